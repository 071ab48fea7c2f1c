//! Lines of a curve: contributions to the measured force that do not come from the contact, such as
//! the zero and the drift. They were estimated before the fit, and are fitted again for each
//! computed model.
//!
//! The points without contact have the same weight in this second fit, however large the residuals
//! in contact are. This weight follows from the noise of the curve. A model that deviates from the
//! curve in contact can therefore not improve its agreement by a wrong zero.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::dot;
use crate::fit::population::WRONG_SIDE;

/// Smallest pivot of a matrix, as a share of its diagonal element, that is not a rounding error.
const LEAST_PIVOT: f64 = 1e-12;

/// Lines of a curve (contributions to the force such as zero and drift), with the data for their
/// fit.
pub(crate) struct Lines {
    columns: Vec<Vec<f64>>,
    /// True for each point of the curve that is in contact.
    in_contact: Vec<bool>,
    /// Sums of the products of each pair of columns over the points without contact. Points without
    /// contact of segments that are not used are included. `contact_products` has the sums over the
    /// points in contact.
    free_products: Vec<Vec<f64>>,
    contact_products: Vec<Vec<f64>>,
    /// Lines of further curves, whose points follow the points of this curve.
    further: Vec<Lines>,
}

impl Lines {
    /// Prepares the fit of contributions to the measured force, such as zero and drift. `has_zero`
    /// is true if the zero of the force is a free parameter of the fit; it is then not one of the
    /// contributions.
    pub fn new(curve: &MeasuredCurve, has_zero: bool) -> Self {
        let in_contact = curve.in_contact();
        let first = usize::from(has_zero || !curve.subtracted.has_zero);
        let elsewhere = &curve.subtracted.elsewhere;
        let mut columns = curve.lines(has_zero);
        let mut lengths = Vec::with_capacity(columns.len());
        for column in &mut columns {
            let length = dot(column, column).sqrt();
            let length = if length > 0.0 { length } else { 1.0 };
            for value in column.iter_mut() {
                *value /= length;
            }
            lengths.push(length);
        }
        let products = |is_in_contact: bool, row: usize, column: usize| {
            let mut sum = 0.0;
            for (index, in_contact) in in_contact.iter().enumerate() {
                if *in_contact == is_in_contact {
                    sum += columns[row][index] * columns[column][index];
                }
            }
            sum
        };
        let count = columns.len();
        let mut free_products = vec![vec![0.0; count]; count];
        let mut contact_products = vec![vec![0.0; count]; count];
        for row in 0..count {
            for column in 0..count {
                let not_used = elsewhere[first + row][first + column];
                free_products[row][column] =
                    products(false, row, column) + not_used / (lengths[row] * lengths[column]);
                contact_products[row][column] = products(true, row, column);
            }
        }
        Lines {
            columns,
            in_contact,
            free_products,
            contact_products,
            further: Vec::new(),
        }
    }

    /// Adds the contributions to the forces of a further curve, whose points follow those of the
    /// earlier curves.
    pub fn push(&mut self, lines: Lines) {
        self.further.push(lines);
    }

    /// Fits contributions to the measured force, such as zero and drift, to the residuals, and
    /// returns what remains of the residuals. All numbers are in units of the noise without
    /// contact. The fit assumes the standard deviation `noise` for a residual in contact, and 1 for
    /// any other residual. A residual above 5 standard deviations counts as 5 standard deviations.
    pub fn refined(&self, residuals: &[f64], noise: f64) -> Vec<f64> {
        let (own, mut others) = residuals.split_at(self.in_contact.len());
        let mut refined = self.refined_of_curve(own, noise);
        for lines in &self.further {
            let (own, after) = others.split_at(lines.in_contact.len());
            refined.extend(lines.refined_of_curve(own, noise));
            others = after;
        }
        refined
    }

