//! The body of a scene in three dimensions: a square rough surface on an elastic half-space, which
//! is loaded without and with adhesion.

use super::error::StudyError;
use super::shells::Shells;
use asperity_contact::Move;
use asperity_half_space::{
    AdhesiveSquare, AdhesiveState, Boundary, HalfSpace, HalfSpaceError, Load, Square, random_map,
};
use asperity_surface::Form;

/// Tolerance of the gap in contacts without adhesion, divided by the rms height, at which the
/// solver stops.
const TOLERANCE: f64 = 1e-8;
/// Relative difference between the two forces from whose indentations the stiffness is computed as
/// a difference quotient.
const APART: f64 = 0.02;
/// Largest allowed deviation, as a share of the target, with which a loop may turn before it has
/// reached its target force or displacement.
const NEAR: f64 = 0.01;
/// Share of an indentation below which a difference counts as a rounding error.
const ROUNDING: f64 = 1e-9;
/// Largest number of steps of a loop, far more than any loop needs.
const MOST_STEPS: usize = 4000;

/// Body of a scene in three dimensions. Only the random phases of the roughness are not part of it;
/// a seed determines them when the surface is loaded.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub form: Option<Form>,
    /// Waves of the roughness; `None` for a smooth body.
    pub shells: Option<Shells>,
    /// Factor by which the heights of the roughness are multiplied in contacts with adhesion. With
    /// this factor, the square surfaces have the same elastic energy per area as the profiles.
    pub adhesive_height_factor: f64,
    /// Side L of the square in m.
    pub side: f64,
    /// Effective modulus E* in Pa.
    pub modulus: f64,
    /// Works of adhesion on closing and on opening in J/m²; `None` without adhesion.
    pub works: Option<[f64; 2]>,
}

/// Turning point of the loop. It is the same for square surfaces and for profiles (lines).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Turn {
    /// The loop turns at the contained force in N.
    Force(f64),
    /// The loop turns at the contained indentation in m.
    Indentation(f64),
    /// The loop turns at a displacement of the drive of an instrument. The displacement is d + F/k,
    /// with the indentation d, the force F and the stiffness k of the instrument.
    Displacement {
        /// Displacement in m.
        displacement: f64,
        /// Stiffness k of the instrument in N/m.
        stiffness: f64,
    },
}

impl Turn {
    /// Returns the stage of a loading that goes to this turning point.
    pub fn stage(self) -> Move {
        match self {
            Turn::Force(force) => Move::ToForce(force),
            Turn::Indentation(indentation) => Move::ToIndentation(indentation),
            Turn::Displacement { displacement, .. } => Move::ToDisplacement(displacement),
        }
    }

    /// Returns how near the square surface in this state is to the turning point.
    fn progress(self, state: &AdhesiveState) -> Approach {
        match self {
            Turn::Force(target) => Approach {
                reached: state.force,
                target,
                tolerance: NEAR,
            },
            Turn::Indentation(target) => Approach {
                reached: state.indentation,
                target,
                tolerance: ROUNDING,
            },
            Turn::Displacement {
                displacement,
                stiffness,
            } => Approach {
                reached: state.indentation + state.force / stiffness,
                target: displacement,
                tolerance: NEAR,
            },
        }
    }
}

/// Progress towards the turning point: the reached value and the target, in the same unit.
struct Approach {
    reached: f64,
    target: f64,
    /// Share of the target by which the loop may turn too early.
    tolerance: f64,
}

/// Loading of a square surface.
#[derive(Clone, Debug)]
pub(super) struct SquareLoading {
    /// Forces in N at which the contact without adhesion is computed.
    pub forces: Vec<f64>,
    /// Turning point of the loop with adhesion.
    pub turn: Turn,
    /// Step of the indentation in the loop in m.
    pub step: f64,
}

/// Functions that the computation of a square surface calls.
#[derive(Clone, Copy)]
pub(super) struct Watch<'a> {
    /// Function that returns true if the computation should end.
    pub stop: &'a dyn Fn() -> bool,
    /// Function that is called after each computed load (force or indentation), to report the
    /// progress.
    pub loaded: &'a dyn Fn(),
}

/// State of a square surface at one force, without adhesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pressing {
    pub indentation: f64,
    /// Stiffness dF/dd of the contact in N/m, with the force F and the indentation d.
    pub stiffness: f64,
    /// Contact area in m².
    pub area: f64,
    pub residual: f64,
}

