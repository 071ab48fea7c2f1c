//! The screen as a scalable picture, for slides and for pages on the web.

use super::sheet::{MARGIN, Part, Pen, Sheet, size};
use crate::draw::{Document, Palette, hex};
use ratatui::buffer::Buffer;
use std::fmt::Write as _;

/// A picture of the screen: a self-contained document of SVG 1.1, the same bytes for the same screen.
#[must_use]
pub fn svg(buffer: &Buffer, palette: &Palette, title: &str) -> String {
    let ((width, height), ground) = (size(buffer), hex(palette.background));
    let (parts, letters) = Sheet::new(buffer, palette).parts();
    let mut document = Document::new(f64::from(width), f64::from(height), title);
    let mut svg = format!(
        "<rect width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"{ground}\"/>\n\
         <g transform=\"translate({MARGIN} {MARGIN})\">\n"
    );
    for Part { path, colour, pen } in parts {
        let colour = hex(colour);
        // Writing to a string does not fail.
        let _ = match pen {
            None => writeln!(svg, "<path fill=\"{colour}\" d=\"{path}\"/>"),
            Some(pen) => {
                let width = pen.width();
                let ends = match pen {
                    Pen::Whole(_) => "stroke-linecap=\"square\"",
                    Pen::Dot => "stroke-linecap=\"round\" stroke-linejoin=\"round\"",
                    _ => "stroke-linecap=\"butt\"",
                };
                writeln!(
                    svg,
                    "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" {ends} d=\"{path}\"/>"
                )
            }
        };
    }
    document.push(&(svg + &letters.elements() + "</g>\n"));
    document.finish()
}

#[cfg(test)]
mod tests {
    use super::super::letters::FONTS;
    use super::*;
    use crate::draw::svg_tests::parsed;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use ratatui::layout::{Constraint, Layout, Rect};
    use ratatui::style::{Color, Style};
    use ratatui::symbols::Marker;
    use ratatui::widgets::Block;
    use ratatui::widgets::canvas::{Canvas, Line};
    use std::collections::BTreeMap;

    /// The elements between the background and the end, of a screen of one row.
    fn drawn(buffer: &Buffer) -> Vec<String> {
        let svg = svg(buffer, &Palette::DARK, "");
        parsed(&svg);
        let inner = svg.split_once("translate(8 8)\">\n").unwrap().1.replace(FONTS, "FONTS");
        inner
            .lines()
            .filter(|line| !line.starts_with("</") && !line.contains("FONTS"))
            .map(str::to_owned)
            .collect()
    }

