//! A section: the mean along one axis with its confidence, and the same on a logarithmic scale in a corner.

use super::canvas::{Canvas, FAINT, INK, PAPER, Place, Stroke, stroke};
use super::frame::{Frame, NUMBER, Ruler};
use super::label::{axis_label, prefixed, quantity_label, symbol, value_label};
use super::legend::Legend;
use super::shades::NO_SPREAD;
use crate::study::figure::{AxisScale, Estimate, Figure, Panel};
use plotters::prelude::RGBColor;

/// Colours of curves and of their bands, told apart with any colour vision (after Okabe and Ito) and, dark beside
/// light, in grey; the signs at their points differ as well.
const CURVES: [(RGBColor, RGBColor, Sign); 5] = [
    (RGBColor(0, 84, 140), RGBColor(86, 180, 233), Sign::Dot),
    (RGBColor(213, 94, 0), RGBColor(245, 170, 110), Sign::Square),
    (RGBColor(0, 0, 0), RGBColor(150, 150, 150), Sign::Triangle),
    (RGBColor(0, 158, 115), RGBColor(120, 210, 180), Sign::Diamond),
    (RGBColor(170, 85, 140), RGBColor(220, 170, 205), Sign::Ring),
];
/// How much of the band covers what is below.
const BAND_OPACITY: f64 = 0.45;

/// The sign at the points of a curve.
#[derive(Clone, Copy)]
enum Sign {
    Dot,
    Square,
    Triangle,
    Diamond,
    Ring,
}

impl Sign {
    fn draw(self, canvas: &Canvas<'_>, (x, y): Place, radius: f64, colour: RGBColor) {
        let r = radius;
        match self {
            Sign::Dot => canvas.dot((x, y), r, colour),
            Sign::Square => canvas.rectangle((x - 0.9 * r, y - 0.9 * r), (x + 0.9 * r, y + 0.9 * r), colour),
            Sign::Triangle => {
                canvas.area(
                    &[(x, y - 1.2 * r), (x + 1.1 * r, y + 0.9 * r), (x - 1.1 * r, y + 0.9 * r)],
                    colour,
                    1.0,
                );
            }
            Sign::Diamond => {
                canvas.area(
                    &[(x, y - 1.3 * r), (x + 1.2 * r, y), (x, y + 1.3 * r), (x - 1.2 * r, y)],
                    colour,
                    1.0,
                );
            }
            Sign::Ring => {
                canvas.dot((x, y), 1.1 * r, colour);
                canvas.dot((x, y), 0.6 * r, PAPER);
            }
        }
    }
}

/// Decades a quantity must span before it is shown on a logarithmic scale as well.
const DECADES_FOR_INSET: f64 = 1.5;
/// Most decades of a logarithmic scale.
const MOST_DECADES: f64 = 12.0;
/// Widths and heights an inset may have, in shares of its panel; the first that fits is taken.
const INSETS: [(f64, f64); 4] = [(0.46, 0.42), (0.4, 0.4), (0.36, 0.48), (0.32, 0.34)];
/// How much further a scale goes, at the most, to make room for an inset: then even the highest curve has it.
const MOST_ROOM: f64 = 2.2;
/// Room on the left of an inset and below it for its numbers, px.
const INSET_AXES: (f64, f64) = (40.0, 20.0);

