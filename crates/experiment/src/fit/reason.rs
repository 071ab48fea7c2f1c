//! The reason why a model does not describe a curve, found from the pattern of the residuals.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::{Extent, dot, least_squares, right_angled, subtract_all};
use crate::error::ExperimentError;
use crate::fit::model::Model;
use crate::fit::parameter::{Parameter, Values};
use asperity_data::{Warning, format_quantity, median};
use asperity_scene::{CheckedScene, Simulation};
use serde::{Serialize, Serializer};
use thiserror::Error;

/// Largest jump of the force between two points on a rigid instrument, divided by the pull-off
/// force. A sphere on a rigid instrument jumps by 5/9.
const RIGID: f64 = 0.65;
/// Share of the squared residuals that a pattern must explain.
const EXPLAINS: f64 = 0.4;
/// Slope of the force, divided by the stiffness of the instrument, that the instrument does not
/// allow. The slope is measured in a part of the way from first touch to the turning point, with a
/// smallest number of points.
const STEEPER: f64 = 1.03;
const PRESSED: f64 = 0.2;
const FEWEST: usize = 5;
/// Relative step of a numerical derivative. A change of the force, divided by its range, above the
/// second number is a jump without a derivative.
const STEP: f64 = 1e-3;
const LEAPS: f64 = 0.02;
/// Residual in units of the median above which residuals are cut off. Such points are on the wrong
/// side of a jump.
const CUT: f64 = 5.0;

