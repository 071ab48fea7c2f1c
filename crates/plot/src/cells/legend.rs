//! Legends of charts in terminal cells.

use super::glyph::glyph;
use crate::chart::{Chart, Entry, Sample, Stroke};
use crate::colour::Ink;
use crate::label::Label;
use crate::palette::Palette;
use ratatui::text::Span as Text;

/// Returns the three characters, from left to right, that show a line in the legend.
fn strokes(stroke: Stroke) -> [&'static str; 3] {
    match stroke {
        Stroke::Solid => ["⠒"; 3],
        Stroke::Dashed => ["⠒", "⠂", "⠒"],
        Stroke::Dotted => ["⠒", " ", "⠒"],
        Stroke::DashDotted => ["⠒", "⠐", "⠒"],
        Stroke::Sparse => ["⠂", " ", "⠂"],
    }
}

fn text_of(sample: Sample, ink: Ink, palette: Palette) -> String {
    match sample {
        Sample::Line(stroke, sign) => {
            let [left, middle, right] = stroke.map_or(["", "", ""], strokes);
            format!("{left}{}{right}", sign.map_or(middle, glyph))
        }
        // The area has as few dots as in the chart.
        Sample::Area if ink == Ink::Quiet => "⡀⠄⠂".to_owned(),
        Sample::Area => "⠪⠕⠪".to_owned(),
        Sample::Solid => "■".to_owned(),
        Sample::Guide => "┊".to_owned(),
        Sample::Contour if palette.has_shades() => "▀▀".to_owned(),
        Sample::Contour => "▁▕".to_owned(),
        Sample::Empty => "blank:".to_owned(),
    }
}

/// Returns the entries of the legend of these charts for a terminal. Each entry is a list of
/// coloured texts: first a short piece of the line or the marker of each layer, and then the name
/// that these layers share.
pub fn legend(charts: &[Chart], palette: Palette) -> Vec<Vec<Text<'static>>> {
    let mut parts = Vec::new();
    for entry in Entry::of_charts(charts) {
        let letter = letter_of_class(charts, &entry.name);
        let mut part: Vec<Text<'static>> = Vec::new();
        for (ink, sample) in entry.samples {
            let text = match (sample, letter) {
                (Sample::Line(..), Some(letter)) => letter.to_string(),
                (sample, _) => text_of(sample, ink, palette),
            };
            if part.last().is_none_or(|last| *last.content != text) {
                part.push(Text::styled(text, palette.ink(ink)));
            }
        }
        part.push(Text::raw(format!(" {}", entry.name)));
        parts.push(part);
    }
    parts
}

/// Returns the letter that marks the class of this name in the cells of a map; `None` if the class
/// has no letter.
fn letter_of_class(charts: &[Chart], name: &Label) -> Option<char> {
    for map in charts.iter().filter_map(Chart::map) {
        for class in &map.class_names {
            if Label::plain(&class.name) == *name {
                return class.letter;
            }
        }
    }
    None
}
