//! A program in a pseudo-terminal: its output is kept byte by byte and shown on a screen, and each
//! wait has a deadline.

#![allow(dead_code, reason = "no test uses all of it")]

use portable_pty::{
    Child, ChildKiller, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system,
};
use std::collections::VecDeque;
use std::ffi::OsStr;
use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest wait.
const PATIENCE: Duration = Duration::from_secs(20);

/// Time without a byte after which a screen counts as finished: several frames.
const QUIET: Duration = Duration::from_millis(200);

/// Bytes of the program before and after a frame to be shown at once.
pub const BEGIN_FRAME: &[u8] = b"\x1b[?2026h";
pub const END_FRAME: &[u8] = b"\x1b[?2026l";

/// An event of the program.
enum Event {
    Wrote(Vec<u8>, Instant),
    Closed,
    Ended(ExitStatus),
}

/// A received frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Time of its last byte.
    pub arrived: Instant,
    /// Number of its bytes, including the marks around them.
    pub bytes: usize,
}

/// A program to be started in a terminal of its own.
pub struct Program {
    command: CommandBuilder,
    size: (u16, u16),
    /// Home folder of its own: no file of the user is read or written.
    home: TempDir,
}

impl Program {
    /// A program in a window of 120 × 40 whose environment contains only its terminal.
    pub fn new(path: impl AsRef<OsStr>) -> Self {
        let mut command = CommandBuilder::new(path);
        command.env_clear();
        command.env("TERM", "xterm-256color");
        let home = tempfile::tempdir().unwrap();
        command.env("HOME", home.path());
        Program {
            command,
            size: (120, 40),
            home,
        }
    }

    pub fn argument(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.command.arg(argument);
        self
    }

    pub fn env(mut self, name: &str, value: &str) -> Self {
        self.command.env(name, value);
        self
    }

    pub fn folder(mut self, folder: &Path) -> Self {
        self.command.cwd(folder);
        self
    }

    pub fn size(mut self, columns: u16, rows: u16) -> Self {
        self.size = (columns, rows);
        self
    }

    /// Starts the program.
    pub fn start(self) -> Terminal {
        let pty = native_pty_system().openpty(size(self.size)).unwrap();
        let before = attributes(pty.master.as_ref());
        let child = pty.slave.spawn_command(self.command).unwrap();
        // The terminal closes with the program.
        drop(pty.slave);
        let (sender, events) = channel();
        let killer = child.clone_killer();
        let pid = child.process_id().expect("a process has a number");
        await_end(child, sender.clone());
        let closing = Arc::new(AtomicBool::new(false));
        let resting = Arc::new(AtomicBool::new(false));
        let reader = pty.master.try_clone_reader().unwrap();
        let reader = read(reader, sender, Arc::clone(&closing), Arc::clone(&resting));
        let (columns, rows) = self.size;
        Terminal {
            parser: vt100::Parser::new(nonzero(rows), nonzero(columns), 0),
            written: Vec::new(),
            waiting: VecDeque::new(),
            arrived: Instant::now(),
            begun: None,
            frames: Vec::new(),
            keyboard: Some(pty.master.take_writer().unwrap()),
            master: Some(pty.master),
            before,
            events,
            reader: Some(reader),
            closing,
            resting,
            killer,
            pid,
            closed: false,
            ended: None,
            _home: self.home,
        }
    }
}

fn size((cols, rows): (u16, u16)) -> PtySize {
    PtySize {
        rows,
        cols,
        pixel_width: 0,
        pixel_height: 0,
    }
}

fn nonzero(value: u16) -> NonZeroU16 {
    NonZeroU16::new(value).expect("a window has columns and rows")
}

/// Treatment of input and output by the terminal: raw or line by line, with or without echo.
fn attributes(master: &dyn MasterPty) -> String {
    format!(
        "{:?}",
        master.get_termios().expect("a terminal has attributes")
    )
}

fn await_end(mut child: Box<dyn Child + Send + Sync>, events: Sender<Event>) {
    thread::spawn(move || {
        let status = child.wait().unwrap();
        let _ = events.send(Event::Ended(status));
    });
}

fn read(
    mut reader: Box<dyn Read + Send>,
    events: Sender<Event>,
    closing: Arc<AtomicBool>,
    resting: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut bytes = [0; 1 << 16];
        loop {
            while resting.load(Ordering::SeqCst) {
                thread::sleep(Duration::from_millis(5));
            }
            let event = match reader.read(&mut bytes) {
                Ok(count) if count > 0 => Event::Wrote(bytes[..count].to_vec(), Instant::now()),
                _ => Event::Closed,
            };
            let done = matches!(event, Event::Closed) || closing.load(Ordering::SeqCst);
            if events.send(event).is_err() || done {
                return;
            }
        }
    })
}

