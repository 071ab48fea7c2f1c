//! Probability of the parameters γ and E*. The mean prediction over the measured curves is compared
//! with the predictions over the random profiles of a table.

use super::posterior::{Extent, Limits, Posterior};
use super::scatter::Scatter;
use super::table::{MODULUS, Place, Table, WORK};

/// Largest number of grids that are tried, each finer or wider than the previous one.
const MOST_GRIDS: usize = 60;

/// Distribution of the predictions over random profiles, from which the probability of the
/// parameters is computed.
pub(crate) struct Likelihood {
    scatter: Scatter,
    limits: Limits,
    /// Number of random profiles of the table.
    profiles: f64,
}

/// Mean over the measured curves of the predicted parameters.
struct Observed {
    /// ln γ and ln E*.
    prediction: [f64; 2],
    /// Variance of the difference between this mean and the mean of the table, in units of the
    /// variance of one profile.
    variance: f64,
}

impl Likelihood {
    /// Prepares the comparison of measured curves with a table of computed curves. `known` is ln E*
    /// if the effective modulus E* is given; only pairs of parameters with this value are then
    /// compared.
    pub fn new(table: &Table, scatter: &Scatter, known: Option<f64>) -> Self {
        let moduli = match known {
            Some(modulus) => Extent {
                low: modulus,
                high: modulus,
            },
            None => Extent::of(&table.moduli),
        };
        Likelihood {
            scatter: scatter.clone(),
            limits: Limits {
                ranges: Extent::of(&table.ranges),
                moduli,
            },
            profiles: table.profiles.len() as f64,
        }
    }

    /// Returns the probability of each pair of ln γ and ln E*, if the mean of the values predicted
    /// from `curves` measured curves is `prediction`. The prior is flat over ln γ and ln E*. The
    /// error of the mean has three sources: the number of curves, the number of random profiles,
    /// and the finite distances between the points of a curve, because of which its summaries
    /// change in steps.
    ///
    /// The probabilities are computed on a grid. The first grid covers the whole table. The next
    /// grids are narrowed to the values with more than negligible probability, or widened where the
    /// probability does not end within the grid, until no value of a parameter has more than a
    /// small part of the probability.
    pub fn posterior(&self, prediction: [f64; 2], curves: f64) -> Posterior {
        let observed = Observed {
            prediction,
            variance: 1.0 / curves + 1.0 / self.profiles,
        };
        let whole = self.limits.extents();
        let mut extents = whole;
        let mut posterior = self.on_grid(&observed, extents);
        for _ in 1..MOST_GRIDS {
            let next = [WORK, MODULUS].map(|axis| posterior.next_extent(axis, whole[axis]));
            if next == extents {
                break;
            }
            extents = next;
            posterior = self.on_grid(&observed, extents);
        }
        posterior
    }

    /// Computes the probability on a grid over these values of ln γ and ln E*.
    fn on_grid(&self, observed: &Observed, extents: [Extent; 2]) -> Posterior {
        let [works, moduli] = extents.map(Extent::values);
        let mut weights = Vec::with_capacity(works.len() * moduli.len());
        for work in &works {
            for modulus in &moduli {
                let place = Place {
                    range: work - modulus,
                    modulus: *modulus,
                };
                weights.push(self.logarithm(observed, place));
            }
        }
        let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        for weight in &mut weights {
            *weight = (*weight - largest).exp();
            sum += *weight;
        }
        for weight in &mut weights {
            *weight /= sum;
        }
        Posterior {
            axes: [works, moduli],
            weights,
            limits: self.limits,
        }
    }

