//! The lines around the panes: title, status, footer.

use super::stages;
use super::typed::typed;
use super::wrap::{fitted, fitting, wrapped_within};
use crate::accuracy::Estimate;
use crate::analysis::SteepWaves;
use crate::contact::CurvePoint;
use crate::explorer::action::{Content, Traffic};
use crate::explorer::app::{App, ManualState, Message, Mode, ModeKind};
use crate::explorer::keys::{self, Binding};
use crate::explorer::parameters::Parameter;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::update::{Choosing, can_complete};
use crate::scene::{format_quantity, format_rounded};
use crate::text::grouped;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;
use std::f64::consts::PI;
use std::path::is_separator;

/// Name of the scene, a sign of unsaved changes, and the notice.
pub fn title(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let scene = app.edit.document.scene();
    let name = if scene.title.is_empty() { app.edit.document.name() } else { &scene.title };
    let changed = if app.is_unsaved() { " [changed]" } else { "" };
    let notice = scene.notice.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = Line::from(vec![
        Span::styled(format!("{name}{changed}  "), app.view.appearance.theme.style(Meaning::Title)),
        Span::styled(notice, app.view.appearance.theme.style(Meaning::Quiet)),
    ]);
    frame.render_widget(Paragraph::new(wrapped_within(&line, area)), area);
}

/// The headline figures, or a question, an error, or the typed text.
pub fn status(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let theme = app.view.appearance.theme;
    let stated = |line: Line<'static>| fitted(line, area.width);
    let error = |text: String| stated(Line::styled(text, theme.style(Meaning::Error)));
    let line = match (&app.mode, &app.message) {
        (Mode::Prompt(prompt), _) if prompt.refused.is_some() || prompt.line.left_out().is_some() => {
            let why = prompt.refused.as_deref().or(prompt.line.left_out()).unwrap_or_default();
            let why = why.replace('\n', " · ");
            if prompt.purpose == Purpose::Value {
                // The line is in its row.
                error(format!("! {why}"))
            } else {
                let least = LEAST_TYPED.min(Span::raw(prompt.line.text()).width() as u16 + 1);
                let style = theme.style(Meaning::Error);
                let mut why =
                    fitted(Line::styled(format!("! {why}"), style), area.width.saturating_sub(least + 2));
                why.push_span(Span::styled(": ", style));
                prompted(why, &prompt.line, area.width, theme)
            }
        }
        (Mode::Prompt(prompt), _) if prompt.purpose != Purpose::Value => {
            prompted(Line::raw(label(prompt, app, area.width)), &prompt.line, area.width, theme)
        }
        (Mode::Overwrite(file), _) => error(format!("{} exists. Overwrite it?", file.path.display())),
        (Mode::Quit, _) => error(match app.unsaved()[..] {
            [] | [_] => "The scene has unsaved changes. Leave?".to_owned(),
            ref several => {
                let names: Vec<&str> = several.iter().map(|document| document.name()).collect();
                format!("{} scenes have unsaved changes: {}. Leave?", several.len(), names.join(", "))
            }
        }),
        (_, Some(Message::Error(text))) => error(format!("! {}", text.replace('\n', " · "))),
        (Mode::Explore, None) if app.edit.refused.is_some() => {
            let text = app.edit.refused.as_ref().map_or("", |(_, text)| text);
            error(format!("! {text}"))
        }
        (_, Some(Message::Done(text))) => stated(Line::raw(text.clone())),
        (Mode::Explore, None) if app.studies.value::<Choosing>().is_some() => choosing(app),
        _ => headline(app, area.width),
    };
    frame.render_widget(Paragraph::new(line), area);
}

/// Least columns of a typed line behind the reason of its refusal.
const LEAST_TYPED: u16 = 16;

