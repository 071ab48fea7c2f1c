//! Script of the demo.

use Cue::{Do, Enter, Open, Repeat, Select, Wait};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cue {
    Wait(f64),
    /// Runs a command of the table of keys, by its name.
    Do(&'static str),
    /// Runs a command a number of times, with this interval in seconds.
    Repeat(u32, f64, &'static str),
    Open(&'static str),
    Select(&'static str),
    /// Types a value for the selected parameter, character by character.
    Enter(&'static str),
}

/// Duration, s, of a loop of two loading stages and a pause at its end.
const LOOP: f64 = 12.5;

/// The tour of the built-in scenes: the three regimes, pressing harder, manual loading, contact
/// patches, a sphere with and without its roughness.
pub const TOUR: &[Cue] = &[
    Open("ideal-adhesion"),
    Wait(LOOP),
    Open("pressure-sensitive"),
    Wait(LOOP),
    Do("pin"),
    Select("loading.0.0"),
    Enter("20 µN"),
    Do("restart"),
    Wait(LOOP),
    Do("toggle-dissipated-energy"),
    Wait(2.0),
    Do("toggle-dissipated-energy"),
    Do("clear-ghosts"),
    Do("previous-stage"),
    Wait(0.5),
    Do("toggle-manual"),
    Repeat(12, 0.25, "pull-coarse"),
    Repeat(8, 0.25, "press-coarse"),
    Repeat(8, 0.25, "pull-coarse"),
    Wait(1.0),
    Do("separate"),
    Wait(2.0),
    Open("non-adhesive"),
    Wait(LOOP),
    Open("fragment-closeup"),
    Wait(6.0),
    Do("toggle-play"),
    Repeat(4, 1.0, "next-patch"),
    Open("rough-sphere"),
    Wait(LOOP),
    Do("pin"),
    Select("roughness"),
    Wait(1.0),
    Do("toggle-effect"),
    Do("restart"),
    Wait(LOOP),
];

/// One scene that is pressed and pulled off, with its contact patches.
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
        assert!(
            names.len() > 15
                && names
                    .iter()
                    .all(|name| bindings.named(name, Context::Explore).is_some()),
            "{names:?}"
        );
    }
}
