//! Effect of each action on the model. Nothing here touches terminal, files or worker: work to be
//! done outside is returned.

mod accuracy;
pub(super) mod chart;
mod compare;
mod complete;
mod crosshair;
pub(super) mod edit;
mod files;
mod find;
mod ghosts;
mod library;
pub(super) mod look;
mod mouse;
pub(super) mod movement;
mod palette;
mod show;

pub use accuracy::study_tasks;
pub use complete::can_complete;

use super::action::{Action, Command, Content};
use super::layout::Layout;
use super::mode::Mode;
use super::model::{Model, Notice, Pane, Player};
use super::request::{ManualMove, SnapshotRequest};
use super::snapshot::Report;
use super::theme::Appearance;
use super::view::help_end;
use crate::scene::{Document, typed_path};
use std::path::PathBuf;

/// Something to be done outside the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Compute the scene.
    Compute,
    /// Show the present snapshot of the contact.
    Show,
    /// Compute the scene that is shown beside, or forget the last one.
    Beside,
    /// Work out what is not known yet of the scene's accuracy, see [`study_tasks`], and nothing else.
    Study,
    /// Move the body manually.
    Manual(ManualMove),
    /// Draw a random seed and give it back as an action.
    DrawSeed,
    /// Write a file.
    Write {
        /// The file.
        path: PathBuf,
        /// Content.
        content: Content,
        /// True if to overwrite it.
        overwrite: bool,
    },
    /// Keep colours and markers in the configuration file.
    Remember {
        /// The file.
        path: PathBuf,
        /// Colours and markers.
        appearance: Appearance,
    },
    /// List the scenes of the library.
    List,
    /// List the paths that complete a typed one.
    Complete(String),
    /// Open a scene or a study by its path.
    Open(String),
    /// Compute a scene to look at its curve.
    Preview(Box<Document>),
    /// Compute no scene to look at any more.
    StopPreview,
    /// Copy a text.
    Copy(String),
    /// Hand the terminal back to the shell for a while.
    Suspend,
}

/// Applies an action and returns the effects to perform outside.
pub fn update(model: &mut Model, action: Action) -> Vec<Effect> {
    match action {
        Action::Command(Command::Suspend) => return vec![Effect::Suspend],
        Action::Command(command) => return obey(model, command),
        Action::Type(character) => return typed(model, &character.to_string()),
        Action::Paste(text) => return typed(model, &text),
        Action::Resize(columns, rows) => {
            model.size = (columns, rows);
            return vec![Effect::Show];
        }
        Action::Elapse(time) => return movement::elapse(model, time),
        Action::SetSeed(seed) => match model.document.scene().seed() {
            Some(_) => {
                return edit::change(model, "roughness.seed", &seed.to_string());
            }
            _ => model.notice = Some(Notice::Error("the scene has no random line to draw anew".to_owned())),
        },
        Action::Report(report) => return reported(model, report),
        Action::Found(found) => return accuracy::found(model, found),
        Action::Written(result) => files::written(model, result),
        Action::Listed(entries) => return library::listed(model, entries),
        Action::Completed { typed, paths } => return complete::completed(model, &typed, paths),
        Action::Opened(Ok(opening)) => return chart::open(model, *opening),
        Action::Opened(Err(why)) => model.notice = Some(Notice::Error(why)),
        Action::Remembered(Ok(path)) => {
            model.notice = Some(Notice::Done(format!("colours and markers are kept in {}", path.display())));
        }
        Action::Remembered(Err(why)) => model.notice = Some(Notice::Error(why)),
        Action::Offered(names) if model.mode == Mode::Explore && model.notice.is_none() => {
            let of = names.join(", ");
            let text = format!(
                "unsaved changes of {of} are kept from another session: asperity --restore opens them"
            );
            model.notice = Some(Notice::Done(text));
        }
        Action::Offered(_) => {}
        Action::NotKept(why) => {
            model.notice =
                Some(Notice::Error(format!("unsaved changes are not kept for another session: {why}")));
        }
        Action::Traffic(traffic) => model.traffic = Some(traffic),
        Action::Mouse(mouse) => return mouse::act(model, mouse),
    }
    Vec::new()
}

