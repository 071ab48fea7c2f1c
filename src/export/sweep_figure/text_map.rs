//! A map as text: a shade for each cell, the regime in it, and a bar where adhesion without a load vanishes.

use super::label::{axis_label, plain, prefixed, quantity_label};
use super::shades::{Shades, ink_on};
use super::text::{Colours, centred, numbers_below, painted, push_words, scaled};
use crate::analysis::Regime;
use crate::study::figure::{AxisScale, Boundary, Figure, FigureAxis, Panel};

/// Shades from low to high where there are no colours; a cell without a value is blank.
const SHADES: [char; 5] = ['·', '░', '▒', '▓', '█'];
/// Most rows of cells.
const MOST_ROWS: usize = 48;
/// Widest cell, columns.
const WIDEST_CELL: usize = 5;

pub(super) fn draw(
    text: &mut String,
    figure: &Figure,
    up: &FigureAxis,
    panel: &Panel,
    columns: usize,
    colours: Colours,
) {
    let (across_divisor, across_unit) = prefix(&figure.across);
    let (up_divisor, up_unit) = prefix(up);
    let rows: Vec<String> = up.values.iter().map(|value| scaled(*value, up_divisor)).collect();
    let before = rows.iter().map(|row| row.chars().count()).max().unwrap_or(0) + 2;
    let values = figure.across.values.len();
    let room = columns.saturating_sub(before + 1);
    // Where there are more values than columns or rows, every so manieth is shown.
    let every = values.div_ceil(room.max(1)).max(1);
    let every_row = rows.len().div_ceil(MOST_ROWS).max(1);
    let shown = values.div_ceil(every).max(1);
    let wide = (room / shown).clamp(1, WIDEST_CELL);
    let means = panel.estimates.iter().flatten().map(|estimate| estimate.mean);
    let shades = Shades::over(panel.scale, means);
    let largest = match shades.scale {
        AxisScale::Linear => shades.high.abs().max(shades.low.abs()),
        AxisScale::Logarithmic => 10_f64.powf(shades.high),
    };
    let (divisor, unit) = prefixed(&panel.quantity.unit, largest);

    let boundary = figure.boundary_of(panel);
    let heading = |label: String| format!("{}\n", plain(&label));
    text.push_str(&heading(quantity_label(&panel.quantity, &unit)));
    text.push_str(&heading(format!(
        "{}↑ {}",
        " ".repeat(before.saturating_sub(1)),
        axis_label(up, &up_unit)
    )));
    for row in (0..rows.len()).step_by(every_row).rev() {
        text.push_str(&format!("{:>width$} ", rows[row], width = before - 2));
        text.push('┤');
        for column in (0..values).step_by(every) {
            let ends = row * values + values;
            let index = row * values + column;
            // Bars stand between shown cells.
            let beside = (index + every < ends).then_some(index + every);
            let below = index.checked_sub(every_row * values);
            text.push_str(&cell(
                figure,
                panel,
                (&shades, boundary.as_ref()),
                (index, beside, below),
                wide,
                colours,
            ));
        }
        trim(text);
        text.push('\n');
    }
    text.push_str(&format!("{}└{}\n", " ".repeat(before - 1), "─".repeat(shown * wide)));
    let places: Vec<_> = (0..values)
        .step_by(every)
        .enumerate()
        .map(|(place, column)| {
            (place * wide + wide / 2, scaled(figure.across.values[column], across_divisor))
        })
        .collect();
    text.push_str(&format!("{}\n", numbers_below(before, &places, columns)));
    text.push_str(&format!(
        "{}\n\n",
        centred(&axis_label(&figure.across, &across_unit), before, shown * wide)
    ));
    text.push_str(&scale_of_shades(&shades, divisor, columns, colours));
    for line in meanings(figure, panel, wide, (every, every_row)) {
        push_words(text, &line, columns);
    }
}

fn prefix(axis: &FigureAxis) -> (f64, String) {
    prefixed(&axis.unit, axis.values.iter().copied().fold(0.0, f64::max))
}

/// Blanks at the end of a line that are part of no colour.
fn trim(text: &mut String) {
    text.truncate(text.trim_end_matches(' ').len());
}

fn shade(share: f64) -> char {
    SHADES[((share * SHADES.len() as f64) as usize).min(SHADES.len() - 1)]
}

