//! Changes of one field in the text of a scene. All comments stay.

use super::errors::did_you_mean;
use super::field::{Field, SPHERE_FIELDS, STAGE_FIELDS};
use super::fields::{FIELDS, field};
use super::range::{Range, choice_name};
use super::text::edit::NOT_ONE_VALUE;
use super::text::index::Text;
use std::collections::BTreeSet;

/// Returns the field at a path. If several choices, such as the forms sphere and punch, have a
/// field at this path, it is the field of the choice in the text. Returns `None` if there is no
/// field at this path.
pub(super) fn field_at(text: &Text, path: &str) -> Option<&'static Field> {
    let parent = path.rsplit_once('.').map_or("", |(parent, _)| parent);
    let variant = text.variant(parent);
    if parent.starts_with("loading.") {
        return STAGE_FIELDS
            .into_iter()
            .find(|field| field.variant == variant);
    }
    field(path, variant).or_else(|| field(path, None))
}

/// Sets the field at `path` to `value`, in RON, and returns the new text.
///
/// A missing field is inserted, and so is its group if the group is missing. If the value is
/// `None`, a missing field is not inserted. The rest of the text does not change.
///
/// # Errors
/// Returns the reason as a sentence: there is no such field, `value` is not a single value, or the
/// text has no group for the field.
pub(super) fn set(text: &Text, path: &str, value: &str) -> Result<Text, String> {
    let value = value.trim();
    if field(path, None).is_some_and(|field| SPHERE_FIELDS.contains(&field)) {
        return set_of_sphere(text, path, value);
    }
    let base = without_positions(path);
    // Several fields have the same path if several choices, such as the forms sphere and punch,
    // have a field of this name.
    let fields: Vec<&Field> = FIELDS.iter().filter(|field| field.path == base).collect();
    let Some(field) = fields.first() else {
        return Err(no_such_field(path));
    };
    if text.span(path).is_some() {
        return text.replace(path, value);
    }
    if base != path {
        return Err("there is no such element".into());
    }
    if value == "None" && fields.iter().any(|field| field.default == "None") {
        return Ok(text.clone());
    }
    let variant = text.variant(field.parent());
    if field.variant.is_some() && !fields.iter().any(|field| field.variant == variant) {
        return Err(wrong_variant(field.parent(), variant, &fields));
    }
    let edited = insert(text, field, value)?;
    // The value is read back, because `value` may contain a bracket that closes the new group too
    // early.
    if edited.written(path) == Some(value) {
        Ok(edited)
    } else {
        Err(NOT_ONE_VALUE.into())
    }
}

/// Sets a value of one sphere of a form, and returns the new text.
fn set_of_sphere(text: &Text, path: &str, value: &str) -> Result<Text, String> {
    if text.span(path).is_some() {
        return text.replace(path, value);
    }
    let variant = text.variant("form");
    if variant != SPHERE_FIELDS[0].variant {
        return Err(wrong_variant("form", variant, &SPHERE_FIELDS));
    }
    let (sphere, name) = path.rsplit_once('.').unwrap_or(("form", path));
    if text.span(sphere).is_none() {
        return Err("there is no such sphere".into());
    }
    let order = SPHERE_FIELDS.map(Field::last);
    let edited = text.insert(sphere, name, value, &order)?;
    if edited.written(path) == Some(value) {
        Ok(edited)
    } else {
        Err(NOT_ONE_VALUE.into())
    }
}

/// Returns the path of the list or pair, if the path leads to one of its elements; otherwise
/// returns the path unchanged.
fn without_positions(path: &str) -> &str {
    let mut base = path;
    while let Some((before, last)) = base.rsplit_once('.')
        && is_position(last)
    {
        base = before;
    }
    base
}

fn is_position(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit())
}

/// Inserts a field that the text does not have. If its group is missing too, the group is inserted
/// with the field.
fn insert(text: &Text, field: &Field, value: &str) -> Result<Text, String> {
    let parent = field.parent();
    let group = format!("({}: {value})", field.last());
    if text.span(parent).is_none() {
        if parent.is_empty() {
            return Err("the scene is not a group of fields".into());
        }
        return set(text, parent, &group);
    }
    if text.written(parent) == Some("None") {
        return text.replace(parent, &group);
    }
    let mut order = Vec::new();
    for sibling in FIELDS {
        if sibling.parent() == parent {
            order.push(sibling.last());
        }
    }
    text.insert(parent, field.last(), value, &order)
}

