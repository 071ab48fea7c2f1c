//! Changing one field of a scene in its text, leaving every comment where it stands.

use std::ops::Range;

use super::fields::{FIELDS, Field};
use super::locate::{Body, Entry, Outline};
use super::range::choice_name;
use super::scan::comment_end;
use super::suggest::nearest;

/// Gives the field at `path` the value `value`, written as RON, and returns the new text.
///
/// A field that is not there is inserted, with the group around it where that is missing too; a part
/// set to `None` that is not there stays away. Whatever the value is, it changes this one place.
///
/// # Errors
///
/// A sentence that says why not: no such field, not one value, or no place for it.
pub(super) fn set(text: &str, path: &str, value: &str) -> Result<String, String> {
    let value = one_value(value)?;
    let fields = fields_at(path)?;
    let outline = Outline::of(text).map_err(|unreadable| unreadable.reason.to_string())?;
    let new = if let Some(place) = outline.find(path) {
        apply(text, vec![(place.value, value.to_string())])
    } else if value == "None" && fields.iter().any(|field| field.default == "None" && field.path == path) {
        return Ok(text.to_string());
    } else {
        insert(text, &outline, path, value, &fields)?
    };
    // Whatever was spliced in must now be the value of that field, and of nothing else.
    let stands = Outline::of(&new).ok().and_then(|outline| outline.find(path)).map(|place| &new[place.value]);
    if stands == Some(value) { Ok(new) } else { Err("this value does not stay in its place".into()) }
}

/// The value without blanks around it, if it is one RON value and nothing else.
fn one_value(value: &str) -> Result<&str, String> {
    let value = value.trim();
    if value.is_empty() {
        return Err("a value is missing".into());
    }
    let outline =
        Outline::of(value).map_err(|unreadable| format!("not one RON value: {}", unreadable.reason))?;
    let bare = !outline.has_outer_comments();
    if outline.is_one_value() && bare {
        Ok(value)
    } else {
        Err("not one RON value, such as 1.0e-3 or (1, 512)".into())
    }
}

/// The fields a path may mean: more than one where variants of a choice share a name. A position in
/// a list or pair means that list or pair.
fn fields_at(path: &str) -> Result<Vec<&'static Field>, String> {
    let mut base = path;
    while let Some((before, last)) = base.rsplit_once('.')
        && !last.is_empty()
        && last.bytes().all(|byte| byte.is_ascii_digit())
    {
        base = before;
    }
    let fields: Vec<_> = FIELDS.iter().filter(|field| field.path == base).collect();
    if !fields.is_empty() {
        return Ok(fields);
    }
    let mut names: Vec<_> = FIELDS.iter().map(|field| field.path).collect();
    names.sort_unstable();
    names.dedup();
    let near = nearest(path, names.iter().copied());
    let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
    Err(format!("no such field{near} Fields: {}", names.join(", ")))
}

