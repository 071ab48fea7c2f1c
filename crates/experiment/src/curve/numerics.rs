//! Least-squares fits of straight lines, polynomials and combinations of columns.

use asperity_data::{mean, median};
use std::f64::consts::SQRT_2;

/// Factor between two measures of a normal distribution: its standard deviation divided by the
/// median of the absolute deviation from its mean.
pub(crate) const MEDIAN_TO_DEVIATION: f64 = 1.4826;
/// Smallest number of independent parts that a curve is assumed to have. It limits the number of
/// points over which correlations of the residuals are added up.
const RANGES: usize = 20;
/// Largest number of residuals that count as few. `LEAST_CORRELATED` is the smallest number of
/// residuals for which a correlation of neighbours is computed.
const FEW: usize = 200;
const LEAST_CORRELATED: usize = 12;
/// Largest correlation of neighbours that is assumed for few residuals.
const MOST_CORRELATED: f64 = 0.95;

/// Least-squares straight line through evenly spaced values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Baseline {
    count: f64,
    mean: f64,
    pub slope: f64,
    /// Standard deviation of the values from the line, in the unit of the values.
    pub noise: f64,
}

impl Baseline {
    pub fn through(values: &[f64]) -> Baseline {
        let count = values.len() as f64;
        let mean = mean(values);
        let middle = 0.5 * (count - 1.0);
        let mut product = 0.0;
        for (index, value) in values.iter().enumerate() {
            product += (index as f64 - middle) * value;
        }
        let slope = product / (count * (count * count - 1.0) / 12.0);
        let mut squares = 0.0;
        for (index, value) in values.iter().enumerate() {
            squares += (value - mean - slope * (index as f64 - middle)).powi(2);
        }
        Baseline {
            count,
            mean,
            slope,
            noise: (squares / (count - 2.0)).sqrt(),
        }
    }

    /// Returns the deviations of `values` from the line. The first value belongs to the first point
    /// of the line.
    pub fn residuals(self, values: &[f64]) -> Vec<f64> {
        let middle = 0.5 * (self.count - 1.0);
        values
            .iter()
            .enumerate()
            .map(|(index, value)| value - self.mean - self.slope * (index as f64 - middle))
            .collect()
    }
}

/// Returns the standard deviation of the noise, computed from the median difference of neighbouring
/// values. Slow changes and single jumps of the values do not increase this result.
pub(crate) fn noise_of_neighbours(values: &[f64]) -> f64 {
    let mut differences: Vec<f64> = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    median(&mut differences).unwrap_or(0.0) * MEDIAN_TO_DEVIATION / SQRT_2
}

/// Returns sums of squared residuals, one for each value. The residuals belong to a least-squares
/// polynomial with `terms` terms that is fitted to all values up to and including this value.
pub(crate) fn growing(values: impl ExactSizeIterator<Item = f64>, terms: usize) -> Vec<f64> {
    let count = values.len() as f64;
    let mut triangle = Triangle::default();
    let mut sums = Vec::with_capacity(values.len());
    let mut sum = 0.0;
    for (index, value) in values.enumerate() {
        let place = index as f64 / count;
        let residual = triangle.add([1.0, place, place * place, value], terms);
        sum += residual * residual;
        sums.push(sum);
    }
    sums
}

/// Triangular matrix of the least-squares fit of a polynomial. Its last column is for the values.
#[derive(Default)]
struct Triangle {
    rows: [[f64; 4]; 3],
}

impl Triangle {
    /// Adds a row to the triangle by Givens rotations. Returns the remainder of the fitted value of
    /// this row; its square is the increase of the sum of squared residuals.
    fn add(&mut self, mut row: [f64; 4], terms: usize) -> f64 {
        for (term, old_row) in self.rows.iter_mut().enumerate().take(terms) {
            let old = old_row[term];
            let new = row[term];
            let length = old.hypot(new);
            if length > 0.0 {
                let cosine = old / length;
                let sine = new / length;
                for column in term..4 {
                    let above = old_row[column];
                    let below = row[column];
                    old_row[column] = cosine * above + sine * below;
                    row[column] = cosine * below - sine * above;
                }
            }
        }
        row[3]
    }
}

/// Returns orthonormal columns that span the given columns. A column that is a linear combination
/// of the columns before it becomes zero.
pub(crate) fn right_angled(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
    for column in columns {
        let mut remainder = column.clone();
        let whole = dot(column, column).sqrt();
        subtract_all(&mut remainder, &basis);
        let length = dot(&remainder, &remainder).sqrt();
        // If a column depends on the columns before it, only rounding errors remain of it.
        let is_independent = length > 1e-9 * whole;
        for value in &mut remainder {
            *value = if is_independent { *value / length } else { 0.0 };
        }
        basis.push(remainder);
    }
    basis
}

