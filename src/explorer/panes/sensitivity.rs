//! Sensitivity of the results to each number of the scene: a table of all changes, with bars for
//! the pull-off force.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::{Panel, numbered};
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled};
use asperity_plot::{CellPlot, Figure, Label};
use asperity_report::{NOT_ALLOWED, SensitivityReport, sensitivity_chart, sensitivity_table};
use asperity_study::Sensitivity;
use ratatui::layout::{Rect, Size};
use ratatui::text::{Line, Span};
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel: |app, size| {
        let mut pages = pages(app, size);
        let page = app.view.page.min(pages.len() - 1);
        pages.swap_remove(page)
    },
    pages: |app, size| pages(app, size).len(),
    figure: |app, _| {
        let found = app
            .studies
            .value::<Sensitivity>()
            .filter(|found| found.missing().is_none())?;
        let rows = sensitivity_table(found).len() - BEFORE_BARS;
        let chart = sensitivity_chart(found, 0, 0..rows);
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
         profiles. PageDown: further numbers in a small window",
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

/// Number of rows of the table before the rows with bars: the heading and the present results.
const BEFORE_BARS: usize = 2;

/// Returns the pages of the pane, each with as many bars as fit. There is at least one page.
fn pages(app: &App, size: Size) -> Vec<Panel> {
    let title = "Sensitivity: each number ±10 %".to_owned();
    let Some(sensitivity) = app.studies.value::<Sensitivity>() else {
        let failure = app.studies.failure::<Sensitivity>();
        return vec![Panel::of_text(title, failure.unwrap_or("computing …"))];
    };
    if let Some(missing) = sensitivity.missing() {
        return vec![Panel::of_text(title, missing)];
    }
    let mut rows = sensitivity_table(sensitivity);
    let present = rows.remove(1);
    let results = filled(results(&rows[0], &present), "  ", size.width.into());
    for row in &mut rows {
        if row[SINGLE_PROFILES] == NOT_ALLOWED {
            row[RESULTS[0]] = NOT_ALLOWED.to_owned();
        }
    }
    let heading = rows.remove(0);
    let bars = rows.len();
    // The heading of the table has one row.
    let room = Rect {
        height: size.height.saturating_sub(results.len() as u16 + 1),
        ..Rect::from(size)
    };
    let whole = sensitivity_chart(sensitivity, 0, 0..bars);
    let rows_of_plot = usize::from(CellPlot::within(room, &whole).plot.height);
    // The two bars of a number are on one page.
    let bars_of_page = (rows_of_plot / 2 * 2).max(2);
    // The number of the page needs room in the title.
    let title = if bars > bars_of_page {
        "Sensitivity to ±10 %".to_owned()
    } else {
        title
    };
    let mut pages = Vec::new();
    for first in (0..bars).step_by(bars_of_page) {
        let shown = first..bars.min(first + bars_of_page);
        let mut chart = sensitivity_chart(sensitivity, 0, shown.clone());
        let mut head = results.clone();
        let listed = [std::slice::from_ref(&heading), &rows[shown]].concat();
        if let Some(labels) = labels_within(&listed, usize::from(3 * size.width / 4)) {
            head.push(Line::raw(labels[0].clone()));
            let names = labels[1..].iter().rev();
            chart.y.names = names.map(|label| Label::plain(label)).collect();
        }
        // Each bar has one row, and the rows that remain are below the bars.
        let blank = rows_of_plot.saturating_sub(chart.y.names.len());
        chart.y.span.low -= blank as f64;
        pages.push(Panel {
            head,
            ..Panel::of_chart(title.clone(), chart)
        });
    }
    numbered(pages)
}

/// Column of the table that contains the range of F_a over the profiles.
const SINGLE_PROFILES: usize = 4;

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
