//! Charts of force loops. Figures of scenes and the explorer both use them.

use asperity_contact::{CurvePoint, Direction, Mark, MarkedPoint, StageRecord};
use asperity_data::{AxisScale, format_rounded};
use asperity_plot::{
    Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke, value_label,
};
use asperity_scene::Outcome;
use asperity_scene::instrument::{DisplacementCurve, DisplacementPoint};

/// Pair of quantities that a chart of a force loop shows, one over the other. A force loop is the
/// curve of loading and unloading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoopQuantities {
    /// Force over the indentation.
    #[default]
    ForceIndentation,
    /// Force over the displacement of the instrument.
    ForceDisplacement,
    /// Force over the time since first touch, of a body that relaxes.
    ForceTime,
    /// Total length of all contact patches, over the force.
    LengthForce,
    /// Number of contact patches, over the indentation.
    PatchesIndentation,
}

impl LoopQuantities {
    /// Returns the pairs of quantities that a chart of a computed scene can show. Only with a
    /// compliant instrument is the displacement another quantity than the indentation, and only a
    /// body that relaxes has times.
    pub fn of_scene(outcome: &Outcome) -> Vec<LoopQuantities> {
        let mut offered = vec![LoopQuantities::ForceIndentation];
        if outcome.instrument.is_some() {
            offered.push(LoopQuantities::ForceDisplacement);
        }
        let mut stages = outcome.history.stages.iter();
        if stages.any(|stage| stage.times().is_some()) {
            offered.push(LoopQuantities::ForceTime);
        }
        offered.push(LoopQuantities::LengthForce);
        offered.push(LoopQuantities::PatchesIndentation);
        offered
    }

    /// Returns the pair that follows this pair in the list `offered`. The first pair follows the
    /// last one. A pair that is not in the list counts as the first one.
    pub fn next(self, offered: &[LoopQuantities]) -> Self {
        let present = offered.iter().position(|&quantities| quantities == self);
        let next = present.unwrap_or(0) + 1;
        offered.get(next).copied().unwrap_or_default()
    }
}

/// Quantities on the two axes of a chart of force loops, and their units: SI units, or parameters
/// of a scene such as the rms height.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopUnits {
    quantities: LoopQuantities,
    /// Loading stiffness, N/m; `None` for a rigid instrument.
    stiffness: Option<f64>,
    /// Rms height h in m, if the indentation is shown in units of h; `None` for SI units.
    indentation: Option<f64>,
    /// Ideal pull-off force F_a,max in N, if the force is shown in units of F_a,max; `None` for SI
    /// units.
    force: Option<f64>,
    /// Length L in m, if lengths along the profile are shown in units of L; `None` for SI units.
    length: Option<f64>,
}

/// Quantity that every point of a force curve has. The chart may show it divided by a parameter of
/// the scene.
#[derive(Clone, Copy)]
struct Quantity {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    /// Parameter by which the quantity is divided; `None` for SI units.
    divisor: Option<Divisor>,
    /// Function that returns the quantity at a point.
    value: fn(&Recorded<'_>) -> f64,
}

/// Point of a force curve, with what its quantities may depend on.
struct Recorded<'a> {
    point: &'a CurvePoint,
    /// Stiffness of the instrument in N/m, infinite if it is rigid.
    stiffness: f64,
    /// Time in s since first touch; 0 if the body does not relax.
    seconds: f64,
}

/// Parameter of a scene by which a quantity is divided.
#[derive(Clone, Copy)]
struct Divisor {
    value: f64,
    symbol: &'static str,
}

impl Divisor {
    fn new(value: Option<f64>, symbol: &'static str) -> Option<Self> {
        value.map(|value| Divisor { value, symbol })
    }
}

impl Quantity {
    /// Returns the symbol of the quantity, such as `d` or `d/h`.
    fn symbol(&self) -> String {
        match self.divisor {
            Some(divisor) => format!("{}/{}", self.symbol, divisor.symbol),
            None => self.symbol.to_owned(),
        }
    }

