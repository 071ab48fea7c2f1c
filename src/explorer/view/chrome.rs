//! The lines around the panes: title, status, footer.

use super::typed::typed;
use super::wrap::{clipped, fitting, wrapped};
use crate::accuracy::Target;
use crate::contact::CurvePoint;
use crate::explorer::action::{Command, Content, Traffic};
use crate::explorer::keys;
use crate::explorer::model::{Estimated, Mode, ModeKind, Model, Notice};
use crate::explorer::text_line::TextLine;
use crate::explorer::theme::Meaning;
use crate::scene::format_quantity;
use crate::text::grouped;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Name of the scene, whether it has changed, and what to look at.
pub fn title(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let scene = model.document.scene();
    let name = if scene.title.is_empty() { model.document.name() } else { &scene.title };
    let changed = if model.is_unsaved() { " [changed]" } else { "" };
    let notice = scene.notice.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = Line::from(vec![
        Span::styled(format!("{name}{changed}  "), model.appearance.theme.style(Meaning::Title)),
        Span::styled(notice, model.appearance.theme.style(Meaning::Quiet)),
    ]);
    let mut lines = wrapped(&line, area.width);
    if lines.len() > usize::from(area.height) {
        lines.truncate(usize::from(area.height));
        let last = lines.pop().map(|last| clipped(last, area.width));
        lines.extend(last);
    }
    frame.render_widget(Paragraph::new(lines), area);
}

/// The headline figures, or a question, an error, or what is being typed.
pub fn status(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let error = |text: String| Line::styled(text, theme.style(Meaning::Error));
    let prompted = |prompt: &'static str, line: &TextLine| {
        let prompt = Span::raw(prompt);
        let room = usize::from(area.width).saturating_sub(prompt.width());
        Line::from_iter([prompt].into_iter().chain(typed(line, room, theme)))
    };
    let line = match (&model.mode, &model.notice) {
        (Mode::SaveAs { line, .. }, _) => prompted("Save as: ", line),
        // What is typed is to be seen in the smallest window too.
        (Mode::Export(line), _) if area.width < 60 => prompted("Export to: ", line),
        (Mode::Export(line), _) if model.exports() == Content::MAP_EXPORTS => {
            prompted("Export the map to (.csv .svg .txt): ", line)
        }
        (Mode::Export(line), _) => prompted("Export to (.csv .npy .json .svg .txt): ", line),
        (Mode::Force(line), _) => prompted("Go to the force: ", line),
        (Mode::Tolerance(line), _) if area.width < 60 => prompted("Tolerance: ", line),
        (Mode::Tolerance(line), _) => prompted("Relative error allowed (0.1 % or 1e-3): ", line),
        (Mode::Library(library), _) => prompted("Search: ", &library.finder.query),
        (Mode::Find { finder, .. }, _) => prompted("Find: ", &finder.query),
        (Mode::Overwrite { path, .. }, _) => error(format!("{} exists. Overwrite it?", path.display())),
        (Mode::Quit, _) => error("The scene has unsaved changes. Leave?".to_owned()),
        (_, Some(Notice::Error(text))) => error(format!("! {}", text.replace('\n', " · "))),
        (Mode::Explore | Mode::Edit(_), None) if model.refused.is_some() => {
            let text = model.refused.as_ref().map_or("", |(_, text)| text);
            error(format!("! {text}"))
        }
        (_, Some(Notice::Done(text))) => Line::raw(text.clone()),
        (Mode::Explore, None) if model.appraisal.choosing.is_some() => choosing(model),
        _ => headline(model, area.width),
    };
    frame.render_widget(Paragraph::new(line), area);
}

/// A time to two digits.
fn short(seconds: f64) -> f64 {
    format!("{seconds:.1e}").parse().unwrap_or(seconds)
}

