//! Draws the layers of a chart as Braille dots, on a canvas with coordinates from 0 to 1.

use super::glyph::is_blank;
use crate::axis::{Axes, Share};
use crate::chart::{Chart, Shape, Sign, StressFill, Stroke};
use crate::colour::Ink;
use crate::palette::{ColourRole, Colours, Palette};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::canvas::{Painter, Shape as CanvasShape};

pub(super) struct LayerShape<'a> {
    pub chart: &'a Chart,
    pub shape: &'a Shape,
    pub ink: Ink,
    pub palette: Palette,
}

/// Distance of the lines that show pulled springs above the profile, in columns of dots. Between
/// two lines, three cells stay blank, in which the profile is seen.
const COLUMNS_BETWEEN_LINES: usize = 8;

/// Column and row of a Braille dot on the canvas.
type Dot = (usize, usize);

impl LayerShape<'_> {
    fn axes(&self) -> Axes<'_> {
        Axes {
            x: &self.chart.x,
            y: &self.chart.y,
        }
    }

    fn paint(&self, painter: &mut Painter<'_, '_>, dot: Dot) {
        let (x, y) = dot;
        painter.paint(x, y, self.colour());
    }

    fn colour(&self) -> Color {
        self.palette.ink(self.ink).fg.unwrap_or_default()
    }

    fn lines(&self, painter: &mut Painter<'_, '_>, runs: &[Vec<Share>], stroke: Stroke) {
        let mut painted = 0_usize;
        for run in runs {
            let dots: Vec<Dot> = run
                .iter()
                .filter_map(|(x, y)| painter.get_point(*x, *y))
                .collect();
            for (index, dot) in dots.iter().enumerate() {
                for dot in between(dots[index.saturating_sub(1)], *dot) {
                    if paints(stroke, painted) {
                        self.paint(painter, dot);
                    }
                    painted += 1;
                }
            }
        }
    }

    /// Paints one dot for each point.
    fn points(&self, painter: &mut Painter<'_, '_>, points: &[(f64, f64)]) {
        for (x, y) in points.iter().filter_map(|point| self.axes().place(*point)) {
            if let Some(dot) = painter.get_point(x, y) {
                self.paint(painter, dot);
            }
        }
    }

    /// Shades the area inside a closed line: paints every dot that is inside the line and for which
    /// [`Self::is_shaded`] returns true.
    fn inside(&self, painter: &mut Painter<'_, '_>, border: &[(f64, f64)]) {
        let Some(last) = painter.get_point(1.0, 0.0) else {
            return;
        };
        for dot in dots_inside(self.chart, border, last) {
            if self.is_shaded(dot.0, dot.1) {
                self.paint(painter, dot);
            }
        }
    }

    /// Fills the area between a profile and the level without stress. The colour of each row of
    /// dots shows the stress at its height. Above the profile, pulled springs are lines with gaps,
    /// so that they do not hide its peaks; each patch has one at its left end. Without colours,
    /// they have only every second dot, and the dots along the profile.
    fn fill(
        &self,
        painter: &mut Painter<'_, '_>,
        x: (f64, f64),
        columns: &[Option<(f64, f64)>],
        fill: StressFill,
    ) {
        let Some((last_column, last_row)) = painter.get_point(1.0, 0.0) else {
            return;
        };
        let y = &self.chart.y;
        let row_at = |number: f64| {
            let down = 1.0 - y.share(number).clamp(0.0, 1.0);
            (down * last_row as f64).round() as usize
        };
        let mut colours = Vec::with_capacity(last_row + 1);
        for row in 0..=last_row {
            let up = 1.0 - row as f64 / last_row.max(1) as f64;
            let number = y.scale.number(y.span.low + up * y.span.width());
            // The stress of the layer has only one sign, even in the row of the level.
            let size = fill.stress(number).abs();
            let is_pulled = self.ink == Ink::Pull;
            colours.push(self.palette.stress(if is_pulled { -size } else { size }));
        }
        let is_thinned = self.palette.colours == Colours::Plain && self.ink == Ink::Pull;
        let level = row_at(fill.level);
        let width = (x.1 - x.0) / columns.len().max(1) as f64;
        let mut is_inside = false;
        for (index, heights) in columns.iter().enumerate() {
            let Some((low, high)) = *heights else {
                is_inside = false;
                continue;
            };
            let is_end = !std::mem::replace(&mut is_inside, true);
            let left = self.chart.x.share(x.0 + width * index as f64) * last_column as f64;
            let right = self.chart.x.share(x.0 + width * (index + 1) as f64) * last_column as f64;
            if right < 0.0 || left > last_column as f64 {
                continue;
            }
            // The dots from the left to the right end of the column, at least the nearest one.
            let first = (left.round().max(0.0) as usize).min(last_column);
            let end = (right.round() as usize).clamp(first + 1, last_column + 1);
            let edge = if self.ink == Ink::Pull {
                row_at(low)
            } else {
                row_at(high)
            };
            let top = edge.min(level);
            let bottom = edge.max(level);
            let highest = row_at(high);
            for column in first..end {
                for (row, colour) in (top..).zip(&colours[top..=bottom]) {
                    let is_above = self.ink == Ink::Pull && row < highest;
                    let is_painted = if is_thinned {
                        row == edge || (column + row).is_multiple_of(2)
                    } else {
                        let is_line = column.is_multiple_of(COLUMNS_BETWEEN_LINES);
                        !is_above || is_line || is_end && column == first
                    };
                    if is_painted {
                        painter.paint(column, row, *colour);
                    }
                }
            }
        }
    }

    /// Returns true for the dots that shade an area: every second dot or, for [`Ink::Quiet`], every
    /// eighth dot.
    fn is_shaded(&self, column: usize, row: usize) -> bool {
        if self.ink == Ink::Quiet {
            column.is_multiple_of(2) && (column / 2 + row).is_multiple_of(4)
        } else {
            (column + row).is_multiple_of(2)
        }
    }

    fn filled_box(&self, painter: &mut Painter<'_, '_>, x: (f64, f64), y: (f64, f64)) {
        let (left, right) = x;
        let (low, high) = y;
        let dot = |point| {
            let (across, up) = self.axes().place(point)?;
            painter.get_point(across, up)
        };
        let (Some(from), Some(to)) = (dot((left, high)), dot((right, low))) else {
            return;
        };
        for row in from.1..=to.1 {
            for column in from.0..=to.0 {
                self.paint(painter, (column, row));
            }
        }
    }
}

