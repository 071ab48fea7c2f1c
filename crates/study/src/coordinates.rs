//! Coordinates along a searched range, and the values that a number can have in it.

use super::axis::{Axis, Target};
use asperity_data::AxisScale;
use asperity_scene::Scene;
use asperity_scene::fields::{Field, Range};

/// Largest relative deviation of a quotient from a whole number that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Values that a number of a scene can have so that each value is another contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Allowed {
    /// Any value.
    Any,
    /// Whole numbers.
    Whole,
    /// This number divided by whole numbers: wavelengths, of which a whole number fits on the
    /// length of the profile.
    Fractions(f64),
    /// Whole multiples of this number: lengths of the profile on which a whole number of given
    /// wavelengths fits.
    Multiples(f64),
}

impl Allowed {
    /// Returns the values that the number of this axis can have in a scene.
    pub fn of(axis: &Axis, scene: &Scene) -> Allowed {
        match axis.target {
            Target::Number(Field {
                range: Range::Wavelengths(..),
                ..
            }) => Allowed::Fractions(scene.length),
            Target::Number(Field { path: "length", .. }) => {
                let longest = scene.number("roughness.wavelengths.0");
                longest.map_or(Allowed::Any, Allowed::Multiples)
            }
            Target::SpringsPerWave => Allowed::Fractions(scene.numerics.points as f64),
            _ if axis.is_whole() => Allowed::Whole,
            _ => Allowed::Any,
        }
    }

    /// Returns the whole number that belongs to a value: the number of waves. `None` if any value
    /// is allowed.
    pub fn count(self, number: f64) -> Option<f64> {
        match self {
            Allowed::Any => None,
            Allowed::Whole => Some(number),
            Allowed::Fractions(whole) => Some(whole / number),
            Allowed::Multiples(unit) => Some(number / unit),
        }
    }

    /// Returns the value to which a whole number belongs.
    fn of_count(self, count: f64) -> f64 {
        match self {
            Allowed::Any | Allowed::Whole => count,
            Allowed::Fractions(whole) => whole / count,
            Allowed::Multiples(unit) => unit * count,
        }
    }

    /// Returns the nearest allowed value. A wave fits at least once.
    pub fn nearest(self, number: f64) -> f64 {
        match (self, self.count(number)) {
            (_, None) => number,
            (Allowed::Whole, Some(count)) => count.round(),
            (_, Some(count)) => self.of_count(count.round().max(1.0)),
        }
    }

    /// Returns the allowed value nearest to `number` that is not the value nearest to `present`, on
    /// the same side of it as `number`. Returns `None` if there is no such value, since a wave fits
    /// at least once.
    pub fn nearest_other(self, present: f64, number: f64) -> Option<f64> {
        let (Some(from), Some(to)) = (self.count(present), self.count(number)) else {
            return Some(number);
        };
        let from = from.round();
        let to = to.round();
        let rises = (number > present) != matches!(self, Allowed::Fractions(_));
        let next = if rises {
            to.max(from + 1.0)
        } else {
            to.min(from - 1.0)
        };
        let is_allowed = next >= 1.0 || self == Allowed::Whole;
        is_allowed.then(|| self.of_count(next))
    }

    /// Returns the smallest and the largest allowed value of a range; `None` if the range has no
    /// allowed value.
    fn ends(range: [f64; 2], allowed: Allowed) -> Option<[f64; 2]> {
        let [from, to] = range;
        let ends = match allowed {
            Allowed::Any => [from, to],
            Allowed::Whole => [rounded_up(from), rounded_down(to)],
            Allowed::Fractions(whole) => {
                let most = rounded_down(whole / from);
                let least = rounded_up(whole / to).max(1.0);
                [whole / most, whole / least]
            }
            Allowed::Multiples(unit) => {
                let least = rounded_up(from / unit).max(1.0);
                let most = rounded_down(to / unit);
                [unit * least, unit * most]
            }
        };
        (ends[0] <= ends[1]).then_some(ends)
    }
}

/// Rounds a count up, unless it exceeds a whole number by rounding alone.
fn rounded_up(count: f64) -> f64 {
    (count * (1.0 - ROUNDING * count.signum())).ceil()
}

/// Rounds a count down, unless it is below a whole number by rounding alone.
fn rounded_down(count: f64) -> f64 {
    (count * (1.0 + ROUNDING * count.signum())).floor()
}

/// How coordinates follow from numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Map {
    /// The scale of an axis.
    Scale(AxisScale),
    /// Inverse hyperbolic sine of the number in this unit: linear near zero and logarithmic far
    /// from it.
    BothSides(f64),
}

