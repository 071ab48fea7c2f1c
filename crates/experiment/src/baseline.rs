//! Least-squares lines, polynomials and combinations of columns.

use asperity_data::mean;

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
