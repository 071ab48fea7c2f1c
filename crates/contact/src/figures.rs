//! The figures of a loading history, such as its preload and pull-off force, and the marked points
//! of its force curve.

use super::body::Reversal;
use super::branches::{Branch, ROUNDING};
use super::history::{CurvePoint, Direction, History, StageRecord};
use super::target::Move;

/// Figures of a loading history: preload, pull-off and dissipated energy. A figure is `None` if the
/// history does not determine it.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let pressed = contact.load(&[Move::ToForce(1.0e-4)])?.figures();
/// assert_eq!((pressed.pull_off_force, pressed.dissipated_energy), (None, None));
/// let loop_ = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?.figures();
/// assert!((loop_.adhesion_coefficient.unwrap() - 0.2356).abs() < 1e-4);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Preload F_n in N: the largest force on loading before the last unloading. Forces before an
    /// earlier separation of the body do not count. `None` if the body is never in contact on this
    /// loading.
    pub preload: Option<f64>,
    /// Indentation in m at which the preload acts; `None` if `preload` is `None`.
    pub preload_indentation: Option<f64>,
    /// Pull-off force F_a in N: the smallest force of the last unloading, with the opposite sign.
    /// `None` if this smallest force is above zero. Also `None` if the unloading ends in contact
    /// before it has passed the smallest force.
    pub pull_off_force: Option<f64>,
    /// Adhesion coefficient F_a/F_n. `None` if F_a is `None`, or if the preload is not a positive
    /// force.
    pub adhesion_coefficient: Option<f64>,
    /// Indentation in m at the smallest force of the last unloading. `None` if `pull_off_force` is
    /// `None`. This indentation is less accurate than the pull-off force.
    pub pull_off_indentation: Option<f64>,
    /// Energy in J dissipated in the contact during all stages together; `None` if the last stage
    /// ends in contact.
    pub dissipated_energy: Option<f64>,
}

impl Figures {
    /// Computes preload, pull-off and dissipated energy from the records of a history.
    pub fn of(history: &History) -> Self {
        let records = &history.stages;
        let preload = Branch::preload(records).map(|(stage, point)| Preload {
            target: records[stage].target,
            point,
        });
        let pull_off = Branch::pull_off(records).map(|(_, point)| point);
        let end = records.last().and_then(|record| record.curve.last());
        let ends_separated = end.is_some_and(|point| point.springs == 0);
        let energy =
            ends_separated.then(|| records.iter().map(StageRecord::dissipated_energy).sum());
        Figures::of_points(preload, pull_off, energy)
    }

    /// Computes the figures of a history with two stages: a loading of the separated body to the
    /// target `record`, and the unloading `reversal` back to separation.
    pub fn of_reversal(record: Move, reversal: &Reversal) -> Self {
        let touches = reversal.turn.springs > 0;
        let preload = Preload {
            target: record,
            point: reversal.turn,
        };
        let pulls = touches && reversal.smallest.force <= 0.0;
        Figures::of_points(
            touches.then_some(preload),
            pulls.then_some(reversal.smallest),
            Some(reversal.dissipated_energy),
        )
    }

    /// Computes the figures from the preload, the pull-off point, and the energy in J that all
    /// stages together release.
    fn of_points(
        preload: Option<Preload>,
        pull_off: Option<CurvePoint>,
        energy: Option<f64>,
    ) -> Self {
        let preload_force = preload.map(|preload| preload.without_rounding().force);
        // 0.0 − F instead of −F, because −F would be −0 for a force of zero.
        let pull_off_force = pull_off.map(|point| 0.0 - point.force);
        Figures {
            preload: preload_force,
            preload_indentation: preload.map(|preload| preload.point.indentation),
            pull_off_force,
            adhesion_coefficient: adhesion_coefficient(pull_off_force, preload_force),
            pull_off_indentation: pull_off.map(|point| point.indentation),
            // Adding 0.0 changes −0 to 0 if no energy is dissipated.
            dissipated_energy: energy.map(|energy| energy + 0.0),
        }
    }
}

/// Returns F_a/F_n for forces in N; `None` if either force is `None`, if the preload is not
/// positive, or if the quotient is too large for a number.
fn adhesion_coefficient(pull_off_force: Option<f64>, preload: Option<f64>) -> Option<f64> {
    let pull_off_force = pull_off_force?;
    let preload = preload?;
    let coefficient = pull_off_force / preload;
    (preload > 0.0 && coefficient.is_finite()).then_some(coefficient)
}

/// Point of the largest force on loading, with the target of its stage.
#[derive(Clone, Copy)]
struct Preload {
    target: Move,
    point: CurvePoint,
}

impl Preload {
    /// Returns the point of the preload. If the target is a force of zero, the force is set to
    /// exactly zero, because the small remaining force is a rounding.
    fn without_rounding(&self) -> CurvePoint {
        match self.target {
            Move::ToForce(0.0) | Move::ToZeroForce => CurvePoint {
                force: 0.0,
                ..self.point
            },
            _ => self.point,
        }
    }
}

