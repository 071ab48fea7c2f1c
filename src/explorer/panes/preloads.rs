//! Adhesion against preload: the curve of the profile, the mean over random profiles with its confidence, and the
//! preload of the scene.

use super::{Exported, PROFILES, PaneRow, PreloadCurve};
use crate::draw::{Axis, AxisScale, Chart, Ink, Layer, Shape, Sign};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::{Panel, names};
use crate::explorer::studies::Study;
use crate::explorer::theme::Meaning;
use crate::explorer::view::text::filled;
use crate::export::{PreloadReport, preload_axes, preload_layers};
use crate::study::Results;
use ratatui::layout::Size;
use ratatui::text::Span as Text;
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel,
    report,
    keys: Some(Context::Crosshair),
    studies: |app, computed| {
        let (begun, computed) = (app.studies.value::<PreloadCurve>().cloned(), Arc::clone(computed));
        vec![Study::new(computed.generation, false, move |simulation, stop, report| {
            let mut curve = begun.map_or_else(|| PreloadCurve::new(&computed), Ok)?;
            let done = curve.compute(simulation, stop, &mut |curve| report(curve.clone()));
            done.map(|()| curve).map_err(|error| error.to_string())
        })]
    },
    help: &[(
        "Preloads",
        "i: adhesion force over preload, of this profile and the mean of random profiles with its 95 % confidence; the \
         line and ◆ are the present preload",
    )],
    ..PaneRow::EMPTY
};

fn report(app: &App) -> Exported<'_> {
    let curve = app.studies.value::<PreloadCurve>()?;
    // The mean once all random profiles are computed, until then the profile of the scene.
    let whole = |results: &&Results| results.is_whole(0);
    let results = curve.random.as_ref().filter(whole).or(Some(&curve.own).filter(whole))?;
    let report = PreloadReport { title: app.edit.document.title(), choice: None, results };
    Some(("asperity run", Box::new(report)))
}

fn panel(app: &App, size: Size) -> Panel {
    let title = "Adhesion against preload".to_owned();
    let Some(curve) = app.studies.value::<PreloadCurve>() else {
        return Panel::of_text(title, app.studies.failure::<PreloadCurve>().unwrap_or("computing …"));
    };
    let chart = chart(app, curve);
    let mut parts = names(&chart, app.view.appearance);
    if !curve.is_whole() && curve.profiles() >= 2 {
        let progress = format!("{} of {} profiles", curve.profiles(), PROFILES);
        parts.insert(1, vec![Text::styled(progress, app.view.appearance.theme.style(Meaning::Title))]);
    }
    Panel { head: filled(parts, "  ", size.width.into()), ..Panel::of_chart(title, chart) }
}

fn chart(app: &App, curve: &PreloadCurve) -> Chart {
    let means = curve.random.as_ref().map_or_else(Vec::new, Results::mean_adhesion_forces);
    let mut layers = preload_layers(&curve.own.adhesion_forces(0), &means);
    let figures = app.current().map(|one| one.outcome.figures);
    let present = figures.and_then(|figures| figures.preload.zip(figures.adhesion_force));
    if let Some((preload, force)) = present {
        layers.push(Layer::unnamed(Ink::Cursor, Shape::Upright(preload)));
        let shape = Shape::signs(vec![(preload, force)], Sign::Diamond);
        layers.push(Layer::new("present preload".into(), Ink::Cursor, shape));
    }
    let chart = preload_axes(layers);
    // The title of the pane has the names of both axes.
    let axis = |axis: &Axis, symbol| Axis::new(AxisScale::Linear, axis.span, "", symbol, "N");
    let (x, y) = (axis(&chart.x, "F_n"), axis(&chart.y, "F_a"));
    Chart { x, y, ..chart }
}
