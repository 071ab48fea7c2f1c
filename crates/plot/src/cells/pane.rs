//! A chart in a pane of the screen. The names of the curves are beside the curves, and further
//! charts can be at the sides.

use super::legend::legend;
use super::plot::{CellPlot, Name};
use super::style::CellStyle;
use crate::chart::{Chart, Shape};
use crate::colour::Ink;
use asperity_data::format_rounded;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::text::Span as Text;
use std::ops::RangeInclusive;

/// Entry of the legend: samples and a name.
type Entry = Vec<Text<'static>>;

/// Width in columns of a chart beside another chart, including the line between them, and the
/// smallest width of both.
const BESIDE: u16 = 14;
const WITH_BESIDE: u16 = 54;
/// Largest number of rows for which the scales beside a chart are laid out. The plot has the rows
/// of the chart.
const MOST_BESIDE: u16 = 15;
/// Smallest number of rows of an area with a chart below its chart, and the numbers of rows of the
/// chart below.
const WITH_BELOW: u16 = 11;
const BELOW: RangeInclusive<u16> = 3..=7;
/// Smallest number of rows of a chart with a row of contact signs.
const WITH_CONTACT: u16 = 5;

/// Chart in a pane, which is a part of the screen of the terminal. The names of the curves are
/// written beside the curves.
pub struct PaneChart {
    /// Main chart, which has the largest part of the pane.
    pub chart: Chart,
    /// Texts to write beside points of the main chart, in addition to the names of the curves.
    pub names: Vec<Name>,
    /// Chart on the right of the main chart, with the same vertical axis.
    pub beside: Option<Chart>,
    /// Chart of a few rows below the main chart, with the same horizontal axis. A pane with fewer
    /// than 11 rows does not show it.
    pub below: Option<Chart>,
    /// Row of characters directly below the main chart that shows which springs are in contact.
    pub contact: ContactRow,
}

/// Row of characters below a chart that shows where springs along the horizontal axis are in
/// contact. `■` means that all springs at this place are in contact, `▪` that some are, and `·`
/// that none is.
#[derive(Default)]
pub struct ContactRow {
    /// For each spring, from left to right, true if the spring is in contact. Empty for no row.
    pub springs: Vec<bool>,
    /// Part of the horizontal axis between two brackets, given by its ends from 0 (left) to 1
    /// (right); `None` for no brackets.
    pub marked: Option<(f64, f64)>,
}

/// Divides an area of the screen into a left part for a chart and a right part for a second chart.
/// The right part is `None` if the area is too narrow for two charts.
pub fn split(area: Rect) -> (Rect, Option<Rect>) {
    if area.width < WITH_BESIDE {
        return (area, None);
    }
    let width = area.width - BESIDE;
    (
        Rect { width, ..area },
        Some(Rect {
            x: area.x + width,
            width: BESIDE,
            ..area
        }),
    )
}

/// Number of places along a curve at which its name may stand.
const NAMED_AT: usize = 19;

/// Shares of a curve at which its name may stand, from the middle to both ends.
fn shares() -> impl Iterator<Item = f64> {
    let step = 0.5 / (NAMED_AT as f64 + 1.0);
    (0..NAMED_AT)
        .map(move |place| 0.5 + if place % 2 == 0 { -1.0 } else { 1.0 } * step * place as f64)
}

/// Returns the name of each entry of the legend with the points where it may be written, and the
/// entry.
fn names_of_layers(chart: &Chart, style: &CellStyle<'_>) -> Vec<(Name, Entry)> {
    let named = legend(std::slice::from_ref(chart), style)
        .into_iter()
        .filter_map(|entry| {
            let text = entry.last()?.content.trim().to_owned();
            let layers = chart
                .layers
                .iter()
                .filter(|layer| layer.name.to_string() == text);
            let ink = layers.clone().next()?.ink;
            let points: Vec<_> = layers.flat_map(|layer| layer.shape.points()).collect();
            let last = points.len().checked_sub(1);
            let at = shares().filter_map(|share| Some(points[(share * last? as f64) as usize]));
            Some((
                Name {
                    at: at.collect(),
                    texts: vec![text],
                    ink,
                },
                entry,
            ))
        });
    named.collect()
}

