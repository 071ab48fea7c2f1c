//! Charts in panes, in the colours of a theme.

use crate::draw::{Axis, CellPlot, CellStyle, Chart, Colours, Ink, Layer};
use crate::explorer::theme::{Appearance, Meaning};
use ratatui::Frame;
use ratatui::layout::Rect;

/// Meaning of an ink on the screen.
fn meaning(ink: Ink) -> Meaning {
    match ink {
        Ink::Text => Meaning::Title,
        Ink::Quiet => Meaning::Quiet,
        Ink::Profile => Meaning::Line,
        Ink::Surface => Meaning::Surface,
        Ink::Contact => Meaning::Contact,
        Ink::Loading => Meaning::Approach,
        Ink::Unloading => Meaning::Retraction,
        Ink::Manual => Meaning::Hand,
        Ink::Kept => Meaning::Ghost,
        Ink::Cursor => Meaning::Cursor,
        Ink::Series(number) => {
            let all = [
                Meaning::Retraction,
                Meaning::Surface,
                Meaning::Hand,
                Meaning::Approach,
                Meaning::Quiet,
                Meaning::Text,
            ];
            all[number % all.len()]
        }
    }
}

/// Calls `draw` with the look of charts in a theme.
pub fn in_theme<R>(appearance: Appearance, draw: impl FnOnce(&CellStyle<'_>) -> R) -> R {
    let ink = |ink| appearance.theme.style(meaning(ink));
    draw(&CellStyle { marker: appearance.marker.symbols(), ink: &ink, colours: Colours::None })
}

/// Draws a chart with its scales.
pub fn draw_chart(frame: &mut Frame<'_>, area: Rect, chart: &Chart, appearance: Appearance) -> CellPlot {
    let place = CellPlot::within(area, chart);
    in_theme(appearance, |style| place.draw(frame.buffer_mut(), chart, style));
    place
}

/// A chart of a pane, whose title names what is shown.
pub fn chart(x: Axis, y: Axis, layers: Vec<Layer>) -> Chart {
    Chart { heading: String::new(), x, y, layers, inset: None }
}
