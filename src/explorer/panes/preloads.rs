//! The pane of the pull-off force as a function of the preload. It shows the steps of the pull-off
//! force of the scene's own profile, the scatter over random profiles, and the present preload. It
//! also shows the pull-off forces of loadings that turn at first touch and at zero force.

use super::row::{Exported, PaneRow};
use crate::explorer::app::App;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::wrapped;
use crate::explorer::theme::Meaning;
use asperity_data::AxisScale;
use asperity_plot::{Chart, Ink, Label, Layer, Shape, Sign};
use asperity_report::{PreloadReport, distribution, preload_chart, preload_figure, warning};
use asperity_study::PreloadCurve;
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| {
        let charts = Charts::new(app, app.studies.value()?);
        Some(preload_figure(
            app.edit.document.title(),
            charts.curves,
            charts.distribution,
        ))
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
        "key i: pull-off force against preload: the staircase of this profile, and mean, median, quartiles and range over \
         random profiles; ◇ turned at first touch, ○ at zero force, ◆ the present preload. On the right the share of \
         profiles up to each force",
    )],
    ..PaneRow::EMPTY
};

/// Returns the data of the curves, and the command that computes them as a table.
fn report(app: &App) -> Exported<'_> {
    let curve = app.studies.value::<PreloadCurve>()?;
    let axis = &curve.axis;
    let from = axis.values.first()?;
    let to = axis.values.last()?;
    let scale = if axis.scale() == AxisScale::Logarithmic {
        ":log"
    } else {
        ""
    };
    let profiles = curve.results.plan().lines;
    let profiles = if profiles > 1 {
        format!(" --profiles {profiles}")
    } else {
        String::new()
    };
    let count = axis.count();
    let command =
        format!("asperity run --preloads={from:?}..{to:?}:{count}{scale}{profiles} --draw curves");
    let report = PreloadReport {
        title: app.edit.document.title(),
        choice: None,
        results: &curve.results,
        staircase: Some(&curve.staircase),
        curves: true,
    };
    Some((command.into(), Box::new(report)))
}

/// Smallest height in rows of a pane whose legend states the turning points in words.
const WITH_TURNS: u16 = 14;

fn panel(app: &App, size: Size) -> Panel {
    let name = "Pull-off force";
    let Some(curve) = app.studies.value::<PreloadCurve>() else {
        let failure = app.studies.failure::<PreloadCurve>();
        return Panel::of_text(name.to_owned(), failure.unwrap_or("computing …"));
    };
    let charts = Charts::new(app, curve);
    let mut chart = charts.curves.with_symbols();
    if size.height < WITH_TURNS {
        for layer in &mut chart.layers {
            // The value before the comma is enough, since the symbol states the turning point.
            let name = layer.name.to_string();
            if let Some((value, _)) = name.split_once(", ") {
                layer.name = Label::plain(value);
            }
        }
    }
    let title = format!("{name} {}", chart.y.symbol_with_unit());
    let mut edge = Vec::new();
    let computed = curve.profiles();
    if !curve.is_whole() && computed >= 1 {
        let progress = format!("{computed} of {} profiles", PreloadCurve::PROFILES);
        edge.push(vec![Text::raw(progress)]);
    }
    let warning = warning(&curve.results.spread_of_adhesion()).unwrap_or_default();
    let warning = Line::styled(warning, app.style(Meaning::Key));
    let mut panel = Panel {
        edge,
        foot: wrapped(&warning, size.width),
        ..Panel::of_chart(title, chart)
    };
    if let Body::Chart(plot) = &mut panel.body {
        plot.beside = charts.distribution.map(Chart::with_symbols);
    }
    panel
}

/// The charts of the pane.
struct Charts {
    /// Pull-off force against preload, with a marker at the preload of the scene.
    curves: Chart,
    /// Distribution of the pull-off force over the random profiles, at the preload of the crosshair
    /// or, without crosshair, of the scene; `None` if this preload is unknown.
    distribution: Option<Chart>,
}

impl Charts {
    fn new(app: &App, curve: &PreloadCurve) -> Self {
        let ideal = app.ideal_pull_off_force().filter(|_| app.is_normalised());
        let spread = curve.results.spread_of_adhesion();
        let mut curves = preload_chart(&curve.staircase, &spread, ideal.is_none());
        let figures = app.current().map(|solved| solved.outcome.figures);
        let present = figures.and_then(|figures| figures.preload.zip(figures.pull_off_force));
        if let Some((preload, force)) = present {
            let sign = Shape::signs(vec![(preload, force)], Sign::Diamond);
            let layer = Layer::new("present preload".into(), Ink::Cursor, sign);
            curves.layers.push(layer);
        }
        // The position of the crosshair is a share of the axis. Therefore the crosshair stays in
        // place if the unit of the axis changes.
        let axis = &curves.x;
        let read = match app.view.crosshair {
            Some(share) => {
                let coordinate = axis.span.low + share * axis.span.width();
                Some(axis.scale.number(coordinate))
            }
            None => present.map(|(preload, _)| preload),
        };
        let distribution =
            read.and_then(|preload| distribution(&curve.results, preload, Some(&curves.y)));
        let unit = ideal.map(|ideal| (ideal, "F_a,max"));
        Charts {
            curves: curves.over(unit, unit),
            distribution: distribution.map(|chart| chart.over(None, unit)),
        }
    }
}
