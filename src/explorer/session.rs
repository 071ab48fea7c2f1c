//! A session: the explorer in a terminal, with threads for input, signals, solver and background
//! computations (studies).

use super::action::{Action, Task};
use super::app::App;
use super::autosave::{Autosave, Kept, Unsaved};
use super::cell_writer::CellWriter;
use super::commands::opening::begin;
use super::config::Config;
use super::editor::Editor;
use super::manual_path::ManualPath;
use super::opening::Opening;
use super::pacing::{Content, Pacing};
use super::pen::remove_ink_of_blanks;
use super::runtime::{Engine, Runtime};
use super::signals::{SystemSignal, watch_for_signals};
use super::snapshot::SolvedScene;
use super::solver::{Solve, SolverThread};
use super::studies::StudyThread;
use super::terminal::{FrameWriter, TerminalGuard};
use super::terminal_input::Input;
use super::theme::{Appearance, Marker, Theme};
use super::{autosave, input, terminal, theme};
use asperity_plot::{Background, Colours};
use asperity_scene::Document;
use crossterm::clipboard::CopyToClipboard;
use crossterm::queue;
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

/// Time without input after which unsaved changes are written to a file. While the explorer writes,
/// it waits for the disk, which takes longer than a frame if the home folder is on another
/// computer.
const KEEPING_PAUSE: Duration = Duration::from_secs(1);

/// Longest time for which the first frame is delayed to have the colours for the background that
/// the terminal states.
const BACKGROUND_TIME: Duration = Duration::from_millis(100);

/// Largest number of input events that wait for the main loop. Further input waits in the terminal.
const MOST_WAITING: usize = 64;

/// Longest time for which actions are applied before the next frame is drawn.
const DRAINING: Duration = Duration::from_millis(100);

pub struct Options {
    /// Background for which the colours are chosen; `None` if the environment determines it.
    pub theme: Option<Theme>,
    /// Characters with which plots are drawn; `None` if the environment determines them.
    pub marker: Option<Marker>,
    /// Unsaved changes that an earlier explorer has left, with which this explorer continues;
    /// `None` if there are none. Their first scene is the scene that is opened.
    pub restored: Option<Kept>,
    /// Configuration. The fields `theme` and `marker` have precedence over it.
    pub config: Config,
    pub warning: Option<String>,
    /// Folder for copies of unsaved changes. If it is `None`, no copies are made.
    pub unsaved: Option<PathBuf>,
}

impl Options {
    /// Returns options for a session that only the configuration determines.
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
    /// Number of the signal that ended the explorer; `None` if the user ended it.
    pub signal: Option<i32>,
}

