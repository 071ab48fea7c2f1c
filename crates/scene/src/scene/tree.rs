//! A scene as a tree of values, which are read, set and written by the paths of the table of
//! fields.

use serde::Serialize;
use serde_json::{Map, Value};

use super::field::Field;
use super::fields::{FIELDS, fields_inside};
use super::model::Scene;
use super::range::Range;
use super::text::{ron_float, ron_string};

/// Values of a scene, which are read and set by the paths of fields.
///
/// ```
/// use asperity_scene::fields::Tree;
/// use asperity_scene::open;
///
/// let mut tree = Tree::of(open("jkr-sphere")?.scene());
/// assert!(tree.set("length", 2.0e-4) && !tree.set("width", 1.0));
/// assert_eq!(tree.get("length"), Some(2.0e-4));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tree(Value);

impl Tree {
    /// Returns the values of a scene.
    pub fn of(scene: &Scene) -> Tree {
        Tree(serde_json::to_value(scene).unwrap_or_default())
    }

    /// Returns the scene with these values.
    ///
    /// # Errors
    /// Returns an error if fields contradict each other.
    pub fn scene(self) -> Result<Scene, String> {
        serde_json::from_value(self.0).map_err(|error| error.to_string())
    }

    /// Returns the number at a path, such as `form.radius`, `roughness.modes.0` or `loading.1.0`;
    /// `None` if there is no number.
    pub fn get(&self, path: &str) -> Option<f64> {
        self.at(path)?.as_f64()
    }

    /// Sets the number at a path without checking its range. A number that the scene omits is
    /// added. Returns false, with the tree unchanged, if the scene can have no number at this path.
    pub fn set(&mut self, path: &str, value: f64) -> bool {
        let is_adhesion =
            |field: &Field| field.parent() == "adhesion" && self.0["adhesion"].is_null();
        let row = FIELDS
            .iter()
            .find(|row| row.path == path && (self.has(row) || is_adhesion(row)));
        let is_whole = match (self.at(path), row.map(|row| row.range)) {
            (Some(Value::Number(present)), _) => present.is_u64(),
            (Some(Value::Null) | None, Some(Range::Real(..))) => false,
            (None, Some(Range::Whole(..))) => true,
            _ => return false,
        };
        let (parent, name) = path.rsplit_once('.').unwrap_or(("", path));
        let mut group = &mut self.0;
        for name in parent.split('.').filter(|name| !name.is_empty()) {
            group = match contents_mut(group) {
                Value::Array(list) => &mut list[name.parse::<usize>().unwrap_or_default()],
                group => &mut group[name],
            };
        }
        if group.is_null() {
            *group = Value::Object(Map::new());
        }
        let number = if is_whole {
            Value::from(value as u64)
        } else {
            Value::from(value)
        };
        match contents_mut(group) {
            Value::Array(list) => list[name.parse::<usize>().unwrap_or_default()] = number,
            Value::Object(group) => drop(group.insert(name.to_owned(), number)),
            target => *target = number,
        }
        true
    }

    /// Returns the value at a path, which has no names of variants.
    fn at(&self, path: &str) -> Option<&Value> {
        path.split('.')
            .try_fold(&self.0, |group, name| match contents(group) {
                Value::Object(group) => group.get(name),
                Value::Array(list) => list.get(name.parse::<usize>().ok()?),
                // The number of a loading stage.
                Value::Number(_) | Value::Null if group.is_object() && name == "0" => {
                    Some(contents(group))
                }
                _ => None,
            })
    }

    /// Returns true if a field belongs to the selected variants.
    pub(super) fn has(&self, field: &Field) -> bool {
        let group = if field.parent().is_empty() {
            Some(&self.0)
        } else {
            self.at(field.parent())
        };
        let is_of = |group: &Value| field.variant.is_none() || field.variant == variant(group);
        group.is_some_and(|group| !group.is_null() && is_of(group))
    }

