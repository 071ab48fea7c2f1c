//! A chart in an area of a terminal: the plot and the scales beside it.

use super::map;
use super::shapes::LayerShape;
use super::style::{CellStyle, glyph};
use crate::axis::ChartAxis;
use crate::chart::{Chart, Layer, Shape, Sign};
use crate::colour::Ink;
use crate::ticks::Tick;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::Canvas;
use std::ops::RangeInclusive;

/// Smallest area in columns and rows whose plot has a scale on the left.
pub(super) const WITH_LEFT_SCALE: (u16, u16) = (26, 6);
/// Smallest number of rows of an area with a scale below the plot, and of an area that also has a
/// line between both.
const WITH_SCALE_BELOW: u16 = 5;
const WITH_LINE_BELOW: u16 = 12;
/// Smallest number of rows of an area whose label of the horizontal axis gets its own row if it
/// would cover a number.
const WITH_LABEL_BELOW: u16 = 16;
/// Columns and rows of Braille dots in a cell.
const DOTS: (u16, u16) = (2, 4);

/// Text that [`CellPlot::draw_name`] draws beside a point of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// Points (x, y) on the axes of the chart beside which the text may be written. The first point
    /// with enough room is used.
    pub at: Vec<(f64, f64)>,
    /// Alternative texts, from the longest to the shortest. The first one that fits is written.
    pub texts: Vec<String>,
    /// Ink of the text.
    pub ink: Ink,
}

/// Area of the screen for one chart, divided into the plot and the numbers on the left and below.
pub struct CellPlot {
    /// Area of the screen in which the data of the chart are drawn, without the numbers along the
    /// axes.
    pub plot: Rect,
    left: u16,
    /// Number of rows between the plot and the numbers below it.
    between: u16,
    /// True if the first of these rows has a line.
    line: bool,
    below: bool,
    label: bool,
}

impl CellPlot {
    /// Divides an area of the screen between the plot of a chart and the numbers along its axes. A
    /// small area has no numbers.
    pub fn within(area: Rect, chart: &Chart) -> CellPlot {
        let line = area.height >= WITH_LINE_BELOW;
        CellPlot {
            line,
            ..CellPlot::above(area, chart, u16::from(line))
        }
    }

