//! Reading the text of a scene, and saying in the scene's own terms why it cannot be read.

use ron::extensions::Extensions;

use super::fields::{Field, field};
use super::locate::{Outline, offset_of};
use super::model::{SCENE_VERSION, Scene};
use super::suggest::nearest;

/// Longer values than this are not repeated in messages.
const MOST_REPEATED: usize = 60;

/// Why text is no scene: at which byte, which field is meant, and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unread {
    pub(super) offset: usize,
    pub(super) field: String,
    pub(super) value: String,
    pub(super) allowed: String,
    pub(super) message: String,
}

/// Reads a scene; its values are not checked.
pub(super) fn read(text: &str) -> Result<Scene, Unread> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| explain(text, &error))
}

/// What is wrong with the version a text gives, whether or not the rest of it can be read.
pub(super) fn wrong_version(text: &str) -> Option<Unread> {
    let outline = Outline::of(text).ok()?;
    let inside = outline.inside(outline.body("")?);
    let (offset, value, message) = match outline.find("version") {
        Some(place) => {
            let value = text[place.value.clone()].to_string();
            if value.parse() == Ok(SCENE_VERSION) {
                return None;
            }
            (place.value.start, value, "version of the scene file")
        }
        None => {
            (inside.start.saturating_sub(1), String::new(), "version of the scene file, which is missing")
        }
    };
    let (field, allowed, message) = ("version".into(), SCENE_VERSION.to_string(), message.into());
    Some(Unread { offset, field, value, allowed, message })
}

fn explain(text: &str, error: &ron::error::SpannedError) -> Unread {
    use ron::Error;

    let start = offset_of(text, error.span.start.line, error.span.start.col);
    let end = offset_of(text, error.span.end.line, error.span.end.col).max(start);
    // The span starts before the last thing read; where that was only blank or punctuation, what is
    // wrong comes after it.
    let names_it =
        text[start..end].contains(|c: char| c.is_alphanumeric() || matches!(c, '"' | '\'' | '_' | '-'));
    let offset = if names_it { start } else { end };

    let outline = match Outline::of(text) {
        Ok(outline) => outline,
        Err(unreadable) => {
            let lost =
                matches!(error.code, Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment);
            let (offset, message) = if lost {
                (unreadable.offset, unreadable.reason.to_string())
            } else {
                (offset, plain(&error.code))
            };
            return Unread { offset, message, ..Unread::nowhere() };
        }
    };
    let path = outline.path_at(offset);
    match &error.code {
        Error::NoSuchStructField { expected, found, .. } => {
            let mut message = "no such field".to_string();
            if let Some(near) = nearest(found, expected.iter().copied()) {
                message.push_str(&format!("; did you mean {near}?"));
            }
            message.push_str(&format!(" Fields here: {}", expected.join(", ")));
            Unread { offset, field: path, message, ..Unread::nowhere() }
        }
        Error::MissingStructField { field: name, .. } => {
            let path = if path.is_empty() { (*name).to_string() } else { format!("{path}.{name}") };
            let allowed =
                known(&outline, &path).map_or_else(String::new, |field| format!(": {}", field.allowed()));
            Unread { offset, field: path, message: format!("missing{allowed}"), ..Unread::nowhere() }
        }
        Error::DuplicateStructField { .. } => {
            Unread { offset, field: path, message: "given twice".into(), ..Unread::nowhere() }
        }
        Error::NoSuchEnumVariant { expected, found, .. } => {
            let near = nearest(found, expected.iter().copied());
            Unread {
                offset,
                field: path,
                value: found.clone(),
                allowed: expected.join(", "),
                message: near.map_or_else(String::new, |near| format!("did you mean {near}?")),
            }
        }
        code => {
            let value = outline.find(&path).map(|place| &text[place.value]).unwrap_or_default();
            let scalar =
                !value.is_empty() && value.len() <= MOST_REPEATED && !value.contains(['(', '[', '{']);
            let allowed = known(&outline, &path).filter(|_| scalar).map_or_else(String::new, Field::allowed);
            let value = if scalar { value.to_string() } else { String::new() };
            Unread { offset, field: path, value, allowed, message: plain(code) }
        }
    }
}

impl Unread {
    fn nowhere() -> Unread {
        Unread {
            offset: 0,
            field: String::new(),
            value: String::new(),
            allowed: String::new(),
            message: String::new(),
        }
    }
}

/// The field at a path, by the variant the text gives to the group around it.
fn known(outline: &Outline, path: &str) -> Option<&'static Field> {
    let parent = path.rsplit_once('.').map_or("", |(parent, _)| parent);
    field(path, outline.head(parent)).or_else(|| field(path, None))
}

/// What the reader says, in words that do not presume the reader's own.
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
    use super::super::locate::line_column;
    use super::*;

    fn unread(text: &str) -> ((usize, usize), String, String, String, String) {
        let Unread { offset, field, value, allowed, message } = read(text).unwrap_err();
        (line_column(text, offset), field, value, allowed, message)
    }

    fn scene(line: &str) -> String {
        format!(
            "(\n    version: 1,\n    material: (effective_modulus: 1.0e6),\n    length: 1.0e-4,\n{line}\n)\n"
        )
    }

    #[test]
    fn errors_are_told_in_the_terms_of_the_scene() {
        let rough = |fields: &str| scene(&format!("    roughness: SelfAffine({fields}),"));
        for (text, place, field, value, said) in [
            (scene("    lenght: 1,"), (5, 5), "lenght", "", "did you mean length?"),
            (scene("    title: \"a\",\n    title: \"b\","), (6, 5), "title", "", "given twice"),
            (
                scene("    form: Cube(radius: 1.0),"),
                (5, 11),
                "form",
                "Cube",
                "Paraboloid, Cone, Power, Punch",
            ),
            (scene("    form: Cone(angel: 1.0),"), (5, 16), "form.angel", "", "did you mean angle?"),
            (
                scene("    loading: [ToTouch, ToFroce(1.0)],"),
                (5, 24),
                "loading.1",
                "ToFroce",
                "did you mean ToForce?",
            ),
            (
                scene("    loading: [ToForce(\"a\")],"),
                (5, 23),
                "loading.0.0",
                "\"a\"",
                "a number is expected",
            ),
            (
                scene("    numerics: (points: 1.5),"),
                (5, 25),
                "numerics.points",
                "1.5",
                "a whole number from 1",
            ),
            (scene("    numerics: (points: -5),"), (5, 24), "numerics.points", "-5", "a whole number from 1"),
            (
                scene("    numerics: (points: 1e3),"),
                (5, 25),
                "numerics.points",
                "1e3",
                "a whole number from 1",
            ),
            (scene("    title: Hello,"), (5, 12), "title", "Hello", "text in quotes"),
            (scene("    adhesion: 0.5,"), (5, 15), "adhesion", "0.5", "an opening ("),
            (rough("hurst: 0.7, modes: (1, 2)"), (5, 48), "roughness.seed", "", "missing: a whole number"),
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
    fn the_version_is_told_whatever_else_is_wrong() {
        assert_eq!(wrong_version("(version: 1, nonsense)"), None);
        assert_eq!(wrong_version("(version: 2, nonsense)").unwrap().value, "2");
        assert!(wrong_version("(length: 1)").unwrap().message.contains("missing"));
        assert_eq!(wrong_version("(version: 2, nonsense"), None);
    }
}
