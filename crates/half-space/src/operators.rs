//! Linear operators of a half-space on a square grid, in units of the side L and the effective modulus E*. They are the
//! displacement by a pressure, its approximate inverse, and the extension of numbers from a contact to the grid around it.

use super::convolution::Convolution;
use asperity_data::{OutOfMemory, resized};
use std::f64::consts::{PI, TAU};

/// Number of sweeps by which a residual is extended beyond the contact.
const SWEEPS: usize = 6;

/// Surroundings of the square on the half-space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The square is alone on the half-space.
    Free,
    /// The square is repeated without end in both directions.
    Periodic,
}

/// Displacement of the middle of a square cell by a pressure of E* on it, in units of the side of the cell: (4/π) ln(1+√2).
pub const OWN_DISPLACEMENT: f64 = 1.122_199_7;

/// Operators of one grid.
pub struct Operators {
    cells: usize,
    displacement: Convolution<f64>,
    stiffness: Convolution<f32>,
    /// Number of convolutions so far.
    pub convolutions: u64,
    extended: Vec<f32>,
    other: Vec<f32>,
    off: Vec<f32>,
}

impl Operators {
    /// Returns the number of bytes of the operators of a grid.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        let (displacement, stiffness) = paddings(cells, boundary);
        Convolution::<f64>::bytes(cells, displacement)
            + Convolution::<f32>::bytes(cells, stiffness)
            + 12 * (cells * cells) as u64
    }

    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, OutOfMemory> {
        let (margin, padded) = paddings(cells, boundary);
        let length = padded as f64 / cells as f64;
        let displacement = match boundary {
            // 2/(E*|q|); the mean displacement of a periodic half-space is infinite and left out.
            Boundary::Periodic => Convolution::by_transform(cells, cells, |x, y| {
                if x == 0.0 && y == 0.0 { 0.0 } else { 2.0 / (TAU * x.hypot(y)) }
            })?,
            Boundary::Free => {
                Convolution::by_kernel(cells, margin, |x, y| of_a_cell(x as f64, y as f64) / cells as f64)?
            }
        };
        // A mean pressure takes the inverse of the longest wave: under a force it is taken out, else it need not be exact.
        let stiffness = |x: f64, y: f64| 0.5 * TAU / length * x.hypot(y).max(0.5);
        Ok(Operators {
            cells,
            displacement,
            stiffness: Convolution::by_transform(cells, padded, stiffness)?,
            convolutions: 0,
            extended: resized(Vec::new(), cells * cells, 0.0)?,
            other: resized(Vec::new(), cells * cells, 0.0)?,
            off: resized(Vec::new(), cells * cells, 0.0)?,
        })
    }

    /// Computes the displacements by pressures.
    pub fn displace(&mut self, pressure: &[f64], displacement: &mut [f64]) {
        self.convolutions += 1;
        self.displacement.apply(pressure, displacement);
    }

    /// Computes approximate pressures on a contact for displacements there, zero elsewhere: P Eᵀ D E. D is E*|q|/2, and E
    /// extends displacements smoothly beyond the contact, because zeros there would act as a wall at each edge. The operator is
    /// symmetric. It is only approximate, so single precision is enough. `outside` is 1 off the contact and 0 on it.
    pub fn precondition(&mut self, residual: &[f32], outside: &[f32], pressure: &mut [f32]) {
        let Operators { cells, stiffness, extended, other, off, .. } = self;
        // E sums over the ways of up to as many steps off the contact, and Eᵀ over the same ways back.
        extend((*cells, SWEEPS), (residual, outside), extended, other);
        self.convolutions += 1;
        stiffness.apply(extended, pressure);
        off.iter_mut().zip(&*pressure).zip(outside).for_each(|((to, of), out)| *to = of * out);
        extend((*cells, SWEEPS - 1), (off, outside), extended, other);
        each_row(*cells, extended, pressure, |row, sums, to| {
            let of = outside[row * *cells..].iter().zip(sums);
            to.iter_mut().zip(of).for_each(|(to, (out, sum))| *to = (1.0 - out) * (*to + 0.25 * sum));
        });
    }
}

