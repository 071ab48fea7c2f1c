//! From a scene to its force curve: the computing stages, their selection by the scene, and their
//! results.

pub(crate) mod outcome;
pub(crate) mod reach;
pub(crate) mod reversals;
pub(crate) mod roughness;
pub(crate) mod smooth;
pub(crate) mod stages;
pub(crate) mod workload;
