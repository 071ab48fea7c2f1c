//! The chart of force loops, which is the same in figures of scenes and in the explorer.

use asperity_contact::{CurvePoint, Direction, LegRecord, Mark};
use asperity_data::{AxisScale, format_rounded};
use asperity_plot::{
    Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke, value_label,
};
use asperity_scene::Outcome;
use asperity_scene::instrument::{DisplacementCurve, DisplacementPoint};

/// Two quantities of a force loop that a chart shows. A loop is the curve of loading and unloading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoopQuantities {
    /// Force over the indentation.
    #[default]
    ForceIndentation,
    /// Force over the displacement of the instrument.
    ForceDisplacement,
    /// Total length of all contact patches, over the force.
    LengthForce,
    /// Number of contact patches, over the indentation.
    FragmentsIndentation,
}

impl LoopQuantities {
    /// Returns the pair of quantities that the explorer shows next. If `deflects` is false, as for
    /// a rigid instrument, the pair `ForceDisplacement` is left out.
    pub fn next(self, deflects: bool) -> Self {
        match self {
            LoopQuantities::ForceIndentation if deflects => LoopQuantities::ForceDisplacement,
            LoopQuantities::ForceIndentation | LoopQuantities::ForceDisplacement => {
                LoopQuantities::LengthForce
            }
            LoopQuantities::LengthForce => LoopQuantities::FragmentsIndentation,
            LoopQuantities::FragmentsIndentation => LoopQuantities::ForceIndentation,
        }
    }
}

/// Quantities of a chart of force loops, with the units of its axes: SI units, or parameters of a
/// scene such as the rms height.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopUnits {
    quantities: LoopQuantities,
    /// Loading stiffness, N/m; `None` for a rigid instrument.
    stiffness: Option<f64>,
    /// Rms height h in m as the unit of the indentation; `None` for SI units.
    indentation: Option<f64>,
    /// Ideal adhesion force F_a,max in N as the unit of the force; `None` for SI units.
    force: Option<f64>,
    /// Length L in m as the unit of lengths along the profile; `None` for SI units.
    length: Option<f64>,
}

/// Quantity of a point of the curve, possibly divided by a parameter of the scene.
#[derive(Clone, Copy)]
struct Quantity {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    over: Option<(f64, &'static str)>,
    /// Function that returns the quantity at a point. Its second argument is the stiffness of the
    /// instrument in N/m.
    of: fn(&CurvePoint, f64) -> f64,
}

impl Quantity {
    fn symbol_and_unit(&self) -> (String, &'static str) {
        let Quantity {
            symbol, unit, over, ..
        } = *self;
        over.map_or_else(
            || (symbol.to_owned(), unit),
            |(_, over)| (format!("{symbol}/{over}"), "1"),
        )
    }
}

impl LoopUnits {
    /// Returns these quantities with axes in SI units.
    pub fn si(quantities: LoopQuantities) -> LoopUnits {
        LoopUnits {
            quantities,
            ..LoopUnits::default()
        }
    }

    /// Returns these quantities for a chart of a computed scene. If `normalised` is true, the
    /// indentation is in units of the rms height h, the force in units of F_a,max, and lengths in
    /// units of L; otherwise all are in SI units.
    pub fn of_scene(quantities: LoopQuantities, outcome: &Outcome, normalised: bool) -> LoopUnits {
        let positive = |value: Option<f64>| value.filter(|value| normalised && *value > 0.0);
        LoopUnits {
            stiffness: outcome.instrument.map(|instrument| instrument.stiffness),
            quantities,
            indentation: positive(
                outcome
                    .governing
                    .amplitude
                    .map(|amplitude| amplitude.rms_height),
            ),
            force: positive(outcome.ideal_adhesion_force),
            length: positive(Some(outcome.line.length)),
        }
    }

    /// Returns the numbers on the horizontal and the vertical axis at a point of a force curve.
    pub fn place(&self, point: &CurvePoint) -> (f64, f64) {
        let stiffness = self.stiffness.unwrap_or(f64::INFINITY);
        let [x, y] = self
            .quantities()
            .map(|one| (one.of)(point, stiffness) / one.over.map_or(1.0, |(over, _)| over));
        (x, y)
    }

