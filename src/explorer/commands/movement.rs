//! Commands that move the body: the animation of the scene's loading, and manual loading.

use crate::explorer::app::App;
use crate::explorer::player::{At, Player};
use crate::explorer::prompt::Purpose;
use crate::explorer::request::{Focus, ManualMove};
use crate::explorer::snapshot::{ContactSnapshot, ManualPath, ManualState};
use crate::explorer::typed::unit_of_force;
use asperity_data::{in_unit, parse_quantity};
use std::sync::Arc;
use std::time::Duration;

/// Time that the animation takes for a loading stage at speed 1.
const LEG_TIME: Duration = Duration::from_secs(6);
/// Number of steps into which a loading stage is divided for stepping through the animation.
const STEPS: f64 = 120.0;
/// If the animation has passed less than this share of a loading stage, it counts as being at the
/// start of the stage.
const NEAR_START: f64 = 0.05;
/// Number of small steps of manual loading from the lowest to the highest indentation.
const SMALL_PUSHES: f64 = 400.0;
/// Number of large steps of manual loading from the lowest to the highest indentation.
const LARGE_PUSHES: f64 = 40.0;
/// Largest number of points of the manual force curve that are stored.
const PATH_KEPT: usize = 20_000;

pub fn toggle_manual(app: &mut App) {
    if app.manual.take().is_none() {
        take(app, None);
    }
}

/// Presses the body by a number of steps of manual loading. If `steps` is negative, the body is
/// pulled.
pub fn push(app: &mut App, steps: i32, coarse: bool) {
    let (low, high) = app.indentations().unwrap_or_default();
    let steps_over_range = if coarse { LARGE_PUSHES } else { SMALL_PUSHES };
    let step = (high - low) / steps_over_range;
    take(app, Some(ManualMove::By(f64::from(steps) * step)))
}

pub fn separate(app: &mut App) {
    take(app, Some(ManualMove::Separate))
}

/// Starts or pauses the animation. If the animation has reached its end, it starts again from the
/// beginning. Manual loading ends, as with all commands of the animation, because the animation
/// shows the loading of the scene.
pub fn toggle_play(app: &mut App) {
    app.manual = None;
    let is_last = app.play.leg + 1 >= app.legs().len();
    let is_at_end = app.play == Player::at_rest(app.legs()) || app.play.at == At::End && is_last;
    if is_at_end && !app.play.playing {
        app.play = Player::START;
    } else {
        app.play.playing = !app.play.playing;
    }
}

/// Moves the animation by a number of steps. If a step would leave the loading stage, the animation
/// stops at the boundary between the two stages.
pub fn step(app: &mut App, steps: i32) {
    app.manual = None;
    app.play.playing = false;
    let player = app.play;
    let share = f64::from(steps) / STEPS;
    let reached = player.share(app.legs()) + share;
    app.play = if reached > 1.0 && player.leg + 1 < app.legs().len() {
        Player {
            leg: player.leg + 1,
            at: At::Start,
            ..player
        }
    } else if reached < 0.0 && player.leg > 0 {
        Player {
            leg: player.leg - 1,
            at: At::End,
            ..player
        }
    } else {
        Player {
            at: player.advanced(app.legs(), share),
            ..player
        }
    };
}

pub fn restart(app: &mut App) {
    app.manual = None;
    app.play = Player::START;
}

/// Moves the animation to the start of another loading stage, which is `legs` stages after the
/// present stage. If `legs` is negative and the animation is inside a stage, it moves to the start
/// of this stage instead.
pub fn go_to_leg(app: &mut App, legs: i32) {
    app.manual = None;
    // While the animation plays, it moves on between two presses of the key. Therefore a position
    // shortly after the start counts as the start. Otherwise the user could not get back to earlier
    // stages.
    let is_inside = app.play.share(app.legs()) > NEAR_START;
    let distance = if legs < 0 && is_inside { 0 } else { legs };
    let leg = app.play.leg.saturating_add_signed(distance as isize);
    app.play.leg = leg.min(app.legs().len().saturating_sub(1));
    app.play.at = At::Start;
}

/// Moves the animation to the pull-off, just before the contact is lost. The animation also shows
/// this state after it has been played to its end.
pub fn go_to_pull_off(app: &mut App) {
    let rest = Player::at_rest(app.legs());
    if rest.at == At::End {
        app.set_error(
            "there is no pull-off: the force does not fall below 0 N in the last unloading",
        );
        return;
    }
    app.play = rest;
    app.manual = None;
}

