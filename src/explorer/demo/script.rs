//! Scripts of the demos. A script is a list of commands and pauses that a demo plays.

use Cue::{Do, Enter, Open, Repeat, Select, Wait};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cue {
    Wait(f64),
    /// Runs the command that has this name in the table of keys.
    Do(&'static str),
    /// Runs a command several times. The values are the number of times, the interval in s, and the
    /// name of the command.
    Repeat(u32, f64, &'static str),
    Open(&'static str),
    Select(&'static str),
    /// Types a value for the selected parameter, one character at a time.
    Enter(&'static str),
}

/// Time in s in which the demo plays a loading and an unloading stage, with a pause at the end.
const LOOP: f64 = 12.5;

/// Tour of the built-in scenes: the three regimes of adhesion, a larger preload, manual loading,
/// contact patches, and a sphere with and without roughness.
pub const TOUR: &[Cue] = &[
    Open("ideal-adhesion"),
    Wait(LOOP),
    Open("pressure-sensitive"),
    Wait(LOOP),
    Do("pin"),
    Select("loading.0.0"),
    Enter("20 µN"),
    Do("toggle-play"),
    Wait(LOOP),
    Wait(2.0),
    Do("clear-ghosts"),
    Do("toggle-events"),
    Repeat(4, 1.0, "previous-event"),
    Repeat(8, 1.0, "next-event"),
    Do("toggle-events"),
    Do("previous-stage"),
    Wait(0.5),
    Do("toggle-manual"),
    Repeat(12, 0.25, "push Shift+←"),
    Repeat(8, 0.25, "push Shift+→"),
    Repeat(8, 0.25, "push Shift+←"),
    Wait(1.0),
    Do("separate"),
    Wait(2.0),
    Open("non-adhesive"),
    Wait(LOOP),
    Open("patch-closeup"),
    Wait(6.0),
    Do("toggle-play"),
    Repeat(4, 1.0, "next-patch"),
    Open("rough-sphere"),
    Wait(LOOP),
    Do("pin"),
    Select("roughness"),
    Wait(1.0),
    Do("toggle-effect"),
    Do("toggle-play"),
    Wait(LOOP),
];

/// Script for a single scene: its loading and unloading, with the contact patches.
pub const ONE_SCENE: &[Cue] = &[Wait(LOOP)];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::commands::table::bindings;
    use crate::explorer::keys::bindings::Context;

    #[test]
    fn every_command_of_the_scripts_is_in_the_table_of_keys() {
        let bindings = bindings();
        let names = TOUR.iter().chain(ONE_SCENE).filter_map(|cue| match cue {
            Do(name) | Repeat(_, _, name) => Some(*name),
            Wait(_) | Open(_) | Select(_) | Enter(_) => None,
        });
        let names: Vec<&str> = names.collect();
        let is_known = |name: &&str| {
            let contexts = [Context::Explore, Context::Manual];
            let mut commands = contexts
                .map(|context| bindings.named(name, context))
                .into_iter();
            commands.any(|command| command.is_some())
        };
        assert!(names.len() > 15 && names.iter().all(is_known), "{names:?}");
    }
}
