//! The terminal. The explorer takes the terminal over when it starts. When the explorer ends, the
//! terminal is restored, even after a panic.

use super::cursor::LineFeeds;
use crossterm::cursor::Show;
use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::style::Print;
use crossterm::terminal::{
    BeginSynchronizedUpdate, EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen,
    disable_raw_mode, enable_raw_mode,
};
use crossterm::{execute, queue};
use ratatui::layout::Size;
use std::io;
use std::io::Write;

/// Largest number of cells of a window. A cell takes about 100 bytes of memory.
const MOST_CELLS: u32 = 4_000_000;

/// Control sequence that makes the terminal report presses, drags and the wheel of the mouse. The
/// sequence of crossterm would also make it report every other motion. Each of these useless
/// reports would be transmitted and wake the explorer.
const MOUSE_ON: &str = "\x1b[?1000h\x1b[?1002h\x1b[?1006h";
const MOUSE_OFF: &str = "\x1b[?1006l\x1b[?1002l\x1b[?1000l";

/// Control sequence (OSC 11) that asks for the colour of the background.
const BACKGROUND_QUESTION: &str = "\x1b]11;?\x1b\\";

/// The terminal while the explorer uses it. The terminal is restored when this value is dropped,
/// and also on a panic.
pub struct TerminalGuard {
    mouse: bool,
}

impl TerminalGuard {
    /// Takes the terminal over. If `mouse` is true, the explorer also receives the mouse.
    pub fn take(mouse: bool) -> io::Result<Self> {
        // If `NO_COLOR` is set, the theme already has no colours. If crossterm obeyed `NO_COLOR` as
        // well, it would also drop reverse and bold text.
        crossterm::style::force_color_output(true);
        let before = std::panic::take_hook();
        let drawing = std::thread::current().id();
        std::panic::set_hook(Box::new(move |panic| {
            // A panic on another thread becomes a message in the explorer, which continues.
            if std::thread::current().id() == drawing {
                let _ = give_back(mouse);
                before(panic);
            }
        }));
        let guard = TerminalGuard { mouse };
        guard.enter()?;
        Ok(guard)
    }

    fn enter(&self) -> io::Result<()> {
        enable_raw_mode()?;
        let mouse = if self.mouse { MOUSE_ON } else { "" };
        execute!(
            io::stdout(),
            EnterAlternateScreen,
            EnableBracketedPaste,
            Print(mouse)
        )
    }

    /// Takes the terminal over again after another program may have used it.
    pub fn take_again(&self) -> io::Result<()> {
        // The terminal must leave raw mode before it can be taken over.
        disable_raw_mode()?;
        self.enter()
    }

    /// Gives the terminal back to the shell and stops the process, as Ctrl-Z does in other
    /// programs. When the shell continues the process, the terminal is taken over again.
    pub fn suspend(&self) -> io::Result<()> {
        give_back(self.mouse)?;
        stop_until_continued();
        self.enter()
    }
}

/// Asks the terminal for the colour of its background. A terminal that knows the question answers
/// soon; others ignore it.
pub fn ask_background() -> io::Result<()> {
    execute!(io::stdout(), Print(BACKGROUND_QUESTION))
}

impl Drop for TerminalGuard {
    fn drop(&mut self) {
        // If the terminal is gone, it cannot be restored, so the error is ignored.
        let _ = give_back(self.mouse);
        // The hook cannot be removed during a panic, and this is not necessary.
        if !std::thread::panicking() {
            let _ = std::panic::take_hook();
        }
    }
}

/// Restores the terminal. It leaves raw mode last: otherwise a Ctrl+C could make the system discard
/// output that the terminal has not read yet.
fn give_back(mouse: bool) -> io::Result<()> {
    let mouse = if mouse { MOUSE_OFF } else { "" };
    let left = execute!(
        io::stdout(),
        Print(mouse),
        DisableBracketedPaste,
        LeaveAlternateScreen,
        Show
    );
    wait_until_written();
    left.and(disable_raw_mode())
}

/// Waits until the output has been sent, and then a short time longer, because a pseudo-terminal
/// does not report when its output has been read.
#[cfg(unix)]
fn wait_until_written() {
    const READING: std::time::Duration = std::time::Duration::from_millis(20);
    let _ = rustix::termios::tcdrain(rustix::stdio::stdout());
    std::thread::sleep(READING);
}

/// On other systems, output is written immediately, so there is nothing to wait for.
#[cfg(not(unix))]
fn wait_until_written() {}

/// Returns `size` if there is enough memory for a window of this size, otherwise an error. The
/// check is made before any memory is allocated.
pub fn checked(size: Size) -> io::Result<Size> {
    let Size { width, height } = size;
    if u32::from(width) * u32::from(height) > MOST_CELLS {
        let fault =
            format!("a window of {width} × {height} cells; allowed: at most {MOST_CELLS} cells");
        return Err(io::Error::other(fault));
    }
    Ok(size)
}