fn insert(
    text: &str,
    outline: &Outline,
    path: &str,
    value: &str,
    fields: &[&'static Field],
) -> Result<String, String> {
    let Some(field) = fields.iter().find(|field| field.path == path) else {
        return Err("there is no such element".into());
    };
    let parent = field.parent();
    let head = outline.head(parent);
    if field.variant.is_some() && !fields.iter().any(|field| field.variant == head) {
        return Err(wrong_variant(parent, head, fields));
    }
    let grouped = format!("({}: {value})", field.last());
    match (outline.body(parent), outline.find(parent)) {
        (Some(body), _) => Ok(insert_entry(text, outline, body, field, value)),
        (None, Some(place)) if &text[place.value.clone()] == "None" => {
            Ok(apply(text, vec![(place.value, grouped)]))
        }
        (None, Some(_)) => Err(format!("{parent} has no fields here")),
        (None, None) if parent.is_empty() => Err("the scene is not a group of fields".into()),
        (None, None) => set(text, parent, &grouped),
    }
}

/// Says how to get the variant that has the field.
fn wrong_variant(parent: &str, head: Option<&str>, fields: &[&Field]) -> String {
    let choices = FIELDS.iter().find(|field| field.path == parent).map(|field| field.range);
    let Some(super::range::Range::Choice(choices)) = choices else {
        return format!("{parent} has no such field");
    };
    let with_it = choices
        .iter()
        .filter(|choice| fields.iter().any(|field| field.variant == Some(choice_name(choice))))
        .map(|choice| format!("{parent}={choice}"));
    let here = match head {
        Some(head) if head != "None" => format!("{parent} is {head}, which has no such field"),
        _ => format!("there is no {parent}"),
    };
    format!("{here}: set {}", with_it.collect::<Vec<_>>().join(" or "))
}

/// Inserts `name: value` where the table has it: after the last of the fields that come before it.
fn insert_entry(text: &str, outline: &Outline, body: Body, field: &Field, value: &str) -> String {
    let rank = |name: Option<&str>| {
        FIELDS.iter().position(|other| other.parent() == field.parent() && Some(other.last()) == name)
    };
    let here = rank(Some(field.last()));
    let entries: Vec<Entry> = outline.entries(body).collect();
    let before = entries.iter().filter(|entry| rank(entry.name) < here).max_by_key(|entry| rank(entry.name));
    let new = format!("{}: {value}", field.last());
    let inside = outline.inside(body);
    let Some(anchor) = before.or(entries.last()) else {
        return apply(text, vec![(inside.start..inside.start, new)]);
    };
    let after = anchor.comma.unwrap_or(anchor.place.value.end);
    let next = entries.iter().map(|entry| entry.place.entry.start).find(|start| *start >= after);
    let gap = after..next.unwrap_or(inside.end);
    apply(text, edits_after(text, anchor, gap, &new))
}

/// The edits that put an entry after another one, in the way the other one is written: on a line of
/// its own, after the comment on the line before, or on the same line.
fn edits_after(text: &str, anchor: &Entry, gap: Range<usize>, new: &str) -> Vec<(Range<usize>, String)> {
    let comma = if anchor.comma.is_some() { "," } else { "" };
    let at = |offset: usize, text: String| (offset..offset, text);
    let own_line = indentation(text, anchor.place.entry.start);
    match (own_line, line_break(text, gap.clone())) {
        (Some(indentation), Some(end)) => {
            let newline = if text[..end].ends_with('\r') { "\r\n" } else { "\n" };
            let end = end + 1 - newline.len();
            let missing_comma = if anchor.comma.is_some() { "" } else { "," };
            vec![
                at(anchor.place.value.end, missing_comma.into()),
                at(end, format!("{newline}{indentation}{new}{comma}")),
            ]
        }
        _ if anchor.comma.is_some() => vec![at(gap.start, format!(" {new},"))],
        _ => vec![at(gap.start, format!(", {new}"))],
    }
}

/// The blanks before a byte, if nothing else stands before it on its line and it is not the first.
fn indentation(text: &str, offset: usize) -> Option<&str> {
    let line = text[..offset].rfind('\n')? + 1;
    let before = &text[line..offset];
    before.chars().all(|c| matches!(c, ' ' | '\t')).then_some(before)
}

/// The first line break in a stretch of blanks and comments that is not inside a block comment.
fn line_break(text: &str, gap: Range<usize>) -> Option<usize> {
    let mut at = gap.start;
    while at < gap.end {
        if let Some(end) = comment_end(text, at).ok()? {
            at = end;
            continue;
        }
        let c = text[at..].chars().next()?;
        if c == '\n' {
            return Some(at);
        }
        at += c.len_utf8();
    }
    None
}

/// Applies edits that do not overlap.
fn apply(text: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let mut text = text.to_string();
    for (range, new) in edits.into_iter().rev() {
        text.replace_range(range, &new);
    }
    text
}