/// Name of a special point of a force curve: a jump, the preload or the pull-off.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
/// use asperity_contact::Mark;
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// let found = Mark::all(cycle.stages()).into_iter().map(|marked| marked.mark);
/// assert!(found.eq([Mark::JumpIn, Mark::Preload, Mark::PullOff, Mark::JumpOut]));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// First point in contact after the first jump from separation into contact. The mark exists
    /// only if the force at this point is tensile.
    JumpIn,
    /// Point at which the preload acts, as [`Branch::preload`] finds it.
    Preload,
    /// Point at which the pull-off force acts, as [`Branch::pull_off`] finds it. The mark exists
    /// only if the pull-off force is tensile.
    PullOff,
    /// Last point in contact of the last unloading, before the body jumps out of contact. The mark
    /// exists only if the force at this point is tensile, but less tensile than the pull-off force.
    JumpOut,
}

impl Mark {
    /// Finds the special points of a force curve. Returns each mark with its point, in the order of
    /// the variants of [`Mark`]. `records` are the records of all loading stages.
    pub fn all(records: &[StageRecord]) -> Vec<MarkedPoint> {
        let mut marks = Vec::new();
        let mut add = |mark: Mark, stage: usize, point: CurvePoint| {
            marks.push(MarkedPoint {
                mark,
                stage,
                seconds: records[stage].time_of(&point),
                point,
            });
        };
        if let Some((stage, point)) = first_jump_into_contact(records)
            && point.force < 0.0
        {
            add(Mark::JumpIn, stage, point);
        }
        if let Some((stage, point)) = Branch::preload(records) {
            let target = records[stage].target;
            let preload = Preload { target, point };
            add(Mark::Preload, stage, preload.without_rounding());
        }
        if let Some((stage, pull_off)) = Branch::pull_off(records) {
            if pull_off.force < 0.0 {
                add(Mark::PullOff, stage, pull_off);
            }
            if let Some((stage, point)) = last_jump_out_of_contact(records)
                && point.force > pull_off.force * (1.0 - ROUNDING)
                && point.force < 0.0
            {
                add(Mark::JumpOut, stage, point);
            }
        }
        marks
    }

    /// Returns the name of the mark as charts print it beside the point, such as `pull-off`.
    pub fn name(self) -> &'static str {
        match self {
            Mark::JumpIn => "jump-in",
            Mark::Preload => "preload",
            Mark::PullOff => "pull-off",
            Mark::JumpOut => "jump-out",
        }
    }
}

/// Point of a force curve with its mark.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MarkedPoint {
    /// Kind of the point.
    pub mark: Mark,
    /// Index of the stage of the point.
    pub stage: usize,
    /// Indentation, force and contact.
    pub point: CurvePoint,
    /// Time of the point in s since first touch; `None` without
    /// [relaxation](crate::Relaxation), because time then has no effect.
    pub seconds: Option<f64>,
}

/// Returns the first point in contact after the first jump of a history into contact, and the index
/// of its stage.
fn first_jump_into_contact(records: &[StageRecord]) -> Option<(usize, CurvePoint)> {
    let mut stages = records.iter().enumerate();
    stages.find_map(|(stage, record)| Some((stage, jump_into_contact(record)?)))
}

/// Returns the first point in contact after the first jump of a loading into contact.
fn jump_into_contact(record: &StageRecord) -> Option<CurvePoint> {
    if record.direction != Direction::Loading {
        return None;
    }
    let mut pairs = record.curve.windows(2);
    let jump = pairs.find(|pair| pair[0].springs == 0 && pair[1].springs > 0)?;
    Some(jump[1])
}

/// Returns the last point before the last jump of a motion out of contact.
fn jump_out_of_contact(record: &StageRecord) -> Option<CurvePoint> {
    let mut pairs = record.curve.windows(2);
    let jump = pairs.rfind(|pair| pair[0].springs > 0 && pair[1].springs == 0)?;
    Some(jump[0])
}

