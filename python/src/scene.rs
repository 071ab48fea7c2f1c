//! Scenes for calls from Python. They are opened by name, read from files or text, changed, or made
//! from a surface in memory.

use crate::failure::Failure;
use crate::force_loop::Profile;
use asperity::data::shown;
use asperity::scene::library::is_path;
use asperity::scene::text::ron_float;
use asperity::scene::{
    Document, Material, Measured, Numerics, Roughness, Scene as SceneValues, Simulation, open,
};
use asperity::surface::EquivalentLine;
use asperity::surface::lines::{MeasuredProfile, MeasuredRoughness};
use asperity::surface::spectra::IsotropicSpectrum;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// Name that an equivalent line has in place of a file if it was made from heights in memory.
const HEIGHTS: &str = "heights in memory";

/// Name that a spectrum in memory has in place of a file.
const SPECTRUM: &str = "spectrum in memory";

/// A checked scene. It states material, form, roughness, adhesion and loading of a contact, and how
/// they are computed.
#[pyclass(frozen, module = "asperity._native")]
pub struct Scene {
    pub document: Document,
    /// Roughness that exists only in memory and not in a file; `None` if the scene has none.
    pub in_memory: Option<Arc<MeasuredRoughness>>,
}

impl Scene {
    /// Returns a simulation of this scene.
    pub fn simulation(&self) -> Simulation {
        simulation(&self.document, self.in_memory.as_ref())
    }

    /// Returns the roughness that exists only in memory, if the document still contains it.
    /// `document` was made from this scene.
    fn kept_in_memory(
        &self,
        document: &Document,
    ) -> Result<Option<Arc<MeasuredRoughness>>, Failure> {
        let Some(in_memory) = &self.in_memory else {
            return Ok(None);
        };
        let Some(before) = self.document.scene().measured() else {
            return Ok(None);
        };
        let Some(after) = document.scene().measured() else {
            return Ok(None);
        };
        if before.file != after.file {
            return Ok(None);
        }
        let with_former_seed = Measured {
            seed: before.seed,
            ..after.clone()
        };
        if with_former_seed != *before {
            let allowed = "another seed alone, since the surface is in memory; asperity.surface takes the other options";
            return Err(Failure::field("roughness", &before.file, allowed));
        }
        Ok(Some(Arc::clone(in_memory)))
    }
}

/// Returns a simulation for the scene of a document. If `in_memory` is given, this roughness is
/// used in place of the measured files of the document.
pub fn simulation(document: &Document, in_memory: Option<&Arc<MeasuredRoughness>>) -> Simulation {
    let simulation = Simulation::new(document.resolve(""));
    match in_memory {
        Some(in_memory) => simulation.with_measured(Arc::clone(in_memory)),
        None => simulation,
    }
}

#[pymethods]
impl Scene {
    /// Opens a built-in scene by its name, or a scene file by its path.
    #[staticmethod]
    fn open(name: &str) -> Result<Scene, Failure> {
        match open(name) {
            Ok(document) => Ok(Scene {
                document,
                in_memory: None,
            }),
            Err(errors) if is_path(name) => Err(Failure::of_files(&[name.into()], errors)),
            Err(errors) => Err(errors.into()),
        }
    }

    /// Reads the text of a scene. Paths of files in the scene are relative to the working folder.
    #[staticmethod]
    fn parse(text: &str) -> Result<Scene, Failure> {
        Ok(Scene {
            document: Document::parse(text, "scene")?,
            in_memory: None,
        })
    }

    /// Returns a scene in which a body with the effective modulus `modulus` (in Pa) has this
    /// profile.
    #[staticmethod]
    fn of_profile(profile: &Profile, modulus: f64) -> Result<Scene, Failure> {
        let profile = &profile.profile;
        let points = profile.points();
        if points < 2 {
            return Err(Failure::field("heights", "1 height", "at least 2 heights"));
        }
        let length = profile.length();
        let cell = length / points as f64;
        let mut positions = Vec::with_capacity(points);
        for index in 0..points {
            positions.push((index as f64 + 0.5) * cell);
        }
        let heights = MeasuredProfile {
            positions,
            heights: profile.heights().collect(),
        };
        let roughness = Measured {
            as_line: true,
            ..Measured::of_file(HEIGHTS)
        };
        let scene = SceneValues {
            roughness: Some(Roughness::Measured(roughness)),
            numerics: Numerics {
                points: points as u64,
                ..Numerics::default()
            },
            ..SceneValues::new(Material::effective(modulus), length)
        };
        let document = Document::from_scene(&scene, "scene")?;
        Ok(Scene {
            document,
            in_memory: Some(Arc::new(MeasuredRoughness::Profile(heights))),
        })
    }

