//! The map over κ and H: regimes as glyphs and colours, and the mark of the scene. Beside it stand
//! [words].

use super::regimes::{STEPS, glyph_between, glyph_of, meaning};
use super::wrap::wrapped;
use super::{chart_words as words, sections};
use crate::explorer::model::Model;
use crate::explorer::theme::{Meaning, Theme};
use crate::study::map::{Charted, MapCell, MapModel, Place};
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;

/// Columns for the values of H beside the map.
const GUTTER: u16 = 5;
/// Rows of map that make it worth drawing.
const FEWEST_ROWS: u16 = 4;

fn glyph(map_model: &MapModel, place: &Place<'_>, map_cell: &MapCell, charted: Charted) -> &'static str {
    match (charted, map_cell.regime) {
        (Charted::Regime, None) => "?",
        (Charted::Regime, Some(regime)) => {
            map_cell.split.map_or_else(|| glyph_of(regime), |other| glyph_between(regime, other))
        }
        (Charted::Quantity(quantity), _) => map_model
            .layer(quantity)
            .and_then(|layer| Some((layer, map_model.estimate(layer, place.column, place.row)?)))
            .map_or("?", |(layer, estimate)| STEPS[layer.step(estimate.mean)]),
    }
}

/// Where everything stands in the pane.
struct Places {
    legend: Vec<Line<'static>>,
    plot: Rect,
    below: Vec<Line<'static>>,
}

fn places(model: &Model, area: Rect) -> Places {
    let mut legend = words::legend(model, area.width);
    let mut below = words::below(model, area);
    // The map comes first, then what the mark says, then the legend.
    let room = usize::from(area.height.saturating_sub(FEWEST_ROWS + 1));
    below.truncate(room.min(usize::from(area.height / 3)));
    legend.truncate(room - below.len());
    let gutter = if area.width >= 30 { GUTTER } else { 0 };
    let axis = u16::from(area.height >= 5);
    let taken = (legend.len() + below.len()) as u16 + axis;
    let plot = Rect {
        x: area.x + gutter,
        y: area.y + legend.len() as u16,
        width: area.width - gutter,
        height: area.height.saturating_sub(taken),
    };
    Places { legend, plot, below }
}

/// κ and H under a place on the screen.
pub fn place_at(model: &Model, area: Rect, here: Position) -> Option<(f64, f64)> {
    let map_model = model.chart.map_model().filter(|_| !model.chart.sections)?;
    let up = map_model.up()?;
    let plot = places(model, area).plot;
    let inside = plot.contains(here);
    if !inside {
        return None;
    }
    let (columns, rows) = map_model.size();
    let kappa = map_model.across().values.get(index(here.x - plot.x, plot.width, columns))?;
    let hurst = up.values.get(index(plot.bottom() - 1 - here.y, plot.height, rows))?;
    Some((*kappa, *hurst))
}

/// The cell of the map that a cell of the screen shows.
fn index(at: u16, of: u16, count: usize) -> usize {
    usize::from(at) * count / usize::from(of.max(1))
}

/// The cell of the screen that shows a place on the map, or the one at its edge.
fn screen(at: f64, of: u16, count: usize) -> u16 {
    let place = ((at + 0.5) * f64::from(of) / count as f64).floor();
    place.clamp(0.0, f64::from(of.max(1) - 1)) as u16
}

/// Draws legend, map, and what stands at the mark, as far as there is room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let Some(map_model) = model.chart.map_model() else {
        let text = wrapped(&Line::styled(words::nothing_yet(model), theme.style(Meaning::Quiet)), area.width);
        return write(frame, area, text);
    };
    if model.chart.sections || map_model.up().is_none() {
        let below = words::below(model, area);
        let rows = (below.len() as u16).min(area.height.saturating_sub(FEWEST_ROWS));
        let plots = Rect { height: area.height - rows, ..area };
        sections::draw(frame, plots, model, map_model);
        return write(frame, Rect { y: plots.bottom(), height: rows, ..area }, below);
    }
    let Places { legend, plot, below } = places(model, area);
    write(frame, Rect { height: legend.len() as u16, ..area }, legend);
    let rows = (below.len() as u16).min(area.height);
    write(frame, Rect { y: area.bottom() - rows, height: rows, ..area }, below);
    cells(frame, plot, model, map_model);
    axes(frame, area, plot, map_model, theme);
    mark(frame, area, plot, model, map_model);
}

