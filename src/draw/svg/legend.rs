//! Legend of a figure: rows of samples with names.

use super::elements::{Anchor, HATCHED, Pen, Place, QUIET, Svg, TEXT};
use super::layers::{AREA_OPACITY, SIGN, draw_sign, guide};
use crate::draw::chart::{Entry, Sample};

/// Size of names, px.
const SIZE: f64 = 11.5;
/// Distance of two entries, px.
const BETWEEN: f64 = 20.0;
/// Height of a row, px.
pub(super) const ROW: f64 = 20.0;

/// Entries in rows, with the width of each row.
pub(super) struct Legend {
    rows: Vec<(f64, Vec<Entry>)>,
}

impl Legend {
    /// Rows no wider than `most`, unless a single entry is.
    pub(super) fn new(entries: Vec<Entry>, most: f64) -> Legend {
        let mut rows: Vec<(f64, Vec<Entry>)> = Vec::new();
        for entry in entries {
            let own = width(&entry);
            match rows.last_mut() {
                Some((width, row)) if *width + BETWEEN + own <= most => {
                    *width += BETWEEN + own;
                    row.push(entry);
                }
                _ => rows.push((own, vec![entry])),
            }
        }
        Legend { rows }
    }

    pub(super) fn width(&self) -> f64 {
        self.rows.iter().map(|(width, _)| *width).fold(0.0, f64::max)
    }

    pub(super) fn height(&self) -> f64 {
        self.rows.len() as f64 * ROW
    }

    /// Draws the rows around a middle, the first at this height.
    pub(super) fn draw(&self, svg: &mut Svg, middle: f64, top: f64) {
        for (index, (row_width, entries)) in self.rows.iter().enumerate() {
            let mut x = middle - row_width / 2.0;
            let y = top + index as f64 * ROW;
            for entry in entries {
                sample(svg, entry, (x, y));
                svg.label(&entry.name, (x + room(entry), y), SIZE, Anchor::Left, TEXT);
                x += width(entry) + BETWEEN;
            }
        }
    }
}

fn width(entry: &Entry) -> f64 {
    room(entry) + entry.name.width() * SIZE
}

/// Room for the samples of an entry, px.
fn room(entry: &Entry) -> f64 {
    match entry.samples[..] {
        [(_, Sample::Guide)] => 16.0,
        [(_, Sample::Line(None, _))] => 12.0,
        [(_, Sample::Empty)] => 18.0,
        _ => 28.0,
    }
}

/// Draws the samples of an entry from this place; several share the room.
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
                    svg.line(&[(left, y), (left + part, y)], Pen { colour, width: 1.6, stroke: *stroke });
                }
                if let Some(sign) = sign {
                    draw_sign(svg, *sign, (left + part / 2.0, y), SIGN, colour);
                }
            }
            Sample::Area | Sample::Solid => {
                let (from, to) = ((left, y - 5.0), (left + part, y + 5.0));
                let opacity = if *sample == Sample::Area { AREA_OPACITY } else { 1.0 };
                svg.area(&[from, (to.0, from.1), to, (from.0, to.1)], colour, opacity);
            }
            Sample::Guide => svg.line(&[(x + 5.0, y + 7.0), (x + 5.0, y - 7.0)], guide(*ink)),
            Sample::Contour => svg.line(&[(x, y), (x + 22.0, y)], Pen::solid(colour, 1.8)),
            Sample::Empty => {
                let (from, to) = ((x, y - 6.0), (x + 12.0, y + 6.0));
                svg.rect(from, to, HATCHED);
                svg.frame(from, to, Pen::solid(QUIET, 0.8));
            }
        }
    }
}
