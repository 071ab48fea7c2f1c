//! Reduction of a force curve to its summaries: the logarithms of a few forces, distances and
//! energies. Measured and computed curves are reduced by the same code.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use asperity_data::{mean, median, standard_deviation};
use std::f64::consts::FRAC_1_SQRT_2;

/// Smallest number of points of a branch, which is the approach or the retraction.
const FEWEST: usize = 20;
/// Smallest number of points of the part of a branch without contact.
const FEWEST_FREE: usize = 5;
/// Magnitude of the mean force at the end of the retraction, in units of the standard deviation
/// that noise causes in this mean, above which the body is still in contact.
const IN_CONTACT: f64 = 5.0;
/// Smallest assumed noise, divided by the largest force. Computed curves are not more accurate than
/// this.
const LEAST_NOISE: f64 = 1e-4;
/// Largest force without contact, as a share of the largest force, that may result from drift.
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
/// Index of the pull-off force in the summaries.
pub(crate) const PULL_OFF: usize = 0;
/// Index of the area of the loop in the summaries.
pub(crate) const LOOP_AREA: usize = 1;
/// Index, in the summaries, of the distance from the turning point back to half of the preload.
pub(crate) const WAY_TO_HALF: usize = 3;
/// Smallest pull-off force in a summary, in units of the noise. A smaller force is noise, and is
/// replaced by this one.
const FLOOR: f64 = 3.0;
/// Tension, in units of the noise, that is subtracted before the work of the tension is computed,
/// so that noise alone does no work.
const TENSION: f64 = 2.0;
/// Largest magnitude of the force after loss of contact, in units of the noise.
const LOST: f64 = 5.0;
/// Largest distance of two points that are the ends of a jump of the force, as a share of the mean
/// distance between points.
const AT_JUMP: f64 = 1e-3;
/// Ratio of the scatter of the preloads to the scatter that noise causes, above which the preloads
/// count as different.
const DIFFERENT: f64 = 2.0;
/// Largest ratio between the noise of a curve and the median noise of all curves, in either
/// direction. If no curve exceeds this ratio, the median replaces the noise of each curve.
const ONE_NOISE: f64 = 1.5;

/// Point of an approach or a retraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Displacement in m, relative to the displacement at the turning point. It is at most about 0.
    pub displacement: f64,
    /// Force in N.
    pub force: f64,
}

/// Approach and first retraction of a curve, each in the order of time.
pub(crate) struct Branches {
    pub approach: Vec<Point>,
    pub retraction: Vec<Point>,
    /// Standard deviation of the noise of the force in N.
    pub noise: f64,
    /// Number of points at the beginning of the approach from which the zero and the noise of the
    /// force are determined.
    pub free: usize,
}

impl Branches {
    /// Returns the approach and the first retraction of a measured curve. The zero and the noise of
    /// the force are determined from the first half of the part before contact.
    ///
    /// # Errors
    /// Returns an error if the curve lacks an approach or a retraction, or ends before the contact
    /// is lost.
    pub fn of(curve: &MeasuredCurve) -> Result<Self, ExperimentError> {
        let mut approach = branch_of(curve, 0);
        let mut retraction = branch_of(curve, 1);
        if approach.len().min(retraction.len()) < FEWEST || curve.free < 2 * FEWEST_FREE {
            let found = "no approach and retraction of at least 20 points each";
            let allowed = "an approach, which begins before contact, and its retraction";
            return refused(found, allowed);
        }
        // Only the first half of the part before contact is used, because the first contacts of a
        // rough body are weak and may lie in the second half.
        let free = curve.free / 2;
        let before = &approach[..free.min(approach.len())];
        let before: Vec<f64> = before.iter().map(|point| point.force).collect();
        let zero = mean(&before);
        let points = approach.iter().chain(&retraction);
        let largest = points
            .map(|point| (point.force - zero).abs())
            .fold(0.0, f64::max);
        let noise = standard_deviation(&before, zero).max(LEAST_NOISE * largest);
        if curve.subtracted.has_zero {
            for point in approach.iter_mut().chain(&mut retraction) {
                point.force -= zero;
            }
        }
        let branches = Branches {
            approach,
            retraction,
            noise,
            free,
        };
        if branches.ends_in_contact() {
            let found = "the retraction ends before contact is lost";
            return refused(found, "a retraction until the force is zero");
        }
        Ok(branches)
    }

