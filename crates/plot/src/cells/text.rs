//! Figures as lines of text, for a terminal or a file.

use super::legend::legend;
use super::map;
use super::plot::{COLUMNS_WITH_LEFT_SCALE, CellPlot};
use super::style::{CellStyle, Colours};
use crate::chart::{Chart, Figure, HeatMap};
use crate::colour::Ink;
use crate::label::Label;
use asperity_data::wrap;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::Line;

/// Smallest width of the text in columns.
const FEWEST_COLUMNS: usize = 40;
/// Largest width of the text in columns.
const MOST_COLUMNS: usize = 160;
/// Largest width in columns of a chart of curves.
const WIDEST_PLOT: u16 = 110;
/// Height in rows of a chart of curves, including the numbers below the plot.
const ROWS: u16 = 20;
/// Largest width in columns of a cell of a heat map.
const WIDEST_CELL: usize = 5;
/// Smallest height in rows of all cells of a heat map together.
const FEWEST_ROWS: usize = 10;
/// Largest height in rows of all cells of a heat map together.
const MOST_ROWS: usize = 48;

/// Returns a figure as text for a terminal or a file, with each chart below the previous one. A
/// line has at most `columns` characters. If `columns` is below 40, 40 is used; if it is above 160,
/// 160 is used.
pub fn figure_text(figure: &Figure, columns: usize, colours: Colours) -> String {
    let columns = columns.clamp(FEWEST_COLUMNS, MOST_COLUMNS);
    let ink = |ink: Ink| match (ink, colours) {
        (Ink::Text | Ink::Quiet, _) | (_, Colours::None) => Style::new(),
        (ink, colours) => Style::new().fg(colours.colour(ink.on_paper())),
    };
    let style = CellStyle { ink: &ink, colours };
    let mut text = String::new();
    push_words(&mut text, &Label::plain(&figure.title).to_string(), columns);
    for note in &figure.notes {
        push_words(&mut text, &note.to_string(), columns);
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
    match chart.map() {
        Some(map) => map.key.label_with_unit(),
        None => chart.y.label_with_unit(),
    }
}

fn push_chart(text: &mut String, chart: &Chart, columns: u16, style: &CellStyle<'_>) {
    let area = match chart.map() {
        Some(map) => {
            let label = format!("↑ {}", chart.y.label_with_unit());
            push_words(text, &label, usize::from(columns));
            area_of_map(chart, map, columns)
        }
        None => Rect::new(0, 0, columns.min(WIDEST_PLOT), ROWS),
    };
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

/// Returns the area of the screen for a heat map. If there is enough room, every cell of the map
/// covers equally many columns and equally many rows of the terminal.
fn area_of_map(chart: &Chart, map: &HeatMap, columns: u16) -> Rect {
    let mut area = Rect::new(0, 0, columns.min(WIDEST_PLOT), ROWS);
    let values_up = map.rows.len().max(1);
    let values_for_a_row = values_up.div_ceil(MOST_ROWS);
    let rows_for_a_value = FEWEST_ROWS.div_ceil(values_up);
    let rows = values_up.div_ceil(values_for_a_row) * rows_for_a_value;
    let left = area.width - CellPlot::within(area, chart).plot.width;
    let room = usize::from(columns - left);
    let values_across = map.columns.len().max(1);
    let plot = if values_across > room {
        room
    } else {
        values_across * (room / values_across).min(WIDEST_CELL)
    };
    area.width = (plot as u16 + left).max(COLUMNS_WITH_LEFT_SCALE);
    area.height = rows as u16;
    while usize::from(CellPlot::within(area, chart).plot.height) < rows {
        area.height += 1;
    }
    area
}

fn push_legend(text: &mut String, chart: &Chart, columns: usize, style: &CellStyle<'_>) {
    let mut lines: Vec<Line<'static>> = Vec::new();
    for part in legend(std::slice::from_ref(chart), style) {
        let part = Line::from(part);
        match lines.last_mut() {
            Some(line) if line.width() + 2 + part.width() <= columns => {
                line.push_span("  ");
                line.spans.extend(part.spans);
            }
            _ => lines.push(part),
        }
    }
    for line in lines {
        let runs: Vec<(&str, Style)> = line
            .spans
            .iter()
            .map(|span| (span.content.as_ref(), span.style))
            .collect();
        push_line(text, &runs);
    }
}

/// Escape sequence that returns to the default colours.
const RESET: &str = "\x1b[0m";

/// Appends a line of styled texts, in which escape sequences set the colours. Blanks at the end of
/// the line are left out, unless they are coloured.
fn push_line<S: AsRef<str>>(text: &mut String, runs: &[(S, Style)]) {
    let mut runs = runs;
    while let [before @ .., (blank, style)] = runs {
        let is_blank = blank.as_ref().trim_matches([' ', '\u{2800}']).is_empty();
        if !is_blank || !code(style).is_empty() {
            break;
        }
        runs = before;
    }
    let mut last = String::new();
    for (run, style) in runs {
        let code = code(style);
        if code != last {
            if !last.is_empty() {
                text.push_str(RESET);
            }
            text.push_str(&code);
            last = code;
        }
        text.push_str(run.as_ref());
    }
    if !last.is_empty() {
        text.push_str(RESET);
    }
    text.push('\n');
}

/// Returns the escape sequence for the colours of a style. It is empty for a style without colours.
fn code(style: &Style) -> String {
    let colours = [(38, style.fg), (48, style.bg)];
    let parameters: Vec<String> = colours
        .iter()
        .filter_map(|(kind, colour)| parameters(*kind, *colour))
        .collect();
    if parameters.is_empty() {
        String::new()
    } else {
        format!("\x1b[{}m", parameters.join(";"))
    }
}

/// Returns the parameters of the escape sequence for a colour. `kind` is 38 for the colour of
/// letters and 48 for the background.
fn parameters(kind: u8, colour: Option<Color>) -> Option<String> {
    match colour {
        Some(Color::Rgb(red, green, blue)) => Some(format!("{kind};2;{red};{green};{blue}")),
        Some(Color::Indexed(index)) => Some(format!("{kind};5;{index}")),
        _ => None,
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
