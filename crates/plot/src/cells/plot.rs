//! A chart in an area of a terminal. The area contains the plot, the numbers on the left of the
//! plot and the numbers below the plot.

use super::glyph::{glyph, is_blank};
use super::map;
use super::shapes::{LayerShape, border_of_band, shade_inside};
use crate::axis::ChartAxis;
use crate::chart::{Chart, Layer, Shape, Sign};
use crate::colour::Ink;
use crate::palette::Palette;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::Canvas;
use std::ops::RangeInclusive;

/// Smallest width in columns of an area that has numbers on the left of the plot.
pub(super) const COLUMNS_WITH_LEFT_SCALE: u16 = 26;
/// Smallest height in rows of an area that has numbers on the left of the plot.
const ROWS_WITH_LEFT_SCALE: u16 = 6;
/// Smallest number of columns of the numbers on the left. Most numbers with and without a sign fit
/// into it, so that the plot keeps its place when they change.
const LEAST_LEFT_NUMBER: u16 = 4;
/// Smallest height in rows of an area that has numbers below the plot.
const WITH_SCALE_BELOW: u16 = 5;
/// Smallest height in rows of an area that has a line between the plot and the numbers below it.
const WITH_LINE_BELOW: u16 = 12;
/// Smallest height in rows of an area in which the label of the horizontal axis has a row of its
/// own, where it covers no number. This does not depend on the numbers, so that the plot keeps its
/// place when they change.
const WITH_LABEL_BELOW: u16 = 16;
/// Number of columns of Braille dots in a cell.
const COLUMNS_OF_DOTS: u16 = 2;
/// Number of rows of Braille dots in a cell.
const ROWS_OF_DOTS: u16 = 4;

/// Text that [`CellPlot::draw_name`] writes beside a point of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// Points (x, y) beside which the text may be written, as numbers on the axes of the chart. The
    /// text is written at the first of these points that has enough room.
    pub at: Vec<(f64, f64)>,
    /// Alternative texts, from the longest to the shortest. The first text that fits is written.
    pub texts: Vec<String>,
    pub ink: Ink,
}

/// Layout of a chart in an area of the screen: the plot, and the numbers on its left and below.
pub struct CellPlot {
    /// Area of the screen in which the data of the chart are drawn, without the numbers along the
    /// axes.
    pub plot: Rect,
    /// Number of columns of the area on the left of the plot, which contain the numbers.
    left: u16,
    /// Number of rows between the plot and the numbers below it.
    between: u16,
    /// True if the first row below the plot contains a line.
    has_line: bool,
    /// True if there are numbers below the plot.
    has_scale_below: bool,
    /// True if the label of the horizontal axis has its own row below the numbers.
    has_label_row: bool,
}

/// Column or row of the plot, and the number that the axis shows there.
type PlacedNumber = (u16, String);

impl CellPlot {
    /// Divides an area of the screen between the plot of a chart and the numbers along its axes. A
    /// small area has no numbers.
    pub fn within(area: Rect, chart: &Chart) -> CellPlot {
        let has_line = area.height >= WITH_LINE_BELOW;
        CellPlot {
            has_line,
            ..CellPlot::above(area, chart, u16::from(has_line))
        }
    }

    /// Divides an area of the screen between the plot of a chart and the numbers along its axes,
    /// and leaves `between` rows free directly below the plot.
    pub fn above(area: Rect, chart: &Chart, between: u16) -> CellPlot {
        let has_scale_below = area.height >= WITH_SCALE_BELOW;
        let has_label_row = area.height >= WITH_LABEL_BELOW;
        let rows_below = u16::from(has_scale_below) + between + u16::from(has_label_row);
        let height = area.height.saturating_sub(rows_below);
        let mut left = 0;
        if area.width >= COLUMNS_WITH_LEFT_SCALE && area.height >= ROWS_WITH_LEFT_SCALE {
            let numbers = scale_beside(chart, height);
            let widths = numbers.iter().map(|(_, text)| text.chars().count() as u16);
            let width = widths.max().map_or(0, |width| width.max(LEAST_LEFT_NUMBER));
            left = width + 2;
        }
        // Names on the vertical axis may take more room than numbers, because the names already
        // state what the bars beside them show.
        let most = if chart.y.names.is_empty() {
            area.width / 2
        } else {
            3 * area.width / 4
        };
        if left > most {
            left = 0;
        }
        let plot = Rect {
            x: area.x + left,
            width: area.width - left,
            height,
            ..area
        };
        CellPlot {
            plot,
            left,
            between,
            has_line: false,
            has_scale_below,
            has_label_row,
        }
    }