    /// Divides an area of the screen as [`Self::within`], but leaves `between` rows free directly
    /// below the plot.
    pub fn above(area: Rect, chart: &Chart, between: u16) -> CellPlot {
        let below = area.height >= WITH_SCALE_BELOW;
        let label = area.height >= WITH_LABEL_BELOW && label_hides_numbers(chart, area.width);
        let height = area
            .height
            .saturating_sub(u16::from(below) + between + u16::from(label));
        let mut left = 0;
        if area.width >= WITH_LEFT_SCALE.0 && area.height >= WITH_LEFT_SCALE.1 {
            let labels = scale_beside(chart, height);
            left = labels
                .iter()
                .map(|(_, text)| text.chars().count() as u16)
                .max()
                .unwrap_or(0)
                + 2;
        }
        // The bars beside names have the same content as the names.
        let most = if chart.y.names.is_empty() {
            area.width / 2
        } else {
            3 * area.width / 4
        };
        let left = if left > most { 0 } else { left };
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
            line: false,
            below,
            label,
        }
    }

    /// Returns the point (x, y) on the axes of the chart at a cell of the screen, which is given by
    /// column and row. For a heat map it is the pair of axis values of the map cell that is drawn
    /// there, or `None` outside the map.
    pub fn data_at(&self, chart: &Chart, (column, row): (u16, u16)) -> Option<(f64, f64)> {
        let plot = self.plot;
        if let Some(map) = chart.map() {
            let inside = plot.contains((column, row).into());
            let (across, up) = inside.then(|| (column - plot.x, plot.bottom() - 1 - row))?;
            let value = |axis: &ChartAxis, values: &[f64], cells: u16, cell: u16| {
                values
                    .get(map::values_behind(axis, values, cells)[usize::from(cell)])
                    .copied()
            };
            let x = value(&chart.x, &map.columns, plot.width, across)?;
            return Some((x, value(&chart.y, &map.rows, plot.height, up)?));
        }
        let share = |at: u16, from: u16, cells: u16| {
            ((f64::from(at) + 0.5 - f64::from(from)) / f64::from(cells.max(1))).clamp(0.0, 1.0)
        };
        let number = |axis: &ChartAxis, share: f64| {
            axis.scale.number(axis.span.low + share * axis.span.width())
        };
        let x = number(&chart.x, share(column, plot.x, plot.width));
        Some((x, number(&chart.y, 1.0 - share(row, plot.y, plot.height))))
    }

    /// Returns column and row of the cell of the screen that contains the point (x, y) on the axes
    /// of the chart. Returns `None` for a point outside the chart; in a heat map such a point has
    /// the nearest cell at the edge.
    pub fn cell(&self, chart: &Chart, (x, y): (f64, f64)) -> Option<(u16, u16)> {
        let shares = (chart.x.share(x), 1.0 - chart.y.share(y));
        let (across, down) = (shares.0.clamp(0.0, 1.0), shares.1.clamp(0.0, 1.0));
        let inside = chart.map().is_some() || (across, down) == shares;
        let cell = |share: f64, cells: u16, dots: u16| match chart.map() {
            Some(_) => ((share * f64::from(cells)) as u16).min(cells - 1),
            None => cell_at(share, cells, dots),
        };
        (inside && !self.plot.is_empty()).then(|| {
            let column = cell(across, self.plot.width, DOTS.0);
            (
                self.plot.x + column,
                self.plot.y + cell(down, self.plot.height, DOTS.1),
            )
        })
    }

    /// Draws the data of the chart and the numbers along its axes into the cells of a buffer.
    pub fn draw(&self, buffer: &mut Buffer, chart: &Chart, style: &CellStyle<'_>) {
        if self.plot.is_empty() {
            return;
        }
        self.draw_scales(buffer, chart, style);
        for layer in &chart.layers {
            if let Shape::Map(map) = &layer.shape {
                map::draw(buffer, self.plot, chart, map, style);
            }
        }
        let drawn = |layer: &&Layer| !matches!(layer.shape, Shape::Map(_));
        if chart.layers.iter().any(|layer| drawn(&layer)) {
            Canvas::default()
                .marker(Marker::Braille)
                .x_bounds([0.0, 1.0])
                .y_bounds([0.0, 1.0])
                .paint(|context| {
                    for layer in chart.layers.iter().filter(drawn) {
                        context.layer();
                        let (shape, ink) = (&layer.shape, layer.ink);
                        let colour = (style.ink)(ink).fg.unwrap_or_default();
                        context.draw(&LayerShape {
                            chart,
                            shape,
                            ink,
                            colour,
                        });
                    }
                })
                .render(self.plot, buffer);
        }
        self.draw_signs(buffer, chart, style);
    }

    /// Writes the longest text of a name that fits on blank cells beside one of the points
    /// [`Name::at`]. Returns false if no text fits.
    pub fn draw_name(
        &self,
        buffer: &mut Buffer,
        chart: &Chart,
        style: &CellStyle<'_>,
        name: &Name,
    ) -> bool {
        let pairs = name
            .texts
            .iter()
            .flat_map(|text| name.at.iter().map(move |at| (text, *at)));
        for (text, at) in pairs {
            if let Some((x, y)) = self.free_place(buffer, chart, at, text) {
                buffer.set_string(x, y, text, (style.ink)(name.ink));
                return true;
            }
        }
        false
    }

    /// Returns the first cell of a text that fits on blank cells beside a point.
    fn free_place(
        &self,
        buffer: &Buffer,
        chart: &Chart,
        point: (f64, f64),
        text: &str,
    ) -> Option<(u16, u16)> {
        let plot = self.plot;
        let all_columns = i32::from(plot.x)..i32::from(plot.right());
        let all_rows = i32::from(plot.y)..i32::from(plot.bottom());
        let cell = self.cell(chart, point)?;
        let (column, row) = (i32::from(cell.0), i32::from(cell.1));
        let wide = text.chars().count() as i32;
        let rows = [row, row + 1, row - 1].into_iter();
        let sides = rows.flat_map(|y| [(column + 2, y), (column - 1 - wide, y)]);
        let mut places = sides.chain([row + 1, row - 1].map(|y| (column - wide / 2, y)));
        let free = places.find(|&(x, y)| {
            let inside =
                all_columns.start <= x && x + wide <= all_columns.end && all_rows.contains(&y);
            // With a blank column on either side, unless the plot ends there.
            let mut columns = (x - 1).max(all_columns.start)..(x + wide + 1).min(all_columns.end);
            inside
                && columns.all(|column| {
                    let at = (column as u16, y as u16);
                    at == cell || matches!(buffer[at].symbol(), " " | "\u{2800}")
                })
        });
        free.map(|(x, y)| (x as u16, y as u16))
    }

    fn draw_signs(&self, buffer: &mut Buffer, chart: &Chart, style: &CellStyle<'_>) {
        for layer in &chart.layers {
            let Shape::Curve {
                points,
                sign: Some(sign),
                ..
            } = &layer.shape
            else {
                continue;
            };
            // A point is a dot, which the canvas draws.
            if *sign == Sign::Point {
                continue;
            }
            // At most one sign in every other column.
            let every = (2 * points.len())
                .div_ceil(usize::from(self.plot.width))
                .max(1);
            for point in points.iter().step_by(every) {
                if let Some((column, row)) = self.cell(chart, *point) {
                    buffer[(column, row)]
                        .set_symbol(glyph(*sign))
                        .set_style((style.ink)(layer.ink));
                }
            }
        }
    }

    fn draw_scales(&self, buffer: &mut Buffer, chart: &Chart, style: &CellStyle<'_>) {
        let (plot, quiet) = (self.plot, (style.ink)(Ink::Quiet));
        if self.left > 0 {
            let labels = scale_beside(chart, plot.height);
            for row in 0..plot.height {
                let label = labels
                    .iter()
                    .find(|(at, _)| *at == row)
                    .map(|(_, text)| text.as_str());
                let mark = if label.is_some() { '┤' } else { '│' };
                let width = usize::from(self.left) - 2;
                let text = format!("{:>width$} {mark}", label.unwrap_or_default());
                buffer.set_string(plot.x - self.left, plot.y + row, text, quiet);
            }
        }
        let mut y = plot.bottom();
        let (numbers, label) = scale_below(chart, plot.width, self.label);
        if self.line {
            let mut line: Vec<char> = vec!['─'; usize::from(plot.width)];
            for (column, _) in &numbers {
                line[usize::from(*column)] = '┬';
            }
            if self.left > 0 {
                buffer.set_string(plot.x - 1, y, "└", quiet);
            }
            buffer.set_string(plot.x, y, line.into_iter().collect::<String>(), quiet);
        }
        y += self.between;
        if self.below {
            let from = plot.x - self.left;
            let width = (label.chars().count() as u16).min(plot.width);
            let end = plot.right() - if self.label { 0 } else { width };
            let mut free = from;
            for (column, text) in numbers {
                let width = text.chars().count() as u16;
                let x = (plot.x + column).saturating_sub(width / 2).max(from);
                let right = x + width;
                if x >= free && right < end.max(from + 1) + u16::from(self.label) {
                    buffer.set_string(x, y, text, quiet);
                    free = right + 1;
                }
            }
            let (x, y) = if self.label {
                (plot.x + (plot.width - width) / 2, y + 1)
            } else {
                (end, y)
            };
            buffer.set_stringn(x, y, label, usize::from(width), quiet);
        }
    }
}

