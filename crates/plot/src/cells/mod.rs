//! Charts in the cells of a terminal: the panes of the explorer and the text of `sweep plot`.

pub(crate) mod glyph;
pub(crate) mod legend;
pub(crate) mod map;
pub(crate) mod pane;
pub(crate) mod plot;
pub(crate) mod shapes;
pub(crate) mod text;
