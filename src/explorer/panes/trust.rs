//! How far the adhesion force can be trusted: what accuracy costs, as errors over computing times,
//! the errors by their sources, and what other theories say of the same surface.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::{Panel, entries};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled, wrapped};
use crate::explorer::theme::Meaning;
use asperity_data::{format_rounded, grouped, per_cent};
use asperity_plot::{Chart, Ink, Layer, Shape, Sign, Span};
use asperity_report::{CostReport, error_rows, theory_rows, work_precision};
use asperity_scene::Estimate;
use asperity_scene::discretisation::{CostTable, Knob, Progress, measure};
use asperity_study::Ensemble;
use asperity_study::half_space::{Reference, SquareLoops};
use asperity_study::trust::{Budget, MeasuredAdhesion};
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

pub static ROW: PaneRow = PaneRow {
    panel,
    report,
    studies: |_, computed| vec![study(computed)],
    help: &[(
        "Trust",
        "key A: relative error of F_a over the computing time, for both rules of edges and for the stepwise solver. An \
         error is the largest at half, once and twice the load; ◆ is the scene. Below it the errors of F_a by their sources, and what other theories say",
    )],
    ..PaneRow::EMPTY
};

/// Time limit of the whole measurement, equal to the default of `asperity cost`.
const BUDGET: Duration = Duration::from_secs(10);

#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub table: Option<CostTable>,
    pub trying: Option<String>,
}

/// Measures the cost table of a scene. Its times belong together, so an interrupted measurement
/// begins anew.
fn study(computed: &SolvedScene) -> Study {
    let scene = Arc::clone(&computed.scene);
    Study::new(computed.generation, true, move |_, mut control| {
        let mut costs = Costs::default();
        let stop = control.stop();
        let mut report = |progress: Progress<'_>| {
            match progress {
                Progress::Trying(knob, setting) => {
                    costs.trying = Some(format!("{}: {setting}", knob.name()))
                }
                Progress::Rows(table) => costs.table = Some(table.clone()),
            }
            control.report(&costs);
        };
        let table = measure(&scene, Path::new(""), BUDGET, stop, &mut report)?;
        Ok::<_, String>(Costs {
            table: Some(table),
            trying: None,
        })
    })
}

fn report(app: &App) -> Exported<'_> {
    let (document, table) = (
        &app.edit.document,
        app.studies.value::<Costs>()?.table.as_ref()?,
    );
    Some((
        "asperity cost".into(),
        Box::new(CostReport::new(
            document.title(),
            document.scene(),
            table,
            reference(app),
        )),
    ))
}

/// The comparison with three dimensions, if it is computed.
fn reference(app: &App) -> Option<&Reference> {
    app.studies.value::<SquareLoops>()?.reference.as_ref()
}

/// Relative errors that are drawn as lines, and whose requirements are stated.
const TARGETS: [f64; 2] = [0.01, 0.001];

/// Smallest number of rows of the chart.
const LEAST_CHART: usize = 6;

/// Lower end of the error axis; smaller errors are drawn in the lowest row.
const LOWEST: f64 = 1e-8;

fn panel(app: &App, size: Size) -> Panel {
    let theme = app.view.appearance.theme;
    let style = theme.style(Meaning::Error);
    let warnings = app.warnings().into_iter();
    let head: Vec<_> = warnings
        .flat_map(|text| wrapped(&Line::styled(text, style), size.width))
        .collect();
    let room = usize::from(size.height).saturating_sub(head.len());
    let table = app
        .studies
        .value::<Costs>()
        .and_then(|costs| costs.table.as_ref());
    let cost = filled(sentence(app, table), "  ", size.width.into());
    let words = Words {
        cost,
        ..words(app, size.width)
    };
    let chart = table.and_then(|table| {
        let chart = work_precision("", table, reference(app)).charts.pop()?;
        (!chart.layers.is_empty()).then(|| with_scene(chart, app, table))
    });
    let Some(chart) = chart else {
        let title = "Trust: errors of F_a".to_owned();
        let nothing = nothing_yet(app);
        let body = wrapped(&Line::raw(nothing.clone()), size.width).len();
        let foot = words.within(room.saturating_sub(body), app);
        return Panel {
            head,
            foot,
            ..Panel::of_text(title, &nothing)
        };
    };
    let legend = filled(
        entries(&chart, app.view.appearance),
        "  ",
        size.width.into(),
    );
    let beside_chart = room.saturating_sub(LEAST_CHART + legend.len());
    // In a small window other theories are left out before the chart, and the chart before the
    // errors.
    if beside_chart < words.cost.len() + words.errors.len() + 1 && beside_chart < words.count() {
        let title = "Trust: errors of F_a; the chart needs more rows".to_owned();
        return Panel {
            head,
            foot: words.within(room, app),
            ..Panel::of_text(title, "")
        };
    }
    let title = "Trust: relative error over time, log–log".to_owned();
    Panel {
        head,
        foot: words.within(beside_chart, app),
        ..Panel::of_chart(title, chart)
    }
}

