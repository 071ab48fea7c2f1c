//! Errors of a comparison between profiles and bodies in three dimensions, one for each source of
//! errors.

use super::compared::Compared;
use serde::Serialize;

/// Errors of a [`Reference`](super::reference::Reference), one for each source of errors. All
/// except `solver` are relative errors of the pull-off force, or of the indentation at the preload
/// if the scene has no adhesion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReferenceBudget {
    /// Largest error of the gap in the contacts without adhesion, divided by the rms height of the
    /// square surface. The gap is the distance between the bodies at a grid cell, and the largest
    /// error over all grid cells of all surfaces is taken.
    pub solver: f64,
    /// Relative error due to the grid of the square surfaces. It is an error of the mean pull-off
    /// force over these surfaces or, without adhesion, of their mean indentation. The error is the
    /// relative difference between this mean and the mean over the same surfaces with half as many
    /// grid cells along the side. `None` if half as many cells are too few.
    ///
    /// If the profile model is exact for the body, the difference between the means over the
    /// profiles and over the square surfaces is an error of the grid too. The error is then the
    /// larger of the two differences.
    pub grid: Option<f64>,
    /// Error due to the finite numbers of profiles and square surfaces: half the width of the 95 %
    /// confidence interval of [`Compared::ratio`], divided by this ratio. `None` for fewer than two
    /// profiles or square surfaces.
    pub sample: Option<f64>,
    /// Relative difference of the pull-off force (without adhesion, of the indentation) between
    /// profiles and square surfaces: its mean over the profiles divided by its mean over the square
    /// surfaces, minus 1. `None` if the difference is unknown.
    pub difference: Option<f64>,
    /// Lower bound of the relative error of the model. It is the magnitude of `difference` as far
    /// as it exceeds the errors `sample` and `grid`. It is 0 if these errors can explain the
    /// difference, and `None` if one of these errors is unknown.
    pub model: Option<f64>,
    /// Name of the field with the largest known error: `solver`, `grid`, `sample` or `model`.
    pub largest: &'static str,
}

/// Properties of the compared bodies that determine which errors exist.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bodies {
    /// True if profiles and square surfaces are random.
    pub are_random: bool,
    /// True for a body of revolution for which the profile model is exact.
    pub line_is_exact: bool,
}

impl ReferenceBudget {
    /// Collects the errors. `headline` is the comparison of the pull-off force or, without
    /// adhesion, of the indentation. `solver` is the error [`ReferenceBudget::solver`].
    pub(super) fn new(solver: f64, headline: Option<&Compared>, bodies: Bodies) -> ReferenceBudget {
        let mut budget = ReferenceBudget {
            solver,
            grid: None,
            sample: None,
            difference: None,
            model: None,
            largest: "solver",
        };
        if let Some(compared) = headline {
            budget.add(compared, bodies);
        }
        let mut most = solver;
        for (name, error) in [
            ("grid", budget.grid),
            ("sample", budget.sample),
            ("model", budget.model),
        ] {
            if let Some(error) = error
                && error >= most
                && error > 0.0
            {
                budget.largest = name;
                most = error;
            }
        }
        budget
    }

    fn add(&mut self, compared: &Compared, bodies: Bodies) {
        let difference = compared.difference();
        self.difference = Some(difference);
        self.sample = compared.error.map(|error| error / compared.ratio);
        self.grid = compared.grid;
        if bodies.line_is_exact {
            // The profile is exact for this body, so the whole difference is an error of the square
            // surfaces.
            self.grid = Some(difference.abs().max(compared.grid.unwrap_or(0.0)));
            self.model = Some(0.0);
            return;
        }
        // If the bodies are not random, there is no error due to a finite number of samples.
        let sample = if bodies.are_random {
            compared.error
        } else {
            Some(0.0)
        };
        if let (Some(sample), Some(grid)) = (sample, compared.grid) {
            self.model = Some((difference.abs() - sample - grid * compared.ratio).max(0.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::compared::Values;
    use super::*;

    const RANDOM: Bodies = Bodies {
        are_random: true,
        line_is_exact: false,
    };

    /// Returns a comparison with the ratio `lines`/2 and the error `error`. On the coarser grid,
    /// the mean over the square surfaces differs by the share `grid`.
    fn compared(lines: f64, error: Option<f64>, grid: Option<f64>) -> Compared {
        let values = Values {
            lines: vec![lines; 2],
            squares: vec![2.0; 2],
            coarse: Vec::new(),
        };
        Compared {
            error,
            grid,
            ..values.compared().unwrap()
        }
    }

    #[test]
    fn the_model_is_what_exceeds_sample_and_grid() {
        let budget = |compared: Compared| ReferenceBudget::new(1e-9, Some(&compared), RANDOM);
        let within = budget(compared(2.08, Some(0.45), Some(0.1)));
        assert!((within.difference.unwrap() - 0.04).abs() < 1e-12);
        assert_eq!((within.model, within.largest), (Some(0.0), "sample"));
        let coarse = budget(compared(2.08, Some(0.05), Some(0.1)));
        assert_eq!((coarse.model, coarse.largest), (Some(0.0), "grid"));
        // The ratio 8/2 exceeds 1 by 3. The error of the sample explains 1 of this difference, and
        // the error of the grid 4 · 0.1, so that 1.6 remains.
        let far = budget(compared(8.0, Some(1.0), Some(0.1)));
        assert!(
            (far.model.unwrap() - 1.6).abs() < 1e-12 && far.largest == "model",
            "{far:?}"
        );
        assert!((far.sample.unwrap() - 0.25).abs() < 1e-12);
        let below = budget(compared(1.0, Some(0.1), Some(0.2)));
        assert!(
            (below.model.unwrap() - 0.3).abs() < 1e-12 && below.difference == Some(-0.5),
            "{below:?}"
        );
    }

    #[test]
    fn an_unknown_error_leaves_the_model_unknown() {
        for (error, grid) in [(None, Some(0.1)), (Some(0.1), None), (None, None)] {
            let compared = compared(8.0, error, grid);
            assert_eq!(
                ReferenceBudget::new(1e-9, Some(&compared), RANDOM).model,
                None
            );
        }
        let none = ReferenceBudget::new(1e-9, None, RANDOM);
        assert_eq!(
            (none.difference, none.model, none.largest),
            (None, None, "solver")
        );
    }

    /// Nothing is random about smooth bodies, so their sample has no error. A flat square and its
    /// profile may nevertheless differ. For a body of revolution the profile model is exact.
    #[test]
    fn a_smooth_body_has_no_sample() {
        let alone = compared(2.2, None, Some(0.03));
        let flat = Bodies {
            are_random: false,
            line_is_exact: false,
        };
        let budget = ReferenceBudget::new(0.0, Some(&alone), flat);
        assert!(
            (budget.model.unwrap() - 0.067).abs() < 1e-12 && budget.largest == "model",
            "{budget:?}"
        );
        let sphere = Bodies {
            are_random: false,
            line_is_exact: true,
        };
        let budget = ReferenceBudget::new(0.0, Some(&alone), sphere);
        assert!(
            (budget.grid.unwrap() - 0.1).abs() < 1e-12 && budget.largest == "grid",
            "{budget:?}"
        );
        assert_eq!(budget.model, Some(0.0));
        let same = ReferenceBudget::new(1e-9, Some(&compared(2.0, None, None)), sphere);
        assert_eq!((same.grid, same.largest), (Some(0.0), "solver"));
    }
}
