//! Commands of the animation, which moves the body along the loading of the scene or along the path
//! of manual loading.

use super::manual;
use crate::explorer::app::App;
use crate::explorer::player::{At, Player};
use crate::explorer::request::Focus;
use crate::explorer::snapshot::ContactSnapshot;
use std::sync::Arc;
use std::time::Duration;

/// Time that the animation takes for a loading stage at speed 1.
const STAGE_TIME: Duration = Duration::from_secs(6);
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

/// Advances the animation by the time that has passed since the last call.
pub fn elapse(app: &mut App, time: Duration) {
    let stages = app.played_stages();
    if !app.is_playing() || stages.is_empty() {
        return;
    }
    let last = stages.len() - 1;
    let mut player = app.playhead();
    let mut share = app.config.speed * time.as_secs_f64() / STAGE_TIME.as_secs_f64();
    // If the step goes beyond the end of a stage, its rest is made in the next stage. In this way
    // the speed does not depend on the frame rate.
    while player.stage < last && share > 1.0 - player.share(stages) {
        share -= 1.0 - player.share(stages);
        player = Player {
            stage: player.stage + 1,
            at: At::Start,
            ..player
        };
    }
    player.at = player.advanced(stages, share);
    if player.stage < last || player.at != At::End {
        app.set_playhead(player);
    } else if app.config.repeat {
        restart(app);
    } else if app.edit.path.is_some() {
        app.set_playhead(player);
    } else {
        app.set_playhead(Player::at_rest(stages));
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
