//! The pane with the list of events: the jumps and the marked points of the loading, in the order
//! of the motion. The selected row is the event that the animation has passed last.

use super::force;
use super::row::{Exported, PaneRow, outcome, run_report};
use super::timeline::{ink_of, symbol_of};
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::text::fitted;
use crate::explorer::theme::Meaning;
use crate::explorer::timeline::selected;
use asperity_contact::{Event, Events};
use asperity_data::{counted, format_range, format_rounded, grouped};
use asperity_report::{EventsReport, event_words, jumps_of_instrument, signed_energy};
use ratatui::layout::Size;
use ratatui::text::{Line, Span};

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, panel| (force::ROW.figure)(app, panel),
    report,
    help: &[(
        "Events",
        "key e: the jumps of the loading with at least 1 % of the largest energy, and its marks. A positive energy is \
         gained by springs, a negative one released. With the pane selected, ↑ ↓ or a click move the animation to an \
         event; + lists smaller jumps as well, from 0.1 % or all, - only those from 10 %",
    )],
    ..PaneRow::EMPTY
};

/// Returns the events of the scene, and the command that lists them. Under manual loading, returns
/// the path.
fn report(app: &App) -> Exported<'_> {
    if app.edit.path.is_some() {
        return outcome(app);
    }
    let events = app.listed_events()?.ok()?;
    let report = EventsReport {
        run: run_report(app)?,
        events,
        least_share: app.listed_share().value(),
    };
    let command = format!("asperity run --events={}", app.listed_share().argument());
    Some((command.into(), Box::new(report)))
}

/// Width in columns from which a row also states the energy of a jump. Narrower rows have only room
/// for what happens.
const WITH_ENERGY: u16 = 36;

/// Texts of a row of the list.
struct EventRow {
    /// Indentation, or the time if the body relaxes.
    place: String,
    mark: char,
    words: String,
    /// Energy that the springs gain (positive) or release, in J.
    energy: Option<f64>,
    forces: String,
}

impl EventRow {
    fn new(event: &Event) -> Self {
        EventRow {
            place: match event.seconds {
                Some(seconds) => format_rounded(seconds, 3, "s"),
                None => format_rounded(event.indentation, 3, "m"),
            },
            mark: event.mark.map_or(' ', symbol_of),
            words: event_words(event),
            energy: match (event.jump, event.instrument) {
                (Some(jump), _) => Some(jump.energy),
                (None, Some(jump)) => Some(-jump.energy),
                (None, None) => None,
            },
            forces: match event.forces {
                [before, after] if before == after => format_rounded(before, 3, "N"),
                [before, after] => format_range((before, after), 3, "N"),
            },
        }
    }

    fn energy_in_words(&self) -> String {
        self.energy.map_or_else(String::new, signed_energy)
    }
}

/// Widths of the columns of the list.
struct Columns {
    place: usize,
    /// `None` if the rows state no energies.
    energy: Option<usize>,
    /// `None` if the rows state no forces.
    forces: Option<usize>,
}

impl Columns {
    /// Returns the columns of rows of this width. Forces are stated only if the words have room
    /// beside them.
    fn new(rows: &[EventRow], width: u16) -> Self {
        let widest = |text: fn(&EventRow) -> usize| rows.iter().map(text).max().unwrap_or(0);
        let place = widest(|row| row.place.chars().count());
        let energy = widest(|row| row.energy_in_words().chars().count());
        let forces = widest(|row| row.forces.chars().count());
        let words = widest(|row| row.words.chars().count());
        let with_all = BESIDE_WORDS + place + words + energy + BEFORE_FORCES.len() + forces;
        Columns {
            place,
            energy: (width >= WITH_ENERGY).then_some(energy),
            forces: (with_all <= usize::from(width)).then_some(forces),
        }
    }
}

/// Columns of a row beside its texts: the sign of the selected row, blanks and the mark.
const BESIDE_WORDS: usize = 5;
/// Text before the forces.
const BEFORE_FORCES: &str = "  F ";

fn panel(app: &App, size: Size) -> Panel {
    let title = format!("Events · {}", app.listed_share().in_words());
    let listed = match app.listed_events() {
        None => return Panel::of_text(title, "listing the jumps…"),
        Some(Err(why)) => return Panel::of_text(title, why),
        Some(Ok(listed)) => listed,
    };
    if listed.list.is_empty() {
        return Panel::of_text(
            title,
            "nothing happens at once: no jump and no mark on this loading",
        );
    }
    let selected = selected(app.played_stages(), &listed.list, app.playhead());
    let texts: Vec<EventRow> = listed.list.iter().map(EventRow::new).collect();
    let columns = Columns::new(&texts, size.width);
    let mut rows = Vec::new();
    for (index, row) in texts.iter().enumerate() {
        rows.push(line_of(
            app,
            row,
            &columns,
            selected == Some(index),
            size.width,
        ));
    }
    let mut panel = Panel::of_text(title, "");
    panel.edge = vec![vec![Span::raw(count_in_words(listed))]];
    panel.body = Body::Rows {
        rows,
        selected: selected.unwrap_or(0),
    };
    panel
}

/// Returns how many of all jumps are listed.
fn count_in_words(listed: &Events) -> String {
    if listed.list.iter().any(|event| event.seconds.is_some()) {
        return "marks only".to_owned();
    }
    let all = format!(
        "{}{}",
        counted(listed.jumps as u64, "jump"),
        jumps_of_instrument(listed)
    );
    if listed.listed_jumps == listed.jumps {
        return all;
    }
    format!("{} of {all}", grouped(listed.listed_jumps as u64))
}

/// Returns a row of the list. Words that are too long are shortened.
fn line_of(
    app: &App,
    row: &EventRow,
    columns: &Columns,
    is_selected: bool,
    width: u16,
) -> Line<'static> {
    let sign = if is_selected { "›" } else { " " };
    let mut line = Line::from(vec![
        Span::raw(sign),
        Span::raw(format!("{:>1$} {2} ", row.place, columns.place, row.mark)),
        Span::raw(row.words.clone()),
    ]);
    let mut right = String::new();
    if let Some(energy) = columns.energy {
        right = format!("{:>energy$}", row.energy_in_words());
    }
    if let Some(forces) = columns.forces {
        right = format!("{right}{BEFORE_FORCES}{:forces$}", row.forces);
    }
    let room = usize::from(width).saturating_sub(right.chars().count() + 1);
    line = fitted(line, room as u16);
    let blanks =
        " ".repeat(usize::from(width).saturating_sub(line.width() + right.chars().count()));
    line.push_span(Span::raw(blanks));
    let style = match row.energy {
        Some(energy) => app.view.appearance.palette().ink(ink_of(energy > 0.0)),
        None => app.style(Meaning::Text),
    };
    line.push_span(Span::styled(right, style));
    if is_selected {
        line = line.style(app.style(Meaning::Selected));
    }
    line
}
