//! Crossings of quantities that depend on the preload only through the preload itself and the
//! pull-off force F_a. F_a rises in steps and is constant between two steps.

use super::bracket::WITHIN;
use super::coordinates::Coordinates;
use super::preloads::SAME;
use super::scan::{Tried, side};
use asperity_scene::RunError;

/// Largest number of preloads at which one profile is computed.
const MOST: usize = 4096;
/// Largest ratio of the ends of an interval of preloads that is divided in its middle. A wider
/// interval is divided in the middle on a logarithmic scale.
const WIDE: f64 = 4.0;
/// Smallest width of an interval, as a share of the searched range. A step of F_a is not located
/// more precisely.
const LEAST: f64 = 1e-20;
/// An interval that begins at 0 N is divided at its upper end divided by this factor.
const FROM_ZERO: f64 = 16.0;
/// An interval that contains a step but no crossing is not divided if it is narrower than this
/// share of the range in coordinates.
const NARROWEST: f64 = 1.0 / 4096.0;

/// A preload in N with the pull-off force F_a in N after this preload, and the value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stair {
    pub preload: f64,
    pub pull_off_force: f64,
    pub value: f64,
}

/// Function that computes a [`Stair`] for each of several ascending preloads.
pub(super) type Climb<'c> = dyn FnMut(&[f64]) -> Result<Vec<Stair>, RunError> + 'c;

/// Ascending numbers at which a quantity crosses its target. `may_miss` is true if some crossings
/// may be missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Crossings {
    pub numbers: Vec<f64>,
    pub may_miss: bool,
}

/// Interval between two preloads, with the pull-off force at each end.
#[derive(Clone, Copy, Debug)]
struct Flight {
    low: Stair,
    high: Stair,
}

/// Result of the search for crossings in one interval.
enum Found {
    Nothing,
    Crossing(f64),
    /// There may be crossings below and above this preload.
    Split(f64),
}

impl Flight {
    fn has_step(&self) -> bool {
        let low = self.low.pull_off_force;
        let high = self.high.pull_off_force;
        high - low > SAME * high.abs()
    }

    /// Searches the interval for preloads at which F_a is `ratio` times the preload. `depth` is the
    /// number of divisions that led to this interval, and `range` is the length of the searched
    /// range in N.
    fn look(&self, ratio: f64, depth: usize, range: f64) -> Found {
        let low = self.low;
        let high = self.high;
        let is_above = [low, high].map(|stair| stair.pull_off_force - ratio * stair.preload > 0.0);
        let crossed = is_above[0] != is_above[1];
        if !self.has_step() {
            let crossing = (low.pull_off_force / ratio).clamp(low.preload, high.preload);
            return if crossed {
                Found::Crossing(crossing)
            } else {
                Found::Nothing
            };
        }
        // F_a never falls, so inside the interval it lies between its values at the ends. These
        // values show that F_a over the preload cannot cross the target `ratio`.
        if high.pull_off_force < ratio * low.preload || low.pull_off_force > ratio * high.preload {
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
        // If the lower end is above the target, the interval is divided where F_a of the lower end
        // gives the target: the quotient crosses the target there, unless F_a has a step before. If
        // the lower end is below the target, the interval is divided where F_a of the upper end
        // gives the target: at higher preloads the quotient is smaller than the target.
        let stair = if is_above[0] { low } else { high };
        let preload = at_most(stair.pull_off_force, ratio);
        if depth.is_multiple_of(2) && low.preload < preload && preload < high.preload {
            return Found::Split(preload);
        }
        Found::Split(middle(low.preload, high.preload))
    }
}

/// Returns the smallest preload at which `force` divided by the preload is at most `ratio`.
fn at_most(force: f64, ratio: f64) -> f64 {
    let mut preload = force / ratio;
    while force - ratio * preload > 0.0 {
        preload = preload.next_up();
    }
    preload
}

/// Returns the preload at which an interval between two preloads is divided.
fn middle(low: f64, high: f64) -> f64 {
    if low <= 0.0 {
        high / FROM_ZERO
    } else if high > WIDE * low {
        (low * high).sqrt()
    } else {
        f64::midpoint(low, high)
    }
}

/// Returns the preloads in N at which the pull-off force F_a is `ratio` times the preload. `ends`
/// are the smallest and the largest searched preload in N, zero or above. `ratio` is above zero.
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

/// Divides each interval at the preload of a computed stair, and returns both parts.
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

/// Finds the crossings of a quantity that is constant except where the pull-off force F_a jumps.
/// Returns pairs of neighbouring preloads between which the quantity crosses the target. The second
/// value is true if a pair may be missing. A pair may be missing if two jumps are closer together
/// than the computed preloads.
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
    crossed.sort_by(|first, second| first[0].number.total_cmp(&second[0].number));
    Ok((crossed, may_miss))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Returns a stair at each preload. Its pull-off force is that of the last step at or below the
    /// preload. `steps` are pairs of preload and pull-off force.
    fn stairs(steps: &[(f64, f64)], preloads: &[f64]) -> Vec<Stair> {
        let stair = |&preload: &f64| {
            let pull_off_force = steps
                .iter()
                .rev()
                .find(|step| step.0 <= preload)
                .map_or(0.0, |step| step.1);
            Stair {
                preload,
                pull_off_force,
                value: pull_off_force / preload,
            }
        };
        preloads.iter().map(stair).collect()
    }

    #[test]
    fn ratios_cross_where_the_steps_say() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut most = 0;
        for case in 0..400 {
            // The steps lie in eight decades of preloads. The first step is at 0 N or above it.
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
            // Between two steps F_a is constant, so the expected crossings are known in closed
            // form.
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
