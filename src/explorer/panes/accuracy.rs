//! Cost of accuracy: errors over times, both logarithmic, requirements of a good accuracy, and the stages of the run.

use super::{Exported, PaneRow};
use crate::accuracy::{CostTable, Estimate, Knob, Progress, measure};
use crate::draw::{Chart, Ink, Layer, Shape, Sign, Span};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::{Panel, names};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::theme::{Appearance, Meaning};
use crate::explorer::view::stages;
use crate::explorer::view::text::{filled, wrapped};
use crate::export::{CostReport, work_precision};
use crate::scene::{Edges, Numerics, Solver, format_quantity, format_rounded};
use crate::text::{grouped, per_cent};
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

pub static ROW: PaneRow = PaneRow {
    panel,
    report,
    keys: Some(Context::Crosshair),
    studies: |_, computed| vec![study(computed)],
    help: &[(
        "Accuracy",
        "A: relative error against the time of a run, with springs and edges between them or at them, and with steps of \
         the stepwise solver; ◆ is the scene. Below it error and time of the scene, the time of a ten times smaller error, \
         the cost of 1 % and 0.1 %, and the computing stages",
    )],
    ..PaneRow::EMPTY
};

/// Time for a whole measurement: that of `asperity cost`.
const BUDGET: Duration = Duration::from_secs(10);

#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub table: Option<CostTable>,
    pub trying: Option<String>,
}

/// Measures the costs of a scene. Their times are measured together: an interrupted measurement begins anew.
fn study(computed: &SolvedScene) -> Study {
    let scene = Arc::clone(&computed.scene);
    Study::new(computed.generation, true, move |_, stop, report| {
        let mut costs = Costs::default();
        let measured = measure(&scene, Path::new(""), BUDGET, stop, &mut |progress| {
            match progress {
                Progress::Trying(knob, setting) => costs.trying = Some(format!("{}: {setting}", knob.name())),
                Progress::Rows(table) => costs.table = Some(table.clone()),
            }
            report(costs.clone());
        });
        Ok(Costs { table: Some(measured?), trying: None })
    })
}

fn report(app: &App) -> Exported<'_> {
    let (document, table) = (&app.edit.document, app.studies.value::<Costs>()?.table.as_ref()?);
    Some(("asperity cost".into(), Box::new(CostReport::new(document.title(), document.scene(), table))))
}

/// Relative errors whose requirements are stated, with lines in the plot.
const TARGETS: [f64; 2] = [0.01, 0.001];

/// Lower limit of the plot; errors below are in the lowest row.
const LOWEST: f64 = 1e-8;

fn panel(app: &App, size: Size) -> Panel {
    let title = "Accuracy: error over time, log–log".to_owned();
    let table = app.studies.value::<Costs>().and_then(|costs| costs.table.as_ref());
    let chart = table.and_then(|table| Some((table, work_precision("", table).charts.pop()?)));
    let Some((table, chart)) = chart.filter(|(_, chart)| !chart.layers.is_empty()) else {
        let foot = texts(app, None, size);
        return Panel { foot, ..Panel::of_text(title, &nothing_yet(app)) };
    };
    let head = entries(table, &chart, size.width, app.view.appearance);
    let chart = with_scene(chart, app, table);
    Panel { head, foot: texts(app, Some(table), size), ..Panel::of_chart(title, chart) }
}

fn nothing_yet(app: &App) -> String {
    if app.is_computing() {
        return "the scene is computed first…".to_owned();
    }
    match (app.studies.failure::<Costs>(), app.studies.is_done::<Costs>()) {
        _ if !app.is_current() => "the scene has no curve to estimate an error of".to_owned(),
        (Some(why), _) => format!("nothing is measured: {why}"),
        (None, true) => {
            "nothing to show: no force in this scene whose error depends on springs or steps".to_owned()
        }
        (None, _) if !app.view.shows_times => {
            "times are not measured here: they differ from run to run".to_owned()
        }
        (None, _) => "measuring: each setting from coarse to fine, as often as 10 s allow…".to_owned(),
    }
}

