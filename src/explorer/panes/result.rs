//! The pane of the main results: the pull-off forces of the random profiles as a strip, and the
//! results in one line each. In a small pane, the last lines are left out.

use super::force;
use super::row::{PaneRow, outcome};
use super::trust;
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::shown_ensemble::ShownEnsemble;
use crate::explorer::text::{fitted, range_in_words};
use crate::explorer::theme::Meaning;
use asperity_data::{counted, format_rounded, grouped};
use asperity_report::{SPECTRUM_NOT_COMPUTED, percent, theories_briefly};
use asperity_scene::Outcome;
use asperity_study::{Ensemble, Quantity};
use ratatui::layout::Size;
use ratatui::text::{Line, Span};

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, panel| (force::ROW.figure)(app, panel),
    report: outcome,
    help: &[(
        "Result",
        "pull-off force of each random profile, ● on a linear axis from zero, ◆ this profile; │ is the median. Below it \
         medians and quartiles over the profiles, and which theories say that the bodies adhere without a preload \
         (details: key A); key e shows the events instead",
    )],
    ..PaneRow::EMPTY
};

/// Number of rows of the strip of pull-off forces.
const STRIP_ROWS: usize = 2;
/// Smallest height in rows of a pane with the strip.
const WITH_STRIP: u16 = 6;

/// A result: its name, its value, and its range over the profiles, which may be empty.
struct ResultLine {
    name: &'static str,
    value: String,
    range: String,
}

fn panel(app: &App, size: Size) -> Panel {
    // Under manual loading, the body follows another loading than the one with these results.
    let title = if app.edit.path.is_some() {
        "Result of the scene's loop"
    } else {
        "Result"
    };
    let Some(outcome) = app.outcome() else {
        return Panel::of_text(title.to_owned(), "computing…");
    };
    let shown = app.shown_ensemble();
    let ensemble = shown.as_ref().map(|shown| shown.ensemble);
    let mut lines = Vec::new();
    if size.height >= WITH_STRIP {
        lines.extend(match &shown {
            Some(shown) => strip(app, outcome, shown, size.width.into()),
            // The lines below stay in their places when the strip appears.
            None if app.awaits_profiles() => vec![Line::default(); STRIP_ROWS + 1],
            None => Vec::new(),
        });
    }
    for result in results(app, outcome, ensemble) {
        lines.push(line_of_result(app, &result, size.width));
    }
    let mut panel = Panel::of_text(title.to_owned(), "");
    panel.edge = edge(shown.as_ref());
    panel.body = Body::Lines(lines);
    panel
}

/// Returns the number of profiles that are computed, or that were computed before the last change.
fn edge(shown: Option<&ShownEnsemble>) -> Vec<Vec<Span<'static>>> {
    let Some(shown) = shown else {
        return Vec::new();
    };
    let ensemble = shown.ensemble;
    let all = counted(ensemble.profiles(), "profile");
    let text = if shown.is_former {
        format!("{all} before the change")
    } else if ensemble.computed() < ensemble.profiles() {
        format!("{} of {all}", grouped(ensemble.computed()))
    } else {
        all
    };
    vec![vec![Span::raw(text)]]
}

