//! Built-in scenes.

/// Name of the default scene.
pub const DEFAULT: &str = "pressure-sensitive";

/// A built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name of the scene on the command line.
    pub name: &'static str,
    /// Text in RON.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal),* $(,)?) => {
        &[$(Preset {
            name: $name,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/presets/", $name, ".ron")),
        }),*]
    };
}

const PRESETS: &[Preset] = presets![
    "ideal-adhesion",
    "pressure-sensitive",
    "non-adhesive",
    "profile-hurst-025",
    "profile-hurst-075",
    "fragment-closeup",
    "jkr-sphere",
    "kendall-punch",
    "rough-sphere",
    "million-springs",
    "two-works",
    "wavy-sphere",
    "elastic-energy-below",
    "elastic-energy-above",
];

/// All built-in scenes, in the recommended order.
pub fn presets() -> &'static [Preset] {
    PRESETS
}

/// Built-in scene of this name.
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