    /// Returns the value of a field; `None` if it is omitted or belongs to a variant that is not
    /// selected. A number that is not finite is `null`.
    pub(super) fn value(&self, field: &Field) -> Option<&Value> {
        let is_given = |value: &&Value| !value.is_null() || matches!(field.range, Range::Real(..));
        self.at(field.path)
            .filter(is_given)
            .filter(|_| self.has(field))
    }

    /// Returns the fields inside a field, for its selected variant.
    pub(super) fn inside(&self, field: &Field) -> Vec<&'static Field> {
        let has_fields = matches!(field.range, Range::Choice(_) | Range::Group);
        let value = self.value(field).filter(|_| has_fields);
        value.map_or_else(Vec::new, |value| {
            fields_inside(field.path, variant(value)).collect()
        })
    }

    /// Returns the value of an omitted field in RON; empty if the field is required.
    pub(super) fn default(&self, field: &Field) -> &'static str {
        let is_stepwise =
            field.path == "numerics.edges" && self.at("numerics.solver.step").is_some();
        if is_stepwise { "Grid" } else { field.default }
    }

    /// Returns the value of a field in RON, or its default; `None` if it belongs to a variant that
    /// is not selected.
    pub(super) fn written(&self, field: &Field) -> Option<String> {
        let Some(value) = self.value(field) else {
            return self.has(field).then(|| self.default(field).into());
        };
        let quoted = |value: &Value| value.as_str().map_or_else(|| written(value), ron_string);
        Some(match (field.range, value) {
            (Range::Choice(_) | Range::Group, Value::Object(_)) => {
                let entries: Vec<String> = self.entries(&self.inside(field)).collect();
                format!(
                    "{}({})",
                    variant(value).unwrap_or_default(),
                    entries.join(", ")
                )
            }
            (Range::Band(..) | Range::Wavelengths(..), Value::Array(ends)) => {
                format!("({})", joined(ends, written))
            }
            (Range::Text { .. }, text) => quoted(text),
            (Range::List { .. }, Value::Array(list)) if field.parent() == "roughness" => {
                format!("[{}]", joined(list, quoted))
            }
            (_, value) => written(value),
        })
    }

    /// Returns the fields that differ from their defaults, as `name: value`.
    fn entries(&self, fields: &[&Field]) -> impl Iterator<Item = String> {
        fields.iter().filter_map(|field| {
            let value = self
                .written(field)
                .filter(|value| value != self.default(field))?;
            Some(format!("{}: {value}", field.last()))
        })
    }
}

/// Returns the fields that differ between two scenes. Fields of a group are compared one by one if
/// both scenes have the same variant and `splits` is true for each; otherwise the whole group
/// counts. `splits` gets whether each scene states the field.
pub(super) fn differing(trees: [&Tree; 2], splits: fn(bool, bool) -> bool) -> Vec<&'static Field> {
    let mut fields: Vec<&Field> = fields_inside("", None).collect();
    let mut found = Vec::new();
    fields.reverse();
    while let Some(field) = fields.pop() {
        let values = trees.map(|tree| tree.written(field).unwrap_or_default());
        // A field at its default in both is equal, though the default may depend on another field.
        let are_defaults = values
            .iter()
            .zip(trees)
            .all(|(value, tree)| value == tree.default(field));
        if values[0] == values[1] || are_defaults {
            continue;
        }
        let [inside, others] = trees.map(|tree| tree.inside(field));
        let has_default = |field: &Field| !["", "None"].contains(&field.default);
        let given =
            |field: &&Field| trees.map(|tree| tree.value(field).is_some() || has_default(field));
        if inside.is_empty()
            || inside != others
            || !inside.iter().map(given).all(|[a, b]| splits(a, b))
        {
            found.push(field);
        } else {
            fields.extend(inside.into_iter().rev());
        }
    }
    found
}

