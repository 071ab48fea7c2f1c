//! Polynomials that predict the parameters γ and E* of a curve from its summaries: numbers computed
//! from the curve, such as its pull-off force. The polynomials are learned from computed curves.

use super::summary::{Description, SUMMARIES};
use super::table::{MODULUS, WORK};
use asperity_data::{Cholesky, mean, standard_deviation};

/// Largest deviation of a summary from its mean, in standard deviations. Larger deviations are
/// reduced to this value before they enter the polynomials.
const LARGEST: f64 = 4.0;
/// Penalty on the squares of the coefficients (ridge regression), divided by the mean diagonal
/// element of the matrix of the normal equations.
const RIDGE: f64 = 1e-5;

/// Computed curve of a random profile with known parameters.
pub(crate) struct Example {
    /// Half of the random profiles, 0 or 1, to which the profile of the curve belongs.
    pub half: usize,
    pub description: Description,
    /// Values ln γ and ln E* for which the curve was computed, with γ and E* in SI units.
    pub parameters: [f64; 2],
}

/// Mean and standard deviation of a summary over the computed curves.
struct Standard {
    mean: f64,
    deviation: f64,
}

/// Two polynomials of second degree in the summaries. Each is learned from one half of the random
/// profiles, and predicts the parameters of the other half.
pub(crate) struct Polynomials {
    /// Mean and standard deviation of each summary.
    standards: Vec<Standard>,
    /// Coefficients for both parameters, as learned from each half of the profiles.
    halves: [Vec<[f64; 2]>; 2],
    /// Mean of the parameters of the computed curves.
    centre: [f64; 2],
}

impl Polynomials {
    pub fn learned(examples: &[Example]) -> Self {
        let mut polynomials = Polynomials {
            standards: standards(examples),
            halves: [Vec::new(), Vec::new()],
            centre: [WORK, MODULUS].map(|parameter| {
                let values = examples.iter().map(|example| example.parameters[parameter]);
                mean(&values.collect::<Vec<f64>>())
            }),
        };
        polynomials.halves = [0, 1].map(|half| polynomials.coefficients(examples, half));
        polynomials
    }

    /// Returns the coefficients that are learned from one half of the profiles (ridge regression).
    fn coefficients(&self, examples: &[Example], half: usize) -> Vec<[f64; 2]> {
        let count = self.terms(&examples[0].description).len();
        let mut products = vec![0.0; count * count];
        let mut right_of_work = vec![0.0; count];
        let mut right_of_modulus = vec![0.0; count];
        for example in examples {
            if example.half != half {
                continue;
            }
            let terms = self.terms(&example.description);
            let work = example.parameters[WORK] - self.centre[WORK];
            let modulus = example.parameters[MODULUS] - self.centre[MODULUS];
            for (row, term) in terms.iter().enumerate() {
                // The matrix is symmetric, so only its lower triangle is computed.
                let sums = &mut products[row * count..][..=row];
                for (sum, other) in sums.iter_mut().zip(&terms) {
                    *sum += term * other;
                }
                right_of_work[row] += term * work;
                right_of_modulus[row] += term * modulus;
            }
        }
        let trace: f64 = (0..count).map(|index| products[index * (count + 1)]).sum();
        for index in 0..count {
            products[index * (count + 1)] += RIDGE * trace / count as f64;
        }
        let Some(factor) = Cholesky::new(products, count) else {
            return vec![[0.0; 2]; count];
        };
        let work = factor.solve(right_of_work);
        let modulus = factor.solve(right_of_modulus);
        work.into_iter()
            .zip(modulus)
            .map(<[f64; 2]>::from)
            .collect()
    }

    /// Returns the terms of a polynomial of second degree: 1, the standardised summaries, and all
    /// products of two of them.
    fn terms(&self, description: &Description) -> Vec<f64> {
        let mut factors = Vec::with_capacity(self.standards.len() + 1);
        factors.push(1.0);
        for (value, standard) in description.values().zip(&self.standards) {
            let deviation = (value - standard.mean) / standard.deviation;
            factors.push(deviation.clamp(-LARGEST, LARGEST));
        }
        let mut terms = Vec::with_capacity(factors.len() * (factors.len() + 1) / 2);
        for (index, factor) in factors.iter().enumerate() {
            for other in &factors[..=index] {
                terms.push(factor * other);
            }
        }
        terms
    }