    fn ends_in_contact(&self) -> bool {
        let end = &self.retraction[self.retraction.len() - FEWEST_FREE..];
        let mean = end.iter().map(|point| point.force).sum::<f64>() / FEWEST_FREE as f64;
        let forces = self.retraction.iter().map(|point| point.force.abs());
        let largest = forces.fold(0.0, f64::max);
        let error = self.noise / (FEWEST_FREE as f64).sqrt();
        mean.abs() > (IN_CONTACT * error).max(NEAR_ZERO * largest)
    }

    /// Returns the force at the turning point in N: the mean of the last force of the approach and
    /// the first force of the retraction.
    pub fn preload(&self) -> f64 {
        0.5 * (self.approach[self.approach.len() - 1].force + self.retraction[0].force)
    }

    /// Returns the standard deviation in N that noise causes in the preload. It is the noise
    /// divided by √2, because the preload is the mean of two forces.
    pub fn preload_error(&self) -> f64 {
        self.noise * FRAC_1_SQRT_2
    }
}

/// Returns the points of a segment of a curve.
fn branch_of(curve: &MeasuredCurve, number: usize) -> Vec<Point> {
    let turn = curve.turns[0];
    let mut branch = Vec::new();
    for ((displacement, force), segment) in curve.points().zip(&curve.segment) {
        if *segment == number {
            branch.push(Point {
                displacement: displacement - turn,
                force,
            });
        }
    }
    branch
}

/// Natural logarithms of forces in N, distances in m and energies in J.
pub(crate) type Summaries = [f64; SUMMARIES];

/// Computes the summaries of a curve whose preload in N is known. Distances count from the turning
/// point, so that an error of the contact point has no effect. They are interpolated between
/// points, because otherwise the summaries would change with the parameters in steps.
pub(crate) fn summaries(branches: &Branches, preload: f64) -> Summaries {
    let approach = &branches.approach;
    let retraction = &branches.retraction;
    let noise = branches.noise;
    let back_from_turn: Vec<Point> = approach.iter().rev().copied().collect();
    let count = retraction.len() as f64;
    let range = retraction[0].displacement - retraction[retraction.len() - 1].displacement;
    let spacing = range.abs() / count;
    let least_force = FLOOR * noise;
    // Smallest work: the integral over the displacement of noise at all points.
    let least_work = least_force * spacing * count.sqrt();
    let tension = |force: f64| (-force - TENSION * noise).max(0.0);

    let pull_off = largest_tension(retraction);
    let loop_area = work(approach, |force| force) + work(retraction, |force| force);
    let work_on_retraction = -work(retraction, tension);
    let way_to_half = -below(retraction, 0.5 * preload);
    let way_from_half = -below(&back_from_turn, 0.5 * preload);
    let way_to_zero = -below(retraction, 0.0);
    let way_from_tenth = -below(&back_from_turn, 0.1 * preload);
    let way_to_pull_off = -pull_off.displacement;
    let way_to_loss = -loss(retraction, LOST * noise);
    let tension_on_approach = largest_tension(approach).force;
    let work_on_approach = work(approach, tension);
    [
        pull_off.force.max(least_force),
        loop_area.max(least_work),
        work_on_retraction.max(least_work),
        way_to_half.max(spacing),
        way_from_half.max(spacing),
        way_to_zero.max(spacing),
        way_from_tenth.max(spacing),
        way_to_pull_off.max(spacing),
        way_to_loss.max(spacing),
        tension_on_approach.max(least_force),
        work_on_approach.max(least_work),
    ]
    .map(f64::ln)
}

/// Integrates a function of the force over the displacement. The result is in J.
fn work(branch: &[Point], force_of: impl Fn(f64) -> f64) -> f64 {
    branch
        .windows(2)
        .map(|pair| {
            let force = 0.5 * (force_of(pair[0].force) + force_of(pair[1].force));
            force * (pair[1].displacement - pair[0].displacement)
        })
        .sum()
}

