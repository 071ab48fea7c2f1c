//! Likelihood of the observed powers by Whittle's method. The powers of the waves are assumed to be
//! independent and exponentially distributed, with mean values that the spectrum gives.

use super::nodes::{End, Nodes, Term, WaveRange};
use super::observation::Observation;

/// Number of nodes of a spectrum per decade of wave numbers.
const NODES_PER_DECADE: f64 = 6.0;

/// Model of the observed powers. The expected value of each observed power is a sum of terms that
/// depend on the spectrum.
pub(super) struct Model<'a> {
    pub observations: &'a [Observation],
    /// For each observation, a list of terms. Their sum is the expected value of the observed
    /// power.
    pub terms: Vec<Vec<Term>>,
    pub nodes: Nodes,
}

impl<'a> Model<'a> {
    /// Creates a model for observations in a range of wave numbers. The spectrum of the model is
    /// given at wave numbers in this range, the nodes. `end` states whether the spectrum continues
    /// beyond the range.
    pub fn new(observations: &'a [Observation], range: WaveRange, end: End) -> Self {
        let nodes = Nodes::new(range, NODES_PER_DECADE, end);
        let terms = observations
            .iter()
            .map(|observation| observation.terms(&nodes))
            .collect();
        Model {
            observations,
            terms,
            nodes,
        }
    }

    /// Returns the expected value of each observed power, which the spectrum `values` predicts.
    /// `values` is ln C2D at the nodes, the wave numbers at which the spectral density C2D is
    /// given.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.terms
            .iter()
            .map(|terms| terms.iter().map(|term| term.value(values)).sum::<f64>())
    }
}

/// Returns the negative logarithm of the likelihood of observations. It is the sum of w (P/m + ln
/// m) over the observations: P is the mean power of w waves that was observed, and m from `means`
/// is its expected value.
pub(super) fn misfit(observations: &[Observation], means: impl Iterator<Item = f64>) -> f64 {
    observations
        .iter()
        .zip(means)
        .map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln()))
        .sum()
}
