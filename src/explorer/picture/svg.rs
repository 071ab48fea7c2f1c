//! The screen as an SVG document, for slides and for pages on the web.
//!
//! Letters are text, stretched to the grid of cells. Dots, blocks and lines are drawn, so that they meet from cell to
//! cell with any font.

use super::{Glyph, dots, glyphs};
use crate::draw::{Palette, Rgb, Svg, escaped, hex};
use ratatui::buffer::Buffer;
use ratatui::style::{Color, Modifier};
use ratatui::symbols::pixel::OCTANTS;
use std::collections::BTreeMap;

/// Width and height of a cell, height of the base line of letters in it, and room around the screen, px.
const WIDTH: u32 = 8;
const HEIGHT: u32 = 16;
const BASE: u32 = 12;
const MARGIN: u32 = 8;
/// Monospaced fonts of the common systems, with letters about 0.6 times as wide as their size.
const FONTS: &str =
    "ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono','Liberation Mono',monospace";
const FONT_SIZE: f64 = 13.3;
/// Remaining share of a dimmed colour, percent.
const DIMMED: u8 = 60;

/// Kind of a shape, in the order of drawing.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Ground,
    Block,
    Line,
    Dots,
}

/// The screen as a self-contained document, the same bytes for the same screen.
pub fn svg(buffer: &Buffer, palette: &Palette, title: &str) -> String {
    let width = u32::from(buffer.area.width) * WIDTH + 2 * MARGIN;
    let height = u32::from(buffer.area.height) * HEIGHT + 2 * MARGIN;
    let mut svg = Svg::new(f64::from(width), f64::from(height), title);
    let ground = hex(palette.background);
    svg.push(format_args!("<rect width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"{ground}\"/>"));
    svg.push(format_args!(
        "<g transform=\"translate({MARGIN} {MARGIN})\" font-family=\"{FONTS}\" font-size=\"{FONT_SIZE}\" \
         xml:space=\"preserve\">"
    ));
    for ((kind, colour), path) in paths(buffer, palette) {
        let colour = hex(colour);
        let stroke = |width: f64, cap: &str| {
            format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"{cap}\"")
        };
        let looks = match kind {
            Kind::Ground | Kind::Block => format!("fill=\"{colour}\" shape-rendering=\"crispEdges\""),
            Kind::Line => stroke(1.2, "square"),
            Kind::Dots => stroke(2.8, "round"),
        };
        svg.push(format_args!("<path {looks} d=\"{path}\"/>"));
    }
    for ((colour, is_bold, is_underlined), texts) in texts(buffer, palette) {
        let bold = if is_bold { " font-weight=\"bold\"" } else { "" };
        let underlined = if is_underlined { " text-decoration=\"underline\"" } else { "" };
        svg.push(format_args!("<g fill=\"{}\"{bold}{underlined}>\n{texts}</g>", hex(colour)));
    }
    svg.push(format_args!("</g>"));
    svg.finish()
}

/// Backgrounds and characters that are drawn, as data of paths.
fn paths(buffer: &Buffer, palette: &Palette) -> BTreeMap<(Kind, Rgb), String> {
    let mut paths = BTreeMap::<_, String>::new();
    for glyph in glyphs(buffer) {
        let (colour, ground) = colours(&glyph, palette);
        if ground != palette.background {
            let path = boxed(&glyph, [0, 0, u32::from(glyph.width) * WIDTH, HEIGHT]);
            paths.entry((Kind::Ground, ground)).or_default().push_str(&path);
        }
        if let Some((kind, percent, path)) = shape(&glyph) {
            paths.entry((kind, mixed(colour, ground, percent))).or_default().push_str(&path);
        }
    }
    paths
}

/// Path around a part of the cell of a symbol: left, top, width and height.
fn boxed(glyph: &Glyph<'_>, [left, top, width, height]: [u32; 4]) -> String {
    let (x, y) = (u32::from(glyph.column) * WIDTH + left, u32::from(glyph.row) * HEIGHT + top);
    format!("M{x} {y}h{width}v{height}h-{width}z")
}

