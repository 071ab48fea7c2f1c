//! Figures of sweeps: maps and sections, as pictures in SVG and as text for a terminal.
//!
//! The same results give the same bytes.

mod canvas;
mod contour;
mod frame;
mod label;
mod legend;
mod map;
mod section;
mod shades;
mod text;
mod text_map;
mod text_section;
mod ticks;

pub use text::{Colours, figure_text};

use crate::sweep::figure::Figure;
use canvas::{Anchor, Canvas, Place, picture};
use frame::LABEL;

/// Size of the rectangle of a panel, px.
const PANEL: (f64, f64) = (330.0, 270.0);
/// Room on the left and below a panel for its axes.
const AXES: (f64, f64) = (78.0, 50.0);
/// Room on the right of a map for its scale of colours, and of a section.
const SCALE: f64 = 104.0;
const BESIDE: f64 = 22.0;
/// Size of the title, px.
const TITLE: f64 = 14.5;

/// A figure as SVG.
#[must_use]
pub fn figure_svg(figure: &Figure) -> String {
    let beside = if figure.up.is_some() { SCALE } else { BESIDE };
    let wide = AXES.0 + PANEL.0 + beside;
    let draw_legend = if figure.up.is_some() { map::legend } else { section::legend };
    let legend = draw_legend(None, figure, (0.0, 0.0));
    let panels = figure.panels.len().max(1);
    let width = (panels as f64 * wide).max(legend + 40.0);
    let title = wrapped(&figure.title, TITLE, width - 24.0);
    let fixed = wrapped(&figure.fixed.join(", "), LABEL - 1.0, width - 24.0);
    let letters = if panels > 1 { 22.0 } else { 6.0 };
    let top = 12.0 + title.len() as f64 * 20.0 + fixed.len() as f64 * 18.0 + letters;
    let bottom = top + PANEL.1 + AXES.1;
    let height = bottom + if legend > 0.0 { 30.0 } else { 6.0 };
    let middle = width / 2.0;
    picture(width, height, |canvas| {
        let mut y = 20.0;
        for line in &title {
            canvas.text(line, (middle, y), TITLE, Anchor::Middle);
            y += 20.0;
        }
        for line in &fixed {
            canvas.text(&label::symbol_before(line), (middle, y - 1.0), LABEL - 1.0, Anchor::Middle);
            y += 18.0;
        }
        let left = (width - panels as f64 * wide) / 2.0 + AXES.0;
        for (index, panel) in figure.panels.iter().enumerate() {
            let from: Place = (left + index as f64 * wide, top);
            let to = (from.0 + PANEL.0, from.1 + PANEL.1);
            if panels > 1 {
                let letter = char::from(b'a' + (index % 26) as u8);
                let heading = format!("({letter}) {}", panel.quantity.name);
                canvas.text(&heading, (from.0, from.1 - 12.0), LABEL, Anchor::Left);
            }
            draw_panel(canvas, figure, panel, (from, to));
        }
        if legend > 0.0 {
            draw_legend(Some(canvas), figure, ((width - legend) / 2.0, bottom + 12.0));
        }
    })
}

fn draw_panel(
    canvas: &Canvas<'_>,
    figure: &Figure,
    panel: &crate::sweep::figure::Panel,
    place: (Place, Place),
) {
    match &figure.up {
        Some(up) => map::draw(canvas, figure, up, panel, place),
        None => section::draw(canvas, figure, panel, place),
    }
}

/// Lines of words that are no wider than this.
fn wrapped(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if (label::width(line) + label::width(word) + 0.33) * size <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod examples;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn look() {
        for (name, figure) in [("map", examples::phase_map()), ("section", examples::sections())] {
            std::fs::write(format!("/tmp/mapscratch/{name}.svg"), figure_svg(&figure)).unwrap();
            std::fs::write(format!("/tmp/mapscratch/{name}.txt"), figure_text(&figure, 80, Colours::None)).unwrap();
        }
    }
}
