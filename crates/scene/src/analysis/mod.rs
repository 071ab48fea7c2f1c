//! Figures derived from a scene and its loading history: governing parameters, adhesion, regime and energy.

pub(crate) mod branches;
pub(crate) mod figures;
pub(crate) mod governing;
pub(crate) mod instrument;
pub(crate) mod reversal_map;
