//! Everything that can happen to the explorer, and the tasks outside of its state that follow.

use super::keys::bindings::KeyCommand;
use super::measured::Measured;
use super::opening::Opened;
use super::snapshot::Reply;
use super::studies::Finding;
use asperity_experiment::CurveOptions;
use asperity_report::Format;
use asperity_scene::library::Entry;
use crossterm::event::KeyEvent;
use std::path::PathBuf;
use std::time::Duration;

/// An event: input of the user, a result from outside, or elapsed time.
#[derive(Clone, Debug)]
pub enum Action {
    Key(KeyEvent),
    Command(KeyCommand),
    /// Text pasted into the line being typed.
    Paste(String),
    Resize(u16, u16),
    Elapse(Duration),
    Reply(Reply),
    Found(Finding),
    /// A file was written, or the reason why it was not.
    Written(OutputFile, Result<(), WriteFailure>),
    /// The scenes that can be opened have been listed.
    Listed(Vec<Entry>),
    /// Paths that begin as the typed path have been found.
    Completed(Vec<String>),
    /// A scene, study or force curve, by its path, was opened; or the reason why it was not.
    Opened(String, Result<Opened, String>),
    /// The measured curve was read with other options; or the reason why it was not.
    CurveRead(CurveRequest, Result<Box<Measured>, String>),
    Mouse(Mouse),
}

/// A task outside of the state of the explorer.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Ask the solver for the state that the screen waits for.
    Ask,
    /// Perform the studies of the scene that are still open, in place of all others.
    Study,
    Write(OutputFile),
    List,
    Complete(String),
    Open(String),
    /// Read the measured curve with other options.
    ReadCurve(CurveRequest),
    Copy(String),
    Redraw,
    Suspend,
}

/// A request for the measured curve as read with other options.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveRequest {
    pub options: CurveOptions,
    /// The typed value that is asked for; `None` for a choice of the arrows.
    pub typed: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: PathBuf,
    pub content: Content,
    pub overwrite: bool,
    pub then_quit: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteFailure {
    Exists,
    /// The system refused to write, or there is no such content.
    Refused(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Scene,
    /// The selected pane in this format: its picture, its result, or for text all panes.
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
    /// Turns of the mouse wheel, positive upwards.
    Wheel(i32),
}
