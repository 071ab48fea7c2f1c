//! Differences between two scenes, by technical names.

use super::document::Document;
use super::field::Field;
use super::fields::field;
use super::quantity::format_quantity;

/// A field with different values in two scenes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Symbol of the field, or its name if it has no symbol.
    pub name: String,
    /// Value in the first scene, with its unit.
    pub from: String,
    /// Value in the second scene; `…` if the second scene has other fields instead.
    pub to: String,
}

impl Document {
    /// The fields, other than texts, with different values in this scene and another one.
    #[must_use]
    pub fn changes_to(&self, other: &Document) -> Vec<Change> {
        let [this, other] = [self, other].map(with_stated_use);
        let theirs = other.overrides_from(&this);
        let is_text = |path: &str| ["title", "notice", "version"].contains(&path);
        let change = |(path, value): &(String, String)| {
            let (name, known) = name_of(path, &this);
            let read = |value: &str| match (value.parse::<f64>(), known) {
                (Ok(number), Some(field)) => format_quantity(number, field.unit),
                _ => value.split_whitespace().collect::<Vec<_>>().join(" "),
            };
            let to = theirs.iter().find(|(their, _)| their == path);
            Change {
                name,
                from: read(value),
                to: to.map_or_else(|| "…".to_owned(), |(_, value)| read(value)),
            }
        };
        let mine = this.overrides_from(&other);
        mine.iter().filter(|(path, _)| !is_text(path)).map(change).collect()
    }
}

/// The document with an explicit use of its measured profile as the line, which is mostly omitted.
fn with_stated_use(document: &Document) -> Document {
    let use_as_line = document.scene().measured_as_line().to_string();
    let is_measured = !document.scene().measured_files().is_empty();
    let stated = is_measured.then(|| document.set("roughness.as_line", &use_as_line).ok()).flatten();
    stated.unwrap_or_else(|| document.clone())
}

/// Technical name of a path, and its field if it has one.
fn name_of(path: &str, scene: &Document) -> (String, Option<&'static Field>) {
    let symbol = |field: &'static Field| if field.symbol.is_empty() { field.name } else { field.symbol };
    let mut parts = path.strip_prefix("loading.").unwrap_or_default().split('.');
    if let Some(index) = parts.next().and_then(|index| index.parse::<usize>().ok()) {
        let leg = parts.next().and(scene.scene().loading.get(index));
        let target = leg.and_then(|leg| leg.field()).map(|(field, _)| field);
        let symbol = target.map(|field| format!(" {}", symbol(field))).unwrap_or_default();
        return (format!("leg {}{symbol}", index + 1), target);
    }
    let known = field(path, None);
    (known.map_or(path, symbol).to_owned(), known)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    fn changes(from: &Document, to: &Document) -> Vec<String> {
        let text = |change: Change| format!("{} {} → {}", change.name, change.from, change.to);
        from.changes_to(to).into_iter().map(text).collect()
    }

    #[test]
    fn changes_name_fields_with_both_values() {
        let scene = open("pressure-sensitive").unwrap();
        assert_eq!(changes(&scene, &scene), Vec::<String>::new());
        let other = scene.set("roughness.hurst", "0.5").unwrap().set("title", "\"other\"").unwrap();
        assert_eq!(changes(&scene, &other), ["H 0.7 → 0.5"]);
        assert_eq!(changes(&other, &scene), ["H 0.5 → 0.7"]);
        let other = scene.set("loading.0.0", "2e-5").unwrap();
        assert_eq!(changes(&scene, &other), ["leg 1 F 10 µN → 20 µN"]);
        let text = "(version: 2, material: (effective_modulus: 1.0e6), length: 1.0e-4, roughness: Measured(file: \"a\"))";
        let line = Document::parse(text, "test").unwrap();
        let profile = line.set("roughness.as_line", "true").unwrap();
        assert_eq!(changes(&line, &profile), ["profile as line false → true"]);
        assert_eq!(changes(&line, &line), Vec::<String>::new());
        let other = scene.set("material", "(effective_modulus: 3e6)").unwrap();
        assert_eq!(changes(&scene, &other).len(), 1, "{:?}", changes(&scene, &other));
    }
}
