//! Heat maps in terminal cells: shades, letters of classes, and bars along the contour.

use super::style::{CellStyle, Colours};
use crate::axis::ChartAxis;
use crate::chart::{Chart, Class, HeatMap};
use crate::colour::ink_on;
use asperity_data::format_rounded;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use std::ops::Range;

/// Characters for the values of a heat map in a terminal without colours, from the lowest to the
/// highest values.
pub const SHADES: [&str; 5] = ["·", "░", "▒", "▓", "█"];
/// Smallest number of columns with which a cell shows the letter of its class.
const WITH_LETTER: usize = 3;

/// Returns the index of the value that each screen cell along an axis shows, from the lower end of
/// the axis.
pub(super) fn values_behind(axis: &ChartAxis, values: &[f64], cells: u16) -> Vec<usize> {
    let borders = HeatMap::borders(axis.scale, values);
    let value = |cell: u16| {
        let share = (f64::from(cell) + 0.5) / f64::from(cells);
        let at = axis.span.low + share * axis.span.width();
        borders
            .partition_point(|border| *border <= at)
            .clamp(1, values.len().max(1))
            - 1
    };
    (0..cells).map(value).collect()
}

/// Returns the range of the screen cells that show the same value as this cell.
fn run(values: &[usize], cell: usize) -> Range<usize> {
    let first = |value: usize| values.partition_point(|one| *one < value);
    first(values[cell])..first(values[cell] + 1)
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
    let cell = |column: usize, row: usize| rows[row] * map.columns.len() + columns[column];
    for (y, up) in (area.y..area.bottom()).zip((0..rows.len()).rev()) {
        for (x, across) in (area.x..).zip(0..columns.len()) {
            let here = cell(across, up);
            let value = map.values.get(here).copied().flatten();
            let class = map
                .classes
                .get(here)
                .copied()
                .flatten()
                .and_then(|class| map.class_names.get(class));
            let (mut symbol, looks) = match (value, style.colours) {
                (None, _) => (" ", Style::new()),
                (Some(value), Colours::None) => {
                    let looks = class.map_or_else(Style::new, |class| (style.ink)(class.ink));
                    (SHADES[step(map.key.share(value))], looks)
                }
                (Some(value), colours) => {
                    let ground = map.colour(value);
                    (
                        " ",
                        Style::new()
                            .bg(colours.colour(ground))
                            .fg(colours.colour(ink_on(ground))),
                    )
                }
            };
            let (wide, high) = (run(&columns, across), run(&rows, up));
            let is_wide = wide.len() >= WITH_LETTER;
            let is_end = !is_wide || across == wide.start || across + 1 == wide.end;
            let is_middle =
                across == wide.start + wide.len() / 2 && up == high.start + high.len() / 2;
            let mut letter = [0; 4];
            if across + 1 < columns.len() && crosses(map, here, cell(across + 1, up)) {
                symbol = "▕";
            } else if up > 0 && is_end && crosses(map, here, cell(across, up - 1)) {
                symbol = "▁";
            } else if let Some(Class {
                letter: Some(of_class),
                ..
            }) = class
                && value.is_some()
                && is_wide
                && is_middle
            {
                symbol = of_class.encode_utf8(&mut letter);
            }
            buffer[(x, y)].set_symbol(symbol).set_style(looks);
        }
    }
}

fn step(share: f64) -> usize {
    // NaN is the lowest step.
    ((share * SHADES.len() as f64) as usize).min(SHADES.len() - 1)
}

fn crosses(map: &HeatMap, cell: usize, other: usize) -> bool {
    let Some(contour) = &map.contour else {
        return false;
    };
    let below = |cell: usize| Some(contour.field.get(cell).copied().flatten()? < contour.level);
    below(cell)
        .zip(below(other))
        .is_some_and(|(here, there)| here != there)
}

/// Returns the colour scale of a heat map as texts with styles, to be written one after the other.
/// The scale has six numbers and, between each two neighbours, one coloured piece. In a terminal
/// without colours the pieces are made of [`SHADES`]. A scale that would need more than `columns`
/// columns shows only the first and the last number.
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
    // Without room for all numbers, only those at the ends are shown.
    let all = (0..=steps)
        .map(|step| number(step).chars().count())
        .sum::<usize>()
        + 5 * steps
        <= columns;
    let mut parts = vec![(number(0), Style::new())];
    for (step, character) in SHADES.into_iter().enumerate() {
        let colour = map.shades.at((step as f64 + 0.5) / steps as f64);
        if all || step == 0 {
            parts.push((" ".to_owned(), Style::new()));
        }
        parts.push(match colours {
            Colours::None => (character.repeat(3), Style::new()),
            colours => ("   ".to_owned(), Style::new().bg(colours.colour(colour))),
        });
        if all || step + 1 == steps {
            parts.push((format!(" {}", number(step + 1)), Style::new()));
        }
    }
    parts
}
