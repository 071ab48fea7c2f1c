//! Search of the list of parameters by letters of a name or symbol.

use super::{Effect, edit, edit_line, show};
use crate::explorer::action::Command;
use crate::explorer::finder::Finder;
use crate::explorer::mode::Mode;
use crate::explorer::model::{Model, Pane};
use crate::explorer::parameters::Parameter;

/// Begins the search, in the pane of parameters.
pub fn open(model: &mut Model) -> Vec<Effect> {
    model.mode = Mode::Find(Finder::new(model.parameters.len()));
    model.pane_before = model.pane;
    edit::show_parameters(model)
}

/// Finds what fits the query as it is now.
pub fn search(model: &mut Model) -> Vec<Effect> {
    if let Mode::Find(finder) = &mut model.mode {
        finder.search(model.parameters.iter().map(Parameter::candidate));
    }
    Vec::new()
}

/// Obeys a command during the search.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    let Mode::Find(finder) = &mut model.mode else { return Vec::new() };
    match command {
        Command::Select(rows) => finder.select(rows),
        Command::Accept => {
            let Some(found) = finder.choice() else { return Vec::new() };
            model.mode = Mode::Explore;
            edit::select(model, found);
            return show::choose(model, Pane::Parameters);
        }
        Command::Delete { .. } | Command::Clear => {
            edit_line(model, command);
            return search(model);
        }
        _ => edit_line(model, command),
    }
    if model.mode == Mode::Explore {
        model.pane = model.pane_before;
        return vec![Effect::Show];
    }
    Vec::new()
}
