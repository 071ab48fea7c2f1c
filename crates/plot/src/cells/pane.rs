//! A chart in a pane of the screen. The name of each curve is written beside the curve. The pane
//! may have one more chart on the right and one more below.

use super::glyph::is_blank;
use super::legend::legend;
use super::plot::{CellPlot, Name};
use crate::chart::{Chart, Shape};
use crate::colour::Ink;
use crate::palette::{Colours, Palette};
use asperity_data::format_rounded;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::Span as Text;
use std::ops::RangeInclusive;

/// Entry of the legend: first a sample of each layer, then the name.
type Entry = Vec<Text<'static>>;

/// Width in columns of the chart on the right, including the dividing line.
const BESIDE: u16 = 14;
/// Smallest width in columns of an area that is divided into two charts side by side.
const WITH_BESIDE: u16 = 44;
/// Largest height in rows that is used to decide which numbers and labels the chart on the right
/// has. The plot of this chart has as many rows as the main plot.
const MOST_BESIDE: u16 = 15;
/// Smallest height in rows of an area that shows a second chart below the main chart.
const WITH_BELOW: u16 = 11;
/// Smallest and largest height in rows of the chart below the main chart.
const BELOW: RangeInclusive<u16> = 3..=7;
/// Smallest height in rows of an area that shows a row of contact signs.
const WITH_CONTACT: u16 = 5;

/// Chart in a pane, which is a part of the screen of the terminal. The names of the curves are
/// written beside the curves.
pub struct PaneChart {
    /// Main chart, which has the largest part of the pane.
    pub chart: Chart,
    /// Further texts to be written beside points of the main chart, in addition to the names of the
    /// curves.
    pub names: Vec<Name>,
    /// Chart on the right of the main chart, with the same vertical axis.
    pub beside: Option<Chart>,
    /// Chart of a few rows below the main chart, with the same horizontal axis. It is not shown in
    /// a pane with fewer than 11 rows.
    pub below: Option<Chart>,
    /// Row of characters directly below the main chart that shows which springs are in contact.
    pub contact: ContactRow,
}

/// Row of characters below a chart that shows which springs are in contact, and their stress. Each
/// character shows the springs above it: `█` if all of them are in contact, `▪` if some are, and
/// `·` if none is. In a terminal with colours the colour shows the mean stress; without colours the
/// characters are `▒` and `▫` for springs that are pulled.
#[derive(Default)]
pub struct ContactRow {
    /// Stress of each spring, from left to right, as a share of the largest stress and positive if
    /// the spring is pressed; `None` for a spring without contact. If the list is empty, the row is
    /// not drawn.
    pub springs: Vec<Option<f64>>,
    /// Part of the horizontal axis that is enclosed in brackets, given by its left and its right
    /// end. An end is a position from 0 (left end of the axis) to 1 (right end). `None` for no
    /// brackets.
    pub marked: Option<(f64, f64)>,
}

/// Divides an area of the screen into a left part for one chart and a right part for a second
/// chart. If the area is too narrow for two charts, the left part is the whole area, and the right
/// part is `None`.
pub fn split(area: Rect) -> (Rect, Option<Rect>) {
    if area.width < WITH_BESIDE {
        return (area, None);
    }
    let left = Rect {
        width: area.width - BESIDE,
        ..area
    };
    let right = Rect {
        x: left.right(),
        width: BESIDE,
        ..area
    };
    (left, Some(right))
}

/// Number of points along a curve beside which the name of the curve may be written.
const NAMED_AT: usize = 19;

/// Returns the points of a curve beside which its name may be written, as fractions of the curve
/// from 0 to 1. The middle of the curve comes first. The others lie alternately on its left and its
/// right, at increasing distances.
fn shares() -> impl Iterator<Item = f64> {
    let step = 0.5 / (NAMED_AT as f64 + 1.0);
    (0..NAMED_AT).map(move |place| {
        let side = if place % 2 == 0 { -1.0 } else { 1.0 };
        0.5 + side * step * place as f64
    })
}

/// Name of a curve, with the points beside which the name may be written, and the legend entry of
/// the curve.
struct NamedEntry {
    name: Name,
    entry: Entry,
}

/// Returns the legend entries of a chart, each with the name that is written beside the curve.
/// Entries without a layer are left out.
fn names_of_layers(chart: &Chart, palette: Palette) -> Vec<NamedEntry> {
    let mut named = Vec::new();
    for entry in legend(std::slice::from_ref(chart), palette) {
        let Some(last) = entry.last() else {
            continue;
        };
        let text = last.content.trim().to_owned();
        let mut ink = None;
        let mut points = Vec::new();
        for layer in &chart.layers {
            if layer.name.to_string() == text {
                ink = ink.or(Some(layer.ink));
                points.extend(layer.shape.points());
            }
        }
        let Some(ink) = ink else {
            continue;
        };
        let mut at = Vec::new();
        if let Some(last) = points.len().checked_sub(1) {
            at = shares()
                .map(|share| points[(share * last as f64) as usize])
                .collect();
        }
        let name = Name {
            at,
            texts: vec![text],
            ink,
        };
        named.push(NamedEntry { name, entry });
    }
    named
}

