//! Writes the changed cells of a frame to a terminal in few bytes. Over a slow line, the bytes of a
//! frame determine how long the answer to a key takes.
//!
//! The backend of ratatui sends both colours of a cell whenever one of them differs from the cell
//! before, and the place of each cell that does not follow the cell before. A colour of 24 bits
//! takes up to 19 bytes and a place up to 10, which is more than the text of most cells.

use super::cursor::{Cursor, LineFeeds, Movement, ShownCells, is_narrow};
use super::pen::{Pen, shows_ink};
use crossterm::queue;
use crossterm::style::Print;
use crossterm::terminal::Clear;
use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};
use ratatui::style::Color;
use std::collections::VecDeque;
use std::io;
use std::io::Write;

/// Backend that writes cells in few bytes. In all else it is the backend of ratatui for crossterm.
pub struct CellWriter<W: Write> {
    inner: CrosstermBackend<W>,
    shown: ShownCells,
    line_feeds: LineFeeds,
}

impl<W: Write> CellWriter<W> {
    pub fn new(out: W, line_feeds: LineFeeds) -> Self {
        CellWriter {
            inner: CrosstermBackend::new(out),
            shown: ShownCells::default(),
            line_feeds,
        }
    }

    /// Returns the text that writes these runs.
    fn text_of(&self, runs: Vec<Run>, last_column: u16) -> String {
        let mut text = String::new();
        let mut pen = Pen::PLAIN;
        let mut cursor: Option<Cursor> = None;
        let mut waiting = VecDeque::from(runs);
        while let Some(next) = self.nearest(&waiting, pen, cursor) {
            let Some(run) = waiting.remove(next) else {
                break;
            };
            let pen_of_run = run.pen_after(pen);
            text.push_str(&pen.change_to(pen_of_run));
            pen = pen_of_run;
            self.movement(cursor, &run, pen)
                .append_to(&mut text, &self.shown);
            text.push_str(&run.text);
            // After the last column, terminals differ in the place of the cursor.
            cursor = (run.next_column <= last_column).then_some(run.end);
        }
        if pen != Pen::PLAIN {
            text.push_str("\x1b[m");
        }
        text
    }

    /// Returns the number of the run that takes the fewest bytes before its text, among the first
    /// runs that wait; `None` if none waits.
    fn nearest(&self, waiting: &VecDeque<Run>, pen: Pen, cursor: Option<Cursor>) -> Option<usize> {
        // Runs of one style follow each other, so the bytes of a change are computed once for them.
        let mut style = pen;
        let mut bytes_of_style = 0;
        let mut nearest = None;
        let mut fewest = usize::MAX;
        for (number, run) in waiting.iter().take(MOST_COMPARED).enumerate() {
            let pen_of_run = run.pen_after(pen);
            if pen_of_run != style {
                style = pen_of_run;
                bytes_of_style = pen.change_to(style).len();
            }
            if bytes_of_style >= fewest {
                continue;
            }
            let bytes = bytes_of_style + self.movement(cursor, run, style).length();
            if bytes < fewest {
                fewest = bytes;
                nearest = Some(number);
            }
        }
        nearest
    }

    fn movement(&self, cursor: Option<Cursor>, run: &Run, pen: Pen) -> Movement {
        Movement::shortest(cursor, run.start, pen, &self.shown, self.line_feeds)
    }
}

/// Largest number of runs among which the next one is chosen. It limits the time of a frame with
/// thousands of runs; a frame of a usual window has fewer.
const MOST_COMPARED: usize = 400;

/// Smallest number of bytes of a control sequence that moves the cursor within a row. Unchanged
/// cells between two changes are written again if they take at most this number of bytes.
const SHORTEST_MOVEMENT: usize = 3;
/// Number of bytes of a gap between blanks that is written again, because it may be erased with
/// them.
const GAP_BETWEEN_BLANKS: usize = 6;

/// Smallest number of blanks that a control sequence erases. It has at least four bytes.
const FEWEST_ERASED: u16 = 5;
/// Smallest number of erased blanks with text after them. The cursor stays before erased blanks, so
/// that another control sequence moves it to the text.
const FEWEST_ERASED_BEFORE_TEXT: u16 = 10;

