//! Elements of an SVG document. Lengths are rounded to a hundredth of a px.

use crate::chart::Stroke;
use crate::colour::{Rgb, hex};
use crate::label::{Face, Label, SMALL};
use crate::palette::{ColourRole, Palette};
use std::fmt::{Arguments, Write};

pub(super) const TEXT: Rgb = Palette::LIGHT.rgb(ColourRole::Text);
pub(super) const PAPER: Rgb = Palette::LIGHT.paper();
/// Colour of map cells without a value: a grey that does not occur in any colour scale.
pub(super) const EMPTY: Rgb = [0xc4, 0xc8, 0xcc];

/// Position in a picture, in px from the upper left corner.
pub(super) type Place = (f64, f64);

/// Point of a label that lies at the given position: the left end, the middle or the right end of
/// the label, at half its height.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
    /// Middle of a label that is written upwards.
    Upwards,
}

/// Colour, width in px and pattern of a line.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub colour: Rgb,
    pub width: f64,
    pub stroke: Stroke,
}

impl Pen {
    pub(super) fn solid(colour: Rgb, width: f64) -> Pen {
        Pen {
            colour,
            width,
            stroke: Stroke::Solid,
        }
    }

    fn attributes(self) -> String {
        let dashes = match self.stroke {
            Stroke::Solid => "",
            Stroke::Dashed => " stroke-dasharray=\"6 3.5\"",
            Stroke::Dotted => " stroke-dasharray=\"2.5 2.5\"",
            Stroke::DashDotted => " stroke-dasharray=\"8 2.5 1.5 2.5\"",
            Stroke::Sparse => " stroke-dasharray=\"1.5 4.5\"",
        };
        format!(
            "stroke=\"{}\" stroke-width=\"{}\"{dashes}",
            hex(self.colour),
            px(self.width)
        )
    }
}

/// SVG 1.1 document that refers to no other files, or a part of such a document.
#[derive(Default)]
pub struct Svg {
    text: String,
}

impl Svg {
    /// Begins a document with this width and height in px.
    pub fn new(width: f64, height: f64, title: &str) -> Svg {
        let width = px(width);
        let height = px(height);
        let title = escaped(title);
        let mut svg = Svg::default();
        svg.push(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\">\n\
             <title>{title}</title>"
        ));
        svg
    }

    pub fn push(&mut self, elements: Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.text.write_fmt(elements);
        self.text.push('\n');
    }

    pub(super) fn append(&mut self, part: Svg) {
        self.text += &part.text;
    }

    /// Ends the document and returns its text.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// Adds a group with the given attributes. The elements of the group are drawn by `draw`.
    pub(super) fn group(&mut self, attributes: &str, draw: impl FnOnce(&mut Svg)) {
        self.push(format_args!("<g {attributes}>"));
        draw(self);
        self.push(format_args!("</g>"));
    }

    fn rect(&mut self, from: Place, to: Place, looks: &str) {
        let x = px(from.0);
        let y = px(from.1);
        let width = px(rounded(to.0) - rounded(from.0));
        let height = px(rounded(to.1) - rounded(from.1));
        self.push(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {looks}/>"
        ));
    }

    pub(super) fn rectangle(&mut self, from: Place, to: Place, fill: Rgb) {
        self.rect(from, to, &format!("fill=\"{}\"", hex(fill)));
    }

    pub(super) fn frame(&mut self, from: Place, to: Place, pen: Pen) {
        self.rect(from, to, &format!("fill=\"none\" {}", pen.attributes()));
    }

    pub(super) fn line(&mut self, places: &[Place], pen: Pen) {
        let points = points(places);
        let pen = pen.attributes();
        self.push(format_args!(
            "<polyline points=\"{points}\" fill=\"none\" {pen} stroke-linejoin=\"round\"/>"
        ));
    }

    /// Draws straight lines with round caps. Each line is given by its two ends.
    pub(super) fn pieces(&mut self, pieces: &[[Place; 2]], pen: Pen) {
        let mut path = String::new();
        for [from, to] in pieces {
            path += &format!("M{} {}L{} {}", px(from.0), px(from.1), px(to.0), px(to.1));
        }
        let pen = pen.attributes();
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"none\" {pen} stroke-linecap=\"round\"/>"
        ));
    }

    pub(super) fn area(&mut self, places: &[Place], fill: Rgb, opacity: f64) {
        let points = points(places);
        let fill = hex(fill);
        let opacity = if opacity < 1.0 {
            format!(" fill-opacity=\"{}\"", px(opacity))
        } else {
            String::new()
        };
        self.push(format_args!(
            "<polygon points=\"{points}\" fill=\"{fill}\"{opacity}/>"
        ));
    }

    /// Fills rectangles with a colour. Each rectangle is given by its upper left and its lower
    /// right corner. A rectangle below 0.5 px in width or height is enlarged to 0.5 px. Rectangles
    /// with a common edge meet without a gap.
    pub(super) fn boxes(&mut self, boxes: impl Iterator<Item = (Place, Place)>, fill: Rgb) {
        let mut path = String::new();
        for (from, to) in boxes {
            let left = px(from.0);
            let top = px(from.1);
            let right = px(to.0.max(from.0 + 0.5));
            let bottom = px(to.1.max(from.1 + 0.5));
            path += &format!("M{left} {top}H{right}V{bottom}H{left}z");
        }
        let fill = hex(fill);
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"{fill}\" shape-rendering=\"crispEdges\"/>"
        ));
    }

    pub(super) fn circle(&mut self, middle: Place, radius: f64, fill: Rgb, pen: Option<Pen>) {
        let x = px(middle.0);
        let y = px(middle.1);
        let radius = px(radius);
        let fill = hex(fill);
        let pen = pen.map_or_else(String::new, |pen| format!(" {}", pen.attributes()));
        self.push(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{pen}/>"
        ));
    }

    /// Writes labels one below the other, the first label at the position `first`. Returns the
    /// vertical position in px at which a further label would follow.
    pub(super) fn lines(
        &mut self,
        lines: &[Label],
        first: Place,
        size: f64,
        anchor: Anchor,
    ) -> f64 {
        let (x, mut y) = first;
        for line in lines {
            self.label(line, (x, y), size, anchor);
            y += (1.4 * size).round();
        }
        y
    }

    pub(super) fn label(&mut self, label: &Label, place: Place, size: f64, anchor: Anchor) {
        let x = px(place.0);
        let y = px(place.1);
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
        // The base line lies below the middle by half the height of a capital letter.
        let base = px(place.1 + 0.35 * size);
        let fill = hex(TEXT);
        let runs = runs(label, size);
        let size = px(size);
        self.push(format_args!(
            "<text x=\"{x}\" y=\"{base}\" font-size=\"{size}\" text-anchor=\"{side}\" \
             fill=\"{fill}\"{turned}>{runs}</text>"
        ));
    }
}