/// Function that draws the state of the explorer on the screen of the terminal.
pub type Draw = fn(&mut Frame<'_>, &App);

/// What a thread can send to the main loop of the session.
enum Incoming {
    /// Input of the user; `None` if the input has ended.
    Input(Option<Input>),
    Signal(SystemSignal),
    /// Action that carries a result of the solver or of a background computation.
    Act(Box<Action>),
}

/// Runs the explorer, beginning with a scene or a finished study, and returns its final state.
/// `solve` computes scenes, and `draw` draws the screen.
pub fn open(
    opening: impl Into<Opening>,
    options: Options,
    solve: Solve,
    draw: Draw,
) -> io::Result<SessionEnd> {
    let size = terminal::window()?;
    let guard = TerminalGuard::take(options.config.mouse)?;
    // `sender` exists as long as the session, so that `inbox` always has a sender and stays open.
    let (sender, inbox) = channel();
    let engine = start_engine(solve, &sender)?;
    let waiting = start_input(&sender)?;
    // When the session ends, `guard` restores the terminal. The destructor of `Terminal` must not
    // run: if the terminal is gone, it would write to standard error, and would panic if standard
    // error is gone too.
    let writer = FrameWriter::new(io::stdout());
    let mut terminal = ManuallyDrop::new(Terminal::new(CellWriter::new(
        writer,
        terminal::line_feeds(),
    ))?);
    let appearance = chosen_appearance(&options);
    let asks_background = asks_background(&options, appearance);
    if asks_background {
        terminal::ask_background()?;
    }
    let app = first_state(
        opening.into(),
        (size.width, size.height),
        appearance,
        &options,
    );
    let autosave = options
        .unsaved
        .map(|folder| Autosave::new(&folder, options.restored));
    let now = Instant::now();
    let first_frame = if asks_background {
        now + BACKGROUND_TIME
    } else {
        now
    };
    let pacing = Pacing::new(is_remote(), app.config.frame_rate, first_frame);
    let mut session = Session {
        runtime: Runtime {
            app,
            engine,
            asked: 0,
            folder: PathBuf::new(),
        },
        terminal: &mut terminal,
        guard,
        redraw: true,
        draw,
        pacing,
        change: Change::Other,
        asks_background,
        asked: None,
        moved: now,
        inbox,
        waiting,
        autosave,
        kept: StateOfChanges::default(),
        touched: now,
    };
    let end = catch_unwind(AssertUnwindSafe(|| session.run()));
    // This also runs after a panic, so that the user can open the unsaved changes in another
    // session.
    session.keep_unsaved();
    match end {
        Ok(end) => Ok(session.end(end?)),
        Err(panic) => resume_unwind(panic),
    }
}

/// Returns the state with which the explorer begins, with its messages.
fn first_state(
    opening: Opening,
    size: (u16, u16),
    appearance: Appearance,
    options: &Options,
) -> App {
    let mut app = begin(opening, size, appearance, options.config.clone());
    let offer = restore_or_offer(
        &mut app,
        options.restored.as_ref(),
        options.unsaved.as_deref(),
    );
    app.state_beside(options.warning.clone(), offer);
    app
}

/// Continues with the unsaved changes of another session (`restored`). If there are none, returns a
/// message that offers the newest unsaved changes in the folder `unsaved`.
fn restore_or_offer(
    app: &mut App,
    restored: Option<&Kept>,
    unsaved: Option<&Path>,
) -> Option<String> {
    if let Some(kept) = restored {
        app.edit.restore(&kept.documents, kept.by_hand.as_ref());
        return None;
    }
    autosave::offer(unsaved?)
}

/// Starts the threads of the solver and of the studies, which send their results to the main loop.
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

/// Starts the threads that wait for input, for signals and for the loss of the terminal. Returns a
/// receiver with one entry for each input event that waits for the main loop. If the receiver is
/// full, further input waits in the terminal.
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

/// Returns the colours and the characters of plots. The options of the command line have precedence
/// over the configuration, and the configuration has precedence over the environment.
fn chosen_appearance(options: &Options) -> Appearance {
    let environment = Appearance::of_environment();
    let config = &options.config;
    Appearance {
        theme: options.theme.or(config.theme).unwrap_or(environment.theme),
        colours: config.colours.unwrap_or(environment.colours),
        marker: options
            .marker
            .or(config.markers)
            .unwrap_or(environment.marker),
    }
}

/// Returns true if nothing but the terminal itself can say which background it has. Terminals that
/// print the question instead of answering it are not asked.
fn asks_background(options: &Options, appearance: Appearance) -> bool {
    let is_chosen = options.theme.is_some() || options.config.theme.is_some();
    let term = theme::variable("TERM").unwrap_or_default();
    let is_old = ["dumb", "linux", "ansi", "vt"]
        .iter()
        .any(|name| term.starts_with(name));
    cfg!(unix)
        && appearance.theme == Theme::Neutral
        && appearance.colours != Colours::Plain
        && !is_chosen
        && !is_old
}

fn is_remote() -> bool {
    let variables = ["SSH_CONNECTION", "SSH_TTY"];
    variables
        .iter()
        .any(|name| std::env::var_os(name).is_some())
}

type Screen = Terminal<CellWriter<FrameWriter<Stdout>>>;

struct Session<'a> {
    runtime: Runtime,
    terminal: &'a mut Screen,
    guard: TerminalGuard,
    /// True if the content of the screen is unknown, so that the next frame must draw all cells.
    redraw: bool,
    draw: Draw,
    pacing: Pacing,
    /// What has changed since the last frame.
    change: Change,
    /// True until the terminal has stated its background, if it was asked.
    asks_background: bool,
    /// Time of the request that the solver has not answered yet; `None` if there is none.
    asked: Option<Instant>,
    /// Time of the last step of the animation.
    moved: Instant,
    inbox: Receiver<Incoming>,
    /// One entry for each input event that waits in the inbox.
    waiting: Receiver<()>,
    autosave: Option<Autosave>,
    /// State at the time when unsaved changes were last written.
    kept: StateOfChanges,
    /// Time of the last input.
    touched: Instant,
}

