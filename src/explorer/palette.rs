//! The list of all commands, each with its key: the table of keys, by description.

use super::keys::{Binding, Bindings, Command};
use crate::scene::presets;

/// A command of the list.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Names of its keys.
    pub keys: Vec<String>,
    /// Description.
    pub help: String,
    /// The command.
    pub command: Command,
}

/// All commands of the explorer but those of texts and questions, in the order of the table.
#[must_use]
pub fn commands(bindings: &Bindings) -> Vec<Listed> {
    bindings.rows().filter(|binding| binding.row.is_listed()).flat_map(of_row).collect()
}

/// The command of a row; for the keys of built-in scenes one for each scene.
fn of_row(binding: &Binding) -> Vec<Listed> {
    let listed = |(key, help)| Listed { command: binding.command_of(key), keys: vec![key.name()], help };
    if binding.row.takes_character() {
        let help = presets().iter().map(|preset| format!("open the built-in scene {}", preset.name));
        return binding.keys.iter().zip(help).map(listed).collect();
    }
    let command = Command::of(binding.row);
    vec![Listed { keys: binding.names(), help: binding.row.help.to_owned(), command }]
}

impl Listed {
    /// Texts of a search: keys, description, section.
    #[must_use]
    pub fn texts(&self) -> Vec<String> {
        let words = [self.help.clone(), self.command.row.section.to_owned()];
        self.keys.iter().cloned().chain(words).collect()
    }
}
