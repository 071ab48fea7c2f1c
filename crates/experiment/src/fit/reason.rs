//! The reason why a model does not describe a measured curve. The fit finds this reason from the
//! pattern of the residuals.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::{Extent, dot, least_squares, right_angled, subtract_all};
use crate::error::ExperimentError;
use crate::fit::model::Model;
use crate::fit::parameter::{Parameter, Values};
use asperity_data::{Note, Remedy, Warning, format_quantity, format_rounded, median};
use asperity_scene::{CheckedScene, Simulation};
use asperity_surface::Form;
use serde::{Serialize, Serializer};
use thiserror::Error;

/// Largest jump of the force between two points on a rigid instrument, divided by the pull-off
/// force. A sphere on a rigid instrument jumps by 5/9.
const RIGID: f64 = 0.65;
/// Share of the squared residuals that a pattern of the residuals must explain, so that this
/// pattern is stated as the reason why the model does not describe the curve.
const EXPLAINS: f64 = 0.4;
/// Smallest slope of the force over the displacement, divided by the stiffness of the instrument,
/// that is impossible with this instrument. The excess over 1 allows for errors.
const STEEPER: f64 = 1.03;
/// Lengths of the parts of a loading over which the slope of the force is measured, as shares of
/// the way from first touch to the turning point. Each part ends at the turning point.
const PRESSED: [f64; 2] = [0.2, 0.5];
/// Smallest number of points from which the slope of the force is measured.
const FEWEST: usize = 5;
/// Smallest and largest hysteresis in compression, as a share of the loading, that results from a
/// smaller work of adhesion on closing.
const OF_ADHESION: (f64, f64) = (0.03, 0.11);
/// Hysteresis in compression, as a share of the loading, above which the body relaxes.
const RELAXES: f64 = 0.08;
/// Fall of the force in a pause, divided by the largest force, above which the body relaxes.
const FALLS: f64 = 0.02;
/// Relative step of a parameter in a numerical derivative.
const STEP: f64 = 1e-3;
/// Change of the force over a step of [`STEP`], divided by the range of the force, above which the
/// force jumps and has no derivative.
const LEAPS: f64 = 0.02;
/// Largest residual in units of the median magnitude. Larger residuals are reduced to this value,
/// because such points are on the wrong side of a jump.
const CUT: f64 = 5.0;