/// Every edit, every move of the body by hand and every save changes at least one of these values.
#[derive(Clone, Debug, Default, PartialEq)]
struct StateOfChanges {
    /// Generation of the scene.
    generation: u64,
    /// Number of saves.
    saves: u64,
    /// Path along which the user has moved the body by hand.
    path: Option<Arc<ManualPath>>,
}

impl StateOfChanges {
    fn of(edit: &Editor) -> Self {
        StateOfChanges {
            generation: edit.generation,
            saves: edit.saves,
            path: edit.unsaved_path().cloned(),
        }
    }
}

/// Returns what another session can restore: the scenes with unsaved changes and the path by hand,
/// with its scene even if this scene has no changes.
fn unsaved(edit: &Editor) -> Unsaved<'_> {
    let path = edit.unsaved_path().map(Arc::as_ref);
    let mut documents = edit.unsaved();
    if path.is_some() && !edit.is_unsaved() {
        documents.insert(0, &edit.document);
    }
    Unsaved { documents, path }
}

/// What has changed since the last frame, from the least to the most urgent.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    Nothing,
    /// Only results of the studies.
    Studies,
    Other,
}

/// Reason why a session ends although the user has not ended it.
enum Interruption {
    /// The terminal is gone.
    NoInput,
    /// A signal has asked the explorer to end. The value is the number of the signal.
    Signal(i32),
}

