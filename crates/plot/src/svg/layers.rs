//! Draws the layers of a chart into the frame of the chart.

use super::elements::{EMPTY, PAPER, Pen, Place, QUIET, Svg, TEXT};
use super::frame::Frame;
use crate::axis::ChartAxis;
use crate::chart::{Contour, HeatMap, Layer, Shape, Sign, Stroke};
use crate::colour::{Ink, Rgb, ink_on};
use crate::contour::contour;
use std::collections::BTreeMap;

pub(super) const AREA_OPACITY: f64 = 0.25;
/// Smallest distance in px between two class markers on a map.
const SIGN_DISTANCE: f64 = 13.0;
/// Half the size of a marker in px.
pub(super) const SIGN: f64 = 2.7;

/// Draws the layers of a chart into its frame. Areas come first, so that lines are drawn over them.
pub(super) fn draw(svg: &mut Svg, frame: &Frame<'_>, layers: &[Layer]) {
    for layer in layers.iter().filter(|layer| !is_line(layer)) {
        draw_layer(svg, frame, layer);
    }
    for layer in layers.iter().filter(|layer| is_line(layer)) {
        draw_layer(svg, frame, layer);
    }
}

fn is_line(layer: &Layer) -> bool {
    matches!(layer.shape, Shape::Curve { .. } | Shape::Envelope { .. })
}

fn draw_layer(svg: &mut Svg, frame: &Frame<'_>, layer: &Layer) {
    let place = |point| frame.axes.place(point).map(|share| frame.at(share));
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
        Shape::Upright(number) | Shape::Level(number) => {
            let is_vertical = matches!(layer.shape, Shape::Upright(_));
            if let Some(ends) = frame.axes.guide(*number, is_vertical) {
                svg.line(&ends.map(|end| frame.at(end)), guide(layer.ink));
            }
        }
        Shape::Envelope { x, columns } => {
            let pen = Pen {
                colour,
                width: 1.2,
                stroke: Stroke::Solid,
            };
            for run in frame.axes.envelope(*x, columns) {
                line(svg, &frame.places(run), pen);
            }
        }
        Shape::Curve {
            points,
            stroke,
            sign,
        } => {
            let radius = radius(frame, points.len());
            for run in frame.axes.runs(points.iter().copied()) {
                let places = frame.places(run);
                if let Some(stroke) = *stroke {
                    let pen = Pen {
                        colour,
                        width: 1.6,
                        stroke,
                    };
                    line(svg, &places, pen);
                }
                if let Some(sign) = *sign {
                    for place in places {
                        draw_sign(svg, sign, place, radius, colour);
                    }
                }
            }
        }
    }
}

