//! What signs and lines mean, in one row.

use super::canvas::{Anchor, Canvas, Place};
use super::label::width;

/// Size of its words, px.
const SIZE: f64 = 11.5;
/// Room between two entries, px.
const BETWEEN: f64 = 20.0;

/// A row of signs with their meanings; without a canvas it is only measured.
pub(super) struct Legend<'c, 'a> {
    canvas: Option<&'c Canvas<'a>>,
    left: f64,
    x: f64,
    y: f64,
}

impl<'c, 'a> Legend<'c, 'a> {
    pub(super) fn new(canvas: Option<&'c Canvas<'a>>, (left, y): Place) -> Self {
        Legend { canvas, left, x: left, y }
    }

    /// Adds an entry: its sign, given the left end of the room for it, and what it means.
    pub(super) fn say(&mut self, text: &str, room: f64, sign: impl FnOnce(&Canvas<'_>, f64)) {
        if let Some(canvas) = self.canvas {
            sign(canvas, self.x);
            canvas.text(text, (self.x + room, self.y), SIZE, Anchor::Left);
        }
        self.x += room + width(text) * SIZE + BETWEEN;
    }

    /// Width of all entries.
    pub(super) fn width(&self) -> f64 {
        (self.x - self.left - BETWEEN).max(0.0)
    }
}
