//! Sections through the mark of the map: means over κ and over H, with their confidence where it is known.

use super::axes::{Axis, Places};
use super::chart_words::{name_of, number, told};
use super::plot::{Polyline, Span, Stroke};
use super::wrap::filled;
use crate::explorer::model::Model;
use crate::explorer::theme::Meaning;
use crate::study::figure::{AxisScale, Estimate, FigureAxis};
use crate::study::map::{Layer, MapModel};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::Canvas;

/// Lowest decade that is shown of numbers without a unit, and most decades of others: what is smaller lies
/// below the plot.
const LOWEST: f64 = -4.0;
const DECADES: f64 = 8.0;

/// Rows that make a plot worth drawing.
const FEWEST_ROWS: u16 = 4;

/// Lines of curves, and what they mean where there are two.
const CURVES: [(Meaning, Stroke, &str); 2] =
    [(Meaning::Retraction, Stroke::Solid, "─ "), (Meaning::Approach, Stroke::Dotted, "┄ ")];

/// A curve: its points, the confidence of each where it is known, in coordinates of the plot, and its name.
struct Curve {
    points: Vec<(f64, f64)>,
    bars: Vec<(f64, f64, f64)>,
    name: String,
    meaning: Meaning,
    stroke: Stroke,
    sign: &'static str,
}

/// A plot: its curves, how their values lie, along what, where the mark is, and what is kept.
struct Section {
    curves: Vec<Curve>,
    scale: AxisScale,
    unit: &'static str,
    symbol: &'static str,
    across: &'static str,
    x: Span,
    ends: Span,
    mark: f64,
    kept: String,
}

impl Section {
    /// A section along an axis, of layers with their values on it.
    fn along(
        plane: &MapModel,
        (axis, across): (&FigureAxis, &'static str),
        values: &[(&Layer, Vec<(f64, Estimate)>)],
        mark: f64,
        kept: String,
    ) -> Option<Self> {
        let (first, last) = (*axis.values.first()?, *axis.values.last()?);
        let (layer, _) = values.first()?;
        let (scale, unit) = (layer.scale, layer.quantity.unit());
        let curve = |((layer, values), (meaning, stroke, sign)): (&(&Layer, Vec<(f64, Estimate)>), _)| {
            let at = |number: f64| axis.scale.coordinate(number);
            let y = |number: f64| scale.coordinate(number);
            let points = values.iter().map(|(x, one)| (at(*x), y(one.mean)));
            let bars = values.iter().filter(|(_, one)| one.low < one.high);
            // Of a mean near zero the interval may go beyond what has a logarithm.
            let bottom =
                |number: f64| if number > 0.0 || scale == AxisScale::Linear { y(number) } else { f64::MIN };
            Curve {
                points: points.filter(|point| point.1.is_finite()).collect(),
                bars: bars.map(|(x, one)| (at(*x), bottom(one.low), y(one.high))).collect(),
                name: name_of(plane, layer.quantity),
                meaning,
                stroke,
                sign,
            }
        };
        let symbol = match values {
            [_] if !layer.quantity.symbol().is_empty() => layer.quantity.symbol(),
            [_] => "value",
            _ => "share",
        };
        Some(Section {
            curves: values.iter().zip(CURVES).map(curve).collect(),
            scale,
            unit,
            symbol,
            across,
            x: Span { low: axis.scale.coordinate(first), high: axis.scale.coordinate(last) },
            ends: Span { low: first, high: last },
            mark: axis.scale.coordinate(mark),
            kept,
        })
    }

    /// What its values span; `None` where there are none.
    fn y(&self) -> Option<Span> {
        let means = || self.curves.iter().flat_map(|curve| &curve.points).map(|point| point.1);
        let (low, high) = (means().fold(f64::INFINITY, f64::min), means().fold(f64::NEG_INFINITY, f64::max));
        if low > high {
            return None;
        }
        if self.scale == AxisScale::Linear {
            let bars = self.curves.iter().flat_map(|curve| &curve.bars).flat_map(|bar| [bar.1, bar.2]);
            let ends: Vec<f64> = means().chain(bars).collect();
            let Span { low, high } = Span::around(ends.iter().copied(), 0.04);
            // What is never negative has no axis below zero.
            let least = if ends.iter().all(|end| *end >= 0.0) { 0.0 } else { low };
            return Some(Span { low: low.max(least), high });
        }
        let high = high.ceil();
        let low = low.floor().max(if self.unit == "1" { LOWEST } else { high - DECADES });
        Some(Span { low, high: high.max(low + 1.0) })
    }
}

/// Draws both sections one above the other, or that over κ where there is no H or no room.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model, plane: &MapModel) {
    let Some((at_kappa, at_hurst)) = model.place() else { return };
    let Some(place) = plane.nearest(at_kappa, at_hurst) else { return };
    let layers = told(model.chart.charted(), plane);
    let kept = |symbol: &str, axis: &FigureAxis, index: usize| {
        axis.values.get(index).map_or_else(String::new, |value| format!("at {symbol} {}", number(*value)))
    };
    let values: Vec<_> = layers.iter().map(|layer| (*layer, plane.along_kappa(layer, place.row))).collect();
    let at = plane.up().map_or_else(String::new, |up| kept("H", up, place.row));
    let over_kappa = Section::along(plane, (plane.across(), "κ"), &values, at_kappa, at);
    let both = plane.up().zip(at_hurst).filter(|_| area.height >= 2 * FEWEST_ROWS);
    let upper = if both.is_some() { area.height.div_ceil(2) } else { area.height };
    if let Some(over_kappa) = over_kappa {
        section(frame, Rect { height: upper, ..area }, model, &over_kappa);
    }
    if let Some((up, at_hurst)) = both {
        let values: Vec<_> =
            layers.iter().map(|layer| (*layer, plane.along_hurst(layer, place.column))).collect();
        let at = kept("κ", plane.across(), place.column);
        if let Some(over_hurst) = Section::along(plane, (up, "H"), &values, at_hurst, at) {
            let lower = Rect { y: area.y + upper, height: area.height - upper, ..area };
            section(frame, lower, model, &over_hurst);
        }
    }
}

