//! The crosshair: on the force curve at the shown state, so that moving the crosshair moves the body; on profile
//! and close-up at one position, to be read.

use super::{Effect, movement};
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::model::{Crosshair, Model, Pane};
use crate::explorer::panes::{position_at, stage_at};
use crate::explorer::snapshot::Section;
use ratatui::layout::{Position, Rect};

/// Small and large steps along a loading stage.
const STEPS: (f64, f64) = (240.0, 24.0);
/// Columns of dots in a large step along the profile.
const COARSE: usize = 10;

/// Moves the crosshair of the selected pane by steps, positive to the right; on the force curve the body moves with it.
pub fn move_by(model: &mut Model, steps: i32, coarse: bool) -> Vec<Effect> {
    if model.pane != Pane::Force {
        step(model, steps, coarse);
    } else if model.manual.is_some() {
        return movement::push(model, steps, coarse);
    } else {
        let share = f64::from(steps) / if coarse { STEPS.1 } else { STEPS.0 };
        put(model, model.player.leg, model.player.done + direction(model) * share);
    }
    vec![Effect::Ask]
}

/// Moves the crosshair to the left or right end of the loading stage or of the section.
pub fn go_to_end(model: &mut Model, right: bool) {
    if model.pane == Pane::Force {
        let done = f64::from(u8::from(right == (direction(model) > 0.0)));
        put(model, model.player.leg, done);
    } else if let Some((section, _)) = section(model) {
        let end = section.first + if right { section.springs.saturating_sub(1) } else { 0 };
        look_at(model, end);
    }
}

/// Moves the crosshair to the mouse; `None` for a pane without crosshair, or where the mouse moves the body manually.
pub fn point_at(model: &mut Model, pane: Pane, area: Rect, here: Position) -> Option<Vec<Effect>> {
    model.crosshair?;
    match pane {
        Pane::Force if model.manual.is_none() => {
            let (leg, indentation) = stage_at(model, inside(area), here)?;
            put(model, leg, model.done_at(leg, indentation));
        }
        Pane::Force => return None,
        pane => {
            let spring = position_at(model, pane, inside(area), here.x)?;
            look_at(model, spring);
        }
    }
    Some(vec![Effect::Ask])
}

/// Shows or hides the crosshair, which begins in the middle of the close-up.
pub fn toggle(model: &mut Model) {
    if model.crosshair.take().is_some() {
        return;
    }
    model.crosshair = Some(Crosshair { position: 0.5 });
    if let Some(close_up) = model.snapshot.as_ref().map(|snapshot| snapshot.close_up.clone()) {
        let middle = close_up.section.first + close_up.section.springs / 2;
        look_at(model, close_up.fragment.map_or(middle, |facts| facts.patch.middle()));
    }
    if model.pane.row().keys != Some(ModeKind::Crosshair) {
        model.pane = Pane::Force;
    }
}

/// 1 where the indentation grows along the stage of the animation, else −1.
fn direction(model: &Model) -> f64 {
    let falls = model.legs().get(model.player.leg).is_some_and(|leg| leg.end() < leg.start());
    if falls { -1.0 } else { 1.0 }
}

/// Pauses the animation at a part of a loading stage.
fn put(model: &mut Model, leg: usize, done: f64) {
    if model.manual.is_none() {
        model.player.playing = false;
        (model.player.leg, model.player.done) = (leg, done.clamp(0.0, 1.0));
    }
}

/// Goes to another loading stage at the shown indentation, or at the nearer end of the stage.
pub fn go_to_stage(model: &mut Model, stages: i32) {
    let last = model.legs().len().saturating_sub(1);
    let leg = model.player.leg.saturating_add_signed(stages as isize).min(last);
    let indentation = model.indentation();
    if leg != model.player.leg {
        put(model, leg, model.done_at(leg, indentation));
    }
}

/// The section of the chosen pane with its columns of dots.
fn section(model: &Model) -> Option<(&Section, usize)> {
    let snapshot = model.snapshot.as_ref()?;
    let section = if model.pane == Pane::CloseUp { &snapshot.close_up.section } else { &snapshot.profile };
    Some((section, section.columns.len().max(1)))
}

/// Moves along the profile within the visible section.
fn step(model: &mut Model, steps: i32, coarse: bool) {
    let Some((section, columns)) = section(model) else { return };
    let springs = (section.springs / columns).max(1) * if coarse { COARSE } else { 1 };
    let (first, last) = (section.first, section.first + section.springs.saturating_sub(1));
    // Not the shown spring: keys may come faster than snapshots.
    let now =
        model.crosshair.map_or(first, |crosshair| (crosshair.position * springs_of(model) as f64) as usize);
    let to = now.saturating_add_signed(springs as isize * steps as isize);
    look_at(model, to.clamp(first, last));
}

fn springs_of(model: &Model) -> u64 {
    model.computed.as_ref().map_or(1, |computed| computed.outcome.history.work.springs.max(1))
}

/// Puts the crosshair on the middle of a spring.
fn look_at(model: &mut Model, spring: usize) {
    let springs = springs_of(model);
    if let Some(crosshair) = &mut model.crosshair {
        crosshair.position = (spring as f64 + 0.5) / springs as f64;
    }
}
