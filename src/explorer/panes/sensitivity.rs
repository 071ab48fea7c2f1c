//! Sensitivity of the results to each number of the scene: a table of all changes, with bars for
//! the pull-off force.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled};
use asperity_plot::{Figure, Label};
use asperity_report::{SensitivityReport, sensitivity_chart, sensitivity_table};
use asperity_study::Sensitivity;
use ratatui::layout::Size;
use ratatui::text::{Line, Span};
use std::sync::Arc;

/// Number of rows that cannot be used for bars: they contain the results of the scene, the heading,
/// and the horizontal axis with its numbers and its label.
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
    if !app.studies.is_done::<Sensitivity>() {
        return None;
    }
    let report = SensitivityReport {
        title: app.edit.document.title(),
        scene: app.edit.document.scene(),
        sensitivity: app.studies.value()?,
    };
    Some(("asperity sensitivity".into(), Box::new(report)))
}

fn panel(app: &App, size: Size) -> Panel {
    let title = "Sensitivity: each number ±10 %".to_owned();
    let Some(sensitivity) = app.studies.value::<Sensitivity>() else {
        let failure = app.studies.failure::<Sensitivity>();
        return Panel::of_text(title, failure.unwrap_or("computing …"));
    };
    if let Some(missing) = sensitivity.missing() {
        return Panel::of_text(title, missing);
    }
    // Each number of the scene takes two rows: a bar for its decrease and a bar for its increase.
    let bars = usize::from(size.height.saturating_sub(BESIDE));
    let of_range = sensitivity.range.iter().len();
    let most = (bars / 2).saturating_sub(of_range).max(1);
    let mut rows = sensitivity_table(sensitivity, most);
    let present = rows.remove(1);
    let mut head = filled(results(&rows[0], &present), "  ", size.width.into());
    let mut chart = sensitivity_chart(sensitivity, 0, most);
    if let Some(labels) = labels_within(&rows, usize::from(3 * size.width / 4)) {
        head.push(Line::raw(labels[0].clone()));
        let names = labels[1..].iter().rev();
        chart.y.names = names.map(|label| Label::plain(label)).collect();
    }
    chart.y.span.low -= bars.saturating_sub(chart.y.names.len()) as f64;
    let all = sensitivity.influences.len();
    // At the edge of the title there might be no room to say that numbers are left out.
    let title = if all > most {
        format!("Sensitivity: the largest {most} of {all}, ±10 %")
    } else {
        title
    };
    Panel {
        head,
        ..Panel::of_chart(title, chart)
    }
}

/// Columns of the table that contain results: F_a and two further results.
const RESULTS: [usize; 3] = [3, 5, 6];

/// Returns the results of the unchanged scene. Before each result is its name from the heading of
/// the table.
fn results(heading: &[String; 7], present: &[String; 7]) -> Vec<Part> {
    let mut parts = Vec::new();
    for column in RESULTS {
        let text = format!("{} {}", heading[column], present[column]);
        parts.push(vec![Span::raw(text)]);
    }
    parts
}

/// Returns the labels of the rows with as many results as fit into this number of columns; `None`
/// if there is no room for a result.
fn labels_within(rows: &[[String; 7]], columns: usize) -> Option<Vec<String>> {
    for results in (1..=RESULTS.len()).rev() {
        let labels = labels(rows, results);
        if labels[0].chars().count() + 2 <= columns {
            return Some(labels);
        }
    }
    None
}

/// Returns the rows of the table as texts of equal width. Each text contains the name of a number,
/// its change, and the changes of the first `results` results.
fn labels(rows: &[[String; 7]], results: usize) -> Vec<String> {
    let mut columns = vec![0, 2];
    columns.extend(&RESULTS[..results]);
    let mut lines = vec![String::new(); rows.len()];
    for column in columns {
        let lengths = rows.iter().map(|row| row[column].chars().count());
        let width = lengths.max().unwrap_or(0);
        for (line, row) in lines.iter_mut().zip(rows) {
            *line += &format!("{:width$}  ", row[column]);
        }
    }
    let lines: Vec<&str> = lines.iter().map(|line| line.trim_end()).collect();
    let lengths = lines.iter().map(|line| line.chars().count());
    let widest = lengths.max().unwrap_or(0);
    lines.iter().map(|line| format!("{line:widest$}")).collect()
}
