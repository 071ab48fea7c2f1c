//! A session: input, worker and terminal around one model.

use super::action::{Action, Traffic};
use super::app::App;
use super::autosave::{self, Autosave};
use super::config::Config;
use super::input;
use super::opening::Opening;
use super::runtime::{Console, Runtime, Solver, Studies};
use super::signals::{SystemSignal, watch_for_signals};
use super::snapshot::SolvedScene;
use super::study::{Accuracy, Study};
use super::terminal::{self, FrameWriter, TerminalGuard};
use super::theme::{Appearance, Marker, Theme};
use super::update::Effect;
use super::view;
use super::worker::{self, Engine, Worker};
use crate::scene::Document;
use crate::simulation::Simulation;
use crossterm::clipboard::CopyToClipboard;
use crossterm::event::Event;
use crossterm::queue;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::{Position, Rect, Size};
use ratatui::{Frame, Terminal};
use std::cell::Cell;
use std::io::{self, Write};
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// Most frames per second over SSH, where each has to travel.
const REMOTE_FRAMES: u32 = 12;

/// Most cells of a window, of about 100 bytes each.
const MOST_CELLS: u32 = 4_000_000;

/// Longest time of actions without a frame.
const DRAINING: Duration = Duration::from_millis(100);

/// Options of the explorer.
#[derive(Default)]
pub struct Options {
    /// Colours in place of those by the environment.
    pub theme: Option<Theme>,
    /// Markers in place of those by the environment.
    pub marker: Option<Marker>,
    /// True to leave the mouse to the terminal.
    pub no_mouse: bool,
    /// File of unsaved changes of another session, and its scenes; the opened scene is the first.
    pub restored: Option<(PathBuf, Vec<Document>)>,
    /// Configuration; options here have precedence.
    pub config: Config,
    /// Message that is shown at the start.
    pub warning: Option<String>,
    /// Folder in which unsaved changes are kept; `None`: nowhere.
    pub unsaved: Option<PathBuf>,
}

/// State at the end of the explorer.
pub struct SessionEnd {
    /// The scene at the end.
    pub document: Document,
    /// Outcome.
    pub computed: Option<Arc<SolvedScene>>,
    /// Number of the signal that ended the explorer.
    pub signal: Option<i32>,
}

