//! Prompts: opening, editing, accepting and cancelling them.

use super::{accuracy, edit, files, measured, movement, target};
use crate::explorer::action::{OutputFile, Task};
use crate::explorer::app::App;
use crate::explorer::completion::common_start;
use crate::explorer::keys::bindings::{Command, Context};
use crate::explorer::layout::Layout;
use crate::explorer::pane::Pane;
use crate::explorer::panes;
use crate::explorer::prompt::{Aim, Prompt, Purpose, Topic};
use asperity_scene::library::{Entry, typed_path};
use asperity_scene::presets;
use crossterm::event::{KeyCode, KeyEvent};
use tui_input::InputRequest;

/// Name of the help, a list that is only read: its entries cannot be chosen.
const HELP: &str = "Help";

/// Opens the search of the list of parameters, and its pane.
pub fn find_parameter(app: &mut App) {
    app.ask(
        Purpose::Parameter {
            before: app.view.pane,
        },
        "",
    );
    edit::show_parameters(app)
}

pub fn open_library(app: &mut App) {
    app.ask(Purpose::Scene(Vec::new()), "");
    app.effects.push(Task::List);
}

pub fn listed(app: &mut App, entries: Vec<Entry>) {
    if let Some(prompt) = &mut app.prompt {
        prompt.purpose = Purpose::Scene(entries);
        prompt.search(&app.edit.parameters);
    }
}

/// Opens the help: the notice of the scene, for which a small window has no room, the contents of
/// the panes, and all keys.
pub fn open_help(app: &mut App) {
    let topic = |name: &str, text: &str| Topic {
        section: "What you see",
        name: name.to_owned(),
        text: text.to_owned(),
        words: String::new(),
        aim: Aim::Nothing,
    };
    let notice = app
        .edit
        .document
        .scene()
        .notice
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let notice = (!notice.is_empty()).then(|| topic("This scene", &notice));
    let panes = Pane::ALL
        .iter()
        .flat_map(|pane| panes::row(*pane).help)
        .map(|(name, text)| topic(name, text));
    let keys = app.config.bindings.rows().map(Topic::of);
    let topics = notice.into_iter().chain(panes).chain(keys).collect();
    app.ask(
        Purpose::Topics {
            name: HELP,
            topics,
            is_typed: false,
        },
        "",
    );
}

/// Opens the list of commands, of the parameters of the scene, and of the built-in scenes.
pub fn open_commands(app: &mut App) {
    let commands = app.config.bindings.listed().map(Topic::of);
    let parameters = app
        .edit
        .parameters
        .iter()
        .enumerate()
        .map(Topic::of_parameter);
    let topics = commands
        .chain(parameters)
        .chain(presets().iter().map(Topic::of_preset))
        .collect();
    app.ask(
        Purpose::Topics {
            name: "Commands",
            topics,
            is_typed: true,
        },
        "",
    );
}

/// Searches the help for what is typed next.
pub fn search_help(app: &mut App) {
    if let Some(Purpose::Topics { is_typed, .. }) =
        app.prompt.as_mut().map(|prompt| &mut prompt.purpose)
    {
        *is_typed = true;
    }
}

/// Moves the selection of the list by a number of rows.
pub fn select(app: &mut App, rows: i32) {
    if let Some(prompt) = &mut app.prompt {
        let last = prompt.found.len().saturating_sub(1);
        prompt.selected = prompt
            .selected
            .saturating_add_signed(rows as isize)
            .min(last);
    }
}

/// Moves the selection of the list to the row that a key asks for.
pub fn select_by(app: &mut App, key: &KeyEvent) {
    select(
        app,
        match key.code {
            KeyCode::Home | KeyCode::Char('g') => i32::MIN,
            KeyCode::End | KeyCode::Char('G') => i32::MAX,
            KeyCode::Up | KeyCode::Char('k' | 'p') => -1,
            _ => 1,
        },
    );
}

/// Moves the selection of the list, or of the parameters, by a page: half the rows of a window,
/// since an entry may take two rows.
pub fn page(app: &mut App, key: &KeyEvent) {
    let rows = i32::from(Layout::of(app).body().height / 2).max(1);
    let rows = if key.code == KeyCode::PageUp {
        -rows
    } else {
        rows
    };
    if app.prompt.is_some() {
        select(app, rows)
    } else {
        edit::move_selection(app, rows)
    }
}

/// Accepts the typed line, the selected row, or the question. A refused line stays in the prompt,
/// with the reason.
pub fn accept(app: &mut App) {
    let Some(mut prompt) = app.prompt.take() else {
        return;
    };
    if let Purpose::Topics {
        name: HELP,
        is_typed: is_typed @ true,
        ..
    } = &mut prompt.purpose
    {
        // The search of the help is over, and its results stay.
        *is_typed = false;
        app.prompt = Some(prompt);
        return;
    }
    if let Err(why) = accept_prompt(app, &prompt) {
        app.prompt = Some(Prompt {
            refused: Some(why),
            ..prompt
        });
    }
}

