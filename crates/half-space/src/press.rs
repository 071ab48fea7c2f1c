//! Contact without adhesion: nested projected conjugate gradients on an active set.
//!
//! Each grid halves the cells of the coarser one, and starts from the solution on it. On a fixed
//! set of cells, preconditioned conjugate gradients (Polak and Ribière) make the gap uniform.
//! Pressures may become negative in the meantime. The set changes where the cells that pull or
//! penetrate outweigh what the gradients have left over. An active set in one loop with the
//! gradients is the idea of Polonsky and Keer (1999).

use super::error::HalfSpaceError;
use super::operators::{Boundary, OWN_DISPLACEMENT, Operators};
use asperity_data::{OutOfMemory, resized};
use std::array::from_fn;

/// Number of cells along the side of the coarsest grid.
pub const COARSEST: usize = 32;
/// Residual to which coarser grids are solved, in rms heights.
const COARSE: f64 = 1e-3;
/// Ratio of the violations of the set to the residual on it at which the set changes.
const OUTWEIGHS: f64 = 1.5;
/// Largest number of steps of the gradients on one grid.
const MOST_STEPS: u64 = 400;

/// Prescribed force or indentation, in units of L and E*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Mean pressure over the square, F/(E* L²).
    MeanPressure(f64),
    /// Indentation from first touch, d/L.
    Indentation(f64),
}

/// End of a solution: its residual and its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// Largest violation of the conditions of contact, in rms heights of the surface.
    pub residual: f64,
    /// True if the required residual is reached.
    pub is_reached: bool,
    /// Number of steps of the gradients on the finest grid.
    pub steps: u64,
    /// Number of convolutions on the finest grid.
    pub convolutions: u64,
}

/// State and memory of one grid.
pub struct Grid {
    pub cells: usize,
    pub operators: Operators,
    /// Depth of the rigid surface below its highest point.
    pub depths: Vec<f64>,
    pub pressure: Vec<f64>,
    /// Sum of displacement and depth of each cell, uniform on the contact.
    pub levels: Vec<f64>,
    /// 1 for a cell off the contact, 0 on it.
    pub outside: Vec<f32>,
    /// Sum of displacement and depth that the contact is to have.
    pub level: f64,
    /// Number of cells of the contact.
    count: f64,
    residual: Vec<f32>,
    former: Vec<f32>,
    gradient: Vec<f32>,
    direction: Vec<f64>,
    image: Vec<f64>,
}

