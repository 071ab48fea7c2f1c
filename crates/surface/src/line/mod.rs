//! The rigid profile of a body: its macroscopic form, its self-affine or measured roughness, and
//! the statistics of this roughness.

pub(crate) mod equivalent;
pub(crate) mod form;
pub(crate) mod measured;
pub(crate) mod modes;
pub(crate) mod rigid_line;
pub(crate) mod roughness;
pub(crate) mod spectrum;
pub(crate) mod table;
