//! Remarkable points of a force curve.

use crate::contact::{CurvePoint, Direction, LegRecord};

/// A remarkable point of a force curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// First contact at a tensile force: the contact forms in a jump.
    JumpIn,
    /// Largest force of the loading stages.
    Preload,
    /// Smallest force of the last unloading stage, tensile.
    PullOff,
    /// Last contact of the last unloading stage at a tensile force, if not the pull-off: the contact is lost in a
    /// jump.
    JumpOut,
}

impl Mark {
    /// Technical name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Mark::JumpIn => "jump-in",
            Mark::Preload => "preload",
            Mark::PullOff => "pull-off",
            Mark::JumpOut => "jump-out",
        }
    }
}

/// Existing marks of a loading history, in their order.
#[must_use]
pub fn marks(legs: &[LegRecord]) -> Vec<(Mark, CurvePoint)> {
    let mut marks = Vec::new();
    let loading = || legs.iter().filter(|leg| leg.direction == Direction::Loading);
    let touch = loading().find(|leg| leg.curve.iter().any(|point| point.springs > 0));
    let jump = touch.and_then(|leg| {
        let pair = leg.curve.windows(2).find(|pair| pair[0].springs == 0 && pair[1].springs > 0)?;
        Some(pair[1]).filter(|point| point.force < 0.0)
    });
    marks.extend(jump.map(|point| (Mark::JumpIn, point)));
    let preload = loading().map(|leg| leg.largest).max_by(|a, b| a.force.total_cmp(&b.force));
    marks.extend(preload.filter(|point| point.springs > 0).map(|point| (Mark::Preload, point)));
    let unloading = legs.iter().rev().find(|leg| leg.direction == Direction::Unloading);
    let pull_off = unloading.map(|leg| leg.smallest).filter(|point| point.force < 0.0);
    marks.extend(pull_off.map(|point| (Mark::PullOff, point)));
    let lost = unloading.and_then(|leg| {
        let pair = leg.curve.windows(2).rfind(|pair| pair[0].springs > 0 && pair[1].springs == 0)?;
        // The forces are different sums, so equal forces differ by rounding.
        let is_pull_off = pull_off.is_some_and(|least| pair[0].force <= least.force * (1.0 - 1e-9));
        Some(pair[0]).filter(|point| point.force < 0.0 && !is_pull_off)
    });
    marks.extend(lost.map(|point| (Mark::JumpOut, point)));
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Leg;

    fn point(indentation: f64, force: f64, springs: u64) -> CurvePoint {
        CurvePoint { indentation, force, springs, ..CurvePoint::default() }
    }

    #[test]
    fn a_loop_has_its_marks_and_a_curve_without_adhesion_only_the_preload() {
        let loading = vec![point(0.0, 0.0, 0), point(0.0, -1.0, 2), point(2.0, 3.0, 9)];
        let unloading =
            vec![point(2.0, 3.0, 9), point(-1.0, -2.0, 5), point(-1.5, -0.5, 1), point(-1.5, 0.0, 0)];
        let leg = |leg, direction, curve: &[CurvePoint], largest, smallest| LegRecord {
            direction,
            curve: curve.to_vec(),
            largest,
            smallest,
            ..LegRecord::still(leg, point(0.0, 0.0, 0))
        };
        let legs = [
            leg(Leg::ToForce(3.0), Direction::Loading, &loading, loading[2], loading[1]),
            leg(Leg::ToSeparation, Direction::Unloading, &unloading, unloading[0], unloading[1]),
        ];
        let expected = [
            (Mark::JumpIn, loading[1]),
            (Mark::Preload, loading[2]),
            (Mark::PullOff, unloading[1]),
            (Mark::JumpOut, unloading[2]),
        ];
        assert_eq!(marks(&legs), expected);
        let mut torn = legs.clone();
        torn[1].curve.remove(2);
        assert_eq!(marks(&torn), expected[..3], "the contact is lost at pull-off");
        let pressed = [point(0.0, 0.0, 0), point(0.0, 0.0, 1), point(1.0, 1.0, 4)];
        let legs = [leg(Leg::ToForce(1.0), Direction::Loading, &pressed, pressed[2], pressed[0])];
        assert_eq!(marks(&legs), [(Mark::Preload, pressed[2])]);
        assert_eq!(marks(&[]), []);
    }
}
