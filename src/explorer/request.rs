//! Requests from the explorer to the worker.

use crate::scene::Scene;
use std::sync::Arc;

/// State that the screen waits for: the scene, solved unless it is the last one, after the manual moves, reduced to a
/// snapshot.
#[derive(Clone, Debug)]
pub struct Request {
    /// Generation of the scene.
    pub generation: u64,
    pub scene: Arc<Scene>,
    /// Manual moves since the last request.
    pub moves: Vec<ManualMove>,
    /// Snapshot of the contact.
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

/// Move of manual loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ManualMove {
    /// Begins manual loading at an indentation of a leg.
    Take {
        /// Index of the leg.
        leg: usize,
        /// Indentation, m.
        indentation: f64,
    },
    /// Moves the body to an indentation, m.
    To(f64),
    /// Moves the body by a distance, m; pressing is positive.
    By(f64),
    /// Moves the body to a force, N.
    ToForce(f64),
    /// Pulls until nothing touches.
    Separate,
}

/// Place of the body on a loading stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Share of the stage, 0 to 1, as the animation plays it.
    Share(f64),
    /// Indentation, m.
    Indentation(f64),
}

/// Request for a snapshot of the contact, with the sizes of the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    /// Drive of the body.
    pub drive: Drive,
    /// Place on the stage; manual loading has its own.
    pub place: Place,
    /// Columns of dots of the profile pane.
    pub profile_columns: usize,
    /// Part of the line in the profile pane.
    pub profile: LineView,
    /// Columns of dots of the close-up pane.
    pub close_up_columns: usize,
    /// Cells across the close-up pane.
    pub strip_cells: usize,
    /// Place of the close-up.
    pub focus: Focus,
    pub close_up_springs: usize,
    /// Position of the crosshair as a share of the profile, 0 to 1.
    pub crosshair: Option<f64>,
}

/// Part of the line in the profile pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Its middle, as a share of the line.
    pub centre: f64,
    /// Shown share of the line, above 0 to 1.
    pub share: f64,
    /// True if its middle follows the close-up instead.
    pub follow: bool,
}

impl LineView {
    pub const WHOLE: LineView = LineView { centre: 0.5, share: 1.0, follow: false };
}

/// Place of the close-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// Place of first touch.
    Summit,
    Spring(usize),
    /// The fragment after the one nearest to a spring.
    After(Option<usize>),
    /// The fragment before the one nearest to a spring.
    Before(Option<usize>),
    /// The longest fragment.
    Largest,
    /// The fragment that carries the largest force, pressing or pulling.
    MostLoaded,
}

impl Focus {
    /// Returns true for a question, with a spring as the answer.
    pub fn is_question(self) -> bool {
        !matches!(self, Focus::Summit | Focus::Spring(_))
    }
}

/// Drive of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A leg of the scene's loading, by its index.
    Leg(usize),
    /// Manual loading.
    Manual,
}
