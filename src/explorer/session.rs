//! A session: input, worker and terminal around one model.

use super::action::{Action, Traffic};
use super::config::Config;
use super::drafts::{Drafts, Restored};
use super::file_job::FileJob;
use super::input;
use super::model::{Model, Notice};
use super::opening::Opening;
use super::signals::{SystemSignal, watch_for_signals};
use super::snapshot::SolvedScene;
use super::study::{Accuracy, Study};
use super::terminal::{self, FrameWriter, TerminalGuard};
use super::theme::{Appearance, Marker, Theme};
use super::update::{Effect, request, study_tasks, update};
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
use std::collections::VecDeque;
use std::io::{self, Write};
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// Frames per second where the configuration has no other number.
pub const FRAME_RATE: u32 = 30;
/// Most frames per second over SSH, where each has to travel.
const REMOTE_FRAMES: u32 = 12;

/// Most cells of a window, of about 100 bytes each.
const MOST_CELLS: u32 = 4_000_000;

/// Longest time of actions without a frame.
const DRAINING: Duration = Duration::from_millis(100);

/// Longest wait for a file job before anything else is done: keys typed after the job act on its result. Longer
/// jobs continue in the background.
const JOB: Duration = Duration::from_millis(50);

/// Options of the explorer.
#[derive(Default)]
pub struct Options {
    /// Colours in place of those by the environment.
    pub theme: Option<Theme>,
    /// Markers in place of those by the environment.
    pub marker: Option<Marker>,
    /// True to leave the mouse to the terminal.
    pub no_mouse: bool,
    /// Unsaved changes of another session; the opened scene is the first.
    pub restored: Option<Restored>,
    /// Configuration; options here have precedence.
    pub config: Config,
    /// Message that is shown at the start.
    pub warning: Option<String>,
    /// Folder in which unsaved changes are kept; `None`: nowhere.
    pub drafts: Option<PathBuf>,
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
pub type Draw = fn(&mut Frame<'_>, &Model);

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
    /// The file job of this number is done.
    Done(u64, Box<Action>),
}

impl Message {
    fn act(action: Action) -> Self {
        Message::Act(Box::new(action))
    }
}

/// File job in the background.
#[derive(Clone, Copy)]
struct Beside {
    number: u64,
    /// Generation of the scene at the request.
    generation: u64,
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
        marker: options.marker.or(options.config.marker).unwrap_or(environment.marker),
    };
    let frame_rate = options.config.frame_rate.unwrap_or(FRAME_RATE);
    let mut model = Model::new(document, (size.width, size.height), appearance);
    model.opens_beside = beside;
    if let Some(study_map) = study_map {
        model.show_study(study_map);
    }
    model.configure(options.config);
    if let Some(warning) = options.warning {
        model.set_error(warning);
    }
    if let Some(restored) = &options.restored {
        model.restore(&restored.documents);
    }
    let send_action = sender(&messages, Message::act);
    let keep = move |action| {
        send_action(action);
    };
    let start = |folder| Drafts::start(folder, options.restored, keep);
    let drafts = options.drafts.map(start).transpose()?;
    let mut session = Session {
        terminal: &mut terminal,
        guard,
        model,
        worker: Worker::new(requests, newest),
        study,
        draw,
        remote: ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| std::env::var_os(name).is_some()),
        frame_rate,
        redraw: false,
        own_stops: 0,
        written,
        traffic: (Instant::now(), 0),
        inbox,
        messages,
        held: VecDeque::new(),
        jobs: 0,
        opening: None,
        drafts,
        kept: (0, 0),
    };
    let signal = session.run()?;
    session.leave_drafts();
    let model = session.model;
    let computed = model.current().cloned();
    Ok(SessionEnd { document: model.document, computed, signal })
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