/// Takes in a report of the worker, unless the scene or the text has been changed since.
fn reported(model: &mut Model, report: Report) -> Vec<Effect> {
    match report {
        Report::Computed(computed) if computed.generation == model.generation => {
            model.progress = None;
            let last = computed.outcome.history.legs.len().saturating_sub(1);
            model.computed = Some(computed);
            movement::stay_on_legs(model, last);
            if matches!(model.notice, Some(Notice::Error(_))) {
                model.notice = None;
            }
            if let Some(document) = model.opens_beside.take() {
                return compare::open_beside(model, document);
            }
            return vec![Effect::Show, Effect::Study];
        }
        Report::Shown(snapshot) if snapshot.generation == model.generation => {
            movement::shown(model, snapshot)
        }
        Report::Progress { generation, legs } if generation == model.generation => {
            model.progress = model.progress.map(|_| legs);
        }
        Report::Failed { generation, error } if generation == model.generation => {
            model.progress = None;
            model.notice = Some(Notice::Error(error));
        }
        Report::Computed(_) | Report::Shown(_) | Report::Progress { .. } | Report::Failed { .. } => {}
        Report::Previewed(preview)
            if matches!(model.mode, Mode::Edit(_))
                && model.tried.as_ref() != Some(&preview.text)
                && model.next_ghost.is_none() => {}
        Report::Previewed(preview) => return compare::previewed(model, preview),
    }
    Vec::new()
}

/// Request to the worker for the panes of this model.
#[must_use]
pub fn moment_request(model: &Model) -> Option<SnapshotRequest> {
    if !model.is_current() {
        return None;
    }
    let layout = Layout::of(model);
    let dots = model.appearance.marker.columns();
    Some(SnapshotRequest {
        generation: model.generation,
        drive: model.drive(),
        indentation: model.indentation(),
        profile_columns: dots * layout.profile_cells(),
        profile: model.profile,
        close_up_columns: dots * layout.close_up_cells(),
        strip_cells: layout.close_up_cells(),
        focus: model.look.focus,
        close_up_springs: model.look.springs,
        large: model.large,
        lower: model.lower,
        crosshair: model.crosshair.map(|crosshair| crosshair.position),
        beside: model.beside().filter(|_| layout.pane(Pane::Beside).is_some()).map(|ghost| {
            let legs = &ghost.computed.outcome.history.legs;
            let leg = model.player.leg.min(legs.len().saturating_sub(1));
            (leg, Player { leg, ..model.player }.indentation(legs))
        }),
    })
}

fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    if command == Command::Complete {
        return complete::obey(model);
    }
    model.completion = None;
    match &mut model.mode {
        Mode::Explore => return explore(model, command),
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
        }
        Mode::Library(_) => return library::obey(model, command),
        Mode::Find(_) => return find::obey(model, command),
        Mode::Palette(_) => return palette::obey(model, command),
        Mode::Edit(line) => match command {
            Command::Accept => {
                let typed = line.text();
                return edit::accept_value(model, &typed);
            }
            _ => {
                model.refused = None;
                edit_line(model, command);
                return edit::preview(model);
            }
        },
        Mode::Force(line) => match command {
            Command::Accept => {
                let typed = line.text();
                model.mode = Mode::Explore;
                return movement::accept_force(model, &typed);
            }
            _ => edit_line(model, command),
        },
        Mode::Tolerance(line) => match command {
            Command::Accept => {
                let typed = line.text();
                model.mode = Mode::Explore;
                return accuracy::accept_tolerance(model, &typed);
            }
            _ => edit_line(model, command),
        },
        Mode::SaveAs(form) => match command {
            Command::Accept => {
                let form = form.clone();
                return files::save(model, &form);
            }
            Command::NextLine(lines) => form.go(lines),
            _ => edit_line(model, command),
        },
        Mode::StaleComments { path, then_quit, .. } => {
            let (path, then_quit) = (path.clone(), *then_quit);
            return match command {
                Command::Accept => files::save_without_comments(model, path, then_quit),
                Command::Refuse => files::write(model, path, Content::Scene, then_quit),
                _ => {
                    model.mode = Mode::Explore;
                    Vec::new()
                }
            };
        }
        Mode::Export(line) => match command {
            Command::Accept => {
                let path = typed_path(&line.text());
                return files::export(model, path);
            }
            _ => edit_line(model, command),
        },
        Mode::Overwrite { path, content, then_quit } => match command {
            Command::Accept => {
                let (path, content, then_quit) = (path.clone(), *content, *then_quit);
                return files::overwrite(model, path, content, then_quit);
            }
            _ => model.mode = Mode::Explore,
        },
        Mode::Quit => match command {
            Command::QuitAnyway => files::quit(model),
            Command::Save => return files::save_before_leaving(model),
            _ => model.mode = Mode::Explore,
        },
    }
    Vec::new()
}