/// Returns the dots inside a closed line on a canvas, on which `last` is the lower right dot. A dot
/// is inside if the line crosses the column an odd number of times below the dot.
fn dots_inside(chart: &Chart, border: &[(f64, f64)], last: Dot) -> Vec<Dot> {
    let (last_column, last_row) = last;
    let mut shares: Vec<Share> = Vec::new();
    for (x, y) in border {
        // Zero on a logarithmic axis has no finite position, so the point is placed far below the
        // chart.
        let up = chart.y.share(*y).clamp(-9.0, 9.0);
        shares.push((chart.x.share(*x), up));
    }
    let row_at = |up: f64| ((1.0 - up.clamp(0.0, 1.0)) * last_row as f64).round() as usize;
    let mut dots = Vec::new();
    for column in 0..=last_column {
        let x = column as f64 / last_column.max(1) as f64;
        for pair in crossings(&shares, x).chunks_exact(2) {
            for row in row_at(pair[1])..=row_at(pair[0]) {
                dots.push((column, row));
            }
        }
    }
    dots
}

/// Returns the points of the closed line around a band.
pub(super) fn border_of_band(points: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    let lower = points.iter().map(|(x, low, _)| (*x, *low));
    let upper = points.iter().rev().map(|(x, _, high)| (*x, *high));
    lower.chain(upper).collect()
}

/// Least number of dots of a cell, out of eight, that lie inside an area whose ground covers the
/// cell.
const DOTS_OF_GROUND: u8 = 5;

