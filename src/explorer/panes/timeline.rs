//! The pane of the timeline: the loading stages as segments of a line, the jumps as ticks over it,
//! and the position of the animation.

use super::force;
use super::row::PaneRow;
use crate::explorer::app::App;
use crate::explorer::caption::caption;
use crate::explorer::commands::movement::is_at_rest;
use crate::explorer::manual_path;
use crate::explorer::pane::Pane;
use crate::explorer::panel::{Body, Panel, title_line};
use crate::explorer::player::At;
use crate::explorer::text::Part;
use crate::explorer::theme::Meaning;
use crate::explorer::timeline::{Tick, Timeline, passed, selected, speed_in_words};
use asperity_contact::{Direction, Mark, Move, StageRecord};
use asperity_data::grouped;
use asperity_plot::Ink;
use asperity_report::{event_words, signed_energy};
use ratatui::layout::Size;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use std::ops::{Range, RangeInclusive};

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, panel| (force::ROW.figure)(app, panel),
    report: |app| (force::ROW.report)(app),
    help: &[(
        "Timeline",
        "the stages of the loading, or their times if the body relaxes; a tick is a jump, its height the square root of \
         the elastic energy that springs gain or release. Such an energy is no loss: only a closed loop has a dissipated energy. ◇ jump-in, ▲ preload, ▼ \
         pull-off, ○ jump-out. With the pane selected, ← → move along the stage, Home and End go to the ends, + and - \
         change the speed of play; a click goes there. ■ is the end of play, from which Space plays anew",
    )],
    ..PaneRow::EMPTY
};

/// Heights in rows of a strip whose first line is its title. A higher pane has the title that all
/// panes have.
const STRIP_WITH_TITLE: RangeInclusive<u16> = 3..=4;
/// Glyphs of the top of a tick, from an eighth of a cell to the whole cell.
const EIGHTHS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Symbol in a cell, and the style of the symbol.
#[derive(Clone, Copy)]
struct Cell {
    symbol: char,
    style: Style,
}

fn panel(app: &App, size: Size) -> Panel {
    let mut panel = Panel::of_text(String::new(), "");
    let width = usize::from(size.width);
    let records = app.played_stages();
    if records.is_empty() || width == 0 {
        return panel;
    }
    let timeline = Timeline::new(records, width);
    let mut lines = Vec::new();
    if STRIP_WITH_TITLE.contains(&size.height) {
        let is_selected = app.view.pane == Pane::Timeline;
        let look = app.view.appearance;
        lines.push(title_line(
            &title(app),
            event(app),
            size.width,
            is_selected,
            look,
        ));
    } else {
        panel.title = title(app);
        panel.edge = event(app);
    }
    let rows = usize::from(size.height).saturating_sub(lines.len() + 1);
    let playhead = app.playhead();
    let head = timeline.column(playhead.stage, playhead.share(records));
    lines.extend(tick_lines(app, &timeline, width, rows, head));
    let mut stages = stage_line(app, &timeline, width, head);
    let has_no_title = size.height < *STRIP_WITH_TITLE.start();
    if has_no_title && app.view.pane == Pane::Timeline && head != Some(0) {
        mark_as_selected(&mut stages, app.style(Meaning::Title));
    }
    lines.push(stages);
    panel.body = Body::Lines(lines);
    panel
}

/// Replaces the first sign of a line by the sign of the selected pane.
fn mark_as_selected(line: &mut Line<'static>, style: Style) {
    if let Some(first) = line.spans.first_mut() {
        let rest: String = first.content.chars().skip(1).collect();
        first.content = rest.into();
        line.spans.insert(0, Span::styled("▸", style));
    }
}

/// Returns the name of the pane, whether the animation plays, and its speed.
fn title(app: &App) -> String {
    let playhead = app.playhead();
    let speed = speed_in_words(app.config.speed);
    let repeat = if app.config.repeat { " ↻" } else { "" };
    let (playing, end) = match playhead.at {
        _ if playhead.playing => ("▶", ""),
        _ if !is_at_rest(app, playhead) => ("❚❚", ""),
        // After its end, the animation goes back to the pull-off.
        At::PullOff => ("■", " · end, at the pull-off"),
        _ => ("■", " · end"),
    };
    format!("Timeline  {playing} {speed}{repeat}{end}")
}

