//! The body of a scene in three dimensions: one random square on a half-space, loaded without and with adhesion.

use super::error::StudyError;
use asperity_half_space::{
    AdhesiveSquare, AdhesiveState, Boundary, HalfSpace, HalfSpaceError, Load, Square, random_map,
};
use asperity_surface::{EquivalentLine, Form, SelfAffine};

/// Residual of contacts without adhesion, in rms heights.
const TOLERANCE: f64 = 1e-8;
/// Relative difference of two forces that determine a stiffness.
const APART: f64 = 0.02;
/// Share of the preload by which a loop may miss the preload.
const NEAR: f64 = 0.01;
/// Largest number of steps of a loop, far more than any loop needs.
const MOST_STEPS: usize = 4000;

/// Spectrum of a random surface.
#[derive(Clone, Debug)]
pub(super) enum Spectrum {
    /// Self-affine spectrum with the amplitude A₁ in m of its first mode without a roll-off.
    SelfAffine(SelfAffine, f64),
    /// Spectrum of the surface whose equivalent line this is.
    Measured(EquivalentLine),
}

/// A body in three dimensions, without its random phases.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub form: Option<Form>,
    /// Spectrum of the roughness; `None` for a smooth body.
    pub spectrum: Option<Spectrum>,
    /// Side L of the square, m.
    pub side: f64,
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
    /// Works of adhesion on closing and on opening, J/m²; `None` without adhesion.
    pub works: Option<[f64; 2]>,
}

/// State without adhesion at one force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pressing {
    pub indentation: f64,
    /// Stiffness dF/dd, N/m.
    pub stiffness: f64,
    /// Contact area, m².
    pub area: f64,
    pub residual: f64,
}

/// Figures of an adhesive loop.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pulling {
    /// Adhesion force, N.
    pub adhesion_force: f64,
    /// Adhesion force turned at first touch, N.
    pub at_touch: f64,
    /// Dissipated energy, J.
    pub dissipated_energy: f64,
    /// Indentation in m and force in N from first touch on.
    pub curve: Vec<(f64, f64)>,
}

/// The numbers of one random square.
#[derive(Clone, Debug, Default)]
pub(super) struct Loads {
    pub pressings: Vec<Pressing>,
    /// Figures of the adhesive loop; `None` without adhesion.
    pub pulling: Option<Pulling>,
    pub convolutions: u64,
}

impl Loads {
    /// Returns the adhesion force in N, or the indentation in m under the last force if there is no adhesion.
    pub fn headline(&self) -> Option<f64> {
        match &self.pulling {
            Some(pulling) => Some(pulling.adhesion_force),
            None => Some(self.pressings.last()?.indentation),
        }
    }
}

impl Body {
    /// Returns the memory in bytes of the largest part of a computation.
    pub fn bytes(&self, cells: usize) -> u64 {
        let adhesive = if self.works.is_some() { AdhesiveSquare::bytes(cells) } else { 0 };
        // Heights; waves in their place before.
        let heights = 8 * (cells * cells) as u64;
        heights + HalfSpace::bytes(cells, Boundary::Free).max(adhesive).max(3 * heights)
    }

    /// Loads the square with these random phases to each force in N without adhesion, and to the last one with adhesion, in
    /// steps of the indentation in m.
    pub fn load(
        &self,
        (cells, seed): (usize, u64),
        (forces, step): (&[f64], f64),
        stop: &dyn Fn() -> bool,
    ) -> Result<Loads, StudyError> {
        let heights = self.heights(cells, seed)?;
        let mut loads = Loads::default();
        self.press(&heights, forces, &mut loads, stop)?;
        if let (Some([closing, opening]), Some(preload)) = (self.works, forces.last()) {
            let square = || AdhesiveSquare::new(&self.square(&heights), (opening, closing));
            let mut touched = Loop::begin(square()?, stop)?;
            touched.pull_off(step, stop)?;
            let mut pressed = Loop::begin(square()?, stop)?;
            pressed.press(*preload, step, stop)?;
            pressed.pull_off(step, stop)?;
            loads.convolutions += touched.body.convolutions() + pressed.body.convolutions();
            loads.pulling = Some(Pulling {
                at_touch: touched.adhesion_force(),
                adhesion_force: pressed.adhesion_force(),
                dissipated_energy: work(&pressed.curve).max(0.0),
                curve: pressed.curve,
            });
        }
        Ok(loads)
    }

