//! Figures as SVG documents. Equal figures have equal bytes.

pub(crate) mod elements;
pub(crate) mod frame;
pub(crate) mod layers;
pub(crate) mod legend;

use super::axis::Axes;
use super::chart::{Chart, Figure, HeatMap};
use super::colour::Shades;
use super::label::Label;
use elements::{Anchor, PAPER, Pen, Place, TEXT};
use elements::{Svg, escaped};
use frame::{Frame, LABEL, Side};

/// Fonts of figures, whose letters are nearly the same on all systems.
const FONTS: &str = "font-family=\"Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif\"";
/// Room below a chart for its axis, and smallest room on its right, px.
const BELOW: f64 = 50.0;
const BESIDE: f64 = 22.0;
/// Distance of the colour scale from its map, and width of the scale, px.
const FROM_MAP: f64 = 14.0;
const BAR: f64 = 13.0;
/// Smallest distance of text from the border, px.
const MARGIN: f64 = 6.0;
/// Font sizes of the title and of the text below title and legend, px.
const TITLE: f64 = 14.5;
const TEXT_SIZE: f64 = LABEL - 1.0;
/// Smallest width in px of frames side by side in a figure with a given width, and largest width of
/// any other figure with several charts.
const LEAST: f64 = 110.0;
const WIDEST: f64 = 1400.0;
/// Width in px up to which a frame is at least as high as it is wide.
const SQUARE: f64 = 150.0;
/// Largest ratio of height to width for frames below each other.
const LOW: f64 = 0.62;
/// Largest height in px of a figure with a given width, which is 240 mm, and smallest height of a
/// frame.
const PAGE: f64 = 907.0;
const LOWEST: f64 = 60.0;
/// Height of a name on an axis, px.
const NAME: f64 = 14.0;

/// Size of a figure and its frames.
struct Layout {
    /// Width of the picture, px.
    width: f64,
    /// Size of the frames, px.
    size: (f64, f64),
    /// Room on the left and on the right of each column of charts, px.
    rooms: Vec<(f64, f64)>,
}

impl Figure {
    /// Draws the figure and returns an SVG document. Equal figures give documents of equal bytes.
    pub fn svg(&self) -> String {
        let mut layout = self.columns();
        let (mut svg, mut height) = self.drawn(&layout);
        let most = self.height.or(self.width.map(|_| PAGE));
        // Besides the frames all has the same height.
        if let Some(most) = most.filter(|most| self.height.is_some() || height > *most) {
            let rows = self.charts.len().div_ceil(layout.rooms.len()).max(1) as f64;
            layout.size.1 = (layout.size.1 - (height - most) / rows).max(LOWEST);
            (svg, height) = self.drawn(&layout);
        }
        let width = layout.width;
        let mut document = Svg::new(width, height, &Label::plain(&self.title).to_string());
        if !self.origin.is_empty() {
            let lines: Vec<String> = self.origin.lines().map(escaped).collect();
            document.push(format_args!("<metadata>{}</metadata>", lines.join("\n")));
        }
        document.rectangle((0.0, 0.0), (width, height), PAPER);
        document.group(FONTS, |document| document.append(svg));
        document.finish()
    }

    /// Draws all elements. Returns them with the height of the picture.
    fn drawn(&self, Layout { width, size, rooms }: &Layout) -> (Svg, f64) {
        let mut svg = Svg::default();
        let middle = width / 2.0;
        let wrapped = |label: &Label, size: f64| label.wrapped((width - 4.0 * MARGIN) / size);
        let title = if self.untitled {
            Vec::new()
        } else {
            wrapped(&Label::plain(&self.title), TITLE)
        };
        let first = if title.is_empty() && self.notes.is_empty() {
            10.0
        } else {
            20.0
        };
        let mut y = svg.lines(&title, (middle, first), TITLE, Anchor::Middle);
        for note in &self.notes {
            y = svg.lines(
                &wrapped(note, TEXT_SIZE),
                (middle, y),
                TEXT_SIZE,
                Anchor::Middle,
            );
        }
        for (row, charts) in self.charts.chunks(rooms.len()).enumerate() {
            y = self.draw_row(&mut svg, row * rooms.len(), charts, (*size, rooms, y));
        }
        y = legend::draw(
            &mut svg,
            &self.legend(),
            (middle, y + 2.0),
            width - 4.0 * MARGIN,
        ) + MARGIN;
        let parameters: Vec<Label> = self
            .parameters
            .iter()
            .flat_map(|line| wrapped(line, TEXT_SIZE))
            .collect();
        if !parameters.is_empty() {
            let left = 2.0 * MARGIN;
            let end = svg.lines(
                &parameters,
                (left, y + 2.0 * MARGIN),
                TEXT_SIZE,
                Anchor::Left,
            ) - MARGIN;
            svg.frame((MARGIN, y), (width - MARGIN, end), Pen::solid(TEXT, 0.8));
            y = end + MARGIN;
        }
        (svg, y)
    }

