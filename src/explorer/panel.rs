//! Panels: the contents of panes as data. One function draws any panel. Another function returns
//! what a panel shows in a given character cell. Both functions divide the area in the same way.

use super::layout::{has_title, inside};
use super::text::{Part, filled, fitted, wrapped};
use super::theme::{Appearance, Meaning};
use asperity_data::{format_range, format_rounded};
use asperity_plot::{Chart, Ink, Layer, PaneChart, Shape, key, legend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Scrollbar, ScrollbarOrientation, ScrollbarState, StatefulWidget};

pub struct Panel {
    pub title: String,
    pub head: Vec<Line<'static>>,
    pub body: Body,
    pub foot: Vec<Line<'static>>,
    /// Texts at the right end of the title line, the most important first.
    pub edge: Vec<Part>,
}

pub enum Body {
    Chart(Box<PaneChart>),
    /// List of rows, scrolled so that the selected row is visible.
    Rows {
        rows: Vec<Line<'static>>,
        selected: usize,
    },
    /// Lines from the top downwards.
    Lines(Vec<Line<'static>>),
    /// Text in place of a chart, such as the reason why there is no chart.
    Text(String),
}

/// Largest number of attempts to divide a pane between its legend and its chart.
const MOST_ROUNDS: usize = 4;
/// Two positions on an axis count as equal if their distance is below this share of the length of
/// the axis.
const HAIR: f64 = 1e-9;
/// Width in columns below which a pane is narrow. If the texts of a narrow pane do not all fit
/// beside its title, as many as possible are shown there nevertheless.
const NARROW: u16 = 40;
/// Smallest height in rows of a chart with both axes. Lines above and below the chart get only the
/// rows that remain.
const FEWEST_ROWS: u16 = 6;
/// Number of columns of the title line that neither the title nor the texts on its right may use.
const FRAME_OF_TITLE: usize = 8;

impl Panel {
    pub fn of_chart(title: String, chart: Chart) -> Panel {
        Panel {
            body: Body::Chart(Box::new(PaneChart::new(chart))),
            ..Panel::of_text(title, "")
        }
    }

    pub fn of_text(title: String, text: &str) -> Panel {
        let body = Body::Text(text.to_owned());
        Panel {
            title,
            head: Vec::new(),
            body,
            foot: Vec::new(),
            edge: Vec::new(),
        }
    }

    pub fn chart(&self) -> Option<&Chart> {
        if let Body::Chart(plot) = &self.body {
            Some(&plot.chart)
        } else {
            None
        }
    }

    /// Adds a crosshair to the chart: a vertical line, and the values of all named curves at this
    /// line. `share`, from 0 to 1, is the position of the line on the horizontal axis. The values
    /// are written beside the title or, if they do not fit into `width` columns, below the chart.
    pub fn read_at(&mut self, share: f64, look: Appearance, width: u16) {
        let Body::Chart(plot) = &mut self.body else {
            return;
        };
        let axis = &plot.chart.x;
        let coordinate = axis.span.low + share * axis.span.width();
        let x = axis.scale.number(coordinate);
        let texts = values_at(&plot.chart, coordinate);
        plot.chart.layers.insert(0, upright(x));
        if let Some(below) = &mut plot.below {
            below.layers.insert(0, upright(x));
        }
        let style = look.style(Meaning::Cursor);
        let readings = texts
            .into_iter()
            .map(|text| vec![Span::styled(text, style)])
            .collect();
        self.show(readings, width);
    }

