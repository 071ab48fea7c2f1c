//! Figures of sweeps: maps and sections, as pictures in SVG and as text for a terminal.
//!
//! The same results give the same bytes.

mod canvas;
mod contour;
mod frame;
mod label;
mod legend;
mod map;
mod section;
mod shades;
mod text;
mod text_map;
mod text_section;
mod ticks;

pub use text::{Colours, figure_text};

use crate::study::figure::Figure;
use canvas::{Anchor, Canvas, Place, picture};
use frame::LABEL;

/// Size of the rectangle of a panel, px.
const PANEL: (f64, f64) = (330.0, 270.0);
/// Room on the left and below a panel for its axes; more on the left where numbers are long.
const AXES: (f64, f64) = (78.0, 50.0);
/// Room on the right of a map for its scale of colours, as far as numbers are not long, and of a section.
const SCALE: f64 = 104.0;
const BESIDE: f64 = 22.0;
/// Least distance of words from the border, px.
const MARGIN: f64 = 6.0;
/// Size of the title, px.
const TITLE: f64 = 14.5;

/// A figure as SVG.
#[must_use]
pub fn figure_svg(figure: &Figure) -> String {
    let (before, beside) = rooms(figure);
    let wide = before + PANEL.0 + beside;
    let draw_legend = if figure.up.is_some() { map::legend } else { section::legend };
    let legend = draw_legend(None, figure, (0.0, 0.0));
    let panels = figure.panels.len().max(1);
    let width = (panels as f64 * wide).max(legend + 40.0);
    let title = wrapped(&label::foreign(&figure.title), TITLE, width - 24.0);
    let fixed = wrapped(&label::foreign(&figure.fixed.join(", ")), LABEL - 1.0, width - 24.0);
    let letters = if panels > 1 { 22.0 } else { 6.0 };
    let top = 12.0 + title.len() as f64 * 20.0 + fixed.len() as f64 * 18.0 + letters;
    let bottom = top + PANEL.1 + AXES.1;
    let height = bottom + if legend > 0.0 { 30.0 } else { 6.0 };
    let middle = width / 2.0;
    picture(width, height, |canvas| {
        let mut y = 20.0;
        for line in &title {
            canvas.text(line, (middle, y), TITLE, Anchor::Middle);
            y += 20.0;
        }
        for line in &fixed {
            canvas.text(&label::symbol_before(line), (middle, y - 1.0), LABEL - 1.0, Anchor::Middle);
            y += 18.0;
        }
        let left = (width - panels as f64 * wide) / 2.0 + before;
        for (index, panel) in figure.panels.iter().enumerate() {
            let from: Place = (left + index as f64 * wide, top);
            let to = (from.0 + PANEL.0, from.1 + PANEL.1);
            if panels > 1 {
                let letter = char::from(b'a' + (index % 26) as u8);
                let heading = format!("({letter}) {}", panel.quantity.name);
                canvas.text(&heading, (from.0, from.1 - 12.0), LABEL, Anchor::Left);
            }
            draw_panel(canvas, figure, panel, (from, to));
        }
        if legend > 0.0 {
            draw_legend(Some(canvas), figure, ((width - legend) / 2.0, bottom + 12.0));
        }
    })
}

/// Room on the left and on the right of a panel, the same for all.
fn rooms(figure: &Figure) -> (f64, f64) {
    let of_panels = figure.panels.iter().map(|panel| match &figure.up {
        Some(up) => map::rooms(up, panel),
        None => (section::room(figure, panel), 0.0),
    });
    let least = (AXES.0, if figure.up.is_some() { SCALE } else { BESIDE });
    of_panels.fold(least, |most, (left, right)| (most.0.max(left + MARGIN), most.1.max(right + MARGIN)))
}

fn draw_panel(
    canvas: &Canvas<'_>,
    figure: &Figure,
    panel: &crate::study::figure::Panel,
    place: (Place, Place),
) {
    match &figure.up {
        Some(up) => map::draw(canvas, figure, up, panel, place),
        None => section::draw(canvas, figure, panel, place),
    }
}

