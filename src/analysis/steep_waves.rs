//! Waves of a sphere so steep that the rule of Hess is no longer the theory of Johnson, Kendall and Roberts.

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::WavySphere;
    use crate::scene::open;
    use crate::simulation::Simulation;

    #[test]
    fn steep_waves_are_found_with_the_force_of_the_closed_form() {
        let of = |radius: f64, amplitude: f64, wavelength: f64, work: f64| {
            let form = format!(
                "WavySphere(radius: {radius:?}, amplitude: {amplitude:?}, wavelength: {wavelength:?})"
            );
            let fields = [("form", form), ("material", "(effective_modulus: 1.0e6)".to_owned())];
            let adhesion = [("adhesion", format!("(work: {work:?})")), ("length", "1.0".to_owned())];
            let fields = fields.into_iter().chain(adhesion).map(|(path, value)| (path.to_owned(), value));
            let document = open("wavy-sphere").unwrap().set_all(&fields.collect::<Vec<_>>()).unwrap();
            let (_, _, governing) = Simulation::default().make_line(document.scene()).unwrap();
            SteepWaves::of(document.scene(), &governing)
        };
        // JKR by the closed form of one piece: 1.669 and 1.690 times the force of the sphere.
        for (amplitude, wavelength) in [(0.3_f64, 0.26_f64), (0.3, 0.033)] {
            let (radius, work, modulus) = (1.0, 1.0e3, 1.0e6_f64);
            let critical = (9.0 * PI * work * radius * radius / (8.0 * modulus)).cbrt();
            let wavelength = wavelength * critical;
            let amplitude = amplitude * (2.0 * wavelength * work / (PI * modulus)).sqrt();
            let sphere = WavySphere {
                radius,
                amplitude,
                wavelength,
                effective_modulus: modulus,
                work_of_adhesion: work,
            };
            let turn = sphere.indentation(3.0 * critical);
            let closed = sphere.cycle(turn, 5.0 * critical).unwrap().smallest_force;
            let factor = closed / (-1.5 * PI * work * radius);
            let found = of(radius, amplitude, wavelength, work).unwrap();
            assert!((found.jkr_factor / factor - 1.0).abs() < 0.02, "{found:?} {factor}");
            assert!((found.ratio - wavelength.powi(2) / amplitude).abs() < 1e-9 * found.ratio);
        }
        assert_eq!(of(1.0, 0.01, 0.4, 1.0e3), None);
        assert_eq!(of(1.0, 2.0e-3, 0.1, 0.0), None);
    }
}