struct Session<'a, W: Write> {
    terminal: &'a mut Terminal<CrosstermBackend<FrameWriter<W>>>,
    guard: TerminalGuard,
    model: Model,
    worker: Worker,
    study: Study,
    draw: Draw,
    remote: bool,
    /// Frames per second of the animation.
    frame_rate: u32,
    /// True if the content of the screen is unknown.
    redraw: bool,
    /// Own stops without a signal of continuation so far.
    own_stops: u32,
    /// Bytes written so far.
    written: Rc<Cell<u64>>,
    /// Time of the last report of the traffic, and the bytes written by then.
    traffic: (Instant, u64),
    inbox: Receiver<Message>,
    messages: Sender<Message>,
    /// Messages that arrived during a file job.
    held: VecDeque<Message>,
    /// File jobs so far.
    jobs: u64,
    /// The newest background job that opens a scene or a study.
    opening: Option<Beside>,
    /// Keeps unsaved changes.
    drafts: Option<Drafts>,
    /// Generation and number of saves when changes were last kept.
    kept: (u64, u64),
}

impl<W: Write> Session<'_, W> {
    /// Runs until the explorer is to end; returns the signal that ends it, if any.
    fn run(&mut self) -> io::Result<Option<i32>> {
        let frames = if self.remote { self.frame_rate.min(REMOTE_FRAMES) } else { self.frame_rate };
        let frame_time = Duration::from_secs(1) / frames;
        self.perform(vec![Effect::Compute])?;
        let mut moved = Instant::now();
        let mut changed = true;
        // Over SSH nothing is drawn before this time: a held key or a dragged mouse would fill the line
        // with frames that nobody sees in time.
        let mut due = moved;
        while !self.model.finished {
            if changed && Instant::now() >= due {
                if std::mem::take(&mut self.redraw) {
                    // Unlike `clear` this does not query the position of the cursor on the input that
                    // the other thread reads.
                    let size = self.terminal.size()?;
                    self.terminal.resize(Rect::from((Position::ORIGIN, size)))?;
                }
                if self.remote {
                    self.measure_traffic(frames);
                    due = Instant::now() + frame_time;
                }
                let Session { terminal, model, draw, .. } = self;
                terminal.draw(|frame| draw(frame, model))?;
                changed = false;
            }
            self.keep_drafts();
            let playing = self.model.player.playing && self.model.is_current() && self.model.manual.is_none();
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
                    Message::Continued if self.own_stops > 0 => {
                        self.own_stops -= 1;
                        None
                    }
                    Message::Continued => {
                        self.guard.take_again()?;
                        Some(self.resize()?)
                    }
                    Message::Resized => Some(self.resize()?),
                    // In the present mode: the key before may have changed it.
                    Message::Input(event) => {
                        input::action_of(&event, &self.model.bindings, self.model.keys())
                    }
                    Message::Act(action) => Some(*action),
                    Message::Done(number, action) => Some(self.late(number, *action)),
                };
                if let Some(action) = action {
                    changed = true;
                    // A window that shrank and grew back between two frames has lost its content,
                    // though its size is that of the last frame.
                    self.redraw |= matches!(action, Action::Resize(..));
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

    /// Action for a window of another size.
    fn resize(&self) -> io::Result<Action> {
        let size = window(self.terminal)?;
        Ok(Action::Resize(size.width, size.height))
    }

    /// The next message, after `wait` at most; `None` waits without limit.
    fn wait_for_message(&mut self, wait: Option<Duration>) -> Option<Message> {
        let received = |inbox: &Receiver<Message>| match wait {
            Some(wait) => inbox.recv_timeout(wait).ok(),
            None => inbox.recv().ok(),
        };
        self.held.pop_front().or_else(|| received(&self.inbox))
    }

    /// Runs a file job, and performs its action here if that comes soon.
    fn work_on_files(&mut self, job: FileJob) -> io::Result<()> {
        self.jobs += 1;
        let number = self.jobs;
        let description = job.describe();
        let opens = matches!(job, FileJob::Open(_));
        let messages = self.messages.clone();
        job.start(move |action| drop(messages.send(Message::Done(number, Box::new(action)))));
        let until = Instant::now() + JOB;
        while let Ok(message) = self.inbox.recv_timeout(until.saturating_duration_since(Instant::now())) {
            match message {
                Message::Done(done, action) if done == number => return self.act(*action),
                other => self.held.push_back(other),
            }
        }
        self.model.notice = Some(Notice::Done(description));
        if opens {
            self.opening = Some(Beside { number, generation: self.model.generation });
        }
        Ok(())
    }

    /// Action that follows a background job. An opened scene does not replace one opened or changed
    /// since.
    fn late(&mut self, number: u64, action: Action) -> Action {
        let Action::Opened(Ok(opening)) = &action else { return action };
        let is_wanted =
            |beside: Beside| beside.number == number && beside.generation == self.model.generation;
        if self.opening.is_some_and(is_wanted) {
            return action;
        }
        let name = opening.document.name();
        Action::Opened(Err(format!("{name}: read too late, another scene is shown by now; open it again")))
    }

    /// Keeps unsaved changes after an edit or a save.
    fn keep_drafts(&mut self) {
        let now = (self.model.generation, self.model.saves);
        if let Some(drafts) = self.drafts.as_ref().filter(|_| now != self.kept) {
            drafts.keep(self.model.unsaved().into_iter().cloned().collect());
            self.kept = now;
        }
    }

    /// Keeps unsaved changes where the user was not asked about them, else none.
    fn leave_drafts(&mut self) {
        self.keep_drafts();
        let Some(drafts) = &self.drafts else { return };
        if self.model.finished {
            drafts.keep(Vec::new());
        }
        drafts.flush();
    }

    fn act(&mut self, action: Action) -> io::Result<()> {
        let effects = update(&mut self.model, action);
        self.perform(effects)
    }

    /// Reports the number of bytes written, once in a second of drawing.
    fn measure_traffic(&mut self, frames: u32) {
        let (since, before) = self.traffic;
        let elapsed = since.elapsed();
        if self.model.traffic.is_some() && elapsed < Duration::from_secs(1) {
            return;
        }
        let written = self.written.get();
        let bytes = (written - before) as f64 / elapsed.as_secs_f64().max(1.0);
        self.traffic = (Instant::now(), written);
        let traffic = Traffic { frames, bytes: bytes as u64 };
        update(&mut self.model, Action::Traffic(traffic));
    }

    /// Performs the effects of an update.
    fn perform(&mut self, effects: Vec<Effect>) -> io::Result<()> {
        for effect in effects {
            match effect {
                Effect::Compute | Effect::Show | Effect::Beside | Effect::Manual(_) | Effect::Preview(_) => {
                    if effect == Effect::Compute {
                        // Estimates of the former scene are of no use, and take time from this one.
                        self.study.stop();
                    }
                    if let Some(request) = request(&self.model, &effect) {
                        self.worker.ask(request);
                    }
                }
                Effect::Study => self.study.ask(self.model.generation, study_tasks(&self.model)),
                Effect::DrawSeed => {
                    // Six digits are enough for another line and can be read out to a colleague.
                    let seed = rand::random_range(0..1_000_000);
                    self.act(Action::SetSeed(seed))?;
                }
                Effect::Write { path, content, overwrite } => {
                    let model = Box::new(self.model.clone());
                    self.work_on_files(FileJob::Write { model, path, content, overwrite })?;
                }
                Effect::Remember { path, appearance } => {
                    self.work_on_files(FileJob::Remember { path, appearance })?;
                }
                Effect::Complete(typed) => self.work_on_files(FileJob::Complete(typed))?,
                Effect::List => self.work_on_files(FileJob::List)?,
                Effect::Open(name) => self.work_on_files(FileJob::Open(name))?,
                Effect::StopPreview => self.worker.stop_preview(),
                Effect::Copy(text) => {
                    // Sent with the next frame; the terminal does not confirm a copy.
                    queue!(self.terminal.backend_mut(), CopyToClipboard::to_clipboard_from(text))?;
                }
                Effect::Suspend => {
                    self.own_stops += 1;
                    self.guard.suspend()?;
                    // The window may have another size by now.
                    self.redraw = true;
                    let resize = self.resize()?;
                    self.act(resize)?;
                }
            }
        }
        Ok(())
    }
}
