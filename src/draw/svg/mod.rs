//! Figures as SVG documents. Equal figures have equal bytes.

mod elements;
mod frame;
mod layers;
mod legend;

pub(crate) use elements::{Svg, escaped};
#[cfg(test)]
pub(crate) use tests::{attribute, elements, parsed};

use super::axis::Axes;
use super::chart::{Chart, Figure, HeatMap};
use super::colour::{Rgb, Shades, hex};
use super::label::Label;
use elements::{Anchor, PAPER, Pen, Place, QUIET, TEXT};
use frame::{Frame, LABEL, Side};
use legend::Legend;

/// Fonts of figures, with nearly the same letters on all systems.
const FONTS: &str = "font-family=\"Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif\"";
/// Least room on the left of a chart and below it for the axes, and on the right of a chart, px.
const AXES: (f64, f64) = (78.0, 50.0);
const BESIDE: f64 = 22.0;
/// Distance of the colour scale from its map, and its width, px.
const FROM_MAP: f64 = 14.0;
const BAR: f64 = 13.0;
/// Least distance of text from the border, px.
const MARGIN: f64 = 6.0;
/// Size of the title, px.
const TITLE: f64 = 14.5;

impl Figure {
    pub fn svg(&self) -> String {
        let page = Page::new(self);
        let mut svg = Svg::new(page.width, page.height, &Label::plain(&self.title).to_string());
        definitions(&mut svg, &self.charts);
        svg.group(FONTS, |svg| page.draw(svg));
        svg.finish()
    }
}

/// Defines the shades and the hatching of maps.
fn definitions(svg: &mut Svg, charts: &[Chart]) {
    let maps = || charts.iter().filter_map(Chart::map);
    for shades in [Shades::Sequential, Shades::Diverging] {
        if maps().any(|map| map.shades == shades) {
            let colours = shades.colours();
            let last = (colours.len() - 1) as f64;
            let stop = |(index, colour): (usize, &Rgb)| {
                format!("<stop offset=\"{}\" stop-color=\"{}\"/>", index as f64 / last, hex(*colour))
            };
            let stops: String = colours.iter().enumerate().map(stop).collect();
            svg.push(format_args!(
                "<linearGradient id=\"{shades}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">{stops}</linearGradient>"
            ));
        }
    }
    if maps().any(|map| map.values.contains(&None)) {
        let quiet = hex(QUIET);
        svg.push(format_args!(
            "<pattern id=\"hatched\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">\
             <path d=\"M-1 1L1 -1M0 6L6 0M5 7L7 5\" stroke=\"{quiet}\" stroke-width=\"0.8\"/></pattern>"
        ));
    }
}

/// A figure with the places of its parts, px.
struct Page<'a> {
    figure: &'a Figure,
    legend: Legend,
    title: Vec<Label>,
    notes: Vec<Label>,
    width: f64,
    height: f64,
    /// Room on the left and on the right of each chart.
    rooms: Vec<(f64, f64)>,
    /// Upper and lower ends of the charts, including the axes below.
    top: f64,
    bottom: f64,
}

impl<'a> Page<'a> {
    fn new(figure: &'a Figure) -> Page<'a> {
        let rooms: Vec<(f64, f64)> = figure.charts.iter().map(|chart| rooms(chart, figure.size)).collect();
        let charts = charts_width(&rooms, figure.size.0);
        let legend = Legend::new(figure.legend(), charts - 40.0);
        let width = charts.max(legend.width() + 40.0);
        let title = Label::plain(&figure.title).wrapped((width - 24.0) / TITLE);
        let notes: Vec<Label> =
            figure.notes.iter().flat_map(|note| note.wrapped((width - 24.0) / (LABEL - 1.0))).collect();
        let headings = if figure.charts.len() > 1 { 22.0 } else { 6.0 };
        let top = 12.0 + title.len() as f64 * 20.0 + notes.len() as f64 * 18.0 + headings;
        let bottom = top + figure.size.1 + AXES.1;
        let height = bottom + if legend.height() > 0.0 { legend.height() + 10.0 } else { 6.0 };
        Page { figure, legend, title, notes, width, height, rooms, top, bottom }
    }

    fn draw(&self, svg: &mut Svg) {
        let Page { figure, width, height, .. } = *self;
        let middle = width / 2.0;
        svg.rectangle((0.0, 0.0), (width, height), PAPER);
        let mut y = 20.0;
        for line in &self.title {
            svg.label(line, (middle, y), TITLE, Anchor::Middle, TEXT);
            y += 20.0;
        }
        for line in &self.notes {
            svg.label(line, (middle, y - 1.0), LABEL - 1.0, Anchor::Middle, TEXT);
            y += 18.0;
        }
        let mut left = (width - charts_width(&self.rooms, figure.size.0)) / 2.0;
        for (index, (chart, (before, beside))) in figure.charts.iter().zip(&self.rooms).enumerate() {
            left += before;
            if let Some(heading) = figure.heading(index) {
                svg.label(&heading, (left, self.top - 12.0), LABEL, Anchor::Left, TEXT);
            }
            draw_chart(svg, chart, (left, self.top), figure.size);
            left += figure.size.0 + beside;
        }
        self.legend.draw(svg, middle, self.bottom + 12.0);
    }
}

/// Width of charts with frames of this width, px.
fn charts_width(rooms: &[(f64, f64)], frame: f64) -> f64 {
    rooms.iter().map(|(before, beside)| before + frame + beside).sum()
}

fn frame_of(chart: &Chart, from: Place, size: (f64, f64)) -> Frame<'_> {
    Frame { from, to: (from.0 + size.0, from.1 + size.1), axes: Axes { x: &chart.x, y: &chart.y } }
}

