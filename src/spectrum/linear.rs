//! Least squares: straight lines, and small symmetric systems of equations.

/// Cholesky factor of a symmetric positive definite matrix.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cholesky {
    size: usize,
    /// Lower triangle, row by row of the full matrix.
    factor: Vec<f64>,
}

impl Cholesky {
    /// Factor of a matrix of `size` rows, from its lower triangle. `None` unless the matrix is positive definite.
    pub fn new(mut matrix: Vec<f64>, size: usize) -> Option<Self> {
        for row in 0..size {
            for column in 0..=row {
                let sum: f64 = (0..column).map(|k| matrix[row * size + k] * matrix[column * size + k]).sum();
                let rest = matrix[row * size + column] - sum;
                matrix[row * size + column] = if row > column {
                    rest / matrix[column * size + column]
                } else if rest > 0.0 && rest.is_finite() {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Cholesky { size, factor: matrix })
    }

    /// Solution of the system with this right-hand side.
    pub fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let at = |row: usize, column: usize| self.factor[row * self.size + column];
        for row in 0..self.size {
            let sum: f64 = (0..row).map(|k| at(row, k) * right[k]).sum();
            right[row] = (right[row] - sum) / at(row, row);
        }
        self.solve_transposed(right)
    }

    /// Solution of Lᵀ x = b with the factor L. For independent normal b of variance 1 it has the covariance M⁻¹.
    pub fn solve_transposed(&self, mut right: Vec<f64>) -> Vec<f64> {
        let at = |row: usize, column: usize| self.factor[row * self.size + column];
        for row in (0..self.size).rev() {
            let sum: f64 = (row + 1..self.size).map(|k| at(k, row) * right[k]).sum();
            right[row] = (right[row] - sum) / at(row, row);
        }
        right
    }

    /// √(M⁻¹)ᵢᵢ: the standard error of a parameter, if M is an information matrix.
    pub fn standard_error(&self, index: usize) -> f64 {
        let mut gradient = vec![0.0; self.size];
        gradient[index] = 1.0;
        self.variance(&gradient).sqrt()
    }

    /// vᵀ M⁻¹ v for a vector v: the variance of a quantity with the gradient v, if M is an information matrix.
    pub fn variance(&self, gradient: &[f64]) -> f64 {
        let solved = self.solve(gradient.to_vec());
        gradient.iter().zip(solved).map(|(a, b)| a * b).sum()
    }
}

/// Slope of the straight line of least squares through some points; `None` for fewer than two different points.
pub(crate) fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let product: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let square: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    Some(product / square).filter(|slope| slope.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved() {
        let matrix = vec![4.0, 0.0, 0.0, 2.0, 5.0, 0.0, 1.0, 3.0, 6.0];
        let factor = Cholesky::new(matrix, 3).unwrap();
        // The matrix times (1, −2, 3).
        let solution = factor.solve(vec![4.0 - 4.0 + 3.0, 2.0 - 10.0 + 9.0, 1.0 - 6.0 + 18.0]);
        for (found, expected) in solution.iter().zip([1.0, -2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14, "{solution:?}");
        }
        assert!((Cholesky::new(vec![4.0], 1).unwrap().variance(&[3.0]) - 9.0 / 4.0).abs() < 1e-15);
        assert_eq!(Cholesky::new(vec![1.0, 0.0, 2.0, 1.0], 2), None);
        assert_eq!(Cholesky::new(vec![f64::NAN], 1), None);
    }
}
