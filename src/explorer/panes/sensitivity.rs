//! Sensitivity of the results to the numbers of the scene: bars of the changes of the adhesion force, and all changes.

use super::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::{Panel, names};
use crate::explorer::studies::Study;
use crate::explorer::view::text::{filled, fitted};
use crate::export::sheet::Sheet;
use crate::export::{SensitivityReport, sensitivity_chart, sensitivity_table};
use crate::study::Sensitivity;
use ratatui::layout::Size;
use ratatui::text::Line;
use std::sync::Arc;

/// Rows of a chart beside its bars: horizontal axis, its numbers and label, legend.
const BESIDE: u16 = 4;

pub static ROW: PaneRow = PaneRow {
    panel,
    report,
    studies: |_, computed| {
        let scene = Arc::clone(&computed.scene);
        vec![Study::new(computed.generation, false, move |simulation, stop, report| {
            let found = Sensitivity::of(&scene, simulation, stop, &mut |part| report(part.clone()));
            found.map_err(|error| error.to_string())
        })]
    },
    help: &[(
        "Sensitivity",
        "Y: change of the adhesion force where one number of the scene is 10 % smaller or larger, the largest change at the \
         top, and the range over other random profiles",
    )],
    ..PaneRow::EMPTY
};

fn report(app: &App) -> Exported<'_> {
    let (title, scene) = (app.edit.document.title(), app.edit.document.scene());
    let sensitivity = app.studies.value().filter(|_| app.studies.is_done::<Sensitivity>())?;
    Some(("asperity sensitivity".into(), Box::new(SensitivityReport { title, scene, sensitivity })))
}

fn panel(app: &App, size: Size) -> Panel {
    let title = "Sensitivity to ±10 % of each number".to_owned();
    let Some(found) = app.studies.value::<Sensitivity>() else {
        return Panel::of_text(title, app.studies.failure::<Sensitivity>().unwrap_or("computing …"));
    };
    // The bars have the changes of the adhesion force.
    let others = sensitivity_table(found)
        .into_iter()
        .map(|[name, value, _, zero_load, loss]| [name, value, zero_load, loss]);
    let table = Sheet::of_table(&others.collect::<Vec<_>>());
    let bars = size.height.saturating_sub(BESIDE);
    // The table of all results where it leaves as many rows for the bars.
    let foot: Vec<Line<'static>> = if bars > 2 * table.lines().count() as u16 {
        table.lines().map(|line| fitted(Line::raw(line.to_owned()), size.width)).collect()
    } else {
        Vec::new()
    };
    let chart = sensitivity_chart(found, 0, (usize::from(bars) - foot.len()).max(1));
    let head = filled(names(&chart, app.view.appearance), "  ", size.width.into());
    Panel { head, foot, ..Panel::of_chart(title, chart) }
}
