//! Layers of a chart in its frame.

use super::canvas::{Canvas, Pen, Place};
use super::frame::Frame;
use crate::draw::axis::Axis;
use crate::draw::chart::{Contour, HeatMap, Layer, Shape, Sign, Stroke};
use crate::draw::colour::{Ink, Palette, Rgb, ink_on, shade};
use crate::draw::contour::contour;

pub(super) const TEXT: Rgb = Palette::LIGHT.foreground;
pub(super) const QUIET: Rgb = [0x96, 0x9c, 0xa2];
pub(super) const PAPER: Rgb = Palette::LIGHT.background;

/// Opacity of an area.
pub(super) const AREA_OPACITY: f64 = 0.25;
/// Least distance of two signs on a map, px.
const SIGN_DISTANCE: f64 = 13.0;
/// Half the size of a sign, px.
pub(super) const SIGN: f64 = 2.7;

/// Draws the layers, areas below lines.
pub(super) fn draw(canvas: &mut dyn Canvas, frame: &Frame<'_>, layers: &[Layer]) {
    let is_line = |layer: &&Layer| matches!(layer.shape, Shape::Curve { .. } | Shape::Envelope { .. });
    for layer in layers.iter().filter(|layer| !is_line(layer)).chain(layers.iter().filter(is_line)) {
        let colour = layer.ink.on_paper();
        match &layer.shape {
            Shape::Map(map) => heat_map(canvas, frame, map),
            Shape::Band(points) => band(canvas, frame, points, colour),
            Shape::Inside(border) => {
                let places: Vec<_> = border.iter().filter_map(|point| frame.place(*point)).collect();
                canvas.area(&places, colour, AREA_OPACITY);
            }
            Shape::Boxes(boxes) => {
                let corners = boxes.iter().filter_map(|((left, right), (low, high))| {
                    Some((frame.place((*left, *high))?, frame.place((*right, *low))?))
                });
                canvas.boxes(&corners.collect::<Vec<_>>(), colour);
            }
            Shape::Upright(x) => {
                if let Some((x, _)) = inside(frame.x, *x).then(|| frame.place_at_end((*x, 0.0))).flatten() {
                    canvas.line(&[(x, frame.from.1), (x, frame.to.1)], guide(layer.ink));
                }
            }
            Shape::Level(y) => {
                let low = frame.x.scale.number(frame.x.span.low);
                if let Some((_, y)) = inside(frame.y, *y).then(|| frame.place((low, *y))).flatten() {
                    canvas.line(&[(frame.from.0, y), (frame.to.0, y)], guide(layer.ink));
                }
            }
            Shape::Envelope { x, columns } => envelope(canvas, frame, *x, columns, colour),
            Shape::Curve { points, stroke, sign } => {
                let width = if frame.size < super::frame::NUMBER { 1.1 } else { 1.6 };
                let pen = stroke.map(|stroke| Pen { colour, width, stroke });
                let sign = sign.map(|sign| (sign, radius(frame, points.len())));
                curve(canvas, frame, points, pen, sign.map(|sign| (sign, colour)));
            }
        }
    }
}

fn inside(axis: &Axis, number: f64) -> bool {
    (0.0..=1.0).contains(&axis.share(number))
}

/// Pen of guide lines.
pub(super) fn guide(ink: Ink) -> Pen {
    let colour = if ink == Ink::Quiet { QUIET } else { ink.on_paper() };
    Pen { colour, width: 1.0, stroke: Stroke::Dashed }
}

/// Half the size of signs; smaller for many, so that neighbours do not touch.
fn radius(frame: &Frame<'_>, points: usize) -> f64 {
    let usual = if frame.size < super::frame::NUMBER { 1.7 } else { SIGN };
    usual.min(0.3 * frame.width() / points.max(1) as f64).max(0.9)
}

fn curve(
    canvas: &mut dyn Canvas,
    frame: &Frame<'_>,
    points: &[(f64, f64)],
    pen: Option<Pen>,
    sign: Option<((Sign, f64), Rgb)>,
) {
    let places: Vec<Option<Place>> = points.iter().map(|point| frame.place(*point)).collect();
    for run in places.split(Option::is_none) {
        let run: Vec<Place> = run.iter().flatten().copied().collect();
        if let Some(pen) = pen.filter(|_| run.len() > 1) {
            canvas.line(&run, pen);
        }
        if let Some(((sign, radius), colour)) = sign {
            run.iter().for_each(|place| draw_sign(canvas, sign, *place, radius, colour));
        }
    }
}

fn envelope(
    canvas: &mut dyn Canvas,
    frame: &Frame<'_>,
    (from, to): (f64, f64),
    columns: &[Option<(f64, f64)>],
    colour: Rgb,
) {
    let middle = |column: usize| from + (to - from) * (column as f64 + 0.5) / columns.len() as f64;
    let mut points = Vec::new();
    let mut last: Option<f64> = None;
    for (column, ends) in columns.iter().enumerate() {
        let Some((low, high)) = *ends else {
            points.push((middle(column), f64::NAN));
            last = None;
            continue;
        };
        // From the end nearer to the previous point of the line.
        let falls = last.is_some_and(|last| (last - high).abs() < (last - low).abs());
        let ends = if falls { [high, low] } else { [low, high] };
        points.extend(ends.map(|end| (middle(column), end)));
        last = Some(ends[1]);
    }
    let pen = Pen { colour, width: 1.2, stroke: Stroke::Solid };
    curve(canvas, frame, &points, Some(pen), None);
}

