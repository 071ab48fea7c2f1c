//! Content of a figure: charts with axes, and layers of data in SI units.

use super::axis::ChartAxis;
use super::colour::{Ink, Rgb, Shades};
use super::label::Label;
use super::scale::Span;
use asperity_data::AxisScale;

/// Picture with one title, one or more charts arranged in rows, and one legend for all charts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Title of the figure; may be empty.
    pub title: String,
    /// Lines of text below the title.
    pub notes: Vec<Label>,
    /// Charts of the figure, which are placed in rows from left to right.
    pub charts: Vec<Chart>,
    /// Width and height of the frame of each chart in px (1/96 inch). If [`Self::width`] is given,
    /// only the ratio of this width and height is used.
    pub size: (f64, f64),
    /// Lines that state how to compute the figure again: version, command and scene. Only SVG
    /// documents contain these lines, as metadata.
    pub origin: String,
    /// Lines of text in a box below the legend, such as the parameters of the scene.
    pub parameters: Vec<Label>,
    /// Width of the picture in px (1/96 inch), to which the frames are fitted. If it is `None`, the
    /// frames have the size [`Self::size`].
    pub width: Option<f64>,
    /// Height of the picture in px (1/96 inch). If it is `None`, the picture is as high as the
    /// frames need.
    pub height: Option<f64>,
    /// True if the picture is drawn without the title, because a caption outside the picture
    /// contains the title.
    pub untitled: bool,
}

impl Figure {
    /// Usual size in px of the frame of each chart ([`Self::size`]), in a figure with a heat map or
    /// with several charts.
    pub const SMALL: (f64, f64) = (330.0, 270.0);
    /// Usual size in px of the frame of the chart ([`Self::size`]), in a figure with only one
    /// chart.
    pub const WIDE: (f64, f64) = (480.0, 300.0);
    /// Usual size in px of the frame of each chart ([`Self::size`]), if the horizontal axis of the
    /// charts is the position along the profile.
    pub const LOW: (f64, f64) = (640.0, 240.0);

    /// Creates a figure of one chart with this title.
    ///
    /// ```
    /// use asperity_data::AxisScale;
    /// use asperity_plot::{Chart, ChartAxis, Figure, Ink, Layer, Shape, Span, Stroke};
    ///
    /// let axis = |name, symbol, unit| {
    ///     ChartAxis::new(AxisScale::Linear, Span { low: 0.0, high: 1e-6 }, name, symbol, unit)
    /// };
    /// let line = Shape::line(vec![(0.0, 0.0), (1e-6, 1e-6)], Stroke::Solid);
    /// let chart = Chart::new(
    ///     axis("indentation", "d", "m"),
    ///     axis("force", "F", "N"),
    ///     vec![Layer::new("loading".into(), Ink::Press, line)],
    /// );
    /// let svg = Figure::of_chart("A straight line", chart).svg();
    /// assert!(svg.starts_with("<svg") && svg.contains("A straight line"));
    /// ```
    pub fn of_chart(title: &str, chart: Chart) -> Figure {
        Figure {
            title: title.to_owned(),
            charts: vec![chart],
            size: Figure::WIDE,
            ..Figure::default()
        }
    }

    /// Collects the charts of several figures in one figure without a title. The titles and notes
    /// of the given figures become headings of the charts.
    pub fn of_panels(figures: Vec<Figure>) -> Figure {
        let size = figures.first().map_or(Figure::SMALL, |figure| figure.size);
        let mut charts = Vec::new();
        for figure in figures {
            for chart in figure.charts {
                let mut heading = Label::default();
                let parts = [Label::plain(&figure.title), chart.heading.clone()];
                for part in parts.iter().chain(&figure.notes) {
                    if !heading.is_empty() && !part.is_empty() {
                        heading = heading.then(", ");
                    }
                    heading = heading.join(part);
                }
                charts.push(Chart { heading, ..chart });
            }
        }
        Figure {
            charts,
            size,
            ..Figure::default()
        }
    }

