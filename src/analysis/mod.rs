//! Figures derived from a scene and its history: the governing parameters, adhesion, regime and energy.

mod branches;
mod figures;
mod governing;
mod instrument;
mod reversal_map;

pub use branches::{Branch, preload_point, pull_off_point};
pub use figures::{Figures, INSENSITIVE_SHARE, Mark, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE, marks};
pub use governing::{
    DEFAULT_RANGE, Governing, LEAST_TABOR_NUMBER, SteepWaves, ideal_adhesion_force, scene_tabor_number,
};
pub use instrument::{DisplacementCurve, DisplacementPoint, InstrumentFigures, displacements};
pub use reversal_map::ReversalMap;