/// Reason why a model does not describe a measured curve. `Display` writes the reason as one
/// sentence. If a field of the scene can remove the cause, the sentence names this field.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// The contact reaches the ends of the profile, so the profile is too short. The value is the
    /// length of the profile in m.
    #[error("{}", Warning::ContactAtEnds { length: *.0 })]
    ShortProfile(f64),
    /// Too few springs are in contact for an accurate force. The value is the largest number of
    /// springs in contact.
    #[error("{}", Warning::FewSpringsInContact { springs: *.0 })]
    CoarseProfile(u64),
    /// The measured force jumps between two points, although the instrument of the scene is rigid.
    /// The value is the jump in N.
    #[error(
        "The force jumps by {} between two points, but the scene has no loading_stiffness: its instrument is rigid.",
        format_quantity(*.0, "N")
    )]
    Rigid(f64),
    /// The measured force without contact changes along a straight line over time.
    #[error("The force drifts over time where nothing touches.")]
    Drift,
    /// The measured force without contact changes along a straight line over the displacement.
    #[error("The force has a slope over the displacement where nothing touches.")]
    Tilt,
    /// The measured force without contact changes over time and also over the displacement.
    #[error("The force has slopes over time and displacement where nothing touches.")]
    DriftAndTilt,
    /// The measured force without contact is higher after contact than before contact. A drag
    /// cannot be the cause, because a drag makes the force after contact lower. The value is the
    /// difference in N.
    #[error(
        "The force is higher by {} after contact than before.",
        format_quantity(*.0, "N")
    )]
    Step(f64),
    /// The attraction reaches too far for JKR theory. The value is the Tabor number, which must be
    /// at least 5 for this theory.
    #[error("{}", Warning::of_tabor_number(*.0).map_or_else(String::new, |warning| warning.to_string()))]
    TaborNumber(f64),
    /// The profile of the scene is one of many random profiles, and the specimen has another
    /// profile.
    #[error(
        "The profile of the scene is one of many random ones, and the specimen has another one."
    )]
    OtherProfile,
    /// Approach and retraction differ more than they can differ in an elastic contact with a single
    /// work of adhesion.
    #[error(
        "Approach and retraction differ as those of an elastic body do not, because it relaxes (viscoelasticity) or adheres less \
         on closing."
    )]
    Branches,
    /// The measured force rises over the displacement with a slope that is larger than the
    /// stiffness of the instrument. No modulus follows from such a curve. The first value is the
    /// slope, the second value the stiffness, both in N/m.
    #[error(
        "The force rises by {} over the displacement, and an instrument of {} allows no more than its stiffness: the stiffness, \
         the unit or the sensitivity of the force, or the column of the height is wrong, and E* cannot be found.",
        format_quantity(*.0, "N/m"),
        format_quantity(*.1, "N/m")
    )]
    Stiffness(f64, f64),
    /// The fit has found a stiffness of the instrument that differs from the stated one by more
    /// than a wrong calibration explains.
    #[error("{}", far_from_stated(*found, *stated))]
    StiffnessFarFromStated {
        /// Fitted stiffness in N/m.
        found: f64,
        /// Stiffness in N/m that the scene or the file of the curve states.
        stated: f64,
    },
    /// The force jumps more than once in one motion, which the force of a smooth body does not do.
    /// The value is the number of jumps of the curve.
    #[error(
        "The curve has {} jumps, and a smooth sphere has one on loading and one on unloading: the body has another form or \
         several contacts, on which γ and E* depend.",
        .0
    )]
    SeveralContacts(usize),
    /// The hysteresis in compression is as large as for a body whose work of adhesion on closing is
    /// smaller than on opening. The value is the hysteresis divided by the area under the loading
    /// curve.
    #[error(
        "The hysteresis in compression is {} % of the loading, and an elastic body with one work of adhesion has none. Such \
         curves need a smaller work of adhesion on closing.",
        format_rounded(100.0 * .0, 2, "1")
    )]
    HysteresisOfAdhesion(f64),
    /// The body relaxes: its hysteresis in compression is large, or its force falls in a pause. If
    /// it does not fall, the cause may also be a much smaller work of adhesion on closing.
    #[error(
        "The hysteresis in compression is {} % of the loading{}: the body relaxes (viscoelasticity){}. E* by the loading is that \
         of its speed. The retraction alone gives γ.",
        format_rounded(100.0 * .hysteresis, 2, "1"),
        in_pause(*.fall_in_pause),
        if *.may_adhere_less { ", or it adheres far less on closing than on opening" } else { "" }
    )]
    Relaxation {
        /// Hysteresis in compression divided by the area under the loading curve.
        hysteresis: f64,
        /// Largest fall of the force in a pause divided by the largest force; 0 without a pause.
        fall_in_pause: f64,
        /// True if a much smaller work of adhesion on closing is another possible cause: it was
        /// not fitted, and the force does not fall in a pause.
        may_adhere_less: bool,
    },
    /// Approach and retraction deviate from the model in the same way. The stiffness of the
    /// instrument, the form or the profile of the scene is likely to be wrong.
    #[error(
        "Approach and retraction deviate alike, because the body has another form or profile, or the instrument another \
         stiffness."
    )]
    StiffnessOrForm,
    /// No other reason was found. The form or the profile of the scene is likely to be wrong.
    #[error("Another form or profile than that of the scene is likely.")]
    Form,
}

impl Reason {
    /// Returns the reason as a sentence, with the steps that remove the cause.
    pub fn note(&self) -> Note {
        let mut note = Note::new(self.to_string());
        for remedy in self.remedies() {
            note = note.with(remedy);
        }
        note
    }

