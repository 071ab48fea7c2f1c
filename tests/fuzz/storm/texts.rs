//! Texts of scenes and overrides, with the properties of the fuzz targets.

use super::properties::{overrides, scene};
use super::*;

/// Texts of scenes.
const SCENES: u32 = 500;
/// Scenes with overrides.
const OVERRIDES: u32 = 1250;
/// Overrides of one scene.
const MOST_OVERRIDES: usize = 3;

#[test]
fn texts_without_mistakes() {
    proptest!(draws(SCENES), |(text in Drawn::default().scene_texts())| scene(text.as_bytes()));
}

#[test]
fn texts_with_mistakes() {
    proptest!(draws(SCENES), |(text in Drawn::default().with_mistakes().scene_texts())| scene(text.as_bytes()));
}

#[test]
fn overrides_of_presets() {
    let names: Vec<&str> = asperity::scene::presets().iter().map(|preset| preset.name).collect();
    let name = prop::sample::select(names);
    let drawn =
        [Drawn::default(), Drawn::default().with_mistakes()].map(|drawn| drawn.overrides(MOST_OVERRIDES));
    let drawn = proptest::strategy::Union::new(drawn);
    proptest!(draws(OVERRIDES), |(name in name, set in drawn)| {
        let lines: String = set.iter().map(|(path, value)| format!("\n{path}={value}")).collect();
        overrides(format!("{name}{lines}").as_bytes());
    });
}

/// A storm of only refused texts, or of only a few kinds of scenes, would prove little.
#[test]
fn all_fields_are_drawn_and_many_texts_are_allowed() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let mut drawn = |texts: &BoxedStrategy<String>| -> Vec<String> {
        (0..600).map(|_| texts.new_tree(&mut runner).unwrap().current()).collect()
    };
    let sound = drawn(&Drawn::default().scene_texts());
    for field in FIELDS {
        let entry = format!("{}: ", field.last());
        assert!(sound.iter().any(|text| text.contains(&entry)), "{} is not drawn", field.path);
        if let Range::Choice(of) | Range::List { of, .. } = field.range {
            for choice in of {
                let start = choice.find([':', '(']).map_or(*choice, |end| &choice[..end.max(1)]);
                assert!(sound.iter().any(|text| text.contains(start)), "{choice} is not drawn");
            }
        }
    }
    let allowed =
        |texts: &[String]| texts.iter().filter(|text| Document::parse(text, "drawn").is_ok()).count();
    let (many, few) = (allowed(&sound), allowed(&drawn(&Drawn::default().with_mistakes().scene_texts())));
    assert!(many >= 30 && few < many, "{many} and {few} of 600 are allowed");
}
