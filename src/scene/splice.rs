//! Changing one field of a scene in its text, leaving every comment where it stands.

use std::ops::Range;

use super::field::Field;
use super::fields::FIELDS;
use super::locate::{Body, Entry, Outline};
use super::range::choice_name;
use super::scan::comment_end;
use super::suggest::nearest;

const NOT_ONE_VALUE: &str = "not one RON value by itself, such as 1.0e-3 or (1, 512)";

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
    // Whatever was spliced in must now be the value of that field, all of it and nothing else: a
    // comment in it must not swallow what follows.
    let stands = Outline::of(&new).ok().and_then(|outline| outline.find(path)).map(|place| &new[place.value]);
    if stands == Some(value) { Ok(new) } else { Err(NOT_ONE_VALUE.into()) }
}

/// The value without blanks around it, if it is one RON value and nothing else.
fn one_value(value: &str) -> Result<&str, String> {
    let value = value.trim();
    if value.is_empty() {
        return Err("a value is missing".into());
    }
    let outline =
        Outline::of(value).map_err(|unreadable| format!("not one RON value: {}", unreadable.reason))?;
    if outline.is_one_value() { Ok(value) } else { Err(NOT_ONE_VALUE.into()) }
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
    Err(format!("no such field{near} (fields: {})", names.join(", ")))
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

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"(
    version: 1,
    // What it is made of.
    material: (effective_modulus: 1.0e6), // soft
    length: 1.0e-4, /* as long
                       as it is */
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1),
    numerics: (
        points: 4096, // enough
        samples: 64 // few
    ),
    observe: []
)
"#;

    fn changed(path: &str, value: &str, from: &str, to: &str) {
        assert_eq!(SCENE.matches(from).count(), 1, "{from}");
        assert_eq!(set(SCENE, path, value).unwrap(), SCENE.replace(from, to), "{path}={value}");
    }

    #[test]
    fn values_are_exchanged_in_their_place() {
        changed("length", " 2.0e-4 ", "1.0e-4,", "2.0e-4,");
        changed("roughness.hurst", "0.5", "hurst: 0.7", "hurst: 0.5");
        changed("roughness.modes", "(2, 4)", "(1, 512)", "(2, 4)");
        changed("roughness.modes.1", "4", "(1, 512)", "(1, 4)");
        changed("observe", "[Fragments]", "[]", "[Fragments]");
        let rough = "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)";
        changed("roughness", "None", rough, "None");
    }

    #[test]
    fn missing_fields_are_inserted_where_the_table_has_them() {
        let after_length = "as it is */\n";
        let line = |line: &str| format!("{after_length}    {line}\n");
        changed("form", "Cone(angle: 0.1)", after_length, &line("form: Cone(angle: 0.1),"));
        changed("title", "\"A\"", "version: 1,\n", "version: 1,\n    title: \"A\",\n");
        changed("material.poisson_ratio", "0.5", "1.0e6)", "1.0e6, poisson_ratio: 0.5)");
        changed("roughness.rms_gradient", "0.1", "1.0e-7,", "1.0e-7, rms_gradient: 0.1,");
        changed("numerics.solver", "Exact", "// enough\n", "// enough\n        solver: Exact,\n");
        changed("numerics.edges", "Grid", "// enough\n", "// enough\n        edges: Grid,\n");
        let rough = "seed: 1),\n";
        changed("adhesion.work", "0.1", rough, &format!("{rough}    adhesion: (work: 0.1),\n"));
    }

    #[test]
    fn the_last_entry_keeps_its_comment_and_its_lack_of_a_comma() {
        let text = "(\n    version: 1,\n    length: 1.0 // last\n)\n";
        let new = "(\n    version: 1,\n    length: 1.0, // last\n    observe: []\n)\n";
        assert_eq!(set(text, "observe", "[]").unwrap(), new);
        let text = "(\r\n\tversion: 1,\r\n\tlength: 1.0\r\n)\r\n";
        let new = "(\r\n\tversion: 1,\r\n\tlength: 1.0,\r\n\tobserve: []\r\n)\r\n";
        assert_eq!(set(text, "observe", "[]").unwrap(), new);
    }

    #[test]
    fn one_line_stays_one_line() {
        for (text, path, value, new) in [
            ("(length: 1.0)", "observe", "[]", "(length: 1.0, observe: [])"),
            ("(length: 1.0,)", "observe", "[]", "(length: 1.0, observe: [],)"),
            ("(length: 1.0 /* c */)", "observe", "[]", "(length: 1.0, observe: [] /* c */)"),
            ("(observe: [])", "length", "1.0", "(observe: [], length: 1.0)"),
            ("()", "adhesion.work", "0.1", "(adhesion: (work: 0.1))"),
            ("(adhesion: None)", "adhesion.work", "0.1", "(adhesion: (work: 0.1))"),
            ("(adhesion: ())", "adhesion.work", "0.1", "(adhesion: (work: 0.1))"),
            ("( // c\n)", "length", "1.0", "(length: 1.0 // c\n)"),
            (
                "Scene(form: Some(Cone(angle: 1.0)))",
                "form.angle",
                "0.1",
                "Scene(form: Some(Cone(angle: 0.1)))",
            ),
        ] {
            assert_eq!(set(text, path, value).as_deref(), Ok(new), "{text} {path}");
        }
    }

    #[test]
    fn what_is_not_there_need_not_be_taken_away() {
        for path in ["form", "adhesion", "adhesion.work", "roughness.rms_gradient", "material.youngs_modulus"]
        {
            assert_eq!(set(SCENE, path, "None").as_deref(), Ok(SCENE), "{path}");
        }
    }

    #[test]
    fn a_value_is_one_value_and_stays_in_its_place() {
        for value in [
            "",
            "1.0), title: (\"x\"",
            "1 // ",
            "1 /* ",
            "1 /* a */",
            "/* a */ 1",
            "// a\n1",
            "1.0, title: \"x\"",
            "1.0 title",
            "title: 1.0",
            "\"a",
            "\"a\" \"b\"",
            "r#\"a\"",
            "'",
            "(",
            ")",
            "[1)",
            ",",
            ":",
            "1,",
            "(1) (2)",
            "#![enable(unwrap_newtypes)] 1",
        ] {
            assert!(set(SCENE, "length", value).is_err(), "{value}");
            assert!(set(SCENE, "adhesion.work", value).is_err(), "{value}");
        }
    }

    #[test]
    fn a_value_does_not_become_a_comment_with_what_follows() {
        assert!(set("(length: 1.0// c\n)", "length", "/").is_err());
        assert!(set("(length: 1.0/* c */)", "length", "/").is_err());
    }

    #[test]
    fn refusals_say_what_to_do() {
        for (path, said) in [
            ("roughness.hurts", "did you mean roughness.hurst?"),
            ("hurst", "did you mean roughness.hurst?"),
            ("nothing", "no such field (fields: adhesion, adhesion.kappa"),
            ("", "no such field"),
            ("loading.", "no such field"),
            ("..", "no such field"),
            ("roughness..hurst", "no such field"),
            ("form.radius", "there is no form: set form=Paraboloid(radius: 1.0e-3) or form=Punch("),
            ("roughness.file", "roughness is SelfAffine, which has no such field: set roughness=Measured("),
            ("numerics.solver.step", "set numerics.solver=Stepwise(step: 1.0e-9)"),
            ("loading.0", "no such element"),
            ("roughness.modes.2", "no such element"),
            ("version.0", "no such element"),
        ] {
            let message = set(SCENE, path, "1").unwrap_err();
            assert!(message.contains(said), "{path}: {message}");
        }
        let without = SCENE.replace("observe: []", "form: None");
        let message = set(&without, "form.radius", "1").unwrap_err();
        assert!(message.contains("there is no form: set "), "{message}");
    }

    #[test]
    fn a_number_is_not_replaced_by_a_group() {
        let message = set("(length: 1.0, adhesion: 3.0)", "adhesion.work", "0.1").unwrap_err();
        assert_eq!(message, "adhesion has no fields here");
    }
}
