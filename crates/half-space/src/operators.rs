//! Linear operators of a half-space on a square grid, in units of the side L and the effective
//! modulus E*. They are the displacement by a pressure, its approximate inverse, and the extension
//! of numbers from a contact to the grid around it.

use super::convolution::Convolution;
use asperity_data::{OutOfMemory, resized};
use std::f64::consts::{PI, TAU};

/// Number of sweeps by which a residual is extended beyond the contact.
const SWEEPS: usize = 6;

/// Surface of the half-space around the square: bare, or covered with copies of the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The square is alone on the half-space.
    Free,
    /// Copies of the square lie side by side without end, along both of its sides.
    Periodic,
}

/// Displacement of the middle of a square cell by a pressure of E* on it, in units of the side of
/// the cell: (4/π) ln(1+√2).
pub const OWN_DISPLACEMENT: f64 = 1.122_199_7;

/// Operators of one grid.
pub struct Operators {
    cells: usize,
    displacement: Convolution<f64>,
    stiffness: Convolution<f32>,
    /// Number of convolutions so far.
    pub convolutions: u64,
    sweeps: Sweeps,
}

impl Operators {
    /// Returns the number of bytes of the operators of a grid.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        let (displacement, stiffness) = paddings(cells, boundary);
        Convolution::<f64>::bytes(cells, displacement)
            + Convolution::<f32>::bytes(cells, stiffness)
            + (12 * (SWEEPS + 1) * cells) as u64
    }

    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, OutOfMemory> {
        let (margin, padded) = paddings(cells, boundary);
        let length = padded as f64 / cells as f64;
        let displacement = match boundary {
            // 2/(E*|q|); the mean displacement of a periodic half-space is infinite and left out.
            Boundary::Periodic => Convolution::by_transform(cells, cells, |x, y| {
                if x == 0.0 && y == 0.0 {
                    0.0
                } else {
                    2.0 / (TAU * x.hypot(y))
                }
            })?,
            Boundary::Free => Convolution::by_kernel(cells, margin, |x, y| {
                of_a_cell(x as f64, y as f64) / cells as f64
            })?,
        };
        // A mean pressure takes the inverse of the longest wave: under a force it is taken out,
        // else it need not be exact.
        let stiffness = |x: f64, y: f64| 0.5 * TAU / length * x.hypot(y).max(0.5);
        Ok(Operators {
            cells,
            displacement,
            stiffness: Convolution::by_transform(cells, padded, stiffness)?,
            convolutions: 0,
            sweeps: Sweeps {
                cells,
                rows: resized(Vec::new(), 3 * (SWEEPS + 1) * cells, 0.0)?,
            },
        })
    }

    /// Computes the displacements by pressures, both row by row.
    pub fn displace<C>(
        &mut self,
        context: &mut C,
        pressure: impl FnMut(&mut C, usize, &mut [f64]),
        displacement: impl FnMut(&mut C, usize, &[f64]),
    ) {
        self.convolutions += 1;
        self.displacement.apply(context, pressure, displacement);
    }

    /// Computes approximate pressures on a contact for displacements there, zero elsewhere: P Eᵀ D
    /// E. D is E*|q|/2, and E extends displacements smoothly beyond the contact, because zeros
    /// there would act as a wall at each edge. The operator is symmetric. It is only approximate,
    /// so single precision is enough. `outside` is 1 off the contact and 0 on it. `visit` gets each
    /// row once it is computed.
    pub fn precondition(
        &mut self,
        residual: &[f32],
        outside: &[f32],
        pressure: &mut [f32],
        mut visit: impl FnMut(usize, &[f32]),
    ) {
        let Operators {
            cells,
            stiffness,
            sweeps,
            ..
        } = self;
        let cells = *cells;
        self.convolutions += 1;
        // In E a cell of the contact keeps its number, and another one becomes the mean of its
        // neighbours.
        let extend = |sweeps: &mut Sweeps, row: usize, to: &mut [f32]| {
            for time in if row == 0 { 0 } else { row + SWEEPS }..=row + SWEEPS {
                if let Some(fixed) = residual.chunks_exact(cells).nth(time) {
                    sweeps.row_mut(0, time).copy_from_slice(fixed);
                }
                sweeps.sweep(time, (residual, outside), |_, fixed, out, sum| {
                    fixed + 0.25 * out * sum
                });
            }
            to.copy_from_slice(sweeps.row_mut(SWEEPS, row));
        };
        // E sums over the ways of up to as many steps off the contact, and Eᵀ over the same ways
        // back.
        let mut restrict = |(sweeps, pressure): &mut (&mut Sweeps, &mut [f32]), time: usize| {
            sweeps.sweep(time, (pressure, outside), |is_last, fixed, out, sum| {
                (if is_last { 1.0 - out } else { out }) * (fixed + 0.25 * sum)
            });
            if let Some(row) = time.checked_sub(SWEEPS) {
                let to = &mut pressure[row * cells..][..cells];
                to.copy_from_slice(sweeps.row_mut(SWEEPS, row));
                visit(row, to);
            }
        };
        let mut context = (sweeps, pressure);
        stiffness.apply(
            &mut context,
            |(sweeps, _), row, to| extend(sweeps, row, to),
            |context, row, found| {
                let (sweeps, pressure) = context;
                pressure[row * cells..][..cells].copy_from_slice(found);
                let off = sweeps
                    .row_mut(0, row)
                    .iter_mut()
                    .zip(found.iter().zip(&outside[row * cells..]));
                off.for_each(|(to, (of, out))| *to = of * out);
                restrict(context, row);
            },
        );
        (cells..cells + SWEEPS).for_each(|time| restrict(&mut context, time));
    }
}

