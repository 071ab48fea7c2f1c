//! The number of random profiles over which the explorer takes medians and quartiles. It belongs to
//! the explorer and not to the scene, so a scene file does not contain it.

use asperity_scene::Scene;
use asperity_scene::fields::{Field, Range, Step};
use asperity_study::Ensemble;
use std::ops::RangeInclusive;

/// Numbers of profiles that the user may choose. More profiles would keep the user waiting;
/// `asperity run --profiles` computes them.
pub const ALLOWED: RangeInclusive<u64> = 1..=256;

/// Path of the row in the list of parameters.
pub const PATH: &str = "numerics.profiles";

/// The row in the list of parameters.
pub static FIELD: Field = Field::beside(
    PATH,
    "profiles",
    Range::Whole(*ALLOWED.start(), *ALLOWED.end()),
    "random profiles of medians, quartiles and answers, from the seed of the scene on; i and Y have \
     16. Of the explorer, not of the scene file (--profiles)",
)
.step(Step::Doubling)
.words("number of profiles realisations realizations ensemble sample statistics median seeds");

/// Returns the number of random profiles that are computed for a scene if the user wants this
/// number: 1 if the profile of the scene is fixed.
pub fn count(wanted: u64, scene: &Scene) -> u64 {
    if Ensemble::profiles_of(scene) == 1 {
        1
    } else {
        wanted
    }
}

/// Returns the option of the command line for a number of profiles, with a blank before it; empty
/// for the usual number.
pub fn argument(wanted: u64, scene: &Scene) -> String {
    if count(wanted, scene) == Ensemble::profiles_of(scene) {
        String::new()
    } else {
        format!(" --profiles={wanted}")
    }
}
