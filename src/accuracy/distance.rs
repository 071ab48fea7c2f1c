//! Distance of two force curves.
//!
//! Where contact forms or ends at once, two good solutions jump at slightly different indentations, and the
//! difference of their forces between the two jumps is the height of the jump, however close they are. So curves
//! are compared as sets of points: the distance of a point of one curve to the nearest point of the other,
//! indentations in units of the range of indentations and forces in units of the largest force; the largest such
//! distance, in both directions, on any loading stage (the Hausdorff distance of the curves' points from the
//! curves). A jump that is late by one hundredth of the range counts one hundredth, and so does a force with an
//! error of one hundredth of the largest.

use crate::contact::{Direction, History};

/// The force curve of a loading history: for each loading stage, points of ascending indentation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceCurve {
    legs: Vec<Vec<[f64; 2]>>,
}

impl ForceCurve {
    /// The curve of a history.
    #[must_use]
    pub fn of(history: &History) -> Self {
        let leg = |record: &crate::contact::LegRecord| {
            let mut points: Vec<_> =
                record.curve.iter().map(|point| [point.indentation, point.force]).collect();
            if record.direction == Direction::Unloading {
                points.reverse();
            }
            points
        };
        ForceCurve { legs: history.legs.iter().map(leg).collect() }
    }

    /// Lowest and highest indentation, m; `None` without points.
    #[must_use]
    pub fn indentations(&self) -> Option<(f64, f64)> {
        let all = || self.legs.iter().flatten().map(|point| point[0]);
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        (low <= high).then_some((low, high))
    }

    /// Distance of this curve from a reference in units of the reference's ranges; see the module. `None` if the
    /// reference has no range or forces, or another number of loading stages.
    #[must_use]
    pub fn distance(&self, reference: &ForceCurve) -> Option<f64> {
        let (low, high) = reference.indentations()?;
        let forces = reference.legs.iter().flatten().map(|point| point[1].abs());
        let scale = [high - low, forces.fold(0.0, f64::max)];
        if self.legs.len() != reference.legs.len()
            || scale.iter().any(|&range| range.is_nan() || range <= 0.0)
        {
            return None;
        }
        let scaled = |leg: &[[f64; 2]]| -> Vec<[f64; 2]> {
            leg.iter().map(|point| [point[0] / scale[0], point[1] / scale[1]]).collect()
        };
        let legs = self.legs.iter().zip(&reference.legs);
        let distances = legs.map(|(one, other)| {
            let (one, other) = (scaled(one), scaled(other));
            farthest(&one, &other).max(farthest(&other, &one))
        });
        Some(distances.fold(0.0, f64::max))
    }
}

/// The largest distance of one of these points from a curve through points of ascending first coordinate.
fn farthest(points: &[[f64; 2]], curve: &[[f64; 2]]) -> f64 {
    points.iter().map(|&point| nearest(point, curve)).fold(0.0, f64::max)
}

/// Distance of a point from a curve: outwards from the nearest first coordinate, until the rest is farther away
/// along that coordinate alone.
fn nearest(point: [f64; 2], curve: &[[f64; 2]]) -> f64 {
    let middle = curve.partition_point(|other| other[0] < point[0]);
    let mut best = curve.get(middle).map_or(f64::INFINITY, |&other| to_piece(point, other, other));
    for pair in curve[middle.saturating_sub(1)..].windows(2) {
        if pair[0][0] - point[0] > best {
            break;
        }
        best = best.min(to_piece(point, pair[0], pair[1]));
    }
    for pair in curve[..middle].windows(2).rev() {
        if point[0] - pair[1][0] > best {
            break;
        }
        best = best.min(to_piece(point, pair[0], pair[1]));
    }
    if let [only] = curve {
        best = best.min(to_piece(point, *only, *only));
    }
    best
}

/// Distance of a point from a straight piece.
fn to_piece(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let apart = [point[0] - from[0], point[1] - from[1]];
    let square = along[0].powi(2) + along[1].powi(2);
    let share = if square > 0.0 { (apart[0] * along[0] + apart[1] * along[1]) / square } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    (apart[0] - share * along[0]).hypot(apart[1] - share * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn curve(points: &[[f64; 2]]) -> ForceCurve {
        ForceCurve { legs: vec![points.to_vec()] }
    }

    #[test]
    fn a_late_jump_counts_by_how_late_it_is() {
        let jump = |at: f64| curve(&[[0.0, 0.0], [at, 0.0], [at, 1.0], [1.0, 1.0]]);
        let distance = jump(0.51).distance(&jump(0.5)).unwrap();
        assert!((distance - 0.01).abs() < 1e-15, "{distance}");
        assert_eq!(jump(0.5).distance(&jump(0.5)), Some(0.0));
    }

    #[test]
    fn a_wrong_force_counts_by_how_wrong_it_is() {
        let flat = |force: f64| curve(&[[0.0, force], [2.0, force]]);
        let distance = flat(-4.1).distance(&flat(-4.0)).unwrap();
        assert!((distance - 0.025).abs() < 1e-15, "{distance}");
        assert_eq!(flat(1.0).distance(&flat(0.0)), None);
        assert_eq!(flat(1.0).distance(&ForceCurve::default()), None);
    }

    #[test]
    fn what_only_one_of_them_does_is_found_from_either_side() {
        let straight = curve(&[[0.0, 1.0], [1.0, 1.0]]);
        let spike = curve(&[[0.0, 1.0], [0.5, 1.0], [0.5, 0.0], [0.5, 1.0], [1.0, 1.0]]);
        assert_eq!(spike.distance(&straight), Some(1.0));
        assert_eq!(straight.distance(&spike), Some(1.0));
    }

    prop_compose! {
        fn ascending()(steps in prop::collection::vec((0.0..0.3, -1.0..1.0), 1..20)) -> Vec<[f64; 2]> {
            let mut at = 0.0;
            steps.into_iter().map(|(step, force)| { at += step; [at, force] }).collect()
        }
    }

    proptest! {
        #[test]
        fn the_search_finds_the_nearest_piece(curve in ascending(), x in -0.5..4.0, y in -2.0..2.0) {
            let pieces = || curve.windows(2).map(|pair| to_piece([x, y], pair[0], pair[1]));
            let blind = pieces().fold(to_piece([x, y], curve[0], curve[0]), f64::min);
            let found = nearest([x, y], &curve);
            // Ends of pieces are compared separately as well.
            prop_assert!((found - blind).abs() <= 1e-14, "{} for {}", found, blind);
        }
    }
}
