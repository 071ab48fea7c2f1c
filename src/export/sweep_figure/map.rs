//! A map: a coloured cell for each pair of values, with the boundary of adhesion without a load and the
//! regimes.

use super::canvas::{Canvas, FAINT, INK, PAPER, Place, stroke};
use super::contour::contour;
use super::frame::{Frame, NUMBER, Ruler};
use super::label::{axis_label, prefixed, quantity_label, symbol};
use super::legend::Legend;
use super::shades::{Shades, ink_on, shade};
use crate::analysis::Regime;
use crate::study::figure::{AxisScale, Figure, FigureAxis, Panel};
use plotters::prelude::RGBColor;

/// Least distance of two signs of regimes, px.
const SIGN_DISTANCE: f64 = 13.0;
/// Half the size of a sign, px.
const SIGN: f64 = 2.9;
/// Distance of the scale of colours from its map, and its width, px.
const FROM_MAP: f64 = 14.0;
const BAR: f64 = 13.0;
/// Stripes of the scale of colours.
const STRIPES: u32 = 128;

/// Draws one panel of a map into the rectangle of its cells; axes and scale stand around it.
pub(super) fn draw(
    canvas: &Canvas<'_>,
    figure: &Figure,
    up: &FigureAxis,
    panel: &Panel,
    (from, to): (Place, Place),
) {
    let (columns, rows) = (borders(&figure.across), borders(up));
    let ends = |borders: &[f64]| (borders[0], borders[borders.len() - 1]);
    let frame = Frame { from, to, across: ends(&columns), up: ends(&rows) };
    let shades = shades_of(panel);
    for row in 0..rows.len() - 1 {
        for column in 0..columns.len() - 1 {
            let estimate = panel.estimates.get(row * (columns.len() - 1) + column).copied().flatten();
            let lower = frame.place((columns[column], rows[row]));
            let upper = frame.place((columns[column + 1], rows[row + 1]));
            match estimate {
                // Half a pixel over the next ones, so that no seam is seen between them.
                Some(estimate) => {
                    let to = ((upper.0 + 0.5).min(frame.to.0), lower.1);
                    let from = (lower.0, (upper.1 - 0.5).max(frame.from.1));
                    canvas.rectangle(from, to, shades.colour(estimate.mean));
                }
                None => canvas.line(&[lower, upper], stroke(FAINT, 0.8)),
            }
        }
    }
    if let Some(boundary) = figure.boundary_of(panel) {
        let (across, up) = (figure.across.coordinates(), up.coordinates());
        for line in contour(&across, &up, &boundary.values, boundary.level) {
            let places: Vec<_> = line.into_iter().map(|point| frame.place(point)).collect();
            canvas.line(&places, stroke(PAPER, 4.0));
            canvas.line(&places, stroke(INK, 1.8));
        }
    }
    signs(canvas, figure, up, panel, &frame, &shades);
    canvas.frame(from, to);
    axes(canvas, figure, up, &frame);
    scale_of_colours(canvas, panel, &frame, shades);
}

fn signs(
    canvas: &Canvas<'_>,
    figure: &Figure,
    up: &FigureAxis,
    panel: &Panel,
    frame: &Frame,
    shades: &Shades,
) {
    let (across, up) = (figure.across.coordinates(), up.coordinates());
    let every = |count: usize, pixels: f64| ((SIGN_DISTANCE * count as f64 / pixels).ceil() as usize).max(1);
    let every_column = every(across.len(), frame.to.0 - frame.from.0);
    let every_row = every(up.len(), frame.to.1 - frame.from.1);
    for (row, y) in up.iter().enumerate().skip(every_row / 2).step_by(every_row) {
        for (column, x) in across.iter().enumerate().skip(every_column / 2).step_by(every_column) {
            let index = row * across.len() + column;
            let Some(regime) = figure.regimes.get(index).copied().flatten() else { continue };
            // What has no value has no sign.
            let Some(estimate) = panel.estimates.get(index).copied().flatten() else { continue };
            sign(canvas, regime, frame.place((*x, *y)), ink_on(shades.colour(estimate.mean)));
        }
    }
}

/// The sign of a regime: a dot, a triangle, a cross.
pub(super) fn sign(canvas: &Canvas<'_>, regime: Regime, (x, y): Place, ink: RGBColor) {
    match regime {
        Regime::PressureInsensitive => canvas.dot((x, y), 0.9 * SIGN, ink),
        Regime::PressureSensitive => {
            let corners = [(x, y - 1.1 * SIGN), (x + SIGN, y + 0.8 * SIGN), (x - SIGN, y + 0.8 * SIGN)];
            canvas.area(&corners, ink, 1.0);
        }
        Regime::NonAdhesive => {
            let arm = 0.85 * SIGN;
            canvas.line(&[(x - arm, y - arm), (x + arm, y + arm)], stroke(ink, 1.3));
            canvas.line(&[(x - arm, y + arm), (x + arm, y - arm)], stroke(ink, 1.3));
        }
    }
}

