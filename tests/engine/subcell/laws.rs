//! Laws for every line: energy, memory, order, symmetries, and exact extremes and crossings of the force.

use super::*;

fn bits(point: &CurvePoint) -> [u64; 6] {
    let CurvePoint { indentation, force, contact_length, springs, fragments, stored_energy } = *point;
    let [d, force, length, energy] = [indentation, force, contact_length, stored_energy].map(f64::to_bits);
    [d, force, length, energy, springs, fragments]
}

fn to(turns: &[f64]) -> Vec<Move> {
    turns.iter().map(|&to| Move::ToIndentation(to)).collect()
}

/// Compares all bits of two points. With a smaller work on closing an edge that keeps its place may do so up to the
/// indentation at which it slid before: the level there is then the same but for its rounding.
fn same_point(body: &Body, one: &CurvePoint, other: &CurvePoint) -> Result<(), TestCaseError> {
    if body.closing_work < body.work {
        let slack = 1e-15 * body.force_scale();
        prop_assert!((one.force - other.force).abs() <= slack, "{:?} {:?}", one, other);
        prop_assert_eq!((one.springs, one.fragments), (other.springs, other.fragments));
    } else {
        prop_assert_eq!(bits(one), bits(other));
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn what_is_lost_is_the_work_less_what_is_stored(
        body in any_body(40),
        turns in prop::collection::vec(-0.9..1.3_f64, 1..7),
    ) {
        // From event to event and between them on fine steps: Simpson's rule on a curve that is smooth except at jumps,
        // where steps are.
        let mut solver = body.on(30_000);
        let scale = body.gaps.len() as f64 * body.foundation.spring_stiffness();
        let depth = 1.3 + body.largest_stretch();
        let (mut stored, mut lost) = (0.0, 0.0);
        for target in [to(&turns), vec![Move::ToSeparation]].concat() {
            let record = solver.advance(target).unwrap();
            let work: f64 = record.curve.windows(2).map(|p| {
                0.5 * (p[0].force + p[1].force) * (p[1].indentation - p[0].indentation)
            }).sum();
            let stored_now = end(&record).stored_energy;
            let expected = work - (stored_now - stored);
            // Each jump may lie anywhere in its step.
            let error = (record.released_energy - expected).abs();
            prop_assert!(error <= 2e-4 * scale * depth * depth, "{} for {}", record.released_energy, expected);
            (stored, lost) = (stored_now, lost + record.released_energy);
        }
        prop_assert!(lost >= -1e-14 * scale * depth * depth, "{}", lost);
    }

    #[test]
    fn minor_loops_close(body in any_body(60), deep in 0.0..1.3_f64, back in 0.0..1.0_f64) {
        let low = -body.largest_stretch();
        let back = low + back * (deep - low);
        let (once, again) = (body.history(&to(&[deep]), 2), body.history(&to(&[deep, back, deep]), 2));
        let (once_end, again_end) = (end(&once.legs[0]), end(&again.legs[2]));
        same_point(&body, &once_end, &again_end)?;
        prop_assert_eq!(once.contacts, again.contacts);
        let again = body.history(&to(&[deep, back, deep, back]), 2);
        let once = body.history(&to(&[deep, back]), 2);
        same_point(&body, &end(&once.legs[1]), &end(&again.legs[3]))?;
        prop_assert_eq!(once.contacts, again.contacts);
    }

    #[test]
    fn a_contact_that_is_formed_again_is_what_it_was(
        body in any_body(60), legs in formed::loadings(), samples in 2_usize..40,
    ) {
        formed::as_if_new(|| body.on(samples), &legs, body.force_scale())?;
    }

    #[test]
    fn deeper_loads_leave_more_in_contact(
        body in any_body(60), a in 0.0..1.2_f64, b in 0.0..1.2_f64, probe in 0.0..1.0_f64,
    ) {
        let (shallow, deep) = (a.min(b), a.max(b));
        let low = -body.largest_stretch();
        let probe = low + probe * (shallow - low);
        let (less, more) = (body.history(&to(&[shallow, probe]), 2), body.history(&to(&[deep, probe]), 2));
        let indices = |contacts: &[(usize, usize)]| -> Vec<usize> {
            contacts.iter().flat_map(|&(first, last)| first..=last).collect()
        };
        let held = indices(&more.contacts);
        prop_assert!(indices(&less.contacts).iter().all(|index| held.contains(index)));
        let most = |turn: f64| body.history(&[Move::ToIndentation(turn), Move::ToSeparation], 2).legs[1].smallest;
        let slack = 1e-14 * body.force_scale();
        let (more, less) = (most(deep), most(shallow));
        prop_assert!(more.force <= less.force + slack, "{more:?} {less:?}");
    }

    #[test]
    fn powers_of_two_scale_every_bit(body in any_body(60), turns in prop::collection::vec(-0.9..1.3_f64, 1..6)) {
        let scaled = Body {
            gaps: body.gaps.iter().map(|gap| 4.0 * gap).collect(),
            work: 16.0 * body.work,
            closing_work: 16.0 * body.closing_work,
            ..body.clone()
        };
        let four_turns: Vec<f64> = turns.iter().map(|turn| 4.0 * turn).collect();
        let (one, four) = (body.history(&to(&turns), 9), scaled.history(&to(&four_turns), 9));
        for (one, four) in one.legs.iter().zip(&four.legs) {
            prop_assert_eq!(16.0 * one.released_energy, four.released_energy);
            for (one, four) in one.curve.iter().zip(&four.curve) {
                let (indentation, force) = (4.0 * one.indentation, 4.0 * one.force);
                let one = CurvePoint { indentation, force, stored_energy: 16.0 * one.stored_energy, ..*one };
                prop_assert_eq!(bits(&one), bits(four));
            }
        }
    }

    #[test]
    fn mirrored_lines_differ_by_rounding(body in any_body(60), turns in prop::collection::vec(-0.9..1.3_f64, 1..6)) {
        let mirrored = Body { gaps: body.gaps.iter().rev().copied().collect(), ..body.clone() };
        let (one, other) = (body.history(&to(&turns), 9), mirrored.history(&to(&turns), 9));
        let scale = body.gaps.len() as f64 * body.foundation.spring_stiffness() * (1.3 + body.largest_stretch());
        for (one, other) in one.legs.iter().zip(&other.legs) {
            let (one, other) = (end(one), end(other));
            prop_assert_eq!((one.springs, one.fragments), (other.springs, other.fragments));
            prop_assert!((one.force - other.force).abs() <= 1e-13 * scale);
        }
    }

    #[test]
    fn extremes_are_those_of_very_many_points_whatever_the_samples(
        body in any_body(60), deep in 0.0..1.2_f64, samples in 2_usize..40,
    ) {
        let legs = [Move::ToIndentation(deep), Move::ToSeparation];
        let (few, many) = (body.history(&legs, samples), body.history(&legs, 20_011));
        let slack = 4e-15 * body.gaps.len() as f64 * body.foundation.spring_stiffness()
            * (1.3 + body.largest_stretch());
        for history in [&few, &many] {
            for (leg, curve) in history.legs.iter().zip(&many.legs) {
                for point in curve.curve.iter().filter(|point| point.springs > 0) {
                    let (least, most) = (leg.smallest.force, leg.largest.force);
                    if leg.direction == asperity::contact::Direction::Loading {
                        prop_assert!(point.force <= most + slack, "{point:?} above {:?}", leg.largest);
                    } else {
                        prop_assert!(point.force >= least - slack, "{point:?} below {:?}", leg.smallest);
                    }
                }
            }
        }
        prop_assert!((few.legs[1].smallest.force - many.legs[1].smallest.force).abs() <= slack);
        prop_assert!((few.legs[0].released_energy - many.legs[0].released_energy).abs() <= slack);
    }

    #[test]
    fn forces_are_reached_there_and_not_before(body in any_body(60), first in 0.0..1.0_f64, then in -0.3..1.0_f64) {
        let mut solver = body.on(5000);
        let slack = 1e-14 * body.gaps.len() as f64 * body.foundation.spring_stiffness()
            * (1.3 + body.largest_stretch());
        for share in [first, then] {
            let wanted = share * body.force_scale();
            let Ok(record) = solver.advance(Move::ToForce(wanted)) else { continue };
            let (last, before) = record.curve.split_last().unwrap();
            let presses = record.direction == asperity::contact::Direction::Loading;
            let past = |point: &CurvePoint| if presses { point.force - wanted } else { wanted - point.force };
            prop_assert!(past(last) >= -slack, "{last:?} for {wanted}");
            for point in before.iter().filter(|point| point.springs > 0) {
                let same = (point.indentation - last.indentation).abs() <= 1e-14 * (1.3 + body.largest_stretch());
                prop_assert!(same || past(point) <= slack, "{point:?} for {wanted}");
            }
        }
    }
}

#[test]
fn extreme_values_give_numbers() {
    let lines: [&[f64]; 8] = [
        &[0.0],
        &[0.0, 0.0],
        &[0.0, 1.0],
        &[1.0, 0.0, 1.0],
        &[0.0, 5e-324, 1e-310, 0.0],
        &[0.0, 1e-300, 1.0, 1e300],
        &[3.0, 2.0, 1.0, 0.0, 0.0, 1.0, f64::MIN_POSITIVE],
        &[0.5, 0.0, 0.5_f64.next_up(), 0.5_f64.next_down(), 0.0],
    ];
    for gaps in lines {
        for length in [1e-9, 1e-3, 1.0] {
            for work in [0.0, 1e-30, 1e-3, 1e30] {
                let foundation = Foundation::endless(length, 1e6);
                let gaps: Vec<f64> = gaps.iter().map(|gap| gap * length.min(1.0)).collect();
                let body = Body { gaps, foundation, work, closing_work: work };
                let mut solver = body.on(17);
                let legs = [
                    Move::ToTouch,
                    Move::ToIndentation(length),
                    Move::ToIndentation(-length),
                    Move::ToForce(1e3 * length),
                    Move::ToZeroForce,
                    Move::ToSeparation,
                    Move::ToForce(1.0),
                    Move::ToSeparation,
                ];
                for leg in legs {
                    let Ok(record) = solver.advance(leg) else { continue };
                    for point in &record.curve {
                        assert!(
                            point.force.is_finite() && point.indentation.is_finite(),
                            "{body:?} {point:?}"
                        );
                        assert!(point.contact_length >= 0.0, "{body:?} {point:?}");
                    }
                    assert!(record.released_energy.is_finite(), "{body:?} {leg:?}");
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(1500))]

    /// Without adhesion a line needs no tree: the cells alone give the same curves, forces reached and loss.
    #[test]
    fn without_adhesion_cells_alone_give_what_the_tree_gives(
        body in any_body(80),
        turns in prop::collection::vec((any::<bool>(), -0.2..1.3_f64), 1..5),
    ) {
        let body = Body { work: 0.0, closing_work: 0.0, ..body };
        let mut tree = body.on(33);
        let mut cells = nonadhesive(&body.gaps, Edges::SubCell, body.foundation, 33);
        let scale = body.force_scale();
        let near = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-12 * size;
        for (presses, turn) in turns {
            let leg = if presses { Move::ToForce(turn.max(0.0).powi(3) * scale) } else { Move::ToIndentation(turn) };
            let (one, other) = (tree.advance(leg).unwrap(), cells.advance(leg).unwrap());
            prop_assert_eq!((one.direction, one.curve.len()), (other.direction, other.curve.len()));
            for (a, b) in one.curve.iter().zip(&other.curve) {
                prop_assert!(near(a.indentation, b.indentation, 2.0 + body.deepest()), "{:?} {:?}", a, b);
                prop_assert!(near(a.force, b.force, scale), "{:?} {:?}", a, b);
                prop_assert!(near(a.contact_length, b.contact_length, 100.0), "{:?} {:?}", a, b);
            }
            prop_assert!(near(one.largest.force, other.largest.force, scale));
            prop_assert!(near(one.smallest.force, other.smallest.force, scale));
            prop_assert_eq!(other.released_energy, 0.0);
        }
        prop_assert_eq!(cells.work().hess_evaluations, 0);
    }
}
