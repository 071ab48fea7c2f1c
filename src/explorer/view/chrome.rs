//! The lines above and below the panes: title, status line and footer.

use crate::explorer::action::EXPORTS;
use crate::explorer::app::{App, Message};
use crate::explorer::commands::accuracy::Choosing;
use crate::explorer::commands::table::footer as footer_keys;
use crate::explorer::commands::{map_over, target};
use crate::explorer::layout::Layout;
use crate::explorer::measured;
use crate::explorer::measured::Fitting;
use crate::explorer::pane::Pane;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text::{Part, filled, fitted, wrapped_within};
use crate::explorer::theme::Meaning;
use crate::explorer::timeline::passed;
use crate::explorer::typed;
use asperity_contact::Move;
use asperity_data::{counted, format_quantity, format_range, format_rounded};
use asperity_report::{event_words, square_loops_words};
use asperity_scene::{Estimate, Outcome};
use asperity_study::half_space::SquareLoops;
use asperity_study::{Ensemble, Quantity};
use ratatui::text::{Line, Span};
use std::path::is_separator;

/// Returns the lines of the title: the name of the scene, a sign for unsaved changes, and the
/// notice of the scene.
pub fn title(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    let title = app.title();
    let heading = format!("{}{}", title.name, title.sign());
    let line = Line::from_iter([
        Span::styled(heading, app.style(Meaning::Title)),
        Span::styled(title.notice_apart(), app.style(Meaning::Quiet)),
    ]);
    wrapped_within(&line, width, rows)
}

/// Returns the status lines below the panes, at most `rows` lines. They contain the main results of
/// the scene, a question, an error, or the text that the user is typing.
pub fn status(app: &App, width: u16, rows: u16) -> Vec<Line<'static>> {
    if let Some(prompt) = &app.prompt
        && let Some(lines) = status_of_prompt(app, prompt, width, rows)
    {
        return lines;
    }
    match &app.message {
        Some(Message::Error(why) | Message::Refused(why)) => refusal(app, why, width, rows),
        Some(Message::Done(text)) => done(app, text, width, rows),
        Some(Message::Taken { name, quantity }) => {
            let text = target::taken_in_words(app, name, *quantity);
            done(app, &text, width, rows)
        }
        None if app.prompt.is_none() => match searching(app) {
            Some(progress) => vec![Line::raw(progress)],
            None => vec![headline(app, width.into())],
        },
        None => vec![headline(app, width.into())],
    }
}

/// Returns the status lines for an open prompt. `None` if the prompt does not use these lines, so
/// that they show results and messages.
fn status_of_prompt(
    app: &App,
    prompt: &Prompt,
    width: u16,
    rows: u16,
) -> Option<Vec<Line<'static>>> {
    if let Some(why) = prompt.refused.as_deref().or(prompt.line.left_out()) {
        return Some(status_of_refused(app, prompt, why, width, rows));
    }
    match &prompt.purpose {
        // In these prompts, the typed value is in its row in the list of parameters, or there is no
        // typed line.
        Purpose::Value
        | Purpose::Topics {
            is_typed: false, ..
        } => None,
        Purpose::Overwrite { file, is_changed } => {
            let state = if *is_changed {
                "was changed by another program since it was opened"
            } else {
                "exists"
            };
            let question = format!("{} {state}. Overwrite it?", file.path.display());
            Some(vec![Line::styled(question, app.style(Meaning::Error))])
        }
        Purpose::Leave => {
            let question = question_before_leaving(app);
            Some(vec![Line::styled(question, app.style(Meaning::Error))])
        }
        _ => {
            let mut lines = vec![prompted(app, prompt, width)];
            lines.extend(answer(app, width).filter(|_| rows > 1));
            if let Some(answer) = map_over::answer(app) {
                let answer = Line::styled(answer, app.style(Meaning::Title));
                lines.extend(wrapped_within(&answer, width, rows - 1));
            }
            Some(lines)
        }
    }
}

/// Returns the answer to the typed target, as much of it as fits into one line; `None` if the user
/// is typing no target.
fn answer(app: &App, width: u16) -> Option<Line<'static>> {
    let style = app.style(Meaning::Title);
    let mut parts = Vec::new();
    for text in target::answer(app)? {
        parts.push(vec![Span::styled(text, style)]);
    }
    let first = parts.first().cloned().unwrap_or_default();
    let line = first_line(parts, " · ", width.into());
    if line.spans.is_empty() {
        // Not even the first part fits, so its beginning is shown.
        return wrapped_within(&Line::from(first), width, 1).pop();
    }
    Some(line)
}

