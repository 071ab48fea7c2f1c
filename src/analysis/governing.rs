//! Governing parameters of a scene: κ, eq. (11), and e_el/γ, which compare roughness with adhesion.

use crate::contact::{Foundation, HessRule};
use crate::scene::{Adhesion, Roughness, RoughnessParameter, Scene};
use crate::surface::Amplitude;

/// The governing parameters of a scene, each given or derived from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Governing {
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
    /// Work of adhesion γ, J/m²; `None` without adhesion.
    pub work_of_adhesion: Option<f64>,
    /// Work of adhesion γ₁ on closing, J/m²; `None` if equal to `work_of_adhesion`.
    pub closing_work: Option<f64>,
    /// Amplitude of the roughness; `None` for a smooth profile.
    pub amplitude: Option<Amplitude>,
    /// κ = √(h⟨∇z⟩E*/γ), eq. (11); `None` without roughness or adhesion.
    pub kappa: Option<f64>,
    /// Elastic energy of conformity over the work of adhesion e_el/γ; `None` without roughness or adhesion.
    pub elastic_energy_ratio: Option<f64>,
}

impl Governing {
    /// Derives the parameters of a checked scene from the amplitude of its self-affine profile of rms height 1, or that
    /// of its measured one.
    ///
    /// Given κ alone, γ = h⟨∇z⟩E*/κ²; given γ and κ, h = κ √(γ/(E* ⟨∇z⟩/h)). Similarly for e_el/γ, with e_el = E*
    /// h² q̄/4 and the mean wave number q̄.
    pub fn of(scene: &Scene, unit: Option<Amplitude>, measured: Option<Amplitude>) -> Self {
        let effective_modulus = scene.material.effective_modulus();
        let amplitude = measured.or_else(|| {
            let unit = unit?;
            let Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }) = scene.roughness else {
                return None;
            };
            let by_adhesion = || {
                let adhesion = scene.adhesion?;
                let (work, (parameter, value)) = adhesion.work.zip(adhesion.parameter())?;
                let per_square = energy_of(parameter, unit, effective_modulus);
                Some(parameter.energy_over_work(value).sqrt() * (work / per_square).sqrt())
            };
            let rms_height = rms_height
                .or_else(|| rms_gradient.map(|gradient| gradient / unit.rms_gradient))
                .or_else(by_adhesion)?;
            let amplitude = unit.scaled(rms_height);
            Some(Amplitude { rms_gradient: rms_gradient.unwrap_or(amplitude.rms_gradient), ..amplitude })
        });
        let without = Governing {
            effective_modulus,
            work_of_adhesion: None,
            closing_work: None,
            amplitude,
            kappa: None,
            elastic_energy_ratio: None,
        };
        without.with_adhesion(scene.adhesion)
    }

    /// The same profile with another adhesion.
    pub fn with_adhesion(self, adhesion: Option<Adhesion>) -> Self {
        let adhesion = adhesion.unwrap_or_default();
        let given = adhesion.parameter();
        let by_parameter = || given.and_then(|(parameter, value)| self.work_for(parameter, value));
        let work_of_adhesion = adhesion.work.or_else(by_parameter);
        let value = |parameter: RoughnessParameter| match given {
            Some((same, value)) if same == parameter => Some(value),
            _ => value_of(parameter, self.energy(parameter)?, work_of_adhesion?),
        };
        Governing {
            work_of_adhesion,
            closing_work: adhesion.closing_work,
            kappa: value(RoughnessParameter::Kappa),
            elastic_energy_ratio: value(RoughnessParameter::ElasticEnergyRatio),
            ..self
        }
    }

    /// Work of adhesion for this value of a parameter, J/m²; `None` without roughness.
    pub fn work_for(&self, parameter: RoughnessParameter, value: f64) -> Option<f64> {
        Some(self.energy(parameter)? / parameter.energy_over_work(value))
    }

    /// Value of a parameter; `None` without roughness or adhesion.
    pub fn parameter(&self, parameter: RoughnessParameter) -> Option<f64> {
        match parameter {
            RoughnessParameter::Kappa => self.kappa,
            RoughnessParameter::ElasticEnergyRatio => self.elastic_energy_ratio,
        }
    }

    /// Elastic energy of conformity e_el per area, J/m²; `None` without roughness.
    pub fn elastic_energy(&self) -> Option<f64> {
        self.energy(RoughnessParameter::ElasticEnergyRatio)
    }

    /// Energy per area that a parameter compares with the work of adhesion, J/m²: h⟨∇z⟩E* or e_el; `None` without roughness.
    pub(crate) fn energy(&self, parameter: RoughnessParameter) -> Option<f64> {
        self.amplitude.map(|amplitude| energy_of(parameter, amplitude, self.effective_modulus))
    }

    /// Unit of forces E* h L, N, of a body of this length, m; `None` without roughness. Pohrt, Popov and Filippov (2012).
    pub fn force_unit(&self, length: f64) -> Option<f64> {
        Some(self.effective_modulus * self.amplitude?.rms_height * length)
    }

    /// The rule of Hess on the foundation under a profile; `None` without adhesion.
    pub fn hess_rule(&self, foundation: Foundation) -> Option<HessRule> {
        let work = self.adhesive_work()?;
        Some(HessRule::from_works(foundation, self.closing_work.unwrap_or(work), work))
    }

    /// The work of adhesion if there is any, J/m².
    pub fn adhesive_work(&self) -> Option<f64> {
        self.work_of_adhesion.filter(|&work| work > 0.0)
    }
}

