//! The table of panes: one row each. A pane is one file with one function of the app, which returns its panel.

mod accuracy;
mod beside;
mod close_up;
mod force;
mod lengths;
mod map;
mod parameters;
mod preload_curve;
mod preloads;
mod profile;
mod reversals;
mod scene_spectra;
mod section;
mod spectrum;

pub use accuracy::Costs;
pub use force::{indentation_at, nearest};
pub use parameters::parameter_in;
pub use preload_curve::{PROFILES, PreloadCurve};
pub use scene_spectra::SceneSpectra;
pub use section::spring_at;

use super::app::App;
use super::keys::Context;
use super::layout::{Layout, inside};
use super::panel::{self, Panel, Under};
use super::snapshot::SolvedScene;
use super::studies::Study;
use crate::draw::Figure;
use crate::export::{Report, RunReport};
use ratatui::layout::{Position, Size};
use std::sync::Arc;

/// The panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    /// The force curve.
    Force,
    /// The profile with the distribution of its heights.
    Profile,
    /// The close-up of contact patches.
    CloseUp,
    /// Distribution of the lengths of contact patches, in place of the close-up.
    Lengths,
    /// The profile of the newest loop kept for comparison, in place of the close-up.
    Beside,
    /// Cost of accuracy and stages of the run, in place of profile and close-up.
    Accuracy,
    /// Spectra, in place of profile and close-up.
    Spectrum,
    /// Adhesion against preload, in place of profile and close-up.
    Preloads,
    /// Everett function of first-order reversal curves, in place of profile and close-up.
    Everett,
    /// Density of first-order reversal curves, in place of profile and close-up.
    Density,
    /// The map over κ and H, in place of profile and close-up.
    Map,
    /// The list of parameters.
    Parameters,
}

/// Place of a pane in a window with room for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Own,
    CloseUp,
    /// The place of profile and close-up.
    Large,
}

/// Command and result of an exported pane.
pub type Exported<'a> = Option<(&'static str, Box<dyn Report + 'a>)>;

/// Properties of one pane.
pub struct PaneRow {
    /// Place in a window with room for all.
    pub place: Place,
    /// Content for an area of this size within the frame.
    pub panel: fn(&App, Size) -> Panel,
    /// Content as a figure for a file, where this is more than the chart of the panel.
    pub figure: fn(&App, &Panel) -> Option<Figure>,
    /// The command and the report that a table or a JSON file states; `None` while the result is missing.
    pub report: for<'a> fn(&'a App) -> Exported<'a>,
    /// Keys of the selected pane; those of the crosshair, while this is shown.
    pub keys: Option<Context>,
    /// Studies of a computed scene whose values the shown pane needs.
    pub studies: fn(&App, &Arc<SolvedScene>) -> Vec<Study>,
    /// Paragraphs of the help: a name and the meaning of the signs in the pane.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// An empty pane in the place of profile and close-up.
    pub const EMPTY: PaneRow = PaneRow {
        place: Place::Large,
        panel: |_, _| Panel::of_text(String::new(), ""),
        figure: |app, panel| Some(Figure::of_chart(app.edit.document.title(), panel.chart()?.clone())),
        report: outcome,
        keys: None,
        studies: |_, _| Vec::new(),
        help: &[],
    };
}

/// The outcome of the scene, with its force curve.
fn outcome(app: &App) -> Exported<'_> {
    let (title, scene, outcome) =
        (app.edit.document.title(), app.edit.document.scene(), &app.current()?.outcome);
    let report = RunReport { title, scene, outcome, choice: None, estimate: app.studies.value() };
    Some(("asperity run", Box::new(report)))
}

/// Size within the frame of a pane that is exported.
const EXPORTED: Size = Size { width: 120, height: 40 };

impl Pane {
    /// All panes, in the order of the help.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;

    pub fn row(self) -> &'static PaneRow {
        match self {
            Pane::Force => &force::ROW,
            Pane::Profile => &profile::ROW,
            Pane::CloseUp => &close_up::ROW,
            Pane::Lengths => &lengths::ROW,
            Pane::Beside => &beside::ROW,
            Pane::Accuracy => &accuracy::ROW,
            Pane::Spectrum => &spectrum::ROW,
            Pane::Preloads => &preloads::ROW,
            Pane::Everett => &reversals::EVERETT,
            Pane::Density => &reversals::DENSITY,
            Pane::Map => &map::ROW,
            Pane::Parameters => &parameters::ROW,
        }
    }

    /// Content of the pane for an area of this size within the frame, with the crosshair.
    pub fn panel(self, app: &App, size: Size) -> Panel {
        let mut panel = (self.row().panel)(app, size);
        // The crosshairs of the other panes are at the shown state and at a spring.
        if let (Some(position), Place::Large) = (app.view.crosshair, self.row().place) {
            panel.read_at(position, app.view.appearance);
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

/// Letter of a ghost.
pub fn letter(number: usize) -> &'static str {
    const LETTERS: [&str; 8] = ["A", "B", "C", "D", "E", "F", "G", "H"];
    LETTERS[number % LETTERS.len()]
}

/// Letter of the newest ghost.
pub fn newest_letter(app: &App) -> &'static str {
    letter(app.ghosts.len().saturating_sub(1))
}