/// Returns the size of the window in columns and rows. Returns an error if the window needs too
/// much memory.
pub fn window() -> io::Result<Size> {
    let (width, height) = crossterm::terminal::size()?;
    checked(Size { width, height })
}

/// Returns what a line feed does to the column of the cursor. Raw mode belongs to the terminal of
/// the input, and the output may go to another terminal, which is not in raw mode.
#[cfg(unix)]
pub fn line_feeds() -> LineFeeds {
    use rustix::termios::{OutputModes, tcgetattr};
    match tcgetattr(rustix::stdio::stdout()) {
        Ok(state) if !state.output_modes.contains(OutputModes::OPOST) => LineFeeds::KeepColumn,
        _ => LineFeeds::Unknown,
    }
}

#[cfg(not(unix))]
pub fn line_feeds() -> LineFeeds {
    LineFeeds::Unknown
}

/// Stops all processes of this job, as the terminal does for Ctrl-Z. If no shell could continue the
/// job, the system does not stop it.
#[cfg(unix)]
fn stop_until_continued() {
    let _ = rustix::process::kill_current_process_group(rustix::process::Signal::TSTP);
}

/// Other systems cannot stop a job, so nothing is done.
#[cfg(not(unix))]
fn stop_until_continued() {}

/// Calls `gone` when the connection to the terminal is lost.
///
/// The system announces this event by a signal, but the process may ignore the signal (`nohup`).
/// crossterm would then read the end of its input again and again without a pause. A thread
/// therefore waits for the event.
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

/// Does nothing. On systems other than Unix, reading the input returns an error at its end, so that
/// nothing has to be watched.
#[cfg(not(unix))]
pub fn watch_for_hang_up(_: impl FnOnce() + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Writer that collects a whole frame and writes it at once, as a synchronised update. A frame that
/// does not change the screen is not written.
pub struct FrameWriter<W: Write> {
    frame: Vec<u8>,
    out: W,
}

impl<W: Write> FrameWriter<W> {
    pub fn new(out: W) -> Self {
        FrameWriter {
            frame: Vec::with_capacity(64 * 1024),
            out,
        }
    }
}

/// Returns true if a frame changes the screen. Even if ratatui draws nothing, it writes sequences
/// that reset styles and hide the cursor; a frame with only such sequences changes nothing.
fn shows_something(frame: &[u8]) -> bool {
    let mut rest = frame;
    while let Some(sequence) = rest.strip_prefix(b"\x1b[") {
        let Some(end) = sequence.iter().position(|byte| (0x40..0x7f).contains(byte)) else {
            return true;
        };
        let (sequence, after) = sequence.split_at(end + 1);
        if !(sequence.ends_with(b"m") || sequence == b"?25l" || sequence == b"?2026h") {
            return true;
        }
        rest = after;
    }
    !rest.is_empty()
}

impl<W: Write> Write for FrameWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.frame.is_empty() {
            queue!(self.frame, BeginSynchronizedUpdate)?;
        }
        self.frame.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !shows_something(&self.frame) {
            self.frame.clear();
            return Ok(());
        }
        queue!(self.frame, EndSynchronizedUpdate)?;
        let written = self
            .out
            .write_all(&self.frame)
            .and_then(|()| self.out.flush());
        self.frame.clear();
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_beyond_memory_is_refused() {
        for (width, height, is_allowed) in [
            (0, 0, true),
            (2000, 2000, true),
            (2000, 2001, false),
            (65535, 65535, false),
        ] {
            assert_eq!(
                checked(Size { width, height }).is_ok(),
                is_allowed,
                "{width} × {height}"
            );
        }
    }

    #[test]
    fn frames_that_show_nothing_are_not_written() {
        let mut out = Vec::new();
        let mut writer = FrameWriter::new(&mut out);
        writer
            .write_all(b"\x1b[39m\x1b[49m\x1b[59m\x1b[0m\x1b[?25l")
            .unwrap();
        writer.flush().unwrap();
        assert!(writer.out.is_empty());
        writer.write_all(b"\x1b[0m\x1b[3;4Hx").unwrap();
        writer.flush().unwrap();
        assert_eq!(out, b"\x1b[?2026h\x1b[0m\x1b[3;4Hx\x1b[?2026l");
        for shown in [
            b"\x1b[2J".as_slice(),
            b"\x1b]52;c;eA==\x07",
            b"\x1b[0",
            b"x",
        ] {
            assert!(shows_something(shown), "{shown:?}");
        }
    }
}
