//! The explorer: a blocking input thread and the worker send actions into one channel, `update`
//! changes the model, the views draw it. Nothing is computed on this thread and nothing wakes it while
//! nothing happens.

pub mod action;
pub mod keys;
pub mod layout;
pub mod model;
pub mod parameters;
pub mod picture;
pub mod reduce;
pub mod snapshot;
mod terminal;
mod text_line;
pub mod theme;
pub mod update;
pub mod view;
pub mod worker;

use crate::export::{WriteError, write_new};
use crate::scene::Document;
use crate::simulation::Simulation;
use action::{Action, SaveError};
use crossterm::event::{Event, KeyCode, KeyEventKind, KeyModifiers};
use model::Model;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::{Position, Rect};
use ratatui::{Frame, Terminal};
use std::io::{self, Write};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use terminal::{FrameWriter, TerminalGuard};
use theme::Theme;
use update::{Effect, moment_request, update};
use worker::{Engine, Report, Request, Worker};

/// Frames in a second: fewer over SSH, where each has to travel.
const LOCAL_FRAMES: u32 = 30;
const REMOTE_FRAMES: u32 = 12;

/// Something from outside: input of the user, or its end, or a report of the worker.
enum Message {
    Input(Event),
    InputEnded,
    Report(Report),
}

/// Opens the explorer on a scene and returns the document as it was left.
///
/// # Errors
/// When the terminal refuses.
pub fn open(document: Document, folder: PathBuf) -> io::Result<Document> {
    open_with(document, Box::new(Simulation::new(folder)), view::draw)
}

/// Draws a model: [`view::draw`] does.
pub type Draw = fn(&mut Frame<'_>, &Model);

/// Opens the explorer on a scene with another engine behind it and another view before it.
///
/// # Errors
/// When the terminal refuses.
pub fn open_with(document: Document, engine: Box<dyn Engine>, draw: Draw) -> io::Result<Document> {
    let guard = TerminalGuard::take()?;
    let (messages, inbox) = channel();
    let (requests, outbox) = channel();
    let newest = worker::Newest::new(AtomicU64::new(0));
    let reports = messages.clone();
    worker::start(engine, Arc::clone(&newest), outbox, move |report| {
        reports.send(Message::Report(report)).is_ok()
    })?;
    terminal::watch_for_hang_up({
        let messages = messages.clone();
        move || drop(messages.send(Message::InputEnded))
    })?;
    read_input(messages)?;
    let worker = Worker::new(requests, newest);
    // The guard gives everything back; ratatui's own drop would complain on standard error, and panic
    // where that is gone together with the terminal.
    let mut terminal = ManuallyDrop::new(Terminal::new(CrosstermBackend::new(FrameWriter::new()))?);
    let size = terminal.size()?;
    let model = Model::new(document, (size.width, size.height), Theme::of_environment());
    let model = explore(&mut terminal, model, &worker, &inbox, draw)?;
    drop(guard);
    Ok(model.document)
}

/// Reads input on a thread of its own, which ends with the terminal or the explorer.
fn read_input(messages: Sender<Message>) -> io::Result<()> {
    std::thread::Builder::new()
        .name("input".to_owned())
        .spawn(move || {
            loop {
                let message = crossterm::event::read().map_or(Message::InputEnded, Message::Input);
                let ended = matches!(message, Message::InputEnded);
                // A dropped connection must not leave a process behind that reads nothing for ever.
                if messages.send(message).is_err() || ended {
                    return;
                }
            }
        })
        .map(drop)
}

fn explore<W: Write>(
    terminal: &mut Terminal<CrosstermBackend<W>>,
    mut model: Model,
    worker: &Worker,
    inbox: &Receiver<Message>,
    draw: Draw,
) -> io::Result<Model> {
    let remote = ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| std::env::var_os(name).is_some());
    let frame_time = Duration::from_secs(1) / if remote { REMOTE_FRAMES } else { LOCAL_FRAMES };
    perform(&mut model, worker, vec![Effect::Compute]);
    let mut moved = Instant::now();
    let (mut changed, mut resized) = (true, false);
    while !model.finished {
        if std::mem::take(&mut resized) {
            // Unlike `clear` this does not ask the terminal where its cursor is, on the input that the
            // other thread reads.
            let size = terminal.size()?;
            terminal.resize(Rect::from((Position::ORIGIN, size)))?;
        }
        if changed {
            terminal.draw(|frame| draw(frame, &model))?;
            changed = false;
        }
        let playing = model.player.playing && model.is_current();
        if !playing {
            moved = Instant::now();
        }
        let wait = playing.then(|| frame_time.saturating_sub(moved.elapsed()));
        let first =
            match wait.map_or_else(|| inbox.recv().map_err(Into::into), |wait| inbox.recv_timeout(wait)) {
                Ok(message) => Some(message),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => break,
            };
        for message in first.into_iter().chain(inbox.try_iter()) {
            let action = match message {
                Message::InputEnded => return Ok(model),
                // In the mode that holds by now: the key before may have changed it.
                Message::Input(event) => action_of(&event, &model),
                Message::Report(report) => Some(action_of_report(report)),
            };
            if let Some(action) = action {
                changed = true;
                // A window that shrank and grew back between two frames has lost what stood there,
                // though its size is that of the last frame.
                resized |= matches!(action, Action::Resize(..));
                act(&mut model, worker, action);
            }
        }
        if playing && moved.elapsed() >= frame_time {
            // Time by itself shows nothing: the moment it asks for does.
            let elapsed = moved.elapsed().min(4 * frame_time);
            moved = Instant::now();
            act(&mut model, worker, Action::Elapse(elapsed));
        }
    }
    Ok(model)
}

