//! Reader of the text of a scene. Its error messages use the terms of scenes.

use ron::Error;
use ron::error::SpannedError;

use super::edit::field_at;
use super::errors::{Origin, SceneError, SceneErrors, did_you_mean, nearest};
use super::fields::field;
use super::model::Scene;
use super::range::Range;
use super::text::index::{Text, offset_of};
use super::text::read_ron;

/// Largest length of a value that error messages repeat.
const MOST_REPEATED: usize = 60;

/// Error message for a text that does not begin as a scene, such as a table of an instrument.
const NO_SCENE: &str = "a scene in ( ) is expected here; a measured surface is read by `asperity surface FILE`, and \
                        is the roughness of a scene as Measured(file: \"FILE\")";

/// Reads a scene without checking its values. `origin` returns the origin of an error from its byte
/// offset in the text.
pub(super) fn read(text: &str, origin: impl Fn(usize) -> Origin) -> Result<Scene, SceneErrors> {
    read_ron(text).map_err(|error| {
        let (offset, error) = no_scene(text, &error).unwrap_or_else(|| explain(text, &error));
        error.at(origin(offset)).into()
    })
}

/// Returns the byte offset and the error of a text that does not begin as a scene or has an
/// unsupported version. The version is checked before other errors are explained, because an
/// unsupported version may be the reason why the rest is unreadable. Returns `None` for any other
/// text.
fn no_scene(source: &str, error: &SpannedError) -> Option<(usize, SceneError)> {
    if !source.trim().is_empty() && !source[..place_of(source, error).1].contains('(') {
        let start = source.len() - source.trim_start().len();
        return Some((start, SceneError::whole(Origin::Scene, NO_SCENE)));
    }
    let text = Text::new(source).ok()?;
    let field = field("version", None)?;
    let value = text.written("version")?;
    let is_supported = value
        .parse()
        .is_ok_and(|version| field.range.contains_whole(version));
    if is_supported {
        return None;
    }
    let error = SceneError::of(field.path, value, field.allowed(), field.name);
    Some((text.nearest_value("version"), error))
}

/// Returns the byte offset at which the error begins, and the byte offset that the reader has
/// reached.
fn place_of(text: &str, error: &SpannedError) -> (usize, usize) {
    let start = offset_of(text, error.span.start.line, error.span.start.col);
    let end = offset_of(text, error.span.end.line, error.span.end.col).max(start);
    // If the error is a message of the types of a scene, it refers to the group that ends at this
    // position.
    if let Error::Message(_) = error.code {
        return (text[..end].trim_end().len().saturating_sub(1), end);
    }
    // The span of the error starts before the last token. If the span contains only blanks and
    // punctuation, the error is after the span.
    let is_token = |sign: char| sign.is_alphanumeric() || matches!(sign, '"' | '\'' | '_' | '-');
    if text[start..end].contains(is_token) {
        (start, end)
    } else {
        (end, end)
    }
}

/// Returns an error of [`read_ron`] in plain words, and its byte offset in the text of the scene
/// `source`.
pub fn explain(source: &str, error: &SpannedError) -> (usize, SceneError) {
    let (offset, end) = place_of(source, error);
    let is_lost = matches!(
        error.code,
        Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment
    );
    let unreadable = match Text::new(source) {
        Ok(text) => return explain_at(&text, offset, &error.code),
        Err(unreadable) => unreadable,
    };
    // If the reader has reached the end of the text, the position of the open bracket explains the
    // error better.
    if end >= source.trim_end().len() || is_lost {
        let error = SceneError::whole(Origin::Scene, unreadable.reason);
        return (unreadable.offset, error);
    }
    let error = SceneError::whole(Origin::Scene, plain(&error.code));
    (offset, error)
}

fn explain_at(text: &Text, offset: usize, error: &Error) -> (usize, SceneError) {
    let path = text.path_at(offset);
    let error = match error {
        Error::MissingStructField { field: name, .. } => {
            let path = if path.is_empty() {
                name.to_string()
            } else {
                format!("{path}.{name}")
            };
            let message = match field_at(text, &path) {
                Some(field) => format!("missing; allowed: {}", field.allowed()),
                None => "missing".to_owned(),
            };
            SceneError::of(&path, "", "", &message)
        }
        Error::NoSuchEnumVariant {
            expected, found, ..
        } => {
            let near = nearest(found, expected.iter().copied());
            let message = near.map_or_else(String::new, |near| format!("did you mean {near}?"));
            SceneError::of(path, found, expected.join(", "), &message)
        }
        Error::Message(reason) => {
            return (
                text.nearest_value(path),
                SceneError::of(path, "", "", reason),
            );
        }
        Error::NoSuchStructField { .. } | Error::DuplicateStructField { .. } => {
            SceneError::of(path, "", "", &plain(error))
        }
        _ => return explain_value(text, path, offset, error),
    };
    (offset, error)
}

/// Explains the error of a value. If the text at the path is a single value, the error begins at
/// this value and states the value and the allowed values.
fn explain_value(text: &Text, path: &str, offset: usize, error: &Error) -> (usize, SceneError) {
    let single = text.written(path).filter(|value| {
        !path.is_empty() && value.len() <= MOST_REPEATED && !value.contains(['(', '[', '{'])
    });
    let Some(value) = single else {
        return (offset, SceneError::of(path, "", "", &plain(error)));
    };
    let offset = text.nearest_value(path);
    // The error of a text without quotes is the missing quotes and not its content, so no allowed
    // values are stated for it.
    if let Some(field) = field_at(text, path)
        && !matches!(field.range, Range::Text { .. })
        && !value.is_empty()
    {
        let error = SceneError::of(path, value, field.allowed(), field.name);
        return (offset, error);
    }
    (offset, SceneError::of(path, value, "", &plain(error)))
}

