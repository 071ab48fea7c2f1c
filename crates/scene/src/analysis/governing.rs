//! Parameters that compare roughness and adhesion, κ of eq. (11) and e_el/γ, and limits of the rule
//! of Hess.
//!
//! The rule holds under two conditions: the attraction is short-ranged, as a large Tabor number
//! indicates, and the profile rises everywhere from its summit. Attraction of finite range
//! dissipates less energy. In three dimensions the hysteresis vanishes at a Tabor number near 1.

use crate::scene::adhesion::{Adhesion, RoughnessParameter, Strength};
use crate::scene::model::{Roughness, Scene};
use asperity_contact::{Contact, ContactBuilder, ContactError, Modulus, Profile};
use asperity_data::Warning;
use asperity_surface::{Amplitude, Form};
use serde::Serialize;
use std::f64::consts::PI;

/// Parameters that govern the contact of a scene: effective modulus, work of adhesion, roughness,
/// and the two parameters κ and e_el/γ that compare the roughness with the adhesion.
///
/// ```
/// use asperity_scene::{Adhesion, RoughnessParameter, Simulation, open};
///
/// let rough = open("pressure-sensitive")?;
/// let (_, _, governing) = Simulation::default().make_line(rough.scene())?;
/// // The same profile with κ = 1: the work of adhesion grows with 1/κ².
/// let softer =
///     governing.with_adhesion(Some(Adhesion::by_parameter(RoughnessParameter::Kappa, 1.0)));
/// let ratio = softer.work_of_adhesion.unwrap() / governing.work_of_adhesion.unwrap();
/// assert!((ratio / governing.kappa.unwrap().powi(2) - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Governing {
    /// Effective modulus E* in Pa.
    pub modulus: f64,
    /// Work of adhesion γ in J/m²; `None` without adhesion.
    pub work_of_adhesion: Option<f64>,
    /// Energy γ₁ per area in J/m² that is gained where the interface closes. `None` if the scene
    /// does not state γ₁; then γ₁ equals γ.
    pub closing_work: Option<f64>,
    /// Rms height h, rms gradient ⟨∇z⟩ and rms curvature of the roughness; `None` for a smooth
    /// profile.
    pub amplitude: Option<Amplitude>,
    /// Roughness parameter κ = √(h⟨∇z⟩E*/γ), eq. (11) of Popov and Filippov (2012), with the rms
    /// height h, the rms gradient ⟨∇z⟩, the effective modulus E* and the work of adhesion γ. `None`
    /// without roughness or adhesion.
    pub kappa: Option<f64>,
    /// Ratio e_el/γ. e_el is the elastic energy per area that flattens the roughness, and γ the
    /// work of adhesion. `None` without roughness or adhesion.
    pub elastic_energy_ratio: Option<f64>,
}

impl Governing {
    /// Smallest [Tabor number](Self::tabor_number) for which the dissipated energy is accurate.
    /// Below this number the model overestimates the dissipated energy.
    pub const LEAST_TABOR_NUMBER: f64 = Warning::JKR_TABOR_NUMBER;

    /// Derives the governing parameters of a scene. `unit` is the [`Amplitude`] of a self-affine
    /// profile after scaling to an rms height of 1 m; it is needed only for a self-affine
    /// roughness. `measured` is the amplitude of a measured surface; it is needed only for a
    /// measured roughness.
    pub fn of(scene: &Scene, unit: Option<Amplitude>, measured: Option<Amplitude>) -> Self {
        // If the scene states κ, γ = h⟨∇z⟩E*/κ². If it states e_el/γ, γ follows from e_el = E* h²
        // q̄/4. Here q̄ is the mean wave number of the roughness in rad/m, weighted by the squared
        // amplitudes of the waves.
        Governing {
            modulus: scene.material.modulus_in_pascals(),
            amplitude: measured.or_else(|| self_affine_amplitude(scene, unit?)),
            ..Governing::default()
        }
        .with_adhesion(scene.adhesion)
    }

