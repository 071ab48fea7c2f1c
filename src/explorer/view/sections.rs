//! Sections through the mark of the map: adhesion over κ and over H, on a logarithmic scale.

use super::axes::{Axis, Places};
use super::plot::{Polyline, Span, Stroke};
use super::wrap::filled;
use crate::explorer::model::Model;
use crate::explorer::theme::Meaning;
use crate::phase::{Cell, HURSTS, KAPPAS, PhaseMap, hurst, kappa};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::Canvas;

/// Lowest decade that is shown: what is smaller lies below the plot.
const LOWEST: f64 = -4.0;

/// Rows that make a plot worth drawing.
const FEWEST_ROWS: u16 = 4;

/// A curve: its points, its name, its colour and its line.
struct Curve {
    points: Vec<(f64, f64)>,
    name: &'static str,
    meaning: Meaning,
    stroke: Stroke,
}

/// What is shown of cells: the share of the ideal adhesion without a preload, and the adhesion coefficient.
fn curves<'a>(cells: impl Iterator<Item = (f64, &'a Cell)>) -> [Curve; 2] {
    let (mut zero_load, mut coefficient) = (Vec::new(), Vec::new());
    for (at, cell) in cells {
        zero_load.push((at, cell.zero_load_share().log10()));
        coefficient.extend(cell.coefficient().map(|value| (at, value.log10())));
    }
    for points in [&mut zero_load, &mut coefficient] {
        points.retain(|point| point.1.is_finite());
    }
    let curve = |points, name, meaning, stroke| Curve { points, name, meaning, stroke };
    [
        curve(zero_load, "F_a(0)/F_a,max", Meaning::Retraction, Stroke::Solid),
        curve(coefficient, "F_a/F_n", Meaning::Approach, Stroke::Dotted),
    ]
}

/// A plot: its curves, along what, where the mark is, and what is kept.
struct Section {
    curves: [Curve; 2],
    x: Span,
    ends: Span,
    symbol: &'static str,
    mark: f64,
    kept: String,
}

/// Draws both sections one above the other, or that over κ where there is no H or no room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model, map: &PhaseMap) {
    let Some((at_kappa, at_hurst)) = model.place() else { return };
    let Some((column, row, _)) = map.nearest(at_kappa, at_hurst.unwrap_or_default()) else { return };
    let number = |value: f64| format_quantity(format!("{value:.2e}").parse().unwrap_or(value), "1");
    let over_kappa = Section {
        curves: curves(map.along_kappa(row).map(|(kappa, cell)| (kappa.log2(), cell))),
        x: Span { low: kappa(0).log2(), high: kappa(KAPPAS - 1).log2() },
        ends: Span { low: kappa(0), high: kappa(KAPPAS - 1) },
        symbol: "κ",
        mark: at_kappa.log2(),
        kept: if at_hurst.is_some() { format!("at H {}", number(hurst(row))) } else { String::new() },
    };
    let Some(at_hurst) = at_hurst.filter(|_| area.height >= 2 * FEWEST_ROWS) else {
        return section(frame, area, model, &over_kappa);
    };
    let over_hurst = Section {
        curves: curves(map.along_hurst(column)),
        x: Span { low: hurst(0), high: hurst(HURSTS - 1) },
        ends: Span { low: hurst(0), high: hurst(HURSTS - 1) },
        symbol: "H",
        mark: at_hurst,
        kept: format!("at κ {}", number(kappa(column))),
    };
    let upper = area.height.div_ceil(2);
    section(frame, Rect { height: upper, ..area }, model, &over_kappa);
    let lower = Rect { y: area.y + upper, height: area.height - upper, ..area };
    section(frame, lower, model, &over_hurst);
}

fn section(frame: &mut Frame<'_>, area: Rect, model: &Model, section: &Section) {
    let theme = model.appearance.theme;
    let Section { curves, x, ends, symbol, mark, kept } = section;
    let told = Text::styled(format!("over {symbol} {kept}"), theme.style(Meaning::Title));
    let names = curves.iter().filter(|curve| !curve.points.is_empty()).map(|curve| {
        let line = if curve.stroke == Stroke::Solid { "─ " } else { "┄ " };
        vec![Text::styled(line, theme.style(curve.meaning)), Text::raw(curve.name)]
    });
    let legend = filled(std::iter::once(vec![told]).chain(names).collect(), "  ", usize::from(area.width));
    let rows = (legend.len() as u16).min(area.height.saturating_sub(FEWEST_ROWS));
    for (y, line) in (area.y..area.y + rows).zip(legend) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
    let all = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.1);
    let low = all().fold(f64::INFINITY, f64::min);
    if !low.is_finite() {
        return;
    }
    let low = low.floor().max(LOWEST);
    let y = Span { low, high: all().fold(low, f64::max).ceil().max(low + 1.0) };
    let places = Places::within(area, rows);
    let canvas = Canvas::default()
        .marker(model.appearance.marker.symbols())
        .x_bounds(x.bounds())
        .y_bounds(y.bounds())
        .paint(|ctx| {
            let there = [(*mark, y.low), (*mark, y.high)];
            if (x.low..=x.high).contains(mark) {
                let colour = theme.colour(Meaning::Cursor);
                ctx.draw(&Polyline { points: &there, colour, stroke: Stroke::Sparse });
            }
            for Curve { points, meaning, stroke, .. } in curves {
                ctx.layer();
                let colour = theme.colour(*meaning);
                ctx.draw(&Polyline { points, colour, stroke: *stroke });
            }
            if (x.low..=x.high).contains(mark) {
                ctx.print(*mark, y.high, Line::styled("◆", theme.style(Meaning::Cursor)));
            }
        });
    frame.render_widget(canvas, places.plot);
    let decades = Span { low: 10_f64.powf(y.low), high: 10_f64.powf(y.high) };
    places.draw(
        frame,
        Axis { span: *ends, unit: "1", symbol },
        Axis { span: decades, unit: "1", symbol: "share" },
        theme,
    );
}
