//! Movement of the body: animation of the scene's loading, or manual loading.

use super::Effect;
use crate::explorer::action::Command;
use crate::explorer::config::Animation;
use crate::explorer::mode::Mode;
use crate::explorer::model::{ManualState, Model, Notice, Player};
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
/// Points that are kept of the path of manual loading.
const PATH_KEPT: usize = 20_000;

/// Obeys a command that moves the body.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::ToggleManual if model.manual.is_some() => return give_back(model),
        Command::ToggleManual => return take(model, None),
        Command::Push { steps, coarse } => {
            let (low, high) = model.indentations().unwrap_or_default();
            let step = (high - low) / if coarse { HAND_STEPS.1 } else { HAND_STEPS.0 };
            return take(model, Some(ManualMove::By(f64::from(steps) * step)));
        }
        Command::Separate => return take(model, Some(ManualMove::Separate)),
        Command::TypeForce => {
            model.mode = Mode::Force(TextLine::new(""));
            return Vec::new();
        }
        _ => {}
    }
    // What plays is the scene's loading.
    let mut effects = Vec::new();
    if model.manual.take().is_some() {
        effects.push(Effect::Manual(ManualMove::Give));
    }
    match command {
        Command::TogglePlay => {
            let at_end = model.player.done >= 1.0 && model.player.leg + 1 >= model.legs().len();
            if at_end && !model.player.playing {
                model.player = Player { leg: 0, done: 0.0, playing: true };
            } else {
                model.player.playing = !model.player.playing;
            }
        }
        Command::Step(steps) => {
            model.player.playing = false;
            let legs = model.legs().len();
            advance(&mut model.player, f64::from(steps) / STEPS, legs);
        }
        Command::Restart => model.player = Player { leg: 0, done: 0.0, playing: true },
        Command::Leg(legs) => {
            // Back from inside a leg goes to its start.
            let back = legs < 0 && model.player.done > 0.0;
            let leg = model.player.leg.saturating_add_signed(if back { 0 } else { legs as isize });
            model.player.leg = leg.min(model.legs().len().saturating_sub(1));
            model.player.done = 0.0;
        }
        _ => {}
    }
    effects.push(Effect::Show);
    effects
}

/// Lets the animation go on by a time.
pub fn elapse(model: &mut Model, time: Duration) -> Vec<Effect> {
    if !model.player.playing || model.legs().is_empty() || !model.is_current() {
        return Vec::new();
    }
    let legs = model.legs().len();
    let player = &mut model.player;
    let Animation { speed, repeats } = model.animation;
    player.done += speed * time.as_secs_f64() / LEG_TIME.as_secs_f64();
    // How far it is does not depend on how often it is drawn: what is left goes on in the next leg.
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
    vec![Effect::Show]
}

/// Moves the animation by a share of a leg; on its way to another leg it stops between the two.
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

/// Keeps the animation on the legs there are.
pub fn stay_on_legs(model: &mut Model, last: usize) {
    if model.player.leg > last {
        model.player = Player { leg: last, done: 1.0, playing: false };
    }
}

/// Takes over a snapshot from the worker.
pub fn shown(model: &mut Model, snapshot: Arc<ContactSnapshot>) {
    // Another snapshot may have been on its way when the fragment was asked for.
    if snapshot.focus == model.look.focus && model.look.focus.is_question() {
        let middle = snapshot.close_up.fragment.map(|fragment| fragment.middle());
        model.look.focus = middle.map_or(Focus::Summit, Focus::Spring);
    }
    if let Some((manual, travel)) = model.manual.as_mut().zip(snapshot.manual.as_ref()) {
        manual.path.extend(&travel.path);
        let old = manual.path.len().saturating_sub(PATH_KEPT);
        manual.path.drain(..old);
        if !travel.path.is_empty() {
            (manual.changed, manual.touched) = (travel.changed, travel.touched);
        }
        manual.dissipated_energy = travel.dissipated_energy;
        if let Some(error) = &travel.refused {
            model.notice = Some(Notice::Error(refusal(error, &model.typed_force)));
        }
    }
    model.snapshot = Some(snapshot);
}

/// Reason why the body was not moved, with forces in the unit of the typed one, rounded into the range that is allowed.
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

/// The nearest number of four digits that is not smaller.
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
    let mut effects = Vec::new();
    if model.manual.is_none() {
        let (leg, indentation) = (model.player.leg, model.indentation());
        let start = model.present().map(|snapshot| snapshot.point);
        model.player.playing = false;
        model.manual = Some(ManualState { path: start.into_iter().collect(), ..ManualState::default() });
        effects.push(Effect::Manual(ManualMove::Take { leg, indentation }));
    }
    effects.extend(order.map(Effect::Manual));
    effects.push(Effect::Show);
    effects
}

fn give_back(model: &mut Model) -> Vec<Effect> {
    model.manual = None;
    vec![Effect::Manual(ManualMove::Give), Effect::Show]
}

/// Moves the body to a force that was typed.
pub fn accept_force(model: &mut Model, typed: &str) -> Vec<Effect> {
    match parse_quantity(typed.trim(), "N") {
        Ok(force) => {
            model.typed_force = typed.trim().to_owned();
            take(model, Some(ManualMove::ToForce(force)))
        }
        Err(error) => {
            model.notice = Some(Notice::Error(format!("{error}; for example 10 µN, or -2e-6 to pull")));
            Vec::new()
        }
    }
}
