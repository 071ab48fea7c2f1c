//! Sums, means, quantiles, fitted straight lines, interpolation, quadrature, and Student's
//! distribution.

use std::cell::Cell;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// Sum in which rounding errors are compensated (method of Neumaier). For n terms t, the deviation
/// from the exact sum is below 2u |Σ t| + O(n u²) Σ |t|, where u = 2⁻⁵³.
///
/// ```
/// let mut sum = asperity_data::CompensatedSum::default();
/// [1.0, 1e100, 1.0, -1e100].into_iter().for_each(|term| sum.add(term));
/// assert_eq!(sum.total(), 2.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CompensatedSum {
    value: f64,
    error: f64,
}

impl CompensatedSum {
    /// Adds a term to the sum.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let sum = self.value + term;
        let added = sum - self.value;
        self.error += (self.value - (sum - added)) + (term - added);
        self.value = sum;
    }

    /// Returns the sum of all terms.
    pub fn total(self) -> f64 {
        self.value + self.error
    }
}

/// Returns the mean of the values; NaN for an empty slice.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the root mean square of the values; `None` if there are no values.
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut count = 0_u64;
    let mut squares = 0.0;
    for value in values {
        count += 1;
        squares += value.powi(2);
    }
    (count > 0).then(|| (squares / count as f64).sqrt())
}

/// Returns the sample standard deviation of n values, with the divisor n − 1. `mean` must be the
/// mean of these values. For fewer than two values the result is NaN.
pub fn standard_deviation(values: &[f64], mean: f64) -> f64 {
    let squares = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>();
    (squares / (values.len() as f64 - 1.0)).sqrt()
}

/// Returns the median of the values, whose order it changes. For an even number of values, the
/// median is the mean of the two middle values. Returns `None` if there are no values.
///
/// ```
/// assert_eq!(asperity_data::median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
/// ```
pub fn median(values: &mut [f64]) -> Option<f64> {
    let count = values.len();
    if count == 0 {
        return None;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(count / 2, f64::total_cmp);
    if !count.is_multiple_of(2) {
        return Some(upper);
    }
    let lower = below.iter().copied().reduce(f64::max)?;
    Some(f64::midpoint(lower, upper))
}

/// Returns a quantile of `ascending`, values in ascending order. A `share` of 0 gives the first
/// value, 0.5 the median, and 1 the last value. Between two values the quantile is interpolated
/// linearly. Returns `None` if there are no values, or if the share is below 0 or above 1.
///
/// ```
/// assert_eq!(asperity_data::quantile(&[0.0, 10.0, 20.0], 0.25), Some(5.0));
/// assert_eq!(asperity_data::quantile(&[], 0.25), None);
/// ```
pub fn quantile(ascending: &[f64], share: f64) -> Option<f64> {
    if !(0.0..=1.0).contains(&share) {
        return None;
    }
    let last = ascending.len().checked_sub(1)?;
    let place = share * last as f64;
    let lower = place as usize;
    let fraction = place - lower as f64;
    // The upper neighbour may be infinite. Multiplied by zero it would give NaN.
    if fraction == 0.0 {
        return Some(ascending[lower]);
    }
    Some(between(ascending[lower], ascending[lower + 1], fraction))
}

/// Returns the lower quartile, the median and the upper quartile of ascending values, in this
/// order. The quartiles are the [quantiles](quantile()) for the shares 0.25 and 0.75. Returns
/// `None` if there are no values.
///
/// ```
/// assert_eq!(asperity_data::quartiles(&[1.0, 2.0, 3.0, 4.0, 5.0]), Some([2.0, 3.0, 4.0]));
/// ```
pub fn quartiles(ascending: &[f64]) -> Option<[f64; 3]> {
    let lower = quantile(ascending, 0.25)?;
    let median = quantile(ascending, 0.5)?;
    let upper = quantile(ascending, 0.75)?;
    Some([lower, median, upper])
}

/// Interpolates linearly between the values `from` and `to`. A `share` of 0 gives `from`, and a
/// `share` of 1 gives `to`.
#[inline]
pub fn between(from: f64, to: f64, share: f64) -> f64 {
    from + share * (to - from)
}

/// Returns the slope of the least-squares line through points (x, y); `None` if there are fewer
/// than two different x.
///
/// ```
/// assert_eq!(asperity_data::slope(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]), Some(2.0));
/// ```
pub fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / count;
    let product: f64 = points
        .iter()
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    let square: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let slope = product / square;
    slope.is_finite().then_some(slope)
}

