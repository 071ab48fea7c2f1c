//! A rigid rough square on a half-space, in SI units.

use super::error::HalfSpaceError;
use super::operators::Boundary;
use super::press::{COARSEST, Ended, Given, Grid, press};
use asperity_data::check_room;

/// Largest number of cells along a side.
const FINEST: usize = 8192;

/// A rigid rough square above an elastic half-space. The square is divided into equal square cells,
/// with the same number of cells along each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square<'a> {
    /// Height of each cell in m, row by row. The highest cell touches first.
    pub heights: &'a [f64],
    /// Side L of the square in m.
    pub side: f64,
    /// Effective modulus E* in Pa.
    pub modulus: f64,
}

/// The prescribed load of a contact: its force or its indentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Force in N, positive in compression. With [`Boundary::Periodic`] this is the force on one of
    /// the copies of the square.
    Force(f64),
    /// Indentation in m from first touch. It can be prescribed only with [`Boundary::Free`]. With
    /// [`Boundary::Periodic`] the mean displacement of the half-space is not determined, so a force
    /// must be prescribed.
    Indentation(f64),
}

/// Solution of a contact without adhesion: pressures, gaps, force and indentation.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// Pressure on each cell in Pa.
    pub pressure: Vec<f64>,
    /// Gap between the square and the half-space at each cell in m. In a cell in contact the gap
    /// should be zero; [`Pressed::residual`] is a measure of the deviation.
    pub gap: Vec<f64>,
    /// Force on the square in N: the sum of the pressures times the area of a cell. Compression is
    /// positive.
    pub force: f64,
    /// Indentation in m from first touch. With [`Boundary::Periodic`] this is the depth of the
    /// highest point of the square below the mean plane of the deformed half-space.
    pub indentation: f64,
    /// Contact area in m²: the sum of the areas of the cells in contact.
    pub area: f64,
    /// Largest deviation of the gap of any cell, divided by the rms height of the square. For a
    /// cell in contact the deviation is the absolute value of the gap. For any other cell it is the
    /// depth of penetration. A flat square has the rms height zero. Its deviation is divided by the
    /// prescribed indentation instead, or by F/(E* L) for a prescribed force F and the side L.
    pub residual: f64,
    /// True if the solver has reached its goal: `residual` is at most the required tolerance, and
    /// no pressure is negative. False if the solver has used all its steps without reaching the
    /// goal.
    pub is_reached: bool,
    /// Number of convolutions that the solver computed on its finest grid, whose cells are the
    /// cells of the square. This number is a measure of the computing work.
    pub convolutions: u64,
}

/// Solver for contacts of squares that all have the same number of cells.
pub struct HalfSpace {
    boundary: Boundary,
    /// Nested grids, the finest one last.
    grids: Vec<Grid>,
}

impl HalfSpace {
    /// Returns the memory in bytes that a solver needs for squares with `cells` cells along a side.
    pub fn bytes(cells: usize, boundary: Boundary) -> u64 {
        nested(cells)
            .map(|cells| Grid::bytes(cells, boundary))
            .sum()
    }

    /// Creates a solver for squares with `cells` cells along a side.
    ///
    /// # Errors
    /// Returns an error if the number of cells is not a power of two from 32 to 8192, or if there
    /// is not enough memory.
    pub fn new(cells: usize, boundary: Boundary) -> Result<Self, HalfSpaceError> {
        check_cells(cells)?;
        check_room(HalfSpace::bytes(cells, boundary))?;
        let grids = nested(cells)
            .map(|cells| Grid::new(cells, boundary))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(HalfSpace { boundary, grids })
    }

