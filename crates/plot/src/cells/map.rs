//! Heat maps in terminal cells. Colours or characters show the values, letters the classes, and
//! a line of bars or of half cells the contour.

use crate::axis::ChartAxis;
use crate::chart::{Chart, Class, HeatMap};
use crate::colour::{Rgb, Shades, ink_on};
use crate::palette::Palette;
use asperity_data::format_rounded;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use std::ops::Range;

/// Characters that show the values of a heat map in a terminal without colours, from the lowest to
/// the highest value.
pub const SHADES: [&str; 5] = ["·", "░", "▒", "▓", "█"];
/// Smallest width, in columns of the screen, of a map cell that shows the letter of its class.
const WITH_LETTER: usize = 3;

/// Returns, for each screen cell along an axis, the index of the value that this screen cell shows.
/// The list begins at the lower end of the axis.
pub(super) fn values_behind(axis: &ChartAxis, values: &[f64], cells: u16) -> Vec<usize> {
    let borders = HeatMap::borders(axis.scale, values);
    let mut indices = Vec::with_capacity(usize::from(cells));
    for cell in 0..cells {
        let share = (f64::from(cell) + 0.5) / f64::from(cells);
        let coordinate = axis.span.low + share * axis.span.width();
        let borders_below = borders.partition_point(|border| *border <= coordinate);
        indices.push(borders_below.clamp(1, values.len().max(1)) - 1);
    }
    indices
}

/// Returns the range of neighbouring screen cells that show the same value as the cell with the
/// index `cell`.
fn run(values: &[usize], cell: usize) -> Range<usize> {
    let own = values[cell];
    let start = values.partition_point(|value| *value < own);
    let end = values.partition_point(|value| *value <= own);
    start..end
}

pub(super) fn draw(
    buffer: &mut Buffer,
    area: Rect,
    chart: &Chart,
    map: &HeatMap,
    palette: Palette,
) {
    if palette.has_shades() {
        let shades = ShadedMap::new(area, chart, map, palette);
        shades.draw(buffer, area);
    } else {
        draw_characters(buffer, area, chart, map, palette);
    }
}

/// Draws a map with characters that show the values.
fn draw_characters(
    buffer: &mut Buffer,
    area: Rect,
    chart: &Chart,
    map: &HeatMap,
    palette: Palette,
) {
    let columns = values_behind(&chart.x, &map.columns, area.width);
    let rows = values_behind(&chart.y, &map.rows, area.height);
    let index = |column: usize, row: usize| rows[row] * map.columns.len() + columns[column];
    for (y, up) in (area.y..area.bottom()).zip((0..rows.len()).rev()) {
        for (x, across) in (area.x..).zip(0..columns.len()) {
            let here = index(across, up);
            let value = map.values.get(here).copied().flatten();
            let class = class_of(map, here);
            let wide = run(&columns, across);
            let is_wide = wide.len() >= WITH_LETTER;
            let is_end = !is_wide || across == wide.start || across + 1 == wide.end;
            let cell = &mut buffer[(x, y)];
            let character = match value {
                Some(value) => SHADES[step(map.key.share(value))],
                None => " ",
            };
            cell.set_symbol(character);
            if value.is_some()
                && let Some(class) = class
            {
                cell.set_style(palette.ink(class.ink));
            }
            if across + 1 < columns.len() && crosses(map, here, index(across + 1, up)) {
                cell.set_symbol("▕");
            } else if up > 0 && is_end && crosses(map, here, index(across, up - 1)) {
                cell.set_symbol("▁");
            } else if is_wide
                && is_middle(&columns, across)
                && is_middle(&rows, up)
                && let Some(letter) = letter(map, here)
            {
                cell.set_char(letter);
            }
        }
    }
}

fn class_of(map: &HeatMap, index: usize) -> Option<&Class> {
    map.class_names
        .get(map.classes.get(index).copied().flatten()?)
}

/// Returns the letter of the class of a map cell; `None` if the cell has no value or no class with
/// a letter.
fn letter(map: &HeatMap, index: usize) -> Option<char> {
    map.values.get(index).copied().flatten()?;
    class_of(map, index)?.letter
}

/// Returns true for the screen cell in the middle of those that show the same value.
fn is_middle(values: &[usize], cell: usize) -> bool {
    let same = run(values, cell);
    cell == same.start + same.len() / 2
}

/// Map in a terminal with many colours. Each cell of the screen has two values, one above the
/// other: the upper half block `▀` has the colour of the upper value, and its ground the colour of
/// the lower value.
struct ShadedMap<'a> {
    map: &'a HeatMap,
    palette: Palette,
    /// For each column of the screen, the index of its value.
    columns: Vec<usize>,
    /// For each half of a row of the screen, from below, the index of its value.
    rows: Vec<usize>,
    /// Colour of each band of values.
    bands: Vec<Color>,
}

