//! Commands of the user: the functions of the keys, by their names.

use super::app::App;
use super::effect::Effect;
use std::fmt;

/// A command of the user. Each is a row of the table in [`super::keys`].
#[derive(Clone, Copy)]
pub struct Command {
    /// Name in the configuration and in scripts: `step -1`, `push 1 coarse`.
    pub name: &'static str,
    handler: Handler,
    /// Character of the key, for a handler of characters.
    character: Option<char>,
}

/// Function of a command.
#[derive(Clone, Copy)]
pub enum Handler {
    /// Changes the model without effects.
    Silent(fn(&mut App)),
    /// Changes the shown part or state of the contact: a snapshot is requested.
    View(fn(&mut App)),
    /// Changes the model and returns the effects.
    Act(fn(&mut App) -> Vec<Effect>),
    /// As `Act`, for a row with several keys, with the character of the key.
    Character(fn(&mut App, char) -> Vec<Effect>),
}

impl Command {
    /// A command without character.
    #[must_use]
    pub const fn new(name: &'static str, handler: Handler) -> Self {
        Command { name, handler, character: None }
    }

    /// Returns true if the characters of the keys differ in meaning.
    #[must_use]
    pub const fn takes_character(&self) -> bool {
        matches!(self.handler, Handler::Character(_))
    }

    /// The command of the key with this character.
    #[must_use]
    pub fn with(self, character: char) -> Self {
        Command { character: self.takes_character().then_some(character), ..self }
    }

    /// Changes the model and returns the effects.
    pub(super) fn run(self, app: &mut App) -> Vec<Effect> {
        match self.handler {
            Handler::Silent(change) => change(app),
            Handler::View(change) => {
                change(app);
                return vec![Effect::Ask];
            }
            Handler::Act(act) => return act(app),
            Handler::Character(act) => {
                return self.character.map_or_else(Vec::new, |character| act(app, character));
            }
        }
        Vec::new()
    }
}

impl PartialEq for Command {
    fn eq(&self, other: &Self) -> bool {
        (self.name, self.character) == (other.name, other.character)
    }
}

impl fmt::Debug for Command {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}{}", self.name, self.character.map_or_else(String::new, |one| format!(" {one}")))
    }
}
