//! The lines above and below the panes: title, status, footer.

use crate::explorer::action::EXPORTS;
use crate::explorer::app::{App, Message};
use crate::explorer::commands::accuracy::Choosing;
use crate::explorer::commands::table::footer as footer_keys;
use crate::explorer::commands::target;
use crate::explorer::keys::bindings::Row;
use crate::explorer::measured;
use crate::explorer::measured::Fitting;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text::{filled, wrapped_within};
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::typed;
use asperity_data::{format_quantity, format_range, format_rounded, grouped};
use asperity_experiment::FitResult;
use asperity_report::square_loops_words;
use asperity_scene::Estimate;
use asperity_study::half_space::SquareLoops;
use asperity_study::{Ensemble, Quantity};
use ratatui::text::{Line, Span};
use std::path::is_separator;

/// Title lines: name of the scene, a sign for unsaved changes, and the notice, which may no longer
/// hold for a changed scene.
pub fn title(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    let (scene, theme) = (app.edit.document.scene(), app.view.appearance.theme);
    let has_title = !scene.title.is_empty() && !app.edit.document.is_changed_built_in();
    let name = if has_title {
        &scene.title
    } else {
        app.edit.document.name()
    };
    let mut spans = vec![Span::styled(name.to_owned(), theme.style(Meaning::Title))];
    let saved = app
        .edit
        .saved
        .get(app.edit.document.name())
        .map(|saved| &saved.scene().notice);
    if app.edit.is_unsaved() {
        spans.push(Span::styled(" [changed]", theme.style(Meaning::Title)));
    }
    if !app.edit.is_unsaved() || saved != Some(&scene.notice) {
        let notice = scene
            .notice
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        spans.push(Span::styled(
            format!("  {notice}"),
            theme.style(Meaning::Quiet),
        ));
    }
    wrapped_within(&Line::from(spans), width, rows)
}

/// Status lines: the headline figures, a question, an error, or the typed text, in at most this
/// number of rows.
pub fn status(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    let theme = app.view.appearance.theme;
    let error = |text: String| Line::styled(text, theme.style(Meaning::Error));
    let refusal = |why: &str, rows| {
        wrapped_within(
            &error(format!("! {}", why.replace('\n', " · "))),
            width,
            rows,
        )
    };
    let line = match (
        app.prompt.as_ref().map(|prompt| (prompt, &prompt.purpose)),
        &app.message,
    ) {
        (Some((prompt, purpose)), _)
            if prompt.refused.is_some() || prompt.line.left_out().is_some() =>
        {
            let why = prompt
                .refused
                .as_deref()
                .or(prompt.line.left_out())
                .unwrap_or_default();
            // A value is typed in its row of the parameters.
            let typed = (rows > 1 && !matches!(purpose, Purpose::Value))
                .then(|| prompted(app, prompt, width));
            let mut lines = refusal(why, rows - u16::from(typed.is_some()));
            lines.extend(typed);
            return lines;
        }
        (Some((_, Purpose::Overwrite(file))), _) => {
            error(format!("{} exists. Overwrite it?", file.path.display()))
        }
        (Some((_, Purpose::Leave)), _) => error(match app.edit.unsaved()[..] {
            [] | [_] => "The scene has unsaved changes. Leave?".to_owned(),
            ref several => {
                let names: Vec<&str> = several.iter().map(|document| document.name()).collect();
                format!(
                    "{} scenes have unsaved changes: {}. Leave?",
                    several.len(),
                    names.join(", ")
                )
            }
        }),
        (Some((prompt, purpose)), _)
            if !matches!(
                purpose,
                Purpose::Value
                    | Purpose::Topics {
                        is_typed: false,
                        ..
                    }
            ) =>
        {
            let mut lines = vec![prompted(app, prompt, width)];
            let answer =
                target::answer(app).map(|answer| Line::styled(answer, theme.style(Meaning::Title)));
            lines.extend(
                answer
                    .into_iter()
                    .flat_map(|answer| wrapped_within(&answer, width, rows - 1)),
            );
            return lines;
        }
        (_, Some(Message::Error(why) | Message::Refused(why))) => return refusal(why, rows),
        (_, Some(Message::Done(text))) if Span::raw(text.as_str()).width() + 2 > width.into() => {
            return wrapped_within(&Line::raw(text.clone()), width, rows);
        }
        (_, Some(Message::Done(text))) => {
            let mut line = Line::raw(format!("{text}  "));
            line.extend(headline(
                app,
                usize::from(width).saturating_sub(line.width()),
            ));
            line
        }
        (None, None) => searching(app).map_or_else(|| headline(app, width.into()), Line::raw),
        _ => headline(app, width.into()),
    };
    vec![line]
}

