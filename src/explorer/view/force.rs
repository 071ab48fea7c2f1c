//! The force curve: the hysteresis loop with its two branches.

use super::plot::{Polyline, Span};
use crate::contact::{CurvePoint, Direction, LegRecord};
use crate::explorer::model::Model;
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::{Canvas, Context};

/// Columns for the forces beside the plot.
const GUTTER: u16 = 9;

/// Title of the pane.
pub fn title(model: &Model) -> String {
    if model.is_computing() { " Force F(d) · computing ".to_owned() } else { " Force F(d) ".to_owned() }
}

/// Draws the curve with its axes.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let legs = model.legs();
    let points = || legs.iter().flat_map(|leg| &leg.curve);
    if points().next().is_none() {
        let text = if model.is_computing() { "computing…" } else { "no curve" };
        frame.render_widget(Paragraph::new(text).style(model.theme.style(Meaning::Quiet)), area);
        return;
    }
    let axis_rows = u16::from(area.height >= 5);
    let legend_rows = u16::from(area.height >= 8);
    let gutter = if area.width >= 30 && area.height >= 6 { GUTTER } else { 0 };
    let plot = Rect {
        x: area.x + gutter,
        y: area.y + legend_rows,
        width: area.width - gutter,
        height: area.height - axis_rows - legend_rows,
    };
    let x = Span::around(points().map(|point| point.indentation), 0.06);
    let y = Span::around(points().map(|point| point.force).chain([0.0]), 0.08);
    let stale = model.computed.as_ref().is_some_and(|computed| computed.generation != model.generation);
    // A curve of a scene that has been changed since stands back until the new one is there.
    let colour = |meaning| model.theme.colour(if stale { Meaning::Quiet } else { meaning });
    let theme = model.theme;
    let canvas =
        Canvas::default().marker(Marker::Braille).x_bounds(x.bounds()).y_bounds(y.bounds()).paint(|ctx| {
            let zero = [(x.low, 0.0), (x.high, 0.0)];
            ctx.draw(&Polyline { points: &zero, colour: theme.colour(Meaning::Quiet), dotted: true });
            for (direction, meaning) in
                [(Direction::Loading, Meaning::Approach), (Direction::Unloading, Meaning::Retraction)]
            {
                ctx.layer();
                for leg in legs.iter().filter(|leg| leg.direction == direction) {
                    let points: Vec<(f64, f64)> =
                        leg.curve.iter().map(|p| (p.indentation, p.force)).collect();
                    let dotted = direction == Direction::Loading;
                    ctx.draw(&Polyline { points: &points, colour: colour(meaning), dotted });
                }
            }
            if !stale {
                mark_figures(ctx, legs, theme);
            }
            let moment = model.moment.as_ref().filter(|moment| moment.generation == model.generation);
            if let Some(moment) = moment {
                let at = moment.point.indentation.clamp(x.low, x.high);
                let style = theme.style(Meaning::Cursor);
                ctx.print(at, moment.point.force.clamp(y.low, y.high), Line::styled("◆", style));
            }
        });
    frame.render_widget(canvas, plot);
    if legend_rows > 0 {
        let legend = Line::from(vec![
            Text::styled("⠒ ⠒ ", Style::new().fg(colour(Meaning::Approach))),
            Text::raw("approach  "),
            Text::styled("⠒⠒⠒ ", Style::new().fg(colour(Meaning::Retraction))),
            Text::raw("retraction  "),
            Text::styled("◆", theme.style(Meaning::Cursor)),
            Text::raw(" now"),
        ]);
        frame.render_widget(Paragraph::new(legend), Rect { height: 1, ..area });
    }
    if axis_rows > 0 {
        let row = Rect { y: area.bottom() - 1, height: 1, ..area };
        x_axis(frame, Rect { x: plot.x, width: plot.width, ..row }, x, theme);
    }
    if gutter > 0 {
        y_axis(frame, Rect { x: area.x, width: gutter, ..plot }, y, theme);
    }
}

/// Both ends of the axis of forces, and zero where it fits between them.
fn y_axis(frame: &mut Frame<'_>, column: Rect, y: Span, theme: Theme) {
    let zero = (y.high / (y.high - y.low) * f64::from(column.height)) as u16;
    let last = column.height - 1;
    let mut label = |row: u16, text: String| {
        let place = Rect { y: column.y + row, height: 1, width: column.width - 1, ..column };
        frame.render_widget(Paragraph::new(text).right_aligned().style(theme.style(Meaning::Quiet)), place);
    };
    label(0, format_quantity(short(y.high), "N"));
    label(last, format_quantity(short(y.low), "N"));
    if (2..last.saturating_sub(1)).contains(&zero) {
        label(zero, "F = 0".to_owned());
    }
}

/// The value to three digits: an axis needs no more.
fn short(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Marks preload and pull-off.
fn mark_figures(ctx: &mut Context<'_>, legs: &[LegRecord], theme: Theme) {
    let mut mark = |point: CurvePoint, glyph: &'static str| {
        ctx.print(point.indentation, point.force, Line::styled(glyph, theme.style(Meaning::Title)));
    };
    let loading = legs.iter().filter(|leg| leg.direction == Direction::Loading).map(|leg| leg.largest);
    if let Some(preload) = loading.max_by(|a, b| a.force.total_cmp(&b.force)) {
        mark(preload, "▲");
    }
    let unloading = legs.iter().rev().find(|leg| leg.direction == Direction::Unloading);
    if let Some(pull_off) = unloading.map(|leg| leg.smallest).filter(|point| point.force < 0.0) {
        mark(pull_off, "▼");
    }
}

/// Both ends of the axis of indentations, and zero where it fits between them.
fn x_axis(frame: &mut Frame<'_>, row: Rect, x: Span, theme: Theme) {
    let quiet = theme.style(Meaning::Quiet);
    let ends = [format_quantity(short(x.low), "m"), format_quantity(short(x.high), "m")];
    let width = |text: &str| text.chars().count() as u16;
    let zero = (-x.low / (x.high - x.low) * f64::from(row.width)).floor();
    let right = Rect { x: row.right().saturating_sub(width(&ends[1])), width: width(&ends[1]), ..row };
    if right.x > row.x + width(&ends[0]) {
        frame.render_widget(Paragraph::new(ends[1].clone()).style(quiet), right.intersection(row));
    }
    frame.render_widget(
        Paragraph::new(ends[0].clone()).style(quiet),
        Rect { width: width(&ends[0]).min(row.width), ..row },
    );
    let label = "d = 0";
    let start = f64::from(row.x) + zero - 2.0;
    if start > f64::from(row.x + width(&ends[0]) + 1) && start + 6.0 < f64::from(right.x) {
        let place = Rect { x: start as u16, width: width(label), ..row };
        frame.render_widget(Paragraph::new(label).style(quiet), place.intersection(row));
    }
}