/// The frame of the colour scale on the right of a map.
fn frame_of_colours<'a>(map: &'a HeatMap, chart: Frame<'a>) -> Frame<'a> {
    let left = chart.to.0 + FROM_MAP;
    let axes = Axes { y: &map.key, ..chart.axes };
    Frame { from: (left, chart.from.1), to: (left + BAR, chart.to.1), axes }
}

/// Room on the left and on the right of a chart.
fn rooms(chart: &Chart, size: (f64, f64)) -> (f64, f64) {
    let frame = frame_of(chart, (0.0, 0.0), size);
    let scale = chart
        .map()
        .map_or(0.0, |map| FROM_MAP + BAR + frame_of_colours(map, frame).room(Side::Right) + MARGIN);
    (AXES.0.max(frame.room(Side::Left) + MARGIN), BESIDE.max(scale))
}

fn draw_chart(svg: &mut Svg, chart: &Chart, from: Place, size: (f64, f64)) {
    let frame = frame_of(chart, from, size);
    layers::draw(svg, &frame, &chart.layers);
    svg.frame(frame.from, frame.to, Pen::solid(TEXT, 1.0));
    frame.axis(svg, Side::Below);
    frame.axis(svg, Side::Left);
    if let Some(map) = chart.map() {
        let scale = frame_of_colours(map, frame);
        svg.rect(scale.from, scale.to, &format!("fill=\"url(#{})\"", map.shades));
        svg.frame(scale.from, scale.to, Pen::solid(TEXT, 1.0));
        scale.axis(svg, Side::Right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::chart::{Layer, Shape, Sign, Stroke};
    use crate::draw::colour::Ink;
    use crate::draw::{Axis, AxisScale, Span};
    use roxmltree::Document;

    /// Tags of a document with their attributes, and its text. Panics if the document is not well-formed.
    pub(crate) fn parsed(svg: &str) -> (Vec<String>, String) {
        let document = Document::parse(svg).unwrap();
        let tag = |element: roxmltree::Node<'_, '_>| {
            let tag = svg[element.range()].split('>').next().unwrap_or_default();
            tag.trim_start_matches('<').trim_end_matches('/').to_owned()
        };
        let elements = document.descendants().filter(roxmltree::Node::is_element).map(tag).collect();
        let text = document.descendants().filter(roxmltree::Node::is_text).filter_map(|node| node.text());
        (elements, text.collect())
    }

    /// Elements of a kind.
    pub(crate) fn elements(svg: &str, tag: &str) -> Vec<String> {
        let is_kind = |element: &String| element.split(' ').next() == Some(tag);
        parsed(svg).0.into_iter().filter(is_kind).collect()
    }

    /// Number in an attribute.
    pub(crate) fn attribute(element: &str, name: &str) -> f64 {
        let value = element.split_once(&format!(" {name}=\"")).and_then(|(_, rest)| rest.split('"').next());
        value.and_then(|value| value.parse().ok()).unwrap_or(f64::NAN)
    }

    fn axis(scale: AxisScale, low: f64, high: f64, symbol: &str, unit: &str) -> Axis {
        Axis::new(scale, Span { low, high }, "", symbol, unit)
    }

    /// A chart over d from 0 to 10 nm and F from 1 µN to 1 mN.
    fn small(layers: Vec<Layer>) -> Figure {
        let (d, force) = (
            axis(AxisScale::Linear, 0.0, 1e-8, "d", "m"),
            axis(AxisScale::Logarithmic, -6.0, -3.0, "F_n", "N"),
        );
        let chart = Chart::new(d, force, layers);
        Figure { size: (400.0, 300.0), ..Figure::of_chart("a < b & \u{1b}", chart) }
    }

    fn curve(points: &[(f64, f64)], ink: Ink, name: &str) -> Layer {
        let (stroke, sign) = (Some(Stroke::Dashed), Some(Sign::Dot));
        Layer::new(Label::symbol(name), ink, Shape::Curve { points: points.to_vec(), stroke, sign })
    }

    #[test]
    fn points_and_ticks_lie_where_the_axes_say() {
        let points = [(0.0, 1e-6), (2.5e-9, 1e-5), (5e-9, f64::NAN), (1e-8, 1e-3), (7.5e-9, 0.0)];
        let svg = small(vec![curve(&points, Ink::Series(0), "F_n")]).svg();
        let frame = elements(&svg, "rect").into_iter().find(|rect| rect.contains("fill=\"none\"")).unwrap();
        let corner = (attribute(&frame, "x"), attribute(&frame, "y"));
        assert_eq!((attribute(&frame, "width"), attribute(&frame, "height")), (400.0, 300.0));
        let circles = elements(&svg, "circle");
        // One for each point with coordinates, and one in the legend.
        assert_eq!(circles.len(), 4);
        for (circle, (across, up)) in circles.iter().zip([(0.0, 0.0), (0.25, 1.0 / 3.0), (1.0, 1.0)]) {
            let place = (corner.0 + 400.0 * across, corner.1 + 300.0 * (1.0 - up));
            let off = (attribute(circle, "cx") - place.0, attribute(circle, "cy") - place.1);
            assert!(off.0.abs() <= 0.005 && off.1.abs() <= 0.005, "{circle} {place:?}");
        }
        // Ticks below: labels at 0, 2, … 10 nm.
        let below = corner.1 + 300.0;
        for (number, share) in [("0", 0.0), ("2", 0.2), ("10", 1.0)] {
            let x = corner.0 + 400.0 * share;
            let text = elements(&svg, "text")
                .into_iter()
                .find(|text| (attribute(text, "x") - x).abs() < 0.01 && attribute(text, "y") > below);
            let text = text.unwrap_or_else(|| panic!("no number at {x}"));
            assert!(svg.contains(&format!("<{text}>{number}<")), "{text}");
        }
        let words = parsed(&svg).1;
        assert!(words.contains("d (nm)") && words.contains("Fn (mN)"), "{words}");
        assert!(words.contains("a < b & \\u{1b}"), "{words}");
        assert_eq!(svg, small(vec![curve(&points, Ink::Series(0), "F_n")]).svg());
    }

    #[test]
    fn the_legend_shows_what_is_drawn() {
        let band = |ink| {
            let points = vec![(1e-9, 1e-5, 1e-4), (9e-9, 0.0, 1e-2)];
            Layer::new("confidence".into(), ink, Shape::Band(points))
        };
        let points = [(1e-9, 5e-5), (9e-9, 5e-5)];
        let inks = [Ink::Series(1), Ink::Series(3)];
        let figure = small(vec![
            band(inks[0]),
            curve(&points, inks[0], "F_n"),
            band(inks[1]),
            curve(&points, inks[1], "G"),
            Layer::unnamed(Ink::Quiet, Shape::Level(1e-4)),
        ]);
        let names: Vec<String> = figure.legend().iter().map(|entry| entry.name.to_string()).collect();
        assert_eq!(names, ["F_n", "G", "confidence"]);
        let svg = figure.svg();
        let looks = |element: &String| element.split_once("fill=").unwrap().1.to_owned();
        let areas: Vec<String> = elements(&svg, "polygon").iter().map(looks).collect();
        // Both bands, and a sample of each in the legend, of the same appearance.
        assert_eq!(areas.len(), 4);
        assert_eq!(areas[..2], areas[2..]);
        for ink in inks {
            let colour = hex(ink.on_paper());
            let lines = elements(&svg, "polyline").into_iter().filter(|line| line.contains(&colour));
            let dashes = lines.filter(|line| line.contains("stroke-dasharray")).count();
            assert_eq!(dashes, 2, "a line and its sample");
        }
        // The end without a logarithm is at the bottom.
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert!(small(Vec::new()).svg().len() < svg.len());
    }

    #[test]
    fn a_small_figure_is_drawn_like_this() {
        let figure = small(vec![
            Layer::new(
                "inside".into(),
                Ink::Quiet,
                Shape::Inside(vec![(2e-9, 1e-5), (8e-9, 1e-5), (8e-9, 1e-4)]),
            ),
            Layer::new("zero".into(), Ink::Quiet, Shape::Upright(5e-9)),
            Layer::new(
                "profile".into(),
                Ink::Profile,
                Shape::Envelope {
                    x: (0.0, 1e-8),
                    columns: vec![Some((1e-5, 2e-5)), Some((3e-5, 4e-5)), None, Some((1e-4, 1e-4))],
                },
            ),
            curve(&[(1e-9, 1e-5), (2e-9, 1e-4)], Ink::Loading, "F_n"),
        ]);
        insta::assert_snapshot!(figure.svg());
    }
}