impl Grid {
    /// Returns the number of bytes of a grid and its operators.
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
            former: singles()?,
            gradient: singles()?,
            direction: zeros()?,
            image: zeros()?,
        })
    }

    /// Sets each depth to the mean over four cells of a finer grid.
    pub fn coarsen(&mut self, finer: &Grid) {
        let (cells, fine) = (self.cells, finer.cells);
        for (at, depth) in self.depths.iter_mut().enumerate() {
            let corner = 2 * (at / cells) * fine + 2 * (at % cells);
            let of =
                [corner, corner + 1, corner + fine, corner + fine + 1].map(|at| finer.depths[at]);
            *depth = 0.25 * (of[0] + of[1] + (of[2] + of[3]));
        }
    }

    /// Begins on the coarsest grid: with everything under load, or with all cells that the
    /// undeformed half-space would touch.
    pub fn begin(&mut self, given: Given) {
        match given {
            Given::MeanPressure(mean) => {
                self.pressure.fill(mean);
                self.outside.fill(0.0);
            }
            Given::Indentation(depth) => {
                self.pressure.fill(0.0);
                let outside = |of: &f64| f32::from(u8::from(*of >= depth));
                self.outside
                    .iter_mut()
                    .zip(&self.depths)
                    .for_each(|(out, of)| *out = outside(of));
            }
        }
    }

    /// Begins with the solution of a coarser grid. The edge of the contact lies where a number
    /// changes its sign. The number is the pressure as a displacement of one cell on the contact,
    /// and minus the gap elsewhere.
    pub fn refine(&mut self, coarse: &Grid, given: Given, boundary: Boundary) {
        let own = OWN_DISPLACEMENT / coarse.cells as f64;
        let signed = |at: usize| {
            if coarse.outside[at] == 0.0 {
                own * coarse.pressure[at]
            } else {
                -(coarse.levels[at] - coarse.level).max(0.0)
            }
        };
        let (cells, half) = (self.cells, coarse.cells);
        let apart = |index: usize, is_upper: bool| match (is_upper, boundary) {
            (true, Boundary::Periodic) => (index + 1) % half,
            (false, Boundary::Periodic) => (index + half - 1) % half,
            (true, Boundary::Free) => (index + 1).min(half - 1),
            (false, Boundary::Free) => index.saturating_sub(1),
        };
        let mut any = false;
        for row in 0..cells {
            let (near_row, far_row) = (row / 2, apart(row / 2, row % 2 == 1));
            for column in 0..cells {
                let (near, far) = (column / 2, apart(column / 2, column % 2 == 1));
                let corners = [
                    (near_row, near),
                    (near_row, far),
                    (far_row, near),
                    (far_row, far),
                ]
                .map(|(row, column)| row * half + column);
                let mean = |of: &dyn Fn(usize) -> f64| {
                    let [a, b, c, d] = corners.map(of);
                    0.0625 * (9.0 * a + 3.0 * (b + c) + d)
                };
                let at = row * cells + column;
                let is_on = mean(&signed) > 0.0;
                any |= is_on;
                self.outside[at] = f32::from(u8::from(!is_on));
                self.pressure[at] = if is_on {
                    mean(&|at: usize| coarse.pressure[at]).max(0.0)
                } else {
                    0.0
                };
            }
        }
        if !any && matches!(given, Given::MeanPressure(_)) {
            // A contact of a few cells, all of whose finer cells would be open.
            for at in 0..cells * cells {
                let of = at / cells / 2 * half + at % cells / 2;
                (self.pressure[at], self.outside[at]) = (coarse.pressure[of], coarse.outside[of]);
            }
        }
    }

    /// Brings the pressures to the given mean, and computes the displacements.
    fn load(&mut self, given: Given) {
        if let Given::MeanPressure(mean) = given {
            let [sum] = Sums::of([&self.pressure], [], |[pressure], []| [pressure]);
            let factor = mean * self.pressure.len() as f64 / sum;
            self.pressure
                .iter_mut()
                .for_each(|pressure| *pressure *= factor);
        }
        self.displace();
    }

    /// Computes the displacements by the pressures.
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
            |_, row, to| to.copy_from_slice(&pressure[row * cells..][..cells]),
            |levels, row, displacement| {
                let of = displacement.iter().zip(&depths[row * cells..]);
                levels[row * cells..]
                    .iter_mut()
                    .zip(of)
                    .for_each(|(to, (u, z))| *to = u + z);
            },
        );
    }

    /// Sets the level of the contact: the given indentation, or the mean over the contact.
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

    /// Moves by a length along the direction, and finds the residuals on the contact. Returns the
    /// largest of them, the deepest penetration elsewhere and the lowest pressure.
    fn advance(&mut self, length: f64) -> [f64; 3] {
        std::mem::swap(&mut self.residual, &mut self.former);
        let level = self.level;
        let mut found = [[0.0; LANES]; 3];
        let moved = groups_of(&mut self.pressure).zip(groups_of(&mut self.levels));
        let by = groups(&self.direction).iter().zip(groups(&self.image));
        let cells = groups(&self.outside)
            .iter()
            .zip(groups_of(&mut self.residual));
        for (((p, u), (direction, image)), (out, residual)) in moved.zip(by).zip(cells) {
            // Group by group, for instructions on several numbers.
            *p = from_fn(|lane| p[lane] + length * direction[lane]);
            *u = from_fn(|lane| u[lane] + length * image[lane]);
            let (missing, out) = (u.map(|u| level - u), out.map(f64::from));
            let on: [f64; LANES] = from_fn(|lane| (1.0 - out[lane]) * missing[lane]);
            *residual = on.map(|on| on as f32);
            let beyond = from_fn(|lane| out[lane] * missing[lane]);
            for (most, of) in found
                .iter_mut()
                .zip([on.map(f64::abs), beyond, p.map(|p| -p)])
            {
                *most = from_fn(|lane| {
                    if of[lane] > most[lane] {
                        of[lane]
                    } else {
                        most[lane]
                    }
                });
            }
        }
        let [on_contact, beyond, pull] = found.map(|lanes| lanes.into_iter().fold(0.0, f64::max));
        [on_contact, beyond, -pull]
    }

    /// Removes cells that pull or carry nothing, and adds cells that penetrate. Returns true if a
    /// pressure was removed.
    fn change_set(&mut self) -> bool {
        let mut is_clipped = false;
        let level = self.level;
        for ((pressure, out), of) in self
            .pressure
            .iter_mut()
            .zip(&mut self.outside)
            .zip(&self.levels)
        {
            if *out == 0.0 && *pressure <= 0.0 {
                is_clipped |= *pressure < 0.0;
                (*pressure, *out) = (0.0, 1.0);
            } else if *out == 1.0 && level > *of {
                *out = 0.0;
            }
        }
        is_clipped
    }

    /// Solves the contact on this grid to a residual in rms heights `height`.
    pub fn solve(
        &mut self,
        given: Given,
        (tolerance, height): (f64, f64),
        stop: &dyn Fn() -> bool,
    ) -> Result<Ended, HalfSpaceError> {
        let before = self.operators.convolutions;
        let own = OWN_DISPLACEMENT / self.cells as f64;
        self.load(given);
        self.find_level(given);
        let mut found = self.advance(0.0);
        // Scalar product of the last gradient and residual; without one the next step is that of
        // the steepest descent.
        let mut last = None;
        let mut steps = 0;
        loop {
            let [on_contact, beyond, lowest] = found;
            let residual = on_contact.max(beyond) / height;
            let is_reached = residual <= tolerance && lowest >= 0.0;
            if is_reached || steps == MOST_STEPS {
                let convolutions = self.operators.convolutions - before;
                return Ok(Ended {
                    residual,
                    is_reached,
                    steps,
                    convolutions,
                });
            }
            if stop() {
                return Err(HalfSpaceError::Stopped);
            }
            if last.is_some() && beyond.max(own * -lowest) > OUTWEIGHS * on_contact {
                if self.change_set() {
                    self.load(given);
                }
                self.find_level(given);
                (last, found) = (None, self.advance(0.0));
            } else {
                let (product, next) = self.step(given, last);
                (last, found) = (Some(product), next);
                steps += 1;
            }
        }
    }

    /// Solves on the present contact, whose pressures may pull, at the indentation `depth`, until
    /// no displacement on it is off by more than `tolerance`.
    pub fn solve_fixed(
        &mut self,
        depth: f64,
        tolerance: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), HalfSpaceError> {
        self.level = depth;
        let mut found = self.advance(0.0);
        let mut last = None;
        for _ in 0..MOST_STEPS {
            if found[0] <= tolerance {
                break;
            }
            if stop() {
                return Err(HalfSpaceError::Stopped);
            }
            let (product, next) = self.step(Given::Indentation(depth), last);
            (last, found) = (Some(product), next);
        }
        Ok(())
    }

    /// Makes one step of the gradients on the present contact. Returns the product that the next
    /// step needs, and what `advance` finds.
    fn step(&mut self, given: Given, last: Option<f64>) -> (f64, [f64; 3]) {
        let Grid {
            cells,
            operators,
            residual,
            former,
            outside,
            gradient,
            direction,
            image,
            ..
        } = self;
        let cells = *cells;
        let mut found = Sums::default();
        operators.precondition(residual, outside, gradient, |row, gradient| {
            let singles = [gradient, &residual[row * cells..], &former[row * cells..]];
            found.add([], singles, |[], [gradient, residual, former]| {
                let of = |value: f32| f64::from(gradient) * f64::from(value);
                [of(residual), of(former), f64::from(gradient)]
            });
        });
        let [product, former, total] = found.total();
        // Under a force the mean of the residual over the contact is zero, and so is the mean of
        // the step.
        let count = self.count;
        let mean_of = |total: f64| {
            if matches!(given, Given::MeanPressure(_)) {
                total / count
            } else {
                0.0
            }
        };
        let (mean, turned) = (mean_of(total), product - former);
        let carried = last.map_or(0.0, |last| {
            if last > 0.0 {
                (turned / last).max(0.0)
            } else {
                0.0
            }
        });
        let mut context = (direction, image, Sums::default());
        operators.displace(
            &mut context,
            |(direction, ..), row, to| {
                let singles = gradient[row * cells..].iter().zip(&outside[row * cells..]);
                let both = direction[row * cells..].iter_mut().zip(to);
                for ((direction, to), (gradient, out)) in both.zip(singles) {
                    *direction = f64::from(*gradient) - (1.0 - f64::from(*out)) * mean
                        + carried * *direction;
                    *to = *direction;
                }
            },
            |(direction, image, found), row, of| {
                image[row * cells..][..cells].copy_from_slice(of);
                let singles = [&residual[row * cells..], &outside[row * cells..]];
                found.add(
                    [of, &direction[row * cells..]],
                    singles,
                    |[image, direction], [residual, out]| {
                        [
                            direction * f64::from(residual),
                            direction * image,
                            (1.0 - f64::from(out)) * image,
                        ]
                    },
                );
            },
        );
        let [along, curvature, total] = context.2.total();
        let length = if curvature > 0.0 {
            along / curvature
        } else {
            0.0
        };
        self.level += length * mean_of(total);
        (product, self.advance(length))
    }
}