/// A line being typed, after its label and before what it will be read as.
fn prompted(app: &App, prompt: &Prompt, width: u16) -> Line<'static> {
    let theme = app.view.appearance.theme;
    let label = Span::raw(label(app, prompt, width));
    let reading = typed::reading(app).map_or_else(String::new, |reading| format!("→ {reading}"));
    let reading = Span::styled(reading, theme.style(Meaning::Title));
    let room = usize::from(width).saturating_sub(label.width() + reading.width());
    Line::from_iter(
        [label]
            .into_iter()
            .chain(prompt.line.spans(room, theme))
            .chain([reading]),
    )
}

/// Label of a prompt; shortened if the typed text would otherwise be out of sight.
fn label(app: &App, prompt: &Prompt, width: u16) -> String {
    let is_narrow = width < 60;
    match &prompt.purpose {
        Purpose::Value | Purpose::Overwrite(_) | Purpose::Leave => String::new(),
        Purpose::Target if is_narrow => "For: ".to_owned(),
        Purpose::Target => format!("Find {} for: ", target::name(app)),
        Purpose::Force => format!("Go to the force ({}): ", typed::unit_of_force(app)),
        Purpose::Tolerance if is_narrow => "Tolerance: ".to_owned(),
        Purpose::Tolerance => "Relative error allowed (0.1 % or 1e-3): ".to_owned(),
        Purpose::Fit => "Parameters to fit: ".to_owned(),
        Purpose::Save { .. } => "Save as: ".to_owned(),
        Purpose::Export if is_narrow => "Export to: ".to_owned(),
        Purpose::Export => {
            let extensions = EXPORTS.map(|format| format!(".{}", format.extension()));
            format!("Export to ({}): ", extensions.join(" "))
        }
        Purpose::Scene(_) => "Search: ".to_owned(),
        Purpose::Parameter { .. } | Purpose::Topics { .. } => "Find: ".to_owned(),
    }
}

/// Smallest width, columns, of a status line with the error of F_a, and of one that has random
/// profiles too.
const WITH_ERROR: usize = 48;
const WITH_BOTH: usize = 100;

/// As many facts about the loop as there is room for.
fn headline(app: &App, width: usize) -> Line<'static> {
    if app.solved.is_none() {
        return Line::raw("computing…");
    }
    let theme = app.view.appearance.theme;
    let line = |is_short: bool| {
        let short = |text: String| {
            if is_short {
                text.replace("pressure-", "")
            } else {
                text
            }
        };
        let facts = facts(app, width).into_iter();
        let part = |(text, meaning)| vec![Span::styled(short(text), theme.style(meaning))];
        filled(facts.map(part).collect(), " · ", width)
            .into_iter()
            .next()
            .unwrap_or_default()
    };
    // Short names of regimes leave room for further facts.
    let (full, short) = (line(false), line(true));
    if short.spans.len() > full.spans.len() {
        short
    } else {
        full
    }
}