    /// Returns the governing parameters of a contact with the same profile and modulus, but with
    /// the adhesion `adhesion`.
    pub fn with_adhesion(self, adhesion: Option<Adhesion>) -> Self {
        let Some(adhesion) = adhesion else {
            return Governing {
                work_of_adhesion: None,
                closing_work: None,
                kappa: None,
                elastic_energy_ratio: None,
                ..self
            };
        };
        Governing {
            work_of_adhesion: self.work_of(adhesion),
            closing_work: adhesion.closing_work(),
            kappa: self.parameter_of(adhesion, RoughnessParameter::Kappa),
            elastic_energy_ratio: self
                .parameter_of(adhesion, RoughnessParameter::ElasticEnergyRatio),
            ..self
        }
    }

    /// Returns the value of κ or e_el/γ that a contact with the adhesion `adhesion` has. If the
    /// adhesion states this parameter, returns the stated value; otherwise the value that follows
    /// from the work of adhesion.
    fn parameter_of(&self, adhesion: Adhesion, parameter: RoughnessParameter) -> Option<f64> {
        if let Some((given, value)) = adhesion.parameter()
            && given == parameter
        {
            return Some(value);
        }
        value_of(parameter, self.energy(parameter)?, self.work_of(adhesion)?)
    }

    /// Returns the work of adhesion in J/m² that `adhesion` means on this profile. It is the stated
    /// work, or the work that follows from the stated κ or e_el/γ. Returns `None` if κ or e_el/γ is
    /// stated and the profile is smooth.
    fn work_of(&self, adhesion: Adhesion) -> Option<f64> {
        match adhesion.strength {
            Strength::Work { opening, .. } => Some(opening),
            Strength::Parameter(parameter, value) => self.work_for(parameter, value),
        }
    }

    /// Returns the work of adhesion in J/m² for which a parameter has the value `value`. The
    /// parameter is the roughness parameter κ, or the ratio e_el/γ of elastic energy to work of
    /// adhesion. Returns `None` without roughness.
    pub fn work_for(&self, parameter: RoughnessParameter, value: f64) -> Option<f64> {
        Some(self.energy(parameter)? / parameter.energy_over_work(value))
    }

    /// Returns the value of a parameter for this contact: of the roughness parameter κ, or of the
    /// ratio e_el/γ of elastic energy to work of adhesion. Returns `None` without roughness or
    /// adhesion.
    pub fn parameter(&self, parameter: RoughnessParameter) -> Option<f64> {
        match parameter {
            RoughnessParameter::Kappa => self.kappa,
            RoughnessParameter::ElasticEnergyRatio => self.elastic_energy_ratio,
        }
    }

    /// Returns the elastic energy e_el per area that flattens the roughness, in J/m²; `None`
    /// without roughness.
    pub fn elastic_energy(&self) -> Option<f64> {
        self.energy(RoughnessParameter::ElasticEnergyRatio)
    }

    /// Returns the energy per area in J/m² that a parameter compares with the work of adhesion γ.
    /// For κ it is h⟨∇z⟩E* (rms height times rms gradient times effective modulus), since κ² =
    /// h⟨∇z⟩E*/γ. For e_el/γ it is the elastic energy e_el that flattens the roughness. Returns
    /// `None` without roughness.
    pub fn energy(&self, parameter: RoughnessParameter) -> Option<f64> {
        self.amplitude
            .map(|amplitude| energy_of(parameter, amplitude, self.modulus))
    }

    /// Returns the force E* h L in N, by which Pohrt, Popov and Filippov (2012) divide forces. E*
    /// is the effective modulus, h the rms height of the roughness in m, and L = `length` the
    /// length of the profile in m. Returns `None` without roughness.
    pub fn force_unit(&self, length: f64) -> Option<f64> {
        Some(self.modulus * self.amplitude?.rms_height * length)
    }

