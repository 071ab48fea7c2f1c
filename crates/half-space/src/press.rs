//! Contact without adhesion: conjugate gradients on a set of cells in contact, on nested grids.
//!
//! The cells of each grid have half the size of the cells of the next coarser grid. The solution on
//! the coarser grid is the start on the finer one. For a fixed set of cells in contact,
//! preconditioned conjugate gradients (Polak and Ribière) make the gap on the set uniform.
//! Meanwhile pressures may become negative. A violation of the set is a cell in contact that pulls,
//! or an open cell that penetrates. The set changes when these violations are larger than the
//! residual that the gradients have left on the contact. Polonsky and Keer (1999) had the idea to
//! change the set in the same loop as the gradients.

use super::error::HalfSpaceError;
use super::operators::{Boundary, OWN_DISPLACEMENT, Operators};
use asperity_data::{OutOfMemory, resized};
use std::array::from_fn;
use std::mem::swap;

/// Number of cells along the side of the coarsest grid.
pub const COARSEST: usize = 32;

/// Residual at which the solution on a coarser grid ends, divided by the rms height.
const COARSE: f64 = 1e-3;

/// Ratio of the violations of the set to the residual on the contact. When the ratio exceeds this
/// value, the set changes.
const OUTWEIGHS: f64 = 1.5;

/// Largest number of conjugate gradient steps on one grid.
const MOST_STEPS: u64 = 400;

/// Prescribed force or indentation of a contact, as a number without a unit: divided by powers of
/// the side L of the square and of the effective modulus E*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Mean pressure over the square, F/(E* L²).
    MeanPressure(f64),
    /// Indentation from first touch, d/L.
    Indentation(f64),
}

/// Result of the solver: the residual that is left, and the computing work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// Largest violation of the conditions of contact, divided by the rms height of the surface. A
    /// violation is a gap of a cell in contact, or the penetration of any other cell.
    pub residual: f64,
    /// True if the residual is within the required tolerance.
    pub is_reached: bool,
    /// Number of conjugate gradient steps on the finest grid.
    pub steps: u64,
    /// Number of convolutions on the finest grid.
    pub convolutions: u64,
}

/// State and memory of the solver on one grid. All lengths are in units of the side of the square,
/// and all pressures in units of the effective modulus E*.
pub struct Grid {
    pub cells: usize,
    pub operators: Operators,
    /// Depth of each cell of the rigid surface below the highest point, in units of the side of the
    /// square.
    pub depths: Vec<f64>,
    pub pressure: Vec<f64>,
    /// For each cell, the displacement of the half-space plus the depth of the rigid surface, in
    /// units of the side of the square. In the solution, this sum has the same value in all cells
    /// in contact.
    pub levels: Vec<f64>,
    /// 1 for a cell off the contact, 0 for a cell on the contact.
    pub outside: Vec<f32>,
    /// Value of `levels` in all cells in contact once the solution is found, in units of the side
    /// of the square.
    pub level: f64,
    /// Number of cells in contact.
    count: f64,
    residual: Vec<f32>,
    /// Residual before the last step.
    former_residual: Vec<f32>,
    gradient: Vec<f32>,
    /// Direction of a step: the change of the pressures divided by the length of the step.
    direction: Vec<f64>,
    /// Displacements that the values of `direction` cause if they act as pressures.
    image: Vec<f64>,
}

/// Violations of the conditions of contact.
#[derive(Clone, Copy)]
struct Violations {
    /// Largest residual on the contact.
    on_contact: f64,
    /// Largest penetration off the contact.
    penetration: f64,
    lowest_pressure: f64,
}

/// Result of a step of the conjugate gradients.
struct Step {
    /// Scalar product of gradient and residual before the step, which the next step needs.
    product: f64,
    violations: Violations,
}

/// Sums over the cells in contact that determine the next search direction of the conjugate
/// gradients.
struct GradientSums {
    /// Scalar product of gradient and residual.
    with_residual: f64,
    /// Scalar product of the gradient and the residual before the last step.
    with_former_residual: f64,
    total: f64,
}

