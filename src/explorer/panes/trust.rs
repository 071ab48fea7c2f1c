//! The pane that shows the accuracy of the pull-off force. The first part is the cost of accuracy:
//! the error as a function of the computing time. The second part has the errors from each source.
//! The third part has the verdicts of other theories on the adhesion of the same surface.

use super::row::{Exported, PaneRow};
use crate::explorer::advice;
use crate::explorer::app::App;
use crate::explorer::measured::fitted;
use crate::explorer::panel::{Panel, entries};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::{Part, filled, wrapped};
use crate::explorer::theme::Meaning;
use asperity_data::{counted, format_rounded, per_cent};
use asperity_experiment::Grade;
use asperity_plot::{Chart, Figure, Ink, Layer, Shape, Sign, Span};
use asperity_report::{CostReport, error_rows, theory_rows, work_precision};
use asperity_scene::Estimate;
use asperity_scene::discretisation::{CostTable, Knob, Progress, Row as CostRow, measure};
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
    figure: |app, _| Some(Figure::of_chart(app.edit.document.title(), chart(app)?)),
    report,
    studies: |_, computed| vec![study(computed)],
    help: &[(
        "Trust",
        "key A: relative error of F_a over the computing time, for both rules of edges and for the stepwise solver. An \
         error is the largest at half, once and twice the load; ◆ is the scene. PageDown: the next page in a \
         small window. Below the chart the errors of F_a by their sources, and what other theories say",
    )],
};

/// Time limit of the whole measurement of errors and times. It is equal to the default of
/// `asperity cost`.
const BUDGET: Duration = Duration::from_secs(10);

#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub table: Option<CostTable>,
    pub trying: Option<String>,
}

/// Returns the study (background computation) that measures the errors and computing times of a
/// scene. Times are comparable only within one measurement, so an interrupted measurement starts
/// again from the beginning.
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
    let document = &app.edit.document;
    let table = app.studies.value::<Costs>()?.table.as_ref()?;
    let report = CostReport::new(document.title(), document.scene(), table, reference(app));
    Some(("asperity cost".into(), Box::new(report)))
}

/// Returns the comparison with the contact of square surfaces on an elastic half-space, if it is
/// computed.
fn reference(app: &App) -> Option<&Reference> {
    app.studies.value::<SquareLoops>()?.reference.as_ref()
}

/// Relative errors that the chart marks by horizontal lines. A text states the number of springs
/// and the time that each of them needs.
const TARGETS: [f64; 2] = [0.01, 0.001];

/// Smallest height of the chart in rows.
const LEAST_CHART: usize = 6;

/// Lower end of the axis of relative errors. Smaller errors are drawn in the lowest row.
const LOWEST: f64 = 1e-8;

fn panel(app: &App, size: Size) -> Panel {
    let mut pages = pages(app, size);
    let page = app.view.page.min(pages.len() - 1);
    pages.swap_remove(page)
}

/// Returns the number of pages of the pane in an area of this size.
pub fn count_pages(app: &App, size: Size) -> usize {
    pages(app, size).len()
}

/// Returns the pages of the pane, through which PageDown and PageUp go. There is one page if the
/// texts and the chart fit below each other. Otherwise the chart has the last page. There is at
/// least one page.
fn pages(app: &App, size: Size) -> Vec<Panel> {
    let words = words(app, size.width);
    let mut warnings = Vec::new();
    for warning in app.warnings() {
        let line = Line::styled(warning, app.style(Meaning::Error));
        warnings.extend(wrapped(&line, size.width));
    }
    let Some(chart) = chart(app) else {
        let nothing = Line::styled(nothing_yet(app), app.style(Meaning::Quiet));
        let nothing = wrapped(&nothing, size.width);
        let texts = [warnings, nothing, words.all()].concat();
        return numbered(pages_of_text(texts, size.height));
    };
    let entries = entries(&chart, app.view.appearance);
    let legend = filled(entries, "  ", size.width.into()).len();
    let needed = warnings.len() + words.count() + legend + LEAST_CHART;
    let title = "Trust: relative error over time, log–log".to_owned();
    if needed <= size.height.into() {
        return vec![Panel {
            head: warnings,
            foot: words.all(),
            ..Panel::of_chart(title, chart)
        }];
    }
    let texts = [warnings, words.errors, words.theories].concat();
    let mut pages = pages_of_text(texts, size.height);
    // Below the chart are the texts that state what its curves mean for the scene.
    let room = usize::from(size.height).saturating_sub(legend + LEAST_CHART);
    let mut foot = words.cost;
    foot.truncate(room);
    pages.push(Panel {
        foot,
        ..Panel::of_chart(title, chart)
    });
    numbered(pages)
}

/// Returns lines of text as pages of this height.
fn pages_of_text(lines: Vec<Line<'static>>, rows: u16) -> Vec<Panel> {
    let mut pages = Vec::new();
    for lines in lines.chunks(usize::from(rows).max(1)) {
        pages.push(Panel {
            head: lines.to_vec(),
            ..Panel::of_text("Trust: errors of F_a".to_owned(), "")
        });
    }
    pages
}

