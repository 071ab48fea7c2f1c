//! Movement of the body: the animation of the scene's loading, or manual loading.

use crate::explorer::app::App;
use crate::explorer::player::{At, Player};
use crate::explorer::prompt::Purpose;
use crate::explorer::request::{Focus, ManualMove};
use crate::explorer::snapshot::{ContactSnapshot, ManualState};
use crate::explorer::typed::unit_of_force;
use asperity_data::{in_unit, parse_quantity};
use std::sync::Arc;
use std::time::Duration;

/// Time that the animation takes for one loading stage at speed 1.
const LEG_TIME: Duration = Duration::from_secs(6);
const STEPS: f64 = 120.0;
/// Share of a loading stage that counts as its start.
const NEAR_START: f64 = 0.05;
/// Number of small and of large steps of manual loading over the whole range of indentations.
const HAND_STEPS: (f64, f64) = (400.0, 40.0);
/// Largest number of points kept of the path of manual loading.
const PATH_KEPT: usize = 20_000;

pub fn toggle_manual(app: &mut App) {
    if app.manual.take().is_none() {
        take(app, None);
    }
}

/// Presses the body by a number of steps of manual loading, or pulls it if negative.
pub fn push(app: &mut App, steps: i32, coarse: bool) {
    let (low, high) = app.indentations().unwrap_or_default();
    let step = (high - low) / if coarse { HAND_STEPS.1 } else { HAND_STEPS.0 };
    take(app, Some(ManualMove::By(f64::from(steps) * step)))
}

pub fn separate(app: &mut App) {
    take(app, Some(ManualMove::Separate))
}

/// Plays or pauses the animation. At rest it starts again from the beginning. Like all movements of
/// the animation this ends manual loading, since the animation shows the loading of the scene.
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

pub fn step(app: &mut App, steps: i32) {
    app.manual = None;
    app.play.playing = false;
    let share = f64::from(steps) / STEPS;
    let to = app.play.share(app.legs()) + share;
    let player = app.play;
    app.play = match player.leg {
        // Not past the boundary to another stage.
        leg if to > 1.0 && leg + 1 < app.legs().len() => Player {
            leg: leg + 1,
            at: At::Start,
            ..player
        },
        leg if to < 0.0 && leg > 0 => Player {
            leg: leg - 1,
            at: At::End,
            ..player
        },
        _ => Player {
            at: player.advanced(app.legs(), share),
            ..player
        },
    };
}

pub fn restart(app: &mut App) {
    app.manual = None;
    app.play = Player::START;
}

/// Goes to the start of a loading stage, `legs` after the present one; back from inside a stage,
/// first to its own start.
pub fn go_to_leg(app: &mut App, legs: i32) {
    app.manual = None;
    // A playing animation is past the start at once.
    let back = legs < 0 && app.play.share(app.legs()) > NEAR_START;
    let leg = app
        .play
        .leg
        .saturating_add_signed(if back { 0 } else { legs as isize });
    app.play.leg = leg.min(app.legs().len().saturating_sub(1));
    app.play.at = At::Start;
}

/// Goes to the state at the pull-off, just before the contact is lost, in which the animation
/// rests.
pub fn go_to_pull_off(app: &mut App) {
    let rest = Player::at_rest(app.legs());
    if rest.at == At::End {
        app.set_error(
            "there is no pull-off: the force does not fall below 0 N in the last unloading",
        );
        return;
    }
    (app.play, app.manual) = (rest, None);
}

pub fn elapse(app: &mut App, time: Duration) {
    if !app.play.playing || app.legs().is_empty() || !app.is_current() {
        return;
    }
    let legs = app.legs();
    let (mut player, last) = (app.play, legs.len() - 1);
    let mut share = app.config.speed * time.as_secs_f64() / LEG_TIME.as_secs_f64();
    // The distance does not depend on the frame rate: its rest continues on the next stage.
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

pub fn shown(app: &mut App, snapshot: Arc<ContactSnapshot>) {
    // Another snapshot may have been on its way when the fragment was requested.
    if snapshot.focus == app.view.close_up.focus && app.view.close_up.focus.is_question() {
        let middle = snapshot.close_up.patch.map(|facts| facts.patch.middle());
        app.view.close_up.focus = middle.map_or(Focus::Summit, Focus::Spring);
    }
    if let Some((manual, travel)) = app.manual.as_mut().zip(snapshot.manual.as_ref()) {
        manual
            .path
            .extend(travel.path.iter().map(|(_, point)| point));
        manual
            .stages
            .extend(travel.path.iter().map(|(stage, _)| stage));
        let old = manual.path.len().saturating_sub(PATH_KEPT);
        manual.path.drain(..old);
        manual.stages.drain(..old);
        manual.loading.clone_from(&travel.loading);
        if !travel.path.is_empty() {
            manual.changed = travel.changed;
        }
        manual.released_energy = travel.released_energy;
        let typed = std::mem::take(&mut manual.typed);
        match &travel.refused {
            Some(why) if typed.is_empty() || app.prompt.is_some() => app.set_error(why.clone()),
            Some(why) => app.ask_again(Purpose::Force, &typed, why),
            None => {}
        }
    }
    app.snapshot = Some(snapshot);
}

/// Begins manual loading if it has not begun, and moves the body.
pub fn take(app: &mut App, order: Option<ManualMove>) {
    if !app.is_current() || app.legs().is_empty() {
        return;
    }
    if app.manual.is_none() {
        let Player { leg, at, .. } = app.play;
        let start = app.present().map(|snapshot| snapshot.point);
        app.play.playing = false;
        let at = if at == At::PullOff {
            At::Indentation(app.indentation())
        } else {
            at
        };
        let moves = vec![ManualMove::Take { leg, at }];
        // The start of a stage is the end of the one before, which the path may continue.
        let stage = if at == At::Start {
            leg.saturating_sub(1)
        } else {
            leg
        };
        let (path, stages) = start.map(|point| (point, stage)).into_iter().unzip();
        app.manual = Some(ManualState {
            path,
            stages,
            moves,
            ..ManualState::default()
        });
    }
    if let Some(manual) = &mut app.manual {
        manual.moves.extend(order);
    }
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
