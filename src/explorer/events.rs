//! The events of the shown loading, as the solver has listed them.

use super::manual_path::ManualPath;
use asperity_contact::Events;
use std::sync::Arc;

/// Smallest energy of a listed jump, as a share of the largest energy of all jumps.
pub const LEAST_SHARE: f64 = 0.01;
/// Largest number of listed jumps.
pub const MOST_LISTED: usize = 4096;

/// Events of the loading of a scene or of a path of manual loading.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedEvents {
    pub generation: u64,
    /// Path of manual loading; `None` for the loading of the scene.
    pub path: Option<Arc<ManualPath>>,
    /// The events. If the jumps cannot be listed, the error is the reason, on one line.
    pub events: Result<Events, String>,
}