/// Returns the pull-off forces of the random profiles as a strip with its axis: a point for each
/// profile, stacked where several are in one column. The force of the shown profile is not among
/// the results before a change.
fn strip(app: &App, outcome: &Outcome, shown: &ShownEnsemble, width: usize) -> Vec<Line<'static>> {
    let ensemble = shown.ensemble;
    let forces: Vec<f64> = ensemble
        .values(Quantity::PullOffForce)
        .into_iter()
        .flatten()
        .collect();
    let Some(statistics) = ensemble.statistics(Quantity::PullOffForce) else {
        return Vec::new();
    };
    let present = outcome.figures.pull_off_force.filter(|_| !shown.is_former);
    let largest = forces.iter().copied().chain(present).fold(0.0, f64::max);
    if largest <= 0.0 || width < 12 {
        return Vec::new();
    }
    let [lower, median, upper] = statistics.quartiles;
    let last = (width - 1) as f64;
    let column_of = |force: f64| ((force / largest).clamp(0.0, 1.0) * last).round() as usize;
    let mut rows = vec![vec![' '; width]; STRIP_ROWS];
    for row in &mut rows {
        row[column_of(median)] = '│';
    }
    let mut counts = vec![0; width];
    for &force in &forces {
        let column = column_of(force);
        if counts[column] < STRIP_ROWS {
            rows[counts[column]][column] = '●';
        }
        counts[column] += 1;
    }
    if let Some(force) = present {
        rows[0][column_of(force)] = '◆';
    }
    let mut lines = Vec::new();
    for row in rows.iter().rev() {
        let mut spans = Vec::new();
        for &symbol in row {
            let style = match symbol {
                '◆' => app.style(Meaning::Cursor),
                '│' => app.style(Meaning::Quiet),
                _ => app.style(Meaning::Text),
            };
            spans.push(Span::styled(symbol.to_string(), style));
        }
        lines.push(Line::from(spans));
    }
    lines.push(axis(app, [lower, median, upper, largest], width, column_of));
    lines
}

/// Returns the axis of the strip: a line with zero, the quartiles and the largest force, each at
/// its place if there is room.
fn axis(
    app: &App,
    forces: [f64; 4],
    width: usize,
    column_of: impl Fn(f64) -> usize,
) -> Line<'static> {
    let [lower, median, upper, largest] = forces;
    let mut cells = vec!['─'; width];
    cells[0] = '0';
    let zero = 0..2;
    let mut taken = Vec::from([zero]);
    for force in [largest, median, upper, lower] {
        let text = format_rounded(force, 3, "N");
        let length = text.chars().count();
        if length > width {
            continue;
        }
        let middle = column_of(force);
        let first = middle.saturating_sub(length / 2).min(width - length);
        let place = first..first + length;
        let is_free = taken
            .iter()
            .all(|other| place.end < other.start || other.end < place.start);
        if !is_free {
            continue;
        }
        for (column, symbol) in place.clone().zip(text.chars()) {
            cells[column] = symbol;
        }
        taken.push(place);
    }
    let text: String = cells.into_iter().collect();
    Line::styled(text, app.style(Meaning::Quiet))
}

/// Returns the results, the most important first.
fn results(app: &App, outcome: &Outcome, ensemble: Option<&Ensemble>) -> Vec<ResultLine> {
    let mut results = Vec::new();
    let figures = &outcome.figures;
    let share = figures
        .pull_off_force
        .zip(app.ideal_pull_off_force())
        .map(|(force, ideal)| force / ideal);
    let rows = [
        ("F_a", Quantity::PullOffForce, figures.pull_off_force, "N"),
        ("F_a/F_a,max", Quantity::AdhesionShare, share, "%"),
        (
            "dissipated",
            Quantity::DissipatedEnergy,
            figures.dissipated_energy,
            "J",
        ),
    ];
    for (name, quantity, present, unit) in rows {
        let statistics = ensemble.and_then(|ensemble| ensemble.statistics(quantity));
        if let Some(statistics) = statistics {
            let [lower, median, upper] = statistics.quartiles;
            results.push(ResultLine {
                name,
                value: in_unit(median, unit),
                range: range_in_unit(lower, upper, unit),
            });
        } else if let Some(value) = present {
            results.push(ResultLine {
                name,
                value: in_unit(value, unit),
                range: String::new(),
            });
        }
    }
    if let Some(regime) = outcome.regime {
        results.push(ResultLine {
            name: "regime",
            value: regime
                .by_protocols(outcome.regime_after_zero_force)
                .replace("pressure-", ""),
            range: String::new(),
        });
    }
    if let Some(computed) = app.current()
        && let Some(largest) = largest_error(&trust::errors(app, computed, ensemble))
    {
        results.push(ResultLine {
            name: "error",
            value: largest,
            range: String::new(),
        });
    }
    let warnings = app.warnings().len() as u64;
    if warnings > 0 {
        results.push(ResultLine {
            name: "warnings",
            value: format!("{} (key A)", counted(warnings, "premise")),
            range: String::new(),
        });
    }
    if let Some(computed) = app.current()
        && let Some(verdicts) = theories_briefly(&computed.scene, &computed.outcome)
    {
        results.push(ResultLine {
            name: "theories",
            value: verdicts,
            range: String::new(),
        });
    }
    results
}

