//! The lines above and below the panes: title, status, footer.

use crate::explorer::action::EXPORTS;
use crate::explorer::app::{App, Message};
use crate::explorer::commands::accuracy::Choosing;
use crate::explorer::commands::table::footer as footer_keys;
use crate::explorer::keys::bindings::Row;
use crate::explorer::measured;
use crate::explorer::measured::Fitting;
use crate::explorer::panes::preload_curve::PreloadCurve;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::text::{filled, wrapped_within};
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::typed;
use asperity_contact::CurvePoint;
use asperity_data::grouped;
use asperity_data::{format_quantity, format_range, format_rounded};
use asperity_experiment::Fit;
use asperity_scene::Estimate;
use asperity_scene::SteepWaves;
use asperity_study::{MeasuredAdhesion, Statistics};
use ratatui::text::{Line, Span};
use std::f64::consts::PI;
use std::path::is_separator;

/// Title lines: name of the scene, a sign for unsaved changes, and the notice, which may no longer hold for a changed scene.
pub fn title(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    let (scene, theme) = (app.edit.document.scene(), app.view.appearance.theme);
    let name = if scene.title.is_empty() { app.edit.document.name() } else { &scene.title };
    let mut spans = vec![Span::styled(name.to_owned(), theme.style(Meaning::Title))];
    let saved = app.edit.saved.get(app.edit.document.name()).map(|saved| &saved.scene().notice);
    if app.edit.is_unsaved() {
        spans.push(Span::styled(" [changed]", theme.style(Meaning::Title)));
    }
    if !app.edit.is_unsaved() || saved != Some(&scene.notice) {
        let notice = scene.notice.split_whitespace().collect::<Vec<_>>().join(" ");
        spans.push(Span::styled(format!("  {notice}"), theme.style(Meaning::Quiet)));
    }
    wrapped_within(&Line::from(spans), width, rows)
}

/// Status lines: the headline figures, a question, an error, or the typed text, in at most this number of rows.
pub fn status(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    let theme = app.view.appearance.theme;
    let error = |text: String| Line::styled(text, theme.style(Meaning::Error));
    let refusal =
        |why: &str, rows| wrapped_within(&error(format!("! {}", why.replace('\n', " · "))), width, rows);
    let line = match (app.prompt.as_ref().map(|prompt| (prompt, &prompt.purpose)), &app.message) {
        (Some((prompt, purpose)), _) if prompt.refused.is_some() || prompt.line.left_out().is_some() => {
            let why = prompt.refused.as_deref().or(prompt.line.left_out()).unwrap_or_default();
            // A value is typed in its row of the parameters.
            let typed =
                (rows > 1 && !matches!(purpose, Purpose::Value)).then(|| prompted(app, prompt, width));
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
                format!("{} scenes have unsaved changes: {}. Leave?", several.len(), names.join(", "))
            }
        }),
        (Some((prompt, purpose)), _)
            if !matches!(purpose, Purpose::Value | Purpose::Topics { is_typed: false, .. }) =>
        {
            prompted(app, prompt, width)
        }
        (_, Some(Message::Error(why) | Message::Refused(why))) => return refusal(why, rows),
        (_, Some(Message::Done(text))) if Span::raw(text.as_str()).width() + 2 > width.into() => {
            return wrapped_within(&Line::raw(text.clone()), width, rows);
        }
        (_, Some(Message::Done(text))) => {
            let mut line = Line::raw(format!("{text}  "));
            line.extend(headline(app, usize::from(width).saturating_sub(line.width())));
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
    Line::from_iter([label].into_iter().chain(prompt.line.spans(room, theme)).chain([reading]))
}

