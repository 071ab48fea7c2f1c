//! The cursor of the terminal, and the shortest text that moves it to another cell. Over a slow
//! line, the movements between short texts take more bytes than colours.

use super::pen::Pen;
use ratatui::buffer::Cell;
use ratatui::layout::Position;
use std::fmt::Write;

/// Place of the cursor, as far as it is known.
#[derive(Clone, Copy)]
pub struct Cursor {
    pub row: u16,
    /// `None` after a character whose width differs between terminals.
    pub column: Option<u16>,
}

/// Cells that the terminal shows. Before the screen is first cleared, the cells that have not been
/// written are unknown. A cell is also unknown if the character before it may be wider than a
/// column.
#[derive(Default)]
pub struct ShownCells {
    rows: Vec<Vec<Option<Cell>>>,
    is_cleared: bool,
}

impl ShownCells {
    pub fn clear(&mut self) {
        self.rows.clear();
        self.is_cleared = true;
    }

    /// Stores a written cell.
    pub fn set(&mut self, place: Position, cell: &Cell) {
        let (x, y) = (usize::from(place.x), usize::from(place.y));
        if self.rows.len() <= y {
            self.rows.resize(y + 1, Vec::new());
        }
        let row = &mut self.rows[y];
        if row.len() < x + 2 {
            let blank = self.is_cleared.then_some(Cell::EMPTY);
            row.resize(x + 2, blank);
        }
        let before = row[x].replace(cell.clone());
        let is_next_known = match before {
            Some(before) => is_narrow(before.symbol()) && is_narrow(cell.symbol()),
            None => is_narrow(cell.symbol()),
        };
        if !is_next_known {
            row[x + 1] = None;
        }
    }

    /// Returns the cell at a place; `None` if it is unknown.
    pub fn get(&self, x: u16, y: u16) -> Option<&Cell> {
        let row = self.rows.get(usize::from(y));
        match row.and_then(|row| row.get(usize::from(x))) {
            Some(cell) => cell.as_ref(),
            None => self.is_cleared.then_some(&Cell::EMPTY),
        }
    }

    /// Returns the number of bytes of the cells from column `first` to column `end` of a row, if
    /// all of them are one column wide, have the style `pen` and take fewer than `most` bytes.
    pub fn bytes(&self, first: u16, end: u16, row: u16, pen: Pen, most: usize) -> Option<usize> {
        let mut bytes = 0;
        for x in first..end {
            let cell = self.get(x, row)?;
            bytes += cell.symbol().len();
            if bytes >= most || !is_narrow(cell.symbol()) || Pen::of(cell, pen) != pen {
                return None;
            }
        }
        Some(bytes)
    }
}

/// Returns true for a character that has the width of one column everywhere.
pub fn is_narrow(symbol: &str) -> bool {
    let mut characters = symbol.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => is_narrow_character(character),
        _ => false,
    }
}

/// ASCII, the letters and signs of units and quantities, and the characters of plots and frames:
/// box drawing, blocks and braille.
fn is_narrow_character(character: char) -> bool {
    matches!(
        character,
        ' '..='~'
            | '\u{a1}'..='\u{ac}'
            | '\u{ae}'..='\u{ff}'
            | '\u{391}'..='\u{3c9}'
            | '\u{2500}'..='\u{259f}'
            | '\u{2800}'..='\u{28ff}'
    )
}

/// Part of a movement of the cursor.
#[derive(Clone, Copy)]
enum Step {
    /// Control sequence with one number. The number 1 is left out.
    Sequence(u16, char),
    /// Control character, written several times.
    Characters(u16, char),
    /// Cells of the row of the target that are written again, from this column on.
    Cells { first: u16, bytes: usize },
    /// Control sequence with row and column, counted from 1.
    Place(u16, u16),
}

impl Step {
    /// Number of bytes.
    fn length(self) -> usize {
        match self {
            Step::Sequence(1, _) => 3,
            Step::Sequence(number, _) => 3 + digits(number),
            Step::Characters(count, _) => count.into(),
            Step::Cells { bytes, .. } => bytes,
            Step::Place(row, column) => 4 + digits(row) + digits(column),
        }
    }
}