/// Returns the displacement in m at which the force first falls below a level in N. If the force
/// never does, returns the last displacement.
fn below(branch: &[Point], level: f64) -> f64 {
    let next = branch
        .iter()
        .position(|point| point.force < level)
        .unwrap_or(branch.len() - 1);
    crossing(branch[next.saturating_sub(1)], branch[next], level)
}

/// Returns the displacement in m at which the magnitude of the force falls below a level in N for
/// the last time.
fn loss(branch: &[Point], level: f64) -> f64 {
    let last = branch
        .iter()
        .rposition(|point| point.force.abs() > level)
        .unwrap_or(0);
    let next = (last + 1).min(branch.len() - 1);
    crossing(branch[last].magnitude(), branch[next].magnitude(), level)
}

impl Point {
    /// Returns the same point with the magnitude of its force.
    fn magnitude(self) -> Self {
        Point {
            force: self.force.abs(),
            ..self
        }
    }
}

/// Returns the displacement in m between two points at which the force has the value `level` in N,
/// by linear interpolation.
fn crossing(from: Point, to: Point, level: f64) -> f64 {
    let change = to.force - from.force;
    let share = if change == 0.0 {
        1.0
    } else {
        ((level - from.force) / change).clamp(0.0, 1.0)
    };
    from.displacement + share * (to.displacement - from.displacement)
}

struct LargestTension {
    /// Tension as a positive force in N.
    force: f64,
    /// Displacement at the largest tension, relative to the turning point, in m.
    displacement: f64,
}

/// Returns the largest tension: the minimum of the parabola through the lowest point and its two
/// neighbours.
fn largest_tension(branch: &[Point]) -> LargestTension {
    let points = branch.iter().enumerate();
    let lowest = points.min_by(|(_, point), (_, next)| point.force.total_cmp(&next.force));
    let index = lowest.map_or(0, |(index, _)| index);
    let point = branch[index];
    let mut tension = LargestTension {
        force: -point.force,
        displacement: point.displacement,
    };
    if index == 0 || index + 1 == branch.len() {
        return tension;
    }
    let before = branch[index - 1];
    let after = branch[index + 1];
    let bend = before.force - 2.0 * point.force + after.force;
    let share = if bend > 0.0 {
        0.5 * (before.force - after.force) / bend
    } else {
        0.0
    };
    tension.displacement += 0.5 * share * (after.displacement - before.displacement);
    tension
}

/// Properties of a measured curve that the computed curves take over.
pub(crate) struct Protocol {
    /// Measured force in N at the turning point.
    pub preload: f64,
    /// Standard deviation of the error of the preload in N.
    pub preload_error: f64,
    /// Standard deviation of the noise of the force in N.
    pub noise: f64,
    /// Displacements of the approach in m, relative to the turning point.
    pub approach: Vec<f64>,
    /// Displacements of the retraction in m, relative to the turning point.
    pub retraction: Vec<f64>,
    /// Number of points at the beginning of the approach from which the zero of the force is
    /// determined.
    pub free: usize,
    /// For approach and retraction: true if there are points at both ends of each jump, as in a
    /// computed curve. In the curve of an instrument, the nearest points are somewhere before and
    /// after a jump.
    pub has_jump_ends: [bool; 2],
}

impl Protocol {
    pub fn of(branches: &Branches, preload: f64) -> Self {
        Protocol {
            preload,
            preload_error: branches.preload_error(),
            noise: branches.noise,
            approach: displacements(&branches.approach),
            retraction: displacements(&branches.retraction),
            free: branches.free,
            has_jump_ends: [&branches.approach, &branches.retraction]
                .map(|branch| has_jump_ends(branch, branches.noise)),
        }
    }
}

/// Returns true if two consecutive points have the same displacement, but different forces.
fn has_jump_ends(branch: &[Point], noise: f64) -> bool {
    let width = branch[branch.len() - 1].displacement - branch[0].displacement;
    let near = AT_JUMP * width.abs() / branch.len() as f64;
    branch.windows(2).any(|pair| {
        let distance = pair[1].displacement - pair[0].displacement;
        let change = pair[1].force - pair[0].force;
        distance.abs() < near && change.abs() > LOST * noise
    })
}

