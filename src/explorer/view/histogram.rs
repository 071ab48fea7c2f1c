//! The histogram of heights beside the profile, on the same axis.

use super::plot::Span;
use crate::explorer::theme::{Meaning, Theme};
use crate::surface::Histogram;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Block, Borders, Paragraph};

const EIGHTHS: [char; 8] = ['▏', '▎', '▍', '▌', '▋', '▊', '▉', '█'];

/// Draws one bar for each row: the share of heights that lie in it.
pub fn draw(frame: &mut Frame<'_>, area: Rect, histogram: Option<&Histogram>, z: Span, theme: Theme) {
    let block = Block::new().borders(Borders::LEFT).border_style(theme.style(Meaning::Quiet));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let Some(histogram) = histogram else { return };
    let rows = shares(histogram, z, usize::from(inner.height));
    let most = rows.iter().copied().fold(0.0, f64::max);
    for (row, share) in (inner.y..).zip(rows) {
        if most > 0.0 {
            let line = Line::styled(bar(share / most, usize::from(inner.width)), theme.style(Meaning::Line));
            frame.render_widget(Paragraph::new(line), Rect { y: row, height: 1, ..inner });
        }
    }
}

/// The heights that fall into each row, top row first; a bin is spread evenly over the rows it covers.
fn shares(histogram: &Histogram, z: Span, rows: usize) -> Vec<f64> {
    let mut shares = vec![0.0; rows];
    let bin = (histogram.high - histogram.low) / histogram.counts.len() as f64;
    let row = (z.high - z.low) / rows as f64;
    if !(row > 0.0 && row.is_finite()) {
        return shares;
    }
    for (index, &count) in histogram.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let low = histogram.low + bin * index as f64;
        let place = |height: f64| ((z.high - height) / row).max(0.0);
        let (top, bottom) = (place(low + bin), place(low));
        if bottom - top < 1e-9 {
            if let Some(share) = shares.get_mut(top as usize) {
                *share += count as f64;
            }
            continue;
        }
        for (number, share) in shares.iter_mut().enumerate().take(bottom.ceil() as usize).skip(top as usize) {
            let covered = (number as f64 + 1.0).min(bottom) - (number as f64).max(top);
            *share += count as f64 * covered.max(0.0) / (bottom - top);
        }
    }
    shares
}

/// A bar over a share of `width` cells; anything above zero shows.
fn bar(share: f64, width: usize) -> String {
    let eighths = (share * 8.0 * width as f64).round() as usize;
    let eighths = if share > 0.0 { eighths.max(1) } else { 0 };
    let mut bar = "█".repeat(eighths / 8);
    if eighths % 8 > 0 {
        bar.push(EIGHTHS[eighths % 8 - 1]);
    }
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_heights_are_spread_over_the_rows() {
        let histogram = Histogram { low: 0.0, high: 1.0, counts: vec![4, 0, 2, 2] };
        let rows = shares(&histogram, Span { low: 0.0, high: 1.0 }, 2);
        assert_eq!(rows, [4.0, 4.0]);
        let rows = shares(&histogram, Span { low: -1.0, high: 2.0 }, 3);
        assert_eq!(rows, [0.0, 8.0, 0.0]);
        let point = Histogram { low: 0.5, high: 0.5, counts: vec![3, 0] };
        assert_eq!(shares(&point, Span { low: 0.0, high: 1.0 }, 4), [0.0, 0.0, 3.0, 0.0]);
    }

    #[test]
    fn bars_have_eighths_of_a_cell() {
        assert_eq!(bar(0.0, 4), "");
        assert_eq!(bar(0.001, 4), "▏");
        assert_eq!(bar(0.5, 3), "█▌");
        assert_eq!(bar(1.0, 2), "██");
    }
}
