//! Requests from the explorer to the solver.

use super::player::At;
use asperity_scene::CheckedScene;
use std::sync::Arc;

/// State that the screen waits for: the scene, solved unless it is the last one, after the manual moves, reduced to a
/// snapshot.
#[derive(Clone, Debug)]
pub struct Request {
    pub generation: u64,
    pub scene: Arc<CheckedScene>,
    /// Manual moves since the last request.
    pub moves: Vec<ManualMove>,
    pub snapshot: SnapshotRequest,
}

impl Request {
    /// This request in place of an earlier one: no manual move of the same scene is lost.
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
    /// Begins manual loading at a place of a loading stage.
    Take {
        leg: usize,
        at: At,
    },
    /// Moves the body to an indentation, m.
    To(f64),
    /// Moves the body by a distance, m; pressing is positive.
    By(f64),
    /// Moves the body to a force, N.
    ToForce(f64),
    Separate,
}

/// Request for a snapshot of the contact, with the sizes of the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    pub drive: Drive,
    /// Place of the animation in the stage; manual loading has a place of its own.
    pub at: At,
    /// Columns of dots of the profile pane.
    pub profile_columns: usize,
    pub profile: LineView,
    /// Columns of dots of the close-up pane.
    pub close_up_columns: usize,
    /// Cells across the close-up pane.
    pub strip_cells: usize,
    pub focus: Focus,
    pub close_up_springs: usize,
    /// Position of the crosshair as a share of the profile, 0 to 1.
    pub crosshair: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Its middle, as a share of the line.
    pub centre: f64,
    /// Shown share of the line, above 0 to 1.
    pub share: f64,
}

impl LineView {
    pub const WHOLE: LineView = LineView { centre: 0.5, share: 1.0 };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    Summit,
    Spring(usize),
    /// The patch after the one nearest to a spring.
    After(Option<usize>),
    /// The patch before the one nearest to a spring.
    Before(Option<usize>),
    Largest,
    /// The patch that carries the largest force, pressing or pulling.
    MostLoaded,
}

impl Focus {
    /// Returns true for a question, with a spring as the answer.
    pub fn is_question(self) -> bool {
        !matches!(self, Focus::Summit | Focus::Spring(_))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A leg of the scene's loading, by its index.
    Leg(usize),
    Manual,
}
