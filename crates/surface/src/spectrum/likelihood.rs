//! Likelihood of the observed powers by Whittle's method. The powers of the waves are assumed to be
//! independent and exponentially distributed, with mean values that the spectrum gives.

use super::nodes::{End, Nodes, Term, WaveRange};
use super::observation::Observation;

/// Number of nodes of a spectrum per decade of wave numbers.
const NODES_PER_DECADE: f64 = 6.0;

/// Spacing in ln q of the grid of wave numbers to which [`Model::condensed`] moves terms.
const GRID: f64 = 0.02;

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

    /// Returns a model with fewer terms and nearly the same expected values of the powers. The
    /// weight of each term is divided between the two nearest wave numbers of a fine grid. For a
    /// power law q^(−4), the expected values change by less than 0.1 %.
    pub fn condensed(&self) -> Model<'a> {
        let terms = self.terms.iter().map(|terms| self.condensed_terms(terms));
        Model {
            observations: self.observations,
            terms: terms.collect(),
            nodes: self.nodes,
        }
    }

    fn condensed_terms(&self, terms: &[Term]) -> Vec<Term> {
        // Terms below the first node are moved to this node, because the spectrum is constant below
        // it.
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

    /// Returns the negative logarithm of the likelihood of the observations. It is the sum of w
    /// (P/m + ln m) over the observations: P is the mean power of w waves that was observed, and m
    /// from `means` is its expected value.
    pub fn misfit(&self, means: impl Iterator<Item = f64>) -> f64 {
        self.observations
            .iter()
            .zip(means)
            .map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln()))
            .sum()
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