    /// Returns the heights in m of the square with these random phases, row by row.
    pub fn heights(&self, cells: usize, seed: u64) -> Result<Vec<f64>, StudyError> {
        let mut heights = match &self.spectrum {
            Some(Spectrum::SelfAffine(spectrum, first)) => {
                let variance = |waves: f64| first * first * spectrum.relative_variance_of_surface(waves);
                random_map(cells, variance, seed)?
            }
            Some(Spectrum::Measured(line)) => {
                random_map(cells, |waves| line.variance_of_surface(waves, self.side), seed)?
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

    /// Presses the square without adhesion to each force in N.
    fn press(
        &self,
        heights: &[f64],
        forces: &[f64],
        loads: &mut Loads,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), StudyError> {
        let mut half_space = HalfSpace::new(heights.len().isqrt(), Boundary::Free)?;
        for force in forces {
            let mut at = |force: f64| {
                let found = half_space.press(&self.square(heights), Load::Force(force), TOLERANCE, stop)?;
                loads.convolutions += found.convolutions;
                Ok::<_, HalfSpaceError>((found.indentation, found.area, found.residual))
            };
            let (indentation, area, residual) = at(*force)?;
            let (deeper, ..) = at(force * (1.0 + APART))?;
            let stiffness = APART * force / (deeper - indentation);
            loads.pressings.push(Pressing { indentation, stiffness, area, residual });
        }
        Ok(())
    }
}

/// The motion of a square with adhesion.
struct Loop {
    body: AdhesiveSquare,
    state: AdhesiveState,
    curve: Vec<(f64, f64)>,
}

impl Loop {
    /// Begins the motion at first touch.
    fn begin(mut body: AdhesiveSquare, stop: &dyn Fn() -> bool) -> Result<Loop, HalfSpaceError> {
        let state = body.move_to(0.0, stop)?;
        Ok(Loop { body, state, curve: vec![(0.0, state.force)] })
    }

    fn move_by(&mut self, step: f64, stop: &dyn Fn() -> bool) -> Result<(), HalfSpaceError> {
        self.state = self.body.move_to(self.state.indentation + step, stop)?;
        self.curve.push((self.state.indentation, self.state.force));
        Ok(())
    }

    /// Presses to a force in N, in steps of the indentation in m.
    fn press(&mut self, preload: f64, step: f64, stop: &dyn Fn() -> bool) -> Result<(), StudyError> {
        // The next step ends at the preload, by the stiffness of the last one.
        let mut next = step;
        for _ in 0..MOST_STEPS {
            let before = self.state.force;
            if before >= preload * (1.0 - NEAR) {
                return Ok(());
            }
            self.move_by(next, stop)?;
            let missing = (preload - self.state.force) * next / (self.state.force - before);
            next = if missing > 0.0 { missing.clamp(0.05 * step, step) } else { step };
        }
        let deepest = self.state.indentation;
        let found = format!("{preload:e} N is not reached at the indentation {deepest:e} m");
        Err(StudyError::refused(Some("the preload in three dimensions"), found, "a smaller preload"))
    }

    /// Pulls off in steps of the indentation in m, until nothing touches.
    fn pull_off(&mut self, step: f64, stop: &dyn Fn() -> bool) -> Result<(), StudyError> {
        for _ in 0..MOST_STEPS {
            if self.state.area == 0.0 {
                break;
            }
            self.move_by(-step, stop)?;
        }
        Ok(())
    }

    /// Returns the largest tensile force in N.
    fn adhesion_force(&self) -> f64 {
        self.curve.iter().map(|(_, force)| -force).fold(0.0, f64::max)
    }
}

/// Returns the work of the force along a curve in J.
fn work(curve: &[(f64, f64)]) -> f64 {
    curve.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum()
}
