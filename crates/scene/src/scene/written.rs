//! Values of a scene as text in RON, and the fields that differ between two scenes.

use super::field::Field;
use super::fields::{field, fields_inside};
use super::model::{Observer, Scene};
use super::slot::Value;
use super::spheres::spheres_in_ron;
use super::stages::stages_in_ron;
use super::text::{real_in_ron, ron_string};

impl Field {
    /// Returns the value of this field. Returns `None` if the scene does not state the value or has
    /// another choice, such as another form.
    pub(super) fn value<'s>(&self, scene: &'s Scene) -> Option<Value<'s>> {
        (self.place.slot)(scene)?.value()
    }

    /// Returns true if the scene has the group and the choice to which this field belongs. The
    /// scene need not state the value of the field.
    pub(super) fn is_in(&self, scene: &Scene) -> bool {
        if self.parent().is_empty() {
            return true;
        }
        let group = field(self.parent(), None).and_then(|group| group.value(scene));
        let Some(group) = group else {
            return false;
        };
        self.variant.is_none() || self.variant == group.choice()
    }

    /// Returns the fields inside this field. For a choice, these are the fields of the selected
    /// choice.
    pub(super) fn inside(&self, scene: &Scene) -> Vec<&'static Field> {
        match self.value(scene) {
            Some(Value::Choice(name)) => fields_inside(self.path, Some(name)).collect(),
            Some(Value::Group) => fields_inside(self.path, None).collect(),
            _ => Vec::new(),
        }
    }

    /// Returns the default of this field in RON, which is its value if the scene does not state the
    /// field. The text is empty if the field is required.
    pub(super) fn default_in(&self, scene: &Scene) -> &'static str {
        if self.path == "numerics.edges" {
            scene.numerics.solver.usual_edges().name()
        } else {
            self.default
        }
    }

    /// Returns the value of this field in RON, or its default if the scene does not state the
    /// value. Returns `None` if the scene has another choice, such as another form.
    pub(super) fn written(&self, scene: &Scene) -> Option<String> {
        let Some(value) = self.value(scene) else {
            return self.is_in(scene).then(|| self.default_in(scene).to_owned());
        };
        Some(match value {
            Value::Real(number) => real_in_ron(number),
            Value::Whole(number) => number.to_string(),
            Value::Flag(flag) => flag.to_string(),
            Value::Text(text) => ron_string(text),
            Value::Texts(texts) => list(texts.iter().map(|text| ron_string(text))),
            Value::Modes(first, last) => format!("({first}, {last})"),
            Value::Wavelengths(longest, shortest) => {
                format!("({}, {})", real_in_ron(longest), real_in_ron(shortest))
            }
            Value::Choice(name) => {
                let inside = self.inside(scene);
                if inside.is_empty() {
                    name.to_owned()
                } else {
                    format!("{name}({})", entries(scene, &inside).join(", "))
                }
            }
            Value::Group => format!("({})", entries(scene, &self.inside(scene)).join(", ")),
            Value::Stages(stages) => stages_in_ron(stages),
            Value::Spheres(spheres) => spheres_in_ron(spheres),
            Value::Observers(observers) => list(observers.iter().map(observer_in_ron)),
        })
    }
}

fn observer_in_ron(observer: &Observer) -> String {
    let name: &'static str = observer.into();
    name.to_owned()
}

fn list(elements: impl Iterator<Item = String>) -> String {
    format!("[{}]", elements.collect::<Vec<_>>().join(", "))
}

/// Returns the fields that differ from their defaults, each as `name: value`.
fn entries(scene: &Scene, fields: &[&Field]) -> Vec<String> {
    let mut entries = Vec::new();
    for field in fields {
        if let Some(value) = field.written(scene)
            && value != field.default_in(scene)
        {
            entries.push(format!("{}: {value}", field.last()));
        }
    }
    entries
}

/// Writes a scene as RON text. Fields that have their default values are left out. A reader of the
/// text gets the same scene.
pub fn to_ron(scene: &Scene) -> String {
    let fields: Vec<&Field> = fields_inside("", None).collect();
    let mut text = "(\n".to_owned();
    for entry in entries(scene, &fields) {
        text += &format!("    {entry},\n");
    }
    text + ")\n"
}

/// Returns the fields that differ between two scenes. A group of fields is compared field by field
/// under two conditions: both scenes have the same choice for the group, and `splits` is true for
/// each field. Otherwise the whole group counts as one field. The arguments of `splits` are true if
/// the first and the second scene state the field.
pub(super) fn differing(
    first: &Scene,
    second: &Scene,
    splits: fn(bool, bool) -> bool,
) -> Vec<&'static Field> {
    let mut differing = Vec::new();
    for field in fields_inside("", None) {
        add_differing(field, first, second, splits, &mut differing);
    }
    differing
}

