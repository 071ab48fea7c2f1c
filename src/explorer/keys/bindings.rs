//! The keys in use: the table with the keys of the configuration, the names of actions, the table of docs/keys.md.

use super::key::control;
use super::{BINDINGS, Binding, Key, names};
use crate::explorer::command::Command;
use crate::explorer::mode::ModeKind;
use crate::scene::nearest;
use crossterm::event::KeyEvent;
use std::borrow::Cow;

impl Binding {
    /// The command of one of the keys.
    #[must_use]
    pub fn command_of(&self, key: &Key) -> Command {
        key.character().map_or(self.command, |character| self.command.with(character))
    }

    /// Returns true if the configuration may replace the keys of the row: keys for typing, lists and questions are
    /// fixed, and so are digits.
    #[must_use]
    pub fn is_rebindable(&self) -> bool {
        !self.command.takes_character() && self.modes.iter().all(|mode| mode.is_exploring())
    }
}

/// Reason why keys are refused.
pub struct RebindError {
    /// Value and allowed values.
    pub message: String,
    /// True for the keys, false for the action.
    pub is_about_keys: bool,
}

/// The keys in use: the table, with other keys where the configuration has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Bindings(Vec<Binding>);

impl Default for Bindings {
    fn default() -> Self {
        Bindings(BINDINGS.to_vec())
    }
}

impl Bindings {
    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = &Binding> {
        self.0.iter()
    }

    /// The rows that are valid in a mode.
    pub fn valid_in(&self, mode: ModeKind) -> impl Iterator<Item = &Binding> {
        self.rows().filter(move |row| row.modes.contains(&mode))
    }

    /// The command of a key in a mode.
    #[must_use]
    pub fn command(&self, event: &KeyEvent, mode: ModeKind) -> Option<Command> {
        self.valid_in(mode)
            .find_map(|row| Some(row.command_of(row.keys.iter().find(|key| key.matches(event))?)))
    }

    /// The command of a name in a mode, with the character where the row takes one: `preset 3`.
    #[must_use]
    pub fn named(&self, name: &str, mode: ModeKind) -> Option<Command> {
        self.valid_in(mode).find_map(|row| match name.strip_prefix(row.command.name)?.strip_prefix(' ') {
            None => (name == row.command.name).then_some(row.command),
            Some(character) if row.command.takes_character() => {
                character.parse().ok().map(|character| row.command.with(character))
            }
            Some(_) => None,
        })
    }

    /// Replaces the keys of an action. Ctrl+C always quits.
    ///
    /// # Errors
    /// An action or a key that does not exist.
    pub fn rebind(&mut self, action: &str, keys: &[String]) -> Result<(), RebindError> {
        let is_action = |row: &&mut Binding| row.is_rebindable() && row.command.name == action;
        let parsed = keys.iter().map(|name| {
            Key::named(name).ok_or_else(|| RebindError {
                message: format!("{name}: there is no such key; allowed: one character, Ctrl+c, Shift+Left, F5, PageUp and the like"),
                is_about_keys: true,
            })
        });
        let mut parsed = parsed.collect::<Result<Vec<Key>, _>>()?;
        let rows: Vec<&mut Binding> = self.0.iter_mut().filter(is_action).collect();
        if rows.is_empty() {
            let names = BINDINGS.iter().filter(|row| row.is_rebindable()).map(|row| row.command.name);
            let near = nearest(action, names);
            let near = near.map_or_else(String::new, |near| format!(" did you mean {near}?"));
            let message = format!("{action}: there is no such action;{near} allowed: docs/keys.md lists all");
            return Err(RebindError { message, is_about_keys: false });
        }
        for row in rows {
            if row.command.name == "quit" && !parsed.contains(&control('c')) {
                parsed.push(control('c'));
            }
            row.keys = Cow::Owned(parsed.clone());
        }
        Ok(())
    }