/// Writes a scene as RON text, without fields that have their default. The text reads back as the
/// same scene.
pub fn to_ron(scene: &Scene) -> String {
    let tree = Tree::of(scene);
    let fields: Vec<&Field> = fields_inside("", None).collect();
    let lines: String = tree
        .entries(&fields)
        .map(|entry| format!("    {entry},\n"))
        .collect();
    format!("(\n{lines})\n")
}

/// Returns a loading stage, or a list of stages or observers, in RON.
pub(super) fn in_ron(value: &impl Serialize) -> String {
    written(&serde_json::to_value(value).unwrap_or_default())
}

/// Returns a value without fields in RON: a number, a name, a loading stage, or a list of them.
pub(super) fn written(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_f64() => ron_float(number.as_f64().unwrap_or_default()),
        Value::String(name) => name.clone(),
        Value::Array(list) => format!("[{}]", joined(list, written)),
        Value::Object(_) => format!(
            "{}({})",
            variant(value).unwrap_or_default(),
            written(contents(value))
        ),
        Value::Null => "NaN".to_string(),
        other => other.to_string(),
    }
}

fn joined(list: &[Value], written: impl Fn(&Value) -> String) -> String {
    list.iter().map(written).collect::<Vec<_>>().join(", ")
}

/// Returns the name of the variant of a value, or `None` if it has no variants.
fn variant(value: &Value) -> Option<&str> {
    match value {
        Value::String(name) => Some(name),
        Value::Object(group) if group.len() == 1 => group
            .keys()
            .next()
            .map(String::as_str)
            .filter(|name| name.starts_with(char::is_uppercase)),
        _ => None,
    }
}

/// Returns the value without the name of its variant.
fn contents(value: &Value) -> &Value {
    match (value, variant(value)) {
        (Value::Object(group), Some(name)) => &group[name],
        _ => value,
    }
}

fn contents_mut(value: &mut Value) -> &mut Value {
    match variant(value).map(str::to_owned) {
        Some(name) if value.is_object() => &mut value[name],
        _ => value,
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::Document;
    use super::super::fields::field;
    use super::super::open::open;
    use super::*;

    fn sound() -> Scene {
        Scene::clone(
            open("rough-sphere")
                .unwrap()
                .set("form", "None")
                .unwrap()
                .scene(),
        )
    }

    fn scenes_of_all_variants() -> Vec<Scene> {
        let base = Document::from_scene(&sound(), "base").unwrap();
        let all = |path: &'static str| match field(path, None).map(|field| field.range) {
            Some(Range::Choice(of)) => of
                .iter()
                .map(|value| base.set(path, value).unwrap())
                .collect(),
            _ => Vec::new(),
        };
        let documents = ["form", "roughness", "numerics.solver"]
            .into_iter()
            .flat_map(all);
        documents
            .map(|document| Scene::clone(document.scene()))
            .collect()
    }

    #[test]
    fn each_number_is_a_value_of_its_own() {
        let is_number = |field: &&Field| matches!(field.range, Range::Real(..) | Range::Whole(..));
        let mut met = Vec::new();
        for scene in scenes_of_all_variants() {
            let before = Tree::of(&scene);
            for field in FIELDS
                .iter()
                .filter(is_number)
                .filter(|field| before.has(field))
            {
                let mut tree = before.clone();
                assert!(
                    tree.set(field.path, 12_345.0) && tree.get(field.path) == Some(12_345.0),
                    "{field:?}"
                );
                // Numbers may contradict each other.
                let read = tree.clone().scene();
                assert!(
                    read.is_err() || Tree::of(&read.unwrap()) == tree,
                    "{field:?}"
                );
                for other in FIELDS
                    .iter()
                    .filter(|other| *other != field && other.range.ends().is_some())
                {
                    assert_eq!(
                        tree.value(other),
                        before.value(other),
                        "{field:?} {other:?}"
                    );
                }
                met.push((field.path, field.variant));
            }
        }
        let unmet =
            |field: &&Field| is_number(field) && !met.contains(&(field.path, field.variant));
        assert_eq!(FIELDS.iter().find(unmet), None);
    }
}