/// Sums over the cells in contact that determine the length of a conjugate gradient step. They are
/// sums of the search direction and of its image, the displacements that it causes as a pressure.
struct DirectionSums {
    /// Scalar product of direction and residual.
    with_residual: f64,
    /// Scalar product of the direction and its image.
    with_image: f64,
    /// Sum of the values of the image over the contact.
    image_on_contact: f64,
}

/// Search direction, its image and the sums of both, while the image is computed row by row.
struct DirectionRows<'a> {
    direction: &'a mut [f64],
    image: &'a mut [f64],
    sums: Sums<3>,
}

impl Grid {
    /// Returns the memory in bytes that a grid with `cells` cells along a side and its operators
    /// need.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        Operators::bytes(cells, boundary) + (5 * 8 + 4 * 4) * (cells * cells) as u64
    }

    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, OutOfMemory> {
        let zeros = || resized(Vec::new(), cells * cells, 0.0);
        let singles = || resized(Vec::new(), cells * cells, 0.0_f32);
        Ok(Grid {
            cells,
            operators: Operators::new(cells, boundary)?,
            depths: zeros()?,
            pressure: zeros()?,
            levels: zeros()?,
            outside: singles()?,
            level: 0.0,
            count: 0.0,
            residual: singles()?,
            former_residual: singles()?,
            gradient: singles()?,
            direction: zeros()?,
            image: zeros()?,
        })
    }

    /// Sets the depth of each cell from the finer grid: the mean depth of the four finer cells that
    /// lie in this cell.
    pub fn coarsen(&mut self, finer: &Grid) {
        let cells = self.cells;
        let fine = finer.cells;
        for (index, depth) in self.depths.iter_mut().enumerate() {
            let corner = 2 * (index / cells) * fine + 2 * (index % cells);
            let [a, b, c, d] = [corner, corner + 1, corner + fine, corner + fine + 1]
                .map(|corner| finer.depths[corner]);
            *depth = 0.25 * (a + b + (c + d));
        }
    }

    /// Sets the cells in contact with which the solution on the coarsest grid begins. If a force is
    /// prescribed, all cells are in contact. If an indentation is prescribed, the cells that
    /// penetrate the undeformed half-space are in contact.
    pub fn begin(&mut self, given: Given) {
        match given {
            Given::MeanPressure(mean) => {
                self.pressure.fill(mean);
                self.outside.fill(0.0);
            }
            Given::Indentation(depth) => {
                self.pressure.fill(0.0);
                for (out, own_depth) in self.outside.iter_mut().zip(&self.depths) {
                    *out = f32::from(u8::from(*own_depth >= depth));
                }
            }
        }
    }

    /// Sets the pressures and the cells in contact from the solution on the coarser grid `coarse`.
    /// The edge of the contact follows from a length in each coarser cell. In a cell in contact,
    /// this length is the displacement of the cell that its own pressure causes. In any other cell
    /// it is minus the gap. The length is interpolated between the coarser cells, and the edge lies
    /// where it changes its sign.
    pub fn refine(&mut self, coarse: &Grid, given: Given, boundary: Boundary) {
        let cells = self.cells;
        let half = coarse.cells;
        let mut has_contact = false;
        for row in 0..cells {
            let near_row = row / 2;
            let far_row = neighbour(near_row, row % 2 == 1, half, boundary);
            for column in 0..cells {
                let near_column = column / 2;
                let far_column = neighbour(near_column, column % 2 == 1, half, boundary);
                let corners = [
                    near_row * half + near_column,
                    near_row * half + far_column,
                    far_row * half + near_column,
                    far_row * half + far_column,
                ];
                let index = row * cells + column;
                let is_on =
                    interpolated(corners.map(|corner| coarse.signed_pressure(corner))) > 0.0;
                has_contact |= is_on;
                self.outside[index] = f32::from(u8::from(!is_on));
                self.pressure[index] = if is_on {
                    interpolated(corners.map(|corner| coarse.pressure[corner])).max(0.0)
                } else {
                    0.0
                };
            }
        }
        if !has_contact && matches!(given, Given::MeanPressure(_)) {
            // If a contact has so few cells that interpolation would open all of them, each finer
            // cell gets the values of the coarser cell that contains it.
            for index in 0..cells * cells {
                let parent = index / cells / 2 * half + index % cells / 2;
                self.pressure[index] = coarse.pressure[parent];
                self.outside[index] = coarse.outside[parent];
            }
        }
    }

    /// Returns a length that is positive on the contact and negative elsewhere. On the contact it
    /// is the displacement that the pressure of the cell causes at the cell; elsewhere it is minus
    /// the gap.
    fn signed_pressure(&self, index: usize) -> f64 {
        if self.outside[index] == 0.0 {
            OWN_DISPLACEMENT / self.cells as f64 * self.pressure[index]
        } else {
            -(self.levels[index] - self.level).max(0.0)
        }
    }

    /// Scales the pressures to the prescribed mean pressure, if there is one, and computes the
    /// displacements.
    fn load(&mut self, given: Given) {
        if let Given::MeanPressure(mean) = given {
            let [sum] = Sums::of([&self.pressure], [], |[pressure], []| [pressure]);
            let factor = mean * self.pressure.len() as f64 / sum;
            for pressure in &mut self.pressure {
                *pressure *= factor;
            }
        }
        self.displace();
    }

    /// Computes the displacements that the pressures cause, and sets `levels`.
    pub fn displace(&mut self) {
        let Grid {
            cells,
            operators,
            pressure,
            levels,
            depths,
            ..
        } = self;
        let cells = *cells;
        operators.displace(
            levels,
            |_, row, pressures| pressures.copy_from_slice(&pressure[row * cells..][..cells]),
            |levels, row, displacement| {
                let sums = displacement.iter().zip(&depths[row * cells..]);
                for (level, (displacement, depth)) in levels[row * cells..].iter_mut().zip(sums) {
                    *level = displacement + depth;
                }
            },
        );
    }

    /// Sets the level of the contact. Under a prescribed indentation, the level is the indentation;
    /// under a prescribed force, it is the mean of the levels on the contact.
    fn find_level(&mut self, given: Given) {
        let [total, count] = Sums::of([&self.levels], [&self.outside], |[level], [out]| {
            let on = 1.0 - f64::from(out);
            [on * level, on]
        });
        self.count = f64::max(count, 1.0);
        self.level = match given {
            Given::Indentation(depth) => depth,
            Given::MeanPressure(_) => total / self.count,
        };
    }

    /// Adds `length` times the direction to the pressures. Computes the new residuals on the
    /// contact, and returns the violations.
    fn advance(&mut self, length: f64) -> Violations {
        swap(&mut self.residual, &mut self.former_residual);
        let level = self.level;
        let mut on_contact = [0.0; LANES];
        let mut penetration = [0.0; LANES];
        let mut pull = [0.0; LANES];
        let moved = groups_mut(&mut self.pressure).zip(groups_mut(&mut self.levels));
        let by = groups(&self.direction).iter().zip(groups(&self.image));
        let cells = groups(&self.outside)
            .iter()
            .zip(groups_mut(&mut self.residual));
        for (((p, u), (direction, image)), (out, residual)) in moved.zip(by).zip(cells) {
            // The loop works on groups of cells, so that the processor computes several values at
            // once.
            *p = from_fn(|lane| p[lane] + length * direction[lane]);
            *u = from_fn(|lane| u[lane] + length * image[lane]);
            let missing = u.map(|u| level - u);
            let out = out.map(f64::from);
            let on: [f64; LANES] = from_fn(|lane| (1.0 - out[lane]) * missing[lane]);
            *residual = on.map(|on| on as f32);
            keep_larger(&mut on_contact, on.map(f64::abs));
            keep_larger(&mut penetration, from_fn(|lane| out[lane] * missing[lane]));
            keep_larger(&mut pull, p.map(|p| -p));
        }
        Violations {
            on_contact: largest(on_contact),
            penetration: largest(penetration),
            lowest_pressure: -largest(pull),
        }
    }

    /// Removes from the contact the cells whose pressure is not positive, and adds the cells that
    /// penetrate. Returns true if a negative pressure was set to zero.
    fn change_set(&mut self) -> bool {
        let mut is_clipped = false;
        let level = self.level;
        let cells = self.pressure.iter_mut().zip(&mut self.outside);
        for ((pressure, out), own_level) in cells.zip(&self.levels) {
            if *out == 0.0 && *pressure <= 0.0 {
                is_clipped |= *pressure < 0.0;
                *pressure = 0.0;
                *out = 1.0;
            } else if *out == 1.0 && level > *own_level {
                *out = 0.0;
            }
        }
        is_clipped
    }

    /// Solves the contact on this grid. The solver ends when no cell violates the conditions of
    /// contact by more than `tolerance` times the rms height `height`.
    ///
    /// # Errors
    /// Returns [`HalfSpaceError::Stopped`] if `stop` returned true.
    pub fn solve(
        &mut self,
        given: Given,
        tolerance: f64,
        height: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Ended, HalfSpaceError> {
        let convolutions_before = self.operators.convolutions;
        let own = OWN_DISPLACEMENT / self.cells as f64;
        self.load(given);
        self.find_level(given);
        let mut violations = self.advance(0.0);
        // The first step has no product of a former step, so it goes along the steepest descent.
        let mut last_product = None;
        let mut steps = 0;
        loop {
            let Violations {
                on_contact,
                penetration,
                lowest_pressure,
            } = violations;
            let residual = on_contact.max(penetration) / height;
            let is_reached = residual <= tolerance && lowest_pressure >= 0.0;
            if is_reached || steps == MOST_STEPS {
                return Ok(Ended {
                    residual,
                    is_reached,
                    steps,
                    convolutions: self.operators.convolutions - convolutions_before,
                });
            }
            if stop() {
                return Err(HalfSpaceError::Stopped);
            }
            let by_set = penetration.max(own * -lowest_pressure);
            if last_product.is_some() && by_set > OUTWEIGHS * on_contact {
                if self.change_set() {
                    self.load(given);
                }
                self.find_level(given);
                last_product = None;
                violations = self.advance(0.0);
            } else {
                let step = self.step(given, last_product);
                last_product = Some(step.product);
                violations = step.violations;
                steps += 1;
            }
        }
    }

    /// Solves for the pressures at the indentation `depth` while the cells in contact do not
    /// change. The pressures may be negative, so that cells pull. The solver ends when each
    /// displacement on the contact deviates from the required one by at most `tolerance`.
    ///
    /// # Errors
    /// Returns [`HalfSpaceError::Stopped`] if `stop` returned true.
    pub fn solve_fixed(
        &mut self,
        depth: f64,
        tolerance: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), HalfSpaceError> {
        self.level = depth;
        let mut violations = self.advance(0.0);
        let mut last_product = None;
        for _ in 0..MOST_STEPS {
            if violations.on_contact <= tolerance {
                break;
            }
            if stop() {
                return Err(HalfSpaceError::Stopped);
            }
            let step = self.step(Given::Indentation(depth), last_product);
            last_product = Some(step.product);
            violations = step.violations;
        }
        Ok(())
    }

    /// Makes one step of the conjugate gradients on the present contact. `last_product` is the
    /// product of the previous [`Step`]; `None` for the first step.
    fn step(&mut self, given: Given, last_product: Option<f64>) -> Step {
        let gradient = self.find_gradient();
        let product = gradient.with_residual;
        let turned = product - gradient.with_former_residual;
        let carried = match last_product {
            Some(last) if last > 0.0 => (turned / last).max(0.0),
            _ => 0.0,
        };
        let mean = self.mean_to_subtract(given, gradient.total);
        let direction = self.find_direction(mean, carried);
        let length = if direction.with_image > 0.0 {
            direction.with_residual / direction.with_image
        } else {
            0.0
        };
        self.level += length * self.mean_to_subtract(given, direction.image_on_contact);
        Step {
            product,
            violations: self.advance(length),
        }
    }

    /// Returns the mean that is subtracted from values on the contact with the sum `total`. Under a
    /// force the mean of the step must be zero, so the mean of the values is subtracted. Under an
    /// indentation nothing is subtracted.
    fn mean_to_subtract(&self, given: Given, total: f64) -> f64 {
        match given {
            Given::MeanPressure(_) => total / self.count,
            Given::Indentation(_) => 0.0,
        }
    }

    /// Computes the gradient: the residual after the preconditioner has acted on it.
    fn find_gradient(&mut self) -> GradientSums {
        let Grid {
            cells,
            operators,
            residual,
            former_residual,
            outside,
            gradient,
            ..
        } = self;
        let cells = *cells;
        let mut sums = Sums::default();
        operators.precondition(residual, outside, gradient, |row, gradient| {
            let residual = &residual[row * cells..];
            let former = &former_residual[row * cells..];
            let singles = [gradient, residual, former];
            sums.add([], singles, |[], [gradient, residual, former]| {
                let gradient = f64::from(gradient);
                [
                    gradient * f64::from(residual),
                    gradient * f64::from(former),
                    gradient,
                ]
            });
        });
        let [with_residual, with_former_residual, total] = sums.total();
        GradientSums {
            with_residual,
            with_former_residual,
            total,
        }
    }

    /// Computes the direction of a step and the displacements that this direction causes. The
    /// direction is the gradient minus `mean` on the contact, plus `carried` times the former
    /// direction.
    fn find_direction(&mut self, mean: f64, carried: f64) -> DirectionSums {
        let Grid {
            cells,
            operators,
            residual,
            outside,
            gradient,
            direction,
            image,
            ..
        } = self;
        let cells = *cells;
        let mut rows = DirectionRows {
            direction,
            image,
            sums: Sums::default(),
        };
        operators.displace(
            &mut rows,
            |rows, row, pressures| {
                let singles = gradient[row * cells..].iter().zip(&outside[row * cells..]);
                let both = rows.direction[row * cells..].iter_mut().zip(pressures);
                for ((direction, pressure), (gradient, out)) in both.zip(singles) {
                    *direction = f64::from(*gradient) - (1.0 - f64::from(*out)) * mean
                        + carried * *direction;
                    *pressure = *direction;
                }
            },
            |rows, row, displacements| {
                rows.image[row * cells..][..cells].copy_from_slice(displacements);
                let doubles = [displacements, &rows.direction[row * cells..]];
                let singles = [&residual[row * cells..], &outside[row * cells..]];
                rows.sums
                    .add(doubles, singles, |[image, direction], [residual, out]| {
                        [
                            direction * f64::from(residual),
                            direction * image,
                            (1.0 - f64::from(out)) * image,
                        ]
                    });
            },
        );
        let [with_residual, with_image, image_on_contact] = rows.sums.total();
        DirectionSums {
            with_residual,
            with_image,
            image_on_contact,
        }
    }
}

