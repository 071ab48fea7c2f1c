//! Results of the solver: immutable, stamped with the generation of their scene, and already
//! reduced to the resolution of a pane.

use super::request::{Drive, Focus, LineView, ManualMove, SnapshotRequest};
use asperity_contact::motion::PatchState;
use asperity_contact::{CurvePoint, Move, Patch};
use asperity_report::{LineColumns, Part, Section, SectionContact};
use asperity_scene::stages::{LineFacts, Reach};
use asperity_scene::{CheckedScene, Outcome};
use std::sync::{Arc, Weak};

#[derive(Clone, Debug, PartialEq)]
pub struct SolvedScene {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    pub outcome: Outcome,
    pub reach: Reach,
}

#[derive(Clone, Debug, PartialEq)]
pub struct ContactSnapshot {
    pub generation: u64,
    pub drive: Drive,
    pub line: LineFacts,
    /// Requested position of the close-up.
    pub focus: Focus,
    /// Point of the force curve: indentation, force, number of springs in contact and of patches.
    pub point: CurvePoint,
    /// Half the distance between the outermost edges of the contact, m; zero in separation.
    pub contact_radius: f64,
    pub profile: Section,
    pub springs: SpringsInContact,
    pub close_up: CloseUp,
    /// Readings at the crosshair on the profile.
    pub probe: Option<Probe>,
    /// Path of manual loading to this state.
    pub manual: Option<ManualPath>,
}

/// The springs in a state and their patches. The snapshot does not keep the springs alive: they are
/// gone as soon as the solver begins another profile.
#[derive(Clone, Debug, Default)]
pub struct SpringsInContact {
    pub gaps: Weak<Vec<f64>>,
    pub patches: Vec<Patch>,
}

/// Compares the patches: equal patches of equal sections have equal springs.
impl PartialEq for SpringsInContact {
    fn eq(&self, other: &Self) -> bool {
        self.patches == other.patches
    }
}

/// Rigid profile and elastic surface at one spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    pub spring: usize,
    pub height: f64,
    /// Height of the undeformed elastic surface, m.
    pub level: f64,
    /// Number, from 0, of the contact patch that the spring belongs to; `None` if it is not in
    /// contact.
    pub patch: Option<usize>,
}

impl Probe {
    /// Reads profile and contact at a share of the profile; `None` for a profile without springs.
    pub fn at(contact: &SectionContact<'_>, position: f64) -> Option<Self> {
        let last = contact.gaps.len().checked_sub(1)?;
        let spring = ((position * contact.gaps.len() as f64) as usize).min(last);
        let next = contact.patches.partition_point(|patch| patch.last < spring);
        let is_in_contact = match contact.patches.get(next) {
            Some(patch) => patch.first <= spring,
            None => false,
        };
        Some(Probe {
            spring,
            height: contact.height(spring),
            level: contact.level(),
            patch: if is_in_contact { Some(next) } else { None },
        })
    }
}

impl ContactSnapshot {
    /// A part of the profile and its contact, reduced to columns; `None` if the springs are gone.
    pub fn section(&self, part: Part) -> Option<Section> {
        let gaps = self.springs.gaps.upgrade()?;
        let contact = SectionContact {
            gaps: &gaps,
            summit: self.line.summit,
            indentation: self.point.indentation,
            patches: &self.springs.patches,
        };
        Some(contact.section(part, &mut LineColumns::default()))
    }
}

/// The springs that the profile pane shows, within the profile.
pub fn profile_part(request: &SnapshotRequest, count: usize) -> Part {
    let LineView { centre, share } = request.profile;
    let springs = ((count as f64 * share).round() as usize).clamp(1, count.max(1));
    let middle = (count as f64 * centre) as usize;
    let first = middle.saturating_sub(springs / 2);
    Part {
        first: first.min(count.saturating_sub(springs)),
        springs,
        columns: request.profile_columns,
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualPath {
    /// Points of the force curve since then, each with the index of its loading stage.
    pub path: Vec<(usize, CurvePoint)>,
    /// Loading history from separation to this state: the loading of the scene, then the turning
    /// points of manual loading.
    pub loading: Vec<Move>,
    /// Number of springs that attached or detached since then.
    pub changed: u64,
    /// Elastic energy released since manual loading began, J.
    pub released_energy: f64,
    /// Reason why the body was not moved, if it was refused.
    pub refused: Option<String>,
}

/// Manual loading so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualState {
    /// Points of the path so far, the newest last.
    pub path: Vec<CurvePoint>,
    /// Index of the loading stage of each point of the path.
    pub stages: Vec<usize>,
    pub loading: Vec<Move>,
    /// Number of springs that attached or detached in the last move.
    pub changed: u64,
    /// Elastic energy released since manual loading began, J.
    pub released_energy: f64,
    pub moves: Vec<ManualMove>,
    /// The text of the force typed last, which the solver may refuse.
    pub typed: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloseUp {
    /// The part of the profile that is shown.
    pub section: Section,
    /// Boundary points of the shown patches: spring, and height in m (the white circles of Fig. 3).
    pub boundaries: Vec<(usize, f64)>,
    /// The patch nearest to the middle; `None` if nothing is in contact.
    pub patch: Option<PatchFacts>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFacts {
    /// Number of the patch along the line, from 0.
    pub number: usize,
    pub patch: Patch,
    pub state: PatchState,
}

/// Outcome for a value that is being typed.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The text of the scene, which identifies the scene.
    pub text: String,
    pub outcome: Outcome,
}

impl Reply {
    pub fn generation(&self) -> u64 {
        match self {
            Reply::Solved(solved, _) => solved.generation,
            Reply::Shown(snapshot) => snapshot.generation,
            Reply::Progress { generation, .. } | Reply::Failed { generation, .. } => *generation,
        }
    }

    /// Returns true for the last reply to a request, after which none follows.
    pub fn is_answer(&self) -> bool {
        !matches!(self, Reply::Progress { .. })
    }
}

#[derive(Clone, Debug)]
pub enum Reply {
    /// A scene is computed; with its first snapshot, unless its loading is empty.
    Solved(Arc<SolvedScene>, Option<Arc<ContactSnapshot>>),
    /// A further snapshot of a scene is ready.
    Shown(Arc<ContactSnapshot>),
    /// Part of the stages of a scene is computed.
    Progress {
        generation: u64,
        /// Number of computed loading stages.
        legs: usize,
    },
    Failed {
        generation: u64,
        /// Reason, on one line.
        error: String,
    },
}
