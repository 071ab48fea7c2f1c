//! Search, on coarse tables, for the place around which the table of computed curves has to lie.

use super::computed::Workers;
use super::scatter::Scatter;
use super::summary::{Measurement, SUMMARIES, Summaries};
use super::table::{Axis, Place, Table, places};
use crate::error::ExperimentError;
use asperity_scene::Governing;

/// Number of random profiles of the coarse table.
const COARSE_LINES: u64 = 8;
/// Nodes of the coarse table in ln(γ/E*).
const COARSE_RANGES: Axis = Axis {
    step: 0.8,
    nodes: 19,
};
/// Nodes of the coarse table in ln E*.
const COARSE_MODULI: Axis = Axis {
    step: 0.7,
    nodes: 7,
};
/// Number of steps of the search within one step of the coarse table.
const FINE_STEPS: usize = 6;
/// Largest number of coarse tables that are computed. If the best place is at an end of a table,
/// the next table lies around this place.
const MOST_MOVES: usize = 4;
/// Largest roughness-adhesion parameter κ = √(h⟨∇z⟩E*/γ) in the first coarse table. The smallest κ
/// in this table is 0.06, that of a soft body which is almost smooth.
const HIGHEST_KAPPA: f64 = 80.0;
/// Standard deviation that is added in quadrature to the scatter of each summary, so that no
/// summary has too large a weight.
const LEAST_SCATTER: f64 = 0.1;
/// Mean square of the differences between the summaries at a place and the summaries of the
/// measured curves, each in units of its variance, above which the place is far from the curves.
const FAR: f64 = 25.0;

/// Finds the place at which the computed curves have the mean summaries of the measured curves,
/// with an accuracy of about a step of the first table. `known` is ln E* if E* is given.
pub(crate) fn placed(
    workers: &Workers<'_>,
    measured: &Measurement,
    governing: &Governing,
    known: Option<f64>,
) -> Result<Place, ExperimentError> {
    let largest_range = match governing.amplitude {
        Some(amplitude) => amplitude.rms_height * amplitude.rms_gradient,
        None => 0.0,
    };
    let largest_range = largest_range.max(f64::MIN_POSITIVE).ln();
    let modulus = governing.modulus.ln();
    let mut low = largest_range - HIGHEST_KAPPA.powi(2).ln();
    let mut soft = COARSE_MODULI.first_around(modulus);
    for moves_left in (0..MOST_MOVES).rev() {
        let ranges = COARSE_RANGES.nodes_from(low);
        let moduli = match known {
            Some(modulus) => vec![modulus],
            None => COARSE_MODULI.nodes_from(soft),
        };
        let table = Table::new(workers, COARSE_LINES, ranges, moduli)?;
        let Some(best) = best_place(&table, measured) else {
            break;
        };
        let is_range_at_end = is_at_end(&table.ranges, best.range, COARSE_RANGES.step);
        let is_modulus_at_end = is_at_end(&table.moduli, best.modulus, COARSE_MODULI.step);
        if moves_left == 0 || !(is_range_at_end || is_modulus_at_end) {
            return Ok(best);
        }
        if is_range_at_end {
            low = COARSE_RANGES.first_around(best.range);
        }
        if is_modulus_at_end {
            soft = COARSE_MODULI.first_around(best.modulus);
        }
    }
    Ok(Place {
        range: low,
        modulus,
    })
}

/// Returns the place, on a fine grid over the table, at which the mean summaries agree best with
/// those of the measured curves.
///
/// If all places are far from the curves, the place may be beyond the table. The scatter of the
/// summaries then says nothing about the curves, and a place with a small scatter would count as
/// farther than it is. So the distances from all places are compared in the same units.
fn best_place(table: &Table, measured: &Measurement) -> Option<Place> {
    let summaries = SummariesOfTable::new(table, measured);
    let places = places(&refined(&table.ranges), &refined(&table.moduli));
    let best = least(&places, |place| summaries.misfit(place))?;
    if summaries.mean_square(best) <= FAR {
        return Some(best);
    }
    least(&places, |place| summaries.distance(place))
}

/// Returns the place with the smallest value of a function.
fn least(places: &[Place], value: impl Fn(Place) -> f64) -> Option<Place> {
    let mut best: Option<(f64, Place)> = None;
    for place in places {
        let value = value(*place);
        if best.is_none_or(|(least, _)| value.total_cmp(&least).is_lt()) {
            best = Some((value, *place));
        }
    }
    best.map(|(_, place)| place)
}

/// Summaries of the random profiles of a table, and mean summaries of the measured curves.
struct SummariesOfTable {
    scatters: Vec<Scatter>,
    target: Summaries,
    /// Variance of the difference between the means of the curves and of the table, in units of the
    /// variance of one profile.
    variance: f64,
}

impl SummariesOfTable {
    fn new(table: &Table, measured: &Measurement) -> Self {
        SummariesOfTable {
            scatters: (0..SUMMARIES)
                .map(|index| Scatter::of_summary(table, index))
                .collect(),
            target: measured.mean().summaries,
            variance: 1.0 / measured.summaries.len() as f64 + 1.0 / COARSE_LINES as f64,
        }
    }

    /// Returns the difference of each summary from the measured curves at a place, and the variance
    /// of the summary over the profiles.
    fn differences(&self, place: Place) -> impl Iterator<Item = [f64; 2]> {
        let pairs = self.scatters.iter().zip(self.target);
        pairs.map(move |(scatter, target)| {
            let moments = scatter.at(place);
            let square = moments.covariance[0] + LEAST_SCATTER.powi(2);
            [moments.mean[0] - target, square]
        })
    }

    /// Returns twice the negative logarithm of the likelihood of a place, up to a constant.
    fn misfit(&self, place: Place) -> f64 {
        let terms = self
            .differences(place)
            .map(|[difference, square]| difference.powi(2) / square / self.variance + square.ln());
        terms.sum()
    }

    /// Returns the mean square of the differences at a place, in units of their variances.
    fn mean_square(&self, place: Place) -> f64 {
        let terms = self
            .differences(place)
            .map(|[difference, square]| difference.powi(2) / square / self.variance);
        terms.sum::<f64>() / SUMMARIES as f64
    }

    /// Returns the sum of the squared differences at a place.
    fn distance(&self, place: Place) -> f64 {
        let squares = self.differences(place);
        squares.map(|[difference, _]| difference.powi(2)).sum()
    }
}

/// Returns the values of an axis and [`FINE_STEPS`] − 1 further values between each pair of its
/// nodes.
fn refined(axis: &[f64]) -> Vec<f64> {
    let count = FINE_STEPS * (axis.len() - 1);
    let first = axis[0];
    let last = axis[axis.len() - 1];
    (0..=count)
        .map(|index| first + (last - first) * index as f64 / count.max(1) as f64)
        .collect()
}

/// Returns true for a place within half a step of an end of an axis with several nodes.
fn is_at_end(axis: &[f64], place: f64, step: f64) -> bool {
    let first = axis[0];
    let last = axis[axis.len() - 1];
    axis.len() > 1 && (place - first).min(last - place) < 0.5 * step
}
