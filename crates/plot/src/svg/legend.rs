//! Legend of a figure: rows of samples with names.

use super::elements::{Anchor, EMPTY, Pen, Place, Svg};
use super::layers::{AREA_OPACITY, SIGN, draw_sign, guide};
use crate::chart::{Entry, Sample};
use crate::label::Label;

/// Font size of the names, px.
const SIZE: f64 = 11.5;
/// Distance between two entries of a row, px.
const BETWEEN: f64 = 20.0;
/// Height of a row, px.
const ROW: f64 = 20.0;

/// Entry with its width in px and the lines of its name.
type Named<'a> = (f64, &'a Entry, Vec<Label>);

/// Draws the entries in rows centred on `middle` and no wider than `most` px. Returns the height of
/// their lower end.
pub(super) fn draw(svg: &mut Svg, entries: &[Entry], (middle, top): Place, most: f64) -> f64 {
    let mut rows: Vec<(f64, Vec<Named<'_>>)> = Vec::new();
    for entry in entries {
        let lines = entry.name.wrapped((most - room(entry)) / SIZE);
        let own = room(entry) + SIZE * lines.iter().map(Label::width).fold(0.0, f64::max);
        match rows.last_mut() {
            Some((width, row)) if *width + BETWEEN + own <= most => {
                *width += BETWEEN + own;
                row.push((own, entry, lines));
            }
            _ => rows.push((own, vec![(own, entry, lines)])),
        }
    }
    let mut y = top;
    for (width, row) in rows {
        let mut x = middle - width / 2.0;
        let height = row.iter().map(|(.., lines)| lines.len()).max().unwrap_or(1);
        for (own, entry, lines) in row {
            sample(svg, entry, (x, y + ROW / 2.0));
            svg.lines(&lines, (x + room(entry), y + ROW / 2.0), SIZE, Anchor::Left);
            x += own + BETWEEN;
        }
        y += ROW + (height - 1) as f64 * 1.4 * SIZE;
    }
    y
}

/// Returns the width of the samples of an entry in px.
fn room(entry: &Entry) -> f64 {
    match entry.samples[..] {
        [(_, Sample::Guide)] => 16.0,
        [(_, Sample::Line(None, _))] => 12.0,
        [(_, Sample::Empty)] => 18.0,
        _ => 28.0,
    }
}

fn sample(svg: &mut Svg, entry: &Entry, (x, y): Place) {
    let part = 22.0 / entry.samples.len().max(1) as f64;
    for (index, (ink, sample)) in entry.samples.iter().enumerate() {
        let (colour, left) = (ink.on_paper(), x + index as f64 * part);
        match sample {
            Sample::Line(None, Some(sign)) if entry.samples.len() == 1 => {
                draw_sign(svg, *sign, (x + SIGN, y), SIGN, colour);
            }
            Sample::Line(stroke, sign) => {
                if let Some(stroke) = stroke {
                    svg.line(
                        &[(left, y), (left + part, y)],
                        Pen {
                            colour,
                            width: 1.6,
                            stroke: *stroke,
                        },
                    );
                }
                if let Some(sign) = sign {
                    draw_sign(svg, *sign, (left + part / 2.0, y), SIGN, colour);
                }
            }
            Sample::Area | Sample::Solid => {
                let (from, to) = ((left, y - 5.0), (left + part, y + 5.0));
                let opacity = if *sample == Sample::Area {
                    AREA_OPACITY
                } else {
                    1.0
                };
                svg.area(&[from, (to.0, from.1), to, (from.0, to.1)], colour, opacity);
            }
            Sample::Guide => svg.line(&[(x + 5.0, y + 7.0), (x + 5.0, y - 7.0)], guide(*ink)),
            Sample::Contour => svg.line(&[(x, y), (x + 22.0, y)], Pen::solid(colour, 1.8)),
            Sample::Empty => {
                svg.rectangle((x, y - 6.0), (x + 12.0, y + 6.0), EMPTY);
            }
        }
    }
}