/// A line being typed, behind a label.
fn prompted(label: Line<'static>, line: &TextLine, width: u16, theme: Theme) -> Line<'static> {
    let room = usize::from(width).saturating_sub(label.width());
    Line::from_iter(label.spans.into_iter().chain(typed(line, room, theme)))
}

/// Label of a prompt; a short one where the typed text would be out of sight.
fn label(prompt: &Prompt, app: &App, width: u16) -> String {
    let is_narrow = width < 60;
    match &prompt.purpose {
        Purpose::Value => String::new(),
        Purpose::Force => "Go to the force: ".to_owned(),
        Purpose::Tolerance if is_narrow => "Tolerance: ".to_owned(),
        Purpose::Tolerance => "Relative error allowed (0.1 % or 1e-3): ".to_owned(),
        Purpose::Save { .. } => "Save as: ".to_owned(),
        Purpose::Export if is_narrow => "Export to: ".to_owned(),
        Purpose::Export => {
            let exports = app.exports();
            let what = if exports == Content::MAP_EXPORTS { "Export the map" } else { "Export" };
            let extensions: Vec<String> =
                exports.iter().map(|(format, _)| format!(".{}", format.extension())).collect();
            format!("{what} to ({}): ", extensions.join(" "))
        }
        Purpose::Scene(_) => "Search: ".to_owned(),
        Purpose::Parameter { .. } => "Find: ".to_owned(),
        Purpose::Command(_) => ": ".to_owned(),
    }
}

/// Least columns of a status line with the error of F_a, beside which d and F have room.
const WITH_ERROR: u16 = 48;

/// F_a, regime, the state of the contact and its cost, the most important first, as far as there is room.
fn headline(app: &App, width: u16) -> Line<'static> {
    let Some(computed) = &app.solved else { return Line::raw("computing…") };
    let theme = app.view.appearance.theme;
    let outcome = &computed.outcome;
    let mut parts = Vec::new();
    let mut part = |apart: &'static str, text: String, meaning: Meaning| {
        let apart = if parts.is_empty() { "" } else { apart };
        parts.push(vec![Span::raw(apart), Span::styled(text, theme.style(meaning))]);
    };
    if let Some(tried) = app.tried_outcome().filter(|_| app.mode.is_typing_value()) {
        let force =
            tried.figures.adhesion_force.map_or("none".to_owned(), |force| format_quantity(force, "N"));
        let shown = if app.is_tried() { format!("F_a {force}") } else { "computing…".to_owned() };
        part("", format!("preview: {shown}"), Meaning::Title);
        part(" · ", "Enter accepts".to_owned(), Meaning::Quiet);
    }
    let is_manual = app.present().is_some() && app.manual.is_some();
    let adhesion = outcome.figures.adhesion_force.filter(|force| *force != 0.0);
    if let Some(adhesion) = adhesion {
        part("  ", format!("F_a {}", format_quantity(adhesion, "N")), Meaning::Title);
    } else if let Some(largest) = outcome.figures.preload.filter(|force| *force != 0.0) {
        // Without tensile force.
        part("  ", format!("F_max {}", format_quantity(largest, "N")), Meaning::Title);
    }
    // In a narrow window the state of the contact comes first.
    let is_narrow = width < WITH_ERROR;
    let error = error(app).filter(|_| !is_narrow);
    if let Some(error) = error.as_ref().filter(|_| !is_manual) {
        part(" ", error.clone(), Meaning::Title);
    }
    let state = match (app.present(), &app.manual) {
        _ if app.view.shows_work => work(app),
        (Some(snapshot), Some(state)) => {
            let of = if adhesion.is_some() { "F_a " } else { "" };
            let error = error.map(|error| (" · ", format!("{of}{error}"), Meaning::Text));
            let title = if is_narrow { "" } else { "manual: " };
            manual(app, snapshot, state, title).into_iter().chain(error).collect()
        }
        (snapshot, _) => mechanics(app, snapshot),
    };
    state.into_iter().for_each(|(apart, text, meaning)| part(apart, text, meaning));
    if app.is_computing() {
        let legs = app.edit.document.scene().loading.len();
        part("  ", format!("computing, stage {} of {legs}", app.progress.unwrap_or(0) + 1), Meaning::Quiet);
    }
    fitting(parts, "", usize::from(width))
}

