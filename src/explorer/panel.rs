//! Panels: the content of panes as data. One renderer draws all of them, and finds from the same
//! division of an area what is under a cell.

use super::layout::{has_title, inside};
use super::text::{Part, filled, fitted, wrapped};
use super::theme::{Appearance, Meaning};
use asperity_data::{format_range, format_rounded};
use asperity_plot::{CellStyle, Chart, ChartAxis, Colours, Ink, PaneChart, Shape, key, legend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Scrollbar, ScrollbarOrientation, ScrollbarState, StatefulWidget};

pub struct Panel {
    pub title: String,
    pub head: Vec<Line<'static>>,
    pub body: Body,
    pub foot: Vec<Line<'static>>,
    /// Texts on the right of the title, the most important first.
    pub edge: Vec<Part>,
}

pub enum Body {
    Chart(Box<PaneChart>),
    /// A list, scrolled so that the selected row is visible.
    Rows {
        rows: Vec<Line<'static>>,
        selected: usize,
    },
    /// A text in place of a chart, such as the reason why the chart is missing.
    Text(String),
}

/// Largest number of divisions of a pane between its legend and its chart that are tried.
const MOST_ROUNDS: usize = 4;
/// Share of an axis below which a distance is one of rounding.
const HAIR: f64 = 1e-9;
/// Width of a pane, columns, below which its title has as many readings as there is room for.
const NARROW: u16 = 40;
/// Smallest number of rows of a chart with both scales; only the remaining rows are for lines above
/// and below.
const FEWEST_ROWS: u16 = 6;
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

    /// Adds a vertical line at a share of the horizontal axis, with the values of all named curves
    /// there: beside the title or, if they need more than this width, below the chart.
    pub fn read_at(&mut self, share: f64, look: Appearance, width: u16) {
        let Body::Chart(plot) = &mut self.body else {
            return;
        };
        let Chart {
            x: across,
            y: up,
            layers,
            ..
        } = &mut plot.chart;
        let at = across.span.low + share * across.span.width();
        let x = across.scale.number(at);
        let value = |axis: &ChartAxis, number| format_rounded(number, 3, &axis.unit);
        let mut parts = vec![format!("{} {}", across.symbol_or_name(), value(across, x))];
        for layer in layers.iter().filter(|layer| !layer.name.is_empty()) {
            let read = |points: &[(f64, f64)]| {
                let place = |point: &(f64, f64)| (across.scale.coordinate(point.0), point.1);
                let mut between = points
                    .windows(2)
                    .map(|pair| (place(&pair[0]), place(&pair[1])));
                let (from, to) = between.find(|(from, to)| {
                    // Also at an end that is rounded.
                    let far = HAIR * across.span.width() * (to.0 - from.0).abs();
                    (from.0 - at) * (to.0 - at) <= far && from.0 != to.0
                })?;
                let [low, high] = [from.1, to.1].map(|y| up.scale.coordinate(y));
                // The ends themselves where there is nothing between them, or no coordinate.
                let share = (at - from.0) / (to.0 - from.0);
                let is_level = low == high || !(low.is_finite() && high.is_finite());
                Some(if is_level {
                    from.1
                } else {
                    up.scale.number(low + (high - low) * share)
                })
            };
            match &layer.shape {
                Shape::Curve { points, .. } => {
                    parts.extend(read(points).map(|y| format!("{} {}", layer.name, value(up, y))));
                }
                Shape::Band(points) => {
                    let end = |of: fn(&(f64, f64, f64)) -> f64| {
                        read(
                            &points
                                .iter()
                                .map(|point| (point.0, of(point)))
                                .collect::<Vec<_>>(),
                        )
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
        plot.below
            .iter_mut()
            .for_each(|below| below.layers.insert(0, upright()));
        let style = look.theme.style(Meaning::Cursor);
        self.show(
            parts
                .into_iter()
                .map(|text| vec![Span::styled(text, style)])
                .collect(),
            width,
        );
    }

    /// Shows readings beside the title or, if there is no room for all of them, below the chart.
    pub fn show(&mut self, readings: Vec<Part>, width: u16) {
        let taken = self.title.chars().count() + 8;
        let lines = filled(
            readings.clone(),
            "  ",
            usize::from(width).saturating_sub(taken),
        );
        let is_whole = lines.len() == 1 && lines[0].spans.len() + 1 >= 2 * readings.len();
        if is_whole {
            self.edge = readings;
        } else {
            // A low pane has no rows below its chart.
            self.edge = if width < NARROW {
                readings.clone()
            } else {
                Vec::new()
            };
            self.foot.splice(..0, filled(readings, "  ", width.into()));
        }
    }
}

/// Entries of the legend of a chart.
pub fn entries(chart: &Chart, look: Appearance) -> Vec<Part> {
    in_theme(look, |style| legend(std::slice::from_ref(chart), style))
}

/// Label of the vertical axis of a map, and its shades with their numbers, each at most `width`
/// columns wide.
pub fn shades(chart: &Chart, look: Appearance, width: usize) -> Vec<Part> {
    let title = |text: String| Span::styled(text, look.theme.style(Meaning::Title));
    let scale = chart.map().map(|map| {
        let name = title(format!("{} ", map.key.label_with_unit()));
        let scale = key(map, width.saturating_sub(name.width()), Colours::None);
        std::iter::once(name)
            .chain(scale.into_iter().map(|(text, _)| Span::raw(text)))
            .collect()
    });
    let label = vec![title(format!("↑ {}", chart.y.label_with_unit()))];
    std::iter::once(label).chain(scale).collect()
}

/// Calls `draw` with the styles of charts for this appearance.
pub fn in_theme<R>(look: Appearance, draw: impl FnOnce(&CellStyle<'_>) -> R) -> R {
    let ink = |ink| look.theme.style(meaning(ink));
    draw(&CellStyle {
        ink: &ink,
        colours: Colours::None,
    })
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
    /// Divides the area below the title into head, body and foot: in small windows first the foot
    /// becomes shorter, then the head.
    fn within(panel: &Panel, legend: usize, area: Rect) -> Places {
        let least = match &panel.body {
            Body::Chart(_) => FEWEST_ROWS,
            Body::Text(text) if text.is_empty() => 0,
            Body::Rows { .. } | Body::Text(_) => 1,
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

/// Draws a panel into an area, with a title if there is room; a selected panel is marked.
pub fn draw(panel: &Panel, area: Rect, is_selected: bool, look: Appearance, buffer: &mut Buffer) {
    let quiet = look.theme.style(Meaning::Quiet);
    let (legend, edge) = legend_of(panel, area, look);
    let Places { head, body, foot } = Places::within(panel, legend.len(), inside(area));
    draw_lines(&[&panel.head[..], &legend].concat(), head, buffer);
    draw_lines(&panel.foot, foot, buffer);
    match &panel.body {
        Body::Text(text) => {
            draw_lines(
                &wrapped(&Line::styled(text.clone(), quiet), body.width),
                body,
                buffer,
            );
        }
        Body::Rows { rows, selected } => {
            let first = first_row(*selected, rows.len(), body.height);
            draw_lines(rows.get(first..).unwrap_or_default(), body, buffer);
            let hidden = rows.len().saturating_sub(body.height.into());
            if hidden > 0 && has_title(area) {
                let mut state = ScrollbarState::new(hidden + 1).position(first);
                state = state.viewport_content_length(body.height.into());
                let bar = Scrollbar::new(ScrollbarOrientation::VerticalRight).style(quiet);
                let bar = bar
                    .begin_symbol(None)
                    .end_symbol(None)
                    .track_symbol(Some("│"))
                    .thumb_symbol("█");
                bar.render(
                    Rect {
                        x: area.right() - 1,
                        width: 1,
                        ..body
                    },
                    buffer,
                    &mut state,
                );
            }
        }
        Body::Chart(plot) => drop(in_theme(look, |style| plot.draw(body, style, buffer))),
    }
    if has_title(area) {
        // A blank column is between two panes.
        let width = area.width - u16::from(area.right() < buffer.area.right());
        let line = title_line(&panel.title, edge, width, is_selected, look);
        draw_lines(&[line], area, buffer);
    }
}

/// Entries of the legend that have no room beside their curves: as lines above the chart, or if
/// there is room for all of them on the right of the title, with the texts that are there.
fn legend_of(panel: &Panel, area: Rect, look: Appearance) -> (Vec<Line<'static>>, Vec<Part>) {
    let Body::Chart(plot) = &panel.body else {
        return (Vec::new(), panel.edge.clone());
    };
    let inner = inside(area);
    let (mut kept, mut legend): (Vec<Part>, _) = (Vec::new(), Vec::new());
    // Rows of the legend leave less room for names beside the curves.
    for _ in 0..MOST_ROUNDS {
        let body = Places::within(panel, legend.len(), inner).body;
        let left_out = in_theme(look, |style| {
            plot.draw(body, style, &mut Buffer::empty(body))
        });
        let before = kept.len();
        kept.extend(
            left_out
                .into_iter()
                .filter(|entry| !kept.contains(entry))
                .collect::<Vec<_>>(),
        );
        let all: Vec<Part> = kept.iter().chain(&panel.edge).cloned().collect();
        let width = |part: &Part| part.iter().map(Span::width).sum::<usize>() + 1;
        let taken = panel.title.chars().count() + 8 + all.iter().map(width).sum::<usize>();
        if legend.is_empty() && (taken <= usize::from(area.width) || !has_title(area)) {
            return (Vec::new(), all);
        }
        if kept.len() == before {
            break;
        }
        legend = filled(kept.clone(), "  ", inner.width.into());
    }
    (legend, panel.edge.clone())
}

/// The title of a pane on a line across it, with texts on the right as far as there is room.
fn title_line(
    title: &str,
    edge: Vec<Part>,
    width: u16,
    is_selected: bool,
    look: Appearance,
) -> Line<'static> {
    let quiet = look.theme.style(Meaning::Quiet);
    let (mark, style) = if is_selected {
        ("▸", look.theme.style(Meaning::Title))
    } else {
        ("─", quiet)
    };
    let mut line = fitted(Line::styled(format!("{mark} {title} "), style), width);
    let room = usize::from(width) - line.width();
    let edge = spaced(edge, room.saturating_sub(4));
    let dashes = room
        - if edge.width() > 0 {
            edge.width() + 2
        } else {
            0
        };
    line.push_span(Span::styled("─".repeat(dashes), quiet));
    if edge.width() > 0 {
        line.spans.extend(
            [Span::raw(" ")]
                .into_iter()
                .chain(edge.spans)
                .chain([Span::raw(" ")]),
        );
    }
    line
}

/// Draws lines from the top of an area down, as far as there is room; a line that is too wide ends
/// in `…`.
pub fn draw_lines(lines: &[Line<'static>], area: Rect, buffer: &mut Buffer) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        buffer.set_line(area.x, y, &fitted(line.clone(), area.width), area.width);
    }
}

/// First visible row of a list. It depends only on the selected row, so that a click on a visible
/// row does not scroll the list; the rows above and below the selected one are visible.
fn first_row(selected: usize, rows: usize, height: u16) -> usize {
    let height = usize::from(height.max(1));
    let margin = usize::from(height >= 3);
    let page = height - 2 * margin;
    (selected.saturating_sub(margin) / page * page).min(rows.saturating_sub(height))
}

/// A line of the parts up to the first one that does not fit into a number of columns; two blanks
/// apart if all fit, otherwise one.
fn spaced(mut parts: Vec<Part>, columns: usize) -> Line<'static> {
    let widths: usize = parts.iter().flatten().map(Span::width).sum();
    let between = if widths + 2 * parts.len().saturating_sub(1) <= columns {
        "  "
    } else {
        " "
    };
    let mut taken = 0;
    let fits = parts.iter().take_while(|part| {
        taken += part.iter().map(Span::width).sum::<usize>() + between.len();
        taken - between.len() <= columns
    });
    let count = fits.count();
    parts.truncate(count);
    filled(parts, between, columns)
        .into_iter()
        .next()
        .unwrap_or_default()
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Under {
    /// Numbers on the axes of a chart; for a cell beside the plot the numbers of the nearest cell.
    Data(f64, f64),
    Row(usize),
    Frame,
}

/// Returns what a panel drawn into an area shows in a cell.
pub fn under(panel: &Panel, area: Rect, look: Appearance, cell: Position) -> Under {
    let inner = inside(area);
    let body = Places::within(panel, legend_of(panel, area, look).0.len(), inner).body;
    match &panel.body {
        Body::Chart(plot) if inner.contains(cell) => {
            let data = plot.divided(body).0.data_at(&plot.chart, (cell.x, cell.y));
            data.map_or(Under::Frame, |(x, y)| Under::Data(x, y))
        }
        Body::Rows { rows, selected } if body.contains(cell) => {
            let row = first_row(*selected, rows.len(), body.height) + usize::from(cell.y - body.y);
            if row < rows.len() {
                Under::Row(row)
            } else {
                Under::Frame
            }
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
                theme: Theme::Plain,
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
