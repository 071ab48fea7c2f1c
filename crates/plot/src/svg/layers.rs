//! Layers of a chart, drawn into its frame.

use super::elements::{EMPTY, PAPER, Pen, Place, QUIET, Svg, TEXT};
use super::frame::Frame;
use crate::axis::{ChartAxis, Share};
use crate::chart::{Contour, HeatMap, Layer, Shape, Sign, Stroke};
use crate::colour::{Ink, Rgb, ink_on};
use crate::contour::contour;
use std::collections::BTreeMap;

pub(super) const AREA_OPACITY: f64 = 0.25;
/// Smallest distance of two signs on a map, px.
const SIGN_DISTANCE: f64 = 13.0;
/// Half the size of a sign, px.
pub(super) const SIGN: f64 = 2.7;

/// Draws the layers of a chart, areas below lines.
pub(super) fn draw(svg: &mut Svg, frame: &Frame<'_>, layers: &[Layer]) {
    let place = |point| frame.axes.place(point).map(|place| frame.at(place));
    let is_line =
        |layer: &&Layer| matches!(layer.shape, Shape::Curve { .. } | Shape::Envelope { .. });
    for layer in layers
        .iter()
        .filter(|layer| !is_line(layer))
        .chain(layers.iter().filter(is_line))
    {
        let colour = layer.ink.on_paper();
        match &layer.shape {
            Shape::Map(map) => heat_map(svg, frame, map),
            Shape::Band(points) => band(svg, frame, points, colour),
            Shape::Inside(border) => {
                let places: Vec<_> = border.iter().filter_map(|point| place(*point)).collect();
                svg.area(&places, colour, AREA_OPACITY);
            }
            Shape::Boxes(boxes) => {
                let corners = boxes.iter().filter_map(|((left, right), (low, high))| {
                    Some((place((*left, *high))?, place((*right, *low))?))
                });
                svg.boxes(corners, colour);
            }
            Shape::Upright(at) | Shape::Level(at) => {
                let ends = frame
                    .axes
                    .guide(*at, matches!(layer.shape, Shape::Upright(_)));
                ends.iter()
                    .for_each(|ends| svg.line(&ends.map(|end| frame.at(end)), guide(layer.ink)));
            }
            Shape::Envelope { x, columns } => {
                let pen = Pen {
                    colour,
                    width: 1.2,
                    stroke: Stroke::Solid,
                };
                curve(
                    svg,
                    frame,
                    frame.axes.envelope(*x, columns),
                    Some(pen),
                    None,
                );
            }
            Shape::Curve {
                points,
                stroke,
                sign,
            } => {
                let pen = stroke.map(|stroke| Pen {
                    colour,
                    width: 1.6,
                    stroke,
                });
                let sign = sign.map(|sign| (sign, radius(frame, points.len())));
                let runs = frame.axes.runs(points.iter().copied());
                curve(svg, frame, runs, pen, sign.map(|sign| (sign, colour)));
            }
        }
    }
}

pub(super) fn guide(ink: Ink) -> Pen {
    let colour = if ink == Ink::Quiet {
        QUIET
    } else {
        ink.on_paper()
    };
    Pen {
        colour,
        width: 1.0,
        stroke: Stroke::Dashed,
    }
}

/// Returns half the size in px of the signs of a curve. Many points have smaller signs, so that
/// neighbours do not touch.
fn radius(frame: &Frame<'_>, points: usize) -> f64 {
    SIGN.min(0.3 * frame.width() / points.max(1) as f64)
        .max(0.9)
}

fn curve(
    svg: &mut Svg,
    frame: &Frame<'_>,
    runs: Vec<Vec<Share>>,
    pen: Option<Pen>,
    sign: Option<((Sign, f64), Rgb)>,
) {
    for run in runs {
        let run: Vec<Place> = run.into_iter().map(|place| frame.at(place)).collect();
        if let Some(pen) = pen.filter(|_| run.len() > 1) {
            svg.line(&run, pen);
        }
        if let Some(((sign, radius), colour)) = sign {
            run.iter()
                .for_each(|place| draw_sign(svg, sign, *place, radius, colour));
        }
    }
}

fn band(svg: &mut Svg, frame: &Frame<'_>, points: &[(f64, f64, f64)], colour: Rgb) {
    let ends: Vec<Option<(Place, Place)>> = points
        .iter()
        .map(|(x, low, high)| {
            let is_known = low.is_finite() && high.is_finite();
            let place = |y| {
                frame
                    .axes
                    .place_at_end((*x, y))
                    .map(|place| frame.at(place))
            };
            let high = place(*high).filter(|_| is_known)?;
            Some((place(*low)?, high))
        })
        .collect();
    for run in ends.split(Option::is_none) {
        let run: Vec<(Place, Place)> = run.iter().flatten().copied().collect();
        match run[..] {
            [] => {}
            [(low, high)] => {
                let r = SIGN;
                let corners = [
                    (low.0 - r, low.1),
                    (low.0 + r, low.1),
                    (high.0 + r, high.1),
                    (high.0 - r, high.1),
                ];
                svg.area(&corners, colour, AREA_OPACITY);
            }
            _ => {
                let lower = run.iter().rev().map(|ends| ends.0);
                let border: Vec<Place> = run.iter().map(|ends| ends.1).chain(lower).collect();
                svg.area(&border, colour, AREA_OPACITY);
            }
        }
    }
}

