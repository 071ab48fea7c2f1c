//! Minimisation of a negative log-likelihood by Fisher's scoring.

use asperity_data::Cholesky;

/// The search ends if one step decreases the objective by less than this share of the objective, or
/// by less than this number if the objective is below 1.
const SMALL_DECREASE: f64 = 1e-9;

/// Largest number of times that a step is halved.
const MOST_HALVINGS: i32 = 30;

/// A function of several parameters that is to be minimised.
pub(super) trait Objective {
    type Parameters;

    fn value(&self, parameters: &Self::Parameters) -> f64;

    fn linearise(&self, parameters: &Self::Parameters) -> Linearised;

    /// Returns the parameters after a change by `share` times the step `step`.
    fn moved(&self, parameters: &Self::Parameters, step: &[f64], share: f64) -> Self::Parameters;
}

/// Gradient of an objective, and its information matrix. The matrix is stored row by row, and only
/// its lower triangle is set.
pub(super) struct Linearised {
    pub gradient: Vec<f64>,
    pub information: Vec<f64>,
}

impl Linearised {
    /// Creates a gradient and a matrix of zeros for this number of parameters.
    pub fn zeros(count: usize) -> Self {
        Linearised {
            gradient: vec![0.0; count],
            information: vec![0.0; count * count],
        }
    }

    /// Returns the Cholesky factor of the information matrix; `None` if the matrix is not positive
    /// definite.
    pub fn factor(self) -> Option<Cholesky> {
        Cholesky::new(self.information, self.gradient.len())
    }
}

/// Smallest value of an objective that a search has found, and the parameters with this value.
#[derive(Clone, Copy)]
pub(super) struct Minimum<P> {
    pub parameters: P,
    pub value: f64,
}

/// Minimises an objective by a search that begins with the parameters `start`. Each step solves the
/// linearised equations, and is halved until the objective decreases. Returns `None` if an
/// information matrix is not positive definite.
pub(super) fn descend<O: Objective>(
    objective: &O,
    start: O::Parameters,
    most_steps: usize,
) -> Option<Minimum<O::Parameters>> {
    let mut least = Minimum {
        value: objective.value(&start),
        parameters: start,
    };
    for _ in 0..most_steps {
        let linearised = objective.linearise(&least.parameters);
        let count = linearised.gradient.len();
        let factor = Cholesky::new(linearised.information, count)?;
        let step = factor.solve(linearised.gradient);
        let Some(lower) = first_lower(objective, &least, &step) else {
            break;
        };
        let decrease = least.value - lower.value;
        least = lower;
        if decrease <= SMALL_DECREASE * least.value.abs().max(1.0) {
            break;
        }
    }
    least.value.is_finite().then_some(least)
}

/// Tries a step, half of it, a quarter of it and so on. Returns the parameters after the first step
/// that lowers the objective.
fn first_lower<O: Objective>(
    objective: &O,
    least: &Minimum<O::Parameters>,
    step: &[f64],
) -> Option<Minimum<O::Parameters>> {
    for halvings in 0..MOST_HALVINGS {
        let parameters = objective.moved(&least.parameters, step, 0.5_f64.powi(halvings));
        let value = objective.value(&parameters);
        if value < least.value {
            return Some(Minimum { parameters, value });
        }
    }
    None
}
