//! Builder of the profile of a form and a roughness, for programs that have no scene.

use crate::analysis::governing::Governing;
use crate::error::Error;
use crate::scene::adhesion::Adhesion;
use crate::scene::checked::CheckedScene;
use crate::scene::errors::{SceneError, SceneErrors};
use crate::scene::measured::Measured;
use crate::scene::model::{Material, Numerics, Roughness, SPRINGS_PER_WAVE, Scene};
use crate::simulation::outcome::{Outcome, RunError};
use crate::simulation::stages::{Simulation, nominal_form, profile_of};
use asperity_contact::{ContactError, Modulus, Move, NominalForm, Profile};
use asperity_surface::lines::{Line, MeasuredRoughness};
use asperity_surface::{EquivalentLine, Form};
use std::sync::Arc;

/// Builder of the one-dimensional profile that is equivalent to a body with a form and a roughness.
/// By default the body is nominally flat and smooth. The order of the calls does not matter, except
/// that the last of several values for the same quantity counts.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move};
/// use asperity_scene::ProfileBuilder;
///
/// // A rough sphere on a length of 100 µm with 4096 points.
/// let rough = ProfileBuilder::new(1.0e-4, 4096).sphere(1.0e-3);
/// let rough = rough
///     .self_affine(0.7)
///     .rms_height(5.0e-8)
///     .wavelengths(5.0e-5, 2.0e-7)
///     .seed(3);
/// let contact = Contact::builder(&rough.build()?, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// assert!(cycle.pull_off_force() > Some(0.0));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ProfileBuilder {
    length: f64,
    points: usize,
    form: Option<Form>,
    /// Self-affine roughness, whose members are set one by one.
    self_affine: Option<Roughness>,
    /// Measured spectrum of the roughness, given by the program instead of files of a measured
    /// surface.
    spectrum: Option<Arc<MeasuredRoughness>>,
    /// Seed of the random phases, for a self-affine and for a measured roughness.
    seed: u64,
}

/// Sets one field of the self-affine roughness. If the builder has no roughness yet, the macro
/// first adds a roughness without values.
macro_rules! with_member {
    ($builder:expr, $member:ident, $value:expr) => {{
        let (mut builder, value) = ($builder, $value);
        let roughness = builder.self_affine.get_or_insert(WITHOUT_MEMBERS);
        if let Roughness::SelfAffine { $member, .. } = roughness {
            *$member = value;
        }
        builder
    }};
}

/// Self-affine roughness without any member. A scene with this roughness is invalid.
const WITHOUT_MEMBERS: Roughness = Roughness::SelfAffine {
    hurst: f64::NAN,
    rms_height: None,
    rms_gradient: None,
    modes: None,
    wavelengths: None,
    roll_off: None,
    seed: 1,
};

impl ProfileBuilder {
    /// Creates a builder for a profile with the length `length` in m and with `points` points, one
    /// for each spring.
    #[must_use]
    pub fn new(length: f64, points: usize) -> Self {
        ProfileBuilder {
            length,
            points,
            form: None,
            self_affine: None,
            spectrum: None,
            seed: 1,
        }
    }

    /// Sets the macroscopic form of the body.
    #[must_use]
    pub fn form(self, form: Form) -> Self {
        ProfileBuilder {
            form: Some(form),
            ..self
        }
    }

    /// Sets a sphere of this radius in m as the form.
    #[must_use]
    pub fn sphere(self, radius: f64) -> Self {
        self.form(Form::Paraboloid { radius })
    }

    /// Sets a random self-affine roughness with the Hurst exponent H. The roughness also needs an
    /// amplitude, by [`Self::rms_height`] or [`Self::rms_gradient`], and waves, by [`Self::modes`]
    /// or [`Self::wavelengths`].
    #[must_use]
    pub fn self_affine(self, hurst: f64) -> Self {
        with_member!(self, hurst, hurst)
    }

    /// Sets the rms height of the self-affine roughness in m. A roughness needs either the rms
    /// height or the rms gradient, not both.
    #[must_use]
    pub fn rms_height(self, rms_height: f64) -> Self {
        with_member!(self, rms_height, Some(rms_height))
    }

    /// Sets the rms gradient of the self-affine roughness. A roughness needs either the rms
    /// gradient or the rms height, not both.
    #[must_use]
    pub fn rms_gradient(self, rms_gradient: f64) -> Self {
        with_member!(self, rms_gradient, Some(rms_gradient))
    }

    /// Sets the first and the last mode of the self-affine roughness, as numbers of waves on the
    /// length of the profile. A roughness needs either modes or wavelengths, not both.
    #[must_use]
    pub fn modes(self, first: u64, last: u64) -> Self {
        with_member!(self, modes, Some((first, last)))
    }

    /// Sets the longest and the shortest wavelength of the self-affine roughness in m. A roughness
    /// needs either wavelengths or modes, not both.
    #[must_use]
    pub fn wavelengths(self, longest: f64, shortest: f64) -> Self {
        with_member!(self, wavelengths, Some((longest, shortest)))
    }

