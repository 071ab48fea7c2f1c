//! Remarkable points of a force curve.

use super::figures::{preload_point, pull_off_point};
use crate::contact::{CurvePoint, Direction, LegRecord};

/// A remarkable point of a force curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// First contact at a tensile force: the contact forms in a jump.
    JumpIn,
    /// See [`preload_point`].
    Preload,
    /// See [`pull_off_point`]; at a tensile force.
    PullOff,
    /// Last contact of the unloading stage of the pull-off, if not the pull-off: the contact is lost in a jump.
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
    let mut loading = legs.iter().filter(|leg| leg.direction == Direction::Loading);
    let touch = loading.find(|leg| leg.curve.iter().any(|point| point.springs > 0));
    let jump = touch.and_then(|leg| {
        let pair = leg.curve.windows(2).find(|pair| pair[0].springs == 0 && pair[1].springs > 0)?;
        Some(pair[1]).filter(|point| point.force < 0.0)
    });
    marks.extend(jump.map(|point| (Mark::JumpIn, point)));
    marks.extend(preload_point(legs).map(|(_, point)| (Mark::Preload, point)));
    let pull_off = pull_off_point(legs).filter(|(_, point)| point.force < 0.0);
    marks.extend(pull_off.map(|(_, point)| (Mark::PullOff, point)));
    let lost = pull_off.and_then(|(stage, least)| {
        let curve = &legs[stage].curve;
        let pair = curve.windows(2).rfind(|pair| pair[0].springs > 0 && pair[1].springs == 0)?;
        // The forces are different sums, so equal forces differ by rounding.
        let is_pull_off = pair[0].force <= least.force * (1.0 - 1e-9);
        Some(pair[0]).filter(|point| point.force < 0.0 && !is_pull_off)
    });
    marks.extend(lost.map(|point| (Mark::JumpOut, point)));
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Figures;
    use crate::contact::History;
    use crate::scene::Move;

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
            leg(Move::ToForce(3.0), Direction::Loading, &loading, loading[2], loading[1]),
            leg(Move::ToSeparation, Direction::Unloading, &unloading, unloading[0], unloading[1]),
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
        let legs = [leg(Move::ToForce(1.0), Direction::Loading, &pressed, pressed[2], pressed[0])];
        assert_eq!(marks(&legs), [(Mark::Preload, pressed[2])]);
        assert_eq!(marks(&[]), []);
    }

    #[test]
    fn a_later_stage_of_the_separated_body_keeps_the_marks_of_the_summary() {
        let loading = [point(0.0, 0.0, 0), point(0.0, -1.0, 2), point(2.0, 3.0, 9)];
        let unloading = [point(2.0, 3.0, 9), point(-1.0, -2.0, 5), point(-1.5, 0.0, 0)];
        let leg = |leg, direction, curve: &[CurvePoint], extreme| LegRecord {
            direction,
            curve: curve.to_vec(),
            largest: extreme,
            smallest: extreme,
            ..LegRecord::still(leg, point(0.0, 0.0, 0))
        };
        let legs = vec![
            leg(Move::ToForce(3.0), Direction::Loading, &loading, loading[2]),
            leg(Move::ToSeparation, Direction::Unloading, &unloading, unloading[1]),
            LegRecord::free(Move::ToIndentation(-2.0), -1.5, -2.0),
            LegRecord::free(Move::ToIndentation(-1.0), -2.0, -1.0),
        ];
        let marked =
            |wanted| marks(&legs).into_iter().find(|(mark, _)| *mark == wanted).map(|(_, at)| at.force);
        let figures = Figures::of(&History { legs: legs.clone(), ..History::default() });
        assert_eq!(marked(Mark::PullOff), figures.adhesion_force.map(|force| -force));
        assert_eq!(marked(Mark::Preload), figures.preload);
        assert_eq!(figures.adhesion_force, Some(2.0));
    }
}