/// Returns an error message for a misspelt path. It names the field that the path probably means,
/// or else the fields that exist.
fn no_such_field(path: &str) -> String {
    let near = did_you_mean(path, FIELDS.iter().map(|field| field.path));
    if !near.is_empty() {
        return format!("no such field{near}");
    }
    let group = path.split('.').next().unwrap_or_default();
    let mut paths = paths_inside(group);
    if paths.is_empty() {
        paths = paths_inside("");
    }
    let paths: Vec<&str> = paths.into_iter().collect();
    format!("no such field (fields: {})", paths.join(", "))
}

/// Returns the paths of the fields directly inside a group, in alphabetical order.
fn paths_inside(group: &str) -> BTreeSet<&'static str> {
    FIELDS
        .iter()
        .filter(|field| field.parent() == group)
        .map(|field| field.path)
        .collect()
}

/// Returns an error message that names the choices that have this field.
fn wrong_variant(parent: &str, variant: Option<&str>, fields: &[&Field]) -> String {
    let Some(Range::Choice(choices)) = field(parent, None).map(|field| field.range) else {
        return format!("{parent} has no such field");
    };
    let mut possible = Vec::new();
    for choice in choices {
        let name = Some(choice_name(choice));
        if fields.iter().any(|field| field.variant == name) {
            possible.push(format!("{parent}={choice}"));
        }
    }
    let possible = possible.join(" or ");
    match variant {
        None | Some("None") => format!("there is no {parent}: set {possible}"),
        Some(variant) => {
            let first = SPHERE_FIELDS[0];
            let list = if Some(variant) == first.variant {
                format!(" (its first sphere has {})", first.path)
            } else {
                String::new()
            };
            format!("{parent} is {variant}, which has no such field{list}: set {possible}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"(
    version: 1,
    // Its parts.
    material: (modulus: 1.0e6), // soft
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

    fn set_text(text: &str, path: &str, value: &str) -> Result<String, String> {
        set(&Text::new(text).unwrap(), path, value).map(|text| text.as_str().to_owned())
    }

    fn changed(path: &str, value: &str, from: &str, to: &str) {
        assert_eq!(SCENE.matches(from).count(), 1, "{from}");
        assert_eq!(
            set_text(SCENE, path, value).unwrap(),
            SCENE.replace(from, to),
            "{path}={value}"
        );
    }

    #[test]
    fn values_are_exchanged_in_their_place() {
        changed("length", " 2.0e-4 ", "1.0e-4,", "2.0e-4,");
        changed("roughness.hurst", "0.5", "hurst: 0.7", "hurst: 0.5");
        changed("roughness.modes", "(2, 4)", "(1, 512)", "(2, 4)");
        changed("roughness.modes.1", "4", "(1, 512)", "(1, 4)");
        changed("observe", "[Patches]", "[]", "[Patches]");
        let rough = "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)";
        changed("roughness", "None", rough, "None");
    }

    #[test]
    fn missing_fields_are_inserted_where_the_table_has_them() {
        let after_length = "as it is */\n";
        let line = |line: &str| format!("{after_length}    {line}\n");
        changed(
            "form",
            "Cone(angle: 0.1)",
            after_length,
            &line("form: Cone(angle: 0.1),"),
        );
        changed(
            "title",
            "\"A\"",
            "version: 1,\n",
            "version: 1,\n    title: \"A\",\n",
        );
        changed(
            "material.poisson_ratio",
            "0.5",
            "1.0e6)",
            "1.0e6, poisson_ratio: 0.5)",
        );
        changed(
            "roughness.rms_gradient",
            "0.1",
            "1.0e-7,",
            "1.0e-7, rms_gradient: 0.1,",
        );
        changed(
            "numerics.solver",
            "Exact",
            "// enough\n",
            "// enough\n        solver: Exact,\n",
        );
        changed(
            "numerics.edges",
            "Grid",
            "// enough\n",
            "// enough\n        edges: Grid,\n",
        );
        let rough = "seed: 1),\n";
        changed(
            "adhesion.work",
            "0.1",
            rough,
            &format!("{rough}    adhesion: (work: 0.1),\n"),
        );
    }

    #[test]
    fn the_last_entry_keeps_its_comment_and_its_lack_of_a_comma() {
        let text = "(\n    version: 1,\n    length: 1.0 // last\n)\n";
        let new = "(\n    version: 1,\n    length: 1.0, // last\n    observe: []\n)\n";
        assert_eq!(set_text(text, "observe", "[]").unwrap(), new);
        let text = "(\r\n\tversion: 1,\r\n\tlength: 1.0\r\n)\r\n";
        let new = "(\r\n\tversion: 1,\r\n\tlength: 1.0,\r\n\tobserve: []\r\n)\r\n";
        assert_eq!(set_text(text, "observe", "[]").unwrap(), new);
    }

    #[test]
    fn one_line_stays_one_line() {
        for (text, path, value, new) in [
            (
                "(length: 1.0)",
                "observe",
                "[]",
                "(length: 1.0, observe: [])",
            ),
            (
                "(length: 1.0,)",
                "observe",
                "[]",
                "(length: 1.0, observe: [],)",
            ),
            (
                "(length: 1.0 /* c */)",
                "observe",
                "[]",
                "(length: 1.0, observe: [] /* c */)",
            ),
            (
                "(observe: [])",
                "length",
                "1.0",
                "(observe: [], length: 1.0)",
            ),
            ("()", "adhesion.work", "0.1", "(adhesion: (work: 0.1))"),
            (
                "(adhesion: None)",
                "adhesion.work",
                "0.1",
                "(adhesion: (work: 0.1))",
            ),
            (
                "(adhesion: ())",
                "adhesion.work",
                "0.1",
                "(adhesion: (work: 0.1))",
            ),
            ("( // c\n)", "length", "1.0", "(length: 1.0 // c\n)"),
            (
                "S(form: Some(Cone(angle: 1.0)))",
                "form.angle",
                "0.1",
                "S(form: Some(Cone(angle: 0.1)))",
            ),
        ] {
            assert_eq!(
                set_text(text, path, value).as_deref(),
                Ok(new),
                "{text} {path}"
            );
        }
    }

    #[test]
    fn a_value_is_one_value_and_stays_in_its_place() {
        let values = "|1.0), title: (\"x\"|1 // |1 /* |1 /* a */|/* a */ 1|// a\n1|1.0, title: \"x\"|1.0 title|title: 1.0\
                      |\"a|\"a\" \"b\"|r#\"a\"|'|(|)|[1)|,|:|1,|(1) (2)|#![enable(unwrap_newtypes)] 1";
        for value in values.split('|') {
            assert!(set_text(SCENE, "length", value).is_err(), "{value}");
            assert!(set_text(SCENE, "adhesion.work", value).is_err(), "{value}");
        }
    }

    #[test]
    fn refusals_say_what_to_do() {
        for (path, said) in [
            ("roughness.hurts", "did you mean roughness.hurst?"),
            ("hurst", "did you mean roughness.hurst?"),
            ("nothing", "no such field (fields: adhesion, form, length, "),
            (
                "adhesion.nothing",
                "no such field (fields: adhesion.closing_work, ",
            ),
            ("", "no such field"),
            ("loading.", "no such field"),
            ("..", "no such field"),
            ("roughness..hurst", "no such field"),
            (
                "form.radius",
                "there is no form: set form=Paraboloid(radius: 1.0e-3) or form=WavySphere(",
            ),
            (
                "roughness.file",
                "roughness is SelfAffine, which has no such field: set roughness=Measured(",
            ),
            (
                "numerics.solver.step",
                "set numerics.solver=Stepwise(step: 1.0e-9)",
            ),
            ("loading.0", "no such element"),
            ("roughness.modes.2", "no such element"),
            ("version.0", "no such element"),
        ] {
            let message = set_text(SCENE, path, "1").unwrap_err();
            assert!(message.contains(said), "{path}: {message}");
        }
        let without = SCENE.replace("observe: []", "form: None");
        let message = set_text(&without, "form.radius", "1").unwrap_err();
        assert!(message.contains("there is no form: set "), "{message}");
    }
}