    /// Returns a force, given in N, as text in the unit of the chart.
    pub fn force_in_words(&self, force: f64) -> String {
        self.force.map_or_else(
            || format_rounded(force, 3, "N"),
            |unit| format_rounded(force / unit, 3, "1"),
        )
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
            LoopQuantities::ForceIndentation | LoopQuantities::FragmentsIndentation
        );
        is_over_indentation.then(|| x * self.indentation.unwrap_or(1.0))
    }

    /// Returns true if the vertical axis is the force.
    pub fn shows_force(&self) -> bool {
        matches!(
            self.quantities,
            LoopQuantities::ForceIndentation | LoopQuantities::ForceDisplacement
        )
    }

    /// Returns the symbols of the horizontal and the vertical quantity: `d` and `F`, or `d/h` and
    /// `F/F_a,max`.
    pub fn symbols(&self) -> (String, String) {
        let [x, y] = self.quantities().map(|one| one.symbol_and_unit().0);
        (x, y)
    }

    fn quantities(&self) -> [Quantity; 2] {
        let one = |name, symbol, unit, over, of| Quantity {
            name,
            symbol,
            unit,
            over,
            of,
        };
        let over = |value: Option<f64>, symbol| value.map(|value| (value, symbol));
        let indentation = one(
            "indentation",
            "d",
            "m",
            over(self.indentation, "h"),
            |point, _| point.indentation,
        );
        let displacement = one(
            "displacement",
            "D",
            "m",
            over(self.indentation, "h"),
            CurvePoint::displacement,
        );
        let force = one(
            "force",
            "F",
            "N",
            over(self.force, "F_a,max"),
            |point, _| point.force,
        );
        let length = one(
            "contact length",
            "l",
            "m",
            over(self.length, "L"),
            |point, _| point.contact_length,
        );
        let patches = one("contact patches", "n", "1", None, |point, _| {
            point.fragments as f64
        });
        match self.quantities {
            LoopQuantities::ForceIndentation => [indentation, force],
            LoopQuantities::ForceDisplacement => [displacement, force],
            LoopQuantities::LengthForce => [force, length],
            LoopQuantities::FragmentsIndentation => [indentation, patches],
        }
    }

    fn axes(&self, places: &[(f64, f64)]) -> [ChartAxis; 2] {
        let x = Span::around(places.iter().map(|place| place.0), 0.06);
        let y = Span::around(places.iter().map(|place| place.1).chain([0.0]), 0.08);
        // There is no negative length or number.
        let [across, up] = self.quantities();
        let low = if up.symbol == "F" { y.low } else { 0.0 };
        [(x, across), (Span { low, ..y }, up)].map(|(span, one)| {
            let (symbol, unit) = one.symbol_and_unit();
            let axis = ChartAxis::new(AxisScale::Linear, span, one.name, &symbol, unit);
            ChartAxis {
                counts: one.symbol == "n",
                ..axis
            }
        })
    }
}

/// Force loop in a chart: the curves of loading and unloading, and how they are drawn.
#[derive(Clone, Debug, Default)]
pub struct ForceLoop<'a> {
    /// Points of the force curve of each loading stage, with the direction of the stage.
    pub curves: Vec<(Direction, &'a [CurvePoint])>,
    /// Stiffness of the instrument in N/m; `None` for a rigid instrument.
    pub stiffness: Option<f64>,
    /// Marked points of the curves, such as preload and pull-off.
    pub marks: Vec<(Mark, CurvePoint)>,
    /// Name of the loop in the legend; `None` for the two names `loading` and `unloading`.
    pub name: Option<Label>,
    /// True if the legend has the names of the marked points without their forces.
    pub without_forces: bool,
    /// Ink of the whole loop; `None` for [`Ink::Loading`] on loading and [`Ink::Unloading`] on
    /// unloading.
    pub ink: Option<Ink>,
    /// Stroke of loading and unloading; `None` for a dotted loading and an unloading with the
    /// stroke [`Self::unloading`].
    pub stroke: Option<Stroke>,
    /// Stroke of the unloading if [`Self::stroke`] is `None`; `None` for a solid line.
    pub unloading: Option<Stroke>,
}