/// Returns true if a field of the plan of a study was found where a scene was expected.
fn is_of_plan(found: &str, expected: &[&str]) -> bool {
    ["scene", "axes", "preloads", "profiles", "record"].contains(&found)
        && expected.contains(&"material")
}

/// Returns the error message of the RON reader in plain words.
fn plain(error: &Error) -> String {
    let text = match error {
        Error::Eof => "the text ends too early",
        Error::ExpectedFloat => "a number is expected here",
        Error::ExpectedInteger | Error::InvalidIntegerDigit { .. } => {
            "a whole number is expected here"
        }
        Error::IntegerOutOfBounds => "this whole number is too large or negative",
        Error::ExpectedString => "text in quotes is expected here",
        Error::ExpectedComma => "a comma is expected here",
        Error::ExpectedArray => "a list in [ ] is expected here",
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => {
            "an opening ( is expected here"
        }
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => "a closing ) is expected here",
        Error::ExpectedDifferentStructName { .. } => "a group of fields in ( ) is expected here",
        Error::DuplicateStructField { .. } => "given twice",
        Error::NoSuchStructField {
            expected, found, ..
        } if is_of_plan(found, expected) => {
            return "a scene has no such field; asperity sweep PLAN computes the plan of a study"
                .to_owned();
        }
        Error::NoSuchStructField {
            expected, found, ..
        } => {
            let near = did_you_mean(found, expected.iter().copied());
            return format!("no such field{near} (fields here: {})", expected.join(", "));
        }
        Error::ExpectedMapColon => "a colon is expected here",
        Error::ExceededRecursionLimit => "nested too deeply",
        Error::TrailingCharacters => "nothing may follow here",
        other => return with_small_letter(&other.to_string()),
    };
    text.to_string()
}

/// Returns a text with its first letter changed to a small letter.
fn with_small_letter(text: &str) -> String {
    let Some(first) = text.chars().next() else {
        return String::new();
    };
    format!(
        "{}{}",
        first.to_lowercase(),
        text.get(1..).unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::super::errors::origin_at;
    use super::*;

    fn unread(text: &str) -> ((usize, usize), String, String, String, String) {
        let errors = read(text, |offset| origin_at(text, "", offset)).unwrap_err();
        let SceneError {
            origin,
            field,
            value,
            allowed,
            message,
        } = errors.first().clone();
        let Origin::File {
            place: Some(place), ..
        } = origin
        else {
            panic!("{origin:?}")
        };
        (place, field, value, allowed, message)
    }

    fn scene(line: &str) -> String {
        format!(
            "(\n    version: 1,\n    material: (modulus: 1.0e6),\n    length: 1.0e-4,\n{line}\n)\n"
        )
    }

    #[test]
    fn errors_are_stated_in_the_terms_of_the_scene() {
        // Each row has the fifth line of a scene, followed by the column, the field, the value and
        // a part of the message of the error in this line.
        for row in [
            "lenght: 1,|5|lenght||did you mean length?",
            "length: 1.0,|5|length||given twice",
            "axes: [],|5|axes||asperity sweep PLAN computes the plan",
            "form: Cube(radius: 1.0),|11|form|Cube|Cone, Power, WavySphere, RoundedCone, Punch",
            "form: Cone(angel: 1.0),|16|form.angel||did you mean angle?",
            "loading: [ToTouch, ToFroce(1.0)],|24|loading.1|ToFroce|mean ToForce?",
            "loading: [ToForce(\"a\")],|23|loading.0.0|\"a\"|from -1e30 to 1e30 N",
            "numerics: (points: 1.5),|24|numerics.points|1.5|from 1 to 268435456",
            "numerics: (points: -5),|24|numerics.points|-5|from 1 to 268435456",
            "title: Hello,|12|title|Hello|text in quotes",
            "adhesion: 0.5,|15|adhesion|0.5|(work: 0.05), (kappa: 2.0) or (elastic_energy_ratio: 0.5)",
            "adhesion: (work: 0.05, kappa: 2.0),|15|adhesion||give (work: 0.05) or (kappa: 2.0)",
            "adhesion: (), // none|15|adhesion||give work, kappa or elastic_energy_ratio",
            "roughness: SelfAffine(hurst: 0.7, modes: (1, 2)),|52|roughness.seed||missing; allowed: a whole number",
            "roughness: SelfAffine(hurst: \"x\"),|34|roughness.hurst|\"x\"|above 0 and below 1",
            "roughness: SelfAffine(hurst: 0.7 seed: 1),|38|roughness||a comma is expected",
        ] {
            let [line, column, field, value, said] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            let (at, path, found, allowed, message) = unread(&scene(&format!("    {line}")));
            let place = (5, column.parse().unwrap());
            assert_eq!(
                (at, path.as_str(), found.as_str()),
                (place, field, value),
                "{row}: {allowed} {message}"
            );
            assert!(
                format!("{allowed} {message}").contains(said),
                "{row}: {allowed} {message}"
            );
        }
        for (text, place, field, said) in [
            ("(version: 1)", (1, 12), "material", "missing"),
            ("(version: 1", (1, 1), "", "not closed"),
            ("(version: 1, title: \"a)", (1, 21), "", "not closed"),
            ("", (1, 1), "", ""),
        ] {
            let (at, path, _, _, message) = unread(text);
            assert!(
                (at, path.as_str()) == (place, field) && message.contains(said),
                "{text}: {message}"
            );
        }
    }
}
