//! What each action does to the model. Nothing here touches terminal, files or worker: what is to be
//! done outside is returned.

use super::action::{Action, Command, SaveError};
use super::layout::Layout;
use super::model::{Look, Mode, Model, Notice, Pane, Player};
use super::parameters::parameters;
use super::text_line::TextLine;
use super::view::help_end;
use super::worker::{Focus, MomentRequest};
use crate::scene::{Document, Roughness, presets};
use std::path::PathBuf;
use std::time::Duration;

/// Time the animation takes for one leg.
const LEG_TIME: Duration = Duration::from_secs(6);
/// Steps of the animation in one leg.
const STEPS: f64 = 120.0;
/// Edits that can be taken back.
const UNDO_DEPTH: usize = 1000;

/// Something to be done outside the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Compute the scene.
    Compute,
    /// Show the moment at which the animation stands.
    Show,
    /// Draw a random seed and give it back as an action.
    DrawSeed,
    /// Save the scene.
    Save {
        /// The file.
        path: PathBuf,
        /// Whether to overwrite it.
        overwrite: bool,
    },
}

/// Applies an action and tells what is to be done outside.
pub fn update(model: &mut Model, action: Action) -> Vec<Effect> {
    match action {
        Action::Command(command) => obey(model, command),
        Action::Type(character) => {
            typed(model, |line| line.insert(character));
            Vec::new()
        }
        Action::Paste(text) => {
            typed(model, |line| text.chars().for_each(|character| line.insert(character)));
            Vec::new()
        }
        Action::Resize(columns, rows) => {
            model.size = (columns, rows);
            vec![Effect::Show]
        }
        Action::Elapse(time) => elapse(model, time),
        Action::SetSeed(seed) => match model.document.scene().roughness {
            Some(Roughness::SelfAffine { .. }) => change(model, "roughness.seed", &seed.to_string()),
            _ => {
                model.notice = Some(Notice::Error("the scene has no random line to draw anew".to_owned()));
                Vec::new()
            }
        },
        Action::Computed(computed) if computed.generation == model.generation => {
            model.progress = None;
            let last = computed.outcome.history.legs.len().saturating_sub(1);
            model.computed = Some(computed);
            if model.player.leg > last {
                model.player = Player { leg: last, done: 1.0, playing: false };
            }
            if matches!(model.notice, Some(Notice::Error(_))) {
                model.notice = None;
            }
            vec![Effect::Show]
        }
        Action::Shown(moment) if moment.generation == model.generation => {
            // Another moment may have been on its way when the fragment was asked for.
            let is_answer = moment.focus == model.look.focus;
            if is_answer && matches!(model.look.focus, Focus::After(_) | Focus::Before(_)) {
                let middle = moment.close_up.fragment.map(|fragment| fragment.middle());
                model.look.focus = middle.map_or(Focus::Summit, Focus::Spring);
            }
            model.moment = Some(moment);
            Vec::new()
        }
        Action::Progress { generation, legs } if generation == model.generation => {
            model.progress = model.progress.map(|_| legs);
            Vec::new()
        }
        Action::Failed { generation, error } if generation == model.generation => {
            model.progress = None;
            model.notice = Some(Notice::Error(error));
            Vec::new()
        }
        // Stale: of a scene that has been changed since.
        Action::Computed(_) | Action::Shown(_) | Action::Progress { .. } | Action::Failed { .. } => {
            Vec::new()
        }
        Action::Saved(result) => {
            saved(model, result);
            Vec::new()
        }
    }
}

/// What the worker is asked to show for this model.
#[must_use]
pub fn moment_request(model: &Model) -> Option<MomentRequest> {
    if !model.is_current() {
        return None;
    }
    let layout = Layout::of(model);
    Some(MomentRequest {
        generation: model.generation,
        leg: model.player.leg,
        indentation: model.indentation(),
        profile_columns: layout.profile_columns(),
        close_up_columns: layout.close_up_columns(),
        focus: model.look.focus,
        close_up_springs: model.look.springs,
    })
}

fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match &mut model.mode {
        Mode::Explore => explore(model, command),
        Mode::Help { scroll } => {
            let scroll = *scroll;
            model.mode = match command {
                Command::Select(lines) => {
                    let last = help_end(model);
                    let lines = lines.signum() as i16;
                    Mode::Help { scroll: scroll.min(last).saturating_add_signed(lines).min(last) }
                }
                _ => Mode::Explore,
            };
            Vec::new()
        }
        Mode::Edit(line) => match command {
            Command::Accept => {
                let typed = line.text();
                model.mode = Mode::Explore;
                accept_value(model, &typed)
            }
            _ => edit_line(model, command),
        },
        Mode::SaveAs { line, then_quit } => match command {
            Command::Accept => {
                let path = PathBuf::from(line.text().trim());
                if path.as_os_str().is_empty() {
                    return Vec::new();
                }
                // Kept until the outcome is known, for the question whether to overwrite.
                model.mode = Mode::Overwrite { path: path.clone(), then_quit: *then_quit };
                vec![Effect::Save { path, overwrite: false }]
            }
            _ => edit_line(model, command),
        },
        Mode::Overwrite { path, .. } => match command {
            Command::Accept => vec![Effect::Save { path: path.clone(), overwrite: true }],
            _ => {
                model.mode = Mode::Explore;
                Vec::new()
            }
        },
        Mode::Quit => {
            match command {
                Command::QuitAnyway => model.finished = true,
                Command::Save => model.mode = save_as(&model.document, true),
                _ => model.mode = Mode::Explore,
            }
            Vec::new()
        }
    }
}

