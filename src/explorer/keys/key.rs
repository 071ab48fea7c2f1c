//! A key with its modifiers, and the names of keys.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    code: KeyCode,
    modifiers: KeyModifiers,
}

impl Key {
    /// Returns true if a key event is this key. Shift is part of a character, not a modifier.
    #[must_use]
    pub fn matches(&self, event: &KeyEvent) -> bool {
        let modifiers = match event.code {
            KeyCode::Char(_) | KeyCode::BackTab => event.modifiers - KeyModifiers::SHIFT,
            _ => event.modifiers,
        };
        self.code == event.code && self.modifiers == modifiers
    }

    /// Character of the key.
    #[must_use]
    pub fn character(&self) -> Option<char> {
        if let KeyCode::Char(character) = self.code { Some(character) } else { None }
    }

    /// The key in the notation of keyboards.
    #[must_use]
    pub fn name(&self) -> String {
        let named = NAMES.iter().find(|(_, code)| *code == self.code);
        let name = match (named, self.code) {
            (Some((name, _)), _) => (*name).to_owned(),
            (None, KeyCode::Char(character)) => character.to_string(),
            (None, KeyCode::BackTab) => "Shift+Tab".to_owned(),
            (None, KeyCode::F(number)) => format!("F{number}"),
            (None, other) => format!("{other:?}"),
        };
        let control = if self.modifiers.contains(KeyModifiers::CONTROL) { "Ctrl+" } else { "" };
        let shift = if self.modifiers.contains(KeyModifiers::SHIFT) { "Shift+" } else { "" };
        format!("{control}{shift}{name}")
    }

    /// The key of a name, as [`Key::name`] writes it, or in the words on a keyboard: `Up`, `Ctrl+p`, `Shift+Left`.
    #[must_use]
    pub fn named(name: &str) -> Option<Key> {
        fn without<'a>(name: &'a str, modifier: &str) -> (bool, &'a str) {
            let named = name.split_at_checked(modifier.len());
            let rest = named.filter(|(before, _)| before.eq_ignore_ascii_case(modifier));
            rest.map_or((false, name), |(_, rest)| (true, rest))
        }
        let (control, rest) = without(name, "Ctrl+");
        let (shift, rest) = without(rest, "Shift+");
        let mut characters = rest.chars();
        let code = match (NAMES.iter().find(|(name, _)| *name == rest), characters.next(), characters.next())
        {
            (Some((_, KeyCode::Tab)), ..) if shift => KeyCode::BackTab,
            (Some((_, code)), ..) => *code,
            // Shift is part of a character.
            (None, Some(character), None) if !shift && !crate::text::is_control(character) => {
                KeyCode::Char(character)
            }
            _ => {
                let number = rest.strip_prefix('F')?.parse().ok();
                KeyCode::F(number.filter(|number| (1..=12).contains(number))?)
            }
        };
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, control);
        modifiers.set(KeyModifiers::SHIFT, shift && code != KeyCode::BackTab);
        Some(Key { code, modifiers })
    }
}

/// Keys with names of their own; of two names of a key the first is shown.
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

/// Names of keys; consecutive digits have one name: `1–9`.
#[must_use]
pub fn names(keys: &[Key]) -> Vec<String> {
    let digit = |key: &Key| match key.code {
        KeyCode::Char(character) if key.modifiers.is_empty() => character.to_digit(10),
        _ => None,
    };
    let follows =
        |one: &Key, next: &Key| digit(one).zip(digit(next)).is_some_and(|(one, next)| one + 1 == next);
    let run = |run: &[Key]| match run {
        [first, .., last] => format!("{}–{}", first.name(), last.name()),
        one => one.iter().map(Key::name).collect(),
    };
    keys.chunk_by(follows).map(run).collect()
}