/// Bits of a Braille character for its two columns of dots and their four rows.
const BRAILLE: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Shades the cells inside a closed line: with a ground or, in a terminal without grounds, with
/// dots if it is a loop. Dots are only drawn in blank cells that are not beside a text, so that
/// texts can be read.
pub(super) fn shade_inside(
    buffer: &mut Buffer,
    plot: Rect,
    chart: &Chart,
    border: &[(f64, f64)],
    ink: Ink,
    palette: Palette,
) {
    /// A cell inside the line.
    #[derive(Clone, Copy, Default)]
    struct Inside {
        /// Number of dots inside.
        dots: u8,
        /// Bits of the Braille character that shades the cell.
        pattern: u32,
    }
    let width = usize::from(plot.width);
    let last = (width * 2 - 1, usize::from(plot.height) * 4 - 1);
    let mut cells = vec![Inside::default(); width * usize::from(plot.height)];
    for (column, row) in dots_inside(chart, border, last) {
        let cell = &mut cells[row / 4 * width + column / 2];
        cell.dots += 1;
        if (column + row).is_multiple_of(2) {
            cell.pattern |= BRAILLE[column % 2][row % 4];
        }
    }
    let ground = palette.ground(ink.role());
    for (inside, position) in cells.iter().zip(plot.positions()) {
        let is_beside_text = has_letter(buffer, position.x.saturating_sub(1), position.y)
            || has_letter(buffer, position.x + 1, position.y);
        let cell = &mut buffer[position];
        if let Some(ground) = ground {
            if inside.dots >= DOTS_OF_GROUND {
                cell.set_bg(ground);
            }
        } else if ink == Ink::Loop
            && inside.pattern > 0
            && is_blank(cell)
            && !is_beside_text
            && let Some(dots) = char::from_u32(0x2800 + inside.pattern)
        {
            cell.set_char(dots)
                .set_style(palette.style(ColourRole::Quiet));
        }
    }
}

/// Returns true if the cell at a column and a row has a letter or a digit.
fn has_letter(buffer: &Buffer, column: u16, row: u16) -> bool {
    let Some(cell) = buffer.cell((column, row)) else {
        return false;
    };
    cell.symbol().chars().any(char::is_alphanumeric)
}

/// Returns the heights at which a closed line crosses the vertical line at x, in ascending order.
fn crossings(line: &[Share], x: f64) -> Vec<f64> {
    let mut crossings = Vec::new();
    for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
        if (a.0 <= x) == (b.0 <= x) {
            continue;
        }
        let y = a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0);
        if y.is_finite() {
            crossings.push(y);
        }
    }
    crossings.sort_unstable_by(f64::total_cmp);
    crossings
}

impl CanvasShape for LayerShape<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        match self.shape {
            Shape::Curve {
                points,
                stroke: None,
                sign: Some(Sign::Point),
            } => self.points(painter, points),
            Shape::Curve {
                points,
                stroke: Some(stroke),
                ..
            } => {
                self.lines(painter, &self.axes().runs(points.iter().copied()), *stroke);
            }
            Shape::Band(points) => self.inside(painter, &border_of_band(points)),
            Shape::Envelope {
                x,
                columns,
                fill: Some(fill),
            } => self.fill(painter, *x, columns, *fill),
            Shape::Envelope {
                x,
                columns,
                fill: None,
            } => {
                self.lines(painter, &self.axes().envelope(*x, columns), Stroke::Solid);
            }
            Shape::Inside(border) => self.inside(painter, border),
            Shape::Boxes(boxes) => {
                for (x, y) in boxes {
                    self.filled_box(painter, *x, *y);
                }
            }
            Shape::Upright(number) | Shape::Level(number) => {
                let is_vertical = matches!(self.shape, Shape::Upright(_));
                if let Some(ends) = self.axes().guide(*number, is_vertical) {
                    self.lines(painter, &[Vec::from(ends)], Stroke::Sparse);
                }
            }
            Shape::Curve { stroke: None, .. } | Shape::Map(_) => {}
        }
    }
}

/// Returns true if a line with this stroke has a dot at the place `dot`, counted along the line.
/// The strokes differ in their gaps, so that lines can be distinguished without colours.
fn paints(stroke: Stroke, dot: usize) -> bool {
    match stroke {
        Stroke::Solid => true,
        Stroke::Dashed => dot % 8 < 6,
        Stroke::Dotted => dot % 4 < 2,
        Stroke::DashDotted => !matches!(dot % 10, 6 | 7 | 9),
        Stroke::Sparse => dot.is_multiple_of(4),
    }
}

/// Returns the dots on the straight line between two dots, without the dot `from`. If the two dots
/// are the same, returns this dot.
fn between(from: Dot, to: Dot) -> impl Iterator<Item = Dot> {
    let dx = to.0 as f64 - from.0 as f64;
    let dy = to.1 as f64 - from.1 as f64;
    let steps = dx.abs().max(dy.abs()).max(1.0) as usize;
    (1..=steps).map(move |step| {
        let share = step as f64 / steps as f64;
        (
            (from.0 as f64 + dx * share).round() as usize,
            (from.1 as f64 + dy * share).round() as usize,
        )
    })
}
