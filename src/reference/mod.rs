//! Closed forms that the profile must reproduce: adhesive contact of bodies of revolution.

mod power_law;
mod wavy_sphere;

pub use power_law::{PowerLaw, flat_punch, smooth_adhesion_force};
pub use wavy_sphere::{WavyLoop, WavySphere};