    /// Writes the values at the crosshair beside the title or, if they do not all fit there, below
    /// the chart.
    pub fn show(&mut self, readings: Vec<Part>, width: u16) {
        let taken = self.title.chars().count() + FRAME_OF_TITLE;
        let room = usize::from(width).saturating_sub(taken);
        let lines = filled(readings.clone(), "  ", room);
        let is_whole = lines.len() == 1 && lines[0].spans.len() + 1 >= 2 * readings.len();
        if is_whole {
            self.edge = readings;
            return;
        }
        // A low pane has no rows below its chart. Therefore a narrow pane also writes as many
        // values as possible beside its title.
        self.edge = if width < NARROW {
            readings.clone()
        } else {
            Vec::new()
        };
        self.foot.splice(..0, filled(readings, "  ", width.into()));
    }
}

/// Adds to the title of each page its number and the key for the next page, if there are several
/// pages.
pub fn numbered(mut pages: Vec<Panel>) -> Vec<Panel> {
    let count = pages.len();
    if count > 1 {
        for (number, page) in (1..).zip(&mut pages) {
            page.title = format!("{} · {number}/{count} PageDown", page.title);
        }
    }
    pages
}

/// Returns the vertical line of the crosshair.
fn upright(x: f64) -> Layer {
    Layer::unnamed(Ink::Cursor, Shape::Upright(x))
}

/// Returns the number on the horizontal axis at a coordinate and the values of all named curves
/// there, as texts.
fn values_at(chart: &Chart, coordinate: f64) -> Vec<String> {
    let x = chart.x.scale.number(coordinate);
    let mut texts = vec![format!(
        "{} {}",
        chart.x.symbol_or_name(),
        format_rounded(x, 3, &chart.x.unit)
    )];
    for layer in &chart.layers {
        if layer.name.is_empty() {
            continue;
        }
        let before = texts.len();
        match &layer.shape {
            Shape::Curve { points, .. } => {
                if let Some(y) = height_at(chart, points, coordinate) {
                    let value = format_rounded(y, 3, &chart.y.unit);
                    texts.push(format!("{} {value}", layer.name));
                }
            }
            Shape::Band(points) => {
                let lower: Vec<_> = points.iter().map(|point| (point.0, point.1)).collect();
                let upper: Vec<_> = points.iter().map(|point| (point.0, point.2)).collect();
                if let Some(low) = height_at(chart, &lower, coordinate)
                    && let Some(high) = height_at(chart, &upper, coordinate)
                {
                    let range = format_range((low, high), 3, &chart.y.unit);
                    texts.push(format!("{} {range}", layer.name));
                }
            }
            _ => {}
        }
        // Parts of a curve that meet at the crosshair have the same value.
        if texts[..before].contains(&texts[texts.len() - 1]) {
            texts.truncate(before);
        }
    }
    texts
}

/// Returns the number on the vertical axis at the first point where a curve passes this coordinate
/// of the horizontal axis; `None` if the curve does not reach the coordinate.
fn height_at(chart: &Chart, points: &[(f64, f64)], coordinate: f64) -> Option<f64> {
    for pair in points.windows(2) {
        let from = chart.x.scale.coordinate(pair[0].0);
        let to = chart.x.scale.coordinate(pair[1].0);
        // Due to rounding, the end of a curve may lie slightly before the coordinate.
        let rounding = HAIR * chart.x.span.width() * (to - from).abs();
        let is_between = (from - coordinate) * (to - coordinate) <= rounding;
        if !is_between || from == to {
            continue;
        }
        let low = chart.y.scale.coordinate(pair[0].1);
        let high = chart.y.scale.coordinate(pair[1].1);
        // An end of the segment may have no finite coordinate, such as a negative number on a
        // logarithmic axis. Then no value between the two ends can be computed.
        if low == high || !low.is_finite() || !high.is_finite() {
            return Some(pair[0].1);
        }
        let share = (coordinate - from) / (to - from);
        return Some(chart.y.scale.number(low + (high - low) * share));
    }
    None
}

/// Returns the entries of the legend of a chart.
pub fn entries(chart: &Chart, look: Appearance) -> Vec<Part> {
    legend(std::slice::from_ref(chart), look.palette())
}

/// Returns the label of the vertical axis of a map, and the colour scale of the map with its
/// numbers. The colour scale is at most `width` columns wide.
pub fn shades(chart: &Chart, look: Appearance, width: usize) -> Vec<Part> {
    let style = look.style(Meaning::Title);
    let label = Span::styled(format!("↑ {}", chart.y.label_with_unit()), style);
    let mut parts = vec![vec![label]];
    if let Some(map) = chart.map() {
        let name = Span::styled(format!("{} ", map.key.label_with_unit()), style);
        let room = width.saturating_sub(name.width());
        let mut scale = vec![name];
        for (text, style) in key(map, room, look.palette()) {
            scale.push(Span::styled(text, style));
        }
        parts.push(scale);
    }
    parts
}

struct Places {
    head: Rect,
    body: Rect,
    foot: Rect,
}

impl Places {
    /// Divides the area below the title into head, body and foot. In a small window, first the foot
    /// and then the head gets fewer lines.
    fn within(panel: &Panel, legend: usize, area: Rect) -> Places {
        let least = match &panel.body {
            Body::Chart(_) => FEWEST_ROWS,
            Body::Text(text) if text.is_empty() => 0,
            Body::Rows { .. } | Body::Lines(_) | Body::Text(_) => 1,
        };
        let room = area.height.saturating_sub(least);
        let above = ((panel.head.len() + legend) as u16).min(room);
        let below = (panel.foot.len() as u16).min(room - above);
        let body = Rect {
            y: area.y + above,
            height: area.height - above - below,
            ..area
        };
        Places {
            head: Rect {
                height: above,
                ..area
            },
            body,
            foot: Rect {
                y: body.bottom(),
                height: below,
                ..area
            },
        }
    }
}

/// Draws a panel into an area, with a title if there is room for it. If the panel is selected, its
/// title is marked.
pub fn draw(panel: &Panel, area: Rect, is_selected: bool, look: Appearance, buffer: &mut Buffer) {
    let Heading { legend, edge } = heading(panel, area, look);
    let Places { head, body, foot } = Places::within(panel, legend.len(), inside(area));
    draw_lines(&[&panel.head[..], &legend].concat(), head, buffer);
    draw_lines(&panel.foot, foot, buffer);
    match &panel.body {
        Body::Text(text) => {
            let text = Line::styled(text.clone(), look.style(Meaning::Quiet));
            draw_lines(&wrapped(&text, body.width), body, buffer);
        }
        Body::Rows { rows, selected } => {
            let first = first_row(*selected, rows.len(), body.height);
            draw_lines(rows.get(first..).unwrap_or_default(), body, buffer);
            let hidden = rows.len().saturating_sub(body.height.into());
            if hidden > 0 && has_title(area) {
                let column = Rect {
                    x: area.right() - 1,
                    width: 1,
                    ..body
                };
                draw_scrollbar(first, hidden, column, look, buffer);
            }
        }
        Body::Lines(lines) => draw_lines(lines, body, buffer),
        Body::Chart(plot) => drop(plot.draw(body, look.palette(), buffer)),
    }
    if has_title(area) {
        // The last column of a pane stays blank if another pane is on its right.
        let width = area.width - u16::from(area.right() < buffer.area.right());
        let line = title_line(&panel.title, edge, width, is_selected, look);
        draw_lines(&[line], area, buffer);
    }
}

/// Draws the scrollbar of a list. `first` is the first visible row, and `hidden` the number of rows
/// that are not visible.
fn draw_scrollbar(
    first: usize,
    hidden: usize,
    column: Rect,
    look: Appearance,
    buffer: &mut Buffer,
) {
    let bar = Scrollbar::new(ScrollbarOrientation::VerticalRight)
        .style(look.style(Meaning::Quiet))
        .begin_symbol(None)
        .end_symbol(None)
        .track_symbol(Some("│"))
        .thumb_symbol("█");
    let mut state = ScrollbarState::new(hidden + 1)
        .position(first)
        .viewport_content_length(column.height.into());
    bar.render(column, buffer, &mut state);
}

/// Parts of a panel above its chart, in addition to the text of the title and the head.
struct Heading {
    /// Lines above the chart with entries of the legend.
    legend: Vec<Line<'static>>,
    /// Texts on the right of the title line.
    edge: Vec<Part>,
}

/// Places the legend, which has an entry for each curve whose name does not fit beside the curve.
/// If the title line has room for all entries, they are placed there, before the texts on the
/// right. Otherwise they are written in lines above the chart.
fn heading(panel: &Panel, area: Rect, look: Appearance) -> Heading {
    let mut heading = Heading {
        legend: Vec::new(),
        edge: panel.edge.clone(),
    };
    let Body::Chart(plot) = &panel.body else {
        return heading;
    };
    let inner = inside(area);
    let mut entries: Vec<Part> = Vec::new();
    // Each line of the legend leaves less room for names beside the curves, so that further names
    // may need an entry in the legend. Therefore the division of the pane is repeated.
    for _ in 0..MOST_ROUNDS {
        let body = Places::within(panel, heading.legend.len(), inner).body;
        let left_out = plot.draw(body, look.palette(), &mut Buffer::empty(body));
        let before = entries.len();
        let known = entries.clone();
        entries.extend(left_out.into_iter().filter(|entry| !known.contains(entry)));
        let in_title = [&entries[..], &panel.edge].concat();
        if heading.legend.is_empty()
            && (!has_title(area) || fits_into_title(&panel.title, &in_title, area.width))
        {
            heading.edge = in_title;
            return heading;
        }
        if entries.len() == before {
            break;
        }
        heading.legend = filled(entries.clone(), "  ", inner.width.into());
    }
    heading
}

/// Returns true if a title line of this width has room for the title and all texts.
fn fits_into_title(title: &str, texts: &[Part], width: u16) -> bool {
    let mut taken = title.chars().count() + FRAME_OF_TITLE;
    for text in texts {
        taken += text.iter().map(Span::width).sum::<usize>() + 1;
    }
    taken <= usize::from(width)
}

/// Returns the title line of a pane: the title, a rule, and on the right as many of the texts
/// `edge` as fit.
pub fn title_line(
    title: &str,
    edge: Vec<Part>,
    width: u16,
    is_selected: bool,
    look: Appearance,
) -> Line<'static> {
    let quiet = look.style(Meaning::Quiet);
    let (mark, style) = if is_selected {
        ("▸", look.style(Meaning::Title))
    } else {
        ("─", quiet)
    };
    let mut line = fitted(Line::styled(format!("{mark} {title} "), style), width);
    let room = usize::from(width) - line.width();
    let edge = spaced(edge, room.saturating_sub(4));
    if edge.width() == 0 {
        line.push_span(Span::styled("─".repeat(room), quiet));
        return line;
    }
    let dashes = room - (edge.width() + 2);
    line.push_span(Span::styled("─".repeat(dashes), quiet));
    line.push_span(Span::raw(" "));
    line.spans.extend(edge.spans);
    line.push_span(Span::raw(" "));
    line
}

