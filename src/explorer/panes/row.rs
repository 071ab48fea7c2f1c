//! The properties of a pane, as one row of the table of panes.

use crate::explorer::advice;
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use asperity_plot::Figure;
use asperity_report::{PathReport, Report, RunReport};
use asperity_study::trust::MeasuredAdhesion;
use ratatui::layout::Size;
use std::borrow::Cow;
use std::sync::Arc;

/// Command that computes the result of a pane, and the result; `None` while it is missing.
pub type Exported<'a> = Option<(Cow<'static, str>, Box<dyn Report + 'a>)>;

pub struct PaneRow {
    /// Content for an area of this size inside the frame.
    pub panel: fn(&App, Size) -> Panel,
    /// Content as a figure for a file, which may have more than the chart of the panel.
    pub figure: fn(&App, &Panel) -> Option<Figure>,
    /// Content as a table or JSON with the command that computes it, if that is more than the
    /// curves of the figure; `None` while the result is missing.
    pub report: for<'a> fn(&'a App) -> Exported<'a>,
    /// Studies of a computed scene whose values the pane needs while it is shown.
    pub studies: fn(&App, &Arc<SolvedScene>) -> Vec<Study>,
    /// Paragraphs of the help: names, and the meanings of the signs in the pane.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// Properties of a pane without content, as defaults.
    pub const EMPTY: PaneRow = PaneRow {
        panel: |_, _| Panel::of_text(String::new(), ""),
        figure: |app, panel| {
            Some(Figure::of_chart(
                app.edit.document.title(),
                panel.chart()?.clone(),
            ))
        },
        report: |_| None,
        studies: |_, _| Vec::new(),
        help: &[],
    };
}

/// Command for a result that no other command computes: the explorer opens on the scene, whose
/// loading is the path of manual loading.
pub const OPEN_COMMAND: &str = "asperity";

/// Report of the pane's result: the path of manual loading, or else the outcome of the scene with
/// its force curve.
pub fn outcome(app: &App) -> Exported<'_> {
    let scene = app.edit.document.scene();
    if let Some(manual) = &app.manual {
        let report = PathReport {
            scene,
            loading: &manual.loading,
            path: &manual.path,
            stages: &manual.stages,
        };
        return Some((OPEN_COMMAND.into(), Box::new(report)));
    }
    let measured = app.studies.value::<MeasuredAdhesion>();
    let report = RunReport {
        title: app.edit.document.title(),
        scene,
        outcome: &app.current()?.outcome,
        choice: None,
        estimate: app.studies.value(),
        ensemble: app.studies.value(),
        deviation: measured.and_then(MeasuredAdhesion::fit_deviation),
        wording: advice::row,
    };
    Some(("asperity run".into(), Box::new(report)))
}
