//! Measured curves as a few logarithms. The same code serves computed curves.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use asperity_data::{mean, median, standard_deviation};
use std::f64::consts::FRAC_1_SQRT_2;

/// Smallest number of points of a branch, and of its part without contact.
const FEWEST: usize = 20;
const FEWEST_FREE: usize = 5;
/// Mean force at the end of the retraction, in standard deviations of its noise, above which the
/// body is still in contact.
const IN_CONTACT: f64 = 5.0;
/// Smallest noise divided by the largest force. Computed curves are not more accurate.
const LEAST_NOISE: f64 = 1e-4;
/// Share of the largest force by which a force without contact may differ from zero because of
/// drift.
const NEAR_ZERO: f64 = 0.03;
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
/// Scatter of the preloads divided by the scatter due to noise, above which the preloads differ.
const DIFFERENT: f64 = 2.0;
/// Factor within which the noise of all curves must agree to be replaced by the median.
const ONE_NOISE: f64 = 1.5;

/// Displacement relative to the turning point in m, at most about 0, and the force in N.
pub(crate) type Point = (f64, f64);

/// Approach and first retraction of a curve, each in the order of time.
pub(crate) struct Branches {
    pub approach: Vec<Point>,
    pub retraction: Vec<Point>,
    /// Standard deviation of the noise of the force, N.
    pub noise: f64,
    /// Number of points at the beginning of the approach that give the zero and the noise of the
    /// force.
    pub free: usize,
}

impl Branches {
    /// Takes approach and retraction out of a measured curve.
    ///
    /// # Errors
    /// The curve lacks an approach or a retraction, or ends before the contact is lost.
    pub fn of(curve: &MeasuredCurve) -> Result<Self, ExperimentError> {
        let turn = curve.turns[0];
        let branch = |number: usize| -> Vec<Point> {
            let of = curve
                .points()
                .zip(&curve.segment)
                .filter(|(_, segment)| **segment == number);
            of.map(|((displacement, force), _)| (displacement - turn, force))
                .collect()
        };
        let (mut approach, mut retraction) = (branch(0), branch(1));
        if approach.len().min(retraction.len()) < FEWEST || curve.free < 2 * FEWEST_FREE {
            let allowed = "an approach, which begins before contact, and its retraction";
            return refused(
                "no approach and retraction of at least 20 points each",
                allowed,
            );
        }
        // The first contacts of a rough body are weak, and may lie in the part that seems to be
        // free.
        let free = curve.free / 2;
        let before: Vec<f64> = approach[..free.min(approach.len())]
            .iter()
            .map(|point| point.1)
            .collect();
        let zero = mean(&before);
        let points = approach.iter().chain(&retraction);
        let largest = points
            .map(|point| (point.1 - zero).abs())
            .fold(0.0, f64::max);
        let noise = standard_deviation(&before, zero).max(LEAST_NOISE * largest);
        let zero = if curve.is_estimated[0] { zero } else { 0.0 };
        [&mut approach, &mut retraction]
            .into_iter()
            .flatten()
            .for_each(|point| point.1 -= zero);
        let branches = Branches {
            approach,
            retraction,
            noise,
            free,
        };
        if branches.ends_in_contact() {
            return refused(
                "the retraction ends before contact is lost",
                "a retraction until the force is zero",
            );
        }
        Ok(branches)
    }

    fn ends_in_contact(&self) -> bool {
        let end = &self.retraction[self.retraction.len() - FEWEST_FREE..];
        let mean = end.iter().map(|point| point.1).sum::<f64>() / FEWEST_FREE as f64;
        let largest = self
            .retraction
            .iter()
            .map(|point| point.1.abs())
            .fold(0.0, f64::max);
        mean.abs()
            > (IN_CONTACT * self.noise / (FEWEST_FREE as f64).sqrt()).max(NEAR_ZERO * largest)
    }

    /// Returns the force at the turning point in N, as the mean over the ends of both branches.
    pub fn preload(&self) -> f64 {
        0.5 * (self.approach[self.approach.len() - 1].1 + self.retraction[0].1)
    }

    /// Returns the standard deviation of the preload due to the noise, in N.
    pub fn preload_error(&self) -> f64 {
        self.noise * FRAC_1_SQRT_2
    }
}

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

