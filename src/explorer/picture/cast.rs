//! Recordings of a terminal: asciicast v2, <https://docs.asciinema.org/manual/asciicast/v2/>.

use serde::Serialize;
use std::io::{self, Write};

/// The first line of a recording, without a date, so that the same session results in the same file.
#[derive(Serialize)]
struct Header<'a> {
    version: u8,
    width: u16,
    height: u16,
    title: &'a str,
    env: Environment,
}

#[derive(Serialize)]
struct Environment {
    #[serde(rename = "TERM")]
    term: &'static str,
}

/// A recording in progress: the output to the terminal, with times.
pub struct Cast<W: Write> {
    out: W,
    /// Time of the last frame, µs.
    last: u64,
}

impl<W: Write> Cast<W> {
    /// Begins a recording of a terminal of so many columns and rows.
    ///
    /// # Errors
    /// When writing fails.
    pub fn new(mut out: W, width: u16, height: u16, title: &str) -> io::Result<Self> {
        let env = Environment { term: "xterm-256color" };
        let header = serde_json::to_string(&Header { version: 2, width, height, title, env })?;
        writeln!(out, "{header}")?;
        Ok(Cast { out, last: 0 })
    }

    /// Records the output to the terminal at a time, in seconds since the beginning. No output is left
    /// out. Time does not go back: an earlier time, or one that is no number, counts as that of the last
    /// frame.
    ///
    /// # Errors
    /// [`io::ErrorKind::InvalidData`] for bytes that are not UTF-8; else when writing fails.
    pub fn frame(&mut self, seconds: f64, bytes: &[u8]) -> io::Result<()> {
        let text =
            std::str::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
        if text.is_empty() {
            return Ok(());
        }
        if seconds.is_finite() {
            self.last = self.last.max((seconds * 1e6).round() as u64);
        }
        let (seconds, micros) = (self.last / 1_000_000, self.last % 1_000_000);
        let fraction = format!("{micros:06}");
        let fraction = match fraction.trim_end_matches('0') {
            "" => "0",
            digits => digits,
        };
        writeln!(self.out, "[{seconds}.{fraction}, \"o\", {}]", serde_json::to_string(text)?)
    }

    /// Ends the recording and returns its writer.
    ///
    /// # Errors
    /// When writing fails.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::backend::{Backend, CrosstermBackend};
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::{Color, Modifier, Style};
    use serde_json::{Value, json};

    fn lines(cast: Cast<Vec<u8>>) -> Vec<Value> {
        let text = String::from_utf8(cast.finish().unwrap()).unwrap();
        assert!(text.ends_with('\n'));
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    #[test]
    fn a_recording_begins_with_its_header() {
        let cast = Cast::new(Vec::new(), 120, 40, "κ \"6\"").unwrap();
        let text = String::from_utf8(cast.finish().unwrap()).unwrap();
        assert_eq!(
            text,
            r#"{"version":2,"width":120,"height":40,"title":"κ \"6\"","env":{"TERM":"xterm-256color"}}"#
                .to_owned()
                + "\n"
        );
    }

    #[test]
    fn frames_keep_their_bytes_and_their_order() {
        let mut cast = Cast::new(Vec::new(), 80, 24, "").unwrap();
        let times = [0.0, 0.1, 0.05, f64::NAN, 1.0 / 3.0, -1.0, f64::INFINITY, 12.5, 60.000_000_4];
        for (number, time) in times.into_iter().enumerate() {
            cast.frame(time, format!("\u{1b}[2J\r\n\t\"\\{number}⣿漢\u{7f}").as_bytes()).unwrap();
        }
        let lines = lines(cast);
        assert_eq!(lines[0]["version"], json!(2));
        let expected = [0.0, 0.1, 0.1, 0.1, 0.333_333, 0.333_333, 0.333_333, 12.5, 60.0];
        assert_eq!(lines.len(), 1 + expected.len());
        for (number, (line, time)) in lines[1..].iter().zip(expected).enumerate() {
            assert_eq!(*line, json!([time, "o", format!("\u{1b}[2J\r\n\t\"\\{number}⣿漢\u{7f}")]));
        }
    }

    #[test]
    fn nothing_written_is_no_frame() {
        let mut cast = Cast::new(Vec::new(), 80, 24, "").unwrap();
        cast.frame(1.0, b"").unwrap();
        cast.frame(0.5, b"x").unwrap();
        assert_eq!(lines(cast)[1..], [json!([0.5, "o", "x"])]);
    }

    #[test]
    fn bytes_that_are_no_text_are_refused_and_leave_no_trace() {
        let mut cast = Cast::new(Vec::new(), 80, 24, "").unwrap();
        let error = cast.frame(2.0, &"⣿".as_bytes()[..2]).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidData);
        cast.frame(1.0, b"x").unwrap();
        assert_eq!(lines(cast)[1..], [json!([1.0, "o", "x"])]);
    }

    /// Screens, each a change of the one before.
    fn screens() -> Vec<Buffer> {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 30, 6));
        let mut screens = vec![buffer.clone()];
        buffer.set_string(0, 0, "┌ Force F(d) ─┐ 漢字 ⟨∇z⟩", Style::new().fg(Color::Green));
        buffer.set_string(1, 2, "⣀⠤⠒⠉ ▌ \"\\ µN", Style::new().add_modifier(Modifier::BOLD));
        screens.push(buffer.clone());
        buffer.set_string(3, 2, "◆ now", Style::new().add_modifier(Modifier::REVERSED));
        buffer.set_string(24, 5, "12.4", Style::new().fg(Color::Magenta));
        screens.push(buffer.clone());
        buffer.set_string(0, 0, "              ", Style::reset());
        screens.push(buffer);
        screens
    }

    #[test]
    fn played_back_it_shows_what_was_drawn() {
        crossterm::style::force_color_output(true);
        let screens = screens();
        let mut cast = Cast::new(Vec::new(), 30, 6, "").unwrap();
        for (number, pair) in screens.windows(2).enumerate() {
            let mut bytes = Vec::new();
            CrosstermBackend::new(&mut bytes).draw(pair[0].diff(&pair[1]).into_iter()).unwrap();
            cast.frame(number as f64, &bytes).unwrap();
        }
        let mut terminal = vt100::Parser::new(6.try_into().unwrap(), 30.try_into().unwrap(), 0);
        let lines = lines(cast);
        assert_eq!(lines.len(), screens.len());
        for (line, screen) in lines[1..].iter().zip(&screens[1..]) {
            terminal.process(line[2].as_str().unwrap().as_bytes());
            for glyph in super::super::glyphs(screen) {
                let shown = terminal.screen().cell(glyph.row, glyph.column).unwrap();
                let contents = if shown.has_contents() { shown.contents() } else { " " };
                assert_eq!(contents, glyph.symbol(), "{} {}", glyph.row, glyph.column);
                let colour = match glyph.cell.fg {
                    Color::Green => vt100::Color::Idx(2),
                    Color::Magenta => vt100::Color::Idx(5),
                    _ => vt100::Color::Default,
                };
                let modifier = glyph.cell.modifier;
                assert_eq!(
                    (shown.fgcolor(), shown.bold(), shown.inverse()),
                    (colour, modifier.contains(Modifier::BOLD), modifier.contains(Modifier::REVERSED))
                );
            }
        }
    }
}
