//! Requests from the explorer to the solver.

use super::player::At;
use asperity_scene::CheckedScene;
use std::sync::Arc;

/// Request for a state of a scene after manual moves, reduced to a snapshot. The scene is solved
/// first, unless it is the last one.
#[derive(Clone, Debug)]
pub struct Request {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    /// Manual moves since the last request.
    pub moves: Vec<ManualMove>,
    pub snapshot: SnapshotRequest,
}

impl Request {
    /// Merges this request with an earlier one that was not answered: manual moves of the same
    /// scene are kept.
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
    /// Begins manual loading at a position of a loading stage.
    Take {
        leg: usize,
        at: At,
    },
    To(f64),
    /// Moves the body by a distance, m; positive presses.
    By(f64),
    ToForce(f64),
    Separate,
}

/// Request for a snapshot of the contact, in the resolution of the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    pub drive: Drive,
    /// Position of the animation in the stage; not used under manual loading.
    pub at: At,
    /// Width of the profile pane, columns of dots.
    pub profile_columns: usize,
    pub profile: LineView,
    /// Width of the close-up pane, columns of dots.
    pub close_up_columns: usize,
    pub focus: Focus,
    /// Number of springs in the close-up; `None`: as many as show the whole patch.
    pub close_up_springs: Option<usize>,
    /// Position of the crosshair as a share of the profile, 0 to 1.
    pub crosshair: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Middle of the shown part, as a share of the line.
    pub centre: f64,
    /// Shown part, as a share of the line, above 0 and at most 1.
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
    /// Number of springs; `None`: as many as show the whole patch.
    pub springs: Option<usize>,
}

impl CloseUpTarget {
    /// The patch at first touch as a whole.
    pub const WHOLE: CloseUpTarget = CloseUpTarget {
        focus: Focus::Summit,
        springs: None,
    };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    Summit,
    Spring(usize),
    /// The patch that follows the patch nearest to this spring.
    After(Option<usize>),
    /// The patch that precedes the patch nearest to this spring.
    Before(Option<usize>),
}

impl Focus {
    /// Returns true for a question that the solver answers by a spring.
    pub fn is_question(self) -> bool {
        !matches!(self, Focus::Summit | Focus::Spring(_))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A loading stage of the scene, by its index.
    Leg(usize),
    Manual,
}
