//! Patches by themselves add up to the point of the curve, and a body moves between targets as along a recorded leg.

use super::*;
use asperity::contact::{Body as Moving, ContactError, Direction, Stepwise};

/// Moves a body along legs and compares points of each curve with the sums over the patches there.
fn patches_add_up(body: &Body, edges: Edges, hess: HessRule, legs: &[Move]) -> Result<(), TestCaseError> {
    let mut solver = adhesive(&body.gaps, edges, hess, body.foundation, 12);
    let tolerance = 1e-9 * body.force_scale();
    let spread = 1e-9 * body.foundation.spacing * body.gaps.len() as f64;
    for &leg in legs {
        let record = solver.advance(leg).unwrap();
        let leg = solver.leg();
        for point in &record.curve {
            let patches = leg.patches(point.indentation);
            let springs: u64 = patches.iter().map(|&(first, last)| (last - first + 1) as u64).sum();
            // At a point where part of the contact jumps, either side is right.
            if springs != point.springs {
                continue;
            }
            prop_assert_eq!(&leg.point(point.indentation).unwrap(), point);
            let states: Vec<_> = (0..patches.len())
                .map(|number| leg.patch_state(point.indentation, number).unwrap())
                .collect();
            prop_assert_eq!(leg.patch_state(point.indentation, patches.len()), None);
            let force: f64 = states.iter().map(|state| state.force).sum();
            let length: f64 = states.iter().map(|state| state.length).sum();
            prop_assert!((force - point.force).abs() <= tolerance);
            prop_assert!((length - point.contact_length).abs() <= spread);
            for (state, &(first, last)) in states.iter().zip(&patches) {
                prop_assert!(
                    state.most_stretched <= state.largest_stretch * (1.0 + 1e-6) + 1e-9,
                    "{:?}",
                    state
                );
                let range = body.work / body.foundation.effective_modulus;
                let largest = (std::f64::consts::PI * state.length * range).sqrt();
                prop_assert!((state.largest_stretch / largest - 1.0).abs() < 1e-12);
                if edges == Edges::Grid {
                    let highest = body.gaps[first..=last].iter().copied().fold(0.0, f64::max);
                    prop_assert_eq!(state.most_stretched, highest - point.indentation);
                    let springs = (last - first + 1) as f64;
                    prop_assert_eq!(state.length, springs * body.foundation.spacing);
                }
            }
        }
    }
    Ok(())
}

/// Moves a body to targets twice: along recorded legs, and without a curve by moves of several parts.
fn moves_alike(
    new: impl Fn() -> Moving,
    targets: &[Move],
    parts: &[f64],
    scale: f64,
) -> Result<(), TestCaseError> {
    let (mut recorded, mut moved) = (new(), new());
    for &target in targets {
        let from = moved.point();
        let record = match (recorded.advance(target), moved.plan_of(target)) {
            (Ok(record), Ok(())) => record,
            (Err(one), Err(other)) => {
                prop_assert_eq!(one, other);
                prop_assert_eq!(moved.point(), from);
                continue;
            }
            other => return Err(TestCaseError::fail(format!("{target:?}: {other:?}"))),
        };
        let end = record.curve.last().unwrap();
        let mut released = 0.0;
        let mut changed = 0;
        let mut go = |moved: &mut Moving, target| {
            let before = moved.point();
            if let Some(motion) = moved.move_to(target).unwrap() {
                let after = moved.point();
                let low =
                    if before.springs == 0 || after.springs == 0 { f64::NEG_INFINITY } else { motion.low };
                released += motion.leg.released_energy(low, motion.high);
                changed += after.springs.abs_diff(before.springs);
            }
        };
        // The rounding of a crossing depends on the indentation from which it is sought.
        let divided = from.springs > 0 && matches!(target, Move::ToIndentation(_) | Move::ToSeparation);
        for part in parts.iter().filter(|_| divided) {
            let at = from.indentation + part * (end.indentation - from.indentation);
            go(&mut moved, Move::ToIndentation(at));
        }
        go(&mut moved, target);
        prop_assert_eq!(bits(&moved.point()), bits(end), "{:?}", target);
        prop_assert_eq!(changed, record.attached + record.detached);
        prop_assert!(
            (released - record.released_energy).abs() <= 1e-12 * scale,
            "{:?}: {} J",
            target,
            released
        );
        let at = end.indentation;
        if end.springs > 0 {
            prop_assert_eq!(moved.present_leg().patches(at), recorded.leg().patches(at));
        }
    }
    Ok(())
}

trait PlanOf {
    fn plan_of(&self, target: Move) -> Result<(), ContactError>;
}

