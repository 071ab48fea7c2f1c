//! Linear operators of a half-space on a square grid, in units of the side L and the effective
//! modulus E*. The first operator computes the displacements that pressures cause. The second is an
//! approximate inverse of the first. The third extends values from a contact to the grid around it.

use super::convolution::Convolution;
use asperity_data::{OutOfMemory, resized};
use std::f64::consts::{PI, TAU};

/// Number of sweeps that extend a residual beyond the contact. Each sweep extends it by one cell.
const SWEEPS: usize = 6;

/// What lies on the half-space around the square: nothing, or copies of the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The square is the only body on the half-space.
    Free,
    /// Copies of the square cover the whole half-space. They lie side by side in both directions.
    Periodic,
}

/// Displacement of the middle of a square cell on which a pressure of E* acts, in units of the side
/// of the cell: (4/π) ln(1+√2).
pub const OWN_DISPLACEMENT: f64 = 1.122_199_7;

/// The linear operators of one grid, such as the operator that computes displacements from
/// pressures.
pub struct Operators {
    cells: usize,
    displacement: Convolution<f64>,
    stiffness: Convolution<f32>,
    /// Number of convolutions computed so far, a measure of the computing work.
    pub convolutions: u64,
    sweeps: Sweeps,
}

impl Operators {
    /// Returns the memory in bytes that the operators of a grid with `cells` cells along a side
    /// need.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        let padded = PaddedSides::of(cells, boundary);
        let sweeps = size_of::<f32>() * Sweeps::numbers(cells);
        Convolution::<f64>::bytes(cells, padded.displacement)
            + Convolution::<f32>::bytes(cells, padded.stiffness)
            + sweeps as u64
    }

    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, OutOfMemory> {
        let padded = PaddedSides::of(cells, boundary);
        let displacement = match boundary {
            // The transform is 2/(E*|q|) for the wave number q. The mean displacement of a periodic
            // half-space is infinite, so it is left out.
            Boundary::Periodic => Convolution::by_transform(cells, cells, |x, y| {
                if x == 0.0 && y == 0.0 {
                    0.0
                } else {
                    2.0 / (TAU * x.hypot(y))
                }
            })?,
            Boundary::Free => Convolution::by_kernel(cells, padded.displacement, |x, y| {
                displacement_by_cell(x as f64, y as f64) / cells as f64
            })?,
        };
        // For the mean pressure, the inverse uses the value of a wave that is twice as long as the
        // padded grid. This value need not be exact: under a force the mean is subtracted later,
        // and under an indentation the inverse is only an approximation.
        let length = padded.stiffness as f64 / cells as f64;
        let stiffness = |x: f64, y: f64| 0.5 * TAU / length * x.hypot(y).max(0.5);
        Ok(Operators {
            cells,
            displacement,
            stiffness: Convolution::by_transform(cells, padded.stiffness, stiffness)?,
            convolutions: 0,
            sweeps: Sweeps {
                cells,
                rows: resized(Vec::new(), Sweeps::numbers(cells), 0.0)?,
            },
        })
    }

    /// Computes the displacements that pressures cause, row by row. The caller gives two functions,
    /// which get `context` and the index of a row. `pressure` writes the pressures of this row, and
    /// `displacement` reads the displacements of this row.
    pub fn displace<C>(
        &mut self,
        context: &mut C,
        pressure: impl FnMut(&mut C, usize, &mut [f64]),
        displacement: impl FnMut(&mut C, usize, &[f64]),
    ) {
        self.convolutions += 1;
        self.displacement.apply(context, pressure, displacement);
    }

    /// Computes approximate pressures on the contact that cause given displacements of the contact.
    /// The pressures outside the contact are zero. The operator is P Eᵀ D E:
    ///
    /// * E extends the displacements smoothly beyond the contact, because zeros outside would act
    ///   as a wall at each edge.
    /// * D multiplies each wave with the wave number q by E*|q|/2.
    /// * Eᵀ is the transpose of E, and P sets the pressures outside the contact to zero.
    ///
    /// The operator is symmetric. Since it is only approximate, single precision is enough.
    /// `outside` is 1 for a cell off the contact and 0 for a cell on it. `visit` receives each row
    /// as soon as the row is computed.
    pub fn precondition(
        &mut self,
        residual: &[f32],
        outside: &[f32],
        pressure: &mut [f32],
        visit: impl FnMut(usize, &[f32]),
    ) {
        self.convolutions += 1;
        let mut extension = Extension {
            sweeps: &mut self.sweeps,
            residual,
            outside,
            pressure,
            visit,
        };
        self.stiffness.apply(
            &mut extension,
            |extension, row, extended| extension.extend(row, extended),
            |extension, row, found| {
                extension.take(row, found);
                extension.restrict(row);
            },
        );
        for time in self.cells..self.cells + SWEEPS {
            extension.restrict(time);
        }
    }
}