/// Advances the animation by the time that has passed since the last call.
pub fn elapse(app: &mut App, time: Duration) {
    if !app.play.playing || app.legs().is_empty() || !app.is_current() {
        return;
    }
    let legs = app.legs();
    let last = legs.len() - 1;
    let mut player = app.play;
    let mut share = app.config.speed * time.as_secs_f64() / LEG_TIME.as_secs_f64();
    // If the step goes beyond the end of a stage, its rest is made in the next stage. In this way
    // the speed does not depend on the frame rate.
    while player.leg < last && share > 1.0 - player.share(legs) {
        share -= 1.0 - player.share(legs);
        player = Player {
            leg: player.leg + 1,
            at: At::Start,
            ..player
        };
    }
    player.at = player.advanced(legs, share);
    if player.leg == last && player.at == At::End {
        player = if app.config.repeat {
            Player::START
        } else {
            Player::at_rest(legs)
        };
    }
    app.play = player;
}

/// Shows a snapshot that the solver has computed. If the snapshot belongs to manual loading, its
/// points are added to the force curve of manual loading.
pub fn shown(app: &mut App, snapshot: Arc<ContactSnapshot>) {
    // The snapshot may answer an earlier request with another focus. Then it does not answer the
    // question which patch to show.
    if snapshot.focus == app.view.close_up.focus && app.view.close_up.focus.is_question() {
        let middle = snapshot.close_up.patch.map(|facts| facts.patch.middle());
        app.view.close_up.focus = middle.map_or(Focus::Summit, Focus::Spring);
    }
    if let Some(travelled) = &snapshot.manual {
        continue_path(app, travelled);
    }
    app.snapshot = Some(snapshot);
}

/// Adds the points that the body has passed to the manual force curve. If a move was refused, a
/// message states the reason.
fn continue_path(app: &mut App, travelled: &ManualPath) {
    let Some(manual) = &mut app.manual else {
        return;
    };
    for (stage, point) in &travelled.path {
        manual.path.push(*point);
        manual.stages.push(*stage);
    }
    let old = manual.path.len().saturating_sub(PATH_KEPT);
    manual.path.drain(..old);
    manual.stages.drain(..old);
    manual.loading.clone_from(&travelled.loading);
    if !travelled.path.is_empty() {
        manual.changed = travelled.changed;
    }
    manual.released_energy = travelled.released_energy;
    let typed = std::mem::take(&mut manual.typed);
    let Some(why) = &travelled.refused else {
        return;
    };
    if typed.is_empty() || app.prompt.is_some() {
        app.set_error(why.clone());
    } else {
        app.ask_again(Purpose::Force, &typed, why);
    }
}

/// Begins manual loading, unless it has already begun. Then carries out the manual move `order`, if
/// there is one.
pub fn take(app: &mut App, order: Option<ManualMove>) {
    if !app.is_current() || app.legs().is_empty() {
        return;
    }
    if app.manual.is_none() {
        begin_manual(app);
    }
    if let Some(manual) = &mut app.manual {
        manual.moves.extend(order);
    }
}

/// Begins manual loading at the state that the animation shows.
fn begin_manual(app: &mut App) {
    app.play.playing = false;
    let Player { leg, at, .. } = app.play;
    let at = match at {
        At::PullOff => At::Indentation(app.indentation()),
        at => at,
    };
    let mut manual = ManualState {
        moves: vec![ManualMove::Take { leg, at }],
        ..ManualState::default()
    };
    if let Some(snapshot) = app.present() {
        manual.path.push(snapshot.point);
        // At the start of a stage, the contact is at the end of the previous stage, and manual
        // loading may continue this previous stage.
        manual.stages.push(match at {
            At::Start => leg.saturating_sub(1),
            _ => leg,
        });
    }
    app.manual = Some(manual);
}

pub fn accept_force(app: &mut App, typed: &str) -> Result<(), String> {
    let force = parse_quantity(&in_unit(typed, &unit_of_force(app)), "N");
    let force = force.map_err(|error| format!("{error}; for example 10 µN, or -2 µN to pull"))?;
    take(app, Some(ManualMove::ToForce(force)));
    if let Some(manual) = &mut app.manual {
        typed.clone_into(&mut manual.typed);
    }
    Ok(())
}
