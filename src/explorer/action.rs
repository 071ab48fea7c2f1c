//! Everything that can happen to the explorer.

use super::opening::Opening;
use super::panes::Pane;
use super::snapshot::Report;
use super::study::Found;
use crate::draw::PictureFormat;
use crate::export::TableFormat;
use crate::scene::Entry;
use std::path::PathBuf;
use std::time::Duration;

/// Something that happens: a command of the user, a report of the worker, or time going by.
#[derive(Clone, Debug)]
pub enum Action {
    /// A command from a key.
    Command(Command),
    /// A character typed into a line of text.
    Type(char),
    /// Text pasted into a line of text.
    Paste(String),
    /// The terminal has another size.
    Resize(u16, u16),
    /// Time went by while the animation plays.
    Elapse(Duration),
    /// The seed is to be this one.
    SetSeed(u64),
    /// A report of the worker.
    Report(Report),
    /// Something was found out about accuracy.
    Found(Found),
    /// A file has been written, or not.
    Written(Result<Written, WriteFailure>),
    /// The scenes that can be opened.
    Listed(Vec<Entry>),
    /// Paths that complete a typed one.
    Completed {
        /// The path as typed.
        typed: String,
        /// The whole paths, the best first.
        paths: Vec<String>,
    },
    /// A scene or a study has been opened by its path, or not, and why.
    Opened(Result<Box<Opening>, String>),
    /// Colours and markers are in the configuration file, or not, and why.
    Remembered(Result<PathBuf, String>),
    /// Unsaved changes of a session that was interrupted are kept: the names of their scenes.
    Offered(Vec<String>),
    /// Unsaved changes cannot be kept, and why.
    NotKept(String),
    /// Traffic of the connection.
    Traffic(Traffic),
    /// The mouse did something.
    Mouse(Mouse),
}

/// A file that has been written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Path.
    pub path: PathBuf,
    /// Content.
    pub content: Content,
}

/// Reason for which a file was not written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteFailure {
    /// A file of that name is there already.
    Exists(PathBuf, Content),
    /// The system refused, or what was asked for is not there to be written.
    Refused(String),
}

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The scene, in RON.
    Scene,
    /// The force curve, as a table.
    Curve(TableFormat),
    /// Everything that was computed, in JSON.
    Outcome,
    /// The panes as a picture.
    Picture(PictureFormat),
    /// The panes as plain text.
    Text,
    /// The cells of the map, or of its sections, as comma-separated values.
    MapCells,
    /// The map or its sections as a figure.
    MapFigure(PictureFormat),
}