/// Part of the status line, with the text before.
type Part = (&'static str, String, Meaning);

/// The state under manual loading: the changes by the move come before the resulting contact.
fn manual(app: &App, snapshot: &ContactSnapshot, state: &ManualState, title: &str) -> Vec<Part> {
    let released = format!("released {}", format_rounded(state.released_energy, 2, "J"));
    let mut parts = vec![
        ("  ", format!("{title}{}", place(snapshot.point)), Meaning::Text),
        (" · ", format!("{} changed", counted(state.changed, "spring")), Meaning::Text),
        (" · ", contact(snapshot.point), Meaning::Text),
        (" · ", released, Meaning::Text),
    ];
    parts.extend(response(app, snapshot));
    parts
}

/// The present state in mechanical quantities, and those of the whole loop.
fn mechanics(app: &App, snapshot: Option<&ContactSnapshot>) -> Vec<Part> {
    let Some(computed) = &app.solved else { return Vec::new() };
    let outcome = &computed.outcome;
    let mut parts = Vec::new();
    if let Some(snapshot) = snapshot {
        parts.push(("  ", place(snapshot.point), Meaning::Text));
        let share = 100.0 * snapshot.point.contact_length / outcome.line.length;
        parts.push((" · ", format!("contact {} %", format_rounded(share, 2, "1")), Meaning::Text));
    }
    if let Some(regime) = outcome.regime {
        parts.push((" · ", regime.by_protocol().to_owned(), Meaning::Title));
    }
    if let Some(SteepWaves { ratio, jkr_factor }) = outcome.steep_waves {
        let warning =
            format!("λ²/AR {ratio:.2} < {}: JKR pulls {jkr_factor:.2} F_smooth", SteepWaves::LEAST_RATIO);
        parts.push((" · ", warning, Meaning::Error));
    }
    if let Some(coefficient) = outcome.figures.adhesion_coefficient {
        parts.push((" · ", format!("F_a/F_n {}", format_quantity(coefficient, "1")), Meaning::Title));
    }
    if let Some(snapshot) = snapshot {
        parts.extend(response(app, snapshot));
    }
    if let Some(energy) = outcome.figures.dissipated_energy {
        parts.push((" · ", format!("ΔW {}", format_rounded(energy, 2, "J")), Meaning::Text));
    }
    if let Some(snapshot) = snapshot {
        parts.push((" · ", contact(snapshot.point), Meaning::Text));
    }
    parts
}

/// Stiffness E* l of the present contact with its edges in place (Popov and Filippov 2012, eq. (1)), and the mean pressure
/// on a circle of its radius.
fn response(app: &App, snapshot: &ContactSnapshot) -> Vec<Part> {
    let Some(computed) = &app.solved else { return Vec::new() };
    let stiffness = computed.outcome.governing.effective_modulus * snapshot.point.contact_length;
    let mut parts = vec![(" · ", format!("E*l {}", format_rounded(stiffness, 2, "N/m")), Meaning::Text)];
    let radius = snapshot.contact_radius;
    if radius > 0.0 {
        let pressure = snapshot.point.force / (PI * radius * radius);
        parts.push((" · ", format!("p_m {}", format_rounded(pressure, 2, "Pa")), Meaning::Text));
    }
    parts
}

/// Springs in contact, the cost of the last manual move, and the times of the computing stages.
fn work(app: &App) -> Vec<Part> {
    let mut parts = Vec::new();
    if let Some(snapshot) = app.present() {
        parts.push(("  ", contact(snapshot.point), Meaning::Text));
    }
    if let Some(computed) = &app.solved {
        parts.push((" of ", grouped(computed.outcome.line.points as u64), Meaning::Text));
    }
    if let Some(state) = &app.manual {
        parts.push((" · ", format!("{} changed", counted(state.changed, "spring")), Meaning::Text));
    }
    // Times of the last run only: a kept profile and tree take none.
    if app.view.shows_times && !app.is_computing() {
        let stages = stages::times(app).into_iter();
        parts.extend(stages.map(|(name, time)| (" · ", format!("{name} {time}"), Meaning::Quiet)));
    }
    parts
}

/// Indentation and force.
fn place(point: CurvePoint) -> String {
    format!("d {} F {}", format_quantity(point.indentation, "m"), format_quantity(point.force, "N"))
}

/// The estimated error of the headline: `…` while awaited, `None` without an estimate.
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

/// Progress of the search of springs for a tolerance.
fn choosing(app: &App) -> Line<'static> {
    let Some(Choosing { tolerance, tried, .. }) = app.studies.value() else { return Line::default() };
    let tried = tried.map_or_else(String::new, |points| format!(": {} springs", grouped(points)));
    Line::raw(format!("trying for {tolerance:e}{tried}…"))
}

