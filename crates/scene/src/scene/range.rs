//! Allowed values of fields: checks of values, and descriptions of the allowed values for users.

use std::fmt;
use std::ops::Bound::{Excluded, Included};
use std::ops::{Bound, RangeBounds};

/// Allowed values of a field of a scene: the kind of the value, such as a real number or a text,
/// and its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// A finite real number between two bounds. Each bound is included or excluded, or there is no
    /// bound.
    Real(Bound<f64>, Bound<f64>),
    /// An integer from the first to the second bound, both included.
    Whole(u64, u64),
    /// A pair `(first, last)` of integers with first ≤ last. Both integers lie between the two
    /// numbers of this variant, which are included.
    Band(u64, u64),
    /// A pair `(longest, shortest)` of wavelengths in m with longest ≥ shortest. Both wavelengths
    /// lie between the two numbers of this variant, which are included.
    Wavelengths(f64, f64),
    /// Text without control characters; line breaks may be allowed.
    Text {
        /// Smallest allowed number of characters.
        least: usize,
        /// Largest allowed number of characters.
        most: usize,
        /// True if line breaks are allowed.
        lines: bool,
    },
    /// A choice among alternatives, such as the forms of a body. The list has each alternative in
    /// RON, with example values, such as `Cone(angle: 0.1)`.
    Choice(&'static [&'static str]),
    /// A list of `least` to `most` elements. The kind of an element is one of the kinds in `of`.
    List {
        /// Allowed kinds of elements. Each kind is written in RON, with example values.
        of: &'static [&'static str],
        /// Smallest allowed number of elements.
        least: usize,
        /// Largest allowed number of elements.
        most: usize,
    },
    /// A group of further fields, such as the elastic constants. Each of these fields has its own
    /// range.
    Group,
}

impl Range {
    /// Returns the range from `min` to `max`, both included.
    pub(super) const fn closed(min: f64, max: f64) -> Range {
        Range::Real(Included(min), Included(max))
    }

    /// Returns the range above `min` and up to `max`, which is included.
    pub(super) const fn above(min: f64, max: f64) -> Range {
        Range::Real(Excluded(min), Included(max))
    }

    /// Returns the range above `min` and below `max`.
    pub(super) const fn between(min: f64, max: f64) -> Range {
        Range::Real(Excluded(min), Excluded(max))
    }

    /// Returns true if this is a range of real numbers or of wavelengths, and `value` is between
    /// its bounds. Returns false for any other kind of range, and for NaN and infinity.
    pub fn contains(&self, value: f64) -> bool {
        match *self {
            Range::Real(min, max) => value.is_finite() && (min, max).contains(&value),
            Range::Wavelengths(min, max) => (min..=max).contains(&value),
            _ => false,
        }
    }

    /// Returns true if this is a range of integers, or of pairs of integers, and `value` is between
    /// its bounds. Returns false for any other kind of range.
    pub fn contains_whole(&self, value: u64) -> bool {
        matches!(*self, Range::Whole(min, max) | Range::Band(min, max) if (min..=max).contains(&value))
    }

    /// Returns the lower and the upper bound of a range of numbers. A bound is returned even if the
    /// range excludes the bound itself. Returns `None` for a range without numbers or without two
    /// bounds.
    pub fn ends(&self) -> Option<(f64, f64)> {
        match *self {
            Range::Real(Included(min) | Excluded(min), Included(max) | Excluded(max)) => {
                Some((min, max))
            }
            Range::Whole(min, max) | Range::Band(min, max) => Some((min as f64, max as f64)),
            Range::Wavelengths(min, max) => Some((min, max)),
            _ => None,
        }
    }
}

/// Returns the name at the beginning of a choice: `Cone` for `Cone(angle: 0.1)`. A choice without a
/// name is returned unchanged.
pub(super) fn choice_name(choice: &str) -> &str {
    match choice.split_once('(') {
        Some((name, _)) if !name.is_empty() => name,
        _ => choice,
    }
}

/// Returns the part that identifies a choice: its name, or the first field of a group without a
/// name.
pub(super) fn choice_key(choice: &str) -> &str {
    let name = choice_name(choice.trim());
    match name.split_once(':') {
        Some((first_field, _)) if name.starts_with('(') => first_field,
        _ => name,
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Range::Real(min, max) => match (min.map(Number), max.map(Number)) {
                (Included(min), Included(max)) if min.0 == max.0 => write!(f, "{min}"),
                (Included(min), Included(max)) => write!(f, "from {min} to {max}"),
                (Excluded(min), Excluded(max)) => write!(f, "above {min} and below {max}"),
                (Excluded(min), Included(max)) => write!(f, "above {min}, at most {max}"),
                (Included(min), Excluded(max)) => write!(f, "at least {min} and below {max}"),
                _ => f.write_str("a number"),
            },
            Range::Whole(min, max) if min == max => write!(f, "{min}"),
            Range::Whole(min, max) => write!(f, "a whole number from {min} to {max}"),
            Range::Band(min, max) => {
                write!(
                    f,
                    "a pair (first, last) of whole numbers from {min} to {max}, first ≤ last"
                )
            }
            Range::Wavelengths(min, max) => {
                write!(
                    f,
                    "a pair (longest, shortest), longest ≥ shortest, both from {:e} to {}",
                    min,
                    Number(max)
                )
            }
            Range::Text { least, most, lines } => {
                let kind = if lines { "text of" } else { "one line of" };
                write!(f, "{kind} {} characters", counts(least, most))
            }
            Range::Choice(choices) => f.write_str(&listed(choices, "or")),
            Range::List { of, least, most } => {
                write!(
                    f,
                    "a list of {}, of {}",
                    counts(least, most),
                    listed(of, "and")
                )
            }
            Range::Group => f.write_str("a group of fields"),
        }
    }
}

fn counts(least: usize, most: usize) -> String {
    if least == 0 {
        format!("at most {most}")
    } else {
        format!("{least} to {most}")
    }
}

/// Returns the names of the choices as a phrase, with the word `last` before the last name:
/// `Cone, Punch or None`.
fn listed(choices: &[&str], last: &str) -> String {
    let names: Vec<&str> = choices.iter().map(|choice| choice_name(choice)).collect();
    match names.split_last() {
        Some((end, others)) if !others.is_empty() => format!("{} {last} {end}", others.join(", ")),
        _ => names.concat(),
    }
}

/// A bound of a range. `Display` writes it in the usual notation: `0.5`, `1e13`, `π/2`.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.abs() {
            std::f64::consts::FRAC_PI_2 => f.write_str("π/2"),
            size if size != 0.0 && !(1e-3..1e5).contains(&size) => write!(f, "{:e}", self.0),
            _ => write!(f, "{}", self.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_decide_at_the_ends() {
        for (range, at_zero, at_one) in [
            (Range::closed(0.0, 1.0), true, true),
            (Range::between(0.0, 1.0), false, false),
            (Range::above(0.0, 1.0), false, true),
        ] {
            assert_eq!(
                (range.contains(0.0), range.contains(1.0)),
                (at_zero, at_one),
                "{range}"
            );
        }
        let everything = Range::closed(f64::NEG_INFINITY, f64::INFINITY);
        assert!(everything.contains(1.0));
        assert!(
            ![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]
                .iter()
                .any(|value| everything.contains(*value))
        );
    }
}
