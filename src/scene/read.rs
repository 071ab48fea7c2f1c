//! Reader of the text of a scene, with errors in the terms of the scene.

use ron::extensions::Extensions;

use super::edit::known_field;
use super::errors::{Origin, SceneError};
use super::field::Field;
use super::model::{SCENE_VERSIONS, Scene};
use super::range::Range;
use super::suggest::nearest;
use super::text::{Text, offset_of};

/// Longest value that is repeated in messages.
const MOST_REPEATED: usize = 60;

/// Message for text that does not begin as a scene, such as the table of an instrument.
const NO_SCENE: &str = "a scene in ( ) is expected here; a measured surface is read by `asperity surface FILE`, and \
                        is the roughness of a scene by --set roughness=FILE";

/// Reason why text is no scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unread {
    /// Byte offset in the text.
    pub(super) offset: usize,
    /// The error, still without an origin.
    pub(super) error: SceneError,
}

/// Reads a scene; its values are not checked.
pub(super) fn read(text: &str) -> Result<Scene, Box<Unread>> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| Box::new(explain(text, &error)))
}

/// Error of the version in a text, even if the rest of the text cannot be read.
pub(super) fn wrong_version(text: &str) -> Option<Unread> {
    let outline = Text::new(text).ok()?;
    let opening = outline.opening("")?;
    let (offset, value, message) = match outline.span("version") {
        Some(span) => {
            let value = text[span.value.clone()].to_string();
            if value.parse().is_ok_and(|version| SCENE_VERSIONS.contains(&version)) {
                return None;
            }
            (span.value.start, value, "version of the scene file")
        }
        None => (opening, String::new(), "version of the scene file, which is missing"),
    };
    let allowed = format!("{} or {}", SCENE_VERSIONS.start(), SCENE_VERSIONS.end());
    let error = SceneError::whole(Origin::Scene, message);
    Some(Unread { offset, error: SceneError { field: "version".into(), value, allowed, ..error } })
}

/// Place and reason of the error in text with the form of a scene.
pub(crate) fn describe_error(text: &str, error: &ron::error::SpannedError) -> (usize, String) {
    let message = match &error.code {
        ron::Error::NoSuchEnumVariant { expected, found, .. } => {
            let near = nearest(found, expected.iter().copied());
            let near = near.map_or_else(String::new, |near| format!(" (did you mean {near}?)"));
            format!("{found}: allowed: {}{near}", expected.join(", "))
        }
        ron::Error::MissingStructField { field, .. } => format!("{field}: missing"),
        ron::Error::NoSuchStructField { found, .. } => format!("{found}: {}", plain(&error.code)),
        ron::Error::DuplicateStructField { field, .. } => format!("{field}: given twice"),
        ron::Error::TrailingCharacters => "nothing may follow here".into(),
        code => plain(code),
    };
    (place_of(text, error).0, message)
}

/// First byte of the error, and the position of the reader.
fn place_of(text: &str, error: &ron::error::SpannedError) -> (usize, usize) {
    let start = offset_of(text, error.span.start.line, error.span.start.col);
    let end = offset_of(text, error.span.end.line, error.span.end.col).max(start);
    // The span starts before the last token read; if that was only blank or punctuation, the error comes after it.
    let something = |c: char| c.is_alphanumeric() || matches!(c, '"' | '\'' | '_' | '-');
    (if text[start..end].contains(something) { start } else { end }, end)
}

fn explain(text: &str, error: &ron::error::SpannedError) -> Unread {
    let (offset, end) = place_of(text, error);
    let whole = |offset, message: String| Unread { offset, error: SceneError::whole(Origin::Scene, message) };
    if !text.trim().is_empty() && !text[..end].contains('(') {
        return whole(text.len() - text.trim_start().len(), NO_SCENE.into());
    }
    match Text::new(text) {
        Ok(outline) => explain_at(text, &outline, offset, &error.code),
        // If the reader reached the end of the text, the open bracket is the better place.
        Err(unreadable) if end >= text.trim_end().len() || is_lost(&error.code) => {
            whole(unreadable.offset, unreadable.reason.into())
        }
        Err(_) => whole(offset, plain(&error.code)),
    }
}

fn is_lost(error: &ron::Error) -> bool {
    use ron::Error;

    matches!(error, Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment)
}

