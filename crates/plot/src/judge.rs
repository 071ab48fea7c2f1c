//! Checks of drawn pictures for tests: their elements, and properties of every figure.

use super::label::Label;
use roxmltree::Document;

/// Returns the tags of an SVG document, each as its name with its attributes, and the whole text of
/// the document. Panics if the document is not well-formed.
pub fn parsed(svg: &str) -> (Vec<String>, String) {
    let document = Document::parse(svg).unwrap();
    let tag = |element: roxmltree::Node<'_, '_>| {
        let tag = svg[element.range()].split('>').next().unwrap_or_default();
        tag.trim_start_matches('<').trim_end_matches('/').to_owned()
    };
    let elements = document
        .descendants()
        .filter(roxmltree::Node::is_element)
        .map(tag)
        .collect();
    let text = document
        .descendants()
        .filter(roxmltree::Node::is_text)
        .filter_map(|node| node.text());
    (elements, text.collect())
}

/// Returns the elements of an SVG document whose tag has this name, such as `rect`, each with its
/// attributes.
pub fn elements(svg: &str, tag: &str) -> Vec<String> {
    let is_kind = |element: &String| element.split(' ').next() == Some(tag);
    parsed(svg).0.into_iter().filter(is_kind).collect()
}

/// Asserts that all numbers of an SVG document are finite, and that its texts lie within the
/// picture and do not overlap.
pub fn check_picture(svg: &str) {
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    let paper = &elements(svg, "rect")[0];
    let size = (attribute(paper, "width"), attribute(paper, "height"));
    let mut boxes: Vec<[f64; 4]> = Vec::new();
    for (element, rest) in svg
        .split("<text")
        .skip(1)
        .map(|rest| rest.split_once('>').unwrap())
    {
        let words = rest.split("</text>").next().unwrap_or_default();
        let plain: String = words
            .split('<')
            .map(|part| part.rsplit('>').next().unwrap_or(""))
            .collect();
        let plain = plain
            .replace("&lt;", "<")
            .replace("&gt;", ">")
            .replace("&quot;", "\"")
            .replace("&amp;", "&");
        let [x, y, height] = ["x", "y", "font-size"].map(|name| attribute(element, name));
        let width = 0.9 * Label::plain(plain.trim()).width() * height;
        let left = match () {
            () if element.contains("\"middle\"") => x - width / 2.0,
            () if element.contains("\"end\"") => x - width,
            () => x,
        };
        let (middle, half) = (y - 0.35 * height, 0.4 * height);
        let place = match element.contains("rotate") {
            true => [
                x - half,
                middle - width / 2.0,
                x + half,
                middle + width / 2.0,
            ],
            false => [left, middle - half, left + width, middle + half],
        };
        let is_inside = place[0] > 0.0 && place[1] > 0.0 && place[2] < size.0 && place[3] < size.1;
        assert!(is_inside, "{plain}: {place:?} {size:?}");
        let is_over = |other: &&[f64; 4]| {
            place[0] < other[2] && other[0] < place[2] && place[1] < other[3] && other[1] < place[3]
        };
        assert_eq!(boxes.iter().find(is_over), None, "{plain}: {place:?}");
        boxes.push(place);
    }
}

/// Returns the value of the attribute `name` of an SVG element as a number. `element` is one of the
/// texts that [`elements`] returns. Returns NaN if the attribute is missing or is not a number.
pub fn attribute(element: &str, name: &str) -> f64 {
    let value = element
        .split_once(&format!(" {name}=\""))
        .and_then(|(_, rest)| rest.split('"').next());
    value
        .and_then(|value| value.parse().ok())
        .unwrap_or(f64::NAN)
}