/// Subtracts from the values their component along `column`, a vector of length 1, and returns this
/// component.
pub(crate) fn subtract(values: &mut [f64], column: &[f64]) -> f64 {
    let component = dot(values, column);
    for (value, direction) in values.iter_mut().zip(column) {
        *value -= component * direction;
    }
    component
}

/// Subtracts from the values their components along orthonormal columns, one after another.
pub(crate) fn subtract_all(values: &mut [f64], columns: &[Vec<f64>]) {
    for column in columns {
        subtract(values, column);
    }
}

/// Returns the scalar product of two columns, up to the length of the shorter column.
pub(crate) fn dot(first: &[f64], second: &[f64]) -> f64 {
    first.iter().zip(second).map(|(x, y)| x * y).sum()
}

/// Smallest and largest value of a set of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub low: f64,
    pub high: f64,
}

impl Extent {
    /// Returns the extent of the values. If there are no values, `low` is ∞ and `high` is −∞.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut extent = Extent {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        for value in values {
            extent.low = extent.low.min(value);
            extent.high = extent.high.max(value);
        }
        extent
    }

    pub fn width(self) -> f64 {
        self.high - self.low
    }
}

/// Returns the factor by which the variance of the mean of residuals is larger than for
/// uncorrelated residuals.
pub(crate) fn correlated(residuals: &[f64]) -> f64 {
    let square = dot(residuals, residuals);
    let least = 2.0 / (residuals.len() as f64).sqrt();
    let mut sum = 0.0;
    for lag in 1..residuals.len() / RANGES {
        let correlation = dot(residuals, &residuals[lag..]) / square;
        // If all residuals are 0, the correlation is NaN.
        if correlation.is_nan() || correlation <= least {
            break;
        }
        sum += correlation;
    }
    1.0 + 2.0 * sum
}

/// Returns the factor of [`correlated`], and for few residuals at least the factor of a first-order
/// autoregression, in which the correlation falls by the same ratio ρ from point to point: (1 +
/// ρ)/(1 − ρ). Few residuals have too few parts for the sum of [`correlated`] over many lags.
///
/// The correlation of neighbours in n residuals about their mean is expected to be ρ − (1 + 4ρ)/n
/// (Kendall, Biometrika 41, 403, 1954), for which ρ is corrected. Residuals whose correlation may
/// be chance are taken to be uncorrelated.
pub(crate) fn correlated_few(residuals: &[f64]) -> f64 {
    let factor = correlated(residuals);
    let count = residuals.len() as f64;
    if residuals.len() < LEAST_CORRELATED || residuals.len() > FEW {
        return factor;
    }
    let neighbours = dot(residuals, &residuals[1..]) / dot(residuals, residuals);
    if neighbours.is_nan() || neighbours <= 2.0 / count.sqrt() {
        return factor;
    }
    let ratio = (neighbours + 1.0 / count) / (1.0 - 4.0 / count);
    let ratio = ratio.min(MOST_CORRELATED);
    factor.max((1.0 + ratio) / (1.0 - ratio))
}

/// Coefficient of a column in a least-squares fit, with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Coefficient {
    pub value: f64,
    pub error: f64,
}

/// Fits a linear combination of columns to the values by least squares, and returns its
/// coefficients. `None` if a column is a linear combination of the columns before it.
pub(crate) fn least_squares(columns: &[Vec<f64>], values: &[f64]) -> Option<Vec<Coefficient>> {
    let basis = right_angled(columns);
    let mut residuals = values.to_vec();
    let components: Vec<f64> = basis
        .iter()
        .map(|column| subtract(&mut residuals, column))
        .collect();
    let count = columns.len();
    let degrees_of_freedom = (values.len().max(count + 1) - count) as f64;
    let square = correlated(&residuals) * dot(&residuals, &residuals);
    let noise = (square / degrees_of_freedom).sqrt();
    let triangle: Vec<Vec<f64>> = basis
        .iter()
        .map(|direction| {
            columns
                .iter()
                .map(|column| dot(direction, column))
                .collect()
        })
        .collect();

    // Back substitution, from the last column to the first.
    let mut coefficients = vec![Coefficient::default(); count];
    for index in (0..count).rev() {
        let diagonal = triangle[index][index];
        if diagonal.abs() <= 1e-6 * dot(&columns[index], &columns[index]).sqrt() {
            return None;
        }
        let later: f64 = (index + 1..count)
            .map(|other| triangle[index][other] * coefficients[other].value)
            .sum();
        let row = inverse_row(&triangle, index);
        coefficients[index] = Coefficient {
            value: (components[index] - later) / diagonal,
            error: noise * dot(&row, &row).sqrt(),
        };
    }
    Some(coefficients)
}

