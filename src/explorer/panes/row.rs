//! The row of a pane: all properties of the pane for layout, drawing, keys, mouse and data.

use crate::draw::{CellPlot, Chart, Figure};
use crate::explorer::app::App;
use crate::explorer::mode::ModeKind;
use crate::explorer::snapshot::{Section, SolvedScene};
use crate::explorer::studies::Study;
use crate::explorer::update::Effect;
use ratatui::Frame;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;
use std::sync::Arc;

/// Place of a pane in a window with room for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A place of its own.
    Own,
    /// The place of the close-up.
    CloseUp,
    /// The place of profile and close-up.
    Large,
}

/// Reply of a pane to the mouse at a position inside of its frame.
pub type Reply = fn(&mut App, Rect, Position) -> Vec<Effect>;

/// Section of the profile in a pane, as a chart and its place on the screen.
pub type PlacedSection = for<'m> fn(&'m App, Rect) -> Option<(&'m Section, Chart, CellPlot)>;

/// Properties of one pane. Drawing, title and edge get the area of the whole pane, all others the area inside of the
/// frame.
pub struct PaneRow {
    /// Place in a window with room for all.
    pub place: Place,
    /// Title in the frame.
    pub title: fn(&App) -> String,
    /// Draws the inside.
    pub draw: fn(&mut Frame<'_>, Rect, &App),
    /// Content as a figure for a file; `None` while there is nothing to draw.
    pub figure: fn(&App) -> Option<Figure>,
    /// Text in the lower edge of the frame.
    pub edge: fn(&App, Rect) -> Option<Line<'static>>,
    /// Keys of the selected pane; those of the crosshair, while this is shown.
    pub keys: Option<ModeKind>,
    /// Section of the profile in the pane.
    pub section: Option<PlacedSection>,
    /// Reply to a press, which also selects the pane.
    pub press: Reply,
    /// Reply to a movement with the button down.
    pub drag: Reply,
    /// Reply to turns of the wheel, up positive.
    pub wheel: fn(&mut App, Rect, Position, i32) -> Vec<Effect>,
    /// Studies of a computed scene whose values the shown pane needs.
    pub studies: fn(&App, &Arc<SolvedScene>) -> Vec<Study>,
    /// Paragraphs of the help: a name and the meaning of the signs in the pane.
    pub help: &'static [(&'static str, &'static str)],
}

impl PaneRow {
    /// An empty pane in the place of profile and close-up.
    pub const EMPTY: PaneRow = PaneRow {
        place: Place::Large,
        title: |_| String::new(),
        draw: |_, _, _| (),
        figure: |_| None,
        edge: |_, _| None,
        keys: None,
        section: None,
        press: |_, _, _| vec![Effect::Ask],
        drag: |_, _, _| Vec::new(),
        wheel: |_, _, _, _| Vec::new(),
        studies: |_, _| Vec::new(),
        help: &[],
    };
}
