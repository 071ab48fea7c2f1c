//! Results of a scene, or the reason why it could not be computed.

use super::reach::BeyondFullContact;
use crate::analysis::governing::{Governing, SteepWaves};
use crate::analysis::instrument::InstrumentFigures;
use crate::analysis::regime::Regime;
use crate::scene::errors::SceneErrors;
use asperity_contact::{ContactError, Figures, History, Patch};
use asperity_data::{Remedied, Remedy, Warning, format_quantity, rounded_up};
use asperity_surface::SurfaceError;
use asperity_surface::lines::Histogram;
use serde::Serialize;
use thiserror::Error;

/// All results of a computed scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// Facts about the profile, the rigid line above the springs, such as its length and its
    /// largest gap.
    pub line: LineFacts,
    /// Parameters that govern the contact: effective modulus, work of adhesion, rms height and rms
    /// gradient of the roughness, and the two parameters κ and e_el/γ that compare the roughness
    /// with the adhesion.
    pub governing: Governing,
    /// Ideal pull-off force F_a,max in N of a flat face whose length is the length of the profile,
    /// eq. (14) of Popov and Filippov (2012); `None` without adhesion.
    pub ideal_pull_off_force: Option<f64>,
    /// Pull-off force F_smooth in N of the same body without roughness after the same preload;
    /// `None` without adhesion.
    pub smooth_pull_off_force: Option<f64>,
    /// Pull-off force F_a(d=0) in N after a loading that ends at first touch. `None` if the scene
    /// has no adhesion or no unloading stage.
    pub first_touch_pull_off_force: Option<f64>,
    /// Pull-off force F_a(F=0) in N after a loading that ends where the force has returned to zero.
    /// `None` if the scene has no adhesion or no unloading stage.
    pub zero_force_pull_off_force: Option<f64>,
    /// Tabor number μ; `None` without adhesion, and for a body without a radius of curvature, such
    /// as a cone.
    pub tabor_number: Option<f64>,
    /// Steep waves of a wavy sphere with adhesion. Waves are steep if the rule of Hess differs from
    /// the theory of Johnson, Kendall and Roberts. `None` if there are no such waves.
    pub steep_waves: Option<SteepWaves>,
    /// Regime of adhesion (Fig. 4 of Popov and Filippov (2012)), derived with F_a(d=0), the
    /// pull-off force after a loading that ends at first touch. `None` for a loading without a
    /// tensile force.
    pub regime: Option<Regime>,
    /// Regime of adhesion, derived with F_a(F=0), the pull-off force after a loading that ends at
    /// zero force. `None` for a loading without a tensile force.
    pub regime_after_zero_force: Option<Regime>,
    /// Main forces and energies of the loading, such as preload, pull-off force and dissipated
    /// energy.
    pub figures: Figures,
    /// Pull-off displacement and loop area of the instrument; `None` for a rigid instrument.
    pub instrument: Option<InstrumentFigures>,
    /// Force curves of all loading stages, and the contact patches after the last one.
    pub history: History,
    /// Contact patches at the end of each loading stage. The list is empty unless the scene has
    /// [`Observer::Patches`](crate::Observer::Patches).
    pub patches: Vec<Vec<Patch>>,
    /// Histogram of the heights of the profile; `None` unless the scene has
    /// [`Observer::HeightHistogram`](crate::Observer::HeightHistogram).
    pub histogram: Option<Histogram>,
    /// A warning for each premise of the model that the scene or its results do not meet; empty if
    /// all premises hold. Each [`Warning`] states the consequence for the results.
    pub warnings: Vec<Warning>,
    /// Times that the parts of the computation have taken.
    pub timings: Timings,
}

impl Outcome {
    /// Returns the ratio F_a/F_a,max of the pull-off force to the ideal pull-off force; `None`
    /// without a tensile force or without adhesion.
    pub fn adhesion_share(&self) -> Option<f64> {
        Some(
            self.figures.pull_off_force?
                / self.ideal_pull_off_force.filter(|ideal| *ideal > 0.0)?,
        )
    }
}

