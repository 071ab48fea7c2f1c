//! The record of a stage, made from the states of the body one after the other.

use super::law::Relaxation;
use super::state::State;
use super::view::View;
use crate::contact::Contact;
use crate::error::ContactError;
use crate::history::{CurvePoint, Direction, Patch, StageRecord};
use crate::target::Move;
use asperity_data::CompensatedSum;

/// Collects the points of the force curve of a stage, and the springs that detach in this stage.
pub struct Recorder<'a> {
    view: View<'a>,
    recorded: Recorded,
    /// Patches at the last point at which the body was above its largest indentation.
    patches: Option<Vec<Patch>>,
    /// Points of the curve at which the body was at its largest indentation.
    deepest: Vec<usize>,
}

/// Points of the force curve of a stage, and the springs that detached in this stage.
pub struct Recorded {
    curve: Vec<CurvePoint>,
    seconds: Vec<f64>,
    /// Displacement of the drive in m at each point.
    drives: Vec<f64>,
    /// ∫ v² dx in m² at each point, where v is that part of a compression which has not relaxed.
    fresh_squares: Vec<f64>,
    /// Indentation in m at which each spring detached on this stage. Infinite otherwise.
    detached_at: Vec<f64>,
}

impl<'a> Recorder<'a> {
    /// Creates an empty record of a stage. The profile has `springs` springs.
    pub fn new(view: View<'a>, springs: usize) -> Self {
        Recorder {
            view,
            recorded: Recorded {
                curve: Vec::new(),
                seconds: Vec::new(),
                drives: Vec::new(),
                fresh_squares: Vec::new(),
                detached_at: vec![f64::INFINITY; springs],
            },
            patches: None,
            deepest: Vec::new(),
        }
    }

    fn add(&mut self, state: &State) {
        let patches = self.view.turned_patches(state);
        let recorded = &mut self.recorded;
        if let (Some(before), Some(after)) = (&self.patches, &patches) {
            let indentation = recorded.curve.last().map_or(0.0, |point| point.indentation);
            for spring in lost(before, after) {
                if let Some(detached_at) = recorded.detached_at.get_mut(spring) {
                    *detached_at = indentation;
                }
            }
        }
        match patches {
            Some(_) => self.patches = patches,
            None => self.deepest.push(recorded.curve.len()),
        }
        recorded.curve.push(self.view.curve_point(state));
        recorded.seconds.push(state.seconds);
        recorded.drives.push(state.drive);
        recorded.fresh_squares.push(state.load.fresh_squares);
    }

    /// Moves all states except the last one from `states` to the record. The motion continues from
    /// the last state.
    pub fn add_all_but_last(&mut self, states: &mut Vec<State>) {
        let kept = states.len() - 1;
        for state in states.drain(..kept) {
            self.add(&state);
        }
    }

    /// Adds the last states of a stage, and returns what was recorded.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn finish(mut self, states: &[State]) -> Result<Recorded, ContactError> {
        for state in states {
            self.add(state);
        }
        self.view
            .count_springs(&mut self.recorded.curve, self.deepest)?;
        Ok(self.recorded)
    }

    /// Returns the smallest force so far in N.
    pub fn smallest_force(&self) -> f64 {
        let forces = self.recorded.curve.iter().map(|point| point.force);
        forces.fold(f64::INFINITY, f64::min)
    }
}

impl Recorded {
    /// Returns for each spring the indentation in m at which the spring detached; infinite for a
    /// spring that did not detach.
    pub fn detached_at(&self) -> &[f64] {
        &self.detached_at
    }

    /// Returns the record of the stage.
    pub fn record(
        self,
        contact: &Contact,
        relaxation: Relaxation,
        target: Move,
        direction: Direction,
    ) -> StageRecord {
        let first = self.curve[0];
        let last = self.curve[self.curve.len() - 1];
        let mut record = StageRecord {
            direction,
            ..StageRecord::still(target, first)
        };
        for &point in &self.curve {
            if point.force > record.largest.force {
                record.largest = point;
            }
            if point.force < record.smallest.force {
                record.smallest = point;
            }
        }
        let rate = relaxation.share() * contact.foundation.spring_stiffness() / relaxation.time();
        let forces: Vec<f64> = self.curve.iter().map(|point| point.force).collect();
        let work = integral(&self.drives, &forces);
        record.dashpot_energy = rate * integral(&self.seconds, &self.fresh_squares);
        for pair in self.curve.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            record.attached += to.springs.saturating_sub(from.springs);
            record.detached += from.springs.saturating_sub(to.springs);
        }
        let energy = |point: CurvePoint| {
            let bent = point.force / contact.loading_stiffness;
            point.stored_energy + 0.5 * point.force * bent
        };
        // Without adhesion nothing is released, and the difference would be the error of the steps.
        if contact.has_adhesion() {
            let stored = energy(last) - energy(first);
            record.released_energy = work - stored - record.dashpot_energy;
        }
        record.curve = self.curve;
        record.seconds = self.seconds;
        record
    }
}