/// Draws a sign with half the size `r`, px.
pub(super) fn draw_sign(svg: &mut Svg, sign: Sign, (x, y): Place, r: f64, colour: Rgb) {
    match sign {
        Sign::Dot => svg.circle((x, y), r, colour, None),
        Sign::Point => svg.circle((x, y), 0.4 * r, colour, None),
        Sign::Ring => svg.circle((x, y), r, PAPER, Some(Pen::solid(colour, 0.45 * r))),
        Sign::Square => svg.rectangle(
            (x - 0.9 * r, y - 0.9 * r),
            (x + 0.9 * r, y + 0.9 * r),
            colour,
        ),
        Sign::Up | Sign::Down | Sign::Left | Sign::Right => {
            let up = if matches!(sign, Sign::Up | Sign::Left) {
                r
            } else {
                -r
            };
            let corners = [(0.0, -1.2 * up), (1.1 * r, 0.9 * up), (-1.1 * r, 0.9 * up)];
            let turns = matches!(sign, Sign::Left | Sign::Right);
            let corners = corners.map(|(dx, dy)| {
                if turns {
                    (x + dy, y + dx)
                } else {
                    (x + dx, y + dy)
                }
            });
            svg.area(&corners, colour, 1.0);
        }
        Sign::Diamond | Sign::HollowDiamond => {
            let corners = [
                (x, y - 1.3 * r),
                (x + 1.2 * r, y),
                (x, y + 1.3 * r),
                (x - 1.2 * r, y),
            ];
            if sign == Sign::Diamond {
                svg.area(&corners, colour, 1.0);
            } else {
                svg.area(&corners, PAPER, 1.0);
                svg.line(
                    &[&corners[..], &corners[..1]].concat(),
                    Pen::solid(colour, 0.45 * r),
                );
            }
        }
        Sign::Cross => {
            let arm = 0.9 * r;
            for turn in [1.0, -1.0] {
                svg.line(
                    &[(x - arm, y - turn * arm), (x + arm, y + turn * arm)],
                    Pen::solid(colour, 0.5 * r),
                );
            }
        }
    }
}

fn heat_map(svg: &mut Svg, frame: &Frame<'_>, map: &HeatMap) {
    let columns = HeatMap::borders(frame.axes.x.scale, &map.columns);
    let rows = HeatMap::borders(frame.axes.y.scale, &map.rows);
    // One path for each shade: a figure has few lines, and changes of a few cells change few of
    // them.
    let mut boxes: BTreeMap<Option<usize>, Vec<(Place, Place)>> = BTreeMap::new();
    let shades: Vec<Option<usize>> = map
        .values
        .iter()
        .map(|value| value.map(|value| map.shade(value)))
        .collect();
    for (cells, up) in shades.chunks(map.columns.len().max(1)).zip(rows.windows(2)) {
        let mut column = 0;
        for alike in cells.chunk_by(|one, next| one == next) {
            let from = frame.place_of_coordinates((columns[column], up[1]));
            column += alike.len();
            let to = frame.place_of_coordinates((columns[column], up[0]));
            boxes.entry(alike[0]).or_default().push((from, to));
        }
    }
    for (shade, boxes) in boxes {
        svg.boxes(
            boxes.into_iter(),
            shade.map_or(EMPTY, |shade| map.shades.of_band(shade)),
        );
    }
    let coordinates = |axis: &ChartAxis, values: &[f64]| -> Vec<f64> {
        values
            .iter()
            .map(|value| axis.scale.coordinate(*value))
            .collect()
    };
    let (across, up) = (
        coordinates(frame.axes.x, &map.columns),
        coordinates(frame.axes.y, &map.rows),
    );
    if let Some(Contour { field, level, .. }) = &map.contour {
        let pieces = contour(&across, &up, field, *level);
        let pieces = pieces
            .into_iter()
            .map(|ends| ends.map(|end| frame.place_of_coordinates(end)));
        svg.pieces(pieces.clone(), Pen::solid(PAPER, 4.0));
        svg.pieces(pieces, Pen::solid(TEXT, 1.8));
    }
    let every = |count: usize, pixels: f64| {
        ((SIGN_DISTANCE * count as f64 / pixels).ceil() as usize).max(1)
    };
    let (every_column, every_row) = (
        every(across.len(), frame.width()),
        every(up.len(), frame.height()),
    );
    for (row, y) in up.iter().enumerate().skip(every_row / 2).step_by(every_row) {
        for (column, x) in across
            .iter()
            .enumerate()
            .skip(every_column / 2)
            .step_by(every_column)
        {
            let index = row * across.len() + column;
            let class = map
                .classes
                .get(index)
                .copied()
                .flatten()
                .and_then(|class| map.class_names.get(class));
            let value = map.values.get(index).copied().flatten();
            if let Some((class, value)) = class.zip(value) {
                let ink = ink_on(map.colour(value));
                draw_sign(
                    svg,
                    class.sign,
                    frame.place_of_coordinates((*x, *y)),
                    SIGN,
                    ink,
                );
            }
        }
    }
}
