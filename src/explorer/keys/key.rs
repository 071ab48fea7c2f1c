//! A key with its modifiers, and the names of keys.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    code: KeyCode,
    modifiers: KeyModifiers,
}

impl Key {
    /// Returns true if a key event is this key. Shift is part of a character, not beside it.
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

    /// The key as it is written on a keyboard.
    #[must_use]
    pub fn name(&self) -> String {
        let name = match self.code {
            KeyCode::Char(' ') => "space".to_owned(),
            KeyCode::Char(character) => character.to_string(),
            KeyCode::Up => "↑".to_owned(),
            KeyCode::Down => "↓".to_owned(),
            KeyCode::Left => "←".to_owned(),
            KeyCode::Right => "→".to_owned(),
            KeyCode::BackTab => "Shift+Tab".to_owned(),
            KeyCode::F(number) => format!("F{number}"),
            other => format!("{other:?}"),
        };
        let mut prefix = String::new();
        if self.modifiers.contains(KeyModifiers::CONTROL) {
            prefix.push_str("Ctrl+");
        }
        if self.modifiers.contains(KeyModifiers::SHIFT) {
            prefix.push_str("Shift+");
        }
        prefix + &name
    }

    /// The key of a name, as [`Key::name`] writes it, or in the words on a keyboard: `Up`, `Ctrl+p`, `Shift+Left`.
    #[must_use]
    pub fn named(name: &str) -> Option<Key> {
        let (control, rest) = name.strip_prefix("Ctrl+").map_or((false, name), |rest| (true, rest));
        let (shift, rest) = rest.strip_prefix("Shift+").map_or((false, rest), |rest| (true, rest));
        let mut characters = rest.chars();
        let code = match (characters.next(), characters.next()) {
            (Some(arrow @ ('↑' | '↓' | '←' | '→')), None) => match arrow {
                '↑' => KeyCode::Up,
                '↓' => KeyCode::Down,
                '←' => KeyCode::Left,
                _ => KeyCode::Right,
            },
            // Shift is part of a character.
            (Some(character), None) if !shift && !crate::text::is_control(character) => {
                KeyCode::Char(character)
            }
            _ => match rest {
                "space" => KeyCode::Char(' '),
                "Tab" if shift => KeyCode::BackTab,
                "Up" => KeyCode::Up,
                "Down" => KeyCode::Down,
                "Left" => KeyCode::Left,
                "Right" => KeyCode::Right,
                "Tab" => KeyCode::Tab,
                "Enter" => KeyCode::Enter,
                "Esc" => KeyCode::Esc,
                "Home" => KeyCode::Home,
                "End" => KeyCode::End,
                "PageUp" => KeyCode::PageUp,
                "PageDown" => KeyCode::PageDown,
                "Insert" => KeyCode::Insert,
                "Delete" => KeyCode::Delete,
                "Backspace" => KeyCode::Backspace,
                function => KeyCode::F(
                    function.strip_prefix('F')?.parse().ok().filter(|number| (1..=12).contains(number))?,
                ),
            },
        };
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, control);
        modifiers.set(KeyModifiers::SHIFT, shift && code != KeyCode::BackTab);
        Some(Key { code, modifiers })
    }
}

/// A key without modifiers.
pub const fn key(code: KeyCode) -> Key {
    Key { code, modifiers: KeyModifiers::NONE }
}

/// The key of a character.
pub const fn char(character: char) -> Key {
    key(KeyCode::Char(character))
}

/// The key of a character with Ctrl.
pub const fn control(character: char) -> Key {
    Key { code: KeyCode::Char(character), modifiers: KeyModifiers::CONTROL }
}

/// A key with Shift.
pub const fn shift(code: KeyCode) -> Key {
    Key { code, modifiers: KeyModifiers::SHIFT }
}

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
