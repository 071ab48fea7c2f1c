//! Loops kept beside the present one.

use super::{Effect, edit};
use crate::explorer::action::Command;
use crate::explorer::model::{Ghost, Model, Notice};
use crate::scene::{Document, Field, field, format_quantity};
use std::sync::Arc;

/// Ghosts that are kept; more could not be told apart.
const MOST_GHOSTS: usize = 8;

/// Obeys a command on ghosts.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::Pin => pin(model),
        Command::Swap => return swap(model),
        _ => model.ghosts.clear(),
    }
    Vec::new()
}

fn ghost(model: &Model) -> Option<Ghost> {
    let computed = model.computed.as_ref().filter(|_| model.is_current())?;
    Some(Ghost { document: model.document.clone(), computed: Arc::clone(computed), differs: String::new() })
}

fn pin(model: &mut Model) {
    let Some(ghost) = ghost(model) else {
        model.notice = Some(Notice::Error("there is no curve yet to keep".to_owned()));
        return;
    };
    if model.ghosts.iter().any(|kept| kept.document.scene() == ghost.document.scene()) {
        model.notice = Some(Notice::Done("this loop is kept already".to_owned()));
        return;
    }
    if model.ghosts.len() == MOST_GHOSTS {
        model.ghosts.remove(0);
    }
    model.ghosts.push(ghost);
    name_ghosts(model);
    model.notice = Some(Notice::Done("kept; now change something, x exchanges the two".to_owned()));
}

/// The scene and the newest ghost change places.
fn swap(model: &mut Model) -> Vec<Effect> {
    let Some(present) = ghost(model) else { return Vec::new() };
    let Some(last) = model.ghosts.pop() else {
        model.notice = Some(Notice::Error("nothing to exchange with: c keeps a loop".to_owned()));
        return Vec::new();
    };
    model.ghosts.push(present);
    edit::adopt(model, last.document)
}

/// Says anew where the ghosts differ from the present scene.
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
