//! The table of panes, with one row for each pane. Each pane has a file of its own. The file has a
//! function that makes the content of the pane from the state of the explorer.

mod close_up;
mod compared;
mod events;
pub mod force;
mod force_loops;
mod map;
mod parameters;
mod preloads;
mod profile;
mod result;
pub mod row;
mod section;
mod sensitivity;
pub mod spectrum;
mod timeline;
pub mod trust;

use self::row::PaneRow;
use crate::explorer::app::App;
use crate::explorer::keys::bindings::Context;
use crate::explorer::layout::{Layout, inside};
use crate::explorer::pane::Pane;
use crate::explorer::panel;
use crate::explorer::panel::{Panel, Under};
use asperity_plot::Figure;
use ratatui::layout::{Position, Size};

/// Size in columns and rows for which a pane is laid out to make its figure for a file.
const EXPORTED: Size = Size {
    width: 120,
    height: 40,
};

pub fn row(pane: Pane) -> &'static PaneRow {
    match pane {
        Pane::Force => &force::ROW,
        Pane::Timeline => &timeline::ROW,
        Pane::Profile => &profile::ROW,
        Pane::CloseUp => &close_up::ROW,
        Pane::Trust => &trust::ROW,
        Pane::Spectrum => &spectrum::ROW,
        Pane::Preloads => &preloads::ROW,
        Pane::Sensitivity => &sensitivity::ROW,
        Pane::Map => &map::ROW,
        Pane::Parameters => &parameters::ROW,
        Pane::Result => &result::ROW,
        Pane::Events => &events::ROW,
    }
}

/// Returns the content of a pane, including the crosshair, for an area of this size inside the
/// frame of the pane.
pub fn panel(app: &App, pane: Pane, size: Size) -> Panel {
    let mut panel = (row(pane).panel)(app, size);
    // The profile and the close-up draw their crosshair themselves, because it is at a spring.
    let draws_crosshair =
        pane == app.view.pane && pane.keys() == Context::Crosshair && app.section().is_none();
    if draws_crosshair && let Some(position) = app.view.crosshair {
        panel.read_at(position, app.view.appearance, size.width);
    }
    panel
}

/// Returns the figure of a pane for an exported file; `None` if the pane has no chart.
pub fn figure(app: &App, pane: Pane) -> Option<Figure> {
    let properties = row(pane);
    let content = (properties.panel)(app, EXPORTED);
    (properties.figure)(app, &content)
}

/// Returns the pane that is drawn at a character cell of the screen, and what the pane shows in
/// this cell; `None` if there is no pane.
pub fn under(app: &App, cell: Position) -> Option<(Pane, Under)> {
    let mut panes = Layout::of(app).panes.into_iter();
    let (pane, area) = panes.find(|(_, area)| area.contains(cell))?;
    let content = panel(app, pane, inside(area).as_size());
    let under = panel::under(&content, area, app.view.appearance, cell);
    Some((pane, under))
}
