//! Movement of the body: animation of the scene's loading, or manual loading.

use super::Effect;
use crate::analysis::pull_off_point;
use crate::explorer::config::Animation;
use crate::explorer::model::{ManualState, Model, Player};
use crate::explorer::prompt::Purpose;
use crate::explorer::request::{Focus, ManualMove};
use crate::explorer::snapshot::{ContactSnapshot, Refusal};
use crate::explorer::text_line::TextLine;
use crate::scene::{parse_quantity, quantity_as_typed};
use std::sync::Arc;
use std::time::Duration;

/// Time of the animation for one loading stage, at speed 1.
const LEG_TIME: Duration = Duration::from_secs(6);
/// Steps of the animation in one leg.
const STEPS: f64 = 120.0;
/// Small and large steps of manual loading in the whole range of indentations.
const HAND_STEPS: (f64, f64) = (400.0, 40.0);
/// Most kept points of the path of manual loading.
const PATH_KEPT: usize = 20_000;

/// Begins manual loading, or returns to the loading of the scene.
pub fn toggle_manual(model: &mut Model) -> Vec<Effect> {
    if model.manual.is_some() { animate(model, |_| ()) } else { take(model, None) }
}

/// Presses (positive) or pulls the body by so many steps of manual loading.
pub fn push(model: &mut Model, steps: i32, coarse: bool) -> Vec<Effect> {
    let (low, high) = model.indentations().unwrap_or_default();
    let step = (high - low) / if coarse { HAND_STEPS.1 } else { HAND_STEPS.0 };
    take(model, Some(ManualMove::By(f64::from(steps) * step)))
}

/// Pulls the body until nothing touches.
pub fn separate(model: &mut Model) -> Vec<Effect> {
    take(model, Some(ManualMove::Separate))
}

/// Asks for a target force.
pub fn type_force(model: &mut Model) {
    model.ask(Purpose::Force, TextLine::default());
}

/// Plays or pauses the animation; at its end it begins again.
pub fn toggle_play(model: &mut Model) -> Vec<Effect> {
    animate(model, |model| {
        let at_end = model.player.done >= 1.0 && model.player.leg + 1 >= model.legs().len();
        if at_end && !model.player.playing {
            model.player = Player::START;
        } else {
            model.player.playing = !model.player.playing;
        }
    })
}

/// Moves the paused animation by steps.
pub fn step(model: &mut Model, steps: i32) -> Vec<Effect> {
    animate(model, |model| {
        model.player.playing = false;
        let legs = model.legs().len();
        advance(&mut model.player, f64::from(steps) / STEPS, legs);
    })
}

/// Begins the animation again.
pub fn restart(model: &mut Model) -> Vec<Effect> {
    animate(model, |model| model.player = Player::START)
}

/// Goes to the start of the leg `legs` after this one; back from inside a leg, to its own start first.
pub fn go_to_leg(model: &mut Model, legs: i32) -> Vec<Effect> {
    animate(model, |model| {
        let back = legs < 0 && model.player.done > 0.0;
        let leg = model.player.leg.saturating_add_signed(if back { 0 } else { legs as isize });
        model.player.leg = leg.min(model.legs().len().saturating_sub(1));
        model.player.done = 0.0;
    })
}

/// Goes to the pull-off, while the contact still holds.
pub fn go_to_pull_off(model: &mut Model) -> Vec<Effect> {
    let legs = model.legs();
    let Some((leg, point)) = pull_off_point(legs).filter(|(_, point)| point.force < 0.0) else {
        model
            .set_error("there is no pull-off: the force does not fall below 0 N in the last unloading stage");
        return Vec::new();
    };
    let indentation = point.indentation;
    // Rounding must not pass the indentation: below it springs detach.
    let done = model.done_at(leg, indentation);
    let paused = |done| Player { leg, done, playing: false };
    let ulps = (0..8).map(|ulps| paused(done - f64::from(ulps) * f64::EPSILON));
    let holds = ulps.into_iter().find(|player| player.indentation(legs) >= indentation);
    let player = holds.unwrap_or(paused(done));
    animate(model, |model| model.player = player)
}

/// Changes the animation, which ends manual loading: the animation is the loading of the scene.
fn animate(model: &mut Model, change: impl FnOnce(&mut Model)) -> Vec<Effect> {
    model.manual = None;
    model.moves.clear();
    change(model);
    vec![Effect::Ask]
}

