//! Writes the changed cells of a frame to a terminal in few bytes. Over a slow line, the bytes of a
//! frame determine how long the answer to a key takes.
//!
//! The backend of ratatui sends both colours of a cell whenever one of them differs from the cell
//! before. A colour of 24 bits takes up to 19 bytes, which is more than the text of most cells.

use crossterm::cursor::MoveTo;
use crossterm::style::{Color as TerminalColor, Colored};
use crossterm::{Command, queue};
use ratatui::backend::{Backend, ClearType, CrosstermBackend, IntoCrossterm, WindowSize};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Size};
use ratatui::style::{Color, Modifier};
use std::io;
use std::io::Write;

/// Modifiers by which a blank cell looks different.
const VISIBLE_ON_BLANKS: Modifier = Modifier::REVERSED
    .union(Modifier::UNDERLINED)
    .union(Modifier::CROSSED_OUT);

/// Backend that writes cells in few bytes. In all else it is the backend of ratatui for crossterm.
pub struct CellWriter<W: Write> {
    inner: CrosstermBackend<W>,
}

impl<W: Write> CellWriter<W> {
    pub fn new(out: W) -> Self {
        CellWriter {
            inner: CrosstermBackend::new(out),
        }
    }
}

/// Style of the text that the terminal writes next.
#[derive(Clone, Copy, PartialEq)]
struct Pen {
    ink: Color,
    ground: Color,
    modifier: Modifier,
}

impl Pen {
    /// Style of a terminal after a reset.
    const PLAIN: Pen = Pen {
        ink: Color::Reset,
        ground: Color::Reset,
        modifier: Modifier::empty(),
    };

    /// Returns the style in which a cell is written after the style `present`. A blank cell shows
    /// only its ground, so the rest of the style stays as it is.
    fn of(cell: &Cell, present: Pen) -> Pen {
        if shows_ink(cell) {
            return Pen {
                ink: cell.fg,
                ground: cell.bg,
                modifier: cell.modifier,
            };
        }
        let kept = if present.modifier.intersects(VISIBLE_ON_BLANKS) {
            Pen::PLAIN
        } else {
            present
        };
        Pen {
            ground: cell.bg,
            ..kept
        }
    }

    /// Returns the control sequence that changes this style to `next`; empty if they are equal.
    fn change_to(self, next: Pen) -> String {
        if next == self {
            return String::new();
        }
        let by_difference = self.difference(next);
        let from_plain = Pen::PLAIN.difference(next);
        let by_reset = if from_plain.is_empty() {
            String::new()
        } else {
            format!("0;{from_plain}")
        };
        let shorter = if by_reset.len() < by_difference.len() {
            by_reset
        } else {
            by_difference
        };
        format!("\x1b[{shorter}m")
    }

    /// Returns the parameters that change this style to `next` without a reset.
    fn difference(self, next: Pen) -> String {
        let mut parameters = Vec::new();
        let (mut ended, mut begun) = (self.modifier - next.modifier, next.modifier - self.modifier);
        if ended.intersects(Modifier::BOLD | Modifier::DIM) {
            // The parameter that ends bold text also ends dim text, and the other way round.
            parameters.push("22".to_owned());
            ended -= Modifier::BOLD | Modifier::DIM;
            begun |= next.modifier & (Modifier::BOLD | Modifier::DIM);
        }
        for (modifier, on, off) in MODIFIERS {
            if ended.contains(modifier) {
                parameters.push(off.to_owned());
            }
            if begun.contains(modifier) {
                parameters.push(on.to_owned());
            }
        }
        if next.ink != self.ink {
            let ink: TerminalColor = next.ink.into_crossterm();
            parameters.push(Colored::ForegroundColor(ink).to_string());
        }
        if next.ground != self.ground {
            let ground: TerminalColor = next.ground.into_crossterm();
            parameters.push(Colored::BackgroundColor(ground).to_string());
        }
        parameters.join(";")
    }

    /// Returns a text by which runs are ordered so that equal styles come together, and among them
    /// equal grounds.
    fn order(self) -> String {
        format!("{:?} {:?} {:?}", self.ground, self.modifier, self.ink)
    }
}

/// Parameters that switch modifiers on and off.
const MODIFIERS: [(Modifier, &str, &str); 9] = [
    (Modifier::BOLD, "1", "22"),
    (Modifier::DIM, "2", "22"),
    (Modifier::ITALIC, "3", "23"),
    (Modifier::UNDERLINED, "4", "24"),
    (Modifier::SLOW_BLINK, "5", "25"),
    (Modifier::RAPID_BLINK, "6", "25"),
    (Modifier::REVERSED, "7", "27"),
    (Modifier::HIDDEN, "8", "28"),
    (Modifier::CROSSED_OUT, "9", "29"),
];

fn shows_ink(cell: &Cell) -> bool {
    cell.symbol() != " " || cell.modifier.intersects(VISIBLE_ON_BLANKS)
}

/// Removes the ink of blank cells. Otherwise a cell would be written again because its ink has
/// changed, although it looks the same.
pub fn remove_ink_of_blanks(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if !shows_ink(cell) {
            cell.fg = Color::Reset;
            cell.modifier = Modifier::empty();
        }
    }
}