    fn styled(text: &str, style: Style) -> Vec<String> {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 1));
        buffer.set_string(1, 0, text, style);
        drawn(&buffer)
    }

    #[test]
    fn the_document_says_what_it_is() {
        let svg = svg(&Buffer::empty(Rect::new(5, 5, 120, 40)), &Palette::LIGHT, "κ < 6 & \"h\" > 0\u{1}");
        let (elements, text) = parsed(&svg);
        assert_eq!(text.trim(), "κ < 6 & \"h\" > 0\u{fffd}");
        assert!(
            elements[0].contains(r#"width="976" height="656" viewBox="0 0 976 656" role="img""#),
            "{svg}"
        );
        assert_eq!(elements[1], "title");
        assert_eq!(elements[2], r##"rect width="976" height="656" rx="6" fill="#ffffff""##);
        assert_eq!(elements.len(), 5, "{svg}");
        parsed(&super::svg(&Buffer::empty(Rect::ZERO), &Palette::LIGHT, ""));
    }

    #[test]
    fn letters_of_one_look_are_one_text_on_the_grid() {
        let face = r##"<g fill="#e1e6eb">"##;
        let one = [face, r#"<text x="8" y="12" textLength="64">F_a = µN</text>"#];
        assert_eq!(styled("F_a = µN", Style::new()), one);
        let two = [
            face,
            r#"<text x="8" y="12" textLength="24">a&lt;b</text>"#,
            r#"<text x="48" y="12" textLength="8">c</text>"#,
        ];
        assert_eq!(styled("a<b  c", Style::new()), two);
        // Rare and wide characters are set one by one.
        let alone = [
            face,
            r#"<text x="8" y="12" textLength="8">⟨</text>"#,
            r#"<text x="16" y="12" textLength="8">z</text>"#,
            r#"<text x="24" y="12" textLength="16">漢</text>"#,
            r#"<text x="40" y="12" textLength="8">y</text>"#,
        ];
        assert_eq!(styled("⟨z漢y", Style::new()), alone);
    }

    #[test]
    fn looks_are_kept() {
        let text = r#"<text x="8" y="12" textLength="8">x</text>"#;
        let [foreground, background] = ["#e1e6eb", "#10151b"];
        assert_eq!(
            styled("x", Style::new().bold().italic().red()),
            [r##"<g fill="#ff6b3d" font-weight="bold" font-style="italic">"##, text]
        );
        // Three fifths of the foreground over the background.
        assert_eq!(styled("x", Style::new().dim()), [r##"<g fill="#8d9297">"##, text]);
        let reversed = [
            format!(r#"<path fill="{foreground}" d="M8 0H16V16H8z"/>"#),
            format!(r#"<g fill="{background}">"#),
            text.to_owned(),
        ];
        assert_eq!(styled("x", Style::new().reversed()), reversed);
        let ground = r##"<path fill="#0000ff" d="M8 0H24V16H8z"/>"##;
        assert_eq!(styled("  ", Style::new().bg(Color::Indexed(21))), [ground]);
        assert_eq!(styled("x", Style::new().hidden()), [""; 0]);
        let line = |colour: &str, height: u32| {
            format!(
                r#"<path fill="none" stroke="{colour}" stroke-width="1" stroke-linecap="butt" d="M8 {height}H32"/>"#
            )
        };
        assert_eq!(styled("   ", Style::new().underlined()), [line(foreground, 14)]);
        assert_eq!(styled("   ", Style::new().crossed_out()), [line(foreground, 8)]);
        let coloured = Style::new().underlined().underline_color(Color::Rgb(1, 2, 3));
        assert_eq!(styled("   ", coloured), [line("#010203", 14)]);
    }

    #[test]
    fn shapes_are_drawn_whatever_the_font() {
        let blocks = styled("▌█▀", Style::new());
        assert_eq!(blocks, [r##"<path fill="#e1e6eb" d="M8 0H12V16H8zM16 0H32V8H16zM16 8H24V16H16z"/>"##]);
        // A quarter of the way from the background to the foreground.
        assert_eq!(styled("░░", Style::new()), [r##"<path fill="#44494f" d="M8 0H24V16H8z"/>"##]);
        let line = r##"<path fill="none" stroke="#e1e6eb" stroke-width="1.2" stroke-linecap="square" d="M8 8H28M28 8V16"/>"##;
        assert_eq!(styled("──┐", Style::new()), [line]);
        for mark in "▲▼◆■▪▸•●○".chars() {
            let drawn = styled(&mark.to_string(), Style::new());
            assert!(drawn.len() == 1 && drawn[0].contains("d=\"M8 0m"), "{drawn:?}");
        }
    }

    #[test]
    fn every_dot_is_a_point_of_the_path_of_its_colour() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 32, 8));
        let mut expected = BTreeMap::new();
        for (pattern, cell) in (0_u8..=255).zip(&mut buffer.content) {
            let colour = if pattern % 3 == 0 { Color::Red } else { Color::Blue };
            cell.set_char(char::from_u32(0x2800 + u32::from(pattern)).unwrap()).set_fg(colour);
            *expected.entry(colour == Color::Red).or_insert(0) += pattern.count_ones();
        }
        let paths = drawn(&buffer);
        assert_eq!(paths.len(), 2);
        for (is_red, colour) in [(true, "#ff6b3d"), (false, "#3b94f5")] {
            let path = paths.iter().find(|path| path.contains(colour)).unwrap();
            assert_eq!(path.matches("h.1z").count() as u32, expected[&is_red]);
        }
    }

    /// Four framed panes full of curves and filled bars.
    fn screen(marker: Marker) -> Buffer {
        let mut terminal = Terminal::new(TestBackend::new(120, 40)).unwrap();
        terminal
            .draw(|frame| {
                let rows = Layout::vertical([Constraint::Fill(1); 2]).split(frame.area());
                for (row, area) in rows.iter().enumerate() {
                    for (column, area) in
                        Layout::horizontal([Constraint::Fill(1); 2]).split(*area).iter().enumerate()
                    {
                        let canvas = Canvas::default()
                            .marker(marker)
                            .block(Block::bordered().title("Force F(d), µN"))
                            .x_bounds([0.0, 200.0])
                            .y_bounds([-1.5, 1.5])
                            .paint(|context| {
                                for x in 0..200 {
                                    let x = f64::from(x);
                                    let y = (0.05 * x + row as f64).sin();
                                    let other = 0.2 * (0.9 * x).sin() - column as f64;
                                    context.draw(&Line::new(x, y, x + 1.0, y, Color::Green));
                                    context.draw(&Line::new(x, other, x, other + 0.4, Color::Magenta));
                                }
                                context.print(20.0, 1.2, "◆ now");
                            });
                        frame.render_widget(canvas, *area);
                    }
                }
            })
            .unwrap();
        terminal.backend().buffer().clone()
    }

    #[test]
    fn a_full_screen_stays_small_and_the_same() {
        for marker in [Marker::Braille, Marker::Octant, Marker::HalfBlock, Marker::Sextant, Marker::Quadrant]
        {
            let screen = screen(marker);
            let svg = svg(&screen, &Palette::DARK, "Asperity");
            let (elements, text) = parsed(&svg);
            assert!(svg.len() < 60_000 && elements.len() < 60, "{marker} {} {}", svg.len(), elements.len());
            assert_eq!(text.matches("Force F(d), µN").count(), 4);
            assert_eq!(svg, super::svg(&screen, &Palette::DARK, "Asperity"));
        }
    }
}
