//! Requests from the explorer to the worker.

use super::panes::Pane;
use crate::scene::Scene;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Request from the explorer to the worker.
#[derive(Clone, Debug)]
pub enum Request {
    /// Compute a scene.
    Compute {
        /// Its generation.
        generation: u64,
        /// The scene.
        scene: Arc<Scene>,
    },
    /// Move the body manually, in the scene that was computed last.
    Manual {
        /// Generation of the scene it belongs to.
        generation: u64,
        /// Move.
        order: ManualMove,
    },
    /// Show a snapshot of the scene that was computed last.
    Show(SnapshotRequest),
    /// Compute a scene to be shown beside, or none.
    Beside(Option<Arc<Scene>>),
    /// Compute a scene to look at its curve: one of the library, or one with a value that is being typed.
    Preview {
        /// The scene's text.
        text: String,
        /// The scene.
        scene: Arc<Scene>,
    },
}

/// Move of manual loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ManualMove {
    /// Takes it where a leg of the loading has it at this indentation, m.
    Take {
        /// Index of the leg.
        leg: usize,
        /// Indentation, m.
        indentation: f64,
    },
    /// Gives it back.
    Give,
    /// Moves it to an indentation, m.
    To(f64),
    /// Moves it by so much, m; pressing is positive.
    By(f64),
    /// Moves it until its force is this one, N.
    ToForce(f64),
    /// Pulls until nothing touches.
    Separate,
}

/// Request for a snapshot of the contact, with the sizes of the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    /// Generation of the scene it belongs to.
    pub generation: u64,
    /// Drive of the body.
    pub drive: Drive,
    /// Indentation, m; manual loading has its own.
    pub indentation: f64,
    /// Columns of dots of the profile pane.
    pub profile_columns: usize,
    /// Part of the line in the profile pane.
    pub profile: LineView,
    /// Columns of dots of the close-up pane.
    pub close_up_columns: usize,
    /// Cells across it.
    pub strip_cells: usize,
    /// Place of the close-up.
    pub focus: Focus,
    /// Springs it shows.
    pub close_up_springs: usize,
    /// Pane in the place of profile and close-up.
    pub large: Option<Pane>,
    /// Pane in the place of the close-up.
    pub lower: Pane,
    /// Position of the crosshair as a share of the profile, 0 to 1.
    pub crosshair: Option<f64>,
    /// Loading stage and indentation, m, of the scene beside.
    pub beside: Option<(usize, f64)>,
}

/// Part of the line in the profile pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Its middle, as a share of the line.
    pub centre: f64,
    /// Share of the line that it shows, above 0 to 1.
    pub share: f64,
    /// True if its middle follows the close-up instead.
    pub follow: bool,
}

impl LineView {
    /// The whole line.
    pub const WHOLE: LineView = LineView { centre: 0.5, share: 1.0, follow: false };
}

/// Place of the close-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// Place of first touch.
    Summit,
    /// A spring.
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
    /// Returns true if it is a question, to which a spring is the answer.
    #[must_use]
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

/// Newest generation that the explorer waits for; a run for an older one stops.
#[derive(Debug, Default)]
pub struct Awaited {
    generation: AtomicU64,
    preview: Mutex<Option<Arc<Scene>>>,
}

impl Awaited {
    /// Makes this the generation that is waited for.
    pub fn set_generation(&self, generation: u64) {
        self.generation.store(generation, Ordering::Relaxed);
    }

    /// A newer scene than that of this generation is waited for.
    #[must_use]
    pub fn is_newer_than(&self, generation: u64) -> bool {
        self.generation.load(Ordering::Relaxed) != generation
    }

    /// Makes this the preview that is waited for, or none.
    pub fn set_preview(&self, scene: Option<Arc<Scene>>) {
        *self.preview.lock().unwrap_or_else(PoisonError::into_inner) = scene;
    }

    /// Makes a request what is waited for: a scene makes all older ones and every preview stale at once, and a preview those
    /// before.
    pub fn ask(&self, request: &Request) {
        match request {
            Request::Compute { generation, .. } => {
                self.set_generation(*generation);
                self.set_preview(None);
            }
            Request::Preview { scene, .. } => self.set_preview(Some(Arc::clone(scene))),
            Request::Manual { .. } | Request::Show(_) | Request::Beside(_) => {}
        }
    }

    /// This very preview is waited for.
    #[must_use]
    pub fn is_preview(&self, scene: &Arc<Scene>) -> bool {
        let preview = self.preview.lock().unwrap_or_else(PoisonError::into_inner);
        preview.as_ref().is_some_and(|awaited| Arc::ptr_eq(awaited, scene))
    }
}

/// The same for explorer and worker.
pub type Newest = Arc<Awaited>;