    /// Returns the figure with only the charts that `letters` selects, in the order of `letters`.
    /// For example, `ac` selects the first and the third chart.
    ///
    /// # Errors
    /// Returns an error if a letter belongs to no chart, or if no letter is given. The error lists
    /// the letters of the charts.
    pub fn with_panels(self, letters: &str) -> Result<Figure, String> {
        let mut charts = Vec::new();
        for letter in letters.chars() {
            let index = (letter as usize).checked_sub('a' as usize);
            match index.and_then(|index| self.charts.get(index)) {
                Some(chart) => charts.push(chart.clone()),
                None => return Err(self.panel_letters()),
            }
        }
        if charts.is_empty() {
            return Err(self.panel_letters());
        }
        Ok(Figure { charts, ..self })
    }

    fn panel_letters(&self) -> String {
        ('a'..='z').take(self.charts.len()).collect()
    }

    /// Returns the heading of the chart with this index, which begins with the letter of the chart.
    /// Returns `None` if the figure has only one chart.
    pub(super) fn heading(&self, index: usize) -> Option<Label> {
        if self.charts.len() < 2 {
            return None;
        }
        let chart = self.charts.get(index)?;
        let letter = char::from(b'a' + (index % 26) as u8);
        Some(Label::plain(&format!("({letter}) ")).join(&chart.heading))
    }

    /// Returns the entries of the legend of all charts. Layers with the same name share an entry.
    pub fn legend(&self) -> Vec<Entry> {
        Entry::of_charts(&self.charts)
    }
}

/// Chart with two axes and layers of data, such as curves or a heat map.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Heading of the chart, shown in figures of several charts; may be empty.
    pub heading: Label,
    pub x: ChartAxis,
    pub y: ChartAxis,
    /// Layers of data. Later layers are drawn over earlier ones.
    pub layers: Vec<Layer>,
}

impl Chart {
    /// Creates a chart of layers over two axes, without a heading.
    pub fn new(x: ChartAxis, y: ChartAxis, layers: Vec<Layer>) -> Chart {
        Chart {
            heading: Label::default(),
            x,
            y,
            layers,
        }
    }

    /// Removes the name of each axis that has a symbol, so that only the symbol labels the axis.
    pub fn with_symbols(mut self) -> Chart {
        for axis in [&mut self.x, &mut self.y] {
            if !axis.symbol.is_empty() {
                axis.name.clear();
            }
        }
        self
    }

    /// Divides the numbers on one or both axes, and the data of the layers, by a quantity. The
    /// chart then shows F/F_a,max instead of F, for example. `x` and `y` are the value and the
    /// symbol of the quantity for this axis; `None` leaves the axis unchanged. The values of heat
    /// maps are not changed.
    pub fn over(mut self, x: Option<(f64, &str)>, y: Option<(f64, &str)>) -> Chart {
        let mut x_unit = 1.0;
        if let Some((unit, symbol)) = x {
            self.x = self.x.over(unit, symbol);
            x_unit = unit;
        }
        let mut y_unit = 1.0;
        if let Some((unit, symbol)) = y {
            self.y = self.y.over(unit, symbol);
            y_unit = unit;
        }
        for layer in &mut self.layers {
            layer.shape.divide(x_unit, y_unit);
        }
        self
    }

    /// Returns the first heat map of the chart; `None` if the chart has no heat map.
    pub fn map(&self) -> Option<&HeatMap> {
        self.layers.iter().find_map(|layer| match &layer.shape {
            Shape::Map(map) => Some(map.as_ref()),
            _ => None,
        })
    }

    pub fn map_mut(&mut self) -> Option<&mut HeatMap> {
        self.layers
            .iter_mut()
            .find_map(|layer| match &mut layer.shape {
                Shape::Map(map) => Some(map.as_mut()),
                _ => None,
            })
    }
}

/// Set of data in a chart, such as a curve. Its name is shown in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name that the legend shows. A layer with an empty name is not in the legend.
    pub name: Label,
    /// Meaning of the data, such as a loading. The meaning determines the colour of the data.
    pub ink: Ink,
    /// The data, and the shape in which they are drawn, such as a curve or a heat map.
    pub shape: Shape,
}

impl Shape {
    /// Creates a curve that is drawn as a line through these points (x, y).
    pub fn line(points: Vec<(f64, f64)>, stroke: Stroke) -> Shape {
        Shape::Curve {
            points,
            stroke: Some(stroke),
            sign: None,
        }
    }

    /// Creates markers at these points (x, y), without a line.
    pub fn signs(points: Vec<(f64, f64)>, sign: Sign) -> Shape {
        Shape::Curve {
            points,
            stroke: None,
            sign: Some(sign),
        }
    }

