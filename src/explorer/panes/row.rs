//! Properties of one pane.

use crate::explorer::app::{App, ManualState};
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::export::report::Report;
use crate::export::run::{PathReport, RunReport};
use asperity_plot::Figure;
use ratatui::layout::Size;
use std::borrow::Cow;
use std::sync::Arc;

/// Command and result of an exported pane.
pub type Exported<'a> = Option<(Cow<'static, str>, Box<dyn Report + 'a>)>;

pub struct PaneRow {
    /// Content for an area of this size within the frame.
    pub panel: fn(&App, Size) -> Panel,
    /// Content as a figure for a file, where this is more than the chart of the panel.
    pub figure: fn(&App, &Panel) -> Option<Figure>,
    /// The command and the report that a table or a JSON file states, where this is more than the curves of the figure;
    /// `None` while the result is missing.
    pub report: for<'a> fn(&'a App) -> Exported<'a>,
    /// Studies of a computed scene whose values the shown pane needs.
    pub studies: fn(&App, &Arc<SolvedScene>) -> Vec<Study>,
    /// Paragraphs of the help: a name and the meaning of the signs in the pane.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// An empty pane.
    pub const EMPTY: PaneRow = PaneRow {
        panel: |_, _| Panel::of_text(String::new(), ""),
        figure: |app, panel| Some(Figure::of_chart(app.edit.document.title(), panel.chart()?.clone())),
        report: |_| None,
        studies: |_, _| Vec::new(),
        help: &[],
    };
}

/// Command of a result that no other command computes: the explorer opens on the scene, with the path of manual loading as
/// its loading.
pub const OPEN_COMMAND: &str = "asperity";

/// The path of manual loading, else the outcome of the scene with its force curve.
pub fn outcome(app: &App) -> Exported<'_> {
    if let Some(ManualState { loading, path, stages, .. }) = &app.manual {
        return Some((OPEN_COMMAND.into(), Box::new(PathReport { loading, path, stages })));
    }
    let (title, scene, outcome) =
        (app.edit.document.title(), app.edit.document.scene(), &app.current()?.outcome);
    let report = RunReport { title, scene, outcome, choice: None, estimate: app.studies.value() };
    Some(("asperity run".into(), Box::new(report)))
}