fn typed(model: &mut Model, edit: impl FnOnce(&mut TextLine)) {
    if let Mode::Edit(line) | Mode::SaveAs { line, .. } = &mut model.mode {
        edit(line);
    }
}

fn edit_line(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::Move(motion) => typed(model, |line| line.go(motion)),
        Command::Delete { backwards } => typed(model, |line| line.delete(backwards)),
        Command::Clear => typed(model, TextLine::clear),
        _ => model.mode = Mode::Explore,
    }
    Vec::new()
}

fn explore(model: &mut Model, command: Command) -> Vec<Effect> {
    // Why there is no curve stays to be read; all else goes with the next key.
    if model.is_current() || model.is_computing() {
        model.notice = None;
    }
    match command {
        Command::Quit if model.is_unsaved() => model.mode = Mode::Quit,
        Command::Quit | Command::QuitAnyway => model.finished = true,
        Command::Help => model.mode = Mode::Help { scroll: 0 },
        Command::TogglePlay => {
            let at_end = model.player.done >= 1.0 && model.player.leg + 1 >= model.legs().len();
            if at_end && !model.player.playing {
                model.player = Player { leg: 0, done: 0.0, playing: true };
            } else {
                model.player.playing = !model.player.playing;
            }
            return vec![Effect::Show];
        }
        Command::Step(steps) => {
            model.player.playing = false;
            advance(
                &mut model.player,
                f64::from(steps) / STEPS,
                model.computed.as_ref().map_or(0, |c| c.outcome.history.legs.len()),
            );
            return vec![Effect::Show];
        }
        Command::Restart => {
            model.player = Player { leg: 0, done: 0.0, playing: true };
            return vec![Effect::Show];
        }
        Command::Leg(legs) => {
            // Back from inside a leg goes to its start.
            let back = legs < 0 && model.player.done > 0.0;
            let leg = model.player.leg.saturating_add_signed(if back { 0 } else { legs as isize });
            model.player.leg = leg.min(model.legs().len().saturating_sub(1));
            model.player.done = 0.0;
            return vec![Effect::Show];
        }
        Command::Select(rows) => {
            select(model, model.selected.saturating_add_signed(rows as isize));
            return show_parameters(model);
        }
        Command::SelectEnd(last) => {
            select(model, if last { usize::MAX } else { 0 });
            return show_parameters(model);
        }
        Command::StepValue { steps, coarse } => {
            let mut effects = show_parameters(model);
            effects.extend(step_value(model, steps, coarse));
            return effects;
        }
        Command::EditValue => {
            if let Some(parameter) = model.parameter() {
                model.mode = Mode::Edit(TextLine::new(&parameter.written));
            }
            return show_parameters(model);
        }
        Command::Reseed => return vec![Effect::DrawSeed],
        Command::Undo | Command::Redo => return undo(model, command == Command::Undo),
        Command::Save => model.mode = save_as(&model.document, false),
        Command::Fragment(step) => {
            let fragment = model.moment.as_ref().and_then(|moment| moment.close_up.fragment);
            let middle = fragment.map(|fragment| fragment.middle());
            model.look.focus = if step > 0 { Focus::After(middle) } else { Focus::Before(middle) };
            return vec![Effect::Show];
        }
        Command::FocusSummit => {
            model.look.focus = Focus::Summit;
            return vec![Effect::Show];
        }
        Command::Zoom(steps) => {
            let springs = model.look.springs;
            let most = model.document.scene().numerics.points.max(8) as usize;
            model.look.springs = if steps > 0 { springs / 2 } else { springs * 2 }.clamp(8, most);
            return vec![Effect::Show];
        }
        Command::Preset(index) => {
            if let Some(preset) = presets().get(index) {
                match Document::parse(preset.text, preset.name) {
                    Ok(document) => {
                        if model.is_unsaved() {
                            let kept = "the changed scene is kept: undo brings it back";
                            model.notice = Some(Notice::Done(kept.to_owned()));
                        }
                        model.player = Player { leg: 0, done: 0.0, playing: true };
                        model.look = Look { focus: Focus::Summit, springs: Look::springs_shown(&document) };
                        let effects = adopt(model, document);
                        model.set_saved();
                        return effects;
                    }
                    Err(errors) => model.notice = Some(Notice::Error(errors.to_string())),
                }
            }
        }
        Command::NextPane => {
            let place = Pane::ALL.iter().position(|pane| *pane == model.pane).unwrap_or(0);
            model.pane = Pane::ALL[(place + 1) % Pane::ALL.len()];
            return vec![Effect::Show];
        }
        Command::ZoomPane => {
            model.zoomed = !model.zoomed;
            return vec![Effect::Show];
        }
        Command::Accept | Command::Cancel | Command::Move(_) | Command::Delete { .. } | Command::Clear => {}
    }
    Vec::new()
}

