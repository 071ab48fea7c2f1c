//! Values in RON of the fields that a scene file leaves out. The table of fields shows these
//! defaults, and the types of a scene use them.

use super::text::read_ron;
use serde::de::DeserializeOwned;

/// Default of `roughness.seed` of a measured surface.
pub(super) const MEASURED_SEED: &str = "1";
/// Default of `loading`.
pub(super) const LOADING: &str = "[ToZeroForce, ToSeparation]";
/// Default of `numerics.points`.
pub(super) const POINTS: &str = "16384";
/// Default of `numerics.solver`.
pub(super) const SOLVER: &str = "Exact";
/// Default of `numerics.edges` with the exact solver.
pub(super) const EDGES: &str = "SubCell";
/// Default of `numerics.samples`.
pub(super) const SAMPLES: &str = "512";

/// Converts the RON text of a default to a value of its type.
pub(super) fn read_default<T: DeserializeOwned>(default: &str) -> T {
    read_ron(default).expect("a default of this type")
}
