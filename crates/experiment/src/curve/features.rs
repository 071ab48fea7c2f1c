//! Features of a measured curve that are computed without a model: its jumps, its hysteresis in
//! compression, and the decrease of the force during a pause.

use crate::curve::numerics::Extent;
use crate::curve::points::Points;
use asperity_data::{between, format_rounded, mean, median};
use serde::Serialize;

/// Smallest jump of the force, in units of the noise.
const BEYOND_NOISE: f64 = 6.0;
/// Smallest jump of the force, as a share of the range of the force.
const OF_RANGE: f64 = 0.01;
/// Smallest jump of the force, as a share of the largest one in the same motion. A drag of a fluid
/// may change in a cusp at first touch.
const OF_LARGEST: f64 = 0.1;
/// Largest number of steps between points over which a jump extends.
const STEPS: usize = 3;
/// Number of steps before and after a jump in which the slope of the force is computed. The jump
/// has to be much steeper than this slope.
const AROUND: usize = 4;
/// Smallest ratio of the change of the force in a jump to its change over [`STEPS`] steps before or
/// after the jump.
const SHARP: f64 = 3.0;
/// Number of displacements at which the forces of loading and unloading are compared.
const COMPARED: usize = 200;
/// Smallest force at the turning point, in units of the noise, for which the hysteresis is
/// computed.
const PRESSED: f64 = 10.0;
/// Largest distance of a point of a pause from the median displacement of the pause, as a share of
/// the range of displacements. Points farther away are not used.
const STILL: f64 = 0.002;
/// Divisor that gives the number of points averaged at the beginning and at the end of a pause:
/// 1/20 of its points.
const END: usize = 20;

/// Jump of the force of a measured curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ForceJump {
    /// Index, from 0, of the segment (a single loading or unloading) in which the force jumps.
    pub segment: usize,
    /// Displacement in m at the last point before the jump.
    pub displacement: f64,
    /// Mean force in N of a few points before the jump, and of a few points after the jump.
    pub forces: [f64; 2],
}

impl ForceJump {
    /// Returns the magnitude of the jump in N.
    pub fn size(self) -> f64 {
        (self.forces[1] - self.forces[0]).abs()
    }
}

/// Features of a measured curve that are known without a fit of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CurveFeatures {
    /// Number of jumps of the force. A jump is a drop of the force while the body is pressed, or a
    /// rise of the force while the body is pulled, within three steps from point to point. It must
    /// be larger than 6 times the noise, and larger than 1 % of the range of the force.
    pub jumps: usize,
    /// Largest number of jumps in one segment (a single loading or unloading). A sphere has at most
    /// one.
    pub jumps_in_one_motion: usize,
    /// Area between the loading and the unloading curve, divided by the area under the loading
    /// curve. Both areas are taken over the displacements at which loading and unloading are in
    /// compression. `None` if the curve has no loading or no unloading in compression.
    pub hysteresis: Option<f64>,
    /// Largest decrease of the force during a pause in contact, divided by the largest force;
    /// `None` if the curve has no such pause.
    pub fall_in_pause: Option<f64>,
}

impl CurveFeatures {
    pub(crate) fn of(points: &Points, jumps: &[ForceJump], noise: f64) -> Self {
        let mut features = CurveFeatures {
            jumps: jumps.len(),
            ..CurveFeatures::default()
        };
        for motion in jumps.chunk_by(|jump, next| jump.segment == next.segment) {
            features.jumps_in_one_motion = features.jumps_in_one_motion.max(motion.len());
        }
        features.hysteresis = hysteresis(points, noise);
        features.fall_in_pause = fall_in_pause(points, noise);
        features
    }

    /// Returns a sentence for the report that describes these features.
    pub(crate) fn sentence(&self) -> String {
        let jumps = match self.jumps {
            0 => "No jump of the force".to_owned(),
            1 => "1 jump of the force".to_owned(),
            count => format!("{count} jumps of the force"),
        };
        let mut parts = vec![jumps];
        if let Some(hysteresis) = self.hysteresis {
            parts.push(format!(
                "hysteresis in compression {} of the loading",
                percent(hysteresis)
            ));
        }
        if let Some(fall) = self.fall_in_pause {
            parts.push(format!(
                "the force falls by {} of the largest force in a pause",
                percent(fall)
            ));
        }
        format!("{}.", parts.join("; "))
    }
}

