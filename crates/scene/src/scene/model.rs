//! Types of a scene: the values that the author of the scene chooses, in SI units.
//!
//! These types may contain invalid values. [`Scene::checked`] finds them.

use super::adhesion::Adhesion;
use super::defaults::{EDGES, LOADING, POINTS, SAMPLES, SOLVER, read_default};
use super::measured::Measured;
use asperity_contact::{ContactError, Edges, Modulus, Move, Relaxation};
use asperity_data::Warning;
use asperity_surface::lines::MeasuredOptions;
use asperity_surface::{Form, SelfAffine};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::{Path, PathBuf};
use strum::IntoStaticStr;

/// Version of the format of scene files.
pub const SCENE_VERSION: u32 = 1;
/// Number of points of the force curve of a loading stage, if the caller does not use the curve.
pub const FEW_SAMPLES: u64 = 2;
/// Recommended number of springs on the shortest wave. With this number the pull-off force of a
/// rough profile deviates by about one per cent from the value for many springs (docs/accuracy.md).
pub const SPRINGS_PER_WAVE: u64 = Warning::LEAST_SPRINGS_PER_WAVE;

/// A scene: two bodies, their loading, and the resolution of the computation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the file format; always 1.
    pub version: u32,
    /// Title of the scene in one line.
    #[serde(default)]
    pub title: String,
    /// Notes on the scene.
    #[serde(default)]
    pub notice: String,
    /// Elastic constants of the half-space.
    pub material: Material,
    /// Apparent diameter L of the contact in m, which is also the length of the profile.
    pub length: f64,
    /// Macroscopic form of the rigid body; `None` for a nominally flat body.
    pub form: Option<Form>,
    /// Roughness of the rigid body; `None` for a smooth body.
    pub roughness: Option<Roughness>,
    /// Adhesion between the bodies; `None` for a contact without adhesion.
    pub adhesion: Option<Adhesion>,
    /// Stiffness k of the instrument that moves the body in N/m; `None` for a rigid instrument.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loading_stiffness: Option<f64>,
    /// Speed in m/s of the drive of the instrument, or of the body under a rigid instrument; `None`
    /// if it is not stated. Without relaxation it has no effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loading_speed: Option<f64>,
    /// Loading stages in their order. The bodies are separated before the first stage.
    #[serde(default = "default_loading")]
    pub loading: Vec<Move>,
    /// Number of springs, solver, and other settings of the computation.
    #[serde(default)]
    pub numerics: Numerics,
    /// Quantities to record in addition to the force curve.
    #[serde(default)]
    pub observe: Vec<Observer>,
}

/// Elastic constants as a scene states them: either Young's modulus E and Poisson's ratio ν of a
/// half-space under a rigid body, or the effective modulus E*.
///
/// ```
/// use asperity_scene::Material;
///
/// let rubber = Material::isotropic(3.0e6, 0.5);
/// assert!((rubber.modulus()?.pascals() / 4.0e6 - 1.0).abs() < 1e-15);
/// assert!(Material::default().modulus().is_err());
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E in Pa; `None` if the effective modulus is stated instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio ν; `None` if the effective modulus is stated instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson_ratio: Option<f64>,
    /// Effective modulus E* in Pa; `None` if Young's modulus and Poisson's ratio are stated
    /// instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modulus: Option<f64>,
    /// Relaxation of the half-space; `None` for an elastic half-space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relaxation: Option<MaterialRelaxation>,
}

/// Relaxation of a half-space as a scene states it. The modulus of the material is the
/// instantaneous modulus, from which the modulus falls with time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialRelaxation {
    /// Share of the instantaneous modulus that relaxes in the course of time, from 0 to 0.99.
    pub share: f64,
    /// Relaxation time τ in s: the time in which the part of the modulus that still has to relax
    /// falls by the factor e.
    pub time: f64,
}

impl MaterialRelaxation {
    /// Returns the relaxation of the half-space.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a value out of its range.
    pub fn relaxation(&self) -> Result<Relaxation, ContactError> {
        Relaxation::new(self.share, self.time)
    }
}

impl Material {
    /// Returns a material with the effective modulus E* in Pa.
    pub fn effective(modulus: f64) -> Self {
        Material {
            modulus: Some(modulus),
            ..Material::default()
        }
    }

    /// Returns an isotropic material under a rigid body: Young's modulus E in Pa and Poisson's
    /// ratio ν give E* = E/(1 − ν²).
    pub fn isotropic(youngs_modulus: f64, poisson_ratio: f64) -> Self {
        Material {
            youngs_modulus: Some(youngs_modulus),
            poisson_ratio: Some(poisson_ratio),
            ..Material::default()
        }
    }

    /// Returns the effective modulus E* in Pa: the stated E*, otherwise E/(1 − ν²) (eq. (2) of
    /// Popov and Filippov (2012)). Returns NaN if the material has neither E* nor both E and ν, or
    /// if a value is out of its range.
    pub fn modulus_in_pascals(&self) -> f64 {
        self.modulus().map_or(f64::NAN, Modulus::pascals)
    }

