//! Draws screens of a terminal as SVG documents, for slides and web pages.
//!
//! Each word begins at its first cell and is stretched to the width of its cells. Braille dots,
//! blocks and the lines of frames are drawn as shapes, so that the shapes of neighbouring cells
//! join in any font.

use super::{Glyph, dots, glyphs};
use crate::colour::{Rgb, hex};
use crate::palette::{ColourRole, Palette};
use crate::svg::elements::{Svg, escaped};
use ratatui::buffer::Buffer;
use ratatui::style::{Color, Modifier};
use std::collections::BTreeMap;

/// Width of a cell in px.
const WIDTH: u32 = 8;
/// Height of a cell in px.
const HEIGHT: u32 = 16;
/// Distance of the base line from the upper edge of a cell in px.
const BASE: u32 = 12;
/// Margin around the screen in px.
const MARGIN: u32 = 8;
/// Monospaced fonts of common operating systems. Their letters are about 0.6 times as wide as the
/// font size.
const FONTS: &str =
    "ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono','Liberation Mono',monospace";
const FONT_SIZE: f64 = 13.3;

/// A dimmed colour consists of this percentage of the text colour; the rest is background.
const DIMMED: u8 = 60;

/// Kind of a shape. The shapes of one kind are drawn after all shapes of the kinds before it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Ground,
    Block,
    Line,
    Dots,
}

/// Draws a screen of the terminal as an SVG document. Equal screens give documents of equal bytes.
pub fn screen_svg(buffer: &Buffer, palette: Palette, title: &str) -> String {
    let width = u32::from(buffer.area.width) * WIDTH + 2 * MARGIN;
    let height = u32::from(buffer.area.height) * HEIGHT + 2 * MARGIN;
    let mut svg = Svg::new(f64::from(width), f64::from(height), title);
    let ground = hex(palette.paper());
    svg.push(format_args!(
        "<rect width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"{ground}\"/>"
    ));
    svg.push(format_args!(
        "<g transform=\"translate({MARGIN} {MARGIN})\" font-family=\"{FONTS}\" \
         font-size=\"{FONT_SIZE}\" xml:space=\"preserve\">"
    ));
    for ((kind, colour), path) in paths(buffer, palette) {
        let colour = hex(colour);
        let looks = match kind {
            Kind::Ground | Kind::Block => {
                format!("fill=\"{colour}\" shape-rendering=\"crispEdges\"")
            }
            Kind::Line => stroke(&colour, 1.2, "square"),
            Kind::Dots => stroke(&colour, 2.8, "round"),
        };
        svg.push(format_args!("<path {looks} d=\"{path}\"/>"));
    }
    for word in words(buffer, palette) {
        let x = u32::from(word.column) * WIDTH;
        let y = u32::from(word.row) * HEIGHT + BASE;
        let length = u32::from(word.cells) * WIDTH;
        let colour = hex(word.colour);
        let weight = if word.is_bold {
            " font-weight=\"bold\""
        } else {
            ""
        };
        let letters = escaped(&word.letters);
        svg.push(format_args!(
            "<text x=\"{x}\" y=\"{y}\" textLength=\"{length}\" \
             fill=\"{colour}\"{weight}>{letters}</text>"
        ));
    }
    svg.push(format_args!("</g>"));
    svg.finish()
}

fn stroke(colour: &str, width: f64, cap: &str) -> String {
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"{cap}\"")
}

/// Returns the path data of backgrounds and of characters that are drawn as shapes. Shapes of the
/// same kind and colour share a path.
fn paths(buffer: &Buffer, palette: Palette) -> BTreeMap<(Kind, Rgb), String> {
    let mut paths = BTreeMap::<_, String>::new();
    for glyph in glyphs(buffer) {
        let colours = CellColours::of(&glyph, palette);
        if colours.ground != palette.paper() {
            let path = boxed(&glyph, u32::from(glyph.width) * WIDTH);
            *paths.entry((Kind::Ground, colours.ground)).or_default() += &path;
        }
        if let Some((kind, path)) = shape(&glyph) {
            *paths.entry((kind, colours.ink)).or_default() += &path;
        }
    }
    paths
}

