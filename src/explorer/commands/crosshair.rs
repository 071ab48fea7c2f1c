//! The crosshair of the selected pane, for readings: on profile and close-up at a position along
//! the line, on other charts at a share of the horizontal axis.

use crate::explorer::app::App;
use crate::explorer::keys::bindings::Context;
use crate::explorer::keys::key::direction;
use crate::explorer::pane::Pane;
use crate::explorer::panes;
use crossterm::event::{KeyCode, KeyEvent};

/// Number of small and of large steps across a pane.
const STEPS: (f64, f64) = (100.0, 10.0);

/// Shows or hides the crosshair, which appears in the middle of the selected pane.
pub fn toggle(app: &mut App) {
    if app.view.crosshair.take().is_some() {
        return;
    }
    match app.view.pane.keys() {
        Context::Crosshair => {}
        Context::Parameters => app.view.pane = Pane::Force,
        _ => return app.set_done("the selected pane has no curves for the crosshair to read"),
    }
    let (low, high) = ends(app);
    app.view.crosshair = Some(0.5 * (low + high));
}

/// Moves the crosshair by a small or a large step.
pub fn step(app: &mut App, key: &KeyEvent) {
    let Some(((columns, _), is_coarse)) = direction(key) else {
        return;
    };
    let (low, high) = ends(app);
    let step = (high - low) / if is_coarse { STEPS.1 } else { STEPS.0 };
    let now = app.view.crosshair.unwrap_or(low);
    app.view.crosshair = Some((now + f64::from(columns) * step).clamp(low, high));
}

/// Moves the crosshair to the left or right end of the pane.
pub fn go_to_end(app: &mut App, key: &KeyEvent) {
    let (low, high) = ends(app);
    let is_right = matches!(key.code, KeyCode::End | KeyCode::Char('G'));
    app.view.crosshair = Some(if is_right { high } else { low });
}

/// Moves the crosshair to a number on the horizontal axis of the selected pane.
pub fn point_at(app: &mut App, x: f64) {
    let share = match app.section().zip(app.snapshot.as_deref()) {
        Some((_, snapshot)) => {
            (x / snapshot.line.spacing - snapshot.line.first as f64) / springs(app)
        }
        None => match panes::figure(app, app.view.pane)
            .and_then(|figure| figure.charts.into_iter().next())
        {
            Some(chart) => chart.x.share(x),
            None => return,
        },
    };
    let (low, high) = ends(app);
    app.view.crosshair = Some(share.clamp(low, high));
}

/// Positions, as shares, of the left and right end of the selected pane: of the part of the
/// profile, or of the curves of another chart.
fn ends(app: &App) -> (f64, f64) {
    let share = |spring: usize| (spring as f64 / springs(app)).min(1.0);
    if let Some(section) = app.section() {
        return (share(section.first), share(section.first + section.springs));
    }
    let chart =
        panes::figure(app, app.view.pane).and_then(|figure| figure.charts.into_iter().next());
    let shares = chart.iter().flat_map(|chart| {
        let named = chart.layers.iter().filter(|layer| !layer.name.is_empty());
        named
            .flat_map(|layer| layer.shape.points())
            .map(|point| chart.x.share(point.0).clamp(0.0, 1.0))
    });
    shares
        .fold(None, |ends: Option<(f64, f64)>, at| {
            Some(ends.map_or((at, at), |(low, high)| (low.min(at), high.max(at))))
        })
        .filter(|(low, high)| low < high)
        .unwrap_or((0.0, 1.0))
}

fn springs(app: &App) -> f64 {
    app.solved.as_ref().map_or(1.0, |computed| {
        computed.outcome.history.work.springs.max(1) as f64
    })
}