/// Coordinates along a searched range. Numbers are spread evenly on them, and only allowed values
/// are used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinates {
    map: Map,
    allowed: Allowed,
    /// Smallest and largest allowed number of the range.
    ends: [f64; 2],
}

impl Coordinates {
    /// Creates coordinates on a scale. A range that begins at or below zero is linear. Returns
    /// `None` if the range has no allowed value.
    pub fn on(scale: AxisScale, range: [f64; 2], allowed: Allowed) -> Option<Coordinates> {
        let ends = Allowed::ends(range, allowed)?;
        let scale = if ends[0] > 0.0 {
            scale
        } else {
            AxisScale::Linear
        };
        Some(Coordinates {
            map: Map::Scale(scale),
            allowed,
            ends,
        })
    }

    /// Creates coordinates of numbers of either sign which are linear up to `unit` and logarithmic
    /// beyond.
    pub fn on_both_sides(unit: f64, range: [f64; 2]) -> Coordinates {
        Coordinates {
            map: Map::BothSides(unit),
            allowed: Allowed::Any,
            ends: range,
        }
    }

    /// Returns the coordinate of a number.
    pub fn coordinate(&self, number: f64) -> f64 {
        match self.map {
            Map::Scale(scale) => scale.coordinate(number),
            Map::BothSides(unit) => (number / unit).asinh(),
        }
    }

    /// Returns the allowed number that is nearest to a coordinate.
    pub fn number(&self, coordinate: f64) -> f64 {
        let number = match self.map {
            Map::Scale(scale) => scale.number(coordinate),
            Map::BothSides(unit) => unit * coordinate.sinh(),
        };
        self.allowed
            .nearest(number)
            .clamp(self.ends[0], self.ends[1])
    }

    /// Returns the allowed number in the middle between two numbers; `None` if there is no further
    /// number between them.
    pub fn middle(&self, ends: [f64; 2]) -> Option<f64> {
        let [from, to] = ends;
        let middle = self.number(f64::midpoint(self.coordinate(from), self.coordinate(to)));
        if from < middle && middle < to {
            return Some(middle);
        }
        // Rounding may return an end although a whole number lies between them.
        let first = self.allowed.count(from)?.round();
        let last = self.allowed.count(to)?.round();
        let steps = last - first;
        (steps.abs() >= 2.0).then(|| self.allowed.of_count(first + steps.signum()))
    }

    /// Returns the length of the range in coordinates.
    pub fn length(&self) -> f64 {
        self.coordinate(self.ends[1]) - self.coordinate(self.ends[0])
    }

    /// Returns the distance in coordinates of two numbers with the relative difference `share`. The
    /// numbers have about the coordinate in `places` that is farther from zero.
    pub fn distance(&self, share: f64, places: [f64; 2]) -> f64 {
        let place = places[0].abs().max(places[1].abs());
        match self.map {
            Map::Scale(AxisScale::Linear) => share * place,
            Map::Scale(AxisScale::Logarithmic) => share * std::f64::consts::LOG10_E,
            Map::BothSides(_) => share * place.tanh(),
        }
    }

    /// Returns true if only some numbers are allowed, such as whole ones.
    pub fn is_discrete(&self) -> bool {
        self.allowed != Allowed::Any
    }

    /// Returns all allowed numbers between two others, in ascending order; `None` if any number is
    /// allowed or if there are more than `most`.
    pub fn all_between(&self, ends: [f64; 2], most: usize) -> Option<Vec<f64>> {
        let [from, to] = ends;
        let first = self.allowed.count(from)?.round();
        let last = self.allowed.count(to)?.round();
        let low = first.min(last);
        let high = first.max(last);
        if high - low >= most as f64 {
            return None;
        }
        let mut all = Vec::new();
        for index in 0..=(high - low) as u64 {
            all.push(self.allowed.of_count(low + index as f64).clamp(from, to));
        }
        all.sort_by(f64::total_cmp);
        Some(all)
    }

    /// Returns the allowed numbers spread over the range in `intervals` intervals, or all of them
    /// if these are at most `most`. The second value is true if these are all allowed numbers.
    pub fn spread(&self, intervals: usize, most: usize) -> (Vec<f64>, bool) {
        if let Some(all) = self.all_between(self.ends, most) {
            return (all, true);
        }
        let [from, to] = self.ends;
        let first = self.coordinate(from);
        let length = self.length();
        let mut numbers = vec![from];
        for index in 1..intervals {
            numbers.push(self.number(first + length * (index as f64 / intervals as f64)));
        }
        numbers.push(to);
        numbers.dedup();
        (numbers, false)
    }
}
