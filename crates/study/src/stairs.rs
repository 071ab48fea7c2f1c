//! Crossings of quantities that follow from the adhesion force over the preload, which rises in
//! steps and is constant between two steps.

use super::bracket::WITHIN;
use super::coordinates::Coordinates;
use super::preloads::SAME;
use super::scan::{Tried, side};
use asperity_scene::RunError;

/// Largest number of preloads that are computed on one profile.
const MOST: usize = 4096;
/// Largest ratio of the ends of an interval of preloads that is halved, instead of its logarithm.
const WIDE: f64 = 4.0;
/// Share of the searched range below which no step of F_a is located.
const LEAST: f64 = 1e-20;
/// Ratio of the ends of the interval that is cut off from an interval from 0 N.
const FROM_ZERO: f64 = 16.0;
/// Smallest share of the range, in coordinates, to which an interval with a step is halved if it
/// has no crossing.
const NARROWEST: f64 = 1.0 / 4096.0;

/// A preload in N with the adhesion force F_a in N after it and the value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stair {
    pub preload: f64,
    pub adhesion_force: f64,
    pub value: f64,
}

/// Function that computes the stairs of ascending preloads.
pub(super) type Climb<'c> = dyn FnMut(&[f64]) -> Result<Vec<Stair>, RunError> + 'c;

/// Crossings in ascending order, and whether some may be missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Crossings {
    pub numbers: Vec<f64>,
    pub may_miss: bool,
}

/// Two preloads with the stairs between them.
#[derive(Clone, Copy, Debug)]
struct Flight {
    low: Stair,
    high: Stair,
}

/// What is known about the crossings of a flight.
enum Found {
    Nothing,
    Crossing(f64),
    /// There may be crossings on both sides of this preload.
    Split(f64),
}

impl Flight {
    fn has_step(&self) -> bool {
        let low = self.low.adhesion_force;
        let high = self.high.adhesion_force;
        high - low > SAME * high.abs()
    }

    /// Looks for preloads at which F_a is `ratio` times the preload. `depth` is the number of
    /// splits before, and `range` the length of the searched range in N.
    fn look(&self, ratio: f64, depth: usize, range: f64) -> Found {
        let low = self.low;
        let high = self.high;
        let is_above = [low, high].map(|stair| stair.adhesion_force - ratio * stair.preload > 0.0);
        let crossed = is_above[0] != is_above[1];
        if !self.has_step() {
            let crossing = (low.adhesion_force / ratio).clamp(low.preload, high.preload);
            return if crossed {
                Found::Crossing(crossing)
            } else {
                Found::Nothing
            };
        }
        // F_a is between the forces at both ends.
        if high.adhesion_force < ratio * low.preload || low.adhesion_force > ratio * high.preload {
            return Found::Nothing;
        }
        let width = high.preload - low.preload;
        if width <= (WITHIN * high.preload).max(LEAST * range) {
            let end = if is_above[0] { low } else { high };
            return if crossed {
                Found::Crossing(end.preload)
            } else {
                Found::Nothing
            };
        }
        // On the stair of the lower end the crossing is here. Above the second preload the ratio is
        // smaller everywhere.
        let stair = if is_above[0] { low } else { high };
        let preload = at_most(stair.adhesion_force, ratio);
        if depth.is_multiple_of(2) && low.preload < preload && preload < high.preload {
            return Found::Split(preload);
        }
        Found::Split(middle(low.preload, high.preload))
    }
}

/// Returns the smallest preload at which this force divided by the preload is at most `ratio`.
fn at_most(force: f64, ratio: f64) -> f64 {
    let mut preload = force / ratio;
    while force - ratio * preload > 0.0 {
        preload = preload.next_up();
    }
    preload
}

/// Returns a preload between two others.
fn middle(low: f64, high: f64) -> f64 {
    if low <= 0.0 {
        high / FROM_ZERO
    } else if high > WIDE * low {
        (low * high).sqrt()
    } else {
        f64::midpoint(low, high)
    }
}

/// Returns the preloads between two others, at least 0 N, at which F_a is `ratio` times the
/// preload. The ratio is above zero.
pub(super) fn ratio_crossings(
    ends: [f64; 2],
    ratio: f64,
    climb: &mut Climb<'_>,
) -> Result<Crossings, RunError> {
    let stairs = climb(&ends)?;
    let mut flights = vec![Flight {
        low: stairs[0],
        high: stairs[1],
    }];
    let mut crossings = Crossings::default();
    let mut computed = 0;
    for depth in 0.. {
        let mut splits = Vec::new();
        let mut open = Vec::new();
        for flight in flights {
            match flight.look(ratio, depth, ends[1] - ends[0]) {
                Found::Nothing => {}
                Found::Crossing(preload) => crossings.numbers.push(preload),
                Found::Split(preload) => {
                    splits.push(preload);
                    open.push(flight);
                }
            }
        }
        computed += splits.len();
        if splits.is_empty() || computed > MOST {
            crossings.may_miss = !splits.is_empty();
            break;
        }
        flights = halves(&open, &climb(&splits)?);
    }
    crossings.numbers.sort_by(f64::total_cmp);
    Ok(crossings)
}