/// Returns the nodes of the Gauss-Legendre quadrature for an integral from −1 to 1, each with its
/// weight. `COUNT` is the number of nodes.
pub fn gauss_nodes<const COUNT: usize>() -> [(f64, f64); COUNT] {
    std::array::from_fn(|index| gauss_node(COUNT, index))
}

/// Returns the nodes of the Gauss-Legendre quadrature for an integral from 0 to π/2, each with its
/// weight. `COUNT` is the number of nodes.
pub fn gauss_nodes_on_quarter_circle<const COUNT: usize>() -> [(f64, f64); COUNT] {
    gauss_nodes().map(|(x, weight)| (0.5 * FRAC_PI_2 * (1.0 + x), 0.5 * FRAC_PI_2 * weight))
}

/// Returns a zero of the Legendre polynomial of this degree, with its weight in the Gauss-Legendre
/// quadrature. `index` counts the zeros from 0.
fn gauss_node(degree: usize, index: usize) -> (f64, f64) {
    let count = degree as f64;
    let mut x = (PI * (index as f64 + 0.75) / (count + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..20 {
        // `before` and `value` become the Legendre polynomials of the degrees k − 1 and k at x, by
        // their recurrence.
        let mut before = 1.0;
        let mut value = x;
        for k in 2..=degree {
            let k = k as f64;
            let next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
            before = value;
            value = next;
        }
        slope = count * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

thread_local! {
    /// Degrees of freedom and value of the last quantile that this thread computed. They are stored
    /// because most successive samples have the same size.
    static LAST_QUANTILE: Cell<(u32, f64)> = const { Cell::new((0, f64::NAN)) };
}

/// Returns the quantile of Student's distribution for intervals of 95 %. A variable t that has this
/// distribution lies between minus and plus the quantile with a probability of 95 %. `freedom` is
/// the number of degrees of freedom, at least 1.
pub fn student_quantile(freedom: u32) -> f64 {
    let (last_freedom, last_quantile) = LAST_QUANTILE.get();
    if last_freedom == freedom {
        return last_quantile;
    }
    let quantile = student_t(freedom);
    LAST_QUANTILE.set((freedom, quantile));
    quantile
}

/// Computes the quantile of [`student_quantile`] by bisection.
fn student_t(freedom: u32) -> f64 {
    let mut low = 0.0;
    let mut high = 16.0;
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if share_within(middle, freedom) < 0.95 {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Returns the probability that |t| is at most `t`, if t has Student's distribution with `freedom`
/// degrees of freedom (Abramowitz and Stegun, 26.7.3 and 26.7.4).
fn share_within(t: f64, freedom: u32) -> f64 {
    let angle = (t / f64::from(freedom).sqrt()).atan();
    let (sine, cosine) = angle.sin_cos();
    let is_odd = freedom % 2 == 1;
    // Sum over powers of the cosine, up to the power `freedom` − 2: the powers 1, 3, … if `freedom`
    // is odd, otherwise 0, 2, …
    let mut power = u32::from(is_odd);
    let mut term = if is_odd { cosine } else { 1.0 };
    let mut sum = 0.0;
    while power + 2 <= freedom {
        sum += term;
        power += 2;
        term *= cosine * cosine * f64::from(power - 1) / f64::from(power);
    }
    if is_odd {
        FRAC_2_PI * (angle + sine * sum)
    } else {
        sine * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A compensated sum keeps small terms even if a large term is added and later subtracted.
        #[test]
        fn a_sum_keeps_its_rounding_errors(power in 40..60_i32, small in 1e-3..1.0_f64, count in 1_u32..99) {
            let large = 2.0_f64.powi(power);
            let mut sum = CompensatedSum::default();
            (0..count).for_each(|_| [small, large, small].into_iter().for_each(|term| sum.add(term)));
            sum.add(-large * f64::from(count));
            prop_assert!((sum.total() / (2.0 * f64::from(count) * small) - 1.0).abs() < 1e-9, "{:?}", sum);
        }
    }

    proptest! {
        /// The quantile at `share` lies on the polygon through the points (k/(n − 1), value k) at
        /// the abscissa `share`. Here n is the number of values and k counts them from 0. The
        /// median is the quantile at 0.5. If there are no values, both are `None`.
        #[test]
        fn quantiles_lie_on_the_polygon_of_the_values(
            mut values in prop::collection::vec(-1e3..1e3_f64, 0..40),
            share in 0.0..=1.0_f64,
        ) {
            values.sort_by(f64::total_cmp);
            let found = quantile(&values, share);
            prop_assert_eq!(found.is_none(), values.is_empty());
            prop_assert_eq!(quartiles(&values).is_none(), values.is_empty());
            let middle = median(&mut values.clone());
            prop_assert_eq!(middle.is_none(), values.is_empty());
            if let (Some(found), Some(middle)) = (found, middle) {
                // The expected quantile is the first value plus the rise of each interval, each
                // multiplied by the part of the interval that lies below the share.
                let intervals = values.len() as f64 - 1.0;
                let mut expected = values[0];
                for (number, pair) in values.windows(2).enumerate() {
                    let covered = (share * intervals - number as f64).clamp(0.0, 1.0);
                    expected += covered * (pair[1] - pair[0]);
                }
                prop_assert!((found - expected).abs() < 1e-9, "{} {}", found, expected);
                let [_, half, _] = quartiles(&values).unwrap();
                prop_assert!((half - middle).abs() < 1e-12 * (1.0 + middle.abs()), "{} {}", half, middle);
            }
        }
    }

    #[test]
    fn quantiles_of_nothing_and_beyond_the_sample_are_none() {
        for share in [0.0, 0.5, 1.0] {
            assert_eq!(
                (quantile(&[], share), quantile(&[7.0], share)),
                (None, Some(7.0))
            );
        }
        for share in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(quantile(&[1.0, 2.0], share), None, "{share}");
        }
        assert_eq!(quartiles(&[]), None);
        assert_eq!(quantile(&[1.0, 2.0, f64::INFINITY], 0.5), Some(2.0));
    }

    #[test]
    fn samples_have_moments_and_quantiles() {
        let values = [4.0, 1.0, 2.0, 3.0, 10.0];
        assert_eq!(
            (mean(&values), standard_deviation(&values, 4.0)),
            (4.0, 12.5_f64.sqrt())
        );
        assert_eq!(
            (root_mean_square([3.0, 4.0, 0.0, 0.0]), root_mean_square([])),
            (Some(2.5), None)
        );
        for (mut values, expected) in [
            (vec![], None),
            (vec![3.0], Some(3.0)),
            (vec![9.0, 1.0, 2.0], Some(2.0)),
            (vec![4.0, 1.0, 2.0, 9.0], Some(3.0)),
        ] {
            assert_eq!(median(&mut values), expected);
        }
        assert_eq!(
            [0.0, 0.25, 0.5, 1.0].map(|share| quantile(&[1.0, 2.0, 4.0], share)),
            [1.0, 1.5, 2.0, 4.0].map(Some)
        );
        assert_eq!(slope(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]), Some(2.0));
        assert_eq!(slope(&[(1.0, 1.0), (1.0, 3.0)]), None);
    }

    #[test]
    fn quantiles_of_student_are_those_of_the_tables() {
        for (freedom, expected) in [
            (1, 12.706_204_736),
            (2, 4.302_652_730),
            (3, 3.182_446_305),
            (4, 2.776_445_105),
            (9, 2.262_157_163),
            (31, 2.039_513_446),
            (100, 1.983_971_519),
            (1000, 1.962_339_081),
        ] {
            let t = student_t(freedom);
            assert!((t - expected).abs() < 2e-9 * expected, "{freedom}: {t}");
        }
    }

    #[test]
    fn nodes_integrate_polynomials() {
        for power in 0..18_i32 {
            let found: f64 = gauss_nodes::<9>()
                .iter()
                .map(|(x, weight)| weight * x.powi(power))
                .sum();
            let expected = if power % 2 == 0 {
                2.0 / f64::from(power + 1)
            } else {
                0.0
            };
            assert!((found - expected).abs() < 1e-14, "{power}: {found}");
        }
        let sine: f64 = gauss_nodes_on_quarter_circle::<9>()
            .iter()
            .map(|(angle, weight)| weight * angle.sin())
            .sum();
        assert!((sine - 1.0).abs() < 1e-14);
    }
}