/// Returns the reason why a typed text is refused and, if there is room, the typed text below it.
/// The value of a parameter is not repeated here, because the list of parameters shows it.
fn status_of_refused(
    app: &App,
    prompt: &Prompt,
    why: &str,
    width: u16,
    rows: u16,
) -> Vec<Line<'static>> {
    let has_room = rows > 1 && !matches!(prompt.purpose, Purpose::Value);
    if !has_room {
        return refusal(app, why, width, rows);
    }
    let mut lines = refusal(app, why, width, rows - 1);
    lines.push(prompted(app, prompt, width));
    lines
}

fn refusal(app: &App, why: &str, width: u16, rows: u16) -> Vec<Line<'static>> {
    let text = format!("! {}", why.replace('\n', " · "));
    let line = Line::styled(text, app.style(Meaning::Error));
    wrapped_within(&line, width, rows)
}

fn question_before_leaving(app: &App) -> String {
    let unsaved = app.edit.unsaved();
    if unsaved.len() <= 1 {
        return "The scene has unsaved changes. Leave?".to_owned();
    }
    let names: Vec<&str> = unsaved.iter().map(|document| document.name()).collect();
    format!(
        "{} scenes have unsaved changes: {}. Leave?",
        names.len(),
        names.join(", ")
    )
}

/// Returns a message on what was done, followed by as many main results of the scene as fit.
fn done(app: &App, text: &str, width: u16, rows: u16) -> Vec<Line<'static>> {
    if Span::raw(text).width() + 2 > width.into() {
        return wrapped_within(&Line::raw(text.to_owned()), width, rows);
    }
    let mut line = Line::raw(format!("{text}  "));
    let room = usize::from(width).saturating_sub(line.width());
    let beside = headline(app, room);
    // The results and the warnings matter more than the keys, whose row the message then takes. If
    // the pane of results is shown, they need no row.
    let shows_result = Layout::of(app).pane(Pane::Result).is_some();
    if beside.spans.is_empty() && rows > 1 && !shows_result {
        return vec![Line::raw(text.to_owned()), headline(app, width.into())];
    }
    line.extend(beside);
    vec![line]
}

/// Returns the line that the user is typing: its label, the typed text, and the meaning of this
/// text.
fn prompted(app: &App, prompt: &Prompt, width: u16) -> Line<'static> {
    let label = Span::raw(label(app, prompt, width));
    let meaning = typed::understood(app).or_else(|| target::understood(app));
    let meaning = meaning.map_or_else(String::new, |text| format!("→ {text}"));
    let meaning = Span::styled(meaning, app.style(Meaning::Title));
    let room = usize::from(width).saturating_sub(label.width() + meaning.width());
    let mut spans = vec![label];
    spans.extend(prompt.line.spans(room, app.view.appearance));
    spans.push(meaning);
    Line::from(spans)
}

/// Returns the label of a prompt. It is shorter in a narrow window, so that the typed text stays
/// visible.
fn label(app: &App, prompt: &Prompt, width: u16) -> String {
    let is_narrow = width < 60;
    match &prompt.purpose {
        Purpose::Value | Purpose::Overwrite { .. } | Purpose::Leave => String::new(),
        Purpose::Target => format!("{} for ", target::name(app)),
        Purpose::Map => "Map ".to_owned(),
        Purpose::SavePlan if is_narrow => "Plan: ".to_owned(),
        Purpose::SavePlan => "Save the plan of this map as: ".to_owned(),
        Purpose::Move if is_narrow => "Move to: ".to_owned(),
        Purpose::Move if app.is_normalised() => "Press or pull to (F_a,max, nm): ".to_owned(),
        Purpose::Move => format!("Press or pull to ({}, nm): ", typed::unit_of_force(app)),
        Purpose::Tolerance if is_narrow => "Tolerance: ".to_owned(),
        Purpose::Tolerance => "Relative error allowed (0.1 % or 1e-3): ".to_owned(),
        Purpose::Fit => "Parameters to fit: ".to_owned(),
        Purpose::Save { .. } => "Save as: ".to_owned(),
        Purpose::Export if is_narrow => "Export to: ".to_owned(),
        Purpose::Export => {
            let extensions = EXPORTS.map(|format| format!(".{}", format.extension()));
            format!("Export to ({}; 85mm: width): ", extensions.join(" "))
        }
        Purpose::Open(_) => "Search: ".to_owned(),
        Purpose::Curve(question) => format!("{}: ", question.option().field.name),
        Purpose::Parameter { .. } | Purpose::Topics { .. } => "Find: ".to_owned(),
    }
}

