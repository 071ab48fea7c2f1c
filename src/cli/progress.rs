//! Long computations of commands: their progress on standard error, on a terminal a single line
//! that changes, and the signals that end them.

use super::error::CliError;
use asperity_data::Control;
use std::io;
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Shortest time between two texts on a terminal.
const BETWEEN: Duration = Duration::from_millis(50);

/// Message of a command that a signal ends before its results are complete.
const STOPPED: &str = "stopped; no results are written";

#[derive(Default)]
pub(super) struct ProgressLine {
    /// Time of the text on the terminal, if there is one.
    drawn: Option<Instant>,
}

impl ProgressLine {
    /// Shows a text on a terminal in place of the previous one, unless the previous one is hardly
    /// drawn. Without a terminal, prints `plain` if it is given. A closed standard error is no
    /// failure.
    pub(super) fn show(&mut self, text: &str, plain: Option<&str>) {
        let mut stderr = io::stderr();
        if stderr.is_terminal() {
            let is_early = self.drawn.is_some_and(|drawn| drawn.elapsed() < BETWEEN);
            if is_early && plain.is_none() {
                return;
            }
            self.drawn = Some(Instant::now());
            let _ = write!(stderr, "\r\x1b[K{text}").and_then(|()| stderr.flush());
        } else if let Some(plain) = plain {
            let _ = writeln!(stderr, "{plain}");
        }
    }

    /// Removes the text from the terminal.
    pub(super) fn clear(&self) {
        if self.drawn.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K").and_then(|()| io::stderr().flush());
        }
    }

    /// Keeps the text on the terminal, and begins the next line.
    pub(super) fn keep(&self) {
        if self.drawn.is_some() {
            let _ = writeln!(io::stderr());
        }
    }
}

/// A long computation of a command.
pub(super) struct Task<'a> {
    /// Name of what is computed, with which the message of an error begins; `None` if the error has
    /// a name itself.
    pub name: Option<&'a str>,
    pub threads: usize,
    /// Text on a terminal until the first progress.
    pub begins: String,
}

/// Shows no progress of a short computation, which a signal can still end.
pub(super) fn show_nothing<P>(_: &P, _: &mut ProgressLine) {}

/// Runs a computation. `show` shows its progress on a terminal, where the last text is removed at
/// the end. A signal that asks the process to end ends the computation.
///
/// # Errors
/// The computation fails, or a signal ended it.
pub(super) fn watched<P, T, E: Into<CliError>>(
    task: Task<'_>,
    mut show: impl FnMut(&P, &mut ProgressLine),
    work: impl FnOnce(Control<'_, P>) -> Result<T, E>,
) -> Result<T, CliError> {
    let watch = SignalWatch::begin()?;
    let mut line = ProgressLine::default();
    line.show(&task.begins, None);
    let stop = || watch.is_signalled();
    let mut report = |progress: &P| show(progress, &mut line);
    let control = Control::default()
        .on_threads(task.threads)
        .stopped_by(&stop)
        .reporting_to(&mut report);
    let result = work(control);
    line.clear();
    if watch.is_signalled() {
        return Err(watch.interrupted(STOPPED));
    }
    result.map_err(|error| {
        let error = error.into();
        match task.name {
            Some(name) => CliError::named(name, error),
            None => error,
        }
    })
}

/// Signals of the process, once they are watched.
static SIGNALS: OnceLock<Signals> = OnceLock::new();

struct Signals {
    /// True while a signal ends the process at once.
    act_at_once: Arc<AtomicBool>,
    /// Number of the first signal that came while signals were watched; 0 until then.
    first: Arc<AtomicUsize>,
}

/// Watch over the signals that ask the process to end. While there is a watch, the first of them is
/// noted, and a second one ends the process at once. Without a watch, each does.
pub(super) struct SignalWatch {
    signals: &'static Signals,
}

impl SignalWatch {
    pub(super) fn begin() -> io::Result<SignalWatch> {
        let signals = match SIGNALS.get() {
            Some(signals) => signals,
            None => {
                let signals = Signals::register()?;
                SIGNALS.get_or_init(|| signals)
            }
        };
        signals.act_at_once.store(false, Ordering::SeqCst);
        Ok(SignalWatch { signals })
    }

    /// Returns true if a signal has asked the process to end.
    pub(super) fn is_signalled(&self) -> bool {
        self.signals.first.load(Ordering::SeqCst) != 0
    }

    /// Creates the error of a command that the signal has ended.
    pub(super) fn interrupted(&self, message: impl Into<String>) -> CliError {
        CliError::interrupted(&self.signals.first, message)
    }
}

impl Drop for SignalWatch {
    fn drop(&mut self) {
        self.signals.act_at_once.store(true, Ordering::SeqCst);
    }
}

impl Signals {
    fn register() -> io::Result<Signals> {
        let signals = Signals {
            act_at_once: Arc::new(AtomicBool::new(true)),
            first: Arc::new(AtomicUsize::new(0)),
        };
        #[cfg(unix)]
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            let Signals { act_at_once, first } = &signals;
            signal_hook::flag::register_conditional_default(signal, Arc::clone(act_at_once))?;
            signal_hook::flag::register(signal, Arc::clone(act_at_once))?;
            signal_hook::flag::register_usize(signal, Arc::clone(first), signal as usize)?;
        }
        Ok(signals)
    }
}
