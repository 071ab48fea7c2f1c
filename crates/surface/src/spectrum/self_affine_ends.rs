//! Self-affine fits with several assumptions about the waves that the points do not resolve.
//!
//! Such waves change the measured spectrum in two ways. Their powers are added to the powers of
//! longer waves (aliases), and each power of a profile contains a part of shorter waves of the
//! surface. The assumption about the unresolved waves changes the Hurst exponent by up to 0.2. The
//! fit therefore uses the assumption with the largest likelihood. The change between likely
//! assumptions is part of the error.

use super::isotropic_fit::fit_isotropic;
use super::likelihood::Model;
use super::nodes::{End, WaveRange};
use super::observation::{Kind, Observation};
use super::self_affine_fit::{PowerLaw, SelfAffineFit, find_power_law};

/// Assumed ratios of the last wave number of the surface to the last resolved wave number. All of
/// them are tried.
const CONTINUED: [f64; 3] = [1.5, 3.0, 10.0];

/// Assumed ratio of the last wave number of the surface to the last wave number that passes a
/// filter of the instrument, if the instrument filters before it samples.
const FILTERED: f64 = 30.0;

/// Ratio of the last resolved wave number to the last wave number of a fit to fewer waves.
const OCTAVE: f64 = 2.0;

/// Assumption on the waves of the surface beyond the last resolved wave.
#[derive(Clone, Copy)]
struct Assumption {
    end: End,
    /// True if the instrument is assumed to remove these waves from each profile before it samples
    /// heights.
    is_filtered: bool,
}

/// A power law and the assumption under which it was fitted.
#[derive(Clone, Copy)]
struct Candidate {
    assumption: Assumption,
    law: PowerLaw,
}

/// Fits a self-affine spectrum to observations over a range of wave numbers. Of several assumptions
/// about the waves that the points do not resolve, the one with the largest likelihood is used.
/// Returns `None` if no fit converges or if no Hurst exponent between 0 and 1 fits.
pub(super) fn fit_for_ends(
    observations: &[Observation],
    range: WaveRange,
    end: End,
    ends_inside: bool,
) -> Option<SelfAffineFit> {
    let mut candidates = Vec::new();
    for assumption in assumptions(observations, range, end, ends_inside) {
        let observations = assumption.observed(observations);
        let model = Model::new(&observations, range, assumption.end);
        if let Some(law) = find_power_law(&model) {
            candidates.push(Candidate { assumption, law });
        }
    }
    let best = candidates
        .iter()
        .min_by(|first, second| first.law.misfit.total_cmp(&second.law.misfit))?;

    let observed = best.assumption.observed(observations);
    let model = Model::new(&observed, range, best.assumption.end);
    let isotropic = fit_isotropic(&model, None)?;
    let scale = best.law.scale(&model, &isotropic);
    let mut fit = best.law.with_errors(&model, scale)?;
    let by_end = change_by_end(&candidates, best, scale);
    let by_range = if ends_inside {
        0.0
    } else {
        change_by_range(&observed, range, best, fit.hurst.error)
    };
    fit.hurst.error = fit.hurst.error.hypot(by_end).hypot(by_range);
    Some(fit)
}

/// Returns the assumptions on the unresolved waves that are tried.
fn assumptions(
    observations: &[Observation],
    range: WaveRange,
    end: End,
    ends_inside: bool,
) -> Vec<Assumption> {
    let stated = Assumption {
        end,
        is_filtered: false,
    };
    let mut assumptions = vec![stated];
    if end != End::Ends {
        return assumptions;
    }
    let has_cut = observations
        .iter()
        .any(|observation| matches!(observation.kind, Kind::Cut { .. }));
    // A spectrum that ends before the last resolved wave has no shorter waves.
    let continued = if ends_inside { &[] } else { &CONTINUED[..] };
    for factor in continued {
        assumptions.push(Assumption {
            end: End::Continues(factor * range.last),
            is_filtered: false,
        });
    }
    // Only profiles need this assumption. Without aliases, the power of a wave of a map contains no
    // part of shorter waves.
    if has_cut {
        assumptions.push(Assumption {
            end: End::Continues(FILTERED * range.last),
            is_filtered: true,
        });
    }
    assumptions
}

impl Assumption {
    /// Returns the observations. If the instrument is assumed to filter, the observations are
    /// changed so that their expected means contain no aliases.
    fn observed(&self, observations: &[Observation]) -> Vec<Observation> {
        let mut observed = observations.to_vec();
        if !self.is_filtered {
            return observed;
        }
        for observation in &mut observed {
            match &mut observation.kind {
                Kind::Cut { sampling, .. } => *sampling = f64::INFINITY,
                Kind::Plane { sampling, .. } => *sampling = [f64::INFINITY; 2],
            }
        }
        observed
    }
}

/// Returns the rms change of the Hurst exponent between the assumptions, weighted by their
/// likelihoods. `scale` is the ratio of the observed scatter of the powers to the scatter expected
/// by chance. With a larger scatter the likelihoods distinguish the assumptions less.
fn change_by_end(candidates: &[Candidate], best: &Candidate, scale: f64) -> f64 {
    let mut weights = 0.0;
    let mut squares = 0.0;
    for candidate in candidates {
        let excess = (candidate.law.misfit - best.law.misfit) / (scale * scale);
        let weight = (-excess).exp();
        weights += weight;
        squares += weight * (candidate.law.hurst() - best.law.hurst()).powi(2);
    }
    let by_likelihood = squares / weights;
    (by_likelihood + change_between_ends(candidates, best).powi(2)).sqrt()
}

/// Returns the standard deviation of the Hurst exponent that results from the finite number of wave
/// numbers that are tried as the last wave number of the surface. The exponent is assumed to be
/// uniformly distributed between its values for the best assumption and for the next likely
/// assumption without a filter. The result is zero if, by the best assumption, the surface ends at
/// the last resolved wave or the instrument filters.
fn change_between_ends(candidates: &[Candidate], best: &Candidate) -> f64 {
    if best.assumption.is_filtered || best.assumption.end == End::Ends {
        return 0.0;
    }
    let others = candidates.iter().filter(|candidate| {
        !candidate.assumption.is_filtered && candidate.assumption.end != best.assumption.end
    });
    let likeliest = others.min_by(|first, second| first.law.misfit.total_cmp(&second.law.misfit));
    match likeliest {
        Some(other) => (other.law.hurst() - best.law.hurst()).abs() / 12.0_f64.sqrt(),
        None => 0.0,
    }
}

/// Returns by how much the Hurst exponent changes if the last octave of waves is left out, as far
/// as the smaller number of waves does not explain the change. `error` is the standard error of the
/// fit over the whole range.
fn change_by_range(
    observations: &[Observation],
    range: WaveRange,
    best: &Candidate,
    error: f64,
) -> f64 {
    let mut fewer = observations.to_vec();
    fewer.retain(|observation| observation.wave_number < range.last / OCTAVE);
    let model = Model::new(&fewer, range, best.assumption.end);
    let Some(law) = find_power_law(&model) else {
        return 0.0;
    };
    let Some(fit) = law.with_errors(&model, 1.0) else {
        return 0.0;
    };
    let change = fit.hurst.value - best.law.hurst();
    let chance = (fit.hurst.error.powi(2) - error * error).max(0.0);
    (change * change - chance).max(0.0).sqrt()
}