/// Extension E of the residuals beyond the contact, and its transpose Eᵀ for the pressures. In each
/// sweep of E, a cell of the contact keeps its value, and each other cell gets the mean of its four
/// neighbours. E therefore sums over all paths off the contact whose number of steps is at most the
/// number of sweeps. Eᵀ sums over the same paths in the opposite direction.
struct Extension<'a, V> {
    sweeps: &'a mut Sweeps,
    residual: &'a [f32],
    outside: &'a [f32],
    /// Pressures before and after Eᵀ. A row is replaced when no sweep needs its former values for a
    /// further row.
    pressure: &'a mut [f32],
    /// Function that receives each row of the pressures after Eᵀ.
    visit: V,
}

impl<V: FnMut(usize, &[f32])> Extension<'_, V> {
    /// Computes a row of the extended residuals. The rows must be computed in order.
    fn extend(&mut self, row: usize, extended: &mut [f32]) {
        let cells = self.sweeps.cells;
        // The first extended row needs all rows that its sweeps reach. Each following row needs one
        // more row.
        let first = if row == 0 { 0 } else { row + SWEEPS };
        for time in first..=row + SWEEPS {
            if let Some(residual) = self.residual.chunks_exact(cells).nth(time) {
                self.sweeps.row_mut(0, time).copy_from_slice(residual);
            }
            self.sweeps
                .sweep(time, self.residual, self.outside, |_, fixed, out, sum| {
                    fixed + 0.25 * out * sum
                });
        }
        extended.copy_from_slice(self.sweeps.row_mut(SWEEPS, row));
    }

    /// Stores a row of the pressures before Eᵀ.
    fn take(&mut self, row: usize, found: &[f32]) {
        let cells = self.sweeps.cells;
        self.pressure[row * cells..][..cells].copy_from_slice(found);
        let outside = &self.outside[row * cells..];
        let swept = self.sweeps.row_mut(0, row);
        for (to, (pressure, out)) in swept.iter_mut().zip(found.iter().zip(outside)) {
            *to = pressure * out;
        }
    }

    /// Sweeps as far as the stored rows allow. `time` is the number of the last stored row. After
    /// the last row of the grid, `time` continues to grow, and empty rows take the place of stored
    /// rows.
    fn restrict(&mut self, time: usize) {
        let cells = self.sweeps.cells;
        self.sweeps.sweep(
            time,
            self.pressure,
            self.outside,
            |is_last, fixed, out, sum| {
                (if is_last { 1.0 - out } else { out }) * (fixed + 0.25 * sum)
            },
        );
        if let Some(row) = time.checked_sub(SWEEPS) {
            let pressure = &mut self.pressure[row * cells..][..cells];
            pressure.copy_from_slice(self.sweeps.row_mut(SWEEPS, row));
            (self.visit)(row, pressure);
        }
    }
}

/// Sweeps over the grid that run at the same time. Each sweep is one row behind the sweep before,
/// so that all rows in use stay in the cache of the processor.
struct Sweeps {
    cells: usize,
    /// The last three rows of each sweep, and of the values before the first sweep.
    rows: Vec<f32>,
}

impl Sweeps {
    /// Returns the number of values in all rows.
    fn numbers(cells: usize) -> usize {
        3 * (SWEEPS + 1) * cells
    }

    fn row_mut(&mut self, sweep: usize, row: usize) -> &mut [f32] {
        &mut self.rows[(3 * sweep + row % 3) * self.cells..][..self.cells]
    }

    /// Computes the row `time` − n of each sweep n. `each` is called for each cell of a row. Its
    /// arguments are: true for the last sweep, the fixed value of the cell, the value of `outside`,
    /// and the sum of the four neighbours. At the boundary of the grid, the cell itself replaces a
    /// missing neighbour.
    fn sweep(
        &mut self,
        time: usize,
        fixed: &[f32],
        outside: &[f32],
        each: impl Fn(bool, f32, f32, f32) -> f32,
    ) {
        let cells = self.cells;
        let last = cells - 1;
        for sweep in 1..=SWEEPS {
            let Some(row) = time.checked_sub(sweep).filter(|row| *row < cells) else {
                continue;
            };
            let (before, own) = self.rows.split_at_mut(3 * sweep * cells);
            let before = &before[3 * (sweep - 1) * cells..];
            let row_before = |row: usize| &before[row % 3 * cells..][..cells];
            let around = Around {
                above: row_before(row.saturating_sub(1)),
                middle: row_before(row),
                below: row_before((row + 1).min(last)),
                fixed: &fixed[row * cells..],
                outside: &outside[row * cells..],
            };
            let to = &mut own[row % 3 * cells..][..cells];
            if sweep < SWEEPS {
                around.sweep(to, |fixed, out, sum| each(false, fixed, out, sum));
            } else {
                around.sweep(to, |fixed, out, sum| each(true, fixed, out, sum));
            }
        }
    }
}