impl PaneChart {
    /// Creates a pane with this chart alone, without further charts and texts.
    pub fn new(chart: Chart) -> PaneChart {
        PaneChart {
            chart,
            names: Vec::new(),
            beside: None,
            below: None,
            contact: ContactRow::default(),
        }
    }

    /// Divides an area of the screen among the charts of the pane. Returns the place of the main
    /// chart [`Self::chart`], and the area of the chart [`Self::beside`] on its right; `None` if
    /// this chart is missing or has no room.
    pub fn divided(&self, area: Rect) -> (CellPlot, Option<Rect>) {
        let (left, right) = if self.beside.is_some() {
            split(area)
        } else {
            (area, None)
        };
        let left = Rect {
            height: left.height - self.rows_below(area),
            ..left
        };
        (self.scaled(left, &self.chart), right)
    }

    /// Divides an area between a plot and its scales, with a row for the signs of contact if there
    /// are any.
    fn scaled(&self, area: Rect, chart: &Chart) -> CellPlot {
        if self.has_signs(area) {
            CellPlot::above(area, chart, 1)
        } else {
            CellPlot::within(area, chart)
        }
    }

    fn has_signs(&self, area: Rect) -> bool {
        !self.contact.springs.is_empty() && area.height >= WITH_CONTACT
    }

    /// Returns the number of rows of the chart below.
    fn rows_below(&self, area: Rect) -> u16 {
        let has_room = self.below.is_some() && area.height >= WITH_BELOW;
        if has_room {
            (area.height / 4).clamp(*BELOW.start(), *BELOW.end())
        } else {
            0
        }
    }

    /// Draws the chart below under the columns of the plot. The ends of its vertical axis are on
    /// the left, and its name is shown if there is room.
    fn draw_below(&self, plot: Rect, area: Rect, style: &CellStyle<'_>, buffer: &mut Buffer) {
        let height = self.rows_below(area);
        let Some(below) = self.below.as_ref().filter(|_| height > 0) else {
            return;
        };
        let place = Rect {
            y: area.bottom() - height,
            height,
            ..plot
        };
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
        let name = &below.y.name;
        let x = place
            .right()
            .saturating_sub(name.chars().count() as u16 + 1)
            .max(place.x);
        let is_blank = |x, y| matches!(buffer[(x, y)].symbol(), " " | "\u{2800}");
        let row = (place.y..place.bottom()).find(|y| (x..place.right()).all(|x| is_blank(x, *y)));
        if let Some(row) = row {
            buffer.set_stringn(
                x,
                row,
                name,
                usize::from(place.width),
                (style.ink)(Ink::Quiet),
            );
        }
    }