    /// Returns the effective modulus E* as a [`Modulus`].
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] if the material has neither E* nor both E and ν, or if a
    /// value is out of its range.
    pub fn modulus(&self) -> Result<Modulus, ContactError> {
        if let Some(modulus) = self.modulus {
            return Modulus::effective(modulus);
        }
        Modulus::isotropic(
            self.youngs_modulus.unwrap_or(f64::NAN),
            self.poisson_ratio.unwrap_or(f64::NAN),
        )
    }
}

/// Roughness of the rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Roughness {
    /// Random self-affine profile, eqs. (4) to (9) of Popov and Filippov (2012). Either
    /// `rms_height` or `rms_gradient` gives its amplitude.
    SelfAffine {
        /// Hurst exponent H, above 0 and below 1.
        hurst: f64,
        /// Root mean square height h of the profile in m; `None` if `rms_gradient` is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        rms_height: Option<f64>,
        /// Root mean square gradient ⟨∇z⟩ of the profile; `None` if `rms_height` is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        rms_gradient: Option<f64>,
        /// First and last mode, as numbers of waves on the length L; `None` if `wavelengths` is
        /// given.
        #[serde(skip_serializing_if = "Option::is_none")]
        modes: Option<(u64, u64)>,
        /// Longest and shortest wavelength in m; `None` if `modes` is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        wavelengths: Option<(f64, f64)>,
        /// Wavelength in m above which the spectrum of the surface is flat; `None` if there is no
        /// such wavelength.
        #[serde(skip_serializing_if = "Option::is_none")]
        roll_off: Option<f64>,
        /// Seed of the random phases.
        seed: u64,
    },
    /// Roughness from a file. Either the file has a measured surface, and random profiles get the
    /// spectrum of this surface. Or the file has heights that are used, unchanged, as the heights
    /// of the profile.
    Measured(Measured),
}

impl Scene {
    /// Returns true if the half-space relaxes, so that forces depend on time.
    pub fn relaxes(&self) -> bool {
        self.material
            .relaxation
            .is_some_and(|relaxation| relaxation.share > 0.0)
    }

    /// Returns a scene with this material and this apparent diameter in m. The body is nominally
    /// flat and smooth, and there is no adhesion. All other fields have their defaults.
    ///
    /// ```
    /// use asperity_scene::{Adhesion, Material, Scene};
    /// use asperity_surface::Form;
    ///
    /// let flat = Scene::new(Material::effective(1.0e6), 1.0e-4);
    /// let form = Some(Form::Paraboloid { radius: 1.0e-3 });
    /// let sphere = Scene { form, adhesion: Some(Adhesion::by_work(0.05)), ..flat.clone() };
    /// assert!(sphere.checked().is_ok());
    /// assert!(Scene { length: -1.0, ..flat }.checked().is_err());
    /// ```
    pub fn new(material: Material, length: f64) -> Self {
        Scene {
            version: SCENE_VERSION,
            title: String::new(),
            notice: String::new(),
            material,
            length,
            form: None,
            roughness: None,
            adhesion: None,
            loading_stiffness: None,
            loading_speed: None,
            loading: default_loading(),
            numerics: Numerics::default(),
            observe: Vec::new(),
        }
    }

    /// Returns the distance Δx in m between springs: L/N, where L is the apparent diameter and N
    /// the number of springs.
    pub fn spacing(&self) -> f64 {
        self.length / self.numerics.points as f64
    }

    /// Returns the indices of the springs under the body. If the body is a punch narrower than the
    /// profile, these are the springs under its flat end. Otherwise all springs are under the body.
    pub fn springs_under_body(&self) -> Range<u64> {
        let points = self.numerics.points;
        self.form
            .as_ref()
            .map_or(0..points, |form| form.springs_under(self.length, points))
    }

    /// Returns the spectrum of the self-affine roughness of this scene, for a profile of the length
    /// of the scene. Returns `None` for any other roughness.
    pub fn spectrum(&self) -> Option<SelfAffine> {
        let Some(Roughness::SelfAffine {
            hurst,
            modes,
            wavelengths,
            roll_off,
            ..
        }) = self.roughness
        else {
            return None;
        };
        let (first, last) = match (modes, wavelengths) {
            (Some(modes), _) => modes,
            (None, Some((longest, shortest))) => (
                (self.length / longest).round() as u64,
                (self.length / shortest).round() as u64,
            ),
            (None, None) => return None,
        };
        let roll_off_mode = roll_off.map_or(0.0, |wavelength| self.length / wavelength);
        Some(SelfAffine {
            hurst,
            first,
            last,
            roll_off_mode,
        })
    }

    /// Returns the description of the measured surface of the scene; `None` if its roughness is not
    /// measured.
    pub fn measured(&self) -> Option<&Measured> {
        if let Some(Roughness::Measured(measured)) = &self.roughness {
            Some(measured)
        } else {
            None
        }
    }

    /// Returns true if the scene uses the heights of the measured file, unchanged, as the heights
    /// of its profile. Returns false if random profiles get the spectrum of the measured surface.
    pub fn measured_as_line(&self) -> bool {
        self.measured().is_some_and(|measured| measured.as_line)
    }

