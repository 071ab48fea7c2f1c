//! Spectrum of the largest penalised likelihood (Whittle): powers of waves are exponentially distributed about their means.
//!
//! Over the values x = ln C2D at the nodes, Σ w (P/m + ln m) + λ Σ (x_{i−1} − 2x_i + x_{i+1})² is minimised, with the
//! observed powers P of w waves and their means m(x). Steps are those of Fisher's scoring, halved until they descend.

use super::isotropic::{End, IsotropicSpectrum, Nodes, Term};
use super::linear::Cholesky;
use super::observation::Observation;
use std::f64::consts::TAU;

/// Weight λ of the second differences.
const SMOOTHNESS: f64 = 1.0;

const NODES_PER_DECADE: f64 = 6.0;

/// Most steps, and the decrease of the objective that ends the search.
const MOST_STEPS: usize = 200;
const SMALL_DECREASE: f64 = 1e-9;

const LARGEST_STEP: f64 = 1.5;

/// Observations with the terms of their means.
pub(super) struct Model<'a> {
    pub observations: &'a [Observation],
    pub terms: Vec<Vec<Term>>,
    pub nodes: Nodes,
}

impl<'a> Model<'a> {
    /// Model with nodes from the smallest to the largest observed wave number, including half a wave.
    pub fn new(observations: &'a [Observation], [low, high]: [f64; 2], end: End) -> Self {
        let nodes = Nodes::new(low, high, NODES_PER_DECADE, end);
        let terms = observations.iter().map(|observation| observation.terms(&nodes)).collect();
        Model { observations, terms, nodes }
    }

