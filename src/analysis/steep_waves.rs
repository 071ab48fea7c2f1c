//! Waves on a sphere above the steepness at which the rule of Hess departs from the theory of Johnson, Kendall and
//! Roberts.

use super::Governing;
use crate::scene::{Form, Scene};
use serde::Serialize;
use std::f64::consts::PI;

/// Waves of a sphere whose equivalent profile does not rise everywhere: by the rule of Hess the most stretched spring,
/// here an inner one, detaches first, while JKR lets the contact recede at its edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SteepWaves {
    /// λ²/(AR), below [`SteepWaves::LEAST_RATIO`].
    pub ratio: f64,
    /// Pull-off force over that of the sphere without waves by JKR, (1 + A√(πE*/2λγ))², for waves short against the
    /// contact radius (Kesari and Lew 2011).
    pub jkr_factor: f64,
}

impl SteepWaves {
    /// Quotient λ²/(AR) above which the equivalent profile rises everywhere.
    pub const LEAST_RATIO: f64 = 12.391;

    /// Finds the waves of an adhesive scene that are too steep; `None` for any other scene.
    #[must_use]
    pub fn of(scene: &Scene, governing: &Governing) -> Option<Self> {
        let Some(Form::WavySphere { radius, amplitude, wavelength }) = scene.form else { return None };
        let stretch = governing.adhesive_work()? / governing.effective_modulus;
        let ratio = wavelength.powi(2) / (amplitude * radius);
        let jkr_factor = (1.0 + amplitude * (PI / (2.0 * wavelength * stretch)).sqrt()).powi(2);
        (ratio < Self::LEAST_RATIO).then_some(SteepWaves { ratio, jkr_factor })
    }
}
