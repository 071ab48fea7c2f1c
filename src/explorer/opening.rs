//! What the explorer opens: at its start a scene, or a finished study with its scene, and later
//! everything of which the user types the path.

use super::curve_options::{CurveOptionRow, OPTIONS};
use super::ghost::Ghost;
use super::measured::Measured;
use super::recognition::{MeasuredFile, lacks_options};
use crate::explorer::advice;
use asperity_data::{Remedied, Remedy, read_regular_text};
use asperity_experiment::CurveOptions;
use asperity_scene::library::{is_plan, open_argument};
use asperity_scene::{Document, SceneErrors, open};
use asperity_study::maps::StudyMap;
use asperity_study::{Changes, Folder, Plan, StudyError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// Largest length of the text of a plan in bytes.
const LONGEST_PLAN: usize = 1 << 20;

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
    /// The scene does not exist, or it is invalid.
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
    /// stream such as standard input from which a scene is read.
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
    /// Measured force curve that cannot be read yet, because the user has to type an option first.
    Question(Box<CurveQuestion>),
    /// Path of a measured surface, which becomes the roughness of the present scene.
    Surface(PathBuf),
}

/// Question to the user for an option that is necessary to read a measured curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveQuestion {
    pub path: PathBuf,
    /// Options that are known so far.
    pub options: CurveOptions,
    /// Index in [`OPTIONS`] of the missing option.
    pub missing: usize,
    /// Reason why the curve cannot be read without the option.
    pub reason: String,
}

impl CurveQuestion {
    pub fn option(&self) -> &'static CurveOptionRow {
        &OPTIONS[self.missing]
    }
}

/// Options that a curve may lack, in the order in which they are asked for, by their paths in
/// [`OPTIONS`].
const MAY_BE_MISSING: [(Remedy, &str); 3] = [
    (Remedy::Columns, "measured.columns"),
    (Remedy::Units, "measured.units"),
    (Remedy::Ramp, "measured.ramp"),
];

impl Opened {
    /// Opens a scene, the folder of a study, the scene of a plan, a measured force curve, or a
    /// measured surface.
    ///
    /// # Errors
    /// Returns the reason if nothing can be opened.
    pub fn of(name: &str) -> Result<Self, String> {
        let error = match Opening::of(name) {
            Ok(opening) => return Ok(Opened::Scene(Box::new(opening))),
            Err(error) => error,
        };
        match MeasuredFile::of(Path::new(name)) {
            Some(MeasuredFile::Surface) => Ok(Opened::Surface(PathBuf::from(name))),
            Some(MeasuredFile::Curve) => Opened::read_curve(Path::new(name)),
            None if lacks_options(Path::new(name)) => Opened::read_curve(Path::new(name)),
            None => plan_scene(name).unwrap_or_else(|| Err(error.to_string())),
        }
    }

    /// Opens a measured curve with the option that the user has typed in answer to `question`. If
    /// the curve still cannot be read, the result is another question: for the same option with the
    /// reason, or for another missing option.
    pub fn of_curve(question: CurveQuestion) -> Self {
        let error = match Measured::read(&question.path, question.options.clone()) {
            Ok(measured) => return Opened::Curve(Box::new(measured)),
            Err(error) => error,
        };
        let remedies = error.remedies();
        let path = question.option().field.path;
        let is_asked = |(remedy, row): &(Remedy, &str)| *row == path && remedies.contains(remedy);
        let missing = if MAY_BE_MISSING.iter().any(is_asked) {
            None
        } else {
            missing_option(&remedies, &question.options)
        };
        Opened::Question(Box::new(CurveQuestion {
            missing: missing.unwrap_or(question.missing),
            reason: error.to_string(),
            ..question
        }))
    }

    /// Reads a measured curve without options, or returns the question for the first option that is
    /// missing.
    fn read_curve(path: &Path) -> Result<Self, String> {
        let options = CurveOptions::default();
        let error = match Measured::read(path, options.clone()) {
            Ok(measured) => return Ok(Opened::Curve(Box::new(measured))),
            Err(error) => error,
        };
        match missing_option(&error.remedies(), &options) {
            Some(missing) => Ok(Opened::Question(Box::new(CurveQuestion {
                path: path.to_owned(),
                options,
                missing,
                reason: error.to_string(),
            }))),
            None => Err(error.in_words(advice::row)),
        }
    }
}

/// Returns the index in [`OPTIONS`] of the first option that is not set and with which a curve
/// could be read, by the remedies of its error.
fn missing_option(remedies: &[Remedy], options: &CurveOptions) -> Option<usize> {
    for (remedy, path) in &MAY_BE_MISSING {
        let place = OPTIONS
            .iter()
            .position(|option| option.field.path == *path)?;
        if remedies.contains(remedy) && !OPTIONS[place].is_set(options) {
            return Some(place);
        }
    }
    None
}

/// Opens the scene of a plan; `None` if the file is not a plan.
fn plan_scene(name: &str) -> Option<Result<Opened, String>> {
    let text = read_regular_text(Path::new(name), LONGEST_PLAN).ok()?;
    if !is_plan(&text) {
        return None;
    }
    let opened = || {
        let plan = Plan::open(name, &Changes::default()).map_err(|error| error.to_string())?;
        let document =
            Document::from_scene(&plan.scene, name).map_err(|error| error.to_string())?;
        Ok(Opened::Scene(Box::new(Opening::from(document))))
    };
    Some(opened())
}
