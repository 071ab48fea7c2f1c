//! Options for reading a measured curve, as rows in the explorer's list of parameters.

use super::measured::Measured;
use asperity_data::{exact_quantity, format_quantity, in_unit, parse_quantity, unit_of};
use asperity_experiment::{CurveOptions, Drift, Negate, Tilt};
use asperity_scene::fields::{Field, Range};
use asperity_scene::text::ron_float;
use std::ops::Bound::{Excluded, Included};

/// Path of the group of rows that belong to the measured curve in the list of parameters.
pub const GROUP: &str = "measured";

/// Heading of the group of rows that belong to the measured curve. It shows the name of the file.
pub static HEAD: Field = Field::beside(GROUP, "measured curve", Range::Group, "");

/// Function that writes a number with its unit, as text.
type Format = fn(f64, &str) -> String;

/// Row in the list of parameters for one option that states how to read the measured curve. The
/// user types the value of the option as on the command line.
pub struct CurveOptionRow {
    pub field: Field,
    /// Text that is shown if the option is not set.
    pub usual: &'static str,
    /// Values through which the arrow keys step. The first is the text for an option that is not
    /// set. Empty if the value can only be typed.
    choices: &'static [&'static str],
    /// Returns the value of the option as the user would type it; `None` if the option is not set.
    /// The function of type `Format` writes forces.
    written: fn(&CurveOptions, Format) -> Option<String>,
    /// Sets the option to a typed value. An empty text unsets the option.
    take: fn(&mut CurveOptions, &str) -> Result<(), String>,
}

const TEXT: Range = Range::Text {
    least: 0,
    most: 4096,
    lines: false,
};
const FORCE: Range = Range::Real(Included(-1e6), Included(1e6));
/// Allowed range of a length in m.
const LENGTH: Range = Range::Real(Excluded(0.0), Included(1e3));
const NEGATED: &[&str] = &["by the approach", "none", "displacement", "force", "both"];
const KEPT: &[&str] = &["keep", "remove"];

const fn option(
    path: &'static str,
    name: &'static str,
    range: Range,
    meaning: &'static str,
) -> Field {
    Field::beside(path, name, range, meaning)
}