fn accept_prompt(app: &mut App, prompt: &Prompt) -> Result<(), String> {
    let typed = prompt.line.text();
    let nothing = || "nothing in the list fits".to_owned();
    match &prompt.purpose {
        Purpose::Value if measured::is_option(app) => return measured::accept_option(app, typed),
        Purpose::Value => return edit::accept_value(app, typed),
        Purpose::Target => return target::accept(app, typed),
        Purpose::Force => return movement::accept_force(app, typed),
        Purpose::Tolerance => return accuracy::accept_tolerance(app, typed),
        Purpose::Fit => return measured::accept_fit(app, typed),
        Purpose::Save { then_quit } => return files::save(app, typed_path(typed), *then_quit),
        Purpose::Export => return files::export(app, typed_path(typed)),
        Purpose::Scene(_) => match prompt.scene() {
            Some(entry) => {
                let document = entry
                    .document
                    .clone()
                    .map_err(|errors| errors.to_string())?;
                edit::open(app, document);
            }
            None if typed.trim().is_empty() => return Err("type a name or a path".to_owned()),
            // The path of a scene, or of a study.
            None => {
                let path = typed_path(typed.trim()).to_string_lossy().into_owned();
                app.effects.push(Task::Open(path));
            }
        },
        Purpose::Parameter { .. } => {
            app.edit.select(prompt.choice().ok_or_else(nothing)?);
            app.show(Pane::Parameters);
        }
        Purpose::Topics { topics, .. } => {
            let topic = prompt
                .choice()
                .and_then(|index| topics.get(index))
                .ok_or_else(nothing)?;
            match &topic.aim {
                Aim::Nothing => {}
                Aim::Command(row) => choose(app, Command { row, key: None }),
                Aim::Parameter(row) => {
                    app.edit.select(*row);
                    app.show(Pane::Parameters);
                }
                Aim::Open(name) => app.effects.push(Task::Open(name.clone())),
            }
        }
        Purpose::Overwrite(file) => {
            app.effects.push(Task::Write(OutputFile {
                overwrite: true,
                ..file.clone()
            }));
        }
        Purpose::Leave => {}
    }
    Ok(())
}

pub fn cancel(app: &mut App) {
    match app.prompt.take().map(|prompt| prompt.purpose) {
        Some(Purpose::Value) => edit::preview(app),
        Some(Purpose::Target) => app.effects.push(Task::Study),
        Some(Purpose::Parameter { before }) => app.view.pane = before,
        _ => {}
    }
}

/// Chooses a command of the list, to be run in a pane in which its key is valid.
fn choose(app: &mut App, command: Command) {
    let is_valid = |context: Context| command.row.contexts.contains(&context);
    match app.keys() {
        here if is_valid(here) => {}
        _ if is_valid(Context::Parameters) => app.show(Pane::Parameters),
        _ if is_valid(Context::Explore) => app.show(Pane::Force),
        _ => app.show(Pane::Map),
    }
    app.chosen = Some(command);
}

/// Paths of parameters whose values contain names of files.
const WITH_FILES: [&str; 4] = [
    "roughness",
    "roughness.file",
    "roughness.further_files",
    "roughness.opposite",
];

/// The path being typed: the whole line, or in a value what follows the last quote, relative to the
/// folder of the scene.
fn typed_in_line(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let text = prompt.line.text().trim_start();
    match prompt.purpose {
        Purpose::Save { .. } | Purpose::Export | Purpose::Scene(_) => Some(text.to_owned()),
        Purpose::Value if WITH_FILES.contains(&app.edit.parameter()?.path.as_str()) => {
            let path = text.rsplit('"').next().unwrap_or(text);
            Some(
                app.edit
                    .document
                    .resolve(path)
                    .to_string_lossy()
                    .into_owned(),
            )
        }
        _ => None,
    }
}

pub fn can_complete(app: &App) -> bool {
    typed_in_line(app).is_some()
}

/// Requests the paths that begin as the typed one.
pub fn complete(app: &mut App) {
    if let Some(path) = typed_in_line(app) {
        app.effects.push(Task::Complete(path));
    }
}

/// Completes the typed path by what all these paths begin with, and shows them if they are several.
pub fn completed(app: &mut App, paths: Vec<String>) {
    let Some(typed) = typed_in_line(app) else {
        return;
    };
    let common = common_start(&paths);
    if let Some(rest) = common.strip_prefix(&typed) {
        edit::edit_line(app, |line| {
            line.edit(InputRequest::GoToEnd);
            line.insert(rest);
        });
    }
    app.refuse(
        paths
            .is_empty()
            .then(|| "no file or folder begins so".to_owned()),
    );
    if let Some(prompt) = &mut app.prompt {
        prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
    }
}