fn explain_at(text: &str, outline: &Text, offset: usize, error: &ron::Error) -> Unread {
    use ron::Error;

    let at = SceneError { field: outline.path_at(offset), ..SceneError::default() };
    let error = match error {
        Error::MissingStructField { field: name, .. } => {
            let field =
                if at.field.is_empty() { (*name).to_string() } else { format!("{}.{name}", at.field) };
            let allowed = known_field(outline, &field)
                .map_or_else(String::new, |field| format!("; allowed: {}", field.allowed()));
            SceneError { field, message: format!("missing{allowed}"), ..at }
        }
        Error::NoSuchStructField { .. } | Error::DuplicateStructField { .. } => {
            SceneError { message: plain(error), ..at }
        }
        Error::NoSuchEnumVariant { expected, found, .. } => {
            let near = nearest(found, expected.iter().copied());
            let message = near.map_or_else(String::new, |near| format!("did you mean {near}?"));
            SceneError { value: found.clone(), allowed: expected.join(", "), message, ..at }
        }
        error => return explain_value(text, outline, Unread { offset, error: at }, error),
    };
    Unread { offset, error }
}

/// A single value is marked as a whole and repeated, with its allowed values.
fn explain_value(text: &str, outline: &Text, at: Unread, error: &ron::Error) -> Unread {
    let field = &at.error.field;
    let scalar = outline
        .span(field)
        .map(|place| (place.value.start, &text[place.value]))
        .filter(|(_, value)| value.len() <= MOST_REPEATED && !value.contains(['(', '[', '{']));
    let Some((offset, value)) = scalar else {
        return Unread { error: SceneError { message: plain(error), ..at.error }, ..at };
    };
    let (allowed, message) = match known_field(outline, field) {
        // Without quotes the content of a text is not the error.
        Some(Field { range: Range::Text { .. }, .. }) | None => (String::new(), plain(error)),
        Some(field) => (field.allowed(), field.name.to_string()),
    };
    Unread { offset, error: SceneError { value: value.to_string(), allowed, message, ..at.error } }
}

/// Message of the reader in plain words.
fn plain(error: &ron::Error) -> String {
    use ron::Error;

    let text = match error {
        Error::Eof => "the text ends too early",
        Error::ExpectedFloat => "a number is expected here",
        Error::ExpectedInteger | Error::InvalidIntegerDigit { .. } => "a whole number is expected here",
        Error::IntegerOutOfBounds => "this whole number is too large or negative",
        Error::ExpectedString => "text in quotes is expected here",
        Error::ExpectedComma => "a comma is expected here",
        Error::ExpectedArray => "a list in [ ] is expected here",
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => "an opening ( is expected here",
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => "a closing ) is expected here",
        Error::ExpectedDifferentStructName { .. } => "a group of fields in ( ) is expected here",
        Error::DuplicateStructField { .. } => "given twice",
        Error::NoSuchStructField { expected, found, .. } => {
            let near = nearest(found, expected.iter().copied());
            let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
            return format!("no such field{near} (fields here: {})", expected.join(", "));
        }
        Error::ExpectedMapColon => "a colon is expected here",
        Error::ExceededRecursionLimit => "nested too deeply",
        Error::TrailingCharacters => "nothing may follow the scene",
        other => {
            let text = other.to_string();
            let mut characters = text.chars();
            let first = characters.next().map(char::to_lowercase);
            return first.into_iter().flatten().chain(characters).collect();
        }
    };
    text.to_string()
}

#[cfg(test)]
mod tests {
    use super::super::text::line_column;
    use super::*;

    fn unread(text: &str) -> ((usize, usize), String, String, String, String) {
        let Unread { offset, error } = *read(text).unwrap_err();
        let SceneError { field, value, allowed, message, .. } = error;
        (line_column(text, offset), field, value, allowed, message)
    }

    fn scene(line: &str) -> String {
        format!(
            "(\n    version: 1,\n    material: (effective_modulus: 1.0e6),\n    length: 1.0e-4,\n{line}\n)\n"
        )
    }