/// Elements of text by colour, weight and underline: letters of one look on one row, at most one blank apart, are one
/// element.
fn texts(buffer: &Buffer, palette: &Palette) -> BTreeMap<(Rgb, bool, bool), String> {
    let looks = |glyph: &Glyph<'_>| {
        let has = |modifier| glyph.cell.modifier.contains(modifier);
        (colours(glyph, palette).0, has(Modifier::BOLD), has(Modifier::UNDERLINED))
    };
    // Other characters come from a font of another width.
    let is_common = |glyph: &Glyph<'_>| glyph.symbol().chars().all(is_common);
    let gap = |one: &Glyph<'_>, next: &Glyph<'_>| next.column - one.column - one.width;
    let is_letter = |glyph: &Glyph<'_>| shape(glyph).is_none() && glyph.symbol() != " ";
    let letters: Vec<Glyph<'_>> = glyphs(buffer).filter(is_letter).collect();
    let runs = letters.chunk_by(|one, next| {
        let is_near = one.row == next.row && gap(one, next) <= 1;
        is_near && looks(one) == looks(next) && is_common(one) && is_common(next)
    });
    let mut texts = BTreeMap::<_, String>::new();
    for run in runs {
        let (first, last) = (&run[0], &run[run.len() - 1]);
        let mut text = first.symbol().to_owned();
        for pair in run.windows(2) {
            text += if gap(&pair[0], &pair[1]) == 1 { " " } else { "" };
            text += pair[1].symbol();
        }
        let (x, y) = (u32::from(first.column) * WIDTH, u32::from(first.row) * HEIGHT + BASE);
        let length = u32::from(last.column + last.width - first.column) * WIDTH;
        let text = format!("<text x=\"{x}\" y=\"{y}\" textLength=\"{length}\">{}</text>\n", escaped(&text));
        texts.entry(looks(first)).or_default().push_str(&text);
    }
    texts
}

/// Colours of a symbol and of its background.
fn colours(glyph: &Glyph<'_>, palette: &Palette) -> (Rgb, Rgb) {
    let (cell, modifier) = (glyph.cell, glyph.cell.modifier);
    let mut ink = rgb(palette, cell.fg, palette.foreground);
    let mut ground = rgb(palette, cell.bg, palette.background);
    if modifier.contains(Modifier::DIM) {
        ink = mixed(ink, ground, DIMMED);
    }
    if modifier.contains(Modifier::REVERSED) {
        std::mem::swap(&mut ink, &mut ground);
    }
    (ink, ground)
}

/// Colour of the palette; `reset` where the terminal chooses. The explorer has the sixteen colours of ANSI.
fn rgb(palette: &Palette, colour: Color, reset: Rgb) -> Rgb {
    const ANSI: &str = "Black Red Green Yellow Blue Magenta Cyan Gray DarkGray LightRed LightGreen LightYellow \
                        LightBlue LightMagenta LightCyan White";
    let name = colour.to_string();
    ANSI.split(' ').position(|one| one == name).map_or(reset, |index| palette.ansi[index])
}

/// A colour between two others: a share in percent of the first.
fn mixed(one: Rgb, other: Rgb, percent: u8) -> Rgb {
    std::array::from_fn(|channel| {
        let part = |colour: Rgb, percent: u8| u32::from(colour[channel]) * u32::from(percent);
        ((part(one, percent) + part(other, 100 - percent)) / 100) as u8
    })
}