    fn unit(&self) -> &'static str {
        if self.divisor.is_some() {
            "1"
        } else {
            self.unit
        }
    }

    /// Returns the number that the axis shows for a point of a curve.
    fn number(&self, recorded: &Recorded<'_>) -> f64 {
        let value = (self.value)(recorded);
        value / self.divisor.map_or(1.0, |divisor| divisor.value)
    }

    /// Returns an axis for the quantity, over the range `span`.
    fn axis(&self, span: Span) -> ChartAxis {
        let symbol = self.symbol();
        let axis = ChartAxis::new(AxisScale::Linear, span, self.name, &symbol, self.unit());
        ChartAxis {
            counts: self.symbol == "n",
            ..axis
        }
    }
}

impl LoopUnits {
    /// Returns the pair `quantities` with SI units on both axes.
    pub fn si(quantities: LoopQuantities) -> LoopUnits {
        LoopUnits {
            quantities,
            ..LoopUnits::default()
        }
    }

    /// Returns the pair `quantities` with the units for a chart of a computed scene. If
    /// `normalised` is true, the indentation is in units of the rms height h, the force in units of
    /// the ideal pull-off force F_a,max, and lengths in units of the length L of the profile.
    /// Otherwise all quantities are in SI units.
    pub fn of_scene(quantities: LoopQuantities, outcome: &Outcome, normalised: bool) -> LoopUnits {
        let units = LoopUnits {
            stiffness: outcome.instrument.map(|instrument| instrument.stiffness),
            ..LoopUnits::si(quantities)
        };
        if !normalised {
            return units;
        }
        let amplitude = outcome.governing.amplitude;
        let rms_height = amplitude.map(|amplitude| amplitude.rms_height);
        let is_positive = |value: &f64| *value > 0.0;
        LoopUnits {
            indentation: rms_height.filter(is_positive),
            force: outcome.ideal_pull_off_force.filter(is_positive),
            length: Some(outcome.line.length).filter(is_positive),
            ..units
        }
    }

    /// Returns the numbers on the horizontal and the vertical axis that belong to a point of a
    /// force curve. `seconds` is the time of the point in s since first touch, if the body relaxes.
    /// Returns `None` if the horizontal axis is the time and the point has no time.
    pub fn place(&self, point: &CurvePoint, seconds: Option<f64>) -> Option<(f64, f64)> {
        if self.quantities == LoopQuantities::ForceTime {
            seconds?;
        }
        let recorded = Recorded {
            point,
            stiffness: self.stiffness.unwrap_or(f64::INFINITY),
            seconds: seconds.unwrap_or(0.0),
        };
        let [across, up] = self.quantities();
        Some((across.number(&recorded), up.number(&recorded)))
    }

    /// Returns the numbers on the horizontal and the vertical axis that belong to a marked point,
    /// as [`Self::place`] does.
    pub fn place_of_mark(&self, marked: &MarkedPoint) -> Option<(f64, f64)> {
        self.place(&marked.point, marked.seconds)
    }

    /// Returns a force, given in N, as text in the unit in which the chart shows forces.
    pub fn force_in_words(&self, force: f64) -> String {
        match self.force {
            Some(unit) => format_rounded(force / unit, 3, "1"),
            None => format_rounded(force, 3, "N"),
        }
    }

    /// Returns true if a chart of these quantities shows this kind of marked point. A chart of the
    /// force over the displacement of the instrument has no [`Mark::JumpIn`] and [`Mark::JumpOut`];
    /// any other chart shows all kinds.
    pub fn shows(&self, mark: Mark) -> bool {
        self.quantities != LoopQuantities::ForceDisplacement
            || !matches!(mark, Mark::JumpIn | Mark::JumpOut)
    }