    /// Returns this [`Shape::Envelope`] with its area filled. Any other shape stays as it is.
    pub fn filled(mut self, area: StressFill) -> Shape {
        if let Shape::Envelope { fill, .. } = &mut self {
            *fill = Some(area);
        }
        self
    }

    /// Returns the points (x, y) of a curve. For a [`Shape::Envelope`], returns the lowest and the
    /// highest point of each column. For any other shape, returns an empty list.
    pub fn points(&self) -> Vec<(f64, f64)> {
        match self {
            Shape::Curve { points, .. } => points.clone(),
            Shape::Envelope {
                x: (from, to),
                columns,
                ..
            } => {
                let mut points = Vec::new();
                for (index, ends) in columns.iter().enumerate() {
                    let Some((low, high)) = *ends else {
                        continue;
                    };
                    let x = from + (to - from) * (index as f64 + 0.5) / columns.len() as f64;
                    points.push((x, low));
                    if low < high {
                        points.push((x, high));
                    }
                }
                points
            }
            _ => Vec::new(),
        }
    }

    /// Divides each x by `x_unit` and each y by `y_unit`. Heat maps are not changed.
    fn divide(&mut self, x_unit: f64, y_unit: f64) {
        match self {
            Shape::Curve { points, .. } | Shape::Inside(points) => {
                for (x, y) in points {
                    *x /= x_unit;
                    *y /= y_unit;
                }
            }
            Shape::Band(points) => {
                for (x, low, high) in points {
                    *x /= x_unit;
                    *low /= y_unit;
                    *high /= y_unit;
                }
            }
            Shape::Envelope {
                x: (from, to),
                columns,
                fill,
            } => {
                *from /= x_unit;
                *to /= x_unit;
                for (low, high) in columns.iter_mut().flatten() {
                    *low /= y_unit;
                    *high /= y_unit;
                }
                if let Some(fill) = fill {
                    fill.level /= y_unit;
                    fill.full /= y_unit;
                }
            }
            Shape::Boxes(boxes) => {
                for ((left, right), (low, high)) in boxes {
                    *left /= x_unit;
                    *right /= x_unit;
                    *low /= y_unit;
                    *high /= y_unit;
                }
            }
            Shape::Upright(x) => *x /= x_unit,
            Shape::Level(y) => *y /= y_unit,
            Shape::Map(_) => {}
        }
    }
}

impl Layer {
    pub fn new(name: Label, ink: Ink, shape: Shape) -> Layer {
        Layer { name, ink, shape }
    }

    /// Creates a layer without an entry in the legend.
    pub fn unnamed(ink: Ink, shape: Shape) -> Layer {
        Layer::new(Label::default(), ink, shape)
    }
}

/// Data of a layer, and the shape in which they are drawn. Each x is a number on the horizontal
/// axis, and each y a number on the vertical axis. A curve or a band is interrupted at a point that
/// the axes cannot show, such as 0 on a logarithmic axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Line through points, markers at the points, or both.
    Curve {
        points: Vec<(f64, f64)>,
        /// Stroke of the line; `None` for no line.
        stroke: Option<Stroke>,
        /// Marker at each point; `None` for no markers.
        sign: Option<Sign>,
    },
    /// Area between two curves. Each point is (x, lower y, upper y).
    Band(Vec<(f64, f64, f64)>),
    /// Line with more points than a picture can show. The x axis is divided into many columns of
    /// equal width. Only the lowest and the highest y of the line in each column are stored.
    Envelope {
        /// x at the left edge of the first column, and x at the right edge of the last column.
        x: (f64, f64),
        /// Lowest and highest y of each column; `None` where the line is interrupted.
        columns: Vec<Option<(f64, f64)>>,
        /// Area between the line and a level, which is filled in place of the line; `None` for a
        /// line.
        fill: Option<StressFill>,
    },
    /// Area inside the closed line through these points.
    Inside(Vec<(f64, f64)>),
    /// Filled rectangles. Each is ((smallest x, largest x), (smallest y, largest y)).
    Boxes(Vec<((f64, f64), (f64, f64))>),
    /// Vertical line at this x from the lower to the upper end of the chart.
    Upright(f64),
    /// Horizontal line at this y from the left to the right end of the chart.
    Level(f64),
    /// Heat map with one coloured cell for each pair of a number on the horizontal axis and a
    /// number on the vertical axis.
    Map(Box<HeatMap>),
}

