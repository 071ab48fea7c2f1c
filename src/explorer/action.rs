//! Everything that can happen to the explorer, and the work outside of its state that follows.

use super::keys::Command;
use super::opening::Opening;
use super::snapshot::Report;
use super::studies::Finding;
use super::theme::Appearance;
use crate::export::Format;
use crate::scene::Entry;
use crossterm::event::KeyEvent;
use std::path::PathBuf;
use std::time::Duration;

/// Event: input of the user, a report from outside, or elapsed time.
#[derive(Clone, Debug)]
pub enum Action {
    Key(KeyEvent),
    /// A command by its name.
    Command(Command),
    /// Text for the line being typed.
    Paste(String),
    /// The terminal has another size.
    Resize(u16, u16),
    /// Time elapsed while the animation plays.
    Elapse(Duration),
    /// A report of the worker.
    Report(Report),
    /// A finding of a study.
    Found(Finding),
    /// A written file, or the reason why it was not written.
    Written(OutputFile, Result<(), WriteFailure>),
    /// The scenes that can be opened.
    Listed(Vec<Entry>),
    /// Paths that begin as the typed one.
    Completed(Vec<String>),
    /// A scene or a study opened by its path, or the reason for none.
    Opened(String, Result<Box<Opening>, String>),
    /// Configuration file with the kept appearance, or an error.
    Remembered(Result<PathBuf, String>),
    /// Gesture of the mouse.
    Mouse(Mouse),
}

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

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: PathBuf,
    pub content: Content,
    pub overwrite: bool,
    /// True to leave afterwards.
    pub then_quit: bool,
}

/// Reason for which a file was not written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteFailure {
    /// A file of that name exists.
    Exists,
    /// The system refused, or the content does not exist.
    Refused(String),
}

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The scene, in RON.
    Scene,
    /// The selected pane: its picture, its result, or, as text, all panes.
    Pane(Format),
}

/// Formats of exported files.
pub const EXPORTS: [Format; 7] =
    [Format::Csv, Format::Npy, Format::Json, Format::Svg, Format::Png, Format::Pdf, Format::Text];

/// Gesture of the mouse at a cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    /// Column, from 0 at the left.
    pub column: u16,
    /// Row, from 0 at the top.
    pub row: u16,
    pub gesture: Gesture,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Its left button goes down.
    Press,
    /// Movement with the button down.
    Drag,
    /// Its wheel turns: up is positive.
    Wheel(i32),
}

/// Traffic of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// Most frames in a second.
    pub frames: u32,
    /// Bytes written in the last second.
    pub bytes: u64,
}