/// Values from which a sweep computes a row: three rows after the sweep before (the rows above, at
/// and below this row), the fixed values of the row, and its values of `outside`.
struct Around<'a> {
    above: &'a [f32],
    middle: &'a [f32],
    below: &'a [f32],
    fixed: &'a [f32],
    outside: &'a [f32],
}

impl Around<'_> {
    fn sweep(&self, to: &mut [f32], each: impl Fn(f32, f32, f32) -> f32) {
        let last = to.len() - 1;
        let swept = |column: usize, left: usize, right: usize| {
            each(
                self.fixed[column],
                self.outside[column],
                self.above[column] + self.below[column] + (self.middle[left] + self.middle[right]),
            )
        };
        to[0] = swept(0, 0, 1);
        to[last] = swept(last, last - 1, last);
        // The loop uses iterators without indices, because only then the compiler makes
        // instructions for several values at once.
        let vertical = self.above[1..].iter().zip(&self.below[1..]);
        let horizontal = self.middle[..last - 1].iter().zip(&self.middle[2..]);
        let own = self.fixed[1..].iter().zip(&self.outside[1..]);
        let to = to[1..last].iter_mut().zip(own);
        for ((to, (fixed, outside)), ((above, below), (left, right))) in
            to.zip(vertical.zip(horizontal))
        {
            *to = each(*fixed, *outside, above + below + (left + right));
        }
    }
}

/// Sides of the padded grids for the displacement and the stiffness, in cells.
struct PaddedSides {
    displacement: usize,
    stiffness: usize,
}

impl PaddedSides {
    fn of(cells: usize, boundary: Boundary) -> Self {
        match boundary {
            Boundary::Periodic => PaddedSides {
                displacement: cells,
                stiffness: cells,
            },
            // The sides are multiples of 16, because such numbers have no large prime factor on the
            // grids that are used.
            Boundary::Free => PaddedSides {
                displacement: (2 * cells).next_multiple_of(16),
                stiffness: (cells + cells / 4).next_multiple_of(16),
            },
        }
    }
}

/// Returns the displacement that a pressure of E* on a cell causes at the distance (x, y) from the
/// middle of this cell (Love 1929). The distances are in cells, and the displacement is in units of
/// the side of a cell.
fn displacement_by_cell(x: f64, y: f64) -> f64 {
    let left = x - 0.5;
    let right = x + 0.5;
    let bottom = y - 0.5;
    let top = y + 0.5;
    (corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)) / PI
}

/// Returns the contribution of one corner of the cell to the displacement: y ln(x + r) + x ln(y +
/// r) at the distance (x, y) from this corner, with r² = x² + y².
fn corner(x: f64, y: f64) -> f64 {
    let r = x.hypot(y);
    // For a negative x, r + x would be a small difference of large numbers. The equal expression
    // y²/(r − x) avoids it.
    let along = |x: f64, y: f64| {
        y * if x < 0.0 {
            (y * y / (r - x)).ln()
        } else {
            (x + r).ln()
        }
    };
    along(x, y) + along(y, x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_displaces_by_the_integral_over_it() {
        assert!((displacement_by_cell(0.0, 0.0) - OWN_DISPLACEMENT).abs() < 1e-7);
        // The expected value is the sum of the displacements that small parts of the cell cause.
        let parts = 200;
        for (x, y) in [(1.0, 0.0), (3.0, 2.0), (0.0, 7.0), (40.0, 9.0)] {
            let mut sum = 0.0;
            for index in 0..parts * parts {
                let part_x = ((index % parts) as f64 + 0.5) / parts as f64 - 0.5;
                let part_y = ((index / parts) as f64 + 0.5) / parts as f64 - 0.5;
                sum += 1.0 / (x - part_x).hypot(y - part_y);
            }
            let expected = sum / (parts * parts) as f64 / PI;
            let found = displacement_by_cell(x, y);
            assert!((found / expected - 1.0).abs() < 1e-5, "{x} {y}");
        }
    }

    fn scalar_product(first: &[f32], second: &[f32]) -> f64 {
        first
            .iter()
            .zip(second)
            .map(|(first, second)| f64::from(*first) * f64::from(*second))
            .sum()
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
            let first = vector(1);
            let second = vector(5);
            let mut precondition = |residual: &[f32]| {
                let mut pressure = vec![0.0; residual.len()];
                operators.precondition(residual, &outside, &mut pressure, |_, _| ());
                pressure
            };
            let by_first = precondition(&first);
            let by_second = precondition(&second);
            let left = scalar_product(&first, &by_second);
            let right = scalar_product(&second, &by_first);
            let square = scalar_product(&first, &by_first);
            assert!((left - right).abs() < 1e-6 * square.abs(), "{left} {right}");
            assert!(square > 0.0);
        }
    }
}
