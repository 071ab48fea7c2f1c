//! Figures derived from a scene and its loading history: governing parameters, adhesion, regime and energy.

pub(crate) mod governing;
pub(crate) mod instrument;
pub(crate) mod regime;
pub(crate) mod reversal_map;
