//! Outcome of a computed scene, or the reason why there is none.

use super::reach::BeyondFullContact;
use crate::analysis::governing::{Governing, SteepWaves};
use crate::analysis::instrument::InstrumentFigures;
use crate::analysis::regime::Regime;
use crate::scene::errors::SceneErrors;
use asperity_contact::{ContactError, Figures, History, Patch};
use asperity_data::{format_quantity, rounded_up};
use asperity_surface::SurfaceError;
use asperity_surface::lines::Histogram;
use serde::Serialize;
use thiserror::Error;

/// All results of a scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// Facts about the profile.
    pub line: LineFacts,
    /// Governing parameters.
    pub governing: Governing,
    /// Ideal adhesion force F_a,max, eq. (14), N; `None` without adhesion.
    pub ideal_adhesion_force: Option<f64>,
    /// Adhesion force F_smooth, N, of the same body without roughness after the same preload; `None` without adhesion.
    pub smooth_adhesion_force: Option<f64>,
    /// Adhesion force F_a(d=0), N; `None` without adhesion or an unloading stage.
    pub first_touch_adhesion_force: Option<f64>,
    /// Adhesion force F_a(F=0), N; `None` without adhesion or an unloading stage.
    pub zero_force_adhesion_force: Option<f64>,
    /// Tabor number μ; `None` without adhesion or a radius of curvature.
    pub tabor_number: Option<f64>,
    /// Waves of a sphere, if they are too steep for the theory of Johnson, Kendall and Roberts.
    pub steep_waves: Option<SteepWaves>,
    /// Regime of adhesion (Fig. 4) turned at first touch; `None` without a tensile force.
    pub regime: Option<Regime>,
    /// Regime of adhesion turned at zero force; `None` without a tensile force.
    pub regime_after_zero_force: Option<Regime>,
    /// Headline figures of the loading history.
    pub figures: Figures,
    /// Figures over the displacement of the instrument; `None` for a rigid instrument.
    pub instrument: Option<InstrumentFigures>,
    /// The loading history itself.
    pub history: History,
    /// Contact patches after each loading stage, if observed.
    pub fragments: Vec<Vec<Patch>>,
    /// Histogram of the heights of the profile, if observed.
    pub histogram: Option<Histogram>,
    /// Times of the computing stages.
    pub timings: Timings,
}

impl Outcome {
    /// Adhesion force over the ideal one, F_a/F_a,max; `None` without either.
    pub fn adhesion_share(&self) -> Option<f64> {
        Some(self.figures.adhesion_force? / self.ideal_adhesion_force.filter(|ideal| *ideal > 0.0)?)
    }
}

/// Facts about a profile, without its heights.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineFacts {
    /// Number of springs N of the foundation.
    pub points: usize,
    /// Apparent diameter L, m.
    pub length: f64,
    /// Spring spacing Δx, m.
    pub spacing: f64,
    /// Index of the first spring under the body; above zero only under a punch.
    pub first: usize,
    /// Height of the highest point, m, above the apex of the form and the mean of the roughness.
    pub summit: f64,
    /// Largest gap, m.
    pub deepest: f64,
    /// First and last mode of the roughness.
    pub modes: Option<(u64, u64)>,
    /// Seed of the roughness.
    pub seed: Option<u64>,
    /// Rms gradient by the integrals of eq. (12), for the same rms height.
    pub continuum_rms_gradient: Option<f64>,
}

/// Times of the computing stages, s; zero for a stage that did not run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Timings {
    /// Time for making the profile, s.
    pub line: f64,
    /// Time for building the contact tree and counting heights into the histogram, s.
    pub tree: f64,
    /// Time for the thresholds of all loading stages, or for the steps of the stepwise solver, s.
    #[serde(rename = "loop")]
    pub passes: f64,
    /// Time for the curves and exact extremes of all loading stages, s.
    pub curve: f64,
    /// Time for F_a(d=0) and F_a(F=0), for the regimes, s.
    pub without_preload: f64,
}

impl Timings {
    /// Time of all computing stages, s.
    pub fn total(&self) -> f64 {
        self.line + self.tree + self.passes + self.curve + self.without_preload
    }
}

/// Reason why a checked scene could not be computed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A variant of the scene that the computation needs has values out of their ranges.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// The scene does not fit into memory.
    #[error(
        "not enough memory: this scene takes about {} MiB; fewer numerics.points and numerics.samples take less",
        bytes.div_ceil(1 << 20)
    )]
    OutOfMemory {
        /// Required bytes.
        bytes: u64,
    },
    /// The profile could not be made, for this reason.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Reversals were requested for the stepwise solver.
    #[error("numerics.solver = Stepwise: reversals need the exact solver; allowed: numerics.solver = Exact")]
    NeedsExactSolver,
    /// Turning points were requested for a loading that never presses.
    #[error(
        "loading: no indentation above 0 m at the preload; allowed: a stage that presses the bodies together"
    )]
    NeverPressed,
    /// No loading reaches the preload, since the contact already has a larger force at first touch.
    #[error(
        "preload {}: allowed: at least the force at first touch, {}",
        format_quantity(*preload, "N"),
        format_quantity(rounded_up(*touch), "N")
    )]
    BelowTouch {
        /// The preload, N.
        preload: f64,
        /// Force at first touch, N.
        touch: f64,
    },
    /// A stage presses the body deeper than one length of the profile beyond full contact.
    #[error(transparent)]
    BeyondFullContact(#[from] BeyondFullContact),
    /// The contact could not be computed, for this reason.
    #[error(transparent)]
    Contact(#[from] ContactError),
}

impl RunError {
    /// Returns true if the computation was stopped rather than failed.
    pub fn is_interruption(&self) -> bool {
        *self == RunError::Contact(ContactError::Interrupted)
    }
}