/// Facts about the loop for a line of this width, the most important first.
fn facts(app: &App, width: usize) -> Vec<(String, Meaning)> {
    let is_wide = width >= WITH_ERROR;
    let Some(outcome) = app.solved.as_ref().map(|solved| &solved.outcome) else {
        return Vec::new();
    };
    let figures = &outcome.figures;
    let regime = outcome.regime.map(|regime| {
        (
            regime.by_protocols(outcome.regime_after_zero_force),
            Meaning::Title,
        )
    });
    let force = |value| format_quantity(value, "N");
    let error = error(app).filter(|_| is_wide);
    let mut facts = Vec::new();
    if let Some(tried) = app.tried_outcome().filter(|_| app.is_typing_value()) {
        let shown = match tried.figures.adhesion_force {
            _ if !app.is_tried() => "computing…".to_owned(),
            None => "F_a none".to_owned(),
            Some(adhesion) => format!("F_a {}", app.force_in_words(adhesion)),
        };
        facts.push((format!("preview: {shown}"), Meaning::Title));
        facts.push(("Enter accepts".to_owned(), Meaning::Quiet));
    }
    if app.is_computing() {
        let (stage, stages) = (
            app.progress.unwrap_or(0) + 1,
            app.edit.document.scene().loading.len(),
        );
        facts.push((
            format!("computing, stage {stage} of {stages}"),
            Meaning::Quiet,
        ));
    }
    facts.extend(app.view.squares.then(|| squares(app, width)));
    if let Some(adhesion) = figures.adhesion_force.filter(|force| *force != 0.0) {
        let is_fixed = Ensemble::profiles_of(app.edit.document.scene()) == 1;
        let profiles = profiles(app, is_wide);
        let this = if profiles.is_some() {
            "this profile"
        } else {
            "F_a"
        };
        let fixed = if is_fixed && is_wide {
            ", fixed profile"
        } else {
            ""
        };
        let error = error.filter(|_| profiles.is_none() || width >= WITH_BOTH);
        let error = error.map_or_else(String::new, |error| format!(", {error}"));
        facts.extend(profiles);
        facts.push((
            format!("{this} {}{error}{fixed}", app.force_in_words(adhesion)),
            Meaning::Text,
        ));
    } else if let Some(largest) = figures.preload.filter(|force| *force != 0.0) {
        // Without tensile force.
        let error = error.map_or_else(String::new, |error| format!(", {error}"));
        facts.push((format!("F_max {}{error}", force(largest)), Meaning::Title));
    }
    if let Some(measured) = &app.edit.measured {
        let misfit = |fit: &FitResult| format!("misfit {}", format_rounded(fit.misfit, 3, "1"));
        let state = match measured::failure(&app.studies) {
            Some(why) => why.to_owned(),
            None => measured::fitted(&app.studies).map_or_else(|| "misfit …".to_owned(), misfit),
        };
        facts.push((format!("{}: {state}", measured.name), Meaning::Title));
    }
    add_warning(&mut facts, &app.warnings(), width);
    facts.extend(regime);
    let share = app
        .median_share_in_words()
        .or_else(|| app.adhesion_share_in_words());
    facts.extend(share.map(|share| (share, Meaning::Title)));
    if let Some(coefficient) = figures.adhesion_coefficient {
        facts.push((
            format!("F_a/F_n {}", format_quantity(coefficient, "1")),
            Meaning::Title,
        ));
    }
    if let Some(energy) = figures.dissipated_energy.filter(|_| app.snapshot.is_some()) {
        facts.push((
            format!("ΔW {}", format_rounded(energy, 2, "J")),
            Meaning::Text,
        ));
    }
    facts
}

/// Smallest width, columns, in which the beginning of a warning can be understood.
const LEAST_WARNING: usize = 30;

/// Adds the number of warnings and the first of them, as far as there is room; without room, the
/// number alone after the first fact.
fn add_warning(facts: &mut Vec<(String, Meaning)>, warnings: &[String], width: usize) {
    let Some(first) = warnings.first() else {
        return;
    };
    let before: usize = facts
        .iter()
        .map(|(text, _)| text.chars().count() + " · ".len())
        .sum();
    let room = width.saturating_sub(before);
    let count = warnings.len();
    let text = if count == 1 {
        format!("! {first}")
    } else {
        format!("! 1 of {count} (A): {first}")
    };
    if text.chars().count() <= room {
        facts.push((text, Meaning::Error));
    } else if room >= LEAST_WARNING {
        let beginning: String = text.chars().take(room - 1).collect();
        facts.push((format!("{}…", beginning.trim_end()), Meaning::Error));
    } else {
        let number = if count == 1 {
            "! 1 warning (A)".to_owned()
        } else {
            format!("! {count} warnings (A)")
        };
        facts.insert(facts.len().min(1), (number, Meaning::Error));
    }
}