    /// Objective for given means, without the penalty.
    pub fn misfit(&self, means: impl Iterator<Item = f64>) -> f64 {
        let each = self.observations.iter().zip(means);
        each.map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln())).sum()
    }

    /// Means of the observed powers for these values.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.terms.iter().map(|terms| terms.iter().map(|term| term.value(values)).sum::<f64>())
    }

    fn objective(&self, values: &[f64]) -> f64 {
        let rough: f64 = values.windows(3).map(|x| (x[0] - 2.0 * x[1] + x[2]).powi(2)).sum();
        self.misfit(self.means(values)) + SMOOTHNESS * rough
    }

    /// Gradient and information matrix of the objective.
    fn linearise(&self, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let count = values.len();
        let (mut gradient, mut information) = (vec![0.0; count], vec![0.0; count * count]);
        let mut slope = vec![0.0; count];
        for (observed, terms) in self.observations.iter().zip(&self.terms) {
            slope.fill(0.0);
            let mut mean = 0.0;
            for term in terms {
                let value = term.value(values);
                mean += value;
                slope[term.index] += (1.0 - term.share) * value;
                slope[term.index + 1] += term.share * value;
            }
            slope.iter_mut().for_each(|slope| *slope /= mean);
            let residual = observed.waves * (1.0 - observed.power / mean);
            for row in 0..count {
                gradient[row] += residual * slope[row];
                for column in 0..=row {
                    information[row * count + column] += observed.waves * slope[row] * slope[column];
                }
            }
        }
        for (first, x) in values.windows(3).enumerate() {
            let difference = x[0] - 2.0 * x[1] + x[2];
            for (row, a) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                gradient[first + row] += 2.0 * SMOOTHNESS * a * difference;
                for (column, b) in [1.0, -2.0, 1.0].into_iter().enumerate().take(row + 1) {
                    information[(first + row) * count + first + column] += 2.0 * SMOOTHNESS * a * b;
                }
            }
        }
        (gradient, information)
    }

    /// Initial values: powers of cuts as if C2D were a power law with the exponent −3, constant outside the
    /// observations.
    fn start(&self) -> Vec<f64> {
        let count = self.nodes.count;
        let mut sums = vec![(0.0, 0.0); count];
        for (observed, terms) in self.observations.iter().zip(&self.terms) {
            // The mean of a spectrum of ones is the normalisation.
            let ln_q = observed.wave_number.ln();
            let weights = terms.iter().map(|term| term.weight * ((ln_q - term.ln_q) * 3.0).exp());
            let weight: f64 = weights.sum();
            if observed.power > 0.0 && weight > 0.0 {
                let (index, share) = self.nodes.place(ln_q);
                let nearest = if share < 0.5 { index } else { (index + 1).min(count - 1) };
                sums[nearest].0 += observed.waves * (observed.power / weight).ln();
                sums[nearest].1 += observed.waves;
            }
        }
        let known = (0..count).filter(|index| sums[*index].1 > 0.0);
        let known: Vec<_> = known.map(|index| (index, sums[index].0 / sums[index].1)).collect();
        let between = |index: usize| {
            let after = known.iter().find(|(place, _)| *place >= index);
            let before = known.iter().rev().find(|(place, _)| *place <= index);
            match (before, after) {
                (Some((i, a)), Some((j, b))) if i < j => a + (b - a) * (index - i) as f64 / (j - i) as f64,
                (Some((_, value)), _) | (None, Some((_, value))) => *value,
                (None, None) => 0.0,
            }
        };
        (0..count).map(between).collect()
    }

    /// Spectrum of the smallest objective; `None` if the information matrix is not positive definite, as for powers
    /// that are zero or not finite.
    pub fn fit(&self) -> Option<IsotropicSpectrum> {
        let moved = |values: &Vec<f64>, step: &[f64], share: f64| {
            let largest = step.iter().fold(0.0_f64, |largest, change| largest.max(change.abs()));
            let limited = share * (LARGEST_STEP / largest).min(1.0);
            values.iter().zip(step).map(|(x, change)| x - limited * change).collect()
        };
        let objective = |values: &Vec<f64>| self.objective(values);
        let linearise = |values: &Vec<f64>| self.linearise(values);
        let (values, _) = descend(self.start(), MOST_STEPS, objective, linearise, moved)?;
        let (_, information) = self.linearise(&values);
        let information = Cholesky::new(information, values.len())?;
        let mut found =
            IsotropicSpectrum { nodes: self.nodes, values, information, method: [0.0; 3], missing: [0.0; 3] };
        found.method = self.departure(&found);
        Some(found)
    }

    /// Largest departure of the moments of the measured powers from those of the fitted means over the same waves, among
    /// profiles or maps of one kind, relative to the moments of the whole spectrum. Of several kinds, only what is beyond chance.
    fn departure(&self, found: &IsotropicSpectrum) -> [f64; 3] {
        let mut largest = [0.0_f64; 3];
        let mut means = self.means(&found.values);
        let kinds: Vec<_> = self.observations.chunk_by(|one, next| one.kind == next.kind).collect();
        for kind in &kinds {
            let (mut sums, mut variances) = ([0.0; 3], [0.0; 3]);
            for (observed, mean) in kind.iter().zip(&mut means) {
                let (differences, scatter) =
                    (observed.moments(observed.power - mean), observed.moments(mean));
                for index in 0..3 {
                    sums[index] += differences[index];
                    variances[index] += scatter[index].powi(2) / observed.waves;
                }
            }
            for ((largest, sum), variance) in largest.iter_mut().zip(sums).zip(variances) {
                // Scans that share a spectrum depart from it by chance, which is in the statistical error.
                let chance = if kinds.len() > 1 { 2.0 * f64::sqrt(variance) } else { 0.0 };
                *largest = largest.max(sum.abs() - chance);
            }
        }
        let whole = found.integrals();
        [0, 1, 2].map(|index| TAU * largest[index] / whole[index])
    }
}

/// Descends to the least objective by Fisher's scoring: steps solve the linearised equations (gradient, information matrix)
/// and are halved until they descend; `moved` makes a share of a step. `None` if an information matrix is not positive definite.
pub(super) fn descend<P>(
    start: P,
    most_steps: usize,
    objective: impl Fn(&P) -> f64,
    linearise: impl Fn(&P) -> (Vec<f64>, Vec<f64>),
    moved: impl Fn(&P, &[f64], f64) -> P,
) -> Option<(P, f64)> {
    let mut least = objective(&start);
    let mut parameters = start;
    for _ in 0..most_steps {
        let (gradient, information) = linearise(&parameters);
        let step = Cholesky::new(information, gradient.len())?.solve(gradient);
        let shares = (0..30).map(|halvings| moved(&parameters, &step, 0.5_f64.powi(halvings)));
        let lower = shares.map(|next| (objective(&next), next)).find(|(found, _)| *found < least);
        let Some((found, next)) = lower else { break };
        let decrease = least - found;
        (parameters, least) = (next, found);
        if decrease <= SMALL_DECREASE * least.abs().max(1.0) {
            break;
        }
    }
    least.is_finite().then_some((parameters, least))
}
