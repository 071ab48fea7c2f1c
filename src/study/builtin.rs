//! Built-in plans.

use crate::scene::{Preset, built_in};

const PLANS: &[Preset] = built_in!("plans/":
    "figure-5a",
    "figure-5b",
    "figure-6",
    "equation-15",
    "elastic-energy",
    "stiffness-exponent",
    "self-averaging"
);

/// All built-in plans.
pub fn plans() -> &'static [Preset] {
    PLANS
}

/// Built-in plan of this name.
pub fn find(name: &str) -> Option<&'static Preset> {
    PLANS.iter().find(|plan| plan.name == name)
}