    fn remedies(&self) -> Vec<Remedy> {
        match self {
            Reason::Drift => vec![Remedy::RemoveDrift],
            Reason::Tilt => vec![Remedy::RemoveTilt],
            Reason::DriftAndTilt => vec![Remedy::RemoveDrift, Remedy::RemoveTilt],
            Reason::Step(_) => vec![Remedy::Segment(2)],
            Reason::OtherProfile => vec![Remedy::ManyProfiles],
            Reason::Branches => vec![free(Parameter::ClosingWork), Remedy::Segment(2)],
            Reason::Stiffness(..) => vec![Remedy::Columns],
            Reason::StiffnessFarFromStated { .. } => vec![Remedy::Units],
            Reason::HysteresisOfAdhesion(_) => vec![free(Parameter::ClosingWork)],
            Reason::Relaxation {
                may_adhere_less: true,
                ..
            } => vec![free(Parameter::ClosingWork), Remedy::Segment(2)],
            Reason::Relaxation { .. } => vec![Remedy::Segment(2)],
            Reason::StiffnessOrForm => vec![free(Parameter::Stiffness)],
            Reason::ShortProfile(_)
            | Reason::CoarseProfile(_)
            | Reason::Rigid(_)
            | Reason::TaborNumber(_)
            | Reason::SeveralContacts(_)
            | Reason::Form => Vec::new(),
        }
    }
}

fn free(parameter: Parameter) -> Remedy {
    Remedy::Free(parameter.name().to_owned())
}

