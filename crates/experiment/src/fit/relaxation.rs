//! Relaxation in a fit: the time of the motion, which the file or the scene states, and the
//! relaxation at which a search begins.

use crate::curve::MeasuredCurve;
use crate::curve::features::CurveFeatures;
use crate::error::{ExperimentError, refused};
use crate::fit::parameter::{Free, Parameter, Values};
use crate::fit::scene::{pause_of, wrong};
use asperity_data::{Note, format_quantity, format_rounded, grouped};
use asperity_scene::text::ron_float;
use asperity_scene::{Document, Scene};

/// Share of the modulus that relaxes at which a search begins, if neither the scene nor the curve
/// shows one.
const USUAL_SHARE: f64 = 0.2;
/// Smallest and largest share of the modulus that relaxes at which a search begins, even if the
/// curve shows a smaller or a larger share.
const SHARES: (f64, f64) = (0.05, 0.8);
/// Time in contact divided by the relaxation time at which a search begins.
const RELAXATIONS: f64 = 10.0;
/// Further relaxation times at which descents begin, divided by the relaxation time at which the
/// search begins.
const OTHER_TIMES: [f64; 3] = [0.1, 10.0, 100.0];
/// Smallest relative difference between two speeds that a sentence reports.
const OTHER_SPEED: f64 = 0.02;

/// Returns the document with the speed and the rest of the instrument, which the times in the file
/// state, and with a relaxation at which a search begins, if it is free.
///
/// # Errors
/// Returns an error for a scene with a relaxation, or for a fit that searches one, in two cases:
/// neither the scene nor the file states a speed, or the curve has more segments than an approach
/// and a retraction.
pub(crate) fn with_relaxation(
    document: &Document,
    curve: &MeasuredCurve,
    free: &[Free],
) -> Result<Document, ExperimentError> {
    let scene = document.scene();
    let is_free = free.iter().any(|free| free.parameter.is_of_relaxation());
    if !is_free && scene.material.relaxation.is_none() {
        return Ok(document.clone());
    }
    let speed = curve.timing.speeds.map(|speeds| speeds.approach);
    let Some(speed) = speed.or(scene.loading_speed) else {
        let found = "relaxation without a speed of the instrument";
        let allowed = "loading_speed in m/s, such as 1.0e-6, or a column of the time in the file";
        return refused(found, allowed);
    };
    if curve.turns.len() > 2 {
        let found = format!("relaxation, and a curve of {} segments", curve.turns.len());
        return refused(
            found,
            "an approach and a retraction, such as segments 1 and 2",
        );
    }
    let mut changes = vec![("loading_speed".to_owned(), ron_float(speed))];
    let rest = curve.timing.rest.unwrap_or(pause_of(scene));
    changes.push(curve.loading(curve.touch, rest));
    if scene.material.relaxation.is_none() {
        let in_contact = seconds_of(curve, speed, rest);
        let share = ron_float(start_share(&curve.features));
        let time = ron_float(in_contact / RELAXATIONS);
        let relaxation = format!("(share: {share}, time: {time})");
        changes.push(("material.relaxation".to_owned(), relaxation));
    }
    document.set_all(&changes).map_err(wrong)
}

/// Returns the time in s that the body spends in contact: the time of both motions, and the time
/// `rest` of the rest between them. Without times in the file, both motions have the speed `speed`
/// in m/s.
fn seconds_of(curve: &MeasuredCurve, speed: f64, rest: f64) -> f64 {
    let way = curve.turns[0] - curve.touch;
    match curve.timing.speeds {
        Some(speeds) => way / speeds.approach + way / speeds.retraction + rest,
        None => 2.0 * way / speed + rest,
    }
}

/// Returns the time in s that the body spends in contact; `None` if the half-space of the scene
/// does not relax.
pub(crate) fn seconds_in_contact(curve: &MeasuredCurve, scene: &Scene) -> Option<f64> {
    scene.material.relaxation?;
    Some(seconds_of(curve, scene.loading_speed?, pause_of(scene)))
}

/// Returns the share that relaxes at which a search begins: the fall of the force in a pause, or
/// half of the hysteresis, whichever is larger.
fn start_share(features: &CurveFeatures) -> f64 {
    let fall = features.fall_in_pause;
    let half = features.hysteresis.map(|hysteresis| 0.5 * hysteresis);
    let shown = fall.unwrap_or(0.0).max(half.unwrap_or(0.0));
    if shown > 0.0 {
        shown.clamp(SHARES.0, SHARES.1)
    } else {
        USUAL_SHARE
    }
}

/// Returns values of all parameters with other relaxation times than `base`; none if the relaxation
/// time is not free.
pub(crate) fn other_relaxations(base: &Values, is_free: impl Fn(Parameter) -> bool) -> Vec<Values> {
    let mut others = Vec::new();
    if is_free(Parameter::RelaxationTime) {
        for ratio in OTHER_TIMES {
            let mut values = *base;
            values[Parameter::RelaxationTime as usize] *= ratio;
            others.push(values);
        }
    }
    others
}

/// Returns sentences on the speed and the rest that a fit with relaxation assumes. `scene` is the
/// scene as the user gave it.
pub(crate) fn notes_on_time(curve: &MeasuredCurve, scene: &Scene) -> Vec<Note> {
    let timing = &curve.timing;
    let mut notes = Vec::new();
    if let Some(speeds) = timing.speeds {
        let speed = format_rounded(speeds.approach, 3, "m/s");
        let mut sentence = format!("Loading speed {speed} by the times of the file");
        if let Some(stated) = scene.loading_speed
            && (speeds.approach / stated - 1.0).abs() > OTHER_SPEED
        {
            let stated = format_quantity(stated, "m/s");
            sentence += &format!(", in place of {stated} of the scene");
        }
        notes.push(Note::new(sentence + "."));
        let ratio = speeds.retraction / speeds.approach;
        if (ratio - 1.0).abs() > OTHER_SPEED {
            let times = format_rounded(ratio, 2, "1");
            notes.push(Note::new(format!(
                "The retraction is {times} times as fast as the approach, in the fit too. The loading_speed of the result is the \
                 speed of the approach."
            )));
        }
        if timing.motions.iter().any(|pieces| pieces.len() > 1) {
            notes.push(Note::new(
                "The speed changes within a motion. The fit follows the times of the points.",
            ));
        }
    }
    let points = grouped(timing.points.len() as u64);
    let rest = timing.rest.unwrap_or(pause_of(scene));
    if timing.rest.is_some() && timing.points.is_empty() {
        // The times of the file show no rest: the instrument turns between two points.
    } else if rest > 0.0 {
        let source = if timing.rest.is_some() {
            "times of the file"
        } else {
            "scene"
        };
        let seconds = format_rounded(rest, 3, "s");
        notes.push(Note::new(format!(
            "Rest of {seconds} between approach and retraction by the {source}; {points} points of the rest are used."
        )));
    } else if !timing.points.is_empty() {
        notes.push(Note::new(format!(
            "The rest between approach and retraction, {points} points, is left out of the model: neither the file nor the \
             loading of the scene states how long it is."
        )));
    }
    if timing.has_other_rests && timing.speeds.is_none() {
        let sentence = "The instrument rests in contact elsewhere too. The model does not.";
        notes.push(Note::new(sentence));
    }
    notes
}
