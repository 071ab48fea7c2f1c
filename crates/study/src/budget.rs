//! Errors of an adhesion force by their sources: grid, sample of random profiles, measured surface, model.

use super::ensemble::Ensemble;
use super::quantity::Quantity;
use asperity_data::{Warning, quantile};
use asperity_scene::{Estimate, Outcome};
use serde::Serialize;
use std::ops::Range;

/// Smallest number of profiles whose median has an interval.
const FEWEST: usize = 4;
/// Half the width of the interval of a median in quantiles, times the root of the number of profiles. It is the normal
/// approximation of the binomial distribution for 95 of 100 cases.
const HALF: f64 = 0.98;

/// Errors of the adhesion force of a scene, one for each source of errors. They are relative: the error `grid` is divided by
/// the adhesion force on the scene's own profile, and `sample` and `surface` by the median over random profiles. In about 5 of
/// 100 cases the true error is larger. `None` means that an error is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Budget {
    /// Error due to the finite number of springs, for the profile with the seed of the scene.
    pub grid: Option<f64>,
    /// Error of the median over random profiles, due to the finite number of these profiles.
    pub sample: Option<f64>,
    /// Error of the median over random profiles, due to the uncertainty of the spectrum of a measured surface.
    pub surface: Option<f64>,
    /// Error of the model: relative difference between the mean adhesion force on one-dimensional profiles and the mean of the
    /// same bodies in three dimensions.
    pub model: Option<f64>,
    /// Name of the field with the largest known error: `grid`, `sample`, `surface` or `model`; `None` if no error is known, or
    /// if a premise of the model does not hold, which may cause a larger error.
    pub largest: Option<&'static str>,
}

impl Budget {
    /// Collects the errors of a computed scene; `None` if the adhesion force of the scene is not above zero. `estimate` gives
    /// [`Budget::grid`], and `ensemble` gives [`Budget::sample`]. `deviation` is the standard deviation of the adhesion force
    /// in N due to the uncertainty of the spectrum of a measured surface.
    pub fn of(
        outcome: &Outcome,
        estimate: Option<&Estimate>,
        ensemble: Option<&Ensemble>,
        deviation: Option<f64>,
    ) -> Option<Budget> {
        let forces = ensemble.map(|ensemble| ensemble.values(Quantity::AdhesionForce));
        let mut forces: Vec<f64> = forces.into_iter().flatten().flatten().collect();
        let force = outcome.figures.adhesion_force.filter(|force| *force > 0.0)?;
        let finite = |share: f64| Some(share).filter(|share| share.is_finite());
        forces.sort_by(f64::total_cmp);
        let median = if forces.is_empty() { force } else { quantile(&forces, 0.5) };
        let grid = estimate.and_then(|estimate| finite(estimate.of_adhesion_force(outcome)? / force));
        let sample = median_interval(&forces).and_then(|ends| finite(0.5 * (ends.end - ends.start) / median));
        let surface = deviation.and_then(|deviation| finite(2.0 * deviation / median));
        let known = [("grid", grid), ("sample", sample), ("surface", surface)];
        let known = known.into_iter().filter_map(|(name, share)| Some((name, share?)));
        let largest = known.max_by(|one, other| one.1.total_cmp(&other.1)).map(|(name, _)| name);
        // A premise that does not hold may cause a larger error than all that are known.
        let largest = largest.filter(|_| !outcome.warnings.iter().any(Warning::exceeds_errors));
        Some(Budget { grid, sample, surface, model: None, largest })
    }

    /// Returns these errors with the relative error `share` of the model as [`Budget::model`].
    pub fn with_model(self, share: f64) -> Budget {
        let known = [self.grid, self.sample, self.surface].into_iter().flatten();
        let is_largest = known.fold(0.0, f64::max) <= share;
        Budget { model: Some(share), largest: if is_largest { Some("model") } else { self.largest }, ..self }
    }
}

/// Returns an interval of ascending values that holds the median of any distribution in about 95 of 100 cases; `None` for
/// few values.
fn median_interval(ascending: &[f64]) -> Option<Range<f64>> {
    let count = ascending.len();
    let half = HALF / (count as f64).sqrt();
    (count >= FEWEST).then(|| quantile(ascending, 0.5 - half)..quantile(ascending, 0.5 + half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::discretisation::{Evidence, Target};
    use asperity_scene::{Simulation, open, run};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The interval holds the median of log-normal forces in about 95 of 100 samples.
    #[test]
    fn the_interval_of_a_median_holds_it() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        for count in [8, 16, 32, 128] {
            let mut held = 0;
            for _ in 0..4000 {
                let normal = |random: &mut ChaCha8Rng| -> f64 {
                    (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
                };
                let mut forces: Vec<f64> = (0..count).map(|_| (1.5 * normal(&mut random)).exp()).collect();
                forces.sort_by(f64::total_cmp);
                held += i32::from(median_interval(&forces).unwrap().contains(&1.0));
            }
            let share = f64::from(held) / 4000.0;
            assert!((0.92..0.97).contains(&share), "{count}: {share}");
        }
        assert_eq!(median_interval(&[1.0; 3]), None);
    }

    #[test]
    fn the_largest_source_is_named() {
        let fields = [("numerics.points", "1024"), ("roughness.modes", "(1, 128)")];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = open("pressure-sensitive").unwrap().set_all(&fields).unwrap();
        let outcome = run(&document).unwrap();
        let simulation = (Simulation::default(), 1);
        let ensemble =
            Ensemble::of(document.scene(), &[], 17, simulation, &|| false, &mut |_, _| ()).unwrap();
        let estimate = |error| Estimate {
            target: Target::AdhesionForce,
            error,
            near_step: false,
            evidence: Evidence::ClosedForm,
        };
        let budget = |error, ensemble, deviation| {
            Budget::of(&outcome, Some(&estimate(error)), ensemble, deviation).unwrap()
        };
        let grid = budget(0.01, None, None);
        assert_eq!((grid.sample, grid.surface, grid.largest), (None, None, Some("grid")));
        assert!((grid.grid.unwrap() / 0.01 - 1.0).abs() < 1e-12);
        let all = ensemble.statistics(Quantity::AdhesionForce).unwrap();
        let median = all.quartiles[1];
        let sample = budget(0.01, Some(&ensemble), Some(1e-3 * median));
        // About half of the distance of the quartiles.
        let quartiles = 0.5 * (all.quartiles[2] - all.quartiles[0]) / median;
        assert!((sample.sample.unwrap() / quartiles - 1.0).abs() < 0.2, "{sample:?} {quartiles}");
        assert!((sample.surface.unwrap() - 2e-3).abs() < 1e-12 && sample.largest == Some("sample"));
        assert_eq!(budget(0.01, Some(&ensemble), Some(9.0 * median)).largest, Some("surface"));
        let modelled = [0.2, 1e-3].map(|share| budget(0.01, None, None).with_model(share));
        assert_eq!(
            modelled.map(|one| (one.model, one.largest)),
            [(Some(0.2), Some("model")), (Some(1e-3), Some("grid"))]
        );
        assert_eq!(Budget::of(&outcome, None, None, None).unwrap().largest, None);
        let apart = run(&open("jkr-sphere").unwrap().set("adhesion", "None").unwrap()).unwrap();
        assert_eq!(Budget::of(&apart, None, None, None), None);
    }
}
