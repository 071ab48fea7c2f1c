//! Progress on standard error: on a terminal a single line that changes.

use std::io;
use std::io::{IsTerminal, Write};

#[derive(Default)]
pub(super) struct ProgressLine {
    is_drawn: bool,
}

impl ProgressLine {
    /// Shows a text on a terminal in place of the previous one. Without a terminal, prints `plain` if it is given. A closed
    /// standard error is no failure.
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
