//! Difference of two force curves.

use crate::contact::{Direction, History, LegRecord};

/// Indentations at which the forces of a loading stage are compared.
const COMPARED: usize = 2048;

/// Indentation, m, and force, N, at points of ascending indentation, for each loading stage.
pub(super) type ForceCurve = Vec<Vec<[f64; 2]>>;

/// Returns the force curve of a loading history.
pub(super) fn force_curve(history: &History) -> ForceCurve {
    let points = |leg: &LegRecord| {
        let mut points: Vec<_> = leg.curve.iter().map(|point| [point.indentation, point.force]).collect();
        if leg.direction == Direction::Unloading {
            points.reverse();
        }
        points
    };
    history.legs.iter().map(points).collect()
}

/// Mean difference of the forces of a loading stage from those of a reference at equal indentations, in units of the
/// largest force of the reference; the largest of all stages. A jump that is late by a hundredth of the indentations
/// counts a hundredth of its height. `None` if the reference has no forces or another number of stages.
pub(super) fn difference(curve: &ForceCurve, reference: &ForceCurve) -> Option<f64> {
    let largest = reference.iter().flatten().map(|point| point[1].abs()).fold(0.0, f64::max);
    if curve.len() != reference.len() || largest == 0.0 || largest.is_nan() {
        return None;
    }
    let mean = |(one, other): (&Vec<[f64; 2]>, &Vec<[f64; 2]>)| {
        let (first, last) = (other.first()?[0], other.last()?[0]);
        let at = |index: usize| first + (last - first) * (index as f64 + 0.5) / COMPARED as f64;
        let apart = |at: f64| Some((force(one, at)? - force(other, at)?).abs());
        let sum: Option<f64> = (0..COMPARED).map(|index| apart(at(index))).sum();
        Some(sum? / COMPARED as f64 / largest)
    };
    curve.iter().zip(reference).map(mean).try_fold(0.0, |most, mean| Some(f64::max(most, mean?)))
}

/// Force of a curve at an indentation; beyond its ends that of the end. `None` without points.
fn force(curve: &[[f64; 2]], at: f64) -> Option<f64> {
    let above = curve.partition_point(|point| point[0] < at).min(curve.len().checked_sub(1)?);
    let ([low, before], [high, after]) = (curve[above.saturating_sub(1)], curve[above]);
    let share = if high > low { ((at - low) / (high - low)).clamp(0.0, 1.0) } else { 1.0 };
    Some(before + share * (after - before))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[[f64; 2]]) -> ForceCurve {
        vec![points.to_vec()]
    }

    #[test]
    fn a_late_jump_counts_its_share_of_the_indentations() {
        let jump = |at: f64| curve(&[[0.0, 0.0], [at, 0.0], [at, 1.0], [1.0, 1.0]]);
        let late = difference(&jump(0.51), &jump(0.5)).unwrap();
        assert!((late - 0.01).abs() < 1.0 / COMPARED as f64, "{late}");
        assert_eq!(difference(&jump(0.5), &jump(0.5)), Some(0.0));
    }

    #[test]
    fn a_wrong_force_counts_its_share_of_the_largest() {
        let flat = |force: f64| curve(&[[0.0, force], [2.0, force]]);
        let wrong = difference(&flat(-4.1), &flat(-4.0)).unwrap();
        assert!((wrong - 0.025).abs() < 1e-15, "{wrong}");
        // A curve that ends early continues with its last force.
        let short = curve(&[[0.0, 0.0], [1.0, 1.0]]);
        let long = curve(&[[0.0, 0.0], [2.0, 2.0]]);
        let wrong = difference(&short, &long).unwrap();
        assert!((wrong - 0.125).abs() < 1e-3, "{wrong}");
        assert_eq!(difference(&flat(1.0), &flat(0.0)), None);
        assert_eq!(difference(&flat(1.0), &Vec::new()), None);
        assert_eq!(difference(&vec![Vec::new()], &flat(1.0)), None);
    }
}