/// Draws as many of the lines as fit into an area, from its top downwards. A line that is too wide
/// is cut and ends in `…`.
pub fn draw_lines(lines: &[Line<'static>], area: Rect, buffer: &mut Buffer) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        buffer.set_line(area.x, y, &fitted(line.clone(), area.width), area.width);
    }
}

/// Returns the first visible row of a list. The row depends only on the selected row, so that a
/// click on a visible row usually does not scroll the list. The rows directly above and below the
/// selected row are visible too.
fn first_row(selected: usize, rows: usize, height: u16) -> usize {
    let height = usize::from(height.max(1));
    let margin = usize::from(height >= 3);
    let page = height - 2 * margin;
    (selected.saturating_sub(margin) / page * page).min(rows.saturating_sub(height))
}

/// Joins parts to one line. The first part that does not fit into the columns, and all later parts,
/// are left out. If there is room, two blanks separate the parts, otherwise one.
fn spaced(mut parts: Vec<Part>, columns: usize) -> Line<'static> {
    let widths: usize = parts.iter().flatten().map(Span::width).sum();
    let fits_wide = widths + 2 * parts.len().saturating_sub(1) <= columns;
    let between = if fits_wide { "  " } else { " " };
    let mut taken = 0;
    let mut count = 0;
    for part in &parts {
        taken += part.iter().map(Span::width).sum::<usize>();
        if taken > columns {
            break;
        }
        taken += between.len();
        count += 1;
    }
    parts.truncate(count);
    let lines = filled(parts, between, columns);
    lines.into_iter().next().unwrap_or_default()
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Under {
    /// Numbers on the horizontal and on the vertical axis of a chart at this cell. For a cell
    /// outside the plot area, these are the numbers at the nearest cell inside.
    Data(f64, f64),
    Row(usize),
    /// A column of a body of lines, and the number of its columns.
    Column(usize, usize),
    Frame,
}