/// Numbers that are summed side by side, in an order of their own.
const LANES: usize = 4;

/// Returns the numbers in groups. The numbers of a grid, whose side is even, leave no rest.
fn groups<T>(of: &[T]) -> &[[T; LANES]] {
    of.as_chunks().0
}

fn groups_of<T>(of: &mut [T]) -> impl Iterator<Item = &mut [T; LANES]> {
    of.as_chunks_mut().0.iter_mut()
}

/// Sums over cells of what a function makes of their numbers, in double and in single precision.
struct Sums<const N: usize>([[f64; LANES]; N]);

impl<const N: usize> Default for Sums<N> {
    fn default() -> Self {
        Sums([[0.0; LANES]; N])
    }
}

impl<const N: usize> Sums<N> {
    /// The sums over all cells.
    fn of<const D: usize, const S: usize>(
        double: [&[f64]; D],
        single: [&[f32]; S],
        each: impl Fn([f64; D], [f32; S]) -> [f64; N],
    ) -> [f64; N] {
        let mut sums = Sums::default();
        sums.add(double, single, each);
        sums.total()
    }

    /// Adds as many cells as the shortest slice has.
    fn add<const D: usize, const S: usize>(
        &mut self,
        double: [&[f64]; D],
        single: [&[f32]; S],
        each: impl Fn([f64; D], [f32; S]) -> [f64; N],
    ) {
        let count = double
            .iter()
            .map(|of| of.len())
            .chain(single.iter().map(|of| of.len()))
            .min();
        let count = count.unwrap_or(0);
        let (double, single) = (double.map(|of| &of[..count]), single.map(|of| &of[..count]));
        let mut add = |lane: usize, of: [f64; N]| {
            self.0
                .iter_mut()
                .zip(of)
                .for_each(|(total, of)| total[lane] += of);
        };
        let (doubles, singles) = (double.map(groups), single.map(groups));
        for group in 0..count / LANES {
            let (double, single) = (doubles.map(|of| &of[group]), singles.map(|of| &of[group]));
            (0..LANES).for_each(|lane| {
                add(
                    lane,
                    each(double.map(|of| of[lane]), single.map(|of| of[lane])),
                )
            });
        }
        for at in count / LANES * LANES..count {
            add(
                at % LANES,
                each(double.map(|of| of[at]), single.map(|of| of[at])),
            );
        }
    }

    fn total(&self) -> [f64; N] {
        self.0.map(|[a, b, c, d]| a + b + (c + d))
    }
}

/// Solves a contact on nested grids, the finest one last, whose depths are set.
pub fn press(
    grids: &mut [Grid],
    boundary: Boundary,
    given: Given,
    (tolerance, height): (f64, f64),
    stop: &dyn Fn() -> bool,
) -> Result<Ended, HalfSpaceError> {
    for finer in (1..grids.len()).rev() {
        let (coarse, fine) = grids.split_at_mut(finer);
        coarse[finer - 1].coarsen(&fine[0]);
    }
    grids[0].begin(given);
    let finest = grids.len() - 1;
    for at in 0..=finest {
        if at > 0 {
            let (coarse, fine) = grids.split_at_mut(at);
            fine[0].refine(&coarse[at - 1], given, boundary);
        }
        let asked = if at == finest {
            tolerance
        } else {
            tolerance.max(COARSE)
        };
        let ended = grids[at].solve(given, (asked, height), stop)?;
        if at == finest {
            return Ok(ended);
        }
    }
    Err(HalfSpaceError::Stopped)
}
