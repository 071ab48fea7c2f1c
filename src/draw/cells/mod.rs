//! Charts in the cells of a terminal: the panes of the explorer and the text of `sweep plot`.

mod legend;
mod map;
mod plot;
mod shapes;
mod style;
mod text;

pub use legend::legend;
pub use map::{SHADES, key};
pub use plot::CellPlot;
pub use style::{CellStyle, Colours, glyph};
pub use text::figure_text;
