//! Polynomials of the summaries that predict the parameters, by least squares over computed curves.

use super::summary::{SUMMARIES, Summaries};
use asperity_data::{Cholesky, mean, standard_deviation};

/// Largest deviation of a summary from its mean, in standard deviations. Larger deviations are cut
/// off.
const LARGEST: f64 = 4.0;
/// Penalty of the size of the coefficients, divided by the mean weight of the curves.
const RIDGE: f64 = 1e-5;

/// Summaries of a curve, and the logarithm of its preload if the preloads differ.
#[derive(Clone, Copy)]
pub(crate) struct Described {
    pub summaries: Summaries,
    pub preload: Option<f64>,
}

impl Described {
    fn values(&self) -> impl Iterator<Item = f64> {
        self.summaries.into_iter().chain(self.preload)
    }
}

/// Two polynomials of second degree in the summaries. Each is learned from one half of the random
/// profiles, and predicts the parameters of the other half.
pub(crate) struct Learned {
    /// Mean and standard deviation of each summary.
    standard: Vec<(f64, f64)>,
    halves: [Vec<[f64; 2]>; 2],
    centre: [f64; 2],
}

impl Learned {
    /// Learns from computed curves, each with the number of its random profile, ln γ and ln E*.
    pub fn from(curves: &[(u64, Described, [f64; 2])]) -> Self {
        let standard = (0..SUMMARIES + 1)
            .map_while(|index| {
                let of: Option<Vec<f64>> = curves
                    .iter()
                    .map(|curve| curve.1.values().nth(index))
                    .collect();
                let of = of?;
                let mean = mean(&of);
                Some((mean, standard_deviation(&of, mean).max(f64::MIN_POSITIVE)))
            })
            .collect();
        let of_parameter = |index: usize| {
            mean(
                &curves
                    .iter()
                    .map(|curve| curve.2[index])
                    .collect::<Vec<f64>>(),
            )
        };
        let centre = [of_parameter(0), of_parameter(1)];
        let mut learned = Learned {
            standard,
            halves: [Vec::new(), Vec::new()],
            centre,
        };
        learned.halves = [0, 1].map(|half| learned.coefficients(curves, half));
        learned
    }

    fn coefficients(&self, curves: &[(u64, Described, [f64; 2])], half: u64) -> Vec<[f64; 2]> {
        let columns = self.terms(&curves[0].1).len();
        let (mut products, mut right) = (
            vec![0.0; columns * columns],
            [0, 1].map(|_| vec![0.0; columns]),
        );
        for (_, described, parameters) in curves.iter().filter(|curve| curve.0 % 2 == half) {
            let terms = self.terms(described);
            for (row, one) in terms.iter().enumerate() {
                let sums = products[row * columns..][..=row].iter_mut();
                sums.zip(&terms)
                    .for_each(|(sum, other)| *sum += one * other);
                for (parameter, sums) in right.iter_mut().enumerate() {
                    sums[row] += one * (parameters[parameter] - self.centre[parameter]);
                }
            }
        }
        let on_diagonal = |index: usize| index * (columns + 1);
        let trace: f64 = (0..columns).map(|index| products[on_diagonal(index)]).sum();
        (0..columns)
            .for_each(|index| products[on_diagonal(index)] += RIDGE * trace / columns as f64);
        let Some(factor) = Cholesky::new(products, columns) else {
            return vec![[0.0; 2]; columns];
        };
        let [work, modulus] = right.map(|right| factor.solve(right));
        work.into_iter()
            .zip(modulus)
            .map(<[f64; 2]>::from)
            .collect()
    }

    /// Returns 1, the standardised summaries and all their products.
    fn terms(&self, described: &Described) -> Vec<f64> {
        let standardised = described.values().zip(&self.standard);
        let all: Vec<f64> = std::iter::once(1.0)
            .chain(standardised.map(|(value, (mean, deviation))| {
                ((value - mean) / deviation).clamp(-LARGEST, LARGEST)
            }))
            .collect();
        (0..all.len())
            .flat_map(|one| (0..=one).map(move |other| (one, other)))
            .map(|(one, other)| all[one] * all[other])
            .collect()
    }

    fn by_half(&self, terms: &[f64], half: usize) -> [f64; 2] {
        let sum = |parameter: usize| {
            terms
                .iter()
                .zip(&self.halves[half])
                .map(|(term, of)| term * of[parameter])
                .sum::<f64>()
        };
        [self.centre[0] + sum(0), self.centre[1] + sum(1)]
    }

    /// Predicts ln γ and ln E* of a curve of a random profile, by the polynomial learned from the
    /// other half.
    pub fn of_line(&self, line: u64, described: &Described) -> [f64; 2] {
        self.by_half(&self.terms(described), 1 - (line % 2) as usize)
    }

    /// Predicts ln γ and ln E* of another curve, as the mean of both polynomials.
    pub fn of_curve(&self, described: &Described) -> [f64; 2] {
        let terms = self.terms(described);
        let [one, other] = [0, 1].map(|half| self.by_half(&terms, half));
        [0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// A relation of second degree is learned, by each half from its own lines.
    #[test]
    fn a_polynomial_of_second_degree_is_learned() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut random = || {
            let summaries: Summaries = std::array::from_fn(|_| generator.random_range(-1.0..1.0));
            Described {
                summaries,
                preload: Some(generator.random_range(5.0..6.0)),
            }
        };
        let parameters = |of: &Described| {
            let [one, other, third] = [of.summaries[0], of.summaries[4], of.preload.unwrap()];
            [3.0 + one - 2.0 * other * third, 7.0 * one * one - other]
        };
        let curves: Vec<_> = (0..2000)
            .map(|index| {
                let of = random();
                // The lines of one half are off by 1: the other half does not learn it.
                let [work, modulus] = parameters(&of);
                (
                    index % 16,
                    of,
                    [work + f64::from(u8::from(index % 2 == 0)), modulus],
                )
            })
            .collect();
        let learned = Learned::from(&curves);
        let of = random();
        let [work, modulus] = parameters(&of);
        for (found, expected) in [
            (learned.of_line(0, &of), [work, modulus]),
            (learned.of_line(1, &of), [work + 1.0, modulus]),
            (learned.of_curve(&of), [work + 0.5, modulus]),
        ] {
            assert!(
                found
                    .iter()
                    .zip(expected)
                    .all(|(one, other)| (one - other).abs() < 0.01),
                "{found:?} {expected:?}"
            );
        }
    }
}
