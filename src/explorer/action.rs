//! Everything that can happen to the explorer.

use super::snapshot::{Loop, Moment};
use std::sync::Arc;
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
    /// A scene has been computed.
    Computed(Arc<Loop>),
    /// A moment of the animation is ready.
    Shown(Arc<Moment>),
    /// Some legs of a scene are done.
    Progress {
        /// Generation of the scene.
        generation: u64,
        /// Legs done.
        legs: usize,
    },
    /// A scene could not be computed.
    Failed {
        /// Generation of the scene.
        generation: u64,
        /// Why, in one line.
        error: String,
    },
    /// The scene has been saved, or not.
    Saved(Result<std::path::PathBuf, SaveError>),
}

/// Why a scene was not saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SaveError {
    /// A file of that name is there already.
    Exists(std::path::PathBuf),
    /// The system refused.
    Refused(String),
}

/// A command of the user. Keys are bound to commands in [`super::keys`] alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Leave the explorer.
    Quit,
    /// Leave it without asking.
    QuitAnyway,
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
    /// Move the selection in the list of parameters.
    Select(i32),
    /// Select the first or last parameter.
    SelectEnd(bool),
    /// Step the selected value.
    StepValue {
        /// How often and which way.
        steps: i32,
        /// By the large step.
        coarse: bool,
    },
    /// Type the selected value.
    EditValue,
    /// Another random line.
    Reseed,
    /// Take back the last edit, or do it again.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Save the scene to a file.
    Save,
    /// Look at the next fragment (or the previous one) in the close-up.
    Fragment(i32),
    /// Look closer in the close-up, or from further away.
    Zoom(i32),
    /// Let the close-up look where the bodies touch first.
    FocusSummit,
    /// Open a built-in scene by its number.
    Preset(usize),
    /// Give one pane the whole screen, or all of them again.
    ZoomPane,
    /// Choose the next pane.
    NextPane,
    /// Accept the line of text or the question.
    Accept,
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
