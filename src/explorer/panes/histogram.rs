//! The histogram of heights beside the profile, on the same axis.

use crate::draw::Span;
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::format_rounded;
use crate::surface::Histogram;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::{Block, Borders, Paragraph};

const EIGHTHS: [char; 8] = ['▏', '▎', '▍', '▌', '▋', '▊', '▉', '█'];

/// Draws one bar for each row, the share of heights in the row, and behind the bars the bell curve of the
/// same mean and rms height; in the row of `numbers`, the share of heights of the longest bar.
pub fn draw(
    frame: &mut Frame<'_>,
    area: Rect,
    numbers: Option<u16>,
    histogram: Option<&Histogram>,
    z: Span,
    theme: Theme,
) {
    let block = Block::new().borders(Borders::LEFT).border_style(theme.style(Meaning::Quiet));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let Some(histogram) = histogram else { return };
    let rows = shares(histogram, z, usize::from(inner.height));
    let bell = bell(histogram, z, usize::from(inner.height));
    let most = rows.iter().chain(&bell).copied().fold(0.0, f64::max);
    if most <= 0.0 {
        return;
    }
    let width = usize::from(inner.width);
    for (row, (share, bell)) in (inner.y..).zip(rows.into_iter().zip(bell)) {
        let bar = bar(share / most, width);
        let place = ((bell / most * width as f64) as usize).min(width.saturating_sub(1));
        let mut spans = vec![Text::styled(bar.clone(), theme.style(Meaning::Line))];
        if bell > 0.0 && place >= bar.chars().count() {
            spans.push(Text::raw(" ".repeat(place - bar.chars().count())));
            spans.push(Text::styled("¦", theme.style(Meaning::Surface)));
        }
        frame.render_widget(Paragraph::new(Line::from(spans)), Rect { y: row, height: 1, ..inner });
    }
    let all: u64 = histogram.counts.iter().sum();
    let longest = format_rounded(100.0 * most / all as f64, 2, "1");
    if let Some(y) = numbers {
        let (row, quiet) = (Rect { y, height: 1, ..inner }, theme.style(Meaning::Quiet));
        frame.render_widget(Paragraph::new(Line::styled("0", quiet)), row);
        frame.render_widget(Paragraph::new(Line::styled(format!("{longest} %"), quiet).right_aligned()), row);
    }
}

/// Number of heights in each row, top row first, of a normal distribution with the mean and the rms height
/// of the histogram.
fn bell(histogram: &Histogram, z: Span, rows: usize) -> Vec<f64> {
    let bin = (histogram.high - histogram.low) / histogram.counts.len() as f64;
    let heights = || {
        let middle = |index: usize| histogram.low + bin * (index as f64 + 0.5);
        histogram.counts.iter().enumerate().map(move |(index, &count)| (middle(index), count as f64))
    };
    let count: f64 = heights().map(|(_, count)| count).sum();
    let mean = heights().map(|(height, count)| height * count).sum::<f64>() / count;
    let variance = heights().map(|(height, count)| (height - mean).powi(2) * count).sum::<f64>() / count;
    let row = (z.high - z.low) / rows as f64;
    let scale = (2.0 * variance).sqrt();
    if !(scale > 0.0 && row > 0.0 && scale.is_finite() && row.is_finite()) {
        return vec![0.0; rows];
    }
    let below = |height: f64| 0.5 * libm::erfc((mean - height) / scale);
    let top = |index: usize| z.high - row * index as f64;
    (0..rows).map(|index| count * (below(top(index)) - below(top(index + 1)))).collect()
}

/// Number of heights in each row, top row first; a bin is spread evenly over the rows it covers.
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
    fn the_bell_has_the_mean_and_rms_of_the_heights() {
        let histogram = Histogram { low: -2.0, high: 2.0, counts: vec![10, 30, 30, 10] };
        let z = Span { low: -8.0, high: 8.0 };
        let rows = bell(&histogram, z, 1600);
        let height = |row: usize| 8.0 - (row as f64 + 0.5) / 100.0;
        let moment = |power: i32| -> f64 {
            rows.iter().enumerate().map(|(row, share)| share * height(row).powi(power)).sum::<f64>() / 80.0
        };
        assert!((moment(0) - 1.0).abs() < 1e-9 && moment(1).abs() < 1e-9);
        // (20 · 1.5² + 60 · 0.5²) / 80
        assert!((moment(2) - 0.75).abs() < 1e-4, "{}", moment(2));
        let flat = Histogram { low: 1.0, high: 1.0, counts: vec![3] };
        assert_eq!(bell(&flat, z, 2), [0.0, 0.0]);
    }

    #[test]
    fn bars_have_eighths_of_a_cell() {
        assert_eq!(bar(0.0, 4), "");
        assert_eq!(bar(0.001, 4), "▏");
        assert_eq!(bar(0.5, 3), "█▌");
        assert_eq!(bar(1.0, 2), "██");
    }
}
