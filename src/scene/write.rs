//! Writing a scene as RON: every field that differs from its default, in the order of the table.

use super::field::Field;
use super::fields::fields_inside;
use super::model::{Leg, Observer, Scene};
use super::value::Value;
use crate::text::is_control;

/// The scene as canonical RON text, ending in a line break; reading the text gives the same scene.
pub fn to_ron(scene: &Scene) -> String {
    let lines: String = entries("", None, scene).map(|entry| format!("    {entry},\n")).collect();
    format!("(\n{lines})\n")
}

impl Field {
    /// Value in a scene as RON, `None` for an optional field that is left out. Nothing where the field belongs to a
    /// choice that the scene does not make.
    pub fn written(&self, scene: &Scene) -> Option<String> {
        Some(match self.get(scene)? {
            Value::None => "None".to_string(),
            Value::Real(value) => ron_float(value),
            Value::Whole(value) => value.to_string(),
            Value::Band(first, last) => format!("({first}, {last})"),
            Value::Text(text) => ron_string(text),
            Value::Legs(stages) => legs(stages),
            Value::Observers(observed) => observers(observed),
            Value::Choice(variant) => match fields_inside(self.path, Some(variant)).next() {
                Some(_) => {
                    let entries: Vec<String> = entries(self.path, Some(variant), scene).collect();
                    format!("{variant}({})", entries.join(", "))
                }
                None => variant.to_string(),
            },
        })
    }
}

/// The fields inside a group that differ from their defaults, as `name: value`.
fn entries(path: &str, variant: Option<&str>, scene: &Scene) -> impl Iterator<Item = String> {
    fields_inside(path, variant).filter_map(|field| {
        let value = field.written(scene).filter(|value| value != field.default_in(scene))?;
        Some(format!("{}: {value}", field.last()))
    })
}

/// Loading stages as RON.
pub(super) fn legs(legs: &[Leg]) -> String {
    list(legs.iter().map(leg))
}

/// Observed quantities as RON.
pub(super) fn observers(observers: &[Observer]) -> String {
    list(observers.iter().map(|observer| format!("{observer:?}")))
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// One loading stage as RON.
pub(super) fn leg(leg: &Leg) -> String {
    match (leg.target(), leg) {
        (Some((field, value)), _) => format!("{}({})", field.variant.unwrap_or_default(), ron_float(value)),
        (None, leg) => format!("{leg:?}"),
    }
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::check::check;
    use super::super::document::Document;
    use super::super::model::Numerics;
    use super::super::strategies::{sound, sound_scenes};
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
