//! From a cell of profile or close-up to the spring that is drawn there.

use super::Pane;
use super::{close_up, profile};
use crate::explorer::model::Model;
use ratatui::layout::Rect;

/// Spring of the section of profile or close-up under a column of the screen.
pub fn position_at(model: &Model, pane: Pane, area: Rect, column: u16) -> Option<usize> {
    let moment = model.moment.as_deref()?;
    let (chart, place) = match pane {
        Pane::Profile => profile::placed(moment, area, profile::heights(moment)),
        Pane::CloseUp if !model.lengths && !model.side_by_side => close_up::placed(moment, area),
        _ => return None,
    };
    let section = if pane == Pane::Profile { &moment.profile } else { &moment.close_up.section };
    let spring = (place.number_at(&chart.x, column) / moment.line.spacing) as usize;
    let spring = spring.saturating_sub(moment.line.first);
    Some(spring.clamp(section.first, section.first + section.springs.saturating_sub(1)))
}

/// Share of the part of the profile that a pane shows, under a column of the screen; `None` for a pane without profile.
#[must_use]
pub fn share_at(model: &Model, pane: Pane, area: Rect, column: u16) -> Option<f64> {
    match pane {
        Pane::Profile => profile::share_at(model, area, column),
        Pane::CloseUp if !model.lengths => close_up::share_at(model, area, column),
        _ => None,
    }
}