/// Rounds a length in px to a hundredth. Due to the rounding, adjacent rectangles share the same
/// edge.
fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

/// Replaces the hyphen before a number by a minus sign.
fn with_minus(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut before = ' ';
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        let is_before_digit = characters.peek().is_some_and(char::is_ascii_digit);
        let is_minus =
            character == '-' && is_before_digit && matches!(before, ' ' | '\u{a0}' | '(');
        shown.push(if is_minus { '−' } else { character });
        before = character;
    }
    shown
}

/// Returns the parts of a label as SVG elements inside a text with this font size in px.
fn runs(label: &Label, size: f64) -> String {
    let mut elements = String::new();
    let mut shift = 0.0;
    for (face, text) in label.runs() {
        let text = with_minus(text);
        let after = text.trim_start_matches(is_blank);
        let inner = after.trim_end_matches(is_blank);
        // Some viewers drop blanks at the beginning or end of an element. Therefore blanks are
        // written outside the elements, as no-break spaces.
        push_blanks(&mut elements, &text[..text.len() - after.len()]);
        if inner.is_empty() {
            continue;
        }
        let below = match face {
            Face::Upright | Face::Italic => 0.0,
            Face::Index => 0.25 * size,
            Face::Exponent => -0.42 * size,
        };
        let looks = match face {
            Face::Upright => String::new(),
            Face::Italic => " font-style=\"italic\"".to_owned(),
            Face::Index | Face::Exponent => format!(" font-size=\"{}\"", px(SMALL * size)),
        };
        let step = match px(below - shift).as_str() {
            "0" => String::new(),
            step => format!(" dy=\"{step}\""),
        };
        shift = below;
        let shown = escaped(inner);
        if step.is_empty() && looks.is_empty() {
            elements.push_str(&shown);
        } else {
            elements.push_str(&format!("<tspan{step}{looks}>{shown}</tspan>"));
        }
        push_blanks(&mut elements, &after[inner.len()..]);
    }
    elements
}

fn is_blank(character: char) -> bool {
    matches!(character, ' ' | '\u{a0}')
}

/// Appends a no-break space for each blank.
fn push_blanks(elements: &mut String, blanks: &str) {
    elements.extend(blanks.chars().map(|_| '\u{a0}'));
}

fn points(places: &[Place]) -> String {
    let texts: Vec<String> = places
        .iter()
        .map(|(x, y)| format!("{},{}", px(*x), px(*y)))
        .collect();
    texts.join(" ")
}

/// Writes a length in px, rounded to a hundredth.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Escapes text for XML. Characters that are not allowed in XML become U+FFFD.
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
        let label = Label::symbol("F_a,max")
            .then(" < ")
            .join(&Label::power_of_ten(-3));
        assert_eq!(
            runs(&label, 10.0),
            "<tspan font-style=\"italic\">F</tspan><tspan dy=\"2.5\" font-size=\"7.2\">a,max</tspan>\
             \u{a0}<tspan dy=\"-2.5\">&lt; 10</tspan><tspan dy=\"-4.2\" font-size=\"7.2\">−3</tspan>"
        );
    }

    #[test]
    fn lengths_are_short() {
        assert_eq!(
            [0.0, -0.001, 1.0, 2.345, -12.5, 120.0].map(px),
            ["0", "0", "1", "2.35", "-12.5", "120"]
        );
        assert_eq!(
            escaped("a<&>\"\u{1}\u{ffff}é"),
            "a&lt;&amp;&gt;&quot;\u{fffd}\u{fffd}é"
        );
    }
}
