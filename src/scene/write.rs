//! Writing of a scene in RON: every field that differs from its default, in the order of the table.

use super::field::Field;
use super::fields::fields_inside;
use super::model::{Move, Observer, Scene};
use super::text::{ron_float, ron_string};
use super::value::Value;

/// The scene as canonical RON text, ending in a line break; parsing the text returns the same scene.
pub fn to_ron(scene: &Scene) -> String {
    let lines: String = entries("", None, scene).map(|entry| format!("    {entry},\n")).collect();
    format!("(\n{lines})\n")
}

impl Field {
    /// Value in a scene as RON, the text `None` for an omitted optional field. No value if the field belongs to an
    /// unselected choice.
    pub fn written(&self, scene: &Scene) -> Option<String> {
        Some(match self.get(scene)? {
            Value::None => "None".to_string(),
            Value::Real(value) => ron_float(value),
            Value::Whole(value) => value.to_string(),
            Value::Band(first, last) => format!("({first}, {last})"),
            Value::Text(text) => ron_string(text),
            Value::Texts(texts) => list(texts.iter().map(|text| ron_string(text))),
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

/// Loading stages in RON.
pub(super) fn legs(legs: &[Move]) -> String {
    list(legs.iter().map(leg))
}

/// Observed quantities in RON.
pub(super) fn observers(observers: &[Observer]) -> String {
    list(observers.iter().map(|observer| format!("{observer:?}")))
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// One loading stage in RON.
pub(super) fn leg(leg: &Move) -> String {
    match (leg.field(), leg) {
        (Some((field, value)), _) => format!("{}({})", field.variant.unwrap_or_default(), ron_float(value)),
        (None, leg) => format!("{leg:?}"),
    }
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

    proptest! {
        #[test]
        fn what_is_written_reads_back_the_same(scene in sound_scenes()) {
            prop_assert_eq!(check(&scene), vec![]);
            let text = to_ron(&scene);
            let document = Document::parse(&text, "scene").map_err(|errors| TestCaseError::fail(format!("{errors}\n{text}")))?;
            prop_assert_eq!(document.scene(), &scene);
            prop_assert_eq!(to_ron(document.scene()), text);
        }
    }
}
