//! The map in its pane: shades in the colours of the regimes, the mark of the scene, and the [words] of the map.

use super::curves::draw_chart;
use super::{PaneRow, chart_words as words};
use crate::draw::{CellPlot, Chart, Figure, Ink, Layer, Shape, Sign};
use crate::explorer::app::App;
use crate::explorer::chart;
use crate::explorer::layout::inside;
use crate::explorer::mode::ModeKind;
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::update::{self, Effect};
use crate::explorer::view::lines::{draw_around, draw_reason};
use crate::explorer::view::plot;
use crate::export::{study_curves, study_figure, study_map};
use crate::study::{Grid, Place, Quantity};
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title: words::title,
    draw,
    figure: |app| app.grid().map(|grid| figure(app, grid)),
    keys: Some(ModeKind::Chart),
    press: |app, area, here| {
        app.chart.moving = false;
        put(app, area, here)
    },
    drag: |app, area, here| if app.chart.moving { put(app, area, here) } else { Vec::new() },
    studies: |app, computed| match app.chart.shown_study() {
        Some(_) => Vec::new(),
        None => chart::study(app, computed).into_iter().collect(),
    },
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

/// Fewest rows of a useful map, and of curves with their legend.
const FEWEST_ROWS: u16 = 4;
const FEWEST_ROWS_OF_CURVES: u16 = 6;

/// Chart of the regime or a quantity of a map over two axes.
fn chart(grid: &Grid, charted: Quantity) -> Option<Chart> {
    let mut chart = study_map(grid, charted, true)?;
    if let (Quantity::Regime, Some(map)) = (charted, chart.map_mut()) {
        // The shades show the regimes.
        map.contour = None;
        map.class_names.iter_mut().for_each(|class| class.letter = None);
    }
    Some(chart)
}

/// Curves over the only axis of a map, with the mark of the scene.
fn curves(app: &App, grid: &Grid) -> Vec<Chart> {
    let quantities = words::shown_quantities(app.charted(), grid);
    let curves = quantities.into_iter().filter(|quantity| *quantity != Quantity::Regime);
    let mark = app.place().map(|(across, _)| across);
    let chart = |quantity| {
        let mut chart = Chart { inset: None, ..study_curves(grid, quantity) };
        if let Some(mark) = mark {
            let top = chart.y.scale.number(chart.y.span.high);
            chart.layers.push(Layer::unnamed(Ink::Cursor, Shape::Upright(mark)));
            chart.layers.push(Layer::unnamed(Ink::Cursor, Shape::signs(vec![(mark, top)], Sign::Diamond)));
        }
        chart
    };
    curves.map(chart).collect()
}

/// Figure of the pane: the map, with the quantities behind the regimes while these are mapped, or curves over the only
/// axis.
fn figure(app: &App, grid: &Grid) -> Figure {
    let charts = match grid.up {
        None => curves(app, grid),
        Some(_) => {
            let shown = words::shown_quantities(app.charted(), grid).into_iter();
            shown.filter_map(|quantity| study_map(grid, quantity, false)).collect()
        }
    };
    let study = app.chart.shown_study();
    let title = study.map_or(&app.edit.document.scene().title, |study| &study.study_map.plan().title);
    let fixed = study.map_or_else(Vec::new, |study| study.study_map.fixed_values(study.slice));
    study_figure(title, &fixed, charts)
}

/// The parts of the pane.
struct Parts {
    chart: Chart,
    legend: Vec<Line<'static>>,
    plot: CellPlot,
    below: Vec<Line<'static>>,
}

fn parts(app: &App, grid: &Grid, area: Rect) -> Option<Parts> {
    let chart = chart(grid, app.charted())?;
    let mut legend = words::legend(app, &chart, area.width);
    let mut below = words::below(app, area);
    // The map comes first, then the values at the mark, then the legend.
    let room = usize::from(area.height.saturating_sub(FEWEST_ROWS + 1));
    below.truncate(room.min(usize::from(area.height / 3)));
    legend.truncate(room - below.len());
    let (above, rows) = (legend.len() as u16, (legend.len() + below.len()) as u16);
    let middle = Rect { y: area.y + above, height: area.height.saturating_sub(rows), ..area };
    Some(Parts { plot: CellPlot::within(middle, &chart), chart, legend, below })
}

/// Puts the mark under the mouse.
fn put(app: &mut App, area: Rect, here: Position) -> Vec<Effect> {
    match place_at(app, area, here) {
        Some(place) => update::chart::move_to(app, place),
        None => vec![Effect::Ask],
    }
}

/// Place on the map under a place on the screen.
fn place_at(app: &App, area: Rect, here: Position) -> Option<Place> {
    let Parts { chart, plot, .. } = parts(app, app.grid()?, area)?;
    let (across, up) = plot.values_at(chart.map()?, here.into())?;
    Some((across, Some(up)))
}

/// Draws legend, map, and the values at the mark, as far as there is room.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let theme = app.view.appearance.theme;
    let Some(grid) = app.grid() else {
        return draw_reason(frame, area, &words::nothing_yet(app), theme);
    };
    if grid.up.is_none() {
        let mut charts = curves(app, grid);
        let mut rest = draw_around(frame, area, (Vec::new(), words::below(app, area)), FEWEST_ROWS);
        if rest.height < 2 * FEWEST_ROWS_OF_CURVES {
            charts.truncate(1);
        }
        for (number, chart) in charts.iter().enumerate() {
            let height = rest.height.div_ceil((charts.len() - number) as u16);
            draw_chart(frame, Rect { height, ..rest }, app, chart);
            rest = Rect { y: rest.y + height, height: rest.height - height, ..rest };
        }
        return;
    }
    let Some(Parts { chart, legend, plot, below }) = parts(app, grid, area) else { return };
    draw_around(frame, area, (legend, below), 0);
    plot::in_theme(app.view.appearance, |style| plot.draw(frame.buffer_mut(), &chart, style));
    if let Some((across, Some(up))) = app.place() {
        let marker = app.view.appearance.marker.symbols();
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