    /// Predicts ln γ and ln E* by the polynomial that was learned from one half of the profiles.
    fn by_half(&self, terms: &[f64], half: usize) -> [f64; 2] {
        [WORK, MODULUS].map(|parameter| {
            let products = terms
                .iter()
                .zip(&self.halves[half])
                .map(|(term, coefficients)| term * coefficients[parameter]);
            self.centre[parameter] + products.sum::<f64>()
        })
    }

    /// Predicts ln γ and ln E* of a computed curve by a polynomial. Each of the two polynomials was
    /// learned from one half of the random profiles. The polynomial of the half without the profile
    /// of this curve is used, so that the prediction has no bias from learning. `half` is the half
    /// to which the profile belongs.
    pub fn of_profile(&self, half: usize, description: &Description) -> [f64; 2] {
        self.by_half(&self.terms(description), 1 - half)
    }

    /// Predicts ln γ and ln E* of a curve that belongs to no random profile of the table. The
    /// prediction is the mean of the predictions of the two polynomials.
    pub fn of_curve(&self, description: &Description) -> [f64; 2] {
        let terms = self.terms(description);
        let even = self.by_half(&terms, 0);
        let odd = self.by_half(&terms, 1);
        [WORK, MODULUS].map(|parameter| 0.5 * (even[parameter] + odd[parameter]))
    }
}

/// Returns the mean and the standard deviation of each summary, and of the preload if the examples
/// have one.
fn standards(examples: &[Example]) -> Vec<Standard> {
    let mut standards = Vec::with_capacity(SUMMARIES + 1);
    for index in 0..SUMMARIES + 1 {
        let values = examples
            .iter()
            .map(|example| example.description.values().nth(index));
        let Some(values) = values.collect::<Option<Vec<f64>>>() else {
            break;
        };
        let average = mean(&values);
        standards.push(Standard {
            mean: average,
            deviation: standard_deviation(&values, average).max(f64::MIN_POSITIVE),
        });
    }
    standards
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ensemble::summary::Summaries;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// The random profiles are divided into two halves, and a polynomial is fitted to each half.
    /// Both polynomials learn a relation of second degree.
    #[test]
    fn a_polynomial_of_second_degree_is_learned() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut random = || {
            let summaries: Summaries = std::array::from_fn(|_| generator.random_range(-1.0..1.0));
            Description {
                summaries,
                preload: Some(generator.random_range(5.0..6.0)),
            }
        };
        let parameters = |description: &Description| {
            let summaries = description.summaries;
            let [first, second] = [summaries[0], summaries[4]];
            let preload = description.preload.unwrap();
            [
                3.0 + first - 2.0 * second * preload,
                7.0 * first * first - second,
            ]
        };
        let curves: Vec<_> = (0..2000)
            .map(|index| {
                let description = random();
                // The parameters of one half of the profiles are off by 1, which the polynomial of
                // the other half does not learn.
                let [work, modulus] = parameters(&description);
                Example {
                    half: index % 2,
                    description,
                    parameters: [work + f64::from(u8::from(index % 2 == 0)), modulus],
                }
            })
            .collect();
        let learned = Polynomials::learned(&curves);
        let description = random();
        let [work, modulus] = parameters(&description);
        for (found, expected) in [
            (learned.of_profile(0, &description), [work, modulus]),
            (learned.of_profile(1, &description), [work + 1.0, modulus]),
            (learned.of_curve(&description), [work + 0.5, modulus]),
        ] {
            assert!(
                found
                    .iter()
                    .zip(expected)
                    .all(|(first, second)| (first - second).abs() < 0.01),
                "{found:?} {expected:?}"
            );
        }
    }
}
