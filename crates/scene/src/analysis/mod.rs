//! Results derived from a scene and its loading: κ and e_el/γ, regimes, and the force as a function
//! of the displacement.

pub(crate) mod governing;
pub(crate) mod instrument;
pub(crate) mod premises;
pub(crate) mod regime;
pub(crate) mod reversal_map;