/// Cells side by side in one style.
struct Run {
    start: Position,
    text: String,
    pen: Pen,
    /// True while the run has only blanks, so that it can take any ink.
    is_blank: bool,
    /// Place of the cursor after the run; `None` if it is unknown.
    end: Option<Position>,
}

impl Run {
    fn new(start: Position, cell: &Cell) -> Run {
        let mut run = Run {
            start,
            text: String::new(),
            pen: Pen::of(cell, Pen::PLAIN),
            is_blank: !shows_ink(cell),
            end: Some(start),
        };
        run.push(start, cell);
        run
    }

    /// Returns true if the cell at `place` continues the run, and then appends it.
    fn takes(&mut self, place: Position, cell: &Cell) -> bool {
        if self.end != Some(place) {
            return false;
        }
        let pen = Pen::of(cell, self.pen);
        if self.is_blank && shows_ink(cell) && pen.ground == self.pen.ground {
            let shows_blanks = pen.modifier.intersects(VISIBLE_ON_BLANKS);
            if !shows_blanks {
                self.pen = pen;
                self.is_blank = false;
            }
        }
        let fits = pen == self.pen;
        if fits {
            self.push(place, cell);
        }
        fits
    }

    fn push(&mut self, Position { x, y }: Position, cell: &Cell) {
        let symbol = cell.symbol();
        self.text.push_str(symbol);
        // Terminals differ in the width of unusual characters, so the place of the cursor after
        // them is unknown.
        let is_narrow = symbol.is_ascii() || is_drawing(symbol);
        self.end = is_narrow.then_some(Position { x: x + 1, y });
    }
}

/// Returns true for the characters of plots and frames, which have the width of one column
/// everywhere: box drawing, blocks and braille.
fn is_drawing(symbol: &str) -> bool {
    let mut characters = symbol.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => {
            matches!(character, '\u{2500}'..='\u{259f}' | '\u{2800}'..='\u{28ff}')
        }
        _ => false,
    }
}

/// Returns the control sequence that moves the cursor from `present` to `next`. `present` is `None`
/// if the place of the cursor is unknown.
fn movement(present: Option<Position>, next: Position) -> String {
    let mut absolute = String::new();
    let _ = MoveTo(next.x, next.y).write_ansi(&mut absolute);
    let Some(present) = present else {
        return absolute;
    };
    let relative = format!(
        "{}{}",
        steps(present.y, next.y, ['A', 'B']),
        steps(present.x, next.x, ['D', 'C'])
    );
    if relative.len() < absolute.len() {
        relative
    } else {
        absolute
    }
}

/// Returns the control sequence that moves the cursor by some steps. The letters are those for
/// steps to lower and to higher numbers.
fn steps(from: u16, to: u16, [lower, higher]: [char; 2]) -> String {
    let letter = if to < from { lower } else { higher };
    match from.abs_diff(to) {
        0 => String::new(),
        1 => format!("\x1b[{letter}"),
        count => format!("\x1b[{count}{letter}"),
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
            let is_taken = runs.last_mut().is_some_and(|run| run.takes(place, cell));
            if !is_taken {
                runs.push(Run::new(place, cell));
            }
        }
        // A colour takes more bytes than a movement of the cursor, so the runs of one style are
        // written one after the other.
        runs.sort_by_cached_key(|run| run.pen.order());
        let mut text = String::new();
        let mut pen = Pen::PLAIN;
        let mut cursor = None;
        for run in runs {
            text.push_str(&movement(cursor, run.start));
            text.push_str(&pen.change_to(run.pen));
            text.push_str(&run.text);
            pen = run.pen;
            // After the last column, terminals differ in the place of the cursor.
            cursor = run.end.filter(|end| end.x <= last_column);
        }
        if pen != Pen::PLAIN {
            text.push_str("\x1b[m");
        }
        queue!(self.inner, crossterm::style::Print(text))
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
        self.inner.clear()
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
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
    use proptest::prelude::*;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

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

    /// Draws two frames one after the other.
    fn draw(mut backend: impl Backend, frames: &[&Buffer; 2]) {
        let mut shown = Buffer::empty(frames[0].area);
        for frame in frames {
            let changed = shown.diff(frame);
            let drawn = backend.draw(changed.into_iter());
            assert!(drawn.is_ok());
            shown = (*frame).clone();
        }
    }

    /// Cells of a terminal after these bytes: text, colours and modifiers as far as they are visible.
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

        /// The screen is the one that the backend of ratatui draws, with no more bytes.
        #[test]
        fn the_screen_is_that_of_the_usual_backend(first in frame(), second in frame()) {
            let (mut usual, mut short) = (Vec::new(), Vec::new());
            draw(CrosstermBackend::new(&mut usual), &[&first, &second]);
            let (mut bare_first, mut bare_second) = (first, second);
            remove_ink_of_blanks(&mut bare_first);
            remove_ink_of_blanks(&mut bare_second);
            draw(CellWriter::new(&mut short), &[&bare_first, &bare_second]);
            prop_assert_eq!(cells(&usual), cells(&short));
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
        let empty = Buffer::empty(buffer.area);
        let mut bytes = Vec::new();
        CellWriter::new(&mut bytes)
            .draw(empty.diff(&buffer).into_iter())
            .unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(
            text,
            "\x1b[1;7H\x1b[38;5;4mc\x1b[1;4H\x1b[48;2;1;2;3mb\x1b[3D\x1b[38;2;7;8;9ma \x1b[m"
        );
    }
}
