//! Figures derived from a scene and its history: the governing parameter, adhesion, regime, energy, and the
//! sections of a profile and its contact for a picture.

mod derived;
mod figures;
mod governing;
mod marks;
mod regime;
mod reversal_map;
pub mod section;
mod steep_waves;
mod tabor;

pub use derived::{contact_stiffness, force_unit, ideal_adhesion_force, mean_pressure, tabor_number};
pub use figures::{Figures, preload_point, pull_off_point};
pub use governing::Governing;
pub use marks::{Mark, marks};
pub use regime::{
    AGREEING_SHARE, CellRegime, INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, RegimeEvidence,
    VANISHING_SHARE,
};
pub use reversal_map::{CONGRUENT_SHARE, MinorLoops, ReversalMap};
pub use section::{Column, LengthBin, Section, Share};
pub use steep_waves::SteepWaves;
pub use tabor::{DEFAULT_RANGE, LEAST_TABOR_NUMBER, curvature_radius, scene_tabor_number};