    /// Does the same as [`Lines::refined`] for the residuals of a single curve.
    fn refined_of_curve(&self, residuals: &[f64], noise: f64) -> Vec<f64> {
        let mut refined = residuals.to_vec();
        if self.columns.is_empty() {
            return refined;
        }
        let weight = noise.powi(-2);
        let limit = WRONG_SIDE * noise;
        let mut weighted = Vec::with_capacity(residuals.len());
        for (residual, in_contact) in residuals.iter().zip(&self.in_contact) {
            weighted.push(if !in_contact {
                residual.clamp(-WRONG_SIDE, WRONG_SIDE)
            } else if weight > 0.0 {
                weight * residual.clamp(-limit, limit)
            } else {
                0.0
            });
        }
        let mut matrix = self.free_products.clone();
        let mut components = Vec::with_capacity(self.columns.len());
        for (row, products) in matrix.iter_mut().zip(&self.contact_products) {
            for (value, product) in row.iter_mut().zip(products) {
                *value += weight * product;
            }
        }
        for column in &self.columns {
            components.push(dot(&weighted, column));
        }
        let coefficients = solved(matrix, components);
        for (column, coefficient) in self.columns.iter().zip(coefficients) {
            for (residual, value) in refined.iter_mut().zip(column) {
                *residual -= coefficient * value;
            }
        }
        refined
    }
}

/// Solves a system of linear equations with a symmetric matrix without negative eigenvalues. An
/// unknown that the equations do not determine is 0.
fn solved(mut matrix: Vec<Vec<f64>>, mut values: Vec<f64>) -> Vec<f64> {
    let count = values.len();
    let diagonal: Vec<f64> = (0..count).map(|index| matrix[index][index]).collect();
    for pivot in 0..count {
        if matrix[pivot][pivot] <= LEAST_PIVOT * diagonal[pivot] {
            values[pivot] = 0.0;
            continue;
        }
        let pivot_row = matrix[pivot].clone();
        for row in pivot + 1..count {
            let factor = matrix[row][pivot] / pivot_row[pivot];
            for (value, above) in matrix[row].iter_mut().zip(&pivot_row).skip(pivot) {
                *value -= factor * above;
            }
            values[row] -= factor * values[pivot];
        }
    }
    for row in (0..count).rev() {
        if matrix[row][row] <= LEAST_PIVOT * diagonal[row] {
            values[row] = 0.0;
            continue;
        }
        let later: f64 = (row + 1..count)
            .map(|column| matrix[row][column] * values[column])
            .sum();
        values[row] = (values[row] - later) / matrix[row][row];
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{read, rubber};
    use crate::read::options::Drift;

    #[test]
    fn equations_are_solved_and_undetermined_unknowns_are_0() {
        let matrix = vec![
            vec![4.0, 2.0, 0.0],
            vec![2.0, 3.0, 1.0],
            vec![0.0, 1.0, 2.0],
        ];
        let solution = solved(matrix, vec![8.0, 11.0, 8.0]);
        for (found, expected) in solution.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-12, "{solution:?}");
        }
        let twice = vec![vec![1.0, 1.0], vec![1.0, 1.0]];
        assert_eq!(solved(twice, vec![3.0, 3.0]), [3.0, 0.0]);
    }

    /// With the noise 100, residuals of 100 in contact move the zero by no more than its error.
    /// With the noise 1, the zero is the mean of all residuals.
    #[test]
    fn the_zero_is_held_by_the_part_without_contact() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let lines = Lines::new(&curve, false);
        let in_contact = curve.in_contact();
        let large = |size: f64| -> Vec<f64> {
            in_contact
                .iter()
                .map(|touches| if *touches { size } else { 0.0 })
                .collect()
        };
        let zero =
            |residuals: &[f64], noise: f64| residuals[0] - lines.refined(residuals, noise)[0];
        let free = in_contact.iter().filter(|touches| !**touches).count() as f64;
        let held = zero(&large(100.0), 100.0);
        assert!(held.abs() < 1.0 / free.sqrt(), "{held} {free}");
        let share = 1.0 - free / in_contact.len() as f64;
        assert!((zero(&large(2.0), 1.0) - 2.0 * share).abs() < 1e-12);
        assert_eq!(zero(&large(2.0), f64::INFINITY), 0.0);
        assert_eq!(
            Lines::new(&curve, true).refined(&large(2.0), 1.0),
            large(2.0)
        );
    }
}