fn select(model: &mut Model, row: usize) {
    model.selected = row.min(model.parameters.len().saturating_sub(1));
    model.refused = None;
}

/// Chooses the list of parameters where a small window does not show it: nothing is changed unseen.
fn show_parameters(model: &mut Model) -> Vec<Effect> {
    if Layout::of(model).pane(Pane::Parameters).is_some() {
        return Vec::new();
    }
    model.pane = Pane::Parameters;
    vec![Effect::Show]
}

fn step_value(model: &mut Model, steps: i32, coarse: bool) -> Vec<Effect> {
    let Some(parameter) = model.parameter() else { return Vec::new() };
    let Some(next) = parameter.field.stepped(&parameter.written, steps, coarse) else {
        let allowed = parameter.field.allowed();
        model.refused = Some((model.selected, format!("no further step; allowed: {allowed}")));
        return Vec::new();
    };
    let path = parameter.path.clone();
    change(model, &path, &next)
}

fn accept_value(model: &mut Model, typed: &str) -> Vec<Effect> {
    let Some(parameter) = model.parameter() else { return Vec::new() };
    match parameter.read_typed(typed) {
        Ok(written) => {
            let path = parameter.path.clone();
            change(model, &path, &written)
        }
        Err(error) => {
            model.refused = Some((model.selected, error));
            Vec::new()
        }
    }
}

/// Sets a field; a value that is not allowed leaves the scene as it is.
fn change(model: &mut Model, path: &str, value: &str) -> Vec<Effect> {
    match model.document.set(path, value) {
        Ok(document) => adopt(model, document),
        Err(errors) => {
            let what: Vec<String> = errors.iter().map(|error| error.what().to_string()).collect();
            model.refused = Some((model.selected, what.join("; ")));
            Vec::new()
        }
    }
}

/// Makes a document the one that is explored; the one before can be brought back.
fn adopt(model: &mut Model, document: Document) -> Vec<Effect> {
    let before = std::mem::replace(&mut model.document, document);
    model.undo.push(before);
    if model.undo.len() > UNDO_DEPTH {
        model.undo.remove(0);
    }
    model.redo.clear();
    renew(model)
}

fn undo(model: &mut Model, back: bool) -> Vec<Effect> {
    let (from, to) =
        if back { (&mut model.undo, &mut model.redo) } else { (&mut model.redo, &mut model.undo) };
    let Some(document) = from.pop() else { return Vec::new() };
    to.push(std::mem::replace(&mut model.document, document));
    renew(model)
}

/// Asks for the scene as it is now.
fn renew(model: &mut Model) -> Vec<Effect> {
    let selected = model.parameter().map(|parameter| parameter.path.clone());
    model.parameters = parameters(&model.document);
    // The selection stays on its field when rows come and go.
    let place = model.parameters.iter().position(|parameter| Some(&parameter.path) == selected.as_ref());
    model.selected = place.unwrap_or(model.selected).min(model.parameters.len().saturating_sub(1));
    model.refused = None;
    model.generation += 1;
    model.progress = Some(0);
    vec![Effect::Compute]
}

fn elapse(model: &mut Model, time: Duration) -> Vec<Effect> {
    if !model.player.playing || model.legs().is_empty() || !model.is_current() {
        return Vec::new();
    }
    let legs = model.legs().len();
    advance(&mut model.player, time.as_secs_f64() / LEG_TIME.as_secs_f64(), legs);
    if model.player.done >= 1.0 && model.player.leg + 1 >= legs {
        model.player.playing = false;
    }
    vec![Effect::Show]
}

/// Moves the animation by a share of a leg, from leg to leg.
fn advance(player: &mut Player, share: f64, legs: usize) {
    player.done += share;
    if player.done > 1.0 && player.leg + 1 < legs {
        player.leg += 1;
        player.done = 0.0;
    } else if player.done < 0.0 && player.leg > 0 {
        player.leg -= 1;
        player.done = 1.0;
    }
    player.done = player.done.clamp(0.0, 1.0);
}

fn save_as(document: &Document, then_quit: bool) -> Mode {
    let name = document.name();
    let is_file = std::path::Path::new(name).extension().is_some_and(|extension| extension == "ron");
    let line = TextLine::new(&if is_file { name.to_owned() } else { format!("{name}.ron") });
    Mode::SaveAs { line, then_quit }
}

fn saved(model: &mut Model, result: Result<PathBuf, SaveError>) {
    let then_quit = matches!(model.mode, Mode::Overwrite { then_quit: true, .. });
    match result {
        Ok(path) => {
            model.set_saved();
            model.notice = Some(Notice::Done(format!("saved to {}", path.display())));
            model.mode = Mode::Explore;
            model.finished = then_quit;
        }
        Err(SaveError::Exists(path)) => model.mode = Mode::Overwrite { path, then_quit },
        Err(SaveError::Refused(error)) => {
            model.notice = Some(Notice::Error(format!("not saved: {error}")));
            model.mode = Mode::Explore;
        }
    }
}