/// Points of a line, in the units of the axes.
type Places = Vec<(f64, f64)>;

impl<'a> ForceLoop<'a> {
    /// Creates the loop of the loading stages of a history, with the marked points of the history
    /// and a rigid instrument.
    pub fn new(legs: &'a [LegRecord]) -> ForceLoop<'a> {
        let curves = legs
            .iter()
            .map(|leg| (leg.direction, leg.curve.as_slice()))
            .collect();
        ForceLoop {
            curves,
            marks: Mark::all(legs),
            ..ForceLoop::default()
        }
    }

    /// Creates the loop of a computed scene, with the marked points of its history and the
    /// instrument of the scene.
    pub fn of_outcome(outcome: &'a Outcome) -> ForceLoop<'a> {
        let stiffness = outcome.instrument.map(|instrument| instrument.stiffness);
        ForceLoop {
            stiffness,
            ..ForceLoop::new(&outcome.history.legs)
        }
    }

    /// Returns the lines of the curves with their directions, and true for a jump of the
    /// instrument.
    fn lines(&self, units: LoopUnits) -> Vec<(Direction, Places, bool)> {
        let units = LoopUnits {
            stiffness: self.stiffness.or(units.stiffness),
            ..units
        };
        let mut lines = Vec::new();
        for &(direction, curve) in &self.curves {
            match self
                .stiffness
                .filter(|_| units.quantities == LoopQuantities::ForceDisplacement)
            {
                None => lines.push((
                    direction,
                    curve.iter().map(|point| units.place(point)).collect(),
                    false,
                )),
                Some(stiffness) => {
                    let curve = DisplacementCurve::new(direction, curve, stiffness);
                    let place = |&DisplacementPoint {
                                     indentation, force, ..
                                 }: &DisplacementPoint| {
                        units.place(&CurvePoint {
                            indentation,
                            force,
                            ..CurvePoint::default()
                        })
                    };
                    let line = |part: &[DisplacementPoint], jumps| {
                        (direction, part.iter().map(place).collect(), jumps)
                    };
                    lines.extend(curve.steady_parts().map(|part| line(part, false)));
                    lines.extend(curve.jumps().map(|part| line(part, true)));
                }
            }
        }
        lines
    }

    fn layers(&self, units: LoopUnits) -> Vec<Layer> {
        let mut layers = Vec::new();
        // One sample in the legend is enough for a loop with a name.
        let unloads = self
            .curves
            .iter()
            .any(|(direction, _)| *direction == Direction::Unloading);
        let named = if unloads {
            Direction::Unloading
        } else {
            Direction::Loading
        };
        for (direction, name, ink, stroke) in [
            (Direction::Loading, "loading", Ink::Loading, Stroke::Dotted),
            (
                Direction::Unloading,
                "unloading",
                Ink::Unloading,
                Stroke::Solid,
            ),
        ] {
            let name = match &self.name {
                None => Label::plain(name),
                Some(name) if direction == named => name.clone(),
                Some(_) => Label::default(),
            };
            let own = self
                .stroke
                .or(self.unloading.filter(|_| direction == Direction::Unloading));
            let (ink, stroke) = (self.ink.unwrap_or(ink), own.unwrap_or(stroke));
            for (_, points, jumps) in self
                .lines(units)
                .into_iter()
                .filter(|line| line.0 == direction)
            {
                let (name, stroke) = if jumps {
                    (Label::default(), Stroke::Dashed)
                } else {
                    (name.clone(), stroke)
                };
                layers.push(Layer::new(name, ink, Shape::line(points, stroke)));
            }
        }
        for (mark, point) in self.marks.iter().filter(|(mark, _)| units.shows(*mark)) {
            let name = match self.name {
                None if !self.without_forces => mark_name(*mark, point.force),
                None => Label::plain(mark.name()),
                Some(_) => Label::default(),
            };
            let shape = Shape::signs(vec![units.place(point)], sign(*mark));
            layers.push(Layer::new(name, self.ink.unwrap_or(Ink::Text), shape));
        }
        layers
    }
}

/// Returns one chart of all `loops`, with axes for the quantities `units`. A loop that is later in
/// the list is drawn over the earlier ones.
pub fn loop_chart(loops: &[ForceLoop<'_>], units: LoopUnits) -> Chart {
    let lines = loops.iter().flat_map(|one| one.lines(units));
    let places: Vec<(f64, f64)> = lines.flat_map(|(_, points, _)| points).collect();
    let [x, y] = units.axes(&places);
    let mut layers = vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))];
    layers.extend(loops.iter().flat_map(|one| one.layers(units)));
    Chart::new(x, y, layers)
}

