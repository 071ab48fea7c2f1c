//! Requests from the explorer to the solver for a state of the contact.

use super::events::LeastShare;
use super::manual_path::ManualPath;
use super::player::At;
use asperity_scene::CheckedScene;
use std::sync::Arc;

/// Request for a snapshot: the state of the contact in a scene. If the solver has not solved the
/// scene yet, it solves the scene first. A request needs nothing from earlier requests, so of all
/// waiting requests only the newest is answered.
#[derive(Clone, Debug)]
pub struct Request {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    /// Path along which the user has moved the body; `None` without manual loading.
    pub path: Option<Arc<ManualPath>>,
    /// Smallest energy of a listed jump, as a share of the largest one.
    pub least_share: LeastShare,
    pub snapshot: SnapshotRequest,
}

/// Part of a request that describes the snapshot. The snapshot has as many columns as the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    pub drive: Drive,
    /// Position of the animation within its loading stage. The end of a path does not use it.
    pub at: At,
    /// Width of the profile pane in columns of dots, of which several may be in one character cell.
    pub profile_columns: usize,
    pub profile: LineView,
    /// Width of the close-up in columns of dots, of which several may be in one character cell.
    pub close_up_columns: usize,
    pub focus: Focus,
    /// Number of springs in the close-up; `None` to show the whole patch.
    pub close_up_springs: Option<usize>,
    /// Position of the crosshair along the profile, from 0 to 1; `None` if there is no crosshair.
    pub crosshair: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Middle of the visible part, from 0 at the left end of the profile to 1 at the right end.
    pub centre: f64,
    /// Length of the visible part divided by the length of the profile; above 0, at most 1.
    pub share: f64,
}

impl LineView {
    pub const WHOLE: LineView = LineView {
        centre: 0.5,
        share: 1.0,
    };
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseUpTarget {
    pub focus: Focus,
    /// Number of springs in the close-up; `None` to show the whole contact patch.
    pub springs: Option<usize>,
}

impl CloseUpTarget {
    /// Close-up of the whole contact patch at the point of first touch.
    pub const WHOLE: CloseUpTarget = CloseUpTarget {
        focus: Focus::Summit,
        springs: None,
    };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    Summit,
    Spring(usize),
    /// The contact patch that follows the patch nearest to this spring, along the profile.
    After(Option<usize>),
    /// The contact patch that precedes the patch nearest to this spring, along the profile.
    Before(Option<usize>),
}

impl Focus {
    /// Returns true if the request does not state the spring in the middle of the close-up, so that
    /// the solver has to find this spring.
    pub fn is_question(self) -> bool {
        !matches!(self, Focus::Summit | Focus::Spring(_))
    }
}

/// What moves the body to the state that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Loading stage of the scene, given by its index.
    Stage(usize),
    /// Manual loading: the body is at the end of its path.
    Manual,
    /// The animation plays the path of manual loading, and is in the stage with this index.
    Path(usize),
}