fn energy_of(parameter: RoughnessParameter, amplitude: Amplitude, effective_modulus: f64) -> f64 {
    match parameter {
        RoughnessParameter::Kappa => amplitude.rms_height * amplitude.rms_gradient * effective_modulus,
        RoughnessParameter::ElasticEnergyRatio => amplitude.elastic_energy(effective_modulus),
    }
}

/// Value of a parameter at this energy and work of adhesion per area, J/m². `None` if adhesion is so small that the
/// value overflows.
fn value_of(parameter: RoughnessParameter, energy: f64, work: f64) -> Option<f64> {
    Some(parameter.of_energy_over_work(energy / work)).filter(|value| work > 0.0 && value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;

    const ROUGH: Option<Amplitude> =
        Some(Amplitude { rms_height: 3.0, rms_gradient: 6.0, rms_curvature: 15.0, mean_wave_number: 0.5 });

    /// The parameters of a scene with E* = 4 Pa and the given roughness and adhesion; `None` for no roughness.
    fn governing(amplitude: Option<&str>, adhesion: &str) -> Governing {
        let roughness = amplitude.map_or_else(String::new, |amplitude| {
            format!("roughness: SelfAffine(hurst: 0.5, {amplitude} modes: (1, 8), seed: 1), ")
        });
        let text = format!(
            "(version: 1, material: (effective_modulus: 4.0), length: 1.0, {roughness}adhesion: {adhesion})"
        );
        let document = Document::parse(&text, "scene").unwrap_or_else(|errors| panic!("{errors}"));
        let unit = amplitude.map(|_| Amplitude {
            rms_height: 1.0,
            rms_gradient: 2.0,
            rms_curvature: 5.0,
            mean_wave_number: 0.5,
        });
        Governing::of(document.scene(), unit, None)
    }

    #[test]
    fn two_of_amplitude_work_and_a_parameter_give_the_third() {
        // h⟨∇z⟩E* = 72, and 72/2 is the square of 6. E* h² q̄/4 = 4.5.
        let expected = Governing {
            effective_modulus: 4.0,
            work_of_adhesion: Some(2.0),
            closing_work: None,
            amplitude: ROUGH,
            kappa: Some(6.0),
            elastic_energy_ratio: Some(2.25),
        };
        for (amplitude, adhesion) in [
            ("rms_height: 3.0,", "(work: 2.0)"),
            ("rms_gradient: 6.0,", "(work: 2.0)"),
            ("rms_height: 3.0,", "(kappa: 6.0)"),
            ("rms_gradient: 6.0,", "(kappa: 6.0)"),
            ("", "(work: 2.0, kappa: 6.0)"),
            ("rms_height: 3.0,", "(elastic_energy_ratio: 2.25)"),
            ("rms_gradient: 6.0,", "(elastic_energy_ratio: 2.25)"),
            ("", "(work: 2.0, elastic_energy_ratio: 2.25)"),
        ] {
            assert_eq!(governing(Some(amplitude), adhesion), expected, "{amplitude} {adhesion}");
        }
    }

    #[test]
    fn a_smooth_line_has_no_kappa_and_no_work_is_no_adhesion() {
        let smooth = governing(None, "(work: 2.0)");
        assert_eq!((smooth.adhesive_work(), smooth.kappa, smooth.amplitude), (Some(2.0), None, None));
        let none = governing(Some("rms_height: 3.0,"), "(work: 0.0)");
        assert_eq!((none.work_of_adhesion, none.kappa, none.adhesive_work()), (Some(0.0), None, None));
        let without = governing(Some("rms_height: 3.0,"), "None");
        assert_eq!((without.work_of_adhesion, without.kappa, without.amplitude), (None, None, ROUGH));
        // A parameter that overflows.
        assert_eq!(value_of(RoughnessParameter::Kappa, 1e300, 5e-324), None);
    }

    #[test]
    fn another_adhesion_on_the_same_line() {
        let base = governing(Some("rms_height: 3.0,"), "(work: 2.0)");
        let by = |parameter, value| {
            let changed = base.with_adhesion(Some(Adhesion::by_parameter(parameter, value)));
            assert_eq!(changed.work_of_adhesion, base.work_for(parameter, value));
            (changed.work_of_adhesion, changed.kappa)
        };
        assert_eq!(by(RoughnessParameter::Kappa, 3.0), (Some(8.0), Some(3.0)));
        assert_eq!(by(RoughnessParameter::ElasticEnergyRatio, 0.5), (Some(9.0), Some(8.0_f64.sqrt())));
        assert_eq!(base.with_adhesion(Some(Adhesion::by_work(8.0))).kappa, Some(3.0));
        assert_eq!(base.with_adhesion(None).kappa, None);
    }
}
