//! Heat maps in terminal cells. Colours or characters show the values, letters show the classes of
//! map cells, and bars show the contour.

use super::style::{CellStyle, Colours};
use crate::axis::ChartAxis;
use crate::chart::{Chart, Class, HeatMap};
use crate::colour::ink_on;
use asperity_data::format_rounded;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
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
    style: &CellStyle<'_>,
) {
    let columns = values_behind(&chart.x, &map.columns, area.width);
    let rows = values_behind(&chart.y, &map.rows, area.height);
    let index = |column: usize, row: usize| rows[row] * map.columns.len() + columns[column];
    for (y, up) in (area.y..area.bottom()).zip((0..rows.len()).rev()) {
        for (x, across) in (area.x..).zip(0..columns.len()) {
            let here = index(across, up);
            let value = map.values.get(here).copied().flatten();
            let class = map.classes.get(here).copied().flatten();
            let class = class.and_then(|class| map.class_names.get(class));
            let wide = run(&columns, across);
            let high = run(&rows, up);
            let is_wide = wide.len() >= WITH_LETTER;
            let is_end = !is_wide || across == wide.start || across + 1 == wide.end;
            let is_middle =
                across == wide.start + wide.len() / 2 && up == high.start + high.len() / 2;
            let letter = class.and_then(|class| class.letter);
            let cell = &mut buffer[(x, y)];
            cell.set_symbol(shade(map, value, style))
                .set_style(looks(map, value, class, style));
            if across + 1 < columns.len() && crosses(map, here, index(across + 1, up)) {
                cell.set_symbol("▕");
            } else if up > 0 && is_end && crosses(map, here, index(across, up - 1)) {
                cell.set_symbol("▁");
            } else if let Some(letter) = letter
                && value.is_some()
                && is_wide
                && is_middle
            {
                cell.set_char(letter);
            }
        }
    }
}

/// Returns the character that shows a value. In a terminal with colours, the background shows the
/// value, so that the character is a blank.
fn shade(map: &HeatMap, value: Option<f64>, style: &CellStyle<'_>) -> &'static str {
    match value {
        Some(value) if style.colours == Colours::None => SHADES[step(map.key.share(value))],
        _ => " ",
    }
}

/// Returns the style of a screen cell. In a terminal with colours, the style depends on the value,
/// otherwise on the class.
fn looks(map: &HeatMap, value: Option<f64>, class: Option<&Class>, style: &CellStyle<'_>) -> Style {
    let Some(value) = value else {
        return Style::new();
    };
    if style.colours == Colours::None {
        return class.map_or_else(Style::new, |class| (style.ink)(class.ink));
    }
    let ground = map.colour(value);
    Style::new()
        .bg(style.colours.colour(ground))
        .fg(style.colours.colour(ink_on(ground)))
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

/// Returns the colour scale of a heat map as a list of styled texts, which are written one after
/// the other. The scale has six numbers, with a coloured piece between each two neighbouring
/// numbers. In a terminal without colours, the pieces consist of the characters [`SHADES`]. If
/// `columns` columns are not enough, the scale has only the first and the last number.
pub fn key(map: &HeatMap, columns: usize, colours: Colours) -> Vec<(String, Style)> {
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
    for (step, character) in SHADES.into_iter().enumerate() {
        let colour = map.shades.at((step as f64 + 0.5) / steps as f64);
        if has_all_numbers || step == 0 {
            parts.push((" ".to_owned(), Style::new()));
        }
        parts.push(match colours {
            Colours::None => (character.repeat(3), Style::new()),
            colours => ("   ".to_owned(), Style::new().bg(colours.colour(colour))),
        });
        if has_all_numbers || step + 1 == steps {
            parts.push((format!(" {}", number(step + 1)), Style::new()));
        }
    }
    parts
}
