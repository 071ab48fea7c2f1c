//! Comparison of one quantity between random profiles and random square surfaces in three
//! dimensions. Profiles are the model of this program. The result is the ratio of the two means,
//! with its errors.

use super::quantity::Quantity;
use super::statistics::Statistics;
use asperity_data::{mean, student_quantile};
use serde::Serialize;

/// Largest deviation of a number of degrees of freedom from a whole number that counts as a
/// rounding error.
const ROUNDING: f64 = 1e-9;

/// Comparison of one quantity between random profiles and random square surfaces. A square surface
/// is a rough body in three dimensions with a square base.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Statistics of the quantity over the random profiles.
    pub line: Statistics,
    /// Statistics of the quantity over the random square surfaces in three dimensions.
    pub half_space: Statistics,
    /// Mean of the quantity over the profiles divided by its mean over the square surfaces.
    pub ratio: f64,
    /// Half the width of the 95 % confidence interval of [`Compared::ratio`], by Student's t;
    /// `None` for fewer than two profiles or square surfaces.
    pub error: Option<f64>,
    /// Relative error of the mean over the square surfaces due to their grid. It is the difference
    /// from the mean over the same surfaces, computed with half as many grid cells along the side.
    /// `None` if the computation with half as many cells would have too few cells.
    pub grid: Option<f64>,
}

impl Compared {
    /// Returns [`Compared::ratio`] − 1, the relative difference between the mean over the profiles
    /// and the mean over the square surfaces.
    pub fn difference(&self) -> f64 {
        self.ratio - 1.0
    }
}

/// Values of one quantity on all random profiles and on all random square surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Values {
    /// Value on each random profile, in the SI unit of the quantity.
    pub lines: Vec<f64>,
    /// Value on each random square surface, in the SI unit of the quantity.
    pub squares: Vec<f64>,
    /// Value on each square surface, in the SI unit of the quantity, computed on a coarser grid
    /// with half as many cells along the side. The list is empty if the coarser grid is not
    /// computed.
    pub coarse: Vec<f64>,
}

impl Values {
    /// Returns the statistics of the values over profiles and over square surfaces, with the ratio
    /// of the two means; `None` if there are no values.
    pub fn compared(self) -> Option<Compared> {
        let bounds = Quantity::PullOffForce.bounds();
        let grid = self.grid_error();
        let line = Statistics::of(self.lines, bounds)?;
        let half_space = Statistics::of(self.squares, bounds)?;
        let ratio = line.mean / half_space.mean;
        if !ratio.is_finite() {
            return None;
        }
        let error = error_of_ratio(&line, &half_space).filter(|error| error.is_finite());
        Some(Compared {
            line,
            half_space,
            ratio,
            error,
            grid,
        })
    }

    fn grid_error(&self) -> Option<f64> {
        if self.coarse.is_empty() || self.coarse.len() != self.squares.len() {
            return None;
        }
        let error = (mean(&self.coarse) / mean(&self.squares) - 1.0).abs();
        error.is_finite().then_some(error)
    }
}

/// Returns half the width of the 95 % confidence interval of the ratio of two means. The number of
/// degrees of freedom of Student's t follows from the relative standard errors of the means by the
/// rule of Welch and Satterthwaite.
fn error_of_ratio(line: &Statistics, square: &Statistics) -> Option<f64> {
    let line_error = line.spread?.standard_error / line.mean;
    let square_error = square.spread?.standard_error / square.mean;
    let error = line_error.hypot(square_error);
    let widened_error = line_error.hypot(widened_square_error(line, square)?);
    if error == 0.0 {
        return Some(0.0);
    }
    // The errors are divided by their root sum of squares before they are raised to powers, because
    // powers of a small error could underflow.
    let line_share = (line_error / error).powi(2);
    let square_share = (square_error / error).powi(2);
    let freedom = (line_share.powi(2) / (line.count - 1) as f64
        + square_share.powi(2) / (square.count - 1) as f64)
        .recip();
    let ratio = line.mean / square.mean;
    let quantile = student_quantile((freedom + ROUNDING).floor().max(1.0) as u32);
    Some(quantile * ratio * widened_error)
}

