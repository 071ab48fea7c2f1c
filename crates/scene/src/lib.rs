#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Scenes: [`open`] returns a [`Document`], which is a [`Scene`] with its text. [`presets`]
//!   returns the built-in scenes as [`Preset`]s. The fields of a scene have the types [`Material`],
//!   [`Adhesion`] ([`Strength`], [`RoughnessParameter`]), [`Roughness`] ([`Measured`]),
//!   [`Numerics`] ([`Solver`]) and [`Observer`].
//! * Computing: [`run`] computes the scene of one document. A [`Simulation`] computes many
//!   [`CheckedScene`]s. [`ProfileBuilder`] makes a profile and computes its loading for programs
//!   that have no scene.
//! * Results: an [`Outcome`] has all results, among them the [`Governing`] parameters and the
//!   [`Regime`]. [`estimate`] returns an [`Estimate`] of the error that the finite number of
//!   springs causes in an outcome.
//! * Errors: [`SceneErrors`] has one [`SceneError`], with its [`Origin`], for each invalid value.
//!   [`RunError`] is an error of the computation. [`Error`] includes both.
//!
//! The modules are for programs with special tasks. Editors of scenes use [`fields`], [`text`],
//! [`loading`] and [`library`]. The number of springs is chosen with [`discretisation`]. Results
//! are compared with [`instrument`] and [`theory`]. The progress of a computation is shown with
//! [`workload`].

mod accuracy;
mod analysis;
mod error;
mod front;
mod profile_builder;
mod reference;
mod scene;
mod simulation;

pub use accuracy::estimate::{Estimate, estimate};
pub use analysis::governing::Governing;
pub use analysis::regime::Regime;
pub use error::Error;
pub use front::run;
pub use profile_builder::ProfileBuilder;
pub use scene::adhesion::{Adhesion, RoughnessParameter, Strength};
pub use scene::checked::CheckedScene;
pub use scene::document::Document;
pub use scene::errors::{Origin, SceneError, SceneErrors};
pub use scene::library::{Preset, presets};
pub use scene::measured::Measured;
pub use scene::model::{
    Material, MaterialRelaxation, Numerics, Observer, Roughness, SPRINGS_PER_WAVE, Scene, Solver,
};
pub use scene::open::open;
pub use simulation::outcome::{Outcome, RunError};
pub use simulation::stages::Simulation;

pub use asperity_data::Warning;

/// Finds the number of springs that a tolerance needs ([`choose`](discretisation::choose)), and
/// measures how the computing time grows if the tolerance is smaller
/// ([`measure`](discretisation::measure)).
pub mod discretisation {
    pub use crate::accuracy::choice::{Choice, ChoiceError, choose, parse_tolerance};
    pub use crate::accuracy::estimate::Evidence;
    pub use crate::accuracy::ladder::{Progress, measure};
    pub use crate::accuracy::solution::Target;
    pub use crate::accuracy::table::{CostReference, CostTable, ErrorFigure, Knob, Row, Timing};
}

/// The table [`FIELDS`](fields::FIELDS) describes each field of a scene: name, unit and allowed
/// range. [`Scene::number`] and [`Scene::set_number`] read and set a number of a scene by the path
/// of its field.
pub mod fields {
    pub use crate::scene::changes::Change;
    pub use crate::scene::effects::Effect;
    pub use crate::scene::errors::NumberError;
    pub use crate::scene::field::{
        Field, SPHERE_FIELDS, STAGE, STAGE_FIELDS, STAGE_FORCE, STAGE_INDENTATION, Step,
        choice_in_words, sphere_values, target_field,
    };
    pub use crate::scene::fields::{FIELDS, field};
    pub use crate::scene::range::Range;
    pub use crate::scene::statements::{Statement, statements};
}

/// Reads, writes and edits the text of scenes in RON; edits keep the comments. Other functions
/// write the shell command that opens a scene, and find the name that a misspelt name probably
/// means.
pub mod text {
    pub use crate::scene::command::quoted;
    pub use crate::scene::errors::{did_you_mean, nearest};
    pub use crate::scene::read::explain;
    pub use crate::scene::text::index::{Text, TextSpan, line_column};
    pub use crate::scene::text::{read_ron, ron_float, ron_string};
    pub use crate::scene::typed::LONGEST_TEXT;
    pub use crate::scene::written::to_ron;
}

/// Reads and writes loading stages as text, such as `100 µN, separation`.
pub mod loading {
    pub use crate::scene::stages::{
        StageKind, loading_text, pressing_force, read_loading, read_stage, stage_in_ron,
    };
}

/// Finds scenes by name: built-in scenes, the user's own scenes, and scenes in a folder.
pub mod library {
    pub use crate::scene::library::{
        DEFAULT, Entry, Source, find_scene, is_plan, own_folder, scenes, typed_path,
    };
    pub use crate::scene::open::{is_file_name, is_path, open_argument};
}

/// Results of theories for comparison with the model. The module has closed forms for smooth bodies
/// and the Everett function. It also checks whether the waves of a wavy sphere are too steep for
/// the rule of Hess.
pub mod theory {
    pub use crate::analysis::governing::SteepWaves;
    pub use crate::analysis::reversal_map::ReversalMap;
    pub use crate::reference::closed_form;
}

/// Force as a function of the displacement of an instrument of finite stiffness that moves the
/// body.
pub mod instrument {
    pub use crate::analysis::instrument::{
        DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements,
    };
}

/// Parts of the computation of a scene, with their times and memory.
pub mod workload {
    pub use crate::simulation::loading::AfterStage;
    pub use crate::simulation::outcome::{LineFacts, Timings};
    pub use crate::simulation::reach::{BeyondFullContact, Reach};
    pub use crate::simulation::roughness::equivalent_springs;
    pub use crate::simulation::workload::{PlannedPart, WorkPart, Workload};
}
