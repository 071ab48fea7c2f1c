//! The governing parameter κ and what it ties together, eqs. (11) and (14).

use crate::contact::{Foundation, HessRule};
use crate::scene::{Adhesion, Roughness, Scene};
use crate::surface::Line;

/// Roughness amplitude of a line: root mean square height and gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitude {
    /// h, m.
    pub rms_height: f64,
    /// ⟨∇z⟩.
    pub rms_gradient: f64,
}

/// The parameters that govern a scene, each given or worked out from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Governing {
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
    /// Work of adhesion γ, J/m²; `None` without adhesion.
    pub work_of_adhesion: Option<f64>,
    /// Work of adhesion γ₁ on closing, J/m²; `None` where that is the same.
    pub closing_work: Option<f64>,
    /// Amplitude of the roughness; `None` where the line is smooth.
    pub amplitude: Option<Amplitude>,
    /// κ = √(h⟨∇z⟩E*/γ), eq. (11); `None` without roughness or adhesion.
    pub kappa: Option<f64>,
}

impl Governing {
    /// The foundation under a line.
    #[must_use]
    pub fn foundation(&self, line: &Line) -> Foundation {
        Foundation { spacing: line.spacing, effective_modulus: self.effective_modulus, length: line.length }
    }

    /// Works out the parameters of a checked scene. `gradient_per_height` is ⟨∇z⟩/h of its self-affine
    /// line, 1/m; `measured` the amplitude of its measured profile.
    ///
    /// Given κ alone, γ = h⟨∇z⟩E*/κ²; given γ and κ, h = κ √(γ/(E* ⟨∇z⟩/h)).
    #[must_use]
    pub fn of(scene: &Scene, gradient_per_height: Option<f64>, measured: Option<Amplitude>) -> Self {
        let effective_modulus = scene.material.effective_modulus();
        let Adhesion { work, closing_work, kappa } = scene.adhesion.unwrap_or_default();
        let amplitude = measured.or_else(|| {
            let ratio = gradient_per_height?;
            let Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }) = scene.roughness else {
                return None;
            };
            let rms_height = rms_height
                .or_else(|| rms_gradient.map(|gradient| gradient / ratio))
                .or_else(|| Some(kappa? * (work? / (effective_modulus * ratio)).sqrt()))?;
            Some(Amplitude { rms_height, rms_gradient: rms_gradient.unwrap_or(rms_height * ratio) })
        });
        let stiff = amplitude.map(|a| a.rms_height * a.rms_gradient * effective_modulus);
        let work_of_adhesion = work.or_else(|| Some(stiff? / kappa?.powi(2)));
        let kappa = kappa.or_else(|| kappa_of(stiff?, work_of_adhesion?));
        Governing { effective_modulus, work_of_adhesion, closing_work, amplitude, kappa }
    }

    /// The same line under another adhesion.
    #[must_use]
    pub fn with_adhesion(self, adhesion: Option<Adhesion>) -> Self {
        let Adhesion { work, closing_work, kappa } = adhesion.unwrap_or_default();
        let stiff = self.stiffness();
        let work_of_adhesion = work.or_else(|| kappa.and_then(|kappa| self.work_for_kappa(kappa)));
        let kappa = kappa.or_else(|| kappa_of(stiff?, work_of_adhesion?));
        Governing { work_of_adhesion, closing_work, kappa, ..self }
    }

    /// The work of adhesion γ = h⟨∇z⟩E*/κ² that gives a κ, J/m²; `None` without roughness.
    #[must_use]
    pub fn work_for_kappa(&self, kappa: f64) -> Option<f64> {
        Some(self.stiffness()? / kappa.powi(2))
    }

    /// h⟨∇z⟩E*, J/m².
    fn stiffness(&self) -> Option<f64> {
        self.amplitude.map(|a| a.rms_height * a.rms_gradient * self.effective_modulus)
    }

    /// The rule of Hess on the foundation under a line; `None` without adhesion.
    #[must_use]
    pub fn hess_rule(&self, foundation: Foundation) -> Option<HessRule> {
        let work = self.adhesive_work()?;
        Some(HessRule::from_works(foundation, self.closing_work.unwrap_or(work), work))
    }

    /// The work of adhesion where there is any, J/m².
    #[must_use]
    pub fn adhesive_work(&self) -> Option<f64> {
        self.work_of_adhesion.filter(|&work| work > 0.0)
    }
}

/// Ideal adhesion force F_a,max = √(π γ E* L³), N, of a flat face of length L, eq. (14).
#[must_use]
pub fn ideal_adhesion_force(work_of_adhesion: f64, effective_modulus: f64, length: f64) -> f64 {
    (std::f64::consts::PI * work_of_adhesion * effective_modulus * length.powi(3)).sqrt()
}

