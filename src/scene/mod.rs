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

mod adhesion;
mod changes;
mod check;
mod checked;
mod command;
mod document;
mod edit;
mod effects;
mod errors;
mod field;
mod fields;
mod library;
mod measured;
mod model;
mod open;
mod quantity;
mod range;
mod read;
mod stages;
mod statements;
mod step;
mod switch;
mod text;
mod tree;

pub use crate::surface::Form;
pub use crate::text::is_control;
pub use adhesion::{Adhesion, RoughnessParameter, Strength};
pub use changes::Change;
pub use checked::CheckedScene;
pub use command::command_line;
pub(crate) use command::quoted;
pub use document::{Document, LONGEST_TEXT};
pub use effects::Effect;
pub use errors::{Origin, SceneError, SceneErrors};
pub(crate) use errors::{did_you_mean, nearest};
pub use field::{Field, LEG_FIELDS, LEG_FORCE, LEG_INDENTATION, Step, target_field};
pub(crate) use field::{STAGE, choice_in_words};
pub use fields::{FIELDS, MOST_POINTS, SCENE_VERSION, field};
pub(crate) use library::built_in;
pub use library::{DEFAULT, Entry, Preset, Source, find, own_folder, presets, scenes, typed_path};
pub use measured::Measured;
pub use model::*;
pub(crate) use open::{is_file_name, is_path};
pub use open::{open, open_argument};
pub use quantity::{QuantityError, exact_quantity, format_quantity, parse_quantity};
pub(crate) use quantity::{format_range, format_rounded, format_within, in_unit, one_unit, unit_of};
pub use range::Range;
pub(crate) use read::explain;
pub(crate) use stages::{STAGE_KINDS, StageKind, kind_and_number, pressing_force, read_stage, stage_in_ron};
pub use stages::{loading_text, read_loading};
pub(crate) use statements::{Statement, statements};
pub(crate) use text::read_ron;
pub use text::{Span, Text, Unreadable, line_column, ron_float, ron_string};
pub use tree::{Tree, to_ron};
