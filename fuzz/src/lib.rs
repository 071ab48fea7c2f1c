//! Properties of everything that is read: each panics if violated.
//!
//! The targets of cargo-fuzz call them with generated inputs; `tests/fuzz/main.rs` includes this
//! file and calls them with the seeds, with the findings, and with mutations of both.

mod curve;
mod overrides;
mod profile;
mod quantity;
mod scene;
mod surface;

pub use curve::curve;
pub use overrides::overrides;
pub use profile::profile;
pub use quantity::quantity;
pub use scene::scene;
pub use surface::surface;

use asperity::scene::fields::FIELDS;
use asperity::scene::text::to_ron;
use asperity::scene::{Document, Origin, Scene, SceneError, SceneErrors};
use std::borrow::Cow;

/// A property of any bytes.
pub type Property = fn(&[u8]);

/// All targets, with the names of their files in `fuzz_targets` and of their folders of seeds and
/// corpus.
pub const TARGETS: &[(&str, Property)] = &[
    ("scene", scene),
    ("overrides", overrides),
    ("quantity", quantity),
    ("profile", profile),
    ("surface", surface),
    ("curve", curve),
];

/// Longest line of a message, in characters: names, values and the words of the field, none of them
/// endless.
const LONGEST_MESSAGE: usize = 2000;

/// Reading a file refuses invalid UTF-8; here it must not waste an input.
fn text(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// A message is one line with text and without characters that move the cursor of a terminal.
fn assert_message(message: &str) {
    assert!(
        message.chars().any(char::is_alphabetic),
        "a message without words: {message:?}"
    );
    assert!(
        !message.contains(char::is_control),
        "a message with control characters: {message:?}"
    );
    let length = message.chars().count();
    assert!(
        length <= LONGEST_MESSAGE,
        "a message of {length} characters: {message:?}"
    );
}

/// Each error names its cause, its place, and either the allowed values or the reason of refusal;
/// `assert_origin` judges the place.
fn assert_errors(errors: &SceneErrors, assert_origin: impl Fn(&Origin)) {
    let count = errors.iter().count();
    assert!(count <= 1000, "{count} errors");
    let lines = errors.to_string().lines().count();
    assert_eq!(lines, count, "an error is one line: {errors}");
    for error in errors.iter() {
        let SceneError {
            origin,
            allowed,
            message,
            ..
        } = error;
        assert!(!(allowed.is_empty() && message.is_empty()), "{error:?}");
        assert_message(&error.to_string());
        assert_message(&error.what());
        let counted = *origin == Origin::Scene && message.starts_with("and ");
        if !counted {
            assert_origin(origin);
        }
    }
}

/// A place is in the text, or directly after its last character.
fn assert_place(text: &str, line: usize, column: usize) {
    let line_text = line
        .checked_sub(1)
        .and_then(|index| text.split('\n').nth(index));
    let Some(line_text) = line_text else {
        panic!("line {line} is not in {text:?}")
    };
    assert!(
        (1..=line_text.chars().count() + 1).contains(&column),
        "{line}:{column} is not in {text:?}"
    );
}

/// A number that is set to its own value leaves the scene as it was.
fn assert_numbers(scene: &Scene) {
    for field in FIELDS {
        for end in ["", ".0", ".1"] {
            let path = format!("{}{end}", field.path);
            if let Some(number) = scene.number(&path) {
                let mut same = scene.clone();
                assert_eq!(same.set_number(&path, number), Ok(()), "{path}");
                // A seed has more digits than a floating-point number keeps.
                if number < 9.0e15 {
                    assert_eq!(&same, scene, "{path}");
                }
            }
        }
    }
}

/// Asserts the properties of every document.
fn assert_document(document: &Document) {
    let scene = document.scene();
    assert_eq!(
        Scene::clone(scene).checked().as_ref(),
        Ok(scene),
        "{}",
        document.text()
    );
    let read = |text: &str| {
        Document::parse(text, "again").unwrap_or_else(|errors| panic!("{errors}\n{text}"))
    };
    assert_eq!(
        read(document.text()).scene(),
        scene,
        "the text is that of the scene"
    );
    assert_numbers(scene);
    // Written in canonical form the scene is the same, and remains so.
    let written = to_ron(scene);
    assert_eq!(read(&written).scene(), scene, "{written}");
    assert_eq!(to_ron(read(&written).scene()), written);
}
