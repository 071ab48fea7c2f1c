//! Adhesion force against preload: the staircase of the scene's profile, the spread over random
//! profiles, adhesion without load, and the preload of the scene.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::wrapped;
use crate::explorer::theme::Meaning;
use asperity_data::AxisScale;
use asperity_plot::{Chart, Ink, Layer, Shape, Sign};
use asperity_report::{PreloadReport, distribution, preload_chart, preload_figure, warning};
use asperity_study::PreloadCurve;
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| {
        let (chart, beside) = charts(app, app.studies.value()?);
        Some(preload_figure(app.edit.document.title(), chart, beside))
    },
    report,
    studies: |app, computed| {
        let begun = app.studies.value::<PreloadCurve>().cloned();
        let computed = Arc::clone(computed);
        let scale = app.view.preloads;
        let key = format!("{} {scale:?}", computed.generation);
        vec![Study::new(key, false, move |simulation, control| {
            let SolvedScene { scene, outcome, .. } = &*computed;
            let control = control.on_threads(1);
            PreloadCurve::of(scene, outcome, scale, begun, simulation, control)
        })]
    },
    help: &[(
        "Preloads",
        "key i: adhesion force against preload: the staircase of this profile, and mean, median, quartiles and range over \
         random profiles; ◇ turned at first touch, ○ at zero force, ◆ the present preload. On the right the share of \
         profiles up to each force",
    )],
};

/// The drawn curves, with the command that computes them as a table.
fn report(app: &App) -> Exported<'_> {
    let curve = app.studies.value::<PreloadCurve>()?;
    let (axis, lines) = (&curve.axis, curve.results.plan().lines);
    let (from, to) = (axis.values.first()?, axis.values.last()?);
    let scale = if axis.scale() == AxisScale::Logarithmic {
        ":log"
    } else {
        ""
    };
    let lines = if lines > 1 {
        format!(" --profiles {lines}")
    } else {
        String::new()
    };
    let command = format!(
        "asperity run --preloads={from:?}..{to:?}:{}{scale}{lines} --curves",
        axis.count()
    );
    let (title, results) = (app.edit.document.title(), &curve.results);
    let report = PreloadReport {
        title,
        choice: None,
        results,
        staircase: Some(&curve.staircase),
        curves: true,
    };
    Some((command.into(), Box::new(report)))
}

fn panel(app: &App, size: Size) -> Panel {
    let name = "Adhesion force";
    let Some(curve) = app.studies.value::<PreloadCurve>() else {
        return Panel::of_text(
            name.to_owned(),
            app.studies
                .failure::<PreloadCurve>()
                .unwrap_or("computing …"),
        );
    };
    let look = app.view.appearance;
    let (chart, beside) = charts(app, curve);
    let chart = chart.with_symbols();
    let title = format!("{name} {}", chart.y.symbol_with_unit());
    let is_begun = !curve.is_whole() && curve.profiles() >= 1;
    let progress = is_begun.then(|| {
        vec![Text::raw(format!(
            "{} of {} profiles",
            curve.profiles(),
            PreloadCurve::PROFILES
        ))]
    });
    let warning = warning(&curve.results.spread_of_adhesion()).unwrap_or_default();
    let foot = wrapped(
        &Line::styled(warning, look.theme.style(Meaning::Key)),
        size.width,
    );
    let edge = progress.into_iter().collect();
    let mut panel = Panel {
        edge,
        foot,
        ..Panel::of_chart(title, chart)
    };
    if let Body::Chart(plot) = &mut panel.body {
        plot.beside = beside.map(Chart::with_symbols);
    }
    panel
}

/// The curves with the preload of the scene, and the distribution over the profiles at the
/// crosshair or at the preload of the scene.
fn charts(app: &App, curve: &PreloadCurve) -> (Chart, Option<Chart>) {
    let ideal = app.ideal_adhesion_force().filter(|_| app.is_normalised());
    let mut chart = preload_chart(
        &curve.staircase,
        &curve.results.spread_of_adhesion(),
        ideal.is_none(),
    );
    let figures = app.current().map(|one| one.outcome.figures);
    let present = figures.and_then(|figures| figures.preload.zip(figures.adhesion_force));
    if let Some((preload, force)) = present {
        let shape = Shape::signs(vec![(preload, force)], Sign::Diamond);
        chart
            .layers
            .push(Layer::new("present preload".into(), Ink::Cursor, shape));
    }
    let x = &chart.x;
    // At the same place whatever the unit.
    let crosshair = app
        .view
        .crosshair
        .map(|share| x.scale.number(x.span.low + share * x.span.width()));
    let read = crosshair.or(present.map(|(preload, _)| preload));
    let beside = read.and_then(|preload| distribution(&curve.results, preload, Some(&chart.y)));
    let unit = ideal.map(|ideal| (ideal, "F_a,max"));
    (
        chart.over(unit, unit),
        beside.map(|beside| beside.over(None, unit)),
    )
}
