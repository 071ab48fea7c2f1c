//! Panels: the content of panes as data. One renderer draws all of them, and finds from the same division of an area what
//! is under a cell.

use super::layout::{inside, is_framed, split_profile};
use super::text::{Part, filled, fitted, wrapped};
use super::theme::{Appearance, Meaning};
use asperity_data::{format_range, format_rounded};
use asperity_plot::{Axis, CellPlot, CellStyle, Chart, Colours, Ink, Shape, key, legend};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Scrollbar, ScrollbarOrientation, ScrollbarState, StatefulWidget, Widget};

pub struct Panel {
    pub title: String,
    pub head: Vec<Line<'static>>,
    pub body: Body,
    pub foot: Vec<Line<'static>>,
    /// Texts on the lower edge of the frame, the most important first.
    pub edge: Vec<Part>,
}

pub enum Body {
    Chart(Box<Plot>),
    /// A list, scrolled so that the selected row is visible.
    Rows {
        rows: Vec<Line<'static>>,
        selected: usize,
    },
    /// A text in place of a chart, such as the reason why the chart is missing.
    Text(String),
}

/// A chart with texts that a figure has in its legend.
pub struct Plot {
    pub chart: Chart,
    /// Texts beside points of the chart, with their inks.
    pub names: Vec<((f64, f64), String, Ink)>,
    /// A second chart on the right, with the same vertical axis.
    pub beside: Option<Chart>,
    /// A low chart below, with the same horizontal axis and its own vertical axis; shown where there is room.
    pub below: Option<Chart>,
    /// True for each spring in contact along the horizontal axis, shown by a row of signs; empty without such a row.
    pub contact: Vec<bool>,
}

/// Smallest number of rows of a chart with both scales; only the remaining rows are for lines above and below.
const FEWEST_ROWS: u16 = 6;
/// Largest number of rows for which the scales beside a chart are laid out; the plot has the rows of the chart.
const MOST_BESIDE: u16 = 15;
/// Smallest number of rows of an area with a chart below its chart, and the numbers of rows of the chart below.
pub const WITH_BELOW: u16 = 11;
const BELOW: std::ops::RangeInclusive<u16> = 3..=7;
/// Smallest number of rows of a chart with a row of contact signs.
const WITH_CONTACT: u16 = 5;

impl Panel {
    pub fn of_chart(title: String, chart: Chart) -> Panel {
        let plot = Plot { chart, names: Vec::new(), beside: None, below: None, contact: Vec::new() };
        Panel { body: Body::Chart(Box::new(plot)), ..Panel::of_text(title, "") }
    }

    pub fn of_text(title: String, text: &str) -> Panel {
        let body = Body::Text(text.to_owned());
        Panel { title, head: Vec::new(), body, foot: Vec::new(), edge: Vec::new() }
    }

    pub fn chart(&self) -> Option<&Chart> {
        if let Body::Chart(plot) = &self.body { Some(&plot.chart) } else { None }
    }