/// Results of the loops of a square surface with adhesion.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pulling {
    /// Pull-off force in N.
    pub pull_off_force: f64,
    /// Pull-off force in N of a loop that turns at first touch.
    pub at_touch: f64,
    /// Dissipated energy in J.
    pub dissipated_energy: f64,
    /// Points of the loop from first touch on, each with indentation in m and force in N.
    pub curve: Vec<(f64, f64)>,
}

/// Results of one random square surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Loads {
    pub pressings: Vec<Pressing>,
    /// Results of the loop with adhesion; `None` without adhesion.
    pub pulling: Option<Pulling>,
    pub convolutions: u64,
    /// Number of computed loads (forces or indentations), with and without adhesion. It is needed
    /// to report the progress.
    pub count: u64,
}

impl Loads {
    /// Returns the main result: the pull-off force in N or, without adhesion, the indentation in m
    /// at the last force. `None` if no load is computed.
    pub fn headline(&self) -> Option<f64> {
        match &self.pulling {
            Some(pulling) => Some(pulling.pull_off_force),
            None => Some(self.pressings.last()?.indentation),
        }
    }
}

impl Body {
    /// Returns the memory in bytes that the computation of a square surface needs at most.
    pub fn bytes(&self, cells: usize) -> u64 {
        let adhesive = if self.works.is_some() {
            AdhesiveSquare::bytes(cells)
        } else {
            0
        };
        // The heights remain in memory during the contact. Before the contact, the waves from which
        // the heights are made need three times as much memory as the heights.
        let heights = 8 * (cells * cells) as u64;
        heights
            + HalfSpace::bytes(cells, Boundary::Free)
                .max(adhesive)
                .max(3 * heights)
    }

    /// Computes the loads of the surface with the random phases of `seed`. First the surface is
    /// loaded without adhesion to each force of `loading`. Then follow two loops with adhesion: one
    /// turns at first touch, the other at the turning point of `loading`. The side of the surface
    /// has `cells` grid cells.
    ///
    /// # Errors
    /// Returns an error if the surface or its contact cannot be computed, or if the computation is
    /// stopped.
    pub fn load(
        &self,
        cells: usize,
        seed: u64,
        loading: &SquareLoading,
        watch: Watch<'_>,
    ) -> Result<Loads, StudyError> {
        let mut loads = Loads::default();
        let heights = self.heights(cells, seed, 1.0)?;
        self.press(&heights, &loading.forces, &mut loads, watch)?;
        drop(heights);
        let Some(works) = self.works else {
            return Ok(loads);
        };
        let heights = self.heights(cells, seed, self.adhesive_height_factor)?;
        let mut touched = self.begin_loop(&heights, works, watch)?;
        touched.pull_off(loading.step)?;
        let mut pressed = self.begin_loop(&heights, works, watch)?;
        pressed.press(loading.turn, loading.step)?;
        pressed.pull_off(loading.step)?;
        loads.convolutions += touched.body.convolutions() + pressed.body.convolutions();
        loads.count += (touched.curve.len() + pressed.curve.len()) as u64;
        loads.pulling = Some(Pulling {
            at_touch: touched.pull_off_force(),
            pull_off_force: pressed.pull_off_force(),
            dissipated_energy: work(&pressed.curve).max(0.0),
            curve: pressed.curve,
        });
        Ok(loads)
    }

    /// Returns the heights in m of the surface with the random phases of `seed`, row by row. Only
    /// the heights of the roughness are multiplied by `factor`, not the heights of the form.
    ///
    /// # Errors
    /// Returns an error if the heights do not fit into memory.
    pub fn heights(&self, cells: usize, seed: u64, factor: f64) -> Result<Vec<f64>, StudyError> {
        let mut heights = match &self.shells {
            Some(shells) => random_map(
                cells,
                |waves| factor * factor * shells.variance(waves),
                seed,
            )?,
            None => asperity_data::resized(Vec::new(), cells * cells, 0.0)
                .map_err(HalfSpaceError::from)?,
        };
        if let Some(form) = &self.form {
            let mut distances = Vec::with_capacity(cells);
            for index in 0..cells {
                distances.push(((index as f64 + 0.5) / cells as f64 - 0.5) * self.side);
            }
            for (index, height) in heights.iter_mut().enumerate() {
                let x = distances[index % cells];
                let y = distances[index / cells];
                // Outside a punch the surface is placed so far away (by the side of the square)
                // that it never touches.
                *height -= form.depth_in_square(x, y, self.side).unwrap_or(self.side);
            }
        }
        Ok(heights)
    }

