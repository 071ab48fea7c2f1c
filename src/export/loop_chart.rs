//! The chart of force loops: the same in figures of scenes and in the explorer.

use crate::analysis::{Mark, marks};
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::draw::{
    Axis, AxisScale, Chart, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke, value_label,
};
use crate::simulation::Outcome;

/// Two quantities, one over the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoopQuantities {
    #[default]
    ForceIndentation,
    LengthForce,
    /// Number of contact patches over indentation.
    FragmentsIndentation,
}

impl LoopQuantities {
    pub fn next(self) -> Self {
        match self {
            LoopQuantities::ForceIndentation => LoopQuantities::LengthForce,
            LoopQuantities::LengthForce => LoopQuantities::FragmentsIndentation,
            LoopQuantities::FragmentsIndentation => LoopQuantities::ForceIndentation,
        }
    }
}

/// Quantities of a chart of loops, and their units: SI units, or parameters of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopUnits {
    quantities: LoopQuantities,
    /// RMS height h, m.
    indentation: Option<f64>,
    /// Ideal adhesion force F_a,max, N.
    force: Option<f64>,
    /// Length L of the profile, m.
    length: Option<f64>,
}

/// A quantity of a point, over a parameter of the scene with its symbol if there is one.
#[derive(Clone, Copy)]
struct Quantity {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    over: Option<(f64, &'static str)>,
    of: fn(&CurvePoint) -> f64,
}

impl Quantity {
    fn symbol_and_unit(&self) -> (String, &'static str) {
        let Quantity { symbol, unit, over, .. } = *self;
        over.map_or_else(|| (symbol.to_owned(), unit), |(_, over)| (format!("{symbol}/{over}"), "1"))
    }
}

impl LoopUnits {
    pub fn si(quantities: LoopQuantities) -> LoopUnits {
        LoopUnits { quantities, ..LoopUnits::default() }
    }

    /// The parameters of a scene that it has; else SI units.
    pub fn of_scene(quantities: LoopQuantities, outcome: &Outcome) -> LoopUnits {
        let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
        LoopUnits {
            quantities,
            indentation: positive(outcome.governing.amplitude.map(|amplitude| amplitude.rms_height)),
            force: positive(outcome.ideal_adhesion_force),
            length: Some(outcome.line.length),
        }
    }

    /// Place of a point of a curve in the chart.
    pub fn place(&self, point: &CurvePoint) -> (f64, f64) {
        let [x, y] = self.quantities().map(|one| (one.of)(point) / one.over.map_or(1.0, |(over, _)| over));
        (x, y)
    }

    /// Indentation at a number on the horizontal axis, m; `None` where that axis shows the force.
    pub fn indentation(&self, x: f64) -> Option<f64> {
        (self.quantities != LoopQuantities::LengthForce).then(|| x * self.indentation.unwrap_or(1.0))
    }

    /// Symbols of the horizontal and the vertical quantity: `d` and `F`, `d/h` and `F/F_a,max`.
    pub fn symbols(&self) -> (String, String) {
        let [x, y] = self.quantities().map(|one| one.symbol_and_unit().0);
        (x, y)
    }

    /// Quantities across and up.
    fn quantities(&self) -> [Quantity; 2] {
        let one = |name, symbol, unit, over, of| Quantity { name, symbol, unit, over, of };
        let over = |value: Option<f64>, symbol| value.map(|value| (value, symbol));
        let indentation =
            one("indentation", "d", "m", over(self.indentation, "h"), |point| point.indentation);
        let force = one("force", "F", "N", over(self.force, "F_a,max"), |point| point.force);
        let length = one("contact length", "l", "m", over(self.length, "L"), |point| point.contact_length);
        let patches = one("contact patches", "n", "1", None, |point| point.fragments as f64);
        match self.quantities {
            LoopQuantities::ForceIndentation => [indentation, force],
            LoopQuantities::LengthForce => [force, length],
            LoopQuantities::FragmentsIndentation => [indentation, patches],
        }
    }

