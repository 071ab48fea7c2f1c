//! Results of the worker: immutable, stamped with the generation of their scene, and
//! already reduced to the resolution of a pane.

use super::request::{Drive, Focus, LineView, SnapshotRequest};
use crate::export::section::Section;
use crate::export::section::{Contact, LineColumns, Part};
use asperity_contact::Move;
use asperity_contact::{CurvePoint, Patch, PatchState, Springs};
use asperity_scene::CheckedScene;
use asperity_scene::Reach;
use asperity_scene::{LineFacts, Outcome};
use std::sync::{Arc, Weak};

#[derive(Clone, Debug, PartialEq)]
pub struct SolvedScene {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    pub outcome: Outcome,
    pub reach: Reach,
}

/// State of the contact at one indentation.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSnapshot {
    pub generation: u64,
    pub drive: Drive,
    pub line: LineFacts,
    /// Requested place of the close-up.
    pub focus: Focus,
    /// Indentation, force, springs in contact and patches.
    pub point: CurvePoint,
    /// Half the distance between the outermost edges of the contact, m; zero in separation.
    pub contact_radius: f64,
    pub profile: Section,
    /// All springs of this state, for files.
    pub springs: SpringsInContact,
    /// The neighbourhood of one patch.
    pub close_up: CloseUp,
    /// Contact of the whole profile in a row of cells: `■` where all springs touch, `▪` some, `·` none.
    pub strip: String,
    /// Readings of the crosshair on the profile.
    pub probe: Option<Probe>,
    /// Path of manual loading to this state.
    pub manual: Option<ManualPath>,
}

/// The springs of a state and their patches. The snapshot does not keep the springs alive: they are gone as soon as the
/// solver begins another profile.
#[derive(Clone, Debug, Default)]
pub struct SpringsInContact {
    pub springs: Weak<Springs>,
    pub patches: Vec<Patch>,
}

/// Equal patches of equal sections have equal springs.
impl PartialEq for SpringsInContact {
    fn eq(&self, other: &Self) -> bool {
        self.patches == other.patches
    }
}

/// Rigid profile and elastic surface at one spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    pub spring: usize,
    /// Height of the rigid profile, m.
    pub height: f64,
    /// Height of the undeformed elastic surface, m.
    pub level: f64,
    /// Number of the contact patch of the spring along the profile, from 0; none where the spring is free.
    pub patch: Option<usize>,
}

impl Probe {
    /// Profile and contact at a share of the profile; `None` for a profile without springs.
    pub fn at(contact: &Contact<'_>, position: f64) -> Option<Self> {
        let last = contact.gaps.len().checked_sub(1)?;
        let spring = ((position * contact.gaps.len() as f64) as usize).min(last);
        let next = contact.patches.partition_point(|patch| patch.last < spring);
        Some(Probe {
            spring,
            height: contact.height(spring),
            level: contact.level(),
            patch: contact.patches.get(next).filter(|patch| patch.first <= spring).map(|_| next),
        })
    }
}

impl ContactSnapshot {
    /// A part of the profile and its contact in columns of springs; `None` once the springs are gone.
    pub fn section(&self, part: Part) -> Option<Section> {
        let SpringsInContact { springs, patches } = &self.springs;
        let (springs, indentation) = (springs.upgrade()?, self.point.indentation);
        let contact = Contact { gaps: springs.gaps(), summit: self.line.summit, indentation, patches };
        Some(contact.section(part, &mut LineColumns::default()))
    }
}

/// Contact of the whole profile in a row of cells.
pub fn strip(contact: &Contact<'_>, cells: usize) -> String {
    let whole = Part { first: 0, springs: contact.gaps.len(), columns: cells };
    let glyph = |cell| {
        let springs = whole.springs_of(cell);
        match contact.within(springs.clone()).map(|part| part.len()).sum::<usize>() {
            0 => '·',
            touching if touching == springs.len() => '■',
            _ => '▪',
        }
    };
    (0..cells).map(glyph).collect()
}

/// The springs of the profile pane: a part within the line.
pub fn profile_part(request: &SnapshotRequest, count: usize) -> Part {
    let LineView { centre, share } = request.profile;
    let springs = ((count as f64 * share).round() as usize).clamp(1, count.max(1));
    let first =
        ((count as f64 * centre) as usize).saturating_sub(springs / 2).min(count.saturating_sub(springs));
    Part { first, springs, columns: request.profile_columns }
}

/// Path of manual loading since the last snapshot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualPath {
    /// Points of the curve on the way, without its start, with the places of their stages.
    pub path: Vec<(usize, CurvePoint)>,
    /// The history from separation to this state: the loading of the scene, then turning points of manual loading.
    pub loading: Vec<Move>,
    /// Springs attached or detached.
    pub changed: u64,
    /// Elastic energy released since manual loading began, J.
    pub released_energy: f64,
    /// Reason why the body was not moved.
    pub refused: Option<String>,
}

/// The neighbourhood of one contact patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloseUp {
    /// The springs shown.
    pub section: Section,
    /// Boundary points of the patches shown: spring and z in m (the white circles of Fig. 3).
    pub boundaries: Vec<(usize, f64)>,
    /// The patch nearest to the middle.
    pub patch: Option<PatchFacts>,
}

/// One contact patch in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFacts {
    /// Its number along the line, from 0.
    pub number: usize,
    /// Its springs.
    pub patch: Patch,
    /// Its length, force and stretch.
    pub state: PatchState,
}

/// Outcome of a tried scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The text of the scene, different for different scenes.
    pub text: String,
    pub outcome: Outcome,
}

impl Reply {
    /// Generation of the scene.
    pub fn generation(&self) -> u64 {
        match self {
            Reply::Solved(solved, _) => solved.generation,
            Reply::Shown(snapshot) => snapshot.generation,
            Reply::Progress { generation, .. } | Reply::Failed { generation, .. } => *generation,
        }
    }
}

/// Answer of the solver.
#[derive(Clone, Debug)]
pub enum Reply {
    /// A scene has been computed, with its first snapshot unless its loading is empty.
    Solved(Arc<SolvedScene>, Option<Arc<ContactSnapshot>>),
    /// Another snapshot of it is ready.
    Shown(Arc<ContactSnapshot>),
    /// Part of a scene is done.
    Progress {
        generation: u64,
        /// Number of computed stages.
        legs: usize,
    },
    /// A scene could not be computed.
    Failed {
        generation: u64,
        /// Reason, in one line.
        error: String,
    },
}
