//! Results of the solver for the screen. A result is never changed. It carries the generation of
//! its scene (a number that increases whenever the scene changes), and contains only as many
//! columns as the panes show.

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
    /// Spring or contact patch that is in the middle of the close-up, as the request named it.
    pub focus: Focus,
    /// Point of the force curve that the snapshot shows: indentation, force, number of springs in
    /// contact and number of contact patches.
    pub point: CurvePoint,
    /// Half the distance between the outermost edges of the contact in m; zero if nothing is in
    /// contact.
    pub contact_radius: f64,
    pub profile: Section,
    pub springs: SpringsInContact,
    pub close_up: CloseUp,
    /// Values at the crosshair on the profile; `None` if there is no crosshair.
    pub probe: Option<Probe>,
    /// Path of manual loading up to the state that the snapshot shows; `None` if there is no manual
    /// loading.
    pub manual: Option<ManualPath>,
}

/// Springs and contact patches of a snapshot. The snapshot does not own the springs, so they are
/// lost when the solver begins another profile.
#[derive(Clone, Debug, Default)]
pub struct SpringsInContact {
    pub gaps: Weak<Vec<f64>>,
    pub patches: Vec<Patch>,
}

/// Compares only the patches. Snapshots are compared together with their sections, and for equal
/// sections, equal patches mean equal springs.
impl PartialEq for SpringsInContact {
    fn eq(&self, other: &Self) -> bool {
        self.patches == other.patches
    }
}

/// Heights of the rigid profile and of the elastic surface at one spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    pub spring: usize,
    pub height: f64,
    /// Height in m of the undeformed elastic surface.
    pub level: f64,
    /// Index (from 0) of the contact patch to which the spring belongs; `None` if the spring is not
    /// in contact.
    pub patch: Option<usize>,
}

impl Probe {
    /// Returns the heights at a position along the profile, where 0 is the left end and 1 the right
    /// end. `None` if the profile has no springs.
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
    /// Returns a part of the profile with its contact, reduced to the columns of a chart. `None` if
    /// the solver has already begun another profile, and the springs are lost.
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

/// Returns the part of the profile that the profile pane shows. `count` is the number of springs of
/// the profile.
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
    /// Points added to the force curve since the previous snapshot, each with the index of its
    /// loading stage.
    pub path: Vec<(usize, CurvePoint)>,
    /// Loading from separation to this state. First come the stages of the scene, then the targets
    /// at which manual loading changed its direction.
    pub loading: Vec<Move>,
    /// Number of springs that have attached or detached since the previous snapshot.
    pub changed: u64,
    /// Elastic energy in J that has been released since manual loading began.
    pub released_energy: f64,
    /// Reason why the last move was refused; `None` if the move was carried out.
    pub refused: Option<String>,
}

/// State of manual loading, with its path from the beginning to the present state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualState {
    /// Points of the force curve under manual loading, the newest last.
    pub path: Vec<CurvePoint>,
    /// For each point of `path`, the index of its loading stage.
    pub stages: Vec<usize>,
    pub loading: Vec<Move>,
    /// Number of springs that attached or detached in the last move.
    pub changed: u64,
    /// Elastic energy in J that has been released since manual loading began.
    pub released_energy: f64,
    pub moves: Vec<ManualMove>,
    /// Text of the force that the user typed last. The solver may still refuse this force.
    pub typed: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloseUp {
    /// The visible part of the profile.
    pub section: Section,
    /// Ends of the visible patches, each as the index of a spring and the height of this spring in
    /// m. They are drawn like the white circles of Fig. 3 of Popov and Filippov (2012).
    pub boundaries: Vec<(usize, f64)>,
    /// The patch nearest to the middle of the close-up; `None` if nothing is in contact.
    pub patch: Option<PatchFacts>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFacts {
    /// Index of the patch, counted from 0 along the profile.
    pub number: usize,
    pub patch: Patch,
    pub state: PatchState,
}

/// Preview: outcome of the scene with the value that the user is typing.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// Text of the scene to which the outcome belongs.
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

    /// Returns true if this reply is the answer to a request. Returns false if it is a report of
    /// progress, which other replies follow.
    pub fn is_answer(&self) -> bool {
        !matches!(self, Reply::Progress { .. })
    }
}

#[derive(Clone, Debug)]
pub enum Reply {
    /// A scene has been computed. The reply includes the first snapshot, unless the loading is
    /// empty.
    Solved(Arc<SolvedScene>, Option<Arc<ContactSnapshot>>),
    /// Another snapshot of the scene has been computed.
    Shown(Arc<ContactSnapshot>),
    /// Some stages of a scene have been computed.
    Progress {
        generation: u64,
        /// Number of loading stages that have been computed.
        legs: usize,
    },
    Failed {
        generation: u64,
        /// Reason of the failure, on one line.
        error: String,
    },
}