/// Lines of words that are no wider than this.
fn wrapped(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if (label::width(line) + label::width(word) + 0.33) * size <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod examples;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::figure::Estimate;

    /// The numbers of an attribute of all elements of a kind.
    fn elements<'a>(svg: &'a str, tag: &'a str) -> impl Iterator<Item = &'a str> {
        svg.split('<')
            .filter(move |element| element.strip_prefix(tag).is_some_and(|rest| rest.starts_with(' ')))
    }

    fn attribute(element: &str, name: &str) -> f64 {
        let value = element.split_once(&format!(" {name}=\"")).and_then(|(_, rest)| rest.split('"').next());
        value.and_then(|value| value.parse().ok()).unwrap_or(f64::NAN)
    }

    #[test]
    fn the_same_figure_has_the_same_bytes_and_says_what_it_shows() {
        for (figure, words) in [
            (examples::phase_map(), vec!["pressure-sensitive", "non-adhesive", "no value", "Hurst exponent"]),
            (examples::sections(), vec!["95 % confidence of the mean", "mean", "governing parameter"]),
        ] {
            let svg = figure_svg(&figure);
            assert_eq!(svg, figure_svg(&figure));
            for word in words {
                assert!(svg.contains(word), "{word}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "no number is lost");
            assert!(!svg.chars().any(|c| ('\u{e000}'..'\u{f8ff}').contains(&c)), "all is typeset");
            assert_eq!(svg.matches("<tspan").count(), svg.matches("</tspan>").count());
            assert!(svg.trim_end().ends_with("</svg>"));
        }
    }

    #[test]
    fn a_foreign_title_neither_breaks_the_picture_nor_controls_the_terminal() {
        let mut figure = examples::phase_map();
        figure.title = "\u{1b}]52;c;eA==\u{7}<&> \u{e000}\u{e004} \u{ffff} a\u{202e}b \u{9b}2J".into();
        let svg = figure_svg(&figure);
        let allowed =
            |c: char| c == '\n' || !(crate::text::is_control(c) || ('\u{e000}'..='\u{f8ff}').contains(&c));
        assert!(svg.chars().all(|c| allowed(c) && c != '\u{ffff}'), "{svg}");
        assert_eq!(svg.matches("<tspan").count(), svg.matches("</tspan>").count());
        assert!(svg.contains("]52;c;eA==") && svg.contains("&lt;&amp;&gt;"), "{svg}");
        let text = figure_text(&figure, 80, Colours::None);
        assert!(text.chars().all(|c| c == '\n' || !crate::text::is_control(c)), "{text}");
    }

    #[test]
    fn each_cell_with_a_value_is_coloured_and_the_others_are_not() {
        let figure = examples::phase_map();
        let svg = figure_svg(&figure);
        let there: usize = figure.panels.iter().map(|panel| panel.estimates.iter().flatten().count()).sum();
        let rectangles = elements(&svg, "rect").count();
        // The paper, the cells, and a scale of colours of 128 stripes beside each panel.
        assert_eq!(rectangles, 1 + there + figure.panels.len() * 128);
        assert!(there < figure.panels.iter().map(|panel| panel.estimates.len()).sum());
    }

    #[test]
    fn words_lie_within_the_picture_and_not_on_each_other() {
        let mut large = examples::phase_map();
        large.title = "A title that is a good deal longer than the figure is wide ".repeat(4);
        // Numbers with many digits, in which alone they differ.
        let mut long = [examples::phase_map(), examples::sections()];
        for estimate in long.iter_mut().flat_map(|figure| figure.panels[0].estimates.iter_mut().flatten()) {
            *estimate = Estimate { mean: 1e5 + estimate.mean, low: 1e5, high: 1e5 + 1.0 };
        }
        let [long_map, long_sections] = long;
        for figure in [large, examples::sections(), examples::phase_map(), long_map, long_sections] {
            let svg = figure_svg(&figure);
            let paper = elements(&svg, "rect").next().unwrap_or_default();
            let size = (attribute(paper, "width"), attribute(paper, "height"));
            let mut boxes: Vec<(f64, f64, f64, f64)> = Vec::new();
            for (element, rest) in svg.split("<text").skip(1).map(|rest| rest.split_once('>').unwrap()) {
                let words: String = rest.split("</text>").next().unwrap_or_default().into();
                let plain: String =
                    words.split('<').map(|part| part.rsplit('>').next().unwrap_or("")).collect();
                let plain = plain.replace("&#8203;", "");
                let (x, y) = (attribute(element, "x"), attribute(element, "y"));
                let height = attribute(element, "font-size");
                let width = 0.9 * label::width(plain.trim()) * height;
                let left = match () {
                    () if element.contains("\"middle\"") => x - width / 2.0,
                    () if element.contains("\"end\"") => x - width,
                    () => x,
                };
                let half = 0.4 * height;
                let place = if element.contains("rotate") {
                    (x - half, y - width / 2.0, x + half, y + width / 2.0)
                } else {
                    (left, y - half, left + width, y + half)
                };
                assert!(
                    place.0 > 0.0 && place.1 > 0.0 && place.2 < size.0 && place.3 < size.1,
                    "{plain}: {place:?} {size:?}"
                );
                let over = |other: &&(f64, f64, f64, f64)| {
                    place.0 < other.2 && other.0 < place.2 && place.1 < other.3 && other.1 < place.3
                };
                assert_eq!(boxes.iter().find(over), None, "{plain}: {place:?}");
                boxes.push(place);
            }
            assert!(boxes.len() > 20);
        }
    }

    #[test]
    fn each_protocol_vanishes_at_its_own_place() {
        let mut figure = examples::sections();
        let own = figure.crossings(&figure.panels[0]);
        assert_eq!(own.len(), 1, "{own:?}");
        // What is no share of F_a(0) shows where that vanishes.
        assert_eq!(figure.crossings(&figure.panels[1]), own);
        let shares = figure.panels[0].estimates.clone();
        let twice = |estimate: Option<Estimate>| {
            estimate.map(|estimate| Estimate { mean: 2.0 * estimate.mean, ..estimate })
        };
        figure.panels[1].estimates = shares.into_iter().map(twice).collect();
        figure.panels[1].vanishes = true;
        let later = figure.crossings(&figure.panels[1]);
        assert!(later.len() == 1 && later[0] > own[0], "{later:?} {own:?}");
    }

    #[test]
    fn text_fits_its_columns_and_has_colours_only_where_it_may() {
        for figure in [examples::phase_map(), examples::sections()] {
            for columns in [40, 80, 200] {
                let text = figure_text(&figure, columns, Colours::None);
                let widest = text.lines().map(|line| line.chars().count()).max();
                assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
                assert!(!text.contains('\x1b'));
            }
        }
        let coloured = figure_text(&examples::phase_map(), 80, Colours::All);
        assert!(coloured.contains("\x1b[38;2;"));
    }

    #[test]
    fn figures_as_text_stay_as_they_are() {
        insta::assert_snapshot!("sweep_map", figure_text(&examples::phase_map(), 80, Colours::None));
        insta::assert_snapshot!("sweep_section", figure_text(&examples::sections(), 80, Colours::None));
    }

    #[test]
    fn what_has_one_value_or_none_is_drawn() {
        for mut figure in [examples::phase_map(), examples::sections()] {
            figure.panels.iter_mut().for_each(|panel| panel.estimates.fill(None));
            assert!(figure_svg(&figure).contains("</svg>") && !figure_svg(&figure).contains("NaN"));
            assert!(!figure_text(&figure, 80, Colours::None).is_empty());
            figure.across.values.truncate(1);
            figure.boundary = None;
            figure.regimes.clear();
            for value in [0.0, -2.0, 1e-300] {
                for scale in
                    [crate::study::figure::AxisScale::Linear, crate::study::figure::AxisScale::Logarithmic]
                {
                    for panel in &mut figure.panels {
                        let estimate =
                            crate::study::figure::Estimate { mean: value, low: value, high: value };
                        panel.estimates =
                            vec![Some(estimate); figure.up.as_ref().map_or(1, |up| up.values.len())];
                        panel.scale = scale;
                    }
                    let svg = figure_svg(&figure);
                    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{value} {scale:?}");
                    assert!(!figure_text(&figure, 80, Colours::None).contains("NaN"));
                }
            }
        }
    }
}