    /// Returns the point (x, y) on the axes of the chart that a cell of the screen shows. `cell` is
    /// the (column, row) of this cell. If the chart has a heat map, x and y are the axis values of
    /// the cell of the map that is drawn there, and a cell of the screen outside the map gives
    /// `None`.
    pub fn data_at(&self, chart: &Chart, cell: (u16, u16)) -> Option<(f64, f64)> {
        let (column, row) = cell;
        let plot = self.plot;
        if let Some(map) = chart.map() {
            if !plot.contains(cell.into()) {
                return None;
            }
            let columns = map::values_behind(&chart.x, &map.columns, plot.width);
            let rows = map::values_behind(&chart.y, &map.rows, plot.height);
            let x = map.columns.get(columns[usize::from(column - plot.x)])?;
            let y = map.rows.get(rows[usize::from(plot.bottom() - 1 - row)])?;
            return Some((*x, *y));
        }
        let across = share_at(column, plot.x, plot.width);
        let down = share_at(row, plot.y, plot.height);
        Some((number_at(&chart.x, across), number_at(&chart.y, 1.0 - down)))
    }

    /// Returns the cell of the screen, as (column, row), that contains the point (x, y) on the axes
    /// of the chart. Returns `None` for a point outside the chart. If the chart has a heat map,
    /// returns the nearest cell of the screen at the edge of the map for such a point.
    pub fn cell(&self, chart: &Chart, point: (f64, f64)) -> Option<(u16, u16)> {
        let (x, y) = point;
        let plot = self.plot;
        let across = chart.x.share(x);
        let down = 1.0 - chart.y.share(y);
        let nearest_across = across.clamp(0.0, 1.0);
        let nearest_down = down.clamp(0.0, 1.0);
        if plot.is_empty() {
            return None;
        }
        if chart.map().is_some() {
            let column = ((nearest_across * f64::from(plot.width)) as u16).min(plot.width - 1);
            let row = ((nearest_down * f64::from(plot.height)) as u16).min(plot.height - 1);
            return Some((plot.x + column, plot.y + row));
        }
        // The comparison is also true if a position is NaN, so that `None` is returned in this case
        // too.
        if (nearest_across, nearest_down) != (across, down) {
            return None;
        }
        let column = cell_at(across, plot.width, COLUMNS_OF_DOTS);
        let row = cell_at(down, plot.height, ROWS_OF_DOTS);
        Some((plot.x + column, plot.y + row))
    }

    /// Draws the data of the chart and the numbers along its axes into the cells of a buffer.
    pub fn draw(&self, buffer: &mut Buffer, chart: &Chart, palette: Palette) {
        if self.plot.is_empty() {
            return;
        }
        self.draw_scales(buffer, chart, palette);
        for layer in &chart.layers {
            if let Shape::Map(map) = &layer.shape {
                map::draw(buffer, self.plot, chart, map, palette);
            }
        }
        if chart.layers.iter().any(is_on_canvas) {
            Canvas::default()
                .marker(Marker::Braille)
                .x_bounds([0.0, 1.0])
                .y_bounds([0.0, 1.0])
                .paint(|context| {
                    let mut is_after_fill = false;
                    for layer in chart.layers.iter().filter(|layer| is_on_canvas(layer)) {
                        // Pressed and pulled springs share the cells along the level between them,
                        // so that they are drawn into the same layer of the canvas.
                        if !(is_after_fill && is_fill(layer)) {
                            context.layer();
                        }
                        is_after_fill = is_fill(layer);
                        context.draw(&LayerShape {
                            chart,
                            shape: &layer.shape,
                            ink: layer.ink,
                            palette,
                        });
                    }
                })
                .render(self.plot, buffer);
        }
        self.draw_signs(buffer, chart, palette);
    }

    /// Shades two areas of the chart: inside its loop, and below the profile of the rigid body.
    /// This function is called after all texts have been written, because texts are written only in
    /// blank cells.
    pub fn draw_grounds(&self, buffer: &mut Buffer, chart: &Chart, palette: Palette) {
        if self.plot.is_empty() {
            return;
        }
        for layer in chart.layers.iter().filter(|layer| layer.ink.is_ground()) {
            match &layer.shape {
                Shape::Inside(border) => {
                    shade_inside(buffer, self.plot, chart, border, layer.ink, palette);
                }
                Shape::Band(points) => {
                    let border = border_of_band(points);
                    shade_inside(buffer, self.plot, chart, &border, layer.ink, palette);
                }
                _ => {}
            }
        }
    }

