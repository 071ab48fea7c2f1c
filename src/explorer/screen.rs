//! A screen without a terminal: returns the bytes for a terminal.

use super::app::App;
use super::terminal::FrameWriter;
use super::view;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{Terminal, TerminalOptions, Viewport};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

/// Screen of the explorer on a terminal.
pub struct Screen {
    terminal: Terminal<CrosstermBackend<FrameWriter<Shared>>>,
    sent: Shared,
}

/// Bytes that the terminal's writer and its owner share.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Screen {
    /// An empty screen of so many columns and rows.
    ///
    /// # Errors
    /// None known.
    pub fn new((columns, rows): (u16, u16)) -> io::Result<Self> {
        // The theme decides on colours, not the environment.
        crossterm::style::force_color_output(true);
        let sent = Shared::default();
        let backend = CrosstermBackend::new(FrameWriter::new(sent.clone()));
        let viewport = Viewport::Fixed(Rect::new(0, 0, columns, rows));
        Ok(Screen { terminal: Terminal::with_options(backend, TerminalOptions { viewport })?, sent })
    }

    /// Draws a model and returns the bytes to be sent.
    ///
    /// # Errors
    /// None known.
    pub fn draw(&mut self, app: &App) -> io::Result<Vec<u8>> {
        self.terminal.draw(|frame| view::draw(frame, app))?;
        Ok(self.sent.0.take())
    }
}