/// Returns the rectangle around the left `width` px of the cells of a symbol, as path data.
fn boxed(glyph: &Glyph<'_>, width: u32) -> String {
    let x = u32::from(glyph.column) * WIDTH;
    let y = u32::from(glyph.row) * HEIGHT;
    format!("M{x} {y}h{width}v{HEIGHT}h-{width}z")
}

/// Letters in adjacent cells that have the same colour and weight.
struct Word {
    column: u16,
    row: u16,
    /// Width in cells.
    cells: u16,
    colour: Rgb,
    is_bold: bool,
    letters: String,
}

/// Returns the words on the screen. The SVG has one text element for each word, because few viewers
/// support a list of positions for the letters of one text.
fn words(buffer: &Buffer, palette: Palette) -> Vec<Word> {
    let mut words: Vec<Word> = Vec::new();
    for glyph in glyphs(buffer) {
        if glyph.symbol() == " " || shape(&glyph).is_some() {
            continue;
        }
        let next = Word {
            column: glyph.column,
            row: glyph.row,
            cells: glyph.width,
            colour: CellColours::of(&glyph, palette).ink,
            is_bold: glyph.cell.modifier.contains(Modifier::BOLD),
            letters: glyph.symbol().to_owned(),
        };
        match words.last_mut() {
            Some(word) if word.continues_with(&next) => {
                word.cells += next.cells;
                word.letters += &next.letters;
            }
            _ => words.push(next),
        }
    }
    words
}

impl Word {
    /// Returns true if `next` begins in the next cell and has the same colour and weight.
    fn continues_with(&self, next: &Word) -> bool {
        let is_adjacent = self.row == next.row && self.column + self.cells == next.column;
        let looks_alike = self.colour == next.colour && self.is_bold == next.is_bold;
        is_adjacent && looks_alike
    }
}

/// Colours of a cell: `ink` of the symbol, `ground` of the background.
struct CellColours {
    ink: Rgb,
    ground: Rgb,
}

impl CellColours {
    fn of(glyph: &Glyph<'_>, palette: Palette) -> Self {
        let modifier = glyph.cell.modifier;
        let mut ink = rgb(glyph.cell.fg, palette.rgb(ColourRole::Text));
        let mut ground = rgb(glyph.cell.bg, palette.paper());
        if modifier.contains(Modifier::DIM) {
            ink = mixed(ink, ground, DIMMED);
        }
        if modifier.contains(Modifier::REVERSED) {
            std::mem::swap(&mut ink, &mut ground);
        }
        CellColours { ink, ground }
    }
}

/// Returns the colour of a cell, or `reset` for the default colour. A picture is drawn from a
/// screen with 24-bit colours, so that other colours do not occur.
fn rgb(colour: Color, reset: Rgb) -> Rgb {
    match colour {
        Color::Rgb(red, green, blue) => [red, green, blue],
        _ => reset,
    }
}

/// Mixes two colours. `percent` is the share of the first colour in per cent.
fn mixed(first: Rgb, second: Rgb, percent: u8) -> Rgb {
    let share = u32::from(percent);
    std::array::from_fn(|channel| {
        let first = u32::from(first[channel]) * share;
        let second = u32::from(second[channel]) * (100 - share);
        ((first + second) / 100) as u8
    })
}