fn section(frame: &mut Frame<'_>, area: Rect, model: &Model, section: &Section) {
    let theme = model.appearance.theme;
    let Section { curves, x, mark, across, kept, .. } = section;
    let told = Text::styled(format!("over {across} {kept}"), theme.style(Meaning::Title));
    let names = curves.iter().filter(|curve| !curve.points.is_empty()).map(|curve| {
        vec![Text::styled(curve.sign, theme.style(curve.meaning)), Text::raw(curve.name.clone())]
    });
    let with_bars = curves.iter().any(|curve| !curve.bars.is_empty());
    let bars = with_bars.then(|| vec![Text::raw("│ 95 % confidence")]);
    let parts = std::iter::once(vec![told]).chain(names).chain(bars).collect();
    let legend = filled(parts, "  ", usize::from(area.width));
    let rows = (legend.len() as u16).min(area.height.saturating_sub(FEWEST_ROWS));
    for (y, line) in (area.y..area.y + rows).zip(legend) {
        frame.render_widget(Paragraph::new(line), Rect { y, height: 1, ..area });
    }
    let Some(y) = section.y() else { return };
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
            for Curve { points, bars, meaning, stroke, .. } in curves {
                ctx.layer();
                let colour = theme.colour(*meaning);
                for (at, low, high) in bars {
                    let bar = [low, high].map(|end| (*at, end.clamp(y.low, y.high)));
                    ctx.draw(&Polyline { points: &bar, colour, stroke: Stroke::Solid });
                }
                ctx.draw(&Polyline { points, colour, stroke: *stroke });
            }
            if (x.low..=x.high).contains(mark) {
                ctx.print(*mark, y.high, Line::styled("◆", theme.style(Meaning::Cursor)));
            }
        });
    frame.render_widget(canvas, places.plot);
    let values = Span { low: section.scale.number(y.low), high: section.scale.number(y.high) };
    places.draw(
        frame,
        Axis { span: section.ends, unit: "1", symbol: across },
        Axis { span: values, unit: section.unit, symbol: section.symbol },
        theme,
    );
}