/// Returns the cell at a share of `cells` cells. The share is rounded to one of the `dots` dots of
/// a cell, as the canvas does, so that signs and ticks fit their curves.
fn cell_at(share: f64, cells: u16, dots: u16) -> u16 {
    let last = f64::from(cells) * f64::from(dots) - 1.0;
    (share * last).round().max(0.0) as u16 / dots
}

/// Returns the rows of a plot of this height that have a number of the vertical axis, with these
/// numbers.
fn scale_beside(chart: &Chart, height: u16) -> Vec<(u16, String)> {
    let place = |at: f64| {
        cell_at(
            (chart.y.span.high - at) / chart.y.span.width(),
            height,
            DOTS.1,
        )
    };
    let fewest = usize::from(height / 3).clamp(2, 6);
    numbers_at(&chart.y, fewest..=fewest.max(height.into()), place, |_| {
        true
    })
}

/// Returns the numbers of an axis with their places. The fewest ticks of which two are visible are
/// used, or the fewest possible.
fn numbers_at(
    axis: &ChartAxis,
    ticks: RangeInclusive<usize>,
    place: impl Fn(f64) -> u16,
    is_seen: impl Fn(&(u16, String)) -> bool,
) -> Vec<(u16, String)> {
    let number = |tick: Tick| Some((place(tick.at), tick.label?.to_string()));
    let numbers = |most: usize| {
        axis.ticks(most)
            .into_iter()
            .filter_map(number)
            .collect::<Vec<_>>()
    };
    let fewest = *ticks.start();
    // Numbers in one cell count as one.
    let two = |numbers: &Vec<(u16, String)>| {
        let mut seen = numbers
            .iter()
            .filter(|number| is_seen(number))
            .map(|number| number.0);
        seen.next()
            .is_some_and(|first| seen.any(|other| other != first))
    };
    ticks
        .map(numbers)
        .find(two)
        .unwrap_or_else(|| numbers(fewest))
}

