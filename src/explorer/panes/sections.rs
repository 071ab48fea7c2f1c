//! Sections through the mark of the map: means along its axes, with their confidence where known.

use super::chart_words::{name_of, on_axis, shown_layers};
use crate::draw::{Axis, AxisScale, Chart, Ink, Label, Layer as Drawn, Shape, Sign, Span, Stroke, legend};
use crate::explorer::model::Model;
use crate::explorer::theme::Meaning;
use crate::explorer::view::lines::draw_around;
use crate::explorer::view::plot;
use crate::explorer::view::wrap::filled;
use crate::study::figure::Estimate;
use crate::study::map::{Layer, MapAxis, MapModel};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Span as Text;

/// Lowest shown decade of numbers without a unit, and most decades of others: smaller values lie below the
/// plot.
const LOWEST: f64 = -4.0;
const DECADES: f64 = 8.0;

/// Fewest rows of a useful plot.
const FEWEST_ROWS: u16 = 6;

/// Lines of curves; there are at most two.
const CURVES: [(Ink, Stroke); 2] = [(Ink::Unloading, Stroke::Solid), (Ink::Loading, Stroke::Dotted)];

/// A section along an axis, of layers with their values on the axis, with the mark at a number of the axis; `None`
/// without values.
fn along(
    map: &MapModel,
    MapAxis { figure: axis, .. }: &MapAxis,
    values: &[(&Layer, Vec<(f64, Estimate)>)],
    mark: Option<f64>,
) -> Option<Chart> {
    let (first, last) = (*axis.values.first()?, *axis.values.last()?);
    let (layer, _) = values.first()?;
    let (scale, unit) = (layer.scale, layer.quantity.unit());
    let estimates = || values.iter().flat_map(|(_, values)| values).map(|(_, estimate)| estimate);
    let y = range(scale, unit, &estimates().copied().collect::<Vec<_>>())?;
    let x = Span { low: axis.scale.coordinate(first), high: axis.scale.coordinate(last) };
    let mut layers = Vec::new();
    let mark = mark.filter(|mark| (first..=last).contains(mark));
    if let Some(mark) = mark {
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
            layers.push(Drawn::new(name, ink, Shape::line(points, stroke)));
        }
    }
    if let Some(mark) = mark {
        let points = vec![(mark, scale.number(y.high))];
        let shape = Shape::signs(points, Sign::Diamond);
        layers.push(Drawn::unnamed(Ink::Cursor, shape));
    }
    let symbol = match values {
        [_] if !layer.quantity.symbol().is_empty() => layer.quantity.symbol(),
        [_] => "value",
        _ => "share",
    };
    let name = if axis.symbol.is_empty() { &axis.name } else { "" };
    let x = Axis::new(axis.scale, x, name, &axis.symbol, &axis.unit);
    Some(Chart::new(x, Axis::new(scale, y, "", symbol, unit), layers))
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

/// Column and row of the sections: those of the mark, or of the middle of a map without one.
pub fn section_cell(model: &Model, map_model: &MapModel) -> (usize, usize) {
    let (columns, rows) = map_model.size();
    model.place().map_or((columns / 2, rows / 2), |mark| map_model.nearest_cell(mark))
}

/// Sections of the map through the mark, or through the middle of a map without one: along the axis across and, where
/// the map has one, along the axis up, each headed by the fixed value of the other axis.
pub fn charts(model: &Model) -> Vec<Chart> {
    let Some(map_model) = model.chart.map_model() else { return Vec::new() };
    let mark = model.place();
    let (column, row) = section_cell(model, map_model);
    let layers = shown_layers(model.chart.charted(), map_model);
    let headed = |axis: &MapAxis, kept: Option<(&MapAxis, usize)>, chart: Option<Chart>| {
        let kept = kept.and_then(|(axis, index)| Some(on_axis(axis, *axis.figure.values.get(index)?)));
        let at = kept.map_or_else(String::new, |kept| format!(" at {kept}"));
        let heading = Label::plain("over ")
            .join(&Label::symbol_or_name(&axis.figure.symbol, &axis.figure.name))
            .then(&at);
        chart.map(|chart| Chart { heading, ..chart })
    };
    let (across, up) = (map_model.across(), map_model.up());
    let values: Vec<_> = layers.iter().map(|layer| (*layer, map_model.along_row(layer, row))).collect();
    let along_row = along(map_model, across, &values, mark.map(|mark| mark.0));
    let mut charts = Vec::from_iter(headed(across, up.map(|up| (up, row)), along_row));
    if let Some(up) = up {
        let values: Vec<_> =
            layers.iter().map(|layer| (*layer, map_model.along_column(layer, column))).collect();
        let along_column = along(map_model, up, &values, mark.and_then(|mark| mark.1));
        charts.extend(headed(up, Some((across, column)), along_column));
    }
    charts
}

/// Draws both sections one above the other, or the first where there is no other or no room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let mut charts = charts(model);
    if area.height < 2 * FEWEST_ROWS {
        charts.truncate(1);
    }
    let mut rest = area;
    for (number, chart) in charts.iter().enumerate() {
        let height = rest.height.div_ceil((charts.len() - number) as u16);
        section(frame, Rect { height, ..rest }, model, chart);
        rest = Rect { y: rest.y + height, height: rest.height - height, ..rest };
    }
}

/// Draws a chart with its legend, which begins with the heading of the chart.
pub(super) fn section(frame: &mut Frame<'_>, area: Rect, model: &Model, chart: &Chart) {
    let heading = vec![Text::styled(chart.heading.to_string(), model.appearance.theme.style(Meaning::Title))];
    let entries = plot::in_theme(model.appearance, |style| legend(std::slice::from_ref(chart), style));
    let parts =
        std::iter::once(heading).filter(|heading| !heading[0].content.is_empty()).chain(entries).collect();
    let legend = filled(parts, "  ", usize::from(area.width));
    let plot = draw_around(frame, area, (legend, Vec::new()), FEWEST_ROWS - 1);
    plot::draw_chart(frame, plot, chart, model.appearance);
}
