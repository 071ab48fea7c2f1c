//! Scenes: read from RON, checked, and changed field by field.
//!
//! [`open()`](crate::open) returns a [`Document`](crate::Document), which is a checked
//! [`Scene`](crate::Scene) with its text. [`FIELDS`](fields::FIELDS) is the table of all fields of
//! a scene.
//!
//! ```
//! let sphere = asperity_scene::open("jkr-sphere")?;
//! let stickier = sphere.set("adhesion.work", "0.1")?;
//! assert_eq!(stickier.value("adhesion.work"), Some("0.1"));
//!
//! let refused = sphere.set("adhesion.work", "-0.1").unwrap_err();
//! assert_eq!(refused.first().allowed, "from 0 to 1e6 J/m²");
//! # Ok::<(), asperity_scene::SceneErrors>(())
//! ```

pub(crate) mod adhesion;
pub(crate) mod changes;
pub(crate) mod check;
pub(crate) mod checked;
pub(crate) mod command;
pub(crate) mod defaults;
pub(crate) mod description;
pub(crate) mod document;
pub(crate) mod edit;
pub(crate) mod effects;
pub(crate) mod errors;
pub(crate) mod field;
pub(crate) mod fields;
pub(crate) mod library;
pub(crate) mod measured;
pub(crate) mod model;
pub(crate) mod numbers;
pub(crate) mod open;
pub(crate) mod range;
pub(crate) mod read;
pub(crate) mod slot;
pub(crate) mod spheres;
pub(crate) mod stages;
pub(crate) mod statements;
pub(crate) mod step;
pub(crate) mod switch;
pub(crate) mod text;
pub(crate) mod typed;
pub(crate) mod written;