impl Content {
    /// Contents that can be exported, by the extension of the file.
    pub const EXPORTS: [(&'static str, Content); 6] = [
        ("csv", Content::Curve(TableFormat::Csv)),
        ("npy", Content::Curve(TableFormat::Npy)),
        ("json", Content::Outcome),
        ("svg", Content::Picture(PictureFormat::Svg)),
        ("png", Content::Picture(PictureFormat::Png)),
        ("txt", Content::Text),
    ];

    /// Exports of the map, while its pane is selected.
    pub const MAP_EXPORTS: [(&'static str, Content); 4] = [
        ("csv", Content::MapCells),
        ("svg", Content::MapFigure(PictureFormat::Svg)),
        ("png", Content::MapFigure(PictureFormat::Png)),
        ("txt", Content::Text),
    ];

    /// Content for a file of this name, of these; `None` for another extension.
    #[must_use]
    pub fn of_file(exports: &[(&'static str, Content)], path: &std::path::Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        let known = |(name, _): &&(&str, Content)| ending.eq_ignore_ascii_case(name);
        exports.iter().find(known).map(|(_, content)| *content)
    }
}

/// Gesture of the mouse at a cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    /// Column, from 0 at the left.
    pub column: u16,
    /// Row, from 0 at the top.
    pub row: u16,
    /// Gesture.
    pub gesture: Gesture,
}

/// Gestures of a mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Its left button goes down.
    Press,
    /// Movement with the button down.
    Drag,
    /// Its wheel turns: up is positive.
    Wheel(i32),
}

/// A command of the user. Keys are bound to commands in [`super::keys`] alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Leave the explorer.
    Quit,
    /// Leave it without asking.
    QuitAnyway,
    /// Hand the terminal back to the shell until it continues the explorer.
    Suspend,
    /// Show or leave the help.
    Help,
    /// Play or pause the animation.
    TogglePlay,
    /// One step of the animation, forwards or backwards.
    Step(i32),
    /// Begin the animation again.
    Restart,
    /// Go to the next or previous leg.
    Leg(i32),
    /// Begin manual loading, or return to the loading of the scene.
    ToggleManual,
    /// Press (positive) or pull the body by so many steps of manual loading.
    Push {
        /// Number of steps; the sign is the direction.
        steps: i32,
        /// By the large step.
        coarse: bool,
    },
    /// Type the force to go to.
    TypeForce,
    /// Pull the body until nothing touches.
    Separate,
    /// Move the selection in a list.
    Select(i32),
    /// Select the first or last of a list.
    SelectEnd(bool),
    /// Step the selected value.
    StepValue {
        /// Number of steps; the sign is the direction.
        steps: i32,
        /// By the large step.
        coarse: bool,
    },
    /// Type the selected value.
    EditValue,
    /// Type the selected value, beginning with this character.
    StartValue(char),
    /// Search the list of parameters.
    FindParameter,
    /// Fold the group of the selected parameter, or unfold it.
    ToggleFold,
    /// Switch the effect of the selected row on or off.
    ToggleEffect,
    /// Another random line.
    Reseed,
    /// Take back the last edit.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Keep the present loop as a ghost.
    Pin,
    /// Exchange the scene with that of the newest ghost.
    Swap,
    /// Show the newest ghost beside the scene: both profiles, both loops, what differs.
    ToggleSideBySide,
    /// Keep the other use of a measured profile as a ghost: the profile itself beside its equivalent line, or the line
    /// beside the profile.
    PinOtherUse,
    /// Remove all ghosts.
    ClearGhosts,
    /// Choose a command from the list of all.
    OpenPalette,
    /// Complete the path that is typed.
    Complete,
    /// Save the scene to a file.
    Save,
    /// Export curve or panes to a file.
    Export,
    /// Copy the command that opens the present scene.
    CopyCommand,
    /// Choose a scene from the library.
    OpenLibrary,
    /// Open a built-in scene by its number.
    Preset(usize),
    /// Look at another fragment in the close-up.
    Fragment(Jump),
    /// Show a pane in its place, or the panes again that were there.
    Toggle(Pane),
    /// Look closer in the chosen pane, or from further away.
    Zoom(i32),
    /// Move along the line by so many quarters of what is seen.
    Pan(i32),
    /// See the whole line, and the close-up as it was.
    ResetZoom,
    /// Let the profile follow the fragment of the close-up.
    ToggleFollow,
    /// Show other quantities in the pane of the curve.
    NextCurve,
    /// Show the curve in units of F_a,max and h, or in SI units.
    ToggleNormalised,
    /// Give the curve logarithmic or linear axes.
    ToggleLogarithmic,
    /// Shade the loss.
    ToggleLoss,
    /// Type a tolerance.
    TypeTolerance,
    /// Draw the approximate JKR curve beside the loop, or leave it out.
    ToggleApproximate,
    /// Show sections through the mark in place of the map, or the other way round.
    ToggleSections,
    /// Show another quantity by the glyphs of the map.
    NextCharted,
    /// Show the map of the study, or the one that is computed here.
    ToggleStudy,
    /// Show the next or previous map of the study: another preload, or another value of a further axis.
    NextSlice(i32),
    /// Exchange columns and rows of the map.
    TransposeMap,
    /// Map over e_el/γ in place of κ, or over κ again.
    NextMapParameter,
    /// Move the mark, and the scene, by so many columns of the map.
    MoveAcross(i32),
    /// Move the mark, and the scene, by so many rows of the map.
    MoveUp(i32),
    /// Show or hide the crosshair.
    ToggleCrosshair,
    /// Move the crosshair of the chosen pane.
    MoveCrosshair {
        /// Number of steps, positive to the right.
        steps: i32,
        /// By the large step.
        coarse: bool,
    },
    /// Move the crosshair to the left or, if true, to the right end of the loading stage or of the section.
    CrosshairEnd(bool),
    /// Move the crosshair to the next or previous loading stage at the same indentation.
    CrosshairStage(i32),
    /// Give one pane the whole screen, or all of them again.
    ZoomPane,
    /// Choose the next pane.
    NextPane,
    /// Show springs and times of the computation in the status line, or mechanical quantities again.
    ToggleWork,
    /// Other colours.
    NextTheme,
    /// Other markers in the plots.
    NextMarker,
    /// Keep colours and markers in the configuration file.
    RememberAppearance,
    /// Go to the next or previous line of several that are typed.
    NextLine(i32),
    /// Accept the line of text or the question.
    Accept,
    /// Answer the question with no.
    Refuse,
    /// Leave the line of text or the question.
    Cancel,
    /// Move in a line of text.
    Move(Motion),
    /// Remove the character before or after the cursor of a line of text.
    Delete {
        /// The one before it.
        backwards: bool,
    },
    /// Empty a line of text.
    Clear,
}

/// Fragment to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jump {
    /// The one to the right.
    Next,
    /// The one to the left.
    Previous,
    /// The longest one.
    Largest,
    /// The one that carries the largest force, pressing or pulling.
    MostLoaded,
    /// Place of first touch.
    Summit,
}

/// A motion in a line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// One character to the left.
    Left,
    /// One character to the right.
    Right,
    /// To the start.
    Start,
    /// To the end.
    End,
}

/// Traffic of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// Most frames in a second.
    pub frames: u32,
    /// Bytes written in the last second.
    pub bytes: u64,
}