/// The chart with the target errors and the scene itself, down to errors of interest.
fn with_scene(mut chart: Chart, app: &App, table: &CostTable) -> Chart {
    let Span { low, high } = chart.y.span;
    chart.y.span = Span { low: low.max(LOWEST.log10()).min(high - 1.0), high };
    let lowest = 10_f64.powf(chart.y.span.low);
    for layer in &mut chart.layers {
        if let Shape::Curve { points, .. } = &mut layer.shape {
            points.iter_mut().for_each(|point| point.1 = point.1.max(lowest));
        }
    }
    let targets = TARGETS.map(|target| Layer::unnamed(Ink::Quiet, Shape::Level(target)));
    chart.layers.splice(0..0, targets);
    if let Some((seconds, error)) = present(&app.edit.document.scene().numerics, table) {
        let points = vec![(seconds, error.max(lowest))];
        let shape = Shape::signs(points, Sign::Diamond);
        chart.layers.push(Layer::unnamed(Ink::Cursor, shape));
    }
    chart
}

fn setting_of(numerics: &Numerics) -> (Knob, f64) {
    match (numerics.solver, numerics.edges) {
        (Solver::Stepwise { step }, _) => (Knob::Step, step),
        (Solver::Exact, Edges::Grid) => (Knob::GridSprings, numerics.points as f64),
        (Solver::Exact, Edges::SubCell) => (Knob::SubCellSprings, numerics.points as f64),
    }
}

/// Place of the scene itself: at the row of its setting, or between its neighbours. `None` for an
/// untried setting, and for steps tried on other springs only.
fn present(numerics: &Numerics, table: &CostTable) -> Option<(f64, f64)> {
    let (knob, setting) = setting_of(numerics);
    let mut rows: Vec<(f64, (f64, f64))> = table
        .rows_of(knob)
        .filter(|row| knob != Knob::Step || row.springs == numerics.points)
        .filter_map(|row| {
            table.point(row).map(|(seconds, figure)| (row.setting.ln(), (seconds, figure.error)))
        })
        .collect();
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    let at = setting.ln();
    let above = rows.iter().position(|(setting, _)| *setting >= at)?;
    let (right, there) = &rows[above];
    if *right == at {
        return Some(*there);
    }
    let (left, before) = rows.get(above.checked_sub(1)?)?;
    let share = (at - left) / (right - left);
    let between = |one: f64, other: f64| one * (other / one).powf(share);
    Some((between(before.0, there.0), between(before.1, there.1)))
}

/// Legend: sign of each knob, with its observed order.
fn entries(table: &CostTable, chart: &Chart, width: u16, look: Appearance) -> Vec<Line<'static>> {
    let mut parts = names(chart, look);
    for part in &mut parts {
        let is_of = |knob: &Knob| part.last().is_some_and(|name| name.content.trim_start() == knob.name());
        if let Some(order) = Knob::ALL.iter().find(|knob| is_of(knob)).and_then(|knob| table.order(*knob)) {
            part.push(Text::raw(format!(" order {order:.1}")));
        }
    }
    filled(parts, "  ", usize::from(width))
}

/// Lines below the plot, the most important first.
fn texts(app: &App, table: Option<&CostTable>, area: Size) -> Vec<Line<'static>> {
    let theme = app.view.appearance.theme;
    let mut lines = Vec::new();
    let mut say = |line: Line<'static>| lines.extend(wrapped(&line, area.width));
    if app.is_current() {
        now(app, table).into_iter().for_each(&mut say);
    }
    if let Some(table) = table {
        for bound in TARGETS {
            let percent = format!("{} %", 100.0 * bound);
            if let Some(answer) = answer(table, bound, app.studies.is_done::<Costs>()) {
                let percent = Text::styled(format!("{percent}: "), theme.style(Meaning::Title));
                say(Line::from(vec![percent, Text::raw(answer)]));
            }
        }
    }
    if let Some(Costs { trying: Some(trying), .. }) = app.studies.value() {
        say(Line::styled(format!("trying {trying}…"), theme.style(Meaning::Key)));
    }
    let rows = if area.height >= 12 { 2 } else { 1 };
    lines.extend(stages::strip(app, area.width, rows));
    if let Some(table) = table.filter(|_| area.height >= 24) {
        let from = if table.reference.closed_form {
            "Errors of F_a are counted from its closed form".to_owned()
        } else {
            format!(
                "Errors are counted from {} springs, edges between them",
                grouped(table.reference.springs)
            )
        };
        let steps = table.rows_of(Knob::Step).next().map_or_else(String::new, |row| {
            format!("; of steps, from the exact solver on {} springs", grouped(row.springs))
        });
        let note = format!("{from}{steps}. ○: error below that of the reference.");
        lines.extend(wrapped(&Line::styled(note, theme.style(Meaning::Quiet)), area.width));
    }
    lines
}