/// The words beside the chart, the most important first.
#[derive(Default)]
struct Words {
    /// Error and time of the scene, and what smaller errors cost.
    cost: Vec<Line<'static>>,
    /// Errors of the adhesion force by their sources, the largest of them first.
    errors: Vec<Line<'static>>,
    /// Criteria of other theories.
    theories: Vec<Line<'static>>,
}

impl Words {
    fn count(&self) -> usize {
        self.cost.len() + self.errors.len() + self.theories.len()
    }

    /// The words in at most this number of rows; the last one says what is left out.
    fn within(self, rows: usize, app: &App) -> Vec<Line<'static>> {
        let mut lines: Vec<Line<'static>> = [self.cost, self.errors, self.theories].concat();
        if lines.len() > rows {
            let shown = rows.saturating_sub(1);
            let left_out = lines.len() - shown;
            lines.truncate(shown);
            let way = if app.view.zoomed { "" } else { "z or " };
            let note = format!("… {left_out} more rows: {way}a larger window");
            lines.push(Line::styled(
                note,
                app.view.appearance.theme.style(Meaning::Quiet),
            ));
            lines.truncate(rows);
        }
        lines
    }
}

/// Errors of the adhesion force by their sources, and the criteria of other theories.
fn words(app: &App, width: u16) -> Words {
    let Some(computed) = app.current() else {
        return Words::default();
    };
    let (scene, outcome) = (&computed.scene, &computed.outcome);
    let (estimate, ensemble) = (
        app.studies.value::<Estimate>(),
        app.studies.value::<Ensemble>(),
    );
    let deviation = app
        .studies
        .value::<MeasuredAdhesion>()
        .and_then(MeasuredAdhesion::fit_deviation);
    let budget =
        Budget::of(outcome, estimate, ensemble, deviation).map(|budget| match reference(app) {
            Some(reference) => budget.with_model(reference.budget.model),
            None => budget,
        });
    let mut errors = budget.map_or_else(Vec::new, |budget| {
        error_rows(scene, outcome, estimate, &budget, ensemble, reference(app))
    });
    let first = errors.len().min(1);
    errors.rotate_right(first);
    let theories = theory_rows(scene, outcome, ensemble);
    let names = errors
        .iter()
        .chain(&theories)
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let title = app.view.appearance.theme.style(Meaning::Title);
    let lines = |(name, words): (&str, String)| {
        let words = wrapped(&Line::raw(words), width.saturating_sub(names as u16 + 2));
        let name = |number| {
            if number == 0 {
                name.to_owned()
            } else {
                String::new()
            }
        };
        let line = move |(number, words): (usize, Line<'static>)| {
            let name = Text::styled(format!("{:names$}  ", name(number)), title);
            Line::from_iter([name].into_iter().chain(words.spans))
        };
        words.into_iter().enumerate().map(line).collect::<Vec<_>>()
    };
    Words {
        cost: Vec::new(),
        errors: errors.into_iter().flat_map(lines).collect(),
        theories: theories.into_iter().flat_map(lines).collect(),
    }
}

fn nothing_yet(app: &App) -> String {
    match app.studies.failure::<Costs>() {
        _ if app.is_computing() => "the scene is still being computed…".to_owned(),
        _ if !app.is_current() => "the scene has no curve to estimate an error of".to_owned(),
        Some(why) => format!("nothing is measured: {why}"),
        None if app.studies.is_done::<Costs>() => {
            "nothing to show: no force in this scene whose error depends on springs or steps"
                .to_owned()
        }
        None if !app.view.shows_times => {
            "times are not measured here: they differ from run to run".to_owned()
        }
        None => "measuring: each setting from coarse to fine, as often as 10 s allow…".to_owned(),
    }
}