/// Returns the relative standard error of the mean over the square surfaces. The relative scatter
/// of the square surfaces is assumed to be at least that of the profiles. The reason is a skewed
/// quantity, such as F_a(d=0): a few square surfaces often miss its rare large values, so that
/// their scatter is too small, but many profiles contain them.
fn widened_square_error(line: &Statistics, square: &Statistics) -> Option<f64> {
    let of_line = line.spread?.standard_deviation / line.mean;
    let of_square = square.spread?.standard_deviation / square.mean;
    Some(of_square.max(of_line) / (square.count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(lines: &[f64], squares: &[f64], coarse: &[f64]) -> Option<Compared> {
        let values = Values {
            lines: lines.to_vec(),
            squares: squares.to_vec(),
            coarse: coarse.to_vec(),
        };
        values.compared()
    }

    #[test]
    fn a_ratio_has_its_errors() {
        let found = compared(&[2.0; 40], &[1.0, 2.0, 3.0], &[1.5, 2.0, 3.1]).unwrap();
        assert_eq!(found.ratio, 1.0);
        // All profiles have the same value, so their mean has no error. The square surfaces have
        // two degrees of freedom, and their mean of 2 has the standard error 1/√3.
        let expected = 4.302_652_730 / 3.0_f64.sqrt() / 2.0;
        assert!(
            (found.error.unwrap() / expected - 1.0).abs() < 1e-9,
            "{found:?}"
        );
        assert!((found.grid.unwrap() - 0.1).abs() < 1e-12, "{found:?}");
        assert!(found.difference() == 0.0);
        // Both means have the same relative error, so the number of degrees of freedom is twice
        // that of one mean.
        let both = compared(&[10.0, 20.0, 30.0], &[1.0, 2.0, 3.0], &[]).unwrap();
        let expected = 10.0 * 2.776_445_105 * (2.0_f64 / 3.0).sqrt() / 2.0;
        assert!(
            (both.error.unwrap() / expected - 1.0).abs() < 1e-9,
            "{both:?}"
        );
        assert_eq!(both.grid, None);
    }

    /// If the square surfaces by chance scatter less than the profiles, the scatter of the profiles
    /// keeps the confidence interval wide.
    #[test]
    fn the_scatter_of_the_lines_counts_for_few_squares() {
        let lines: Vec<f64> = (0..100).map(|line| 1.0 + f64::from(line % 2)).collect();
        let wide = compared(&lines, &[2.0, 2.01], &[]).unwrap().error.unwrap();
        // The relative standard deviation of the profiles is 1/3. It replaces that of the two
        // square surfaces. The standard error of the mean over the profiles is negligible.
        let of_squares = 1.0 / 3.0 / 2.0_f64.sqrt();
        assert!(wide > 1.9 * 0.75 * of_squares, "{wide}");
        // If the square surfaces scatter more than the profiles, the scatter of the square surfaces
        // is used.
        let own = compared(&lines, &[1.0, 9.0], &[]).unwrap();
        let narrow = compared(&[1.5; 100], &[1.0, 9.0], &[]).unwrap();
        assert!(
            (own.error.unwrap() / narrow.error.unwrap() - 1.0).abs() < 0.01,
            "{own:?} {narrow:?}"
        );
    }

    #[test]
    fn what_has_no_ratio_has_none() {
        assert_eq!(compared(&[], &[1.0], &[]), None);
        assert_eq!(compared(&[1.0], &[], &[]), None);
        assert_eq!(compared(&[1.0, 2.0], &[0.0, 0.0], &[]), None);
        let single = compared(&[1.0, 2.0], &[2.0], &[0.0]).unwrap();
        assert_eq!(
            (single.ratio, single.error, single.grid),
            (0.75, None, Some(1.0))
        );
        assert_eq!(
            compared(&[1.0, 1.0], &[2.0, 2.0], &[1.0]).unwrap().error,
            Some(0.0)
        );
    }
}
