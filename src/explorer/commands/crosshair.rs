//! The crosshair, at whose position the selected pane states values. In the profile and the
//! close-up, this is a position along the profile. In other charts, it is a position along the
//! horizontal axis.

use crate::explorer::app::App;
use crate::explorer::keys::bindings::Context;
use crate::explorer::keys::key::direction;
use crate::explorer::pane::Pane;
use crate::explorer::panes;
use asperity_plot::Chart;
use crossterm::event::{KeyCode, KeyEvent};

/// Number of small steps across the width of a pane.
const SMALL_STEPS: f64 = 100.0;
/// Number of large steps across the width of a pane.
const LARGE_STEPS: f64 = 10.0;

/// Shows the crosshair in the middle of the selected pane, or hides it.
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

/// Moves the crosshair by one small or one large step, depending on the pressed key.
pub fn step(app: &mut App, key: &KeyEvent) {
    let Some(direction) = direction(key) else {
        return;
    };
    let (low, high) = ends(app);
    let steps = if direction.is_coarse {
        LARGE_STEPS
    } else {
        SMALL_STEPS
    };
    let step = f64::from(direction.columns) * (high - low) / steps;
    let present = app.view.crosshair.unwrap_or(low);
    app.view.crosshair = Some((present + step).clamp(low, high));
}

/// Moves the crosshair to the left or the right end of the pane, depending on the pressed key.
pub fn go_to_end(app: &mut App, key: &KeyEvent) {
    let (low, high) = ends(app);
    let is_right = matches!(key.code, KeyCode::End | KeyCode::Char('G'));
    app.view.crosshair = Some(if is_right { high } else { low });
}

/// Moves the crosshair to the number `x` on the horizontal axis of the selected pane.
pub fn point_at(app: &mut App, x: f64) {
    let share = match (app.section(), app.snapshot.as_deref()) {
        (Some(_), Some(snapshot)) => {
            let spring = x / snapshot.line.spacing - snapshot.line.first as f64;
            spring / springs(app)
        }
        _ => match chart(app) {
            Some(chart) => chart.x.share(x),
            None => return,
        },
    };
    let (low, high) = ends(app);
    app.view.crosshair = Some(share.clamp(low, high));
}

/// Returns the main chart of the selected pane; `None` if the pane has no chart.
fn chart(app: &App) -> Option<Chart> {
    let figure = panes::figure(app, app.view.pane)?;
    figure.charts.into_iter().next()
}

/// Returns the leftmost and the rightmost position of the crosshair. In the profile and the
/// close-up, these are the ends of the visible part, as shares of the profile. In another chart,
/// these are the ends of the named curves, as shares of the horizontal axis.
fn ends(app: &App) -> (f64, f64) {
    if let Some(section) = app.section() {
        let springs = springs(app);
        let from = section.first as f64 / springs;
        let to = (section.first + section.springs) as f64 / springs;
        return (from.min(1.0), to.min(1.0));
    }
    const WHOLE: (f64, f64) = (0.0, 1.0);
    let Some(chart) = chart(app) else {
        return WHOLE;
    };
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for layer in &chart.layers {
        if layer.name.is_empty() {
            continue;
        }
        for (x, _) in layer.shape.points() {
            let share = chart.x.share(x).clamp(0.0, 1.0);
            low = low.min(share);
            high = high.max(share);
        }
    }
    if low < high { (low, high) } else { WHOLE }
}

/// Returns the number of springs of the whole profile.
fn springs(app: &App) -> f64 {
    match app.outcome() {
        Some(outcome) => outcome.history.work.springs.max(1) as f64,
        None => 1.0,
    }
}
