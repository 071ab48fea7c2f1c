//! Checks of drawn pictures for tests. There are functions that list the elements of a picture, and
//! checks of properties that every figure must have.

use super::label::Label;
use roxmltree::Document;

/// Returns the tags of an SVG document, and the text of the document without tags. Each tag is a
/// text with the name and the attributes of an element. Panics if the document is not well-formed.
pub fn parsed(svg: &str) -> (Vec<String>, String) {
    let document = Document::parse(svg).unwrap();
    let mut elements = Vec::new();
    let mut text = String::new();
    for node in document.descendants() {
        if node.is_element() {
            let tag = svg[node.range()].split('>').next().unwrap_or_default();
            let tag = tag.trim_start_matches('<').trim_end_matches('/');
            elements.push(tag.to_owned());
        } else if node.is_text() {
            text += node.text().unwrap_or_default();
        }
    }
    (elements, text)
}

/// Returns the elements of an SVG document that have the name `tag`, such as `rect`. Each element
/// is a text with its name and its attributes.
pub fn elements(svg: &str, tag: &str) -> Vec<String> {
    let (mut elements, _) = parsed(svg);
    elements.retain(|element| element.split(' ').next() == Some(tag));
    elements
}

/// Asserts that all numbers in an SVG document are finite, that its texts lie within the picture,
/// and that no two texts overlap.
pub fn check_picture(svg: &str) {
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    let paper = &elements(svg, "rect")[0];
    let width = attribute(paper, "width");
    let height = attribute(paper, "height");
    let mut boxes: Vec<TextBox> = Vec::new();
    for text in svg.split("<text").skip(1) {
        let (element, rest) = text.split_once('>').unwrap();
        let words = plain_words(rest.split("</text>").next().unwrap_or_default());
        let place = TextBox::new(element, &words);
        let is_inside =
            place.left > 0.0 && place.top > 0.0 && place.right < width && place.bottom < height;
        assert!(is_inside, "{words}: {place:?} {width} {height}");
        let other = boxes.iter().find(|other| place.overlaps(other));
        assert_eq!(other, None, "{words}: {place:?}");
        boxes.push(place);
    }
}

/// Returns the text inside a text element, without tags.
fn plain_words(elements: &str) -> String {
    let words: String = elements
        .split('<')
        .map(|part| part.rsplit('>').next().unwrap_or(""))
        .collect();
    words
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&amp;", "&")
}

/// Approximate rectangle around a text, in px from the upper left corner of the picture.
#[derive(Debug, PartialEq)]
struct TextBox {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl TextBox {
    fn new(element: &str, words: &str) -> TextBox {
        let x = attribute(element, "x");
        let size = attribute(element, "font-size");
        let middle = attribute(element, "y") - 0.35 * size;
        let width = 0.9 * Label::plain(words.trim()).width() * size;
        let half = 0.4 * size;
        if element.contains("rotate") {
            return TextBox {
                left: x - half,
                top: middle - width / 2.0,
                right: x + half,
                bottom: middle + width / 2.0,
            };
        }
        let left = if element.contains("\"middle\"") {
            x - width / 2.0
        } else if element.contains("\"end\"") {
            x - width
        } else {
            x
        };
        TextBox {
            left,
            top: middle - half,
            right: left + width,
            bottom: middle + half,
        }
    }

    fn overlaps(&self, other: &TextBox) -> bool {
        let overlaps_across = self.left < other.right && other.left < self.right;
        let overlaps_down = self.top < other.bottom && other.top < self.bottom;
        overlaps_across && overlaps_down
    }
}

/// Returns the number in the attribute `name` of an SVG element. `element` is a text with the name
/// and the attributes of the element, as [`elements`] returns it. Returns NaN if the attribute is
/// missing or is not a number.
pub fn attribute(element: &str, name: &str) -> f64 {
    let Some((_, rest)) = element.split_once(&format!(" {name}=\"")) else {
        return f64::NAN;
    };
    let value = rest.split('"').next().unwrap_or_default();
    value.parse().unwrap_or(f64::NAN)
}