    /// Begins a loop with adhesion at first touch. `works` are the works of adhesion on closing and
    /// on opening in J/m².
    fn begin_loop<'a>(
        &self,
        heights: &[f64],
        works: [f64; 2],
        watch: Watch<'a>,
    ) -> Result<Loop<'a>, StudyError> {
        let [closing, opening] = works;
        let body = AdhesiveSquare::new(&self.square(heights), opening, closing)?;
        Ok(Loop::begin(body, watch)?)
    }

    fn square<'a>(&self, heights: &'a [f64]) -> Square<'a> {
        Square {
            heights,
            side: self.side,
            modulus: self.modulus,
        }
    }

    /// Presses the surface without adhesion to each force in N.
    fn press(
        &self,
        heights: &[f64],
        forces: &[f64],
        loads: &mut Loads,
        watch: Watch<'_>,
    ) -> Result<(), StudyError> {
        let mut half_space = HalfSpace::new(heights.len().isqrt(), Boundary::Free)?;
        let square = self.square(heights);
        for &force in forces {
            let pressed = half_space.press(&square, Load::Force(force), TOLERANCE, watch.stop)?;
            let more = Load::Force(force * (1.0 + APART));
            let deeper = half_space.press(&square, more, TOLERANCE, watch.stop)?;
            loads.convolutions += pressed.convolutions + deeper.convolutions;
            loads.count += 1;
            loads.pressings.push(Pressing {
                indentation: pressed.indentation,
                stiffness: APART * force / (deeper.indentation - pressed.indentation),
                area: pressed.area,
                residual: pressed.residual,
            });
            (watch.loaded)();
        }
        Ok(())
    }
}

/// State of a surface with adhesion during its loop, and the points of its force curve so far.
struct Loop<'a> {
    body: AdhesiveSquare,
    state: AdhesiveState,
    curve: Vec<(f64, f64)>,
    watch: Watch<'a>,
}

impl<'a> Loop<'a> {
    /// Begins the loop at first touch.
    fn begin(mut body: AdhesiveSquare, watch: Watch<'a>) -> Result<Loop<'a>, HalfSpaceError> {
        let state = body.move_to(0.0, watch.stop)?;
        (watch.loaded)();
        Ok(Loop {
            body,
            state,
            curve: vec![(0.0, state.force)],
            watch,
        })
    }

    fn move_by(&mut self, step: f64) -> Result<(), HalfSpaceError> {
        self.state = self
            .body
            .move_to(self.state.indentation + step, self.watch.stop)?;
        self.curve.push((self.state.indentation, self.state.force));
        (self.watch.loaded)();
        Ok(())
    }

    /// Increases the indentation in steps of at most `step` in m, up to the turning point.
    fn press(&mut self, turn: Turn, step: f64) -> Result<(), StudyError> {
        let mut approach = turn.progress(&self.state);
        // If the loop turns at an indentation, the first step must not go beyond it. For other
        // turning points the necessary step is not known yet.
        let mut next = match turn {
            Turn::Indentation(indentation) => step.min(indentation),
            _ => step,
        };
        for _ in 0..MOST_STEPS {
            if approach.reached >= approach.target * (1.0 - approach.tolerance) {
                return Ok(());
            }
            let before = approach.reached;
            self.move_by(next)?;
            approach = turn.progress(&self.state);
            // The next step should end at the turning point. Its length is estimated from the slope
            // of the force curve in the last step.
            let missing = (approach.target - approach.reached) * next / (approach.reached - before);
            let shortest = if matches!(turn, Turn::Indentation(_)) {
                0.0
            } else {
                0.05 * step
            };
            next = if missing > 0.0 {
                missing.clamp(shortest, step)
            } else {
                step
            };
        }
        let deepest = self.state.indentation;
        let found = format!(
            "{:?} is not reached at the indentation {deepest:e} m",
            turn.stage()
        );
        Err(StudyError::refused(
            Some("the preload in three dimensions"),
            found,
            "a smaller preload",
        ))
    }

    /// Reduces the indentation in steps of `step` in m until the surface is separated.
    fn pull_off(&mut self, step: f64) -> Result<(), StudyError> {
        for _ in 0..MOST_STEPS {
            if self.state.area == 0.0 {
                break;
            }
            self.move_by(-step)?;
        }
        Ok(())
    }

    /// Returns the largest tensile force of the loop in N.
    fn pull_off_force(&self) -> f64 {
        self.curve
            .iter()
            .map(|(_, force)| -force)
            .fold(0.0, f64::max)
    }
}

/// Returns the work of the force along a curve in J, computed by the trapezoidal rule.
fn work(curve: &[(f64, f64)]) -> f64 {
    curve
        .windows(2)
        .map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0))
        .sum()
}
