//! Figures: one model of charts, drawn as SVG, PNG, PDF or in the cells of a terminal.
//!
//! A [`Figure`] holds [`Chart`]s, a chart two [`Axis`] and [`Layer`]s of data in SI units. Ticks, SI prefixes,
//! typeset symbols and the legend are derived from them, the same for every backend.

mod axis;
#[cfg(feature = "tui")]
mod cells;
mod chart;
mod colour;
mod contour;
#[cfg(test)]
mod judge;
mod label;
#[cfg(feature = "tui")]
mod pdf;
#[cfg(feature = "tui")]
mod png;
mod scale;
mod svg;
mod ticks;

pub use axis::Axis;
#[cfg(feature = "tui")]
pub use cells::{CellPlot, CellStyle, Colours, SHADES, figure_text, glyph, key, legend};
pub use chart::{Chart, Class, Contour, Figure, HeatMap, Layer, Shape, Sign, Stroke};
pub use colour::{Ink, Palette, Rgb, Shades, hex};
pub use label::{Label, prefixed, statement, value_label};
pub use scale::{AxisScale, Span};
#[cfg(feature = "tui")]
pub(crate) use svg::{Svg, escaped};

#[cfg(test)]
pub(crate) use judge::{check_picture, parsed};