/// Filled area between a profile and the level at which its springs have no stress. The colour of
/// each height shows the stress of a spring at this height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressFill {
    /// Vertical coordinate of a spring without stress. Springs above this level are pressed,
    /// springs below it are pulled.
    pub level: f64,
    /// Distance from the level, on the vertical axis, at which the colour is that of the largest
    /// stress.
    pub full: f64,
}

impl StressFill {
    /// Returns the stress of a spring at the height `y` as a share of the largest stress. It is
    /// positive for a pressed spring.
    pub fn stress(self, y: f64) -> f64 {
        (y - self.level) / self.full
    }
}

/// Pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    Solid,
    Dashed,
    /// Short dashes. The gaps between the dashes are as long as the dashes.
    Dotted,
    DashDotted,
    /// Dots, with gaps that are much longer than the dots.
    Sparse,
}

/// Marker that is drawn at a point, such as a filled circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    Dot,
    Square,
    Up,
    Diamond,
    Ring,
    Down,
    Left,
    Right,
    Cross,
    HollowDiamond,
    /// Small dot, for curves with thousands of points.
    Point,
}

impl Sign {
    /// Returns the marker of one of several curves in a chart. `number` is the index of this curve,
    /// from 0.
    pub fn of_series(number: usize) -> Sign {
        [Sign::Dot, Sign::Square, Sign::Up, Sign::Diamond, Sign::Ring][number % 5]
    }
}

/// Heat map: a grid of cells over two axes. The colour of each cell shows a value on a colour
/// scale.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// Number on the horizontal axis of each column of cells. The numbers ascend.
    pub columns: Vec<f64>,
    /// Number on the vertical axis of each row of cells. The numbers ascend.
    pub rows: Vec<f64>,
    /// Value of each cell, row by row from the lower left cell; `None` for a cell without a value.
    pub values: Vec<Option<f64>>,
    /// Axis of the colour scale: the quantity that the colours show, and the range of its values.
    pub key: ChartAxis,
    /// Colours of the values, from low to high.
    pub shades: Shades,
    /// Class of each cell, in the order of [`Self::values`]. A class is an index of
    /// [`Self::class_names`]; `None` is a cell without a class. The list is empty for a map without
    /// classes.
    pub classes: Vec<Option<usize>>,
    /// Classes that cells can have, such as regimes of adhesion; empty for a map without classes.
    pub class_names: Vec<Class>,
    /// Line on the map along which a quantity has a given value; `None` for no line.
    pub contour: Option<Contour>,
}

/// Class of cells in a heat map, such as a regime of adhesion.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Marker of the class in an SVG, PNG or PDF figure.
    pub sign: Sign,
    /// Letter that marks the class in a terminal; `None` for a class without a letter.
    pub letter: Option<char>,
    /// Name of the class in the legend.
    pub name: String,
    /// Meaning of the class. The meaning determines the colour of the class, or the style of the
    /// class in a terminal without colours.
    pub ink: Ink,
}

/// Line in a heat map along which a quantity has a given value.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Value, in each cell of the map, of the quantity that is constant along the line. The order
    /// is the order of [`HeatMap::values`]. `None` for a cell without a value.
    pub field: Vec<Option<f64>>,
    /// Value of the quantity along the line, in the same unit as [`Self::field`].
    pub level: f64,
    /// Name of the line in the legend.
    pub name: Label,
}

impl HeatMap {
    /// Returns the colour that the colour scale [`Self::key`] has for a value.
    pub fn colour(&self, value: f64) -> Rgb {
        self.shades.at(self.key.share(value))
    }

    /// Returns the index of the colour band that contains a value. The colour scale is divided into
    /// [`Shades::BANDS`] bands. Band 0 has the lowest values.
    pub fn shade(&self, value: f64) -> usize {
        ((self.key.share(value) * Shades::BANDS as f64) as usize).min(Shades::BANDS - 1)
    }