/// Returns what a panel shows in the character cell `cell` of the screen. `area` is the area into
/// which the panel is drawn.
pub fn under(panel: &Panel, area: Rect, look: Appearance, cell: Position) -> Under {
    let inner = inside(area);
    let legend = heading(panel, area, look).legend;
    let body = Places::within(panel, legend.len(), inner).body;
    match &panel.body {
        Body::Chart(plot) if inner.contains(cell) => {
            let (cells, _) = plot.divided(body);
            match cells.data_at(&plot.chart, (cell.x, cell.y)) {
                Some((x, y)) => Under::Data(x, y),
                None => Under::Frame,
            }
        }
        Body::Rows { rows, selected } if body.contains(cell) => {
            let first = first_row(*selected, rows.len(), body.height);
            let row = first + usize::from(cell.y - body.y);
            if row < rows.len() {
                Under::Row(row)
            } else {
                Under::Frame
            }
        }
        Body::Lines(_) if body.contains(cell) => {
            Under::Column((cell.x - body.x).into(), body.width.into())
        }
        _ => Under::Frame,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::theme::{Marker, Theme};
    use asperity_data::AxisScale;
    use asperity_plot::{ChartAxis, Colours, Span as Range, Stroke};

    #[test]
    fn the_crosshair_reads_curves_and_both_ends_of_bands() {
        let axis = |symbol: &str| {
            ChartAxis::new(
                AxisScale::Linear,
                Range {
                    low: 0.0,
                    high: 4.0,
                },
                "",
                symbol,
                "1",
            )
        };
        let layers = vec![
            Layer::new(
                "quartiles".into(),
                Ink::Kept,
                Shape::Band(vec![(0.0, 1.0, 2.0), (4.0, 3.0, 4.0)]),
            ),
            Layer::new(
                "median".into(),
                Ink::Kept,
                Shape::line(vec![(0.0, 2.0), (4.0, 3.0)], Stroke::Solid),
            ),
            Layer::unnamed(Ink::Quiet, Shape::Level(1.0)),
        ];
        let mut panel = Panel::of_chart(String::new(), Chart::new(axis("x"), axis("y"), layers));
        panel.read_at(
            0.25,
            Appearance {
                theme: Theme::Neutral,
                colours: Colours::Plain,
                marker: Marker::Braille,
            },
            80,
        );
        let read: Vec<String> = panel
            .edge
            .iter()
            .map(|part| part[0].content.to_string())
            .collect();
        assert_eq!(read, ["x 1", "quartiles 1.5 to 2.5", "median 2.25"]);
    }
}
