//! Tests: the intervals of fits hold the known values of their curves.

mod coloured_noise;
#[path = "../common/mod.rs"]
mod common;
mod conditions;
mod ensembles;
mod ensembles_of_other_bodies;
mod nearly_smooth;
mod relaxation;
mod relaxing_specimens;
mod simple_curves;
mod single_curves;
mod stiffness;
mod two_spheres;