fn digits(number: u16) -> usize {
    number.checked_ilog10().unwrap_or(0) as usize + 1
}

fn shorter(first: Step, second: Step) -> Step {
    if second.length() < first.length() {
        second
    } else {
        first
    }
}

/// Movement of the cursor to a cell: first between the rows, then within the row.
#[derive(Clone, Copy, Default)]
pub struct Movement {
    steps: [Option<Step>; 2],
    target: Position,
}

impl Movement {
    /// Returns the shortest movement of the cursor from `present` to `target`. `present` is `None`
    /// if the place of the cursor is unknown. Cells between both places may be written again, in
    /// the style `pen`, which shows the same cells.
    pub fn shortest(
        present: Option<Cursor>,
        target: Position,
        pen: Pen,
        shown: &ShownCells,
        line_feeds: LineFeeds,
    ) -> Movement {
        let place = Step::Place(target.y + 1, target.x + 1);
        let absolute = Movement {
            steps: [Some(place), None],
            target,
        };
        let Some(present) = present else {
            return absolute;
        };
        let relative = Movement {
            steps: [
                between_rows(present.row, target.y, line_feeds),
                within_row(present.column, target, pen, shown),
            ],
            target,
        };
        if relative.length() < absolute.length() {
            relative
        } else {
            absolute
        }
    }

    /// Number of bytes.
    pub fn length(&self) -> usize {
        self.steps.iter().flatten().map(|step| step.length()).sum()
    }

    /// Appends the movement to the text that the terminal receives.
    pub fn append_to(&self, text: &mut String, shown: &ShownCells) {
        for step in self.steps.into_iter().flatten() {
            // Writing to a string cannot fail.
            let _ = match step {
                Step::Sequence(1, letter) => write!(text, "\x1b[{letter}"),
                Step::Sequence(number, letter) => write!(text, "\x1b[{number}{letter}"),
                Step::Place(row, column) => write!(text, "\x1b[{row};{column}H"),
                Step::Characters(count, character) => {
                    text.extend(std::iter::repeat_n(character, count.into()));
                    Ok(())
                }
                Step::Cells { first, .. } => {
                    for x in first..self.target.x {
                        text.push_str(shown.get(x, self.target.y).map_or(" ", Cell::symbol));
                    }
                    Ok(())
                }
            };
        }
    }
}

/// What a line feed does to the column of the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineFeeds {
    KeepColumn,
    /// The system adds a carriage return to each line feed, or this is unknown.
    Unknown,
}

fn between_rows(present: u16, target: u16, line_feeds: LineFeeds) -> Option<Step> {
    let count = target.abs_diff(present);
    if count == 0 {
        return None;
    }
    if target < present {
        return Some(Step::Sequence(count, 'A'));
    }
    let down = Step::Sequence(count, 'B');
    // The rows above the target exist, so no line feed scrolls the screen.
    Some(match line_feeds {
        LineFeeds::KeepColumn => shorter(down, Step::Characters(count, '\n')),
        LineFeeds::Unknown => down,
    })
}

fn within_row(
    present: Option<u16>,
    target: Position,
    pen: Pen,
    shown: &ShownCells,
) -> Option<Step> {
    if target.x == 0 {
        let is_there = present == Some(0);
        return (!is_there).then_some(Step::Characters(1, '\r'));
    }
    let column = Step::Sequence(target.x + 1, 'G');
    let Some(present) = present else {
        return Some(column);
    };
    let count = target.x.abs_diff(present);
    if count == 0 {
        return None;
    }
    if target.x < present {
        let left = shorter(Step::Characters(count, '\u{8}'), Step::Sequence(count, 'D'));
        return Some(shorter(left, column));
    }
    let right = shorter(Step::Sequence(count, 'C'), column);
    match shown.bytes(present, target.x, target.y, pen, right.length()) {
        Some(bytes) => Some(Step::Cells {
            first: present,
            bytes,
        }),
        None => Some(right),
    }
}