/// Returns the row with this index of the inverse of an upper triangular matrix.
fn inverse_row(triangle: &[Vec<f64>], index: usize) -> Vec<f64> {
    let mut row = vec![0.0; triangle.len()];
    row[index] = 1.0 / triangle[index][index];
    for column in index + 1..triangle.len() {
        let sum: f64 = (index..column)
            .map(|between| row[between] * triangle[between][column])
            .sum();
        row[column] = -sum / triangle[column][column];
    }
    row
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Returns the values with added noise, which is approximately normal and has the standard
    /// deviation `noise`.
    pub(crate) fn noisy(values: impl Iterator<Item = f64>, noise: f64, seed: u64) -> Vec<f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut gauss = || (0..12).map(|_| generator.random::<f64>()).sum::<f64>() - 6.0;
        values.map(|value| value + noise * gauss()).collect()
    }

    #[test]
    fn correlated_residuals_count_less() {
        // `smooth` is a sine with 16 points in a period. Below, the same values are also tried in
        // an order without correlation.
        let sine = |index: usize| (std::f64::consts::TAU * index as f64 / 16.0).sin();
        let smooth: Vec<f64> = (0..480).map(sine).collect();
        let factor = correlated(&smooth);
        // The expected factor is 1 + 2 Σ cos(2πn/16), summed up to the first term that is close to
        // 0.
        let expected: f64 = 1.0
            + 2.0
                * (1..4)
                    .map(|lag| sine(4 + lag) * (480 - lag) as f64 / 480.0)
                    .sum::<f64>();
        assert!(
            (factor / expected - 1.0).abs() < 0.01,
            "{factor} {expected}"
        );
        let turned: Vec<f64> = (0..480).map(|index| sine(index * index * 7)).collect();
        assert!(correlated(&turned) < 2.0, "{}", correlated(&turned));
        let alternating: Vec<f64> = (0..480).map(|index| [1.0, -1.0][index % 2]).collect();
        assert_eq!(correlated(&alternating), 1.0);
    }

    /// Over many series of an autoregression, the mean factor is near the true one, and
    /// uncorrelated residuals keep about 1. The sum over a few lags alone would give half of the
    /// true factor.
    #[test]
    fn few_correlated_residuals_count_by_an_autoregression() {
        for (count, ratio, least, most) in [
            (50, 0.0, 1.0, 1.1),
            (50, 0.5, 0.9, 1.3),
            (50, 0.8, 0.8, 1.6),
            (180, 0.0, 1.0, 1.1),
            (180, 0.8, 0.9, 1.3),
        ] {
            let mut sum = 0.0;
            for seed in 0..200 {
                let mut value = 0.0;
                let fresh = noisy(std::iter::repeat_n(0.0, count + 50), 1.0, seed);
                let mut series: Vec<f64> = Vec::new();
                for fresh in fresh {
                    value = ratio * value + fresh;
                    series.push(value);
                }
                let middle = asperity_data::mean(&series[50..]);
                let residuals: Vec<f64> = series[50..].iter().map(|value| value - middle).collect();
                sum += correlated_few(&residuals);
            }
            let expected = (1.0 + ratio) / (1.0 - ratio);
            let found = sum / 200.0 / expected;
            assert!((least..most).contains(&found), "{count} {ratio}: {found}");
        }
    }

    #[test]
    fn coefficients_are_found_with_their_errors() {
        let columns: Vec<Vec<f64>> = (0..3)
            .map(|power| {
                (0..400)
                    .map(|index| (f64::from(index) / 400.0).powi(power))
                    .collect()
            })
            .collect();
        let value = |index: usize| 1.0 - 2.0 * columns[1][index] + 3.0 * columns[2][index];
        let found = least_squares(&columns, &noisy((0..400).map(value), 0.1, 7)).unwrap();
        for (Coefficient { value, error }, expected) in found.into_iter().zip([1.0, -2.0, 3.0]) {
            assert!(
                (value - expected).abs() < 3.0 * error && error < 0.1,
                "{value} ± {error}"
            );
        }
        assert_eq!(
            least_squares(&[columns[0].clone(), columns[0].clone()], &columns[1]),
            None
        );
    }
}