fn displacements(branch: &[Point]) -> Vec<f64> {
    branch.iter().map(|point| point.displacement).collect()
}

/// Mean of the summaries of the measured curves, and the number of curves.
pub(crate) struct MeanSummaries {
    pub summaries: Summaries,
    pub curves: usize,
}

/// Summaries of a curve, and the logarithm of its preload if the preloads of the measured curves
/// differ.
#[derive(Clone, Copy)]
pub(crate) struct Description {
    pub summaries: Summaries,
    pub preload: Option<f64>,
}

impl Description {
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.summaries.into_iter().chain(self.preload)
    }
}

/// Summaries and properties of all measured curves.
pub(crate) struct Measurement {
    pub protocols: Vec<Protocol>,
    /// Largest force in N of each curve.
    pub preloads: Vec<f64>,
    /// Standard deviation of the preloads divided by their mean; `None` if the preloads differ only
    /// by noise.
    pub preload_scatter: Option<f64>,
    pub summaries: Vec<Summaries>,
}

impl Measurement {
    /// Computes the summaries of all measured curves. If the preloads differ only by noise, their
    /// mean is used for all curves.
    ///
    /// # Errors
    /// Returns an error with the name of the curve if a curve lacks an approach or a retraction,
    /// ends before the contact is lost, or has no positive preload.
    pub fn of(curves: &[(String, MeasuredCurve)]) -> Result<Self, ExperimentError> {
        let mut branches = Vec::with_capacity(curves.len());
        for (name, curve) in curves {
            branches.push(branches_of(name, curve)?);
        }
        share_noise(&mut branches);

        let preloads: Vec<f64> = branches.iter().map(Branches::preload).collect();
        let preload_errors: Vec<f64> = branches.iter().map(Branches::preload_error).collect();
        let mean_preload = mean(&preloads);
        let scatter = standard_deviation(&preloads, mean_preload);
        let preloads_differ = curves.len() > 1 && scatter > DIFFERENT * mean(&preload_errors);

        let mut all_summaries = Vec::with_capacity(curves.len());
        let mut protocols = Vec::with_capacity(curves.len());
        for (branches, own_preload) in branches.iter().zip(&preloads) {
            let preload = if preloads_differ {
                *own_preload
            } else {
                mean_preload
            };
            all_summaries.push(summaries(branches, preload));
            protocols.push(Protocol::of(branches, preload));
        }
        Ok(Measurement {
            protocols,
            preloads,
            preload_scatter: preloads_differ.then(|| scatter / mean_preload),
            summaries: all_summaries,
        })
    }

    pub fn mean(&self) -> MeanSummaries {
        let mut means = Summaries::default();
        for (index, mean_value) in means.iter_mut().enumerate() {
            let values: Vec<f64> = self.summaries.iter().map(|row| row[index]).collect();
            *mean_value = mean(&values);
        }
        MeanSummaries {
            summaries: means,
            curves: self.summaries.len(),
        }
    }

    /// Returns the half, 0 or 1, to which a random profile belongs. Each profile is computed with
    /// the preload of one measured curve. The profiles of the same measured curve are put into both
    /// halves in turn. Otherwise the preload of a single curve, or of every second curve, might
    /// occur in one half only, and the polynomial that is learned from the other half would not
    /// apply to it.
    pub fn half(&self, profile: usize) -> usize {
        let count = self.protocols.len();
        (profile % count + profile / count) % 2
    }

    /// Returns the description of a curve: its `summaries`, and also its preload if the preloads of
    /// the curves differ. `curve` is the index of a measured curve or of a random profile. If there
    /// are more profiles than measured curves, the properties of the measured curves are repeated.
    pub fn describe(&self, summaries: Summaries, curve: usize) -> Description {
        let mut preload = None;
        if self.preload_scatter.is_some() {
            let protocol = &self.protocols[curve % self.protocols.len()];
            preload = Some(protocol.preload.ln());
        }
        Description { summaries, preload }
    }
}

