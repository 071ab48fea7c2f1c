//! A rigid rough square on a half-space: the front of the crate, in SI units.

use super::error::HalfSpaceError;
use super::operators::Boundary;
use super::press::{COARSEST, Ended, Given, Grid, press};
use asperity_data::check_room;

/// Most cells along a side.
const FINEST: usize = 8192;

/// A rigid rough square above an elastic half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square<'a> {
    /// Heights of the cells, m, row by row, peaks up.
    pub heights: &'a [f64],
    /// Side L, m.
    pub side: f64,
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
}

/// What presses the bodies together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Force, N, positive in compression. The force of one period of a periodic square.
    Force(f64),
    /// Indentation, m, from first touch. Only of a free square: the displacement of a periodic half-space has no zero.
    Indentation(f64),
}

/// A contact without adhesion.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// Pressure on each cell, Pa.
    pub pressure: Vec<f64>,
    /// Gap above each cell, m; zero on the contact to within the residual.
    pub gap: Vec<f64>,
    /// Force, N.
    pub force: f64,
    /// Indentation from first touch, m; of a periodic square the distance of the highest point from the mean plane of the
    /// deformed half-space.
    pub indentation: f64,
    /// Area of the cells in contact, m².
    pub area: f64,
    /// Largest violation of the conditions of contact over the rms height: of a gap of zero on the contact, of a gap of at
    /// least zero elsewhere. Pressures are at least zero, and their sum is the force, exactly.
    pub residual: f64,
    /// True if the asked residual is reached; false where the steps of the solver ended before.
    pub is_reached: bool,
    /// Convolutions on the finest grid.
    pub convolutions: u64,
}

/// Planned operators and memory for squares of one number of cells.
pub struct HalfSpace {
    boundary: Boundary,
    /// Nested grids, the finest one last.
    grids: Vec<Grid>,
}

impl HalfSpace {
    /// Bytes of the operators and the memory.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        nested(cells).map(|cells| Grid::bytes(cells, boundary)).sum()
    }

    /// Plans the contact of squares with this number of cells along a side.
    ///
    /// # Errors
    /// The number of cells is not a power of two from 32 to 8192, or the memory is insufficient.
    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, HalfSpaceError> {
        if !cells.is_power_of_two() || !(COARSEST..=FINEST).contains(&cells) {
            return Err(HalfSpaceError::Cells(cells));
        }
        check_room(HalfSpace::bytes(cells, boundary))?;
        let grids = nested(cells).map(|cells| Grid::new(cells, boundary)).collect::<Result<Vec<_>, _>>()?;
        Ok(HalfSpace { boundary, grids })
    }

    /// Presses a square on the half-space without adhesion, to a residual of `tolerance` rms heights. `stop` is asked before
    /// each step.
    ///
    /// # Errors
    /// A value is out of its range, or `stop` returned true.
    pub fn press(
        &mut self,
        square: &Square<'_>,
        load: Load,
        tolerance: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Pressed, HalfSpaceError> {
        let Square { side, effective_modulus, .. } = *square;
        let positive = |name, found: f64| match found.is_normal() && found > 0.0 {
            true => Ok(()),
            false => Err(HalfSpaceError::Value { name, found, allowed: "a positive number" }),
        };
        positive("side", side)?;
        positive("effective modulus", effective_modulus)?;
        positive("tolerance", tolerance)?;
        let given = match load {
            Load::Force(force) => {
                positive("force", force)?;
                Given::MeanPressure(force / (effective_modulus * side * side))
            }
            Load::Indentation(depth) => {
                positive("indentation", depth)?;
                if self.boundary == Boundary::Periodic {
                    let allowed = "a force: the displacement of a periodic half-space has no zero";
                    return Err(HalfSpaceError::Value { name: "indentation", found: depth, allowed });
                }
                Given::Indentation(depth / side)
            }
        };
        let height = self.lay(square)?;
        // A flat punch has no height: its residual is over its indentation by the mean pressure.
        let height = if height > 0.0 {
            height
        } else {
            match given {
                Given::MeanPressure(mean) => mean,
                Given::Indentation(depth) => depth,
            }
        };
        let ended = press(&mut self.grids, self.boundary, given, (tolerance, height), stop)?;
        Ok(self.pressed(square, ended))
    }

    /// Sets the depths of the finest grid; returns the rms height in units of the side.
    fn lay(&mut self, square: &Square<'_>) -> Result<f64, HalfSpaceError> {
        let Some(grid) = self.grids.last_mut() else { return Ok(0.0) };
        let allowed = grid.cells * grid.cells;
        if square.heights.len() != allowed {
            return Err(HalfSpaceError::Heights { found: square.heights.len(), allowed });
        }
        let mut highest = f64::NEG_INFINITY;
        for &found in square.heights {
            if !(found / square.side).is_finite() {
                return Err(HalfSpaceError::Value { name: "height", found, allowed: "finite numbers" });
            }
            highest = highest.max(found);
        }
        let depths = square.heights.iter().map(|height| (highest - height) / square.side);
        grid.depths.iter_mut().zip(depths).for_each(|(to, of)| *to = of);
        let mean = grid.depths.iter().sum::<f64>() / allowed as f64;
        let square = grid.depths.iter().map(|depth| (depth - mean).powi(2)).sum::<f64>();
        Ok((square / allowed as f64).sqrt())
    }

    fn pressed(&self, square: &Square<'_>, ended: Ended) -> Pressed {
        let Some(grid) = self.grids.last() else { unreachable!("a half-space has a grid") };
        let Square { side, effective_modulus, .. } = *square;
        let cell = (side / grid.cells as f64).powi(2);
        let pressure: Vec<f64> = grid.pressure.iter().map(|value| value * effective_modulus).collect();
        let gap = grid.displacement.iter().zip(&grid.depths).map(|(of, depth)| (of + depth - grid.level) * side);
        Pressed {
            gap: gap.collect(),
            force: cell * pressure.iter().sum::<f64>(),
            indentation: grid.level * side,
            area: cell * grid.outside.iter().filter(|out| **out == 0.0).count() as f64,
            residual: ended.residual,
            is_reached: ended.is_reached,
            convolutions: ended.convolutions,
            pressure,
        }
    }
}

