//! The types of a scene: what the author chooses, in SI units, and quantities that follow from it by one formula.
//!
//! These types hold values as written, valid or not; [`Scene::checked`] finds the invalid ones.

use super::adhesion::Adhesion;
use super::fields::{SCENE_VERSION, default_of};
use super::measured::Measured;
use asperity_contact::{ContactError, Edges, Modulus, Move};
use asperity_surface::lines::MeasuredOptions;
use asperity_surface::{Form, SelfAffine};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::{Path, PathBuf};
use strum::IntoStaticStr;

/// Smallest recommended number of springs per wave of a form, of roughness and of the maps: the adhesion force of rough
/// profiles then has an error of about one per cent with both edge models (docs/accuracy.md). At least two springs per wave
/// are required.
pub const SPRINGS_PER_WAVE: u64 = 4;

/// A scene: two bodies, their loading, and the resolution of the computation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the file format, 1.
    pub version: u32,
    /// Title of the scene, one line.
    #[serde(default)]
    pub title: String,
    /// Notes on the scene.
    #[serde(default)]
    pub notice: String,
    /// Elastic constants of the half-space.
    pub material: Material,
    /// Apparent diameter L of the contact, m.
    pub length: f64,
    /// Macroscopic form; `None` for a nominally flat body.
    pub form: Option<Form>,
    /// Roughness; `None` for a smooth profile.
    pub roughness: Option<Roughness>,
    /// Adhesion; `None` without adhesion.
    pub adhesion: Option<Adhesion>,
    /// Stiffness k of the instrument that moves the body, N/m; `None` for a rigid instrument.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loading_stiffness: Option<f64>,
    /// Loading history from separation: consecutive loading stages.
    #[serde(default = "default_loading")]
    pub loading: Vec<Move>,
    /// Resolution and solver.
    #[serde(default)]
    pub numerics: Numerics,
    /// Quantities to observe besides the force curve.
    #[serde(default)]
    pub observe: Vec<Observer>,
}

/// Elastic constants of the half-space as written: E and ν of a half-space under a rigid body, or E* of two elastic bodies.
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
    /// Young's modulus E, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio ν.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson_ratio: Option<f64>,
    /// Effective modulus E* of eq. (2), Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effective_modulus: Option<f64>,
}

impl Material {
    /// Material with this effective modulus E*, Pa.
    pub fn effective(effective_modulus: f64) -> Self {
        Material { effective_modulus: Some(effective_modulus), ..Material::default() }
    }

    /// Isotropic material under a rigid body, with Young's modulus E (Pa) and Poisson's ratio ν: E* = E/(1 − ν²).
    pub fn isotropic(youngs_modulus: f64, poisson_ratio: f64) -> Self {
        let [youngs_modulus, poisson_ratio] = [youngs_modulus, poisson_ratio].map(Some);
        Material { youngs_modulus, poisson_ratio, effective_modulus: None }
    }

    /// Effective modulus E* of eq. (2), Pa; NaN if a constant is missing or out of its range.
    pub fn effective_modulus(&self) -> f64 {
        self.modulus().map_or(f64::NAN, Modulus::pascals)
    }

    /// Effective modulus E* of eq. (2).
    ///
    /// # Errors
    /// [`ContactError::Value`] for a constant that is missing or out of its range.
    pub fn modulus(&self) -> Result<Modulus, ContactError> {
        let [modulus, ratio] =
            [self.youngs_modulus, self.poisson_ratio].map(|value| value.unwrap_or(f64::NAN));
        self.effective_modulus.map_or_else(|| Modulus::isotropic(modulus, ratio), Modulus::effective)
    }
}