/// Returns the columns of a plot of this width that have a number of the horizontal axis, with
/// these numbers, and the label of the axis. The label is complete if it has its own row. Otherwise
/// it is only the symbol, if the name would take more than half of the columns.
fn scale_below(chart: &Chart, width: u16, own_row: bool) -> (Vec<(u16, String)>, String) {
    let mut label = chart.x.label_with_unit().to_string();
    let room = if own_row { width } else { width / 2 };
    if label.chars().count() > usize::from(room) {
        label = chart.x.symbol_with_unit().to_string();
    }
    let place = |at: f64| {
        cell_at(
            (at - chart.x.span.low) / chart.x.span.width(),
            width,
            DOTS.0,
        )
    };
    let fewest = usize::from(width / 10).clamp(2, 9);
    let is_seen = |number: &(u16, String)| !is_covered(number, width, &label);
    let mut numbers = numbers_at(
        &chart.x,
        fewest..=fewest.max(usize::from(width / 4)),
        place,
        is_seen,
    );
    numbers.retain(|(column, _)| *column < width);
    (numbers, label)
}

/// Returns true if a label at the right end of the same row would cover this number.
fn is_covered((column, text): &(u16, String), width: u16, label: &str) -> bool {
    let end = usize::from(width).saturating_sub(label.chars().count() + 1);
    usize::from(*column) + text.chars().count().div_ceil(2) > end
}

