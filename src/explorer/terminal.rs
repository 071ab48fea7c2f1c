//! The terminal: taken over when the explorer opens, given back however it ends.

use crossterm::cursor::Show;
use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::terminal::{
    BeginSynchronizedUpdate, EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen,
    disable_raw_mode, enable_raw_mode,
};
use crossterm::{execute, queue};
use std::io::{self, Stdout, Write};

/// The terminal in the explorer's hands; dropping it gives it back.
pub struct TerminalGuard(());

impl TerminalGuard {
    /// Takes the terminal over.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn take() -> io::Result<Self> {
        // NO_COLOR is read by the theme; left to crossterm it would drop reverse and bold as well.
        crossterm::style::force_color_output(true);
        let before = std::panic::take_hook();
        let drawing = std::thread::current().id();
        std::panic::set_hook(Box::new(move |panic| {
            // A panic of the worker becomes a line in the explorer, which goes on.
            if std::thread::current().id() == drawing {
                let _ = give_back();
                before(panic);
            }
        }));
        enable_raw_mode()?;
        let guard = TerminalGuard(());
        execute!(io::stdout(), EnterAlternateScreen, EnableBracketedPaste)?;
        Ok(guard)
    }
}

impl Drop for TerminalGuard {
    fn drop(&mut self) {
        // Nothing can be done about a terminal that is gone.
        let _ = give_back();
        // While a panic unwinds, the hook cannot be taken and is needed no more.
        if !std::thread::panicking() {
            let _ = std::panic::take_hook();
        }
    }
}

fn give_back() -> io::Result<()> {
    let raw = disable_raw_mode();
    execute!(io::stdout(), DisableBracketedPaste, LeaveAlternateScreen, Show)?;
    raw
}

/// Calls `gone` when the terminal hangs up.
///
/// The signal that tells of it may be ignored (`nohup`), and crossterm then reads the end of its input
/// for ever, at full speed. A thread that waits for nothing but the hang-up costs nothing.
///
/// # Errors
/// When the system gives no thread.
#[cfg(unix)]
pub fn watch_for_hang_up(gone: impl FnOnce() + Send + 'static) -> io::Result<()> {
    use rustix::event::{PollFd, PollFlags, poll};
    std::thread::Builder::new()
        .name("hang-up".to_owned())
        .spawn(move || {
            let input = rustix::stdio::stdin();
            loop {
                let mut waited = [PollFd::new(&input, PollFlags::empty())];
                match poll(&mut waited, None) {
                    Err(rustix::io::Errno::INTR) => {}
                    Err(_) => return,
                    Ok(_) if waited[0].revents().is_empty() => {}
                    Ok(_) => return gone(),
                }
            }
        })
        .map(drop)
}

/// Elsewhere the end of input is an error of its own.
#[cfg(not(unix))]
pub fn watch_for_hang_up(_: impl FnOnce() + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Collects a whole frame and writes it at once, as a synchronized update. Nothing drawn, nothing
/// written.
pub struct FrameWriter {
    frame: Vec<u8>,
    out: Stdout,
}

impl FrameWriter {
    /// A writer of frames to standard output.
    #[must_use]
    pub fn new() -> Self {
        FrameWriter { frame: Vec::with_capacity(64 * 1024), out: io::stdout() }
    }
}

impl Default for FrameWriter {
    fn default() -> Self {
        FrameWriter::new()
    }
}

impl Write for FrameWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.frame.is_empty() {
            queue!(self.frame, BeginSynchronizedUpdate)?;
        }
        self.frame.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.frame.is_empty() {
            return Ok(());
        }
        queue!(self.frame, EndSynchronizedUpdate)?;
        let written = self.out.write_all(&self.frame).and_then(|()| self.out.flush());
        self.frame.clear();
        written
    }
}
