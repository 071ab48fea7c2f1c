//! Legend of a figure: rows of entries. An entry has a name and short samples of the layers with
//! this name.

use super::elements::{Anchor, EMPTY, Pen, Place, Svg};
use super::layers::{AREA_OPACITY, SIGN, draw_sign, guide};
use crate::chart::{Entry, Sample};
use crate::label::Label;

/// Font size of the names in px.
const SIZE: f64 = 11.5;
/// Distance in px between two entries of a row.
const BETWEEN: f64 = 20.0;
/// Height of a row in px.
const ROW: f64 = 20.0;

/// Entry of the legend, with its width in px and the lines of its name.
struct PlacedEntry<'a> {
    entry: &'a Entry,
    width: f64,
    lines: Vec<Label>,
}

/// Entries side by side, and their total width in px.
struct Row<'a> {
    entries: Vec<PlacedEntry<'a>>,
    width: f64,
}

/// Draws the entries in rows of at most `most` px. The rows are centred at x = `middle` and begin
/// at y = `top`, in px. Returns the y of the lower end of the legend in px.
pub(super) fn draw(svg: &mut Svg, entries: &[Entry], middle: f64, top: f64, most: f64) -> f64 {
    let mut y = top;
    for row in rows(entries, most) {
        let mut x = middle - row.width / 2.0;
        let most_lines = row.entries.iter().map(|entry| entry.lines.len()).max();
        for PlacedEntry {
            entry,
            width,
            lines,
        } in row.entries
        {
            sample(svg, entry, (x, y + ROW / 2.0));
            svg.lines(&lines, (x + room(entry), y + ROW / 2.0), SIZE, Anchor::Left);
            x += width + BETWEEN;
        }
        y += ROW + (most_lines.unwrap_or(1) - 1) as f64 * 1.4 * SIZE;
    }
    y
}

/// Divides the entries into rows that are at most `most` px wide.
fn rows(entries: &[Entry], most: f64) -> Vec<Row<'_>> {
    let mut rows: Vec<Row<'_>> = Vec::new();
    for entry in entries {
        let lines = entry.name.wrapped((most - room(entry)) / SIZE);
        let width = room(entry) + SIZE * lines.iter().map(Label::width).fold(0.0, f64::max);
        let placed = PlacedEntry {
            entry,
            width,
            lines,
        };
        match rows.last_mut() {
            Some(row) if row.width + BETWEEN + width <= most => {
                row.width += BETWEEN + width;
                row.entries.push(placed);
            }
            _ => rows.push(Row {
                entries: vec![placed],
                width,
            }),
        }
    }
    rows
}

/// Returns the width in px of the samples of an entry.
fn room(entry: &Entry) -> f64 {
    match entry.samples[..] {
        [(_, Sample::Guide)] => 16.0,
        [(_, Sample::Line(None, _))] => 12.0,
        [(_, Sample::Empty)] => 18.0,
        _ => 28.0,
    }
}

fn sample(svg: &mut Svg, entry: &Entry, place: Place) {
    let (x, y) = place;
    let part = 22.0 / entry.samples.len().max(1) as f64;
    for (index, (ink, sample)) in entry.samples.iter().enumerate() {
        let colour = ink.on_paper();
        let left = x + index as f64 * part;
        match sample {
            Sample::Line(None, Some(sign)) if entry.samples.len() == 1 => {
                draw_sign(svg, *sign, (x + SIGN, y), SIGN, colour);
            }
            Sample::Line(stroke, sign) => {
                if let Some(stroke) = stroke {
                    let pen = Pen {
                        colour,
                        width: 1.6,
                        stroke: *stroke,
                    };
                    svg.line(&[(left, y), (left + part, y)], pen);
                }
                if let Some(sign) = sign {
                    draw_sign(svg, *sign, (left + part / 2.0, y), SIGN, colour);
                }
            }
            Sample::Area | Sample::Solid => {
                let right = left + part;
                let top = y - 5.0;
                let bottom = y + 5.0;
                let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
                let opacity = if *sample == Sample::Area {
                    AREA_OPACITY
                } else {
                    1.0
                };
                svg.area(&corners, colour, opacity);
            }
            Sample::Guide => svg.line(&[(x + 5.0, y + 7.0), (x + 5.0, y - 7.0)], guide(*ink)),
            Sample::Contour => svg.line(&[(x, y), (x + 22.0, y)], Pen::solid(colour, 1.8)),
            Sample::Empty => {
                svg.rectangle((x, y - 6.0), (x + 12.0, y + 6.0), EMPTY);
            }
        }
    }
}
