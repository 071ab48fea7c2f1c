//! Small scenes for the tests, in place of the presets of the program, which may change.

use asperity::scene::Document;

/// A rough line under weak adhesion, pressed until several patches touch, then pulled off.
const ROUGH: &str = r#"(
    version: 1,
    title: "Rough line",
    notice: "Several patches.",
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5), // soft
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (8, 256), seed: 1),
    adhesion: (kappa: 8.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 1024, samples: 64),
)
"#;

/// A scene with fields changed, all at once.
pub fn changed(document: &Document, fields: &[(&str, &str)]) -> Document {
    let fields: Vec<_> = fields
        .iter()
        .map(|(path, value)| (path.to_string(), value.to_string()))
        .collect();
    document
        .set_all(&fields)
        .unwrap_or_else(|errors| panic!("{errors}"))
}

/// A scene as read from a file of that name.
fn as_file(document: &Document, name: &str) -> Document {
    Document::parse(document.text(), name).unwrap_or_else(|errors| panic!("{errors}"))
}

fn based_on_rough(name: &str, fields: &[(&str, &str)]) -> Document {
    let title = format!("\"{name}\"");
    as_file(
        &changed(&rough(), fields).set("title", &title).unwrap(),
        name,
    )
}

/// A rough line under weak adhesion, with several patches.
pub fn rough() -> Document {
    Document::parse(ROUGH, "rough-line").unwrap_or_else(|errors| panic!("{errors}"))
}

/// A smooth sphere with adhesion: no random line.
pub fn smooth() -> Document {
    let fields = [
        ("roughness", "None"),
        ("form", "Paraboloid(radius: 1.0e-4)"),
        ("adhesion", "(work: 0.05)"),
        ("loading", "[ToForce(1.0e-4), ToSeparation]"),
    ];
    based_on_rough("smooth-sphere", &fields)
}

/// A rough line whose springs relax while the instrument rests.
pub fn relaxing() -> Document {
    let fields = [
        (
            "material",
            "(modulus: 2.0e6, relaxation: (share: 0.4, time: 1.0))",
        ),
        ("loading_speed", "1.0e-6"),
        ("loading", "[ToForce(2.0e-5), Hold(2.0), ToSeparation]"),
    ];
    based_on_rough("relaxing", &fields)
}

/// A rough line without adhesion.
pub fn without_adhesion() -> Document {
    based_on_rough("without-adhesion", &[("adhesion", "None")])
}

/// A flat punch with adhesion: only the springs under it take part.
pub fn punch() -> Document {
    let fields = [
        ("roughness", "None"),
        ("form", "Punch(radius: 2.0e-5)"),
        ("adhesion", "(work: 0.05)"),
        ("loading", "[ToForce(1.0e-4), ToSeparation]"),
    ];
    based_on_rough("punch", &fields)
}

/// A line of one spring.
pub fn one_spring() -> Document {
    let fields = [
        ("roughness", "None"),
        ("adhesion", "(work: 0.05)"),
        ("numerics.points", "1"),
    ];
    based_on_rough("one-spring", &fields)
}
