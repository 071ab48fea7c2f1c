//! Heat maps in cells: shades, letters of classes, and bars along the contour.

use super::style::{CellStyle, Colours};
use crate::draw::axis::Axis;
use crate::draw::chart::{Class, HeatMap};
use crate::draw::colour::ink_on;
use crate::draw::label::short;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// Shades from low to high without colours; a cell without a value is blank.
pub const SHADES: [&str; 5] = ["·", "░", "▒", "▓", "█"];
/// Fewest columns of a cell with the letter of its class.
const WITH_LETTER: usize = 3;

/// Index of the value in a column or row of the screen.
pub(super) fn index(at: usize, cells: u16, values: usize) -> usize {
    at * values / usize::from(cells.max(1))
}

/// Columns or rows of the screen with a value; empty for values without room.
fn cells_of(value: usize, cells: u16, values: usize) -> std::ops::Range<usize> {
    let first = |value: usize| (value * usize::from(cells)).div_ceil(values.max(1));
    first(value)..first(value + 1)
}

/// Draws a heat map over the whole area.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, map: &HeatMap, style: &CellStyle<'_>) {
    let (columns, rows) = (map.columns.len(), map.rows.len());
    for y in 0..usize::from(area.height) {
        let up = usize::from(area.height) - 1 - y;
        let row = index(up, area.height, rows);
        for x in 0..usize::from(area.width) {
            let column = index(x, area.width, columns);
            let value = map.values.get(row * columns + column).copied().flatten();
            let (mut symbol, looks) = match (value, style.colours) {
                (None, _) => (" ".to_owned(), Style::new()),
                (Some(value), Colours::None) => {
                    let class = class(map, row * columns + column);
                    let looks = class.map_or_else(Style::new, |class| (style.ink)(class.ink));
                    (SHADES[step(map.key.share(value))].to_owned(), looks)
                }
                (Some(value), colours) => {
                    let ground = map.colour(value);
                    let looks = Style::new().bg(colours.colour(ground)).fg(colours.colour(ink_on(ground)));
                    (" ".to_owned(), looks)
                }
            };
            let place = Within { row, column, x, up, area };
            if let Some(sign) = sign_at(map, &place, value.is_some()) {
                symbol = sign.to_string();
            }
            buffer[(area.x + x as u16, area.y + y as u16)].set_symbol(&symbol).set_style(looks);
        }
    }
}

/// A cell of the screen, counted from the lower left, and its value.
struct Within {
    row: usize,
    column: usize,
    x: usize,
    up: usize,
    area: Rect,
}

/// Bar along the contour, or letter of the class in the middle of a value's cells.
fn sign_at(map: &HeatMap, place: &Within, has_value: bool) -> Option<char> {
    let Within { row, column, x, up, area } = *place;
    let (columns, rows) = (map.columns.len(), map.rows.len());
    let (across, upwards) = (cells_of(column, area.width, columns), cells_of(row, area.height, rows));
    let cell = row * columns + column;
    let is_wide = across.len() >= WITH_LETTER;
    let on_the_right = (x + 1 == across.end && column + 1 < columns).then_some(cell + 1);
    if on_the_right.is_some_and(|other| crosses(map, cell, other)) {
        return Some('▕');
    }
    let below = (up == upwards.start && row > 0).then(|| cell - columns);
    let is_end = !is_wide || x == across.start || x + 1 == across.end;
    if is_end && below.is_some_and(|other| crosses(map, cell, other)) {
        return Some('▁');
    }
    let is_middle = x == across.start + across.len() / 2 && up == upwards.start + upwards.len() / 2;
    class(map, cell).and_then(|class| class.letter).filter(|_| has_value && is_wide && is_middle)
}

/// Step of the characters for a share of the scale.
fn step(share: f64) -> usize {
    // NaN is the lowest step.
    ((share * SHADES.len() as f64) as usize).min(SHADES.len() - 1)
}

fn class(map: &HeatMap, cell: usize) -> Option<&Class> {
    map.class_names.get(map.classes.get(cell).copied().flatten()?)
}

/// Column or row of the screen for a place among the values, clamped to the ends: the middle of the cells of a
/// value, interpolated between values.
pub(super) fn cell_of(place: f64, cells: u16, values: usize) -> u16 {
    let middle = |value: usize| {
        let cells = cells_of(value, cells, values);
        (cells.start + cells.end) as f64 / 2.0 - 0.5
    };
    let place = place.clamp(0.0, values.saturating_sub(1) as f64);
    let (before, share) = (place.floor() as usize, place.fract());
    let at = middle(before) + if share > 0.0 { share * (middle(before + 1) - middle(before)) } else { 0.0 };
    // A place that equals a value but for rounding is in the cells of that value.
    (at + 1e-6).floor().clamp(0.0, f64::from(cells.max(1) - 1)) as u16
}

/// Returns true if the contour passes between two cells.
fn crosses(map: &HeatMap, cell: usize, other: usize) -> bool {
    let Some(contour) = &map.contour else { return false };
    let below = |cell: usize| Some(contour.field.get(cell).copied().flatten()? < contour.level);
    below(cell).zip(below(other)).is_some_and(|(here, there)| here != there)
}

/// Every n-th value at its cell, so that neighbouring numbers have the same distance.
fn texts(axis: &Axis, values: &[f64], cells: u16) -> Vec<(u16, String)> {
    let (divisor, _) = axis.prefix();
    let every = values.len().div_ceil(cells.max(1).into()).max(1);
    let at = |value: usize| cell_of(value as f64, cells, values.len());
    let values = values.iter().enumerate().step_by(every);
    values.map(|(value, number)| (at(value), short(number / divisor))).collect()
}

/// Columns with their values.
pub(super) fn column_labels(x: &Axis, map: &HeatMap, width: u16) -> Vec<(u16, String)> {
    texts(x, &map.columns, width)
}

/// Rows with their values, from above.
pub(super) fn row_labels(y: &Axis, map: &HeatMap, height: u16) -> Vec<(u16, String)> {
    let texts = texts(y, &map.rows, height);
    texts.into_iter().map(|(row, text)| (height - 1 - row, text)).collect()
}

/// Scale of shades: samples of the shades with numbers between them.
#[must_use]
pub fn key(map: &HeatMap, columns: usize, colours: Colours) -> Vec<(String, Style)> {
    let (divisor, _) = map.key.prefix();
    let steps = SHADES.len();
    let number = |step: usize| {
        let share = step as f64 / steps as f64;
        short(map.key.scale.number(map.key.span.low + share * map.key.span.width()) / divisor)
    };
    // Without room for all numbers, only those at the ends are shown.
    let all = (0..=steps).map(|step| number(step).chars().count()).sum::<usize>() + 5 * steps <= columns;
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
