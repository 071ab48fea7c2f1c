//! Typed values of fields, put into the text of a scene.

use super::edit::{field_at, set};
use super::errors::{Origin, SceneError, SceneErrors};
use super::field::Field;
use super::fields::{FIELDS, field};
use super::range::Range;
use super::text::edit::NOT_ONE_VALUE;
use super::text::index::Text;

/// Largest length of the text of a scene in bytes. A longer text is refused unread; most scenes
/// have a few hundred bytes.
pub const LONGEST_TEXT: usize = 1 << 20;

/// Returns the text with the field at `path` set to `value`.
pub(super) fn with_typed(text: &Text, path: &str, value: &str) -> Result<Text, SceneErrors> {
    let parent = path.rsplit_once('.').map_or("", |(parent, _)| parent);
    let band = || {
        field(parent, None)
            .filter(|field| matches!(field.range, Range::Band(..) | Range::Wavelengths(..)))
    };
    let known = field_at(text, path).or_else(band);
    let origin = || Origin::Overrides(vec![format!("{path}={value}")]);
    let refused = |message| SceneErrors::from(SceneError::whole(origin(), message));
    let wrong = |known: &Field, why: &str| {
        SceneErrors::from(SceneError::of(path, value, known.allowed(), why).at(origin()))
    };
    let typed = match known {
        Some(known) => known
            .read_typed(value)
            .map_err(|error| wrong(known, &error.to_string()))?,
        None => value.to_string(),
    };
    let typed = group_in_ron(path, &typed).unwrap_or(typed);
    let text = set(text, path, &typed).map_err(|message| match known {
        Some(known) if message == NOT_ONE_VALUE => wrong(known, ""),
        _ => refused(message),
    })?;
    check_length(text.as_str()).map_err(refused)?;
    Ok(text)
}

/// Returns a typed group of values with prefixes and units, such as `Cone(angle: 70°)`, in RON.
/// Returns `None` for any other text, also for a group that is in RON already.
fn group_in_ron(path: &str, typed: &str) -> Option<String> {
    let (name, inside) = typed.strip_suffix(')')?.split_once('(')?;
    let mut depth = 0_usize;
    let between = |c: char| {
        depth = match c {
            '(' | '[' => depth + 1,
            ')' | ']' => depth.saturating_sub(1),
            _ => depth,
        };
        c == ',' && depth == 0
    };
    let value = |part: &str| {
        let (field, value) = part.split_once(':')?;
        let (field, value) = (field.trim(), value.trim());
        let path = if path.is_empty() {
            field.to_owned()
        } else {
            format!("{path}.{field}")
        };
        let known = FIELDS.iter().find(|field| field.path == path)?;
        let value = known.read_typed(value).ok()?;
        Some(format!(
            "{field}: {}",
            group_in_ron(&path, &value).unwrap_or(value)
        ))
    };
    // A text or a comment may contain any sign.
    let is_plain = !["\"", "//", "/*"].iter().any(|sign| inside.contains(sign));
    let parts = Some(inside).filter(|_| is_plain)?.split(between);
    let parts: Vec<_> = parts.filter(|part| !part.trim().is_empty()).collect();
    let read = parts
        .iter()
        .map(|part| value(part))
        .collect::<Option<Vec<_>>>()?;
    let is_read = parts
        .iter()
        .zip(&read)
        .any(|(part, read)| part.trim() != read);
    is_read.then(|| format!("{name}({})", read.join(", ")))
}

pub(super) fn check_length(text: &str) -> Result<(), String> {
    if text.len() > LONGEST_TEXT {
        return Err(format!(
            "the scene is {} bytes long, at most {LONGEST_TEXT} are read",
            text.len()
        ));
    }
    Ok(())
}