/// What is known of the loops of random squares in three dimensions, and their difference from the
/// line.
fn squares(app: &App, width: usize) -> (String, Meaning) {
    match app.studies.failure::<SquareLoops>() {
        // The reason is whole where there is room, and its beginning elsewhere.
        Some(why) => (
            format!("three dimensions: {why}")
                .chars()
                .take(width)
                .collect(),
            Meaning::Error,
        ),
        None => {
            let (loops, is_adhesive) = (app.studies.value(), app.edit.scene.adhesion.is_some());
            (
                square_loops_words(loops.unwrap_or(&SquareLoops::default()), is_adhesive),
                Meaning::Title,
            )
        }
    }
}

/// Median and quartiles of the adhesion force over the random profiles computed so far, and with
/// room their number.
fn profiles(app: &App, is_wide: bool) -> Option<(String, Meaning)> {
    let ensemble = app.studies.value::<Ensemble>()?;
    let is_share = app.is_normalised();
    let quantity = if is_share {
        Quantity::AdhesionShare
    } else {
        Quantity::AdhesionForce
    };
    let [lower, median, upper] = ensemble.statistics(quantity)?.quartiles;
    let unit = if is_share { "1" } else { "N" };
    let (median, quartiles) = (
        format_rounded(median, 3, unit),
        format_range((lower, upper), 2, unit),
    );
    let count = match (ensemble.computed(), ensemble.profiles()) {
        _ if !is_wide => String::new(),
        (computed, all) if computed < all => format!(", {computed} of {all} profiles"),
        (_, all) => format!(", {all} profiles"),
    };
    let symbol = if is_share { "F_a/F_a,max" } else { "F_a" };
    Some((
        format!("{symbol} median {median} ({quartiles}{count})"),
        Meaning::Title,
    ))
}

/// Estimated error of the headline figure in words: `…` while it is awaited, `None` without an
/// estimate.
fn error(app: &App) -> Option<String> {
    match app.studies.value::<Estimate>() {
        Some(estimate) => Some(estimate.words()),
        None if app.studies.failure::<Estimate>().is_none() => {
            app.view.shows_times.then(|| "± …".to_owned())
        }
        None => {
            let pulls = app
                .solved
                .as_ref()?
                .outcome
                .figures
                .adhesion_force
                .is_some();
            pulls.then(|| "error unknown".to_owned())
        }
    }
}

/// Progress of the search of springs for a tolerance, or of parameters for the measured curve;
/// `None` without a search.
fn searching(app: &App) -> Option<String> {
    if let Some(Choosing {
        tolerance, tried, ..
    }) = app.studies.value()
    {
        let tried = tried.map_or_else(String::new, |points| {
            format!(": {} springs", grouped(points))
        });
        return Some(format!("trying for {tolerance:e}{tried}…"));
    }
    let Fitting { evaluations, .. } = app.studies.value()?;
    Some(format!(
        "fitting, {} curves computed…",
        grouped(*evaluations)
    ))
}

/// The valid keys, as a line.
pub fn footer(app: &App, width: u16) -> Line<'static> {
    let theme = app.view.appearance.theme;
    if let Some(note) = app.view.demo {
        return Line::styled(note, theme.style(Meaning::Quiet));
    }
    if let Some(prompt) = app
        .prompt
        .as_ref()
        .filter(|prompt| !prompt.paths.is_empty())
    {
        return candidates(&prompt.paths, width, theme);
    }
    let item = |(keys, row): (String, &Row)| {
        vec![
            Span::styled(keys, theme.style(Meaning::Key)),
            Span::raw(format!(" {}", row.label)),
        ]
    };
    let items = footer_keys(app).into_iter().map(item).collect();
    filled(items, "  ", width.into())
        .into_iter()
        .next()
        .unwrap_or_default()
}

/// Names of paths, without their folders, as a line.
fn candidates(paths: &[String], width: u16, theme: Theme) -> Line<'static> {
    let name = |path: &String| {
        let from = path
            .trim_end_matches(is_separator)
            .rfind(is_separator)
            .map_or(0, |at| at + 1);
        vec![Span::styled(
            path[from..].to_owned(),
            theme.style(Meaning::Quiet),
        )]
    };
    filled(paths.iter().map(name).collect(), "  ", width.into())
        .into_iter()
        .next()
        .unwrap_or_default()
}
