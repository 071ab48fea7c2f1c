//! Results of the worker: immutable, stamped with the generation of their scene, and
//! already reduced to the resolution of a pane.

use super::panes::SceneSpectra;
pub use super::request::Drive;
use super::request::Focus;
use crate::contact::{ContactError, CurvePoint, Patch};
pub use crate::export::section::{Column, Section};
use crate::scene::Scene;
use crate::simulation::{LineFacts, Outcome};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A computed scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedScene {
    /// Generation of the scene.
    pub generation: u64,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Outcome.
    pub outcome: Outcome,
}

/// State of the contact at one indentation.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSnapshot {
    /// Generation of the scene.
    pub generation: u64,
    /// Drive of the body.
    pub drive: Drive,
    /// The shown profile.
    pub line: LineFacts,
    /// Requested place of the close-up.
    pub focus: Focus,
    /// Indentation, force, springs in contact and fragments.
    pub point: CurvePoint,
    /// Half the distance between the outermost edges of the contact, m; zero in separation.
    pub contact_radius: f64,
    /// The line, or a part of it.
    pub profile: Section,
    /// The neighbourhood of one fragment.
    pub close_up: CloseUp,
    /// Contact of the whole profile in a row of cells: `■` where all springs touch, `▪` some, `·` none.
    pub strip: String,
    /// Readings of the crosshair on the profile.
    pub probe: Option<Probe>,
    /// Numbers of patches of n springs over ⌊log₂ n²⌋, where requested.
    pub lengths: Option<BTreeMap<u32, u64>>,
    /// Spectra of the scene, where requested.
    pub spectra: Option<Arc<SceneSpectra>>,
    /// Path of manual loading to this state.
    pub manual: Option<ManualPath>,
}

/// Rigid profile and elastic surface at one spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// The spring.
    pub spring: usize,
    /// Height of the rigid profile, m.
    pub height: f64,
    /// Height of the undeformed elastic surface, m.
    pub level: f64,
    /// Number of the contact patch of the spring along the profile, from 0; none where the spring is free.
    pub patch: Option<usize>,
}

/// Path of manual loading since the last snapshot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualPath {
    /// Points of the curve on the way, without its start.
    pub path: Vec<CurvePoint>,
    /// Springs attached or detached.
    pub changed: u64,
    /// Elastic energy released since manual loading began, J.
    pub released_energy: f64,
    /// Reason why the body was not moved.
    pub refused: Option<Refusal>,
}

/// Reason why the body was not moved manually.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The contact detaches at a larger force.
    Detaches {
        /// Smallest force within reach, N.
        smallest: f64,
    },
    /// The force lies far beyond full contact.
    BeyondFullContact {
        /// Force at full contact, N.
        full_contact: f64,
        /// Largest allowed force, N.
        largest: f64,
    },
    /// Any other.
    Other(ContactError),
}

impl From<ContactError> for Refusal {
    fn from(error: ContactError) -> Self {
        match error {
            ContactError::DetachesBefore { smallest } => Refusal::Detaches { smallest },
            other => Refusal::Other(other),
        }
    }
}

/// The neighbourhood of one contact fragment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloseUp {
    /// The springs shown.
    pub section: Section,
    /// Boundary points of the fragments shown: spring and z in m (the white circles of Fig. 3).
    pub boundaries: Vec<(usize, f64)>,
    /// The fragment nearest to the middle.
    pub fragment: Option<FragmentFacts>,
}

/// One contact fragment in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FragmentFacts {
    /// Its number along the line, from 0.
    pub number: usize,
    /// Its springs.
    pub patch: Patch,
    /// Its length δx, m.
    pub length: f64,
    /// Largest stretch by the rule of Hess, eq. (10), m; zero without adhesion.
    pub largest_stretch: f64,
    /// Stretch of its most stretched spring, m; negative when all are compressed.
    pub most_stretched: f64,
    /// Force, N; compression positive.
    pub force: f64,
}

/// Outcome of a tried scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The text of the scene, different for different scenes.
    pub text: String,
    /// Outcome, or the reason for none.
    pub outcome: Result<Outcome, String>,
}

/// Report of the worker.
#[derive(Clone, Debug)]
pub enum Report {
    /// A scene has been computed, with its first snapshot unless its loading is empty.
    Solved(Arc<SolvedScene>, Option<Arc<ContactSnapshot>>),
    /// Another snapshot of it is ready.
    Shown(Arc<ContactSnapshot>),
    /// Part of a scene is done.
    Progress {
        /// Its generation.
        generation: u64,
        /// Legs done.
        legs: usize,
    },
    /// A scene could not be computed.
    Failed {
        /// Its generation.
        generation: u64,
        /// Reason, in one line.
        error: String,
    },
    /// A tried scene has been computed, or has failed.
    Tried(Arc<Preview>),
}
