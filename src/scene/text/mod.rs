//! Text of RON values: places by path, and edits that keep the comments. Independent of the fields of a scene.
//!
//! [`Text::span`] finds a value; [`Text::replace`] and [`Text::insert`] return a new text.

mod edit;
mod index;
mod literal;
mod scan;

pub(super) use edit::one_value;
pub use index::{Span, Text, line_column};
pub(super) use index::{is_within, offset_of};
pub use literal::{ron_float, ron_string};
pub use scan::Unreadable;
