//! Coordinates for a search over a range of numbers, such as logarithms of the numbers, and the
//! numbers that are allowed in this range.

use super::axis::{Axis, Target};
use asperity_data::AxisScale;
use asperity_scene::Scene;
use asperity_scene::fields::{Field, Range};

/// Relative deviation from a whole number below which a quotient counts as this whole number.
const ROUNDING: f64 = 1e-9;

/// Rule that states which values of a number of a scene a search may try. Values between the
/// allowed ones would give the same contact, or are not possible in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Allowed {
    /// Any value.
    Any,
    /// Whole numbers.
    Whole,
    /// Wavelengths that fit a whole number of times on the profile. The contained number is the
    /// length of the profile.
    Fractions(f64),
    /// Lengths of the profile that are whole multiples of a wavelength, so that a whole number of
    /// waves fits on the profile. The contained number is this wavelength.
    Multiples(f64),
}

impl Allowed {
    /// Returns which values the quantity of `axis` may have in a scene.
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

    /// Returns the number of waves, whole or not, that fit on the profile if the searched
    /// wavelength or length is `number`. If the searched number must itself be whole, `number` is
    /// returned. `None` if any value is allowed.
    pub fn count(self, number: f64) -> Option<f64> {
        match self {
            Allowed::Any => None,
            Allowed::Whole => Some(number),
            Allowed::Fractions(whole) => Some(whole / number),
            Allowed::Multiples(unit) => Some(number / unit),
        }
    }

    /// Returns the value that belongs to a whole number of waves (the inverse of
    /// [`Allowed::count`]).
    fn of_count(self, count: f64) -> f64 {
        match self {
            Allowed::Any | Allowed::Whole => count,
            Allowed::Fractions(whole) => whole / count,
            Allowed::Multiples(unit) => unit * count,
        }
    }

    /// Returns the allowed value nearest to `number`. An allowed wavelength or length has at least
    /// one wave on the profile.
    pub fn nearest(self, number: f64) -> f64 {
        match (self, self.count(number)) {
            (_, None) => number,
            (Allowed::Whole, Some(count)) => count.round(),
            (_, Some(count)) => self.of_count(count.round().max(1.0)),
        }
    }

    /// Returns the allowed value nearest to `number` that differs from the allowed value nearest to
    /// `present`. The returned value lies in the direction from `present` to `number`. `None` if
    /// there is no such value, because at least one wave must fit on the profile.
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

    /// Returns the smallest and the largest allowed value in a range; `None` if the range contains
    /// no allowed value.
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

/// Rounds a count up to a whole number. A count that exceeds a whole number only by a rounding
/// error becomes this whole number.
fn rounded_up(count: f64) -> f64 {
    (count * (1.0 - ROUNDING * count.signum())).ceil()
}

/// Rounds a count down to a whole number. A count that is below a whole number only by a rounding
/// error becomes this whole number.
fn rounded_down(count: f64) -> f64 {
    (count * (1.0 + ROUNDING * count.signum())).floor()
}

/// Function that converts a number to a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Map {
    /// The linear or logarithmic scale of an axis.
    Scale(AxisScale),
    /// Inverse hyperbolic sine of the number divided by this unit. This function is linear near
    /// zero, and logarithmic far from zero for positive and negative numbers.
    BothSides(f64),
}

/// Coordinates of a searched range. A coordinate is a function of a number, such as its logarithm.
/// The first numbers that are tried have equally spaced coordinates. Only allowed numbers are used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinates {
    map: Map,
    allowed: Allowed,
    /// Smallest and largest allowed number of the range.
    ends: [f64; 2],
}

impl Coordinates {
    /// Creates coordinates on a linear or logarithmic scale for the allowed numbers in `range`. If
    /// the smallest of these numbers is not above zero, the scale is linear. Returns `None` if the
    /// range contains no allowed number.
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

    /// Creates coordinates for a range that contains positive and negative numbers. They are
    /// approximately linear for magnitudes below `unit` and logarithmic for larger magnitudes.
    pub fn on_both_sides(unit: f64, range: [f64; 2]) -> Coordinates {
        Coordinates {
            map: Map::BothSides(unit),
            allowed: Allowed::Any,
            ends: range,
        }
    }

    /// Returns the coordinate of a number: on a linear scale the number itself, and on a
    /// logarithmic scale its decadic logarithm.
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

    /// Returns an allowed number whose coordinate is near the middle between the coordinates of two
    /// numbers. `None` if no allowed number lies between them.
    pub fn middle(&self, ends: [f64; 2]) -> Option<f64> {
        let [from, to] = ends;
        let middle = self.number(f64::midpoint(self.coordinate(from), self.coordinate(to)));
        if from < middle && middle < to {
            return Some(middle);
        }
        // The middle may be rounded to one of the ends although an allowed number lies between
        // them. The allowed number next to `from` is then returned.
        let first = self.allowed.count(from)?.round();
        let last = self.allowed.count(to)?.round();
        let steps = last - first;
        (steps.abs() >= 2.0).then(|| self.allowed.of_count(first + steps.signum()))
    }

    /// Returns the difference between the coordinates of the two ends of the range. On a linear
    /// scale a coordinate is the number itself; on a logarithmic scale it is its decadic logarithm.
    pub fn length(&self) -> f64 {
        self.coordinate(self.ends[1]) - self.coordinate(self.ends[0])
    }

    /// Converts a relative difference between two numbers to the difference between their
    /// coordinates. `share` is the relative difference. `places` are two numbers of the range. The
    /// conversion is valid near that one of them which has the larger magnitude.
    pub fn distance(&self, share: f64, places: [f64; 2]) -> f64 {
        let place = places[0].abs().max(places[1].abs());
        match self.map {
            Map::Scale(AxisScale::Linear) => share * place,
            Map::Scale(AxisScale::Logarithmic) => share * std::f64::consts::LOG10_E,
            Map::BothSides(_) => share * place.tanh(),
        }
    }

    /// Returns true if not every number is allowed, but only whole numbers, for example, or certain
    /// wavelengths.
    pub fn is_discrete(&self) -> bool {
        self.allowed != Allowed::Any
    }

    /// Returns all allowed numbers between the two numbers `ends`, sorted from `ends[0]` to
    /// `ends[1]`. `None` if every number is allowed, or if there are more than `most` allowed
    /// numbers.
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

    /// Returns numbers that divide the range into `intervals` nearly equal intervals, including the
    /// ends of the range. If the range has at most `most` allowed numbers, all of them are returned
    /// instead. The second returned value states whether all allowed numbers are returned.
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