/// Adds the field `field` to the list of differing fields, if its values in the two scenes differ.
/// If the field is a group that is compared field by field, the fields inside the group are added
/// instead.
fn add_differing(
    field: &'static Field,
    first: &Scene,
    second: &Scene,
    splits: fn(bool, bool) -> bool,
    differing: &mut Vec<&'static Field>,
) {
    let first_text = field.written(first).unwrap_or_default();
    let second_text = field.written(second).unwrap_or_default();
    // If both scenes have the default, the field counts as equal, although the default may depend
    // on another field.
    let are_defaults =
        first_text == field.default_in(first) && second_text == field.default_in(second);
    if first_text == second_text || are_defaults {
        return;
    }
    let inside = field.inside(first);
    let is_split = !inside.is_empty()
        && inside == field.inside(second)
        && inside
            .iter()
            .all(|field| splits(is_stated(field, first), is_stated(field, second)));
    if !is_split {
        differing.push(field);
        return;
    }
    for field in inside {
        add_differing(field, first, second, splits, differing);
    }
}

/// Returns true if a scene states a value of this field, or if the field has a default other than
/// `None`.
fn is_stated(field: &Field, scene: &Scene) -> bool {
    field.value(scene).is_some() || !matches!(field.default, "" | "None")
}

#[cfg(test)]
mod tests {
    use super::super::document::Document;
    use super::super::errors::NumberError;
    use super::super::fields::FIELDS;
    use super::super::open::open;
    use super::super::range::Range;
    use super::*;

    fn sound() -> Scene {
        let rough = open("rough-sphere").unwrap();
        Scene::clone(rough.set("form", "None").unwrap().scene())
    }

    /// Creates scenes that together contain each choice of each group.
    fn scenes_of_all_choices() -> Vec<Scene> {
        let base = Document::from_scene(&sound(), "base").unwrap();
        let moving = base.set("loading_speed", "1.0e-6").unwrap();
        let moving = moving.set("numerics.edges", "SubCell").unwrap();
        let relaxing = moving.set("material.relaxation", "(share: 0.2, time: 10.0)");
        let mut scenes = vec![Scene::clone(relaxing.unwrap().scene())];
        for path in ["form", "roughness", "adhesion", "numerics.solver"] {
            let Some(Range::Choice(choices)) = field(path, None).map(|field| field.range) else {
                panic!("{path} is a choice")
            };
            for choice in choices {
                scenes.push(Scene::clone(base.set(path, choice).unwrap().scene()));
            }
        }
        scenes
    }

    #[test]
    fn each_number_is_a_value_of_its_own() {
        let is_number = |field: &&Field| matches!(field.range, Range::Real(..) | Range::Whole(..));
        let mut set = Vec::new();
        for before in scenes_of_all_choices() {
            for field in FIELDS
                .iter()
                .filter(is_number)
                .filter(|field| field.is_in(&before))
            {
                let mut scene = before.clone();
                // The new number may contradict another number of the scene.
                if let Err(error) = scene.set_number(field.path, 12_345.0) {
                    assert!(matches!(error, NumberError::Contradiction(_)), "{field:?}");
                    assert_eq!(scene, before, "{field:?}");
                    continue;
                }
                assert_eq!(scene.number(field.path), Some(12_345.0), "{field:?}");
                for other in FIELDS
                    .iter()
                    .filter(|other| *other != field && other.range.ends().is_some())
                {
                    assert_eq!(
                        other.value(&scene),
                        other.value(&before),
                        "{field:?} {other:?}"
                    );
                }
                set.push((field.path, field.variant));
            }
        }
        let is_missing =
            |field: &&Field| is_number(field) && !set.contains(&(field.path, field.variant));
        assert_eq!(FIELDS.iter().find(is_missing), None);
    }

    #[test]
    fn values_have_the_kinds_of_their_ranges() {
        for scene in scenes_of_all_choices() {
            for field in FIELDS {
                let Some(value) = field.value(&scene) else {
                    continue;
                };
                let is_of_range = match field.range {
                    Range::Real(..) => matches!(value, Value::Real(_)),
                    Range::Whole(..) => matches!(value, Value::Whole(_)),
                    Range::Band(..) => matches!(value, Value::Modes(..)),
                    Range::Wavelengths(..) => matches!(value, Value::Wavelengths(..)),
                    Range::Text { .. } => matches!(value, Value::Text(_)),
                    Range::Choice(_) => {
                        matches!(
                            value,
                            Value::Choice(_) | Value::Flag(_) | Value::Group | Value::Spheres(_)
                        )
                    }
                    Range::List { .. } => matches!(
                        value,
                        Value::Texts(_) | Value::Stages(_) | Value::Observers(_)
                    ),
                    Range::Group => value == Value::Group,
                };
                assert!(is_of_range, "{field:?} {value:?}");
            }
        }
    }
}