    /// Returns a scene whose roughness has a given spectrum of a surface, and the rms height in m
    /// and the rms gradient of this spectrum. `wave_numbers` are in rad/m, and `c2d` is the
    /// two-dimensional spectral density in m⁴ at these wave numbers.
    #[staticmethod]
    fn of_spectrum(
        wave_numbers: PyReadonlyArray1<'_, f64>,
        c2d: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(Scene, [f64; 2])> {
        let spectrum = IsotropicSpectrum::from_table(wave_numbers.as_slice()?, c2d.as_slice()?)
            .map_err(Failure::from)?;
        let moments = spectrum.rms_of_height_and_gradient();
        let line = EquivalentLine {
            faces: vec![spectrum],
        };
        let scene = SceneValues {
            roughness: Some(Roughness::Measured(Measured::of_file(SPECTRUM))),
            ..SceneValues::new(Material::effective(1e6), 1e-4)
        };
        let scene = Scene {
            document: Document::from_scene(&scene, "scene").map_err(Failure::from)?,
            in_memory: Some(Arc::new(MeasuredRoughness::Equivalent(line))),
        };
        Ok((scene, moments))
    }

    /// Returns the scene with other values of fields. `fields` has pairs of a path and a value in
    /// the notation of a scene file.
    fn set(&self, fields: Vec<(String, String)>) -> Result<Scene, Failure> {
        let document = self.document.set_all(&fields)?;
        let in_memory = self.kept_in_memory(&document)?;
        Ok(Scene {
            document,
            in_memory,
        })
    }

    /// Returns the scene with these works of adhesion in J/m². If `closing` is `None`, the work on
    /// closing is equal to the work on opening. The range of the attraction does not change. A work
    /// of 0 removes the adhesion.
    fn with_works(&self, work: f64, closing: Option<f64>) -> Result<Scene, Failure> {
        if work == 0.0 && closing.is_none() {
            return self.set(vec![("adhesion".to_owned(), "None".to_owned())]);
        }
        let range = self
            .document
            .scene()
            .adhesion
            .and_then(|adhesion| adhesion.range);
        let mut text = format!("(work: {}", ron_float(work));
        for (name, value) in [("closing_work", closing), ("range", range)] {
            if let Some(value) = value {
                text += &format!(", {name}: {}", ron_float(value));
            }
        }
        text.push(')');
        self.set(vec![("adhesion".to_owned(), text)])
    }

    /// Returns the value of a field as text; `None` if the scene does not state it.
    fn value(&self, path: &str) -> Option<&str> {
        self.document.value(path).filter(|value| *value != "None")
    }

    /// Returns the text of the scene, as in a scene file.
    #[getter]
    fn text(&self) -> &str {
        self.document.text()
    }

    /// Returns a scene with the roughness of another one, whose random phases have this seed.
    fn roughened(&self, like: &Scene, seed: u64) -> Result<Scene, Failure> {
        let Some(measured) = like.document.scene().measured() else {
            return Err(Failure::from(
                "a scene without a measured surface".to_owned(),
            ));
        };
        let mut rough = (**self.document.scene()).clone();
        rough.roughness = Some(Roughness::Measured(Measured {
            seed,
            ..measured.clone()
        }));
        Ok(Scene {
            document: Document::from_scene(&rough, self.document.name())?,
            in_memory: like.in_memory.clone(),
        })
    }

    /// Returns the function and the arguments with which a copy of the scene is made: its text, its
    /// name, and its roughness in memory as text. The names of its files are made absolute, since a
    /// copy may be used in another folder.
    fn __reduce__(&self, py: Python<'_>) -> PyResult<Reduced> {
        let in_memory = self.in_memory.as_deref().map(written).transpose()?;
        let mut document = self.document.clone();
        if in_memory.is_none() {
            document = document
                .moved_to(|file| {
                    let path = self.document.resolve(file);
                    let absolute = std::path::absolute(&path).unwrap_or(path);
                    absolute.display().to_string()
                })
                .map_err(Failure::from)?;
        }
        let restored = py.get_type::<Scene>().getattr("restored")?.unbind();
        let arguments = (
            document.text().to_owned(),
            document.name().to_owned(),
            in_memory,
        );
        Ok((restored, arguments))
    }

    /// Returns the scene that [`Self::__reduce__`] has described.
    #[staticmethod]
    fn restored(text: &str, name: &str, in_memory: Option<&str>) -> Result<Scene, Failure> {
        let in_memory = in_memory.map(read_again::<MeasuredRoughness>).transpose()?;
        Ok(Scene {
            document: Document::parse(text, name)?,
            in_memory: in_memory.map(Arc::new),
        })
    }

    fn __repr__(&self) -> String {
        format!("<Scene \"{}\">", shown(self.document.title()))
    }
}

/// Function that makes a copy of a scene, and its arguments.
type Reduced = (Py<PyAny>, (String, String, Option<String>));

/// Returns a value as text, from which [`read_again`] makes the same bits in another process.
pub fn written(value: &impl Serialize) -> Result<String, Failure> {
    Ok(ron::to_string(value).map_err(|error| error.to_string())?)
}

/// Reads a text that [`written`] has returned.
pub fn read_again<T: DeserializeOwned>(text: &str) -> Result<T, Failure> {
    Ok(ron::from_str(text).map_err(|error| error.to_string())?)
}

/// Returns the names of the built-in scenes.
#[pyfunction]
pub fn presets() -> Vec<&'static str> {
    asperity::scene::presets()
        .iter()
        .map(|preset| preset.name)
        .collect()
}
