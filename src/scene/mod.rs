//! The scene: the author's choices, read from RON, checked, and changed field by field.
//!
//! [`open()`] returns a [`Document`]: a checked [`Scene`] with its text. [`FIELDS`] is the table of all fields of a
//! scene, used by the checks, the overrides and the explorer.
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

mod changes;
mod check;
mod choose;
mod computed;
mod document;
mod edit;
mod effects;
mod errors;
mod field;
mod fields;
mod found;
mod library;
mod measured_hash;
mod model;
mod named_file;
mod open;
mod overrides;
mod preloads;
mod presets;
mod provenance;
mod quantity;
mod range;
mod read;
mod roughness_parameter;
mod step;
#[cfg(test)]
#[allow(dead_code, reason = "integration tests use the rest")]
#[path = "../../tests/common/strategies.rs"]
mod strategies;
mod suggest;
mod switch;
mod table_content;
mod text;
mod typed;
mod undo;
mod value;
mod write;

pub use crate::surface::Form;
pub use crate::text::is_control;
pub use changes::Change;
pub use check::check;
pub use computed::Computed;
pub use document::{Document, LONGEST_TEXT};
pub use effects::Effect;
pub use errors::{Origin, SceneError, SceneErrors};
pub use field::{Field, Step};
pub use fields::{FIELDS, LEG_FORCE, LEG_INDENTATION, MOST_POINTS, field};
pub use library::{Entry, Library, MOST_BYTES, MOST_FILES, Source, typed_path};
pub use measured_hash::{MeasuredHash, MeasuredHashError};
pub use model::*;
pub use named_file::named_from;
pub(crate) use open::read_file;
pub use open::{open, open_argument};
pub use overrides::command_line;
pub(crate) use overrides::quoted;
pub use preloads::{PRELOADS, Preloads};
pub use presets::{DEFAULT, Preset, find, presets};
pub use provenance::{Provenance, SpectraTable};
pub(crate) use quantity::format_rounded;
pub use quantity::{QuantityError, exact_quantity, format_quantity, parse_quantity, quantity_as_typed};
pub use range::{End, Range};
pub(crate) use read::describe_error;
pub use roughness_parameter::RoughnessParameter;
pub(crate) use suggest::nearest;
pub use table_content::{ReversalContent, TableContent};
pub use text::{Span, Text, Unreadable, line_column, ron_float, ron_string};
pub use value::Value;
pub use write::to_ron;