/// All options for reading a measured curve, in the order of the list of parameters. Options
/// without which certain files cannot be read come first.
pub static OPTIONS: [CurveOptionRow; 10] = [
    CurveOptionRow {
        field: option(
            "measured.columns",
            "columns",
            TEXT,
            "columns of displacement, force and segment by names or numbers (--columns): height,force or 2,3",
        ),
        usual: "by their names",
        choices: &[],
        written: |options, _| listed(&options.columns),
        take: |options, typed| {
            options.columns = words(typed);
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.units",
            "units",
            TEXT,
            "units of displacement and force (--units): nm,nN, or nm,3nN for a deflection in nm with 3 N/m",
        ),
        usual: "of the file",
        choices: &[],
        written: |options, _| listed(&options.units),
        take: |options, typed| {
            options.units = words(typed);
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.segments",
            "segments used",
            TEXT,
            "numbers of the segments without pauses (--segments): 1 is the first approach, 2 its retraction",
        ),
        usual: "all",
        choices: &["all", "1,2", "2", "1"],
        written: |options, _| listed(&options.segments.iter().map(ToString::to_string).collect::<Vec<_>>()),
        take: |options, typed| {
            options.segments = segments(typed)?;
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.ramp",
            "travel of the piezo",
            LENGTH,
            "travel over which the forces of a file with one column are spaced, there and back (--ramp)",
        )
        .in_unit("m"),
        usual: "of the file",
        choices: &[],
        written: |options, format| options.ramp.map(|ramp| format(ramp, "m")),
        take: |options, typed| {
            options.ramp = quantity(typed, "m")?;
            match options.ramp {
                Some(ramp) if ramp <= 0.0 => Err("allowed: a length above 0, such as 500 nm".to_owned()),
                _ => Ok(()),
            }
        },
    },
    CurveOptionRow {
        field: option(
            "measured.negate",
            "reversed quantity",
            Range::Choice(NEGATED),
            "quantity whose sign is reversed, so that pressing is positive (--negate)",
        ),
        usual: "by the approach",
        choices: NEGATED,
        written: |options, _| options.negate.map(|negate| negate.to_string()),
        take: |options, typed| {
            options.negate = reversed_quantity(typed)?;
            Ok(())
        },
    },
    CurveOptionRow {
        field: option("measured.zero", "zero of the force", FORCE, "measured force that is zero (--zero)")
            .in_unit("N"),
        usual: "by the curve",
        choices: &[],
        written: |options, format| options.zero.map(|zero| format(zero, "N")),
        take: |options, typed| {
            options.zero = quantity(typed, "N")?;
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.drift",
            "drift over time",
            TEXT,
            "straight line over time that is taken off (--drift): keep, remove, or a force over the curve",
        ),
        usual: "keep",
        choices: KEPT,
        written: |options, format| match options.drift {
            Drift::Keep => None,
            Drift::Remove => Some("remove".to_owned()),
            Drift::Known(force) => Some(format(force, "N")),
        },
        take: |options, typed| {
            options.drift = if typed.is_empty() { Drift::Keep } else { typed.parse()? };
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.tilt",
            "tilt over displacement",
            Range::Choice(KEPT),
            "straight line over the displacement, the virtual deflection, that is taken off (--tilt)",
        ),
        usual: "keep",
        choices: KEPT,
        written: |options, _| (options.tilt == Tilt::Remove).then(|| "remove".to_owned()),
        take: |options, typed| {
            options.tilt = match typed {
                "" => Tilt::Keep,
                "remove" => Tilt::Remove,
                _ => return Err(not_among(typed, KEPT)),
            };
            Ok(())
        },
    },
    CurveOptionRow {
        field: option(
            "measured.noise",
            "noise",
            FORCE,
            "standard deviation of the force (--noise); without it the standard deviation before contact",
        )
        .in_unit("N"),
        usual: "by the curve",
        choices: &[],
        written: |options, format| options.noise.map(|noise| format(noise, "N")),
        take: |options, typed| {
            options.noise = quantity(typed, "N")?;
            match options.noise {
                Some(noise) if noise <= 0.0 => {
                    Err("allowed: a standard deviation above 0, such as 2 nN".to_owned())
                }
                _ => Ok(()),
            }
        },
    },
    CurveOptionRow {
        field: option(
            "measured.free_points",
            "points before contact",
            TEXT,
            "number of the points before contact (--free-points)",
        ),
        usual: "by the curve",
        choices: &[],
        written: |options, _| options.free_points.map(|count| count.to_string()),
        take: |options, typed| {
            options.free_points = count(typed)?;
            Ok(())
        },
    },
];

/// Splits a text at its commas, and removes blanks around the words.
fn words(typed: &str) -> Vec<String> {
    typed
        .split(',')
        .map(|word| word.trim().to_owned())
        .filter(|word| !word.is_empty())
        .collect()
}

fn listed(words: &[String]) -> Option<String> {
    (!words.is_empty()).then(|| words.join(","))
}

fn quantity(typed: &str, unit: &str) -> Result<Option<f64>, String> {
    if typed.is_empty() {
        return Ok(None);
    }
    parse_quantity(typed, unit)
        .map(Some)
        .map_err(|error| error.to_string())
}

/// Returns the error message for a typed value that is not one of the choices.
fn not_among(typed: &str, choices: &'static [&'static str]) -> String {
    format!("{typed}: allowed: {}", Range::Choice(choices))
}

