//! Figures drawn from a scene and its history: the governing parameter, adhesion, regime, energy, and what a picture
//! shows of a profile and its contact.

mod figures;
mod governing;
mod marks;
mod regime;
pub mod section;

pub use figures::Figures;
pub use governing::{Governing, ideal_adhesion_force};
pub use marks::{Mark, marks};
pub use regime::{
    AGREEING_SHARE, CellRegime, INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, RegimeEvidence,
    VANISHING_SHARE,
};
pub use section::{Column, LengthBin, Section, Share};