/// Returns the sides of the padded grids of both operators.
fn paddings(cells: usize, boundary: Boundary) -> (usize, usize) {
    match boundary {
        Boundary::Periodic => (cells, cells),
        // Multiples of 16 have no large prime factor on the grids used.
        Boundary::Free => ((2 * cells).next_multiple_of(16), (cells + cells / 4).next_multiple_of(16)),
    }
}

/// Returns the displacement at the distance (x, y), in cells, by a pressure of E* on one cell, in units of the cell (Love
/// 1929).
fn of_a_cell(x: f64, y: f64) -> f64 {
    let part = |x: f64, y: f64| {
        let r = x.hypot(y);
        // y ln(x + r), written without the difference of near numbers for negative x.
        let along = |x: f64, y: f64| y * if x < 0.0 { (y * y / (r - x)).ln() } else { (x + r).ln() };
        along(x, y) + along(y, x)
    };
    (part(x + 0.5, y + 0.5) - part(x - 0.5, y + 0.5) - part(x + 0.5, y - 0.5) + part(x - 0.5, y - 0.5)) / PI
}

/// Extends the numbers `fixed` into `extended` by sweeps. In each sweep every cell off the contact becomes its own number
/// and the mean of its neighbours. Cells of the contact keep their own number.
fn extend(
    (cells, sweeps): (usize, usize),
    (fixed, outside): (&[f32], &[f32]),
    extended: &mut Vec<f32>,
    other: &mut Vec<f32>,
) {
    let sweep = |from: &[f32], to: &mut [f32]| {
        each_row(cells, from, to, |row, sums, to| {
            let of = fixed[row * cells..].iter().zip(&outside[row * cells..]).zip(sums);
            to.iter_mut().zip(of).for_each(|(to, ((fixed, out), sum))| *to = fixed + 0.25 * out * sum);
        });
    };
    sweep(fixed, extended);
    for _ in 1..sweeps {
        sweep(extended, other);
        std::mem::swap(extended, other);
    }
}

/// Calls a function with the number of each row, the sums of the four neighbours of its cells, and the row of `to`. A
/// neighbour beyond the grid is the cell itself.
fn each_row(cells: usize, from: &[f32], to: &mut [f32], mut visit: impl FnMut(usize, &[f32], &mut [f32])) {
    let mut sums = vec![0.0; cells];
    let last = cells - 1;
    for (row, to) in to.chunks_exact_mut(cells).enumerate() {
        let [above, middle, below] =
            [row.saturating_sub(1), row, (row + 1).min(last)].map(|row| &from[row * cells..][..cells]);
        let around = above.iter().zip(below);
        sums.iter_mut().zip(around).for_each(|(sum, (above, below))| *sum = above + below);
        let beside = middle.iter().zip(&middle[2..]);
        sums[1..last].iter_mut().zip(beside).for_each(|(sum, (left, right))| *sum += left + right);
        sums[0] += middle[0] + middle[1];
        sums[last] += middle[last] + middle[last - 1];
        visit(row, &sums, to);
    }
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
            let outside: Vec<f32> =
                (0..cells * cells).map(|index| f32::from(u8::from(number(index) > 0.2))).collect();
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
                operators.precondition(of, &outside, &mut to);
                to
            };
            let (of_one, of_other) = (on(&one), on(&other));
            let product = |a: &[f32], b: &[f32]| {
                a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>()
            };
            let (left, right) = (product(&one, &of_other), product(&other, &of_one));
            assert!((left - right).abs() < 1e-6 * product(&one, &of_one).abs(), "{left} {right}");
            assert!(product(&one, &of_one) > 0.0);
        }
    }
}