    /// Returns the layout of the charts in the fewest rows that fit the width.
    fn columns(&self) -> Layout {
        let count = self.charts.len().max(1);
        let rooms = |columns: usize, size| -> Vec<(f64, f64)> {
            let charts = |column| self.charts.iter().skip(column).step_by(columns);
            let wider =
                |one: (f64, f64), other: (f64, f64)| (one.0.max(other.0), one.1.max(other.1));
            let room = |column| {
                charts(column)
                    .map(|chart| rooms(chart, size))
                    .fold((0.0, 0.0), wider)
            };
            (0..columns).map(room).collect()
        };
        let within = |columns: usize| {
            let mut size = self.size;
            // The numbers at the ticks, and so the rooms, depend on the size.
            for width in self.width.into_iter().chain(self.width) {
                let across = (width - width_of(&rooms(columns, size), (0.0, 0.0))) / columns as f64;
                let across = across.max(MARGIN);
                let share =
                    (self.size.1 / self.size.0).min(if columns < count { LOW } else { 1.0 });
                size = (across, (across * share).max(across.min(SQUARE)));
            }
            // Each name on an axis has a line.
            let names = self
                .charts
                .iter()
                .map(|chart| chart.y.names.len())
                .max()
                .unwrap_or(0);
            size.1 = size.1.max(NAME * names as f64);
            let rooms = rooms(columns, size);
            Layout {
                width: self.width.unwrap_or_else(|| width_of(&rooms, size)),
                size,
                rooms,
            }
        };
        let fits = |layout: &Layout| match self.width {
            Some(_) => layout.size.0 >= LEAST,
            None => layout.width <= WIDEST,
        };
        let mut layouts = (1..count).map(|rows| within(count.div_ceil(rows)));
        layouts.find(fits).unwrap_or_else(|| within(1))
    }

    /// Draws charts side by side from the height `y` down. The first chart has the index `first`.
    /// Returns the height below the charts.
    fn draw_row(
        &self,
        svg: &mut Svg,
        first: usize,
        charts: &[Chart],
        (size, rooms, y): ((f64, f64), &[(f64, f64)], f64),
    ) -> f64 {
        let heading = |(index, (_, beside)): (usize, &(f64, f64))| {
            self.heading(index)
                .unwrap_or_default()
                .wrapped((size.0 + beside - MARGIN) / LABEL)
        };
        let headings: Vec<Vec<Label>> = (first..first + charts.len())
            .zip(rooms)
            .map(heading)
            .collect();
        let lines = headings.iter().map(Vec::len).max().unwrap_or(0);
        let top = y + 18.0 * lines as f64 - if lines > 0 { 0.0 } else { 2.0 };
        let mut left = 0.0;
        for ((chart, heading), (before, beside)) in charts.iter().zip(&headings).zip(rooms) {
            left += before;
            svg.lines(
                heading,
                (left, top - 18.0 * heading.len() as f64 + 6.0),
                LABEL,
                Anchor::Left,
            );
            draw_chart(svg, chart, (left, top), size);
            left += size.0 + beside;
        }
        top + size.1
            + BELOW
            + if self.charts.len() > first + charts.len() {
                2.0 * MARGIN
            } else {
                0.0
            }
    }
}

/// Returns the width in px of charts of one size side by side.
fn width_of(rooms: &[(f64, f64)], size: (f64, f64)) -> f64 {
    rooms
        .iter()
        .map(|(before, beside)| before + size.0 + beside)
        .sum()
}

fn frame_of(chart: &Chart, from: Place, size: (f64, f64)) -> Frame<'_> {
    Frame {
        from,
        to: (from.0 + size.0, from.1 + size.1),
        axes: Axes {
            x: &chart.x,
            y: &chart.y,
        },
    }
}

/// Returns the frame of the colour scale on the right of its map.
fn frame_of_colours<'a>(map: &'a HeatMap, chart: Frame<'a>) -> Frame<'a> {
    let left = chart.to.0 + FROM_MAP;
    let axes = Axes {
        y: &map.key,
        ..chart.axes
    };
    Frame {
        from: (left, chart.from.1),
        to: (left + BAR, chart.to.1),
        axes,
    }
}

fn rooms(chart: &Chart, size: (f64, f64)) -> (f64, f64) {
    let frame = frame_of(chart, (0.0, 0.0), size);
    let scale = chart.map().map_or(0.0, |map| {
        FROM_MAP + BAR + frame_of_colours(map, frame).room(Side::Right) + MARGIN
    });
    (frame.room(Side::Left) + MARGIN, BESIDE.max(scale))
}

