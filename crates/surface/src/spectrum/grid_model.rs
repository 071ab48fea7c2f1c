//! The model of the observed powers on one grid of wave numbers. A spectrum that a formula gives is
//! computed once at each wave number of the grid, and all expected powers are sums over the grid.

use super::likelihood::Model;
use super::nodes::{Nodes, Term};
use super::observation::Observation;

/// Spacing of the grid in ln q.
const SPACING: f64 = 0.02;

/// Model of the observed powers on a grid of wave numbers.
pub(super) struct GridModel<'a> {
    pub observations: &'a [Observation],
    pub nodes: Nodes,
    /// ln q at the wave numbers q of the grid, with q in rad/m. The first one is the first node.
    pub ln_q: Vec<f64>,
    /// For each observation, the terms that add up to the expected value of its power.
    pub sums: Vec<GridSum>,
}

/// Sum over a part of the grid: the weights of the wave numbers from `first` on.
pub(super) struct GridSum {
    first: usize,
    weights: Vec<f64>,
}

impl<'a> GridModel<'a> {
    /// Returns a model on the wave numbers of a grid, with nearly the same expected values of the
    /// powers as `model`. The weight of each term of `model` is divided between the two nearest
    /// wave numbers of the grid. For a spectrum q^(−4), the expected values change by less than 0.1
    /// %.
    pub fn new(model: &Model<'a>) -> Self {
        let first = model.nodes.first;
        let sums: Vec<GridSum> = model
            .terms
            .iter()
            .map(|terms| GridSum::new(terms, first))
            .collect();
        let count = sums.iter().map(GridSum::end).max().unwrap_or(0);
        GridModel {
            observations: model.observations,
            nodes: model.nodes,
            ln_q: (0..count)
                .map(|index| first + index as f64 * SPACING)
                .collect(),
            sums,
        }
    }

    /// Returns the expected value of each observed power for a spectrum. `values` is C2D in m⁴ at
    /// the wave numbers of the grid.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.sums.iter().map(|sum| sum.of(values))
    }
}

impl GridSum {
    /// Divides the weights of terms between the wave numbers of a grid that begins at `origin`,
    /// which is ln q of the first node. Terms below the first node are moved to this node, because
    /// the spectrum is constant below it.
    fn new(terms: &[Term], origin: f64) -> Self {
        let place = |term: &Term| (term.ln_q - origin).max(0.0) / SPACING;
        let lowest = terms.iter().map(place).fold(f64::INFINITY, f64::min);
        let highest = terms.iter().map(place).fold(lowest, f64::max);
        if terms.is_empty() {
            return GridSum {
                first: 0,
                weights: Vec::new(),
            };
        }
        let first = lowest as usize;
        let mut weights = vec![0.0; highest as usize - first + 2];
        for term in terms {
            let place = place(term);
            let below = place as usize;
            let share = place - below as f64;
            weights[below - first] += (1.0 - share) * term.weight;
            weights[below - first + 1] += share * term.weight;
        }
        GridSum { first, weights }
    }

    fn end(&self) -> usize {
        self.first + self.weights.len()
    }

    /// Returns the sum of the weights times `values`. There is one value for each wave number of
    /// the grid.
    pub fn of(&self, values: &[f64]) -> f64 {
        scalar_product(&self.weights, &values[self.first..self.end()])
    }
}

/// Returns the scalar product of two columns of the same length. Four partial sums are added
/// independently of each other, which takes less time than a single sum.
pub(super) fn scalar_product(first: &[f64], second: &[f64]) -> f64 {
    let (first, first_rest) = first.as_chunks::<4>();
    let (second, second_rest) = second.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (x, y) in first.iter().zip(second) {
        for index in 0..4 {
            sums[index] += x[index] * y[index];
        }
    }
    let rest = first_rest.iter().zip(second_rest);
    let rest: f64 = rest.map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