/// Returns the sentence on a fitted stiffness that is far from the stated one.
fn far_from_stated(found: f64, stated: f64) -> String {
    let stated_text = format_rounded(stated, 3, "N/m");
    let (ratio, relation) = if found > stated {
        (found / stated, "times the stated")
    } else {
        (stated / found, "times smaller than the stated")
    };
    let ratio = format_rounded(ratio, 2, "1");
    format!(
        "The stiffness found is {ratio} {relation} {stated_text}, and γ and E* are then wrong by the same factor. Check the \
         units of the force."
    )
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

fn in_pause(fall: f64) -> String {
    if fall <= 0.0 {
        return String::new();
    }
    let fall = format_rounded(100.0 * fall, 2, "1");
    format!(", and the force falls by {fall} % in a pause")
}

/// Finds the reason why a scene with the parameters `values` does not describe a curve. `residuals`
/// are the residuals at all points in units of the noise, and `tabor` is the Tabor number of the
/// scene if the curve shows adhesion.
///
/// # Errors
/// Returns an error if a computation fails.
pub(crate) fn reason(
    curve: &MeasuredCurve,
    scene: &CheckedScene,
    simulation: &mut Simulation,
    values: &Values,
    residuals: &[f64],
    free: &[Parameter],
    tabor: Option<f64>,
) -> Result<Reason, ExperimentError> {
    if let Some(reason) = of_profile(scene, simulation) {
        return Ok(reason);
    }
    let is_stiffness_free = free.contains(&Parameter::Stiffness);
    if scene.loading_stiffness.is_none()
        && !is_stiffness_free
        && let Some(jump) = jump_of_compliance(curve)
    {
        return Ok(Reason::Rigid(jump));
    }
    let mut misfit = Misfit::new(curve, scene, simulation, values, residuals, free)?;
    if let Some(reason) = misfit.change_without_contact() {
        return Ok(reason);
    }
    let low_tabor = tabor.filter(|number| *number < Warning::JKR_TABOR_NUMBER);
    if let Some(number) = low_tabor
        && number < Warning::LEAST_TABOR_NUMBER
    {
        return Ok(Reason::TaborNumber(number));
    }
    if scene.seed().is_some() {
        return Ok(Reason::OtherProfile);
    }
    let contacts = scene.form.as_ref().map_or(1, Form::contacts);
    if scene.roughness.is_none()
        && let Some(reason) = of_features(curve, contacts, free)
    {
        return Ok(reason);
    }
    if has_two_directions(curve) && misfit.branches_differ()? {
        return Ok(Reason::Branches);
    }
    if let Some(number) = low_tabor {
        return Ok(Reason::TaborNumber(number));
    }
    let is_stiffness_stated = scene.loading_stiffness.is_some() && !is_stiffness_free;
    if is_stiffness_stated && has_two_directions(curve) {
        return Ok(Reason::StiffnessOrForm);
    }
    Ok(Reason::Form)
}

/// Returns the reason that the curve of a smooth body with this number of contacts shows by itself.
fn of_features(curve: &MeasuredCurve, contacts: usize, free: &[Parameter]) -> Option<Reason> {
    let features = curve.features;
    if features.jumps_in_one_motion > contacts {
        return Some(Reason::SeveralContacts(features.jumps));
    }
    let hysteresis = features.hysteresis?;
    let fall_in_pause = features.fall_in_pause.unwrap_or(0.0);
    let is_closing_free = free.contains(&Parameter::ClosingWork);
    let is_of_adhesion = (OF_ADHESION.0..OF_ADHESION.1).contains(&hysteresis);
    if is_of_adhesion && fall_in_pause < FALLS && !is_closing_free && has_two_directions(curve) {
        return Some(Reason::HysteresisOfAdhesion(hysteresis));
    }
    let relaxes = hysteresis > RELAXES || fall_in_pause > FALLS;
    relaxes.then_some(Reason::Relaxation {
        hysteresis,
        fall_in_pause,
        may_adhere_less: fall_in_pause <= FALLS && !is_closing_free,
    })
}

/// Returns the slope of the loading over the displacement in N/m, if it is larger than the
/// stiffness of the instrument and this stiffness is not a free parameter; otherwise `None`.
pub(crate) fn steeper_slope(
    curve: &MeasuredCurve,
    values: &Values,
    free: &[Parameter],
) -> Option<f64> {
    let stiffness = values[Parameter::Stiffness as usize];
    let slope = slope_when_pressed(curve);
    let is_stated = stiffness.is_finite() && !free.contains(&Parameter::Stiffness);
    (is_stated && slope > STEEPER * stiffness).then_some(slope)
}

fn has_two_directions(curve: &MeasuredCurve) -> bool {
    curve.segment.first() != curve.segment.last()
}

/// Returns the reason why the profile is unsuitable for a fit: the contact reaches the ends of the
/// profile, or too few springs are in contact. Returns `None` if the profile is suitable.
pub(crate) fn of_profile(scene: &CheckedScene, simulation: &mut Simulation) -> Option<Reason> {
    let outcome = simulation.compute(scene).ok()?;
    outcome.warnings.iter().find_map(|warning| match warning {
        Warning::ContactAtEnds { length } => Some(Reason::ShortProfile(*length)),
        Warning::FewSpringsInContact { springs } => Some(Reason::CoarseProfile(*springs)),
        _ => None,
    })
}

/// Returns the largest jump of the force in N, if it is too large for a rigid instrument; otherwise
/// `None`.
fn jump_of_compliance(curve: &MeasuredCurve) -> Option<f64> {
    let jump = largest_jump(curve);
    let pull_off = curve.pull_off_force()?;
    (jump > RIGID * pull_off).then_some(jump)
}

/// Returns the largest rise of the force in N between neighbouring points of a retraction. In a
/// retraction the force rises only where contact is lost, or gradually after the largest tension.
fn largest_jump(curve: &MeasuredCurve) -> f64 {
    let mut largest = 0.0_f64;
    for (segments, forces) in curve.segment.windows(2).zip(curve.force.windows(2)) {
        if segments[0] == segments[1] && segments[0] % 2 == 1 {
            largest = largest.max(forces[1] - forces[0]);
        }
    }
    largest
}

/// Returns a lower bound of the slope of the force over the displacement in N/m where the body is
/// pressed most: the slope minus three standard errors; 0 for few points.
pub(crate) fn slope_when_pressed(curve: &MeasuredCurve) -> f64 {
    PRESSED
        .into_iter()
        .map(|share| slope_in_last(curve, share))
        .fold(0.0, f64::max)
}

/// Returns the lower bound of the slope in N/m over a share of the way next to the turning point.
/// The points are those of the first segment: an approach, or a retraction alone.
fn slope_in_last(curve: &MeasuredCurve, share: f64) -> f64 {
    let turn = curve.turns[0];
    let least = turn - share * (turn - curve.touch);
    let mut distances = Vec::new();
    let mut forces = Vec::new();
    for ((displacement, force), segment) in curve.points().zip(&curve.segment) {
        if Some(segment) == curve.segment.first() && displacement > least {
            distances.push(displacement - turn);
            forces.push(force);
        }
    }
    if forces.len() < FEWEST {
        return 0.0;
    }
    let columns = [vec![1.0; forces.len()], distances];
    match least_squares(&columns, &forces) {
        Some(coefficients) => coefficients[1].value - 3.0 * coefficients[1].error,
        None => 0.0,
    }
}

/// Deviation of a curve from the model.
struct Misfit<'a> {
    curve: &'a MeasuredCurve,
    model: Model<'a>,
    values: &'a Values,
    free: &'a [Parameter],
    /// Forces of the model in N at the points of the curve.
    forces: Vec<f64>,
    /// Measured forces minus those of the model in N, after a fit of the zero and the other lines.
    residuals: Vec<f64>,
    lines: Vec<Vec<f64>>,
}