/// Draws one panel of a section into a rectangle; axes stand around it.
pub(super) fn draw(canvas: &Canvas<'_>, figure: &Figure, panel: &Panel, (from, to): (Place, Place)) {
    let curves = curves(figure, panel, panel.scale);
    let all: Vec<Point> = curves.iter().flatten().copied().collect();
    let across = around(figure.across.coordinates().into_iter(), 0.03);
    let mut up = heights(panel, panel.scale, &all);
    let mut frame = Frame { from, to, across, up };
    let inset = (panel.scale == AxisScale::Linear && spans_decades(panel)).then(|| {
        let mut place = corner(&frame, &curves);
        while place.is_none() && up.1 - up.0 < MOST_ROOM * (frame.up.1 - frame.up.0) {
            up.1 += 0.05 * (up.1 - up.0);
            place = corner(&Frame { up, ..frame }, &curves);
        }
        frame.up = up;
        place.unwrap_or_else(|| place_of_inset(&frame, INSETS[3], true))
    });
    for crossing in figure.crossings(panel) {
        let (x, _) = frame.place((crossing, up.0));
        canvas.line(&[(x, from.1), (x, to.1)], Stroke { colour: FAINT, width: 1.2, dashed: true });
    }
    draw_curves(canvas, &frame, &curves, 2.6);
    canvas.frame(from, to);
    frame.axis_left(canvas, &ruler(panel, &all, up.1), NUMBER);
    let axis = &figure.across;
    let (divisor, unit) = prefixed(&axis.unit, axis.values.iter().copied().fold(0.0, f64::max));
    let label = axis_label(axis, &unit);
    frame.axis_below(canvas, &Ruler { scale: axis.scale, divisor, label, most: 6 }, NUMBER);
    if let Some((from, to)) = inset {
        draw_inset(canvas, figure, panel, (from, to), across);
    }
}

/// The axis of the heights of these points, the highest of which are near `top`.
fn ruler(panel: &Panel, points: &[Point], top: f64) -> Ruler {
    let largest = points.iter().map(|point| point.high.abs().max(point.mean.abs())).fold(0.0, f64::max);
    let largest = if panel.scale == AxisScale::Logarithmic { 10_f64.powf(top) } else { largest };
    let (divisor, unit) = prefixed(&panel.quantity.unit, largest);
    let label = quantity_label(&panel.quantity, &unit);
    Ruler { scale: panel.scale, divisor, label, most: 6 }
}

/// Room that a panel takes on the left of its rectangle, px.
pub(super) fn room(figure: &Figure, panel: &Panel) -> f64 {
    let points = curves(figure, panel, panel.scale).concat();
    let up = heights(panel, panel.scale, &points);
    ruler(panel, &points, up.1).room(up, NUMBER)
}

/// The curves of a panel: one for each value of the series. Where they are all the same to the last bit, the
/// quantity does not depend on it, and one is enough.
pub(super) fn curves(figure: &Figure, panel: &Panel, scale: AxisScale) -> Vec<Vec<Point>> {
    let places = figure.across.coordinates();
    let all: Vec<_> = panel.estimates.chunks(places.len().max(1)).collect();
    let same = all.iter().all(|curve| *curve == all[0]);
    let shown = if same { &all[..all.len().min(1)] } else { &all[..] };
    shown.iter().map(|estimates| points(&places, estimates, scale)).collect()
}

/// A point of a curve, in the coordinates of the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub at: f64,
    pub mean: f64,
    pub low: f64,
    pub high: f64,
    /// Whether the one before it in the plan is missing.
    pub after_gap: bool,
}

/// The points that can be drawn on a scale. On a logarithmic one those that are not above zero cannot, and
/// confidence that reaches below goes down to the end of the scale.
fn points(places: &[f64], estimates: &[Option<Estimate>], scale: AxisScale) -> Vec<Point> {
    let mut points = Vec::new();
    let mut after_gap = false;
    for (&at, estimate) in places.iter().zip(estimates) {
        let drawn = estimate.filter(|estimate| scale == AxisScale::Linear || estimate.mean > 0.0);
        if let Some(Estimate { mean, low, high }) = drawn {
            let coordinate = |value: f64| match scale {
                AxisScale::Logarithmic if value <= 0.0 => -1e3,
                scale => scale.coordinate(value),
            };
            let [mean, low, high] = [mean, low, high].map(coordinate);
            points.push(Point { at, mean, low, high, after_gap });
        }
        after_gap = drawn.is_none();
    }
    points
}

/// From the lowest to the highest with a little room.
pub(super) fn around(values: impl Iterator<Item = f64>, room: f64) -> (f64, f64) {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let width = high - low;
    let spread = width > NO_SPREAD * low.abs().max(high.abs());
    let margin = if spread { room * width } else { (0.1 * low.abs()).max(1e-30) };
    (low - margin, high + margin)
}