/// Cells side by side in one style.
struct Run {
    start: Position,
    text: String,
    /// Number of blanks after the text.
    blanks: u16,
    pen: Pen,
    /// True while the run has only blanks, so that it can take any ink.
    is_blank: bool,
    /// Cursor after the run.
    end: Cursor,
    /// Column after the last cell of the run, or a later one if the width of this cell is unknown.
    next_column: u16,
}

impl Run {
    fn new(start: Position, cell: &Cell) -> Run {
        let mut run = Run {
            start,
            text: String::new(),
            blanks: 0,
            pen: Pen::of(cell, Pen::PLAIN),
            is_blank: !shows_ink(cell),
            end: Cursor {
                row: start.y,
                column: Some(start.x),
            },
            next_column: start.x,
        };
        run.push(cell);
        run
    }

    /// Returns true if the cell at `place` continues the run, and then appends it. Cells in a short
    /// gap before it are written again.
    fn takes(&mut self, place: Position, cell: &Cell, shown: &ShownCells) -> bool {
        let Some(column) = self.end.column else {
            return false;
        };
        if self.end.row != place.y || column > place.x {
            return false;
        }
        let is_between_blanks = self.can_erase() && self.blanks > 0 && cell.symbol() == " ";
        let most_bytes = if is_between_blanks {
            GAP_BETWEEN_BLANKS
        } else {
            SHORTEST_MOVEMENT
        };
        let gap = shown.bytes(column, place.x, place.y, self.pen, most_bytes + 1);
        if gap.is_none() {
            return false;
        }
        if self.can_erase() && self.blanks >= FEWEST_ERASED_BEFORE_TEXT && cell.symbol() != " " {
            return false;
        }
        let pen = Pen::of(cell, self.pen);
        let takes_ink = self.is_blank && shows_ink(cell) && !pen.shows_blanks();
        if pen != self.pen && !(takes_ink && pen.ground == self.pen.ground) {
            return false;
        }
        for x in column..place.x {
            if let Some(cell) = shown.get(x, place.y) {
                self.push(cell);
            }
        }
        if takes_ink {
            self.pen = pen;
            self.is_blank = false;
        }
        self.push(cell);
        true
    }

    fn push(&mut self, cell: &Cell) {
        let symbol = cell.symbol();
        if symbol == " " {
            self.blanks += 1;
        } else {
            self.write_blanks();
            self.text.push_str(symbol);
        }
        if is_narrow(symbol) {
            self.next_column += 1;
            self.end.column = Some(self.next_column);
        } else {
            self.next_column += 2;
            self.end.column = None;
        }
    }

    fn write_blanks(&mut self) {
        self.text
            .extend(std::iter::repeat_n(' ', self.blanks.into()));
        self.blanks = 0;
    }

    /// Returns true if an erased cell looks like a blank of this run. Terminals differ in the
    /// ground of erased cells, unless it is their own.
    fn can_erase(&self) -> bool {
        self.pen.ground == Color::Reset && !self.pen.shows_blanks()
    }

    /// Adds the blanks at the end to the text: blanks, or the control sequence that erases the
    /// cells and leaves the cursor before them.
    fn finish(&mut self) {
        if self.can_erase() && self.blanks >= FEWEST_ERASED {
            self.text.push_str(&format!("\x1b[{}X", self.blanks));
            self.next_column -= self.blanks;
            self.end.column = Some(self.next_column);
        } else {
            self.write_blanks();
        }
    }

    /// Returns the style in which the run is written after the style `present`.
    fn pen_after(&self, present: Pen) -> Pen {
        if self.is_blank {
            present.for_blank(self.pen.ground)
        } else {
            self.pen
        }
    }
}

impl<W: Write> Write for CellWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Write::write(&mut self.inner, bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Write::flush(&mut self.inner)
    }
}