/// Returns the source of the largest error and the error in words. `rows` are the errors from all
/// sources; the last row names the source of the largest one. As long as the error of a measured
/// surface is not computed, which may be larger, the text says so.
fn largest_error(rows: &[(&str, String)]) -> Option<String> {
    let ((_, largest), sources) = rows.split_last()?;
    let source = largest.split(':').next().unwrap_or(largest);
    let words = sources.iter().find(|(name, _)| *name == source);
    let text = match words {
        Some((_, words)) => {
            // The number of profiles is in the title of the pane.
            let (error, _) = words
                .split_once(" of the median")
                .or_else(|| words.split_once(", by "))
                .unwrap_or((words, ""));
            format!("{source} {error}")
        }
        None => largest.clone(),
    };
    let not_computed = ("surface", SPECTRUM_NOT_COMPUTED.to_owned());
    Some(if sources.contains(&not_computed) {
        format!("{text}, surface not known")
    } else {
        text
    })
}

fn in_unit(value: f64, unit: &str) -> String {
    if unit == "%" {
        percent(value, 3)
    } else {
        format_rounded(value, 3, unit)
    }
}

fn range_in_unit(low: f64, high: f64, unit: &str) -> String {
    if unit == "%" {
        range_in_words((100.0 * low, 100.0 * high), "1")
    } else {
        range_in_words((low, high), unit)
    }
}

/// Shorter wordings of results, in the order in which they are used.
const SHORTER: [[&str; 2]; 10] = [
    [": a premise does not hold", ": see the premises"],
    ["sample of profiles", "sample"],
    ["not known", "unknown"],
    ["insensitive", "insens."],
    ["sensitive", "sens."],
    ["more than ", "> "],
    ["(d=0)", "d=0"],
    ["(F=0)", "F=0"],
    ["insens.", "ins."],
    ["non-adhesive", "non-adh."],
];

/// Returns a text with as few shorter wordings as it needs to fit into this width.
fn shortened(text: &str, width: usize) -> String {
    let mut text = text.to_owned();
    for [long, short] in SHORTER {
        if text.chars().count() <= width {
            break;
        }
        text = text.replace(long, short);
    }
    text
}

/// Number of columns of the names of results.
const NAME_COLUMNS: usize = 11;

fn line_of_result(app: &App, result: &ResultLine, width: u16) -> Line<'static> {
    let name = format!("{:NAME_COLUMNS$} ", result.name);
    let room = usize::from(width).saturating_sub(name.chars().count());
    let mut line = Line::from(vec![
        Span::styled(name, app.style(Meaning::Title)),
        Span::raw(shortened(&result.value, room)),
    ]);
    let taken = line.width() + result.range.chars().count() + 1;
    if !result.range.is_empty() && taken <= usize::from(width) {
        let blanks = usize::from(width) - taken + 1;
        line.push_span(Span::raw(" ".repeat(blanks)));
        line.push_span(Span::styled(
            result.range.clone(),
            app.style(Meaning::Quiet),
        ));
    }
    fitted(line, width)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of a value in a window of 80 columns.
    const ROOM: usize = 19;

    #[test]
    fn no_regime_is_cut_in_a_window_of_80_columns() {
        for (regime, short) in [
            ("sensitive (d=0, F=0)", "sens. (d=0, F=0)"),
            ("sensitive (d=0), insensitive (F=0)", "sens. d=0, ins. F=0"),
            ("insensitive (d=0), sensitive (F=0)", "ins. d=0, sens. F=0"),
        ] {
            assert_eq!(shortened(regime, ROOM), short);
        }
    }
}
