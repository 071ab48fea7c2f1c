//! Events of the explorer (actions), and the work that they cause outside of its state (tasks).

use super::keys::bindings::KeyCommand;
use super::measured::Measured;
use super::openable::Openable;
use super::opening::{CurveQuestion, Opened};
use super::snapshot::Reply;
use super::studies::Finding;
use asperity_experiment::CurveOptions;
use asperity_report::Format;
use crossterm::event::KeyEvent;
use std::path::PathBuf;
use std::time::Duration;

/// Event to which the explorer reacts: input of the user, a result from another thread, or the
/// passing of time.
#[derive(Clone, Debug)]
pub enum Action {
    Key(KeyEvent),
    Command(KeyCommand),
    /// The user has pasted this text into the line being typed.
    Paste(String),
    Resize(u16, u16),
    Elapse(Duration),
    Reply(Reply),
    Found(Finding),
    /// The explorer has written a file, or could not write it.
    Written(OutputFile, Result<(), WriteFailure>),
    /// The list of scenes and files that can be opened has been read.
    Listed(Vec<Openable>),
    /// The paths that begin with the typed path have been found.
    Completed(Vec<String>),
    /// The explorer has opened the path in the first text: a scene, a study or a force curve. If
    /// the path could not be opened, the second text is the reason.
    Opened(String, Result<Opened, String>),
    /// The measured curve has been read again with other options. If it could not be read, the text
    /// is the reason.
    CurveRead(CurveRequest, Result<Box<Measured>, String>),
    Mouse(Mouse),
}

/// Work that the explorer starts and that does not change its state directly, such as writing a
/// file.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Asks the solver for the state of the contact that the screen shows next.
    Ask,
    /// Starts the studies (background computations) that the scene still needs. All studies that
    /// were started before are cancelled.
    Study,
    Write(OutputFile),
    List,
    Complete(String),
    Open(String),
    /// Opens a measured curve with the options that the user has typed.
    OpenCurve(CurveQuestion),
    /// Reads the measured curve that is shown again, with other options.
    ReadCurve(CurveRequest),
    Copy(String),
    Redraw,
    Suspend,
}

/// Request to read the measured curve that is shown again, with other options.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveRequest {
    pub options: CurveOptions,
    /// Typed value of the changed option; `None` if the value was chosen with the arrow keys.
    pub typed: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: PathBuf,
    pub content: Content,
    /// Width of a figure in µm; `None` for the usual width.
    pub width: Option<u32>,
    pub overwrite: bool,
    pub then_quit: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteFailure {
    /// The file exists. If `is_changed` is true, it is the file of the scene, and another program
    /// has changed it since the explorer opened or saved it.
    Exists { is_changed: bool },
    /// The explorer could not write the file because the system refused it, or because there is
    /// nothing to write. The text is the reason.
    Refused(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Scene,
    /// The plan of the live map.
    Plan,
    /// The selected pane in this format: a format for pictures gives the figure of the pane, a
    /// format for data its numbers. The text format gives the text of all panes.
    Pane(Format),
}

pub const EXPORTS: [Format; 7] = [
    Format::Csv,
    Format::Npy,
    Format::Json,
    Format::Svg,
    Format::Png,
    Format::Pdf,
    Format::Text,
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    pub column: u16,
    pub row: u16,
    pub gesture: Gesture,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    Press,
    Drag,
    /// Number of turns of the mouse wheel, positive if it is turned upwards.
    Wheel(i32),
}