fn write(frame: &mut Frame<'_>, area: Rect, lines: Vec<Line<'static>>) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
}

fn cells(frame: &mut Frame<'_>, plot: Rect, model: &Model, map_model: &MapModel) {
    let theme = model.appearance.theme;
    let (columns, rows) = map_model.size();
    let charted = model.chart.charted();
    for y in 0..plot.height {
        let row = index(plot.height - 1 - y, plot.height, rows);
        let spans = (0..plot.width).map(|x| {
            let Some(place) = map_model.shown(index(x, plot.width, columns), row) else {
                return Text::raw(" ");
            };
            match place.cell {
                Ok(map_cell) => {
                    let meaning = map_cell.regime.map_or(Meaning::Text, meaning);
                    Text::styled(glyph(map_model, &place, map_cell, charted), theme.style(meaning))
                }
                Err(_) => Text::styled("×", theme.style(Meaning::Error)),
            }
        });
        let line = Line::from_iter(spans);
        frame.render_widget(Paragraph::new(line), Rect { y: plot.y + y, height: 1, ..plot });
    }
}

fn axes(frame: &mut Frame<'_>, area: Rect, plot: Rect, map_model: &MapModel, theme: Theme) {
    let ([across, up], (columns, rows)) = (map_model.labels(), map_model.size());
    let quiet = theme.style(Meaning::Quiet);
    if plot.is_empty() {
        return;
    }
    let mut put = |place: Rect, text: String| {
        frame.render_widget(Paragraph::new(Text::styled(text, quiet)), place.intersection(area));
    };
    let below = Rect { y: plot.bottom(), height: 1, ..plot };
    if below.bottom() <= area.bottom() {
        let mut free = plot.x;
        for (number, (column, text)) in across.iter().enumerate() {
            let text = if number == 0 { format!("κ {text}") } else { text.clone() };
            let width = text.chars().count() as u16;
            let middle = plot.x + screen(*column as f64, plot.width, columns);
            let x = middle
                .saturating_sub(width / 2)
                .clamp(plot.x, plot.right().saturating_sub(width).max(plot.x));
            if x >= free && x + width <= plot.right() {
                put(Rect { x, width, ..below }, text);
                free = x + width + 1;
            }
        }
    }
    if plot.x > area.x {
        let mut free = plot.bottom();
        for (number, (row, text)) in up.iter().enumerate() {
            let y = plot.bottom() - 1 - screen(*row as f64, plot.height, rows);
            if y < free {
                let symbol = if number + 1 == up.len() { "H" } else { " " };
                put(Rect { x: area.x, y, width: GUTTER, height: 1 }, format!("{symbol}{text}"));
                free = y;
            }
        }
    }
}

/// The scene as it stands, with a pointer on each axis.
fn mark(frame: &mut Frame<'_>, area: Rect, plot: Rect, model: &Model, map_model: &MapModel) {
    let Some((kappa, Some(hurst))) = model.place().filter(|_| !plot.is_empty()) else { return };
    let style = model.appearance.theme.style(Meaning::Cursor);
    let (column, row) = map_model.coordinates(kappa, Some(hurst));
    let (columns, rows) = map_model.size();
    // Beyond the map it stands at its edge.
    let (x, y) = (screen(column, plot.width, columns), screen(row, plot.height, rows));
    let (x, y) = (plot.x + x, plot.bottom() - 1 - y);
    let mut put = |x: u16, y: u16, text: &'static str| {
        let place = Rect { x, y, width: text.chars().count() as u16, height: 1 };
        frame.render_widget(Paragraph::new(Text::styled(text, style)), place.intersection(area));
    };
    // Its surroundings stand back, so that it is seen without colours.
    if x > plot.x {
        put(x - 1, y, " ");
    }
    if x + 1 < plot.right() {
        put(x + 1, y, " ");
    }
    put(x, y, "◆");
    put(x, plot.bottom(), "▲");
    if plot.x > area.x {
        put(plot.x - 1, y, "▶");
    }
}
