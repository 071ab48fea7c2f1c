//! The list of all commands, each with its key: the table of keys, by description.

use super::command::Command;
use super::keys::{self, Binding, Bindings};
use super::mode::ModeKind;
use crate::scene::{Preset, presets};

/// A command of the list.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Names of its keys.
    pub keys: Vec<String>,
    /// Description.
    pub help: String,
    /// Its section in the table of keys.
    pub section: &'static str,
    /// The command.
    pub command: Command,
    /// The modes in which its keys are valid.
    pub modes: &'static [ModeKind],
}

/// All commands of the explorer but those of texts and questions, in the order of the table.
#[must_use]
pub fn entries(bindings: &Bindings) -> Vec<Entry> {
    let is_listed = |row: &&Binding| {
        row.modes.iter().any(|mode| mode.is_exploring() && *mode != ModeKind::Crosshair)
            // `start-value` needs its key as the value, and the list is open.
            && !["start-value", "open-palette"].contains(&row.command.name)
    };
    bindings.rows().filter(is_listed).flat_map(of_row).collect()
}

/// The command of a row; for the keys of built-in scenes one for each scene.
fn of_row(row: &Binding) -> Vec<Entry> {
    let entry = |keys, help, command| Entry { keys, help, section: row.section, command, modes: row.modes };
    if !row.command.takes_character() {
        return vec![entry(keys::names(&row.keys), row.help.to_owned(), row.command)];
    }
    let scenes = ('1'..='9').zip(presets());
    let scene = |(digit, preset): (char, &Preset)| {
        let help = format!("open the built-in scene {}", preset.name);
        entry(vec![digit.to_string()], help, row.command.with(digit))
    };
    scenes.map(scene).collect()
}

impl Entry {
    /// Texts of a search: keys, description, section.
    #[must_use]
    pub fn texts(&self) -> Vec<String> {
        self.keys.iter().cloned().chain([self.help.clone(), self.section.to_owned()]).collect()
    }
}