/// Smallest widths in columns at which the status line shows the error of F_a (`WITH_ERROR`), and
/// both this error and the results of the random profiles (`WITH_BOTH`).
const WITH_ERROR: usize = 48;
const WITH_BOTH: usize = 100;

/// Returns the line with the main results of the loop, as many as fit.
fn headline(app: &App, width: usize) -> Line<'static> {
    if app.solved.is_none() {
        return Line::raw("computing…");
    }
    let facts = facts(app, width);
    let full = line_of_facts(app, &facts, width, str::to_owned);
    // A shorter name of the regime may leave room for more facts.
    let short = line_of_facts(app, &facts, width, |text| {
        text.replace("pressure-", "press.-")
            .replace(" (d=0, F=0)", "")
    });
    if short.spans.len() > full.spans.len() {
        short
    } else {
        full
    }
}

/// Returns a line with the first of the facts, as many as fit into this width. `wording` may
/// shorten the text of a fact.
fn line_of_facts(
    app: &App,
    facts: &[Fact],
    width: usize,
    wording: fn(&str) -> String,
) -> Line<'static> {
    let mut parts = Vec::new();
    for fact in facts {
        let text = wording(&fact.text);
        parts.push(vec![Span::styled(text, app.style(fact.meaning))]);
    }
    first_line(parts, " · ", width)
}