/// A program in a terminal.
pub struct Terminal {
    parser: vt100::Parser,
    written: Vec<u8>,
    /// Bytes received and not shown yet, frame by frame.
    waiting: VecDeque<Vec<u8>>,
    /// Time of the newest byte.
    arrived: Instant,
    /// Beginning of the unfinished frame.
    begun: Option<usize>,
    frames: Vec<Frame>,
    keyboard: Option<Box<dyn Write + Send>>,
    master: Option<Box<dyn MasterPty + Send>>,
    /// The attributes before the program started.
    before: String,
    events: Receiver<Event>,
    reader: Option<JoinHandle<()>>,
    closing: Arc<AtomicBool>,
    /// True while output is not read.
    resting: Arc<AtomicBool>,
    killer: Box<dyn ChildKiller + Send + Sync>,
    pid: u32,
    closed: bool,
    ended: Option<ExitStatus>,
    _home: TempDir,
}

impl Terminal {
    /// The screen.
    pub fn screen(&self) -> &vt100::Screen {
        self.parser.screen()
    }

    /// The rows of the screen, without the blanks at their ends.
    pub fn rows(&self) -> Vec<String> {
        rows(self.screen())
    }

    /// The screen as one text.
    pub fn text(&self) -> String {
        self.rows().join("\n")
    }

    /// All bytes written so far.
    pub fn written(&self) -> &[u8] {
        &self.written
    }

    /// All frames so far.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Time of the newest byte on the screen, without the time of showing it.
    pub fn arrived(&self) -> Instant {
        self.arrived
    }

    /// Number of the process.
    pub fn pid(&self) -> u32 {
        self.pid
    }

    /// Sends keys in one write, as a terminal does.
    pub fn send(&mut self, keys: &str) {
        let keyboard = self.keyboard.as_mut().expect("the terminal is open");
        keyboard.write_all(keys.as_bytes()).unwrap();
        keyboard.flush().unwrap();
    }

    /// Sends keys if the program still runs.
    pub fn send_if_open(&mut self, keys: impl AsRef<[u8]>) {
        let keyboard = self.keyboard.as_mut().expect("the terminal is open");
        let _ = keyboard
            .write_all(keys.as_ref())
            .and_then(|()| keyboard.flush());
    }

    /// How the program has ended; `None` while it runs.
    pub fn ended(&self) -> Option<&ExitStatus> {
        self.ended.as_ref()
    }

    /// Resizes the window. Its former content is lost, as it may be in a terminal.
    pub fn resize(&mut self, columns: u16, rows: u16) {
        self.parser.process(b"\x1b[2J");
        self.parser.set_size(nonzero(rows), nonzero(columns));
        self.master
            .as_ref()
            .expect("the terminal is open")
            .resize(size((columns, rows)))
            .unwrap();
    }

    /// True if input is echoed and read line by line, as before the start of the program.
    pub fn is_as_before(&self) -> bool {
        let master = self.master.as_ref().expect("the terminal is open");
        attributes(master.as_ref()) == self.before
    }

    /// Waits until the rows of the screen satisfy a condition.
    #[track_caller]
    pub fn wait(&mut self, what: &str, is_there: impl Fn(&[String]) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        while self.begun.is_some() || !is_there(&self.rows()) {
            let gone = self.closed && self.ended.is_some();
            if gone || !self.take(deadline.saturating_duration_since(Instant::now())) {
                panic!(
                    "no {what} on the screen (ended: {:?}):\n{}",
                    self.ended,
                    self.text()
                );
            }
        }
    }

    /// Waits until a text is on the screen.
    #[track_caller]
    pub fn wait_for(&mut self, text: &str) {
        self.wait(text, |rows| rows.iter().any(|row| row.contains(text)));
    }

    /// Waits until a text is no longer on the screen.
    #[track_caller]
    pub fn wait_without(&mut self, text: &str) {
        self.wait(&format!("screen without {text}"), |rows| {
            !rows.iter().any(|row| row.contains(text))
        });
    }

    /// Waits until output pauses.
    #[track_caller]
    pub fn settle(&mut self) {
        self.settle_for(QUIET);
    }

    /// Waits until output pauses for this time.
    #[track_caller]
    pub fn settle_for(&mut self, quiet: Duration) {
        let deadline = Instant::now() + PATIENCE;
        while self.take(quiet) {
            assert!(
                Instant::now() < deadline,
                "it never stops writing:\n{}",
                self.text()
            );
        }
    }

