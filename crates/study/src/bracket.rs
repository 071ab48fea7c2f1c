//! Search for the number at which a quantity reaches a target. The search starts with two numbers
//! between which the quantity crosses the target.

use super::coordinates::Coordinates;
use super::scan::Tried;
use asperity_scene::RunError;
use std::mem::replace;

/// Relative width of an interval at which the search ends. The interval contains the sought number.
pub const WITHIN: f64 = 1e-9;

/// The search also ends when the interval has this width, as a share of the searched range. This
/// limit is needed for a sought number near zero, whose relative precision has no meaning.
const LEAST: f64 = 1e-18;

/// Way in which a quantity reaches a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Passage {
    pub target: f64,
    /// True if the quantity reaches exactly the target and then remains equal to it. False if the
    /// quantity crosses the target.
    pub falls_onto: bool,
}

impl Passage {
    /// Returns a number whose sign states on which side of the target `value` lies: zero or
    /// positive on the side that contains the answer, negative on the other side. The result is
    /// negative if `value` is NaN. A quantity is NaN if the scene does not allow the number that
    /// the search tries.
    fn excess(self, value: f64) -> f64 {
        let excess = value - self.target;
        if self.falls_onto {
            // Only a sign is returned, so that the search bisects: the quantity is constant at the
            // target, and interpolation would not help.
            return if excess <= 0.0 { 1.0 } else { -1.0 };
        }
        if excess.is_nan() {
            -1.0 - self.target.abs()
        } else {
            excess
        }
    }
}

/// End of the interval: coordinate of a number, and [`Passage::excess`] at this number.
#[derive(Clone, Copy, Debug)]
struct Point {
    place: f64,
    excess: f64,
}

/// Narrows the interval between `ends` by the method of Chandrupatla: inverse quadratic
/// interpolation where the quantity is smooth enough, otherwise bisection. Of the two ends of the
/// last interval, returns the one at which the quantity has reached the target. If only whole
/// numbers are allowed, the interval is bisected until no whole number lies between its ends.
pub(super) fn passage(
    coordinates: &Coordinates,
    passage: Passage,
    ends: [Tried; 2],
    value: &mut dyn FnMut(f64) -> Result<f64, RunError>,
) -> Result<f64, RunError> {
    if coordinates.is_discrete() {
        return between_whole(coordinates, passage, ends, value);
    }
    let [mut other, mut last] = ends.map(|tried| Point {
        place: coordinates.coordinate(tried.number),
        excess: passage.excess(tried.value),
    });
    let floor = LEAST * coordinates.length();
    let mut share: f64 = 0.5;
    loop {
        let width = (other.place - last.place).abs();
        let least = coordinates
            .distance(WITHIN, [last.place, other.place])
            .max(floor);
        // The next point keeps a distance from both ends, so that the interval can become narrower
        // at either end.
        let margin = (0.5 * least / width).min(0.5);
        let place = last.place + share.clamp(margin, 1.0 - margin) * (other.place - last.place);
        if width <= least || place == last.place || place == other.place {
            let end = if last.excess >= 0.0 { last } else { other };
            let number = coordinates.number(end.place);
            // If the result is an end that was given, its number is returned as it was given,
            // without the rounding error of the conversion from its coordinate.
            let known = ends
                .iter()
                .find(|tried| coordinates.coordinate(tried.number) == end.place);
            return Ok(known.map_or(number, |tried| tried.number));
        }
        let next = Point {
            place,
            excess: passage.excess(value(coordinates.number(place))?),
        };
        let same_side = (next.excess >= 0.0) == (last.excess >= 0.0);
        let before = if same_side {
            last
        } else {
            replace(&mut other, last)
        };
        last = next;
        share = interpolated(last, other, before);
    }
}