/// Returns the first of the lines over which the parts are distributed.
fn first_line(parts: Vec<Part>, between: &'static str, width: usize) -> Line<'static> {
    let lines = filled(parts, between, width);
    lines.into_iter().next().unwrap_or_default()
}

/// A main result of the loop, as shown in the status line.
struct Fact {
    text: String,
    meaning: Meaning,
}

impl Fact {
    fn new(text: impl Into<String>, meaning: Meaning) -> Self {
        Fact {
            text: text.into(),
            meaning,
        }
    }
}

/// Returns what happens while the animation plays: a rest, or the last mark or jump of the
/// instrument that it has passed. The jumps of patches follow each other too fast to be read.
fn event_of_animation(app: &App) -> Option<String> {
    if !app.is_playing() {
        return None;
    }
    let records = app.played_stages();
    let player = app.playhead();
    if let Move::Hold(seconds) = records.get(player.stage)?.target {
        return Some(format!("▶ rest for {}", format_quantity(seconds, "s")));
    }
    let events = &app.listed_events()?.ok()?.list;
    let passed = &events[..passed(records, events, player)];
    let named = passed
        .iter()
        .rfind(|event| event.mark.is_some() || event.instrument.is_some())?;
    let mut without_patches = *named;
    without_patches.jump = None;
    Some(format!("▶ passed {}", event_words(&without_patches)))
}

/// Returns the main results of the loop for a line of this width, the most important first.
fn facts(app: &App, width: usize) -> Vec<Fact> {
    let Some(outcome) = app.outcome() else {
        return Vec::new();
    };
    let mut facts = facts_of_preview(app);
    if app.is_computing() {
        let stage = app.progress.unwrap_or(0) + 1;
        let stages = app.edit.document.scene().loading.len();
        let text = format!("computing, stage {stage} of {stages}");
        facts.push(Fact::new(text, Meaning::Quiet));
    }
    if let Some(event) = event_of_animation(app) {
        facts.push(Fact::new(event, Meaning::Heading));
    }
    if app.view.squares {
        facts.push(fact_of_squares(app, width));
    }
    facts.extend(facts_of_force(app, outcome, width));
    if let Some(measured) = &app.edit.measured {
        let text = format!("{}: {}", measured.name, misfit(app));
        facts.push(Fact::new(text, Meaning::Title));
    }
    add_warning(&mut facts, &app.warnings(), width);
    if let Some(regime) = outcome.regime {
        let regime = regime.by_protocols(outcome.regime_after_zero_force);
        facts.push(Fact::new(regime, Meaning::Title));
    }
    let share = app
        .median_share_in_words()
        .or_else(|| app.adhesion_share_in_words());
    if let Some(share) = share {
        facts.push(Fact::new(share, Meaning::Title));
    }
    if let Some(coefficient) = outcome.figures.adhesion_coefficient {
        let text = format!("F_a/F_n {}", format_quantity(coefficient, "1"));
        facts.push(Fact::new(text, Meaning::Title));
    }
    if let Some(energy) = outcome.figures.dissipated_energy
        && app.snapshot.is_some()
    {
        let text = format!("ΔW {}", format_rounded(energy, 3, "J"));
        facts.push(Fact::new(text, Meaning::Text));
    }
    facts
}

/// Returns the pull-off force for the value that the user is typing.
fn facts_of_preview(app: &App) -> Vec<Fact> {
    if !app.is_typing_value() {
        return Vec::new();
    }
    let Some(tried) = app.tried_outcome() else {
        return Vec::new();
    };
    let shown = match tried.figures.pull_off_force {
        _ if !app.is_tried() => "computing…".to_owned(),
        None => "F_a none".to_owned(),
        Some(adhesion) => format!("F_a {}", app.force_in_words(adhesion)),
    };
    vec![
        Fact::new(format!("preview: {shown}"), Meaning::Title),
        Fact::new("Enter accepts", Meaning::Quiet),
    ]
}

/// Returns the pull-off force over the random profiles, and that of the shown profile with its
/// error. If the force is never tensile, returns the largest force instead.
fn facts_of_force(app: &App, outcome: &Outcome, width: usize) -> Vec<Fact> {
    let is_wide = width >= WITH_ERROR;
    let error = if is_wide { error(app) } else { None };
    let adhesion = outcome.figures.pull_off_force;
    let Some(adhesion) = adhesion.filter(|force| *force != 0.0) else {
        let largest = outcome.figures.preload;
        let Some(largest) = largest.filter(|force| *force != 0.0) else {
            return Vec::new();
        };
        let largest = format_quantity(largest, "N");
        let text = format!("F_max {largest}{}", after_comma(error));
        return vec![Fact::new(text, Meaning::Title)];
    };
    let mut facts = Vec::new();
    let over_profiles = fact_of_profiles(app, is_wide);
    let name = if over_profiles.is_some() {
        "this profile"
    } else {
        "F_a"
    };
    let has_room = over_profiles.is_none() || width >= WITH_BOTH;
    let error = if has_room { error } else { None };
    let is_fixed = Ensemble::profiles_of(app.edit.document.scene()) == 1;
    let fixed = if is_fixed && is_wide {
        ", fixed profile"
    } else {
        ""
    };
    facts.extend(over_profiles);
    let force = app.force_in_words(adhesion);
    let text = format!("{name} {force}{}{fixed}", after_comma(error));
    facts.push(Fact::new(text, Meaning::Text));
    facts
}

fn after_comma(text: Option<String>) -> String {
    text.map_or_else(String::new, |text| format!(", {text}"))
}

/// Returns the misfit, which states how well the scene describes the measured curve, as text.
fn misfit(app: &App) -> String {
    if let Some(why) = measured::failure(&app.studies) {
        return why.to_owned();
    }
    match measured::fitted(&app.studies) {
        Some(fit) => format!("misfit {}", format_rounded(fit.misfit, 3, "1")),
        None => "misfit …".to_owned(),
    }
}

/// Smallest width in columns at which the beginning of a warning is shown.
const LEAST_WARNING: usize = 30;

/// Adds the first warning and the number of warnings to the facts. If there is little room, the
/// warning is shortened. If there is less room than [`LEAST_WARNING`], only the number of warnings
/// is added, after the first fact.
fn add_warning(facts: &mut Vec<Fact>, warnings: &[String], width: usize) {
    let Some(first) = warnings.first() else {
        return;
    };
    let before: usize = facts
        .iter()
        .map(|fact| fact.text.chars().count() + " · ".len())
        .sum();
    let room = width.saturating_sub(before);
    let count = warnings.len();
    let text = if count == 1 {
        format!("! {first}")
    } else {
        format!("! 1 of {count} (A): {first}")
    };
    if text.chars().count() <= room {
        facts.push(Fact::new(text, Meaning::Error));
    } else if room >= LEAST_WARNING {
        let beginning: String = text.chars().take(room - 1).collect();
        let text = format!("{}…", beginning.trim_end());
        facts.push(Fact::new(text, Meaning::Error));
    } else {
        let number = if count == 1 {
            "! 1 warning (A)".to_owned()
        } else {
            format!("! {count} warnings (A)")
        };
        let place = facts.len().min(1);
        facts.insert(place, Fact::new(number, Meaning::Error));
    }
}

/// Returns the progress of the loops of random square surfaces on an elastic half-space and, after
/// the first results, a comparison with the profiles. If the computation has failed, returns as
/// much of the reason as fits.
fn fact_of_squares(app: &App, width: usize) -> Fact {
    if let Some(why) = app.studies.failure::<SquareLoops>() {
        let text = format!("three dimensions: {why}");
        let beginning: String = text.chars().take(width).collect();
        return Fact::new(beginning, Meaning::Error);
    }
    let is_adhesive = app.edit.scene.adhesion.is_some();
    let text = match app.studies.value() {
        Some(loops) => square_loops_words(loops, is_adhesive),
        None => square_loops_words(&SquareLoops::default(), is_adhesive),
    };
    Fact::new(text, Meaning::Title)
}

/// Returns the median and the quartiles of the pull-off force over the random profiles computed so
/// far; before the first of them, those before the last change. If `is_wide` is true, also states
/// the number of profiles.
fn fact_of_profiles(app: &App, is_wide: bool) -> Option<Fact> {
    let shown = app.shown_ensemble()?;
    let ensemble = shown.ensemble;
    // Words of one length keep the numbers in their places.
    let name = if shown.is_former { "before" } else { "median" };
    let (quantity, symbol, unit) = if app.is_normalised() {
        (Quantity::AdhesionShare, "F_a/F_a,max", "1")
    } else {
        (Quantity::PullOffForce, "F_a", "N")
    };
    let [lower, median, upper] = ensemble.statistics(quantity)?.quartiles;
    let median = format_rounded(median, 3, unit);
    let quartiles = format_range((lower, upper), 2, unit);
    let computed = ensemble.computed();
    let all = counted(ensemble.profiles(), "profile");
    let count = if !is_wide {
        String::new()
    } else if computed < ensemble.profiles() {
        format!(", {computed} of {all}")
    } else {
        format!(", {all}")
    };
    let text = format!("{symbol} {name} {median} ({quartiles}{count})");
    Some(Fact::new(text, Meaning::Title))
}

/// Returns the estimated error of the pull-off force as text: `± …` while the error is being
/// computed, `None` if no error is computed.
fn error(app: &App) -> Option<String> {
    if let Some(estimate) = app.studies.value::<Estimate>() {
        return Some(estimate.words());
    }
    let has_failed = app.studies.failure::<Estimate>().is_some();
    let text = if has_failed {
        app.outcome()?.figures.pull_off_force?;
        "error unknown"
    } else if app.view.shows_times {
        "± …"
    } else {
        return None;
    };
    Some(text.to_owned())
}

/// Returns the progress of a search for the number of springs, or of a fit to the measured curve;
/// `None` if neither is running.
fn searching(app: &App) -> Option<String> {
    if let Some(Choosing {
        tolerance, tried, ..
    }) = app.studies.value()
    {
        let tried = match tried {
            Some(springs) => format!(": {}", counted(*springs, "spring")),
            None => String::new(),
        };
        return Some(format!("trying for {tolerance:e}{tried}…"));
    }
    let Fitting { evaluations, .. } = app.studies.value()?;
    let curves = counted(*evaluations, "curve");
    Some(format!("fitting, {curves} computed…"))
}

/// Returns the footer: a line with the keys that are valid now.
pub fn footer(app: &App, width: u16) -> Line<'static> {
    if let Some(note) = app.view.demo {
        return Line::styled(note, app.style(Meaning::Quiet));
    }
    if let Some(offer) = &app.offer {
        let offer = Line::styled(offer.clone(), app.style(Meaning::Key));
        return fitted(offer, width);
    }
    if let Some(prompt) = &app.prompt
        && !prompt.paths.is_empty()
    {
        return candidates(app, &prompt.paths, width);
    }
    let mut items = Vec::new();
    for (keys, row) in footer_keys(app) {
        items.push(vec![
            Span::styled(keys, app.style(Meaning::Key)),
            Span::raw(format!(" {}", row.label)),
        ]);
    }
    first_line(items, "  ", width.into())
}

/// Returns a line with the names of files and folders, taken from their paths.
fn candidates(app: &App, paths: &[String], width: u16) -> Line<'static> {
    let mut names = Vec::new();
    for path in paths {
        let separator = path.trim_end_matches(is_separator).rfind(is_separator);
        let name = match separator {
            Some(place) => &path[place + 1..],
            None => path,
        };
        names.push(vec![Span::styled(
            name.to_owned(),
            app.style(Meaning::Quiet),
        )]);
    }
    first_line(names, "  ", width.into())
}