    /// Returns a builder for a contact of `profile` with the effective modulus and the works of
    /// adhesion of these parameters.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] if the effective modulus is out of its range.
    pub fn contact(&self, profile: &Profile) -> Result<ContactBuilder, ContactError> {
        let contact = Contact::builder(profile, Modulus::effective(self.modulus)?);
        Ok(contact.works_of_adhesion(self.adhesive_works().unwrap_or_default()))
    }

    /// Returns the works of adhesion [γ₁, γ] on closing and on opening in J/m²; `None` without
    /// adhesion.
    pub fn adhesive_works(&self) -> Option<[f64; 2]> {
        let work = self.adhesive_work()?;
        Some([self.closing_work.unwrap_or(work), work])
    }

    /// Returns the work of adhesion γ in J/m² if it is above zero; otherwise `None`.
    pub fn adhesive_work(&self) -> Option<f64> {
        self.work_of_adhesion.filter(|&work| work > 0.0)
    }

    /// Returns the Tabor number μ = (ργ²/(E*²z₀³))^(1/3) of a scene. Here ρ is the radius of
    /// curvature of the summits, γ the work of adhesion on opening, E* the effective modulus and z₀
    /// the range of the attraction. Returns `None` without adhesion, and for bodies without a
    /// radius of curvature, such as cones.
    pub fn tabor_number(&self, scene: &Scene) -> Option<f64> {
        let radius = curvature_radius(scene.form.as_ref(), self)?;
        let work = self.adhesive_work()?;
        let range = scene.adhesion?.attraction_range();
        let number = tabor_number(radius, work, self.modulus, range);
        number.is_finite().then_some(number)
    }
}

/// Returns the amplitude of a self-affine roughness; `None` for any other roughness. `unit` is the
/// amplitude of the same roughness scaled to an rms height of 1 m.
fn self_affine_amplitude(scene: &Scene, unit: Amplitude) -> Option<Amplitude> {
    let Some(Roughness::SelfAffine {
        rms_height,
        rms_gradient,
        ..
    }) = scene.roughness
    else {
        return None;
    };
    let rms_height = rms_height.or(rms_gradient.map(|gradient| gradient / unit.rms_gradient))?;
    let amplitude = unit.scaled(rms_height);
    Some(Amplitude {
        rms_gradient: rms_gradient.unwrap_or(amplitude.rms_gradient),
        ..amplitude
    })
}

fn energy_of(parameter: RoughnessParameter, amplitude: Amplitude, modulus: f64) -> f64 {
    match parameter {
        RoughnessParameter::Kappa => amplitude.rms_height * amplitude.rms_gradient * modulus,
        RoughnessParameter::ElasticEnergyRatio => amplitude.elastic_energy(modulus),
    }
}

/// Returns the value of κ or e_el/γ from the energy of the parameter and the work of adhesion, both
/// in J/m². Returns `None` if the work of adhesion is so small that the value is not a finite
/// number.
fn value_of(parameter: RoughnessParameter, energy: f64, work: f64) -> Option<f64> {
    let value = parameter.of_energy_over_work(energy / work);
    (work > 0.0 && value.is_finite()).then_some(value)
}

/// Returns the radius of curvature ρ of the summits in m. Returns `None` for smooth flat bodies,
/// cones and power laws, which have none.
///
/// ρ is 2/z″, where z″ is the rms curvature of the profile. z″ is also the rms Laplacian of the
/// surface, twice its mean curvature. A paraboloid of radius R has the profile x²/R, so that ρ = R.
/// A crest of a sphere with waves of amplitude A and wavelength λ has the curvature 1/R + 4π²A/λ².
/// If a form is rough, the squares of the curvatures of form and roughness add.
fn curvature_radius(form: Option<&Form>, governing: &Governing) -> Option<f64> {
    // A nominally flat body without a form has the curvature zero, like the flat end of a punch.
    let of_form = form.map_or(Some(0.0), Form::summit_curvature)?;
    let of_roughness = governing
        .amplitude
        .map_or(0.0, |amplitude| 0.5 * amplitude.rms_curvature);
    let radius = of_form.hypot(of_roughness).recip();
    radius.is_finite().then_some(radius)
}