/// Cells along the sides of nested grids, the coarsest first.
fn nested(cells: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(COARSEST), |cells| Some(2 * cells)).take_while(move |of| *of <= cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn run(cells: usize, boundary: Boundary, height: impl Fn(f64, f64) -> f64, load: Load) -> Pressed {
        let at = |index: usize| (index as f64 + 0.5) / cells as f64 - 0.5;
        let heights: Vec<f64> =
            (0..cells * cells).map(|index| height(at(index % cells), at(index / cells))).collect();
        let square = Square { heights: &heights, side: 1.0, effective_modulus: 1.0 };
        let mut half_space = HalfSpace::new(cells, boundary).unwrap();
        let pressed = half_space.press(&square, load, 1e-8, &|| false).unwrap();
        assert!(pressed.is_reached, "{pressed:?}");
        pressed
    }

    #[test]
    fn a_sphere_is_that_of_hertz() {
        let radius = 1.0;
        for (cells, bound) in [(64, 2e-3), (128, 5e-4)] {
            let contact: f64 = 0.2;
            let force = 4.0 / 3.0 * contact.powi(3) / radius;
            let sphere = |x: f64, y: f64| -(x * x + y * y) / (2.0 * radius);
            let found = run(cells, Boundary::Free, sphere, Load::Force(force));
            let summit = 2.0 * (0.5 / cells as f64).powi(2) / (2.0 * radius);
            let depth = found.indentation + summit;
            println!(
                "{cells} cells: {} convolutions, indentation {:.2e}, area {:.2e}, pressure {:.2e}",
                found.convolutions,
                depth / (contact * contact / radius) - 1.0,
                found.area / (PI * contact * contact) - 1.0,
                found.pressure.iter().copied().fold(0.0, f64::max) / (2.0 * contact / (PI * radius)) - 1.0
            );
            assert!((depth / (contact * contact / radius) - 1.0).abs() < bound);
            assert!((found.area / (PI * contact * contact) - 1.0).abs() < 0.02);
            let same = run(cells, Boundary::Free, sphere, Load::Indentation(found.indentation));
            assert!((same.force / force - 1.0).abs() < 1e-6, "{} {force}", same.force);
        }
    }

    #[test]
    fn a_flat_square_has_its_stiffness() {
        for cells in [64, 128] {
            let found = run(cells, Boundary::Free, |_, _| 0.0, Load::Force(1e-3));
            let stiffness = found.force / found.indentation;
            println!("{cells} cells: stiffness {stiffness}, {} convolutions", found.convolutions);
            assert!((stiffness / 1.151 - 1.0).abs() < 5e-3, "{stiffness}");
        }
    }
}