/// Returns the index of a neighbour of a cell in a row of `half` cells. If `is_upper` is true, the
/// neighbour is the cell after the given cell; otherwise the cell before.
fn neighbour(index: usize, is_upper: bool, half: usize, boundary: Boundary) -> usize {
    match (is_upper, boundary) {
        (true, Boundary::Periodic) => (index + 1) % half,
        (false, Boundary::Periodic) => (index + half - 1) % half,
        (true, Boundary::Free) => (index + 1).min(half - 1),
        (false, Boundary::Free) => index.saturating_sub(1),
    }
}

/// Interpolates bilinearly at the middle of a quarter of a cell. The values are those of the cell
/// itself, of the two cells beside this quarter, and of the cell across its corner.
fn interpolated(corners: [f64; 4]) -> f64 {
    let [own, beside, above, across] = corners;
    0.0625 * (9.0 * own + 3.0 * (beside + above) + across)
}

/// Number of separate partial sums. The processor computes them at the same time.
const LANES: usize = 4;

/// Divides values into groups of [`LANES`] values. No value of a grid is left over, because the
/// side of a grid is even.
fn groups<T>(numbers: &[T]) -> &[[T; LANES]] {
    numbers.as_chunks().0
}

fn groups_mut<T>(numbers: &mut [T]) -> impl Iterator<Item = &mut [T; LANES]> {
    numbers.as_chunks_mut().0.iter_mut()
}

