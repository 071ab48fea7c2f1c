//! The properties of a pane. Each pane has one row with these properties in the table of panes.

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

/// Result of a pane for an exported file, and the shell command that computes this result. `None`
/// as long as there is no result.
pub type Exported<'a> = Option<(Cow<'static, str>, Box<dyn Report + 'a>)>;

pub struct PaneRow {
    /// Function that makes the content of the pane for an area of this size inside the frame.
    pub panel: fn(&App, Size) -> Panel,
    /// Function that returns the number of pages into which an area of this size divides the
    /// content.
    pub pages: fn(&App, Size) -> usize,
    /// Function that makes the figure of the pane for an exported file. The figure may contain more
    /// than the chart on the screen. The function returns `None` if the pane has no chart.
    pub figure: fn(&App, &Panel) -> Option<Figure>,
    /// Function that makes the table or the JSON of the pane for an exported file, with the shell
    /// command that computes it. It returns `None` if there is no result yet, or if the curves of
    /// the figure are the whole result.
    pub report: for<'a> fn(&'a App) -> Exported<'a>,
    /// Function that returns the studies (background computations) whose values the pane needs
    /// while it is shown.
    pub studies: fn(&App, &Arc<SolvedScene>) -> Vec<Study>,
    /// Paragraphs of the help that explain the symbols in the pane, each with a name and a text.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// Row with the properties of a pane without content. The rows of all panes begin with a copy
    /// of it and replace some of its properties.
    pub const EMPTY: PaneRow = PaneRow {
        panel: |_, _| Panel::of_text(String::new(), ""),
        pages: |_, _| 1,
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

/// Shell command that is stated for a result if no other command computes it. The command opens the
/// explorer on the scene. If the result is the path of manual loading, the scene has this path as
/// its loading.
pub const OPEN_COMMAND: &str = "asperity";

/// Returns the path of manual loading as a report. If there is no manual loading, returns the
/// outcome of the scene with its force curve.
pub fn outcome(app: &App) -> Exported<'_> {
    let scene = app.edit.document.scene();
    if app.edit.path.is_some() {
        let report = PathReport {
            scene,
            stages: &app.followed()?.stages,
        };
        return Some((OPEN_COMMAND.into(), Box::new(report)));
    }
    let command = format!("asperity run{}", app.edit.profiles_argument());
    Some((command.into(), Box::new(run_report(app)?)))
}

/// Returns the report on the computed scene; `None` until the present scene is computed.
pub fn run_report(app: &App) -> Option<RunReport<'_>> {
    let measured = app.studies.value::<MeasuredAdhesion>();
    Some(RunReport {
        title: app.edit.document.title(),
        scene: app.edit.document.scene(),
        outcome: &app.current()?.outcome,
        choice: None,
        estimate: app.studies.value(),
        ensemble: app.studies.value(),
        deviation: measured.and_then(MeasuredAdhesion::fit_deviation),
        wording: advice::row,
    })
}
