//! Ratios of the results of profiles and square surfaces, collected into a comparison.

use crate::compared::{Compared, Values};
use crate::comparison::lines::{LineLoop, Lines, OwnLoading};
use crate::comparison::settings::{Comparison, ROUNDING};
use crate::comparison::squares::SquareResult;
use crate::error::StudyError;
use crate::reference::{LeftOut, Loaded, Reference, RoughnessOfBoth};
use crate::reference_budget::{Bodies, ReferenceBudget};
use crate::spatial::{Loads, Pressing, Pulling};
use asperity_contact::Move;
use asperity_data::{format_rounded, mean};
use asperity_half_space::check_cells;

/// Ratios of the results of the loops with adhesion. A ratio is `None` if a result is unknown.
struct ComparedLoops {
    pull_off_force: Option<Compared>,
    first_touch_pull_off_force: Option<Compared>,
    dissipated_energy: Option<Compared>,
}

impl ComparedLoops {
    fn of(loops: &[LineLoop], squares: &[SquareResult]) -> Self {
        ComparedLoops {
            pull_off_force: compared_loops(
                loops.iter().map(|line| line.pull_off_force),
                squares,
                |pulling| pulling.pull_off_force,
            ),
            first_touch_pull_off_force: compared_loops(
                loops.iter().map(|line| line.first_touch_pull_off_force),
                squares,
                |pulling| pulling.at_touch,
            ),
            dissipated_energy: compared_loops(
                loops.iter().map(|line| line.dissipated_energy),
                squares,
                |pulling| pulling.dissipated_energy,
            ),
        }
    }
}

impl Comparison<'_> {
    /// Collects the comparison from the results of profiles and square surfaces. `seconds` are the
    /// computing times of profiles and of square surfaces. Returns an error if no quantity can be
    /// compared because too few grid cells are in contact.
    pub fn gather(
        &self,
        own: &OwnLoading,
        lines: &Lines,
        squares: &[SquareResult],
        seconds: [f64; 2],
    ) -> Result<Reference, StudyError> {
        let loops = ComparedLoops::of(&lines.loops, squares);
        let (loading, left_out) = self.compared_loading(lines, squares);
        let line_is_exact = self.resolved.line_is_exact && !own.is_full;
        let last = loading.last().filter(|last| last.force >= lines.preload);
        let headline = loops
            .pull_off_force
            .as_ref()
            .or(last.map(|last| &last.indentation));
        if let (None, Some(left_out)) = (headline, left_out.last()) {
            return Err(self.too_few_cells(left_out));
        }
        let bodies = Bodies {
            are_random: self.resolved.waves.is_some(),
            line_is_exact,
        };
        let seconds_of_squares: f64 = squares.iter().map(|square| square.seconds).sum();
        Ok(Reference {
            waves: self.resolved.waves,
            omitted: self.resolved.omitted,
            roughness: self.roughness(),
            work_of_adhesion: self.resolved.body.works.map(|[_, opening]| opening),
            compared_loading: [own.turn.stage(), Move::ToSeparation],
            preload: lines.preload,
            budget: ReferenceBudget::new(largest_residual(squares), headline, bodies),
            pull_off_force: loops.pull_off_force,
            first_touch_pull_off_force: loops.first_touch_pull_off_force,
            dissipated_energy: loops.dissipated_energy,
            loading,
            left_out,
            line_is_exact,
            convolutions: squares.iter().map(|square| square.fine.convolutions).sum(),
            seconds,
            seconds_of_square: seconds_of_squares / squares.len() as f64,
            options: self.options,
            warnings: Vec::new(),
        })
    }

    fn roughness(&self) -> Option<RoughnessOfBoth> {
        let body = &self.resolved.body;
        let half_space = body.shells.as_ref()?.roughness(body.modulus);
        Some(RoughnessOfBoth {
            line: self.resolved.line_roughness?,
            half_space,
            adhesive_half_space: body
                .works
                .map(|_| half_space.scaled(body.adhesive_height_factor)),
        })
    }

    /// Compares profiles and square surfaces without adhesion at each force at which enough grid
    /// cells are in contact. Also returns the forces that are left out because too few cells are in
    /// contact.
    fn compared_loading(
        &self,
        lines: &Lines,
        squares: &[SquareResult],
    ) -> (Vec<Loaded>, Vec<LeftOut>) {
        let cell = (self.resolved.body.side / self.options.cells as f64).powi(2);
        let mut loading = Vec::new();
        let mut left_out = Vec::new();
        for (index, &force) in lines.loading.forces.iter().enumerate() {
            let areas: Vec<f64> = squares
                .iter()
                .map(|square| square.fine.pressings[index].area)
                .collect();
            let area = mean(&areas);
            let cells = area / cell;
            // The number of cells in contact has rounding errors, because it follows from the
            // contact area, which is a sum over cells.
            if cells < Loaded::LEAST_CELLS * (1.0 - ROUNDING) {
                left_out.push(LeftOut {
                    force,
                    cells,
                    grid: self.finer_grid(cells),
                });
                continue;
            }
            let indentation = compared_pressings(
                lines.pressed.iter().map(|states| states[index].indentation),
                squares,
                |loads| loads.pressings[index].indentation,
            );
            let stiffness = compared_pressings(
                lines.pressed.iter().map(|states| states[index].stiffness),
                squares,
                |loads| loads.pressings[index].stiffness,
            );
            if let (Some(indentation), Some(stiffness)) = (indentation, stiffness) {
                loading.push(Loaded {
                    force,
                    indentation,
                    stiffness,
                    area,
                    cells,
                });
            }
        }
        (loading, left_out)
    }

    /// Returns the number of grid cells along the side of a square surface with which enough cells
    /// would be in contact, if only `cells` cells are in contact now. Returns `None` if the solver
    /// does not allow such a grid.
    fn finer_grid(&self, cells: f64) -> Option<usize> {
        let times = (Loaded::LEAST_CELLS / cells.max(1.0)).sqrt();
        let finer = ((self.options.cells as f64 * times).ceil() as usize).next_power_of_two();
        check_cells(finer).is_ok().then_some(finer)
    }

    /// Returns the error that too few grid cells are in contact at the preload.
    fn too_few_cells(&self, left_out: &LeftOut) -> StudyError {
        let cells = format_rounded(left_out.cells, 2, "1");
        let least = Loaded::LEAST_CELLS;
        let found = format!("at the preload {cells} cells of a square are in contact");
        let mut allowed = format!("at least {least}, by a larger preload");
        if let Some(grid) = left_out.grid {
            allowed += &format!(" or {grid} cells along the side");
        }
        StudyError::refused(
            Some(&format!("{} cells", self.options.cells)),
            found,
            allowed,
        )
    }
}