    /// Draws all charts and texts into `area`. Returns the legend entries of curves whose names
    /// found no room in the chart.
    pub fn draw(&self, area: Rect, style: &CellStyle<'_>, buffer: &mut Buffer) -> Vec<Entry> {
        let (place, right) = self.divided(area);
        let plot = place.plot;
        place.draw(buffer, &self.chart, style);
        for name in &self.names {
            place.draw_name(buffer, &self.chart, style, name);
        }
        let is_map = self.chart.map().is_some();
        let names = if is_map {
            Vec::new()
        } else {
            names_of_layers(&self.chart, style)
        };
        let mut left_out = Vec::new();
        for (name, entry) in names {
            if !place.draw_name(buffer, &self.chart, style, &name) {
                left_out.push(entry);
            }
        }
        self.draw_below(plot, area, style, buffer);
        if let Some((chart, right)) = self.beside.as_ref().zip(right) {
            (plot.y..plot.bottom()).for_each(|y| {
                buffer.set_string(right.x, y, "│", (style.ink)(Ink::Quiet));
            });
            let right = Rect {
                x: right.x + 1,
                width: right.width - 1,
                ..right
            };
            // The label below has no row of its own.
            let height = right.height.min(MOST_BESIDE);
            let mut beside = self.scaled(Rect { height, ..right }, chart);
            (beside.plot.y, beside.plot.height) = (plot.y, plot.height);
            beside.draw(buffer, chart, style);
        }
        if is_map {
            self.point_at_mark(&place, area, style, buffer);
        }
        if self.has_signs(area) {
            let signs = self.contact.signs(usize::from(plot.width));
            buffer.set_string(plot.x, plot.bottom(), signs, (style.ink)(Ink::Contact));
            if let Some((from, to)) = self.contact.marked {
                let last = plot.width.saturating_sub(1);
                let cell = |share: f64| (share.clamp(0.0, 1.0) * f64::from(last)) as u16;
                for (sign, column) in [("[", cell(from)), ("]", cell(to).max(cell(from) + 1))] {
                    let column = plot.x + column.min(last);
                    buffer.set_string(column, plot.bottom(), sign, (style.ink)(Ink::Text));
                }
            }
        }
        left_out
    }

    /// Draws pointers on the axes of a map at the mark of the scene, and blanks on both sides of
    /// the mark. The mark is then visible without colours.
    fn point_at_mark(
        &self,
        place: &CellPlot,
        area: Rect,
        style: &CellStyle<'_>,
        buffer: &mut Buffer,
    ) {
        let marked = self
            .chart
            .layers
            .iter()
            .rev()
            .find(|layer| layer.ink == Ink::Cursor);
        let Some(Shape::Curve { points, .. }) = marked.map(|layer| &layer.shape) else {
            return;
        };
        let cell = points.first().and_then(|at| place.cell(&self.chart, *at));
        let Some((x, y)) = cell else { return };
        let (plot, style) = (place.plot, (style.ink)(Ink::Cursor));
        for beside in [x.wrapping_sub(1), x + 1]
            .into_iter()
            .filter(|x| (plot.x..plot.right()).contains(x))
        {
            buffer[(beside, y)].set_symbol(" ");
        }
        let is_line = |cell: &Cell| ["─", "┬"].contains(&cell.symbol());
        if let Some(cell) = buffer
            .cell_mut((x, plot.bottom()))
            .filter(|cell| is_line(cell))
        {
            cell.set_symbol("▲").set_style(style);
        }
        let is_line = |cell: &Cell| ["│", "┤"].contains(&cell.symbol());
        if let Some(cell) = buffer
            .cell_mut((plot.x.wrapping_sub(1), y))
            .filter(|cell| is_line(cell))
        {
            cell.set_symbol("▶").set_style(style);
            // The number of the mark itself, in place of one that the row has too.
            let number = points.first().map_or_else(String::new, |at| {
                format_rounded(at.1, 2, &self.chart.y.unit)
            });
            let columns = usize::from(plot.x.saturating_sub(area.x + 2));
            if number.chars().count() <= columns {
                buffer.set_string(area.x, y, format!("{number:>columns$}"), style);
            }
        }
    }
}

impl ContactRow {
    /// Returns a sign for each cell of a row: `■` if all springs are in contact, `▪` if some are,
    /// `·` if none is.
    fn signs(&self, cells: usize) -> String {
        let springs = &self.springs;
        let sign = |cell: usize| {
            let from = cell * springs.len() / cells;
            let part = &springs[from..((cell + 1) * springs.len() / cells).max(from + 1)];
            match part.iter().filter(|touches| **touches).count() {
                0 => '·',
                touching if touching < part.len() => '▪',
                _ => '■',
            }
        };
        (0..cells).map(sign).collect()
    }
}
