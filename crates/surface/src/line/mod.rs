//! The rigid profile: macroscopic form, self-affine or measured roughness, and its statistics.

pub(crate) mod equivalent;
pub(crate) mod form;
pub(crate) mod measured;
pub(crate) mod modes;
pub(crate) mod rigid_line;
pub(crate) mod roughness;
pub(crate) mod spectrum;
pub(crate) mod table;
