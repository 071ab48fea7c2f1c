//! Values in RON of the fields that a scene file leaves out. The table of fields shows these
//! defaults, and the types of a scene use them.

use super::text::read_ron;
use serde::de::DeserializeOwned;

/// Default, in RON, of the field `roughness.seed` of a measured surface.
pub(super) const MEASURED_SEED: &str = "1";
/// Default, in RON, of the field `loading`.
pub(super) const LOADING: &str = "[ToZeroForce, ToSeparation]";
/// Default, in RON, of the field `numerics.points`, the number of springs.
pub(super) const POINTS: &str = "16384";
/// Default, in RON, of the field `numerics.solver`.
pub(super) const SOLVER: &str = "Exact";
/// Default, in RON, of the field `numerics.edges` if the scene has the exact solver.
pub(super) const EDGES: &str = "SubCell";
/// Default, in RON, of the field `numerics.samples`, the number of points of the force curve on
/// each loading stage.
pub(super) const SAMPLES: &str = "512";

/// Converts the RON text of a default to a value of its type.
pub(super) fn read_default<T: DeserializeOwned>(default: &str) -> T {
    read_ron(default).expect("a default of this type")
}
