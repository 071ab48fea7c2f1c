//! Scenes that the tests explore.

use asperity::scene::{Document, open};

/// A smooth sphere with adhesion: no roughness, no random line.
pub const SMOOTH: &str = "jkr-sphere";

/// A built-in scene.
pub fn built_in(name: &str) -> Document {
    open(name).unwrap_or_else(|errors| panic!("{errors}"))
}

/// A built-in scene with fields changed, all at once.
pub fn changed(name: &str, fields: &[(&str, &str)]) -> Document {
    let fields: Vec<_> = fields.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
    built_in(name).set_all(&fields).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The scene the explorer opens on, on fewer springs.
pub fn small() -> Document {
    changed("pressure-sensitive", &[("numerics.points", "1024"), ("numerics.samples", "64")])
}

/// A rough sphere under adhesion, its fragments observed.
pub fn sphere() -> Document {
    changed("rough-sphere", &[("numerics.points", "2048"), ("numerics.samples", "64")])
}

/// A rough line that nothing attracts.
pub fn without_adhesion() -> Document {
    changed("pressure-sensitive", &[("adhesion", "None"), ("numerics.points", "1024")])
}

/// A flat punch with adhesion: only the springs under it take part.
pub fn punch() -> Document {
    changed("kendall-punch", &[("numerics.points", "1024")])
}

/// A line of one spring.
pub fn one_spring() -> Document {
    let one = [("roughness", "None"), ("adhesion", "(work: 0.05)"), ("numerics.points", "1")];
    changed("pressure-sensitive", &one)
}