    /// Waits for a condition outside the screen.
    #[track_caller]
    pub fn wait_until(&mut self, what: &str, is_so: impl Fn() -> bool) {
        let deadline = Instant::now() + PATIENCE;
        while !is_so() {
            assert!(Instant::now() < deadline, "not {what}:\n{}", self.text());
            self.take(Duration::from_millis(5));
        }
    }

    /// True if there is no output for a time.
    pub fn is_silent_for(&mut self, time: Duration) -> bool {
        !self.take(time)
    }

    /// Shows output until an instant.
    pub fn take_until(&mut self, moment: Instant) {
        loop {
            let time = moment.saturating_duration_since(Instant::now());
            if time.is_zero() || !self.take(time) {
                return;
            }
        }
    }

    /// Waits until the program has ended and all its output has arrived.
    #[track_caller]
    pub fn wait_end(&mut self) -> ExitStatus {
        self.wait_ended(|terminal| terminal.closed || terminal.reader.is_none())
    }

    /// Stops (or resumes) reading output, as a terminal that hangs does. Output already on its way
    /// is still taken.
    pub fn rest(&self, resting: bool) {
        self.resting.store(resting, Ordering::SeqCst);
    }

    /// Waits until the program has ended, with any output.
    #[track_caller]
    pub fn wait_process(&mut self) -> ExitStatus {
        self.wait_ended(|_| true)
    }

    #[track_caller]
    fn wait_ended(&mut self, is_over: fn(&Terminal) -> bool) -> ExitStatus {
        let deadline = Instant::now() + PATIENCE;
        while self.ended.is_none() || !is_over(self) {
            let time = deadline.saturating_duration_since(Instant::now());
            assert!(
                self.take(time),
                "it does not end:
{}",
                self.text()
            );
        }
        self.ended.clone().expect("it has ended")
    }

    /// Closes the terminal, like a closed window or a dropped connection.
    pub fn hang_up(&mut self) {
        self.closing.store(true, Ordering::SeqCst);
        // The reader returns with the next byte of output: the echo of a key.
        self.send("?");
        self.reader
            .take()
            .expect("the terminal is open")
            .join()
            .unwrap();
        self.keyboard = None;
        self.master = None;
    }

    /// Takes one event, or one frame of output; returns true if there was one in time.
    fn take(&mut self, time: Duration) -> bool {
        if let Some(part) = self.waiting.pop_front() {
            self.show(&part);
            return true;
        }
        match self.events.recv_timeout(time) {
            Ok(Event::Wrote(bytes, at)) => {
                self.arrived = at;
                self.waiting = self.frame_by_frame(&bytes);
                return self.take(time);
            }
            Ok(Event::Closed) => self.closed = true,
            Ok(Event::Ended(status)) => self.ended = Some(status),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return false,
        }
        true
    }

    /// Splits bytes after the end of each frame, also of one whose end arrived in two pieces.
    fn frame_by_frame(&self, bytes: &[u8]) -> VecDeque<Vec<u8>> {
        let before = &self.written[self.written.len().saturating_sub(END_FRAME.len() - 1)..];
        let joined = [before, bytes].concat();
        let ends = joined
            .windows(END_FRAME.len())
            .enumerate()
            .filter(|(_, window)| *window == END_FRAME);
        let mut from = before.len();
        let mut parts = VecDeque::new();
        for to in ends
            .map(|(place, _)| place + END_FRAME.len())
            .chain([joined.len()])
        {
            if to > from {
                parts.push_back(joined[from..to].to_vec());
                from = to;
            }
        }
        parts
    }

    /// Shows received bytes of one frame.
    fn show(&mut self, part: &[u8]) {
        self.parser.process(part);
        let from = self.written.len().saturating_sub(END_FRAME.len() - 1);
        self.written.extend_from_slice(part);
        let place = |mark: &[u8]| {
            let found = self.written[from..]
                .windows(mark.len())
                .position(|window| window == mark);
            found.map(|place| from + place)
        };
        let (begin, end) = (place(BEGIN_FRAME), place(END_FRAME));
        self.begun = begin.or(self.begun);
        if let Some((begun, end)) = self.begun.zip(end) {
            let bytes = end + END_FRAME.len() - begun;
            self.frames.push(Frame {
                arrived: self.arrived,
                bytes,
            });
            self.begun = None;
        }
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        if self.ended.is_none() {
            let _ = self.killer.kill();
        }
    }
}

/// The rows of a screen, without the blanks at their ends.
fn rows(screen: &vt100::Screen) -> Vec<String> {
    let (_, columns) = screen.size();
    screen
        .rows(0, columns.get())
        .map(|row| row.trim_end().to_owned())
        .collect()
}
