//! A session: the explorer in a terminal, with threads for input, signals, solver and studies.

use super::action::{Action, Task};
use super::app::App;
use super::autosave::{Autosave, Kept};
use super::commands::opening::begin;
use super::config::Config;
use super::opening::Opening;
use super::runtime::{Engine, Runtime};
use super::signals::{SystemSignal, watch_for_signals};
use super::snapshot::SolvedScene;
use super::solver::{Solve, SolverThread};
use super::studies::StudyThread;
use super::terminal::{FrameWriter, TerminalGuard};
use super::theme::{Appearance, Marker, Theme};
use super::{autosave, input, terminal};
use asperity_scene::Document;
use crossterm::clipboard::CopyToClipboard;
use crossterm::event::Event;
use crossterm::queue;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::{Position, Rect};
use ratatui::{Frame, Terminal};
use std::io;
use std::io::Stdout;
use std::mem::{ManuallyDrop, take};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};
use std::time::{Duration, Instant};

/// Limit of the frame rate over SSH, 1/s, where each frame has to be transmitted.
const REMOTE_FRAMES: u32 = 12;

/// Longest time for which a frame over SSH waits for the answer of the solver.
const ANSWER_TIME: Duration = Duration::from_millis(30);

/// Time without input after which unsaved changes are kept. Writing them waits for the disk, which
/// takes longer than a frame where home folders are on another machine.
const KEEPING_PAUSE: Duration = Duration::from_secs(1);

/// Number of input events that may wait for the loop; the terminal keeps further ones.
const MOST_WAITING: usize = 64;

/// Longest time in which actions are applied before a frame is drawn.
const DRAINING: Duration = Duration::from_millis(100);

pub struct Options {
    /// Colours; `None` to choose them by the environment.
    pub theme: Option<Theme>,
    /// Marker of plots; `None` to choose it by the environment.
    pub marker: Option<Marker>,
    /// Unsaved changes of another session; the opened scene is the first of them.
    pub restored: Option<Kept>,
    /// Configuration; the options here have precedence over it.
    pub config: Config,
    pub warning: Option<String>,
    /// Folder in which unsaved changes are kept; `None` to keep none.
    pub unsaved: Option<PathBuf>,
}

impl Options {
    /// Options of a session with this configuration.
    pub fn new(config: Config) -> Self {
        Options {
            theme: None,
            marker: None,
            restored: None,
            config,
            warning: None,
            unsaved: None,
        }
    }
}

pub struct SessionEnd {
    pub document: Document,
    pub computed: Option<Arc<SolvedScene>>,
    /// Number of the signal that ended the explorer; `None` if the user left it.
    pub signal: Option<i32>,
}