    /// Returns the borders of the map cells along one axis. Each of `values` lies inside one cell,
    /// so there is one more border than values. A border is a coordinate: a number on a linear
    /// axis, and the decadic logarithm of a number on a logarithmic axis.
    pub fn borders(scale: AxisScale, values: &[f64]) -> Vec<f64> {
        let coordinates: Vec<f64> = values
            .iter()
            .map(|value| scale.coordinate(*value))
            .collect();
        let (Some(first), Some(last)) = (coordinates.first(), coordinates.last()) else {
            return vec![0.0, 1.0];
        };
        if coordinates.len() == 1 {
            return vec![first - 0.5, last + 0.5];
        }
        let between: Vec<f64> = coordinates
            .windows(2)
            .map(|pair| f64::midpoint(pair[0], pair[1]))
            .collect();
        let before = 2.0 * first - between[0];
        let after = 2.0 * last - between[between.len() - 1];
        [vec![before], between, vec![after]].concat()
    }

    /// Returns the range of coordinates of an axis that shows a map cell around each of `values`.
    pub fn span(scale: AxisScale, values: &[f64]) -> Span {
        let borders = HeatMap::borders(scale, values);
        Span {
            low: borders[0],
            high: borders[borders.len() - 1],
        }
    }
}

/// Entry of a legend: a name, preceded by the lines, areas or markers of the layers with this name.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub name: Label,
    /// Lines, areas or markers that the legend shows before the name. Each has an ink: the meaning
    /// that determines its colour.
    pub samples: Vec<(Ink, Sample)>,
}

/// Small picture in a legend that shows how a layer with this name is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sample {
    /// Line, marker, or a line with a marker on it.
    Line(Option<Stroke>, Option<Sign>),
    /// A filled transparent area.
    Area,
    /// A filled area.
    Solid,
    /// A straight line that crosses the whole chart, vertically or horizontally.
    Guide,
    /// The line of a [`Contour`].
    Contour,
    /// A cell of a heat map without a value.
    Empty,
}

impl Entry {
    /// Returns the legend entries for the layers of these charts. Layers with the same name share
    /// an entry.
    pub fn of_charts(charts: &[Chart]) -> Vec<Entry> {
        let mut entries = Vec::new();
        for Layer { name, ink, shape } in charts.iter().flat_map(|chart| &chart.layers) {
            let sample = match shape {
                Shape::Curve { stroke, sign, .. } => Sample::Line(*stroke, *sign),
                Shape::Envelope { fill: Some(_), .. } => Sample::Solid,
                Shape::Envelope { fill: None, .. } => Sample::Line(Some(Stroke::Solid), None),
                Shape::Band(_) | Shape::Inside(_) => Sample::Area,
                Shape::Boxes(_) => Sample::Solid,
                Shape::Upright(_) | Shape::Level(_) => Sample::Guide,
                Shape::Map(map) => {
                    add_entries_of_map(&mut entries, map);
                    continue;
                }
            };
            add_entry(&mut entries, name, *ink, sample);
        }
        // Entries with areas come last, because an area usually accompanies a line.
        entries.sort_by_key(|entry| {
            entry
                .samples
                .iter()
                .any(|(_, sample)| *sample == Sample::Area)
        });
        entries
    }
}

fn add_entries_of_map(entries: &mut Vec<Entry>, map: &HeatMap) {
    for (index, class) in map.class_names.iter().enumerate() {
        if map.classes.contains(&Some(index)) {
            let sample = Sample::Line(None, Some(class.sign));
            add_entry(entries, &Label::plain(&class.name), Ink::Text, sample);
        }
    }
    if let Some(contour) = &map.contour {
        add_entry(entries, &contour.name, Ink::Text, Sample::Contour);
    }
    if map.values.contains(&None) {
        add_entry(entries, &"no value".into(), Ink::Quiet, Sample::Empty);
    }
}

/// Adds a sample (small picture of a layer) to the legend entry with this name, or adds a new
/// entry. Does nothing if the name is empty.
fn add_entry(entries: &mut Vec<Entry>, name: &Label, ink: Ink, sample: Sample) {
    if name.is_empty() {
        return;
    }
    match entries.iter_mut().find(|entry| entry.name == *name) {
        Some(entry) if entry.samples.contains(&(ink, sample)) => {}
        Some(entry) => entry.samples.push((ink, sample)),
        None => entries.push(Entry {
            name: name.clone(),
            samples: vec![(ink, sample)],
        }),
    }
}
