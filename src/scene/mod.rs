//! The scene: what its author chose, read from RON, checked, and changed field by field.
//!
//! [`open`] gives a [`Document`]: a checked [`Scene`] with the text it came from. [`FIELDS`] is the
//! table of everything a scene can say; the checks, overrides and the explorer read it.
//!
//! ```
//! use asperity::scene;
//!
//! let sphere = scene::open("jkr-sphere")?;
//! let stickier = sphere.set("adhesion.work", "0.1")?;
//! assert_eq!(stickier.value("adhesion.work"), Some("0.1"));
//!
//! let refused = sphere.set("adhesion.work", "-0.1").unwrap_err();
//! assert_eq!(refused.first().allowed, "from 0 to 1e6 J/m²");
//! # Ok::<(), scene::SceneErrors>(())
//! ```

mod blame;
mod bring_back;
mod check;
mod consistency;
mod derived;
mod document;
mod effects;
mod errors;
mod field;
mod fields;
mod library;
mod locate;
mod model;
mod overrides;
mod presets;
mod quantity;
mod range;
mod read;
mod scan;
mod search;
mod splice;
mod step;
#[cfg(test)]
// Integration tests include the file and use the rest.
#[allow(dead_code)]
mod strategies;
mod suggest;
mod switch;
mod value;
mod write;

pub use crate::text::is_control;
pub use check::{Violation, check};
pub use document::{Document, LONGEST_TEXT};
pub use effects::Effect;
pub use errors::{Origin, SceneError, SceneErrors};
pub use field::{Field, Step};
pub use fields::{FIELDS, LEG_FORCE, LEG_INDENTATION, MOST_POINTS, field};
pub use library::{Entry, Library, MOST_BYTES, MOST_FILES, Source, typed_path};
pub use locate::{Place, line_column, locate};
pub use model::*;
pub use overrides::command_line;
pub(crate) use overrides::quoted;
pub(crate) use presets::read_file;
pub use presets::{DEFAULT, Preset, find, open, open_argument, presets};
pub use quantity::{QuantityError, format_quantity, parse_quantity};
pub use range::{End, Range};
pub(crate) use read::told_otherwise;
pub use search::search;
pub(crate) use suggest::nearest;
pub use switch::Computed;
pub use value::Value;
pub use write::{ron_float, ron_string, to_ron};