impl<'a> ShadedMap<'a> {
    fn new(area: Rect, chart: &Chart, map: &'a HeatMap, palette: Palette) -> Self {
        let bands = (0..Shades::BANDS).map(|band| palette.shade(map.shades.of_band(band)));
        ShadedMap {
            map,
            palette,
            columns: values_behind(&chart.x, &map.columns, area.width),
            rows: values_behind(&chart.y, &map.rows, area.height * 2),
            bands: bands.collect(),
        }
    }

    fn draw(&self, buffer: &mut Buffer, area: Rect) {
        let heights = (0..usize::from(area.height)).rev();
        for (y, up) in (area.y..area.bottom()).zip(heights) {
            for (x, across) in (area.x..).zip(0..self.columns.len()) {
                let upper = self.colour(across, 2 * up + 1);
                let lower = self.colour(across, 2 * up);
                let cell = &mut buffer[(x, y)];
                match (upper, lower) {
                    (None, None) => drop(cell.set_symbol(" ")),
                    (Some(upper), Some(lower)) if upper == lower => {
                        cell.set_symbol(" ").set_bg(lower);
                    }
                    (Some(upper), Some(lower)) => {
                        cell.set_symbol("▀").set_fg(upper).set_bg(lower);
                    }
                    (Some(upper), None) => drop(cell.set_symbol("▀").set_fg(upper)),
                    (None, Some(lower)) => drop(cell.set_symbol("▄").set_fg(lower)),
                }
                let here = self.index(across, 2 * up);
                if run(&self.columns, across).len() >= WITH_LETTER
                    && is_middle(&self.columns, across)
                    && self.is_middle_row(up)
                    && let Some(letter) = letter(self.map, here)
                    && let Some(ground) = self.shade(here)
                {
                    cell.set_char(letter)
                        .set_fg(self.palette.shade(ink_on(ground)))
                        .set_bg(self.palette.shade(ground));
                }
            }
        }
    }

    /// Returns true for the row of the screen with the middle of those halves that show the same
    /// value.
    fn is_middle_row(&self, up: usize) -> bool {
        let same = run(&self.rows, 2 * up);
        up == (same.start + same.len() / 2) / 2
    }

    fn index(&self, column: usize, row: usize) -> usize {
        self.rows[row] * self.map.columns.len() + self.columns[column]
    }

    /// Returns the shade of a map cell; `None` if the cell has no value.
    fn shade(&self, index: usize) -> Option<Rgb> {
        let value = self.map.values.get(index).copied().flatten()?;
        Some(self.map.shades.of_band(self.map.shade(value)))
    }

    /// Returns the colour of half a cell of the screen. The contour is a line of white halves. On a
    /// scale whose middle is white, the halves are black.
    fn colour(&self, column: usize, row: usize) -> Option<Color> {
        let here = self.index(column, row);
        let value = self.map.values.get(here).copied().flatten()?;
        let is_beside_contour =
            column + 1 < self.columns.len() && crosses(self.map, here, self.index(column + 1, row));
        let is_above_contour = row > 0 && crosses(self.map, here, self.index(column, row - 1));
        if is_beside_contour || is_above_contour {
            return Some(self.palette.shade(match self.map.shades {
                Shades::Sequential => [255; 3],
                Shades::Diverging => [0; 3],
            }));
        }
        self.bands.get(self.map.shade(value)).copied()
    }
}

fn step(share: f64) -> usize {
    // If `share` is NaN, the conversion to an integer gives 0, which is the lowest step.
    ((share * SHADES.len() as f64) as usize).min(SHADES.len() - 1)
}

/// Returns true if the contour passes between the two cells with these indices.
fn crosses(map: &HeatMap, first: usize, second: usize) -> bool {
    let Some(contour) = &map.contour else {
        return false;
    };
    let value = |cell: usize| contour.field.get(cell).copied().flatten();
    let (Some(first), Some(second)) = (value(first), value(second)) else {
        return false;
    };
    (first < contour.level) != (second < contour.level)
}

/// Returns a character with its style, as it shows a value of a heat map in a terminal. The range
/// of the values is divided into five steps, and the value is the middle of step number `step`.
/// Step 0 has the lowest values.
fn shade_sample(map: &HeatMap, step: usize, palette: Palette) -> (&'static str, Style) {
    if palette.has_shades() {
        let colour = map.shades.at((step as f64 + 0.5) / SHADES.len() as f64);
        (" ", Style::new().bg(palette.shade(colour)))
    } else {
        (SHADES[step.min(SHADES.len() - 1)], Style::new())
    }
}

