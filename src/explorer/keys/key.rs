//! A key with its modifiers. Each key has a name.

use asperity_data::is_control;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// Key with its modifiers, such as `Ctrl+p`, or a range of characters, such as `1–9`.
#[derive(Clone, Debug)]
pub struct Key {
    /// Name of the key in the table of keys or in the configuration.
    pub name: String,
    first: KeyCode,
    last: KeyCode,
    modifiers: KeyModifiers,
}

impl Key {
    /// Returns true if the event is a press of this key. For a character, Shift is not a modifier,
    /// because a shifted character is another character.
    pub fn matches(&self, event: &KeyEvent) -> bool {
        let modifiers = match event.code {
            KeyCode::Char(_) | KeyCode::BackTab => event.modifiers - KeyModifiers::SHIFT,
            _ => event.modifiers,
        };
        self.modifiers == modifiers && (self.first..=self.last).contains(&event.code)
    }

    /// Returns the event that the terminal sends when this key is pressed. For a range of
    /// characters, it is the event of the first character.
    pub fn event(&self) -> KeyEvent {
        KeyEvent::new(self.first, self.modifiers)
    }

    /// Returns true if one key press can match both this key and the key `other`.
    pub fn overlaps(&self, other: &Key) -> bool {
        self.modifiers == other.modifiers && self.first <= other.last && other.first <= self.last
    }

    /// Returns the key with this name. The name is a character or a word such as `Up`, possibly
    /// after modifiers, as in `Ctrl+p` and `Shift+Left`. `None` if there is no such key.
    pub fn named(name: &str) -> Option<Key> {
        let (has_control, rest) = without_modifier(name, "Ctrl+");
        let (has_shift, rest) = without_modifier(rest, "Shift+");
        let (first, last) = codes(rest, has_shift)?;
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, has_control);
        modifiers.set(KeyModifiers::SHIFT, has_shift && first != KeyCode::BackTab);
        Some(Key {
            name: name.to_owned(),
            first,
            last,
            modifiers,
        })
    }
}

/// Splits off the modifier at the beginning of a name. Returns whether the name begins with the
/// modifier, and the rest of the name.
fn without_modifier<'a>(name: &'a str, modifier: &str) -> (bool, &'a str) {
    match name.split_at_checked(modifier.len()) {
        Some((beginning, rest)) if beginning.eq_ignore_ascii_case(modifier) => (true, rest),
        _ => (false, name),
    }
}

/// Returns the first and the last code of the key with this name. The two codes differ only for a
/// range of characters. Shift is not allowed before a character, so `Shift+a` is not a key.
fn codes(name: &str, has_shift: bool) -> Option<(KeyCode, KeyCode)> {
    if let Some((_, code)) = NAMES.iter().find(|(known, _)| *known == name) {
        return Some(match code {
            KeyCode::Tab if has_shift => (KeyCode::BackTab, KeyCode::BackTab),
            code => (*code, *code),
        });
    }
    let characters: Vec<char> = name.chars().collect();
    match characters[..] {
        [character] if !has_shift && !is_control(character) => {
            Some((KeyCode::Char(character), KeyCode::Char(character)))
        }
        [first, '–', last] if !has_shift => Some((KeyCode::Char(first), KeyCode::Char(last))),
        _ => {
            let number: u8 = name.strip_prefix('F')?.parse().ok()?;
            if !(1..=12).contains(&number) {
                return None;
            }
            Some((KeyCode::F(number), KeyCode::F(number)))
        }
    }
}

/// Step of a selection or a mark that an arrow key causes. A letter can have the same effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyDirection {
    /// Number of columns to the right. A negative number means to the left.
    pub columns: i32,
    /// Number of rows upwards. A negative number means downwards.
    pub rows: i32,
    /// True for a large step.
    pub is_coarse: bool,
}

/// Returns the step that an arrow key causes, or a letter with the same effect; `None` for any
/// other key. With Shift, or for a capital letter, the step is large.
pub fn direction(key: &KeyEvent) -> Option<KeyDirection> {
    let (columns, rows) = match key.code {
        KeyCode::Left | KeyCode::Char('h' | 'H') => (-1, 0),
        KeyCode::Right | KeyCode::Char('l' | 'L') => (1, 0),
        KeyCode::Up | KeyCode::Char('k' | 'K') => (0, 1),
        KeyCode::Down | KeyCode::Char('j' | 'J') => (0, -1),
        _ => return None,
    };
    let is_capital = matches!(key.code, KeyCode::Char(letter) if letter.is_uppercase());
    Some(KeyDirection {
        columns,
        rows,
        is_coarse: is_capital || key.modifiers.contains(KeyModifiers::SHIFT),
    })
}

const NAMES: [(&str, KeyCode); 19] = [
    ("space", KeyCode::Char(' ')),
    ("↑", KeyCode::Up),
    ("↓", KeyCode::Down),
    ("←", KeyCode::Left),
    ("→", KeyCode::Right),
    ("Up", KeyCode::Up),
    ("Down", KeyCode::Down),
    ("Left", KeyCode::Left),
    ("Right", KeyCode::Right),
    ("Tab", KeyCode::Tab),
    ("Enter", KeyCode::Enter),
    ("Esc", KeyCode::Esc),
    ("Home", KeyCode::Home),
    ("End", KeyCode::End),
    ("PageUp", KeyCode::PageUp),
    ("PageDown", KeyCode::PageDown),
    ("Insert", KeyCode::Insert),
    ("Delete", KeyCode::Delete),
    ("Backspace", KeyCode::Backspace),
];
