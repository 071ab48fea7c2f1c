//! Frame of a chart with its axes. The frame converts numbers on the axes to positions in the
//! picture.

use super::elements::{Anchor, Pen, Place, Svg, TEXT};
use crate::axis::{Axes, Share};
use crate::label::Label;
use crate::ticks::Tick;

/// Font size in px of the labels of axes.
pub(super) const LABEL: f64 = 13.0;
/// Font size in px of the numbers at ticks.
pub(super) const NUMBER: f64 = 11.5;
/// Approximate largest number of ticks with labels on a vertical axis.
const TICKS: usize = 6;

/// Rectangle of a chart in a picture, with its two axes.
#[derive(Clone, Copy)]
pub(super) struct Frame<'a> {
    /// Upper left corner, in px.
    pub from: Place,
    /// Lower right corner, in px.
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

    /// Converts a position in the chart to a position in the picture in px. The position in the
    /// chart is given by shares of the two axes from 0 to 1.
    pub(super) fn at(&self, share: Share) -> Place {
        let (x, y) = share;
        (
            self.from.0 + x * self.width(),
            self.to.1 - y * self.height(),
        )
    }

    pub(super) fn places(&self, shares: Vec<Share>) -> Vec<Place> {
        shares.into_iter().map(|share| self.at(share)).collect()
    }

    /// Converts coordinates on the two axes to a position in the picture in px.
    pub(super) fn place_of_coordinates(&self, x: f64, y: f64) -> Place {
        let Axes {
            x: x_axis,
            y: y_axis,
        } = self.axes;
        self.at((
            (x - x_axis.span.low) / x_axis.span.width(),
            (y - y_axis.span.low) / y_axis.span.width(),
        ))
    }

    pub(super) fn axis(&self, svg: &mut Svg, side: Side) {
        let axis = if side == Side::Below {
            self.axes.x
        } else {
            self.axes.y
        };
        let ticks = axis.ticks(self.ticks(side));
        for tick in &ticks {
            self.tick(svg, side, tick);
        }
        let length = if side == Side::Below {
            self.width()
        } else {
            self.height()
        };
        let label = axis.label_within((length + LABEL) / LABEL);
        if label.is_empty() {
            return;
        }
        let middle = self.at((0.5, 0.5));
        let edge = self.edge(side);
        match side {
            Side::Below => {
                let place = (middle.0, edge + 2.9 * NUMBER);
                svg.label(&label, place, LABEL, Anchor::Middle);
            }
            Side::Left | Side::Right => {
                let place = (edge + outwards(side) * beside(&ticks), middle.1);
                svg.label(&label, place, LABEL, Anchor::Upwards);
            }
        }
    }

    fn tick(&self, svg: &mut Svg, side: Side, tick: &Tick) {
        let edge = self.edge(side);
        let share = if tick.label.is_some() { 0.43 } else { 0.23 };
        let end = edge + outwards(side) * NUMBER * share;
        let (x, y) = self.place_of_coordinates(tick.at, tick.at);
        let ends = match side {
            Side::Below => [(x, edge), (x, end)],
            Side::Left => [(end, y), (edge, y)],
            Side::Right => [(edge, y), (end, y)],
        };
        svg.line(&ends, Pen::solid(TEXT, 1.0));
        let Some(label) = &tick.label else {
            return;
        };
        match side {
            Side::Below => svg.label(label, (x, edge + 1.2 * NUMBER), NUMBER, Anchor::Middle),
            Side::Left => svg.label(label, (edge - 0.7 * NUMBER, y), NUMBER, Anchor::Right),
            Side::Right => svg.label(label, (edge + 0.7 * NUMBER, y), NUMBER, Anchor::Left),
        }
    }

    /// Returns the position in px of the edge of the frame on this side. The position is vertical
    /// for the lower edge, and horizontal for the left and the right edge.
    fn edge(&self, side: Side) -> f64 {
        match side {
            Side::Below => self.to.1,
            Side::Left => self.from.0,
            Side::Right => self.to.0,
        }
    }

    /// Returns the approximate number of ticks with labels on a side.
    fn ticks(&self, side: Side) -> usize {
        // A wide frame has more ticks on its horizontal axis, and a low frame has fewer on its
        // vertical axis.
        let room = if side == Side::Below {
            self.width() / 55.0
        } else {
            self.height() / 30.0
        };
        (room as usize).clamp(3, if side == Side::Below { 9 } else { TICKS })
    }

    /// Returns the width in px beside the frame that the numbers and the label of a vertical axis
    /// need.
    pub(super) fn room(&self, side: Side) -> f64 {
        let ticks = self.axes.y.ticks(self.ticks(side));
        beside(&ticks) + 0.7 * LABEL
    }
}

/// Returns the sign of the direction that points out of the frame on this side: −1 on the left,
/// otherwise 1.
fn outwards(side: Side) -> f64 {
    match side {
        Side::Below | Side::Right => 1.0,
        Side::Left => -1.0,
    }
}

/// Returns the distance in px from a vertical axis to the middle of its label. The label lies
/// beyond the widest number of the axis.
fn beside(ticks: &[Tick]) -> f64 {
    let widest = ticks
        .iter()
        .filter_map(|tick| tick.label.as_ref())
        .map(Label::width)
        .fold(0.0, f64::max);
    (widest + 1.9) * NUMBER
}