/// Returns a share as a text in percent. A share below 0.00005 in magnitude is a rounding error and
/// is written as 0.
fn percent(share: f64) -> String {
    let share = if share.abs() < 5e-5 { 0.0 } else { share };
    format!("{} %", format_rounded(100.0 * share, 2, "1"))
}

/// Returns the jumps of the force of all segments, in the order of time.
pub(crate) fn jumps_of(points: &Points, noise: f64) -> Vec<ForceJump> {
    let mut jumps = Vec::new();
    for number in points.segment[0]..=points.last_segment() {
        jumps.extend(jumps_in(points, number, noise));
    }
    jumps
}

/// Returns the jumps in the motion of one segment.
fn jumps_in(points: &Points, number: usize, noise: f64) -> Vec<ForceJump> {
    let range = Extent::of(points.force.iter().copied()).width();
    let least = (BEYOND_NOISE * noise).max(OF_RANGE * range);
    // On loading a jump decreases the force, and on unloading it increases the force, contrary to
    // the continuous motion. With this sign, a jump is always a rise.
    let sign = if number.is_multiple_of(2) { -1.0 } else { 1.0 };
    let mut forces = Vec::new();
    let mut ways = Vec::new();
    for index in points.range_of(number) {
        if !points.is_still[index] {
            forces.push(sign * points.force[index]);
            ways.push(-sign * points.displacement[index]);
        }
    }

    let mut jumps = Vec::new();
    let mut place = 0;
    while place + 1 < forces.len() {
        let Some(jump) = jump_close_to(&forces, place, least) else {
            place += 1;
            continue;
        };
        // If the instrument moves back over a short distance at this place, the change of the force
        // is not a jump.
        let before = ways[(jump + 1).saturating_sub(STEPS)];
        let after = ways[(jump + STEPS).min(ways.len() - 1)];
        // At a turning point the force of a body that relaxes falls, and the motion may turn
        // between two points.
        let steepest = steepest_step(&forces, jump);
        let is_at_turn = number < points.last_segment() && steepest + 1 + STEPS > forces.len();
        if after >= before && !is_at_turn {
            let [before, after] = means_around(&forces, jump);
            jumps.push(ForceJump {
                segment: number,
                displacement: -sign * ways[steepest],
                forces: [sign * before, sign * after],
            });
        }
        // The means before the next places contain points before this jump.
        place = jump + 2 * STEPS;
    }
    let sizes = jumps.iter().map(|jump| jump.size());
    let least = OF_LARGEST * sizes.fold(0.0, f64::max);
    jumps.retain(|jump| jump.size() >= least);
    jumps
}

/// Returns the place of the largest change from point to point at a jump.
fn steepest_step(forces: &[f64], jump: usize) -> usize {
    let end = (jump + 2 * STEPS).min(forces.len() - 1);
    let change = |place: &usize| forces[place + 1] - forces[*place];
    (jump..end)
        .max_by(|place, next| change(place).total_cmp(&change(next)))
        .unwrap_or(jump)
}

/// Returns the mean of a few forces up to a jump, and the mean of a few forces after it.
fn means_around(forces: &[f64], jump: usize) -> [f64; 2] {
    let before = mean(&forces[(jump + 1).saturating_sub(STEPS)..=jump]);
    let largest_gap = (0..STEPS)
        .max_by(|gap, next| step_at(forces, jump, *gap).total_cmp(&step_at(forces, jump, *next)));
    [
        before,
        before + step_at(forces, jump, largest_gap.unwrap_or(0)),
    ]
}

/// Returns the mean of the next forces minus the mean of the forces up to a place. `gap` forces
/// after the place are left out.
fn step_at(forces: &[f64], place: usize, gap: usize) -> f64 {
    let before = &forces[(place + 1).saturating_sub(STEPS)..=place];
    let start = (place + 1 + gap).min(forces.len() - 1);
    let end = (start + STEPS).min(forces.len());
    mean(&forces[start..end]) - mean(before)
}