/// Sweeps that follow each other at a distance of one row, so that all rows of their work stay in
/// the cache.
struct Sweeps {
    cells: usize,
    /// The last three rows of each sweep, and of the numbers before the first one.
    rows: Vec<f32>,
}

impl Sweeps {
    fn row_mut(&mut self, sweep: usize, row: usize) -> &mut [f32] {
        &mut self.rows[(3 * sweep + row % 3) * self.cells..][..self.cells]
    }

    /// Sweeps the row `time` − n by the sweep n. `each` makes a number of the last sweep, or
    /// another one, of the fixed number of the cell, its being outside, and the sum of its four
    /// neighbours; a neighbour beyond the grid is the cell itself.
    fn sweep(
        &mut self,
        time: usize,
        (fixed, outside): (&[f32], &[f32]),
        each: impl Fn(bool, f32, f32, f32) -> f32,
    ) {
        let (cells, last) = (self.cells, self.cells - 1);
        for sweep in 1..=SWEEPS {
            let Some(row) = time.checked_sub(sweep).filter(|row| *row < cells) else {
                continue;
            };
            let (before, own) = self.rows.split_at_mut(3 * sweep * cells);
            let before = &before[3 * (sweep - 1) * cells..];
            let near = [row.saturating_sub(1), row, (row + 1).min(last)];
            let [above, middle, below] = near.map(|row| &before[row % 3 * cells..][..cells]);
            let of = [
                above,
                middle,
                below,
                &fixed[row * cells..],
                &outside[row * cells..],
            ];
            let to = &mut own[row % 3 * cells..][..cells];
            if sweep < SWEEPS {
                sweep_row(of, to, |fixed, out, sum| each(false, fixed, out, sum));
            } else {
                sweep_row(of, to, |fixed, out, sum| each(true, fixed, out, sum));
            }
        }
    }
}