/// Returns the branches of a curve. Errors begin with the name of the curve.
fn branches_of(name: &str, curve: &MeasuredCurve) -> Result<Branches, ExperimentError> {
    let branches = Branches::of(curve).map_err(|error| named(error, name))?;
    if branches.preload() <= branches.noise {
        let found = format!("{name}: the force at the turning point is not above the noise");
        return refused(found, "a preload");
    }
    Ok(branches)
}

/// Returns the error with the name of a curve before its text.
fn named(error: ExperimentError, name: &str) -> ExperimentError {
    match error {
        ExperimentError::File(_) | ExperimentError::Run(_) => error,
        error => ExperimentError::InCurve {
            name: name.to_owned(),
            error: Box::new(error),
        },
    }
}

/// Replaces the noise of each curve by the median noise, if the noise of all curves is similar. The
/// median has a smaller error than the noise of a single curve.
fn share_noise(branches: &mut [Branches]) {
    let mut noises: Vec<f64> = branches.iter().map(|branches| branches.noise).collect();
    let median_noise = median(&mut noises).unwrap_or_default();
    let is_alike = |noise: f64| (noise / median_noise).ln().abs() < ONE_NOISE.ln();
    if branches.iter().all(|branches| is_alike(branches.noise)) {
        for branches in branches {
            branches.noise = median_noise;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the branches of a spring of 1 N/m that is pressed to 100 N, and whose contact breaks
    /// at −40 N.
    fn sawtooth() -> Branches {
        let point = |displacement: f64, end: f64| {
            let force = if displacement >= end {
                100.0 + displacement
            } else {
                0.0
            };
            Point {
                displacement,
                force,
            }
        };
        let mut approach: Vec<Point> = (0..=250)
            .map(|index| f64::from(index) - 200.5)
            .filter(|displacement| *displacement < 0.0)
            .map(|displacement| point(displacement, -100.0))
            .collect();
        approach.push(point(0.0, -100.0));
        let retraction = (0..=400)
            .map(|index| point(-0.5 * f64::from(index), -140.0))
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
        // The expected values are forces in N, energies in J and distances in m. The smallest
        // tension is three times the noise, and the jump lies between two points.
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

    /// Points at both ends of a jump are recognized by their displacements and forces.
    #[test]
    fn ends_of_jumps_are_recognized() {
        let mut branches = sawtooth();
        assert!(!has_jump_ends(&branches.retraction, branches.noise));
        let last = branches
            .retraction
            .iter()
            .rposition(|point| point.force != 0.0);
        let end = branches.retraction[last.unwrap()];
        let after = Point { force: 0.0, ..end };
        branches.retraction.insert(last.unwrap() + 1, after);
        assert!(has_jump_ends(&branches.retraction, branches.noise));
        assert!(!has_jump_ends(&branches.retraction, 100.0));
    }

    /// The profiles of each measured curve are in both halves, as nearly as possible in equal
    /// numbers.
    #[test]
    fn the_profiles_of_each_curve_are_in_both_halves() {
        for curves in [1, 2, 3, 6, 8, 32] {
            let point = Point {
                displacement: 0.0,
                force: 0.0,
            };
            let branches = Branches {
                approach: vec![point; 2],
                retraction: vec![point; 2],
                noise: 1.0,
                free: 1,
            };
            let measurement = Measurement {
                protocols: (0..curves).map(|_| Protocol::of(&branches, 1.0)).collect(),
                preloads: vec![1.0; curves],
                preload_scatter: None,
                summaries: Vec::new(),
            };
            for curve in 0..curves {
                let of_curve = (0..8).map(|turn| measurement.half(curve + turn * curves));
                assert_eq!(of_curve.sum::<usize>(), 4, "{curves} {curve}");
            }
        }
    }

    /// A distance that ends between two points changes continuously with the curve, and not in
    /// steps from point to point.
    #[test]
    fn distances_are_interpolated() {
        let of = |preload: f64| summaries(&sawtooth(), preload)[WAY_TO_HALF].exp();
        assert!((of(100.2) - 49.9).abs() < 1e-9 && (of(100.4) - 49.8).abs() < 1e-9);
    }
}
