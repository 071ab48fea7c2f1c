//! Names of kept loops: their differences from the present scene.

use crate::explorer::model::Model;
use crate::scene::{Document, Field, field, format_quantity};

/// Names the differences between each ghost and the present scene anew.
pub fn name_ghosts(model: &mut Model) {
    let document = &model.document;
    for ghost in &mut model.ghosts {
        ghost.differs = differences(&ghost.document, document);
    }
}

/// What a scene has that another has not: `κ 4, H 0.25`.
fn differences(scene: &Document, other: &Document) -> String {
    let told = |(path, value): &(String, String)| {
        if ["title", "notice", "version"].contains(&path.as_str()) {
            return None;
        }
        let (name, known) = name_of(path, scene);
        let value = match (value.parse::<f64>(), known) {
            (Ok(number), Some(field)) => format_quantity(number, field.unit),
            _ => value.split_whitespace().collect::<Vec<_>>().join(" "),
        };
        Some(format!("{name} {value}"))
    };
    let told: Vec<String> = scene.overrides_from(other).iter().filter_map(told).collect();
    if told.is_empty() { "the same scene".to_owned() } else { told.join(", ") }
}

/// What a path is called, in the terms of the field, and its field where it has one.
fn name_of(path: &str, scene: &Document) -> (String, Option<&'static Field>) {
    let symbol = |field: &'static Field| if field.symbol.is_empty() { field.name } else { field.symbol };
    let mut parts = path.strip_prefix("loading.").unwrap_or_default().split('.');
    if let Some(index) = parts.next().and_then(|index| index.parse::<usize>().ok()) {
        let leg = parts.next().and(scene.scene().loading.get(index));
        let target = leg.and_then(|leg| leg.target()).map(|(field, _)| field);
        let symbol = target.map(|field| format!(" {}", symbol(field))).unwrap_or_default();
        return (format!("leg {}{symbol}", index + 1), target);
    }
    let known = field(path, None);
    (known.map_or(path, symbol).to_owned(), known)
}
