//! The table of panes: one row each. A pane is one file with one function of the app, which returns its panel.

mod accuracy;
mod close_up;
mod force;
mod map;
mod parameters;
mod preload_curve;
mod preloads;
mod profile;
mod row;
mod section;
mod sensitivity;
mod spectrum;

pub use crate::export::SceneSpectra;
pub use accuracy::Costs;
pub use force::indentation_at;
pub use preload_curve::{PROFILES, PreloadCurve};
pub use row::{Exported, OPEN_COMMAND, PaneRow};

use super::app::App;
use super::keys::Context;
use super::layout::{Layout, inside};
pub use super::pane::Pane;
use super::panel::{self, Panel, Under};
use crate::draw::Figure;
use ratatui::layout::{Position, Size};

/// Size within the frame of a pane that is exported.
const EXPORTED: Size = Size { width: 120, height: 40 };

impl Pane {
    pub fn row(self) -> &'static PaneRow {
        match self {
            Pane::Force => &force::ROW,
            Pane::Profile => &profile::ROW,
            Pane::CloseUp => &close_up::ROW,
            Pane::Accuracy => &accuracy::ROW,
            Pane::Spectrum => &spectrum::ROW,
            Pane::Preloads => &preloads::ROW,
            Pane::Sensitivity => &sensitivity::ROW,
            Pane::Map => &map::ROW,
            Pane::Parameters => &parameters::ROW,
        }
    }

    /// Content of the pane for an area of this size within the frame, with the crosshair.
    pub fn panel(self, app: &App, size: Size) -> Panel {
        let mut panel = (self.row().panel)(app, size);
        // The crosshair of profile and close-up is at a spring.
        let is_chart = self == app.view.pane && self.keys() == Context::Crosshair && app.section().is_none();
        if let Some(position) = app.view.crosshair.filter(|_| is_chart) {
            let width = if self.is_large() { size.width } else { u16::MAX };
            panel.read_at(position, app.view.appearance, width);
        }
        panel
    }

    /// The pane as a figure for a file; `None` while it has no chart.
    pub fn figure(self, app: &App) -> Option<Figure> {
        (self.row().figure)(app, &(self.row().panel)(app, EXPORTED))
    }
}

/// Returns the pane at a cell of the screen and what it shows there.
pub fn under(app: &App, cell: Position) -> Option<(Pane, Under)> {
    let layout = Layout::of(app);
    let (pane, area) = layout.panes.into_iter().find(|(_, area)| area.contains(cell))?;
    Some((pane, panel::under(&pane.panel(app, inside(area).as_size()), area, cell)))
}
