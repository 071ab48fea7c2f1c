//! What a terminal sends to the explorer.

use asperity_plot::Background;
use crossterm::event::Event;

/// What a terminal sends: an event such as a pressed key, or the brightness of its background.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    Event(Event),
    /// Answer of the terminal, which the explorer asks for its background when it starts.
    Background(Background),
}
