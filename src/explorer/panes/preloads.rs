//! Adhesion against preload: the curve of the profile, the mean over random profiles with its confidence, and the
//! preload of the scene.

use super::{Pane, PaneRow, PreloadCurve};
use crate::draw::{Axis, AxisScale, Chart, Ink, Layer, Shape, Sign};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::{Panel, names};
use crate::explorer::study::{PaneData, Task};
use crate::explorer::theme::Meaning;
use crate::explorer::view::text::filled;
use crate::export::{preload_axes, preload_layers};
use ratatui::layout::Size;
use ratatui::text::Span as Text;
use std::sync::Arc;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    panel,
    keys: Some(Context::Crosshair),
    task: |app, computed| {
        let begun = app.studies.preloads.clone();
        let curve = begun.or_else(|| PreloadCurve::new(computed).ok().map(Arc::new));
        let curve = curve.filter(|one| !one.is_whole());
        curve.map(|curve| Task::Extend { data: PaneData::Preloads(curve), waits: app.studies.edited })
    },
    take_in: |app, data| {
        if let PaneData::Preloads(curve) = data {
            app.studies.preloads = Some(curve);
        }
    },
    renew: |app| app.studies.preloads = None,
    help: &[(
        "Preloads",
        "i: adhesion force over preload, of this profile and the mean of random profiles with its 95 % confidence; the \
         line and ◆ are the present preload",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, size: Size) -> Panel {
    let title = "Adhesion against preload".to_owned();
    let Some(curve) = app.studies.preloads.as_deref().filter(|curve| !curve.own.is_empty()) else {
        let why = match (app.studies.failures.get(&Pane::Preloads), app.current()) {
            (Some(why), _) => why.clone(),
            (None, Some(computed)) => {
                PreloadCurve::new(computed).map_or_else(str::to_owned, |_| "computing …".to_owned())
            }
            (None, None) => "computing …".to_owned(),
        };
        return Panel::of_text(title, &why);
    };
    let chart = chart(app, curve);
    let mut parts = names(&chart, app.view.appearance);
    if !curve.is_whole() && curve.profiles() >= 2 {
        let progress = format!("{} of {} profiles", curve.profiles(), curve.wanted);
        parts.insert(1, vec![Text::styled(progress, app.view.appearance.theme.style(Meaning::Title))]);
    }
    Panel { head: filled(parts, "  ", size.width.into()), ..Panel::of_chart(title, chart) }
}

fn chart(app: &App, curve: &PreloadCurve) -> Chart {
    // The statistics have fewer preloads than the curve of the profile.
    let mut layers = preload_layers(curve.coarse(), &curve.statistics);
    if let Some(own) = preload_layers(&curve.own, &[]).pop() {
        layers.pop();
        layers.push(own);
    }
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
