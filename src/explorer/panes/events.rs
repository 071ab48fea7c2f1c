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
/// Width in columns from which a row also states the forces.
const WITH_FORCES: u16 = 56;
/// Width of the columns of indentation, or of the time if the body relaxes, and energy.
const NUMBER_COLUMNS: usize = 9;

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
    let mut rows = Vec::new();
    for (index, event) in listed.list.iter().enumerate() {
        rows.push(row(app, event, selected == Some(index), size.width));
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

fn row(app: &App, event: &Event, is_selected: bool, width: u16) -> Line<'static> {
    let mark = event.mark.map_or(' ', symbol_of);
    let place = match event.seconds {
        Some(seconds) => format_rounded(seconds, 3, "s"),
        None => format_rounded(event.indentation, 3, "m"),
    };
    let mut line = Line::from(vec![
        Span::raw(if is_selected { "›" } else { " " }),
        Span::raw(format!("{place:>NUMBER_COLUMNS$} {mark} ")),
        Span::raw(event_words(event)),
    ]);
    let energy = match (event.jump, event.instrument) {
        (Some(jump), _) => Some(jump.energy),
        (None, Some(jump)) => Some(-jump.energy),
        (None, None) => None,
    };
    let energy_text = energy.map_or_else(String::new, signed_energy);
    let mut right = if width >= WITH_ENERGY {
        format!("{energy_text:>NUMBER_COLUMNS$}")
    } else {
        String::new()
    };
    if width >= WITH_FORCES {
        let forces = match event.forces {
            [before, after] if before == after => format_rounded(before, 3, "N"),
            [before, after] => format_range((before, after), 3, "N"),
        };
        right = format!("{right}  F {forces}");
    }
    let room = usize::from(width).saturating_sub(right.chars().count() + 1);
    line = fitted(line, room as u16);
    let blanks =
        " ".repeat(usize::from(width).saturating_sub(line.width() + right.chars().count()));
    line.push_span(Span::raw(blanks));
    let style = match energy {
        Some(energy) => app.view.appearance.palette().ink(ink_of(energy > 0.0)),
        None => app.style(Meaning::Text),
    };
    line.push_span(Span::styled(right, style));
    if is_selected {
        line = line.style(app.style(Meaning::Selected));
    }
    line
}