/// Function that draws the state of the explorer; see [`super::view::draw`].
pub type Draw = fn(&mut Frame<'_>, &App);

/// What a thread sends to the loop of the session.
enum Incoming {
    /// Input of the user; `None` when it ends.
    Input(Option<Event>),
    Signal(SystemSignal),
    /// Result of solver or studies.
    Act(Box<Action>),
}

/// Opens the explorer on a scene or a finished study, with functions that solve and draw, and
/// returns its final state.
pub fn open(
    opening: impl Into<Opening>,
    options: Options,
    solve: Solve,
    draw: Draw,
) -> io::Result<SessionEnd> {
    let size = terminal::window()?;
    let guard = TerminalGuard::take(options.config.mouse)?;
    // This sender lives as long as the session, so that the inbox is never closed.
    let (sender, inbox) = channel();
    let engine = start_engine(solve, &sender)?;
    let waiting = start_input(&sender)?;
    // The guard restores everything; ratatui's own drop would complain on standard error, and panic
    // where that is gone together with the terminal.
    let writer = FrameWriter::new(io::stdout());
    let mut terminal = ManuallyDrop::new(Terminal::new(CrosstermBackend::new(writer))?);
    let appearance = chosen_appearance(&options);
    let mut app = begin(
        opening.into(),
        (size.width, size.height),
        appearance,
        options.config,
    );
    let offer = restore_or_offer(
        &mut app,
        options.restored.as_ref(),
        options.unsaved.as_deref(),
    );
    app.state_beside(options.warning, offer);
    let autosave = options
        .unsaved
        .map(|folder| Autosave::new(&folder, options.restored));
    let remote = is_remote();
    let mut frame_rate = app.config.frame_rate;
    if remote {
        frame_rate = frame_rate.min(REMOTE_FRAMES);
    }
    let now = Instant::now();
    let mut session = Session {
        runtime: Runtime {
            app,
            engine,
            asked: 0,
            folder: PathBuf::new(),
        },
        terminal: &mut terminal,
        guard,
        redraw: false,
        draw,
        remote,
        frame_time: Duration::from_secs(1) / frame_rate,
        changed: true,
        due: now,
        asked: None,
        moved: now,
        inbox,
        waiting,
        autosave,
        kept: (0, 0),
        touched: now,
    };
    let end = catch_unwind(AssertUnwindSafe(|| session.run()));
    // After a panic too: another session can open them.
    session.keep_unsaved();
    match end {
        Ok(end) => Ok(session.end(end?)),
        Err(panic) => resume_unwind(panic),
    }
}

/// Takes over the unsaved changes of another session, or else returns the message that offers the
/// newest ones.
fn restore_or_offer(
    app: &mut App,
    restored: Option<&Kept>,
    unsaved: Option<&Path>,
) -> Option<String> {
    if let Some(kept) = restored {
        app.edit.restore(&kept.documents);
        return None;
    }
    autosave::offer(unsaved?)
}

/// Starts the threads of solver and studies, which send their results.
fn start_engine(solve: Solve, sender: &Sender<Incoming>) -> io::Result<Engine> {
    let replies = sender.clone();
    let solver = SolverThread::start(solve, move |reply| {
        let action = Box::new(Action::Reply(reply));
        let _ = replies.send(Incoming::Act(action));
    })?;
    let findings = sender.clone();
    let studies = StudyThread::start(move |finding| {
        let action = Box::new(Action::Found(finding));
        let _ = findings.send(Incoming::Act(action));
    })?;
    Ok(Engine::threads(solver, studies))
}

/// Starts the threads that wait for the user and the system. Returns a receiver with one entry for
/// each input event in the inbox: it is full if the loop cannot follow, and further input then
/// waits in the terminal.
fn start_input(sender: &Sender<Incoming>) -> io::Result<Receiver<()>> {
    let hang_up = sender.clone();
    terminal::watch_for_hang_up(move || {
        let _ = hang_up.send(Incoming::Input(None));
    })?;
    let signals = sender.clone();
    watch_for_signals(move |signal| signals.send(Incoming::Signal(signal)).is_ok())?;
    let events = sender.clone();
    let (places, waiting) = sync_channel(MOST_WAITING);
    input::read(move |event| {
        places.send(()).is_ok() && events.send(Incoming::Input(event)).is_ok()
    })?;
    Ok(waiting)
}

/// Appearance by the options of the command line, else by the configuration, else by the
/// environment.
fn chosen_appearance(options: &Options) -> Appearance {
    let environment = Appearance::of_environment();
    let config = &options.config;
    Appearance {
        theme: options.theme.or(config.theme).unwrap_or(environment.theme),
        marker: options
            .marker
            .or(config.markers)
            .unwrap_or(environment.marker),
    }
}

fn is_remote() -> bool {
    let variables = ["SSH_CONNECTION", "SSH_TTY"];
    variables
        .iter()
        .any(|name| std::env::var_os(name).is_some())
}

type Screen = Terminal<CrosstermBackend<FrameWriter<Stdout>>>;

struct Session<'a> {
    runtime: Runtime,
    terminal: &'a mut Screen,
    guard: TerminalGuard,
    /// True if the content of the screen is unknown and has to be drawn anew.
    redraw: bool,
    draw: Draw,
    remote: bool,
    /// Shortest time between two frames.
    frame_time: Duration,
    /// True if the state has changed since the last frame.
    changed: bool,
    /// Time before which nothing is drawn. Over SSH a held key or a dragged mouse would otherwise
    /// fill the line with frames that nobody sees in time.
    due: Instant,
    /// Time since which an answer of the solver is awaited, if one is.
    asked: Option<Instant>,
    /// Time of the last step of the animation.
    moved: Instant,
    inbox: Receiver<Incoming>,
    /// One entry for each input event in the inbox.
    waiting: Receiver<()>,
    autosave: Option<Autosave>,
    /// Generation of the scene and number of saves when changes were last kept.
    kept: (u64, u64),
    /// Time of the last input.
    touched: Instant,
}

