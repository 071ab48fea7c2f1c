//! The number of random profiles over which the explorer takes medians and quartiles. It belongs to
//! the explorer and not to the scene, so a scene file does not contain it.

use super::editor::Editor;
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
    "random profiles of medians, quartiles and answers, from the seed of the scene on; of the \
     explorer, not of the scene file (--profiles)",
)
.step(Step::Doubling)
.words("number of profiles realisations realizations ensemble sample statistics median seeds");

/// Returns the number of random profiles that are computed for the present scene: 1 if its profile
/// is fixed, otherwise the number that the user has chosen.
pub fn count(edit: &Editor) -> u64 {
    edit.profiles.min(most(edit))
}

fn most(edit: &Editor) -> u64 {
    if Ensemble::profiles_of(&edit.scene) == 1 {
        1
    } else {
        *ALLOWED.end()
    }
}

/// Returns the option of the command line for the number of profiles, with a blank before it; empty
/// for the usual number.
pub fn argument(edit: &Editor) -> String {
    if count(edit) == Ensemble::profiles_of(&edit.scene) {
        String::new()
    } else {
        format!(" --profiles={}", edit.profiles)
    }
}
