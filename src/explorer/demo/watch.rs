//! The demo in a terminal, in real time.

use super::Demo;
use crate::explorer::cell_writer::CellWriter;
use crate::explorer::terminal::{FrameWriter, TerminalGuard, line_feeds, window};
use crate::explorer::terminal_input::Input;
use crate::explorer::{input, view};
use crossterm::event::{Event, KeyEventKind};
use ratatui::Terminal;
use std::io;
use std::mem::ManuallyDrop;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Plays a demo in the terminal until the demo is over or the user presses a key.
pub fn play(demo: &mut Demo, frames_per_second: f64) -> io::Result<()> {
    demo.set_note("any key ends the demo");
    let mut size = window()?;
    let _guard = TerminalGuard::take(false)?;
    let (sender, inbox) = channel();
    input::read(move |event| sender.send(event).is_ok())?;
    let backend = CellWriter::new(FrameWriter::new(io::stdout()), line_feeds());
    let mut terminal = ManuallyDrop::new(Terminal::new(backend)?);
    let frame = Duration::from_secs_f64(frames_per_second.recip());
    let begun = Instant::now();
    let mut frames = 0;
    while demo.advance().is_some() {
        let present = window()?;
        if present != size {
            size = present;
            demo.resize(size.width, size.height);
        }
        terminal.draw(|area| view::draw(area, demo.app()))?;
        frames += 1;
        let due = begun + frame * frames;
        loop {
            match inbox.recv_timeout(due.saturating_duration_since(Instant::now())) {
                Ok(Some(Input::Event(Event::Key(key)))) if key.kind == KeyEventKind::Press => {
                    return Ok(());
                }
                Ok(Some(_)) => {}
                Err(RecvTimeoutError::Timeout) => break,
                Ok(None) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
            }
        }
    }
    Ok(())
}
