//! Difference of two force curves.

use crate::contact::{Direction, History};

/// Indentations at which the forces of a loading stage are compared.
const COMPARED: usize = 2048;

/// The force curve of a loading history: for each loading stage, points of ascending indentation.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ForceCurve {
    legs: Vec<Vec<[f64; 2]>>,
}

impl ForceCurve {
    pub(super) fn of(history: &History) -> Self {
        let mut legs: Vec<Vec<_>> = Vec::new();
        for record in &history.legs {
            legs.push(record.curve.iter().map(|point| [point.indentation, point.force]).collect());
            if let (Direction::Unloading, Some(points)) = (record.direction, legs.last_mut()) {
                points.reverse();
            }
        }
        ForceCurve { legs }
    }

    /// Lowest and highest indentation, m; `None` without points.
    pub(super) fn indentations(&self) -> Option<(f64, f64)> {
        let all = || self.legs.iter().flatten().map(|point| point[0]);
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        (low <= high).then_some((low, high))
    }

    /// Mean difference of the forces of a loading stage from those of a reference at equal indentations, in units of
    /// the largest force of the reference; the largest of all stages. A jump that is late by a hundredth of the
    /// indentations counts a hundredth of its height. `None` if the reference has no forces or another number of
    /// stages.
    pub(super) fn difference(&self, reference: &ForceCurve) -> Option<f64> {
        let forces = reference.legs.iter().flatten().map(|point| point[1].abs());
        let largest = forces.fold(0.0, f64::max);
        if self.legs.len() != reference.legs.len() || largest == 0.0 || largest.is_nan() {
            return None;
        }
        let of_leg = |(one, other): (&Vec<[f64; 2]>, &Vec<[f64; 2]>)| {
            let (first, last) = (other.first()?[0], other.last()?[0]);
            let at = |index: usize| first + (last - first) * (index as f64 + 0.5) / COMPARED as f64;
            let apart = |at: f64| Some((force(one, at)? - force(other, at)?).abs());
            let sum: Option<f64> = (0..COMPARED).map(|index| apart(at(index))).sum();
            Some(sum? / COMPARED as f64 / largest)
        };
        let mut means = self.legs.iter().zip(&reference.legs).map(of_leg);
        means.try_fold(0.0, |most, mean| Some(f64::max(most, mean?)))
    }
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
        ForceCurve { legs: vec![points.to_vec()] }
    }

    #[test]
    fn a_late_jump_counts_its_share_of_the_indentations() {
        let jump = |at: f64| curve(&[[0.0, 0.0], [at, 0.0], [at, 1.0], [1.0, 1.0]]);
        let difference = jump(0.51).difference(&jump(0.5)).unwrap();
        assert!((difference - 0.01).abs() < 1.0 / COMPARED as f64, "{difference}");
        assert_eq!(jump(0.5).difference(&jump(0.5)), Some(0.0));
    }

    #[test]
    fn a_wrong_force_counts_its_share_of_the_largest() {
        let flat = |force: f64| curve(&[[0.0, force], [2.0, force]]);
        let difference = flat(-4.1).difference(&flat(-4.0)).unwrap();
        assert!((difference - 0.025).abs() < 1e-15, "{difference}");
        // A curve that ends early continues with its last force.
        let short = curve(&[[0.0, 0.0], [1.0, 1.0]]);
        let long = curve(&[[0.0, 0.0], [2.0, 2.0]]);
        let difference = short.difference(&long).unwrap();
        assert!((difference - 0.125).abs() < 1e-3, "{difference}");
        assert_eq!(flat(1.0).difference(&flat(0.0)), None);
        assert_eq!(flat(1.0).difference(&ForceCurve::default()), None);
        assert_eq!(ForceCurve { legs: vec![Vec::new()] }.difference(&flat(1.0)), None);
    }
}