impl<'a> Misfit<'a> {
    fn new(
        curve: &'a MeasuredCurve,
        scene: &CheckedScene,
        simulation: &'a mut Simulation,
        values: &'a Values,
        residuals: &[f64],
        free: &'a [Parameter],
    ) -> Result<Self, ExperimentError> {
        let mut model = Model::new(curve, scene, simulation);
        let forces = model.forces(values)?;
        let residuals = residuals
            .iter()
            .map(|residual| residual * curve.noise)
            .collect();
        let lines = right_angled(&curve.lines(free.contains(&Parameter::Zero)));
        Ok(Misfit {
            curve,
            model,
            values,
            free,
            forces,
            residuals,
            lines,
        })
    }

    /// Returns the reason if a drift, tilt or step of the force without contact is larger than the
    /// residual; otherwise `None`.
    fn change_without_contact(&self) -> Option<Reason> {
        let squares = dot(&self.residuals, &self.residuals);
        let residual = (squares / self.residuals.len() as f64).sqrt();
        let [has_drift, has_tilt, has_step] =
            self.curve.remaining.map(|change| change.abs() > residual);
        if has_drift && has_tilt {
            return Some(Reason::DriftAndTilt);
        }
        if has_drift {
            return Some(Reason::Drift);
        }
        if has_tilt {
            return Some(Reason::Tilt);
        }
        let [_, _, step] = self.curve.remaining;
        (has_step && has_two_directions(self.curve)).then_some(Reason::Step(step))
    }