/// How a curve was measured.
pub(crate) struct Protocol {
    /// Measured force at the turning point, and the standard deviation of its error, N.
    pub preload: f64,
    pub preload_error: f64,
    pub noise: f64,
    /// Displacements relative to the turning point, m.
    pub approach: Vec<f64>,
    pub retraction: Vec<f64>,
    /// Number of points at the beginning of the approach that give the zero of the force.
    pub free: usize,
}

impl Protocol {
    pub fn of(branches: &Branches, preload: f64) -> Self {
        let places = |branch: &[Point]| branch.iter().map(|point| point.0).collect();
        Protocol {
            preload,
            preload_error: branches.preload_error(),
            noise: branches.noise,
            approach: places(&branches.approach),
            retraction: places(&branches.retraction),
            free: branches.free,
        }
    }
}

/// Mean of the summaries of the measured curves, and the number of curves.
pub(crate) struct Mean {
    pub summaries: Summaries,
    pub curves: usize,
}

/// Summaries of a curve, and the logarithm of its preload if the preloads differ.
#[derive(Clone, Copy)]
pub(crate) struct Described {
    pub summaries: Summaries,
    pub preload: Option<f64>,
}

impl Described {
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.summaries.into_iter().chain(self.preload)
    }
}

/// Measured curves as their summaries.
pub(crate) struct Measured {
    pub protocols: Vec<Protocol>,
    /// Largest force of each curve, N.
    pub preloads: Vec<f64>,
    /// Standard deviation of the preloads divided by their mean; `None` if they differ by noise
    /// only.
    pub preload_scatter: Option<f64>,
    pub summaries: Vec<Summaries>,
}

impl Measured {
    pub fn of(curves: &[(String, MeasuredCurve)]) -> Result<Self, ExperimentError> {
        let mut branches = Vec::with_capacity(curves.len());
        for (name, curve) in curves {
            let of = Branches::of(curve).map_err(|error| match error {
                ExperimentError::Refused { found, allowed } => ExperimentError::Refused {
                    found: format!("{name}: {found}"),
                    allowed,
                },
                error => error,
            })?;
            if of.preload() <= of.noise {
                return refused(
                    format!("{name}: the force at the turning point is not above the noise"),
                    "a preload",
                );
            }
            branches.push(of);
        }
        let noise =
            median(&mut branches.iter().map(|of| of.noise).collect::<Vec<_>>()).unwrap_or_default();
        let is_alike = |of: &Branches| (of.noise / noise).ln().abs() < ONE_NOISE.ln();
        if branches.iter().all(is_alike) {
            branches.iter_mut().for_each(|of| of.noise = noise);
        }
        let preloads: Vec<f64> = branches.iter().map(Branches::preload).collect();
        let average = mean(&preloads);
        let by_noise = mean(
            &branches
                .iter()
                .map(Branches::preload_error)
                .collect::<Vec<_>>(),
        );
        let scatter = standard_deviation(&preloads, average);
        let differ = curves.len() > 1 && scatter > DIFFERENT * by_noise;
        let preload_of = |index: usize| if differ { preloads[index] } else { average };
        let of = |(index, branches): (usize, &Branches)| summaries(branches, preload_of(index));
        let summaries = branches.iter().enumerate().map(of).collect();
        let of = |(index, branches): (usize, &Branches)| Protocol::of(branches, preload_of(index));
        let protocols = branches.iter().enumerate().map(of).collect();
        Ok(Measured {
            protocols,
            preload_scatter: differ.then(|| scatter / average),
            preloads,
            summaries,
        })
    }

    pub fn mean(&self) -> Mean {
        let of = |index: usize| {
            mean(
                &self
                    .summaries
                    .iter()
                    .map(|of| of[index])
                    .collect::<Vec<_>>(),
            )
        };
        Mean {
            summaries: std::array::from_fn(of),
            curves: self.summaries.len(),
        }
    }

    /// Returns the summaries of a curve, with its preload if the preloads differ.
    pub fn described(&self, summaries: Summaries, curve: usize) -> Described {
        let preload = self
            .preload_scatter
            .map(|_| self.protocols[curve % self.protocols.len()].preload.ln());
        Described { summaries, preload }
    }
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
