//! The row of a pane: everything that layout, drawing, keys and mouse need to know of the pane.

use crate::explorer::model::Model;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// One pane. Areas are those of the whole pane, frame included.
pub struct PaneRow {
    /// Title in the frame.
    pub title: fn(&Model) -> String,
    /// Draws the inside.
    pub draw: fn(&mut Frame<'_>, Rect, &Model),
    /// Text in the lower edge of the frame.
    pub edge: fn(&Model, Rect) -> Option<Line<'static>>,
    /// True if the crosshair can be moved in the pane.
    pub has_crosshair: bool,
    /// Paragraphs of the help: a name and the meaning of the signs in the pane.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// A pane that shows nothing.
    pub const EMPTY: PaneRow = PaneRow {
        title: |_| String::new(),
        draw: |_, _, _| (),
        edge: |_, _| None,
        has_crosshair: false,
        help: &[],
    };
}