    /// Returns the indentation in m at the number `x` on the horizontal axis; `None` if this axis
    /// shows another quantity.
    pub fn indentation(&self, x: f64) -> Option<f64> {
        let is_over_indentation = matches!(
            self.quantities,
            LoopQuantities::ForceIndentation | LoopQuantities::PatchesIndentation
        );
        is_over_indentation.then(|| x * self.indentation.unwrap_or(1.0))
    }

    /// Returns true if the vertical axis is the force.
    pub fn shows_force(&self) -> bool {
        matches!(
            self.quantities,
            LoopQuantities::ForceIndentation
                | LoopQuantities::ForceDisplacement
                | LoopQuantities::ForceTime
        )
    }

    /// Returns the symbols of the horizontal and the vertical quantity: `d` and `F`, or `d/h` and
    /// `F/F_a,max`.
    pub fn symbols(&self) -> (String, String) {
        let [across, up] = self.quantities();
        (across.symbol(), up.symbol())
    }

    /// Returns the quantities on the horizontal and on the vertical axis.
    fn quantities(&self) -> [Quantity; 2] {
        match self.quantities {
            LoopQuantities::ForceIndentation => {
                [self.indentation_quantity(), self.force_quantity()]
            }
            LoopQuantities::ForceDisplacement => {
                [self.displacement_quantity(), self.force_quantity()]
            }
            LoopQuantities::ForceTime => [TIME, self.force_quantity()],
            LoopQuantities::LengthForce => [self.force_quantity(), self.length_quantity()],
            LoopQuantities::PatchesIndentation => [self.indentation_quantity(), PATCHES],
        }
    }

    fn indentation_quantity(&self) -> Quantity {
        Quantity {
            name: "indentation",
            symbol: "d",
            unit: "m",
            divisor: Divisor::new(self.indentation, "h"),
            value: |recorded| recorded.point.indentation,
        }
    }

    fn displacement_quantity(&self) -> Quantity {
        Quantity {
            name: "displacement",
            symbol: "D",
            unit: "m",
            divisor: Divisor::new(self.indentation, "h"),
            value: |recorded| recorded.point.displacement(recorded.stiffness),
        }
    }

    fn force_quantity(&self) -> Quantity {
        Quantity {
            name: "force",
            symbol: "F",
            unit: "N",
            divisor: Divisor::new(self.force, "F_a,max"),
            value: |recorded| recorded.point.force,
        }
    }

    fn length_quantity(&self) -> Quantity {
        Quantity {
            name: "contact length",
            symbol: "l",
            unit: "m",
            divisor: Divisor::new(self.length, "L"),
            value: |recorded| recorded.point.contact_length,
        }
    }

    /// Returns the horizontal and the vertical axis of a chart that contains these points.
    fn axes(&self, places: &[(f64, f64)]) -> [ChartAxis; 2] {
        let [across, up] = self.quantities();
        let x = Span::around(places.iter().map(|place| place.0), 0.06);
        let mut y = Span::around(places.iter().map(|place| place.1).chain([0.0]), 0.08);
        if up.symbol != "F" {
            // The vertical quantity is a length or a number of patches, which is never negative.
            y.low = 0.0;
        }
        [across.axis(x), up.axis(y)]
    }
}

const PATCHES: Quantity = Quantity {
    name: "contact patches",
    symbol: "n",
    unit: "1",
    divisor: None,
    value: |recorded| recorded.point.patches as f64,
};

const TIME: Quantity = Quantity {
    name: "time",
    symbol: "t",
    unit: "s",
    divisor: None,
    value: |recorded| recorded.seconds,
};