    /// Adds a vertical line at a share of the horizontal axis, with the values of all named curves there: on the lower edge
    /// or, if they need more than this width, below the chart.
    pub fn read_at(&mut self, share: f64, look: Appearance, width: u16) {
        let Body::Chart(plot) = &mut self.body else { return };
        let Chart { x: across, y: up, layers, .. } = &mut plot.chart;
        let at = across.span.low + share * across.span.width();
        let x = across.scale.number(at);
        let value = |axis: &Axis, number| format_rounded(number, 3, &axis.unit);
        let mut parts = vec![format!("{} {}", across.symbol_or_name(), value(across, x))];
        for layer in layers.iter().filter(|layer| !layer.name.is_empty()) {
            let read = |points: &[(f64, f64)]| {
                let place = |point: &(f64, f64)| (across.scale.coordinate(point.0), point.1);
                let mut between = points.windows(2).map(|pair| (place(&pair[0]), place(&pair[1])));
                let (from, to) =
                    between.find(|(from, to)| (from.0 - at) * (to.0 - at) <= 0.0 && from.0 != to.0)?;
                let [low, high] = [from.1, to.1].map(|y| up.scale.coordinate(y));
                // The ends themselves where there is nothing between them, or no coordinate.
                let share = (at - from.0) / (to.0 - from.0);
                let is_level = low == high || !(low.is_finite() && high.is_finite());
                Some(if is_level { from.1 } else { up.scale.number(low + (high - low) * share) })
            };
            match &layer.shape {
                Shape::Curve { points, .. } => {
                    parts.extend(read(points).map(|y| format!("{} {}", layer.name, value(up, y))));
                }
                Shape::Band(points) => {
                    let end = |of: fn(&(f64, f64, f64)) -> f64| {
                        read(&points.iter().map(|point| (point.0, of(point))).collect::<Vec<_>>())
                    };
                    let ends = end(|point| point.1).zip(end(|point| point.2));
                    let range = ends.map(|ends| format_range(ends, 3, &up.unit));
                    parts.extend(range.map(|range| format!("{} {range}", layer.name)));
                }
                _ => {}
            }
        }
        let upright = || asperity_plot::Layer::unnamed(Ink::Cursor, Shape::Upright(x));
        layers.insert(0, upright());
        plot.below.iter_mut().for_each(|below| below.layers.insert(0, upright()));
        let style = look.theme.style(Meaning::Cursor);
        let parts: Vec<Part> = parts.into_iter().map(|text| vec![Span::styled(text, style)]).collect();
        let lines = filled(parts.clone(), "  ", usize::from(width.saturating_sub(2)));
        match lines.len() {
            0..=1 => self.edge = parts,
            _ => drop(self.foot.splice(..0, lines)),
        }
    }
}

/// Label of the vertical axis with its unit, and the entries of the legend.
pub fn names(chart: &Chart, look: Appearance) -> Vec<Part> {
    let label = Span::styled(chart.y.label_with_unit().to_string(), look.theme.style(Meaning::Quiet));
    let entries = in_theme(look, |style| legend(std::slice::from_ref(chart), style));
    std::iter::once(vec![label]).chain(entries).collect()
}

/// Label of the vertical axis of a map, and its shades with their numbers, each at most `width` columns wide.
pub fn shades(chart: &Chart, look: Appearance, width: usize) -> Vec<Part> {
    let title = |text: String| Span::styled(text, look.theme.style(Meaning::Title));
    let scale = chart.map().map(|map| {
        let name = title(format!("{} ", map.key.label_with_unit()));
        let scale = key(map, width.saturating_sub(name.width()), Colours::None);
        std::iter::once(name).chain(scale.into_iter().map(|(text, _)| Span::raw(text))).collect()
    });
    let label = vec![title(format!("↑ {}", chart.y.label_with_unit()))];
    std::iter::once(label).chain(scale).collect()
}

