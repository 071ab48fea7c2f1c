//! Derived quantities of a contact in SI units, and the limits of the rule of Hess, which is that of short-ranged attraction
//! and of profiles that rise everywhere.
//!
//! Attraction of a finite range dissipates less: in three dimensions the hysteresis vanishes at a Tabor number near 1.
//! Adhesion forces of smooth bodies are in [`crate::reference`], the rule of Hess is [`crate::contact::HessRule`].

use super::Governing;
use crate::scene::{Form, Scene};
use serde::Serialize;
use std::f64::consts::PI;

/// Ideal adhesion force F_a,max = √(πγE*L³), N, of a flat face of length L, m, with a work of adhesion γ, J/m², and an
/// effective modulus E*, Pa. Popov and Filippov (2012), eq. (14); Kendall (1971).
pub fn ideal_adhesion_force(work_of_adhesion: f64, effective_modulus: f64, length: f64) -> f64 {
    (PI * work_of_adhesion * effective_modulus * length.powi(3)).sqrt()
}

/// Default range of attraction z₀, m, of a scene: an interatomic distance.
pub const DEFAULT_RANGE: f64 = 0.3e-9;

/// Tabor number below which dissipated energies are overestimated.
pub const LEAST_TABOR_NUMBER: f64 = 5.0;

/// Tabor number μ of a scene, (ργ²/(E*²z₀³))^(1/3); `None` without adhesion, and for bodies without a radius of
/// curvature. Of two works of adhesion, that of opening is used.
pub fn scene_tabor_number(scene: &Scene, governing: &Governing) -> Option<f64> {
    let (radius, work) = (curvature_radius(scene.form.as_ref(), governing)?, governing.adhesive_work()?);
    let range = scene.adhesion?.range.unwrap_or(DEFAULT_RANGE);
    Some(tabor_number(radius, work, governing.effective_modulus, range)).filter(|number| number.is_finite())
}

/// Radius of curvature ρ of the summits of a form and its roughness, m; `None` for flat faces, cones and powers.
///
/// ρ = 2/z″ with the rms curvature z″ of the profile, the rms Laplacian of the surface: twice its mean curvature.
/// A paraboloid of radius R has the profile x²/R and thus ρ = R; crests of a sphere with waves have 1/R + 4π²A/λ². On a
/// rough form the squares of both curvatures add.
fn curvature_radius(form: Option<&Form>, governing: &Governing) -> Option<f64> {
    // A flat face has the curvature of the flat end of a punch.
    let of_form = form.map_or(Some(0.0), Form::summit_curvature)?;
    let of_roughness = governing.amplitude.map_or(0.0, |amplitude| 0.5 * amplitude.rms_curvature);
    Some(of_form.hypot(of_roughness).recip()).filter(|radius| radius.is_finite())
}

/// Tabor number μ = (ργ²/(E*²z₀³))^(1/3) of a summit of curvature radius ρ, m, under a work of adhesion γ, J/m², an effective
/// modulus E*, Pa, and an attraction of range z₀, m. Tabor (1977).
fn tabor_number(curvature_radius: f64, work_of_adhesion: f64, effective_modulus: f64, range: f64) -> f64 {
    ((work_of_adhesion / effective_modulus).powi(2) * curvature_radius / range.powi(3)).cbrt()
}

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
    pub fn of(scene: &Scene, governing: &Governing) -> Option<Self> {
        let &Form::WavySphere { radius, amplitude, wavelength } = scene.form.as_ref()? else {
            return None;
        };
        let stretch = governing.adhesive_work()? / governing.effective_modulus;
        let ratio = wavelength.powi(2) / (amplitude * radius);
        let jkr_factor = (1.0 + amplitude * (PI / (2.0 * wavelength * stretch)).sqrt()).powi(2);
        (ratio < Self::LEAST_RATIO).then_some(SteepWaves { ratio, jkr_factor })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, Roughness, open};
    use crate::simulation::Simulation;
    use std::f64::consts::TAU;

    fn of(document: &Document) -> Option<f64> {
        let mut simulation = Simulation::default();
        let (_, _, governing) = simulation.make_line(document.scene()).unwrap();
        scene_tabor_number(document.scene(), &governing)
    }

    fn set(document: &Document, fields: &[(&str, &str)]) -> Document {
        let fields: Vec<_> =
            fields.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        document.set_all(&fields).unwrap()
    }

    #[test]
    fn quantities_follow_from_plain_numbers() {
        // π γ E* L³ = 750 π, and ρ γ²/(E*² z₀³) = 27.
        let force = ideal_adhesion_force(2.0, 3.0, 5.0);
        assert!((force - (750.0 * PI).sqrt()).abs() < 1e-13, "{force}");
        let number = tabor_number(6.0, 3.0, 0.5, 2.0);
        assert!((number - 3.0).abs() < 1e-14, "{number}");
    }

    #[test]
    fn a_sphere_has_the_number_of_its_radius() {
        let fields = [
            ("form", "Paraboloid(radius: 2.0e-4)"),
            ("material", "(effective_modulus: 4.0e6)"),
            ("adhesion", "(work: 0.05, range: 1.0e-9)"),
        ];
        let sphere = set(&open("jkr-sphere").unwrap(), &fields);
        let expected = tabor_number(2e-4, 0.05, 4e6, 1e-9);
        assert!((of(&sphere).unwrap() / expected - 1.0).abs() < 1e-12);
        // The default range is 0.3 nm: μ ∝ 1/z₀.
        let usual = of(&sphere.set("adhesion.range", "None").unwrap()).unwrap();
        assert!((usual * 0.3 / expected - 1.0).abs() < 1e-12);
        let opening = sphere.set("adhesion.closing_work", "0.01").unwrap();
        assert_eq!(of(&opening), of(&sphere), "by the work of opening");
        assert_eq!(of(&sphere.set("adhesion", "None").unwrap()), None);
        assert_eq!(of(&sphere.set("form", "Cone(angle: 0.1)").unwrap()), None);
    }

    #[test]
    fn a_rough_line_has_the_number_of_its_rms_curvature() {
        let fields = [("adhesion", "(work: 0.05)"), ("numerics.points", "4096")];
        let rough = set(&open("pressure-sensitive").unwrap(), &fields);
        let scene = rough.scene();
        let Some(Roughness::SelfAffine { rms_height: Some(height), .. }) = scene.roughness else {
            panic!("no self-affine roughness with an rms height");
        };
        let spectrum = scene.spectrum().unwrap();
        let squares = |power: f64| -> f64 {
            (spectrum.first..=spectrum.last)
                .map(|k| (k as f64).powf(power) * spectrum.relative_amplitude(k).powi(2))
                .sum()
        };
        let curvature = height * (TAU / scene.length).powi(2) * (squares(4.0) / squares(0.0)).sqrt();
        let expected = tabor_number(2.0 / curvature, 0.05, scene.material.effective_modulus(), DEFAULT_RANGE);
        assert!((of(&rough).unwrap() / expected - 1.0).abs() < 1e-12);
        // A sphere with a radius far larger than that of the summits has almost no effect.
        let sphere = rough.set("form", "Paraboloid(radius: 10.0)").unwrap();
        assert!((of(&sphere).unwrap() / expected - 1.0).abs() < 1e-6);
    }
}