/// Error and time of the scene and the time of an error ten times smaller; below, the settings of both.
fn now(app: &App, table: Option<&CostTable>) -> [Line<'static>; 2] {
    let numerics = app.edit.document.scene().numerics;
    let setting = match setting_of(&numerics) {
        (Knob::Step, step) => {
            format!("{} springs, step {}", grouped(numerics.points), format_quantity(step, "m"))
        }
        (knob, _) => springs_of(knob, numerics.points),
    };
    let estimate = app.studies.value::<Estimate>();
    let error = match estimate {
        None if app.studies.failure::<Estimate>().is_some() => "error unknown".to_owned(),
        None if app.view.shows_times => "error …".to_owned(),
        None => String::new(),
        Some(Estimate { near_step: true, .. }) => "near a step of F_a(F_n)".to_owned(),
        Some(estimate) => format!("error {}", per_cent(estimate.error)),
    };
    let time = table.and_then(|table| Some(format!(" in {}", time_of(present(&numerics, table)?.0))));
    let bound = estimate.filter(|estimate| !estimate.near_step).map(|estimate| estimate.error / 10.0);
    let better = table.zip(bound).and_then(|(table, bound)| {
        // The error of whole springs may be small by accident.
        let knob = if numerics.edges == Edges::Grid { Knob::GridSprings } else { Knob::SubCellSprings };
        let timed = table.first_row_within(knob, bound).and_then(|row| Some((row.seconds?.minimum, row)));
        let found = timed.map(|(seconds, row)| {
            let springs = springs_of(row.knob, row.springs);
            (format!("; ten times better in {}", time_of(seconds)), format!("; ten times better: {springs}"))
        });
        found.or_else(|| {
            app.studies
                .is_done::<Costs>()
                .then(|| ("; ten times better: not found".to_owned(), String::new()))
        })
    });
    let (better, springs) = better.unwrap_or_default();
    let sign = Text::styled("◆ ", app.view.appearance.theme.style(Meaning::Cursor));
    let error = Text::raw(format!("{error}{}{better}", time.unwrap_or_default()));
    [Line::from(vec![sign, error]), Line::raw(format!("{setting}{springs}"))]
}

fn time_of(seconds: f64) -> String {
    format_rounded(seconds, 2, "s")
}

fn springs_of(knob: Knob, springs: u64) -> String {
    let springs = grouped(springs);
    if knob == Knob::GridSprings {
        format!("{springs} whole springs")
    } else {
        format!("{springs} springs, edges between")
    }
}

/// Requirements of a bound; `None` while they are unknown.
fn answer(table: &CostTable, bound: f64, finished: bool) -> Option<String> {
    let knobs = [(Knob::SubCellSprings, "edges between springs"), (Knob::GridSprings, "whole springs")];
    let rows = knobs.into_iter().filter_map(|(knob, edges)| {
        let finest = table.rows_of(knob).next_back();
        match table.first_row_within(knob, bound) {
            Some(row) => {
                let time =
                    row.seconds.map_or_else(String::new, |time| format!(", {}", time_of(time.minimum)));
                Some(format!("{edges}: {}{time}", grouped(row.springs)))
            }
            None if finished => {
                finest.map(|finest| format!("{edges}: not up to {}", grouped(finest.springs)))
            }
            None => None,
        }
    });
    let rows: Vec<_> = rows.collect();
    (!rows.is_empty()).then(|| rows.join("; "))
}