/// F_a, regime, the moment shown and what it cost, the most important first, as far as there is room.
fn headline(model: &Model, width: u16) -> Line<'static> {
    let Some(computed) = &model.computed else { return Line::raw("computing…") };
    let theme = model.appearance.theme;
    let outcome = &computed.outcome;
    let mut parts = Vec::new();
    let mut part = |apart: &'static str, text: String, meaning: Meaning| {
        let apart = if parts.is_empty() { "" } else { apart };
        parts.push(vec![Span::raw(apart), Span::styled(text, theme.style(meaning))]);
    };
    let in_hand = model.present().is_some() && model.hand.is_some();
    let adhesion = outcome.figures.adhesion_force.filter(|force| *force != 0.0);
    if let Some(adhesion) = adhesion {
        part("  ", format!("F_a {}", format_quantity(adhesion, "N")), Meaning::Title);
    } else if let Some(largest) = outcome.figures.preload.filter(|force| *force != 0.0) {
        // Where nothing pulls.
        part("  ", format!("F_max {}", format_quantity(largest, "N")), Meaning::Title);
    }
    let error = error(model);
    if let Some(error) = error.as_ref().filter(|_| !in_hand) {
        part(" ", error.clone(), Meaning::Title);
    }
    if let (Some(moment), Some(hand)) = (model.present(), &model.hand) {
        // What the move cost comes before what it led to.
        let point = moment.point;
        let d = format_quantity(point.indentation, "m");
        part("  ", format!("manual: d {d} F {}", format_quantity(point.force, "N")), Meaning::Text);
        part(" · ", format!("{} changed", counted(hand.changed, "spring")), Meaning::Text);
        part(" · ", format!("{} looked at", hand.touched), Meaning::Text);
        part(" · ", contact(point), Meaning::Text);
        if let Some(error) = error {
            let of = if adhesion.is_some() { "F_a " } else { "" };
            part(" · ", format!("{of}{error}"), Meaning::Text);
        }
    } else {
        if let Some(moment) = model.present() {
            let point = moment.point;
            let d = format_quantity(point.indentation, "m");
            part("  ", format!("d {d} F {}", format_quantity(point.force, "N")), Meaning::Text);
            let share = 100.0 * point.contact_length / outcome.line.length;
            part(" · ", format!("contact {} %", format_quantity(short(share), "1")), Meaning::Text);
        }
        if let Some(regime) = outcome.regime {
            part(" · ", regime.name().to_owned(), Meaning::Title);
        }
        if let Some(coefficient) = outcome.figures.adhesion_coefficient {
            part(" · ", format!("F_a/F_n {}", format_quantity(coefficient, "1")), Meaning::Title);
        }
        if let Some(moment) = model.present() {
            let stiffness = outcome.governing.effective_modulus * moment.point.contact_length;
            part(" · ", format!("dF/dd {}", format_quantity(short(stiffness), "N/m")), Meaning::Text);
            part(" · ", contact(moment.point), Meaning::Text);
        }
        if model.shows_times && !model.is_computing() {
            // Times of the last run only: a kept profile and tree take none.
            part(" · ", format_quantity(short(outcome.timings.total()), "s"), Meaning::Quiet);
        }
    }
    if model.is_computing() {
        let legs = model.document.scene().loading.len();
        part("  ", format!("computing, stage {} of {legs}", model.progress.unwrap_or(0) + 1), Meaning::Quiet);
    }
    fitting(parts, "", usize::from(width))
}

/// The estimated error of the headline, `…` until it is known; nothing where it cannot be.
fn error(model: &Model) -> Option<String> {
    match &model.appraisal.estimated {
        Estimated::Known(estimate) => {
            let of = if estimate.target == Target::Curve { "curve " } else { "" };
            Some(format!("{of}± {}", estimate.per_cent()))
        }
        Estimated::Waiting if model.shows_times => Some("± …".to_owned()),
        Estimated::Waiting | Estimated::Unknown => None,
    }
}

/// That springs are searched for a tolerance, and how far.
fn choosing(model: &Model) -> Line<'static> {
    let Some((tolerance, trying)) = model.appraisal.choosing else { return Line::default() };
    let trying = trying.map_or_else(String::new, |points| format!(": {} springs", grouped(points)));
    Line::raw(format!("trying for {tolerance:e}{trying}…"))
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

/// Narrower windows have no room for what the connection carries.
const TRAFFIC_FROM: u16 = 80;

/// The keys that are valid now, and what the connection carries: the line above is full.
pub fn footer(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let traffic = model.traffic.filter(|_| area.width >= TRAFFIC_FROM).map(|Traffic { frames, bytes }| {
        let bytes = format_quantity(short(bytes as f64), "B/s");
        let text = format!("{bytes}, at most {frames} frames/s");
        Line::styled(text, model.appearance.theme.style(Meaning::Quiet)).right_aligned()
    });
    let mut spans = Vec::new();
    let mut room = usize::from(area.width) - traffic.as_ref().map_or(0, Line::width);
    let labelled = || keys::valid_in(model.keys()).filter(|row| !row.label.is_empty());
    // The way to all the others and the way out show in the smallest window.
    let first = |row: &&keys::Binding| matches!(row.command, Command::Help | Command::Quit);
    // Then what no other pane has.
    let special = |row: &&keys::Binding| !first(row) && !row.modes.contains(&ModeKind::Explore);
    let usual = |row: &&keys::Binding| !first(row) && !special(row);
    let rows = labelled().filter(first).chain(labelled().filter(special)).chain(labelled().filter(usual));
    for row in rows {
        let Some(key) = row.keys.first() else { continue };
        let name = key.name();
        let width = name.chars().count() + row.label.chars().count() + 3;
        if width > room {
            break;
        }
        room -= width;
        spans.push(Span::styled(name, model.appearance.theme.style(Meaning::Key)));
        spans.push(Span::raw(format!(" {}  ", row.label)));
    }
    frame.render_widget(Paragraph::new(Line::from(spans)), area);
    if let Some(traffic) = traffic {
        let width = traffic.width() as u16;
        frame.render_widget(traffic, Rect { x: area.right() - width, width, ..area });
    }
}