    /// A key with two actions in one mode, and their names.
    #[must_use]
    pub fn conflict(&self) -> Option<(String, &'static str, &'static str)> {
        ModeKind::ALL.into_iter().find_map(|mode| {
            let mut seen: Vec<(&Key, &'static str)> = Vec::new();
            for row in self.valid_in(mode) {
                for key in row.keys.iter() {
                    if let Some((_, other)) = seen.iter().find(|(seen, _)| *seen == key) {
                        return Some((key.name(), *other, row.command.name));
                    }
                    seen.push((key, row.command.name));
                }
            }
            None
        })
    }

    /// Names of the actions with other keys than those of the table, and the names of these keys.
    #[must_use]
    pub fn changed(&self) -> Vec<(&'static str, Vec<String>)> {
        let pairs = self.0.iter().zip(BINDINGS).filter(|(row, usual)| row.keys != usual.keys);
        pairs.map(|(row, _)| (row.command.name, row.keys.iter().map(Key::name).collect())).collect()
    }
}

/// The table as Markdown, for docs/keys.md: keys, their functions, and the names of the actions in the configuration.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::from("| | key | does | action |\n| --- | --- | --- | --- |\n");
    let mut section = "";
    for row in BINDINGS.iter().filter(|row| !row.help.is_empty()) {
        let shown = if row.section == section { "" } else { row.section };
        section = row.section;
        // A bar would end the cell.
        let names = names(&row.keys).into_iter().map(|name| name.replace('|', "\\|"));
        let keys: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        let action = if row.is_rebindable() { format!("`{}`", row.command.name) } else { String::new() };
        text += &format!("| {shown} | {} | {} | {action} |\n", keys.join(" "), row.help);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::{KeyCode, KeyModifiers};

    #[test]
    fn no_mode_gives_a_key_two_meanings() {
        assert_eq!(Bindings::default().conflict(), None);
    }

    #[test]
    fn keys_are_found_by_their_names_and_actions_have_names_of_their_own() {
        for row in BINDINGS {
            for key in row.keys.iter() {
                assert_eq!(Key::named(&key.name()), Some(*key), "{}", key.name());
            }
            assert_eq!(Key::named("ctrl+y"), Some(control('y')));
        }
        for name in ["", "ab", "Shift+a", "F0", "F13", "Ctrl+", "\u{1b}", "Alt+x"] {
            assert_eq!(Key::named(name), None, "{name}");
        }
        let mut names: Vec<&str> =
            BINDINGS.iter().filter(|row| row.is_rebindable()).map(|row| row.command.name).collect();
        names.sort_unstable();
        let twice: Vec<&str> =
            names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        assert_eq!(twice, ["toggle-crosshair"], "one more key hides the crosshair while the arrows move it");
        let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == ' ';
        assert!(names.iter().all(|name| !name.is_empty() && name.chars().all(is_plain)), "{names:?}");
    }

    #[test]
    fn a_command_is_found_by_its_name_where_it_is_valid() {
        let bindings = Bindings::default();
        let name = |command: Option<Command>| command.map(|command| command.name);
        assert_eq!(name(bindings.named("push -1 coarse", ModeKind::Explore)), Some("push -1 coarse"));
        assert_eq!(bindings.named("accept", ModeKind::Explore), None);
        assert_eq!(bindings.named("no such command", ModeKind::Explore), None);
        let three = KeyEvent::new(KeyCode::Char('3'), KeyModifiers::NONE);
        let preset = bindings.named("preset 3", ModeKind::Explore);
        assert!(preset.is_some() && bindings.command(&three, ModeKind::Explore) == preset);
        assert_eq!(format!("{:?}", bindings.command(&three, ModeKind::Explore)), "Some(preset 3)");
        assert_eq!(name(bindings.command(&three, ModeKind::Parameters)), Some("start-value"));
    }

    #[test]
    fn every_mode_can_be_left() {
        for mode in ModeKind::ALL {
            let leaves =
                |command: Command| ["quit", "quit-anyway", "close-help", "cancel"].contains(&command.name);
            let interrupt = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
            assert!(Bindings::default().command(&interrupt, mode).is_some_and(leaves), "Ctrl+C in {mode:?}");
        }
    }
}
