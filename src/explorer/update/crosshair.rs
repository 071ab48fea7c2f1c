//! The crosshair: on the force curve at the shown state, so that moving the crosshair moves the body; on profile
//! and close-up at one position, to be read.

use super::{Effect, movement};
use crate::explorer::app::{App, Crosshair, Pane};
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::panes::{position_at, stage_at};
use crate::explorer::snapshot::Section;
use ratatui::layout::{Position, Rect};

/// Small and large steps along a loading stage.
const STEPS: (f64, f64) = (240.0, 24.0);
/// Columns of dots in a large step along the profile.
const COARSE: usize = 10;

/// Moves the crosshair of the selected pane by steps, positive to the right; on the force curve the body moves with it.
pub fn move_by(app: &mut App, steps: i32, coarse: bool) -> Vec<Effect> {
    if app.view.pane != Pane::Force {
        step(app, steps, coarse);
    } else if app.manual.is_some() {
        return movement::push(app, steps, coarse);
    } else {
        let share = f64::from(steps) / if coarse { STEPS.1 } else { STEPS.0 };
        put(app, app.play.leg, app.play.done + direction(app) * share);
    }
    vec![Effect::Ask]
}

/// Moves the crosshair to the left or right end of the loading stage or of the section.
pub fn go_to_end(app: &mut App, right: bool) {
    if app.view.pane == Pane::Force {
        let done = f64::from(u8::from(right == (direction(app) > 0.0)));
        put(app, app.play.leg, done);
    } else if let Some((section, _)) = section(app) {
        let end = section.first + if right { section.springs.saturating_sub(1) } else { 0 };
        look_at(app, end);
    }
}

/// Moves the crosshair to the mouse; `None` for a pane without crosshair, or where the mouse moves the body manually.
pub fn point_at(app: &mut App, pane: Pane, area: Rect, here: Position) -> Option<Vec<Effect>> {
    app.view.crosshair?;
    match pane {
        Pane::Force if app.manual.is_none() => {
            let (leg, indentation) = stage_at(app, inside(area), here)?;
            put(app, leg, app.done_at(leg, indentation));
        }
        Pane::Force => return None,
        pane => {
            let spring = position_at(app, pane, inside(area), here.x)?;
            look_at(app, spring);
        }
    }
    Some(vec![Effect::Ask])
}

/// Shows or hides the crosshair, which begins in the middle of the close-up.
pub fn toggle(app: &mut App) {
    if app.view.crosshair.take().is_some() {
        return;
    }
    app.view.crosshair = Some(Crosshair { position: 0.5 });
    if let Some(close_up) = app.snapshot.as_ref().map(|snapshot| snapshot.close_up.clone()) {
        let middle = close_up.section.first + close_up.section.springs / 2;
        look_at(app, close_up.fragment.map_or(middle, |facts| facts.patch.middle()));
    }
    if app.view.pane.row().keys != Some(ModeKind::Crosshair) {
        app.view.pane = Pane::Force;
    }
}

/// 1 where the indentation grows along the stage of the animation, else −1.
fn direction(app: &App) -> f64 {
    let falls = app.legs().get(app.play.leg).is_some_and(|leg| leg.end() < leg.start());
    if falls { -1.0 } else { 1.0 }
}

/// Pauses the animation at a part of a loading stage.
fn put(app: &mut App, leg: usize, done: f64) {
    if app.manual.is_none() {
        app.play.playing = false;
        (app.play.leg, app.play.done) = (leg, done.clamp(0.0, 1.0));
    }
}

/// Goes to another loading stage at the shown indentation, or at the nearer end of the stage.
pub fn go_to_stage(app: &mut App, stages: i32) {
    let last = app.legs().len().saturating_sub(1);
    let leg = app.play.leg.saturating_add_signed(stages as isize).min(last);
    let indentation = app.indentation();
    if leg != app.play.leg {
        put(app, leg, app.done_at(leg, indentation));
    }
}

/// The section of the chosen pane with its columns of dots.
fn section(app: &App) -> Option<(&Section, usize)> {
    let snapshot = app.snapshot.as_ref()?;
    let section = if app.view.pane == Pane::CloseUp { &snapshot.close_up.section } else { &snapshot.profile };
    Some((section, section.columns.len().max(1)))
}

/// Moves along the profile within the visible section.
fn step(app: &mut App, steps: i32, coarse: bool) {
    let Some((section, columns)) = section(app) else { return };
    let springs = (section.springs / columns).max(1) * if coarse { COARSE } else { 1 };
    let (first, last) = (section.first, section.first + section.springs.saturating_sub(1));
    // Not the shown spring: keys may come faster than snapshots.
    let now =
        app.view.crosshair.map_or(first, |crosshair| (crosshair.position * springs_of(app) as f64) as usize);
    let to = now.saturating_add_signed(springs as isize * steps as isize);
    look_at(app, to.clamp(first, last));
}

fn springs_of(app: &App) -> u64 {
    app.solved.as_ref().map_or(1, |computed| computed.outcome.history.work.springs.max(1))
}

/// Puts the crosshair on the middle of a spring.
fn look_at(app: &mut App, spring: usize) {
    let springs = springs_of(app);
    if let Some(crosshair) = &mut app.view.crosshair {
        crosshair.position = (spring as f64 + 0.5) / springs as f64;
    }
}
