//! Differences between two scenes as text for users.

use super::document::Document;
use super::field::{Field, choice_in_words, sphere_values, target_field};
use super::model::Scene;
use super::range::Range;
use super::slot::Value;
use super::stages::loading_text;
use super::written::differing;
use asperity_contact::Move;
use asperity_data::format_quantity;
use asperity_surface::Sphere;
use std::fmt;

/// Difference between two scenes: a field whose values differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Symbol of the field that differs, or its name in words if it has no symbol.
    pub name: String,
    /// Value of the field in the first of the two scenes, as text with its unit.
    pub from: String,
    /// Value of the field in the second of the two scenes, as text with its unit.
    pub to: String,
}

impl fmt::Display for Change {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} {} → {}", self.name, self.from, self.to)
    }
}

fn symbol_or_name(field: &Field) -> &'static str {
    if field.symbol.is_empty() {
        field.name
    } else {
        field.symbol
    }
}

/// Returns a value as text for users: a single value with its unit, such as `50 mJ/m²`, or the name
/// of a choice, such as `sub-cell` or `none`.
fn value_in_words(field: &Field, value: &str) -> String {
    if ["None", "[]"].contains(&value) {
        return "none".to_owned();
    }
    match field.range {
        Range::Choice(_) => choice_in_words(value),
        Range::Band(..) => value.trim_matches(['(', ')']).replace(", ", " to "),
        _ => match field.quantities(value, format_quantity) {
            Some(quantities) => quantities,
            None => value.split_whitespace().collect::<Vec<_>>().join(" "),
        },
    }
}

/// Returns the value of a field as text for users. For a group of fields, the text is the name of
/// its choice with those values that the scene states: `self-affine (H 0.7, h 200 nm)`, `γ 50
/// mJ/m²`.
fn in_words(scene: &Scene, field: &Field) -> String {
    if let Some(Value::Spheres(spheres)) = field.value(scene) {
        return spheres_in_words(spheres);
    }
    let value = field.written(scene).unwrap_or_default();
    let inside = field.inside(scene);
    if inside.is_empty() {
        return value_in_words(field, &value);
    }
    let mut given = Vec::new();
    for field in inside {
        if field.value(scene).is_some() {
            given.push(format!(
                "{} {}",
                symbol_or_name(field),
                in_words(scene, field)
            ));
        }
    }
    let given = given.join(", ");
    let choice = choice_in_words(value.split('(').next().unwrap_or_default());
    if choice.is_empty() {
        given
    } else if given.is_empty() {
        choice
    } else {
        format!("{choice} ({given})")
    }
}

/// Returns the spheres of a form as text for users: `spheres (R 5.4 µm; R 3.2 µm, b 200 nm)`.
fn spheres_in_words(spheres: &[Sphere]) -> String {
    let mut words = Vec::new();
    for sphere in spheres {
        let mut values = Vec::new();
        for (field, value) in sphere_values(*sphere) {
            if value != 0.0 {
                let quantity = format_quantity(value, field.unit);
                values.push(format!("{} {quantity}", field.symbol));
            }
        }
        words.push(values.join(", "));
    }
    format!("spheres ({})", words.join("; "))
}

impl Document {
    /// Lists the fields whose values differ between this scene and `other`. Title, notes and
    /// version are left out. If the scenes have different choices for a group of fields, such as a
    /// cone and a sphere as the form, the list has one entry for the whole group.
    ///
    /// ```
    /// let sphere = asperity_scene::open("jkr-sphere")?;
    /// let changes = sphere.changes_to(&sphere.set("length", "200 µm")?);
    /// assert_eq!(changes[0].to_string(), "L 100 µm → 200 µm");
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn changes_to(&self, other: &Document) -> Vec<Change> {
        let (here, there): (&Scene, &Scene) = (self.scene(), other.scene());
        let mut changes = Vec::new();
        for field in differing(here, there, |is_here, is_there| is_here == is_there) {
            match field.path {
                "title" | "notice" | "version" => {}
                "loading" => changes.extend(changed_stages(&here.loading, &there.loading)),
                _ => changes.push(Change {
                    name: symbol_or_name(field).to_owned(),
                    from: in_words(here, field),
                    to: in_words(there, field),
                }),
            }
        }
        changes
    }
}

