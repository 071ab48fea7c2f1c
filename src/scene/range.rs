//! Ranges of fields: checks of values and readable text.

use std::fmt;

/// One end of an interval of real numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// The end itself belongs to the interval.
    Closed(f64),
    /// The end itself does not belong to the interval.
    Open(f64),
}

impl End {
    /// The number at this end.
    pub fn value(self) -> f64 {
        match self {
            End::Closed(value) | End::Open(value) => value,
        }
    }
}

/// Allowed values of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// A finite real number.
    Real {
        /// Smallest.
        min: End,
        /// Largest.
        max: End,
    },
    /// A whole number, both ends included.
    Whole {
        /// Smallest.
        min: u64,
        /// Largest.
        max: u64,
    },
    /// A pair `(first, last)` of whole numbers, first ≤ last, both within these ends.
    Band {
        /// Smallest.
        min: u64,
        /// Largest.
        max: u64,
    },
    /// Text without control characters.
    Text {
        /// Fewest characters.
        least: usize,
        /// Most characters.
        most: usize,
        /// True if line breaks are allowed.
        lines: bool,
    },
    /// One of these, each a valid value as text.
    Choice(&'static [&'static str]),
    /// A list of at most `most` of these, each a valid value as text.
    List {
        /// Allowed elements.
        of: &'static [&'static str],
        /// Fewest elements.
        least: usize,
        /// Most elements.
        most: usize,
    },
    /// A group of fields.
    Group,
}

impl Range {
    /// From `min` to `max`, both included.
    pub const fn closed(min: f64, max: f64) -> Range {
        Range::Real { min: End::Closed(min), max: End::Closed(max) }
    }

    /// Above `min`, up to and including `max`.
    pub const fn above(min: f64, max: f64) -> Range {
        Range::Real { min: End::Open(min), max: End::Closed(max) }
    }

    /// Above `min` and below `max`.
    pub const fn between(min: f64, max: f64) -> Range {
        Range::Real { min: End::Open(min), max: End::Open(max) }
    }

    /// Whole numbers from `min` to `max`, both included.
    pub const fn whole(min: u64, max: u64) -> Range {
        Range::Whole { min, max }
    }

    /// Returns true for an allowed real number; NaN and the infinities never are.
    pub fn contains(&self, value: f64) -> bool {
        let Range::Real { min, max } = *self else {
            return false;
        };
        let above = match min {
            End::Closed(end) => value >= end,
            End::Open(end) => value > end,
        };
        let below = match max {
            End::Closed(end) => value <= end,
            End::Open(end) => value < end,
        };
        value.is_finite() && above && below
    }

    /// Returns true for an allowed integer.
    pub fn contains_whole(&self, value: u64) -> bool {
        match *self {
            Range::Whole { min, max } | Range::Band { min, max } => (min..=max).contains(&value),
            _ => false,
        }
    }

    /// The smallest number, for a numeric field.
    pub fn min(&self) -> Option<f64> {
        match *self {
            Range::Real { min, .. } => Some(min.value()),
            Range::Whole { min, .. } | Range::Band { min, .. } => Some(min as f64),
            _ => None,
        }
    }

    /// The largest number, for a numeric field.
    pub fn max(&self) -> Option<f64> {
        match *self {
            Range::Real { max, .. } => Some(max.value()),
            Range::Whole { max, .. } | Range::Band { max, .. } => Some(max as f64),
            _ => None,
        }
    }
}

/// The name at the beginning of a choice: `Cone` of `Cone(angle: 0.1)`, the whole text without one.
pub(super) fn choice_name(choice: &str) -> &str {
    match choice.find('(') {
        Some(0) | None => choice,
        Some(end) => &choice[..end],
    }
}