    #[test]
    fn errors_are_stated_in_the_terms_of_the_scene() {
        let rough = |fields: &str| scene(&format!("    roughness: SelfAffine({fields}),"));
        for (text, place, field, value, said) in [
            (scene("    lenght: 1,"), (5, 5), "lenght", "", "did you mean length?"),
            (scene("    title: \"a\",\n    title: \"b\","), (6, 5), "title", "", "given twice"),
            (
                scene("    form: Cube(radius: 1.0),"),
                (5, 11),
                "form",
                "Cube",
                "Cone, Power, WavySphere, Punch",
            ),
            (scene("    form: Cone(angel: 1.0),"), (5, 16), "form.angel", "", "did you mean angle?"),
            (
                scene("    loading: [ToTouch, ToFroce(1.0)],"),
                (5, 24),
                "loading.1",
                "ToFroce",
                "mean ToForce?",
            ),
            (
                scene("    loading: [ToForce(\"a\")],"),
                (5, 23),
                "loading.0.0",
                "\"a\"",
                "from -1e30 to 1e30 N",
            ),
            (scene("    numerics: (points: 1.5),"), (5, 24), "numerics.points", "1.5", "from 1 to 268435456"),
            (scene("    numerics: (points: -5),"), (5, 24), "numerics.points", "-5", "from 1 to 268435456"),
            (scene("    numerics: (points: 1e3),"), (5, 24), "numerics.points", "1e3", "from 1 to 268435456"),
            (scene("    title: Hello,"), (5, 12), "title", "Hello", "text in quotes"),
            (
                scene("    adhesion: 0.5,"),
                (5, 15),
                "adhesion",
                "0.5",
                "(work: 0.05), (kappa: 2.0) or (elastic_energy_ratio: 0.5)",
            ),
            (
                rough("hurst: 0.7, modes: (1, 2)"),
                (5, 52),
                "roughness.seed",
                "",
                "missing; allowed: a whole number",
            ),
            (rough("hurst: \"x\""), (5, 34), "roughness.hurst", "\"x\"", "above 0 and below 1"),
            (rough("hurst: 0.7 seed: 1"), (5, 38), "roughness", "", "a comma is expected"),
            ("(version: 1)".into(), (1, 12), "material", "", "missing"),
            ("(version: 1".into(), (1, 1), "", "", "not closed"),
            ("(version: 1, title: \"a)".into(), (1, 21), "", "", "not closed"),
            ("".into(), (1, 1), "", "", ""),
        ] {
            let (at, path, text_value, allowed, message) = unread(&text);
            let said_all = format!("{allowed} {message}");
            assert!(said_all.contains(said), "{text}: {said_all}");
            assert_eq!((at, path.as_str(), text_value.as_str()), (place, field, value), "{text}: {said_all}");
        }
    }

    #[test]
    fn nesting_is_bounded() {
        for text in
            ["(".repeat(100_000), "[".repeat(100_000), scene(&format!("form: {}", "Some(".repeat(100_000)))]
        {
            assert!(read(&text).is_err());
        }
        let deep = scene(&format!("form: {}None{}", "Some(".repeat(1000), ")".repeat(1000)));
        assert!(read(&deep).is_err());
    }

    #[test]
    fn the_version_is_stated_whatever_else_is_wrong() {
        assert_eq!(wrong_version("(version: 1, nonsense)"), None);
        assert_eq!(wrong_version("(version: 3, nonsense)").unwrap().error.value, "3");
        assert!(wrong_version("(length: 1)").unwrap().error.message.contains("missing"));
        assert_eq!(wrong_version("(version: 3, nonsense"), None);
    }

    /// Of two mistakes the first is reported, even if a bracket or quote after it is not closed.
    #[test]
    fn what_stops_the_reader_first_is_said() {
        let (at, .., message) = unread("(version: 1, nonsense: 2, title: \"a)");
        assert_eq!(at, (1, 14));
        assert!(message.starts_with("no such field"), "{message}");
    }

    #[test]
    fn another_text_is_explained_by_its_own_fields() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        #[allow(dead_code, reason = "only read")]
        struct Other {
            count: u8,
            colour: Colour,
        }
        #[derive(Debug, serde::Deserialize)]
        enum Colour {
            Green,
            Blue,
        }
        for (text, offset, said) in [
            ("(count: 1, colour: Grren)", 19, "Grren: allowed: Green, Blue (did you mean Green?)"),
            ("(count: 1, colour: X)", 19, "X: allowed: Green, Blue"),
            ("(count: 1)", 9, "colour: missing"),
            ("(count: 1, count: 2)", 11, "count: given twice"),
            ("(count: 1, size: 2)", 11, "size: "),
            ("(count: 1, colour: Blue) x", 25, "nothing may follow here"),
        ] {
            let error = ron::from_str::<Other>(text).unwrap_err();
            let (at, message) = describe_error(text, &error);
            assert!(message.starts_with(said), "{text}: {message}");
            assert_eq!(at, offset, "{text}: {message}");
        }
    }
}