    /// Sets the wavelength in m above which the spectrum of the self-affine surface is flat.
    #[must_use]
    pub fn roll_off(self, wavelength: f64) -> Self {
        with_member!(self, roll_off, Some(wavelength))
    }

    /// Sets a roughness with a measured spectrum and random phases. A body that also has a
    /// self-affine roughness is refused.
    ///
    /// ```
    /// use asperity_scene::ProfileBuilder;
    /// use asperity_surface::{AnalysisOptions, EquivalentLine, Topography, analyse};
    ///
    /// let height = |i: u32| {
    ///     (1..60)
    ///         .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
    ///         .sum::<f64>()
    /// };
    /// let heights: Vec<f64> = (0..256).map(|i| 3e-8 * height(i)).collect();
    /// let surface = Topography::from_profile(&heights, 1e-6).unwrap();
    /// let analysis = analyse(&[surface], &AnalysisOptions::default()).unwrap();
    /// let rough = ProfileBuilder::new(2.56e-4, 1024)
    ///     .sphere(1.0e-3)
    ///     .spectrum(EquivalentLine::from(&analysis));
    /// assert_ne!(rough.clone().seed(1).build()?, rough.seed(2).build()?);
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    #[must_use]
    pub fn spectrum(self, line: EquivalentLine) -> Self {
        ProfileBuilder {
            spectrum: Some(Arc::new(MeasuredRoughness::Equivalent(line))),
            ..self
        }
    }