/// Returns the Tabor number μ = (ργ²/(E*²z₀³))^(1/3) (Tabor 1977) of a summit with the curvature
/// radius ρ in m. The other arguments are the work of adhesion γ in J/m², the effective modulus E*
/// in Pa and the range z₀ of the attraction in m.
fn tabor_number(curvature_radius: f64, work_of_adhesion: f64, modulus: f64, range: f64) -> f64 {
    ((work_of_adhesion / modulus).powi(2) * curvature_radius / range.powi(3)).cbrt()
}

/// Steep waves of a wavy sphere. Waves are steep if the equivalent profile of the sphere does not
/// rise everywhere from the axis outwards. With steep waves, the rule of Hess differs from the
/// theory of Johnson, Kendall and Roberts (JKR).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SteepWaves {
    /// Ratio λ²/(AR), with the wavelength λ and the amplitude A of the waves and the radius R of
    /// the sphere.
    pub ratio: f64,
    /// Factor by which the waves raise the pull-off force of the sphere in the theory of JKR. It is
    /// (1 + A√(πE*/2λγ))², with the effective modulus E* and the work of adhesion γ. The formula
    /// holds for waves much shorter than the contact radius (Kesari and Lew 2011).
    pub jkr_factor: f64,
}

impl SteepWaves {
    /// Smallest ratio λ²/(AR) for which the equivalent profile of a wavy sphere rises everywhere
    /// from the axis outwards. λ is the wavelength and A the amplitude of the waves, and R the
    /// radius of the sphere.
    pub const LEAST_RATIO: f64 = Warning::LEAST_WAVE_RATIO;

