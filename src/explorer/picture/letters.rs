//! The letters of a picture, set in runs that keep to the grid of cells.

use super::Glyph;
use super::outline::{HEIGHT, WIDTH};
use crate::draw::{Rgb, escaped, hex};
use ratatui::style::Modifier;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Height of the base line of letters in a cell, px.
pub const BASE: u32 = 12;
/// Monospaced fonts of the common systems.
pub const FONTS: &str =
    "ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono','Liberation Mono',monospace";
/// Letters of these fonts are about 0.6 times as wide.
pub const FONT_SIZE: f64 = 13.3;

/// Typefaces.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Face {
    pub colour: Rgb,
    pub bold: bool,
    pub italic: bool,
}

/// Letters on one row, set as one element.
pub struct Run {
    pub column: u16,
    pub row: u16,
    face: Face,
    pub text: String,
    pub columns: u16,
    /// Cells since its last letter.
    blanks: u16,
    /// True if letters may follow.
    open: bool,
}

/// All letters, by their look.
#[derive(Default)]
pub struct Letters {
    runs: BTreeMap<Face, Vec<Run>>,
    run: Option<Run>,
}

impl Letters {
    /// Sets a glyph, behind others of the same look if there is no gap.
    pub fn set(&mut self, glyph: &Glyph<'_>, colour: Rgb) {
        let modifier = glyph.cell.modifier;
        let face = Face {
            colour,
            bold: modifier.contains(Modifier::BOLD),
            italic: modifier.contains(Modifier::ITALIC),
        };
        let symbol = glyph.symbol();
        // Other symbols come from a font of another width.
        let open = glyph.width == 1 && symbol.chars().all(is_common);
        let row = glyph.row;
        if let Some(run) =
            self.run.as_mut().filter(|run| open && run.open && (run.row, run.face) == (row, face))
        {
            if run.blanks == 1 {
                run.text.push(' ');
            }
            run.text.push_str(symbol);
            run.columns += run.blanks + 1;
            run.blanks = 0;
            return;
        }
        self.end();
        let (text, columns) = (symbol.to_owned(), glyph.width);
        self.run = Some(Run { column: glyph.column, row, face, text, columns, blanks: 0, open });
    }

    /// Leaves so many cells without letters.
    pub fn leave_blank(&mut self, width: u16) {
        if let Some(run) = &mut self.run {
            run.blanks += width;
            // Gaps are cheaper left out, and each run begins anew on the grid.
            if run.blanks > 1 {
                self.end();
            }
        }
    }

    /// Ends the run: the next glyph begins another.
    pub fn end(&mut self) {
        if let Some(run) = self.run.take() {
            self.runs.entry(run.face).or_default().push(run);
        }
    }

    /// The runs, by their look.
    pub fn runs(mut self) -> BTreeMap<Face, Vec<Run>> {
        self.end();
        self.runs
    }

    /// The SVG elements of the runs.
    pub fn elements(self) -> String {
        let mut elements =
            format!("<g font-family=\"{FONTS}\" font-size=\"{FONT_SIZE}\" xml:space=\"preserve\">\n");
        for (face, runs) in self.runs() {
            let bold = if face.bold { " font-weight=\"bold\"" } else { "" };
            let italic = if face.italic { " font-style=\"italic\"" } else { "" };
            // Writing to a string does not fail.
            let _ = writeln!(elements, "<g fill=\"{}\"{bold}{italic}>", hex(face.colour));
            for run in runs {
                let (x, y) = (u32::from(run.column) * WIDTH, u32::from(run.row) * HEIGHT + BASE);
                let (length, text) = (u32::from(run.columns) * WIDTH, escaped(&run.text));
                let _ = writeln!(elements, "<text x=\"{x}\" y=\"{y}\" textLength=\"{length}\">{text}</text>");
            }
            elements.push_str("</g>\n");
        }
        elements + "</g>\n"
    }
}

/// Returns true if a character is in the common monospaced fonts.
fn is_common(character: char) -> bool {
    matches!(character, ' '..='~' | '\u{a1}'..='ſ' | 'Α'..='ω' | '–' | '—' | '‘'..='”' | '…' | '−')
}
