//! Effects of an update: work outside the model.

use super::action::OutputFile;
use super::theme::Appearance;
use std::path::PathBuf;

/// Work outside the model.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Ask the worker for the state that the screen waits for.
    Ask,
    /// Perform the remaining studies of the scene, see [`super::update::studies`], and no others.
    Study,
    Write(OutputFile),
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
    /// Copy a text.
    Copy(String),
    /// Draw the whole screen anew with the next frame.
    Redraw,
    /// Return the terminal to the shell for a while.
    Suspend,
}