fn band(canvas: &mut dyn Canvas, frame: &Frame<'_>, points: &[(f64, f64, f64)], colour: Rgb) {
    let ends: Vec<Option<(Place, Place)>> = points
        .iter()
        .map(|(x, low, high)| {
            let is_known = low.is_finite() && high.is_finite();
            let high = frame.place_at_end((*x, *high)).filter(|_| is_known)?;
            Some((frame.place_at_end((*x, *low))?, high))
        })
        .collect();
    for run in ends.split(Option::is_none) {
        let run: Vec<(Place, Place)> = run.iter().flatten().copied().collect();
        match run[..] {
            [] => {}
            [(low, high)] => {
                let r = SIGN;
                let corners =
                    [(low.0 - r, low.1), (low.0 + r, low.1), (high.0 + r, high.1), (high.0 - r, high.1)];
                canvas.area(&corners, colour, AREA_OPACITY);
            }
            _ => {
                let lower = run.iter().rev().map(|ends| ends.0);
                let border: Vec<Place> = run.iter().map(|ends| ends.1).chain(lower).collect();
                canvas.area(&border, colour, AREA_OPACITY);
            }
        }
    }
}

/// Draws a sign of half this size.
pub(super) fn draw_sign(canvas: &mut dyn Canvas, sign: Sign, (x, y): Place, r: f64, colour: Rgb) {
    match sign {
        Sign::Dot => canvas.circle((x, y), r, colour, None),
        Sign::Ring => canvas.circle((x, y), r, PAPER, Some(Pen::solid(colour, 0.45 * r))),
        Sign::Square => canvas.rectangle((x - 0.9 * r, y - 0.9 * r), (x + 0.9 * r, y + 0.9 * r), colour),
        Sign::Up | Sign::Down => {
            let up = if sign == Sign::Up { r } else { -r };
            let corners = [(x, y - 1.2 * up), (x + 1.1 * r, y + 0.9 * up), (x - 1.1 * r, y + 0.9 * up)];
            canvas.area(&corners, colour, 1.0);
        }
        Sign::Diamond | Sign::HollowDiamond => {
            let corners = [(x, y - 1.3 * r), (x + 1.2 * r, y), (x, y + 1.3 * r), (x - 1.2 * r, y)];
            if sign == Sign::Diamond {
                canvas.area(&corners, colour, 1.0);
            } else {
                canvas.area(&corners, PAPER, 1.0);
                canvas.line(&[&corners[..], &corners[..1]].concat(), Pen::solid(colour, 0.45 * r));
            }
        }
        Sign::Cross => {
            let arm = 0.9 * r;
            for turn in [1.0, -1.0] {
                canvas.line(
                    &[(x - arm, y - turn * arm), (x + arm, y + turn * arm)],
                    Pen::solid(colour, 0.5 * r),
                );
            }
        }
    }
}

fn heat_map(canvas: &mut dyn Canvas, frame: &Frame<'_>, map: &HeatMap) {
    let columns = HeatMap::borders(frame.x.scale, &map.columns);
    let rows = HeatMap::borders(frame.y.scale, &map.rows);
    for (row, up) in rows.windows(2).enumerate() {
        for (column, across) in columns.windows(2).enumerate() {
            let lower = frame.place_of_coordinates((across[0], up[0]));
            let upper = frame.place_of_coordinates((across[1], up[1]));
            match map.values.get(row * map.columns.len() + column).copied().flatten() {
                // Half a pixel over the next cells, to avoid visible seams.
                Some(value) => {
                    let to = ((upper.0 + 0.5).min(frame.to.0), lower.1);
                    let from = (lower.0, (upper.1 - 0.5).max(frame.from.1));
                    canvas.rectangle(from, to, shade(map.key.share(value)));
                }
                None => canvas.line(&[lower, upper], Pen::solid(QUIET, 0.8)),
            }
        }
    }
    let coordinates = |axis: &Axis, values: &[f64]| -> Vec<f64> {
        values.iter().map(|value| axis.scale.coordinate(*value)).collect()
    };
    let (across, up) = (coordinates(frame.x, &map.columns), coordinates(frame.y, &map.rows));
    if let Some(Contour { field, level, .. }) = &map.contour {
        for line in contour(&across, &up, field, *level) {
            let places: Vec<_> = line.into_iter().map(|point| frame.place_of_coordinates(point)).collect();
            canvas.line(&places, Pen::solid(PAPER, 4.0));
            canvas.line(&places, Pen::solid(TEXT, 1.8));
        }
    }
    let every = |count: usize, pixels: f64| ((SIGN_DISTANCE * count as f64 / pixels).ceil() as usize).max(1);
    let (every_column, every_row) = (every(across.len(), frame.width()), every(up.len(), frame.height()));
    for (row, y) in up.iter().enumerate().skip(every_row / 2).step_by(every_row) {
        for (column, x) in across.iter().enumerate().skip(every_column / 2).step_by(every_column) {
            let index = row * across.len() + column;
            let class =
                map.classes.get(index).copied().flatten().and_then(|class| map.class_names.get(class));
            let value = map.values.get(index).copied().flatten();
            if let Some((class, value)) = class.zip(value) {
                let ink = ink_on(shade(map.key.share(value)));
                draw_sign(canvas, class.sign, frame.place_of_coordinates((*x, *y)), SIGN, ink);
            }
        }
    }
}
