#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod accuracy;
mod analysis;
mod error;
mod front;
mod profile_builder;
mod reference;
mod scene;
mod simulation;

pub use accuracy::choice::{Choice, ChoiceError, choose, parse_tolerance};
pub use accuracy::estimate::{Estimate, Evidence, estimate};
pub use accuracy::ladder::{Progress, measure};
pub use accuracy::solution::Target;
pub use accuracy::table::{CostReference, CostTable, ErrorFigure, Knob, QUANTITIES, Row, Timing};
pub use analysis::governing::{DEFAULT_RANGE, Governing, LEAST_TABOR_NUMBER, SteepWaves, scene_tabor_number};
pub use analysis::instrument::{DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements};
pub use analysis::regime::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE};
pub use analysis::reversal_map::ReversalMap;
pub use error::Error;
pub use front::run;
pub use profile_builder::ProfileBuilder;
pub use reference::closed_form;
pub use scene::adhesion::{Adhesion, RoughnessParameter, Strength};
pub use scene::changes::Change;
pub use scene::checked::CheckedScene;
pub use scene::command::{command_line, quoted};
pub use scene::document::{Document, LONGEST_TEXT};
pub use scene::effects::Effect;
pub use scene::errors::{Origin, SceneError, SceneErrors, did_you_mean, nearest};
pub use scene::field::{
    Field, LEG_FIELDS, LEG_FORCE, LEG_INDENTATION, STAGE, Step, choice_in_words, target_field,
};
pub use scene::fields::{FIELDS, field};
pub use scene::library::{
    DEFAULT, Entry, Preset, Source, find_scene, own_folder, presets, scenes, typed_path,
};
pub use scene::measured::Measured;
pub use scene::model::{Material, Numerics, Observer, Roughness, SPRINGS_PER_WAVE, Scene, Solver};
pub use scene::open::{is_file_name, is_path, open, open_argument};
pub use scene::range::Range;
pub use scene::read::explain;
pub use scene::stages::{
    STAGE_KINDS, StageKind, kind_and_number, loading_text, pressing_force, read_loading, read_stage,
    stage_in_ron,
};
pub use scene::statements::{Statement, statements};
pub use scene::text::index::{Text, TextSpan, line_column};
pub use scene::text::{read_ron, ron_float, ron_string};
pub use scene::tree::{Tree, to_ron};
pub use simulation::outcome::{LineFacts, Outcome, RunError, Timings};
pub use simulation::reach::{BeyondFullContact, Reach};
pub use simulation::reversals::{FEW_SAMPLES, TURNING_POINTS};
pub use simulation::roughness::equivalent_springs;
pub use simulation::stages::{AfterLeg, Simulation};
pub use simulation::workload::{PlannedStage, Stage, Workload};