    /// Returns true if most of the residuals can be explained by a modulus or a work of adhesion
    /// that is different on the retractions, together with small changes of the free parameters.
    /// All effects are assumed to be linear.
    fn branches_differ(&mut self) -> Result<bool, ExperimentError> {
        let mut columns = self.lines.clone();
        for parameter in self.free {
            columns.push(self.effect_of(*parameter)?);
        }
        let mut candidates = vec![self.effect_of(Parameter::Modulus)?];
        if self.values[Parameter::Work as usize] > 0.0 {
            candidates.push(self.effect_of(Parameter::Work)?);
        }
        let basis = right_angled(&columns);
        let mut residuals = self.residuals_without_jumps();
        subtract_all(&mut residuals, &basis);
        let whole = dot(&residuals, &residuals);
        for mut effect in candidates {
            for (change, segment) in effect.iter_mut().zip(&self.curve.segment) {
                let is_approach = segment % 2 == 0;
                if is_approach {
                    *change = 0.0;
                }
            }
            subtract_all(&mut effect, &basis);
            let component = dot(&residuals, &effect);
            if component.powi(2) > EXPLAINS * dot(&effect, &effect) * whole {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the residuals after reduction of very large ones, so that points on the wrong side
    /// of a jump have no more influence than others.
    fn residuals_without_jumps(&self) -> Vec<f64> {
        let in_contact = &self.residuals[self.curve.free..];
        let mut sizes: Vec<f64> = in_contact.iter().map(|residual| residual.abs()).collect();
        let most = CUT * median(&mut sizes).unwrap_or(0.0);
        self.residuals
            .iter()
            .map(|residual| residual.clamp(-most, most))
            .collect()
    }

    /// Returns the change of the force in N at each point for a small change of a parameter; 0 at a
    /// jump.
    fn effect_of(&mut self, parameter: Parameter) -> Result<Vec<f64>, ExperimentError> {
        let range = Extent::of(self.curve.force.iter().copied()).width();
        let mut moved = *self.values;
        let unit = match parameter {
            Parameter::Offset | Parameter::Behind => {
                self.curve.turns[0] - self.values[Parameter::Offset as usize]
            }
            Parameter::Zero => range,
            Parameter::RelaxationShare => -1.0,
            _ => -self.values[parameter as usize],
        };
        moved[parameter as usize] += STEP * unit;
        let most = moved[Parameter::Work as usize];
        moved[Parameter::ClosingWork as usize] = moved[Parameter::ClosingWork as usize].min(most);
        let forces = self.model.forces(&moved)?;
        let mut changes = Vec::with_capacity(forces.len());
        for (force, before) in forces.iter().zip(&self.forces) {
            let change = force - before;
            let is_jump = change.is_nan() || change.abs() > LEAPS * range;
            changes.push(if is_jump { 0.0 } else { change });
        }
        Ok(changes)
    }
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
        ("material", "(modulus: 2e6)"),
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

    /// Returns the force in N on a sphere of 7.5 µm without adhesion, for a displacement in m of an
    /// instrument of the stiffness k = 3 N/m. The indentation d solves d + F(d)/k = displacement,
    /// and is found by bisection.
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

    /// Returns the reason that is found for a curve and a scene. The points are pairs of the
    /// displacement in µm from first touch and the force in µN, with a noise of 1 nN.
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
        if let Some(slope) = steeper_slope(&curve, &values, &free) {
            return Reason::Stiffness(slope, values[Parameter::Stiffness as usize]);
        }
        let forces = Model::new(&curve, document.scene(), &mut simulation)
            .forces(&values)
            .unwrap();
        let residuals: Vec<f64> = curve
            .force
            .iter()
            .zip(&forces)
            .map(|(force, model)| (force - model) / curve.noise)
            .collect();
        reason(
            &curve,
            document.scene(),
            &mut simulation,
            &values,
            &residuals,
            &free,
            tabor,
        )
        .unwrap()
    }

    /// Returns the points of an approach and a retraction between −1 and 1 µm. The forces in N are
    /// functions of the displacement in m and of the time from 0 to 1.
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
        // A sphere with another modulus differs only by a free parameter.
        assert_eq!(
            found(both(), &[("material", "(modulus: 1.9e6)")]),
            Reason::StiffnessOrForm
        );
        assert_eq!(
            found(both(), &[("loading_stiffness", "None")]),
            Reason::Form
        );
        assert!(
            matches!(found(both(), &[("loading_stiffness", "0.5")]), Reason::Stiffness(slope, 0.5) if slope > 0.5)
        );
        let stiffer = curve(elastic, |at, _| hertz(2.6e6, at - 1e-7));
        assert!(
            matches!(found(stiffer.into_iter(), &[]), Reason::Relaxation { hysteresis, .. } if (0.11..0.15).contains(&hysteresis))
        );
        let shifted = curve(elastic, |at, _| hertz(2.2e6, at - 3e-8));
        assert!(
            matches!(found(shifted.into_iter(), &[]), Reason::HysteresisOfAdhesion(share) if (0.03..0.11).contains(&share))
        );
        let little = curve(elastic, |at, _| hertz(2.1e6, at - 2e-8));
        assert_eq!(found(little.into_iter(), &[]), Reason::Branches);
        let twice = curve(
            |at, _| {
                elastic(at, 0.0)
                    - if at > 5e-7 { 2e-7 } else { 0.0 }
                    - if at > 8e-7 { 2e-7 } else { 0.0 }
            },
            elastic,
        );
        assert_eq!(found(twice.into_iter(), &[]), Reason::SeveralContacts(2));
        let tilted = |at: f64, time: f64| elastic(at, time) + 0.1 * at;
        assert_eq!(found(curve(tilted, tilted).into_iter(), &[]), Reason::Tilt);
        let drifts = |at: f64, time: f64| elastic(at, time) - 1e-7 * time;
        assert_eq!(found(curve(drifts, drifts).into_iter(), &[]), Reason::Drift);
        let pushed = curve(elastic, |at, time| elastic(at, time) + 1e-7);
        assert!(
            matches!(found(pushed.into_iter(), &[]), Reason::Step(step) if (step - 1e-7).abs() < 1e-9)
        );
        // A force that resists the motion is a drag. It is subtracted when the curve is read, so it
        // is not the reason.
        let dragged = curve(elastic, |at, time| elastic(at, time) - 1e-7);
        assert_eq!(found(dragged.into_iter(), &[]), Reason::StiffnessOrForm);
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