/// Force loop in a chart: the curves of loading and unloading, and how they are drawn.
#[derive(Clone, Debug, Default)]
pub struct ForceLoop<'a> {
    /// Force curve of each loading stage.
    pub curves: Vec<LoopCurve<'a>>,
    /// Stiffness of the instrument in N/m; `None` for a rigid instrument.
    pub stiffness: Option<f64>,
    /// Marked points of the curves, such as preload and pull-off.
    pub marks: Vec<MarkedPoint>,
    /// Name of the loop in the legend; `None` for the two names `loading` and `unloading`.
    pub name: Option<Label>,
    /// True if the names of the marked points in the legend are written without the forces.
    pub without_forces: bool,
    /// Meaning of the whole loop, which determines its colour. With `None`, the loading has
    /// [`Ink::Press`], and the unloading has [`Ink::Pull`].
    pub ink: Option<Ink>,
    /// Pattern of the lines of loading and unloading. With `None`, the loading is dotted, and the
    /// unloading has the pattern [`Self::unloading`].
    pub stroke: Option<Stroke>,
    /// Pattern of the line of the unloading if [`Self::stroke`] is `None`. With `None`, this line
    /// is solid.
    pub unloading: Option<Stroke>,
}

/// Force curve of a loading stage.
#[derive(Clone, Copy, Debug)]
pub struct LoopCurve<'a> {
    /// Direction of the stage.
    pub direction: Direction,
    /// Points of the curve.
    pub points: &'a [CurvePoint],
    /// Time in s since first touch at each point; empty if the body does not relax.
    pub seconds: &'a [f64],
}

/// Part of a force loop that the chart shows as one line.
struct LoopLine {
    direction: Direction,
    /// Points in the units of the axes.
    places: Vec<(f64, f64)>,
    /// True if this part is a jump of the instrument, which the chart shows in another style.
    jumps: bool,
}

