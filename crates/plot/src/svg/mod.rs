//! Figures as SVG documents. Equal figures give equal bytes.

pub(crate) mod elements;
pub(crate) mod frame;
pub(crate) mod layers;
pub(crate) mod legend;

use super::axis::Axes;
use super::chart::{Chart, Figure, HeatMap};
use super::colour::Shades;
use super::label::Label;
use elements::{Anchor, PAPER, Pen, Place, Svg, TEXT, escaped};
use frame::{Frame, LABEL, Side};

/// Fonts of figures, in the order of preference. Their letters have nearly the same widths.
const FONTS: &str = "font-family=\"Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif\"";
/// Height in px below a chart for its horizontal axis.
const BELOW: f64 = 50.0;
/// Smallest width in px on the right of a chart.
const BESIDE: f64 = 22.0;
/// Distance in px between a map and its colour scale.
const FROM_MAP: f64 = 14.0;
/// Width of the colour scale in px.
const BAR: f64 = 13.0;
/// Smallest distance in px of text from the border of the picture.
const MARGIN: f64 = 6.0;
/// Font size of the title in px.
const TITLE: f64 = 14.5;
/// Font size in px of the text below the title and the legend.
const TEXT_SIZE: f64 = LABEL - 1.0;
/// Height in px of a line in the heading of a chart.
const HEADING: f64 = 18.0;
/// Smallest width in px of a frame that has other frames beside it, in a figure with a given width.
const LEAST: f64 = 110.0;
/// Largest width in px of a figure with several charts, if the user has given no width.
const WIDEST: f64 = 1400.0;
/// A frame up to this width in px is at least as high as it is wide.
const SQUARE: f64 = 150.0;
/// Largest ratio of height to width of a frame, if charts are placed one below the other.
const LOW: f64 = 0.62;
/// Largest height in px (240 mm) of a figure with a given width.
const PAGE: f64 = 907.0;
/// Smallest height of a frame in px.
const LOWEST: f64 = 60.0;
/// Height in px of each name on an axis.
const NAME: f64 = 14.0;

/// Width of a figure, with the sizes of its frames and the room beside them.
struct Layout {
    /// Width of the picture in px.
    width: f64,
    /// Width and height in px of the frames.
    size: (f64, f64),
    /// Room on the left and right of the frames, for each column of charts.
    rooms: Vec<Rooms>,
}

/// Room in px on the left and right of the frame of a chart.
#[derive(Clone, Copy, Default)]
struct Rooms {
    left: f64,
    right: f64,
}

