//! Figures as text for a terminal, or for a file.

use super::legend::legend;
use super::map;
use super::plot::{CellPlot, WITH_LEFT_SCALE};
use super::style::{CellStyle, Colours};
use crate::chart::{Chart, Figure};
use crate::colour::Ink;
use crate::label::Label;
use asperity_data::wrap;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::Line;

/// Smallest and largest width of the text in columns.
const COLUMNS: (usize, usize) = (40, 160);
/// Largest width of a plot of curves in columns, and its height in rows, with the scale below.
const WIDEST_PLOT: u16 = 110;
const ROWS: u16 = 20;
/// Largest width of a cell of a map in columns, and smallest and largest height of a map in rows.
const WIDEST_CELL: usize = 5;
const FEWEST_ROWS: usize = 10;
const MOST_ROWS: usize = 48;

/// Returns a figure as text for a terminal or a file, with its charts one below the other. A line
/// has at most `columns` characters; values of `columns` below 40 count as 40, and values above 160
/// as 160.
pub fn figure_text(figure: &Figure, columns: usize, colours: Colours) -> String {
    let columns = columns.clamp(COLUMNS.0, COLUMNS.1);
    let ink = |ink: Ink| match (ink, colours) {
        (Ink::Text | Ink::Quiet, _) | (_, Colours::None) => Style::new(),
        (ink, colours) => Style::new().fg(colours.colour(ink.on_paper())),
    };
    let style = CellStyle { ink: &ink, colours };
    let mut text = String::new();
    for line in std::iter::once(&Label::plain(&figure.title)).chain(&figure.notes) {
        push_words(&mut text, &line.to_string(), columns);
    }
    for (index, chart) in figure.charts.iter().enumerate() {
        if !text.is_empty() {
            text.push('\n');
        }
        if let Some(heading) = figure.heading(index) {
            push_words(&mut text, &heading.to_string(), columns);
        }
        push_words(&mut text, &heading(chart).to_string(), columns);
        push_chart(&mut text, chart, columns as u16, &style);
        push_legend(&mut text, chart, columns, &style);
    }
    text
}

fn heading(chart: &Chart) -> Label {
    chart.map().map_or_else(
        || chart.y.label_with_unit(),
        |map| map.key.label_with_unit(),
    )
}

fn push_chart(text: &mut String, chart: &Chart, columns: u16, style: &CellStyle<'_>) {
    let mut area = Rect::new(0, 0, columns.min(WIDEST_PLOT), ROWS);
    if let Some(map) = chart.map() {
        // Every value has equal columns and rows, if there is room.
        let rows = map.rows.len().max(1);
        let rows = rows.div_ceil(rows.div_ceil(MOST_ROWS)) * FEWEST_ROWS.div_ceil(rows);
        let left = area.width - CellPlot::within(area, chart).plot.width;
        let (room, values) = (usize::from(columns - left), map.columns.len().max(1));
        let plot = if values > room {
            room
        } else {
            values * (room / values).min(WIDEST_CELL)
        };
        area.width = (plot as u16 + left).max(WITH_LEFT_SCALE.0);
        area.height = rows as u16;
        while usize::from(CellPlot::within(area, chart).plot.height) < rows {
            area.height += 1;
        }
        push_words(
            text,
            &format!("↑ {}", chart.y.label_with_unit()),
            usize::from(columns),
        );
    }
    let mut buffer = Buffer::empty(area);
    let place = CellPlot::within(area, chart);
    place.draw(&mut buffer, chart, style);
    for row in 0..area.height {
        let cells = (0..area.width).map(|column| &buffer[(column, row)]);
        let runs: Vec<(&str, Style)> = cells.map(|cell| (cell.symbol(), cell.style())).collect();
        push_line(text, &runs);
    }
    if let Some(map) = chart.map() {
        text.push('\n');
        let parts = map::key(map, usize::from(columns), style.colours);
        push_line(text, &parts);
        for (axis, values, cells) in [
            ("across", &map.columns, place.plot.width),
            ("up", &map.rows, place.plot.height),
        ] {
            if values.len() > usize::from(cells) {
                let note = format!("{axis}: {cells} of {} values are shown", values.len());
                push_words(text, &note, usize::from(columns));
            }
        }
    }
}

fn push_legend(text: &mut String, chart: &Chart, columns: usize, style: &CellStyle<'_>) {
    let mut lines: Vec<Line<'static>> = Vec::new();
    for part in legend(std::slice::from_ref(chart), style) {
        let part = Line::from(part);
        match lines
            .last_mut()
            .filter(|line| line.width() + 2 + part.width() <= columns)
        {
            Some(line) => {
                line.push_span("  ");
                line.spans.extend(part.spans);
            }
            None => lines.push(part),
        }
    }
    for line in lines {
        push_line(
            text,
            &line
                .spans
                .iter()
                .map(|span| (&span.content, span.style))
                .collect::<Vec<_>>(),
        );
    }
}

/// Appends a line of styled texts, without trailing blanks and with the escape sequences of the
/// styles.
fn push_line<S: AsRef<str>>(text: &mut String, runs: &[(S, Style)]) {
    let is_blank = |(text, style): &&(S, Style)| {
        text.as_ref().trim_matches([' ', '\u{2800}']).is_empty() && code(style).is_empty()
    };
    let end = runs.len() - runs.iter().rev().take_while(is_blank).count();
    let mut last = String::new();
    for (run, style) in &runs[..end] {
        let code = code(style);
        if code != last {
            text.push_str(if last.is_empty() { "" } else { "\x1b[0m" });
            text.push_str(&code);
            last = code;
        }
        text.push_str(run.as_ref());
    }
    text.push_str(if last.is_empty() { "" } else { "\x1b[0m" });
    text.push('\n');
}

fn code(style: &Style) -> String {
    let parameters = |kind: u8, colour: Option<Color>| match colour {
        Some(Color::Rgb(red, green, blue)) => Some(format!("{kind};2;{red};{green};{blue}")),
        Some(Color::Indexed(index)) => Some(format!("{kind};5;{index}")),
        _ => None,
    };
    let both: Vec<String> = parameters(38, style.fg)
        .into_iter()
        .chain(parameters(48, style.bg))
        .collect();
    if both.is_empty() {
        String::new()
    } else {
        format!("\x1b[{}m", both.join(";"))
    }
}

fn push_words(text: &mut String, words: &str, columns: usize) {
    for line in wrap(words, columns).iter().filter(|line| !line.is_empty()) {
        text.push_str(line);
        text.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_cube() {
        let line = |colours: Colours| {
            let looks = Style::new()
                .fg(colours.colour([255; 3]))
                .bg(colours.colour([0; 3]));
            let mut text = String::new();
            push_line(
                &mut text,
                &[("x", looks), (" ", looks), (" ", Style::new())],
            );
            text
        };
        assert_eq!(line(Colours::Palette), "\x1b[38;5;231;48;5;16mx \x1b[0m\n");
        assert_eq!(
            line(Colours::All),
            "\x1b[38;2;255;255;255;48;2;0;0;0mx \x1b[0m\n"
        );
        assert_eq!(line(Colours::None), "x\n");
    }
}
