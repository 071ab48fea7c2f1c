//! The keys in use: the table with the keys of the configuration, the names of actions, the table of docs/keys.md.

use super::key::control;
use super::{BINDINGS, Binding, Key, names};
use crate::explorer::action::Command;
use crate::explorer::mode::ModeKind;
use crate::scene::nearest;
use crossterm::event::{KeyCode, KeyEvent};
use std::borrow::Cow;

impl Binding {
    /// Returns true if the configuration may give the row other keys: keys for typing, lists and questions are the same for all,
    /// and digits mean what they are.
    #[must_use]
    pub fn is_rebindable(&self) -> bool {
        let has_digits = matches!(self.command, Command::StartValue(_) | Command::Preset(_));
        !has_digits && self.modes.iter().all(|mode| mode.is_exploring())
    }
}

/// Name of an action in the configuration, from its command: `step -1`, `push 1 coarse`.
#[must_use]
pub fn action_name(command: Command) -> String {
    let text = match command {
        Command::Toggle(pane) => format!("Toggle{pane:?}"),
        command => format!("{command:?}"),
    };
    let has_names = text.contains('{');
    let words = text.split(|c: char| !(c.is_alphanumeric() || c == '-')).filter(|word| !word.is_empty());
    let (mut name, mut member) = (String::new(), None);
    for (number, word) in words.enumerate() {
        let word = match (word, number, has_names) {
            (member_name, 1.., true) if member.is_none() => {
                member = Some(member_name);
                continue;
            }
            ("false", ..) if has_names => {
                member = None;
                continue;
            }
            ("true", ..) if has_names => member.take().unwrap_or(word),
            _ => {
                member = None;
                word
            }
        };
        if !name.is_empty() {
            name.push(' ');
        }
        for (place, character) in word.char_indices() {
            if character.is_uppercase() && place > 0 {
                name.push('-');
            }
            name.extend(character.to_lowercase());
        }
    }
    name
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

    /// The command of a key in a mode. Where a row has a key for each digit, the command has that digit.
    #[must_use]
    pub fn command(&self, event: &KeyEvent, mode: ModeKind) -> Option<Command> {
        let row = self.valid_in(mode).find(|row| row.keys.iter().any(|key| key.matches(event)))?;
        let KeyCode::Char(character) = event.code else { return Some(row.command) };
        Some(match row.command {
            Command::StartValue(_) => Command::StartValue(character),
            Command::Preset(_) => Command::Preset(character.to_digit(10)?.checked_sub(1)? as usize),
            command => command,
        })
    }

    /// Gives an action these keys in place of its own. Ctrl+C always quits.
    ///
    /// # Errors
    /// An action or a key that does not exist.
    pub fn rebind(&mut self, action: &str, keys: &[String]) -> Result<(), RebindError> {
        let is_action = |row: &&mut Binding| row.is_rebindable() && action_name(row.command) == action;
        let parsed = keys.iter().map(|name| {
            Key::named(name).ok_or_else(|| RebindError {
                message: format!("{name}: there is no such key; allowed: one character, Ctrl+c, Shift+Left, F5, PageUp and the like"),
                is_about_keys: true,
            })
        });
        let mut parsed = parsed.collect::<Result<Vec<Key>, _>>()?;
        let rows: Vec<&mut Binding> = self.0.iter_mut().filter(is_action).collect();
        if rows.is_empty() {
            let names: Vec<String> = BINDINGS
                .iter()
                .filter(|row| row.is_rebindable())
                .map(|row| action_name(row.command))
                .collect();
            let near = nearest(action, names.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!(" did you mean {near}?"));
            let message = format!("{action}: there is no such action;{near} allowed: docs/keys.md lists all");
            return Err(RebindError { message, is_about_keys: false });
        }
        for row in rows {
            if row.command == Command::Quit && !parsed.contains(&control('c')) {
                parsed.push(control('c'));
            }
            row.keys = Cow::Owned(parsed.clone());
        }
        Ok(())
    }

    /// A key with two actions in one mode, and their names.
    #[must_use]
    pub fn conflict(&self) -> Option<(String, String, String)> {
        ModeKind::ALL.into_iter().find_map(|mode| {
            let mut seen: Vec<(&Key, Command)> = Vec::new();
            for row in self.valid_in(mode) {
                for key in row.keys.iter() {
                    if let Some((_, other)) = seen.iter().find(|(seen, _)| *seen == key) {
                        return Some((key.name(), action_name(*other), action_name(row.command)));
                    }
                    seen.push((key, row.command));
                }
            }
            None
        })
    }

    /// Actions with other keys than those of the table, and the names of these keys.
    #[must_use]
    pub fn changed(&self) -> Vec<(Command, Vec<String>)> {
        let pairs = self.0.iter().zip(BINDINGS).filter(|(row, usual)| row.keys != usual.keys);
        pairs.map(|(row, _)| (row.command, row.keys.iter().map(Key::name).collect())).collect()
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
        let action =
            if row.is_rebindable() { format!("`{}`", action_name(row.command)) } else { String::new() };
        text += &format!("| {shown} | {} | {} | {action} |\n", keys.join(" "), row.help);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::action::Jump;
    use crossterm::event::KeyModifiers;

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
        }
        for name in ["", "ab", "Shift+a", "F0", "F13", "Ctrl+", "\u{1b}", "Alt+x"] {
            assert_eq!(Key::named(name), None, "{name}");
        }
        for (command, name) in [
            (Command::TogglePlay, "toggle-play"),
            (Command::Step(-1), "step -1"),
            (Command::Push { steps: -1, coarse: false }, "push -1"),
            (Command::Push { steps: 1, coarse: true }, "push 1 coarse"),
            (Command::SelectEnd(true), "select-end true"),
            (Command::Fragment(Jump::MostLoaded), "fragment most-loaded"),
            (Command::Delete { backwards: true }, "delete backwards"),
        ] {
            assert_eq!(action_name(command), name);
        }
        let all: Vec<Command> =
            BINDINGS.iter().filter(|row| row.is_rebindable()).map(|row| row.command).collect();
        for (place, command) in all.iter().enumerate() {
            let same = all[..place].iter().find(|other| action_name(**other) == action_name(*command));
            assert!(same.is_none_or(|same| same == command), "{command:?} {same:?}");
        }
    }

    #[test]
    fn every_mode_can_be_left() {
        for mode in ModeKind::ALL {
            let leaves = |command| {
                matches!(command, Command::Quit | Command::QuitAnyway | Command::Help | Command::Cancel)
            };
            let interrupt = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
            assert!(Bindings::default().command(&interrupt, mode).is_some_and(leaves), "Ctrl+C in {mode:?}");
        }
    }
}