/// Reason why a model does not describe a measured curve. `Display` writes a reason as one
/// sentence. If an option of `asperity fit` or a field of the scene can remove the cause, the
/// sentence names it.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// The contact reaches the ends of the profile, which should be longer. The value is the length
    /// of the profile in m.
    #[error("{}", Warning::ContactAtEnds { length: *.0 })]
    ShortProfile(f64),
    /// Too few springs are in contact for an accurate force. The value is the largest number of
    /// springs in contact.
    #[error("{}", Warning::FewSpringsInContact { springs: *.0 })]
    CoarseProfile(u64),
    /// The measured force jumps by this value in N between two points, but the instrument of the
    /// scene is rigid.
    #[error(
        "The force jumps by {} between two points, but the scene has no loading_stiffness: its instrument is rigid.",
        format_quantity(*.0, "N")
    )]
    Rigid(f64),
    /// The measured force without contact changes along a straight line over time.
    #[error("The force drifts over time where nothing touches: --drift remove takes it off.")]
    Drift,
    /// The measured force without contact changes along a straight line over the displacement.
    #[error(
        "The force has a slope over the displacement where nothing touches: --tilt remove takes it off."
    )]
    Tilt,
    /// The measured force without contact changes over time and also over the displacement.
    #[error(
        "The force has slopes over time and displacement where nothing touches: --drift remove --tilt remove takes them off."
    )]
    DriftAndTilt,
    /// The measured forces before and after contact differ by this value in N.
    #[error(
        "The force differs by {} before and after contact, by drag of a fluid or the like: --segments 2 fits the retraction \
         alone.",
        format_quantity(*.0, "N")
    )]
    Step(f64),
    /// The attraction reaches too far for JKR theory. The value is the Tabor number, which is below
    /// 5.
    #[error("{}", Warning::of_tabor_number(*.0).map_or_else(String::new, |warning| warning.to_string()))]
    TaborNumber(f64),
    /// The profile of the scene is one of many random profiles, and the specimen has another
    /// profile.
    #[error(
        "The profile of the scene is one of many random ones, and the specimen has another one: --profiles compares the curve with \
         many of them."
    )]
    OtherProfile,
    /// Approach and retraction differ more than in an elastic contact with a single work of
    /// adhesion.
    #[error(
        "Approach and retraction differ as those of an elastic body do not: it relaxes (viscoelasticity), or adheres less on \
         closing. --free {} tries the second, --segments 2 fits the retraction alone.",
        Parameter::ClosingWork.name()
    )]
    Branches,
    /// The measured force rises over the displacement with this slope in N/m, which is larger than
    /// the stiffness of the instrument in the scene.
    #[error(
        "The force rises by {} over the displacement, more than the loading_stiffness of the scene allows.",
        format_quantity(*.0, "N/m")
    )]
    Stiffness(f64),
    /// Approach and retraction deviate from the model in the same way. The stiffness of the
    /// instrument, the form or the profile of the scene is likely to be wrong.
    #[error(
        "Approach and retraction deviate alike: the instrument has another stiffness (--free stiffness tries that), or the body \
         another form or profile."
    )]
    StiffnessOrForm,
    /// No other reason was found. The form or the profile of the scene is likely to be wrong.
    #[error("Another form or profile than that of the scene is likely.")]
    Form,
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Finds the reason why a scene with these values and free parameters does not describe a curve.
///
/// # Errors
/// A computation fails.
pub(crate) fn reason(
    curve: &MeasuredCurve,
    scene: &CheckedScene,
    simulation: &mut Simulation,
    (values, free): (&Values, &[Parameter]),
    tabor: Option<f64>,
) -> Result<Reason, ExperimentError> {
    if let Some(reason) = of_profile(scene, simulation) {
        return Ok(reason);
    }
    let is_rigid = scene.loading_stiffness.is_none() && !free.contains(&Parameter::Stiffness);
    let jump = largest_jump(curve);
    if is_rigid
        && curve
            .pull_off_force()
            .is_some_and(|force| jump > RIGID * force)
    {
        return Ok(Reason::Rigid(jump));
    }
    let mut model = Model::new(curve, scene, simulation);
    let forces = model.forces(values)?;
    let mut rests: Vec<f64> = curve
        .force
        .iter()
        .zip(&forces)
        .map(|(force, model)| force - model)
        .collect();
    let lines = curve.lines(free.contains(&Parameter::Zero));
    subtract_all(&mut rests, &lines);
    let squares = dot(&rests, &rests);
    let residual = (squares / rests.len() as f64).sqrt();
    let [drift, tilt, step] = curve.remaining.map(|slope| slope.abs() > residual);
    match (drift, tilt) {
        (true, true) => return Ok(Reason::DriftAndTilt),
        (true, false) => return Ok(Reason::Drift),
        (false, true) => return Ok(Reason::Tilt),
        (false, false) => {}
    }
    if step && curve.segment.first() != curve.segment.last() {
        return Ok(Reason::Step(curve.remaining[2]));
    }
    let low = tabor.filter(|number| *number < Warning::JKR_TABOR_NUMBER);
    if let Some(number) = low.filter(|number| *number < Warning::LEAST_TABOR_NUMBER) {
        return Ok(Reason::TaborNumber(number));
    }
    let stiffness = values[Parameter::Stiffness as usize];
    let is_stated = stiffness.is_finite() && !free.contains(&Parameter::Stiffness);
    let slope = slope_when_pressed(curve);
    if is_stated && slope > STEEPER * stiffness {
        return Ok(Reason::Stiffness(slope));
    }
    if scene.seed().is_some() {
        return Ok(Reason::OtherProfile);
    }
    if curve.segment.first() != curve.segment.last()
        && branches_differ(curve, &mut model, (values, free), (&forces, rests, lines))?
    {
        return Ok(Reason::Branches);
    }
    let other = if is_stated {
        Reason::StiffnessOrForm
    } else {
        Reason::Form
    };
    Ok(low.map_or(other, Reason::TaborNumber))
}

/// Returns the reason if the contact reaches the ends of its profile or has few springs.
pub(crate) fn of_profile(scene: &CheckedScene, simulation: &mut Simulation) -> Option<Reason> {
    let outcome = simulation.compute(scene).ok()?;
    outcome.warnings.iter().find_map(|warning| match warning {
        Warning::ContactAtEnds { length } => Some(Reason::ShortProfile(*length)),
        Warning::FewSpringsInContact { springs } => Some(Reason::CoarseProfile(*springs)),
        _ => None,
    })
}

/// Returns the largest rise of the force in N between neighbouring points of a retraction. The
/// force of a retraction rises only where contact is lost.
fn largest_jump(curve: &MeasuredCurve) -> f64 {
    let pairs = curve.segment.windows(2).zip(curve.force.windows(2));
    let retracting = pairs.filter(|(segment, _)| segment[0] == segment[1] && segment[0] % 2 == 1);
    retracting
        .map(|(_, force)| force[1] - force[0])
        .fold(0.0, f64::max)
}

