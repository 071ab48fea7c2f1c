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
    /// Move the body manually, in the last computed scene.
    Manual {
        /// Generation of the scene.
        generation: u64,
        /// Move.
        order: ManualMove,
    },
    /// Show a snapshot of the last computed scene.
    Show(SnapshotRequest),
    /// Compute a scene beside, or none.
    Beside(Option<Arc<Scene>>),
    /// Compute the preview of a scene: one of the library, or one with a value being typed.
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
    /// Begins manual loading at an indentation of a leg.
    Take {
        /// Index of the leg.
        leg: usize,
        /// Indentation, m.
        indentation: f64,
    },
    /// Ends manual loading.
    Give,
    /// Moves the body to an indentation, m.
    To(f64),
    /// Moves the body by a distance, m; pressing is positive.
    By(f64),
    /// Moves the body to a force, N.
    ToForce(f64),
    /// Pulls until nothing touches.
    Separate,
}

/// Request for a snapshot of the contact, with the sizes of the panes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapshotRequest {
    /// Generation of the scene.
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
    /// Cells across the close-up pane.
    pub strip_cells: usize,
    /// Place of the close-up.
    pub focus: Focus,
    /// Springs of the close-up.
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
    /// Shown share of the line, above 0 to 1.
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
    /// Returns true for a question, with a spring as the answer.
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

/// Generation and preview awaited by the explorer; older runs stop.
#[derive(Debug, Default)]
pub struct Awaited {
    generation: AtomicU64,
    preview: Mutex<Option<Arc<Scene>>>,
}

impl Awaited {
    /// Sets the awaited generation.
    pub fn set_generation(&self, generation: u64) {
        self.generation.store(generation, Ordering::Relaxed);
    }

    /// Returns true if another generation than this one is awaited.
    #[must_use]
    pub fn is_newer_than(&self, generation: u64) -> bool {
        self.generation.load(Ordering::Relaxed) != generation
    }

    /// Sets the awaited preview, or none.
    pub fn set_preview(&self, scene: Option<Arc<Scene>>) {
        *self.preview.lock().unwrap_or_else(PoisonError::into_inner) = scene;
    }

    /// Marks a request as awaited: a scene makes all older ones and every preview stale at once, a preview all earlier
    /// previews.
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

    /// Returns true if this very preview is awaited.
    #[must_use]
    pub fn is_preview(&self, scene: &Arc<Scene>) -> bool {
        let preview = self.preview.lock().unwrap_or_else(PoisonError::into_inner);
        preview.as_ref().is_some_and(|awaited| Arc::ptr_eq(awaited, scene))
    }
}

/// Shared by explorer and worker.
pub type Newest = Arc<Awaited>;
