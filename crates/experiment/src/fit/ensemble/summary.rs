//! A curve as a few logarithms. The same code serves measured and computed curves.

use super::branches::{Branches, Point};

/// Number of summaries of a curve, without its preload.
pub(crate) const SUMMARIES: usize = 11;
/// Names of the summaries in words.
pub(crate) const NAMES: [&str; SUMMARIES] = [
    "pull-off force",
    "area of the loop",
    "work of the tension on retraction",
    "way back to half of the preload",
    "way from half of the preload on approach",
    "way back to zero force",
    "way from a tenth of the preload on approach",
    "way back to the pull-off",
    "way back to the loss of contact",
    "largest tension on approach",
    "work of the tension on approach",
];
/// Indices of the summaries that the result gives in their units.
pub(crate) const PULL_OFF: usize = 0;
pub(crate) const LOOP_AREA: usize = 1;
pub(crate) const WAY_TO_HALF: usize = 3;

/// Smallest pull-off force, smallest tension that does work, and largest force after loss of
/// contact, in units of the noise.
const FLOOR: f64 = 3.0;
const TENSION: f64 = 2.0;
const LOST: f64 = 5.0;

/// Natural logarithms of forces in N, distances in m and energies in J.
pub(crate) type Summaries = [f64; SUMMARIES];

/// Computes the summaries of a curve whose preload in N is known. Distances are counted from the
/// turning point, so that the displacement at first touch has no effect. Places between points are
/// interpolated, because summaries that count points would change in steps with the parameters.
pub(crate) fn summaries(branches: &Branches, preload: f64) -> Summaries {
    let Branches {
        approach,
        retraction,
        noise,
        ..
    } = branches;
    let backwards: Vec<Point> = approach.iter().rev().copied().collect();
    let range = retraction[0].0 - retraction[retraction.len() - 1].0;
    let spacing = range.abs() / retraction.len() as f64;
    let least_force = FLOOR * noise;
    // Noise of an integral over all points.
    let least_work = least_force * spacing * (retraction.len() as f64).sqrt();
    let way = |branch: &[Point], level: f64| (-below(branch, level)).max(spacing);
    let (deepest, place) = largest_tension(retraction);
    let area = work(approach, |force| force) + work(retraction, |force| force);
    let tension = |force: f64| (-force - TENSION * noise).max(0.0);
    [
        deepest.max(least_force),
        area.max(least_work),
        (-work(retraction, tension)).max(least_work),
        way(retraction, 0.5 * preload),
        way(&backwards, 0.5 * preload),
        way(retraction, 0.0),
        way(&backwards, 0.1 * preload),
        (-place).max(spacing),
        (-loss(retraction, LOST * noise)).max(spacing),
        largest_tension(approach).0.max(least_force),
        work(approach, tension).max(least_work),
    ]
    .map(f64::ln)
}

/// Integrates a function of the force over the displacement, J.
fn work(branch: &[Point], of: impl Fn(f64) -> f64) -> f64 {
    branch
        .windows(2)
        .map(|pair| 0.5 * (of(pair[0].1) + of(pair[1].1)) * (pair[1].0 - pair[0].0))
        .sum()
}

/// Returns the displacement in m at which the force first falls below a level; the last
/// displacement if it never does.
fn below(branch: &[Point], level: f64) -> f64 {
    let next = branch
        .iter()
        .position(|point| point.1 < level)
        .unwrap_or(branch.len() - 1);
    crossing(branch[next.saturating_sub(1)], branch[next], level)
}

/// Returns the displacement in m at which the magnitude of the force is above a level for the last
/// time.
fn loss(branch: &[Point], level: f64) -> f64 {
    let last = branch
        .iter()
        .rposition(|point| point.1.abs() > level)
        .unwrap_or(0);
    let next = (last + 1).min(branch.len() - 1);
    let size = |point: Point| (point.0, point.1.abs());
    crossing(size(branch[last]), size(branch[next]), level)
}

/// Returns the displacement between two points at which the force has a value.
fn crossing(from: Point, to: Point, level: f64) -> f64 {
    let change = to.1 - from.1;
    let share = if change == 0.0 {
        1.0
    } else {
        ((level - from.1) / change).clamp(0.0, 1.0)
    };
    from.0 + share * (to.0 - from.0)
}

/// Returns the largest tension in N and its displacement in m, from the parabola through
/// neighbouring points.
fn largest_tension(branch: &[Point]) -> (f64, f64) {
    let smallest = branch
        .iter()
        .enumerate()
        .min_by(|one, other| one.1.1.total_cmp(&other.1.1));
    let index = smallest.map_or(0, |(index, _)| index);
    let at = branch[index];
    let (Some(before), Some(after)) = (
        index.checked_sub(1).map(|one| branch[one]),
        branch.get(index + 1),
    ) else {
        return (-at.1, at.0);
    };
    let bend = before.1 - 2.0 * at.1 + after.1;
    let share = if bend > 0.0 {
        0.5 * (before.1 - after.1) / bend
    } else {
        0.0
    };
    (-at.1, at.0 + 0.5 * share * (after.0 - before.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring of 1 N/m that presses to 100 N, and whose contact breaks at −40 N.
    fn sawtooth() -> Branches {
        let ramp = |place: f64, end: f64| if place >= end { 100.0 + place } else { 0.0 };
        let approach = (0..=250)
            .map(|at| f64::from(at) - 200.5)
            .map(|at| (at, ramp(at, -100.0)))
            .filter(|at| at.0 < 0.0);
        let approach: Vec<Point> = approach.chain([(0.0, 100.0)]).collect();
        let retraction = (0..=400)
            .map(|at| -0.5 * f64::from(at))
            .map(|at| (at, ramp(at, -140.0)))
            .collect();
        Branches {
            approach,
            retraction,
            noise: 0.1,
            free: 50,
        }
    }

    #[test]
    fn summaries_are_those_of_a_sawtooth() {
        let found = summaries(&sawtooth(), 100.0).map(f64::exp);
        // Forces, energies and distances; the floor of a tension is 3 noises, and a jump lies
        // between two points.
        let least_work = 0.3 * (200.0 / 401.0) * 401.0_f64.sqrt();
        let expected = [
            40.0, 810.0, 802.0, 50.0, 50.0, 100.0, 90.0, 140.0, 140.5, 0.3, least_work,
        ];
        for ((found, expected), name) in found.into_iter().zip(expected).zip(NAMES) {
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{name}: {found}, {expected}"
            );
        }
    }

    /// A place that lies between two points moves with the curve, and not by steps from point to
    /// point.
    #[test]
    fn distances_are_interpolated() {
        let of = |preload: f64| summaries(&sawtooth(), preload)[WAY_TO_HALF].exp();
        assert!((of(100.2) - 49.9).abs() < 1e-9 && (of(100.4) - 49.8).abs() < 1e-9);
    }
}