fn draw_chart(svg: &mut Svg, chart: &Chart, from: Place, size: (f64, f64)) {
    let frame = frame_of(chart, from, size);
    layers::draw(svg, &frame, &chart.layers);
    svg.frame(frame.from, frame.to, Pen::solid(TEXT, 1.0));
    frame.axis(svg, Side::Below);
    frame.axis(svg, Side::Left);
    if let Some(map) = chart.map() {
        let scale = frame_of_colours(map, frame);
        for band in 0..Shades::BANDS {
            let [low, high] = [band, band + 1].map(|band| band as f64 / Shades::BANDS as f64);
            let corners = (scale.at((0.0, high)), scale.at((1.0, low)));
            svg.boxes(std::iter::once(corners), map.shades.of_band(band));
        }
        svg.frame(scale.from, scale.to, Pen::solid(TEXT, 1.0));
        scale.axis(svg, Side::Right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::ChartAxis;
    use crate::chart::{Layer, Shape, Sign, Stroke};
    use crate::colour::{Ink, hex};
    use crate::judge::{attribute, elements, parsed};
    use crate::scale::Span;
    use asperity_data::AxisScale;

    fn axis(scale: AxisScale, low: f64, high: f64, symbol: &str, unit: &str) -> ChartAxis {
        ChartAxis::new(scale, Span { low, high }, "", symbol, unit)
    }

    /// A chart over d from 0 to 10 nm and F from 1 µN to 1 mN.
    fn small(layers: Vec<Layer>) -> Figure {
        let (d, force) = (
            axis(AxisScale::Linear, 0.0, 1e-8, "d", "m"),
            axis(AxisScale::Logarithmic, -6.0, -3.0, "F_n", "N"),
        );
        let chart = Chart::new(d, force, layers);
        Figure {
            size: (400.0, 300.0),
            ..Figure::of_chart("a < b & \u{1b}", chart)
        }
    }

    fn curve(points: &[(f64, f64)], ink: Ink, name: &str) -> Layer {
        let (stroke, sign) = (Some(Stroke::Dashed), Some(Sign::Dot));
        Layer::new(
            Label::symbol(name),
            ink,
            Shape::Curve {
                points: points.to_vec(),
                stroke,
                sign,
            },
        )
    }

    #[test]
    fn points_and_ticks_lie_where_the_axes_say() {
        let points = [
            (0.0, 1e-6),
            (2.5e-9, 1e-5),
            (5e-9, f64::NAN),
            (1e-8, 1e-3),
            (7.5e-9, 0.0),
        ];
        let svg = small(vec![curve(&points, Ink::Series(0), "F_n")]).svg();
        let frame = elements(&svg, "rect")
            .into_iter()
            .find(|rect| rect.contains("fill=\"none\""))
            .unwrap();
        let corner = (attribute(&frame, "x"), attribute(&frame, "y"));
        assert_eq!(
            (attribute(&frame, "width"), attribute(&frame, "height")),
            (400.0, 300.0)
        );
        let circles = elements(&svg, "circle");
        // One for each point with coordinates, and one in the legend.
        assert_eq!(circles.len(), 4);
        for (circle, (across, up)) in
            circles
                .iter()
                .zip([(0.0, 0.0), (0.25, 1.0 / 3.0), (1.0, 1.0)])
        {
            let place = (corner.0 + 400.0 * across, corner.1 + 300.0 * (1.0 - up));
            let off = (
                attribute(circle, "cx") - place.0,
                attribute(circle, "cy") - place.1,
            );
            assert!(
                off.0.abs() <= 0.005 && off.1.abs() <= 0.005,
                "{circle} {place:?}"
            );
        }
        // Ticks below: labels at 0, 2, … 10 nm.
        let below = corner.1 + 300.0;
        for (number, share) in [("0", 0.0), ("2", 0.2), ("10", 1.0)] {
            let x = corner.0 + 400.0 * share;
            let text = elements(&svg, "text").into_iter().find(|text| {
                (attribute(text, "x") - x).abs() < 0.01 && attribute(text, "y") > below
            });
            let text = text.unwrap_or_else(|| panic!("no number at {x}"));
            assert!(svg.contains(&format!("<{text}>{number}<")), "{text}");
        }
        let words = parsed(&svg).1;
        assert!(
            words.contains("d\u{a0}(nm)") && words.contains("Fn\u{a0}(mN)"),
            "{words}"
        );
        assert!(words.contains("a < b & \\u{1b}"), "{words}");
        assert_eq!(
            svg,
            small(vec![curve(&points, Ink::Series(0), "F_n")]).svg()
        );
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
        let names: Vec<String> = figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        assert_eq!(names, ["F_n", "G", "confidence"]);
        let svg = figure.svg();
        let looks = |element: &String| element.split_once("fill=").unwrap().1.to_owned();
        let areas: Vec<String> = elements(&svg, "polygon").iter().map(looks).collect();
        // Both bands, and a sample of each in the legend, of the same appearance.
        assert_eq!(areas.len(), 4);
        assert_eq!(areas[..2], areas[2..]);
        for ink in inks {
            let colour = hex(ink.on_paper());
            let lines = elements(&svg, "polyline")
                .into_iter()
                .filter(|line| line.contains(&colour));
            let dashes = lines
                .filter(|line| line.contains("stroke-dasharray"))
                .count();
            assert_eq!(dashes, 2, "a line and its sample");
        }
        // The end without a logarithm is at the bottom.
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert!(small(Vec::new()).svg().len() < svg.len());
    }

    #[test]
    fn charts_of_a_given_width_lie_apart_and_keep_their_letters() {
        let sizes = |svg: &str| {
            let sizes = elements(svg, "text")
                .into_iter()
                .map(|text| attribute(&text, "font-size").to_bits());
            sizes.collect::<std::collections::BTreeSet<_>>()
        };
        let chart = small(Vec::new()).charts.remove(0);
        for (count, width) in
            (1..=6).flat_map(|count| [189.0, 321.26, 642.52].map(|width| (count, width)))
        {
            let charts = vec![chart.clone(); count];
            let wide = Figure {
                charts,
                parameters: vec!["E".into()],
                ..small(Vec::new())
            };
            let narrow = Figure {
                width: Some(width),
                ..wide.clone()
            }
            .svg();
            assert_eq!(sizes(&narrow), sizes(&wide.svg()));
            let rects = elements(&narrow, "rect");
            assert!(
                (attribute(&rects[0], "width") - width).abs() < 0.01,
                "{}",
                rects[0]
            );
            let frames: Vec<[f64; 4]> = rects
                .iter()
                .filter(|rect| rect.contains("stroke-width=\"1\""))
                .map(|rect| ["x", "y", "width", "height"].map(|name| attribute(rect, name)))
                .collect();
            assert_eq!(frames.len(), count);
            for (index, [x, y, across, down]) in frames.iter().enumerate() {
                assert!(
                    *x > 0.0 && x + across < width && *across > 90.0 && *down >= LOWEST,
                    "{frames:?}"
                );
                let apart = |other: &[f64; 4]| x + across < other[0] || y + down < other[1];
                assert!(frames[index + 1..].iter().all(apart), "{frames:?}");
            }
        }
    }
    #[test]
    fn a_figure_has_the_height_that_is_asked_for_and_fits_on_a_page() {
        let chart = small(Vec::new()).charts.remove(0);
        let of = |count: usize| Figure {
            charts: vec![chart.clone(); count],
            width: Some(321.0),
            ..small(Vec::new())
        };
        let height = |figure: &Figure| attribute(&elements(&figure.svg(), "rect")[0], "height");
        for count in [1, 2, 4] {
            for asked in [400.0, 700.0] {
                let figure = Figure {
                    height: Some(asked),
                    ..of(count)
                };
                let found = height(&figure);
                let least = LOWEST * count as f64;
                assert!(
                    (found - asked).abs() < 0.01 || (found > asked && found < asked + least),
                    "{count} {found}"
                );
            }
        }
        assert!((height(&of(6)) - PAGE).abs() < 0.01 && height(&of(2)) < PAGE);
        let titled = of(1);
        assert!(
            parsed(&titled.svg()).1.matches("a < b").count() == 2,
            "a title, and its name for readers"
        );
        let untitled = Figure {
            untitled: true,
            ..titled
        };
        assert_eq!(parsed(&untitled.svg()).1.matches("a < b").count(), 1);
    }

    #[test]
    fn panels_are_chosen_by_their_letters() {
        let heading = |heading: &str| Chart {
            heading: heading.into(),
            ..small(Vec::new()).charts.remove(0)
        };
        let figure = Figure {
            charts: ["one", "two", "three"].map(heading).to_vec(),
            ..small(Vec::new())
        };
        let words = |letters: &str| parsed(&figure.clone().with_panels(letters).unwrap().svg()).1;
        assert!(words("ca").contains("(a) three") && words("ca").contains("(b) one"));
        assert!(!words("b").contains("two"), "a single chart has no heading");
        for wrong in ["", "d", "aé"] {
            assert_eq!(figure.clone().with_panels(wrong).unwrap_err(), "abc");
        }
    }
}
