//! Relaxation in the contact: closed forms, limits, energy, and springs with memory by brute force.

mod brute_force;
mod climb;
mod closed_forms;
mod cost;
mod instrument;
mod interpolated;
mod limits;
mod published;
mod refusals;
mod springs;

use super::*;
use asperity_contact::{ContactBuilder, Modulus, Profile, Relaxation};

/// A sphere of radius 1 m with γ = E₀ = 1 on a line of `points` springs, 8 m long.
pub struct Sphere {
    pub points: usize,
    pub work: f64,
    pub share: f64,
    /// s
    pub time: f64,
    /// m/s
    pub speed: f64,
    /// N/m
    pub stiffness: f64,
}

impl Sphere {
    pub fn gaps(&self) -> (Vec<f64>, f64) {
        let spacing = 8.0 / self.points as f64;
        let middle = 0.5 * (self.points - 1) as f64;
        let gaps = (0..self.points).map(|point| ((point as f64 - middle) * spacing).powi(2));
        (from_lowest(&gaps.collect::<Vec<_>>()), spacing)
    }

    pub fn contact(&self) -> Contact {
        let (gaps, spacing) = self.gaps();
        let profile = Profile::from_gaps(gaps, spacing).unwrap();
        Contact::builder(&profile, Modulus::effective(1.0).unwrap())
            .work_of_adhesion(self.work)
            .relaxation(Relaxation::new(self.share, self.time).unwrap())
            .loading_speed(self.speed)
            .loading_stiffness(self.stiffness)
            .build()
            .unwrap()
    }
}
