//! Frame of a chart, which converts numbers to positions, and its axes.

use super::elements::{Anchor, Pen, Place, Svg, TEXT};
use crate::axis::{Axes, ChartAxis, Share};
use crate::label::Label;
use crate::ticks::Tick;

/// Font size of the labels of axes, px.
pub(super) const LABEL: f64 = 13.0;
/// Font size of the numbers at ticks, px.
pub(super) const NUMBER: f64 = 11.5;
/// Approximate number of labelled ticks of an axis.
const TICKS: usize = 6;

/// Rectangle of a chart in a picture, with its two axes.
#[derive(Clone, Copy)]
pub(super) struct Frame<'a> {
    /// Upper left corner.
    pub from: Place,
    /// Lower right corner.
    pub to: Place,
    pub axes: Axes<'a>,
}

/// Side of a frame on which an axis is drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Left,
    Right,
}

impl Frame<'_> {
    pub(super) fn width(&self) -> f64 {
        self.to.0 - self.from.0
    }

    pub(super) fn height(&self) -> f64 {
        self.to.1 - self.from.1
    }

    /// Returns the position in the picture of a position in shares of the axes.
    pub(super) fn at(&self, (x, y): Share) -> Place {
        (
            self.from.0 + x * self.width(),
            self.to.1 - y * self.height(),
        )
    }

    pub(super) fn place_of_coordinates(&self, (x, y): (f64, f64)) -> Place {
        let share = |axis: &ChartAxis, at: f64| (at - axis.span.low) / axis.span.width();
        self.at((share(self.axes.x, x), share(self.axes.y, y)))
    }

    pub(super) fn axis(&self, svg: &mut Svg, side: Side) {
        let axis = if side == Side::Below {
            self.axes.x
        } else {
            self.axes.y
        };
        let ticks = axis.ticks(self.ticks(side));
        // Direction outwards from the frame, and the edge of the frame.
        let (outwards, edge) = match side {
            Side::Below => (1.0, self.to.1),
            Side::Left => (-1.0, self.from.0),
            Side::Right => (1.0, self.to.0),
        };
        for Tick { at, label } in &ticks {
            let length = outwards * NUMBER * if label.is_some() { 0.43 } else { 0.23 };
            let (x, y) = self.place_of_coordinates((*at, *at));
            let (ends, place, anchor) = match side {
                Side::Below => (
                    [(x, edge), (x, edge + length)],
                    (x, edge + 1.2 * NUMBER),
                    Anchor::Middle,
                ),
                Side::Left => (
                    [(edge + length, y), (edge, y)],
                    (edge - 0.7 * NUMBER, y),
                    Anchor::Right,
                ),
                Side::Right => (
                    [(edge, y), (edge + length, y)],
                    (edge + 0.7 * NUMBER, y),
                    Anchor::Left,
                ),
            };
            svg.line(&ends, Pen::solid(TEXT, 1.0));
            if let Some(label) = label {
                svg.label(label, place, NUMBER, anchor);
            }
        }
        let length = if side == Side::Below {
            self.width()
        } else {
            self.height()
        };
        let label = axis.label_within((length + LABEL) / LABEL);
        if !label.is_empty() {
            let middle = self.at((0.5, 0.5));
            let (place, anchor) = match side {
                Side::Below => ((middle.0, edge + 2.9 * NUMBER), Anchor::Middle),
                _ => (
                    (edge + outwards * beside(&ticks), middle.1),
                    Anchor::Upwards,
                ),
            };
            svg.label(&label, place, LABEL, anchor);
        }
    }

    fn ticks(&self, side: Side) -> usize {
        // Wide charts have more ticks, low ones fewer.
        let room = if side == Side::Below {
            self.width() / 55.0
        } else {
            self.height() / 30.0
        };
        (room as usize).clamp(3, if side == Side::Below { 9 } else { TICKS })
    }

    /// Returns the width in px that a vertical axis takes beside the frame.
    pub(super) fn room(&self, side: Side) -> f64 {
        let ticks = self.axes.y.ticks(self.ticks(side));
        beside(&ticks) + 0.7 * LABEL
    }
}

/// Returns the distance in px from a vertical axis to the middle of its label, beyond its widest
/// number.
fn beside(ticks: &[Tick]) -> f64 {
    let widest = ticks
        .iter()
        .filter_map(|tick| tick.label.as_ref())
        .map(Label::width)
        .fold(0.0, f64::max);
    (widest + 1.9) * NUMBER
}
