//! The frame of a panel: from numbers to places, with axes around it.

use super::canvas::Anchor;
use super::canvas::{Canvas, INK, Place, stroke};
use super::label::width;
use super::ticks::{Tick, ticks};
use crate::study::figure::AxisScale;

/// Size of the words of axes, px.
pub(super) const LABEL: f64 = 13.0;
/// Size of the numbers at marks, px.
pub(super) const NUMBER: f64 = 11.5;

/// A rectangle on the picture with the coordinates of two axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Upper left corner, px.
    pub from: Place,
    /// Lower right corner, px.
    pub to: Place,
    /// Coordinates at its left and right side.
    pub across: (f64, f64),
    /// Coordinates at its lower and upper side.
    pub up: (f64, f64),
}

/// What an axis says.
pub(super) struct Ruler {
    pub scale: AxisScale,
    /// What numbers are divided by, for the prefix of the unit.
    pub divisor: f64,
    /// Its label, to be typeset; may be empty.
    pub label: String,
    /// Most numbers on it, about.
    pub most: usize,
}

impl Ruler {
    /// Room that an upright axis over these coordinates takes beside its rectangle, px.
    pub(super) fn room(&self, span: (f64, f64), size: f64) -> f64 {
        let ticks = ticks(self.scale, span, self.divisor, self.most);
        beside(&ticks, size) + 0.7 * LABEL * size / NUMBER
    }
}

impl Frame {
    /// Where a point of the plane stands.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> Place {
        let share = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
        (
            self.from.0 + share(x, self.across) * (self.to.0 - self.from.0),
            self.to.1 - share(y, self.up) * (self.to.1 - self.from.1),
        )
    }

    /// Draws the axis below, numbers of this size.
    pub(super) fn axis_below(&self, canvas: &Canvas<'_>, ruler: &Ruler, size: f64) {
        let bottom = self.to.1;
        for tick in ticks(ruler.scale, self.across, ruler.divisor, ruler.most) {
            let (x, _) = self.place((tick.at, self.up.0));
            canvas.line(&[(x, bottom), (x, bottom + length(&tick, size))], stroke(INK, 1.0));
            if let Some(label) = &tick.label {
                canvas.text(label, (x, bottom + 0.45 * size + 0.75 * size), size, Anchor::Middle);
            }
        }
        let middle = f64::midpoint(self.from.0, self.to.0);
        if !ruler.label.is_empty() {
            canvas.text(&ruler.label, (middle, bottom + 2.9 * size), LABEL * size / NUMBER, Anchor::Middle);
        }
    }

    /// Draws the axis on the left, numbers of this size.
    pub(super) fn axis_left(&self, canvas: &Canvas<'_>, ruler: &Ruler, size: f64) {
        let left = self.from.0;
        let ticks = ticks(ruler.scale, self.up, ruler.divisor, ruler.most);
        for tick in &ticks {
            let (_, y) = self.place((self.across.0, tick.at));
            canvas.line(&[(left - length(tick, size), y), (left, y)], stroke(INK, 1.0));
            if let Some(label) = &tick.label {
                canvas.text(label, (left - 0.7 * size, y), size, Anchor::Right);
            }
        }
        let middle = f64::midpoint(self.from.1, self.to.1);
        if !ruler.label.is_empty() {
            let beside = left - beside(&ticks, size);
            canvas.text(&ruler.label, (beside, middle), LABEL * size / NUMBER, Anchor::Upwards);
        }
    }

    /// Draws the axis on the right, as that of a scale of colours.
    pub(super) fn axis_right(&self, canvas: &Canvas<'_>, ruler: &Ruler, size: f64) {
        let right = self.to.0;
        let ticks = ticks(ruler.scale, self.up, ruler.divisor, ruler.most);
        for tick in &ticks {
            let (_, y) = self.place((self.across.0, tick.at));
            canvas.line(&[(right, y), (right + length(tick, size), y)], stroke(INK, 1.0));
            if let Some(label) = &tick.label {
                canvas.text(label, (right + 0.7 * size, y), size, Anchor::Left);
            }
        }
        let middle = f64::midpoint(self.from.1, self.to.1);
        if !ruler.label.is_empty() {
            let beside = right + beside(&ticks, size);
            canvas.text(&ruler.label, (beside, middle), LABEL * size / NUMBER, Anchor::Upwards);
        }
    }
}

/// Length of a mark, px.
fn length(tick: &Tick, size: f64) -> f64 {
    if tick.label.is_some() { 0.43 * size } else { 0.23 * size }
}

/// Distance from an axis to the middle of its label, beyond the widest number, px. Some fonts are a tenth wider
/// than the usual ones.
fn beside(ticks: &[Tick], size: f64) -> f64 {
    let widest = ticks.iter().filter_map(|tick| tick.label.as_deref()).map(width).fold(0.0, f64::max);
    (1.1 * widest + 1.9) * size
}