/// Facts about the profile of a scene, such as its length and its largest gap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineFacts {
    /// Number of springs N along the length L.
    pub points: usize,
    /// Apparent diameter L in m.
    pub length: f64,
    /// Distance Δx between springs in m.
    pub spacing: f64,
    /// Index of the first spring under the body. It is above zero only for a punch.
    pub first: usize,
    /// Height of the highest point of the profile in m. The height is 0 at the apex of the form
    /// without roughness.
    pub summit: f64,
    /// Largest gap in m: depth of the lowest point of the profile below its highest point.
    pub deepest: f64,
    /// First and last mode of a random roughness, as numbers of waves on the length L; `None` for
    /// other profiles.
    pub modes: Option<(u64, u64)>,
    /// Seed of the random phases; `None` for profiles without random phases.
    pub seed: Option<u64>,
    /// Rms gradient that a continuous spectrum with the same rms height has, eq. (12) of Popov and
    /// Filippov (2012). `None` unless the roughness is self-affine.
    pub continuum_rms_gradient: Option<f64>,
}

/// Times in s that the parts of a computation have taken. The time is zero for a part whose earlier
/// result was used again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Timings {
    /// Time in s for computing the profile from the form and the roughness.
    pub profile: f64,
    /// Time in s for building the contact tree
    /// ([`WorkPart::Tree`](crate::simulation::workload::WorkPart::Tree)) and for the histogram of
    /// the heights.
    pub tree: f64,
    /// Time in s for finding the indentations at which contact patches form, merge, split and
    /// detach, or for the steps of the stepwise solver.
    #[serde(rename = "loop")]
    pub passes: f64,
    /// Time in s for the force curves of all loading stages, with their largest and smallest
    /// forces.
    pub curve: f64,
    /// Time in s for two pull-off forces without a preload, F_a(d=0) and F_a(F=0). The regimes
    /// depend on these forces.
    pub without_preload: f64,
}

impl Timings {
    /// Returns the sum of all times in s.
    pub fn total(&self) -> f64 {
        self.profile + self.tree + self.passes + self.curve + self.without_preload
    }
}

/// Reason why a checked scene could not be computed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A value that the computation changed, such as the number of springs, is out of its range.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// There is not enough memory for the scene.
    #[error(
        "not enough memory: this scene takes about {} MiB; fewer numerics.points, numerics.samples and loading stages take less",
        bytes.div_ceil(1 << 20)
    )]
    OutOfMemory {
        /// Required memory in bytes.
        bytes: u64,
    },
    /// The profile could not be computed from the form and the roughness.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Unloadings from many turning points were requested for a scene with the stepwise solver.
    #[error(
        "numerics.solver = Stepwise: reversals need the exact solver; allowed: numerics.solver = Exact"
    )]
    NeedsExactSolver,
    /// A [`ReversalMap`](crate::theory::ReversalMap) was requested for a loading that never presses
    /// the bodies together.
    #[error(
        "loading: no indentation above 0 m at the preload; allowed: a stage that presses the bodies together"
    )]
    NeverPressed,
    /// The requested preload is below the force at first touch, so no loading from separation can
    /// end at this force.
    #[error(
        "preload {}: allowed: at least the force at first touch, {}",
        format_quantity(*preload, "N"),
        format_quantity(rounded_up(*touch), "N")
    )]
    BelowTouch {
        /// Requested preload in N.
        preload: f64,
        /// Force at first touch in N.
        touch: f64,
    },
    /// A loading stage presses the body too deep: beyond full contact, where all springs touch, by
    /// more than the length of the profile.
    #[error(transparent)]
    BeyondFullContact(#[from] BeyondFullContact),
    /// The contact could not be computed.
    #[error(transparent)]
    Contact(#[from] ContactError),
}

impl Remedied for RunError {
    fn remedies(&self) -> Vec<Remedy> {
        match self {
            RunError::Surface(error) => error.remedies(),
            _ => Vec::new(),
        }
    }
}

impl RunError {
    /// Returns true if the caller stopped the computation.
    pub fn is_interruption(&self) -> bool {
        *self == RunError::Contact(ContactError::Interrupted)
    }
}