/// Calls `draw` with the styles of charts for this appearance.
pub fn in_theme<R>(look: Appearance, draw: impl FnOnce(&CellStyle<'_>) -> R) -> R {
    let ink = |ink| look.theme.style(meaning(ink));
    draw(&CellStyle { ink: &ink, colours: Colours::None })
}

pub fn meaning(ink: Ink) -> Meaning {
    use Meaning::{Approach, Ghost, Manual, Quiet, Retraction, Surface, Text};
    match ink {
        Ink::Text => Meaning::Title,
        Ink::Quiet => Quiet,
        Ink::Profile => Meaning::Line,
        Ink::Surface => Surface,
        Ink::Contact => Meaning::Contact,
        Ink::Loading => Approach,
        Ink::Unloading => Retraction,
        Ink::Manual => Manual,
        Ink::Kept => Ghost,
        // The colours not used by the present curve.
        Ink::Compared(number) => [Surface, Manual, Text, Ghost][number % 4],
        Ink::Cursor => Meaning::Cursor,
        Ink::Series(number) => [Retraction, Surface, Manual, Approach, Quiet, Text][number % 6],
    }
}

struct Places {
    head: Rect,
    body: Rect,
    foot: Rect,
}

impl Places {
    /// Divides the area inside the frame into head, body and foot: in small windows first the foot becomes shorter, then
    /// the head.
    fn within(panel: &Panel, area: Rect) -> Places {
        let least = match &panel.body {
            Body::Chart(_) => FEWEST_ROWS,
            Body::Text(text) if text.is_empty() => 0,
            Body::Rows { .. } | Body::Text(_) => 1,
        };
        let room = area.height.saturating_sub(least);
        let above = (panel.head.len() as u16).min(room);
        let below = (panel.foot.len() as u16).min(room - above);
        let body = Rect { y: area.y + above, height: area.height - above - below, ..area };
        Places {
            head: Rect { height: above, ..area },
            body,
            foot: Rect { y: body.bottom(), height: below, ..area },
        }
    }
}

/// Draws a panel into an area, with a frame if there is room; a selected panel is marked.
pub fn draw(panel: &Panel, area: Rect, is_selected: bool, look: Appearance, buffer: &mut Buffer) {
    let quiet = look.theme.style(Meaning::Quiet);
    if is_framed(area) {
        let (mark, style) = if is_selected { ("▸", look.theme.style(Meaning::Title)) } else { ("", quiet) };
        let room = area.width - 2;
        let mut title = format!("{mark} {} ", panel.title);
        if title.chars().count() > usize::from(room) {
            title.truncate(title.trim_end().len());
        }
        let block = Block::bordered().border_style(quiet).title(fitted(Line::styled(title, style), room));
        let edge = spaced(panel.edge.clone(), usize::from(area.width.saturating_sub(4)));
        let edge = edge.filter(|edge| !edge.spans.is_empty());
        let edge =
            edge.map(|edge| Line::from_iter([" ".into()].into_iter().chain(edge.spans).chain([" ".into()])));
        edge.into_iter().fold(block, Block::title_bottom).render(area, buffer);
    }
    let Places { head, body, foot } = Places::within(panel, inside(area));
    draw_lines(&panel.head, head, buffer);
    draw_lines(&panel.foot, foot, buffer);
    match &panel.body {
        Body::Text(text) => {
            draw_lines(&wrapped(&Line::styled(text.clone(), quiet), body.width), body, buffer);
        }
        Body::Rows { rows, selected } => {
            let first = first_row(*selected, rows.len(), body.height);
            draw_lines(rows.get(first..).unwrap_or_default(), body, buffer);
            let hidden = rows.len().saturating_sub(body.height.into());
            if hidden > 0 && is_framed(area) {
                let mut state = ScrollbarState::new(hidden + 1).position(first);
                state = state.viewport_content_length(body.height.into());
                let bar = Scrollbar::new(ScrollbarOrientation::VerticalRight).style(quiet);
                let bar = bar.begin_symbol(None).end_symbol(None).track_symbol(Some("│")).thumb_symbol("█");
                bar.render(Rect { x: area.right() - 1, width: 1, ..body }, buffer, &mut state);
            }
        }
        Body::Chart(plot) => plot.draw(body, look, buffer),
    }
}

/// Draws lines from the top of an area down, as far as there is room; a line that is too wide ends in `…`.
pub fn draw_lines(lines: &[Line<'static>], area: Rect, buffer: &mut Buffer) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        buffer.set_line(area.x, y, &fitted(line.clone(), area.width), area.width);
    }
}

/// First visible row of a list. It depends only on the selected row, so that a click on a visible row does not scroll the
/// list; the rows above and below the selected one are visible.
fn first_row(selected: usize, rows: usize, height: u16) -> usize {
    let height = usize::from(height.max(1));
    let margin = usize::from(height >= 3);
    let page = height - 2 * margin;
    (selected.saturating_sub(margin) / page * page).min(rows.saturating_sub(height))
}

/// A line of the first parts that fit into a number of columns; two blanks apart if all fit, otherwise one.
pub fn spaced(parts: Vec<Part>, columns: usize) -> Option<Line<'static>> {
    let widths: usize = parts.iter().flatten().map(Span::width).sum();
    let between = if widths + 2 * parts.len().saturating_sub(1) <= columns { "  " } else { " " };
    filled(parts, between, columns).into_iter().next()
}

