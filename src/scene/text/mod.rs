//! Text of RON values: places by path, and edits that keep the comments. Independent of the fields of a scene.
//!
//! [`Text::span`] finds an entry; [`Text::replace`], [`Text::insert`] and [`Text::remove`] return a new text.

mod edit;
mod literal;
mod outline;
mod scan;

pub(super) use edit::one_value;
pub use literal::{ron_float, ron_string};
pub use outline::{Span, Text, line_column};
pub(super) use outline::{is_within, offset_of};
pub use scan::Unreadable;
