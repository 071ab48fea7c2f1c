//! The rows of the table of keys, and the keys in use. The keys in use are those of the table,
//! unless the configuration of the user replaces them.

use super::key::Key;
use asperity_scene::text::nearest;
use crossterm::event::KeyEvent;
use std::fmt;

/// Context in which a key is pressed. It determines the function of the key. If a prompt is open (a
/// line in which the user types, or a question), the context depends on the prompt. Otherwise it
/// depends on the selected pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::VariantArray)]
pub enum Context {
    Explore,
    /// No prompt is open, and the map is selected.
    Map,
    /// No prompt is open, and the selected pane shows a crosshair.
    Crosshair,
    /// No prompt is open, and the list of parameters is selected.
    Parameters,
    /// A prompt is open that has a line which the user types, but no list.
    Line,
    /// A prompt is open that has a line which the user types, and a list of matching entries.
    List,
    Overwrite,
    Help,
    Leave,
}

/// Row of the table of keys: a function, its keys, and the contexts in which these keys are valid.
pub struct Row {
    /// Names of the keys, separated by blanks, such as `Shift+← H` or `1–9`.
    pub keys: &'static str,
    pub contexts: &'static [Context],
    /// Name of the function in the configuration and in scripts.
    pub name: &'static str,
    /// Label of the function in the footer; empty if the footer does not show the function.
    pub label: &'static str,
    pub help: &'static str,
    /// Everyday words by which a search finds the function, in addition to its description.
    pub words: &'static str,
    pub section: &'static str,
    /// Rank in the footer. The row with the smallest rank comes first.
    pub rank: u8,
    pub is_listed: bool,
    /// True if successive commands of this row count as one edit. One undo then reverts all of
    /// them.
    pub merges: bool,
    /// True if each key of the row has another effect. The function then receives the pressed key.
    pub takes_key: bool,
}

/// Command that is to be run: a row of the table of keys, and the pressed key if there is one.
#[derive(Clone, Copy, Debug)]
pub struct KeyCommand {
    pub row: &'static Row,
    pub key: Option<KeyEvent>,
}

impl fmt::Debug for Row {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name)
    }
}

/// Contexts without a prompt, for any selected pane.
pub const EXPLORE: &[Context] = &[
    Context::Explore,
    Context::Map,
    Context::Crosshair,
    Context::Parameters,
];
pub const ANY: &[Context] = <Context as strum::VariantArray>::VARIANTS;
pub const MANUAL: &str = "Manual loading";

impl Row {
    /// Returns true if the configuration may replace the keys of the row. It may not replace keys
    /// that are valid in prompts, and rows in which each key has another effect, such as digits.
    fn is_rebindable(&self) -> bool {
        let is_for_exploring = self
            .contexts
            .iter()
            .all(|context| EXPLORE.contains(context));
        is_for_exploring && !self.takes_key
    }

    /// Returns true if the list of commands contains the row. Functions that work only in a prompt,
    /// or only with a crosshair, are not in the list.
    fn is_listed(&self) -> bool {
        let mut contexts = self.contexts.iter();
        let works_without_prompt =
            contexts.any(|context| EXPLORE.contains(context) && *context != Context::Crosshair);
        self.is_listed && works_without_prompt
    }

    /// Returns the priority of the row in the footer:
    /// * 0: help and quit, which even the smallest window shows,
    /// * 1: keys that are valid only in the present context,
    /// * 2 and more: the main keys, followed by all other keys.
    fn place(&self, is_manual: bool) -> u8 {
        let is_special = !self.contexts.contains(&Context::Explore);
        if is_special || is_manual && self.section == MANUAL {
            self.rank.min(1)
        } else {
            self.rank
        }
    }
}

#[derive(Clone, Debug)]
pub struct Binding {
    pub row: &'static Row,
    pub keys: Vec<Key>,
}

impl Binding {
    pub fn names(&self) -> String {
        names_of(&self.keys)
    }

    /// Returns the names of the keys for the footer: the first two keys if each key of the row has
    /// another effect, as arrow keys have, otherwise only the first key.
    fn footer_names(&self) -> String {
        let most = if self.row.takes_key { 2 } else { 1 };
        names_of(&self.keys[..self.keys.len().min(most)])
    }
}

fn names_of(keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|key| key.name.as_str()).collect();
    names.join(" ")
}

/// Key bindings in use: the default keys from the table of commands, or the keys with which the
/// configuration of the user replaces them.
#[derive(Clone, Debug, Default)]
pub struct Bindings(Vec<Binding>);

