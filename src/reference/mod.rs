//! Closed forms that the profile must reproduce: adhesive contact of bodies of revolution.

mod power_law;

pub use power_law::{PowerLaw, flat_punch, smooth_adhesion_force};