fn act(model: &mut Model, worker: &Worker, action: Action) {
    let effects = update(model, action);
    perform(model, worker, effects);
}

/// The action of an input event; `None` for one that means nothing.
fn action_of(event: &Event, model: &Model) -> Option<Action> {
    match event {
        Event::Key(key) if key.kind == KeyEventKind::Press => {
            if let Some(command) = keys::command(key, model.mode.kind()) {
                return Some(Action::Command(command));
            }
            match key.code {
                KeyCode::Char(character)
                    if !key.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT) =>
                {
                    Some(Action::Type(character))
                }
                _ => None,
            }
        }
        Event::Paste(text) => Some(Action::Paste(text.clone())),
        Event::Resize(columns, rows) => Some(Action::Resize(*columns, *rows)),
        _ => None,
    }
}

fn action_of_report(report: Report) -> Action {
    match report {
        Report::Computed(computed) => Action::Computed(computed),
        Report::Shown(moment) => Action::Shown(moment),
        Report::Progress { generation, legs } => Action::Progress { generation, legs },
        Report::Failed { generation, error } => Action::Failed { generation, error },
    }
}

/// Does what an update asks for.
fn perform(model: &mut Model, worker: &Worker, effects: Vec<Effect>) {
    for effect in effects {
        match effect {
            Effect::Compute => worker.ask(Request::Compute {
                generation: model.generation,
                scene: Box::new(model.document.scene().clone()),
            }),
            Effect::Show => {
                if let Some(request) = moment_request(model) {
                    worker.ask(Request::Show(request));
                }
            }
            Effect::DrawSeed => {
                // Six digits are enough for another line and can be read out to a colleague.
                let seed = rand::random_range(0..1_000_000);
                act(model, worker, Action::SetSeed(seed));
            }
            Effect::Save { path, overwrite } => {
                let result = save(&path, overwrite, model.document.text());
                act(model, worker, Action::Saved(result.map(|()| path)));
            }
        }
    }
}

fn save(path: &Path, overwrite: bool, text: &str) -> Result<(), SaveError> {
    write_new(path, overwrite, |file| file.write_all(text.as_bytes())).map_err(|error| match error {
        WriteError::Exists { .. } => SaveError::Exists(path.to_owned()),
        other => SaveError::Refused(other.to_string()),
    })
}
