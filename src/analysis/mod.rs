//! Figures drawn from a scene and its history: the governing parameter, adhesion, regime, energy.

mod figures;
mod governing;
mod regime;

pub use figures::Figures;
pub use governing::{Amplitude, Governing, ideal_adhesion_force};
pub use regime::{
    AGREEING_SHARE, CellRegime, INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, RegimeEvidence,
    VANISHING_SHARE,
};
