//! A screen as parts of a picture, for every format.
//!
//! Only letters need a font. Dots, blocks, lines and marks are drawn, so that they meet from cell to
//! cell with any font, and text is stretched to the grid of cells.

use super::letters::Letters;
use super::outline::{Area, Dots, HEIGHT, Lines, WIDTH};
use super::palette::{mixed, rgb};
use super::raster::{Raster, blocks, dots, shade};
use super::strokes::{Weight, strokes};
use super::{Glyph, glyphs};
use crate::draw::{Palette, Rgb};
use ratatui::buffer::Buffer;
use ratatui::style::Modifier;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Room around the screen, px.
pub const MARGIN: u32 = 8;
/// Height of a line under letters, in its cell.
const UNDER: i32 = 14;
/// Remaining share of a dimmed colour, percent.
const DIMMED: u8 = 60;

/// Width and height of the picture of a screen, px.
pub fn size(buffer: &Buffer) -> (u32, u32) {
    let (columns, rows) = (u32::from(buffer.area.width), u32::from(buffer.area.height));
    (columns * WIDTH + 2 * MARGIN, rows * HEIGHT + 2 * MARGIN)
}

/// Pen for lines of one kind.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pen {
    /// For whole lines, whose ends meet in corners.
    Whole(Weight),
    /// For dashes, whose ends must not.
    Dashed(Weight),
    /// For lines under and through letters.
    Rule,
    /// For dots.
    Dot,
}

impl Pen {
    /// Width, px.
    pub fn width(self) -> f32 {
        match self {
            Pen::Whole(Weight::Light) | Pen::Dashed(Weight::Light) => 1.2,
            Pen::Whole(Weight::Heavy) | Pen::Dashed(Weight::Heavy) => 2.6,
            Pen::Dot => 2.8,
            _ => 1.0,
        }
    }
}

/// A part of the picture: data of a path of SVG from the upper left corner of the screen, its colour, and the pen that
/// draws the path; without one the path is filled.
pub struct Part {
    pub path: String,
    pub colour: Rgb,
    pub pen: Option<Pen>,
}

/// All shapes and letters on the screen, by pen and colour.
pub struct Sheet<'a> {
    palette: &'a Palette,
    grounds: BTreeMap<Rgb, Area>,
    blocks: BTreeMap<Rgb, Area>,
    marks: BTreeMap<Rgb, String>,
    lines: BTreeMap<(Pen, Rgb), Lines>,
    dots: BTreeMap<Rgb, Dots>,
    letters: Letters,
}

impl<'a> Sheet<'a> {
    /// The sheet of a screen in the colours of a palette.
    pub fn new(buffer: &Buffer, palette: &'a Palette) -> Self {
        let mut sheet = Sheet {
            palette,
            grounds: BTreeMap::new(),
            blocks: BTreeMap::new(),
            marks: BTreeMap::new(),
            lines: BTreeMap::new(),
            dots: BTreeMap::new(),
            letters: Letters::default(),
        };
        glyphs(buffer).for_each(|glyph| sheet.draw(&glyph));
        sheet
    }

    /// Parts in the order in which they are drawn, and the letters above them.
    pub fn parts(self) -> (Vec<Part>, Letters) {
        let filled = |(colour, path)| Part { path, colour, pen: None };
        let areas = self.grounds.into_iter().chain(self.blocks).map(|(colour, area)| (colour, area.path()));
        let lines = self.lines.into_iter().map(|((pen, colour), lines)| (lines.path(), colour, pen));
        let dots = self.dots.into_iter().map(|(colour, dots)| (dots.path(), colour, Pen::Dot));
        let drawn = |(path, colour, pen)| Part { path, colour, pen: Some(pen) };
        let parts =
            areas.map(filled).chain(lines.chain(dots).map(drawn)).chain(self.marks.into_iter().map(filled));
        (parts.filter(|part| !part.path.is_empty()).collect(), self.letters)
    }