/// Returns the position of the next point as a share of the distance from `last` to `other`. It is
/// the point at which an inverse quadratic interpolation of the excess is zero, or the middle if
/// the three points are not suitable for interpolation.
fn interpolated(last: Point, other: Point, before: Point) -> f64 {
    let place_share = (last.place - other.place) / (before.place - other.place);
    let excess_share = (last.excess - other.excess) / (before.excess - other.excess);
    let is_smooth = excess_share * excess_share < place_share
        && (1.0 - excess_share).powi(2) < 1.0 - place_share;
    if !is_smooth {
        return 0.5;
    }
    let far = before.excess / (other.excess - before.excess);
    let near = other.excess / (before.excess - other.excess);
    let shift = (before.place - last.place) / (other.place - last.place);
    let share = last.excess / (other.excess - last.excess) * far
        + shift * last.excess / (before.excess - last.excess) * near;
    if share.is_nan() { 0.5 } else { share }
}

/// Bisects an interval in which only some numbers, such as whole numbers, are allowed.
fn between_whole(
    coordinates: &Coordinates,
    passage: Passage,
    ends: [Tried; 2],
    value: &mut dyn FnMut(f64) -> Result<f64, RunError>,
) -> Result<f64, RunError> {
    let [mut from, mut to] = ends.map(|tried| tried.number);
    let to_is_inside = passage.excess(ends[1].value) >= 0.0;
    while let Some(middle) = coordinates.middle([from, to]) {
        let is_inside = passage.excess(value(middle)?) >= 0.0;
        if is_inside == to_is_inside {
            to = middle;
        } else {
            from = middle;
        }
    }
    Ok(if to_is_inside { to } else { from })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coordinates::Allowed;
    use asperity_data::AxisScale;

    /// Returns the number at which an increasing function reaches a target, and the number of calls
    /// of the function.
    fn searched(
        coordinates: &Coordinates,
        ends: [f64; 2],
        target: f64,
        function: &dyn Fn(f64) -> f64,
    ) -> (f64, usize) {
        let mut calls = 0;
        let mut value = |number| {
            calls += 1;
            Ok(function(number))
        };
        let tried = ends.map(|number| Tried {
            number,
            value: function(number),
        });
        let number = passage(
            coordinates,
            Passage {
                target,
                falls_onto: false,
            },
            tried,
            &mut value,
        )
        .unwrap();
        (number, calls)
    }

    /// Tests smooth curves and steps over many decades, with ranges that begin at zero or above
    /// zero.
    #[test]
    fn numbers_have_the_stated_precision() {
        let functions: [(&dyn Fn(f64) -> f64, f64); 6] = [
            (
                &|number| 1.0 - (-number / 1e-6).exp(),
                1e-6 * std::f64::consts::LN_2,
            ),
            (&|number| number / (number + 1e-9), 1e-9),
            (&|number| number.powf(0.1), 0.5_f64.powi(10)),
            (&|number| if number < 3.3e-8 { 0.0 } else { 1.0 }, 3.3e-8),
            (&|number| number.powi(9), 0.5_f64.powf(1.0 / 9.0)),
            // This function is nearly vertical up to the target and nearly constant above it.
            (&|number| (number / 2.7e-7).min(1.0) + number / 1e6, 1.35e-7),
        ];
        for (function, exact) in functions {
            for from in [0.0, 1e-12] {
                let ends = [from, 1.0];
                for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
                    let coordinates = Coordinates::on(scale, ends, Allowed::Any).unwrap();
                    let (number, calls) = searched(&coordinates, ends, 0.5, function);
                    assert!(
                        (number / exact - 1.0).abs() < 2.0 * WITHIN,
                        "{number} {exact} {scale:?} {from}"
                    );
                    assert!(function(number) >= 0.5 && calls < 70, "{number} {calls}");
                }
                let coordinates = Coordinates::on_both_sides(1e-5, ends);
                let (number, _) = searched(&coordinates, ends, 0.5, function);
                assert!(
                    (number / exact - 1.0).abs() < 4.0 * WITHIN,
                    "{number} {exact}"
                );
            }
        }
    }
}
