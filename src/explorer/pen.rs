//! The style in which a terminal writes the next text, and the shortest control sequence that
//! changes one style to another.

use crossterm::style::{Color as TerminalColor, Colored};
use ratatui::backend::IntoCrossterm;
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

/// Modifiers by which a blank cell looks different.
const VISIBLE_ON_BLANKS: Modifier = Modifier::REVERSED
    .union(Modifier::UNDERLINED)
    .union(Modifier::CROSSED_OUT);

/// Style of the text that the terminal writes next.
#[derive(Clone, Copy, PartialEq)]
pub struct Pen {
    pub ink: Color,
    pub ground: Color,
    pub modifier: Modifier,
}

impl Pen {
    /// Style of a terminal after a reset.
    pub const PLAIN: Pen = Pen {
        ink: Color::Reset,
        ground: Color::Reset,
        modifier: Modifier::empty(),
    };

    /// Returns the style in which a cell is written after the style `present`. A blank cell shows
    /// only its ground, so the rest of the style stays as it is.
    pub fn of(cell: &Cell, present: Pen) -> Pen {
        if shows_ink(cell) {
            return Pen {
                ink: cell.fg,
                ground: cell.bg,
                modifier: cell.modifier,
            };
        }
        present.for_blank(cell.bg)
    }

    /// Returns the style in which a blank cell on `ground` is written after this style.
    pub fn for_blank(self, ground: Color) -> Pen {
        let kept = if self.shows_blanks() {
            Pen::PLAIN
        } else {
            self
        };
        Pen { ground, ..kept }
    }

    /// Returns true if a blank cell looks different because of the modifiers of this style.
    pub fn shows_blanks(self) -> bool {
        self.modifier.intersects(VISIBLE_ON_BLANKS)
    }

    /// Returns the control sequence that changes this style to `next`; empty if they are equal.
    pub fn change_to(self, next: Pen) -> String {
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
    pub fn order(self) -> String {
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

/// Returns true if a cell looks different in another ink.
pub fn shows_ink(cell: &Cell) -> bool {
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