/// Roughness of the rigid profile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Roughness {
    /// Random-phase self-affine profile, eqs. (4)–(9). Its amplitude is given by `rms_height` or by `rms_gradient`.
    SelfAffine {
        /// Hurst exponent H.
        hurst: f64,
        /// Root mean square height h, m.
        #[serde(skip_serializing_if = "Option::is_none")]
        rms_height: Option<f64>,
        /// Root mean square gradient ⟨∇z⟩.
        #[serde(skip_serializing_if = "Option::is_none")]
        rms_gradient: Option<f64>,
        /// First and last mode k, q = 2πk/L; `None` if `wavelengths` is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        modes: Option<(u64, u64)>,
        /// Longest and shortest wavelength, m, in place of `modes`.
        #[serde(skip_serializing_if = "Option::is_none")]
        wavelengths: Option<(f64, f64)>,
        /// Wavelength, m, above which the spectrum of the surface is flat; `None` without a roll-off.
        #[serde(skip_serializing_if = "Option::is_none")]
        roll_off: Option<f64>,
        /// Seed of the random phases.
        seed: u64,
    },
    /// Measured surface, profile or map: its equivalent line, or the profile itself.
    Measured(Measured),
}

impl Scene {
    /// A scene of this material and this apparent diameter (m): nominally flat, smooth, without adhesion, and with the
    /// defaults of a scene file.
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
            loading: default_loading(),
            numerics: Numerics::default(),
            observe: Vec::new(),
        }
    }

    /// Spring spacing Δx = L/N, m.
    pub fn spacing(&self) -> f64 {
        self.length / self.numerics.points as f64
    }

    /// Index range of the springs under the body: all springs, except the springs beside a punch.
    pub fn springs_under_body(&self) -> Range<u64> {
        let points = self.numerics.points;
        self.form.as_ref().map_or(0..points, |form| form.springs_under(self.length, points))
    }

    /// Spectrum of a self-affine roughness on the length of the scene; `None` for any other roughness. For given
    /// wavelengths λ the modes are the whole numbers nearest to L/λ, so that the waves stay when the length changes.
    pub fn spectrum(&self) -> Option<SelfAffine> {
        let Some(Roughness::SelfAffine { hurst, modes, wavelengths, roll_off, .. }) = self.roughness else {
            return None;
        };
        let mode = |wavelength: f64| (self.length / wavelength).round() as u64;
        let (first, last) =
            modes.or(wavelengths.map(|(longest, shortest)| (mode(longest), mode(shortest))))?;
        let roll_off_mode = roll_off.map_or(0.0, |wavelength| self.length / wavelength);
        Some(SelfAffine { hurst, first, last, roll_off_mode })
    }

    /// Warning if the shortest wave has fewer springs than [`SPRINGS_PER_WAVE`]. Such a scene is allowed.
    ///
    /// ```
    /// use asperity_contact::{Modulus, Move};
    /// use asperity_scene::ProfileBuilder;
    ///
    /// let coarse = ProfileBuilder::new(1.0e-4, 256).self_affine(0.7).rms_height(1.0e-7).modes(1, 100);
    /// let scene = coarse.scene(Modulus::effective(1.0e6)?, None, &[Move::ToTouch])?;
    /// assert!(scene.warning().unwrap().starts_with("roughness.modes: the shortest wave has 2.5 springs"));
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn warning(&self) -> Option<String> {
        let (path, springs) = match self.roughness.as_ref()? {
            Roughness::SelfAffine { modes, .. } => {
                let path = if modes.is_some() { "roughness.modes" } else { "roughness.wavelengths" };
                (path, self.numerics.points as f64 / self.spectrum()?.last as f64)
            }
            Roughness::Measured(measured) => {
                ("roughness.continue_to", measured.continue_to? / self.spacing())
            }
        };
        (springs < SPRINGS_PER_WAVE as f64).then(|| {
            // Rounded down: never to the least number.
            let springs = (10.0 * springs).floor() / 10.0;
            format!(
                "{path}: the shortest wave has {springs} springs, a resolved one at least {SPRINGS_PER_WAVE}: more \
                 points or longer waves"
            )
        })
    }

    /// The measured surface, if there is one.
    pub fn measured(&self) -> Option<&Measured> {
        if let Some(Roughness::Measured(measured)) = &self.roughness { Some(measured) } else { None }
    }

    /// Returns true if a measured profile is itself the line.
    pub fn measured_as_line(&self) -> bool {
        self.measured().is_some_and(|measured| measured.as_line)
    }

    /// Options for reading and analysing the measured surface.
    pub fn measured_options(&self) -> MeasuredOptions {
        self.measured().map_or_else(MeasuredOptions::default, Measured::options)
    }

    /// Names of the files of the measured surfaces and of the table of the form, relative to the scene file.
    pub fn measured_files(&self) -> Vec<&str> {
        let mut files = self.measured().map_or_else(Vec::new, |measured| measured.faces().concat());
        if let Some(Form::Table { file, .. }) = &self.form {
            files.push(file);
        }
        files
    }

    /// Paths of the files of each face, in `folder`.
    pub fn measured_paths(&self, folder: &Path) -> Vec<Vec<PathBuf>> {
        let faces = self.measured().map_or_else(Vec::new, Measured::faces);
        faces.into_iter().map(|face| face.into_iter().map(|file| folder.join(file)).collect()).collect()
    }

    /// Renames the files of the measured surfaces and of the form.
    pub fn rename_measured_files(&mut self, rename: impl Fn(&str) -> String) {
        if let Some(Form::Table { file, .. }) = &mut self.form {
            *file = rename(file);
        }
        if let Some(Roughness::Measured(Measured { file, further_files, opposite, .. })) = &mut self.roughness
        {
            for name in std::iter::once(file).chain(further_files).chain(opposite) {
                *name = rename(name);
            }
        }
    }

    /// Seed of the random phases; `None` if the profile has none.
    pub fn seed(&self) -> Option<u64> {
        match self.roughness.as_ref()? {
            Roughness::Measured(Measured { as_line: true, .. }) => None,
            Roughness::SelfAffine { seed, .. } | Roughness::Measured(Measured { seed, .. }) => Some(*seed),
        }
    }

    /// Sets the seed of the random phases, if there are any.
    pub fn set_seed(&mut self, wanted: u64) {
        if let Some(Roughness::SelfAffine { seed, .. } | Roughness::Measured(Measured { seed, .. })) =
            &mut self.roughness
        {
            *seed = wanted;
        }
    }
}