/// Returns the event that the animation has passed last, or at the pull-off the jump that follows,
/// with the energy of the jump; without an event, the name of the present part of the loading.
fn event(app: &App) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let listed = match app.listed_events() {
        None => return vec![vec![Span::raw("listing the jumps…")]],
        Some(Err(why)) => return vec![vec![Span::raw(why.to_owned())]],
        Some(Ok(listed)) => listed,
    };
    let records = app.played_stages();
    let passed = passed(records, &listed.list, app.playhead());
    let selected = selected(records, &listed.list, app.playhead());
    match selected {
        Some(index) => {
            let event = &listed.list[index];
            let is_jump_of_pull_off = event.mark == Some(Mark::PullOff) && event.jump.is_some();
            // The pull-off is the state before the jump.
            let words = if is_jump_of_pull_off && index >= passed {
                let mut jump = *event;
                jump.mark = None;
                format!("next: {}", event_words(&jump))
            } else if is_jump_of_pull_off {
                format!("after {}", event_words(event))
            } else {
                event_words(event)
            };
            parts.push(vec![Span::raw(words)]);
            if let Some(jump) = event.jump {
                let palette = app.view.appearance.palette();
                let style = palette.ink(ink_of(jump.energy > 0.0));
                parts.push(vec![Span::styled(signed_energy(jump.energy), style)]);
            }
        }
        None => parts.extend(caption(app).map(|text| vec![Span::raw(text)])),
    }
    let number = listed.list[..passed]
        .iter()
        .filter(|event| event.jump.is_some())
        .count();
    if listed.listed_jumps > 0 {
        let count = grouped(listed.listed_jumps as u64);
        let text = format!("jump {} of {count}", grouped(number as u64));
        parts.push(vec![Span::raw(text)]);
    }
    parts
}

/// Returns the colour of an energy: that of pressing if springs gain it, that of pulling if they
/// release it.
pub fn ink_of(is_gain: bool) -> Ink {
    if is_gain { Ink::Press } else { Ink::Pull }
}

/// Returns the lines with the ticks of the jumps. `head` is the column of the animation, which is a
/// line through all rows.
fn tick_lines(
    app: &App,
    timeline: &Timeline,
    width: usize,
    rows: usize,
    head: Option<usize>,
) -> Vec<Line<'static>> {
    let palette = app.view.appearance.palette();
    let ticks = match app.listed_events() {
        Some(Ok(listed)) => timeline.ticks(&listed.list, width),
        _ => vec![None; width],
    };
    let mut lines = Vec::new();
    for row in (0..rows).rev() {
        let mut cells = Vec::new();
        for (column, tick) in ticks.iter().enumerate() {
            let symbol = tick.and_then(|tick| tick_symbol(tick, row, rows));
            let cell = match (symbol, tick) {
                (Some(symbol), Some(tick)) => Cell {
                    symbol,
                    style: palette.ink(ink_of(tick.is_gain)),
                },
                _ if Some(column) == head => Cell {
                    symbol: '│',
                    style: app.style(Meaning::Cursor),
                },
                _ => Cell {
                    symbol: ' ',
                    style: Style::new(),
                },
            };
            cells.push(cell);
        }
        lines.push(line_of(&cells));
    }
    lines
}

/// Returns the part of a tick in one of the rows, which are counted from 0 at the bottom; `None` if
/// the tick does not reach the row.
fn tick_symbol(tick: Tick, row: usize, rows: usize) -> Option<char> {
    let eighths = (tick.height * (8 * rows) as f64).round().max(1.0) as usize;
    let in_row = eighths.saturating_sub(8 * row).min(8);
    let index = in_row.checked_sub(1)?;
    Some(EIGHTHS[index])
}

