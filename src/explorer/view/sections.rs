//! Sections through the mark of the map: means over κ and over H, with their confidence where it is known.

use super::chart_words::{name_of, number, told};
use super::plot;
use super::wrap::filled;
use crate::draw::{Axis, AxisScale, Chart, Ink, Label, Layer as Drawn, Shape, Sign, Span, Stroke, legend};
use crate::explorer::model::Model;
use crate::explorer::theme::Meaning;
use crate::study::figure::{Estimate, FigureAxis};
use crate::study::map::{Layer, MapModel};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Span as Text;
use ratatui::widgets::Paragraph;

/// Lowest decade that is shown of numbers without a unit, and most decades of others: what is smaller lies
/// below the plot.
const LOWEST: f64 = -4.0;
const DECADES: f64 = 8.0;

/// Rows that make a plot worth drawing.
const FEWEST_ROWS: u16 = 4;

/// Lines of curves; there are at most two.
const CURVES: [(Ink, Stroke); 2] = [(Ink::Unloading, Stroke::Solid), (Ink::Loading, Stroke::Dotted)];

/// A section along an axis, of layers with their values on the axis, with the mark at a number of the axis; `None`
/// without values.
fn along(
    map: &MapModel,
    (axis, across): (&FigureAxis, &'static str),
    values: &[(&Layer, Vec<(f64, Estimate)>)],
    mark: f64,
) -> Option<Chart> {
    let (first, last) = (*axis.values.first()?, *axis.values.last()?);
    let (layer, _) = values.first()?;
    let (scale, unit) = (layer.scale, layer.quantity.unit());
    let estimates = || values.iter().flat_map(|(_, values)| values).map(|(_, estimate)| estimate);
    let y = range(scale, unit, &estimates().copied().collect::<Vec<_>>())?;
    let x = Span { low: axis.scale.coordinate(first), high: axis.scale.coordinate(last) };
    let mut layers = Vec::new();
    let inside = (first..=last).contains(&mark);
    if inside {
        layers.push(Drawn::unnamed(Ink::Cursor, Shape::Upright(mark)));
    }
    for ((layer, values), (ink, stroke)) in values.iter().zip(CURVES) {
        if values.iter().any(|(_, one)| one.low < one.high) {
            let band = values.iter().map(|(x, one)| (*x, one.low, one.high)).collect();
            layers.push(Drawn::new("95 % confidence".into(), ink, Shape::Band(band)));
        }
        let points: Vec<_> = values.iter().map(|(x, one)| (*x, one.mean)).collect();
        if !points.is_empty() {
            let name = Label::symbol(&name_of(map, layer.quantity));
            layers.push(Drawn::new(name, ink, Shape::Curve { points, stroke: Some(stroke), sign: None }));
        }
    }
    if inside {
        let points = vec![(mark, scale.number(y.high))];
        let shape = Shape::Curve { points, stroke: None, sign: Some(Sign::Diamond) };
        layers.push(Drawn::unnamed(Ink::Cursor, shape));
    }
    let symbol = match values {
        [_] if !layer.quantity.symbol().is_empty() => layer.quantity.symbol(),
        [_] => "value",
        _ => "share",
    };
    let x = Axis::new(axis.scale, x, "", across, "1");
    Some(plot::chart(x, Axis::new(scale, y, "", symbol, unit), layers))
}

/// Range of the values in coordinates; `None` without any.
fn range(scale: AxisScale, unit: &str, estimates: &[Estimate]) -> Option<Span> {
    let means = || estimates.iter().map(|one| scale.coordinate(one.mean)).filter(|mean| mean.is_finite());
    means().next()?;
    if scale == AxisScale::Linear {
        let ends = || estimates.iter().flat_map(|one| [one.mean, one.low, one.high]);
        let span = Span::around(ends(), 0.04);
        // A quantity that is never negative has no axis below zero.
        let least = if ends().all(|end| end >= 0.0) { 0.0 } else { span.low };
        return Some(Span { low: span.low.max(least), ..span });
    }
    let span = Span::decades(means());
    let low = span.low.max(if unit == "1" { LOWEST } else { span.high - DECADES });
    Some(Span { low, high: span.high.max(low + 1.0) })
}

/// Draws both sections one above the other, or that over κ where there is no H or no room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model, map_model: &MapModel) {
    let Some((at_kappa, at_hurst)) = model.place() else { return };
    let Some(place) = map_model.nearest(at_kappa, at_hurst) else { return };
    let layers = told(model.chart.charted(), map_model);
    let kept = |symbol: &str, axis: &FigureAxis, index: usize| {
        axis.values.get(index).map_or_else(String::new, |value| format!("at {symbol} {}", number(*value)))
    };
    let values: Vec<_> =
        layers.iter().map(|layer| (*layer, map_model.along_kappa(layer, place.row))).collect();
    let at = map_model.up().map_or_else(String::new, |up| kept("H", up, place.row));
    let over_kappa = along(map_model, (map_model.across(), "κ"), &values, at_kappa);
    let over_kappa = over_kappa.map(|chart| (chart, format!("over κ {at}")));
    let both = map_model.up().zip(at_hurst).filter(|_| area.height >= 2 * FEWEST_ROWS);
    let upper = if both.is_some() { area.height.div_ceil(2) } else { area.height };
    if let Some((chart, told)) = over_kappa {
        section(frame, Rect { height: upper, ..area }, model, &chart, told);
    }
    if let Some((up, at_hurst)) = both {
        let values: Vec<_> =
            layers.iter().map(|layer| (*layer, map_model.along_hurst(layer, place.column))).collect();
        let at = kept("κ", map_model.across(), place.column);
        if let Some(chart) = along(map_model, (up, "H"), &values, at_hurst) {
            let lower = Rect { y: area.y + upper, height: area.height - upper, ..area };
            section(frame, lower, model, &chart, format!("over H {at}"));
        }
    }
}

/// Draws a chart with its legend, which begins with these words.
pub(super) fn section(frame: &mut Frame<'_>, area: Rect, model: &Model, chart: &Chart, told: String) {
    let told = vec![Text::styled(told, model.appearance.theme.style(Meaning::Title))];
    let entries = plot::in_theme(model.appearance, |style| legend(std::slice::from_ref(chart), style));
    let parts = std::iter::once(told).filter(|told| !told[0].content.is_empty()).chain(entries).collect();
    let legend = filled(parts, "  ", usize::from(area.width));
    let rows = (legend.len() as u16).min(area.height.saturating_sub(FEWEST_ROWS));
    for (y, line) in (area.y..area.y + rows).zip(legend) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
    let plot = Rect { y: area.y + rows, height: area.height - rows, ..area };
    plot::draw_chart(frame, plot, chart, model.appearance);
}