/// Returns the character with its style that shows a value in the cells of a heat map in a
/// terminal.
pub fn shade_of(map: &HeatMap, value: f64, palette: Palette) -> (&'static str, Style) {
    if palette.has_shades() {
        let colour = map.shades.of_band(map.shade(value));
        (" ", Style::new().bg(palette.shade(colour)))
    } else {
        (SHADES[step(map.key.share(value))], Style::new())
    }
}

/// Returns the colour scale of a heat map as a list of styled texts, which are to be written one
/// after the other. The scale has six numbers, with a coloured piece between each two. In a
/// terminal without colours, the pieces consist of the characters [`SHADES`]. If the scale has no
/// room in `columns` columns, it has only the first and the last number.
pub fn key(map: &HeatMap, columns: usize, palette: Palette) -> Vec<(String, Style)> {
    let (divisor, _) = map.key.prefix();
    let steps = SHADES.len();
    let number = |step: usize| {
        let share = step as f64 / steps as f64;
        let value = map
            .key
            .scale
            .number(map.key.span.low + share * map.key.span.width());
        format_rounded(value / divisor, 3, "")
    };
    let width_of_numbers: usize = (0..=steps).map(|step| number(step).chars().count()).sum();
    let has_all_numbers = width_of_numbers + 5 * steps <= columns;
    let mut parts = vec![(number(0), Style::new())];
    for step in 0..steps {
        if has_all_numbers || step == 0 {
            parts.push((" ".to_owned(), Style::new()));
        }
        let (sample, style) = shade_sample(map, step, palette);
        parts.push((sample.repeat(3), style));
        if has_all_numbers || step + 1 == steps {
            parts.push((format!(" {}", number(step + 1)), Style::new()));
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::plot::CellPlot;
    use crate::chart::{Contour, Layer, Shape};
    use crate::colour::Ink;
    use crate::scale::Span;
    use asperity_data::AxisScale;

    /// A map of two columns and two rows, with the values 0 and 1 on one diagonal and 0.5 on the
    /// other.
    fn map() -> HeatMap {
        HeatMap {
            columns: vec![0.0, 1.0],
            rows: vec![0.0, 1.0],
            values: vec![Some(0.0), Some(0.5), Some(0.5), Some(1.0)],
            key: axis(0.0, 1.0),
            shades: Shades::Sequential,
            classes: Vec::new(),
            class_names: Vec::new(),
            contour: None,
        }
    }

    fn axis(low: f64, high: f64) -> ChartAxis {
        ChartAxis::new(AxisScale::Linear, Span { low, high }, "", "x", "1")
    }

    /// Draws a map into two columns and one row.
    fn drawn(map: HeatMap, palette: Palette) -> Buffer {
        let layers = vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))];
        let chart = Chart::new(axis(-0.5, 1.5), axis(-0.5, 1.5), layers);
        let area = Rect::new(0, 0, 2, 1);
        let mut buffer = Buffer::empty(area);
        CellPlot::within(area, &chart).draw(&mut buffer, &chart, palette);
        buffer
    }

    fn band(share: f64) -> Color {
        let map = map();
        Palette::DARK.shade(map.shades.of_band(map.shade(share)))
    }

    #[test]
    fn a_cell_shows_two_values_one_above_the_other() {
        let buffer = drawn(map(), Palette::DARK);
        let colours = |column: u16| {
            let cell = &buffer[(column, 0)];
            (cell.symbol().to_owned(), cell.fg, cell.bg)
        };
        assert_eq!(colours(0), ("▀".to_owned(), band(0.5), band(0.0)));
        assert_eq!(colours(1), ("▀".to_owned(), band(1.0), band(0.5)));
        // The legend of a value has its colour.
        for value in [0.0, 0.5, 1.0] {
            let (_, style) = shade_of(&map(), value, Palette::DARK);
            assert_eq!(style.bg, Some(band(value)));
        }
        // Without colours a cell has one character for one value.
        let buffer = drawn(map(), Palette::PLAIN);
        assert_eq!(buffer[(0, 0)].bg, Color::Reset);
        assert!(SHADES.contains(&buffer[(0, 0)].symbol()));
    }

    #[test]
    fn the_contour_is_a_line_of_white_halves() {
        let contour = Contour {
            field: vec![Some(0.0), Some(0.0), Some(1.0), Some(1.0)],
            level: 0.5,
            name: "boundary".into(),
        };
        let with_contour = HeatMap {
            contour: Some(contour),
            ..map()
        };
        let buffer = drawn(with_contour, Palette::DARK);
        let white = Color::Rgb(255, 255, 255);
        let lower = [band(0.0), band(0.5)];
        for (column, lower) in (0..).zip(lower) {
            let cell = &buffer[(column, 0)];
            assert_eq!((cell.fg, cell.bg), (white, lower));
        }
    }
}