/// Returns the last point in contact of the last unloading, if the body jumps out of contact there,
/// and the index of its stage.
fn last_jump_out_of_contact(records: &[StageRecord]) -> Option<(usize, CurvePoint)> {
    let mut stages = Branch::last_unloading(records)?.stages.rev();
    stages.find_map(|stage| Some((stage, jump_out_of_contact(&records[stage])?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(indentation: f64, force: f64, springs: u64) -> CurvePoint {
        CurvePoint {
            indentation,
            force,
            springs,
            ..CurvePoint::default()
        }
    }

    /// Creates the record of a stage with this curve. The point `extreme` has both the largest and
    /// the smallest force. The released energy is 0.25 J.
    fn stage(
        target: Move,
        direction: Direction,
        curve: &[CurvePoint],
        extreme: CurvePoint,
    ) -> StageRecord {
        let (curve, largest, smallest) = (curve.to_vec(), extreme, extreme);
        let still = StageRecord::still(target, extreme);
        StageRecord {
            direction,
            curve,
            largest,
            smallest,
            released_energy: 0.25,
            ..still
        }
    }

    fn pressed(force: f64) -> StageRecord {
        let extreme = point(force / 10.0, force, 3);
        stage(
            Move::ToForce(force),
            Direction::Loading,
            &[point(0.0, 0.5, 1), extreme],
            extreme,
        )
    }

    fn pulled(force: f64, springs: u64) -> StageRecord {
        let extreme = point(-0.3, force, 2);
        stage(
            Move::ToSeparation,
            Direction::Unloading,
            &[extreme, point(-0.3, 0.0, springs)],
            extreme,
        )
    }

    fn figures(records: &[StageRecord]) -> Figures {
        Figures::of(&History {
            stages: records.to_vec(),
            ..History::default()
        })
    }

    #[test]
    fn figures_are_of_the_largest_press_and_the_last_pull() {
        let found = figures(&[pressed(7.0), pulled(-3.0, 1), pressed(5.0), pulled(-2.0, 0)]);
        let expected = Figures {
            preload: Some(7.0),
            preload_indentation: Some(0.7),
            pull_off_force: Some(2.0),
            adhesion_coefficient: Some(2.0 / 7.0),
            pull_off_indentation: Some(-0.3),
            dissipated_energy: Some(1.0),
        };
        assert_eq!(found, expected);
        // Without dissipation the energy is 0, not −0.
        let nothing = |stage: StageRecord| StageRecord {
            released_energy: -0.0,
            ..stage
        };
        let lost = figures(&[nothing(pressed(7.0)), nothing(pulled(-3.0, 0))]).dissipated_energy;
        assert!(
            lost.is_some_and(|lost| lost == 0.0 && lost.is_sign_positive()),
            "{lost:?}"
        );
        // A body that ends in contact has not completed a loop, so the dissipated energy is
        // unknown.
        assert_eq!(
            figures(&[pressed(7.0), pulled(-3.0, 1)]).dissipated_energy,
            None
        );
        assert_eq!(figures(&[]), Figures::default());
    }

    #[test]
    fn only_a_stage_that_pulls_has_a_pull_off_force_and_only_a_preload_a_coefficient() {
        let adhesion = |force| figures(&[pressed(1.0), pulled(force, 0)]).pull_off_force;
        assert_eq!(adhesion(1e-300), None);
        let none = adhesion(0.0);
        assert!(none == Some(0.0) && none.is_some_and(f64::is_sign_positive));
        assert_eq!(adhesion(-1e-300), Some(1e-300));
        // The smallest force lies inside the stage, and the rest of the unloading has no smaller
        // force, so it is the pull-off force.
        let ends_at = |force: f64, rest: Option<f64>| {
            let mut pulled = pulled(-1.0, 0);
            pulled.curve = vec![pulled.smallest, point(-0.5, force, 1)];
            pulled.smallest_of_rest = rest.map(|force| point(-0.6, force, 1));
            figures(&[pressed(1.0), pulled]).pull_off_force
        };
        let rest = Some(-0.9);
        let ends = [
            ends_at(-1.0, rest),
            ends_at(-1.0 + 1e-12, rest),
            ends_at(-0.9, rest),
        ];
        assert_eq!(ends, [None, None, Some(1.0)]);
        assert_eq!([ends_at(-0.9, Some(-1.1)), ends_at(-0.9, None)], [None; 2]);
        // The coefficient is `None` if it is too large for a number. It is also `None` if the
        // target is a force of zero, although rounding leaves a small positive force.
        for pressed in [pressed(0.0), pressed(1e-320)] {
            assert_eq!(
                figures(&[pressed, pulled(-1.0, 0)]).adhesion_coefficient,
                None
            );
        }
        for target in [Move::ToForce(0.0), Move::ToZeroForce] {
            let found = figures(&[
                StageRecord {
                    target,
                    ..pressed(1e-18)
                },
                pulled(-1.0, 0),
            ]);
            assert_eq!(
                (found.preload, found.adhesion_coefficient),
                (Some(0.0), None)
            );
        }
    }

    #[test]
    fn a_loop_has_its_marks_and_a_curve_without_adhesion_only_the_preload() {
        let up = [point(0.0, 0.0, 0), point(0.0, -1.0, 2), point(2.0, 3.0, 9)];
        let down = [
            up[2],
            point(-1.0, -2.0, 5),
            point(-1.5, -0.5, 1),
            point(-1.5, 0.0, 0),
        ];
        let mut records = [
            stage(Move::ToForce(3.0), Direction::Loading, &up, up[2]),
            stage(Move::ToSeparation, Direction::Unloading, &down, down[1]),
        ];
        let expected = [
            (Mark::JumpIn, up[1]),
            (Mark::Preload, up[2]),
            (Mark::PullOff, down[1]),
            (Mark::JumpOut, down[2]),
        ];
        let marks = |records: &[StageRecord]| -> Vec<(Mark, CurvePoint)> {
            let marked = Mark::all(records).into_iter();
            marked.map(|marked| (marked.mark, marked.point)).collect()
        };
        assert_eq!(marks(&records), expected);
        records[1].curve.remove(2);
        assert_eq!(
            marks(&records),
            expected[..3],
            "the contact is lost at pull-off"
        );
        assert_eq!(Mark::all(&[pressed(1.0)]).len(), 1);
    }
}
