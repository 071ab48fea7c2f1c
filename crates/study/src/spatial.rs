//! The body of a scene in three dimensions: one random square on a half-space, loaded without and with adhesion.

use super::error::StudyError;
use asperity_half_space::{
    AdhesiveSquare, AdhesiveState, Boundary, HalfSpace, HalfSpaceError, Load, Square, random_map,
};
use asperity_surface::{Form, SelfAffine};

/// Residual of contacts without adhesion, in rms heights.
const TOLERANCE: f64 = 1e-8;
/// Relative difference of two forces by which a stiffness is found.
const APART: f64 = 0.02;
/// Share of the preload by which a loop may miss the preload.
const NEAR: f64 = 0.01;
/// Most steps of a loop: far more than any takes.
const MOST_STEPS: usize = 4000;

/// A body in three dimensions, without its random phases.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub form: Option<Form>,
    /// Spectrum of the roughness and amplitude A₁, m, of its first mode without a roll-off.
    pub roughness: Option<(SelfAffine, f64)>,
    /// Side L, m.
    pub side: f64,
    /// E*, Pa.
    pub effective_modulus: f64,
    /// Works of adhesion on closing and on opening, J/m².
    pub works: Option<[f64; 2]>,
}

/// A state without adhesion at one force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pressing {
    pub indentation: f64,
    /// dF/dd, N/m.
    pub stiffness: f64,
    /// m².
    pub area: f64,
    pub residual: f64,
}

/// Figures of an adhesive loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pulling {
    /// N.
    pub adhesion_force: f64,
    /// Adhesion force after a turn at first touch, N.
    pub at_touch: f64,
    /// J.
    pub dissipated_energy: f64,
}

impl Body {
    /// Heights, m, of the square with these random phases, row by row.
    pub fn heights(&self, cells: usize, seed: u64) -> Result<Vec<f64>, StudyError> {
        let mut heights = match self.roughness {
            Some((spectrum, first)) => {
                let variance = |waves: f64| first * first * spectrum.relative_variance_of_surface(waves);
                random_map(cells, variance, seed)?
            }
            None => asperity_data::resized(Vec::new(), cells * cells, 0.0).map_err(HalfSpaceError::from)?,
        };
        if let Some(form) = &self.form {
            let at = |index: usize| ((index as f64 + 0.5) / cells as f64 - 0.5) * self.side;
            for (index, height) in heights.iter_mut().enumerate() {
                let radius = at(index % cells).hypot(at(index / cells));
                // Beside a punch the body is out of reach of any contact.
                *height -= form.depth(radius).unwrap_or(self.side);
            }
        }
        Ok(heights)
    }

    fn square<'a>(&self, heights: &'a [f64]) -> Square<'a> {
        Square { heights, side: self.side, effective_modulus: self.effective_modulus }
    }

    /// Presses the square without adhesion with each force, N; returns the states and the convolutions of all.
    pub fn press(
        &self,
        heights: &[f64],
        forces: &[f64],
        stop: &dyn Fn() -> bool,
    ) -> Result<(Vec<Pressing>, u64), StudyError> {
        let mut half_space = HalfSpace::new(heights.len().isqrt(), Boundary::Free)?;
        let (mut states, mut convolutions) = (Vec::new(), 0);
        for force in forces {
            let mut at = |force: f64| {
                let found = half_space.press(&self.square(heights), Load::Force(force), TOLERANCE, stop)?;
                convolutions += found.convolutions;
                Ok::<_, HalfSpaceError>((found.indentation, found.area, found.residual))
            };
            let (indentation, area, residual) = at(*force)?;
            let (deeper, ..) = at(force * (1.0 + APART))?;
            let stiffness = APART * force / (deeper - indentation);
            states.push(Pressing { indentation, stiffness, area, residual });
        }
        Ok((states, convolutions))
    }

    /// Pulls the square off after a turn at first touch and after the preload, N, in steps of the indentation, m; returns the
    /// figures and the convolutions. `None` without adhesion.
    pub fn pull(
        &self,
        heights: &[f64],
        (preload, step): (f64, f64),
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<(Pulling, u64)>, StudyError> {
        let Some([closing, opening]) = self.works else { return Ok(None) };
        let separated = || AdhesiveSquare::new(&self.square(heights), (opening, closing));
        let mut touched = separated()?;
        let at_touch = touched.move_to(0.0, stop)?;
        let (at_touch, _) = pull_off(&mut touched, at_touch, step, stop)?;
        let mut body = separated()?;
        let mut lost = 0.0;
        let mut state = body.move_to(0.0, stop)?;
        // The next step ends at the preload, by the stiffness of the last one.
        let mut next = step;
        for _ in 0..MOST_STEPS {
            if state.force >= preload * (1.0 - NEAR) {
                break;
            }
            let deeper = body.move_to(state.indentation + next, stop)?;
            lost += work(&state, &deeper);
            let stiffness = (deeper.force - state.force) / next;
            let missing = (preload - deeper.force) / stiffness;
            next = if missing > 0.0 { missing.clamp(0.05 * step, step) } else { step };
            state = deeper;
        }
        let (adhesion_force, gained) = pull_off(&mut body, state, step, stop)?;
        let convolutions = touched.convolutions() + body.convolutions();
        let dissipated_energy = (lost + gained).max(0.0);
        Ok(Some((Pulling { adhesion_force, at_touch, dissipated_energy }, convolutions)))
    }
}

/// Work of the force between two states, J.
fn work(from: &AdhesiveState, to: &AdhesiveState) -> f64 {
    0.5 * (from.force + to.force) * (to.indentation - from.indentation)
}

/// Pulls a body off; returns the largest tensile force, N, and the work, J.
fn pull_off(
    body: &mut AdhesiveSquare,
    from: AdhesiveState,
    step: f64,
    stop: &dyn Fn() -> bool,
) -> Result<(f64, f64), StudyError> {
    let (mut state, mut largest, mut done) = (from, (-from.force).max(0.0), 0.0);
    for _ in 0..MOST_STEPS {
        if state.area == 0.0 {
            break;
        }
        let next = body.move_to(state.indentation - step, stop)?;
        done += work(&state, &next);
        largest = largest.max(-next.force);
        state = next;
    }
    Ok((largest, done))
}