/// Returns the integral of a quantity over a coordinate, both given at some points. Between two
/// points the quantity is a parabola whose curvature is the smaller one of the curvatures at these
/// points. Where the quantity jumps, or its slope does, the curvatures have different signs, and
/// the quantity is straight.
fn integral(coordinates: &[f64], values: &[f64]) -> f64 {
    let curvature = |point: usize| -> f64 {
        let Some(before) = point.checked_sub(1) else {
            return 0.0;
        };
        let after = point + 1;
        if after >= values.len() {
            return 0.0;
        }
        let ways = [
            coordinates[point] - coordinates[before],
            coordinates[after] - coordinates[point],
        ];
        let goes_on = ways[0] * ways[1] > 0.0;
        if !goes_on {
            return 0.0;
        }
        let slopes = [
            (values[point] - values[before]) / ways[0],
            (values[after] - values[point]) / ways[1],
        ];
        2.0 * (slopes[1] - slopes[0]) / (ways[0] + ways[1])
    };
    let mut sum = CompensatedSum::default();
    let mut at_end = 0.0;
    for after in 1..values.len() {
        let at_begin = at_end;
        at_end = curvature(after);
        let way = coordinates[after] - coordinates[after - 1];
        sum.add(0.5 * (values[after - 1] + values[after]) * way);
        sum.add(-smaller(at_begin, at_end) * way * way * way / 12.0);
    }
    sum.total()
}

/// Returns the number that is closer to zero of two numbers with the same sign, otherwise zero.
fn smaller(number: f64, other: f64) -> f64 {
    if number * other <= 0.0 {
        0.0
    } else if number.abs() < other.abs() {
        number
    } else {
        other
    }
}

/// Returns the springs of the patches `before` that are not in the patches `after`. Both are from
/// left to right.
fn lost(before: &[Patch], after: &[Patch]) -> Vec<usize> {
    let mut lost = Vec::new();
    let mut rest = after.iter().peekable();
    for patch in before {
        let mut spring = patch.first;
        while let Some(kept) = rest.peek()
            && kept.first <= patch.last
        {
            lost.extend(spring..kept.first.max(spring));
            spring = kept.last + 1;
            rest.next();
        }
        lost.extend(spring..(patch.last + 1).max(spring));
    }
    lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_integrated_but_for_its_ends_and_a_step_as_a_straight_line() {
        let coordinates: Vec<f64> = (0..=40).map(|k| (0.1 * f64::from(k)).powf(1.5)).collect();
        let inside = |values: Vec<f64>| {
            let [first, last] = [1, values.len() - 1];
            integral(&coordinates, &values)
                - integral(&coordinates[..=first], &values[..=first])
                - integral(&coordinates[last - 1..], &values[last - 1..])
        };
        let [from, to] = [coordinates[1], coordinates[39]];
        let found = inside(coordinates.iter().map(|x| 3.0 - x * x).collect());
        let expected = 3.0 * (to - from) - (to.powi(3) - from.powi(3)) / 3.0;
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        let step = |x: f64| if x < 2.0 { 0.0 } else { 1.0 };
        let found = inside(coordinates.iter().map(|&x| step(x)).collect());
        let after = coordinates.partition_point(|&x| x < 2.0);
        let expected = to - 0.5 * (coordinates[after - 1] + coordinates[after]);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }

    #[test]
    fn springs_that_are_no_longer_in_a_patch_are_lost() {
        let patches = |ends: &[(usize, usize)]| -> Vec<Patch> {
            let patches = ends.iter().map(|&(first, last)| Patch { first, last });
            patches.collect()
        };
        let before = patches(&[(0, 3), (5, 9), (12, 12)]);
        assert_eq!(lost(&before, &before), Vec::<usize>::new());
        let after = patches(&[(1, 2), (5, 6), (8, 9)]);
        assert_eq!(lost(&before, &after), [0, 3, 7, 12]);
        assert_eq!(lost(&before, &[]).len(), 10);
    }
}