    fn draw(&mut self, glyph: &Glyph<'_>) {
        let Glyph { column, row, width, cell } = *glyph;
        let (ink, ground) = self.colours(glyph);
        if ground != self.palette.background {
            let grounds = self.grounds.entry(ground).or_default();
            (column..column + width).for_each(|column| grounds.fill(column, row, Raster::FULL));
        }
        if cell.modifier.contains(Modifier::UNDERLINED) {
            let colour = rgb(self.palette, cell.underline_color, ink);
            self.lines.entry((Pen::Rule, colour)).or_default().across(column, row, width, UNDER);
        }
        if cell.modifier.contains(Modifier::CROSSED_OUT) {
            self.lines.entry((Pen::Rule, ink)).or_default().across(column, row, width, HEIGHT as i32 / 2);
        }
        if glyph.symbol().trim().is_empty() || cell.modifier.contains(Modifier::HIDDEN) {
            return self.letters.leave_blank(width);
        }
        let shape = glyph.character().filter(|_| width == 1);
        if !shape.is_some_and(|character| self.draw_shape(glyph, character, ink, ground)) {
            return self.letters.set(glyph, ink);
        }
        self.letters.end();
    }

    /// Colours of a symbol and of its background.
    fn colours(&self, glyph: &Glyph<'_>) -> (Rgb, Rgb) {
        let (cell, modifier) = (glyph.cell, glyph.cell.modifier);
        let mut ink = rgb(self.palette, cell.fg, self.palette.foreground);
        let mut ground = rgb(self.palette, cell.bg, self.palette.background);
        if modifier.contains(Modifier::DIM) {
            ink = mixed(ink, ground, DIMMED);
        }
        if modifier.contains(Modifier::REVERSED) {
            std::mem::swap(&mut ink, &mut ground);
        }
        (ink, ground)
    }

    /// Draws a character other than a letter; `false` for a letter.
    fn draw_shape(&mut self, glyph: &Glyph<'_>, character: char, ink: Rgb, ground: Rgb) -> bool {
        let (column, row) = (glyph.column, glyph.row);
        if let Some(dots) = dots(character) {
            self.dots.entry(ink).or_default().add(column, row, dots);
        } else if let Some(raster) = blocks(character) {
            self.blocks.entry(ink).or_default().fill(column, row, raster);
        } else if let Some(quarters) = shade(character) {
            let colour = mixed(ink, ground, 25 * quarters);
            self.blocks.entry(colour).or_default().fill(column, row, Raster::FULL);
        } else if let Some(strokes) = strokes(character) {
            for weight in [Weight::Light, Weight::Heavy, Weight::Double] {
                if strokes.arms.contains(&Some(weight)) {
                    let pen = if strokes.pieces > 1 { Pen::Dashed } else { Pen::Whole };
                    let lines = self.lines.entry((pen(weight), ink)).or_default();
                    lines.add(column, row, &strokes, weight);
                }
            }
        } else if let Some(mark) = mark(character) {
            let (x, y) = (u32::from(column) * WIDTH, u32::from(row) * HEIGHT);
            let _ = write!(self.marks.entry(ink).or_default(), "M{x} {y}{mark}");
        } else {
            return false;
        }
        true
    }
}

/// The outline of a mark, from the upper left corner of its cell.
fn mark(character: char) -> Option<&'static str> {
    Some(match character {
        '▲' => "m4 4.4l3.6 7.2h-7.2z",
        '▼' => "m4 11.6l3.6-7.2h-7.2z",
        '◆' => "m4 3.8l3.8 4.2-3.8 4.2-3.8-4.2z",
        '■' => "m.5 4.5h7v7h-7z",
        '▪' => "m2 6h4v4h-4z",
        '▸' => "m1.8 4.5l5 3.5-5 3.5z",
        '•' => "m1.8 8a2.2 2.2 0 1 0 4.4 0a2.2 2.2 0 1 0-4.4 0z",
        '●' => "m.5 8a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0z",
        // The inner circle has the opposite direction and so is left out.
        '○' => "m.5 8a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0zm1.2 0a2.3 2.3 0 1 1 4.6 0a2.3 2.3 0 1 1-4.6 0z",
        _ => return None,
    })
}