/// Reads the numbers of segments, separated by commas. The first segment has the number 1.
fn segments(typed: &str) -> Result<Vec<usize>, String> {
    let mut numbers = Vec::new();
    for word in words(typed) {
        match word.parse::<usize>() {
            Ok(number) if number > 0 => numbers.push(number),
            _ => return Err(format!("{typed}: allowed: numbers from 1 on, such as 1,2")),
        }
    }
    Ok(numbers)
}

fn reversed_quantity(typed: &str) -> Result<Option<Negate>, String> {
    if typed.is_empty() {
        return Ok(None);
    }
    let choices = [
        Negate::None,
        Negate::Displacement,
        Negate::Force,
        Negate::Both,
    ];
    for negate in choices {
        if negate.to_string() == typed {
            return Ok(Some(negate));
        }
    }
    Err(not_among(typed, NEGATED))
}

fn count(typed: &str) -> Result<Option<usize>, String> {
    if typed.is_empty() {
        return Ok(None);
    }
    match typed.parse() {
        Ok(count) => Ok(Some(count)),
        Err(_) => Err(format!("{typed}: allowed: a whole number of points")),
    }
}

impl CurveOptionRow {
    /// Returns the value of this option as the list of parameters shows it.
    pub fn shown(&self, measured: &Measured) -> String {
        let given = (self.written)(&measured.options, format_quantity);
        given.unwrap_or_else(|| match self.field.path {
            "measured.noise" => format!("= {}", format_quantity(measured.curve.noise, "N")),
            _ => self.usual.to_owned(),
        })
    }

    /// Returns a text that explains this option, followed by its allowed values or by the meaning
    /// of an empty text.
    pub fn explanation(&self) -> String {
        let meaning = self.field.meaning;
        match self.field.range {
            Range::Choice(_) => format!("{meaning}. Allowed: {}", self.field.allowed()),
            _ => format!("{meaning}. Empty: {}", self.usual),
        }
    }

    /// Returns the text that the user edits to change this option. The text is empty if the option
    /// is not set.
    pub fn editable(&self, options: &CurveOptions) -> String {
        (self.written)(options, exact_quantity).unwrap_or_default()
    }

    /// Returns true if this option is set in `options`.
    pub fn is_set(&self, options: &CurveOptions) -> bool {
        (self.written)(options, format_quantity).is_some()
    }

    /// Returns the value of this option as text for a list of changes.
    pub fn in_words(&self, options: &CurveOptions) -> String {
        (self.written)(options, format_quantity).unwrap_or_else(|| self.usual.to_owned())
    }

    /// Returns the value of this option as a number in the notation of a scene file; `None` if the
    /// option is not set or is not a force.
    pub fn value(&self, options: &CurveOptions) -> Option<String> {
        if self.field.unit != "N" {
            return None;
        }
        let written = (self.written)(options, exact_quantity)?;
        let force = parse_quantity(&written, self.field.unit).ok()?;
        Some(ron_float(force))
    }

    /// Adds a unit to a typed force that has no unit. This is the unit of the present value or, if
    /// the present value is not a force, the unit of the noise. A value that is not a force is
    /// returned unchanged.
    pub fn with_unit(&self, measured: &Measured, typed: &str) -> String {
        let is_force = self.field.unit == "N" || self.field.path == "measured.drift";
        if !is_force {
            return typed.to_owned();
        }
        let shown = self.shown(measured);
        let shown_unit = unit_of(&shown);
        if shown_unit.ends_with('N') {
            return in_unit(typed, shown_unit);
        }
        let noise = format_quantity(measured.curve.noise, "N");
        in_unit(typed, unit_of(&noise))
    }

    /// Returns a copy of `options` in which this option has a typed value. The option is removed if
    /// the text is empty, or if it is the text that the list shows for an option that is not set.
    ///
    /// # Errors
    /// Returns the reason if the option cannot have this value.
    pub fn with(&self, options: &CurveOptions, typed: &str) -> Result<CurveOptions, String> {
        let mut changed = options.clone();
        let typed = typed.trim();
        let value = if typed == self.usual { "" } else { typed };
        (self.take)(&mut changed, value)?;
        Ok(changed)
    }