/// Returns a figure with one chart of the force curves of computed scenes, which are given with
/// their titles.
pub fn force_figure(scenes: &[(&str, &Outcome)], units: LoopUnits) -> Figure {
    if let [(title, outcome)] = scenes {
        return Figure::of_chart(
            title,
            loop_chart(&[ForceLoop::new(&outcome.history.legs)], units),
        );
    }
    let loops = scenes
        .iter()
        .enumerate()
        .map(|(number, (title, outcome))| ForceLoop {
            name: Some(Label::plain(title)),
            ink: Some(Ink::Series(number)),
            unloading: Some([Stroke::Solid, Stroke::Dashed, Stroke::DashDotted][number % 3]),
            ..ForceLoop::new(&outcome.history.legs)
        });
    let loops: Vec<ForceLoop<'_>> = loops.collect();
    let mut chart = loop_chart(&loops, units);
    let is_marked = |mark: &Mark| {
        units.shows(*mark)
            && loops
                .iter()
                .flat_map(|one| &one.marks)
                .any(|(other, _)| other == mark)
    };
    let signs = [Mark::JumpIn, Mark::Preload, Mark::PullOff, Mark::JumpOut]
        .into_iter()
        .filter(is_marked);
    let explained = signs.map(|mark| (mark.name(), Shape::signs(Vec::new(), sign(mark))));
    let loading = ("loading", Shape::line(Vec::new(), Stroke::Dotted));
    let explained = [loading].into_iter().chain(explained);
    chart
        .layers
        .extend(explained.map(|(name, shape)| Layer::new(name.into(), Ink::Text, shape)));
    Figure::of_chart("", chart)
}

/// Returns a figure with a chart for the force curve of each computed scene. The scenes are given
/// with their titles.
pub fn force_panels(scenes: &[(&str, &Outcome)]) -> Figure {
    let figure = |(title, outcome): &(&str, &Outcome)| {
        let one = ForceLoop {
            without_forces: true,
            ..ForceLoop::new(&outcome.history.legs)
        };
        let force = outcome
            .figures
            .adhesion_force
            .map(|force| value_label("", "F_a", "N", force));
        let chart = loop_chart(&[one], LoopUnits::default());
        let notes = force.into_iter().collect();
        Figure {
            notes,
            size: Figure::SMALL,
            ..Figure::of_chart(title, chart)
        }
    };
    Figure::of_panels(scenes.iter().map(figure).collect())
}

/// Returns the marker with which charts of force curves show a marked point, such as ▼ for the
/// pull-off.
pub fn sign(mark: Mark) -> Sign {
    match mark {
        Mark::JumpIn => Sign::HollowDiamond,
        Mark::Preload => Sign::Up,
        Mark::PullOff => Sign::Down,
        Mark::JumpOut => Sign::Ring,
    }
}

fn mark_name(mark: Mark, force: f64) -> Label {
    let (symbol, value) = match mark {
        Mark::Preload => ("F_n", force),
        Mark::PullOff => ("F_a", -force),
        Mark::JumpIn | Mark::JumpOut => ("F", force),
    };
    Label::plain(mark.name())
        .then(" ")
        .join(&value_label("", symbol, "N", value))
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
                -figures.adhesion_force.unwrap()
            )
        );
    }
}