/// Why a session ends without the user leaving it.
enum Interruption {
    /// The terminal is gone.
    NoInput,
    /// A signal with this number asked for it.
    Signal(i32),
}

impl Session<'_> {
    /// Runs until the explorer is to end; returns the number of the signal that ended it, if one
    /// did.
    fn run(&mut self) -> io::Result<Option<i32>> {
        self.runtime.perform(vec![Task::Ask]);
        while !self.runtime.app.finished {
            let keeping = self.next_keeping();
            if keeping.is_some_and(|deadline| Instant::now() >= deadline) {
                self.keep_unsaved();
            }
            if self.changed && Instant::now() >= self.next_frame() {
                self.show()?;
                self.changed = false;
                if self.remote {
                    self.due = Instant::now() + self.frame_time;
                }
            }
            let playing = self.is_playing();
            if !playing {
                self.moved = Instant::now();
            }
            let next = self.wait(playing);
            match self.handle_all(next)? {
                Some(Interruption::NoInput) => return Ok(None),
                Some(Interruption::Signal(signal)) => return Ok(Some(signal)),
                None => {}
            }
            if playing && self.moved.elapsed() >= self.frame_time {
                // A frame follows with the snapshot that the new position requests: time alone
                // changes nothing on the screen.
                let elapsed = self.moved.elapsed().min(4 * self.frame_time);
                self.moved = Instant::now();
                self.act(Action::Elapse(elapsed))?;
            }
        }
        Ok(None)
    }

    /// The final state, after the signal with this number if one ended the session.
    fn end(self, signal: Option<i32>) -> SessionEnd {
        let app = self.runtime.app;
        if app.finished
            && let Some(mut autosave) = self.autosave
        {
            // The user was asked about the changes.
            let _ = autosave.keep(&[]);
        }
        let computed = app.current().cloned();
        SessionEnd {
            document: app.edit.document,
            computed,
            signal,
        }
    }

    /// Time before which nothing is drawn. Over SSH the frame after a key waits a little for the
    /// answer of the solver: a frame without the answer would hold it back until the next frame is
    /// due, and would cost as many bytes.
    fn next_frame(&self) -> Instant {
        match self.asked {
            Some(asked) if self.remote => self.due.max(asked + ANSWER_TIME),
            _ => self.due,
        }
    }

    fn is_playing(&self) -> bool {
        let app = &self.runtime.app;
        app.play.playing && app.is_current() && app.manual.is_none()
    }

    /// Waits until something comes in; `None` when the next step of the animation or the next frame
    /// is due before.
    fn wait(&mut self, playing: bool) -> Option<Incoming> {
        let mut deadlines = Vec::new();
        if playing {
            deadlines.push(self.moved + self.frame_time);
        }
        if self.changed {
            deadlines.push(self.next_frame());
        }
        deadlines.extend(self.next_keeping());
        match deadlines.into_iter().min() {
            Some(deadline) => {
                let time = deadline.saturating_duration_since(Instant::now());
                self.inbox.recv_timeout(time).ok()
            }
            None => self.inbox.recv().ok(),
        }
    }

    /// Handles what has come in, and what comes in meanwhile. If keys come faster than they are
    /// handled, a frame is drawn after some time all the same, so that the user sees their effects.
    fn handle_all(&mut self, first: Option<Incoming>) -> io::Result<Option<Interruption>> {
        let begun = Instant::now();
        let mut next = first;
        while let Some(incoming) = next {
            if let Some(interruption) = self.handle(incoming)? {
                return Ok(Some(interruption));
            }
            if begun.elapsed() >= DRAINING {
                break;
            }
            next = self.inbox.try_recv().ok();
        }
        Ok(None)
    }

    fn handle(&mut self, incoming: Incoming) -> io::Result<Option<Interruption>> {
        if let Incoming::Input(_) = incoming {
            let _ = self.waiting.try_recv();
            self.touched = Instant::now();
        }
        let action = match incoming {
            Incoming::Input(None) => return Ok(Some(Interruption::NoInput)),
            Incoming::Signal(SystemSignal::End(signal)) => {
                return Ok(Some(Interruption::Signal(signal)));
            }
            Incoming::Signal(SystemSignal::Continue) => {
                self.guard.take_again()?;
                Some(self.resize()?)
            }
            Incoming::Signal(SystemSignal::Resize) => Some(self.resize()?),
            Incoming::Input(Some(event)) => input::action_of(event),
            Incoming::Act(action) => Some(*action),
        };
        if let Some(action) = action {
            self.changed = true;
            self.act(action)?;
        }
        Ok(None)
    }

    fn resize(&self) -> io::Result<Action> {
        let size = terminal::checked(self.terminal.size()?)?;
        Ok(Action::Resize(size.width, size.height))
    }

    fn show(&mut self) -> io::Result<()> {
        terminal::checked(self.terminal.size()?)?;
        if take(&mut self.redraw) {
            // Unlike `clear` this does not query the position of the cursor on the input that the
            // other thread reads.
            let size = self.terminal.size()?;
            self.terminal.resize(Rect::from((Position::ORIGIN, size)))?;
        }
        let app = &self.runtime.app;
        self.terminal.draw(|frame| (self.draw)(frame, app))?;
        Ok(())
    }

    fn act(&mut self, action: Action) -> io::Result<()> {
        // A window that shrank and grew back between two frames has lost its content, though its
        // size is that of the last frame.
        self.redraw |= matches!(action, Action::Resize(..));
        for task in self.runtime.act(action) {
            match task {
                // Sent with the next frame; the terminal does not confirm a copy.
                Task::Copy(text) => {
                    let copy = CopyToClipboard::to_clipboard_from(text);
                    queue!(self.terminal.backend_mut(), copy)?;
                }
                Task::Redraw => self.redraw = true,
                Task::Suspend => {
                    self.keep_unsaved();
                    // With the signal of continuation the size of the window is read again.
                    self.guard.suspend()?;
                    self.redraw = true;
                }
                _ => {}
            }
        }
        if !self.runtime.awaits_answer() {
            self.asked = None;
        } else if self.asked.is_none() {
            self.asked = Some(Instant::now());
        }
        Ok(())
    }

    /// Time at which the unsaved changes are to be kept; `None` if they are kept already, or if
    /// there are none and no file to remove.
    fn next_keeping(&mut self) -> Option<Instant> {
        let state = self.state_of_changes();
        if state == self.kept {
            return None;
        }
        let autosave = self.autosave.as_ref()?;
        if !autosave.has_file() && self.runtime.app.edit.unsaved().is_empty() {
            self.kept = state;
            return None;
        }
        Some(self.touched + KEEPING_PAUSE)
    }

    /// Generation of the scene and number of saves, which change with every edit and every save.
    fn state_of_changes(&self) -> (u64, u64) {
        let edit = &self.runtime.app.edit;
        (edit.generation, edit.saves)
    }

    /// Keeps the unsaved changes for another session, if they differ from those kept before. This
    /// is done after a second without input, and at once before the explorer ends or stops. So a
    /// process that is killed, or a signal while the terminal accepts no output, may lose the
    /// changes of the last second.
    fn keep_unsaved(&mut self) {
        let state = self.state_of_changes();
        if state == self.kept {
            return;
        }
        let Some(autosave) = &mut self.autosave else {
            return;
        };
        self.kept = state;
        let app = &mut self.runtime.app;
        if let Err(error) = autosave.keep(&app.edit.unsaved()) {
            self.autosave = None;
            self.changed = true;
            app.set_error(format!(
                "unsaved changes are not kept for another session: {error}"
            ));
        }
    }
}