impl Plot {
    /// Division of an area into the chart and the area of the chart beside it.
    fn places(&self, area: Rect) -> (CellPlot, Option<Rect>) {
        let (left, right) = if self.beside.is_some() { split_profile(area) } else { (area, None) };
        let signs = u16::from(!self.contact.is_empty() && area.height >= WITH_CONTACT);
        let height = left.height - signs - self.rows_below(area);
        (CellPlot::within(Rect { height, ..left }, &self.chart), right)
    }

    /// Number of rows of the chart below.
    fn rows_below(&self, area: Rect) -> u16 {
        let has_room = self.below.is_some() && area.height >= WITH_BELOW;
        if has_room { (area.height / 4).clamp(*BELOW.start(), *BELOW.end()) } else { 0 }
    }

    /// Draws the chart below under the columns of the plot, with the ends of its vertical axis on the left.
    fn draw_below(&self, plot: Rect, area: Rect, style: &CellStyle<'_>, buffer: &mut Buffer) {
        let height = self.rows_below(area);
        let Some(below) = self.below.as_ref().filter(|_| height > 0) else { return };
        let place = Rect { y: area.bottom() - height, height, ..plot };
        // Numbers without a blank behind them if they need its column.
        let columns = usize::from(plot.x - area.x).saturating_sub(1);
        for row in (place.y..place.bottom()).filter(|_| columns > 0) {
            let end = match (row == place.y, row + 1 == place.bottom()) {
                (true, _) => Some(below.y.span.high),
                (_, true) => Some(below.y.span.low),
                _ => None,
            };
            let number = end.map_or_else(String::new, |end| format_rounded(end, 2, &below.y.unit));
            let number = match columns.checked_sub(number.len()) {
                None => String::new(),
                Some(0) => number,
                Some(_) => format!("{number} "),
            };
            let mark = if end.is_some() { '┤' } else { '│' };
            let text = format!("{number:>columns$}{mark}");
            buffer.set_string(area.x, row, text, (style.ink)(Ink::Quiet));
        }
        let mut cells = CellPlot::within(Rect { height: 1, ..place }, below);
        cells.plot = place;
        cells.draw(buffer, below, style);
    }

    fn draw(&self, area: Rect, look: Appearance, buffer: &mut Buffer) {
        let (place, right) = self.places(area);
        let plot = place.plot;
        in_theme(look, |style| {
            place.draw(buffer, &self.chart, style);
            place.draw_names(buffer, &self.chart, style, &self.names);
            self.draw_below(plot, area, style, buffer);
            if let Some((chart, right)) = self.beside.as_ref().zip(right) {
                (plot.y..plot.bottom()).for_each(|y| {
                    buffer.set_string(right.x, y, "│", (style.ink)(Ink::Quiet));
                });
                let right = Rect { x: right.x + 1, width: right.width - 1, ..right };
                // The label below has no row of its own.
                let height = right.height.min(MOST_BESIDE);
                let mut beside = CellPlot::within(Rect { height, ..right }, chart);
                (beside.plot.y, beside.plot.height) = (plot.y, plot.height);
                beside.draw(buffer, chart, style);
            }
        });
        if self.chart.map().is_some() {
            self.point_at_mark(&place, look, buffer);
        }
        if !self.contact.is_empty() && area.height >= WITH_CONTACT {
            let signs = contact_signs(&self.contact, usize::from(plot.width));
            buffer.set_string(plot.x, area.bottom() - 1, signs, look.theme.style(Meaning::Contact));
        }
    }

