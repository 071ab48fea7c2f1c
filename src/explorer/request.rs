//! Requests from the explorer to the solver for a state of the contact.

use super::player::At;
use asperity_scene::CheckedScene;
use std::sync::Arc;

/// Request for a snapshot, which is the state of the contact in a scene after manual moves. If the
/// solver has not computed the scene yet, it computes the scene first.
#[derive(Clone, Debug)]
pub struct Request {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    /// Manual moves since the previous request.
    pub moves: Vec<ManualMove>,
    pub snapshot: SnapshotRequest,
}

impl Request {
    /// Combines this request with an earlier request that the solver has not answered. The combined
    /// request is for the scene of this request. If both requests are for the same scene, the
    /// manual moves of the earlier request come first.
    pub fn after(mut self, mut earlier: Request) -> Request {
        if earlier.generation == self.generation {
            earlier.moves.append(&mut self.moves);
            self.moves = earlier.moves;
        }
        self
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ManualMove {
    /// Begins manual loading. The body starts with the state of the contact at this position of a
    /// loading stage.
    Take {
        leg: usize,
        at: At,
    },
    To(f64),
    /// Moves the body by this distance in m. A positive distance presses the body further.
    By(f64),
    ToForce(f64),
    Separate,
}

/// Part of a request that states what the snapshot shows. The snapshot has as many columns as the
/// panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    pub drive: Drive,
    /// Position of the animation within its loading stage. It has no meaning during manual loading.
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Loading stage of the scene, given by its index.
    Leg(usize),
    Manual,
}
