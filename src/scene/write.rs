//! Writing a scene as RON: every field that differs from its default, in the order of the table.

use super::model::{Adhesion, Form, Leg, Material, Numerics, Observer, Roughness, Scene, Solver};
use crate::text::is_control;

/// The scene as canonical RON text, ending in a line break; reading it gives the same scene.
pub fn to_ron(scene: &Scene) -> String {
    let mut lines = Vec::new();
    let mut line = |name: &str, value: String| lines.push(format!("    {name}: {value},\n"));
    line("version", scene.version.to_string());
    if !scene.title.is_empty() {
        line("title", ron_string(&scene.title));
    }
    if !scene.notice.is_empty() {
        line("notice", ron_string(&scene.notice));
    }
    line("material", material(&scene.material));
    line("length", ron_float(scene.length));
    if let Some(part) = &scene.form {
        line("form", form(part));
    }
    if let Some(part) = &scene.roughness {
        line("roughness", roughness(part));
    }
    if let Some(part) = &scene.adhesion {
        line("adhesion", adhesion(part));
    }
    if scene.loading != super::model::default_loading() {
        line("loading", legs(&scene.loading));
    }
    if scene.numerics != Numerics::default() {
        line("numerics", numerics(&scene.numerics));
    }
    if !scene.observe.is_empty() {
        line("observe", observers(&scene.observe));
    }
    format!("(\n{})\n", lines.concat())
}

/// A number as RON: the shortest text that reads back as the same number, always with a decimal
/// point, with an exponent where it is much smaller or larger than one.
pub fn ron_float(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() || size == 0.0 || (size > 1e-3 && size < 1e5) {
        return format!("{value:?}");
    }
    let text = format!("{value:e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0e{exponent}"),
        _ => text,
    }
}

/// Text as a RON string; only what RON cannot carry in the open is escaped.
pub fn ron_string(text: &str) -> String {
    let mut string = String::with_capacity(text.len() + 2);
    string.push('"');
    for c in text.chars() {
        match c {
            '"' => string.push_str("\\\""),
            '\\' => string.push_str("\\\\"),
            '\n' => string.push_str("\\n"),
            '\r' => string.push_str("\\r"),
            '\t' => string.push_str("\\t"),
            c if is_control(c) => string.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
            c => string.push(c),
        }
    }
    string.push('"');
    string
}

/// A loading history.
pub(super) fn legs(legs: &[Leg]) -> String {
    list(legs.iter().map(leg))
}

