//! From a scene to its results: the parts of the computation, the choice of the parts that a scene
//! needs, and the outcome.

pub(crate) mod loading;
pub(crate) mod outcome;
pub(crate) mod reach;
pub(crate) mod reversals;
pub(crate) mod roughness;
pub(crate) mod smooth;
pub(crate) mod stages;
pub(crate) mod workload;