    /// Draws pointers on the axes of a map at the mark of the scene, and blanks on both sides of the mark, so that it is
    /// visible without colours.
    fn point_at_mark(&self, place: &CellPlot, look: Appearance, buffer: &mut Buffer) {
        let marked = self.chart.layers.iter().rev().find(|layer| layer.ink == Ink::Cursor);
        let Some(Shape::Curve { points, .. }) = marked.map(|layer| &layer.shape) else { return };
        let cell = points.first().and_then(|at| place.cell(&self.chart, *at));
        let Some((x, y)) = cell else { return };
        let (plot, style) = (place.plot, look.theme.style(Meaning::Cursor));
        for beside in [x.wrapping_sub(1), x + 1].into_iter().filter(|x| (plot.x..plot.right()).contains(x)) {
            buffer[(beside, y)].set_symbol(" ");
        }
        let is_line = |cell: &Cell| ["─", "┬"].contains(&cell.symbol());
        if let Some(cell) = buffer.cell_mut((x, plot.bottom())).filter(|cell| is_line(cell)) {
            cell.set_symbol("▲").set_style(style);
        }
        let is_line = |cell: &Cell| ["│", "┤"].contains(&cell.symbol());
        if let Some(cell) = buffer.cell_mut((plot.x.wrapping_sub(1), y)).filter(|cell| is_line(cell)) {
            cell.set_symbol("▶").set_style(style);
        }
    }
}

/// A sign for each cell of a row: `■` if all springs are in contact, `▪` if some are, `·` if none is.
fn contact_signs(contact: &[bool], cells: usize) -> String {
    let sign = |cell: usize| {
        let from = cell * contact.len() / cells;
        let part = &contact[from..((cell + 1) * contact.len() / cells).max(from + 1)];
        match part.iter().filter(|touches| **touches).count() {
            0 => '·',
            touching if touching < part.len() => '▪',
            _ => '■',
        }
    };
    (0..cells).map(sign).collect()
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Under {
    /// Numbers on the axes of a chart; for a cell beside the plot the numbers of the nearest cell.
    Data(f64, f64),
    Row(usize),
    Frame,
}

/// Returns what a panel drawn into an area shows in a cell.
pub fn under(panel: &Panel, area: Rect, cell: Position) -> Under {
    let inner = inside(area);
    let body = Places::within(panel, inner).body;
    match &panel.body {
        Body::Chart(plot) if inner.contains(cell) => {
            let data = plot.places(body).0.data_at(&plot.chart, (cell.x, cell.y));
            data.map_or(Under::Frame, |(x, y)| Under::Data(x, y))
        }
        Body::Rows { rows, selected } if body.contains(cell) => {
            let row = first_row(*selected, rows.len(), body.height) + usize::from(cell.y - body.y);
            if row < rows.len() { Under::Row(row) } else { Under::Frame }
        }
        _ => Under::Frame,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::theme::{Marker, Theme};
    use asperity_data::AxisScale;
    use asperity_plot::{Layer, Span as Range, Stroke};

    #[test]
    fn the_crosshair_reads_curves_and_both_ends_of_bands() {
        let axis =
            |symbol: &str| Axis::new(AxisScale::Linear, Range { low: 0.0, high: 4.0 }, "", symbol, "1");
        let layers = vec![
            Layer::new("quartiles".into(), Ink::Kept, Shape::Band(vec![(0.0, 1.0, 2.0), (4.0, 3.0, 4.0)])),
            Layer::new("median".into(), Ink::Kept, Shape::line(vec![(0.0, 2.0), (4.0, 3.0)], Stroke::Solid)),
            Layer::unnamed(Ink::Quiet, Shape::Level(1.0)),
        ];
        let mut panel = Panel::of_chart(String::new(), Chart::new(axis("x"), axis("y"), layers));
        panel.read_at(0.25, Appearance { theme: Theme::Plain, marker: Marker::Braille }, 80);
        let read: Vec<String> = panel.edge.iter().map(|part| part[0].content.to_string()).collect();
        assert_eq!(read, ["x 1", "quartiles 1.5 to 2.5", "median 2.25"]);
    }
}
