//! Sensitivity of the results to the numbers of the scene: all changes as a table, with bars for
//! the adhesion force.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::studies::Study;
use crate::explorer::text::filled;
use asperity_plot::{Figure, Label};
use asperity_report::{SensitivityReport, sensitivity_chart, sensitivity_table};
use asperity_study::Sensitivity;
use ratatui::layout::Size;
use ratatui::text::{Line, Span};
use std::sync::Arc;

/// Number of rows besides the rows of the bars: results of the scene, heading, and horizontal axis
/// with its numbers and label.
const BESIDE: u16 = 5;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| {
        let found = app
            .studies
            .value::<Sensitivity>()
            .filter(|found| found.missing().is_none())?;
        let chart = sensitivity_chart(found, 0, found.influences.len());
        Some(Figure::of_chart(app.edit.document.title(), chart))
    },
    report,
    studies: |_, computed| {
        let scene = Arc::clone(&computed.scene);
        vec![Study::new(
            computed.generation,
            false,
            move |simulation, control| Sensitivity::of(&scene, simulation, control),
        )]
    },
    help: &[(
        "Sensitivity",
        "key Y: change of the median F_a where one number of the scene is 10 % smaller or larger, and the range over the \
         profiles",
    )],
};

fn report(app: &App) -> Exported<'_> {
    let (title, scene) = (app.edit.document.title(), app.edit.document.scene());
    let sensitivity = app
        .studies
        .value()
        .filter(|_| app.studies.is_done::<Sensitivity>())?;
    let report = SensitivityReport {
        title,
        scene,
        sensitivity,
    };
    Some(("asperity sensitivity".into(), Box::new(report)))
}

fn panel(app: &App, size: Size) -> Panel {
    let title = "Sensitivity: each number ±10 %".to_owned();
    let Some(found) = app.studies.value::<Sensitivity>() else {
        return Panel::of_text(
            title,
            app.studies
                .failure::<Sensitivity>()
                .unwrap_or("computing …"),
        );
    };
    if let Some(missing) = found.missing() {
        return Panel::of_text(title, missing);
    }
    let bars = usize::from(size.height.saturating_sub(BESIDE));
    let most = (bars / 2).saturating_sub(found.range.iter().len()).max(1);
    let mut rows = sensitivity_table(found, most);
    let present = rows.remove(1);
    let fits =
        |labels: &Vec<String>| labels[0].chars().count() + 2 <= usize::from(3 * size.width / 4);
    let labels = (1..=3)
        .rev()
        .map(|results| labels(&rows, results))
        .find(fits);
    let mut chart = sensitivity_chart(found, 0, most);
    let present = [3, 5, 6].map(|result| {
        vec![Span::raw(format!(
            "{} {}",
            rows[0][result], present[result]
        ))]
    });
    let mut head = filled(present.to_vec(), "  ", size.width.into());
    if let Some(labels) = labels {
        head.push(Line::raw(labels[0].clone()));
        chart.y.names = labels[1..]
            .iter()
            .rev()
            .map(|label| Label::plain(label))
            .collect();
    }
    // A row of the screen for each bar.
    chart.y.span.low -= bars.saturating_sub(chart.y.names.len()) as f64;
    let hidden = found.influences.len().saturating_sub(most);
    let edge =
        (hidden > 0).then(|| vec![Span::raw(format!("and {hidden} numbers of less influence"))]);
    Panel {
        head,
        edge: edge.into_iter().collect(),
        ..Panel::of_chart(title, chart)
    }
}

/// Rows of the table, padded to one width: name, change of the number, and changes of the first
/// `results` results.
fn labels(rows: &[[String; 7]], results: usize) -> Vec<String> {
    let length = |text: &String| text.chars().count();
    let line = |row: &[String; 7]| {
        let columns = [0, 2, 3, 5, 6].into_iter().take(2 + results);
        let cell = |at: usize| {
            format!(
                "{:width$}  ",
                row[at],
                width = rows.iter().map(|row| length(&row[at])).max().unwrap_or(0)
            )
        };
        columns.map(cell).collect::<String>().trim_end().to_owned()
    };
    let lines: Vec<String> = rows.iter().map(line).collect();
    let widest = lines.iter().map(length).max().unwrap_or(0);
    lines.iter().map(|line| format!("{line:widest$}")).collect()
}