/// Label of a prompt; shortened if the typed text would otherwise be out of sight.
fn label(app: &App, prompt: &Prompt, width: u16) -> String {
    let is_narrow = width < 60;
    match &prompt.purpose {
        Purpose::Value | Purpose::Overwrite(_) | Purpose::Leave => String::new(),
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

/// Smallest width, columns, of a status line with the error of F_a and the kind of loading; and of one with the full names
/// of regimes.
const WITH_ERROR: usize = 48;
const WITH_NAMES: usize = 100;

/// A fact in the status line, about the whole loop or about the shown state.
struct Fact {
    is_of_loop: bool,
    text: String,
    meaning: Meaning,
}

/// As many facts as there is room for, the most important ones about loop and state.
fn headline(app: &App, width: usize) -> Line<'static> {
    if app.solved.is_none() {
        return Line::raw("computing…");
    }
    let theme = app.view.appearance.theme;
    let line = |facts: &[Fact]| {
        let mut line = Line::default();
        for is_of_loop in [true, false] {
            for (number, fact) in facts.iter().filter(|fact| fact.is_of_loop == is_of_loop).enumerate() {
                let apart = match (number, is_of_loop) {
                    (0, true) => "",
                    (0, false) => "  ◆ ",
                    _ => " · ",
                };
                line.push_span(Span::styled(apart, theme.style(Meaning::Quiet)));
                line.push_span(Span::styled(fact.text.clone(), theme.style(fact.meaning)));
            }
        }
        line
    };
    let (mut known, mut is_full) = (Vec::new(), [false; 2]);
    for fact in facts(app, width) {
        let group = usize::from(fact.is_of_loop);
        known.push(fact);
        is_full[group] |= line(&known).width() > width;
        if is_full[group] {
            known.pop();
        }
    }
    line(&known)
}

/// Facts about loop and state for a line of this width, the most important first.
fn facts(app: &App, width: usize) -> Vec<Fact> {
    let is_wide = width >= WITH_ERROR;
    let Some(outcome) = app.solved.as_ref().map(|solved| &solved.outcome) else { return Vec::new() };
    let (figures, snapshot) = (&outcome.figures, app.present());
    let of_loop = |text: String, meaning| Fact { is_of_loop: true, text, meaning };
    let of_state = |text: String| Fact { is_of_loop: false, text, meaning: Meaning::Text };
    let mut regime = outcome.regime.map(|regime| {
        let regimes = regime.by_protocols(outcome.regime_after_zero_force);
        let regimes = if width < WITH_NAMES { regimes.replace("pressure-", "") } else { regimes };
        of_loop(regimes, Meaning::Title)
    });
    let force = |value| format_quantity(value, "N");
    let error = error(app).filter(|_| is_wide).map_or_else(String::new, |error| format!(" ({error})"));
    let mut facts = Vec::new();
    if let Some(tried) = app.tried_outcome().filter(|_| app.is_typing_value()) {
        let shown = match tried.figures.adhesion_force {
            _ if !app.is_tried() => "computing…".to_owned(),
            None => "F_a none".to_owned(),
            Some(adhesion) => format!("F_a {}", force(adhesion)),
        };
        facts.push(of_loop(format!("preview: {shown}"), Meaning::Title));
        facts.push(of_loop("Enter accepts".to_owned(), Meaning::Quiet));
    }
    if app.is_computing() {
        let (stage, stages) = (app.progress.unwrap_or(0) + 1, app.edit.document.scene().loading.len());
        facts.push(of_loop(format!("computing, stage {stage} of {stages}"), Meaning::Quiet));
    }
    if let Some(adhesion) = figures.adhesion_force.filter(|force| *force != 0.0) {
        let profiles = profiles(app).filter(|_| is_wide);
        let whose = if profiles.is_some() { " of this profile" } else { "" };
        facts.push(of_loop(format!("F_a{whose} {}{error}", force(adhesion)), Meaning::Title));
        facts.extend(profiles.map(|Statistics { count, quartiles: [lower, median, upper], .. }| {
            let (median, quartiles) = (format_rounded(median, 2, "N"), format_range((lower, upper), 2, "N"));
            of_loop(format!("{count} profiles: median {median} ({quartiles})"), Meaning::Title)
        }));
        facts.extend(regime.take_if(|_| app.manual.is_none()));
    } else if let Some(largest) = figures.preload.filter(|force| *force != 0.0) {
        // Without tensile force.
        facts.push(of_loop(format!("F_max {}{error}", force(largest)), Meaning::Title));
    }
    if let Some(measured) = &app.edit.measured {
        let times = |fit: &Fit| format!("{} × noise", format_quantity(fit.residual_over_noise, "1"));
        let residual = match measured::failure(&app.studies) {
            Some(why) => why.to_owned(),
            None => measured::fitted(&app.studies).map_or_else(|| "…".to_owned(), times),
        };
        facts.push(of_loop(format!("{}: residual {residual}", measured.name), Meaning::Title));
    }
    let mut share = None;
    if let Some(snapshot) = snapshot {
        let CurvePoint { indentation, force: pressing, contact_length, .. } = snapshot.point;
        let title = if is_wide && app.manual.is_some() { "manual: " } else { "" };
        let place = format!(
            "{title}d {} F {}",
            format_quantity(indentation, "m"),
            force(app.without_rounding(pressing))
        );
        facts.push(of_state(place));
        if let Some(state) = &app.manual {
            facts.push(of_state(format!("{} changed", counted(state.changed, "spring"))));
            facts.push(of_state(format!("released {}", format_rounded(state.released_energy, 2, "J"))));
        } else {
            let percent = 100.0 * contact_length / outcome.line.length;
            share = Some(of_state(format!("contact {} %", format_rounded(percent, 2, "1"))));
        }
    }
    facts.extend(regime);
    facts.extend(share);
    if let Some(SteepWaves { ratio, jkr_factor }) = outcome.steep_waves {
        let least = SteepWaves::LEAST_RATIO;
        let warning = format!("λ²/AR {ratio:.2} < {least}: JKR pulls {jkr_factor:.2} × the smooth sphere");
        facts.push(of_loop(warning, Meaning::Error));
    }
    if let Some(coefficient) = figures.adhesion_coefficient {
        facts.push(of_loop(format!("F_a/F_n {}", format_quantity(coefficient, "1")), Meaning::Title));
    }
    if let Some(snapshot) = snapshot {
        facts.extend(response(app, snapshot).into_iter().map(of_state));
        if let Some(energy) = figures.dissipated_energy {
            facts.push(of_loop(format!("ΔW {}", format_rounded(energy, 2, "J")), Meaning::Text));
        }
        facts.push(of_state(contact(snapshot.point)));
    }
    facts
}

/// Statistics of the adhesion force over random profiles, if these are computed at the preload of the scene.
fn profiles(app: &App) -> Option<Statistics> {
    let preload = app.current()?.outcome.figures.preload;
    let at = |preload| app.studies.value::<PreloadCurve>()?.at(preload);
    let measured = || app.studies.value::<MeasuredAdhesion>()?.adhesion_force();
    preload.and_then(at).or_else(measured).filter(|forces| forces.count >= 2)
}

/// Stiffness E* l of the present contact with fixed edges (Popov and Filippov 2012, eq. (1)), and the mean pressure on a
/// circle of its radius, in words.
fn response(app: &App, snapshot: &ContactSnapshot) -> Vec<String> {
    let Some(computed) = &app.solved else { return Vec::new() };
    let stiffness = computed.outcome.governing.effective_modulus * snapshot.point.contact_length;
    let mut parts = vec![format!("E*l {}", format_rounded(stiffness, 2, "N/m"))];
    let radius = snapshot.contact_radius;
    if radius > 0.0 {
        let pressure = app.without_rounding(snapshot.point.force) / (PI * radius * radius);
        parts.push(format!("p_m {}", format_rounded(pressure, 2, "Pa")));
    }
    parts
}

/// Estimated error of the headline figure in words: `…` while it is awaited, `None` without an estimate.
fn error(app: &App) -> Option<String> {
    match app.studies.value::<Estimate>() {
        Some(estimate) => Some(estimate.words()),
        None if app.studies.failure::<Estimate>().is_none() => app.view.shows_times.then(|| "± …".to_owned()),
        None => {
            let pulls = app.solved.as_ref()?.outcome.figures.adhesion_force.is_some();
            pulls.then(|| "error unknown".to_owned())
        }
    }
}

/// Progress of the search of springs for a tolerance, or of parameters for the measured curve; `None` without a search.
fn searching(app: &App) -> Option<String> {
    if let Some(Choosing { tolerance, tried, .. }) = app.studies.value() {
        let tried = tried.map_or_else(String::new, |points| format!(": {} springs", grouped(points)));
        return Some(format!("trying for {tolerance:e}{tried}…"));
    }
    let Fitting { evaluations, .. } = app.studies.value()?;
    Some(format!("fitting, {} curves computed…", grouped(*evaluations as u64)))
}

fn contact(point: CurvePoint) -> String {
    format!("{} in {}", counted(point.springs, "spring"), patches(point.fragments))
}

fn patches(number: u64) -> String {
    if number == 1 { "1 contact patch".to_owned() } else { format!("{} contact patches", grouped(number)) }
}

fn counted(number: u64, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{} {thing}{plural}", grouped(number))
}

/// The valid keys, as a line.
pub fn footer(app: &App, width: u16) -> Line<'static> {
    let theme = app.view.appearance.theme;
    if let Some(note) = app.view.demo {
        return Line::styled(note, theme.style(Meaning::Quiet));
    }
    if let Some(prompt) = app.prompt.as_ref().filter(|prompt| !prompt.paths.is_empty()) {
        return candidates(&prompt.paths, width, theme);
    }
    let item = |(keys, row): (String, &Row)| {
        vec![Span::styled(keys, theme.style(Meaning::Key)), Span::raw(format!(" {}", row.label))]
    };
    let items = footer_keys(app).into_iter().map(item).collect();
    filled(items, "  ", width.into()).into_iter().next().unwrap_or_default()
}

/// Names of paths, without their folders, as a line.
fn candidates(paths: &[String], width: u16, theme: Theme) -> Line<'static> {
    let name = |path: &String| {
        let from = path.trim_end_matches(is_separator).rfind(is_separator).map_or(0, |at| at + 1);
        vec![Span::styled(path[from..].to_owned(), theme.style(Meaning::Quiet))]
    };
    filled(paths.iter().map(name).collect(), "  ", width.into()).into_iter().next().unwrap_or_default()
}
