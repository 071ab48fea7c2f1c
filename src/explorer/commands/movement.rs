//! Commands of the animation, which moves the body along the loading of the scene or along the path
//! of manual loading.

use super::manual;
use crate::explorer::app::App;
use crate::explorer::player::{At, Player, Rest};
use crate::explorer::request::Focus;
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::timeline::{passed, position_of};
use asperity_contact::Event;
use std::sync::Arc;
use std::time::Duration;

/// Time in s that the animation takes for a loading stage at speed 1.
const STAGE_TIME: f64 = 6.0;
/// Smallest energy of a jump at which the animation rests, as a share of the largest energy of a
/// jump.
const LARGE_JUMP: f64 = 0.1;
/// Longest time in s of a rest at speed 1, and largest share of the time of a stage for its rests.
const LONGEST_REST: f64 = 0.25;
const SHARE_OF_RESTS: f64 = 0.25;
/// If the animation has passed less than this share of a loading stage, it counts as being at the
/// start of the stage.
const NEAR_START: f64 = 0.05;
/// Starts or pauses the animation. If the animation has reached its end, it starts again from the
/// beginning. Under manual loading, the animation shows the path.
pub fn toggle_play(app: &mut App) {
    let player = app.playhead();
    if is_at_rest(app, player) && !player.playing {
        restart(app);
    } else {
        app.set_playhead(Player {
            playing: !player.playing,
            ..player
        });
    }
}

/// Returns true if the animation is at its end, so that it plays from the start next.
pub fn is_at_rest(app: &App, player: Player) -> bool {
    let stages = app.played_stages();
    let is_at_end = player.at == At::End && player.stage + 1 >= stages.len();
    is_at_end || app.edit.path.is_none() && player == Player::at_rest(stages)
}

/// Plays the loading of the scene from its beginning or, under manual loading, the path from its
/// first move.
pub fn restart(app: &mut App) {
    let Some(followed) = app.former_path() else {
        app.set_playhead(Player::START);
        return;
    };
    if followed.moves().is_empty() {
        app.set_done("the path has no move yet; ← → press and pull");
        return;
    }
    let first = followed.before;
    app.set_playhead(Player {
        stage: first,
        ..Player::START
    });
}

/// Moves the animation to the start of another loading stage, which is `stages` stages after the
/// present stage. If `stages` is negative and the animation is inside a stage, it moves to the
/// start of this stage instead.
pub fn go_to_stage(app: &mut App, stages: i32) {
    let player = app.playhead();
    // While the animation plays, it moves on between two presses of the key. Therefore a position
    // shortly after the start counts as the start. Otherwise the user could not get back to earlier
    // stages.
    let is_inside = player.share(app.played_stages()) > NEAR_START;
    let distance = if stages < 0 && is_inside { 0 } else { stages };
    let stage = player.stage.saturating_add_signed(distance as isize);
    let last = app.played_stages().len().saturating_sub(1);
    app.set_playhead(Player {
        stage: stage.min(last),
        at: At::Start,
        ..player
    });
}

/// Moves the animation to the pull-off, just before the contact is lost. The animation of the
/// scene's loading also shows this state after it has been played to its end.
pub fn go_to_pull_off(app: &mut App) {
    let rest = Player::at_rest(app.played_stages());
    if rest.at == At::End {
        app.set_error(
            "there is no pull-off: the force does not fall below 0 N in the last unloading",
        );
        return;
    }
    app.set_playhead(rest);
}

/// Movement of the animation through a loading stage. The animation moves evenly and rests for the
/// same time at each large jump. The whole stage takes the time [`STAGE_TIME`].
struct Pace {
    /// States just after the large jumps that are still ahead, in the order of the motion.
    ahead: Vec<Player>,
    /// Time in s of each rest, and time in s in which the animation moves through the stage.
    rest: f64,
    moving: f64,
}

impl Pace {
    fn new(app: &App, player: Player) -> Self {
        let mut pace = Pace {
            ahead: Vec::new(),
            rest: 0.0,
            moving: STAGE_TIME,
        };
        let Some(Ok(events)) = app.listed_events() else {
            return pace;
        };
        let stages = app.played_stages();
        let energy = |event: &Event| event.jump.map_or(0.0, |jump| jump.energy.abs());
        let largest = events.list.iter().map(energy).fold(0.0, f64::max);
        let passed = passed(stages, &events.list, player);
        let mut rests = 0;
        for (index, event) in events.list.iter().enumerate() {
            let is_large = event.jump.is_some() && energy(event) >= LARGE_JUMP * largest;
            if event.stage != player.stage || !is_large {
                continue;
            }
            rests += 1;
            if index >= passed {
                pace.ahead.push(Player {
                    playing: true,
                    ..position_of(stages, event)
                });
            }
        }
        if rests > 0 {
            pace.rest = LONGEST_REST.min(SHARE_OF_RESTS * STAGE_TIME / f64::from(rests));
            pace.moving = STAGE_TIME - f64::from(rests) * pace.rest;
        }
        pace
    }
}

/// Advances the animation by the time that has passed since the last call.
pub fn elapse(app: &mut App, time: Duration) {
    let stages = app.played_stages();
    if !app.is_playing() || stages.is_empty() {
        return;
    }
    let last = stages.len() - 1;
    let mut player = app.playhead();
    let mut time = app.config.speed * time.as_secs_f64();
    let mut rest = app.rest.filter(|rest| rest.player == player);
    loop {
        if let Some(Rest { left, .. }) = rest {
            if time < left {
                rest = Some(Rest {
                    player,
                    left: left - time,
                });
                break;
            }
            time -= left;
            rest = None;
        }
        // If the step goes beyond a large jump or the end of a stage, its rest is made there. In
        // this way the speed does not depend on the frame rate.
        let pace = Pace::new(app, player);
        let share = player.share(stages);
        let jump = pace.ahead.first();
        let end = jump.map_or(1.0, |jump| jump.share(stages));
        let needed = (end - share).max(0.0) * pace.moving;
        if let Some(jump) = jump
            && time >= needed
        {
            time -= needed;
            player = *jump;
            rest = Some(Rest {
                player,
                left: pace.rest,
            });
        } else if player.stage < last && time > needed {
            time -= needed;
            player = Player {
                stage: player.stage + 1,
                at: At::Start,
                ..player
            };
        } else {
            player.at = player.advanced(stages, time / pace.moving);
            break;
        }
    }
    let is_resting = rest.is_some();
    let is_at_end = player.stage >= last && player.at == At::End && !is_resting;
    let at_rest = Player::at_rest(stages);
    app.rest = rest;
    if !is_at_end {
        app.set_playhead(player);
    } else if app.config.repeat {
        restart(app);
    } else if app.edit.path.is_some() {
        app.set_playhead(player);
    } else {
        app.set_playhead(at_rest);
    }
}

/// Shows a snapshot from the solver.
pub fn shown(app: &mut App, snapshot: Arc<ContactSnapshot>) {
    // The snapshot may answer an earlier request with another focus. Then it does not answer the
    // question which patch to show.
    if snapshot.focus == app.view.close_up.focus && app.view.close_up.focus.is_question() {
        let middle = snapshot.close_up.patch.map(|facts| facts.patch.middle());
        app.view.close_up.focus = middle.map_or(Focus::Summit, Focus::Spring);
    }
    let before = app.snapshot.replace(snapshot);
    manual::take_note(app, before.as_deref());
}