/// Springs and patches in contact.
fn contact(point: CurvePoint) -> String {
    format!("{} in {}", counted(point.springs, "spring"), counted(point.fragments, "fragment"))
}

/// A number of things.
fn counted(number: u64, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

/// Least columns for the traffic of the connection.
const TRAFFIC_FROM: u16 = 80;
/// Least columns for the frames as well: the keys come first.
const TRAFFIC_WITH_FRAMES: u16 = 100;

/// The valid keys, and the traffic of the connection: the line above is full.
pub fn footer(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let traffic = app.view.traffic.filter(|_| area.width >= TRAFFIC_FROM).map(|Traffic { frames, bytes }| {
        let bytes = format_rounded(bytes as f64, 2, "B/s");
        let most =
            if area.width < TRAFFIC_WITH_FRAMES { "" } else { &format!(", at most {frames} frames/s") };
        let text = format!("{bytes}{most}");
        Line::styled(text, app.view.appearance.theme.style(Meaning::Quiet)).right_aligned()
    });
    if let Some(note) = app.view.demo {
        return frame.render_widget(
            Paragraph::new(note).style(app.view.appearance.theme.style(Meaning::Quiet)),
            area,
        );
    }
    if let Mode::Prompt(prompt) = &app.mode
        && !prompt.paths.is_empty()
    {
        return frame.render_widget(candidates(&prompt.paths, area.width, app.view.appearance.theme), area);
    }
    let mut spans = Vec::new();
    // Two columns apart.
    let mut room =
        usize::from(area.width).saturating_sub(traffic.as_ref().map_or(0, |line| line.width() + 2));
    for (keys, label) in footer_items(app) {
        let width = keys.chars().count() + label.chars().count() + 3;
        if width > room + 2 {
            break;
        }
        room = room.saturating_sub(width);
        spans.push(Span::styled(keys, app.view.appearance.theme.style(Meaning::Key)));
        spans.push(Span::raw(format!(" {label}  ")));
    }
    frame.render_widget(Paragraph::new(Line::from(spans)), area);
    if let Some(traffic) = traffic {
        let width = traffic.width() as u16;
        frame.render_widget(traffic, Rect { x: area.right() - width, width, ..area });
    }
}

/// Names of paths, without their folders.
fn candidates(paths: &[String], width: u16, theme: Theme) -> Line<'static> {
    let name = |path: &String| {
        let from = path.trim_end_matches(is_separator).rfind(is_separator).map_or(0, |at| at + 1);
        vec![Span::styled(path[from..].to_owned(), theme.style(Meaning::Quiet))]
    };
    fitting(paths.iter().map(name).collect(), "  ", usize::from(width))
}

/// Valid keys with their labels, the most important first; adjacent rows with the same label are one item.
fn footer_items(app: &App) -> Vec<(String, &'static str)> {
    let is_shown = |row: &&Binding| match row.command.name {
        "toggle-manual" => true,
        "complete" => can_complete(app),
        "start-value" => app.parameter().is_some_and(Parameter::takes_number),
        _ => !row.label.is_empty() && (app.manual.is_some() || !keys::is_manual(row)),
    };
    let mut rows: Vec<&Binding> = app.config.bindings.valid_in(app.keys()).filter(is_shown).collect();
    rows.sort_by_key(|row| rank(row, app));
    let items = rows.chunk_by(|one, next| one.label == next.label);
    items
        .map(|rows| {
            let first = |row: &&Binding| keys::names(&row.keys).into_iter().next().unwrap_or_default();
            (rows.iter().map(first).collect::<Vec<_>>().join(" "), rows[0].label)
        })
        .collect()
}

/// Place of a key in the footer: help and quit, which show in the smallest window; keys of the present mode only; the
/// main keys for panes, scenes and loops; the rest.
fn rank(row: &Binding, app: &App) -> u8 {
    match row.command.name {
        "help" | "close-help" | "quit" => 0,
        _ if app.manual.is_some() && keys::is_manual(row) => 1,
        _ if !row.modes.contains(&ModeKind::Explore) => 1,
        "next-pane" | "toggle-chart" | "open-library" | "save" | "pin" | "open-palette" => 2,
        _ => 3,
    }
}
