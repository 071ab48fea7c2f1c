//! Progress of long computations on standard error, and signals that end such computations. On a
//! terminal, the progress is a single line that is written again and again.

use super::error::CliError;
use asperity_data::Control;
use std::io;
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Shortest time between two changes of the progress line on a terminal.
const BETWEEN: Duration = Duration::from_millis(50);

/// Message of a command that a signal has ended before its results were complete.
const STOPPED: &str = "stopped; no results are written";

#[derive(Default)]
pub(super) struct ProgressLine {
    /// Time at which the present text was written to the terminal; `None` if there is no text.
    drawn: Option<Instant>,
}

impl ProgressLine {
    /// Shows the text `text` in the progress line of a terminal. If `plain` is `None`, the text is
    /// skipped when the previous text is younger than [`BETWEEN`]. If standard error is not a
    /// terminal, `plain` is printed instead, unless it is `None`. Errors in writing are ignored,
    /// because standard error may be closed.
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

    /// Removes the text of the progress line from the terminal.
    pub(super) fn clear(&self) {
        if self.drawn.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K").and_then(|()| io::stderr().flush());
        }
    }

    /// Keeps the text of the progress line on the terminal, and moves to the next line.
    pub(super) fn keep(&self) {
        if self.drawn.is_some() {
            let _ = writeln!(io::stderr());
        }
    }
}

/// A long computation of a command.
pub(super) struct Task<'a> {
    /// Name of the scene, study or file. The message of an error begins with it. `None` if the
    /// errors of the computation already have a name.
    pub name: Option<&'a str>,
    pub threads: usize,
    /// Text that is shown on a terminal until the computation reports its first progress.
    pub begins: String,
}

/// Shows no progress, for a computation that is too short. A signal can still end the computation.
pub(super) fn show_nothing<P>(_: &P, _: &mut ProgressLine) {}

/// Runs a computation that a signal, such as Ctrl-C, can stop. `show` shows the progress of the
/// computation on a terminal. At the end the progress is removed.
///
/// # Errors
/// Returns the error of the computation, or an error if a signal ended the computation.
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

/// Signals that the process watches; empty until it watches them for the first time.
static SIGNALS: OnceLock<Signals> = OnceLock::new();

struct Signals {
    /// True while no computation is being watched. A signal then ends the process at once.
    act_at_once: Arc<AtomicBool>,
    /// Number of the first signal that arrived during a watched computation; 0 if none has arrived.
    first: Arc<AtomicUsize>,
}

/// Watch for signals that ask the process to end, such as Ctrl-C. While this value exists, the
/// first signal is only recorded, and a second signal ends the process at once. Without this value,
/// the first signal ends the process at once.
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

    /// Creates the error of a command that a signal has ended. The signal is the one that this
    /// watch has recorded.
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
