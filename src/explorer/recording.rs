//! Recordings of the explorer on a terminal: asciicast v2, <https://docs.asciinema.org/manual/asciicast/v2/>.

use super::app::App;
use super::terminal::FrameWriter;
use super::view;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{Terminal, TerminalOptions, Viewport};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

pub struct Recording<W: Write> {
    out: W,
    terminal: Terminal<CrosstermBackend<FrameWriter<Sent>>>,
    sent: Sent,
}

/// Bytes sent to the terminal, shared with its writer.
#[derive(Clone, Default)]
struct Sent(Rc<RefCell<Vec<u8>>>);

impl Write for Sent {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<W: Write> Recording<W> {
    /// Begins the recording of a terminal of a width and a height in cells. The recording states no date: the same demo
    /// gives the same file.
    pub fn new(mut out: W, (width, height): (u16, u16), title: &str) -> io::Result<Self> {
        // The theme decides on colours, not the environment.
        crossterm::style::force_color_output(true);
        let title = serde_json::to_string(title)?;
        writeln!(
            out,
            r#"{{"version":2,"width":{width},"height":{height},"title":{title},"env":{{"TERM":"xterm-256color"}}}}"#
        )?;
        let sent = Sent::default();
        let backend = CrosstermBackend::new(FrameWriter::new(sent.clone()));
        let viewport = Viewport::Fixed(Rect::new(0, 0, width, height));
        let terminal = Terminal::with_options(backend, TerminalOptions { viewport })?;
        Ok(Recording { out, terminal, sent })
    }

    /// Records the screen at a time, in seconds since the beginning, and returns the number of bytes for the terminal.
    /// A screen without a change is left out.
    pub fn frame(&mut self, seconds: f64, app: &App) -> io::Result<usize> {
        self.terminal.draw(|frame| view::draw(frame, app))?;
        let bytes = self.sent.0.take();
        if !bytes.is_empty() {
            let text = serde_json::to_string(&String::from_utf8_lossy(&bytes))?;
            writeln!(self.out, "[{:?}, \"o\", {text}]", (seconds * 1e6).round() / 1e6)?;
        }
        Ok(bytes.len())
    }
}
