//! Figures: one model of charts, drawn as SVG, as PNG or in the cells of a terminal.
//!
//! A [`Figure`] holds [`Chart`]s, a chart two [`Axis`] and [`Layer`]s of data in SI units. Ticks, SI prefixes,
//! typeset symbols and the legend are derived from them, the same for every backend.

mod axis;
#[cfg(feature = "tui")]
mod cells;
mod chart;
mod colour;
mod contour;
mod label;
mod picture;
mod scale;
pub mod section;
mod ticks;

pub use axis::Axis;
#[cfg(feature = "tui")]
pub use cells::{CellPlot, CellStyle, Colours, SHADES, dry, figure_text, glyph, key, legend};
pub use chart::{Chart, Class, Contour, Entry, Figure, HeatMap, Layer, Sample, Shape, Sign, Stroke};
pub use colour::{Ink, Palette, Rgb, hex, ink_on, shade};
pub use label::{Label, prefixed, short, value_label};
pub use picture::{Document, escaped};
#[cfg(feature = "tui")]
pub(crate) use picture::{Font, Pixels};
#[cfg(feature = "tui")]
pub use picture::{PictureFormat, PngError};
pub use scale::{AxisScale, Span};
pub use ticks::Tick;

#[cfg(test)]
pub(crate) use picture::tests as svg_tests;