    /// Writes the longest text of a name for which there are enough blank cells beside one of the
    /// points [`Name::at`]. Returns false if no text fits.
    pub fn draw_name(
        &self,
        buffer: &mut Buffer,
        chart: &Chart,
        palette: Palette,
        name: &Name,
    ) -> bool {
        for text in &name.texts {
            for point in &name.at {
                if let Some((x, y)) = self.free_place(buffer, chart, *point, text) {
                    buffer.set_string(x, y, text, palette.ink(name.ink));
                    return true;
                }
            }
        }
        false
    }

    /// Returns the first cell of a text beside a point; `None` if there are not enough blank cells
    /// on any side of the point.
    fn free_place(
        &self,
        buffer: &Buffer,
        chart: &Chart,
        point: (f64, f64),
        text: &str,
    ) -> Option<(u16, u16)> {
        let cell = self.cell(chart, point)?;
        let column = i32::from(cell.0);
        let row = i32::from(cell.1);
        let width = text.chars().count() as i32;
        let right = column + 2;
        let left = column - 1 - width;
        let middle = column - width / 2;
        // The text is tried first in the row of the point, then in the row below, then in the row
        // above.
        let places = [
            (right, row),
            (left, row),
            (right, row + 1),
            (left, row + 1),
            (right, row - 1),
            (left, row - 1),
            (middle, row + 1),
            (middle, row - 1),
        ];
        for (x, y) in places {
            if self.is_free(buffer, cell, x, y, width) {
                return Some((x as u16, y as u16));
            }
        }
        None
    }

    /// Returns true if there is room for a text of this width that begins at the cell (x, y): it
    /// lies inside the plot, and its cells, the cell before and the cell after are blank. Cells
    /// outside the plot need not be blank, nor the cell of the named `point`.
    fn is_free(&self, buffer: &Buffer, point: (u16, u16), x: i32, y: i32, width: i32) -> bool {
        let plot = self.plot;
        let first = i32::from(plot.x);
        let end = i32::from(plot.right());
        let rows = i32::from(plot.y)..i32::from(plot.bottom());
        if x < first || x + width > end || !rows.contains(&y) {
            return false;
        }
        let mut columns = (x - 1).max(first)..(x + width + 1).min(end);
        columns.all(|column| {
            let cell = (column as u16, y as u16);
            cell == point || is_blank(&buffer[cell])
        })
    }

    fn draw_signs(&self, buffer: &mut Buffer, chart: &Chart, palette: Palette) {
        for layer in &chart.layers {
            let Shape::Curve {
                points,
                sign: Some(sign),
                ..
            } = &layer.shape
            else {
                continue;
            };
            // Markers of this kind have already been drawn as Braille dots.
            if *sign == Sign::Point {
                continue;
            }
            // At most every second column gets a marker, so that neighbouring markers can be
            // distinguished.
            let every = (2 * points.len())
                .div_ceil(usize::from(self.plot.width))
                .max(1);
            for point in points.iter().step_by(every) {
                if let Some((column, row)) = self.cell(chart, *point) {
                    buffer[(column, row)]
                        .set_symbol(glyph(*sign))
                        .set_style(palette.ink(layer.ink));
                }
            }
        }
    }

    fn draw_scales(&self, buffer: &mut Buffer, chart: &Chart, palette: Palette) {
        let quiet = palette.ink(Ink::Quiet);
        if self.left > 0 {
            self.draw_scale_beside(buffer, chart, quiet);
        }
        let scale = self.scale_below(chart);
        if self.has_line {
            self.draw_line_below(buffer, &scale.numbers, quiet);
        }
        if self.has_scale_below {
            self.draw_scale_below(buffer, &scale, quiet);
        }
    }

    fn draw_scale_beside(&self, buffer: &mut Buffer, chart: &Chart, quiet: Style) {
        let plot = self.plot;
        let numbers = scale_beside(chart, plot.height);
        let width = usize::from(self.left) - 2;
        for row in 0..plot.height {
            let number = numbers.iter().find(|(number_row, _)| *number_row == row);
            let text = match number {
                Some((_, text)) => format!("{text:>width$} ┤"),
                None => format!("{:>width$} │", ""),
            };
            buffer.set_string(plot.x - self.left, plot.y + row, text, quiet);
        }
    }