/// Advances the animation by a time.
pub fn elapse(model: &mut Model, time: Duration) -> Vec<Effect> {
    if !model.player.playing || model.legs().is_empty() || !model.is_current() {
        return Vec::new();
    }
    let legs = model.legs().len();
    let player = &mut model.player;
    let Animation { speed, repeats } = model.animation;
    player.done += speed * time.as_secs_f64() / LEG_TIME.as_secs_f64();
    // The distance does not depend on the frame rate: its rest continues on the next leg.
    while player.done > 1.0 && player.leg + 1 < legs {
        player.leg += 1;
        player.done -= 1.0;
    }
    if player.done >= 1.0 && player.leg + 1 >= legs {
        *player = Player {
            leg: if repeats { 0 } else { player.leg },
            done: if repeats { 0.0 } else { 1.0 },
            playing: repeats,
        };
    }
    vec![Effect::Ask]
}

/// Moves the animation by a share of a leg, but not past the boundary to another leg.
fn advance(player: &mut Player, share: f64, legs: usize) {
    player.done += share;
    if player.done > 1.0 && player.leg + 1 < legs {
        player.leg += 1;
        player.done = 0.0;
    } else if player.done < 0.0 && player.leg > 0 {
        player.leg -= 1;
        player.done = 1.0;
    }
    player.done = player.done.clamp(0.0, 1.0);
}

/// Stores a snapshot from the worker.
pub fn shown(model: &mut Model, snapshot: Arc<ContactSnapshot>) {
    // Another snapshot may have been on its way when the fragment was requested.
    if snapshot.focus == model.look.focus && model.look.focus.is_question() {
        let middle = snapshot.close_up.fragment.map(|facts| facts.patch.middle());
        model.look.focus = middle.map_or(Focus::Summit, Focus::Spring);
    }
    if let Some((manual, travel)) = model.manual.as_mut().zip(snapshot.manual.as_ref()) {
        manual.path.extend(&travel.path);
        let old = manual.path.len().saturating_sub(PATH_KEPT);
        manual.path.drain(..old);
        if !travel.path.is_empty() {
            manual.changed = travel.changed;
        }
        manual.released_energy = travel.released_energy;
        if let Some(error) = &travel.refused {
            model.set_error(refusal(error, &model.typed_force));
        }
    }
    model.snapshot = Some(snapshot);
}

/// Reason why the body was not moved, with forces in the unit of the typed one, rounded into the allowed range.
fn refusal(refusal: &Refusal, typed: &str) -> String {
    let force = |value| quantity_as_typed(value, typed, "N");
    match *refusal {
        Refusal::Detaches { smallest } => {
            let least = force(rounded_up(smallest));
            format!("the contact detaches before {}; smallest force within reach: {least}", typed.trim())
        }
        Refusal::BeyondFullContact { full_contact, largest } => {
            let (full, most) = (force(full_contact), force(-rounded_up(-largest)));
            format!("{} is far beyond full contact at {full}; allowed: at most {most}", typed.trim())
        }
        Refusal::Other(ref error) => error.to_string(),
    }
}

/// The nearest number of four digits not below a value.
fn rounded_up(value: f64) -> f64 {
    let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let nearest: f64 = rounded(value);
    let last_digit = 10.0_f64.powi(value.abs().log10().floor() as i32 - 3);
    if nearest >= value { nearest } else { rounded(value + last_digit) }
}

/// Begins manual loading where it has not begun, and moves the body.
pub fn take(model: &mut Model, order: Option<ManualMove>) -> Vec<Effect> {
    if !model.is_current() || model.legs().is_empty() {
        return Vec::new();
    }
    if model.manual.is_none() {
        let (leg, indentation) = (model.player.leg, model.indentation());
        let start = model.present().map(|snapshot| snapshot.point);
        model.player.playing = false;
        model.manual = Some(ManualState { path: start.into_iter().collect(), ..ManualState::default() });
        model.moves.push(ManualMove::Take { leg, indentation });
    }
    model.moves.extend(order);
    vec![Effect::Ask]
}

/// Moves the body to a typed force.
pub fn accept_force(model: &mut Model, typed: &str) -> Result<Vec<Effect>, String> {
    let force = parse_quantity(typed.trim(), "N");
    let force = force.map_err(|error| format!("{error}; for example 10 µN, or -2e-6 to pull"))?;
    model.typed_force = typed.trim().to_owned();
    Ok(take(model, Some(ManualMove::ToForce(force))))
}
