//! Place on the profile at a cell of a pane.

use super::Pane;
use crate::explorer::app::App;
use crate::explorer::update::{Effect, look};
use ratatui::layout::{Position, Rect};

/// Spring under a column of the screen, in a pane with a section of the profile.
pub fn position_at(app: &App, pane: Pane, area: Rect, column: u16) -> Option<usize> {
    let line = app.snapshot.as_deref()?.line;
    let (section, chart, place) = (pane.row().section?)(app, area)?;
    let spring = (place.number_at(&chart.x, column) / line.spacing) as usize;
    let spring = spring.saturating_sub(line.first);
    Some(spring.clamp(section.first, section.first + section.springs.saturating_sub(1)))
}

/// Share of the section in a pane to the left of a column of the screen; `None` for a pane without section.
#[must_use]
pub fn share_at(app: &App, pane: Pane, area: Rect, column: u16) -> Option<f64> {
    let (_, chart, place) = (pane.row().section?)(app, area)?;
    Some(chart.x.share(place.number_at(&chart.x, column)))
}

/// Selects the pane under the mouse and zooms such that the point under the mouse stays there.
pub fn zoom_at(app: &mut App, area: Rect, here: Position, turns: i32) -> Vec<Effect> {
    look::zoom_at(app, turns, share_at(app, app.view.pane, area, here.x));
    vec![Effect::Ask]
}
