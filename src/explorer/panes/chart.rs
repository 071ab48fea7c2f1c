//! The map in its pane: shades in the colours of the regimes, the mark of the scene, and the [words] of the map.

use super::{PaneRow, chart_words as words, sections};
use crate::draw::{CellPlot, Chart, Figure, Label};
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::model::Model;
use crate::explorer::study::{PaneData, Task};
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::update::{self, Effect, scene_of};
use crate::explorer::view::lines::{draw_around, draw_reason};
use crate::explorer::view::plot;
use crate::export::study_figure;
use crate::study::map::{Charted, MapModel, Place};
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title: words::title,
    draw,
    figure: |model| model.chart.map_model().map(|map_model| figure(model, map_model)),
    keys: Some(ModeKind::Chart),
    press: |model, area, here| {
        model.chart.moving = false;
        put(model, area, here)
    },
    drag: |model, area, here| if model.chart.moving { put(model, area, here) } else { Vec::new() },
    task: |model, computed| {
        let map = model.chart.wanted(&computed.scene).ok().flatten();
        let is_live = model.chart.shown_study().is_none();
        map.filter(|_| is_live).map(|map| Task::Extend { data: PaneData::Map(map), waits: model.edited })
    },
    take_in: |model, data| {
        if let PaneData::Map(map) = data {
            model.chart.take_in(map);
        }
    },
    renew: |model| model.chart.renew(&scene_of(&model.document)),
    help: &[
        (
            "Map",
            "m: regime under other H and κ (e: e_el/γ), of most of a few random profiles with few springs; █ adhesion at first \
             touch, ▒ after pressing, · hardly any, blank: not computed; ◆ is the scene, moved by the arrows",
        ),
        (
            "Study",
            "map of a merged study, opened by the path of its folder: means over its profiles, ▓ ░ where profiles \
             differ in their regimes; ◆ moves from cell to cell, P selects the next preload, W switches between the \
             study and the live map",
        ),
    ],
    ..PaneRow::EMPTY
};

/// Fewest rows of a useful map.
const FEWEST_ROWS: u16 = 4;

/// Chart of the regime or a quantity of a map over two axes.
pub(super) fn chart(map_model: &MapModel, charted: Charted) -> Option<Chart> {
    let mut figure = map_model.figure(&[charted], true);
    if charted == Charted::Regime {
        // The shades show the regimes.
        figure.boundary = None;
    }
    let mut chart = study_figure(&figure).charts.pop()?;
    if let (Charted::Regime, Some(map)) = (charted, chart.map_mut()) {
        map.class_names.iter_mut().for_each(|class| class.letter = None);
    }
    Some(chart)
}

/// Figure of the pane: the map, with the quantities behind the regimes while these are mapped, or the sections.
fn figure(model: &Model, map_model: &MapModel) -> Figure {
    let mut figure = if model.chart.sections || map_model.up().is_none() {
        Figure {
            title: String::new(),
            notes: Vec::new(),
            charts: sections::charts(model),
            size: Figure::SMALL,
        }
    } else {
        let layers = words::shown_layers(model.chart.charted(), map_model);
        let mut charted: Vec<_> = layers.into_iter().map(|layer| Charted::Quantity(layer.quantity)).collect();
        if charted.is_empty() {
            charted.push(Charted::Regime);
        }
        study_figure(&map_model.figure(&charted, false))
    };
    let study = model.chart.shown_study();
    let title = study.map_or(&model.document.scene().title, |study| &study.study_map.plan().title);
    figure.title.clone_from(title);
    let fixed = study.map_or_else(Vec::new, |study| study.study_map.fixed_values(study.slice));
    let fixed = fixed.iter().map(|fixed| Label::statement(fixed));
    figure.notes = fixed.reduce(|line, fixed| line.then(", ").join(&fixed)).into_iter().collect();
    figure
}

/// The parts of the pane.
struct Parts {
    chart: Chart,
    legend: Vec<Line<'static>>,
    plot: CellPlot,
    below: Vec<Line<'static>>,
}

fn parts(model: &Model, map_model: &MapModel, area: Rect) -> Option<Parts> {
    let chart = chart(map_model, model.chart.charted())?;
    let mut legend = words::legend(model, &chart, area.width);
    let mut below = words::below(model, area);
    // The map comes first, then the values at the mark, then the legend.
    let room = usize::from(area.height.saturating_sub(FEWEST_ROWS + 1));
    below.truncate(room.min(usize::from(area.height / 3)));
    legend.truncate(room - below.len());
    let (above, rows) = (legend.len() as u16, (legend.len() + below.len()) as u16);
    let middle = Rect { y: area.y + above, height: area.height.saturating_sub(rows), ..area };
    Some(Parts { plot: CellPlot::within(middle, &chart), chart, legend, below })
}

/// Puts the mark under the mouse.
fn put(model: &mut Model, area: Rect, here: Position) -> Vec<Effect> {
    match place_at(model, area, here) {
        Some(place) => update::chart::move_to(model, place),
        None => vec![Effect::Ask],
    }
}

/// Place on the map under a place on the screen.
fn place_at(model: &Model, area: Rect, here: Position) -> Option<Place> {
    let map_model = model.chart.map_model().filter(|_| !model.chart.sections)?;
    map_model.up()?;
    let Parts { chart, plot, .. } = parts(model, map_model, area)?;
    let (across, up) = plot.values_at(chart.map()?, here.into())?;
    Some((across, Some(up)))
}

/// Draws legend, map, and the values at the mark, as far as there is room.
fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let area = inside(area);
    let theme = model.appearance.theme;
    let Some(map_model) = model.chart.map_model() else {
        return draw_reason(frame, area, &words::nothing_yet(model), theme);
    };
    if model.chart.sections || map_model.up().is_none() {
        let below = words::below(model, area);
        let plots = draw_around(frame, area, (Vec::new(), below), FEWEST_ROWS);
        return sections::draw(frame, plots, model);
    }
    let Some(Parts { chart, legend, plot, below }) = parts(model, map_model, area) else { return };
    draw_around(frame, area, (legend, below), 0);
    plot::in_theme(model.appearance, |style| plot.draw(frame.buffer_mut(), &chart, style));
    if let Some((across, Some(up))) = model.place() {
        let marker = model.appearance.marker.symbols();
        if let Some(cell) = plot.cell(&chart, marker, (across, up)) {
            mark(frame, area, plot.plot, cell, theme);
        }
    }
}

/// Draws the mark of the scene, with a pointer on each axis that has a line.
fn mark(frame: &mut Frame<'_>, area: Rect, plot: Rect, (x, y): (u16, u16), theme: Theme) {
    let below = frame.buffer_mut().cell((x, plot.bottom()));
    let has_line = below.is_some_and(|cell| ["─", "┬"].contains(&cell.symbol()));
    let mut put = |x: u16, y: u16, text: &'static str| {
        let place = Rect { x, y, width: text.chars().count() as u16, height: 1 };
        let text = Text::styled(text, theme.style(Meaning::Cursor));
        frame.render_widget(Paragraph::new(text), place.intersection(area));
    };
    // Blanks on both sides, so that the mark is visible without colours.
    if x > plot.x {
        put(x - 1, y, " ");
    }
    if x + 1 < plot.right() {
        put(x + 1, y, " ");
    }
    put(x, y, "◆");
    // Without a line of the axis, names and numbers of the scale take this row.
    if has_line {
        put(x, plot.bottom(), "▲");
    }
    if plot.x > area.x {
        put(plot.x - 1, y, "▶");
    }
}