impl Bindings {
    /// Creates the bindings of these rows. Each command has its default keys.
    pub fn of(rows: impl Iterator<Item = &'static Row>) -> Self {
        let mut bindings = Vec::new();
        for row in rows {
            let keys = row.keys.split(' ').filter_map(Key::named).collect();
            bindings.push(Binding { row, keys });
        }
        Bindings(bindings)
    }

    pub fn rows(&self) -> impl Iterator<Item = &Binding> {
        self.0.iter()
    }

    pub fn valid_in(&self, context: Context) -> impl Iterator<Item = &Binding> {
        self.rows()
            .filter(move |binding| binding.row.contexts.contains(&context))
    }

    pub fn command(&self, event: &KeyEvent, context: Context) -> Option<KeyCommand> {
        let mut valid = self.valid_in(context);
        let binding = valid.find(|binding| binding.keys.iter().any(|key| key.matches(event)))?;
        Some(KeyCommand {
            row: binding.row,
            key: Some(*event),
        })
    }

    pub fn listed(&self) -> impl Iterator<Item = &Binding> {
        self.rows().filter(|binding| binding.row.is_listed())
    }

    /// Returns the command that has this name and is valid in the context. If the command needs a
    /// pressed key, `name` also has the name of this key, as in `start-value 3`. Returns `None` if
    /// there is no such command.
    pub fn named(&self, name: &str, context: Context) -> Option<KeyCommand> {
        let (name, key) = match name.split_once(' ') {
            Some((name, key)) => (name, Key::named(key)),
            None => (name, None),
        };
        let mut valid = self.valid_in(context);
        let binding = valid.find(|binding| binding.row.name == name)?;
        Some(KeyCommand {
            row: binding.row,
            key: key.map(|key| key.event()),
        })
    }

    /// Returns the keys and rows that the footer shows in a context, the most important first.
    /// Neighbouring rows with the same label are joined.
    pub fn footer(
        &self,
        context: Context,
        is_manual: bool,
        is_hidden: impl Fn(&'static Row) -> bool,
    ) -> Vec<(String, &'static Row)> {
        let mut bindings: Vec<&Binding> = self.valid_in(context).collect();
        bindings.retain(|binding| !binding.row.label.is_empty() && !is_hidden(binding.row));
        bindings.sort_by_key(|binding| binding.row.place(is_manual));
        let mut items = Vec::new();
        for same in bindings.chunk_by(|binding, next| binding.row.label == next.row.label) {
            let keys: Vec<String> = same.iter().map(|binding| binding.footer_names()).collect();
            items.push((keys.join(" "), same[0].row));
        }
        items
    }

    /// Replaces the keys of the command with the name `action`. The key Ctrl+C cannot be replaced,
    /// and always ends the explorer.
    ///
    /// # Errors
    /// Returns the name of the wrong field of the setting, `action` or `keys`, and an error
    /// message.
    pub fn rebind(&mut self, action: &str, keys: &[String]) -> Result<(), (&'static str, String)> {
        const ALLOWED: &str = "one character, Ctrl+c, Shift+Left, F5, PageUp and the like";
        let mut parsed = Vec::new();
        for name in keys {
            let key = Key::named(name).ok_or_else(|| {
                let why = format!("{name}: there is no such key; allowed: {ALLOWED}");
                ("keys", why)
            })?;
            parsed.push(key);
        }
        let mut rebindable = self
            .0
            .iter_mut()
            .filter(|binding| binding.row.is_rebindable());
        let Some(binding) = rebindable.find(|binding| binding.row.name == action) else {
            return Err(("action", self.no_such_action(action)));
        };
        if action == "quit" {
            let interrupt = Key::named("Ctrl+c");
            parsed.extend(interrupt.filter(|quit| !parsed.iter().any(|key| key.overlaps(quit))));
        }
        binding.keys = parsed;
        Ok(())
    }

    fn no_such_action(&self, action: &str) -> String {
        let mut names = Vec::new();
        for binding in self.rebindable() {
            names.push(binding.row.name);
        }
        let near = match nearest(action, names) {
            Some(near) => format!(" did you mean {near}?"),
            None => String::new(),
        };
        format!("{action}: there is no such action;{near} allowed: docs/keys.md lists all")
    }

    fn rebindable(&self) -> impl Iterator<Item = &Binding> {
        self.rows().filter(|binding| binding.row.is_rebindable())
    }

    /// Returns the lists of keys for docs/keys.md as Markdown. For each section, the list has the
    /// keys, their functions, and the names of these functions in the configuration.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        let mut section = "";
        for Binding { row, .. } in self.rebindable() {
            if row.section != section {
                section = row.section;
                text += &format!("\n**{section}**\n\n");
            }
            let keys = row.keys.split(' ').map(|name| format!("`{name}`"));
            let keys = keys.collect::<Vec<_>>().join(" ");
            text += &format!("* {keys}: {} (`{}`)\n", row.help, row.name);
        }
        text
    }

