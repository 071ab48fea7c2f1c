#![forbid(unsafe_code)]
#![doc = include_str!("../README.md")]

mod axis;
mod cells;
mod chart;
mod colour;
mod contour;
#[cfg(any(test, feature = "testing"))]
pub mod judge;
mod label;
mod palette;
mod pdf;
mod pdf_font;
mod png;
mod scale;
mod screen;
mod svg;
mod ticks;

pub use axis::ChartAxis;
pub use cells::legend::legend;
pub use cells::map::{SHADES, key, shade_of};
pub use cells::pane::{ContactRow, PaneChart, contact_signs, split};
pub use cells::plot::{CellPlot, Name};
pub use cells::text::figure_text;
pub use chart::{Chart, Class, Contour, Figure, HeatMap, Layer, Shape, Sign, StressFill, Stroke};
pub use colour::{Ink, Rgb, Shades};
pub use label::{Label, prefixed, statement, value_label};
pub use palette::{Background, ColourRole, Colours, Palette};
pub use pdf::pdf_of_svg;
pub use png::png_of_svg;
pub use scale::Span;
pub use screen::ascii::to_ascii;
pub use screen::screen_text;
pub use screen::svg::screen_svg;
