//! Likelihood of the observed powers (Whittle). The powers of waves are exponentially distributed
//! about their means.

use super::nodes::{End, Nodes, Term, WaveRange};
use super::observation::Observation;

const NODES_PER_DECADE: f64 = 6.0;

/// Observed powers, with the terms that give their means from a spectrum.
pub(super) struct Model<'a> {
    pub observations: &'a [Observation],
    /// Terms of the mean of each observation.
    pub terms: Vec<Vec<Term>>,
    pub nodes: Nodes,
}

impl<'a> Model<'a> {
    /// Creates a model with nodes over the range of wave numbers of the observations.
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

    /// Computes the negative logarithm of the likelihood, Σ w (P/m + ln m), for the means m of the
    /// powers P of w waves each.
    pub fn misfit(&self, means: impl Iterator<Item = f64>) -> f64 {
        self.observations
            .iter()
            .zip(means)
            .map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln()))
            .sum()
    }

    /// Returns the means of the observed powers for these values of ln C2D at the nodes.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.terms
            .iter()
            .map(|terms| terms.iter().map(|term| term.value(values)).sum::<f64>())
    }
}
