//! Results derived from a scene and its loading: κ and e_el/γ, regimes, force over displacement.

pub(crate) mod governing;
pub(crate) mod instrument;
pub(crate) mod premises;
pub(crate) mod regime;
pub(crate) mod reversal_map;