/// Returns the line with the stages: a segment for each stage with its number and its target, the
/// marks of the force curve, and the position of the animation.
fn stage_line(app: &App, timeline: &Timeline, width: usize, head: Option<usize>) -> Line<'static> {
    let records = app.played_stages();
    let quiet = app.style(Meaning::Quiet);
    let mut cells = vec![
        Cell {
            symbol: ' ',
            style: quiet,
        };
        width
    ];
    let marks = marks(app, timeline);
    let last = timeline
        .stages
        .iter()
        .rposition(|columns| !columns.is_empty());
    for (stage, columns) in timeline.stages.iter().enumerate() {
        draw_segment(&mut cells, columns, last == Some(stage));
        let taken: Vec<usize> = marks.iter().map(|mark| mark.column).collect();
        write_name(app, &mut cells, &records[stage], stage, columns, &taken);
    }
    for mark in marks {
        if let Some(cell) = cells.get_mut(mark.column) {
            cell.symbol = mark.symbol;
            cell.style = app.style(Meaning::Title);
        }
    }
    if let Some(cell) = head.and_then(|column| cells.get_mut(column)) {
        let is_of_line = matches!(cell.symbol, ' ' | '─' | '├' | '┤' | '┼');
        if is_of_line {
            cell.symbol = '◆';
            cell.style = app.style(Meaning::Cursor);
        } else {
            // The letter of a name, or a mark, stays readable.
            cell.style = app
                .style(Meaning::Cursor)
                .add_modifier(Modifier::BOLD | Modifier::UNDERLINED);
        }
    }
    line_of(&cells)
}

/// Draws the segment of a stage. A stage in one column is a crossing.
fn draw_segment(cells: &mut [Cell], columns: &Range<usize>, is_last: bool) {
    for column in columns.clone() {
        cells[column].symbol = match column {
            _ if columns.len() == 1 => '┼',
            _ if column == columns.start => '├',
            _ if is_last && column + 1 == columns.end => '┤',
            _ => '─',
        };
    }
}

/// Writes the number and the target of a stage into its segment: the longest of several texts that
/// fits beside the marks. Nothing is written if none fits.
fn write_name(
    app: &App,
    cells: &mut [Cell],
    record: &StageRecord,
    stage: usize,
    columns: &Range<usize>,
    taken: &[usize],
) {
    let target = manual_path::in_words(record.target);
    let whole = match (record.target, record.direction) {
        (Move::Hold(_), _) => target.clone(),
        (_, Direction::Loading) => format!("press to {target}"),
        (_, Direction::Unloading) => format!("pull to {target}"),
    };
    let number = stage + 1;
    let texts = [
        format!(" {number} {whole} "),
        format!(" {number} {target} "),
        format!(" {number} "),
    ];
    for text in texts {
        let length = text.chars().count();
        let Some(place) = free_place(length, columns, taken) else {
            continue;
        };
        for (column, symbol) in place.zip(text.chars()) {
            cells[column] = Cell {
                symbol,
                style: app.style(Meaning::Text),
            };
        }
        return;
    }
}

/// Returns the first columns inside a segment that have room for a text of this length and no mark.
fn free_place(length: usize, columns: &Range<usize>, taken: &[usize]) -> Option<Range<usize>> {
    let last = columns.end.checked_sub(length + 1)?;
    (columns.start + 2..=last)
        .map(|first| first..first + length)
        .find(|place| !taken.iter().any(|column| place.contains(column)))
}

/// Mark of the force curve on the line of the stages.
struct PlacedMark {
    column: usize,
    symbol: char,
}

fn marks(app: &App, timeline: &Timeline) -> Vec<PlacedMark> {
    let Some(Ok(listed)) = app.listed_events() else {
        return Vec::new();
    };
    let mut placed = Vec::new();
    for event in &listed.list {
        if let Some(mark) = event.mark
            && let Some(column) = timeline.column_of(event)
        {
            placed.push(PlacedMark {
                column,
                symbol: symbol_of(mark),
            });
        }
    }
    placed
}

/// Returns the symbol of a mark, as in the chart of the force curve.
pub fn symbol_of(mark: Mark) -> char {
    match mark {
        Mark::JumpIn => '◇',
        Mark::Preload => '▲',
        Mark::PullOff => '▼',
        Mark::JumpOut => '○',
    }
}

fn line_of(cells: &[Cell]) -> Line<'static> {
    let mut spans = Vec::new();
    for same in cells.chunk_by(|cell, next| cell.style == next.style) {
        let text: String = same.iter().map(|cell| cell.symbol).collect();
        spans.push(Span::styled(text, same[0].style));
    }
    Line::from(spans)
}
