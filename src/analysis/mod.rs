//! Figures derived from a scene and its history: the governing parameters, adhesion, regime and energy.

mod derived;
mod figures;
mod governing;
mod instrument;
mod reversal_map;

pub use derived::{DEFAULT_RANGE, LEAST_TABOR_NUMBER, SteepWaves, ideal_adhesion_force, scene_tabor_number};
pub use figures::{
    Figures, INSENSITIVE_SHARE, Mark, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE, marks, preload_point,
    pull_off_point,
};
pub use governing::Governing;
pub use instrument::{DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements};
pub use reversal_map::{CONGRUENT_SHARE, MinorLoops, ReversalMap};
