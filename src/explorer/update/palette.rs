//! The list of all commands, and the one that is chosen from it.

use super::{Effect, edit_line, explore, show};
use crate::explorer::action::Command;
use crate::explorer::finder::Finder;
use crate::explorer::mode::{Mode, ModeKind};
use crate::explorer::model::{Model, Pane};
use crate::explorer::palette::{Entry, entries};

/// Opens the list.
pub fn open(model: &mut Model) -> Vec<Effect> {
    model.mode = Mode::Palette(Finder::new(entries(&model.bindings).len()));
    Vec::new()
}

/// Finds what fits the query as it is now.
pub fn search(model: &mut Model) -> Vec<Effect> {
    if let Mode::Palette(finder) = &mut model.mode {
        finder.search(entries(&model.bindings).iter().map(Entry::candidate));
    }
    Vec::new()
}

/// Obeys a command while the list is open.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    let Mode::Palette(finder) = &mut model.mode else { return Vec::new() };
    match command {
        Command::Select(rows) => finder.select(rows),
        Command::Accept => {
            let chosen = finder.choice().and_then(|index| entries(&model.bindings).into_iter().nth(index));
            return chosen.map_or_else(Vec::new, |entry| run(model, &entry));
        }
        Command::Delete { .. } | Command::Clear => {
            edit_line(model, command);
            return search(model);
        }
        _ => edit_line(model, command),
    }
    Vec::new()
}

/// Runs a command, in the pane where its key is valid.
fn run(model: &mut Model, entry: &Entry) -> Vec<Effect> {
    model.mode = Mode::Explore;
    let mut effects = match model.keys() {
        here if entry.modes.contains(&here) => Vec::new(),
        _ if entry.modes.contains(&ModeKind::Chart) => show::choose(model, Pane::Chart),
        _ => show::choose(model, Pane::Parameters),
    };
    effects.extend(explore(model, entry.command));
    effects
}
