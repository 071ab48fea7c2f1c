//! Axes beside a plot: the values at their ends, and zero where it fits between them.

use super::plot::Span;
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::format_quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::widgets::Paragraph;

/// Columns for the values beside a plot.
const GUTTER: u16 = 9;

/// One axis: what it spans, in which unit, and its symbol.
#[derive(Clone, Copy)]
pub struct Axis {
    pub span: Span,
    pub unit: &'static str,
    pub symbol: &'static str,
}

impl Axis {
    /// A value on it, to three digits: an axis needs no more.
    fn label(&self, value: f64) -> String {
        format_quantity(format!("{value:.2e}").parse().unwrap_or(value), self.unit)
    }
}

/// Where plot and axes go in a pane, below `above` rows of text.
pub struct Places {
    pub plot: Rect,
    row: Option<Rect>,
    column: Option<Rect>,
}

impl Places {
    /// The places in a pane.
    pub fn within(area: Rect, above: u16) -> Self {
        let above = above.min(area.height);
        let row_height = u16::from(area.height >= 5);
        let gutter = if area.width >= 30 && area.height >= 6 { GUTTER } else { 0 };
        let plot = Rect {
            x: area.x + gutter,
            y: area.y + above,
            width: area.width - gutter,
            height: area.height.saturating_sub(row_height + above),
        };
        Places {
            plot,
            row: (row_height > 0).then(|| Rect { y: plot.bottom(), height: 1, ..plot }),
            column: (gutter > 0).then_some(Rect { x: area.x, width: gutter, ..plot }),
        }
    }

    /// Draws the axes.
    pub fn draw(&self, frame: &mut Frame<'_>, x: Axis, y: Axis, theme: Theme) {
        if let Some(row) = self.row.filter(|row| row.width > 0) {
            horizontal(frame, row, x, theme);
        }
        if let Some(column) = self.column.filter(|column| column.height > 0) {
            vertical(frame, column, y, theme);
        }
    }
}

fn vertical(frame: &mut Frame<'_>, column: Rect, axis: Axis, theme: Theme) {
    let Span { low, high } = axis.span;
    let zero = (high / (high - low) * f64::from(column.height)) as u16;
    let last = column.height - 1;
    let mut label = |row: u16, text: String| {
        let place = Rect { y: column.y + row, height: 1, width: column.width - 1, ..column };
        frame.render_widget(Paragraph::new(text).right_aligned().style(theme.style(Meaning::Quiet)), place);
    };
    label(0, axis.label(high));
    if last > 0 {
        label(last, axis.label(low));
    }
    if (2..last.saturating_sub(1)).contains(&zero) && low < 0.0 {
        label(zero, format!("{} = 0", axis.symbol));
    }
}

fn horizontal(frame: &mut Frame<'_>, row: Rect, axis: Axis, theme: Theme) {
    let quiet = theme.style(Meaning::Quiet);
    let Span { low, high } = axis.span;
    let ends = [axis.label(low), axis.label(high)];
    let width = |text: &str| text.chars().count() as u16;
    let zero = (-low / (high - low) * f64::from(row.width)).floor();
    let right = Rect { x: row.right().saturating_sub(width(&ends[1])), width: width(&ends[1]), ..row };
    if right.x > row.x + width(&ends[0]) {
        frame.render_widget(Paragraph::new(ends[1].clone()).style(quiet), right.intersection(row));
    }
    frame.render_widget(
        Paragraph::new(ends[0].clone()).style(quiet),
        Rect { width: width(&ends[0]).min(row.width), ..row },
    );
    let label = format!("{} = 0", axis.symbol);
    let start = f64::from(row.x) + zero - 2.0;
    let fits = start > f64::from(row.x + width(&ends[0]) + 1)
        && start + f64::from(width(&label)) + 1.0 < f64::from(right.x);
    if fits {
        let place = Rect { x: start as u16, width: width(&label), ..row };
        frame.render_widget(Paragraph::new(label).style(quiet), place.intersection(row));
    }
}