    /// Computes the contact of a square with the half-space under a load, without adhesion. The
    /// solver improves the pressures in steps until [`Pressed::residual`] is at most `tolerance`.
    /// `stop` is called before each step. If `stop` returns true, the solver ends with
    /// [`HalfSpaceError::Stopped`].
    ///
    /// # Errors
    /// Returns an error if the number of heights differs from the number of cells of this solver,
    /// if a value is out of its range, or if `stop` returned true.
    pub fn press(
        &mut self,
        square: &Square<'_>,
        load: Load,
        tolerance: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Pressed, HalfSpaceError> {
        let Square { side, modulus, .. } = *square;
        positive("side", side)?;
        positive("effective modulus", modulus)?;
        positive("tolerance", tolerance)?;
        let given = match load {
            Load::Force(force) => {
                positive("force", force)?;
                Given::MeanPressure(force / (modulus * side * side))
            }
            Load::Indentation(depth) => {
                positive("indentation", depth)?;
                if self.boundary == Boundary::Periodic {
                    return Err(HalfSpaceError::Value {
                        name: "indentation",
                        found: depth,
                        allowed: "a force: the displacement of a periodic half-space has no zero",
                    });
                }
                Given::Indentation(depth / side)
            }
        };
        let rms_height = self.set_depths(square)?;
        // A flat punch has an rms height of zero. Its residual is divided by the indentation, or by
        // the mean pressure in units of E*.
        let height = if rms_height > 0.0 {
            rms_height
        } else {
            match given {
                Given::MeanPressure(mean) => mean,
                Given::Indentation(depth) => depth,
            }
        };
        let ended = press(
            &mut self.grids,
            self.boundary,
            given,
            tolerance,
            height,
            stop,
        )?;
        Ok(self.pressed(square, ended))
    }

    /// Sets the depth of each cell of the finest grid below the highest cell. Returns the rms
    /// height of the square in units of its side.
    fn set_depths(&mut self, square: &Square<'_>) -> Result<f64, HalfSpaceError> {
        let Some(grid) = self.grids.last_mut() else {
            return Ok(0.0);
        };
        let allowed = grid.cells * grid.cells;
        if square.heights.len() != allowed {
            return Err(HalfSpaceError::Heights {
                found: square.heights.len(),
                allowed,
            });
        }
        let highest = highest(square)?;
        for (depth, height) in grid.depths.iter_mut().zip(square.heights) {
            *depth = (highest - height) / square.side;
        }
        let count = allowed as f64;
        let mean = grid.depths.iter().sum::<f64>() / count;
        let squares: f64 = grid.depths.iter().map(|depth| (depth - mean).powi(2)).sum();
        Ok((squares / count).sqrt())
    }

    fn pressed(&self, square: &Square<'_>, ended: Ended) -> Pressed {
        let Some(grid) = self.grids.last() else {
            unreachable!("a half-space has a grid")
        };
        let Square { side, modulus, .. } = *square;
        let cell = (side / grid.cells as f64).powi(2);
        let pressure: Vec<f64> = grid.pressure.iter().map(|value| value * modulus).collect();
        Pressed {
            gap: grid
                .levels
                .iter()
                .map(|level| (level - grid.level) * side)
                .collect(),
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

/// Checks that a number of cells along a side is allowed: a power of two from 32 to 8192.
///
/// # Errors
/// Returns an error if the number is not a power of two from 32 to 8192.
pub fn check_cells(cells: usize) -> Result<(), HalfSpaceError> {
    let is_allowed = cells.is_power_of_two() && (COARSEST..=FINEST).contains(&cells);
    if is_allowed {
        Ok(())
    } else {
        Err(HalfSpaceError::Cells(cells))
    }
}

/// Returns the largest height of a square in m.
///
/// # Errors
/// Returns an error if a height is not finite.
pub fn highest(square: &Square<'_>) -> Result<f64, HalfSpaceError> {
    let mut highest = f64::NEG_INFINITY;
    for &found in square.heights {
        if !(found / square.side).is_finite() {
            return Err(HalfSpaceError::Value {
                name: "height",
                found,
                allowed: "finite numbers",
            });
        }
        highest = highest.max(found);
    }
    Ok(highest)
}

/// Returns an error unless the value `found` is positive. `name` is the name of the value in the
/// error.
pub fn positive(name: &'static str, found: f64) -> Result<(), HalfSpaceError> {
    if found.is_normal() && found > 0.0 {
        return Ok(());
    }
    Err(HalfSpaceError::Value {
        name,
        found,
        allowed: "a positive number",
    })
}

/// Returns the numbers of cells along the sides of the nested grids, beginning with the coarsest
/// grid.
fn nested(cells: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(COARSEST), |cells| Some(2 * cells))
        .take_while(move |side| *side <= cells)
}

#[cfg(test)]
mod tests {
    use super::super::map::random_map;
    use super::*;
    use std::f64::consts::PI;

    fn run(
        cells: usize,
        boundary: Boundary,
        height: impl Fn(f64, f64) -> f64,
        load: Load,
    ) -> Pressed {
        let at = |index: usize| (index as f64 + 0.5) / cells as f64 - 0.5;
        let heights: Vec<f64> = (0..cells * cells)
            .map(|index| height(at(index % cells), at(index / cells)))
            .collect();
        let square = Square {
            heights: &heights,
            side: 1.0,
            modulus: 1.0,
        };
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
            let largest = found.pressure.iter().copied().fold(0.0, f64::max);
            assert!((largest / (2.0 * contact / (PI * radius)) - 1.0).abs() < 5.0 * bound);
            assert!((depth / (contact * contact / radius) - 1.0).abs() < bound);
            assert!((found.area / (PI * contact * contact) - 1.0).abs() < 0.02);
            let same = run(
                cells,
                Boundary::Free,
                sphere,
                Load::Indentation(found.indentation),
            );
            assert!(
                (same.force / force - 1.0).abs() < 1e-6,
                "{} {force}",
                same.force
            );
        }
    }

    #[test]
    fn a_flat_square_has_its_stiffness() {
        for (cells, stiffness) in [(64, 1.1462), (128, 1.1492), (256, 1.1507)] {
            let found = run(cells, Boundary::Free, |_, _| 0.0, Load::Force(1e-3));
            assert!(
                (found.force / found.indentation / stiffness - 1.0).abs() < 1e-4,
                "{found:?}"
            );
        }
    }

    /// The solver finds the closed forms of Westergaard (1939): partial contact of a wave along one
    /// side, and full contact of waves along both sides.
    #[test]
    fn waves_are_in_contact_as_westergaard_says() {
        let cells = 256;
        let amplitude = 0.01;
        let wave = |x: f64, _: f64| amplitude * (2.0 * PI * x).cos();
        let full = PI * amplitude;
        for share in [0.1_f64, 0.5, 0.9] {
            let found = run(cells, Boundary::Periodic, wave, Load::Force(share * full));
            let area = 2.0 / PI * share.sqrt().asin();
            assert!(
                (found.area - area).abs() <= 2.0 / cells as f64,
                "{share}: {} {area}",
                found.area
            );
            assert!(found.convolutions < 40, "{share}: {}", found.convolutions);
        }
        let waves = |x: f64, y: f64| amplitude * ((2.0 * PI * x).cos() + (2.0 * PI * y).cos());
        for (share, is_full) in [(0.99, false), (1.01, true)] {
            let found = run(
                cells,
                Boundary::Periodic,
                waves,
                Load::Force(2.0 * share * full),
            );
            assert_eq!(found.area == 1.0, is_full, "{share}: {}", found.area);
        }
    }

    fn rough(cells: usize, hurst: f64, seed: u64) -> Vec<f64> {
        let last = cells as f64 / 8.0;
        let power = |k: f64| {
            if k <= last {
                1e-5 * k.powf(-2.0 * hurst - 2.0)
            } else {
                0.0
            }
        };
        random_map(cells, power, seed).unwrap()
    }

    /// Rough squares of three Hurst exponents are pressed by all loads up to full contact. The
    /// conditions of contact hold, and the solver does not take longer near full contact.
    #[test]
    fn rough_squares_are_solved_at_any_load() {
        for (boundary, hurst) in [
            (Boundary::Periodic, 0.3),
            (Boundary::Periodic, 0.8),
            (Boundary::Free, 0.5),
        ] {
            let heights = rough(128, hurst, 5);
            let square = Square {
                heights: &heights,
                side: 1.0,
                modulus: 1.0,
            };
            let mut half_space = HalfSpace::new(128, boundary).unwrap();
            let mut counts = Vec::new();
            let mut areas = vec![0.0];
            for exponent in -16..=4 {
                let force = 0.3 * 2.0_f64.powf(0.5 * f64::from(exponent));
                let found = half_space
                    .press(&square, Load::Force(force), 1e-8, &|| false)
                    .unwrap();
                assert!(
                    found.is_reached && (found.force / force - 1.0).abs() < 1e-12,
                    "{force}"
                );
                assert!(found.pressure.iter().all(|pressure| *pressure >= 0.0));
                let height =
                    (heights.iter().map(|z| z * z).sum::<f64>() / heights.len() as f64).sqrt();
                assert!(found.gap.iter().all(|gap| *gap >= -1.1e-8 * height));
                let pressed = found
                    .gap
                    .iter()
                    .zip(&found.pressure)
                    .filter(|(_, pressure)| **pressure > 0.0);
                assert!(pressed.map(|(gap, _)| gap.abs()).fold(0.0, f64::max) <= 1.1e-8 * height);
                assert!(found.area >= areas[areas.len() - 1], "{force}");
                areas.push(found.area);
                counts.push((found.area, found.convolutions));
            }
            let most = |range: std::ops::Range<f64>| {
                counts
                    .iter()
                    .filter(|(area, _)| range.contains(area))
                    .map(|(_, count)| *count)
                    .max()
            };
            assert!(
                most(0.0..0.6) <= Some(50) && most(0.9..1.1) <= most(0.0..0.6),
                "{counts:?}"
            );
            assert!(most(0.9..1.1).is_some(), "{counts:?}");
        }
    }

    /// At light loads the area of contact is about 2F/(E*h′), where h′ is the rms gradient. The
    /// cells at the edge of the contact are only partly in contact. For each side of a cell along
    /// the edge, the area is therefore corrected by a tenth of a cell.
    #[test]
    fn the_area_at_light_loads_is_proportional_to_the_force() {
        let (cells, last) = (128, 8.0);
        let mut slopes = Vec::new();
        for seed in 1..=4 {
            let heights = random_map(
                cells,
                |k| if k <= last { 1e-5 * k.powf(-3.6) } else { 0.0 },
                seed,
            )
            .unwrap();
            let near = |at: usize| {
                [
                    at / cells * cells + (at + 1) % cells,
                    (at + cells) % (cells * cells),
                ]
            };
            let slope = |at: usize| {
                near(at)
                    .map(|next| (heights[next] - heights[at]).powi(2))
                    .iter()
                    .sum::<f64>()
            };
            let gradient = (0..cells * cells).map(slope).sum::<f64>().sqrt();
            let square = Square {
                heights: &heights,
                side: 1.0,
                modulus: 1.0,
            };
            let mut half_space = HalfSpace::new(cells, Boundary::Periodic).unwrap();
            let force = 0.04 * gradient;
            let found = half_space
                .press(&square, Load::Force(force), 1e-8, &|| false)
                .unwrap();
            let is_edge = |at: usize| {
                near(at).map(|next| (found.pressure[next] > 0.0) != (found.pressure[at] > 0.0))
            };
            let edges = (0..cells * cells)
                .flat_map(is_edge)
                .filter(|is_edge| *is_edge)
                .count() as f64;
            slopes.push((found.area - 0.1 * edges / (cells * cells) as f64) * gradient / force);
        }
        println!("slopes of the area: {slopes:.3?}");
        let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
        assert!((1.7..2.3).contains(&mean), "{slopes:?}");
    }

    /// If the surface is turned by a quarter turn and mirrored, the pressures are turned and
    /// mirrored too.
    #[test]
    fn turned_squares_have_turned_pressures() {
        let (cells, heights) = (64, rough(64, 0.8, 3));
        let turn = |cell: usize| (cells - 1 - cell % cells) * cells + cell / cells;
        let turned: Vec<f64> = (0..cells * cells).map(|cell| heights[turn(cell)]).collect();
        let mut half_space = HalfSpace::new(cells, Boundary::Free).unwrap();
        let [one, other] = [&heights, &turned].map(|heights| {
            let square = Square {
                heights,
                side: 1.0,
                modulus: 1.0,
            };
            half_space
                .press(&square, Load::Force(0.02), 1e-10, &|| false)
                .unwrap()
        });
        let largest = one.pressure.iter().copied().fold(0.0, f64::max);
        for at in 0..cells * cells {
            assert!(
                (one.pressure[turn(at)] - other.pressure[at]).abs() < 1e-6 * largest,
                "{at}"
            );
        }
        assert!((one.indentation / other.indentation - 1.0).abs() < 1e-9);
    }

    /// A contact in other units is the same contact. Pressures scale with E*, forces with E*L², and
    /// lengths with L.
    #[test]
    fn a_contact_scales_with_its_modulus_and_side() {
        let (cells, heights) = (32, rough(32, 0.8, 7));
        let unit = Square {
            heights: &heights,
            side: 1.0,
            modulus: 1.0,
        };
        let near = |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * expected.abs();
        let mut half_space = HalfSpace::new(cells, Boundary::Free).unwrap();
        let mut press = |square: &Square<'_>, load: Load| {
            half_space.press(square, load, 1e-12, &|| false).unwrap()
        };
        for (side, modulus) in [(1e-4, 2e6), (3.0, 1.0), (1.0, 5e-3), (7e2, 4e9)] {
            let scaled: Vec<f64> = heights.iter().map(|height| height * side).collect();
            let square = Square {
                heights: &scaled,
                side,
                modulus,
            };
            let force = 2e-3;
            let expected = press(&unit, Load::Force(force));
            let indentation = expected.indentation;
            for load in [
                Load::Force(force * modulus * side * side),
                Load::Indentation(indentation * side),
            ] {
                let found = press(&square, load);
                assert!(
                    near(found.force, force * modulus * side * side),
                    "{load:?}: {}",
                    found.force
                );
                assert!(
                    near(found.indentation, indentation * side),
                    "{load:?}: {}",
                    found.indentation
                );
                assert!(
                    near(found.area, expected.area * side * side),
                    "{load:?}: {}",
                    found.area
                );
                let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
                let pressure = largest(&found.pressure);
                assert!(
                    near(pressure, largest(&expected.pressure) * modulus),
                    "{load:?}: {pressure}"
                );
                let gap = largest(&found.gap);
                assert!(near(gap, largest(&expected.gap) * side), "{load:?}: {gap}");
            }
        }
    }

    #[test]
    fn values_out_of_range_are_named() {
        let refused = |cells| {
            HalfSpace::new(cells, Boundary::Free)
                .err()
                .unwrap()
                .to_string()
        };
        for cells in [0, 31, 33, 48, 16_384] {
            let expected =
                format!("{cells} cells along a side; allowed: a power of two from 32 to 8192");
            assert_eq!(refused(cells), expected);
        }
        let heights = vec![0.0; 32 * 32];
        let square = Square {
            heights: &heights,
            side: 1.0,
            modulus: 1.0,
        };
        let on = |boundary, square: &Square<'_>, load| {
            let mut half_space = HalfSpace::new(32, boundary).unwrap();
            half_space
                .press(square, load, 1e-8, &|| false)
                .unwrap_err()
                .to_string()
        };
        let free = |square: &Square<'_>, load| on(Boundary::Free, square, load);
        for force in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let expected = format!("force = {force:e}; allowed: a positive number");
            assert_eq!(free(&square, Load::Force(force)), expected);
        }
        let few = Square {
            heights: &heights[1..],
            ..square
        };
        assert_eq!(
            free(&few, Load::Force(1.0)),
            "1023 heights; allowed: 1024, one for each cell"
        );
        let side = Square {
            side: -1.0,
            ..square
        };
        assert_eq!(
            free(&side, Load::Force(1.0)),
            "side = -1e0; allowed: a positive number"
        );
        let mut broken = heights.clone();
        broken[7] = f64::NAN;
        let broken = Square {
            heights: &broken,
            ..square
        };
        assert_eq!(
            free(&broken, Load::Force(1.0)),
            "height = NaN; allowed: finite numbers"
        );
        let periodic = on(Boundary::Periodic, &square, Load::Indentation(1.0));
        assert!(periodic.contains("allowed: a force"), "{periodic}");
        let mut stopped = HalfSpace::new(32, Boundary::Free).unwrap();
        assert_eq!(
            stopped.press(&square, Load::Force(1.0), 1e-8, &|| true),
            Err(HalfSpaceError::Stopped)
        );
    }
}