/// The range of a scale of heights: from zero where nothing is below it and something is near.
pub(super) fn heights(panel: &Panel, scale: AxisScale, points: &[Point]) -> (f64, f64) {
    match scale {
        AxisScale::Linear => {
            let finite = |value: &f64| value.is_finite();
            let ends = points.iter().flat_map(|point| [point.low, point.high, point.mean]);
            let (low, high) = around(ends.filter(finite), 0.0);
            let (least, _) = around(points.iter().map(|point| point.mean).filter(finite), 0.0);
            // What is never below zero may have a confidence interval that is: it says nothing there.
            let from_zero = !panel.quantity.signed && least >= 0.0 && least <= 0.3 * high;
            let room = 0.05 * (high - if from_zero { 0.0 } else { low });
            (if from_zero { -0.6 * room } else { low - room }, high + room)
        }
        AxisScale::Logarithmic => {
            let (_, high) = around(points.iter().flat_map(|point| [point.mean, point.high]), 0.0);
            let (low, _) = around(points.iter().map(|point| point.mean), 0.0);
            let low = low.max(high - MOST_DECADES);
            let room = 0.05 * (high - low).max(0.1);
            (low - room, high + room)
        }
    }
}

/// The bands of confidence, and over them the lines and their points, each run of points by itself.
fn draw_curves(canvas: &Canvas<'_>, frame: &Frame, curves: &[Vec<Point>], radius: f64) {
    let clamped = |(x, y): (f64, f64)| frame.place((x, y.clamp(frame.up.0, frame.up.1)));
    let styled = || curves.iter().zip(CURVES.into_iter().cycle());
    let runs = |points: &'_ [Point]| -> Vec<Vec<Point>> {
        points.chunk_by(|_, next| !next.after_gap).map(<[Point]>::to_vec).collect()
    };
    for (points, (_, band, _)) in styled() {
        for run in runs(points) {
            let above = run.iter().map(|point| clamped((point.at, point.high)));
            let below = run.iter().rev().map(|point| clamped((point.at, point.low)));
            if let [point] = run[..] {
                let ends = [clamped((point.at, point.low)), clamped((point.at, point.high))];
                canvas.line(&ends, stroke(band, 2.0 * radius));
            } else {
                canvas.area(&above.chain(below).collect::<Vec<_>>(), band, BAND_OPACITY);
            }
        }
    }
    // Signs of neighbours do not touch where there are many.
    let most = curves.iter().map(Vec::len).max().unwrap_or(0).max(1) as f64;
    let radius = radius.min(0.3 * (frame.to.0 - frame.from.0) / most).max(0.9);
    for (points, (line, _, sign)) in styled() {
        for run in runs(points) {
            let places: Vec<_> = run.iter().map(|point| clamped((point.at, point.mean))).collect();
            if places.len() > 1 {
                canvas.line(&places, stroke(line, 0.6 * radius.max(2.0)));
            }
            places.into_iter().for_each(|place| sign.draw(canvas, place, radius, line));
        }
    }
}

/// Whether a quantity falls so far that a linear scale does not show it.
fn spans_decades(panel: &Panel) -> bool {
    let means = || panel.estimates.iter().flatten().map(|estimate| estimate.mean);
    let above = means().filter(|mean| *mean > 0.0);
    let lowest = above.clone().fold(f64::INFINITY, f64::min);
    let highest = above.fold(0.0, f64::max);
    means().all(|mean| mean >= 0.0) && (highest / lowest).log10() >= DECADES_FOR_INSET
}

/// Where an inset of this size goes: in the upper corner on the right or on the left.
fn place_of_inset(frame: &Frame, size: (f64, f64), right: bool) -> (Place, Place) {
    let (width, height) = (size.0 * (frame.to.0 - frame.from.0), size.1 * (frame.to.1 - frame.from.1));
    let left = if right { frame.to.0 - width - 10.0 } else { frame.from.0 + INSET_AXES.0 + 6.0 };
    let top = frame.from.1 + 10.0;
    ((left, top), (left + width, top + height))
}