/// What is observed.
pub(super) fn observers(observers: &[Observer]) -> String {
    list(observers.iter().map(|observer| format!("{observer:?}")))
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// `(name: value, …)` of the fields that are there.
fn group(fields: &[(&str, Option<String>)]) -> String {
    let present = fields.iter().filter_map(|(name, value)| Some(format!("{name}: {}", value.as_ref()?)));
    format!("({})", present.collect::<Vec<_>>().join(", "))
}

fn material(part: &Material) -> String {
    group(&[
        ("youngs_modulus", part.youngs_modulus.map(ron_float)),
        ("poisson_ratio", part.poisson_ratio.map(ron_float)),
        ("effective_modulus", part.effective_modulus.map(ron_float)),
    ])
}

fn form(part: &Form) -> String {
    match *part {
        Form::Paraboloid { radius } => format!("Paraboloid(radius: {})", ron_float(radius)),
        Form::Cone { angle } => format!("Cone(angle: {})", ron_float(angle)),
        Form::Power { coefficient, exponent } => {
            format!("Power(coefficient: {}, exponent: {})", ron_float(coefficient), ron_float(exponent))
        }
        Form::Punch { radius } => format!("Punch(radius: {})", ron_float(radius)),
    }
}

fn roughness(part: &Roughness) -> String {
    match part {
        Roughness::SelfAffine { hurst, rms_height, rms_gradient, modes: (first, last), seed } => {
            let fields = group(&[
                ("hurst", Some(ron_float(*hurst))),
                ("rms_height", rms_height.map(ron_float)),
                ("rms_gradient", rms_gradient.map(ron_float)),
                ("modes", Some(format!("({first}, {last})"))),
                ("seed", Some(seed.to_string())),
            ]);
            format!("SelfAffine{fields}")
        }
        Roughness::Measured { file } => format!("Measured(file: {})", ron_string(file)),
    }
}

fn adhesion(part: &Adhesion) -> String {
    group(&[("work", part.work.map(ron_float)), ("kappa", part.kappa.map(ron_float))])
}

/// One leg.
pub(super) fn leg(leg: &Leg) -> String {
    match *leg {
        Leg::ToForce(force) => format!("ToForce({})", ron_float(force)),
        Leg::ToIndentation(indentation) => format!("ToIndentation({})", ron_float(indentation)),
        Leg::ToTouch => "ToTouch".into(),
        Leg::ToZeroForce => "ToZeroForce".into(),
        Leg::ToSeparation => "ToSeparation".into(),
    }
}

fn numerics(part: &Numerics) -> String {
    let default = Numerics::default();
    let solver = match part.solver {
        Solver::Exact => "Exact".to_string(),
        Solver::Stepwise { step } => format!("Stepwise(step: {})", ron_float(step)),
    };
    group(&[
        ("points", (part.points != default.points).then(|| part.points.to_string())),
        ("solver", (part.solver != default.solver).then_some(solver)),
        ("edges", (part.edges != part.solver.usual_edges()).then(|| format!("{:?}", part.edges))),
        ("samples", (part.samples != default.samples).then(|| part.samples.to_string())),
    ])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::check::check;
    use super::super::document::Document;
    use super::super::samples::{sound, sound_scenes};
    use super::*;

    #[test]
    fn only_what_differs_from_the_defaults_is_written() {
        let mut scene = sound();
        scene.numerics = Numerics::default();
        scene.roughness = None;
        scene.loading = super::super::model::default_loading();
        assert_eq!(
            to_ron(&scene),
            r#"(
    version: 1,
    title: "A line",
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    adhesion: (work: 0.05),
)
"#
        );
        scene.numerics.points = 64;
        assert!(to_ron(&scene).contains("    numerics: (points: 64),\n"));
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (2e6, "2.0e6"),
            (1e-4, "1.0e-4"),
            (2.5e-7, "2.5e-7"),
            (0.5, "0.5"),
            (-40.0, "-40.0"),
            (0.001, "1.0e-3"),
            (0.005, "0.005"),
            (99_999.0, "99999.0"),
            (0.0, "0.0"),
            (-0.0, "-0.0"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(ron_float(value), text);
        }
    }

    #[test]
    fn strings_are_escaped_only_where_they_must_be() {
        assert_eq!(ron_string("κ \"a\" \\ \n\u{1b}"), r#""κ \"a\" \\ \n\u{1b}""#);
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back_the_same(scene in sound_scenes()) {
            prop_assert_eq!(check(&scene), vec![]);
            let text = to_ron(&scene);
            let document = Document::parse(&text, "scene").map_err(|errors| TestCaseError::fail(format!("{errors}\n{text}")))?;
            prop_assert_eq!(document.scene(), &scene);
            prop_assert_eq!(to_ron(document.scene()), text);
        }

        #[test]
        fn all_numbers_survive(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            let read: f64 = ron::from_str(&ron_float(value)).map_err(|error| TestCaseError::fail(error.to_string()))?;
            prop_assert!(read.to_bits() == bits || value.is_nan() && read.is_nan());
        }

        #[test]
        fn all_strings_survive(text in any::<String>()) {
            prop_assert_eq!(ron::from_str::<String>(&ron_string(&text)), Ok(text));
        }
    }

    #[test]
    fn numbers_from_a_hundred_thousand_and_from_a_thousandth_have_an_exponent() {
        for (value, text) in [
            (1e5, "1.0e5"),
            (-99_999.5, "-99999.5"),
            (1e-3, "1.0e-3"),
            (0.0011, "0.0011"),
            (-0.0, "-0.0"),
            (1.25e-7, "1.25e-7"),
        ] {
            assert_eq!(ron_float(value), text);
        }
    }
}
