//! The curves of the force pane: the loop of the scene, its former loop, ghosts, measured points,
//! the path of manual loading and the loops of square surfaces.

use crate::explorer::app::App;
use crate::explorer::ghost::Ghost;
use crate::explorer::snapshot::FollowedPath;
use asperity_contact::{CurvePoint, Direction, Mark};
use asperity_plot::{Chart, Ink, Label, Layer, Shape, Sign, Stroke};
use asperity_report::{ForceLoop, LoopCurve, LoopQuantities, LoopUnits, letter, loop_chart};
use asperity_scene::Outcome;
use asperity_study::half_space::SquareLoops;

/// Returns the pair of quantities that the pane shows. It is the pair that the user has chosen, but
/// the force over the time can be shown only for a body that relaxes.
pub fn quantities(app: &App) -> LoopQuantities {
    let chosen = app.view.curve.quantities;
    let is_timed = |outcome| LoopQuantities::of_scene(outcome).contains(&LoopQuantities::ForceTime);
    if chosen == LoopQuantities::ForceTime && !app.outcome().is_some_and(is_timed) {
        return LoopQuantities::default();
    }
    chosen
}

/// Returns true if the chart contains the area of the dissipated energy: only a closed loop of the
/// force over the indentation has this area.
pub fn shows_loss(app: &App) -> bool {
    let is_force_over_indentation = quantities(app) == LoopQuantities::ForceIndentation;
    is_force_over_indentation
        && app
            .outcome()
            .is_some_and(|outcome| outcome.figures.dissipated_energy.is_some())
}

pub fn units(app: &App) -> LoopUnits {
    let quantities = quantities(app);
    match app.outcome() {
        Some(outcome) => LoopUnits::of_scene(quantities, outcome, app.view.curve.normalised),
        None => LoopUnits::si(quantities),
    }
}

/// Returns the stiffness of the instrument of the computed scene in N/m, infinite if the instrument
/// is rigid; `None` before a scene is computed.
pub fn stiffness(app: &App) -> Option<f64> {
    match app.outcome()?.instrument {
        Some(instrument) => Some(instrument.stiffness),
        None => Some(f64::INFINITY),
    }
}

/// Returns the chart with the loop, the curves for comparison, the path of manual loading, and the
/// marks. Each curve is drawn over the curves before it.
pub fn chart(app: &App) -> Option<Chart> {
    app.indentations()?;
    let units = units(app);
    let measured = measured_points(app);
    let bands = bands_of_squares(app);
    let mut loops = Vec::new();
    loops.extend(measured.as_deref().map(measured_loop));
    loops.extend(bands.iter().flat_map(loops_of_band));
    for (number, ghost) in app.ghosts.iter().enumerate() {
        loops.push(ghost_loop(app, number, ghost));
    }
    loops.extend(app.tried_outcome().map(preview_loop));
    loops.push(present_loop(app, app.outcome()?, measured.is_some()));
    loops.extend(app.former_path().map(|followed| path_loop(app, followed)));
    let mut chart = loop_chart(&loops, units);
    for layer in &mut chart.layers {
        if layer.name.to_string() == MEASURED {
            layer.shape = Shape::signs(layer.shape.points(), Sign::Point);
        }
    }
    // Areas are inserted below the curves. Drawn later, they would hide parts of the curves.
    for [lower, _, upper] in &bands {
        let border = lower.iter().chain(upper.iter().rev());
        insert_area(&mut chart, units, Ink::Kept, border);
    }
    if shows_loss(app) {
        let border = app.stages().iter().flat_map(|stage| &stage.curve);
        insert_area(&mut chart, units, Ink::Loop, border);
    }
    Some(chart)
}

/// Inserts an area below the curves of a chart. The points of `border` enclose the area.
fn insert_area<'a>(
    chart: &mut Chart,
    units: LoopUnits,
    ink: Ink,
    border: impl Iterator<Item = &'a CurvePoint>,
) {
    let border = border.filter_map(|point| units.place(point, None));
    let border = border.collect();
    let area = Layer::unnamed(ink, Shape::Inside(border));
    chart.layers.insert(1, area);
}

/// Name of the loops of square surfaces in the legend.
const IN_THREE_DIMENSIONS: &str = "three dimensions";

/// Name of the measured points in the legend.
const MEASURED: &str = "measured";

/// Returns true if the chart can show a measured curve: the force over the indentation or over the
/// displacement.
pub fn shows_measured(app: &App) -> bool {
    units(app).shows_force() && quantities(app) != LoopQuantities::ForceTime
}

/// Returns the points of the measured curve. Returns `None` without a measured curve, before a
/// scene is computed, and if the chart cannot show the curve.
fn measured_points(app: &App) -> Option<Vec<CurvePoint>> {
    if !shows_measured(app) {
        return None;
    }
    let measured = app.edit.measured.as_ref()?;
    Some(measured.points(stiffness(app)?))
}

