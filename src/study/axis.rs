//! Axes of a parameter study: the varied number of a scene and its values.

use super::target::{Target, TargetError};
use crate::text::printable;
use serde::{Deserialize, Serialize};

/// Most values on one axis.
pub const MOST_VALUES: u64 = 1_000_000;

/// Significant digits of values between the ends of an axis: 0.15 rather than 0.15000000000000002.
const DIGITS: usize = 12;

/// An axis in the form of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Axis {
    /// Values at equal distances, both ends included.
    Linear {
        /// Path of the varied field, or a derived quantity.
        path: String,
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values, at least 2.
        count: u64,
    },
    /// Values at equal ratios, both ends included.
    Logarithmic {
        /// Path of the varied quantity.
        path: String,
        /// First value, above zero.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values, at least 2.
        count: u64,
    },
    /// These values.
    List {
        /// Path of the varied quantity.
        path: String,
        /// Values, all different.
        values: Vec<f64>,
    },
}

impl Axis {
    /// Path of the varied quantity.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            Axis::Linear { path, .. } | Axis::Logarithmic { path, .. } | Axis::List { path, .. } => path,
        }
    }

    /// Returns true for values at equal ratios, which have a logarithmic scale in figures.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        matches!(self, Axis::Logarithmic { .. })
    }

    /// Number of values.
    #[must_use]
    pub fn count(&self) -> u64 {
        match self {
            Axis::Linear { count, .. } | Axis::Logarithmic { count, .. } => *count,
            Axis::List { values, .. } => values.len() as u64,
        }
    }

    /// The `index`-th value. Those between the ends are rounded to 12 significant digits, and where the field
    /// holds whole numbers, to the nearest of these.
    #[must_use]
    pub fn value(&self, index: u64) -> f64 {
        let rounded = |value: f64| match Target::of(self.path()) {
            Ok(target) if target.is_whole() => value.round(),
            _ => format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value),
        };
        match self {
            Axis::List { values, .. } => values.get(index as usize).copied().unwrap_or(f64::NAN),
            Axis::Linear { from, .. } | Axis::Logarithmic { from, .. } if index == 0 => *from,
            Axis::Linear { to, count, .. } | Axis::Logarithmic { to, count, .. } if index + 1 >= *count => {
                *to
            }
            Axis::Linear { from, to, count, .. } => {
                let share = index as f64 / (count - 1) as f64;
                rounded(from * (1.0 - share) + to * share)
            }
            Axis::Logarithmic { from, to, count, .. } => {
                let share = index as f64 / (count - 1) as f64;
                rounded((from.ln() * (1.0 - share) + to.ln() * share).exp())
            }
        }
    }

    /// All values of the axis.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        (0..self.count()).map(|index| self.value(index)).collect()
    }

    /// Places of the values in the order of ascending values.
    pub(super) fn ascending(&self) -> Vec<u64> {
        let mut places: Vec<u64> = (0..self.count()).collect();
        places.sort_by(|a, b| self.value(*a).total_cmp(&self.value(*b)));
        places
    }

    /// Error of this axis alone.
    pub(super) fn wrong(&self) -> Option<String> {
        let path = &*printable(self.path());
        let target = match Target::of(path) {
            Ok(target) => target,
            Err(TargetError { near, .. }) => {
                let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
                return Some(format!(
                    "axis {path}: no such number{near} (allowed: numbers of a scene by their paths, and {})",
                    super::target::DERIVED.join(", ")
                ));
            }
        };
        let wrong = |what: String| Some(format!("axis {path}: {what}"));
        match self {
            Axis::Linear { count, .. } | Axis::Logarithmic { count, .. }
                if !(2..=MOST_VALUES).contains(count) =>
            {
                return wrong(format!("count = {count}: allowed: from 2 to {MOST_VALUES}"));
            }
            Axis::Linear { from, to, .. } | Axis::Logarithmic { from, to, .. }
                if !(from.is_finite() && to.is_finite()) =>
            {
                return wrong(format!("from {from:?} to {to:?}: both ends must be finite"));
            }
            Axis::Linear { from, to, .. } | Axis::Logarithmic { from, to, .. } if from >= to => {
                return wrong(format!("from {from:?} to {to:?}: it must begin below its end"));
            }
            Axis::Linear { from, to, .. } if !(to - from).is_finite() => {
                return wrong(format!("from {from:?} to {to:?}: this is too far for numbers"));
            }
            Axis::Logarithmic { from, .. } if *from <= 0.0 => {
                return wrong(format!("from {from:?}: a logarithmic axis begins above 0"));
            }
            Axis::List { values, .. } if values.is_empty() => {
                return wrong("no values; allowed: at least one".into());
            }
            Axis::List { values, .. } if values.len() as u64 > MOST_VALUES => {
                return wrong(format!("{} values; allowed: at most {MOST_VALUES}", values.len()));
            }
            Axis::List { values, .. } => {
                if let Some(value) = values.iter().find(|value| !value.is_finite()) {
                    return wrong(format!("{value:?}: values must be finite"));
                }
            }
            _ => {}
        }
        let mut values = self.values();
        if target.is_whole()
            && let Some(value) = values.iter().find(|value| **value < 0.0 || value.fract() != 0.0)
        {
            return wrong(format!("{value:?}: allowed: whole numbers"));
        }
        values.sort_by(f64::total_cmp);
        let twice = values.windows(2).find(|pair| pair[0] == pair[1]);
        twice.and_then(|pair| wrong(format!("the value {:?} appears twice", pair[0])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(path: &str, from: f64, to: f64, count: u64) -> Axis {
        Axis::Linear { path: path.into(), from, to, count }
    }

    #[test]
    fn values_are_what_people_expect() {
        assert_eq!(
            linear("roughness.hurst", 0.1, 0.9, 17).values()[..4],
            [0.1, 0.15, 0.2, 0.25],
            "no digits of rounding"
        );
        let decades = Axis::Logarithmic { path: "adhesion.work".into(), from: 1e-3, to: 10.0, count: 5 };
        assert_eq!(decades.values(), [1e-3, 1e-2, 0.1, 1.0, 10.0]);
        let points = Axis::Logarithmic { path: "numerics.points".into(), from: 256.0, to: 4096.0, count: 9 };
        assert_eq!(points.values()[..4], [256.0, 362.0, 512.0, 724.0], "whole numbers");
    }

    #[test]
    fn errors_are_stated() {
        let list = |values: &[f64]| Axis::List { path: "kappa".into(), values: values.to_vec() };
        for (axis, said) in [
            (linear("roughness.hurts", 0.1, 0.9, 3), "did you mean roughness.hurst?"),
            (linear("kapa", 0.1, 0.9, 3), "did you mean kappa?"),
            (linear("kappa", 2.0, 1.0, 3), "it must begin below its end"),
            (linear("kappa", 1.0, 1.0, 3), "it must begin below its end"),
            (linear("kappa", f64::NAN, 1.0, 3), "both ends must be finite"),
            (linear("kappa", -1e308, 1.7e308, 3), "too far"),
            (linear("kappa", 1.0, 2.0, 1), "count = 1: allowed: from 2 to 1000000"),
            (linear("kappa", 1.0, 2.0, u64::MAX), "allowed: from 2 to 1000000"),
            (Axis::Logarithmic { path: "kappa".into(), from: 0.0, to: 1.0, count: 3 }, "begins above 0"),
            (list(&[]), "no values"),
            (list(&[1.0, f64::INFINITY]), "values must be finite"),
            (list(&[1.0, 2.0, 1.0]), "the value 1.0 appears twice"),
            (linear("numerics.points", 2.0, 4.0, 9), "appears twice"),
            (linear("numerics.points", 2.5, 4.0, 2), "2.5: allowed: whole numbers"),
        ] {
            let wrong = axis.wrong().unwrap_or_default();
            assert!(wrong.contains(said), "{axis:?}: {wrong}");
        }
        assert_eq!(list(&[3.0, 1.0]).wrong(), None);
    }
}