/// Adds to the title of each page its number and the key for the next page, if there are several
/// pages.
fn numbered(mut pages: Vec<Panel>) -> Vec<Panel> {
    let count = pages.len();
    if count > 1 {
        for (number, page) in (1..).zip(&mut pages) {
            page.title = format!("{} · {number}/{count} PageDown", page.title);
        }
    }
    pages
}

/// Returns the measured errors and times; `None` before the first ones are measured.
fn cost_table(app: &App) -> Option<&CostTable> {
    app.studies.value::<Costs>()?.table.as_ref()
}

/// Returns the chart of errors over computing times; `None` before the chart has a curve.
fn chart(app: &App) -> Option<Chart> {
    let table = cost_table(app)?;
    let chart = work_precision("", table, reference(app)).charts.pop()?;
    if chart.layers.is_empty() {
        return None;
    }
    Some(with_scene(chart, app, table))
}

/// Texts below the chart, in the order of their importance.
#[derive(Default)]
struct Words {
    /// Error and computing time of the scene, and the computing time for smaller errors.
    cost: Vec<Line<'static>>,
    /// Errors of the pull-off force from each source, the largest first.
    errors: Vec<Line<'static>>,
    /// Criteria of other theories.
    theories: Vec<Line<'static>>,
}

impl Words {
    fn count(&self) -> usize {
        self.cost.len() + self.errors.len() + self.theories.len()
    }

    fn all(self) -> Vec<Line<'static>> {
        [self.cost, self.errors, self.theories].concat()
    }
}

/// Returns the texts on cost, errors and other theories, in lines of this width.
fn words(app: &App, width: u16) -> Words {
    let cost = filled(sentence(app), "  ", width.into());
    let Some(computed) = app.current() else {
        return Words {
            cost,
            ..Words::default()
        };
    };
    let ensemble = app.studies.value::<Ensemble>();
    let mut errors = errors(app, computed, ensemble);
    // `errors` ends with the largest error, which is moved to the first row.
    let first = errors.len().min(1);
    errors.rotate_right(first);
    let theories = theory_rows(&computed.scene, &computed.outcome, ensemble);
    let names = errors.iter().chain(&theories).map(|(name, _)| *name);
    let name_width = names.map(|name| name.chars().count()).max().unwrap_or(0);
    Words {
        cost,
        errors: lines_of_rows(app, &errors, name_width, width),
        theories: lines_of_rows(app, &theories, name_width, width),
    }
}

/// Returns the errors of the pull-off force, each as the name of its source and a text. The error
/// of the sample follows from `ensemble`.
pub(super) fn errors(
    app: &App,
    computed: &SolvedScene,
    ensemble: Option<&Ensemble>,
) -> Vec<(&'static str, String)> {
    let outcome = &computed.outcome;
    let estimate = app.studies.value::<Estimate>();
    let measured = app.studies.value::<MeasuredAdhesion>();
    let deviation = measured.and_then(MeasuredAdhesion::fit_deviation);
    let Some(mut budget) = Budget::of(outcome, estimate, ensemble, deviation) else {
        return Vec::new();
    };
    let reference = reference(app);
    if let Some(reference) = reference {
        budget = budget.with_model(reference.budget.model);
    }
    let mut rows = error_rows(
        &computed.scene,
        outcome,
        estimate,
        &budget,
        ensemble,
        reference,
        advice::row,
    );
    if let Some(misfit) = refuted(app)
        && let Some((_, model)) = rows.iter_mut().find(|(name, _)| *name == "model")
    {
        *model = format!("not known: the scene does not describe the measured curve, {misfit}");
    }
    rows
}

/// Returns the misfit of the scene to the measured curve in words, if it is so large that the model
/// does not describe the curve; otherwise `None`.
fn refuted(app: &App) -> Option<String> {
    let fit = fitted(&app.studies)?;
    app.edit.measured.as_ref()?;
    match fit.grade {
        Grade::No => Some(format!("misfit {}", format_rounded(fit.misfit, 3, "1"))),
        _ => None,
    }
}

/// Returns rows of names and texts as lines of this width. The names have a column of their own,
/// and all lines of a text are on its right.
fn lines_of_rows(
    app: &App,
    rows: &[(&str, String)],
    name_width: usize,
    width: u16,
) -> Vec<Line<'static>> {
    let title = app.style(Meaning::Title);
    let room = width.saturating_sub(name_width as u16 + 2);
    let mut lines = Vec::new();
    for (name, words) in rows {
        let words = wrapped(&Line::raw(words.as_str()), room);
        for (number, text) in words.into_iter().enumerate() {
            let name_beside = if number == 0 { *name } else { "" };
            let name_beside = format!("{name_beside:name_width$}  ");
            let mut line = Line::from(Text::styled(name_beside, title));
            line.spans.extend(text.spans);
            lines.push(line);
        }
    }
    lines
}