/// Returns the mean and the scatter of the loops of random square surfaces on an elastic
/// half-space, if the user has switched them on. For each direction of motion there are three
/// curves: the lower end of the scatter, the mean and the upper end.
fn bands_of_squares(app: &App) -> Vec<[Vec<CurvePoint>; 3]> {
    if !app.view.squares || !shows_measured(app) {
        return Vec::new();
    }
    match app.studies.value::<SquareLoops>() {
        Some(loops) => loops.bands(),
        None => Vec::new(),
    }
}

/// Returns a curve that does not belong to the loop of a scene.
fn curve_alone(points: &[CurvePoint]) -> ForceLoop<'_> {
    ForceLoop {
        curves: vec![LoopCurve {
            direction: Direction::Unloading,
            points,
            seconds: &[],
        }],
        ..ForceLoop::new(&[])
    }
}

/// Returns the loop of an outcome, without its marked points.
fn unmarked_loop(outcome: &Outcome) -> ForceLoop<'_> {
    ForceLoop {
        marks: Vec::new(),
        ..ForceLoop::of_outcome(outcome)
    }
}

fn measured_loop(points: &[CurvePoint]) -> ForceLoop<'_> {
    ForceLoop {
        name: Some(MEASURED.into()),
        ink: Some(Ink::Kept),
        ..curve_alone(points)
    }
}

/// Returns the mean and the ends of a band. Only the mean is named: the ends enclose an area.
fn loops_of_band(band: &[Vec<CurvePoint>; 3]) -> [ForceLoop<'_>; 3] {
    let [lower, mean, upper] = band;
    let curves = [
        (lower, Stroke::Sparse, Label::default()),
        (mean, Stroke::Solid, Label::plain(IN_THREE_DIMENSIONS)),
        (upper, Stroke::Sparse, Label::default()),
    ];
    curves.map(|(points, stroke, name)| ForceLoop {
        name: Some(name),
        ink: Some(Ink::Kept),
        stroke: Some(stroke),
        ..curve_alone(points)
    })
}

fn ghost_loop<'a>(app: &App, number: usize, ghost: &'a Ghost) -> ForceLoop<'a> {
    let name = format!("{}: {}", letter(number), differences(app, ghost));
    ForceLoop {
        name: Some(Label::plain(&name)),
        ink: Some(Ink::Compared),
        stroke: Some(Stroke::Dashed),
        ..unmarked_loop(&ghost.outcome)
    }
}

fn preview_loop(outcome: &Outcome) -> ForceLoop<'_> {
    ForceLoop {
        name: Some("preview".into()),
        ink: Some(Ink::Kept),
        stroke: Some(Stroke::DashDotted),
        ..unmarked_loop(outcome)
    }
}

/// Returns the loop of the computed scene. If the scene has changed since, its former loop is drawn
/// in a weaker colour until the new one is computed. Under manual loading it is a reference for the
/// path of the body. A loop over measured points gets a solid line,
/// because a line with gaps could not be seen there.
fn present_loop<'a>(app: &App, outcome: &'a Outcome, is_over_points: bool) -> ForceLoop<'a> {
    let stroke = if is_over_points {
        Some(Stroke::Solid)
    } else {
        None
    };
    if app.edit.path.is_some() {
        ForceLoop {
            name: Some("loading of the scene".into()),
            ink: Some(Ink::Quiet),
            stroke: Some(Stroke::Sparse),
            ..unmarked_loop(outcome)
        }
    } else if app.is_current() {
        ForceLoop {
            stroke,
            ..ForceLoop::of_outcome(outcome)
        }
    } else {
        ForceLoop {
            ink: Some(Ink::Quiet),
            stroke,
            ..unmarked_loop(outcome)
        }
    }
}

/// Returns the curve of the moves of the body under manual loading. If the scene has changed since,
/// the former curve is drawn in a weaker colour until the new one is computed.
fn path_loop<'a>(app: &App, followed: &'a FollowedPath) -> ForceLoop<'a> {
    let path = ForceLoop {
        marks: Mark::all(&followed.stages),
        ..ForceLoop::new(followed.moves())
    };
    let stiffness = stiffness(app).filter(|stiffness| stiffness.is_finite());
    if app.is_current() {
        ForceLoop { stiffness, ..path }
    } else {
        ForceLoop {
            stiffness,
            ink: Some(Ink::Quiet),
            marks: Vec::new(),
            ..path
        }
    }
}

/// Returns the values of a ghost that differ from those of the present scene, as text.
pub fn differences(app: &App, ghost: &Ghost) -> String {
    ghost.changes(&app.edit.document, |change| {
        format!("{} {}", change.name, change.from)
    })
}
