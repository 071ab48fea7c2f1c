//! Results of the solver for the screen. A result is never changed. It carries the generation of
//! its scene (a number that increases whenever the scene changes), and contains only as many
//! columns as the panes show.

use super::events::ListedEvents;
use super::manual_path::ManualPath;
use super::request::{Drive, Focus, LineView, SnapshotRequest};
use asperity_contact::motion::PatchState;
use asperity_contact::{CurvePoint, Move, Patch, StageRecord};
use asperity_report::{LineColumns, Part, Section, SectionContact};
use asperity_scene::workload::{LineFacts, Reach};
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
    /// Time of the point in s since first touch; `None` without relaxation, because time then has
    /// no effect.
    pub seconds: Option<f64>,
    /// Half the distance between the outermost edges of the contact in m; zero if nothing is in
    /// contact.
    pub contact_radius: f64,
    pub profile: Section,
    pub springs: SpringsInContact,
    pub close_up: CloseUp,
    /// Values at the crosshair on the profile; `None` if there is no crosshair.
    pub probe: Option<Probe>,
    /// Path of manual loading; `None` without manual loading.
    pub followed: Option<Arc<FollowedPath>>,
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

/// Path of manual loading, as the body has followed it.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowedPath {
    pub path: Arc<ManualPath>,
    /// Records of the stages from separation to the present state: first the stages that lead to
    /// the start of the path, then one stage for each move.
    pub stages: Vec<StageRecord>,
    /// Number of stages that lead to the start of the path.
    pub before: usize,
    /// Reason why the contact cannot follow the next move; `None` if it has followed all moves.
    pub stopped: Option<String>,
}

impl FollowedPath {
    /// Returns the loading history from separation to the present state.
    pub fn loading(&self) -> Vec<Move> {
        self.stages.iter().map(|stage| stage.target).collect()
    }

    /// Returns the number of moves that the body has followed.
    pub fn count(&self) -> usize {
        self.stages.len().saturating_sub(self.before)
    }

    /// Returns the records of the moves that the body has followed.
    pub fn moves(&self) -> &[StageRecord] {
        self.stages.get(self.before..).unwrap_or_default()
    }
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
            Reply::Listed(events) => events.generation,
            Reply::Progress { generation, .. } | Reply::Failed { generation, .. } => *generation,
        }
    }

    /// Returns true if this reply is the answer to a request. Returns false if it is a report of
    /// progress, which other replies follow, or the list of events, which follows an answer.
    pub fn is_answer(&self) -> bool {
        !matches!(self, Reply::Progress { .. } | Reply::Listed(_))
    }
}

#[derive(Clone, Debug)]
pub enum Reply {
    /// A scene has been computed. The reply includes the first snapshot, unless the loading is
    /// empty.
    Solved(Arc<SolvedScene>, Option<Arc<ContactSnapshot>>),
    /// Another snapshot of the scene has been computed.
    Shown(Arc<ContactSnapshot>),
    /// The events of the scene or of the path of manual loading have been listed.
    Listed(Arc<ListedEvents>),
    /// Some stages of a scene have been computed.
    Progress {
        generation: u64,
        /// Number of loading stages that have been computed.
        stages: usize,
    },
    Failed {
        generation: u64,
        /// Reason of the failure, on one line.
        error: String,
    },
}
