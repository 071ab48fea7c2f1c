//! Script of the demo.

use crate::explorer::action::{Command, Jump};
use crate::explorer::panes::Pane;

/// Something the demo does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cue {
    /// Lets the explorer play for so many seconds.
    Wait(f64),
    /// Obeys a command.
    Do(Command),
    /// Obeys a command so many times, so many seconds apart.
    Repeat(u32, f64, Command),
    /// Selects the parameter of a field.
    Select(&'static str),
    /// Types a value for the selected parameter, as people type.
    Enter(&'static str),
}

use Cue::{Do, Enter, Repeat, Select, Wait};

/// Seconds a loop of two legs takes, and a pause to look at it.
const LOOP: f64 = 12.5;

/// The tour over the built-in scenes: the three regimes, pressing harder, manual loading, fragments, a sphere
/// with and without its roughness.
pub const TOUR: &[Cue] = &[
    Do(Command::Preset(0)),
    Wait(LOOP),
    Do(Command::Preset(1)),
    Wait(LOOP),
    Do(Command::Pin),
    Select("loading.0.0"),
    Enter("20 µN"),
    Do(Command::Restart),
    Wait(LOOP),
    Do(Command::ToggleLoss),
    Wait(2.0),
    Do(Command::ToggleLoss),
    Do(Command::ClearGhosts),
    Do(Command::Leg(-1)),
    Wait(0.5),
    Do(Command::ToggleManual),
    Repeat(12, 0.25, Command::Push { steps: -1, coarse: true }),
    Repeat(8, 0.25, Command::Push { steps: 1, coarse: true }),
    Repeat(8, 0.25, Command::Push { steps: -1, coarse: true }),
    Wait(1.0),
    Do(Command::Separate),
    Wait(2.0),
    Do(Command::Preset(2)),
    Wait(LOOP),
    Do(Command::Preset(5)),
    Wait(6.0),
    Do(Command::TogglePlay),
    Repeat(4, 1.0, Command::Fragment(Jump::Next)),
    Do(Command::Toggle(Pane::Lengths)),
    Wait(3.0),
    Do(Command::Toggle(Pane::Lengths)),
    Do(Command::Preset(8)),
    Wait(LOOP),
    Do(Command::Pin),
    Select("roughness"),
    Wait(1.0),
    Do(Command::ToggleEffect),
    Do(Command::Restart),
    Wait(LOOP),
];

/// One scene, pressed and pulled off, with its fragments.
pub const ONE_SCENE: &[Cue] = &[Wait(LOOP)];
