//! The text of a scene.

use super::{assert_document, assert_errors, assert_place, text};
use asperity::scene::fields::Effect;
use asperity::scene::text::LONGEST_TEXT;
use asperity::scene::workload::Workload;
use asperity::scene::{Document, Origin};

const NAME: &str = "fuzzed.ron";

/// An accepted scene is written and read back the same; a refusal has its place in the text.
pub fn scene(bytes: &[u8]) {
    let whole = text(bytes);
    let text = whole.strip_prefix('\u{feff}').unwrap_or(&whole);
    match Document::parse(&whole, NAME) {
        Err(errors) => assert_errors(&errors, |origin| match origin {
            Origin::File {
                name,
                place: Some((line, column)),
            } => {
                assert_eq!(name, NAME);
                assert_place(text, *line, *column);
            }
            Origin::File { name, place: None } => {
                assert_eq!(name, NAME);
                assert!(
                    text.len() > LONGEST_TEXT,
                    "an error in a text has a place: {errors}"
                );
            }
            other => panic!("an error in a text has a place, not {other:?}: {errors}"),
        }),
        Ok(document) => {
            assert_eq!(document.text(), text);
            assert!(!document.is_changed() && document.overrides().is_empty());
            assert_document(&document);
            assert_fields(&document);
            assert_effects(&document);
            let _ = Workload::of(document.scene());
        }
    }
}

/// Setting a field to its own value changes nothing; one step stays inside the range.
fn assert_fields(document: &Document) {
    for field in document.fields() {
        let Some(value) = document.value(field.path) else {
            continue;
        };
        let same = document
            .set(field.path, value)
            .unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(same.scene(), document.scene(), "{} = {value}", field.path);
        assert_eq!(
            field.read_typed(value).as_deref(),
            Ok(value),
            "{}",
            field.path
        );
        for (steps, coarse) in [(1, false), (-1, false), (1, true), (-1, true)] {
            let Some(next) = field.stepped(value, steps, coarse) else {
                continue;
            };
            assert_ne!(next, value, "{}", field.path);
            if let Ok(next) = next.parse()
                && field.range.ends().is_some()
            {
                let inside = field.range.contains(next) || field.range.contains_whole(next as u64);
                assert!(inside, "{} = {value} steps to {next}", field.path);
            }
        }
    }
}

/// An effect that is switched off is off, and comes back.
fn assert_effects(document: &Document) {
    let sound = |changed: &Result<Document, _>, effect: Effect, on: bool| match changed {
        Ok(changed) => {
            assert_document(changed);
            assert_eq!(effect.is_on(changed.scene()), on, "{}", effect.name());
        }
        Err(errors) => {
            let of_document =
                |origin: &Origin| assert!(!matches!(origin, Origin::File { place: Some(_), .. }));
            assert_errors(errors, of_document);
        }
    };
    for effect in Effect::ALL {
        let off = document.without(effect);
        sound(&off, effect, false);
        let Ok(off) = off else { continue };
        for also in Effect::ALL.into_iter().filter(|also| *also != effect) {
            assert_eq!(
                also.is_on(off.scene()),
                also.is_on(document.scene()),
                "{}",
                also.name()
            );
        }
        let forgotten = Document::parse(off.text(), NAME).and_then(|off| off.with(effect));
        sound(&forgotten, effect, true);
        let back = off.with(effect);
        sound(&back, effect, true);
        if let (true, Ok(back)) = (effect.is_on(document.scene()), back) {
            assert_eq!(back.scene(), document.scene(), "{}", effect.name());
        }
    }
}