/// Returns the place of a jump that lies at `place` or a few steps later; `None` if there is no
/// jump. In a jump the force rises by more than `least` within [`STEPS`] steps, and much faster
/// than before and after these steps.
fn jump_close_to(forces: &[f64], place: usize, least: f64) -> Option<usize> {
    let last = forces.len() - 1;
    // The jump is at that one of the next places where the force rises most.
    let ahead = (place + 2 * STEPS).min(last - 1);
    let jump = (place..=ahead)
        .max_by(|place, next| step_at(forces, *place, 0).total_cmp(&step_at(forces, *next, 0)))
        .unwrap_or(place);
    let rise = (0..STEPS)
        .map(|gap| step_at(forces, jump, gap))
        .fold(0.0, f64::max);
    if rise <= least {
        return None;
    }
    let slope = |from: usize, to: usize| {
        if to < from + STEPS {
            0.0
        } else {
            (forces[to] - forces[from]) / (to - from) as f64
        }
    };
    let before = slope(
        jump.saturating_sub(STEPS + AROUND),
        jump.saturating_sub(STEPS),
    );
    let from = (jump + 1 + STEPS).min(last);
    let after = slope(from, (from + AROUND).min(last));
    (rise > SHARP * STEPS as f64 * before.max(after).max(0.0)).then_some(jump)
}

/// Returns the points of a segment without pauses, as pairs of displacement in m and force in N,
/// with ascending displacements.
fn branch(points: &Points, number: usize) -> Vec<[f64; 2]> {
    let mut branch: Vec<[f64; 2]> = points
        .range_of(number)
        .filter(|index| !points.is_still[*index])
        .map(|index| [points.displacement[index], points.force[index]])
        .collect();
    branch.sort_by(|point, next| point[0].total_cmp(&next[0]));
    branch
}

/// Returns the index of the point from which on all forces of the branch are compressive.
fn compression_begins(branch: &[[f64; 2]]) -> usize {
    branch
        .iter()
        .rposition(|point| point[1] <= 0.0)
        .map_or(0, |last| last + 1)
}

fn force_at(branch: &[[f64; 2]], displacement: f64) -> f64 {
    let next = branch
        .partition_point(|point| point[0] < displacement)
        .clamp(1, branch.len() - 1);
    let [from, force] = branch[next - 1];
    let [to, next_force] = branch[next];
    if to > from {
        between(
            force,
            next_force,
            ((displacement - from) / (to - from)).clamp(0.0, 1.0),
        )
    } else {
        force
    }
}

/// Returns the hysteresis between the loading to the largest force and the unloading after it, as a
/// share of the area under the loading curve; `None` if the loading or the unloading has too few
/// points in compression.
fn hysteresis(points: &Points, noise: f64) -> Option<f64> {
    let largest_in =
        |number: usize| Extent::of(points.range_of(number).map(|index| points.force[index])).high;
    let loadings = (points.segment[0]..points.last_segment()).filter(|number| number % 2 == 0);
    let number =
        loadings.max_by(|number, next| largest_in(*number).total_cmp(&largest_in(*next)))?;
    let loading = branch(points, number);
    let unloading = branch(points, number + 1);
    if largest_in(number) < PRESSED * noise {
        return None;
    }
    let loading = &loading[compression_begins(&loading)..];
    let unloading = &unloading[compression_begins(&unloading)..];
    if loading.len() < 2 * AROUND || unloading.len() < 2 * AROUND {
        return None;
    }
    let low = loading[0][0].max(unloading[0][0]);
    let high = loading[loading.len() - 1][0].min(unloading[unloading.len() - 1][0]);
    let mut loaded = 0.0;
    let mut difference = 0.0;
    for index in 0..COMPARED {
        let displacement = between(low, high, (index as f64 + 0.5) / COMPARED as f64);
        let force = force_at(loading, displacement);
        loaded += force;
        difference += force - force_at(unloading, displacement);
    }
    (high > low && loaded > 0.0).then_some(difference / loaded)
}

