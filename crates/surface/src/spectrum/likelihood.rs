//! Likelihood of the observed powers by Whittle: the powers of the waves are independent and
//! exponentially distributed, with the means of the spectrum.

use super::nodes::{End, Nodes, Term, WaveRange};
use super::observation::Observation;

/// Number of nodes of a spectrum per decade of wave numbers.
const NODES_PER_DECADE: f64 = 6.0;

/// Distance in ln q of the grid of wave numbers to which [`Model::condensed`] moves the terms.
const GRID: f64 = 0.02;

/// Observed powers, with the terms by which their expected means follow from a spectrum.
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

    /// Returns the same model with fewer terms: the weight of each term is divided between the two
    /// nearest wave numbers of a fine grid. The expected mean for a power law q^(−4) changes by
    /// less than 0.1 %.
    pub fn condensed(&self) -> Model<'a> {
        let terms = self.terms.iter().map(|terms| self.condensed_terms(terms));
        Model {
            observations: self.observations,
            terms: terms.collect(),
            nodes: self.nodes,
        }
    }

    fn condensed_terms(&self, terms: &[Term]) -> Vec<Term> {
        // Terms below the first node are moved to it, because the spectrum is constant there.
        let ln_q = |term: &Term| term.ln_q.max(self.nodes.first);
        let lowest = terms.iter().map(ln_q).fold(f64::INFINITY, f64::min);
        let highest = terms.iter().map(ln_q).fold(lowest, f64::max);
        if terms.is_empty() {
            return Vec::new();
        }
        let cells = ((highest - lowest) / GRID).ceil() as usize + 1;
        let mut weights = vec![0.0; cells + 1];
        for term in terms {
            let place = (ln_q(term) - lowest) / GRID;
            let index = place as usize;
            let share = place - index as f64;
            weights[index] += (1.0 - share) * term.weight;
            weights[index + 1] += share * term.weight;
        }
        let mut condensed = Vec::new();
        for (index, weight) in weights.into_iter().enumerate() {
            if weight != 0.0 {
                let wave_number = (lowest + index as f64 * GRID).exp();
                condensed.push(self.nodes.term(wave_number, weight));
            }
        }
        condensed
    }

    /// Computes the negative logarithm of the likelihood, Σ w (P/m + ln m), summed over the
    /// observations. P is the observed mean power of w waves, and m its expected mean.
    pub fn misfit(&self, means: impl Iterator<Item = f64>) -> f64 {
        self.observations
            .iter()
            .zip(means)
            .map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln()))
            .sum()
    }

    /// Returns the expected means of the observed powers for these values of ln C2D at the nodes.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.terms
            .iter()
            .map(|terms| terms.iter().map(|term| term.value(values)).sum::<f64>())
    }
}