#[inline]
fn keep_larger(largest: &mut [f64; LANES], found: [f64; LANES]) {
    *largest = from_fn(|lane| {
        if found[lane] > largest[lane] {
            found[lane]
        } else {
            largest[lane]
        }
    });
}

/// Returns the largest value of all lanes, at least 0.
fn largest(lanes: [f64; LANES]) -> f64 {
    lanes.into_iter().fold(0.0, f64::max)
}

/// Sums over cells. A function computes the terms from the values of each cell, some of which are
/// in double and some in single precision.
struct Sums<const N: usize>([[f64; LANES]; N]);

impl<const N: usize> Default for Sums<N> {
    fn default() -> Self {
        Sums([[0.0; LANES]; N])
    }
}

impl<const N: usize> Sums<N> {
    /// Returns the sums over all cells.
    fn of<const D: usize, const S: usize>(
        double: [&[f64]; D],
        single: [&[f32]; S],
        each: impl Fn([f64; D], [f32; S]) -> [f64; N],
    ) -> [f64; N] {
        let mut sums = Sums::default();
        sums.add(double, single, each);
        sums.total()
    }

    /// Adds the terms of the cells to the sums. The shortest slice determines the number of cells.
    fn add<const D: usize, const S: usize>(
        &mut self,
        double: [&[f64]; D],
        single: [&[f32]; S],
        each: impl Fn([f64; D], [f32; S]) -> [f64; N],
    ) {
        let lengths_of_double = double.iter().map(|numbers| numbers.len());
        let lengths_of_single = single.iter().map(|numbers| numbers.len());
        let count = lengths_of_double
            .chain(lengths_of_single)
            .min()
            .unwrap_or(0);
        let double = double.map(|numbers| &numbers[..count]);
        let single = single.map(|numbers| &numbers[..count]);
        let double_groups = double.map(groups);
        let single_groups = single.map(groups);
        for group in 0..count / LANES {
            let double = double_groups.map(|groups| &groups[group]);
            let single = single_groups.map(|groups| &groups[group]);
            for lane in 0..LANES {
                let terms = each(
                    double.map(|numbers| numbers[lane]),
                    single.map(|numbers| numbers[lane]),
                );
                self.add_to_lane(lane, terms);
            }
        }
        for index in count / LANES * LANES..count {
            let terms = each(
                double.map(|numbers| numbers[index]),
                single.map(|numbers| numbers[index]),
            );
            self.add_to_lane(index % LANES, terms);
        }
    }