/// Returns the largest decrease of the force during a pause in compression, as a share of the
/// largest force; `None` if there is no such pause.
fn fall_in_pause(points: &Points, noise: f64) -> Option<f64> {
    let largest = Extent::of(points.force.iter().copied()).high;
    let near = STILL * Extent::of(points.displacement.iter().copied()).width();
    let mut found: Option<f64> = None;
    let mut start = 0;
    for part in points.is_still.chunk_by(|still, next| still == next) {
        let range = start..start + part.len();
        start = range.end;
        let mut displacements = points.displacement[range.clone()].to_vec();
        let middle = median(&mut displacements)?;
        let forces: Vec<f64> = range
            .filter(|index| (points.displacement[*index] - middle).abs() <= near)
            .map(|index| points.force[index])
            .collect();
        let count = (forces.len() / END).max(1);
        if !part[0] || forces.len() < 2 * count {
            continue;
        }
        let first = mean(&forces[..count]);
        let last = mean(&forces[forces.len() - count..]);
        if first.min(last) > PRESSED * noise {
            let fall = (first - last) / largest;
            found = Some(found.map_or(fall, |other| other.max(fall)));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{from_text, lines, of_spring};
    use crate::read::options::CurveOptions;

    fn features(points: impl IntoIterator<Item = (f64, f64)>) -> CurveFeatures {
        from_text(&lines(points), &CurveOptions::default())
            .unwrap()
            .features
    }

    /// Returns the curve of a spring of 2 N/m whose force drops. Each drop is a pair of the
    /// displacement in nm and the decrease of the force in nN, on the approach (`pressed`) or on
    /// the retraction (`pulled`).
    fn with_drops(pressed: &[(f64, f64)], pulled: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let mut points = of_spring(600);
        for (index, (displacement, force)) in points.iter_mut().enumerate() {
            let drops = if index < 300 { pressed } else { pulled };
            for (place, drop) in drops {
                if *displacement > *place {
                    *force -= drop;
                }
            }
        }
        points
    }

    #[test]
    fn jumps_are_counted_by_motion() {
        assert_eq!(features(of_spring(600)).jumps, 0);
        let adheres = features(with_drops(&[(0.0, 10.0)], &[(-20.0, 10.0)]));
        assert_eq!((adheres.jumps, adheres.jumps_in_one_motion), (2, 1));
        let twice = features(with_drops(
            &[(0.0, 10.0), (20.0, 8.0)],
            &[(-20.0, 10.0), (10.0, 8.0)],
        ));
        assert_eq!((twice.jumps, twice.jumps_in_one_motion), (4, 2));
        // A drop of 0.5 nN is less than 1 % of the range of the force and does not count as a jump.
        assert_eq!(features(with_drops(&[(0.0, 0.5)], &[(0.0, 0.5)])).jumps, 0);
    }

    /// The force of a body that relaxes falls where the motion turns, whichever segment the point
    /// in the middle belongs to.
    #[test]
    fn a_fall_at_the_turning_point_is_no_jump() {
        for first in 298..304 {
            let mut points = of_spring(600);
            for point in &mut points[first..] {
                point.1 = 1.0 + 0.6 * (point.1 - 1.0);
            }
            let curve = from_text(&lines(points), &CurveOptions::default()).unwrap();
            assert_eq!(curve.jumps, [], "{first}");
        }
    }

    /// A force that falls gradually while the body is pressed is no jump, however far it falls.
    #[test]
    fn a_gradual_change_is_no_jump() {
        let gradual = of_spring(600)
            .into_iter()
            .map(|(d, f)| (d, f - 60.0 * (d / 25.0).clamp(0.0, 1.0)));
        let features = features(gradual);
        assert_eq!(features.jumps, 0, "{features:?}");
    }

    /// If the forces of the retraction are nine tenths of those of the approach, the hysteresis is
    /// a tenth of the loading.
    #[test]
    fn hysteresis_is_a_share_of_the_loading() {
        let elastic = features(of_spring(600)).hysteresis.unwrap();
        assert!(elastic.abs() < 0.01, "{elastic}");
        let lossy = of_spring(600)
            .into_iter()
            .enumerate()
            .map(|(index, (d, f))| {
                (
                    d,
                    if index < 300 {
                        f
                    } else {
                        1.0 + 0.9 * (f - 1.0)
                    },
                )
            });
        let share = features(lossy).hysteresis.unwrap();
        assert!((share - 0.1).abs() < 0.01, "{share}");
        let alone = of_spring(600).into_iter().skip(300);
        assert_eq!(features(alone).hysteresis, None);
    }

    #[test]
    fn the_force_falls_in_a_pause() {
        let mut points = of_spring(600);
        let pause = (0..200).map(|index| (50.0, 101.0 - 0.05 * f64::from(index)));
        points.splice(300..300, pause);
        let features = features(points);
        let fall = features.fall_in_pause.unwrap();
        assert!((fall - 0.095).abs() < 0.01, "{fall}");
        assert!(
            features.sentence().contains("in a pause"),
            "{}",
            features.sentence()
        );
        assert_eq!(super::tests::features(of_spring(600)).fall_in_pause, None);
    }
}