/// Returns the text that is shown until there is a chart.
fn nothing_yet(app: &App) -> String {
    let text = if app.is_computing() {
        "the scene is still being computed…"
    } else if !app.is_current() {
        "the scene has no curve to estimate an error of"
    } else if let Some(why) = app.studies.failure::<Costs>() {
        return format!("nothing is measured: {why}");
    } else if app.studies.is_done::<Costs>() {
        "nothing to show: no force in this scene whose error depends on springs or steps"
    } else if !app.view.shows_times {
        "times are not measured here: they differ from run to run"
    } else {
        "measuring: each setting from coarse to fine, as often as 10 s allow…"
    };
    text.to_owned()
}

/// Adds the target errors and the marker of the scene to the chart, and limits its vertical axis to
/// errors above [`LOWEST`].
fn with_scene(mut chart: Chart, app: &App, table: &CostTable) -> Chart {
    let Span { low, high } = chart.y.span;
    chart.y.span = Span {
        low: low.max(LOWEST.log10()).min(high - 1.0),
        high,
    };
    let lowest = 10_f64.powf(chart.y.span.low);
    for layer in &mut chart.layers {
        if let Shape::Curve { points, .. } = &mut layer.shape {
            for point in points {
                point.1 = point.1.max(lowest);
            }
        }
    }
    let targets = TARGETS.map(|target| Layer::unnamed(Ink::Quiet, Shape::Level(target)));
    chart.layers.splice(0..0, targets);
    if let Some((seconds, error)) = table.between_rows(&app.edit.document.scene().numerics) {
        let points = vec![(seconds, error.max(lowest))];
        let shape = Shape::signs(points, Sign::Diamond);
        let layer = Layer::new("this scene".into(), Ink::Cursor, shape);
        chart.layers.push(layer);
    }
    chart
}

/// Returns the texts on cost: error and computing time of the scene; for each target, number of
/// springs and time of the fastest setting; and the setting that is being measured.
fn sentence(app: &App) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    if app.is_current() {
        for text in present_in_words(app) {
            parts.push(vec![Text::raw(text)]);
        }
        parts[0].insert(0, Text::styled("◆ ", app.style(Meaning::Cursor)));
    }
    if let Some(table) = cost_table(app) {
        let is_finished = app.studies.is_done::<Costs>();
        for target in TARGETS {
            if let Some(answer) = answer(table, target, is_finished) {
                let heading = format!("{} %: ", 100.0 * target);
                let heading = Text::styled(heading, app.style(Meaning::Title));
                parts.push(vec![heading, Text::raw(answer)]);
            }
        }
    }
    if let Some(Costs {
        trying: Some(trying),
        ..
    }) = app.studies.value()
    {
        let text = format!("trying {trying}…");
        parts.push(vec![Text::styled(text, app.style(Meaning::Key))]);
    }
    parts
}

/// Returns the error and the computing time of the scene, and its largest error at other loads. The
/// texts are short, because a text that does not fit into the width of the pane is left out.
fn present_in_words(app: &App) -> Vec<String> {
    let error = match app.studies.value::<Estimate>() {
        None if app.studies.failure::<Estimate>().is_some() => "error unknown".to_owned(),
        None => "error …".to_owned(),
        Some(Estimate {
            near_step: true, ..
        }) => "near a step of F_a(F_n)".to_owned(),
        Some(estimate) => format!("± {}", per_cent(estimate.error)),
    };
    let scene = app.edit.document.scene();
    let Some(table) = cost_table(app) else {
        return vec![error];
    };
    let Some((seconds, largest)) = table.between_rows(&scene.numerics) else {
        return vec![error];
    };
    let time = time_of(seconds);
    if !table.is_over_loads(scene) {
        return vec![format!("{error} in {time}")];
    }
    vec![
        format!("{error} at this load in {time}"),
        // A measured error may be smaller than the estimate, which is a bound.
        format!("measured: up to {} at half to twice", per_cent(largest)),
    ]
}

fn time_of(seconds: f64) -> String {
    format_rounded(seconds, 2, "s")
}

/// Returns the number of springs and the time of the fastest setting with a relative error of at
/// most `bound`; `None` if there is no such setting yet.
fn answer(table: &CostTable, bound: f64, is_finished: bool) -> Option<String> {
    let mut fastest: Option<(f64, &CostRow)> = None;
    for knob in [Knob::SubCellSprings, Knob::GridSprings] {
        let Some(row) = table.first_row_within(knob, bound) else {
            continue;
        };
        let Some(seconds) = &row.seconds else {
            continue;
        };
        let seconds = seconds.minimum;
        // Of two settings with the same time, the first one is shown.
        if fastest.is_none_or(|(least, _)| seconds.total_cmp(&least).is_lt()) {
            fastest = Some((seconds, row));
        }
    }
    let Some((seconds, row)) = fastest else {
        return is_finished.then(|| "not reached".to_owned());
    };
    let whole = if row.knob == Knob::GridSprings {
        "whole "
    } else {
        ""
    };
    let springs = counted(row.springs, &format!("{whole}spring"));
    Some(format!("{springs}, {}", time_of(seconds)))
}