/// Compares one result of the loops with adhesion between profiles and square surfaces. `lines` are
/// the values of the profiles, and `figure` returns the value of a square surface.
fn compared_loops(
    lines: impl Iterator<Item = Option<f64>>,
    squares: &[SquareResult],
    figure: impl Fn(&Pulling) -> f64,
) -> Option<Compared> {
    let mut values = Values {
        lines: lines.flatten().collect(),
        squares: Vec::new(),
        coarse: Vec::new(),
    };
    for square in squares {
        values
            .squares
            .extend(square.fine.pulling.as_ref().map(&figure));
        if let Some(coarse) = &square.coarse {
            values.coarse.extend(coarse.pulling.as_ref().map(&figure));
        }
    }
    values.compared()
}

/// Compares one result of the contacts without adhesion between profiles and square surfaces.
/// `lines` are the values of the profiles, and `figure` returns the value of a square surface.
fn compared_pressings(
    lines: impl Iterator<Item = f64>,
    squares: &[SquareResult],
    figure: impl Fn(&Loads) -> f64,
) -> Option<Compared> {
    let coarse = squares.iter().filter_map(|square| square.coarse.as_ref());
    let values = Values {
        lines: lines.collect(),
        squares: squares.iter().map(|square| figure(&square.fine)).collect(),
        coarse: coarse.map(&figure).collect(),
    };
    values.compared()
}

fn largest_residual(squares: &[SquareResult]) -> f64 {
    let pressings = squares.iter().flat_map(|square| &square.fine.pressings);
    pressings
        .map(|pressing: &Pressing| pressing.residual)
        .fold(0.0, f64::max)
}
