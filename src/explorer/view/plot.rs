//! Charts in panes, in the colours of a theme.

use super::wrap::fitting;
use crate::draw::{CellPlot, CellStyle, Chart, Colours, Ink};
use crate::explorer::theme::{Appearance, Meaning};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};

/// Meaning of an ink on the screen.
pub fn meaning(ink: Ink) -> Meaning {
    match ink {
        Ink::Text => Meaning::Title,
        Ink::Quiet => Meaning::Quiet,
        Ink::Profile => Meaning::Line,
        Ink::Surface => Meaning::Surface,
        Ink::Contact => Meaning::Contact,
        Ink::Loading => Meaning::Approach,
        Ink::Unloading => Meaning::Retraction,
        Ink::Manual => Meaning::Manual,
        Ink::Kept => Meaning::Ghost,
        // The colours not used by the present curve.
        Ink::Compared(number) => {
            [Meaning::Surface, Meaning::Manual, Meaning::Text, Meaning::Ghost][number % 4]
        }
        Ink::Cursor => Meaning::Cursor,
        Ink::Series(number) => {
            let all = [
                Meaning::Retraction,
                Meaning::Surface,
                Meaning::Manual,
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

/// As many parts as fit on the lower edge of a frame of this width, apart from its corners.
pub fn on_frame(parts: Vec<Vec<Text<'static>>>, width: u16) -> Line<'static> {
    let room = usize::from(width).saturating_sub(4);
    let mut line = spaced(parts, room);
    if !line.spans.is_empty() {
        line.spans.insert(0, Text::raw(" "));
        line.spans.push(Text::raw(" "));
    }
    line
}

/// As many parts as fit into so many columns: two columns apart where all fit, else one.
pub fn spaced(parts: Vec<Vec<Text<'static>>>, columns: usize) -> Line<'static> {
    let widths: usize = parts.iter().flatten().map(Text::width).sum();
    let between = if widths + 2 * parts.len().saturating_sub(1) <= columns { "  " } else { " " };
    fitting(parts, between, columns)
}