/// κ of a line with h⟨∇z⟩E* = `stiffness`. So little adhesion that κ is beyond all numbers is none.
fn kappa_of(stiffness: f64, work: f64) -> Option<f64> {
    Some((stiffness / work).sqrt()).filter(|kappa| work > 0.0 && kappa.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;

    /// E* = 4 Pa, and of the roughness and adhesion what is given; `None` for no roughness.
    fn scene(amplitude: Option<&str>, adhesion: &str) -> Scene {
        let roughness = amplitude.map_or_else(String::new, |amplitude| {
            format!("roughness: SelfAffine(hurst: 0.5, {amplitude} modes: (1, 8), seed: 1), ")
        });
        let text = format!(
            "(version: 1, material: (effective_modulus: 4.0), length: 1.0, {roughness}adhesion: {adhesion})"
        );
        Document::parse(&text, "scene").unwrap_or_else(|errors| panic!("{errors}")).scene().clone()
    }

    const ROUGH: Option<Amplitude> = Some(Amplitude { rms_height: 3.0, rms_gradient: 6.0 });

    #[test]
    fn two_of_amplitude_work_and_kappa_give_the_third() {
        // h⟨∇z⟩E* = 72, and 72/2 is the square of 6.
        let expected = Governing {
            effective_modulus: 4.0,
            work_of_adhesion: Some(2.0),
            closing_work: None,
            amplitude: ROUGH,
            kappa: Some(6.0),
        };
        for (amplitude, adhesion) in [
            ("rms_height: 3.0,", "(work: 2.0)"),
            ("rms_gradient: 6.0,", "(work: 2.0)"),
            ("rms_height: 3.0,", "(kappa: 6.0)"),
            ("rms_gradient: 6.0,", "(kappa: 6.0)"),
            ("", "(work: 2.0, kappa: 6.0)"),
        ] {
            let governing = Governing::of(&scene(Some(amplitude), adhesion), Some(2.0), None);
            assert_eq!(governing, expected, "{amplitude} {adhesion}");
        }
        let measured = Governing::of(&scene(None, "(work: 2.0)"), None, ROUGH);
        assert_eq!(measured, expected);
    }

    #[test]
    fn a_smooth_line_has_no_kappa_and_no_work_is_no_adhesion() {
        let smooth = Governing::of(&scene(None, "(work: 2.0)"), None, None);
        assert_eq!((smooth.work_of_adhesion, smooth.kappa, smooth.amplitude), (Some(2.0), None, None));
        assert_eq!((smooth.work_for_kappa(1.0), smooth.adhesive_work()), (None, Some(2.0)));
        let none = Governing::of(&scene(Some("rms_height: 3.0,"), "(work: 0.0)"), Some(2.0), None);
        assert_eq!((none.work_of_adhesion, none.kappa, none.adhesive_work()), (Some(0.0), None, None));
        let without = Governing::of(&scene(Some("rms_height: 3.0,"), "None"), Some(2.0), None);
        assert_eq!((without.work_of_adhesion, without.kappa, without.amplitude), (None, None, ROUGH));
    }

    #[test]
    fn another_adhesion_on_the_same_line() {
        let base = Governing::of(&scene(Some("rms_height: 3.0,"), "(work: 2.0)"), Some(2.0), None);
        let with = |adhesion: Adhesion| {
            let changed = base.with_adhesion(Some(adhesion));
            assert_eq!(changed.amplitude, base.amplitude);
            (changed.work_of_adhesion, changed.kappa)
        };
        assert_eq!(with(Adhesion::default().with_work(8.0)), (Some(8.0), Some(3.0)));
        assert_eq!(with(Adhesion::default().with_kappa(3.0)), (Some(8.0), Some(3.0)));
        assert_eq!(base.work_for_kappa(3.0), Some(8.0));
        let none = base.with_adhesion(None);
        assert_eq!((none.work_of_adhesion, none.kappa), (None, None));
    }

    #[test]
    fn a_kappa_beyond_all_numbers_is_none() {
        assert_eq!(kappa_of(1e300, 5e-324), None);
        assert_eq!(kappa_of(1.0, 0.0), None);
        assert_eq!(kappa_of(8.0, 2.0), Some(2.0));
    }

    #[test]
    fn the_ideal_force_is_that_of_a_flat_face() {
        // π γ E* L³ = 750 π.
        let force = ideal_adhesion_force(2.0, 3.0, 5.0);
        assert!((force - (750.0 * std::f64::consts::PI).sqrt()).abs() < 1e-13, "{force}");
    }
}