/// Returns the kind and the path of a character that is drawn as a shape; `None` for a character
/// that is written as text.
fn shape(glyph: &Glyph<'_>) -> Option<(Kind, String)> {
    /// The four lines from the middle of a cell to its left, right, upper and lower edge. Each has
    /// the characters that contain the line, and the path of the line.
    const ENDS: [(&str, &str); 4] = [
        ("─┐┘┤┬┴", "h-4"),
        ("─┌└├┬┴", "h4"),
        ("│└┘├┤┴", "v-8"),
        ("│┌┐├┤┬", "v8"),
    ];
    if glyph.width != 1 {
        return None;
    }
    let character = glyph.character()?;
    let x = u32::from(glyph.column) * WIDTH;
    let y = u32::from(glyph.row) * HEIGHT;
    let mut path = String::new();
    match character {
        '─'..='┴' => {
            for (characters, end) in ENDS {
                if characters.contains(character) {
                    path += &format!("M{} {}{end}", x + WIDTH / 2, y + HEIGHT / 2);
                }
            }
            (!path.is_empty()).then_some((Kind::Line, path))
        }
        '█'..='▏' => {
            let width = WIDTH - (character as u32 - '█' as u32);
            Some((Kind::Block, boxed(glyph, width)))
        }
        _ => {
            // The bits of the dots are ordered row by row, two in a row, beginning with the upper
            // left dot.
            let bits = dots(character)?;
            for bit in 0..8 {
                if bits >> bit & 1 == 1 {
                    let dot_x = x + 2 + bit % 2 * 4;
                    let dot_y = y + 2 + bit / 2 * 4;
                    path += &format!("M{dot_x} {dot_y}h.1");
                }
            }
            Some((Kind::Dots, path))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::parsed;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    const PRESS: Color = Color::Rgb(0xf5, 0xa6, 0x3c);

    /// Draws a screen of one row and returns the SVG elements inside the margins.
    fn drawn(text: &str, style: Style) -> Vec<String> {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 1));
        buffer.set_string(1, 0, text, style);
        let svg = screen_svg(&buffer, Palette::DARK, "");
        parsed(&svg);
        let inner = svg.split_once("\"preserve\">\n").unwrap().1;
        inner
            .lines()
            .filter(|line| !line.starts_with("</"))
            .map(str::to_owned)
            .collect()
    }

    #[test]
    fn the_document_has_a_title_and_the_size_of_the_screen() {
        let svg = screen_svg(
            &Buffer::empty(Rect::new(5, 5, 120, 40)),
            Palette::LIGHT,
            "κ < 6 & \"h\" > 0\u{1}",
        );
        let (elements, text) = parsed(&svg);
        assert_eq!(text.trim(), "κ < 6 & \"h\" > 0\u{fffd}");
        assert!(
            elements[0].contains(r#"width="976" height="656" viewBox="0 0 976 656" role="img""#),
            "{svg}"
        );
        assert_eq!(
            elements[2],
            r##"rect width="976" height="656" rx="6" fill="#ffffff""##
        );
        assert_eq!(elements.len(), 4, "{svg}");
        parsed(&super::screen_svg(
            &Buffer::empty(Rect::ZERO),
            Palette::LIGHT,
            "",
        ));
    }

    #[test]
    fn letters_have_the_places_of_their_cells_and_their_looks() {
        let text = |x: u32, cells: u32, look: &str, letters: &str| {
            format!(
                r#"<text x="{x}" y="12" textLength="{}" fill={look}>{letters}</text>"#,
                8 * cells
            )
        };
        let face = r##""#dee2e9""##;
        let words = [text(8, 3, face, "a&lt;b"), text(48, 3, face, "漢c")];
        assert_eq!(drawn("a<b  漢c", Style::new()), words);
        let bold = text(8, 1, r##""#f5a63c" font-weight="bold""##, "x");
        assert_eq!(drawn("x", Style::new().bold().fg(PRESS)), [bold]);
        // The colour of dimmed text consists of 60 % foreground colour and 40 % background colour.
        assert_eq!(
            drawn("x", Style::new().dim()),
            [text(8, 1, r##""#8b8f96""##, "x")]
        );
        let ground = |colour: &str| {
            format!(r##"<path fill="{colour}" shape-rendering="crispEdges" d="M8 0h8v16h-8z"/>"##)
        };
        let reversed = [ground("#dee2e9"), text(8, 1, r##""#10131a""##, "x")];
        assert_eq!(drawn("x", Style::new().reversed()), reversed);
        assert_eq!(drawn(" ", Style::new().bg(PRESS)), [ground("#f5a63c")]);
    }

    #[test]
    fn dots_blocks_and_lines_are_drawn_whatever_the_font() {
        for (text, path) in [
            ("▌", "M8 0h4v16h-4z"),
            ("█", "M8 0h8v16h-8z"),
            ("┐", "M12 8h-4M12 8v8"),
            ("⡀", "M10 14h.1"),
        ] {
            assert!(
                drawn(text, Style::new())
                    .concat()
                    .contains(&format!(" d=\"{path}\"/>")),
                "{text}"
            );
        }
    }
}