/// Kind, share of its area that is filled in percent, and path of a character other than a letter.
fn shape(glyph: &Glyph<'_>) -> Option<(Kind, u8, String)> {
    /// Lines from the middle of the cell to the left, right, upper and lower edge, and the characters with each.
    const ENDS: [(&str, &str); 4] =
        [("─┐┘┤┬┴", "h-4"), ("─┌└├┬┴", "h4"), ("│└┘├┤┴", "v-8"), ("│┌┐├┤┬", "v8")];
    let character = glyph.character().filter(|_| glyph.width == 1)?;
    let (x, y) = (u32::from(glyph.column) * WIDTH, u32::from(glyph.row) * HEIGHT);
    let block = |part: [u32; 4]| Some((Kind::Block, 100, boxed(glyph, part)));
    // Bits row by row from the upper left, two across and four down.
    let each = |bits: u32, path: &dyn Fn(u32, u32) -> String| {
        (0..8).filter(|bit| bits >> bit & 1 == 1).map(|bit| path(bit % 2 * 4, bit / 2 * 4)).collect()
    };
    match character {
        '─'..='┴' => {
            let ends = ENDS.iter().filter(|(characters, _)| characters.contains(character));
            let path: String =
                ends.map(|(_, end)| format!("M{} {}{end}", x + WIDTH / 2, y + HEIGHT / 2)).collect();
            Some((Kind::Line, 100, path)).filter(|(.., path)| !path.is_empty())
        }
        '▀' => block([0, 0, 8, 8]),
        '▄' => block([0, 8, 8, 8]),
        '▁' => block([0, 14, 8, 2]),
        '▕' => block([7, 0, 1, 16]),
        '█'..='▏' => block([0, 0, 8 - (character as u32 - '█' as u32), 16]),
        '░'..='▓' => Some((
            Kind::Block,
            25 * (character as u32 - '░' as u32 + 1) as u8,
            boxed(glyph, [0, 0, WIDTH, HEIGHT]),
        )),
        ' ' => None,
        _ => match (dots(character), OCTANTS.iter().position(|octant| *octant == character)) {
            (Some(dots), _) => {
                let dot = |left, top| format!("M{} {}h.1", x + 2 + left, y + 2 + top);
                Some((Kind::Dots, 100, each(dots.into(), &dot)))
            }
            (None, Some(bits)) => {
                Some((Kind::Block, 100, each(bits as u32, &|left, top| boxed(glyph, [left, top, 4, 4]))))
            }
            (None, None) => None,
        },
    }
}