impl<W: Write> Backend for CellWriter<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let mut runs: Vec<Run> = Vec::new();
        let mut last_column = 0;
        for (x, y, cell) in content {
            let place = Position { x, y };
            last_column = last_column.max(x);
            self.shown.set(place, cell);
            let last = runs.last_mut();
            let is_taken = last.is_some_and(|run| run.takes(place, cell, &self.shown));
            if !is_taken {
                runs.push(Run::new(place, cell));
            }
        }
        runs.iter_mut().for_each(Run::finish);
        // A colour takes more bytes than a movement of the cursor, so the runs of one style are
        // next to each other.
        runs.sort_by_cached_key(|run| run.pen.order());
        let text = self.text_of(runs, last_column);
        queue!(self.inner, Print(text))
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.inner.hide_cursor()
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.inner.show_cursor()
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        self.inner.get_cursor_position()
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.inner.set_cursor_position(position)
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        if clear_type == ClearType::All {
            self.shown.clear();
            // It is written with the next frame, so that no empty screen is shown before.
            return queue!(self.inner, Clear(crossterm::terminal::ClearType::All));
        }
        self.shown = ShownCells::default();
        self.inner.clear_region(clear_type)
    }

    fn size(&self) -> io::Result<Size> {
        self.inner.size()
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        self.inner.window_size()
    }

    fn flush(&mut self) -> io::Result<()> {
        Backend::flush(&mut self.inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::pen::remove_ink_of_blanks;
    use proptest::prelude::*;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::{Modifier, Style};

    const COLUMNS: u16 = 24;
    const ROWS: u16 = 4;

    fn colour() -> impl Strategy<Value = Color> {
        prop_oneof![
            Just(Color::Reset),
            Just(Color::LightBlue),
            Just(Color::Indexed(236)),
            Just(Color::Rgb(245, 166, 60)),
        ]
    }

    fn modifier() -> impl Strategy<Value = Modifier> {
        prop_oneof![
            4 => Just(Modifier::empty()),
            1 => Just(Modifier::BOLD),
            1 => Just(Modifier::DIM),
            1 => Just(Modifier::REVERSED),
            1 => Just(Modifier::UNDERLINED | Modifier::BOLD),
        ]
    }

    /// Texts of a frame, each with its place and its style.
    fn frame() -> impl Strategy<Value = Buffer> {
        let text = prop::sample::select(vec!["  ", "F ", "⣿⠁", "µN", "漢", "│ █", "      "]);
        let place = (0..COLUMNS - 6, 0..ROWS);
        let written = (place, text, colour(), colour(), modifier());
        prop::collection::vec(written, 0..30).prop_map(|texts| {
            let mut buffer = Buffer::empty(Rect::new(0, 0, COLUMNS, ROWS));
            for ((x, y), text, ink, ground, modifier) in texts {
                let style = Style::reset().fg(ink).bg(ground).add_modifier(modifier);
                buffer.set_string(x, y, text, style);
            }
            buffer
        })
    }

    /// Draws frames one after the other. Before a frame of `cleared`, the screen is cleared.
    fn draw(mut backend: impl Backend<Error = io::Error>, frames: &[Buffer], cleared: &[bool]) {
        let Some(first) = frames.first() else {
            return;
        };
        let mut shown = Buffer::empty(first.area);
        for (frame, is_cleared) in frames.iter().zip(cleared) {
            if *is_cleared {
                backend.clear_region(ClearType::All).unwrap();
                shown.reset();
            }
            let changed = shown.diff(frame);
            backend.draw(changed.into_iter()).unwrap();
            shown = frame.clone();
        }
    }

    /// Bytes that a terminal receives if the system adds a carriage return to each line feed.
    fn with_carriage_returns(bytes: &[u8]) -> Vec<u8> {
        let mut all = Vec::new();
        for &byte in bytes {
            if byte == b'\n' {
                all.push(b'\r');
            }
            all.push(byte);
        }
        all
    }

    /// Cells of a terminal after these bytes: text, colours and modifiers as far as they are
    /// visible.
    fn cells(bytes: &[u8]) -> Vec<String> {
        let rows = std::num::NonZeroU16::new(ROWS).unwrap();
        let columns = std::num::NonZeroU16::new(COLUMNS).unwrap();
        let mut parser = vt100::Parser::new(rows, columns, 0);
        parser.process(bytes);
        let mut cells = Vec::new();
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let cell = parser.screen().cell(row, column).unwrap();
                let text = cell.contents();
                let is_blank = text.trim().is_empty() && !cell.inverse() && !cell.underline();
                let ink = if is_blank {
                    String::new()
                } else {
                    format!("{:?} {} {}", cell.fgcolor(), cell.bold(), cell.dim())
                };
                cells.push(format!(
                    "{:?} {ink} {:?} {} {}",
                    text.trim(),
                    cell.bgcolor(),
                    cell.inverse(),
                    cell.underline()
                ));
            }
        }
        cells
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// After all frames, the screen is the last frame drawn anew by the backend of ratatui. It
        /// is also this frame in a terminal where a line feed loses the column, and the frames take
        /// no more bytes than with the backend of ratatui.
        #[test]
        fn the_screen_is_that_of_the_usual_backend(
            frames in prop::collection::vec(frame(), 1..5),
            cleared in prop::collection::vec(prop::bool::weighted(0.2), 4),
        ) {
            let (mut anew, mut usual, mut usual_of_bare) = (Vec::new(), Vec::new(), Vec::new());
            let (mut short, mut without) = (Vec::new(), Vec::new());
            let last = frames.len() - 1;
            draw(CrosstermBackend::new(&mut anew), &frames[last..], &[false]);
            draw(CrosstermBackend::new(&mut usual), &frames, &cleared);
            let mut bare = frames;
            bare.iter_mut().for_each(remove_ink_of_blanks);
            draw(CrosstermBackend::new(&mut usual_of_bare), &bare, &cleared);
            // Half of a character of two columns may be left over, also by the usual backend.
            prop_assume!(cells(&usual_of_bare) == cells(&anew));
            draw(CellWriter::new(&mut short, LineFeeds::KeepColumn), &bare, &cleared);
            draw(CellWriter::new(&mut without, LineFeeds::Unknown), &bare, &cleared);
            prop_assert_eq!(cells(&anew), cells(&short));
            prop_assert_eq!(cells(&anew), cells(&with_carriage_returns(&without)));
            prop_assert!(short.len() <= usual.len());
        }
    }

    #[test]
    fn only_colours_that_change_are_sent_and_each_once() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 9, 1));
        let ground = Color::Rgb(1, 2, 3);
        buffer.set_string(1, 0, "a", Style::new().fg(Color::Rgb(7, 8, 9)).bg(ground));
        buffer.set_string(2, 0, " ", Style::new().bg(ground));
        buffer.set_string(3, 0, "b", Style::new().fg(Color::Indexed(4)).bg(ground));
        buffer.set_string(6, 0, "c", Style::new().fg(Color::Indexed(4)));
        assert_eq!(
            text_of(&[buffer]),
            "\x1b[2J\x1b[38;5;4m\x1b[1;7Hc\x1b[48;2;1;2;3m\x1b[1;4Hb\x1b[38;2;7;8;9m\u{8}\u{8}\u{8}a \x1b[m"
        );
    }

    /// Text with which a writer draws the last of some frames.
    fn text_of(frames: &[Buffer]) -> String {
        let bytes_of = |frames: &[Buffer]| {
            let mut bytes = Vec::new();
            let writer = CellWriter::new(&mut bytes, LineFeeds::KeepColumn);
            draw(writer, frames, &[true, false]);
            bytes
        };
        let before = bytes_of(&frames[..frames.len() - 1]).len();
        String::from_utf8(bytes_of(frames).split_off(before)).unwrap()
    }

    /// Frame of plain rows.
    fn plain(rows: [&str; 3]) -> Buffer {
        Buffer::with_lines(rows)
    }

    #[test]
    fn the_cursor_moves_by_the_shortest_text() {
        let before = plain(["a b c ⣿ d e", "f g h", "    xyz"]);
        for (after, text) in [
            // Many blanks are erased, and the cursor stays before them.
            (
                plain(["a          ", "f g h", "     yz"]),
                "\x1b[1;3H\x1b[9X\n\n   ",
            ),
            // A narrow gap is written again.
            (plain(["A B c ⣿ d e", "f g h", "    xyz"]), "\x1b[1;1HA B"),
            // The cursor after the last column that changes is unknown.
            (
                plain(["a b c ⣿ D e", "f g H", "    xyz"]),
                "\x1b[1;9HD\x1b[2;5HH",
            ),
            // A line feed and backspaces.
            (
                plain(["a b C ⣿ d e", "f g H", "    xYz"]),
                "\x1b[1;5HC\n\u{8}H\nY",
            ),
            (
                plain(["a b c ⣿ d E", "F g h", "    xyz"]),
                "\x1b[2;1HF\x1b[1;11HE",
            ),
            // The width of a circle differs between terminals, so the next column is stated.
            (
                plain(["● b C ⣿ d e", "f g h", "    xyz"]),
                "\x1b[1;1H●\x1b[5GC",
            ),
        ] {
            assert_eq!(text_of(&[before.clone(), after]), text);
        }
    }
}
