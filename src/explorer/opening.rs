//! What the explorer shows when it starts (a scene, or a finished study with its scene), and what
//! the user opens later by typing a path.

use super::ghost::Ghost;
use super::measured::Measured;
use super::recognition::MeasuredFile;
use crate::explorer::advice;
use asperity_data::Remedied;
use asperity_experiment::CurveOptions;
use asperity_scene::library::open_argument;
use asperity_scene::{Document, SceneErrors, open};
use asperity_study::maps::StudyMap;
use asperity_study::{Folder, StudyError};
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;

#[derive(Clone, Debug)]
pub struct Opening {
    pub document: Document,
    /// The study whose maps are shown; `None` if a scene was opened.
    pub study_map: Option<Arc<StudyMap>>,
    pub ghost: Option<Ghost>,
    pub measured: Option<Measured>,
}

#[derive(Debug, Error)]
pub enum OpeningError {
    /// There is no such scene, or it is invalid.
    #[error(transparent)]
    Scene(Box<SceneErrors>),
    #[error(
        "{0}: this is not the folder of a study: there is no plan.ron in it; allowed: a scene, or the folder of a \
         merged study"
    )]
    Folder(String),
    /// The folder contains a study that cannot be shown.
    #[error(transparent)]
    Study(Box<StudyError>),
}

impl From<Document> for Opening {
    fn from(document: Document) -> Self {
        Opening {
            document,
            study_map: None,
            ghost: None,
            measured: None,
        }
    }
}

impl Opening {
    /// Opens a scene by its name or file, or a study by its folder. If a built-in scene and the
    /// folder of a study have the same name, the study is opened.
    pub fn of(name: &str) -> Result<Self, OpeningError> {
        Self::with(name, open)
    }

    /// Opens what an argument of the command line names: a scene, the folder of a study, or a
    /// stream such as standard input.
    pub fn of_argument(name: &str) -> Result<Self, OpeningError> {
        Self::with(name, open_argument)
    }

    fn with(
        name: &str,
        open: impl Fn(&str) -> Result<Document, SceneErrors>,
    ) -> Result<Self, OpeningError> {
        let folder = Path::new(name);
        if folder.is_dir() && Folder::is_at(folder) {
            return Self::of_study(folder);
        }
        match open(name) {
            Ok(document) => Ok(Opening::from(document)),
            Err(_) if folder.is_dir() => Err(OpeningError::Folder(name.to_owned())),
            Err(errors) => Err(OpeningError::Scene(Box::new(errors))),
        }
    }

    fn of_study(folder: &Path) -> Result<Self, OpeningError> {
        let study_map = match StudyMap::open(folder) {
            Ok(study_map) => study_map,
            Err(error) => return Err(OpeningError::Study(Box::new(error))),
        };
        match study_map.document() {
            Ok(document) => Ok(Opening {
                study_map: Some(Arc::new(study_map)),
                ..Opening::from(document)
            }),
            Err(errors) => Err(OpeningError::Scene(Box::new(errors))),
        }
    }
}

/// What was found at a path that the user opened while the explorer was running.
#[derive(Clone, Debug)]
pub enum Opened {
    Scene(Box<Opening>),
    /// Measured force curve, to be shown beside the present scene.
    Curve(Box<Measured>),
}

impl Opened {
    /// Opens a scene, the folder of a study, or a measured force curve.
    ///
    /// # Errors
    /// Returns the reason if nothing can be opened. For a measured surface, the message says how to
    /// use it in a scene.
    pub fn of(name: &str) -> Result<Self, String> {
        let error = match Opening::of(name) {
            Ok(opening) => return Ok(Opened::Scene(Box::new(opening))),
            Err(error) => error,
        };
        match MeasuredFile::of(Path::new(name)) {
            Some(MeasuredFile::Curve) => {
                let measured = Measured::read(Path::new(name), CurveOptions::default());
                let opened = measured.map(|measured| Opened::Curve(Box::new(measured)));
                opened.map_err(|error| error.in_words(advice::row))
            }
            Some(MeasuredFile::Surface) => Err(
                "a surface; its name, typed on the row of the roughness, makes it the roughness of the scene"
                    .to_owned(),
            ),
            None => Err(error.to_string()),
        }
    }
}
