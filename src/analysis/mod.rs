//! Figures derived from a scene and its history: the governing parameter, adhesion, regime, energy, and the
//! sections of a profile and its contact for a picture.

mod derived;
mod figures;
mod governing;
mod regime;
mod reversal_map;
pub mod section;

pub use derived::{
    DEFAULT_RANGE, LEAST_TABOR_NUMBER, SteepWaves, contact_stiffness, ideal_adhesion_force, mean_pressure,
    scene_tabor_number,
};
pub use figures::{Figures, Mark, marks, preload_point, pull_off_point};
pub use governing::Governing;
pub use regime::{
    AGREEING_SHARE, CellRegime, INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE,
};
pub use reversal_map::{CONGRUENT_SHARE, MinorLoops, ReversalMap};
pub use section::{Column, LengthBin, Section, Share};