/// The chart with the target errors and the scene itself, and errors down to the smallest one of
/// interest.
fn with_scene(mut chart: Chart, app: &App, table: &CostTable) -> Chart {
    let Span { low, high } = chart.y.span;
    chart.y.span = Span {
        low: low.max(LOWEST.log10()).min(high - 1.0),
        high,
    };
    let lowest = 10_f64.powf(chart.y.span.low);
    for layer in &mut chart.layers {
        if let Shape::Curve { points, .. } = &mut layer.shape {
            points
                .iter_mut()
                .for_each(|point| point.1 = point.1.max(lowest));
        }
    }
    let targets = TARGETS.map(|target| Layer::unnamed(Ink::Quiet, Shape::Level(target)));
    chart.layers.splice(0..0, targets);
    if let Some((seconds, error)) = table.between_rows(&app.edit.document.scene().numerics) {
        let points = vec![(seconds, error.max(lowest))];
        let shape = Shape::signs(points, Sign::Diamond);
        chart
            .layers
            .push(Layer::new("this scene".into(), Ink::Cursor, shape));
    }
    chart
}

/// Error and time of the scene, springs and time of the fastest setting for each target, and the
/// setting that is tried now.
fn sentence(app: &App, table: Option<&CostTable>) -> Vec<Part> {
    let theme = app.view.appearance.theme;
    let mut parts = Vec::new();
    if app.is_current() {
        let error = match app.studies.value::<Estimate>() {
            None if app.studies.failure::<Estimate>().is_some() => "error unknown".to_owned(),
            None => "error …".to_owned(),
            Some(Estimate {
                near_step: true, ..
            }) => "near a step of F_a(F_n)".to_owned(),
            Some(estimate) => format!("error {}", per_cent(estimate.error)),
        };
        let present =
            table.and_then(|table| table.between_rows(&app.edit.document.scene().numerics));
        let time = present.map_or_else(String::new, |(seconds, _)| {
            format!(" in {}", time_of(seconds))
        });
        let sign = Text::styled("◆ ", theme.style(Meaning::Cursor));
        let over_loads = table.filter(|table| table.is_over_loads(app.edit.document.scene()));
        match present.filter(|_| over_loads.is_some()) {
            Some((_, largest)) => {
                let largest = per_cent(largest);
                parts.push(vec![
                    sign,
                    Text::raw(format!(
                        "{error} at this load, up to {largest} at half to twice the load,{time}"
                    )),
                ]);
            }
            None => parts.push(vec![sign, Text::raw(format!("{error}{time}"))]),
        }
    }
    let answers = table.into_iter().flat_map(|table| {
        TARGETS.map(|target| {
            Some((
                target,
                answer(table, target, app.studies.is_done::<Costs>())?,
            ))
        })
    });
    parts.extend(answers.flatten().map(|(target, answer)| {
        let target = Text::styled(
            format!("{} %: ", 100.0 * target),
            theme.style(Meaning::Title),
        );
        vec![target, Text::raw(answer)]
    }));
    if let Some(Costs {
        trying: Some(trying),
        ..
    }) = app.studies.value()
    {
        parts.push(vec![Text::styled(
            format!("trying {trying}…"),
            theme.style(Meaning::Key),
        )]);
    }
    parts
}

fn time_of(seconds: f64) -> String {
    format_rounded(seconds, 2, "s")
}

/// Springs and time of the fastest setting with an error within a bound; `None` while there is none
/// yet.
fn answer(table: &CostTable, bound: f64, is_finished: bool) -> Option<String> {
    let rows =
        [Knob::SubCellSprings, Knob::GridSprings].map(|knob| table.first_row_within(knob, bound));
    let timed = rows
        .into_iter()
        .flatten()
        .filter_map(|row| Some((row.seconds?.minimum, row)));
    match timed.min_by(|one, other| one.0.total_cmp(&other.0)) {
        Some((seconds, row)) => {
            let whole = if row.knob == Knob::GridSprings {
                "whole "
            } else {
                ""
            };
            Some(format!(
                "{} {whole}springs, {}",
                grouped(row.springs),
                time_of(seconds)
            ))
        }
        None => is_finished.then(|| "not reached".to_owned()),
    }
}