    /// Returns the ratio and the factor of a scene whose wavy sphere has steep waves; `None` if the
    /// scene has no such waves or no adhesion.
    pub fn of(scene: &Scene, governing: &Governing) -> Option<Self> {
        let &Form::WavySphere {
            radius,
            amplitude,
            wavelength,
        } = scene.form.as_ref()?
        else {
            return None;
        };
        let stretch = governing.adhesive_work()? / governing.modulus;
        let ratio = wavelength.powi(2) / (amplitude * radius);
        let jkr_factor = (1.0 + amplitude * (PI / (2.0 * wavelength * stretch)).sqrt()).powi(2);
        // If the factor is not finite, the scene has almost no adhesion, and no warning is needed.
        (ratio < Self::LEAST_RATIO && jkr_factor.is_finite())
            .then_some(SteepWaves { ratio, jkr_factor })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::document::Document;
    use crate::scene::model::Roughness;
    use crate::scene::open::open;
    use crate::simulation::stages::Simulation;
    use std::f64::consts::TAU;

    const ROUGH: Option<Amplitude> = Some(Amplitude {
        rms_height: 3.0,
        rms_gradient: 6.0,
        rms_curvature: 15.0,
        mean_wave_number: 0.5,
    });

    /// Returns the parameters of a scene with E* = 4 Pa. If `amplitude` is `None`, the scene has no
    /// roughness.
    fn governing(amplitude: Option<&str>, adhesion: &str) -> Governing {
        let roughness = amplitude.map_or_else(String::new, |amplitude| {
            format!("roughness: SelfAffine(hurst: 0.5, {amplitude} modes: (1, 8), seed: 1), ")
        });
        let text = format!(
            "(version: 1, material: (modulus: 4.0), length: 1.0, {roughness}adhesion: {adhesion})"
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
    fn work_and_parameters_follow_from_each_other() {
        // The expected parameters follow from h⟨∇z⟩E* = 72 J/m², γ = 2 J/m², κ² = 72/2 = 36 and
        // e_el = E* h² q̄/4 = 4.5 J/m².
        let expected = Governing {
            modulus: 4.0,
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
            ("rms_height: 3.0,", "(elastic_energy_ratio: 2.25)"),
            ("rms_gradient: 6.0,", "(elastic_energy_ratio: 2.25)"),
        ] {
            assert_eq!(
                governing(Some(amplitude), adhesion),
                expected,
                "{amplitude} {adhesion}"
            );
        }
    }

    #[test]
    fn a_smooth_line_has_no_kappa_and_no_work_is_no_adhesion() {
        let smooth = governing(None, "(work: 2.0)");
        assert_eq!(
            (smooth.adhesive_work(), smooth.kappa, smooth.amplitude),
            (Some(2.0), None, None)
        );
        let none = governing(Some("rms_height: 3.0,"), "(work: 0.0)");
        assert_eq!(
            (none.work_of_adhesion, none.kappa, none.adhesive_work()),
            (Some(0.0), None, None)
        );
        let without = governing(Some("rms_height: 3.0,"), "None");
        assert_eq!(
            (without.work_of_adhesion, without.kappa, without.amplitude),
            (None, None, ROUGH)
        );
        // With an energy of 1e300 J/m² and such a small work of adhesion, κ would not be a finite
        // number.
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
        assert_eq!(
            by(RoughnessParameter::ElasticEnergyRatio, 0.5),
            (Some(9.0), Some(8.0_f64.sqrt()))
        );
        assert_eq!(
            base.with_adhesion(Some(Adhesion::by_work(8.0))).kappa,
            Some(3.0)
        );
        assert_eq!(base.with_adhesion(None).kappa, None);
    }

    fn of(document: &Document) -> Option<f64> {
        let mut simulation = Simulation::default();
        let (_, _, governing) = simulation.make_line(document.scene()).unwrap();
        governing.tabor_number(document.scene())
    }

    fn set(document: &Document, fields: &[(&str, &str)]) -> Document {
        let fields: Vec<_> = fields
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        document.set_all(&fields).unwrap()
    }

    #[test]
    fn quantities_follow_from_plain_numbers() {
        // Here π γ E* L³ is 750 π, and ρ γ²/(E*² z₀³) is 27.
        let force = asperity_contact::ClosedForm::ideal_pull_off_force(2.0, 3.0, 5.0);
        assert!((force - (750.0 * PI).sqrt()).abs() < 1e-13, "{force}");
        let number = tabor_number(6.0, 3.0, 0.5, 2.0);
        assert!((number - 3.0).abs() < 1e-14, "{number}");
    }

    #[test]
    fn a_sphere_has_the_number_of_its_radius() {
        let fields = [
            ("form", "Paraboloid(radius: 2.0e-4)"),
            ("material", "(modulus: 4.0e6)"),
            ("adhesion", "(work: 0.05, range: 1.0e-9)"),
        ];
        let sphere = set(&open("jkr-sphere").unwrap(), &fields);
        let expected = tabor_number(2e-4, 0.05, 4e6, 1e-9);
        assert!((of(&sphere).unwrap() / expected - 1.0).abs() < 1e-12);
        // Without a stated range, the range z₀ of the attraction is 0.3 nm, and μ is proportional
        // to 1/z₀.
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
        let Some(Roughness::SelfAffine {
            rms_height: Some(height),
            ..
        }) = scene.roughness
        else {
            panic!("no self-affine roughness with an rms height");
        };
        let spectrum = scene.spectrum().unwrap();
        let squares = |power: f64| -> f64 {
            (spectrum.first..=spectrum.last)
                .map(|k| (k as f64).powf(power) * spectrum.relative_amplitude(k).powi(2))
                .sum()
        };
        let curvature =
            height * (TAU / scene.length).powi(2) * (squares(4.0) / squares(0.0)).sqrt();
        let expected = tabor_number(
            2.0 / curvature,
            0.05,
            scene.material.modulus_in_pascals(),
            0.3e-9,
        );
        assert!((of(&rough).unwrap() / expected - 1.0).abs() < 1e-12);
        // The radius of this sphere is far larger than the radius of the summits, so the sphere has
        // almost no effect.
        let sphere = rough.set("form", "Paraboloid(radius: 10.0)").unwrap();
        assert!((of(&sphere).unwrap() / expected - 1.0).abs() < 1e-6);
    }
}
