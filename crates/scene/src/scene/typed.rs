//! Values of fields as users type them, converted to RON and put into the text of a scene.

use super::edit::{field_at, set};
use super::errors::{Origin, SceneError, SceneErrors};
use super::field::Field;
use super::fields::field;
use super::range::Range;
use super::text::edit::NOT_ONE_VALUE;
use super::text::index::Text;

/// Largest length of the text of a scene in bytes. A longer text is refused before it is read; most
/// scenes have a few hundred bytes.
pub const LONGEST_TEXT: usize = 1 << 20;

/// Returns the text with the field at `path` set to `value`.
pub(super) fn with_typed(text: &Text, path: &str, value: &str) -> Result<Text, SceneErrors> {
    let typed = Typed {
        path,
        value,
        field: field_at(text, path).or_else(|| pair_around(path)),
    };
    let ron = typed.in_ron()?;
    let text = set(text, path, &ron).map_err(|message| match typed.field {
        Some(field) if message == NOT_ONE_VALUE => typed.not_allowed(field, ""),
        _ => typed.refused(message),
    })?;
    check_length(text.as_str()).map_err(|message| typed.refused(message))?;
    Ok(text)
}

/// Returns the field whose value is a pair of numbers, if the path leads to one of the two numbers.
fn pair_around(path: &str) -> Option<&'static Field> {
    let (pair, _) = path.rsplit_once('.')?;
    field(pair, None)
        .filter(|field| matches!(field.range, Range::Band(..) | Range::Wavelengths(..)))
}

/// A change of a field as a user types it.
struct Typed<'t> {
    path: &'t str,
    value: &'t str,
    /// Field at the path; `None` if there is no such field.
    field: Option<&'static Field>,
}

impl Typed<'_> {
    fn in_ron(&self) -> Result<String, SceneErrors> {
        let ron = match self.field {
            Some(field) => field
                .read_typed(self.value)
                .map_err(|error| self.not_allowed(field, &error.to_string()))?,
            None => self.value.to_owned(),
        };
        Ok(group_in_ron(self.path, &ron).unwrap_or(ron))
    }

    fn origin(&self) -> Origin {
        Origin::Overrides(vec![format!("{}={}", self.path, self.value)])
    }

    fn not_allowed(&self, field: &Field, reason: &str) -> SceneErrors {
        SceneError::of(self.path, self.value, field.allowed(), reason)
            .at(self.origin())
            .into()
    }

    fn refused(&self, message: String) -> SceneErrors {
        SceneError::whole(self.origin(), message).into()
    }
}

/// Converts a typed group of values with prefixes and units, such as `Cone(angle: 70°)`, to RON.
/// Returns `None` for any other text, and for a group that is already in RON.
fn group_in_ron(path: &str, typed: &str) -> Option<String> {
    let (name, inside) = typed.strip_suffix(')')?.split_once('(')?;
    // A quoted text or a comment may contain commas and brackets, so such a group is not divided.
    if ["\"", "//", "/*"].iter().any(|sign| inside.contains(sign)) {
        return None;
    }
    let list = inside.trim().strip_prefix('[');
    let list = list.and_then(|list| list.strip_suffix(']'));
    let mut entries = Vec::new();
    let mut is_changed = false;
    for (index, entry) in split_at_commas(list.unwrap_or(inside)).iter().enumerate() {
        if entry.trim().is_empty() {
            continue;
        }
        let ron = match list {
            Some(_) => element_in_ron(&format!("{path}.{index}"), entry.trim()),
            None => entry_in_ron(path, entry)?,
        };
        is_changed |= entry.trim() != ron;
        entries.push(ron);
    }
    let entries = entries.join(", ");
    is_changed.then(|| match list {
        Some(_) => format!("{name}([{entries}])"),
        None => format!("{name}({entries})"),
    })
}

/// Converts a typed element of a list, such as one of several spheres, to RON.
fn element_in_ron(path: &str, element: &str) -> String {
    group_in_ron(path, element).unwrap_or_else(|| element.to_owned())
}

/// Splits a text at its commas, except for commas inside brackets.
fn split_at_commas(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut depth = 0_usize;
    for (place, sign) in text.char_indices() {
        match sign {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push(&text[start..place]);
                start = place + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// Converts a typed entry `name: value` of the group at a path to RON. Returns `None` if the group
/// has no field of this name, or if the field does not allow the value.
fn entry_in_ron(group: &str, entry: &str) -> Option<String> {
    let (name, value) = entry.split_once(':')?;
    let name = name.trim();
    let path = if group.is_empty() {
        name.to_owned()
    } else {
        format!("{group}.{name}")
    };
    let field = field(&path, None)?;
    let value = field.read_typed(value.trim()).ok()?;
    let value = group_in_ron(&path, &value).unwrap_or(value);
    Some(format!("{name}: {value}"))
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