/// The distinguishing part of a choice: its name, or the first field of a group without a name.
pub(super) fn choice_key(choice: &str) -> &str {
    let choice = choice.trim();
    let key = choice_name(choice);
    key.split_once(':').filter(|_| key.starts_with('(')).map_or(key, |(key, _)| key)
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Range::Real { min: End::Closed(min), max: End::Closed(max) } if min == max => {
                write!(f, "{}", Number(min))
            }
            Range::Real { min: End::Closed(min), max: End::Closed(max) } => {
                write!(f, "from {} to {}", Number(min), Number(max))
            }
            Range::Real { min: End::Open(min), max: End::Open(max) } => {
                write!(f, "above {} and below {}", Number(min), Number(max))
            }
            Range::Real { min: End::Open(min), max: End::Closed(max) } => {
                write!(f, "above {}, at most {}", Number(min), Number(max))
            }
            Range::Real { min: End::Closed(min), max: End::Open(max) } => {
                write!(f, "at least {} and below {}", Number(min), Number(max))
            }
            Range::Whole { min, max } if min == max => write!(f, "{min}"),
            Range::Whole { min, max } => write!(f, "a whole number from {min} to {max}"),
            Range::Band { min, max } => {
                write!(f, "a pair (first, last) of whole numbers from {min} to {max}, first ≤ last")
            }
            Range::Text { least, most, lines } => {
                f.write_str(if lines { "text of " } else { "one line of " })?;
                match least {
                    0 => write!(f, "at most {most} characters"),
                    least => write!(f, "{least} to {most} characters"),
                }
            }
            Range::Choice(choices) => write_choices(f, choices, "or"),
            Range::List { of, least, most } => {
                match least {
                    0 => write!(f, "a list of at most {most}, of ")?,
                    least => write!(f, "a list of {least} to {most}, of ")?,
                }
                write_choices(f, of, "and")
            }
            Range::Group => f.write_str("a group of fields"),
        }
    }
}

fn write_choices(f: &mut fmt::Formatter<'_>, choices: &[&str], last: &str) -> fmt::Result {
    for (index, choice) in choices.iter().enumerate() {
        match index {
            0 => {}
            index if index + 1 == choices.len() => write!(f, " {last} ")?,
            _ => f.write_str(", ")?,
        }
        f.write_str(choice_name(choice))?;
    }
    Ok(())
}

/// A bound in common notation: `0.5`, `1e13`, `π/2`.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == std::f64::consts::FRAC_PI_2 {
            f.write_str("π/2")
        } else if size != 0.0 && !(1e-3..1e5).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_decide_at_the_ends() {
        assert!(Range::closed(0.0, 1.0).contains(0.0));
        assert!(Range::closed(0.0, 1.0).contains(1.0));
        assert!(!Range::between(0.0, 1.0).contains(0.0));
        assert!(!Range::between(0.0, 1.0).contains(1.0));
        assert!(!Range::above(0.0, 1.0).contains(0.0));
        assert!(Range::above(0.0, 1.0).contains(1.0));
        assert!(Range::whole(2, 4).contains_whole(4));
        assert!(!Range::whole(2, 4).contains_whole(5));
    }

    #[test]
    fn what_is_not_finite_is_nowhere() {
        let everything = Range::closed(f64::NEG_INFINITY, f64::INFINITY);
        assert!(everything.contains(1.0));
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!everything.contains(value));
        }
    }

    #[test]
    fn ranges_read_as_sentences() {
        for (range, text) in [
            (Range::between(0.0, 1.0), "above 0 and below 1"),
            (Range::closed(1.0, 1e13), "from 1 to 1e13"),
            (Range::above(-1.0, 0.5), "above -1, at most 0.5"),
            (Range::between(0.0, std::f64::consts::FRAC_PI_2), "above 0 and below π/2"),
            (Range::whole(1, 1), "1"),
            (Range::closed(1.0, 1.0), "1"),
            (Range::whole(2, 1_000_000), "a whole number from 2 to 1000000"),
            (Range::Choice(&["Cone(angle: 0.1)", "Punch(radius: 1.0)", "None"]), "Cone, Punch or None"),
        ] {
            assert_eq!(range.to_string(), text);
        }
    }
}