    /// Sets the seed of the random phases of the roughness. By default the seed is 1.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        ProfileBuilder { seed, ..self }
    }

    /// Computes the profile of the form and the roughness.
    ///
    /// ```
    /// use asperity_scene::ProfileBuilder;
    ///
    /// let refused = ProfileBuilder::new(1.0e-4, 1024)
    ///     .self_affine(1.7)
    ///     .rms_height(1.0e-7)
    ///     .modes(1, 64)
    ///     .build();
    /// assert_eq!(
    ///     refused.unwrap_err().to_string(),
    ///     "roughness.hurst = 1.7: allowed: above 0 and below 1 (Hurst exponent)"
    /// );
    /// ```
    ///
    /// # Errors
    /// Returns [`Error::Values`] for values that a scene does not allow, and [`Error::Contact`] if
    /// the shortest wave has fewer than four points. Returns [`Error::Run`] if a surface or a form
    /// cannot be used, or if there is not enough memory.
    pub fn build(&self) -> Result<Profile, Error> {
        let scene = self.scene(Modulus::effective(1.0)?, None, &[Move::ToTouch])?;
        if let Some(last) = scene.spectrum().map(|spectrum| spectrum.last)
            && last > scene.numerics.points / SPRINGS_PER_WAVE
        {
            let allowed = "from the first mode to a quarter of the number of points, for four springs to a wave";
            return Err(ContactError::Value {
                name: "last mode".to_owned(),
                value: last as f64,
                allowed,
            }
            .into());
        }
        Ok(self.simulation().profile(&scene)?)
    }

    /// Computes the profile of the form with `heights` in m as its roughness, one height for each
    /// point. Of N points, the point with the index ⌊N/2⌋ is on the axis of the form. The heights
    /// must be those of the one-dimensional line that is equivalent to the rough surface. Heights
    /// that were measured along a cut through the surface are not; use the spectrum of the cut with
    /// [`ProfileBuilder::spectrum`] instead.
    ///
    /// ```
    /// use asperity_scene::ProfileBuilder;
    ///
    /// let bump = |point: u32| if point == 60 { 1.0e-6 } else { 0.0 };
    /// let profile = ProfileBuilder::new(1.0e-4, 100)
    ///     .sphere(1.0e-3)
    ///     .build_with((0..100).map(bump).collect())?;
    /// assert_eq!(profile.gaps()[60], 0.0);
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`Self::build`]. Also returns [`Error::Contact`] for a wrong
    /// number of heights or a height that is not finite.
    pub fn build_with(&self, heights: Vec<f64>) -> Result<Profile, Error> {
        let smooth = ProfileBuilder {
            self_affine: None,
            spectrum: None,
            ..self.clone()
        };
        let scene = smooth.scene(Modulus::effective(1.0)?, None, &[Move::ToTouch])?;
        if heights.len() != self.points {
            let error = ContactError::Value {
                name: "number of heights".to_owned(),
                value: heights.len() as f64,
                allowed: "the number of points of the profile",
            };
            return Err(error.into());
        }
        for (index, height) in heights.iter().enumerate() {
            if height.abs() > 1e50 || height.is_nan() {
                let error = ContactError::Value {
                    name: format!("height with index {index}"),
                    value: *height,
                    allowed: "from -1e50 to 1e50 m",
                };
                return Err(error.into());
            }
        }
        let line = Line::from_roughness(heights, self.length, scene.form.as_ref(), 1.0);
        // Without a form, the heights may themselves contain the form of the body.
        let form = if self.form.is_none() {
            NominalForm::Unstated
        } else {
            nominal_form(&scene)
        };
        Ok(profile_of(&line.map_err(RunError::from)?, form)?)
    }

    /// Returns a scene with the profile of this builder, and with the given modulus, adhesion and
    /// loading. [`CheckedScene::with`] can change the other fields of the scene.
    ///
    /// # Errors
    /// Returns [`Error::Values`] if a value is out of its range.
    pub fn scene(
        &self,
        modulus: Modulus,
        adhesion: Option<Adhesion>,
        loading: &[Move],
    ) -> Result<CheckedScene, Error> {
        let scene = Scene {
            form: self.form.clone(),
            roughness: self.roughness()?,
            adhesion,
            loading: loading.to_vec(),
            numerics: Numerics {
                points: self.points as u64,
                ..Numerics::default()
            },
            ..Scene::new(Material::effective(modulus.pascals()), self.length)
        };
        Ok(scene.checked()?)
    }

    /// Returns the [`Governing`] parameters of a contact of this profile with this modulus and this
    /// adhesion: for example the rms height, the work of adhesion, and the parameter κ that
    /// compares the roughness with the adhesion.
    ///
    /// ```
    /// use asperity_contact::Modulus;
    /// use asperity_scene::{Adhesion, ProfileBuilder};
    ///
    /// let rough = ProfileBuilder::new(1.0e-4, 4096)
    ///     .self_affine(0.7)
    ///     .rms_height(1.0e-7)
    ///     .modes(1, 1024);
    /// let modulus = Modulus::effective(2.0e6)?;
    /// let governing = rough.governing(modulus, Some(Adhesion::by_work(0.02)))?;
    /// let amplitude = governing.amplitude.unwrap();
    /// let expected = (1.0e-7 * amplitude.rms_gradient * 2.0e6 / 0.02).sqrt();
    /// assert!((governing.kappa.unwrap() / expected - 1.0).abs() < 1e-12);
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`Self::build`], except that two or three points on the shortest
    /// wave are allowed.
    pub fn governing(
        &self,
        modulus: Modulus,
        adhesion: Option<Adhesion>,
    ) -> Result<Governing, Error> {
        let scene = self.scene(modulus, adhesion, &[Move::ToTouch])?;
        Ok(self.simulation().make_line(&scene)?.2)
    }

    /// Loads a contact with this profile through the stages `loading`, and returns all results.
    ///
    /// ```
    /// use asperity_contact::{Modulus, Move};
    /// use asperity_scene::{Adhesion, ProfileBuilder, Regime, RoughnessParameter};
    ///
    /// let rough = ProfileBuilder::new(1.0e-4, 4096)
    ///     .self_affine(0.7)
    ///     .rms_height(1.0e-7)
    ///     .modes(1, 1024);
    /// let kappa = Adhesion::by_parameter(RoughnessParameter::Kappa, 1.0);
    /// let stages = [Move::ToForce(1.0e-5), Move::ToSeparation];
    /// let outcome = rough.run(Modulus::effective(2.0e6)?, Some(kappa), &stages)?;
    /// assert_eq!(outcome.regime, Some(Regime::PressureInsensitive));
    /// assert!((0.85..0.88).contains(&outcome.adhesion_share().unwrap()));
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`Self::governing`]. Also returns [`Error::Contact`] if the
    /// contact cannot reach the end of a stage.
    pub fn run(
        &self,
        modulus: Modulus,
        adhesion: Option<Adhesion>,
        loading: &[Move],
    ) -> Result<Outcome, Error> {
        let scene = self.scene(modulus, adhesion, loading)?;
        Ok(self.simulation().compute(&scene)?)
    }

    /// Returns the roughness of the body with the seed of the builder; `None` for a smooth body.
    fn roughness(&self) -> Result<Option<Roughness>, SceneErrors> {
        if self.spectrum.is_none() {
            let mut self_affine = self.self_affine.clone();
            if let Some(Roughness::SelfAffine { seed, .. }) = &mut self_affine {
                *seed = self.seed;
            }
            return Ok(self_affine);
        }
        if self.self_affine.is_some() {
            let refused = SceneError {
                field: "roughness".to_owned(),
                value: "a measured spectrum and a self-affine roughness".to_owned(),
                allowed: "one of them".to_owned(),
                ..SceneError::default()
            };
            return Err(refused.into());
        }
        Ok(Some(Roughness::Measured(Measured {
            seed: self.seed,
            ..Measured::of_file("spectrum in memory")
        })))
    }

    fn simulation(&self) -> Simulation {
        let simulation = Simulation::default().for_one_scene();
        match &self.spectrum {
            Some(spectrum) => simulation.with_measured(Arc::clone(spectrum)),
            None => simulation,
        }
    }
}