impl PaneChart {
    /// Creates a pane that contains only this chart.
    pub fn new(chart: Chart) -> PaneChart {
        PaneChart {
            chart,
            names: Vec::new(),
            beside: None,
            below: None,
            contact: ContactRow::default(),
        }
    }

    /// Divides an area of the screen among the charts of the pane. Returns the layout of the main
    /// chart [`Self::chart`], and the area of the chart [`Self::beside`] on the right. The area is
    /// `None` if there is no chart on the right, or not enough room for it.
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

    /// Divides an area between a plot and the numbers along its axes. If the pane shows signs for
    /// the contact, one row below the plot is left free for these signs.
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

    /// Returns the height in rows of the chart below the main chart; 0 if this chart is not shown.
    fn rows_below(&self, area: Rect) -> u16 {
        if self.below.is_none() || area.height < WITH_BELOW {
            return 0;
        }
        (area.height / 4).clamp(*BELOW.start(), *BELOW.end())
    }

    /// Draws the chart [`Self::below`] under the plot of the main chart. The two ends of its
    /// vertical axis have numbers on the left. The name of this axis is written on a blank row of
    /// the plot, if there is one.
    fn draw_below(&self, plot: Rect, area: Rect, palette: Palette, buffer: &mut Buffer) {
        let height = self.rows_below(area);
        let Some(below) = &self.below else {
            return;
        };
        if height == 0 {
            return;
        }
        let quiet = palette.ink(Ink::Quiet);
        let place = Rect {
            y: area.bottom() - height,
            height,
            ..plot
        };
        draw_ends_beside(below, area, place, quiet, buffer);
        let mut cells = CellPlot::within(Rect { height: 1, ..place }, below);
        cells.plot = place;
        cells.draw(buffer, below, palette);
        let name = &below.y.name;
        let width = name.chars().count() as u16 + 1;
        let x = place.right().saturating_sub(width).max(place.x);
        for y in place.y..place.bottom() {
            if (x..place.right()).all(|x| is_blank(&buffer[(x, y)])) {
                buffer.set_stringn(x, y, name, usize::from(place.width), quiet);
                break;
            }
        }
    }

    /// Draws all charts and texts into `area`. Returns the legend entries of the curves whose names
    /// did not fit beside the curves.
    pub fn draw(&self, area: Rect, palette: Palette, buffer: &mut Buffer) -> Vec<Entry> {
        let (place, right) = self.divided(area);
        let plot = place.plot;
        place.draw(buffer, &self.chart, palette);
        for name in &self.names {
            place.draw_name(buffer, &self.chart, palette, name);
        }
        let is_map = self.chart.map().is_some();
        let names = if is_map {
            Vec::new()
        } else {
            names_of_layers(&self.chart, palette)
        };
        let mut left_out = Vec::new();
        for NamedEntry { name, entry } in names {
            if !place.draw_name(buffer, &self.chart, palette, &name) {
                left_out.push(entry);
            }
        }
        place.draw_grounds(buffer, &self.chart, palette);
        self.draw_below(plot, area, palette, buffer);
        if let Some(chart) = &self.beside
            && let Some(right) = right
        {
            self.draw_beside(chart, plot, right, palette, buffer);
        }
        if is_map {
            self.point_at_mark(&place, area, palette, buffer);
        }
        if self.has_signs(area) {
            self.contact.draw(plot, palette, buffer);
        }
        left_out
    }

    /// Draws the chart [`Self::beside`] in the same rows as the main plot.
    fn draw_beside(
        &self,
        chart: &Chart,
        plot: Rect,
        right: Rect,
        palette: Palette,
        buffer: &mut Buffer,
    ) {
        for y in plot.y..plot.bottom() {
            buffer.set_string(right.x, y, "│", palette.ink(Ink::Quiet));
        }
        let area = Rect {
            x: right.x + 1,
            width: right.width - 1,
            // With at most this height, the label of the horizontal axis gets no row of its own.
            height: right.height.min(MOST_BESIDE),
            ..right
        };
        let mut beside = self.scaled(area, chart);
        beside.plot.y = plot.y;
        beside.plot.height = plot.height;
        beside.draw(buffer, chart, palette);
    }

