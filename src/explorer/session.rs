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
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel, sync_channel};
use std::time::{Duration, Instant};

/// Limit of the frame rate over SSH, 1/s, where each frame has to be transmitted.
const REMOTE_FRAMES: u32 = 12;

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

enum Message {
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
    let (sender, inbox) = channel();
    let sender = || sender.clone();
    let to = sender();
    let solver = SolverThread::start(solve, move |report| {
        drop(to.send(Message::Act(Action::Reply(report).into())))
    })?;
    let to = sender();
    let studies = StudyThread::start(move |finding| {
        drop(to.send(Message::Act(Action::Found(finding).into())))
    })?;
    let to = sender();
    terminal::watch_for_hang_up(move || drop(to.send(Message::Input(None))))?;
    let to = sender();
    watch_for_signals(move |signal| to.send(Message::Signal(signal)).is_ok())?;
    let to = sender();
    let (places, waiting) = sync_channel(MOST_WAITING);
    input::read(move |event| places.send(()).is_ok() && to.send(Message::Input(event)).is_ok())?;
    // The guard restores everything; ratatui's own drop would complain on standard error, and panic
    // where that is gone together with the terminal.
    let writer = FrameWriter::new(io::stdout());
    let mut terminal = ManuallyDrop::new(Terminal::new(CrosstermBackend::new(writer))?);
    let environment = Appearance::of_environment();
    let appearance = Appearance {
        theme: options
            .theme
            .or(options.config.theme)
            .unwrap_or(environment.theme),
        marker: options
            .marker
            .or(options.config.markers)
            .unwrap_or(environment.marker),
    };
    let mut app = begin(
        opening.into(),
        (size.width, size.height),
        appearance,
        options.config,
    );
    let remote = ["SSH_CONNECTION", "SSH_TTY"]
        .iter()
        .any(|name| std::env::var_os(name).is_some());
    let frame_rate = app.config.frame_rate;
    let offer = match &options.restored {
        Some(kept) => {
            app.edit.restore(&kept.documents);
            None
        }
        None => options.unsaved.as_deref().and_then(autosave::offer),
    };
    app.state_beside(options.warning, offer);
    let mut session = Session {
        runtime: Runtime {
            app,
            engine: Engine::threads(solver, studies),
            asked: 0,
            folder: PathBuf::new(),
        },
        terminal: &mut terminal,
        guard,
        redraw: false,
        draw,
        remote,
        frames: if remote {
            frame_rate.min(REMOTE_FRAMES)
        } else {
            frame_rate
        },
        inbox,
        waiting,
        autosave: options
            .unsaved
            .map(|folder| Autosave::new(&folder, options.restored)),
        kept: (0, 0),
    };
    let end = session.run();
    session.keep_unsaved();
    let signal = end?;
    let app = session.runtime.app;
    if let Some(autosave) = session.autosave.as_mut().filter(|_| app.finished) {
        // The user was asked about the changes.
        let _ = autosave.keep(&[]);
    }
    let computed = app.current().cloned();
    Ok(SessionEnd {
        document: app.edit.document,
        computed,
        signal,
    })
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
    frames: u32,
    inbox: Receiver<Message>,
    /// One entry for each input event in the inbox.
    waiting: Receiver<()>,
    autosave: Option<Autosave>,
    /// Generation of the scene and number of saves when changes were last kept.
    kept: (u64, u64),
}

impl Session<'_> {
    /// Runs until the explorer is to end; returns the number of the signal that ended it, if one
    /// did.
    fn run(&mut self) -> io::Result<Option<i32>> {
        let frame_time = Duration::from_secs(1) / self.frames;
        self.runtime.perform(vec![Task::Ask]);
        let mut moved = Instant::now();
        let mut changed = true;
        // Over SSH nothing is drawn before this time: a held key or a dragged mouse would fill the
        // line with frames that nobody sees in time.
        let mut due = moved;
        while !self.runtime.app.finished {
            // Unsaved changes are kept before they are drawn.
            self.keep_unsaved();
            if changed && Instant::now() >= due {
                self.show()?;
                if self.remote {
                    due = Instant::now() + frame_time;
                }
                changed = false;
            }
            let app = &self.runtime.app;
            let playing = app.play.playing && app.is_current() && app.manual.is_none();
            if !playing {
                moved = Instant::now();
            }
            let step = playing.then(|| frame_time.saturating_sub(moved.elapsed()));
            let frame = changed.then(|| due.saturating_duration_since(Instant::now()));
            let mut next = match step.into_iter().chain(frame).min() {
                Some(wait) => self.inbox.recv_timeout(wait).ok(),
                None => self.inbox.recv().ok(),
            };
            let since = Instant::now();
            while let Some(message) = next {
                if matches!(message, Message::Input(_)) {
                    let _ = self.waiting.try_recv();
                }
                let action = match message {
                    Message::Input(None) => return Ok(None),
                    Message::Signal(SystemSignal::End(signal)) => return Ok(Some(signal)),
                    Message::Signal(SystemSignal::Continue) => {
                        self.guard.take_again()?;
                        Some(self.resize()?)
                    }
                    Message::Signal(SystemSignal::Resize) => Some(self.resize()?),
                    Message::Input(Some(event)) => input::action_of(event),
                    Message::Act(action) => Some(*action),
                };
                if let Some(action) = action {
                    changed = true;
                    self.act(action)?;
                }
                // Keys faster than their effects would else be drawn after the last one.
                let is_late = since.elapsed() >= DRAINING;
                next = if is_late {
                    None
                } else {
                    self.inbox.try_recv().ok()
                };
            }
            if playing && moved.elapsed() >= frame_time {
                // Time alone shows nothing: the requested snapshot does.
                let elapsed = moved.elapsed().min(4 * frame_time);
                moved = Instant::now();
                self.act(Action::Elapse(elapsed))?;
            }
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
        let Session {
            runtime,
            terminal,
            draw,
            ..
        } = self;
        terminal.draw(|frame| draw(frame, &runtime.app)).map(drop)
    }

    fn act(&mut self, action: Action) -> io::Result<()> {
        // A window that shrank and grew back between two frames has lost its content, though its
        // size is that of the last frame.
        self.redraw |= matches!(action, Action::Resize(..));
        for effect in self.runtime.act(action) {
            match effect {
                // Sent with the next frame; the terminal does not confirm a copy.
                Task::Copy(text) => {
                    queue!(
                        self.terminal.backend_mut(),
                        CopyToClipboard::to_clipboard_from(text)
                    )?;
                }
                Task::Redraw => self.redraw = true,
                Task::Suspend => {
                    // With the signal of continuation the size of the window is read again.
                    self.guard.suspend()?;
                    self.redraw = true;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn keep_unsaved(&mut self) {
        let app = &mut self.runtime.app;
        let now = (app.edit.generation, app.edit.saves);
        if let Some(autosave) = self.autosave.as_mut().filter(|_| now != self.kept) {
            self.kept = now;
            if let Err(error) = autosave.keep(&app.edit.unsaved()) {
                self.autosave = None;
                app.set_error(format!(
                    "unsaved changes are not kept for another session: {error}"
                ));
            }
        }
    }
}