    fn draw_line_below(&self, buffer: &mut Buffer, numbers: &[NumberBelow], quiet: Style) {
        let plot = self.plot;
        let mut line: Vec<char> = vec!['─'; usize::from(plot.width)];
        for number in numbers {
            line[usize::from(number.tick)] = '┬';
        }
        if self.left > 0 {
            buffer.set_string(plot.x - 1, plot.bottom(), "└", quiet);
        }
        let line: String = line.into_iter().collect();
        buffer.set_string(plot.x, plot.bottom(), line, quiet);
    }

    fn draw_scale_below(&self, buffer: &mut Buffer, scale: &ScaleBelow, quiet: Style) {
        let plot = self.plot;
        let y = plot.bottom() + self.between;
        for number in &scale.numbers {
            let x = (i32::from(plot.x) + number.start) as u16;
            buffer.set_string(x, y, &number.text, quiet);
        }
        let y = y + u16::from(self.has_label_row);
        let x = plot.x + scale.label_start;
        let width = plot.width - scale.label_start;
        buffer.set_stringn(x, y, &scale.label, usize::from(width), quiet);
    }

    /// Returns the numbers on the horizontal axis, and its label. If the label does not fit, it
    /// contains only the symbol and the unit. The label has a row of its own, or shares the row of
    /// the numbers: it is then at the right end or, if it would cover a number there, before the
    /// last number. If it fits nowhere, it replaces the last numbers.
    fn scale_below(&self, chart: &Chart) -> ScaleBelow {
        let width = self.plot.width;
        let short = chart.x.symbol_with_unit().to_string();
        let mut label = chart.x.label_with_unit().to_string();
        let room = if self.has_label_row { width } else { width / 2 };
        if columns_of(&label) > i32::from(room) {
            label.clone_from(&short);
        }
        let mut numbers = self.numbers_below(chart, &label);
        if self.has_label_row {
            let blank = i32::from(width) - columns_of(&label);
            return ScaleBelow {
                numbers,
                label_start: (blank.max(0) / 2) as u16,
                label,
            };
        }
        for text in [&label, &short] {
            if let Some(label_start) = start_of_label(text, &numbers, width) {
                return ScaleBelow {
                    numbers,
                    label: text.clone(),
                    label_start,
                };
            }
        }
        let start = (i32::from(width) - columns_of(&short)).max(0);
        numbers.retain(|number| number.end() < start);
        ScaleBelow {
            numbers,
            label: short,
            label_start: start as u16,
        }
    }

    /// Returns the numbers on the horizontal axis that do not overlap. A number at an end of the
    /// axis begins and ends within the columns of the plot and of the numbers on its left.
    fn numbers_below(&self, chart: &Chart, label: &str) -> Vec<NumberBelow> {
        let width = self.plot.width;
        let span = chart.x.span;
        let column =
            |number: f64| cell_at((number - span.low) / span.width(), width, COLUMNS_OF_DOTS);
        let fewest = usize::from(width / 10).clamp(2, 9);
        let most = fewest.max(usize::from(width / 4));
        let is_seen = |number: &PlacedNumber| !is_covered(number, width, label);
        let mut numbers = Vec::new();
        let mut free = -i32::from(self.left);
        for (tick, text) in numbers_at(&chart.x, fewest..=most, column, is_seen) {
            let length = columns_of(&text);
            let last_start = i32::from(width) - length;
            let start = i32::from(tick) - length / 2;
            let start = start.min(last_start).max(-i32::from(self.left));
            let number = NumberBelow { tick, start, text };
            if tick < width && start >= free && start <= last_start {
                free = number.end() + 1;
                numbers.push(number);
            }
        }
        numbers
    }
}

/// Numbers and label of the horizontal axis of a plot.
struct ScaleBelow {
    numbers: Vec<NumberBelow>,
    label: String,
    /// First column of the label, counted from the left end of the plot.
    label_start: u16,
}

/// Number below a plot. Its columns are counted from the left end of the plot.
struct NumberBelow {
    /// Column of the tick to which the number belongs.
    tick: u16,
    /// First column of the text, which is negative for a text that begins before the plot.
    start: i32,
    text: String,
}

