//! Least-squares lines, polynomials and combinations of columns.

use asperity_data::mean;

/// Smallest number of independent ranges that a curve is assumed to have.
const RANGES: usize = 20;

/// Least-squares line through evenly spaced values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Baseline {
    count: f64,
    pub mean: f64,
    pub slope: f64,
    /// Standard deviation of the values about the line.
    pub noise: f64,
}

impl Baseline {
    pub fn through(values: &[f64]) -> Baseline {
        let count = values.len() as f64;
        let place = |index: usize| index as f64 - 0.5 * (count - 1.0);
        let mean = mean(values);
        let product: f64 = values
            .iter()
            .enumerate()
            .map(|(index, value)| place(index) * value)
            .sum();
        let slope = product / (count * (count * count - 1.0) / 12.0);
        let rest = |(index, value): (usize, &f64)| (value - mean - slope * place(index)).powi(2);
        let noise = (values.iter().enumerate().map(rest).sum::<f64>() / (count - 2.0)).sqrt();
        Baseline {
            count,
            mean,
            slope,
            noise,
        }
    }

    /// Returns the deviations of `values` from the line. The first value lies at the beginning of
    /// the line.
    pub fn rests(self, values: &[f64]) -> impl Iterator<Item = f64> {
        let middle = 0.5 * (self.count - 1.0);
        values
            .iter()
            .enumerate()
            .map(move |(index, value)| value - self.mean - self.slope * (index as f64 - middle))
    }
}

/// Returns the sums of squared residuals of least-squares polynomials with `terms` terms. The first
/// sum belongs to the first value, the second to the first two values, and so on. Each new row is
/// rotated into the triangular matrix of the rows before.
pub(crate) fn growing(values: impl ExactSizeIterator<Item = f64>, terms: usize) -> Vec<f64> {
    let count = values.len() as f64;
    let (mut triangle, mut sum) = ([[0.0; 4]; 3], 0.0);
    let add = |(index, value): (usize, f64)| {
        let at = index as f64 / count;
        let mut row = [1.0, at, at * at, value];
        for term in 0..terms {
            let (old, new): (f64, f64) = (triangle[term][term], row[term]);
            let length = old.hypot(new);
            if length > 0.0 {
                let (cosine, sine) = (old / length, new / length);
                for column in term..4 {
                    let (above, below) = (triangle[term][column], row[column]);
                    triangle[term][column] = cosine * above + sine * below;
                    row[column] = cosine * below - sine * above;
                }
            }
        }
        sum += row[3] * row[3];
        sum
    };
    values.enumerate().map(add).collect()
}

/// Returns orthonormal columns that span the given columns. A column that depends on the columns
/// before it becomes zero.
pub(crate) fn right_angled(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let mut column = column.clone();
        let whole = dot(&column, &column).sqrt();
        basis.iter().for_each(|other| {
            take_off(&mut column, other);
        });
        let length = dot(&column, &column).sqrt();
        // What remains of a column that depends on the others is rounding.
        let is_other = length > 1e-9 * whole;
        column
            .iter_mut()
            .for_each(|one| *one = if is_other { *one / length } else { 0.0 });
        basis.push(column);
    }
    basis
}

/// Subtracts from the values their component along a column of length 1, and returns the component.
pub(crate) fn take_off(values: &mut [f64], column: &[f64]) -> f64 {
    let along = dot(values, column);
    values
        .iter_mut()
        .zip(column)
        .for_each(|(value, one)| *value -= along * one);
    along
}

/// Sum of the products of two columns, up to the length of the shorter one.
pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// Smallest and largest of the values.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Returns the factor by which correlation of the residuals along the curve increases the variance
/// of their mean; 1 without correlation.
pub(crate) fn correlated(residuals: &[f64]) -> f64 {
    let square = dot(residuals, residuals);
    let least = 2.0 / (residuals.len() as f64).sqrt();
    let correlations =
        (1..residuals.len() / RANGES).map(|lag| dot(residuals, &residuals[lag..]) / square);
    1.0 + 2.0
        * correlations
            .take_while(|correlation| *correlation > least)
            .sum::<f64>()
}

/// Returns least-squares coefficients of columns for these values, with standard errors; `None` if
/// a column depends on the columns before it.
pub(crate) fn least_squares(columns: &[Vec<f64>], values: &[f64]) -> Option<Vec<(f64, f64)>> {
    let basis = right_angled(columns);
    let mut rests = values.to_vec();
    let along: Vec<f64> = basis
        .iter()
        .map(|column| take_off(&mut rests, column))
        .collect();
    let count = (values.len().max(columns.len() + 1) - columns.len()) as f64;
    let noise = (correlated(&rests) * dot(&rests, &rests) / count).sqrt();
    // Back from the columns at right angles: each coefficient, and its share of each error.
    let mut found = vec![(0.0, 0.0); columns.len()];
    let triangle: Vec<Vec<f64>> = basis
        .iter()
        .map(|one| columns.iter().map(|column| dot(one, column)).collect())
        .collect();
    for index in (0..columns.len()).rev() {
        let own = triangle[index][index];
        if own.abs() <= 1e-6 * dot(&columns[index], &columns[index]).sqrt() {
            return None;
        }
        let others: f64 = (index + 1..columns.len())
            .map(|other| triangle[index][other] * found[other].0)
            .sum();
        let value = (along[index] - others) / own;
        // Squares of a row of the inverse of the triangle.
        let mut row = vec![0.0; columns.len()];
        row[index] = 1.0 / own;
        for other in index + 1..columns.len() {
            let sum: f64 = (index..other)
                .map(|between| row[between] * triangle[between][other])
                .sum();
            row[other] = -sum / triangle[other][other];
        }
        found[index] = (value, noise * dot(&row, &row).sqrt());
    }
    Some(found)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Values of a curve with normal noise of this standard deviation.
    pub(crate) fn noisy(values: impl Iterator<Item = f64>, noise: f64, seed: u64) -> Vec<f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut gauss = || (0..12).map(|_| generator.random::<f64>()).sum::<f64>() - 6.0;
        values.map(|value| value + noise * gauss()).collect()
    }

    #[test]
    fn correlated_residuals_count_less() {
        // Sines of 16 points a period, and their values in an order without correlation.
        let sine = |index: usize| (std::f64::consts::TAU * index as f64 / 16.0).sin();
        let smooth: Vec<f64> = (0..480).map(sine).collect();
        let factor = correlated(&smooth);
        // 1 + 2 Σ cos(2πn/16) up to the first that is close to 0.
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
        for ((value, error), expected) in found.into_iter().zip([1.0, -2.0, 3.0]) {
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