    /// Horizontal and vertical axis over these places.
    fn axes(&self, places: &[(f64, f64)]) -> [Axis; 2] {
        let x = Span::around(places.iter().map(|place| place.0), 0.06);
        let y = Span::around(places.iter().map(|place| place.1).chain([0.0]), 0.08);
        // There is no negative length or number.
        let low = if self.quantities == LoopQuantities::ForceIndentation { y.low } else { 0.0 };
        let [across, up] = self.quantities();
        [(x, across), (Span { low, ..y }, up)].map(|(span, one)| {
            let (symbol, unit) = one.symbol_and_unit();
            Axis::new(AxisScale::Linear, span, one.name, &symbol, unit)
        })
    }
}

/// A loop of a chart. Without a name, an ink or a stroke of the loop, loading and unloading have their own.
#[derive(Clone, Debug)]
pub struct ForceLoop<'a> {
    /// Curves with their directions.
    pub curves: Vec<(Direction, &'a [CurvePoint])>,
    /// Remarkable points; those of a loop without a name are in the legend.
    pub marks: Vec<(Mark, CurvePoint)>,
    /// Name in the legend.
    pub name: Option<Label>,
    /// False for marks without their forces in the legend, where several charts share it.
    pub forces: bool,
    pub ink: Option<Ink>,
    pub stroke: Option<Stroke>,
}

impl<'a> ForceLoop<'a> {
    /// The loop of a loading history with its marks.
    pub fn new(legs: &'a [LegRecord]) -> ForceLoop<'a> {
        let curves = legs.iter().map(|leg| (leg.direction, leg.curve.as_slice())).collect();
        ForceLoop { curves, marks: marks(legs), name: None, forces: true, ink: None, stroke: None }
    }

    fn layers(&self, units: LoopUnits) -> Vec<Layer> {
        let mut layers = Vec::new();
        // One sample in the legend is enough for a loop with a name.
        let unloads = self.curves.iter().any(|(direction, _)| *direction == Direction::Unloading);
        let named = if unloads { Direction::Unloading } else { Direction::Loading };
        for (direction, name, ink, stroke) in [
            (Direction::Loading, "loading", Ink::Loading, Stroke::Dotted),
            (Direction::Unloading, "unloading", Ink::Unloading, Stroke::Solid),
        ] {
            let name = match &self.name {
                None => Label::plain(name),
                Some(name) if direction == named => name.clone(),
                Some(_) => Label::default(),
            };
            let (ink, stroke) = (self.ink.unwrap_or(ink), self.stroke.unwrap_or(stroke));
            for (_, curve) in self.curves.iter().filter(|curve| curve.0 == direction) {
                let points = curve.iter().map(|point| units.place(point)).collect();
                layers.push(Layer::new(name.clone(), ink, Shape::line(points, stroke)));
            }
        }
        for (mark, point) in &self.marks {
            let name = match self.name {
                None if self.forces => mark_name(*mark, point.force),
                None => Label::plain(mark.name()),
                Some(_) => Label::default(),
            };
            let shape = Shape::signs(vec![units.place(point)], sign(*mark));
            layers.push(Layer::new(name, self.ink.unwrap_or(Ink::Text), shape));
        }
        layers
    }
}

/// Chart of loops, the lowest first, with a line at zero.
pub fn loop_chart(loops: &[ForceLoop<'_>], units: LoopUnits) -> Chart {
    let points = loops.iter().flat_map(|one| &one.curves).flat_map(|(_, curve)| curve.iter());
    let places: Vec<(f64, f64)> = points.map(|point| units.place(point)).collect();
    let [x, y] = units.axes(&places);
    let mut layers = vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0))];
    layers.extend(loops.iter().flat_map(|one| one.layers(units)));
    Chart::new(x, y, layers)
}

/// Force curves of computed scenes with their titles: loading and unloading of one scene in two colours, each of
/// several scenes in one.
pub fn force_figure(scenes: &[(&str, &Outcome)]) -> Figure {
    let units = LoopUnits::default();
    if let [(title, outcome)] = scenes {
        return Figure::of_chart(title, loop_chart(&[ForceLoop::new(&outcome.history.legs)], units));
    }
    let loops = scenes.iter().enumerate().map(|(number, (title, outcome))| ForceLoop {
        name: Some(Label::plain(title)),
        ink: Some(Ink::Series(number)),
        ..ForceLoop::new(&outcome.history.legs)
    });
    let chart = loop_chart(&loops.collect::<Vec<_>>(), units);
    Figure { notes: vec![Label::plain("dotted: loading, solid: unloading")], ..Figure::of_chart("", chart) }
}

/// Force curves of computed scenes with their titles, each over axes of its own, with the adhesion force in the heading.
pub fn force_panels(scenes: &[(&str, &Outcome)]) -> Figure {
    let figure = |(title, outcome): &(&str, &Outcome)| {
        let one = ForceLoop { forces: false, ..ForceLoop::new(&outcome.history.legs) };
        let force = outcome.figures.adhesion_force.map(|force| value_label("", "F_a", "N", force));
        let chart = loop_chart(&[one], LoopUnits::default());
        let notes = force.into_iter().collect();
        Figure { notes, size: Figure::SMALL, ..Figure::of_chart(title, chart) }
    };
    Figure::of_panels(scenes.iter().map(figure).collect())
}

pub fn sign(mark: Mark) -> Sign {
    match mark {
        Mark::JumpIn => Sign::HollowDiamond,
        Mark::Preload => Sign::Up,
        Mark::PullOff => Sign::Down,
        Mark::JumpOut => Sign::Ring,
    }
}

/// Name of a mark with its force.
fn mark_name(mark: Mark, force: f64) -> Label {
    let (symbol, value) = match mark {
        Mark::Preload => ("F_n", force),
        Mark::PullOff => ("F_a", -force),
        Mark::JumpIn | Mark::JumpOut => ("F", force),
    };
    Label::plain(mark.name()).then(" ").join(&value_label("", symbol, "N", value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::parsed;
    use crate::scene::open;

    #[test]
    fn a_force_curve_has_its_marks_where_the_figures_are() {
        let document = open("jkr-sphere").unwrap();
        let outcome = crate::run(document.scene()).unwrap();
        let figure = force_figure(&[("Rough <&>", &outcome)]);
        let named: Vec<String> = figure.legend().iter().map(|entry| entry.name.to_string()).collect();
        assert_eq!(named[..2], ["loading", "unloading"]);
        assert!(named.iter().any(|name| name.starts_with("preload F_n = ")), "{named:?}");
        let figures = &outcome.figures;
        let point = |mark: Mark| {
            let layer = figure.charts[0].layers.iter().find(|layer| match layer.shape {
                Shape::Curve { sign: Some(one), stroke: None, .. } => one == sign(mark),
                _ => false,
            });
            match &layer.unwrap().shape {
                Shape::Curve { points, .. } => points[0],
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(point(Mark::Preload), (figures.preload_indentation.unwrap(), figures.preload.unwrap()));
        assert_eq!(
            point(Mark::PullOff),
            (figures.pull_off_indentation.unwrap(), -figures.adhesion_force.unwrap())
        );
        let text = parsed(&figure.svg()).1;
        assert!(text.contains("Rough <&>") && text.contains("indentation d ("), "{text}");
    }
}
