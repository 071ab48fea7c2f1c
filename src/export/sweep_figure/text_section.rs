//! A section as text: the mean in Braille, and dots where its confidence ends.

use super::label::{axis_label, plain, prefixed, quantity_label, short, value_label};
use super::section::{Point, around, curves, heights};
use super::text::{centred, numbers_below, push_words};
use super::ticks::ticks;
use crate::study::figure::{AxisScale, Figure, Panel};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Line, Points};

/// Rows of the plot.
const ROWS: u16 = 18;
/// Widest plot, columns.
const WIDEST: usize = 100;
/// Every so many dots of a row one is set where confidence ends.
const DISTANCE: usize = 3;

pub(super) fn draw(text: &mut String, figure: &Figure, panel: &Panel, columns: usize) {
    let curves = curves(figure, panel, panel.scale);
    let all = curves.concat();
    let across = around(figure.across.coordinates().into_iter(), 0.02);
    let up = heights(panel, panel.scale, &all);
    let largest = match panel.scale {
        AxisScale::Linear => up.0.abs().max(up.1.abs()),
        AxisScale::Logarithmic => 10_f64.powf(up.1),
    };
    let (divisor, unit) = prefixed(&panel.quantity.unit, largest);
    let marks = ticks(panel.scale, up, divisor, 6);
    let labels: Vec<(u16, String)> = marks
        .iter()
        .filter_map(|tick| {
            let share = (tick.at - up.0) / (up.1 - up.0);
            let row = ((1.0 - share) * f64::from(ROWS - 1)).round().clamp(0.0, f64::from(ROWS - 1)) as u16;
            Some((row, plain(tick.label.as_deref()?)))
        })
        .collect();
    let before = labels.iter().map(|(_, label)| label.chars().count()).max().unwrap_or(0) + 2;
    let width = columns.saturating_sub(before).clamp(10, WIDEST);
    let mut buffer = plot(&curves, across, up, width as u16);

    // Where there are several curves, each has its number at its highest point.
    let numbered = figure.series.as_ref().filter(|_| curves.len() > 1);
    if numbered.is_some() {
        number_curves(&mut buffer, &curves, across, up);
    }
    text.push_str(&format!("{}\n", plain(&quantity_label(&panel.quantity, &unit))));
    for row in 0..ROWS {
        let label = labels.iter().find(|(at, _)| *at == row).map(|(_, label)| label.as_str());
        let mark = if label.is_some() { '┤' } else { '│' };
        let mut line = format!("{:>before$} {mark}", label.unwrap_or_default(), before = before - 2);
        line.extend((0..width as u16).map(|column| buffer[(column, row)].symbol()));
        text.push_str(line.trim_end_matches([' ', '\u{2800}']));
        text.push('\n');
    }
    text.push_str(&format!("{}└{}\n", " ".repeat(before - 1), "─".repeat(width)));
    let axis = &figure.across;
    let (divisor, unit) = prefixed(&axis.unit, axis.values.iter().copied().fold(0.0, f64::max));
    let places: Vec<_> = ticks(axis.scale, across, divisor, width / 12)
        .into_iter()
        .filter_map(|tick| {
            let share = (tick.at - across.0) / (across.1 - across.0);
            Some(((share * (width - 1) as f64).round() as usize, plain(tick.label.as_deref()?)))
        })
        .collect();
    text.push_str(&format!("{}\n", numbers_below(before, &places, columns)));
    text.push_str(&format!("{}\n", centred(&axis_label(axis, &unit), before, width)));
    if all.iter().any(|point| point.high > point.low) {
        push_words(text, "line: mean, dots: its 95 % confidence", columns);
    }
    if let Some(series) = numbered {
        let names = series.values.iter().enumerate();
        let names =
            names.map(|(index, value)| format!("{}: {}", index + 1, plain(&value_label(series, *value))));
        push_words(text, &names.collect::<Vec<_>>().join(", "), columns);
    }
    if let Some(boundary) = &figure.boundary {
        let symbol = if axis.symbol.is_empty() { &axis.name } else { &axis.symbol };
        for crossing in figure.crossings(panel) {
            let at = short(axis.scale.number(crossing) / divisor);
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            text.push_str(&format!("{} at {symbol} = {at}{unit}\n", boundary.label));
        }
    }
}

/// Puts the number of each curve on its highest point, the first of those that are as high.
fn number_curves(buffer: &mut Buffer, curves: &[Vec<Point>], across: (f64, f64), up: (f64, f64)) {
    let area = *buffer.area();
    let cell = |value: f64, (low, high): (f64, f64), cells: u16| {
        let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
        ((share * f64::from(cells)) as u16).min(cells - 1)
    };
    for (index, points) in curves.iter().enumerate() {
        let Some(top) = points.iter().reduce(|top, point| if point.mean > top.mean { point } else { top })
        else {
            continue;
        };
        let column = cell(top.at, across, area.width);
        let row = area.height - 1 - cell(top.mean, up, area.height);
        buffer[(column, row)].set_symbol(&(index + 1).to_string());
    }
}

fn plot(curves: &[Vec<Point>], across: (f64, f64), up: (f64, f64), width: u16) -> Buffer {
    let area = Rect::new(0, 0, width, ROWS);
    let mut buffer = Buffer::empty(area);
    let inside = |y: f64| y.clamp(up.0, up.1);
    Canvas::default()
        .marker(Marker::Braille)
        .x_bounds([across.0, across.1])
        .y_bounds([up.0, up.1])
        .paint(|context| {
            for run in curves.iter().flat_map(|points| points.chunk_by(|_, next| !next.after_gap)) {
                for pair in run.windows(2) {
                    context.draw(&Line {
                        x1: pair[0].at,
                        y1: inside(pair[0].mean),
                        x2: pair[1].at,
                        y2: inside(pair[1].mean),
                        color: Color::Reset,
                    });
                }
                let alone: Vec<_> = run.iter().map(|point| (point.at, inside(point.mean))).collect();
                context.draw(&Points { coords: &alone, color: Color::Reset });
                for end in [|point: &Point| point.low, |point: &Point| point.high] {
                    let dots = dotted(run, end, across, usize::from(width) * 2);
                    let dots: Vec<_> = dots.into_iter().filter(|(_, y)| (up.0..=up.1).contains(y)).collect();
                    context.draw(&Points { coords: &dots, color: Color::Reset });
                }
            }
        })
        .render(area, &mut buffer);
    buffer
}

/// Dots along one end of the confidence of a run of points.
fn dotted(run: &[Point], end: fn(&Point) -> f64, across: (f64, f64), columns: usize) -> Vec<(f64, f64)> {
    let place = |column: usize| across.0 + (across.1 - across.0) * column as f64 / (columns - 1) as f64;
    let mut dots: Vec<_> = (0..columns)
        .step_by(DISTANCE)
        .filter_map(|column| {
            let x = place(column);
            let pair = run.windows(2).find(|pair| (pair[0].at..=pair[1].at).contains(&x))?;
            let share = (x - pair[0].at) / (pair[1].at - pair[0].at);
            Some((x, end(&pair[0]) + share * (end(&pair[1]) - end(&pair[0]))))
        })
        .collect();
    if let [point] = run {
        dots.push((point.at, end(point)));
    }
    dots
}