    /// Returns the options for reading and analysing the measured surface.
    pub fn measured_options(&self) -> MeasuredOptions {
        self.measured()
            .map_or_else(MeasuredOptions::default, Measured::options)
    }

    /// Returns the names of all files that the scene uses, relative to the folder of the scene
    /// file. These are the measured files and the table of the form.
    pub fn measured_files(&self) -> Vec<&str> {
        let mut files = self
            .measured()
            .map_or_else(Vec::new, |measured| measured.faces().concat());
        files.extend(self.form.as_ref().and_then(Form::table_file));
        files
    }

    /// Returns the paths of the measured files, whose names are relative to `folder`. The first
    /// element of the list has the paths of all files of the rough body. The second element has the
    /// path of the file of the opposite body. There is no second element if the scene names no such
    /// file.
    pub fn measured_paths(&self, folder: &Path) -> Vec<Vec<PathBuf>> {
        let faces = self.measured().map_or_else(Vec::new, Measured::faces);
        faces
            .into_iter()
            .map(|face| face.into_iter().map(|file| folder.join(file)).collect())
            .collect()
    }

    /// Replaces the names of all files that the scene uses, which are the measured files and the
    /// table of the form. `rename` receives each name and returns the new name. The files
    /// themselves do not change.
    pub fn rename_measured_files(&mut self, rename: impl Fn(&str) -> String) {
        if let Some(Form::Table { file, .. }) = &mut self.form
            && !file.starts_with(Form::ROWS_IN_PLACE)
        {
            *file = rename(file);
        }
        if let Some(Roughness::Measured(Measured {
            file,
            further_files,
            opposite,
            ..
        })) = &mut self.roughness
        {
            for name in std::iter::once(file).chain(further_files).chain(opposite) {
                *name = rename(name);
            }
        }
    }

    /// Returns the seed of the random phases; `None` if the scene has no random profile.
    pub fn seed(&self) -> Option<u64> {
        match self.roughness.as_ref()? {
            Roughness::Measured(Measured { as_line: true, .. }) => None,
            Roughness::SelfAffine { seed, .. } | Roughness::Measured(Measured { seed, .. }) => {
                Some(*seed)
            }
        }
    }

    /// Sets the seed of the random phases. A scene without random phases does not change.
    pub fn set_seed(&mut self, wanted: u64) {
        if let Some(
            Roughness::SelfAffine { seed, .. } | Roughness::Measured(Measured { seed, .. }),
        ) = &mut self.roughness
        {
            *seed = wanted;
        }
    }
}

/// Number of springs, solver, and other settings of the computation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "NumericsText")]
pub struct Numerics {
    /// Number of springs N.
    pub points: u64,
    /// Solver for the equilibrium of the springs: the exact solver, or the stepwise method of Popov
    /// and Filippov (2012).
    pub solver: Solver,
    /// Where an edge of a contact patch may lie: anywhere between two springs, or only where the
    /// patch then consists of whole springs.
    pub edges: Edges,
    /// Number of points of the force curve on each loading stage.
    pub samples: u64,
}

impl Default for Numerics {
    fn default() -> Self {
        NumericsText::default().into()
    }
}

/// Settings of the computation as written in a file. Omitted fields have their defaults.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default, rename = "Numerics")]
struct NumericsText {
    points: u64,
    solver: Solver,
    edges: Option<Edges>,
    samples: u64,
}

impl Default for NumericsText {
    fn default() -> Self {
        NumericsText {
            points: read_default(POINTS),
            solver: read_default(SOLVER),
            edges: None,
            samples: read_default(SAMPLES),
        }
    }
}

impl From<NumericsText> for Numerics {
    fn from(
        NumericsText {
            points,
            solver,
            edges,
            samples,
        }: NumericsText,
    ) -> Self {
        Numerics {
            points,
            solver,
            edges: edges.unwrap_or(solver.usual_edges()),
            samples,
        }
    }
}

/// Method that finds the equilibrium of the springs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Solver {
    /// Exact solver. It computes the indentations at which contact patches form, merge, split and
    /// detach, without finite steps.
    Exact,
    /// Method of Popov and Filippov (2012): the body moves by finite steps. After each step springs
    /// attach and detach until the contact no longer changes.
    Stepwise {
        /// Step Δd of the indentation in m.
        step: f64,
    },
}

impl Solver {
    /// Returns the default of [`Numerics::edges`], which states where the edges of contact patches
    /// lie. With the exact solver they lie anywhere between springs ([`Edges::SubCell`]). With the
    /// stepwise solver, patches consist of whole springs ([`Edges::Grid`]).
    pub fn usual_edges(self) -> Edges {
        match self {
            Solver::Exact => read_default(EDGES),
            Solver::Stepwise { .. } => Edges::Grid,
        }
    }
}

/// A quantity that a computation records in addition to the force curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr)]
pub enum Observer {
    /// The contact patches at the end of each loading stage.
    Patches,
    /// The histogram of the heights of the profile.
    HeightHistogram,
}

fn default_loading() -> Vec<Move> {
    read_default(LOADING)
}
