//! Everything that can happen to the explorer, and the work outside of its state that follows.

use super::keys::bindings::Command;
use super::opening::Opening;
use super::snapshot::Reply;
use super::studies::Finding;
use crate::export::report::Format;
use asperity_scene::Entry;
use crossterm::event::KeyEvent;
use std::path::PathBuf;
use std::time::Duration;

/// Event: input of the user, a report from outside, or elapsed time.
#[derive(Clone, Debug)]
pub enum Action {
    Key(KeyEvent),
    Command(Command),
    /// Text for the line being typed.
    Paste(String),
    Resize(u16, u16),
    Elapse(Duration),
    Reply(Reply),
    Found(Finding),
    /// A written file, or the reason why it was not written.
    Written(OutputFile, Result<(), WriteFailure>),
    /// The scenes that can be opened.
    Listed(Vec<Entry>),
    /// Paths that begin as the typed one.
    Completed(Vec<String>),
    /// A scene or a study opened by its path, or the reason for none.
    Opened(String, Result<Box<Opening>, String>),
    Mouse(Mouse),
}

/// Work outside of the state.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Ask the solver for the state that the screen waits for.
    Ask,
    /// Perform the remaining studies of the scene, and no others.
    Study,
    Write(OutputFile),
    List,
    Complete(String),
    Open(String),
    Copy(String),
    Redraw,
    Suspend,
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
    /// The system refused, or the content does not exist.
    Refused(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The scene, in RON.
    Scene,
    /// The selected pane: its picture, its result, or, as text, all panes.
    Pane(Format),
}

pub const EXPORTS: [Format; 7] =
    [Format::Csv, Format::Npy, Format::Json, Format::Svg, Format::Png, Format::Pdf, Format::Text];

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
    /// Turns of the wheel, positive upwards.
    Wheel(i32),
}
