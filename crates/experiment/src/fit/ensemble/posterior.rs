//! Probability distribution of the parameters γ and E* on a grid, and the estimates that follow
//! from the distribution.

use super::estimate::IntervalEstimate;
use super::table::{End, MODULUS, Place, WORK};

/// Number of cells of a grid along each axis.
const CELLS: usize = 96;
/// Largest allowed probability of one value of an axis. If a value has a larger probability, the
/// grid is too coarse and is replaced by a finer one. A normal distribution has this probability at
/// its mean if the step of the axis is a fifth of the standard deviation.
const MOST_AT_VALUE: f64 = 0.08;
/// Probability of one value of an axis below which the value counts as outside the distribution.
const NEGLIGIBLE: f64 = 1e-7;
/// Number of values that a finer grid keeps on each side, beyond the values with more than
/// negligible probability. The margin is needed because on a coarse grid the largest probability of
/// a narrow ridge may be some values away from the true maximum.
const MARGIN: usize = 8;
/// Smallest step of a grid. With a smaller step the values of an axis would differ only by rounding
/// errors.
const LEAST_STEP: f64 = 1e-12;
/// Largest allowed probability of the values within [`EDGE`] of an end of the table. If their
/// probability is larger, the table is too short.
const MOST_AT_END: f64 = 2e-3;
/// Width of the edge of the table, as a difference of natural logarithms.
const EDGE: f64 = 0.1;
/// Smallest probability density, divided by the largest density, of a value that is not excluded at
/// the level of 5 %: exp(−1.96²/2).
const NOT_EXCLUDED: f64 = 0.146_5;
/// Quantiles of the lower end of the 95 % interval, of the estimate (the median), and of the upper
/// end.
const QUANTILES: [f64; 3] = [0.025, 0.5, 0.975];

/// Ranges of the parameters for which a table has computed curves.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Smallest and largest ln(γ/E*), with γ/E* in m.
    pub ranges: Extent,
    /// Smallest and largest ln E*, with E* in Pa. Both are equal if E* is given.
    pub moduli: Extent,
}

impl Limits {
    /// Returns the ranges of ln γ and of ln E* that contain all values in the table.
    pub fn extents(self) -> [Extent; 2] {
        let works = Extent {
            low: self.ranges.low + self.moduli.low,
            high: self.ranges.high + self.moduli.high,
        };
        [works, self.moduli]
    }

    /// Returns true if a place, a pair of parameters, is near this end of the table.
    fn is_near(self, place: Place, end: End) -> bool {
        let is_modulus_free = self.moduli.high > self.moduli.low;
        match end {
            End::LowRange => place.range < self.ranges.low + EDGE,
            End::HighRange => place.range > self.ranges.high - EDGE,
            End::LowModulus => is_modulus_free && place.modulus < self.moduli.low + EDGE,
            End::HighModulus => is_modulus_free && place.modulus > self.moduli.high - EDGE,
        }
    }
}

/// Interval of values of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub low: f64,
    pub high: f64,
}

/// Probability of the parameters on a grid over ln γ and ln E*.
pub(crate) struct Posterior {
    /// Evenly spaced values of ln γ and of ln E*, with γ in J/m² and E* in Pa.
    pub axes: [Vec<f64>; 2],
    /// Probability of each pair of values. All pairs with the first value of ln γ come first, in
    /// the order of ln E*.
    pub weights: Vec<f64>,
    pub limits: Limits,
}

impl Extent {
    pub fn of(axis: &[f64]) -> Self {
        Extent {
            low: axis[0],
            high: axis[axis.len() - 1],
        }
    }

    fn width(self) -> f64 {
        self.high - self.low
    }

    /// Returns evenly spaced values over this interval, as the axis of a grid. Returns a single
    /// value if the width of the interval is 0.
    pub fn values(self) -> Vec<f64> {
        if self.width() == 0.0 {
            return vec![self.low];
        }
        (0..=CELLS)
            .map(|index| self.low + self.width() * index as f64 / CELLS as f64)
            .collect()
    }
}

impl Posterior {
    /// Returns the pair of parameters of each weight, in the order of the weights.
    fn nodes(&self) -> impl Iterator<Item = Place> {
        let [works, moduli] = &self.axes;
        works.iter().flat_map(move |work| {
            moduli.iter().map(move |modulus| Place {
                range: work - modulus,
                modulus: *modulus,
            })
        })
    }

    /// Returns the probability of each value of an axis.
    fn along(&self, axis: usize) -> Vec<f64> {
        let moduli = self.axes[MODULUS].len();
        let mut sums = vec![0.0; self.axes[axis].len()];
        for (index, weight) in self.weights.iter().enumerate() {
            let value = if axis == WORK {
                index / moduli
            } else {
                index % moduli
            };
            sums[value] += weight;
        }
        sums
    }

    /// Returns the range of an axis for the next grid. The range lies within the range `whole` of
    /// the table. It is unchanged if this grid is already fine and wide enough.
    pub fn next_extent(&self, axis: usize, whole: Extent) -> Extent {
        let values = &self.axes[axis];
        let last = values.len() - 1;
        let present = Extent::of(values);
        if last == 0 {
            return present;
        }
        let probabilities = self.along(axis);
        let is_present = |probability: &f64| *probability > NEGLIGIBLE;
        let first_present = probabilities.iter().position(is_present).unwrap_or(0);
        let last_present = probabilities.iter().rposition(is_present).unwrap_or(last);
        let grows_below = first_present == 0 && present.low > whole.low;
        let grows_above = last_present == last && present.high < whole.high;
        if grows_below || grows_above {
            let mut wider = present;
            if grows_below {
                wider.low -= present.width();
            }
            if grows_above {
                wider.high += present.width();
            }
            return Extent {
                low: wider.low.max(whole.low),
                high: wider.high.min(whole.high),
            };
        }
        let most = probabilities.iter().copied().fold(0.0, f64::max);
        if most <= MOST_AT_VALUE || present.width() < LEAST_STEP * CELLS as f64 {
            return present;
        }
        Extent {
            low: values[first_present.saturating_sub(MARGIN)],
            high: values[(last_present + MARGIN).min(last)],
        }
    }