    /// Marks the position of the present scene on a map by pointers on both axes. On a map without
    /// colours, a blank on each side of the position makes it visible. On a map with colours the
    /// mark contrasts with its cell, and the cells beside it keep their colours.
    fn point_at_mark(&self, place: &CellPlot, area: Rect, palette: Palette, buffer: &mut Buffer) {
        let mut layers = self.chart.layers.iter().rev();
        let Some(mark) = layers.find(|layer| layer.ink == Ink::Cursor) else {
            return;
        };
        let Shape::Curve { points, .. } = &mark.shape else {
            return;
        };
        let Some(point) = points.first() else {
            return;
        };
        let Some((x, y)) = place.cell(&self.chart, *point) else {
            return;
        };
        let plot = place.plot;
        let style = palette.ink(Ink::Cursor);
        if palette.has_shades() {
            let ground = buffer[(x, y)].bg;
            buffer[(x, y)].set_fg(palette.ink_on_shade(ground));
        } else {
            for beside in [x.wrapping_sub(1), x + 1] {
                if (plot.x..plot.right()).contains(&beside) {
                    buffer[(beside, y)].set_symbol(" ");
                }
            }
        }
        if let Some(cell) = buffer.cell_mut((x, plot.bottom()))
            && ["─", "┬"].contains(&cell.symbol())
        {
            cell.set_symbol("▲").set_style(style);
        }
        if let Some(cell) = buffer.cell_mut((plot.x.wrapping_sub(1), y))
            && ["│", "┤"].contains(&cell.symbol())
        {
            cell.set_symbol("▶").set_style(style);
            // The value at the mark is written over any number of the vertical axis in this row.
            let number = format_rounded(point.1, 2, &self.chart.y.unit);
            let columns = usize::from(plot.x.saturating_sub(area.x + 2));
            if number.chars().count() <= columns {
                buffer.set_string(area.x, y, format!("{number:>columns$}"), style);
            }
        }
    }
}

/// Draws the vertical axis of the chart `below` in the columns on the left of `place`, with the
/// numbers at its two ends.
fn draw_ends_beside(below: &Chart, area: Rect, place: Rect, quiet: Style, buffer: &mut Buffer) {
    let columns = usize::from(place.x - area.x).saturating_sub(1);
    if columns == 0 {
        return;
    }
    for row in place.y..place.bottom() {
        let end = if row == place.y {
            Some(below.y.span.high)
        } else if row + 1 == place.bottom() {
            Some(below.y.span.low)
        } else {
            None
        };
        let number = end.map_or_else(String::new, |end| format_rounded(end, 2, &below.y.unit));
        // If the number takes all columns, the blank after the number is left out.
        let number = match columns.checked_sub(number.len()) {
            None => String::new(),
            Some(0) => number,
            Some(_) => format!("{number} "),
        };
        let mark = if end.is_some() { '┤' } else { '│' };
        let text = format!("{number:>columns$}{mark}");
        buffer.set_string(area.x, row, text, quiet);
    }
}

impl ContactRow {
    /// Draws the contact signs into the row below a plot, and the brackets around the marked part.
    fn draw(&self, plot: Rect, palette: Palette, buffer: &mut Buffer) {
        let y = plot.bottom();
        for (x, cell) in (plot.x..).zip(0..plot.width) {
            let sign = self.sign(usize::from(cell), usize::from(plot.width), palette);
            buffer[(x, y)].set_char(sign.character).set_fg(sign.colour);
        }
        let Some((from, to)) = self.marked else {
            return;
        };
        let last = plot.width.saturating_sub(1);
        let column = |share: f64| (share.clamp(0.0, 1.0) * f64::from(last)) as u16;
        let opening = column(from);
        let closing = column(to).max(opening + 1);
        for (bracket, column) in [("[", opening), ("]", closing)] {
            let x = plot.x + column.min(last);
            buffer.set_string(x, y, bracket, palette.ink(Ink::Text));
        }
    }

    /// Returns the sign of a cell in a row of `cells` cells.
    fn sign(&self, cell: usize, cells: usize, palette: Palette) -> ContactSign {
        let springs = &self.springs;
        let from = cell * springs.len() / cells;
        let to = ((cell + 1) * springs.len() / cells).max(from + 1);
        let part = &springs[from..to];
        let stresses: Vec<f64> = part.iter().copied().flatten().collect();
        if stresses.is_empty() {
            return ContactSign {
                character: '·',
                colour: palette.ink(Ink::Quiet).fg.unwrap_or_default(),
            };
        }
        let mean = stresses.iter().sum::<f64>() / stresses.len() as f64;
        let signs = contact_signs(palette, mean);
        ContactSign {
            character: if stresses.len() < part.len() {
                signs.some
            } else {
                signs.all
            },
            colour: palette.stress(mean),
        }
    }
}

struct ContactSign {
    character: char,
    colour: Color,
}

/// Characters of [`ContactRow`] for cells in which all or some of the springs are in contact.
pub struct ContactSigns {
    pub all: char,
    pub some: char,
}

/// Returns the characters for springs with this stress, which is negative for pulled springs.
pub fn contact_signs(palette: Palette, stress: f64) -> ContactSigns {
    if palette.colours == Colours::Plain && stress < 0.0 {
        ContactSigns {
            all: '▒',
            some: '▫',
        }
    } else {
        ContactSigns {
            all: '█',
            some: '▪',
        }
    }
}
