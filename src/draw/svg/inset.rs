//! Place of an inset: a corner of its chart without curves.

use super::elements::Place;
use super::frame::Frame;
use crate::draw::axis::{Axis, Share};
use crate::draw::chart::{Chart, Shape};
use crate::draw::scale::Span;

/// Widths and heights of insets in shares of the chart; the first that fits is used.
const SIZES: [(f64, f64); 4] = [(0.46, 0.42), (0.4, 0.4), (0.36, 0.48), (0.32, 0.34)];
/// Largest factor by which the vertical axis grows for an inset.
const MOST_ROOM: f64 = 2.2;
/// Room for numbers on the left of an inset and below it, px.
pub(super) const AXES: (f64, f64) = (40.0, 20.0);

/// Vertical axis with room for the inset of a chart in a frame of this size.
pub(super) fn axis_with_room(chart: &Chart, frame: &Frame<'_>) -> Axis {
    let span = chart.y.span;
    let mut axis = chart.y.clone();
    while corner(chart, &Frame { y: &axis, ..*frame }).is_none()
        && axis.span.width() < MOST_ROOM * span.width()
    {
        axis.span = Span { high: axis.span.high + 0.05 * axis.span.width(), ..axis.span };
    }
    axis
}

/// Corners of the inset in a frame; in the upper right if no corner is free.
pub(super) fn place(chart: &Chart, frame: &Frame<'_>) -> (Place, Place) {
    corner(chart, frame).unwrap_or_else(|| in_corner(frame, SIZES[3], true))
}

fn in_corner(frame: &Frame<'_>, size: (f64, f64), right: bool) -> (Place, Place) {
    let (width, height) = (size.0 * frame.width(), size.1 * frame.height());
    let left = if right { frame.to.0 - width - 10.0 } else { frame.from.0 + AXES.0 + 6.0 };
    let top = frame.from.1 + 10.0;
    ((left, top), (left + width, top + height))
}

/// The largest inset in a corner without curves and bands.
fn corner(chart: &Chart, frame: &Frame<'_>) -> Option<(Place, Place)> {
    let tops: Vec<Vec<Place>> = chart
        .layers
        .iter()
        .map(|layer| match &layer.shape {
            Shape::Curve { points, .. } => {
                points.iter().filter_map(|point| frame.axes().place(*point)).collect()
            }
            Shape::Band(points) => {
                points.iter().filter_map(|(x, _, high)| frame.axes().place_at_end((*x, *high))).collect()
            }
            _ => Vec::new(),
        })
        .map(|places: Vec<Share>| places.into_iter().map(|place| frame.at(place)).collect())
        .collect();
    let sizes = SIZES.into_iter().flat_map(|size| [(size, true), (size, false)]);
    sizes.map(|(size, right)| in_corner(frame, size, right)).find(|(from, to)| {
        let (left, bottom) = (from.0 - AXES.0 - 4.0, to.1 + AXES.1 + 4.0);
        let in_the_way = |(x, y): &Place| (left..=to.0 + 10.0).contains(x) && *y < bottom;
        // A segment is in the way if one of its ends is, or if it crosses the corner.
        let passes = |pair: &[Place]| {
            (0..=16).any(|step| {
                let at = |a: f64, b: f64| a + (b - a) * f64::from(step) / 16.0;
                in_the_way(&(at(pair[0].0, pair[1].0), at(pair[0].1, pair[1].1)))
            })
        };
        !tops.iter().any(|tops| tops.iter().any(in_the_way) || tops.windows(2).any(passes))
    })
}