/// Draws a line through these positions, if there are at least two.
fn line(svg: &mut Svg, places: &[Place], pen: Pen) {
    if places.len() > 1 {
        svg.line(places, pen);
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

/// Returns half the size in px of the markers of a curve with this number of points. Markers are
/// smaller if there are many points, so that neighbouring markers do not touch.
fn radius(frame: &Frame<'_>, points: usize) -> f64 {
    SIGN.min(0.3 * frame.width() / points.max(1) as f64)
        .max(0.9)
}

fn band(svg: &mut Svg, frame: &Frame<'_>, points: &[(f64, f64, f64)], colour: Rgb) {
    let ends: Vec<Option<(Place, Place)>> = points
        .iter()
        .map(|point| ends_of_band(frame, *point))
        .collect();
    for run in ends.split(Option::is_none) {
        let run: Vec<(Place, Place)> = run.iter().flatten().copied().collect();
        match run[..] {
            [] => {}
            [(low, high)] => {
                let corners = [
                    (low.0 - SIGN, low.1),
                    (low.0 + SIGN, low.1),
                    (high.0 + SIGN, high.1),
                    (high.0 - SIGN, high.1),
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

/// Returns the positions of the lower and the upper end of a band at one x. An end without a
/// coordinate, such as 0 on a logarithmic axis, gets the position of the end of the axis. `None` if
/// one of the two ends is NaN or infinite.
fn ends_of_band(frame: &Frame<'_>, point: (f64, f64, f64)) -> Option<(Place, Place)> {
    let (x, low, high) = point;
    if !low.is_finite() || !high.is_finite() {
        return None;
    }
    let low = frame.axes.place_at_end((x, low))?;
    let high = frame.axes.place_at_end((x, high))?;
    Some((frame.at(low), frame.at(high)))
}

/// Draws a marker. `r` is half the size of the marker in px.
pub(super) fn draw_sign(svg: &mut Svg, sign: Sign, place: Place, r: f64, colour: Rgb) {
    let (x, y) = place;
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
            let is_turned = matches!(sign, Sign::Left | Sign::Right);
            let corners = [(0.0, -1.2 * up), (1.1 * r, 0.9 * up), (-1.1 * r, 0.9 * up)];
            let corners = corners.map(|(dx, dy)| {
                if is_turned {
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
                let outline = [&corners[..], &corners[..1]].concat();
                svg.line(&outline, Pen::solid(colour, 0.45 * r));
            }
        }
        Sign::Cross => {
            let arm = 0.9 * r;
            for turn in [1.0, -1.0] {
                let ends = [(x - arm, y - turn * arm), (x + arm, y + turn * arm)];
                svg.line(&ends, Pen::solid(colour, 0.5 * r));
            }
        }
    }
}

fn heat_map(svg: &mut Svg, frame: &Frame<'_>, map: &HeatMap) {
    draw_cells(svg, frame, map);
    let columns = coordinates(frame.axes.x, &map.columns);
    let rows = coordinates(frame.axes.y, &map.rows);
    if let Some(Contour { field, level, .. }) = &map.contour {
        let pieces: Vec<[Place; 2]> = contour(&columns, &rows, field, *level)
            .into_iter()
            .map(|ends| ends.map(|(x, y)| frame.place_of_coordinates(x, y)))
            .collect();
        svg.pieces(&pieces, Pen::solid(PAPER, 4.0));
        svg.pieces(&pieces, Pen::solid(TEXT, 1.8));
    }
    draw_classes(svg, frame, map, &columns, &rows);
}

fn draw_cells(svg: &mut Svg, frame: &Frame<'_>, map: &HeatMap) {
    let columns = HeatMap::borders(frame.axes.x.scale, &map.columns);
    let rows = HeatMap::borders(frame.axes.y.scale, &map.rows);
    let shades: Vec<Option<usize>> = map
        .values
        .iter()
        .map(|value| value.map(|value| map.shade(value)))
        .collect();
    // One path contains all cells of a colour, so that the document is short. If the values of a
    // few cells change, only a few lines of the document change.
    let mut boxes: BTreeMap<Option<usize>, Vec<(Place, Place)>> = BTreeMap::new();
    for (cells, up) in shades.chunks(map.columns.len().max(1)).zip(rows.windows(2)) {
        let mut column = 0;
        for alike in cells.chunk_by(|cell, next| cell == next) {
            let from = frame.place_of_coordinates(columns[column], up[1]);
            column += alike.len();
            let to = frame.place_of_coordinates(columns[column], up[0]);
            boxes.entry(alike[0]).or_default().push((from, to));
        }
    }
    for (shade, boxes) in boxes {
        let colour = shade.map_or(EMPTY, |shade| map.shades.of_band(shade));
        svg.boxes(boxes.into_iter(), colour);
    }
}

/// Draws the markers of the classes of a map. `columns` and `rows` are the coordinates of the
/// middles of the columns and rows of cells.
fn draw_classes(svg: &mut Svg, frame: &Frame<'_>, map: &HeatMap, columns: &[f64], rows: &[f64]) {
    let every_column = distance_of_signs(columns.len(), frame.width());
    let every_row = distance_of_signs(rows.len(), frame.height());
    for row in (every_row / 2..rows.len()).step_by(every_row) {
        for column in (every_column / 2..columns.len()).step_by(every_column) {
            let index = row * columns.len() + column;
            let class = map.classes.get(index).copied().flatten();
            let value = map.values.get(index).copied().flatten();
            if let Some(class) = class.and_then(|class| map.class_names.get(class))
                && let Some(value) = value
            {
                let ink = ink_on(map.colour(value));
                let place = frame.place_of_coordinates(columns[column], rows[row]);
                draw_sign(svg, class.sign, place, SIGN, ink);
            }
        }
    }
}

/// Returns the distance between two neighbouring markers as a number of cells, if `cells` cells
/// have a total length of `pixels` px.
fn distance_of_signs(cells: usize, pixels: f64) -> usize {
    ((SIGN_DISTANCE * cells as f64 / pixels).ceil() as usize).max(1)
}

fn coordinates(axis: &ChartAxis, values: &[f64]) -> Vec<f64> {
    values
        .iter()
        .map(|value| axis.scale.coordinate(*value))
        .collect()
}