/// Resolution and solver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "NumericsText")]
pub struct Numerics {
    /// Number of springs N.
    pub points: u64,
    /// Exact solver or stepwise relaxation.
    pub solver: Solver,
    /// Edge model of the contact patches.
    pub edges: Edges,
    /// Number of curve samples on each loading stage.
    pub samples: u64,
}

impl Default for Numerics {
    fn default() -> Self {
        NumericsText::default().into()
    }
}

/// Resolution and solver as written in a file, where omitted fields have their defaults.
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
        let [points, samples] = ["numerics.points", "numerics.samples"].map(default_of);
        NumericsText { points, solver: default_of("numerics.solver"), edges: None, samples }
    }
}

impl From<NumericsText> for Numerics {
    fn from(NumericsText { points, solver, edges, samples }: NumericsText) -> Self {
        Numerics { points, solver, edges: edges.unwrap_or(solver.usual_edges()), samples }
    }
}

/// Solver of the equilibrium of the springs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(deny_unknown_fields)]
pub enum Solver {
    /// The exact solver: all thresholds at once, without a step error.
    Exact,
    /// The method of the paper: move by a step, relax, repeat.
    Stepwise {
        /// Step Δd of the indentation, m.
        step: f64,
    },
}

impl Solver {
    /// The edge model of a scene that states none: edges between springs if the solver supports them.
    pub fn usual_edges(self) -> Edges {
        match self {
            Solver::Exact => default_of("numerics.edges"),
            Solver::Stepwise { .. } => Edges::Grid,
        }
    }
}

/// A quantity that is observed besides the force curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Observer {
    /// The contact patches and their lengths.
    Fragments,
    /// The histogram of heights.
    HeightHistogram,
}

fn default_loading() -> Vec<Move> {
    default_of("loading")
}
