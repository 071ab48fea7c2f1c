//! A key with its modifiers, identified by its name.

use asperity_data::is_control;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A key with its modifiers, or a range of characters: `Ctrl+p`, `1–9`.
#[derive(Clone, Debug)]
pub struct Key {
    /// Name, as in the table of keys or the configuration.
    pub name: String,
    first: KeyCode,
    last: KeyCode,
    modifiers: KeyModifiers,
}

impl Key {
    /// Returns true if an event is this key. Shift belongs to a character and is no modifier.
    pub fn matches(&self, event: &KeyEvent) -> bool {
        let modifiers = match event.code {
            KeyCode::Char(_) | KeyCode::BackTab => event.modifiers - KeyModifiers::SHIFT,
            _ => event.modifiers,
        };
        self.modifiers == modifiers && (self.first..=self.last).contains(&event.code)
    }

    /// Returns the event of the key; for a range the event of its first character.
    pub fn event(&self) -> KeyEvent {
        KeyEvent::new(self.first, self.modifiers)
    }

    /// Returns true if one event can match both keys.
    pub fn overlaps(&self, other: &Key) -> bool {
        self.modifiers == other.modifiers && self.first <= other.last && other.first <= self.last
    }

    /// The key with this name: a character or the word on a keyboard, with modifiers: `Up`,
    /// `Ctrl+p`, `Shift+Left`.
    pub fn named(name: &str) -> Option<Key> {
        fn without<'a>(name: &'a str, modifier: &str) -> (bool, &'a str) {
            let named = name.split_at_checked(modifier.len());
            let rest = named.filter(|(before, _)| before.eq_ignore_ascii_case(modifier));
            rest.map_or((false, name), |(_, rest)| (true, rest))
        }
        let (control, rest) = without(name, "Ctrl+");
        let (shift, rest) = without(rest, "Shift+");
        let characters: Vec<char> = rest.chars().collect();
        let known = NAMES
            .iter()
            .find(|(known, _)| *known == rest)
            .map(|(_, code)| *code);
        let (first, last) = match (known, &characters[..]) {
            (Some(KeyCode::Tab), _) if shift => (KeyCode::BackTab, KeyCode::BackTab),
            (Some(code), _) => (code, code),
            // Shift is part of a character.
            (None, &[one]) if !shift && !is_control(one) => {
                (KeyCode::Char(one), KeyCode::Char(one))
            }
            (None, &[first, '–', last]) if !shift => (KeyCode::Char(first), KeyCode::Char(last)),
            _ => {
                let number = rest.strip_prefix('F')?.parse().ok();
                let code = KeyCode::F(number.filter(|number| (1..=12).contains(number))?);
                (code, code)
            }
        };
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, control);
        modifiers.set(KeyModifiers::SHIFT, shift && first != KeyCode::BackTab);
        Some(Key {
            name: name.to_owned(),
            first,
            last,
            modifiers,
        })
    }
}

/// Step of an arrow key or of its letter: columns to the right and rows upwards. The flag marks a
/// large step. `None` for another key.
pub fn direction(key: &KeyEvent) -> Option<((i32, i32), bool)> {
    let is_coarse = key.modifiers.contains(KeyModifiers::SHIFT);
    let way = match key.code {
        KeyCode::Left | KeyCode::Char('h' | 'H') => (-1, 0),
        KeyCode::Right | KeyCode::Char('l' | 'L') => (1, 0),
        KeyCode::Up | KeyCode::Char('k' | 'K') => (0, 1),
        KeyCode::Down | KeyCode::Char('j' | 'J') => (0, -1),
        _ => return None,
    };
    let is_capital = matches!(key.code, KeyCode::Char(letter) if letter.is_uppercase());
    Some((way, is_coarse || is_capital))
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