/// Returns the stages that differ between two loadings. If the numbers of stages differ, or if the
/// list of changes would be longer than the loading, returns both loadings as one change.
fn changed_stages(before: &[Move], after: &[Move]) -> Vec<Change> {
    let mut changes = Vec::new();
    for (index, (from, to)) in before.iter().zip(after).enumerate() {
        if from != to {
            changes.push(change_of_stage(index, *from, *to));
        }
    }
    let from = loading_text(before, format_quantity);
    let to = loading_text(after, format_quantity);
    // In a list of changes, each change takes the space of its value and of about fourteen further
    // characters.
    let length: usize = changes.iter().map(|change| 14 + change.from.len()).sum();
    if before.len() == after.len() && length < 14 + from.len() {
        return changes;
    }
    vec![Change {
        name: "loading".to_owned(),
        from,
        to,
    }]
}

fn change_of_stage(index: usize, from: Move, to: Move) -> Change {
    let symbol = match (target_field(from), target_field(to)) {
        (Some((field, _)), Some((same, _))) if field == same => format!(" {}", field.symbol),
        _ => String::new(),
    };
    Change {
        name: format!("stage {}{symbol}", index + 1),
        from: loading_text(&[from], format_quantity),
        to: loading_text(&[to], format_quantity),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open::open;

    fn changes(from: &Document, to: &Document) -> Vec<String> {
        from.changes_to(to).iter().map(Change::to_string).collect()
    }

    #[test]
    fn changes_name_fields_with_both_values() {
        let scene = open("pressure-sensitive").unwrap();
        assert_eq!(changes(&scene, &scene), Vec::<String>::new());
        let other = scene
            .set("roughness.hurst", "0.5")
            .unwrap()
            .set("title", "\"other\"")
            .unwrap();
        assert_eq!(changes(&scene, &other), ["H 0.7 → 0.5"]);
        assert_eq!(changes(&other, &scene), ["H 0.5 → 0.7"]);
        let other = scene.set("roughness.seed", "12345678901").unwrap();
        assert_eq!(changes(&scene, &other), ["seed 5 → 12345678901"]);
        let other = scene.set("loading.0.0", "2e-5").unwrap();
        assert_eq!(changes(&scene, &other), ["stage 1 F 10 µN → 20 µN"]);
        let other = scene.set("loading", "5 µN").unwrap();
        assert_eq!(
            changes(&scene, &other),
            ["loading 10 µN, separation → 5 µN"]
        );
        let text = "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4, roughness: Measured(file: \"a\"))";
        let line = Document::parse(text, "test").unwrap();
        let profile = line.set("roughness.as_line", "true").unwrap();
        assert_eq!(changes(&line, &profile), ["profile as line false → true"]);
        assert_eq!(changes(&line, &line), Vec::<String>::new());
        let other = scene.set("material", "(modulus: 3e6)").unwrap();
        assert_eq!(
            changes(&scene, &other),
            ["material E 2 MPa, ν 0.5 → E* 3 MPa"]
        );
        let other = scene.set("adhesion", "(work: 0.03)").unwrap();
        assert_eq!(changes(&scene, &other), ["adhesion κ 6 → γ 30 mJ/m²"]);
        let other = scene.set("form", "Paraboloid(radius: 1e-3)").unwrap();
        assert_eq!(changes(&scene, &other), ["form none → paraboloid (R 1 mm)"]);
        let smooth = scene.set_all(
            &[("roughness", "None"), ("adhesion", "None")]
                .map(|(path, value)| (path.into(), value.into())),
        );
        let rough = "roughness none → self-affine (H 0.7, h 200 nm, k 4 to 512, seed 5)";
        assert_eq!(
            changes(&smooth.unwrap(), &scene),
            [rough, "adhesion none → κ 6"]
        );
        let other = scene.set("numerics.edges", "Grid").unwrap();
        assert_eq!(changes(&scene, &other), ["edges sub-cell → grid"]);
    }
}