impl Figure {
    /// Draws the figure and returns an SVG document. Equal figures give documents of equal bytes.
    pub fn svg(&self) -> String {
        let mut layout = self.layout();
        let (mut svg, mut height) = self.drawn(&layout);
        if let Some(wanted) = self.wanted_height(height) {
            // Only the frames can change their height; all other elements keep theirs.
            let rows = self.charts.len().div_ceil(layout.rooms.len()).max(1) as f64;
            layout.size.1 = (layout.size.1 - (height - wanted) / rows).max(LOWEST);
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

    /// Returns the height in px that the picture must have instead of `height`; `None` if `height`
    /// is right.
    fn wanted_height(&self, height: f64) -> Option<f64> {
        if self.height.is_some() {
            return self.height;
        }
        (self.width.is_some() && height > PAGE).then_some(PAGE)
    }

    /// Draws all elements. Returns them, and the height of the picture in px.
    fn drawn(&self, layout: &Layout) -> (Svg, f64) {
        let mut svg = Svg::default();
        let width = layout.width;
        let middle = width / 2.0;
        let text_width = width - 4.0 * MARGIN;
        let wrapped = |label: &Label, size: f64| label.wrapped(text_width / size);
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
            let lines = wrapped(note, TEXT_SIZE);
            y = svg.lines(&lines, (middle, y), TEXT_SIZE, Anchor::Middle);
        }
        let columns = layout.rooms.len();
        for (row, charts) in self.charts.chunks(columns).enumerate() {
            y = self.draw_row(&mut svg, row * columns, charts, layout, y);
        }
        y = legend::draw(&mut svg, &self.legend(), middle, y + 2.0, text_width) + MARGIN;
        let parameters: Vec<Label> = self
            .parameters
            .iter()
            .flat_map(|line| wrapped(line, TEXT_SIZE))
            .collect();
        if !parameters.is_empty() {
            let first = (2.0 * MARGIN, y + 2.0 * MARGIN);
            let end = svg.lines(&parameters, first, TEXT_SIZE, Anchor::Left) - MARGIN;
            svg.frame((MARGIN, y), (width - MARGIN, end), Pen::solid(TEXT, 0.8));
            y = end + MARGIN;
        }
        (svg, y)
    }

    /// Returns the layout with the smallest number of rows in which the charts fit the width.
    fn layout(&self) -> Layout {
        let count = self.charts.len().max(1);
        for rows in 1..count {
            let layout = self.layout_in_columns(count.div_ceil(rows));
            let fits = if self.width.is_some() {
                layout.size.0 >= LEAST
            } else {
                layout.width <= WIDEST
            };
            if fits {
                return layout;
            }
        }
        self.layout_in_columns(1)
    }

    fn layout_in_columns(&self, columns: usize) -> Layout {
        let mut size = self.size;
        if let Some(width) = self.width {
            // The room beside the frames depends on the numbers at the ticks, and these numbers
            // depend on the size of the frames. Therefore the size is computed twice.
            for _ in 0..2 {
                size = self.size_in_columns(columns, width, &self.rooms(columns, size));
            }
        }
        let names = self.charts.iter().map(|chart| chart.y.names.len()).max();
        // On a vertical axis with names, each name needs the height of a line.
        size.1 = size.1.max(NAME * names.unwrap_or(0) as f64);
        let rooms = self.rooms(columns, size);
        Layout {
            width: self.width.unwrap_or_else(|| width_of(&rooms, size.0)),
            size,
            rooms,
        }
    }

    /// Returns the width and height in px of the frames, if the charts of a row have the total
    /// width `width` and the room `rooms` beside their frames.
    fn size_in_columns(&self, columns: usize, width: f64, rooms: &[Rooms]) -> (f64, f64) {
        let across = ((width - width_of(rooms, 0.0)) / columns as f64).max(MARGIN);
        let are_below_each_other = columns < self.charts.len().max(1);
        let largest_ratio = if are_below_each_other { LOW } else { 1.0 };
        let ratio = (self.size.1 / self.size.0).min(largest_ratio);
        (across, (across * ratio).max(across.min(SQUARE)))
    }

    /// Returns the room beside the frames of each column of charts: the largest room that a chart
    /// of this column needs.
    fn rooms(&self, columns: usize, size: (f64, f64)) -> Vec<Rooms> {
        let mut all = vec![Rooms::default(); columns];
        for (index, chart) in self.charts.iter().enumerate() {
            let own = rooms_of(chart, size);
            let column = &mut all[index % columns];
            column.left = column.left.max(own.left);
            column.right = column.right.max(own.right);
        }
        all
    }

    /// Draws charts side by side, with their upper end at `y`. `first` is the index of the leftmost
    /// chart in the figure. Returns the y of the lower end of the charts.
    fn draw_row(
        &self,
        svg: &mut Svg,
        first: usize,
        charts: &[Chart],
        layout: &Layout,
        y: f64,
    ) -> f64 {
        let size = layout.size;
        let mut headings: Vec<Vec<Label>> = Vec::new();
        for (index, rooms) in (first..first + charts.len()).zip(&layout.rooms) {
            let heading = self.heading(index).unwrap_or_default();
            headings.push(heading.wrapped((size.0 + rooms.right - MARGIN) / LABEL));
        }
        let lines = headings.iter().map(Vec::len).max().unwrap_or(0);
        let top = if lines > 0 {
            y + HEADING * lines as f64
        } else {
            y - 2.0
        };
        let mut left = 0.0;
        for ((chart, heading), rooms) in charts.iter().zip(&headings).zip(&layout.rooms) {
            left += rooms.left;
            let first_line = (left, top - HEADING * heading.len() as f64 + 6.0);
            svg.lines(heading, first_line, LABEL, Anchor::Left);
            draw_chart(svg, chart, (left, top), size);
            left += size.0 + rooms.right;
        }
        let is_last = self.charts.len() <= first + charts.len();
        let distance = if is_last { 0.0 } else { 2.0 * MARGIN };
        top + size.1 + BELOW + distance
    }
}

/// Returns the total width in px of charts side by side, if their frames have the width `frame`.
fn width_of(rooms: &[Rooms], frame: f64) -> f64 {
    rooms
        .iter()
        .map(|rooms| rooms.left + frame + rooms.right)
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

/// Returns the frame of the colour scale, which is on the right of its map.
fn frame_of_colours<'a>(map: &'a HeatMap, chart: Frame<'a>) -> Frame<'a> {
    let left = chart.to.0 + FROM_MAP;
    Frame {
        from: (left, chart.from.1),
        to: (left + BAR, chart.to.1),
        axes: Axes {
            y: &map.key,
            ..chart.axes
        },
    }
}

fn rooms_of(chart: &Chart, size: (f64, f64)) -> Rooms {
    let frame = frame_of(chart, (0.0, 0.0), size);
    let scale = chart.map().map_or(0.0, |map| {
        FROM_MAP + BAR + frame_of_colours(map, frame).room(Side::Right) + MARGIN
    });
    Rooms {
        left: frame.room(Side::Left) + MARGIN,
        right: BESIDE.max(scale),
    }
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
            let low = band as f64 / Shades::BANDS as f64;
            let high = (band + 1) as f64 / Shades::BANDS as f64;
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

    /// Creates a figure of one chart with d from 0 to 10 nm and F_n from 1 µN to 1 mN.
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
        // Each of the three points with coordinates has a circle, and the legend has one more.
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
        // The ticks below the chart have labels at 0, 2, … 10 nm.
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
        // The figure has two bands, and the legend repeats the look of each.
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
        // An end of the band has no logarithm. It is drawn at the bottom of the chart, so that all
        // coordinates are finite.
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
