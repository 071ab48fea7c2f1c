//! Values that define a scene, in the order of the table of fields.

use super::field::Field;
use super::fields::fields_inside;
use super::model::Scene;
use super::range::Range;
use super::stages::loading_text;
use super::text::index::is_within;
use asperity_data::{exact_quantity, grouped};

/// Paths of fields on which the solution does not depend.
const DESCRIPTIONS: [&str; 5] = ["version", "title", "notice", "observe", "numerics.samples"];

/// Returns true if the solution does not depend on the value at a path.
pub(super) fn describes(path: &str) -> bool {
    DESCRIPTIONS
        .iter()
        .any(|description| is_within(path, description))
}

/// A field of a scene and its value as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Field of the scene to which `value` belongs.
    pub field: &'static Field,
    /// Value of the field with its unit and all its digits.
    pub value: String,
}

/// Lists the values on which the solution of a scene depends. The list has each number, and those
/// choices and names that differ from their defaults.
///
/// ```
/// use asperity_scene::open;
/// use asperity_scene::fields::statements;
///
/// let stated = statements(open("jkr-sphere")?.scene());
/// let length = stated.iter().find(|one| one.field.path == "length").unwrap();
/// assert_eq!(length.value, "100 µm");
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn statements(scene: &Scene) -> Vec<Statement> {
    let mut found = Vec::new();
    for field in fields_inside("", None) {
        add(field, scene, &mut found);
    }
    found
}

/// Adds the statement of a field. For a group, adds the statements of the fields inside it.
fn add(field: &'static Field, scene: &Scene, found: &mut Vec<Statement>) {
    let inside = field.inside(scene);
    if !inside.is_empty() {
        for field in inside {
            add(field, scene, found);
        }
        return;
    }
    if field.value(scene).is_none() || DESCRIPTIONS.contains(&field.path) {
        return;
    }
    let written = field.written(scene).unwrap_or_default();
    let is_number = matches!(
        field.range,
        Range::Real(..) | Range::Whole(..) | Range::Band(..) | Range::Wavelengths(..)
    );
    if !is_number && written == field.default_in(scene) {
        return;
    }
    let value = value_with_unit(field, scene, written);
    found.push(Statement { field, value });
}

/// Converts a value in RON to text for users.
fn value_with_unit(field: &Field, scene: &Scene, written: String) -> String {
    match field.range {
        Range::Band(..) => written.trim_matches(['(', ')']).replace(", ", " to "),
        Range::Whole(..) if !field.symbol.is_empty() => written.parse().map_or(written, grouped),
        Range::List { .. } if field.path == "loading" => {
            loading_text(&scene.loading, exact_quantity)
        }
        _ => field
            .quantities(&written, exact_quantity)
            .unwrap_or(written),
    }
}