    /// Returns the allowed value that follows the present value of this option, or precedes it if
    /// `forwards` is false. `None` if the option has no list of allowed values, so that the user
    /// must type the value.
    pub fn next_choice(&self, options: &CurveOptions, forwards: bool) -> Option<&'static str> {
        let last = self.choices.len().checked_sub(1)?;
        let present = self.in_words(options);
        let next = match self.choices.iter().position(|choice| *choice == present) {
            Some(place) if forwards && place < last => place + 1,
            Some(place) if !forwards => place.checked_sub(1).unwrap_or(last),
            // The first choice follows the last one, and any value that is not one of the choices.
            _ => 0,
        };
        self.choices.get(next).copied()
    }
}

/// Returns the differences between two sets of options as text, such as
/// `noise by the curve → 2 nN`.
pub fn changes(from: &CurveOptions, to: &CurveOptions) -> Vec<String> {
    let mut changes = Vec::new();
    for option in &OPTIONS {
        let before = option.in_words(from);
        let after = option.in_words(to);
        if before != after {
            changes.push(format!("{} {before} → {after}", option.field.name));
        }
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::command_line::curve_arguments;
    use clap::Args;
    use std::collections::BTreeSet;

    #[test]
    fn options_are_typed_as_on_the_command_line() {
        let with = |path: &str, typed: &str| {
            let option = OPTIONS
                .iter()
                .find(|option| option.field.last() == path)
                .unwrap();
            option
                .with(&CurveOptions::default(), typed)
                .map(|options| curve_arguments(&options))
        };
        for row in [
            "columns|height, force| --columns=height,force",
            "units|nm,3nN| --units=nm,3nN",
            "segments|1, 2| --segments=1,2",
            "segments|all|",
            "negate|force| --negate=force",
            "negate|by the approach|",
            "zero|-2 nN| --zero=-2e-9N",
            "drift|remove| --drift=remove",
            "drift|3 nN| --drift=3e-9N",
            "drift|keep|",
            "tilt|remove| --tilt=remove",
            "noise|2nN| --noise=2e-9N",
            "free_points|40| --free-points=40",
            "free_points||",
        ] {
            let [path, typed, written] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            assert_eq!(with(path, typed).as_deref(), Ok(written), "{row}");
        }
        for row in [
            "segments|0|0: allowed: numbers from 1 on, such as 1,2",
            "negate|sideways|sideways: allowed: by the approach, none, displacement, force or both",
            "tilt|3 nN|3 nN: allowed: keep or remove",
            "noise|-2 nN|allowed: a standard deviation above 0, such as 2 nN",
            "noise|2 nm|nm is not a unit of force: use N, mN, µN, nN",
            "free_points|few|few: allowed: a whole number of points",
        ] {
            let [path, typed, why] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            assert_eq!(with(path, typed), Err(why.to_owned()), "{row}");
        }
    }

    #[test]
    fn every_option_of_the_command_line_has_its_row() {
        let command = CurveOptions::augment_args(clap::Command::new("curve"));
        let names: BTreeSet<&str> = command
            .get_arguments()
            .map(|argument| argument.get_id().as_str())
            .collect();
        assert_eq!(
            names,
            OPTIONS.iter().map(|option| option.field.last()).collect()
        );
    }

    #[test]
    fn arrows_go_through_all_choices_both_ways() {
        for option in OPTIONS.iter().filter(|option| !option.choices.is_empty()) {
            for forwards in [true, false] {
                let mut options = CurveOptions::default();
                for _ in option.choices {
                    let next = option.next_choice(&options, forwards).unwrap();
                    options = option.with(&options, next).unwrap();
                }
                assert_eq!(options, CurveOptions::default(), "{}", option.field.path);
            }
        }
    }
}