    /// Returns a key that has two functions in the same context, with the names of both functions.
    /// `None` if no key has two functions.
    pub fn conflict(&self) -> Option<(String, &'static str, &'static str)> {
        for context in ANY {
            let mut seen: Vec<(&Key, &'static str)> = Vec::new();
            for binding in self.valid_in(*context) {
                for key in &binding.keys {
                    if let Some((_, other)) = seen.iter().find(|(seen, _)| seen.overlaps(key)) {
                        return Some((key.name.clone(), *other, binding.row.name));
                    }
                    seen.push((key, binding.row.name));
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::commands::table::bindings;
    use crossterm::event::{KeyCode, KeyModifiers};

    /// Largest number of rows in the table of keys, because users read all of them in the help.
    const MOST_ROWS: usize = 95;

    #[test]
    fn every_key_has_a_name_and_one_meaning_in_each_context() {
        assert_eq!(bindings().conflict(), None);
        for binding in bindings().rows() {
            assert_eq!(
                binding.keys.len(),
                binding.row.keys.split(' ').count(),
                "{}",
                binding.row.keys
            );
        }
        for name in ["", "ab", "Shift+a", "F0", "F13", "Ctrl+", "\u{1b}", "Alt+x"] {
            assert!(Key::named(name).is_none(), "{name}");
        }
        let mut names: Vec<&str> = bindings()
            .rows()
            .map(|one| one.row)
            .filter(|row| row.is_rebindable())
            .map(|row| row.name)
            .collect();
        assert!(
            names
                .iter()
                .all(|name| name.chars().all(|c| c.is_ascii_lowercase() || c == '-')),
            "{names:?}"
        );
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    }

    #[test]
    fn the_table_is_short() {
        let rows = bindings().rows().count();
        assert!(
            rows <= MOST_ROWS,
            "{rows} rows; allowed: at most {MOST_ROWS}"
        );
    }

    #[test]
    fn a_command_is_found_by_its_name_where_it_is_valid() {
        let bindings = bindings();
        let name = |command: Option<KeyCommand>| {
            command.map(|command| (command.row.name, command.key.map(|key| key.code)))
        };
        assert_eq!(
            name(bindings.named("pull-coarse", Context::Explore)),
            Some(("pull-coarse", None))
        );
        assert_eq!(name(bindings.named("accept", Context::Explore)), None);
        assert_eq!(
            name(bindings.named("no such command", Context::Explore)),
            None
        );
        let three = KeyEvent::new(KeyCode::Char('3'), KeyModifiers::NONE);
        let typed = Some(("start-value", Some(KeyCode::Char('3'))));
        assert_eq!(
            name(bindings.named("start-value 3", Context::Explore)),
            typed
        );
        assert_eq!(name(bindings.command(&three, Context::Explore)), typed);
        assert_eq!(name(bindings.command(&three, Context::Parameters)), typed);
        assert_eq!(name(bindings.command(&three, Context::Map)), None);
    }

    #[test]
    fn the_footer_has_valid_keys_and_begins_with_help_and_quit() {
        for context in ANY {
            let bindings = bindings();
            let items = bindings.footer(*context, false, |_| false);
            assert!(!items.is_empty(), "{context:?}");
            assert!(
                items
                    .iter()
                    .all(|(keys, row)| row.contexts.contains(context) && !keys.is_empty())
            );
            if EXPLORE.contains(context) {
                assert_eq!(
                    [items[0].1.label, items[1].1.label],
                    ["help", "quit"],
                    "{context:?}"
                );
            }
        }
    }

    #[test]
    fn every_context_can_be_left() {
        for context in ANY {
            let leaves = ["quit", "quit-anyway", "close-help", "cancel"];
            let interrupt = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
            let command = bindings().command(&interrupt, *context);
            assert!(
                command.is_some_and(|command| leaves.contains(&command.row.name)),
                "Ctrl+C in {context:?}"
            );
        }
    }
}