/// Returns true if a character is in the common monospaced fonts.
fn is_common(character: char) -> bool {
    matches!(character, ' '..='~' | '\u{a1}'..='ſ' | 'Α'..='ω' | '–' | '—' | '‘'..='”' | '…' | '−')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::parsed;
    use ratatui::layout::Rect;
    use ratatui::style::Style;
    use ratatui::symbols::braille::BRAILLE;

    /// The elements within the margins of a screen of one row.
    fn drawn(text: &str, style: Style) -> Vec<String> {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 1));
        buffer.set_string(1, 0, text, style);
        let svg = svg(&buffer, &Palette::DARK, "");
        parsed(&svg);
        let inner = svg.split_once("\"preserve\">\n").unwrap().1;
        inner.lines().filter(|line| !line.starts_with("</")).map(str::to_owned).collect()
    }

    #[test]
    fn the_document_has_a_title_and_the_size_of_the_screen() {
        let svg = svg(&Buffer::empty(Rect::new(5, 5, 120, 40)), &Palette::LIGHT, "κ < 6 & \"h\" > 0\u{1}");
        let (elements, text) = parsed(&svg);
        assert_eq!(text.trim(), "κ < 6 & \"h\" > 0\u{fffd}");
        assert!(
            elements[0].contains(r#"width="976" height="656" viewBox="0 0 976 656" role="img""#),
            "{svg}"
        );
        assert_eq!(elements[2], r##"rect width="976" height="656" rx="6" fill="#ffffff""##);
        assert_eq!(elements.len(), 4, "{svg}");
        parsed(&super::svg(&Buffer::empty(Rect::ZERO), &Palette::LIGHT, ""));
    }

    #[test]
    fn letters_of_one_look_are_one_text_on_the_grid() {
        let face = r##"<g fill="#e1e6eb">"##;
        let text = |x: u32, columns: u32, letters: &str| {
            format!(r#"<text x="{x}" y="12" textLength="{}">{letters}</text>"#, 8 * columns)
        };
        assert_eq!(drawn("F_a = µN", Style::new()), [face, &text(8, 8, "F_a = µN")]);
        assert_eq!(drawn("a<b  c", Style::new()), [face, &text(8, 3, "a&lt;b"), &text(48, 1, "c")]);
        // Rare and wide characters are set one by one.
        let alone = [face, &text(8, 1, "⟨"), &text(16, 1, "z"), &text(24, 2, "漢"), &text(40, 1, "y")];
        assert_eq!(drawn("⟨z漢y", Style::new()), alone);
    }

    #[test]
    fn looks_are_kept() {
        let text = r#"<text x="8" y="12" textLength="8">x</text>"#;
        assert_eq!(
            drawn("x", Style::new().bold().red()),
            [r##"<g fill="#ff6b3d" font-weight="bold">"##, text]
        );
        // Three fifths of the foreground over the background.
        assert_eq!(drawn("x", Style::new().dim()), [r##"<g fill="#8d9297">"##, text]);
        let reversed = [
            r##"<path fill="#e1e6eb" shape-rendering="crispEdges" d="M8 0h8v16h-8z"/>"##,
            r##"<g fill="#10151b">"##,
            text,
        ];
        assert_eq!(drawn("x", Style::new().reversed()), reversed);
        let ground = r##"<path fill="#ff6b3d" shape-rendering="crispEdges" d="M8 0h8v16h-8z"/>"##;
        assert_eq!(drawn(" ", Style::new().bg(Color::Red)), [ground]);
    }

    #[test]
    fn shapes_are_drawn_whatever_the_font() {
        let blocks =
            [("▌", "M8 0h4v16h-4z"), ("▄", "M8 8h8v8h-8z"), ("▁", "M8 14h8v2h-8z"), ("█", "M8 0h8v16h-8z")];
        for (text, path) in blocks {
            let path = format!("<path fill=\"#e1e6eb\" shape-rendering=\"crispEdges\" d=\"{path}\"/>");
            assert_eq!(drawn(text, Style::new()), [path]);
        }
        // A quarter of the way from the background to the foreground.
        assert!(drawn("░", Style::new())[0].contains("#44494f"));
        assert!(drawn("┐", Style::new())[0].contains("d=\"M12 8h-4M12 8v8\""));
        let path = |character: char| drawn(&character.to_string(), Style::new()).concat();
        for (bits, character) in OCTANTS.into_iter().enumerate().skip(1) {
            let (path, ones) = (path(character), bits.count_ones());
            let boxes = path.split_once(" d=\"").unwrap().1.split('M').skip(1);
            let sizes = boxes
                .map(|part| part.split(['h', 'v']).skip(1).take(2).map(|size| size.parse::<u32>().unwrap()));
            assert_eq!(sizes.map(Iterator::product::<u32>).sum::<u32>(), 16 * ones, "{character}");
        }
        for (bits, character) in BRAILLE.into_iter().enumerate().skip(1) {
            assert_eq!(path(character).matches("h.1").count(), bits.count_ones() as usize, "{character}");
        }
    }

    /// Contrast ratio of WCAG 2.
    fn contrast(one: Rgb, other: Rgb) -> f64 {
        let light = |channel: u8| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        };
        let [one, other] = [one, other].map(|[red, green, blue]| {
            0.2126 * light(red) + 0.7152 * light(green) + 0.0722 * light(blue) + 0.05
        });
        one.max(other) / one.min(other)
    }

    #[test]
    fn colours_can_be_read() {
        for palette in [Palette::DARK, Palette::LIGHT] {
            assert!(contrast(palette.foreground, palette.background) > 12.0);
            // Black and white may be those of the ground.
            for colour in &palette.ansi[1..15] {
                assert!(contrast(*colour, palette.background) > 4.5, "{colour:02x?}");
            }
        }
    }
}