/// Makes a row of the rows above, at and below it, of the fixed numbers and of being outside.
fn sweep_row(of: [&[f32]; 5], to: &mut [f32], each: impl Fn(f32, f32, f32) -> f32) {
    let last = to.len() - 1;
    let at = |at: usize, left: usize, right: usize| {
        let [above, middle, below, fixed, outside] = of;
        each(
            fixed[at],
            outside[at],
            above[at] + below[at] + (middle[left] + middle[right]),
        )
    };
    (to[0], to[last]) = (at(0, 0, 1), at(last, last - 1, last));
    let [above, middle, below, fixed, outside] = of.map(|of| &of[1..]);
    // Iterators without indices are compiled to instructions on several numbers.
    let around = above
        .iter()
        .zip(below)
        .zip(of[1].iter().zip(&middle[1..last]));
    let to = to[1..last].iter_mut().zip(fixed.iter().zip(outside));
    for ((to, (fixed, outside)), ((above, below), (left, right))) in to.zip(around) {
        *to = each(*fixed, *outside, above + below + (left + right));
    }
}

/// Returns the sides of the padded grids of both operators.
fn paddings(cells: usize, boundary: Boundary) -> (usize, usize) {
    match boundary {
        Boundary::Periodic => (cells, cells),
        // Multiples of 16 have no large prime factor on the grids used.
        Boundary::Free => (
            (2 * cells).next_multiple_of(16),
            (cells + cells / 4).next_multiple_of(16),
        ),
    }
}

/// Returns the displacement at the distance (x, y), in cells, by a pressure of E* on one cell, in
/// units of the cell (Love 1929).
fn of_a_cell(x: f64, y: f64) -> f64 {
    let part = |x: f64, y: f64| {
        let r = x.hypot(y);
        // y ln(x + r), written without the difference of near numbers for negative x.
        let along = |x: f64, y: f64| {
            y * if x < 0.0 {
                (y * y / (r - x)).ln()
            } else {
                (x + r).ln()
            }
        };
        along(x, y) + along(y, x)
    };
    (part(x + 0.5, y + 0.5) - part(x - 0.5, y + 0.5) - part(x + 0.5, y - 0.5)
        + part(x - 0.5, y - 0.5))
        / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_displaces_by_the_integral_over_it() {
        assert!((of_a_cell(0.0, 0.0) - OWN_DISPLACEMENT).abs() < 1e-7);
        // By the sum over small parts of the cell.
        for (x, y) in [(1.0, 0.0), (3.0, 2.0), (0.0, 7.0), (40.0, 9.0)] {
            let parts = 200;
            let at = |index: usize| (index as f64 + 0.5) / parts as f64 - 0.5;
            let sum: f64 = (0..parts * parts)
                .map(|index| 1.0 / (x - at(index % parts)).hypot(y - at(index / parts)))
                .sum::<f64>()
                / (parts * parts) as f64
                / PI;
            assert!((of_a_cell(x, y) / sum - 1.0).abs() < 1e-5, "{x} {y}");
        }
    }

    #[test]
    fn the_preconditioner_is_symmetric_and_positive() {
        let cells = 16;
        let number = |index: usize| (index as f64 * 7.13).sin();
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let mut operators = Operators::new(cells, boundary).unwrap();
            let outside: Vec<f32> = (0..cells * cells)
                .map(|index| f32::from(u8::from(number(index) > 0.2)))
                .collect();
            let vector = |shift: usize| -> Vec<f32> {
                outside
                    .iter()
                    .enumerate()
                    .map(|(index, out)| (1.0 - out) * number(index * shift + 3) as f32)
                    .collect()
            };
            let (one, other) = (vector(1), vector(5));
            let mut on = |of: &[f32]| {
                let mut to = vec![0.0; of.len()];
                operators.precondition(of, &outside, &mut to, |_, _| ());
                to
            };
            let (of_one, of_other) = (on(&one), on(&other));
            let product = |a: &[f32], b: &[f32]| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| f64::from(*a) * f64::from(*b))
                    .sum::<f64>()
            };
            let (left, right) = (product(&one, &of_other), product(&other, &of_one));
            assert!(
                (left - right).abs() < 1e-6 * product(&one, &of_one).abs(),
                "{left} {right}"
            );
            assert!(product(&one, &of_one) > 0.0);
        }
    }
}
