//! What the plots share: ranges, polylines and columns of dots.

use crate::explorer::snapshot::Section;
use ratatui::buffer::Buffer;
use ratatui::style::Color;
use ratatui::widgets::canvas::{Painter, Shape};

/// A range of values with a little room at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Span {
    /// The range of finite values with a share `room` of it added at each end; a range around a single
    /// value, and one around zero where there is none.
    pub fn around(values: impl Iterator<Item = f64>, room: f64) -> Self {
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return Span { low: -1.0, high: 1.0 };
        }
        let width = high - low;
        // A single value, or two that differ by rounding only.
        let least = 1e-9 * low.abs().max(high.abs());
        let margin = if width > least {
            room * width
        } else if least > 0.0 {
            1e6 * least
        } else {
            1.0
        };
        Span { low: low - margin, high: high + margin }
    }

    /// The ends, as a canvas wants them.
    pub fn bounds(self) -> [f64; 2] {
        [self.low, self.high]
    }
}

/// Stands on a canvas for the colour of the terminal's text, which the grid of half blocks would take for
/// that of its background where it meets another colour. No theme has it.
const INK: Color = Color::Indexed(16);

fn ink(colour: Color) -> Color {
    if colour == Color::Reset { INK } else { colour }
}

/// Gives what was drawn on canvases the colour of the terminal's text, where it is to have that.
pub fn dry(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        // Of a cell in two colours the one of the text can only be that of the foreground.
        let other = match cell.symbol() {
            "▀" => "▄",
            "▄" => "▀",
            _ => "",
        };
        if cell.bg == INK && !other.is_empty() {
            cell.set_symbol(if cell.fg == INK { "█" } else { other });
            std::mem::swap(&mut cell.fg, &mut cell.bg);
        }
        for colour in [&mut cell.fg, &mut cell.bg] {
            if *colour == INK {
                *colour = Color::Reset;
            }
        }
    }
}

/// A line through points.
pub struct Polyline<'a> {
    pub points: &'a [(f64, f64)],
    pub colour: Color,
    pub stroke: Stroke,
}

/// Which dots of a line are painted: lines are told apart without colours.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// All.
    Solid,
    /// Two of four.
    Dotted,
    /// One of four.
    Sparse,
    /// Six of eight.
    Dashed,
}

impl Stroke {
    fn paints(self, dot: usize) -> bool {
        match self {
            Stroke::Solid => true,
            Stroke::Dotted => dot % 4 < 2,
            Stroke::Sparse => dot.is_multiple_of(4),
            Stroke::Dashed => dot % 8 < 6,
        }
    }
}

impl Shape for Polyline<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        let mut painted = 0_usize;
        let mut last = None;
        let dots = self.points.iter().filter_map(|&(x, y)| painter.get_point(x, y)).collect::<Vec<_>>();
        for &(x, y) in &dots {
            for (x, y) in between(last.unwrap_or((x, y)), (x, y)) {
                if self.stroke.paints(painted) {
                    painter.paint(x, y, ink(self.colour));
                }
                painted += 1;
            }
            last = Some((x, y));
        }
    }
}

/// The dots from one to another, without the first unless they are the same.
fn between(from: (usize, usize), to: (usize, usize)) -> impl Iterator<Item = (usize, usize)> {
    let (dx, dy) = (to.0 as f64 - from.0 as f64, to.1 as f64 - from.1 as f64);
    let steps = dx.abs().max(dy.abs()).max(1.0) as usize;
    (1..=steps).map(move |step| {
        let share = step as f64 / steps as f64;
        ((from.0 as f64 + dx * share).round() as usize, (from.1 as f64 + dy * share).round() as usize)
    })
}

/// The inside of a closed line, every other dot of it: where a vertical line meets the border an odd
/// number of times below.
pub struct Inside<'a> {
    pub border: &'a [(f64, f64)],
    pub colour: Color,
}

impl Shape for Inside<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        let ([left, right], [bottom, top]) = (*painter.bounds().0, *painter.bounds().1);
        let Some((last, _)) = painter.get_point(right, bottom) else { return };
        let ends = self.border.iter().zip(self.border.iter().cycle().skip(1));
        for column in 0..=last {
            let x = left + (right - left) * column as f64 / last.max(1) as f64;
            let mut crossings: Vec<f64> = ends
                .clone()
                .filter(|(a, b)| (a.0 <= x) != (b.0 <= x))
                .map(|(a, b)| a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0))
                .filter(|y| y.is_finite())
                .collect();
            crossings.sort_unstable_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let clamped = |y: f64| y.clamp(bottom, top);
                let low = painter.get_point(x.clamp(left, right), clamped(pair[0]));
                let high = painter.get_point(x.clamp(left, right), clamped(pair[1]));
                let (Some((_, low)), Some((_, high))) = (low, high) else { continue };
                (high..=low)
                    .filter(|y| (column + y).is_multiple_of(2))
                    .for_each(|y| painter.paint(column, y, ink(self.colour)));
            }
        }
    }
}

/// Which part of a section's columns is drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The rigid line.
    Line,
    /// The elastic surface.
    Surface,
    /// The line where it is in contact.
    Contact,
}

/// A part of a section, one vertical bar for each column of dots; neighbours are joined.
pub struct Columns<'a> {
    pub section: &'a Section,
    pub part: Part,
    pub colour: Color,
}

impl Shape for Columns<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        let [bottom, top] = *painter.bounds().1;
        // A section made for another window is stretched until the one for this window comes.
        let ([_, right], count) = (*painter.bounds().0, self.section.columns.len());
        let Some((last, _)) = painter.get_point(right, bottom) else { return };
        let place = |column: usize| column * (last + 1) / count;
        let mut before: Option<(f64, f64)> = None;
        for (column, values) in self.section.columns.iter().enumerate() {
            let ends = match self.part {
                Part::Line => Some(values.line),
                Part::Surface => Some(values.surface),
                Part::Contact => values.contact,
            };
            let Some((mut low, mut high)) = ends else {
                before = None;
                continue;
            };
            // Up to where the neighbour ends, so that steep flanks do not tear.
            if let Some((other_low, other_high)) = before.filter(|_| self.part != Part::Contact) {
                (low, high) = (low.min(other_high), high.max(other_low));
            }
            before = ends;
            if high < bottom || low > top {
                continue;
            }
            let ends = (low.clamp(bottom, top), high.clamp(bottom, top));
            let (Some((_, y_low)), Some((_, y_high))) =
                (painter.get_point(0.0, ends.0), painter.get_point(0.0, ends.1))
            else {
                continue;
            };
            for x in place(column)..place(column + 1).max(place(column) + 1) {
                (y_high..=y_low).for_each(|y| painter.paint(x, y, ink(self.colour)));
            }
        }
    }
}