/// Returns true if the label of the horizontal axis would cover a number.
fn label_hides_numbers(chart: &Chart, width: u16) -> bool {
    let (numbers, label) = scale_below(chart, width, true);
    numbers
        .iter()
        .any(|number| is_covered(number, width, &label))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::style::Colours;
    use crate::chart::HeatMap;
    use crate::chart::Stroke;
    use crate::colour::Shades;
    use crate::scale::Span;
    use asperity_data::AxisScale;
    use ratatui::style::Style;

    const SIZES: [(u16, u16); 6] = [(20, 5), (32, 8), (47, 13), (60, 20), (80, 24), (118, 37)];

    fn axis(low: f64, high: f64, symbol: &str, unit: &str) -> ChartAxis {
        ChartAxis::new(AxisScale::Linear, Span { low, high }, "", symbol, unit)
    }

    fn chart(layers: Vec<Layer>) -> Chart {
        let (x, y) = (
            axis(-1.3e-7, 6.4e-7, "d", "m"),
            axis(-2.1e-5, 1.2e-5, "F", "N"),
        );
        Chart::new(x, y, layers)
    }

    fn drawn(chart: &Chart, (width, height): (u16, u16)) -> (CellPlot, Buffer) {
        let area = Rect::new(3, 2, width, height);
        let (place, mut buffer) = (CellPlot::within(area, chart), Buffer::empty(area));
        place.draw(
            &mut buffer,
            chart,
            &CellStyle {
                ink: &|_| Style::new(),
                colours: Colours::None,
            },
        );
        (place, buffer)
    }

    fn curve(points: &[(f64, f64)], sign: Option<Sign>) -> Layer {
        Layer::unnamed(
            Ink::Text,
            Shape::Curve {
                points: points.to_vec(),
                stroke: Some(Stroke::Solid),
                sign,
            },
        )
    }

    #[test]
    fn a_value_of_a_map_is_found_at_its_cell() {
        let columns: Vec<f64> = (1..20).map(|at| 0.05 * f64::from(at)).collect();
        let rows: Vec<f64> = (0..33)
            .map(|at| 0.125 * 2_f64.powf(0.25 * f64::from(at)))
            .collect();
        let span = |scale, values: &[f64]| HeatMap::span(scale, values);
        let map = HeatMap {
            values: vec![Some(1.0); columns.len() * rows.len()],
            key: axis(0.0, 1.0, "", "1"),
            shades: Shades::Sequential,
            classes: Vec::new(),
            class_names: Vec::new(),
            contour: None,
            columns: columns.clone(),
            rows: rows.clone(),
        };
        let chart = Chart::new(
            ChartAxis::new(
                AxisScale::Linear,
                span(AxisScale::Linear, &columns),
                "",
                "H",
                "1",
            ),
            ChartAxis::new(
                AxisScale::Logarithmic,
                span(AxisScale::Logarithmic, &rows),
                "",
                "κ",
                "1",
            ),
            vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))],
        );
        for (width, height) in [(20, 5), (66, 30), (118, 37), (200, 90)] {
            let place = CellPlot::within(Rect::new(3, 2, width, height), &chart);
            for (x, y) in columns
                .iter()
                .flat_map(|x| rows.iter().map(move |y| (*x, *y)))
            {
                let cell = place.cell(&chart, (x, y)).unwrap();
                let (across, up) = place.data_at(&chart, cell).unwrap();
                // Of several values in one cell, one whose middle is in that cell or the next.
                let (column, row) = place.cell(&chart, (across, up)).unwrap();
                assert!(
                    column.abs_diff(cell.0) <= 1 && row.abs_diff(cell.1) <= 1,
                    "{x} {y} {across} {up}"
                );
                let has_room = |cells: u16, values: &[f64]| usize::from(cells) >= values.len();
                assert!(
                    !has_room(place.plot.width, &columns) || across == x,
                    "{x} {across}"
                );
                assert!(!has_room(place.plot.height, &rows) || up == y, "{y} {up}");
            }
            // A point beyond the map is at its edge, and there is none outside the plot.
            let corner = Some((place.plot.right() - 1, place.plot.y));
            assert_eq!(place.cell(&chart, (9.0, 1e9)), corner);
            assert_eq!(
                place.data_at(&chart, (place.plot.right(), place.plot.y)),
                None
            );
        }
    }

    #[test]
    fn ticks_are_beside_the_dots_of_their_values() {
        let mut labelled = 0;
        for size in SIZES {
            let level = chart(vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))]);
            let (place, buffer) = drawn(&level, size);
            let row_of = |row: u16| -> String {
                (buffer.area.x..buffer.area.right())
                    .map(|column| buffer[(column, row)].symbol())
                    .collect()
            };
            for row in place.plot.y..place.plot.bottom() {
                let text = row_of(row);
                if let Some((number, _)) = text.split_once(" ┤") {
                    let is_level =
                        !["", " ", "\u{2800}"].contains(&buffer[(place.plot.x, row)].symbol());
                    assert_eq!(number.trim() == "0", is_level, "{size:?}\n{text}");
                    labelled += 1;
                }
            }
            if size.1 >= WITH_LINE_BELOW {
                let below: String = (place.plot.bottom() + 1..buffer.area.bottom())
                    .map(row_of)
                    .collect();
                assert!(
                    below.trim_end().ends_with("d (nm)") && below.contains(" 0"),
                    "{below}"
                );
            }
        }
        assert!(labelled > 20, "{labelled}");
    }

    #[test]
    fn names_are_beside_their_points_and_hide_nothing() {
        let points: Vec<(f64, f64)> = (0..40)
            .map(|at| (1.7e-8 * f64::from(at), -2e-5 + 5e-7 * f64::from(at)))
            .collect();
        let chart = chart(vec![curve(&points, None)]);
        let mut found = 0;
        for size in SIZES {
            let (place, before) = drawn(&chart, size);
            let mut after = before.clone();
            let style = CellStyle {
                ink: &|_| Style::new(),
                colours: Colours::None,
            };
            let names = [
                (points[9], "preload"),
                (points[30], "pull-off"),
                ((1.0, 0.0), "outside"),
            ];
            for (at, name) in names {
                let name = Name {
                    at: vec![at],
                    texts: vec![name.to_owned()],
                    ink: Ink::Quiet,
                };
                place.draw_name(&mut after, &chart, &style, &name);
            }
            let rows = after.content.chunks(usize::from(after.area.width));
            let text: String = rows
                .flat_map(|row| row.iter().map(|cell| cell.symbol()).chain(["\n"]))
                .collect();
            let written: Vec<&str> = names
                .iter()
                .map(|(_, name)| *name)
                .filter(|name| text.contains(name))
                .collect();
            assert!(!written.contains(&"outside"));
            found += written.len();
            for (cell, old) in after.content.iter().zip(&before.content) {
                let is_blank = [" ", "\u{2800}"].contains(&old.symbol());
                assert!(cell.symbol() == old.symbol() || is_blank, "{size:?}");
            }
            for (point, name) in names.iter().filter(|(_, name)| written.contains(name)) {
                let (column, row) = place.cell(&chart, *point).unwrap();
                let near = (row.saturating_sub(1).max(after.area.y)
                    ..=(row + 1).min(after.area.bottom() - 1))
                    .any(|y| {
                        let from = column
                            .saturating_sub(name.len() as u16 + 1)
                            .max(after.area.x);
                        let to = (column + name.len() as u16 + 2).min(after.area.right());
                        let text: String = (from..to).map(|x| after[(x, y)].symbol()).collect();
                        text.contains(name)
                    });
                assert!(near, "{size:?} {name}");
            }
        }
        assert!(found > 10, "{found}");
    }

    /// Of thousands of points each paints its dot, and a line above them keeps its cells.
    #[test]
    fn points_are_dots_below_a_line() {
        let cloud = (0..2000).map(|at| {
            (
                3e-10 * f64::from(at),
                -1.5e-5 + 2.4e-8 * f64::from(at * 7 % 1000),
            )
        });
        let cloud = Layer::unnamed(Ink::Kept, Shape::signs(cloud.collect(), Sign::Point));
        let line = curve(&[(0.0, 0.0), (6e-7, -1e-5)], None);
        let symbols = |layers: Vec<Layer>| {
            let (_, buffer) = drawn(&chart(layers), (60, 20));
            buffer
                .content
                .iter()
                .map(|cell| cell.symbol().to_owned())
                .collect::<Vec<_>>()
        };
        let (both, alone) = (
            symbols(vec![cloud.clone(), line.clone()]),
            symbols(vec![line]),
        );
        let is_dots = |symbol: &String| {
            symbol
                .chars()
                .all(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
        };
        assert!(
            alone
                .iter()
                .zip(&both)
                .all(|(line, both)| !is_dots(line) || line == both)
        );
        let dots = symbols(vec![cloud])
            .iter()
            .filter(|symbol| is_dots(symbol))
            .count();
        assert!(
            dots > 150 && alone.iter().filter(|symbol| is_dots(symbol)).count() > 20,
            "{dots} cells"
        );
        assert!(!both.iter().any(|symbol| symbol == glyph(Sign::Dot)));
    }

    #[test]
    fn a_chart_is_drawn_like_this() {
        let area = [(0.0, -1.5e-5), (5e-7, -1.5e-5), (5e-7, 0.0)];
        let columns =
            (0..40).map(|at| (at % 9 > 1).then(|| (2e-7 * f64::from(at), 2.4e-7 * f64::from(at))));
        let chart = chart(vec![
            Layer::unnamed(Ink::Quiet, Shape::Inside(area.to_vec())),
            Layer::unnamed(Ink::Quiet, Shape::Upright(1e-7)),
            Layer::unnamed(
                Ink::Contact,
                Shape::Boxes(vec![((5.2e-7, 6e-7), (-1.8e-5, -1e-5))]),
            ),
            Layer::unnamed(
                Ink::Profile,
                Shape::Envelope {
                    x: (-1e-7, 6e-7),
                    columns: columns.collect(),
                },
            ),
            curve(
                &[(-1e-7, 0.0), (2e-7, f64::NAN), (3e-7, -5e-6), (6e-7, -2e-5)],
                Some(Sign::Ring),
            ),
        ]);
        let (_, buffer) = drawn(&chart, (64, 18));
        let rows = buffer
            .content
            .chunks(64)
            .map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>());
        insta::assert_snapshot!(
            rows.map(|row| row.trim_end().to_owned())
                .collect::<Vec<_>>()
                .join("\n")
        );
    }
}
