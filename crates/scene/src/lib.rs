#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Scenes: [`open`] and [`presets`] return a [`Document`], the text of a [`Scene`], or [`Preset`]s. A scene has [`Material`],
//!   [`Adhesion`] with its [`Strength`] or [`RoughnessParameter`], [`Roughness`], which may be [`Measured`], [`Numerics`] with
//!   the [`Solver`], and [`Observer`]s.
//! * Computing: [`run`] computes a document, [`Simulation`] many [`CheckedScene`]s. [`ProfileBuilder`] needs no scene.
//! * Results: an [`Outcome`] with its [`Governing`] numbers and the [`Regime`]; [`estimate`] returns the [`Estimate`] of its error.
//! * What is refused: [`SceneErrors`] with one [`SceneError`] for each value, their [`Origin`], [`RunError`], and [`Error`] of all.
//!
//! The modules are for programs around a scene: [`fields`], [`text`], [`loading`] and [`library`] for editors,
//! [`discretisation`] for the choice of the number of springs, [`instrument`] and [`theory`] for comparisons, and [`stages`]
//! for the progress of a computation.

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
pub use scene::model::{Material, Numerics, Observer, Roughness, SPRINGS_PER_WAVE, Scene, Solver};
pub use scene::open::open;
pub use simulation::outcome::{Outcome, RunError};
pub use simulation::stages::Simulation;

/// Number of springs: estimated errors, the number for a tolerance, and the cost of smaller errors.
pub mod discretisation {
    pub use crate::accuracy::choice::{Choice, ChoiceError, choose, parse_tolerance};
    pub use crate::accuracy::estimate::Evidence;
    pub use crate::accuracy::ladder::{Progress, measure};
    pub use crate::accuracy::solution::Target;
    pub use crate::accuracy::table::{CostReference, CostTable, ErrorFigure, Knob, Row, Timing};
}

/// Table of the fields of a scene with names, units and ranges, and the values of a scene as a tree.
pub mod fields {
    pub use crate::scene::changes::Change;
    pub use crate::scene::effects::Effect;
    pub use crate::scene::field::{
        Field, LEG_FIELDS, LEG_FORCE, LEG_INDENTATION, STAGE, Step, choice_in_words, target_field,
    };
    pub use crate::scene::fields::{FIELDS, field};
    pub use crate::scene::range::Range;
    pub use crate::scene::statements::{Statement, statements};
    pub use crate::scene::tree::Tree;
}

/// Texts of scenes and of shell commands, edits that keep comments, and suggestions for misspelt names.
pub mod text {
    pub use crate::scene::command::{command_line, quoted};
    pub use crate::scene::document::LONGEST_TEXT;
    pub use crate::scene::errors::{did_you_mean, nearest};
    pub use crate::scene::read::explain;
    pub use crate::scene::text::index::{Text, TextSpan, line_column};
    pub use crate::scene::text::{read_ron, ron_float, ron_string};
    pub use crate::scene::tree::to_ron;
}

/// Loading stages as text.
pub mod loading {
    pub use crate::scene::stages::{
        StageKind, loading_text, pressing_force, read_loading, read_stage, stage_in_ron,
    };
}

/// Scenes by name: built-in scenes, scenes of the user, and scenes in a folder.
pub mod library {
    pub use crate::scene::library::{DEFAULT, Entry, Source, find_scene, own_folder, scenes, typed_path};
    pub use crate::scene::open::{is_file_name, is_path, open_argument};
}

/// Numbers and closed forms of theories, for comparison with the model.
pub mod theory {
    pub use crate::analysis::governing::SteepWaves;
    pub use crate::analysis::reversal_map::ReversalMap;
    pub use crate::reference::closed_form;
}

/// Force over the displacement of an instrument with a finite stiffness.
pub mod instrument {
    pub use crate::analysis::instrument::{
        DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements,
    };
}

/// Parts of the computation of a scene with their times and memory, and the deepest loading that the model covers.
pub mod stages {
    pub use crate::simulation::outcome::{LineFacts, Timings};
    pub use crate::simulation::reach::{BeyondFullContact, Reach};
    pub use crate::simulation::roughness::equivalent_springs;
    pub use crate::simulation::stages::AfterLeg;
    pub use crate::simulation::workload::{PlannedStage, Stage, Workload};
}