impl<'a> ForceLoop<'a> {
    /// Creates the loop of the loading stages of a history, with the marked points of the history
    /// and a rigid instrument.
    pub fn new(stages: &'a [StageRecord]) -> ForceLoop<'a> {
        let curves = stages
            .iter()
            .map(|stage| LoopCurve {
                direction: stage.direction,
                points: &stage.curve,
                seconds: &stage.seconds,
            })
            .collect();
        ForceLoop {
            curves,
            marks: Mark::all(stages),
            ..ForceLoop::default()
        }
    }

    /// Creates the loop of a computed scene, with the marked points of its history and the
    /// instrument of the scene.
    pub fn of_outcome(outcome: &'a Outcome) -> ForceLoop<'a> {
        let stiffness = outcome.instrument.map(|instrument| instrument.stiffness);
        ForceLoop {
            stiffness,
            ..ForceLoop::new(&outcome.history.stages)
        }
    }

    /// Returns the lines of the loop. Over the displacement of an instrument, a curve is divided
    /// into several lines, because steady parts and jumps are drawn in different styles.
    fn lines(&self, units: LoopUnits) -> Vec<LoopLine> {
        let units = LoopUnits {
            stiffness: self.stiffness.or(units.stiffness),
            ..units
        };
        let is_over_displacement = units.quantities == LoopQuantities::ForceDisplacement;
        let mut lines = Vec::new();
        for curve in &self.curves {
            let direction = curve.direction;
            if let Some(stiffness) = self.stiffness
                && is_over_displacement
            {
                let curve = DisplacementCurve::new(direction, curve.points, stiffness);
                for part in curve.steady_parts() {
                    lines.push(LoopLine::of_displacements(direction, part, false, units));
                }
                for part in curve.jumps() {
                    lines.push(LoopLine::of_displacements(direction, part, true, units));
                }
            } else {
                let mut places = Vec::with_capacity(curve.points.len());
                for (index, point) in curve.points.iter().enumerate() {
                    places.extend(units.place(point, curve.seconds.get(index).copied()));
                }
                lines.push(LoopLine {
                    direction,
                    places,
                    jumps: false,
                });
            }
        }
        lines
    }

    fn layers(&self, units: LoopUnits) -> Vec<Layer> {
        let mut layers = Vec::new();
        for direction in [Direction::Loading, Direction::Unloading] {
            let name = self.legend_name(direction);
            let ink = self.ink.unwrap_or(match direction {
                Direction::Loading => Ink::Press,
                Direction::Unloading => Ink::Pull,
            });
            let stroke = self.stroke_of(direction);
            for line in self.lines(units) {
                if line.direction != direction {
                    continue;
                }
                layers.push(if line.jumps {
                    Layer::unnamed(ink, Shape::line(line.places, Stroke::Dashed))
                } else {
                    Layer::new(name.clone(), ink, Shape::line(line.places, stroke))
                });
            }
        }
        for marked in &self.marks {
            let mark = marked.mark;
            let Some(place) = units.place_of_mark(marked).filter(|_| units.shows(mark)) else {
                continue;
            };
            let name = if self.name.is_some() {
                Label::default()
            } else if self.without_forces {
                Label::plain(mark.name())
            } else {
                mark_name(mark, marked.point.force)
            };
            let shape = Shape::signs(vec![place], sign(mark));
            layers.push(Layer::new(name, self.ink.unwrap_or(Ink::Text), shape));
        }
        layers
    }

    /// Returns the name in the legend for the lines of a direction; empty if these lines are not in
    /// the legend.
    fn legend_name(&self, direction: Direction) -> Label {
        let Some(name) = &self.name else {
            return Label::plain(match direction {
                Direction::Loading => "loading",
                Direction::Unloading => "unloading",
            });
        };
        // If the loop has a name, only one direction has an entry in the legend: the unloading or,
        // if there is none, the loading.
        let unloads = self
            .curves
            .iter()
            .any(|curve| curve.direction == Direction::Unloading);
        let named_direction = if unloads {
            Direction::Unloading
        } else {
            Direction::Loading
        };
        if direction == named_direction {
            name.clone()
        } else {
            Label::default()
        }
    }

    fn stroke_of(&self, direction: Direction) -> Stroke {
        self.stroke.unwrap_or(match direction {
            Direction::Loading => Stroke::Dotted,
            Direction::Unloading => self.unloading.unwrap_or(Stroke::Solid),
        })
    }
}

impl LoopLine {
    /// Returns the line for a part of a curve over the displacement of the instrument.
    fn of_displacements(
        direction: Direction,
        part: &[DisplacementPoint],
        jumps: bool,
        units: LoopUnits,
    ) -> Self {
        let mut places = Vec::with_capacity(part.len());
        for point in part {
            let point = CurvePoint {
                indentation: point.indentation,
                force: point.force,
                ..CurvePoint::default()
            };
            places.extend(units.place(&point, None));
        }
        LoopLine {
            direction,
            places,
            jumps,
        }
    }
}

/// Returns one chart of all `loops`. `units` states the quantities on the two axes and their units.
/// Each loop is drawn over the loops before it.
pub fn loop_chart(loops: &[ForceLoop<'_>], units: LoopUnits) -> Chart {
    let mut places = Vec::new();
    let mut layers = vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))];
    for force_loop in loops {
        for line in force_loop.lines(units) {
            places.extend(line.places);
        }
        layers.extend(force_loop.layers(units));
    }
    let [x, y] = units.axes(&places);
    Chart::new(x, y, layers)
}

