//! SVG documents: escaped text, elements, numbers to a hundredth of a pixel.

use super::canvas::{Anchor, Canvas, Pen, Place, below_middle, set};
use crate::draw::colour::{Rgb, hex};
use crate::draw::label::{Face, Label};
use std::fmt::Write;

/// Fonts of figures, with nearly the same letters on all systems.
const FONTS: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// An SVG document of version 1.1 without references to other files.
pub struct Document {
    text: String,
}

impl Document {
    /// Begins a document with the size in px.
    #[must_use]
    pub fn new(width: f64, height: f64, title: &str) -> Document {
        let (width, height, title) = (px(width), px(height), escaped(title));
        Document {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
                 viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\">\n<title>{title}</title>\n"
            ),
        }
    }

    /// Adds elements.
    pub fn push(&mut self, elements: &str) {
        self.text.push_str(elements);
    }

    /// Ends the document.
    #[must_use]
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.text.write_fmt(element);
        self.text.push('\n');
    }

    pub(super) fn begin_text(&mut self) {
        self.element(format_args!("<g font-family=\"{FONTS}\">"));
    }

    pub(super) fn end_text(&mut self) {
        self.element(format_args!("</g>"));
    }
}

impl Canvas for Document {
    fn rectangle(&mut self, from: Place, to: Place, fill: Rgb) {
        let (width, height) = (px(to.0 - from.0), px(to.1 - from.1));
        let (x, y, fill) = (px(from.0), px(from.1), hex(fill));
        self.element(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>"
        ));
    }

    fn frame(&mut self, from: Place, to: Place, pen: Pen) {
        let (width, height, pen) = (px(to.0 - from.0), px(to.1 - from.1), attributes(pen));
        let (x, y) = (px(from.0), px(from.1));
        self.element(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"none\" {pen}/>"
        ));
    }

    fn line(&mut self, places: &[Place], pen: Pen) {
        let (points, pen) = (points(places), attributes(pen));
        self.element(format_args!(
            "<polyline points=\"{points}\" fill=\"none\" {pen} stroke-linejoin=\"round\"/>"
        ));
    }

    fn area(&mut self, places: &[Place], fill: Rgb, opacity: f64) {
        let (points, fill) = (points(places), hex(fill));
        let opacity =
            if opacity < 1.0 { format!(" fill-opacity=\"{}\"", px(opacity)) } else { String::new() };
        self.element(format_args!("<polygon points=\"{points}\" fill=\"{fill}\"{opacity}/>"));
    }

    fn boxes(&mut self, boxes: &[(Place, Place)], fill: Rgb) {
        let path: String = boxes
            .iter()
            .map(|(from, to)| {
                let (width, height) = (px((to.0 - from.0).max(0.5)), px((to.1 - from.1).max(0.5)));
                format!("M{} {}h{width}v{height}h-{width}z", px(from.0), px(from.1))
            })
            .collect();
        if !path.is_empty() {
            let fill = hex(fill);
            self.element(format_args!("<path d=\"{path}\" fill=\"{fill}\" shape-rendering=\"crispEdges\"/>"));
        }
    }

    fn circle(&mut self, at: Place, radius: f64, fill: Rgb, pen: Option<Pen>) {
        let (x, y, radius, fill) = (px(at.0), px(at.1), px(radius), hex(fill));
        let pen = pen.map_or_else(String::new, |pen| format!(" {}", attributes(pen)));
        self.element(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{pen}/>"));
    }

    fn label(&mut self, label: &Label, at: Place, size: f64, anchor: Anchor, colour: Rgb) {
        let (x, y, fill) = (px(at.0), px(at.1), hex(colour));
        let side = match anchor {
            Anchor::Left => "start",
            Anchor::Middle | Anchor::Upwards => "middle",
            Anchor::Right => "end",
        };
        let turned = if anchor == Anchor::Upwards {
            format!(" transform=\"rotate(-90 {x} {y})\"")
        } else {
            String::new()
        };
        let base = px(at.1 + below_middle(size));
        let (runs, size) = (runs(label, size), px(size));
        self.element(format_args!(
            "<text x=\"{x}\" y=\"{base}\" font-size=\"{size}\" text-anchor=\"{side}\" fill=\"{fill}\"{turned}>{runs}</text>"
        ));
    }
}

fn attributes(pen: Pen) -> String {
    let dashes = pen
        .dashes()
        .map_or_else(String::new, |(dash, gap)| format!(" stroke-dasharray=\"{} {}\"", px(dash), px(gap)));
    format!("stroke=\"{}\" stroke-width=\"{}\"{dashes}", hex(pen.colour), px(pen.width))
}

/// The runs of a label as elements within a text of this size, px.
fn runs(label: &Label, size: f64) -> String {
    let mut elements = String::new();
    let mut shift = 0.0;
    for (face, text) in label.runs() {
        let (own, small) = set(*face, size);
        let looks = match face {
            Face::Upright => String::new(),
            Face::Italic => " font-style=\"italic\"".to_owned(),
            Face::Index | Face::Exponent => format!(" font-size=\"{}\"", px(small)),
        };
        let step = px(own - shift);
        let step = if step == "0" { String::new() } else { format!(" dy=\"{step}\"") };
        shift = own;
        let text = escaped(text);
        if step.is_empty() && looks.is_empty() {
            elements.push_str(&text);
        } else {
            elements.push_str(&format!("<tspan{step}{looks}>{text}</tspan>"));
        }
    }
    elements
}

fn points(places: &[Place]) -> String {
    let texts: Vec<String> = places.iter().map(|(x, y)| format!("{},{}", px(*x), px(*y))).collect();
    texts.join(" ")
}

/// A length to a hundredth of a pixel.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Text with markup escaped. Characters invalid in XML become U+FFFD.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\0'..=' ' if character != ' ' => escaped.push('\u{fffd}'),
            '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_and_exponents_return_to_the_base_line() {
        let label = Label::symbol("F_a,max").then(" < ").join(&Label::power_of_ten(-3));
        assert_eq!(
            runs(&label, 10.0),
            "<tspan font-style=\"italic\">F</tspan><tspan dy=\"2.5\" font-size=\"7.2\">a,max</tspan>\
             <tspan dy=\"-2.5\"> &lt; 10</tspan><tspan dy=\"-4.2\" font-size=\"7.2\">−3</tspan>"
        );
    }

    #[test]
    fn lengths_are_short() {
        assert_eq!([0.0, -0.001, 1.0, 2.345, -12.5, 120.0].map(px), ["0", "0", "1", "2.35", "-12.5", "120"]);
        assert_eq!(escaped("a<&>\"\u{1}\u{ffff}é"), "a&lt;&amp;&gt;&quot;\u{fffd}\u{fffd}é");
    }
}
