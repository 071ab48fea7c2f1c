//! Search for the last wave of a measured spectrum that has significant power.

use super::periodogram::{Wave, squared_gradient};

/// Largest share of the squared gradient that waves beyond the end of the spectrum may have.
const NEGLIGIBLE: f64 = 1e-4;

/// The mean power of the last 1/`FLOOR` of all waves is taken for the noise that errors of
/// interpolated points add to all waves.
const FLOOR: usize = 8;

/// Excess of a power over this noise, as a share of the noise, that is attributed to chance.
const CHANCE: f64 = 0.25;

/// Largest ratio of the power of the waves beyond the end of the spectrum to the power of the same
/// number of waves before the end.
const DROP: f64 = 0.03;

/// Finds where the significant power of a spectrum ends, and returns the number of waves before
/// this end. Waves beyond the end have a negligible share of the squared gradient, and far less
/// power than the waves before it. If there is no such end, returns the number of all waves.
///
/// If `has_floor` is true, the mean power of the last waves is first subtracted from all powers.
/// Errors of single interpolated points add such a constant power to all waves.
pub(super) fn last_significant(waves: &[Wave], has_floor: bool) -> usize {
    let floor = if has_floor { noise_floor(waves) } else { 0.0 };
    let excess_over_floor =
        |wave: &Wave| wave.squared_gradient() - floor * wave.wave_number * wave.wave_number;
    let negligible = NEGLIGIBLE * squared_gradient(waves) + CHANCE * floor * sum_of_squares(waves);
    let mut end = waves.len();
    let mut excess = 0.0;
    while end > 1 && excess + excess_over_floor(&waves[end - 1]) <= negligible {
        end -= 1;
        excess += excess_over_floor(&waves[end]);
    }

    let beyond = waves.len() - end;
    let before = beyond.min(end);
    let rest = squared_gradient(&waves[end..]);
    let as_many_before = squared_gradient(&waves[end - before..end]);
    if rest * before as f64 <= DROP * as_many_before * beyond as f64 {
        end
    } else {
        waves.len()
    }
}

/// Returns the mean power of the last waves, which is the power that errors of single interpolated
/// points add to all waves.
fn noise_floor(waves: &[Wave]) -> f64 {
    let last = &waves[waves.len() - waves.len() / FLOOR..];
    if last.is_empty() {
        return 0.0;
    }
    squared_gradient(last) / sum_of_squares(last)
}

/// Returns the sum of the squared wave numbers of several waves.
fn sum_of_squares(waves: &[Wave]) -> f64 {
    waves
        .iter()
        .map(|wave| wave.wave_number * wave.wave_number)
        .sum()
}
