//! Progress on standard error, on a terminal a single line that changes, and the signals that end a
//! long command.

use std::io;
use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize};

#[derive(Default)]
pub(super) struct ProgressLine {
    is_drawn: bool,
}

impl ProgressLine {
    /// Shows a text on a terminal in place of the previous one. Without a terminal, prints `plain`
    /// if it is given. A closed standard error is no failure.
    pub(super) fn show(&mut self, text: &str, plain: Option<&str>) {
        let mut stderr = io::stderr();
        if stderr.is_terminal() {
            self.is_drawn = true;
            let _ = write!(stderr, "\r\x1b[K{text}").and_then(|()| stderr.flush());
        } else if let Some(plain) = plain {
            let _ = writeln!(stderr, "{plain}");
        }
    }

    /// Removes the text from the terminal.
    pub(super) fn clear(&self) {
        if self.is_drawn {
            let _ = write!(io::stderr(), "\r\x1b[K").and_then(|()| io::stderr().flush());
        }
    }

    /// Keeps the text on the terminal, and begins the next line.
    pub(super) fn keep(&self) {
        if self.is_drawn {
            let _ = writeln!(io::stderr());
        }
    }
}

/// Returns the number of the first signal that asks the process to end, 0 until then; a second
/// signal ends it at once.
pub(super) fn stop_by_signal() -> io::Result<Arc<AtomicUsize>> {
    let first = Arc::new(AtomicUsize::new(0));
    #[cfg(unix)]
    {
        let stop = Arc::new(AtomicBool::new(false));
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            signal_hook::flag::register_conditional_default(signal, Arc::clone(&stop))?;
            signal_hook::flag::register(signal, Arc::clone(&stop))?;
            signal_hook::flag::register_usize(signal, Arc::clone(&first), signal as usize)?;
        }
    }
    Ok(first)
}
