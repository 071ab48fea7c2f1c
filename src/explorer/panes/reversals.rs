//! First-order reversal curves of the loading: the Everett function, and the density, over indentation and turning point.

use super::{Exported, PaneRow};
use crate::analysis::ReversalMap;
use crate::draw::Chart;
use crate::explorer::app::App;
use crate::explorer::panel::{Panel, shades};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::theme::Meaning;
use crate::explorer::view::text::{filled, wrapped};
use crate::export::{ReversalReport, everett_chart};
use crate::scene::format_rounded;
use ratatui::layout::Size;
use ratatui::text::Line;
use std::sync::Arc;

const TURNS: usize = 64;

pub static EVERETT: PaneRow = PaneRow {
    panel: |app, size| panel(app, size, "Everett function E", everett_chart),
    report,
    studies,
    help: &[(
        "Everett",
        "O: Everett function E = ½ (F(d_r) − F) of first-order reversal curves over the indentation d and the turning point \
         d_r",
    )],
    ..PaneRow::EMPTY
};

fn studies(_: &App, computed: &Arc<SolvedScene>) -> Vec<Study> {
    let scene = Arc::clone(&computed.scene);
    vec![Study::new(computed.generation, false, move |simulation, stop, _: &mut dyn FnMut(ReversalMap)| {
        simulation.reversal_map(&scene, None, TURNS, stop).map_err(|error| error.to_string())
    })]
}

fn report(app: &App) -> Exported<'_> {
    let (document, map) = (&app.edit.document, app.studies.value::<ReversalMap>()?);
    let report = ReversalReport {
        title: document.title(),
        scene: document.scene(),
        map,
        preloads: None,
        staircase: None,
        map_table: true,
    };
    Some(("asperity reversals --map".into(), Box::new(report)))
}

fn panel(app: &App, size: Size, title: &str, chart: impl Fn(&ReversalMap) -> Chart) -> Panel {
    let title = title.to_owned();
    let Some(map) = app.studies.value::<ReversalMap>() else {
        return Panel::of_text(title, app.studies.failure::<ReversalMap>().unwrap_or("computing …"));
    };
    let chart = chart(map).with_symbols();
    let head = filled(shades(&chart, app.view.appearance, size.width.into()), "  ", size.width.into());
    let step = format_rounded(map.step(), 3, "m");
    let facts = format!("{} turning points d_r with a step of {step}", map.reversals.len());
    let foot = wrapped(&Line::styled(facts, app.view.appearance.theme.style(Meaning::Quiet)), size.width);
    Panel { head, foot, ..Panel::of_chart(title, chart) }
}