fn letter(regime: Regime) -> char {
    match regime {
        Regime::PressureInsensitive => 'i',
        Regime::PressureSensitive => 's',
        Regime::NonAdhesive => 'n',
    }
}

/// Whether cells are wide enough for the letters of regimes.
fn has_letters(wide: usize) -> bool {
    wide >= 3
}

fn cell(
    figure: &Figure,
    panel: &Panel,
    (shades, boundary): (&Shades, Option<&Boundary>),
    (index, beside, below): (usize, Option<usize>, Option<usize>),
    wide: usize,
    colours: Colours,
) -> String {
    let estimate = panel.estimates.get(index).copied().flatten();
    let filled = match estimate {
        Some(estimate) if colours == Colours::None => shade(shades.share(estimate.mean)),
        _ => ' ',
    };
    let mut characters = vec![filled; wide];
    let regime = figure.regimes.get(index).copied().flatten();
    if let Some(regime) = regime.filter(|_| has_letters(wide)) {
        characters[wide / 2] = letter(regime);
    }
    if let Some(boundary) = boundary {
        let vanished = |index: usize| Some(boundary.values.get(index).copied().flatten()? < boundary.level);
        let parted = |other: Option<usize>| {
            other
                .and_then(|other| vanished(index).zip(vanished(other)))
                .is_some_and(|(here, there)| here != there)
        };
        if parted(below) {
            let ends = if has_letters(wide) { [0, wide - 1] } else { [0; 2] };
            ends.into_iter().for_each(|end| characters[end] = '▁');
        }
        if parted(beside) {
            characters[wide - 1] = '▕';
        }
    }
    let characters: String = characters.into_iter().collect();
    estimate.map_or(characters.clone(), |estimate| {
        let colour = shades.colour(estimate.mean);
        painted(&characters, colour, ink_on(colour), colours)
    })
}

fn scale_of_shades(shades: &Shades, divisor: f64, columns: usize, colours: Colours) -> String {
    let number = |share: f64| {
        let coordinate = shades.low + share * (shades.high - shades.low);
        let value = match shades.scale {
            AxisScale::Linear => coordinate,
            AxisScale::Logarithmic => 10_f64.powf(coordinate),
        };
        scaled(value, divisor)
    };
    let steps = SHADES.len() as f64;
    let mut line = number(0.0);
    // Where there is no room for all numbers, those at the ends are given.
    let numbers: usize = (0..=SHADES.len()).map(|index| number(index as f64 / steps).chars().count()).sum();
    let all = numbers + 5 * SHADES.len() <= columns;
    for (index, character) in SHADES.into_iter().enumerate() {
        let middle = (index as f64 + 0.5) / steps;
        let colour = super::shades::shade(middle);
        let blanks = if colours == Colours::None { character.to_string().repeat(3) } else { "   ".into() };
        let painted = painted(&blanks, colour, ink_on(colour), colours);
        let last = index + 1 == SHADES.len();
        let before = if all || index == 0 { " " } else { "" };
        line.push_str(&format!("{before}{painted}"));
        if all || last {
            line.push_str(&format!(" {}", number((index + 1) as f64 / steps)));
        }
    }
    format!("{line}\n")
}

fn meanings(figure: &Figure, panel: &Panel, wide: usize, (every, every_row): (usize, usize)) -> Vec<String> {
    let mut lines = Vec::new();
    if has_letters(wide) {
        let regimes = [Regime::PressureInsensitive, Regime::PressureSensitive, Regime::NonAdhesive];
        let there = regimes.into_iter().filter(|regime| figure.regimes.contains(&Some(*regime)));
        let said: Vec<_> = there.map(|regime| format!("{} {}", letter(regime), regime.name())).collect();
        if !said.is_empty() {
            lines.push(said.join(", "));
        }
    }
    if let Some(boundary) = &figure.boundary {
        lines.push(format!("▁ ▕ {}", boundary.label));
    }
    if panel.estimates.contains(&None) {
        lines.push("blank: no value".into());
    }
    if every > 1 {
        lines.push(format!("across, one of {every} values is shown"));
    }
    if every_row > 1 {
        lines.push(format!("up, one of {every_row} values is shown"));
    }
    lines
}