    /// Returns the logarithm of the probability density at a place, up to a constant. It is
    /// Student's t-distribution, and not a normal distribution, because the covariance from few
    /// profiles is uncertain.
    fn logarithm(&self, observed: &Observed, place: Place) -> f64 {
        let Extent { low, high } = self.limits.ranges;
        let rounding = 1e-9;
        if place.range < low - rounding || place.range > high + rounding {
            return f64::NEG_INFINITY;
        }
        let errors = self.scatter.error_of_steps(place);
        let moments = self.scatter.at(place);
        let moments = moments.with_errors(observed.variance, errors);
        let inverse = moments.inverse();
        let square = inverse.squared_distance(moments.mean, observed.prediction);
        -0.5 * inverse.log_determinant
            - 0.5 * self.profiles * (square / (self.profiles - 1.0)).ln_1p()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ensemble::estimate::IntervalEstimate;
    use crate::fit::ensemble::summary::SUMMARIES;
    use crate::fit::ensemble::table::End;

    /// Returns a likelihood in which the predictions are the parameters plus deviations. Over the
    /// profiles the deviations have the standard deviation `deviation` and the correlation
    /// `correlation` between ln γ and ln E*.
    fn likelihood(
        deviation: f64,
        correlation: f64,
        known: Option<f64>,
        profiles: usize,
    ) -> Likelihood {
        let axis = |count: u8, step: f64| {
            (0..count)
                .map(|index| step * f64::from(index) - 1.5)
                .collect()
        };
        let moduli = known.map_or_else(|| axis(7, 0.5), |modulus| vec![modulus]);
        let mut table = Table {
            ranges: axis(16, 0.2),
            moduli,
            profiles: Vec::new(),
        };
        let places: Vec<Place> = table.places();
        table.profiles = vec![vec![[0.0; SUMMARIES]; places.len()]; profiles];
        // Each profile has two uncorrelated deviations of this size.
        let size = deviation * ((profiles - 1) as f64 / profiles as f64).sqrt();
        let sign = |is_positive: bool| if is_positive { size } else { -size };
        let scatter = Scatter::of(&table, |profile, node| {
            let [work, modulus] = places[node].parameters();
            let [one, other] = [sign(profile % 2 == 0), sign(profile / 2 % 2 == 0)];
            if known.is_some() {
                return [work + one, 0.0];
            }
            [
                work + one,
                modulus + correlation * one + (1.0 - correlation * correlation).sqrt() * other,
            ]
        });
        Likelihood::new(&table, &scatter, known)
    }

    /// Asserts that the estimate of a parameter and its interval are those of a normal
    /// distribution.
    fn assert_normal(found: IntervalEstimate, mean: f64, error: f64) {
        assert!(
            found.low < found.value && found.value < found.high,
            "{found:?}"
        );
        assert!(
            (found.value.ln() - mean).abs() < 0.01 * error,
            "{found:?}: {mean} {error}"
        );
        for (end, sign) in [(found.low, -1.0), (found.high, 1.0)] {
            let expected = mean + sign * 1.96 * error;
            assert!(
                (end.ln() - expected).abs() < 0.02 * error,
                "{found:?}: {mean} {error}"
            );
        }
    }

    /// The intervals are those of normal distributions. The scatter is from a ten-thousandth of a
    /// step of the table to a whole step, without correlation and with strong correlation.
    #[test]
    fn intervals_have_the_errors_of_curves_and_profiles() {
        for deviation in [1e-5, 1e-4, 1e-3, 5e-3, 0.02, 0.1, 0.2] {
            let error = deviation * (1.0_f64 / 8.0 + 1.0 / 1000.0).sqrt();
            for place in [0.1, 0.100_37, -0.731] {
                for correlation in [0.0, 0.9, 0.99, -0.95] {
                    let both = likelihood(deviation, correlation, None, 1000);
                    let posterior = both.posterior([place, 0.03], 8.0);
                    assert_normal(posterior.estimate(0), place, error);
                    assert_normal(posterior.estimate(1), 0.03, error);
                    assert_eq!(posterior.beyond(), []);
                    assert!(
                        (posterior.correlation() - correlation).abs() < 0.01,
                        "{deviation} {correlation}"
                    );
                    let best = posterior.best();
                    let [work, modulus] = best.parameters();
                    assert!(
                        (work - place).abs().max((modulus - 0.03).abs()) < 0.5 * error,
                        "{best:?}"
                    );
                }
                let one = likelihood(deviation, 0.0, Some(0.3), 1000);
                let posterior = one.posterior([place, 0.0], 8.0);
                assert_normal(posterior.estimate(0), place, error);
                assert_eq!(posterior.correlation(), 0.0);
            }
        }
    }

    /// If the table cuts off the probability, or the probability fills the whole table, the
    /// interval lies within the table.
    #[test]
    fn intervals_end_with_the_table() {
        for (deviation, work, modulus) in [
            (30.0, 0.0, 0.0),
            (0.2, 4.0, 0.0),
            (0.01, -2.9, -1.6),
            (3.0, 0.0, -3.0),
        ] {
            let posterior = likelihood(deviation, 0.5, None, 64).posterior([work, modulus], 2.0);
            assert!(!posterior.beyond().is_empty());
            for (parameter, [least, most]) in [[-3.0_f64, 3.0], [-1.5, 1.5]].into_iter().enumerate()
            {
                let IntervalEstimate { value, low, high } = posterior.estimate(parameter);
                assert!(
                    least <= low.ln() && low < value && value < high && high.ln() <= most,
                    "{low} {value} {high}"
                );
            }
        }
    }

    #[test]
    fn ends_of_the_table_are_named_and_errors_add_in_quadrature() {
        let likelihood = likelihood(0.2, 0.0, None, 64);
        assert_eq!(
            likelihood.posterior([1.4, -0.1], 8.0).beyond(),
            [End::HighRange]
        );
        assert_eq!(
            likelihood.posterior([0.0, -1.4], 8.0).beyond(),
            [End::HighRange, End::LowModulus]
        );
        let widened = IntervalEstimate {
            value: 1.0,
            low: (-0.3_f64).exp(),
            high: 0.4_f64.exp(),
        }
        .widened(0.3);
        assert!(
            (widened.low.ln() + 0.3_f64.hypot(0.3)).abs() < 1e-12
                && (widened.high.ln() - 0.5).abs() < 1e-12
        );
    }
}