/// Function that draws a model, as [`view::draw`].
pub type Draw = fn(&mut Frame<'_>, &App);

/// Message from outside: input of the user, its end, a signal, or a report.
enum Message {
    Input(Event),
    InputEnded,
    /// A signal is to end the process.
    Ended(i32),
    /// The stopped process continues: another program may have had the terminal.
    Continued,
    /// The window has another size.
    Resized,
    /// Report of another thread.
    Act(Box<Action>),
}

impl Message {
    fn act(action: Action) -> Self {
        Message::Act(Box::new(action))
    }
}

/// Opens the explorer on a scene or a finished study and returns its final state.
///
/// # Errors
/// When the terminal refuses.
pub fn open(opening: impl Into<Opening>, options: Options) -> io::Result<SessionEnd> {
    open_with(opening, options, Box::new(Simulation::default()), view::draw)
}

/// Opens the explorer with another engine and another view.
///
/// # Errors
/// When the terminal refuses.
pub fn open_with(
    opening: impl Into<Opening>,
    options: Options,
    engine: Box<dyn Engine>,
    draw: Draw,
) -> io::Result<SessionEnd> {
    let Opening { document, study_map, beside } = opening.into();
    let guard = TerminalGuard::take(!options.no_mouse)?;
    let (messages, inbox) = channel();
    let (requests, outbox) = channel();
    let newest = worker::Newest::default();
    let send_report = sender(&messages, |report| Message::act(Action::Report(report)));
    worker::start(engine, Arc::clone(&newest), outbox, send_report)?;
    let send_found = sender(&messages, |found| Message::act(Action::Found(found)));
    let study = Study::start(Box::new(Accuracy), send_found)?;
    let send_end = sender(&messages, |()| Message::InputEnded);
    terminal::watch_for_hang_up(move || {
        send_end(());
    })?;
    watch_for_signals(sender(&messages, |signal| match signal {
        SystemSignal::End(signal) => Message::Ended(signal),
        SystemSignal::Continue => Message::Continued,
        SystemSignal::Resize => Message::Resized,
    }))?;
    input::read(sender(&messages, |event: Option<Event>| event.map_or(Message::InputEnded, Message::Input)))?;
    // The guard restores everything; ratatui's own drop would complain on standard error, and panic
    // where that is gone together with the terminal.
    let writer = FrameWriter::new(io::stdout());
    let written = writer.written();
    let backend = CrosstermBackend::new(writer);
    let mut terminal = ManuallyDrop::new(Terminal::new(backend)?);
    let size = window(&terminal)?;
    let environment = Appearance::of_environment();
    let appearance = Appearance {
        theme: options.theme.or(options.config.theme).unwrap_or(environment.theme),
        marker: options.marker.or(options.config.markers).unwrap_or(environment.marker),
    };
    let frame_rate = options.config.frame_rate;
    let mut app = App::new(document, (size.width, size.height), appearance);
    app.opens_beside = beside;
    // Terminal multiplexers keep a screen of their own.
    app.view.lacks_octants = ["TMUX", "STY"].iter().any(|name| std::env::var_os(name).is_some());
    if let Some(study_map) = study_map {
        app.show_study(study_map);
    }
    app.config = options.config;
    if let Some(warning) = options.warning {
        app.set_error(warning);
    }
    if let Some((_, documents)) = &options.restored {
        app.restore(documents);
    } else if let Some(folder) = &options.unsaved {
        app.offer(&autosave::left_behind(folder));
    }
    let restored = options.restored.map(|(path, _)| path);
    let worker = Worker::new(requests, newest);
    let runtime = Runtime {
        app,
        solver: Solver::Thread(worker),
        studies: Studies::Thread(study),
        asked: 0,
        folder: PathBuf::new(),
        // Six digits are enough for another line and can be read out to a colleague.
        draw_seed: Box::new(|| rand::random_range(0..1_000_000)),
    };
    let mut session = Session {
        runtime,
        console: Screen { terminal: &mut terminal, guard, redraw: false, own_stops: 0 },
        draw,
        remote: ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| std::env::var_os(name).is_some()),
        frame_rate,
        written,
        traffic: (Instant::now(), 0),
        inbox,
        autosave: options.unsaved.map(|folder| Autosave::new(&folder, restored)),
        kept: (0, 0),
    };
    let signal = session.run()?;
    let app = session.runtime.app;
    if let Some(autosave) = session.autosave.as_mut().filter(|_| app.finished) {
        // The user was asked about the changes.
        let _ = autosave.keep(&[]);
    }
    let computed = app.current().cloned();
    Ok(SessionEnd { document: app.edit.document, computed, signal })
}

/// A function for another thread, which sends messages and returns false once nobody listens.
fn sender<T>(messages: &Sender<Message>, message: fn(T) -> Message) -> impl Fn(T) -> bool + Send + use<T> {
    let messages = messages.clone();
    move |content| messages.send(message(content)).is_ok()
}

/// Size of the window.
fn window<W: Write>(terminal: &Terminal<CrosstermBackend<FrameWriter<W>>>) -> io::Result<Size> {
    let size = terminal.size()?;
    if size.area() > MOST_CELLS {
        let Size { width, height } = size;
        let fault = format!("a window of {width} × {height} cells; allowed: at most {MOST_CELLS} cells");
        return Err(io::Error::other(fault));
    }
    Ok(size)
}

/// The terminal of a session.
struct Screen<'a, W: Write> {
    terminal: &'a mut Terminal<CrosstermBackend<FrameWriter<W>>>,
    guard: TerminalGuard,
    /// True if the content of the screen is unknown.
    redraw: bool,
    /// Own stops without a signal of continuation so far.
    own_stops: u32,
}

impl<W: Write> Screen<'_, W> {
    /// Action for a window of another size.
    fn resize(&self) -> io::Result<Action> {
        let size = window(self.terminal)?;
        Ok(Action::Resize(size.width, size.height))
    }
}

impl<W: Write> Console for Screen<'_, W> {
    fn copy(&mut self, text: String) -> io::Result<()> {
        // Sent with the next frame; the terminal does not confirm a copy.
        queue!(self.terminal.backend_mut(), CopyToClipboard::to_clipboard_from(text))
    }

    fn redraw(&mut self) {
        self.redraw = true;
    }

    fn suspend(&mut self) -> io::Result<Option<Action>> {
        self.own_stops += 1;
        self.guard.suspend()?;
        // The window may have another size by now.
        self.redraw = true;
        self.resize().map(Some)
    }
}

struct Session<'a, W: Write> {
    runtime: Runtime,
    console: Screen<'a, W>,
    draw: Draw,
    remote: bool,
    /// Frames per second of the animation.
    frame_rate: u32,
    /// Bytes written so far.
    written: Rc<Cell<u64>>,
    /// Time of the last report of the traffic, and the bytes written by then.
    traffic: (Instant, u64),
    inbox: Receiver<Message>,
    /// Keeps unsaved changes.
    autosave: Option<Autosave>,
    /// Generation and number of saves when changes were last kept.
    kept: (u64, u64),
}