impl Session<'_> {
    /// Runs the main loop of the session until the session ends. Returns the number of the signal
    /// that ended the session; `None` if no signal did.
    fn run(&mut self) -> io::Result<Option<i32>> {
        self.runtime.perform(vec![Task::Ask]);
        while !self.runtime.app.finished {
            let keeping = self.next_keeping();
            if keeping.is_some_and(|deadline| Instant::now() >= deadline) {
                self.keep_unsaved();
            }
            if self.change != Change::Nothing && Instant::now() >= self.next_frame() {
                self.show()?;
                self.change = Change::Nothing;
                self.pacing.note_frame(Instant::now());
            }
            let playing = self.runtime.app.is_playing();
            if !playing {
                self.moved = Instant::now();
            }
            let next = self.wait(playing);
            match self.handle_all(next)? {
                Some(Interruption::NoInput) => return Ok(None),
                Some(Interruption::Signal(signal)) => return Ok(Some(signal)),
                None => {}
            }
            let frame_time = self.pacing.frame_time();
            if playing && self.moved.elapsed() >= frame_time {
                // No frame is due yet, because elapsed time alone changes nothing on the screen. A
                // frame is drawn when the snapshot for the new position arrives.
                let elapsed = self.moved.elapsed().min(4 * frame_time);
                self.moved = Instant::now();
                self.act(Action::Elapse(elapsed))?;
            }
        }
        Ok(None)
    }

    /// Ends the session and returns its final state. `signal` is the number of the signal that
    /// ended the session; `None` if no signal did.
    fn end(self, signal: Option<i32>) -> SessionEnd {
        let app = self.runtime.app;
        if app.finished
            && let Some(mut autosave) = self.autosave
        {
            // The user has already decided about the unsaved changes, so their copy is removed.
            let _ = autosave.keep(&Unsaved::default());
        }
        let computed = app.current().cloned();
        SessionEnd {
            document: app.edit.document,
            computed,
            signal,
        }
    }

    /// Returns the earliest time of the next frame.
    fn next_frame(&self) -> Instant {
        let is_progress =
            self.change == Change::Studies && !self.runtime.app.studies.are_all_done();
        let content = match self.asked {
            _ if is_progress => Content::Progress,
            Some(asked) => Content::Unanswered(asked),
            None => Content::Complete,
        };
        self.pacing.next_frame(content)
    }

    /// Waits for input or a result, and returns it. Returns `None` if before that a step of the
    /// animation, a frame or a copy of unsaved changes is due.
    fn wait(&mut self, playing: bool) -> Option<Incoming> {
        let mut deadlines = Vec::new();
        if playing {
            deadlines.push(self.moved + self.pacing.frame_time());
        }
        if self.change != Change::Nothing {
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

    /// Handles the first event, and then all events that arrive in the meantime. If keys arrive
    /// faster than the explorer handles them, this ends after the time `DRAINING`, so that a frame
    /// shows their effects.
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
            Incoming::Input(Some(Input::Event(event))) => input::action_of(event),
            Incoming::Input(Some(Input::Background(background))) => {
                self.adapt_to(background);
                None
            }
            Incoming::Act(action) => Some(*action),
        };
        if let Some(action) = action {
            let change = match action {
                Action::Found(_) => Change::Studies,
                _ => Change::Other,
            };
            self.change = self.change.max(change);
            self.act(action)?;
        }
        Ok(None)
    }

    /// Chooses the colours for the background that the terminal has stated, unless the user has
    /// chosen others meanwhile.
    fn adapt_to(&mut self, background: Background) {
        if !std::mem::take(&mut self.asks_background) {
            return;
        }
        let look = &mut self.runtime.app.view.appearance;
        if look.theme == Theme::Neutral {
            look.theme = Theme::for_background(background);
        }
        // The first frame needs to wait no longer.
        self.pacing.hurry(Instant::now());
        self.change = Change::Other;
    }

    fn resize(&self) -> io::Result<Action> {
        let size = terminal::checked(self.terminal.size()?)?;
        Ok(Action::Resize(size.width, size.height))
    }

    fn show(&mut self) -> io::Result<()> {
        terminal::checked(self.terminal.size()?)?;
        if take(&mut self.redraw) {
            // `clear` would ask the terminal for the position of the cursor and wait for the
            // answer, but the answer goes to the thread that reads input. `resize` also clears the
            // screen, without asking.
            let size = self.terminal.size()?;
            self.terminal.resize(Rect::from((Position::ORIGIN, size)))?;
        }
        let app = &self.runtime.app;
        self.terminal.draw(|frame| {
            (self.draw)(frame, app);
            remove_ink_of_blanks(frame.buffer_mut());
        })?;
        Ok(())
    }

    fn act(&mut self, action: Action) -> io::Result<()> {
        // If the window shrinks and grows again between two frames, the screen loses its content,
        // although the window has the same size as at the last frame. Therefore the next frame
        // draws all cells.
        self.redraw |= matches!(action, Action::Resize(..));
        for task in self.runtime.act(action) {
            match task {
                // `queue!` only adds the text to the output, which is sent with the next frame.
                Task::Copy(text) => {
                    let copy = CopyToClipboard::to_clipboard_from(text);
                    queue!(self.terminal.backend_mut(), copy)?;
                }
                Task::Redraw => self.redraw = true,
                Task::Suspend => {
                    self.keep_unsaved();
                    // The window may have another size afterwards. The signal that continues the
                    // process causes the explorer to read the size again.
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

    /// Returns the time at which unsaved changes are written to their file. `None` if they have not
    /// changed since they were last written, or if there are none and no file has to be removed.
    fn next_keeping(&mut self) -> Option<Instant> {
        let state = StateOfChanges::of(&self.runtime.app.edit);
        if state == self.kept {
            return None;
        }
        let autosave = self.autosave.as_ref()?;
        if !autosave.has_file() && unsaved(&self.runtime.app.edit).is_empty() {
            self.kept = state;
            return None;
        }
        Some(self.touched + KEEPING_PAUSE)
    }

    /// Writes the unsaved changes to a file for another session, if they have changed since they
    /// were last written. This happens after a second without input, and also before the explorer
    /// ends or is stopped. If the process is killed, or gets a signal while the terminal accepts no
    /// output, the changes of the last second may be lost.
    fn keep_unsaved(&mut self) {
        let state = StateOfChanges::of(&self.runtime.app.edit);
        if state == self.kept {
            return;
        }
        let Some(autosave) = &mut self.autosave else {
            return;
        };
        self.kept = state;
        let app = &mut self.runtime.app;
        if let Err(error) = autosave.keep(&unsaved(&app.edit)) {
            self.autosave = None;
            self.change = Change::Other;
            app.set_error(format!(
                "unsaved changes are not kept for another session: {error}"
            ));
        }
    }
}
