//! Commands that change what is shown: panes, close-up, visible part of the profile, units and
//! colours.

use super::timeline::change_listed;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::pane::Pane;
use crate::explorer::request::{Focus, LineView};
use crate::explorer::theme::Cycle;
use asperity_data::AxisScale;
use asperity_report::LoopQuantities;
use crossterm::event::{KeyCode, KeyEvent};

/// Smallest number of springs in the visible part of the profile.
const FEWEST_SPRINGS: usize = 8;

/// Shows another contact patch in the close-up. `question` receives the middle spring of the patch
/// that is shown now, and returns which patch is shown next, such as the patch after this spring.
pub fn go_to_patch(app: &mut App, question: fn(Option<usize>) -> Focus) {
    let snapshot = app.snapshot.as_ref();
    let shown = snapshot.and_then(|snapshot| snapshot.close_up.patch);
    app.view.close_up.focus = question(shown.map(|facts| facts.patch.middle()));
}

/// Shows the next pair of quantities in the pane of the force curve.
pub fn next_curve(app: &mut App) {
    let offered = app.outcome().map(LoopQuantities::of_scene);
    let quantities = &mut app.view.curve.quantities;
    *quantities = quantities.next(&offered.unwrap_or_default());
}

pub fn next_pane(app: &mut App) {
    let panes = app.panes();
    let selected = panes.iter().position(|pane| *pane == app.view.pane);
    app.view.pane = panes[(selected.unwrap_or(0) + 1) % panes.len()];
}

pub fn next_theme(app: &mut App) {
    app.view.appearance.theme = app.view.appearance.theme.next();
    app.set_done(format!("colours: {}", app.view.appearance.theme.name()));
}

/// Switches the axis of preloads, or the colours of a map, between a linear and a logarithmic
/// scale.
pub fn toggle_scale(app: &mut App) {
    if app.view.pane == Pane::Map {
        let mapped = app.mapped();
        let usual = app.grid().and_then(|grid| grid.layer(mapped));
        let Some(usual) = usual.map(|layer| layer.scale) else {
            return app.set_error("regimes have no scale; V shows another quantity");
        };
        let present = app.colour_scale(mapped).unwrap_or(usual);
        app.map.scale = Some(other_scale(present));
        return;
    }
    app.view.preloads = other_scale(app.view.preloads);
    app.effects.push(Task::Study);
}

fn other_scale(scale: AxisScale) -> AxisScale {
    match scale {
        AxisScale::Linear => AxisScale::Logarithmic,
        AxisScale::Logarithmic => AxisScale::Linear,
    }
}

/// Returns the number of springs of the whole profile.
fn springs(app: &App) -> usize {
    app.outcome()
        .map_or(1, |outcome| outcome.line.points)
        .max(1)
}

/// Returns the number of springs in the close-up.
fn close_up_springs(app: &App) -> usize {
    if let Some(springs) = app.view.close_up.springs {
        return springs;
    }
    match &app.snapshot {
        Some(snapshot) => snapshot.close_up.section.springs,
        None => FEWEST_SPRINGS,
    }
}

/// Zooms the profile if its pane is selected, otherwise the close-up. Positive steps zoom in. If
/// the list of events is selected, lists more jumps instead, or fewer ones.
pub fn zoom(app: &mut App, steps: i32) {
    if app.view.pane == Pane::Events {
        return change_listed(app, steps > 0);
    }
    let most = springs(app);
    if app.view.pane == Pane::Profile {
        let least = (FEWEST_SPRINGS as f64 / most as f64).min(1.0);
        let share = app.view.profile.share * if steps > 0 { 0.5 } else { 2.0 };
        app.view.profile.share = share.clamp(least, 1.0);
        if app.view.profile.share >= 1.0 {
            app.view.profile = LineView::WHOLE;
        }
    } else {
        let springs = close_up_springs(app);
        let springs = if steps > 0 { springs / 2 } else { springs * 2 };
        app.view.close_up.springs = Some(springs.clamp(FEWEST_SPRINGS, most.max(FEWEST_SPRINGS)));
    }
}

/// Zooms the selected pane. Positive `steps` zoom in, negative `steps` zoom out. The point of the
/// profile at `position` in m does not move on the screen.
pub fn zoom_at(app: &mut App, steps: i32, position: Option<f64>) {
    let pointer = position.and_then(|position| share_of_shown(app, position));
    let profile = app.view.profile;
    let springs_before = close_up_springs(app) as f64;
    zoom(app, steps);
    let Some(pointer) = pointer else {
        return;
    };
    let away = pointer - 0.5;
    if app.view.pane == Pane::Profile {
        let LineView { share, .. } = app.view.profile;
        let centre = profile.centre + away * (profile.share - share);
        let centre = centre.clamp(share / 2.0, 1.0 - share / 2.0);
        app.view.profile = LineView { centre, share };
    } else if let Some(snapshot) = &app.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first as f64 + section.springs as f64 / 2.0;
        let lost_springs = springs_before - close_up_springs(app) as f64;
        app.view.close_up.focus = focus_within(app, middle + away * lost_springs);
    }
}

/// Converts a position along the profile in m to a share (0 to 1) of the part that the selected
/// pane shows.
fn share_of_shown(app: &App, position: f64) -> Option<f64> {
    let snapshot = app.snapshot.as_ref()?;
    let section = if app.view.pane == Pane::Profile {
        &snapshot.profile
    } else {
        &snapshot.close_up.section
    };
    let first = (snapshot.line.first + section.first) as f64;
    let spring = position / snapshot.line.spacing - first;
    Some(spring / section.springs.max(1) as f64)
}

/// Returns the focus of the close-up on a spring. A number beyond an end of the profile gives the
/// spring at this end.
fn focus_within(app: &App, spring: f64) -> Focus {
    let last = (springs(app) - 1) as f64;
    Focus::Spring(spring.clamp(0.0, last) as usize)
}

/// Moves the visible part of the profile by a quarter of its width, in the direction of the pressed
/// key.
pub fn pan(app: &mut App, key: &KeyEvent) {
    let is_left = key.code == KeyCode::Char('(');
    let quarter = if is_left { -0.25 } else { 0.25 };
    if app.view.pane == Pane::Profile {
        let half = app.view.profile.share / 2.0;
        let centre = app.view.profile.centre + quarter * app.view.profile.share;
        app.view.profile.centre = centre.clamp(half, 1.0 - half);
    } else if let Some(snapshot) = &app.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first + section.springs / 2;
        let spring = middle as f64 + quarter * section.springs as f64;
        app.view.close_up.focus = focus_within(app, spring);
    }
}