impl<W: Write> Session<'_, W> {
    /// Runs until the explorer is to end; returns the signal that ends it, if any.
    fn run(&mut self) -> io::Result<Option<i32>> {
        let frames = if self.remote { self.frame_rate.min(REMOTE_FRAMES) } else { self.frame_rate };
        let frame_time = Duration::from_secs(1) / frames;
        self.runtime.perform(vec![Effect::Ask], &mut self.console)?;
        let mut moved = Instant::now();
        let mut changed = true;
        // Over SSH nothing is drawn before this time: a held key or a dragged mouse would fill the line
        // with frames that nobody sees in time.
        let mut due = moved;
        while !self.runtime.app.finished {
            if changed && Instant::now() >= due {
                if std::mem::take(&mut self.console.redraw) {
                    // Unlike `clear` this does not query the position of the cursor on the input that
                    // the other thread reads.
                    let size = self.console.terminal.size()?;
                    self.console.terminal.resize(Rect::from((Position::ORIGIN, size)))?;
                }
                if self.remote {
                    self.measure_traffic(frames);
                    due = Instant::now() + frame_time;
                }
                let Session { runtime, console, draw, .. } = self;
                console.terminal.draw(|frame| draw(frame, &runtime.app))?;
                changed = false;
            }
            let app = &self.runtime.app;
            let playing = app.play.playing && app.is_current() && app.manual.is_none();
            if !playing {
                moved = Instant::now();
            }
            let step = playing.then(|| frame_time.saturating_sub(moved.elapsed()));
            let frame = changed.then(|| due.saturating_duration_since(Instant::now()));
            let wait = step.into_iter().chain(frame).min();
            let mut next = self.wait_for_message(wait);
            let since = Instant::now();
            while let Some(message) = next {
                let action = match message {
                    Message::InputEnded => return Ok(None),
                    Message::Ended(signal) => return Ok(Some(signal)),
                    // The terminal has been taken again already.
                    Message::Continued if self.console.own_stops > 0 => {
                        self.console.own_stops -= 1;
                        None
                    }
                    Message::Continued => {
                        self.console.guard.take_again()?;
                        Some(self.console.resize()?)
                    }
                    Message::Resized => Some(self.console.resize()?),
                    Message::Input(event) => input::action_of(event),
                    Message::Act(action) => Some(*action),
                };
                if let Some(action) = action {
                    changed = true;
                    // A window that shrank and grew back between two frames has lost its content,
                    // though its size is that of the last frame.
                    self.console.redraw |= matches!(action, Action::Resize(..));
                    self.act(action)?;
                }
                // Keys faster than their effects would else be drawn after the last one.
                let is_late = since.elapsed() >= DRAINING;
                next = if is_late { None } else { self.wait_for_message(Some(Duration::ZERO)) };
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

    /// The next message, after `wait` at most; `None` waits without limit.
    fn wait_for_message(&self, wait: Option<Duration>) -> Option<Message> {
        match wait {
            Some(wait) => self.inbox.recv_timeout(wait).ok(),
            None => self.inbox.recv().ok(),
        }
    }

    /// Applies an action and keeps unsaved changes before they are drawn.
    fn act(&mut self, action: Action) -> io::Result<()> {
        self.runtime.act(action, &mut self.console)?;
        let app = &mut self.runtime.app;
        let now = (app.edit.generation, app.edit.saves);
        if let Some(autosave) = self.autosave.as_mut().filter(|_| now != self.kept) {
            self.kept = now;
            if let Err(error) = autosave.keep(&app.unsaved()) {
                self.autosave = None;
                app.set_error(format!("unsaved changes are not kept for another session: {error}"));
            }
        }
        Ok(())
    }

    /// Reports the number of bytes written, once in a second of drawing.
    fn measure_traffic(&mut self, frames: u32) {
        let (since, before) = self.traffic;
        let elapsed = since.elapsed();
        let app = &mut self.runtime.app;
        if app.view.traffic.is_some() && elapsed < Duration::from_secs(1) {
            return;
        }
        let written = self.written.get();
        let bytes = (written - before) as f64 / elapsed.as_secs_f64().max(1.0);
        self.traffic = (Instant::now(), written);
        app.view.traffic = Some(Traffic { frames, bytes: bytes as u64 });
    }
}