fn axes(canvas: &Canvas<'_>, figure: &Figure, up: &FigureAxis, frame: &Frame) {
    frame.axis_below(canvas, &ruler(&figure.across), NUMBER);
    frame.axis_left(canvas, &ruler(up), NUMBER);
}

fn ruler(axis: &FigureAxis) -> Ruler {
    let (divisor, unit) = prefixed(&axis.unit, axis.values.iter().copied().fold(0.0, f64::max));
    Ruler { scale: axis.scale, divisor, label: axis_label(axis, &unit), most: 6 }
}

/// Room that a panel takes on the left and on the right of its rectangle, px.
pub(super) fn rooms(up: &FigureAxis, panel: &Panel) -> (f64, f64) {
    let borders = borders(up);
    let left = ruler(up).room((borders[0], borders[borders.len() - 1]), NUMBER);
    let shades = shades_of(panel);
    let right = FROM_MAP + BAR + ruler_of_colours(panel, shades).room((shades.low, shades.high), NUMBER);
    (left, right)
}

fn shades_of(panel: &Panel) -> Shades {
    Shades::over(panel.scale, panel.estimates.iter().flatten().map(|estimate| estimate.mean))
}

fn scale_of_colours(canvas: &Canvas<'_>, panel: &Panel, map: &Frame, shades: Shades) {
    let left = map.to.0 + FROM_MAP;
    let bar = Frame {
        from: (left, map.from.1),
        to: (left + BAR, map.to.1),
        across: (0.0, 1.0),
        up: (shades.low, shades.high),
    };
    let height = bar.to.1 - bar.from.1;
    for stripe in 0..STRIPES {
        let share = |stripe: u32| f64::from(stripe) / f64::from(STRIPES);
        let (bottom, top) = (bar.to.1 - height * share(stripe), bar.to.1 - height * share(stripe + 1));
        let top = (top - 0.5).max(bar.from.1);
        let middle = f64::midpoint(share(stripe), share(stripe + 1));
        canvas.rectangle((bar.from.0, top), (bar.to.0, bottom), shade(middle));
    }
    canvas.frame(bar.from, bar.to);
    bar.axis_right(canvas, &ruler_of_colours(panel, shades), NUMBER);
}

fn ruler_of_colours(panel: &Panel, shades: Shades) -> Ruler {
    let largest = match shades.scale {
        AxisScale::Linear => shades.high.abs().max(shades.low.abs()),
        AxisScale::Logarithmic => 10_f64.powf(shades.high),
    };
    let (divisor, unit) = prefixed(&panel.quantity.unit, largest);
    let label = quantity_label(&panel.quantity, &unit);
    Ruler { scale: shades.scale, divisor, label, most: 6 }
}

/// Borders of the cells of an axis, in its coordinate: halfway between its values.
fn borders(axis: &FigureAxis) -> Vec<f64> {
    let places = axis.coordinates();
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return vec![0.0, 1.0] };
    let halves = |pair: &[f64]| f64::midpoint(pair[0], pair[1]);
    let between: Vec<f64> = places.windows(2).map(halves).collect();
    let (before, after) = match (between.first(), between.last()) {
        (Some(second), Some(before_last)) => (2.0 * first - second, 2.0 * last - before_last),
        _ => (first - 0.5, last + 0.5),
    };
    [vec![before], between, vec![after]].concat()
}

/// What a map shows, in one row; its width is returned, and nothing is drawn without a canvas.
pub(super) fn legend(canvas: Option<&Canvas<'_>>, figure: &Figure, (left, y): Place) -> f64 {
    let mut row = Legend::new(canvas, (left, y));
    for regime in [Regime::PressureInsensitive, Regime::PressureSensitive, Regime::NonAdhesive] {
        if figure.regimes.contains(&Some(regime)) {
            row.say(regime.name(), 12.0, |canvas, x| sign(canvas, regime, (x + SIGN, y), INK));
        }
    }
    if let Some(boundary) = &figure.boundary {
        row.say(&symbol(&boundary.label), 28.0, |canvas, x| {
            canvas.line(&[(x, y), (x + 22.0, y)], stroke(INK, 1.8));
        });
    }
    if figure.panels.iter().any(|panel| panel.estimates.contains(&None)) {
        row.say("no value", 18.0, |canvas, x| {
            let (from, to) = ((x, y - 6.0), (x + 12.0, y + 6.0));
            canvas.line(&[from, (to.0, from.1), to, (from.0, to.1), from], stroke(FAINT, 0.8));
            canvas.line(&[(from.0, to.1), (to.0, from.1)], stroke(FAINT, 0.8));
        });
    }
    row.width()
}
