//! Systems of a few linear equations with a symmetric matrix.

/// Cholesky factor of a symmetric positive definite matrix M: the lower triangular matrix L for
/// which M = L Lᵀ.
///
/// ```
/// use asperity_data::Cholesky;
///
/// let factor = Cholesky::new(vec![4.0, 0.0, 2.0, 5.0], 2).expect("a positive definite matrix");
/// assert_eq!(factor.solve(vec![8.0, 12.0]), [1.0, 2.0]);
/// assert_eq!(Cholesky::new(vec![1.0, 0.0, 2.0, 1.0], 2), None);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Cholesky {
    size: usize,
    /// Matrix L as a full square matrix, stored row by row. Only its lower triangle is used.
    factor: Vec<f64>,
}

impl Cholesky {
    /// Computes the Cholesky factor of the symmetric matrix M. `matrix` contains M row by row, and
    /// `size` is the number of rows. Only the lower triangle of M is read. Returns `None` if M is
    /// not positive definite.
    pub fn new(mut matrix: Vec<f64>, size: usize) -> Option<Self> {
        for row in 0..size {
            for column in 0..=row {
                let sum: f64 = (0..column)
                    .map(|k| matrix[row * size + k] * matrix[column * size + k])
                    .sum();
                let remainder = matrix[row * size + column] - sum;
                matrix[row * size + column] = if row > column {
                    remainder / matrix[column * size + column]
                } else if remainder > 0.0 && remainder.is_finite() {
                    remainder.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Cholesky {
            size,
            factor: matrix,
        })
    }

    /// Returns an element of L.
    fn element(&self, row: usize, column: usize) -> f64 {
        self.factor[row * self.size + column]
    }

    /// Returns the solution x of the equations M x = `right`, where M is the matrix given to `new`.
    pub fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        for row in 0..self.size {
            let sum: f64 = (0..row).map(|k| self.element(row, k) * right[k]).sum();
            right[row] = (right[row] - sum) / self.element(row, row);
        }
        self.solve_transposed(right)
    }

    /// Returns the solution x of the equations Lᵀ x = `right`, where L is the Cholesky factor.
    pub fn solve_transposed(&self, mut right: Vec<f64>) -> Vec<f64> {
        for row in (0..self.size).rev() {
            let sum: f64 = (row + 1..self.size)
                .map(|k| self.element(k, row) * right[k])
                .sum();
            right[row] = (right[row] - sum) / self.element(row, row);
        }
        right
    }

    /// Returns the square root of element (i, i) of M⁻¹, where M is the matrix given to `new` and i
    /// is `index`. If M⁻¹ is the covariance matrix of fitted parameters, the result is the standard
    /// error of parameter i.
    pub fn standard_error(&self, index: usize) -> f64 {
        let mut gradient = vec![0.0; self.size];
        gradient[index] = 1.0;
        self.variance(&gradient).sqrt()
    }

    /// Returns vᵀ M⁻¹ v, where M is the matrix given to `new` and v is `gradient`. If M⁻¹ is the
    /// covariance matrix of fitted parameters, and v contains the derivatives of a quantity with
    /// respect to these parameters, the result is the variance of the quantity.
    pub fn variance(&self, gradient: &[f64]) -> f64 {
        let solved = self.solve(gradient.to_vec());
        gradient
            .iter()
            .zip(solved)
            .map(|(component, solved)| component * solved)
            .sum()
    }
}