/// Returns a figure in which one chart shows the force curves of all computed scenes. Each scene is
/// given with its title.
pub fn force_figure(scenes: &[(&str, &Outcome)], units: LoopUnits) -> Figure {
    if let [(title, outcome)] = scenes {
        let force_loop = ForceLoop::new(&outcome.history.stages);
        return Figure::of_chart(title, loop_chart(&[force_loop], units));
    }
    let strokes = [Stroke::Solid, Stroke::Dashed, Stroke::DashDotted];
    let mut loops = Vec::with_capacity(scenes.len());
    for (number, (title, outcome)) in scenes.iter().enumerate() {
        loops.push(ForceLoop {
            name: Some(Label::plain(title)),
            ink: Some(Ink::Series(number)),
            unloading: Some(strokes[number % strokes.len()]),
            ..ForceLoop::new(&outcome.history.stages)
        });
    }
    let mut chart = loop_chart(&loops, units);
    // The legend explains the stroke of loading and the marked points only once for all loops.
    let loading = Shape::line(Vec::new(), Stroke::Dotted);
    chart
        .layers
        .push(Layer::new("loading".into(), Ink::Text, loading));
    for mark in [Mark::JumpIn, Mark::Preload, Mark::PullOff, Mark::JumpOut] {
        let mut marks = loops.iter().flat_map(|force_loop| &force_loop.marks);
        if units.shows(mark) && marks.any(|marked| marked.mark == mark) {
            let shape = Shape::signs(Vec::new(), sign(mark));
            chart
                .layers
                .push(Layer::new(mark.name().into(), Ink::Text, shape));
        }
    }
    Figure::of_chart("", chart)
}

/// Returns a figure with a chart for each computed scene, which shows the force curve of this
/// scene. Each scene is given with its title.
pub fn force_panels(scenes: &[(&str, &Outcome)]) -> Figure {
    let mut figures = Vec::with_capacity(scenes.len());
    for (title, outcome) in scenes {
        let force_loop = ForceLoop {
            without_forces: true,
            ..ForceLoop::new(&outcome.history.stages)
        };
        let chart = loop_chart(&[force_loop], LoopUnits::default());
        let force = outcome.figures.pull_off_force;
        let note = force.map(|force| value_label("", "F_a", "N", force));
        figures.push(Figure {
            notes: note.into_iter().collect(),
            size: Figure::SMALL,
            ..Figure::of_chart(title, chart)
        });
    }
    Figure::of_panels(figures)
}

/// Returns the marker for a marked point in charts of force curves, such as ▼ for the pull-off.
pub fn sign(mark: Mark) -> Sign {
    match mark {
        Mark::JumpIn => Sign::HollowDiamond,
        Mark::Preload => Sign::Up,
        Mark::PullOff => Sign::Down,
        Mark::JumpOut => Sign::Ring,
    }
}

/// Returns the name of a marked point with the force at this point in N: `pull-off F_a = 2 µN`.
fn mark_name(mark: Mark, force: f64) -> Label {
    let value = match mark {
        Mark::Preload => value_label("", "F_n", "N", force),
        Mark::PullOff => value_label("", "F_a", "N", -force),
        Mark::JumpIn | Mark::JumpOut => value_label("", "F", "N", force),
    };
    Label::plain(mark.name()).then(" ").join(&value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    #[test]
    fn a_force_curve_has_its_marks_where_the_figures_are() {
        let document = open("jkr-sphere").unwrap();
        let outcome = asperity_scene::run(&document).unwrap();
        let figure = force_figure(&[("Rough <&>", &outcome)], LoopUnits::default());
        let named: Vec<String> = figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        assert_eq!(named[..2], ["loading", "unloading"]);
        assert!(
            named.iter().any(|name| name.starts_with("preload F_n = ")),
            "{named:?}"
        );
        let figures = &outcome.figures;
        let point = |mark: Mark| {
            let layer = figure.charts[0]
                .layers
                .iter()
                .find(|layer| match layer.shape {
                    Shape::Curve {
                        sign: Some(one),
                        stroke: None,
                        ..
                    } => one == sign(mark),
                    _ => false,
                });
            match &layer.unwrap().shape {
                Shape::Curve { points, .. } => points[0],
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(
            point(Mark::Preload),
            (
                figures.preload_indentation.unwrap(),
                figures.preload.unwrap()
            )
        );
        assert_eq!(
            point(Mark::PullOff),
            (
                figures.pull_off_indentation.unwrap(),
                -figures.pull_off_force.unwrap()
            )
        );
    }
}