    #[inline]
    fn add_to_lane(&mut self, lane: usize, terms: [f64; N]) {
        for (sums, term) in self.0.iter_mut().zip(terms) {
            sums[lane] += term;
        }
    }

    fn total(&self) -> [f64; N] {
        self.0.map(|[a, b, c, d]| a + b + (c + d))
    }
}

/// Solves a contact on nested grids, from the coarsest to the finest. The finest grid is the last
/// of `grids`, and its depths must be set.
///
/// # Errors
/// Returns [`HalfSpaceError::Stopped`] if `stop` returned true.
pub fn press(
    grids: &mut [Grid],
    boundary: Boundary,
    given: Given,
    tolerance: f64,
    height: f64,
    stop: &dyn Fn() -> bool,
) -> Result<Ended, HalfSpaceError> {
    for finer in (1..grids.len()).rev() {
        let (coarse, fine) = grids.split_at_mut(finer);
        coarse[finer - 1].coarsen(&fine[0]);
    }
    grids[0].begin(given);
    let finest = grids.len() - 1;
    for index in 0..finest {
        grids[index].solve(given, tolerance.max(COARSE), height, stop)?;
        let (coarse, fine) = grids.split_at_mut(index + 1);
        fine[0].refine(&coarse[index], given, boundary);
    }
    grids[finest].solve(given, tolerance, height, stop)
}
