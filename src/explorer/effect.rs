//! Effects of an update: work outside the model.

use super::action::Content;
use super::request::ManualMove;
use super::theme::Appearance;
use crate::scene::Document;
use std::path::PathBuf;

/// Something to be done outside the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Compute the scene.
    Compute,
    /// Show the present snapshot of the contact.
    Show,
    /// Compute the scene that is shown beside, or forget the last one.
    Beside,
    /// Work out what is not known yet of the scene's accuracy, see [`super::update::study_tasks`], and nothing else.
    Study,
    /// Move the body manually.
    Manual(ManualMove),
    /// Draw a random seed and give it back as an action.
    DrawSeed,
    /// Write a file.
    Write {
        /// The file.
        path: PathBuf,
        /// Content.
        content: Content,
        /// True if to overwrite it.
        overwrite: bool,
    },
    /// Keep colours and markers in the configuration file.
    Remember {
        /// The file.
        path: PathBuf,
        /// Colours and markers.
        appearance: Appearance,
    },
    /// List the scenes of the library.
    List,
    /// List the paths that complete a typed one.
    Complete(String),
    /// Open a scene or a study by its path.
    Open(String),
    /// Compute a scene to look at its curve.
    Preview(Box<Document>),
    /// Compute no scene to look at any more.
    StopPreview,
    /// Copy a text.
    Copy(String),
    /// Hand the terminal back to the shell for a while.
    Suspend,
}
