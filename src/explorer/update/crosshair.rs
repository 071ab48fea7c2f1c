//! The crosshair: on the force curve at the shown state, so that moving the crosshair moves the body; on profile and
//! close-up at one spring, on other charts at a share of the horizontal axis, to be read.

use super::movement;
use crate::explorer::app::{App, Pane};
use crate::explorer::keys::Context;
use crate::explorer::panes::{nearest, spring_at};
use crate::explorer::snapshot::Section;

/// Small and large steps along a loading stage.
const STEPS: (f64, f64) = (240.0, 24.0);
/// Columns of dots in a large step along the profile.
const COARSE: usize = 10;
/// Small and large steps along the horizontal axis of a chart.
const AXIS_STEPS: (f64, f64) = (100.0, 10.0);

/// Moves the crosshair of the selected pane by steps, positive to the right; on the force curve the body moves with it.
pub fn move_by(app: &mut App, steps: i32, coarse: bool) {
    if app.view.pane != Pane::Force {
        if section(app).is_some() {
            step(app, steps, coarse);
        } else if let Some(position) = &mut app.view.crosshair {
            let share = f64::from(steps) / if coarse { AXIS_STEPS.1 } else { AXIS_STEPS.0 };
            *position = (*position + share).clamp(0.0, 1.0);
        }
    } else if app.manual.is_some() {
        movement::push(app, steps, coarse);
    } else {
        let share = f64::from(steps) / if coarse { STEPS.1 } else { STEPS.0 };
        put(app, app.play.leg, app.play.done + direction(app) * share);
    }
}

/// Moves the crosshair to the left or right end of the loading stage or of the section.
pub fn go_to_end(app: &mut App, right: bool) {
    if app.view.pane == Pane::Force {
        let done = f64::from(u8::from(right == (direction(app) > 0.0)));
        put(app, app.play.leg, done);
    } else if let Some((section, _)) = section(app) {
        let end = section.first + if right { section.springs.saturating_sub(1) } else { 0 };
        look_at(app, end);
    } else {
        app.view.crosshair = Some(f64::from(u8::from(right)));
    }
}

/// Moves the crosshair of the selected pane to numbers on the axes of its chart.
pub fn point_at(app: &mut App, (x, y): (f64, f64)) {
    if app.view.crosshair.is_none() {
        return;
    }
    if app.view.pane == Pane::Force {
        if let Some((leg, indentation)) = nearest(app, (x, y)) {
            put(app, leg, app.done_at(leg, indentation));
        }
    } else if let Some((section, _)) = section(app) {
        let spring = app.snapshot.as_ref().map(|snapshot| spring_at(snapshot.line, section, x));
        spring.into_iter().for_each(|spring| look_at(app, spring));
    } else if let Some(chart) = app.view.pane.figure(app).and_then(|figure| figure.charts.into_iter().next())
    {
        app.view.crosshair = Some(chart.x.share(x).clamp(0.0, 1.0));
    }
}

/// Shows or hides the crosshair, which begins in the middle of the close-up.
pub fn toggle(app: &mut App) {
    if app.view.crosshair.take().is_some() {
        return;
    }
    app.view.crosshair = Some(0.5);
    if let Some(close_up) = app.snapshot.as_ref().map(|snapshot| snapshot.close_up.clone()) {
        let middle = close_up.section.first + close_up.section.springs / 2;
        look_at(app, close_up.fragment.map_or(middle, |facts| facts.patch.middle()));
    }
    if app.view.pane.row().keys != Some(Context::Crosshair) {
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

/// The section of the profile in the selected pane with its columns of dots.
fn section(app: &App) -> Option<(&Section, usize)> {
    let snapshot = app.snapshot.as_ref()?;
    let section = match app.view.pane {
        Pane::CloseUp => &snapshot.close_up.section,
        Pane::Profile | Pane::Beside => &snapshot.profile,
        _ => return None,
    };
    Some((section, section.columns.len().max(1)))
}

/// Moves along the profile within the visible section.
fn step(app: &mut App, steps: i32, coarse: bool) {
    let Some((section, columns)) = section(app) else { return };
    let springs = (section.springs / columns).max(1) * if coarse { COARSE } else { 1 };
    let (first, last) = (section.first, section.first + section.springs.saturating_sub(1));
    // Not the shown spring: keys may come faster than snapshots.
    let now = app.view.crosshair.map_or(first, |position| (position * springs_of(app) as f64) as usize);
    let to = now.saturating_add_signed(springs as isize * steps as isize);
    look_at(app, to.clamp(first, last));
}

fn springs_of(app: &App) -> u64 {
    app.solved.as_ref().map_or(1, |computed| computed.outcome.history.work.springs.max(1))
}

/// Puts the crosshair on the middle of a spring.
fn look_at(app: &mut App, spring: usize) {
    app.view.crosshair = Some((spring as f64 + 0.5) / springs_of(app) as f64);
}
