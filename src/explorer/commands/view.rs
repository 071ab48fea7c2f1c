//! Changes of the view: panes, close-up, visible part of the line, quantities, colours.

use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::pane::Pane;
use crate::explorer::request::{Focus, LineView};
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::theme::Cycle;
use asperity_data::AxisScale;
use crossterm::event::{KeyCode, KeyEvent};
use std::sync::Arc;

/// Smallest number of springs in a section of the profile.
const FEWEST_SPRINGS: usize = 8;

/// Shows the patch that answers a question; `question` receives the spring of the shown patch.
pub fn go_to_patch(app: &mut App, question: fn(Option<usize>) -> Focus) {
    let fragment = app
        .snapshot
        .as_ref()
        .and_then(|snapshot| snapshot.close_up.patch);
    app.view.close_up.focus = question(fragment.map(|facts| facts.patch.middle()));
}

pub fn next_pane(app: &mut App) {
    let panes = app.panes();
    let place = panes
        .iter()
        .position(|pane| *pane == app.view.pane)
        .unwrap_or(0);
    app.view.pane = panes[(place + 1) % panes.len()];
}

pub fn next_theme(app: &mut App) {
    app.view.appearance.theme = app.view.appearance.theme.next();
    app.set_done(format!("colours: {}", app.view.appearance.theme.name()));
}

/// Changes between equal distances and equal ratios of the preloads.
pub fn toggle_preload_scale(app: &mut App) {
    app.view.preloads = match app.view.preloads {
        AxisScale::Linear => AxisScale::Logarithmic,
        AxisScale::Logarithmic => AxisScale::Linear,
    };
    app.effects.push(Task::Study);
}

fn springs(app: &App) -> usize {
    app.solved
        .as_ref()
        .map_or(1, |computed| computed.outcome.line.points)
        .max(1)
}

/// Number of springs in the close-up.
fn close_up_springs(app: &App) -> usize {
    let shown = app
        .snapshot
        .as_ref()
        .map(|snapshot| snapshot.close_up.section.springs);
    app.view
        .close_up
        .springs
        .or(shown)
        .unwrap_or(FEWEST_SPRINGS)
}

/// Zooms the profile if its pane is selected, otherwise the close-up; positive steps zoom in.
pub fn zoom(app: &mut App, steps: i32) {
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

/// Zooms the section in the selected pane so that a position, m, stays at its place on the screen.
pub fn zoom_at(app: &mut App, steps: i32, position: Option<f64>) {
    let share = |(position, snapshot): (f64, &Arc<ContactSnapshot>)| {
        let is_profile = app.view.pane == Pane::Profile;
        let section = if is_profile {
            &snapshot.profile
        } else {
            &snapshot.close_up.section
        };
        let first = (snapshot.line.first + section.first) as f64;
        (position / snapshot.line.spacing - first) / section.springs.max(1) as f64
    };
    let pointer = position.zip(app.snapshot.as_ref()).map(share);
    let (profile, springs_before) = (app.view.profile, close_up_springs(app) as f64);
    zoom(app, steps);
    let Some(pointer) = pointer else { return };
    let away = pointer - 0.5;
    if app.view.pane == Pane::Profile {
        let LineView { share, .. } = app.view.profile;
        let centre = profile.centre + away * (profile.share - share);
        let centre = centre.clamp(share / 2.0, 1.0 - share / 2.0);
        app.view.profile = LineView { centre, share };
    } else if let Some(snapshot) = &app.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first as f64 + section.springs as f64 / 2.0;
        let to = middle + away * (springs_before - close_up_springs(app) as f64);
        app.view.close_up.focus = Focus::Spring(to.clamp(0.0, (springs(app) - 1) as f64) as usize);
    }
}

/// Moves along the profile by a quarter of the visible part.
pub fn pan(app: &mut App, key: &KeyEvent) {
    let quarters = if key.code == KeyCode::Char('(') {
        -0.25
    } else {
        0.25
    };
    if app.view.pane == Pane::Profile {
        let half = app.view.profile.share / 2.0;
        let centre = app.view.profile.centre + quarters * app.view.profile.share;
        app.view.profile.centre = centre.clamp(half, 1.0 - half);
    } else if let Some(snapshot) = &app.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first + section.springs / 2;
        let to = middle as f64 + quarters * section.springs as f64;
        app.view.close_up.focus = Focus::Spring(to.clamp(0.0, (springs(app) - 1) as f64) as usize);
    }
}