impl PlanOf for Moving {
    /// Moves a copy of the body.
    fn plan_of(&self, target: Move) -> Result<(), ContactError> {
        let mut copy = Moving::at(self.present_leg(), self.point().indentation)?;
        copy.move_to(target).map(drop)
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn patches_add_up_to_the_point_of_the_curve(
        body in body(), turns in indentations(5), closing in 0.0..1.0_f64,
    ) {
        let hess = HessRule::new(body.foundation, body.work);
        let two_works = HessRule::from_works(body.foundation, closing * body.work, body.work);
        for hess in [hess, two_works] {
            patches_add_up(&body, Edges::Grid, hess, &to_indentations(&turns))?;
            patches_add_up(&body, Edges::SubCell, hess, &to_indentations(&turns))?;
        }
    }

    /// A history ends with as many contacts as its last point has fragments: none after separation.
    #[test]
    fn a_history_ends_with_the_contacts_of_its_last_point(body in body(), turns in indentations(5), apart: bool) {
        let mut legs = to_indentations(&turns);
        if apart {
            legs.push(Move::ToSeparation);
        }
        let history = body.history(&legs, 8);
        prop_assert_eq!(history.contacts.len() as u64, end(&history).fragments);
        prop_assert_eq!(indices(&history.contacts).len() as u64, end(&history).springs);
    }
}

/// Moves a solver along legs to indentations and asks each leg for its extremes and for the forces that it passes.
fn asked_alike(solver: &mut dyn Solver, targets: &[Move], scale: f64) -> Result<(), TestCaseError> {
    let mut separated = true;
    for &target in targets {
        let record = solver.advance(target).unwrap();
        let (leg, loads) = (solver.leg(), record.direction == Direction::Loading);
        let (low, high) = (record.start().min(record.end()), record.start().max(record.end()));
        let low = if separated { low.max(0.0) } else { low };
        let touches = |point: &CurvePoint| point.springs > 0;
        let expected = if loads { record.largest } else { record.smallest };
        let holds = record.curve.last().is_some_and(touches) && touches(&expected);
        if holds && record.curve.len() > 1 {
            let found = leg.extremes(low, high).unwrap();
            let curve = leg.curve(&[low, high]).unwrap();
            prop_assert_eq!(bits(&curve[usize::from(loads)]), bits(record.curve.last().unwrap()));
            let found = found[usize::from(loads)];
            prop_assert!((found.force - expected.force).abs() <= 1e-14 * scale, "{:?} {:?}", found, expected);
            // Within reach in spite of the rounding of the division by the stiffness.
            let wanted = expected.force + 1e-13 * scale * if loads { -1.0 } else { 1.0 };
            let at = leg.find_force(wanted, if loads { low } else { high }).unwrap();
            let there = leg.point(at).unwrap().force;
            let reached = if loads { there - wanted } else { wanted - there };
            prop_assert!(reached >= -1e-14 * scale, "{} for {}", there, wanted);
        }
        separated = record.curve.last().unwrap().springs == 0;
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn a_move_is_the_leg_that_it_would_record(
        body in body_of_two_works(),
        targets in formed::loadings(),
        parts in prop::collection::vec(0.0..1.0_f64, 0..4),
    ) {
        let mut parts = parts;
        parts.sort_by(f64::total_cmp);
        let share = |target: &Move| match *target {
            Move::ToForce(share) => Move::ToForce(share * body.force_scale()),
            other => other,
        };
        let targets: Vec<_> = targets.iter().map(share).collect();
        let scale = body.force_scale() * (body.deepest() + body.largest_stretch() + 1.0);
        for edges in [Edges::Grid, Edges::SubCell] {
            let (gaps, foundation) = (&body.gaps, body.foundation);
            moves_alike(|| adhesive(gaps, edges, body.hess(), foundation, 2), &targets, &parts, scale)?;
            moves_alike(|| nonadhesive(gaps, edges, foundation, 2), &targets, &parts, scale)?;
        }
    }

    #[test]
    fn a_leg_has_the_extremes_and_forces_of_its_record(body in body_of_two_works(), turns in indentations(6)) {
        let targets = to_indentations(&turns);
        // Forces of all springs at the deepest of these indentations.
        let springs = body.gaps.len() as f64 * body.foundation.spring_stiffness();
        let scale = springs * (body.deepest() + body.largest_stretch() + 1.2);
        for edges in [Edges::Grid, Edges::SubCell] {
            asked_alike(&mut adhesive(&body.gaps, edges, body.hess(), body.foundation, 9), &targets, scale)?;
            asked_alike(&mut nonadhesive(&body.gaps, edges, body.foundation, 9), &targets, scale)?;
        }
        let contact = body.contact();
        let mut stepwise = Stepwise::new(&contact, 0.05, 5000, &|| false).unwrap();
        stepwise.advance(targets[0]).unwrap();
        let end = stepwise.leg().end();
        prop_assert_eq!(stepwise.leg().extremes(0.0, end), Err(ContactError::Stepwise));
        prop_assert_eq!(stepwise.leg().find_force(0.0, 0.0), Err(ContactError::Stepwise));
    }
}