/// Text typed or pasted into the line there is.
fn typed(model: &mut Model, text: &str) -> Vec<Effect> {
    if let Mode::Edit(_) = model.mode {
        model.refused = None;
    }
    model.completion = None;
    if let Some(line) = model.mode.line_mut() {
        text.chars().for_each(|character| line.insert(character));
    }
    match model.mode {
        Mode::Edit(_) => edit::preview(model),
        Mode::Library(_) => library::search(model),
        Mode::Find(_) => find::search(model),
        Mode::Palette(_) => palette::search(model),
        _ => Vec::new(),
    }
}

/// A command within the line that is being typed; any other leaves it.
fn edit_line(model: &mut Model, command: Command) {
    let Some(line) = model.mode.line_mut() else { return };
    match command {
        Command::Move(motion) => line.go(motion),
        Command::Delete { backwards } => line.delete(backwards),
        Command::Clear => line.clear(),
        _ => model.mode = Mode::Explore,
    }
}

/// Obeys a command while no line, list or question is open.
pub(super) fn explore(model: &mut Model, command: Command) -> Vec<Effect> {
    if !matches!(command, Command::MoveAcross(_) | Command::MoveUp(_)) {
        model.chart.moving = false;
    }
    // Why there is no curve stays to be read; all else goes with the next key.
    if model.is_current() || model.is_computing() {
        model.notice = None;
    }
    match command {
        Command::Quit if !model.unsaved().is_empty() => model.mode = Mode::Quit,
        Command::Quit | Command::QuitAnyway => files::quit(model),
        Command::Help => model.mode = Mode::Help { scroll: 0 },
        Command::TogglePlay
        | Command::Step(_)
        | Command::Restart
        | Command::Leg(_)
        | Command::ToggleManual
        | Command::Push { .. }
        | Command::TypeForce
        | Command::Separate => return movement::obey(model, command),
        Command::Select(_)
        | Command::SelectEnd(_)
        | Command::StepValue { .. }
        | Command::EditValue
        | Command::StartValue(_)
        | Command::ToggleFold
        | Command::ToggleEffect
        | Command::Preset(_) => return edit::obey(model, command),
        Command::FindParameter => return find::open(model),
        Command::OpenPalette => return palette::open(model),
        Command::Reseed => return vec![Effect::DrawSeed],
        Command::Undo | Command::Redo => return edit::undo(model, command == Command::Undo),
        Command::Pin
        | Command::PinOtherUse
        | Command::Swap
        | Command::ClearGhosts
        | Command::ToggleSideBySide => {
            return compare::obey(model, command);
        }
        Command::ToggleCrosshair
        | Command::MoveCrosshair { .. }
        | Command::CrosshairEnd(_)
        | Command::CrosshairStage(_) => return crosshair::obey(model, command),
        Command::Save => model.mode = files::save_as(&model.document, false),
        Command::Export => files::ask_export(model),
        Command::CopyCommand => return files::copy_command(model),
        Command::OpenLibrary => return library::open(model),
        Command::TypeTolerance => return accuracy::type_tolerance(model),
        Command::Toggle(pane) => return show::toggle(model, pane),
        Command::ToggleSections
        | Command::NextCharted
        | Command::ToggleStudy
        | Command::NextSlice(_)
        | Command::TransposeMap
        | Command::NextMapParameter
        | Command::MoveAcross(_)
        | Command::MoveUp(_) => return chart::obey(model, command),
        Command::Fragment(_)
        | Command::Zoom(_)
        | Command::Pan(_)
        | Command::ResetZoom
        | Command::ToggleFollow
        | Command::NextCurve
        | Command::ToggleNormalised
        | Command::ToggleLogarithmic
        | Command::ToggleLoss
        | Command::ToggleApproximate
        | Command::ZoomPane
        | Command::NextPane
        | Command::NextTheme
        | Command::ToggleWork
        | Command::NextMarker
        | Command::RememberAppearance => return look::obey(model, command),
        Command::Suspend
        | Command::NextLine(_)
        | Command::Accept
        | Command::Refuse
        | Command::Cancel
        | Command::Move(_)
        | Command::Delete { .. }
        | Command::Complete
        | Command::Clear => {}
    }
    Vec::new()
}