    /// Returns the most probable pair of ln γ and ln E*.
    pub fn best(&self) -> Place {
        let weights = self.weights.iter().enumerate();
        let best = weights.max_by(|(_, weight), (_, next)| weight.total_cmp(next));
        let index = best.map_or(0, |(index, _)| index);
        let moduli = self.axes[MODULUS].len();
        let work = self.axes[WORK][index / moduli];
        let modulus = self.axes[MODULUS][index % moduli];
        Place {
            range: work - modulus,
            modulus,
        }
    }

    /// Returns the estimate of a parameter: of γ in J/m² for [`WORK`], or of E* in Pa for
    /// [`MODULUS`].
    pub fn estimate(&self, parameter: usize) -> IntervalEstimate {
        let probabilities = self.along(parameter);
        let [low, value, high] =
            QUANTILES.map(|share| quantile(&self.axes[parameter], &probabilities, share).exp());
        IntervalEstimate { value, low, high }
    }

    /// Returns the largest γ in J/m² that the curves do not exclude at a significance level of 5 %.
    /// The probability density at this γ is exp(−1.96²/2) times the largest density.
    pub fn most_work(&self) -> f64 {
        let densities = self.along(WORK);
        let largest = densities.iter().copied().fold(0.0, f64::max);
        let last = densities
            .iter()
            .rposition(|density| *density >= NOT_EXCLUDED * largest);
        self.axes[WORK][last.unwrap_or(densities.len() - 1)].exp()
    }

    /// Returns the mean of a function of ln γ and ln E* over the probability distribution.
    fn mean(&self, value_of: impl Fn(f64, f64) -> f64) -> f64 {
        let [works, moduli] = &self.axes;
        let mut sum = 0.0;
        for (index, weight) in self.weights.iter().enumerate() {
            sum += weight * value_of(works[index / moduli.len()], moduli[index % moduli.len()]);
        }
        sum
    }

    /// Returns the correlation of ln γ and ln E*; 0 for a known E*.
    pub fn correlation(&self) -> f64 {
        if self.axes[MODULUS].len() == 1 {
            return 0.0;
        }
        let mean_work = self.mean(|work, _| work);
        let mean_modulus = self.mean(|_, modulus| modulus);
        let variance_of_work = self.mean(|work, _| (work - mean_work).powi(2));
        let variance_of_modulus = self.mean(|_, modulus| (modulus - mean_modulus).powi(2));
        let covariance = self.mean(|work, modulus| (work - mean_work) * (modulus - mean_modulus));
        let scale = (variance_of_work * variance_of_modulus).sqrt();
        if scale > 0.0 {
            (covariance / scale).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// Returns those ends of the table beyond which the parameters may lie, because the probability
    /// near them is large.
    pub fn beyond(&self) -> Vec<End> {
        let mut ends = vec![
            End::LowRange,
            End::HighRange,
            End::LowModulus,
            End::HighModulus,
        ];
        ends.retain(|end| self.probability_near(*end) > MOST_AT_END);
        ends
    }

    /// Returns the probability of all pairs of parameters near an end of the table.
    fn probability_near(&self, end: End) -> f64 {
        let mut sum = 0.0;
        for (place, weight) in self.nodes().zip(&self.weights) {
            if self.limits.is_near(place, end) {
                sum += weight;
            }
        }
        sum
    }
}

/// Returns the value below which a parameter lies with the probability `share`. The density is
/// linear between the values of the axis, at which it is in proportion to `probabilities`.
fn quantile(values: &[f64], probabilities: &[f64], share: f64) -> f64 {
    let cells: Vec<f64> = probabilities
        .windows(2)
        .map(|ends| 0.5 * (ends[0] + ends[1]))
        .collect();
    let mut remainder = share * cells.iter().sum::<f64>();
    for (index, cell) in cells.iter().enumerate() {
        if remainder <= *cell {
            let from = probabilities[index];
            let to = probabilities[index + 1];
            // `root` is part of the positive solution x of from·x + (to − from)·x²/2 = remainder,
            // written so that it loses no digits if `from` and `to` are nearly equal.
            let root = (from * from + 2.0 * (to - from) * remainder)
                .max(0.0)
                .sqrt();
            let part = if from + root > 0.0 {
                2.0 * remainder / (from + root)
            } else {
                0.0
            };
            return values[index] + part.clamp(0.0, 1.0) * (values[index + 1] - values[index]);
        }
        remainder -= cell;
    }
    values[values.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_a_density_that_is_linear_between_values() {
        // The density x from 0 to 2 has the distribution x²/4, and the density 2 − x is its mirror
        // image.
        for share in [0.0_f64, 0.01, 0.25, 0.3, 0.9, 1.0] {
            let rising = quantile(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0], share);
            assert!(
                (rising - 2.0 * share.sqrt()).abs() < 1e-12,
                "{share}: {rising}"
            );
            let falling = quantile(&[0.0, 1.0, 2.0], &[2.0, 1.0, 0.0], share);
            assert!(
                (falling - (2.0 - 2.0 * (1.0 - share).sqrt())).abs() < 1e-7,
                "{share}: {falling}"
            );
        }
        assert_eq!(quantile(&[5.0], &[1.0], 0.5), 5.0);
    }
}