impl NumberBelow {
    /// Returns the column after the last column of the text.
    fn end(&self) -> i32 {
        self.start + columns_of(&self.text)
    }
}

/// Number of columns of a text on the screen.
fn columns_of(text: &str) -> i32 {
    text.chars().count() as i32
}

/// Returns the first column of a label in the row of the numbers: at the right end, or before the
/// last number with two blanks on each side. `None` if the label would cover a number at both
/// places.
fn start_of_label(label: &str, numbers: &[NumberBelow], width: u16) -> Option<u16> {
    let columns = columns_of(label);
    let last_end = numbers.last().map_or(-1, NumberBelow::end);
    let at_right = i32::from(width) - columns;
    if at_right >= 0 && last_end < at_right {
        return Some(at_right as u16);
    }
    let [.., before, last] = numbers else {
        return None;
    };
    let start = last.start - 2 - columns;
    (start >= before.end() + 2).then_some(start.max(0) as u16)
}

/// Returns true for a layer whose data are Braille dots.
fn is_on_canvas(layer: &Layer) -> bool {
    match layer.shape {
        Shape::Map(_) => false,
        Shape::Inside(_) | Shape::Band(_) => !layer.ink.is_ground(),
        Shape::Curve { stroke, sign, .. } => stroke.is_some() || sign == Some(Sign::Point),
        _ => true,
    }
}

fn is_fill(layer: &Layer) -> bool {
    matches!(layer.shape, Shape::Envelope { fill: Some(_), .. })
}

/// Returns the position of the middle of a cell along an axis, from 0 to 1. The axis consists of
/// `cells` cells, and begins at the cell with the number `first`.
fn share_at(cell: u16, first: u16, cells: u16) -> f64 {
    ((f64::from(cell) + 0.5 - f64::from(first)) / f64::from(cells.max(1))).clamp(0.0, 1.0)
}

fn number_at(axis: &ChartAxis, share: f64) -> f64 {
    axis.scale.number(axis.span.low + share * axis.span.width())
}

/// Returns the cell at the position `share` (0 to 1) along an axis of `cells` cells. As curves are
/// drawn with `dots` dots in each cell, the position is first rounded to a dot, so that signs and
/// ticks coincide with the curves.
fn cell_at(share: f64, cells: u16, dots: u16) -> u16 {
    let last = f64::from(cells) * f64::from(dots) - 1.0;
    (share * last).round().max(0.0) as u16 / dots
}

/// Returns the numbers on the vertical axis of a plot of this height, each with the row in which
/// the number is written.
fn scale_beside(chart: &Chart, height: u16) -> Vec<PlacedNumber> {
    let span = chart.y.span;
    let row = |number: f64| cell_at((span.high - number) / span.width(), height, ROWS_OF_DOTS);
    let fewest = usize::from(height / 3).clamp(2, 6);
    let most = fewest.max(usize::from(height));
    numbers_at(&chart.y, fewest..=most, row, |_| true)
}

/// Returns the numbers on an axis, each with its column or row, which the function `place` gives.
/// The number of ticks is the smallest one in the range `ticks` for which at least two numbers are
/// visible, or the smallest one in the range if there is none.
fn numbers_at(
    axis: &ChartAxis,
    ticks: RangeInclusive<usize>,
    place: impl Fn(f64) -> u16,
    is_seen: impl Fn(&PlacedNumber) -> bool,
) -> Vec<PlacedNumber> {
    let numbers = |most: usize| -> Vec<PlacedNumber> {
        let ticks = axis.ticks(most).into_iter();
        ticks
            .filter_map(|tick| Some((place(tick.at), tick.label?.to_string())))
            .collect()
    };
    let fewest = *ticks.start();
    for most in ticks {
        let numbers = numbers(most);
        let mut seen = numbers.iter().filter(|number| is_seen(number));
        // Two numbers in the same cell count as one, because the second number is written over the
        // first.
        if let Some((first, _)) = seen.next()
            && seen.any(|(place, _)| place != first)
        {
            return numbers;
        }
    }
    numbers(fewest)
}

/// Returns true if a label at the right end of the same row would be written over this number.
fn is_covered(number: &PlacedNumber, width: u16, label: &str) -> bool {
    let (column, text) = number;
    let end = usize::from(width).saturating_sub(label.chars().count() + 1);
    usize::from(*column) + text.chars().count().div_ceil(2) > end
}

#[cfg(test)]
mod tests;
