//! Built-in plans.

/// A built-in plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltInPlan {
    /// Name of the plan on the command line.
    pub name: &'static str,
    /// Text in RON.
    pub text: &'static str,
}

macro_rules! plans {
    ($($name:literal),* $(,)?) => {
        &[$(BuiltInPlan {
            name: $name,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/presets/plans/", $name, ".ron")),
        }),*]
    };
}

const PLANS: &[BuiltInPlan] = plans![
    "figure-5a",
    "figure-5b",
    "figure-6",
    "equation-15",
    "elastic-energy",
    "stiffness-exponent",
    "self-averaging"
];

/// All built-in plans.
pub fn plans() -> &'static [BuiltInPlan] {
    PLANS
}

/// Built-in plan of this name.
pub fn find(name: &str) -> Option<&'static BuiltInPlan> {
    PLANS.iter().find(|plan| plan.name == name)
}