/// Returns the two parts of each flight that is split at a stair.
fn halves(flights: &[Flight], stairs: &[Stair]) -> Vec<Flight> {
    let mut parts = Vec::with_capacity(2 * flights.len());
    for (flight, &stair) in flights.iter().zip(stairs) {
        parts.push(Flight {
            low: flight.low,
            high: stair,
        });
        parts.push(Flight {
            low: stair,
            high: flight.high,
        });
    }
    parts
}

/// Returns neighbouring stairs between which a quantity passes the target that is constant wherever
/// F_a is constant. The second value is true if such a pair may be missing, because two steps are
/// closer together than the stairs.
pub(super) fn step_crossings(
    coordinates: &Coordinates,
    target: f64,
    climb: &mut Climb<'_>,
) -> Result<(Vec<[Tried; 2]>, bool), RunError> {
    let (numbers, _) = coordinates.spread(super::scan::INTERVALS, super::scan::INTERVALS);
    let stairs = climb(&numbers)?;
    let mut flights: Vec<Flight> = stairs
        .windows(2)
        .map(|pair| Flight {
            low: pair[0],
            high: pair[1],
        })
        .collect();
    let mut crossed = Vec::new();
    let mut computed = 0;
    let mut may_miss = false;
    while !flights.is_empty() {
        let mut splits = Vec::new();
        let mut open = Vec::new();
        for flight in flights {
            let ends = [flight.low, flight.high];
            let tried = ends.map(|stair| Tried {
                number: stair.preload,
                value: stair.value,
            });
            let places = ends.map(|stair| coordinates.coordinate(stair.preload));
            let is_narrow = places[1] - places[0] <= NARROWEST * coordinates.length();
            let middle = coordinates.middle([flight.low.preload, flight.high.preload]);
            let middle = middle.filter(|_| flight.has_step() && !is_narrow && computed < MOST);
            if let Some(middle) = middle {
                computed += 1;
                splits.push(middle);
                open.push(flight);
            } else if side(tried[0], target) != side(tried[1], target) {
                crossed.push(tried);
            } else {
                may_miss |= flight.has_step();
            }
        }
        flights = if splits.is_empty() {
            Vec::new()
        } else {
            halves(&open, &climb(&splits)?)
        };
    }
    crossed.sort_by(|one, other| one[0].number.total_cmp(&other[0].number));
    Ok((crossed, may_miss))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Stairs with the adhesion force after the last of the steps (preload, adhesion force) up to a
    /// preload.
    fn stairs(steps: &[(f64, f64)], preloads: &[f64]) -> Vec<Stair> {
        let stair = |&preload: &f64| {
            let adhesion_force = steps
                .iter()
                .rev()
                .find(|step| step.0 <= preload)
                .map_or(0.0, |step| step.1);
            Stair {
                preload,
                adhesion_force,
                value: adhesion_force / preload,
            }
        };
        preloads.iter().map(stair).collect()
    }

    #[test]
    fn ratios_cross_where_the_steps_say() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut most = 0;
        for case in 0..400 {
            // Steps over eight decades of preloads, the first at or above 0 N.
            let first = if case % 2 == 0 { 0.0 } else { 1e-9 };
            let mut steps = vec![(first, 1e-7 * random.random::<f64>())];
            for _ in 0..random.random_range(0..40) {
                let last = steps[steps.len() - 1];
                let preload = last.0 + 10_f64.powf(-8.0 + 6.0 * random.random::<f64>());
                steps.push((
                    preload,
                    last.1 + 10_f64.powf(-8.0 + 6.0 * random.random::<f64>()),
                ));
            }
            let ratio = 10_f64.powf(-2.0 + 5.0 * random.random::<f64>());
            let ends = [0.0, 0.5 * steps[steps.len() - 1].0 + 1e-3];
            let found =
                ratio_crossings(ends, ratio, &mut |preloads| Ok(stairs(&steps, preloads))).unwrap();
            // In closed form, from stair to stair.
            let mut expected = Vec::new();
            let mut is_above = steps[0].0 == 0.0;
            for (index, &(preload, force)) in steps.iter().enumerate() {
                let next = steps.get(index + 1).map_or(f64::INFINITY, |step| step.0);
                if !is_above && force > ratio * preload {
                    expected.push(preload);
                    is_above = true;
                }
                if is_above && force <= ratio * next {
                    expected.push(force / ratio);
                    is_above = false;
                }
            }
            expected.retain(|preload| *preload < ends[1]);
            most = most.max(expected.len());
            assert!(
                !found.may_miss && found.numbers.len() == expected.len(),
                "{case}: {found:?} {expected:?}"
            );
            for (number, exact) in found.numbers.iter().zip(&expected) {
                assert!(
                    (number / exact - 1.0).abs() < 2.0 * WITHIN,
                    "{case}: {found:?} {expected:?} {steps:?} {ratio}"
                );
            }
        }
        assert!(most > 4, "{most}");
    }
}