/// Returns the slope of the force over the displacement in N/m, in the last fifth of the first
/// approach or in the first fifth of a retraction.
fn slope_when_pressed(curve: &MeasuredCurve) -> f64 {
    let (touch, turn) = (curve.touch, curve.turns[0]);
    let first = curve
        .segment
        .iter()
        .zip(curve.displacement.iter().zip(&curve.force));
    let pressed = first.filter(|(segment, (at, _))| {
        Some(*segment) == curve.segment.first() && **at > turn - PRESSED * (turn - touch)
    });
    let points: Vec<(f64, f64)> = pressed
        .map(|(_, (at, force))| (at - turn, *force))
        .collect();
    let columns = [
        vec![1.0; points.len()],
        points.iter().map(|point| point.0).collect(),
    ];
    let forces: Vec<f64> = points.iter().map(|point| point.1).collect();
    let slope = (points.len() >= FEWEST)
        .then(|| least_squares(&columns, &forces))
        .flatten();
    // Less what the noise may add.
    slope.map_or(0.0, |found| found[1].value - 3.0 * found[1].error)
}

/// Returns true if another modulus or work of adhesion on the retractions explains most of the
/// residuals, together with small changes of the free parameters. All effects are taken as linear.
fn branches_differ(
    curve: &MeasuredCurve,
    model: &mut Model<'_>,
    (values, free): (&Values, &[Parameter]),
    (forces, mut rests, mut columns): (&[f64], Vec<f64>, Vec<Vec<f64>>),
) -> Result<bool, ExperimentError> {
    let range = Extent::of(curve.force.iter().copied()).width();
    let mut change = |parameter: Parameter| -> Result<Vec<f64>, ExperimentError> {
        let mut moved = *values;
        let unit = match parameter {
            Parameter::Offset => curve.turns[0] - values[Parameter::Offset as usize],
            Parameter::Zero => range,
            _ => -values[parameter as usize],
        };
        moved[parameter as usize] += STEP * unit;
        let most = moved[Parameter::Work as usize];
        moved[Parameter::ClosingWork as usize] = moved[Parameter::ClosingWork as usize].min(most);
        let changed = model.forces(&moved)?;
        let is_leap = |change: f64| change.is_nan() || change.abs() > LEAPS * range;
        let changes = changed.iter().zip(forces).map(|(one, other)| one - other);
        Ok(changes
            .map(|change| if is_leap(change) { 0.0 } else { change })
            .collect())
    };
    for parameter in free {
        columns.push(change(*parameter)?);
    }
    let mut candidates = vec![change(Parameter::Modulus)?];
    if values[Parameter::Work as usize] > 0.0 {
        candidates.push(change(Parameter::Work)?);
    }
    // A point on the wrong side of a jump counts no more than others.
    let mut sizes: Vec<f64> = rests[curve.free..].iter().map(|rest| rest.abs()).collect();
    let most = CUT * median(&mut sizes).unwrap_or(0.0);
    rests
        .iter_mut()
        .for_each(|rest| *rest = rest.clamp(-most, most));
    let basis = right_angled(&columns);
    let rest_of = |column: &mut Vec<f64>| subtract_all(column, &basis);
    rest_of(&mut rests);
    let whole = dot(&rests, &rests);
    let explains = |mut column: Vec<f64>| {
        let of_approach = column
            .iter_mut()
            .zip(&curve.segment)
            .filter(|(_, segment)| **segment % 2 == 0);
        of_approach.for_each(|(one, _)| *one = 0.0);
        rest_of(&mut column);
        dot(&rests, &column).powi(2) > EXPLAINS * dot(&column, &column) * whole
    };
    Ok(candidates.into_iter().any(explains))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::from_text;
    use crate::fit::scene::values_of;
    use crate::read::options::CurveOptions;
    use asperity_scene::{Document, open};
    use std::fmt::Write;

    const HERTZ: [(&str, &str); 6] = [
        ("form.radius", "7.5e-6"),
        ("length", "2.4e-5"),
        ("material", "(effective_modulus: 2e6)"),
        ("adhesion", "None"),
        ("loading_stiffness", "3"),
        ("numerics.points", "256"),
    ];

    fn scene(changes: &[(&str, &str)]) -> Document {
        let changes = changes
            .iter()
            .map(|(path, value)| ((*path).to_owned(), (*value).to_owned()));
        open("jkr-sphere")
            .unwrap()
            .set_all(&changes.collect::<Vec<_>>())
            .unwrap()
    }

    /// Force, N, of a sphere of 7.5 µm without adhesion at a displacement, m, of an instrument of 3
    /// N/m, by bisection of d
    /// + F/k.
    fn hertz(modulus: f64, at: f64) -> f64 {
        let force = |d: f64| 4.0 / 3.0 * modulus * (7.5e-6 * d.powi(3)).sqrt();
        let (mut low, mut high) = (0.0, at.max(0.0));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *if middle + force(middle) / 3.0 < at {
                &mut low
            } else {
                &mut high
            } = middle;
        }
        force(low)
    }

    /// The reason found for a curve of these points (displacement in µm from first touch, force in
    /// µN, noise of 1 nN) and a scene.
    fn found(points: impl Iterator<Item = (f64, f64)>, changes: &[(&str, &str)]) -> Reason {
        let mut text = "displacement [um],force [uN]\n".to_owned();
        for (index, (at, force)) in points.enumerate() {
            writeln!(
                text,
                "{at},{}",
                force + if index % 2 == 0 { 1e-3 } else { -1e-3 }
            )
            .unwrap();
        }
        let curve = from_text(&text, &CurveOptions::default()).unwrap();
        let document = curve
            .load(&scene(&[&HERTZ, changes].concat()), 0.0)
            .unwrap();
        let mut simulation = Simulation::default();
        let (_, governing) = simulation.contact(document.scene()).unwrap();
        let values = values_of(document.scene(), &governing);
        let tabor = governing.tabor_number(document.scene());
        let free = [Parameter::Modulus, Parameter::Offset];
        reason(
            &curve,
            document.scene(),
            &mut simulation,
            (&values, &free),
            tabor,
        )
        .unwrap()
    }

    /// Points of an approach and a retraction between −1 and 1 µm, with these forces, N, as
    /// functions of displacement, m, and time from 0 to 1.
    fn curve(
        approach: impl Fn(f64, f64) -> f64,
        retraction: impl Fn(f64, f64) -> f64,
    ) -> Vec<(f64, f64)> {
        let point = |index: i32| {
            let time = f64::from(index) / 399.0;
            let at = if index < 200 {
                f64::from(index) / 99.5 - 1.0
            } else {
                1.0 - f64::from(index - 199) / 99.5
            };
            (
                at,
                1e6 * if index < 200 {
                    approach(1e-6 * at, time)
                } else {
                    retraction(1e-6 * at, time)
                },
            )
        };
        (0..400).map(point).collect()
    }

    fn elastic(at: f64, _: f64) -> f64 {
        hertz(2e6, at)
    }

    #[test]
    fn each_pattern_has_its_reason() {
        let both = || curve(elastic, elastic).into_iter();
        // A sphere of another modulus is a change by a free parameter.
        assert_eq!(
            found(both(), &[("material", "(effective_modulus: 1.9e6)")]),
            Reason::StiffnessOrForm
        );
        assert_eq!(
            found(both(), &[("loading_stiffness", "None")]),
            Reason::Form
        );
        assert!(
            matches!(found(both(), &[("loading_stiffness", "0.5")]), Reason::Stiffness(slope) if slope > 0.5)
        );
        let stiffer = curve(elastic, |at, _| hertz(2.6e6, at - 1e-7));
        assert_eq!(found(stiffer.into_iter(), &[]), Reason::Branches);
        let tilted = |at: f64, time: f64| elastic(at, time) + 0.1 * at;
        assert_eq!(found(curve(tilted, tilted).into_iter(), &[]), Reason::Tilt);
        let drifts = |at: f64, time: f64| elastic(at, time) - 1e-7 * time;
        assert_eq!(found(curve(drifts, drifts).into_iter(), &[]), Reason::Drift);
        let dragged = curve(elastic, |at, time| elastic(at, time) - 1e-7);
        assert!(
            matches!(found(dragged.into_iter(), &[]), Reason::Step(step) if (step + 1e-7).abs() < 1e-9)
        );
        assert!(
            matches!(found(both(), &[("length", "2e-6")]), Reason::ShortProfile(length) if (length - 2e-6).abs() < 1e-9)
        );
        assert!(matches!(
            found(both(), &[("length", "1e-3")]),
            Reason::CoarseProfile(..)
        ));
        let jumps = curve(elastic, |at, time| {
            if at < 0.0 {
                0.0
            } else {
                elastic(at, time) - 5e-7
            }
        });
        assert!(matches!(
            found(jumps.into_iter(), &[("loading_stiffness", "None")]),
            Reason::Rigid(_)
        ));
        let weak = [("adhesion", "(work: 1e-6)")];
        assert!(matches!(found(both(), &weak), Reason::TaborNumber(number) if number < 1.0));
    }
}