/// The largest inset that has a corner which curve and band leave free.
fn corner(frame: &Frame, curves: &[Vec<Point>]) -> Option<(Place, Place)> {
    let place = |(x, y)| frame.place((x, f64::clamp(y, frame.up.0, frame.up.1)));
    let tops: Vec<Vec<Place>> = curves
        .iter()
        .map(|points| points.iter().map(|point| place((point.at, point.high.max(point.mean)))).collect())
        .collect();
    let sizes = INSETS.into_iter().flat_map(|size| [(size, true), (size, false)]);
    sizes.map(|(size, right)| place_of_inset(frame, size, right)).find(|(from, to)| {
        let (left, bottom) = (from.0 - INSET_AXES.0 - 4.0, to.1 + INSET_AXES.1 + 4.0);
        let in_the_way = |(x, y): &Place| (left..=to.0 + 10.0).contains(x) && *y < bottom;
        // A segment is in the way where an end of it is, or where it passes over the corner.
        let passes = |pair: &[Place]| {
            (0..=16).any(|step| {
                let at = |a: f64, b: f64| a + (b - a) * f64::from(step) / 16.0;
                in_the_way(&(at(pair[0].0, pair[1].0), at(pair[0].1, pair[1].1)))
            })
        };
        !tops.iter().any(|tops| tops.iter().any(in_the_way) || tops.windows(2).any(passes))
    })
}

fn draw_inset(
    canvas: &Canvas<'_>,
    figure: &Figure,
    panel: &Panel,
    (from, to): (Place, Place),
    across: (f64, f64),
) {
    let size = 0.8 * NUMBER;
    let curves = curves(figure, panel, AxisScale::Logarithmic);
    let up = heights(panel, AxisScale::Logarithmic, &curves.concat());
    let frame = Frame { from, to, across, up };
    canvas.rectangle((from.0 - INSET_AXES.0, from.1 - 3.0), (to.0 + 6.0, to.1 + INSET_AXES.1), PAPER);
    draw_curves(canvas, &frame, &curves, 1.7);
    canvas.line(&[from, (to.0, from.1), to, (from.0, to.1), from], stroke(INK, 0.8));
    let (divisor, _) = prefixed(&panel.quantity.unit, 10_f64.powf(up.1));
    let rulers = [AxisScale::Logarithmic, figure.across.scale].map(|scale| Ruler {
        scale,
        divisor: 1.0,
        label: String::new(),
        most: 4,
    });
    let [left, below] = rulers;
    frame.axis_left(canvas, &Ruler { divisor, ..left }, size);
    let axis = &figure.across;
    let (divisor, _) = prefixed(&axis.unit, axis.values.iter().copied().fold(0.0, f64::max));
    frame.axis_below(canvas, &Ruler { divisor, ..below }, size);
}

/// What a section shows, in one row; its width is returned, and nothing is drawn without a canvas.
pub(super) fn legend(canvas: Option<&Canvas<'_>>, figure: &Figure, (left, y): Place) -> f64 {
    let mut row = Legend::new(canvas, (left, y));
    let estimates = || figure.panels.iter().flat_map(|panel| panel.estimates.iter().flatten());
    let names = match &figure.series {
        Some(axis) => axis.values.iter().map(|value| value_label(axis, *value)).collect(),
        None => vec!["mean".to_owned()],
    };
    for (name, (line, _, sign)) in names.iter().zip(CURVES.into_iter().cycle()) {
        row.say(name, 28.0, |canvas, x| {
            canvas.line(&[(x, y), (x + 22.0, y)], stroke(line, 1.6));
            sign.draw(canvas, (x + 11.0, y), 2.6, line);
        });
    }
    if estimates().any(|estimate| estimate.high > estimate.low) {
        row.say("95 % confidence of the mean", 28.0, |canvas, x| {
            let (from, to) = ((x, y - 5.0), (x + 22.0, y + 5.0));
            canvas.area(&[from, (to.0, from.1), to, (from.0, to.1)], CURVES[0].1, BAND_OPACITY);
        });
    }
    let crosses = figure.panels.iter().any(|panel| !figure.crossings(panel).is_empty());
    if let Some(boundary) = figure.boundary.as_ref().filter(|_| crosses) {
        row.say(&symbol(&boundary.label), 16.0, |canvas, x| {
            let line = [(x + 5.0, y + 7.0), (x + 5.0, y - 7.0)];
            canvas.line(&line, Stroke { colour: FAINT, width: 1.2, dashed: true });
        });
    }
    row.width()
}
