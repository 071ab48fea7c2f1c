//! Errors of a pull-off force, one for each source: grid, sample of random profiles, measured
//! surface, and model.

use super::ensemble::Ensemble;
use super::quantity::Quantity;
use super::statistics::median_interval;
use asperity_data::{Warning, quantile};
use asperity_scene::{Estimate, Outcome};
use serde::Serialize;

/// Errors of the pull-off force of a scene, one for each source of errors. All are relative errors:
/// `grid` and `steps` are divided by the pull-off force on the scene's own profile, and `sample`
/// and `surface` are divided by the median pull-off force over random profiles. The true error
/// exceeds the stated error in about 5 of 100 cases. `None` means that an error is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Budget {
    /// Relative error due to the finite number of springs, for the profile with the seed of the
    /// scene; `None` if it is unknown.
    pub grid: Option<f64>,
    /// Relative error due to the steps in time of a half-space that relaxes; `None` without
    /// relaxation, where there are no such steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<f64>,
    /// Relative error of the median over random profiles, due to the finite number of these
    /// profiles; `None` if it is unknown.
    pub sample: Option<f64>,
    /// Relative error of the median over random profiles, due to the uncertainty of the spectrum of
    /// a measured surface; `None` if it is unknown.
    pub surface: Option<f64>,
    /// Lower bound of the relative error of the model of one-dimensional profiles. It follows from
    /// the difference between the mean pull-off force on profiles and the mean pull-off force on
    /// bodies in three dimensions. The bound is the part of this difference that neither the number
    /// of profiles and bodies nor the grid of the bodies can explain. `None` if it is unknown.
    pub model: Option<f64>,
    /// Name of the field with the largest known error: `grid`, `steps`, `sample`, `surface` or
    /// `model`.
    /// `None` if no error is known. It is also `None` if a premise of the model does not hold,
    /// because this may cause a larger error.
    pub largest: Option<&'static str>,
}

impl Budget {
    /// Collects the errors of the pull-off force of a computed scene; `None` if this force is not
    /// above zero. `estimate` gives the error due to the number of springs, and `ensemble` the
    /// error due to the number of profiles. `deviation` is the standard deviation of the pull-off
    /// force in N due to the uncertainty of the spectrum of a measured surface.
    pub fn of(
        outcome: &Outcome,
        estimate: Option<&Estimate>,
        ensemble: Option<&Ensemble>,
        deviation: Option<f64>,
    ) -> Option<Budget> {
        let forces = ensemble.map(|ensemble| ensemble.values(Quantity::PullOffForce));
        let mut forces: Vec<f64> = forces.into_iter().flatten().flatten().collect();
        let force = outcome
            .figures
            .pull_off_force
            .filter(|force| *force > 0.0)?;
        forces.sort_by(f64::total_cmp);
        let median = quantile(&forces, 0.5).unwrap_or(force);
        let error_of_grid = estimate.and_then(|estimate| estimate.of_pull_off_force(outcome));
        let grid = finite(error_of_grid.map(|error| error / force));
        let error_of_steps = outcome.history.step_error();
        let steps = finite(error_of_steps.map(|error| error / force));
        let interval = median_interval(&forces);
        let sample = finite(interval.map(|(low, high)| 0.5 * (high - low) / median));
        let surface = finite(deviation.map(|deviation| 2.0 * deviation / median));
        let mut largest = None;
        // A premise of the model that does not hold may cause a larger error than all known errors.
        // Then no error counts as the largest.
        if !outcome.warnings.iter().any(Warning::exceeds_errors) {
            largest = largest_source([
                ("steps", steps),
                ("grid", grid),
                ("sample", sample),
                ("surface", surface),
            ]);
        }
        Some(Budget {
            grid,
            steps,
            sample,
            surface,
            model: None,
            largest,
        })
    }

    /// Returns a copy of these errors in which [`Budget::model`] is `model`; `None` means that the
    /// error of the model is unknown. A model error of 0 never becomes the largest error.
    pub fn with_model(self, model: Option<f64>) -> Budget {
        let others = [self.grid, self.steps, self.sample, self.surface]
            .into_iter()
            .flatten()
            .fold(0.0, f64::max);
        let is_largest = model.is_some_and(|model| model > 0.0 && model >= others);
        Budget {
            model,
            largest: if is_largest {
                Some("model")
            } else {
                self.largest
            },
            ..self
        }
    }
}

/// Returns `error` if its value is finite, otherwise `None`.
fn finite(error: Option<f64>) -> Option<f64> {
    error.filter(|error| error.is_finite())
}

/// Returns the name of the largest known error. Of equal errors the last one is returned.
fn largest_source(errors: [(&'static str, Option<f64>); 4]) -> Option<&'static str> {
    let mut largest = None;
    let mut most = f64::NEG_INFINITY;
    for (name, error) in errors {
        if let Some(error) = error
            && error.total_cmp(&most).is_ge()
        {
            most = error;
            largest = Some(name);
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::discretisation::{Evidence, Target};
    use asperity_scene::{Simulation, open, run};

    #[test]
    fn the_largest_source_is_named() {
        let fields = [("numerics.points", "1024"), ("roughness.modes", "(1, 128)")];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = open("pressure-sensitive")
            .unwrap()
            .set_all(&fields)
            .unwrap();
        let outcome = run(&document).unwrap();
        let ensemble = Ensemble::of(
            document.scene(),
            &[],
            17,
            &mut Simulation::default(),
            Control::default().on_threads(1),
        )
        .unwrap();
        let estimate = |error| Estimate {
            target: Target::PullOffForce,
            error,
            near_step: false,
            evidence: Evidence::ClosedForm,
        };
        let budget = |error, ensemble, deviation| {
            Budget::of(&outcome, Some(&estimate(error)), ensemble, deviation).unwrap()
        };
        let grid = budget(0.01, None, None);
        assert_eq!(
            (grid.sample, grid.surface, grid.largest),
            (None, None, Some("grid"))
        );
        assert!((grid.grid.unwrap() / 0.01 - 1.0).abs() < 1e-12);
        let all = ensemble.statistics(Quantity::PullOffForce).unwrap();
        let median = all.quartiles[1];
        let sample = budget(0.01, Some(&ensemble), Some(1e-3 * median));
        // With this number of profiles the error of the median is about half the distance between
        // the quartiles.
        let quartiles = 0.5 * (all.quartiles[2] - all.quartiles[0]) / median;
        assert!(
            (sample.sample.unwrap() / quartiles - 1.0).abs() < 0.2,
            "{sample:?} {quartiles}"
        );
        assert!((sample.surface.unwrap() - 2e-3).abs() < 1e-12 && sample.largest == Some("sample"));
        assert_eq!(
            budget(0.01, Some(&ensemble), Some(9.0 * median)).largest,
            Some("surface")
        );
        for (model, largest) in [
            (Some(0.2), "model"),
            (Some(1e-3), "grid"),
            (Some(0.0), "grid"),
            (None, "grid"),
        ] {
            let modelled = budget(0.01, None, None).with_model(model);
            assert_eq!((modelled.model, modelled.largest), (model, Some(largest)));
        }
        let unknown = Budget::of(&outcome, None, None, None).unwrap();
        assert_eq!(unknown.largest, None);
        assert_eq!(unknown.with_model(Some(0.0)).largest, None);
        let apart = run(&open("jkr-sphere").unwrap().set("adhesion", "None").unwrap()).unwrap();
        assert_eq!(Budget::of(&apart, None, None, None), None);
    }
}
