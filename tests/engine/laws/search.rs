//! Extremes and crossings of the force against all segments of the leg, and independent of the number of samples.

use super::brute_force::Steps;
use super::*;
use asperity::contact::{ContactError, Direction};

/// Legs as drawn: forces as shares of a scale.
#[derive(Clone, Copy, Debug)]
enum Step {
    To(f64),
    Force(f64),
    ForceBy(f64),
    ZeroForce,
    Separation,
}

fn moves() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        3 => (-0.5..1.2_f64).prop_map(Step::To),
        3 => (-0.5..1.0_f64).prop_map(Step::Force),
        4 => (-4.0..0.0_f64, any::<bool>())
            .prop_map(|(p, up)| Step::ForceBy(if up { 1.0 } else { -1.0 } * 10_f64.powf(p))),
        1 => Just(Step::ZeroForce),
        1 => Just(Step::Separation),
    ];
    prop::collection::vec(step, 1..8)
}

impl Step {
    fn leg(self, body: &Body, present: f64) -> Move {
        match self {
            Step::To(to) => Move::ToIndentation(to),
            Step::Force(share) => Move::ToForce(share * body.force_scale()),
            Step::ForceBy(share) => Move::ToForce(present + share * body.force_scale()),
            Step::ZeroForce => Move::ToZeroForce,
            Step::Separation => Move::ToSeparation,
        }
    }
}

/// Rounding of a force on this body at indentation d, N.
fn rounding(body: &Body, d: f64, force: f64) -> f64 {
    let largest_sum =
        body.gaps.len() as f64 * body.foundation.spring_stiffness() * (d.abs() + body.deepest());
    4.0 * f64::EPSILON * force.abs() + 1e-18 * largest_sum
}

/// Rounding of a force at a rounded indentation, N.
fn rounding_at_rounded(body: &Body, d: f64, force: f64) -> f64 {
    let springs = body.gaps.len() as f64 * body.foundation.spring_stiffness();
    rounding(body, d, force) + 8.0 * f64::EPSILON * springs * (d.abs() + body.deepest())
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn extremes_and_crossings_are_those_of_all_segments(
        body in body(),
        moves in moves(),
        samples in 2_usize..600,
    ) {
        let mut solver = body.on(samples);
        let (mut start, mut present, mut separated) = (0.0_f64, 0.0, true);
        for step in moves {
            let target = step.leg(&body, present);
            let outcome = solver.advance(target);
            // A refused unloading is that from the present contact.
            let leg = solver.leg();
            let turns = outcome.is_err() && leg.direction() == Direction::Loading && !separated;
            let leg = if turns { leg.turn(start).unwrap() } else { leg };
            let thresholds = leg.thresholds();
            let steps = Steps::new(&thresholds, &body);
            let record = match outcome {
                Ok(record) => record,
                Err(ContactError::DetachesBefore { smallest }) if target == Move::ToZeroForce => {
                    prop_assert!(smallest > 0.0);
                    continue;
                }
                Err(ContactError::DetachesBefore { smallest }) => {
                    let Move::ToForce(force) = target else { panic!("{target:?}") };
                    let expected = steps.smallest(f64::NEG_INFINITY, start);
                    prop_assert!((smallest - expected).abs() <= rounding(&body, start, expected));
                    prop_assert!(smallest > force, "{} was in reach, at least {}", force, smallest);
                    continue;
                }
                Err(ContactError::NothingToPull) => {
                    prop_assert!(separated && matches!(target, Move::ToForce(force) if force < 0.0));
                    continue;
                }
                Err(error) => return Err(TestCaseError::fail(error.to_string())),
            };
            let end = *record.curve.last().unwrap();
            let d = end.indentation;
            let wanted = match target {
                Move::ToForce(force) => Some(force),
                Move::ToZeroForce => Some(0.0),
                _ => None,
            };
            let moved = record.curve.len() > 1 && (end.springs > 0 || !separated);
            if moved && record.direction == Direction::Loading {
                let low = if separated { start.max(0.0) } else { start };
                let (found, expected) = (record.largest.force, steps.largest(low, d));
                prop_assert!((found - expected).abs() <= rounding_at_rounded(&body, d, expected),
                    "largest {} against {} on {:?}", found, expected, leg);
                if let Some(force) = wanted {
                    let first = steps.first_at_least(force, low).unwrap();
                    prop_assert!((d - first).abs() <= 16.0 * f64::EPSILON * (d.abs() + body.deepest()),
                        "{:?} ended at {}, first reached at {}", leg, d, first);
                }
            }
            if moved && record.direction == Direction::Unloading {
                let (found, expected) = (record.smallest.force, steps.smallest(d, start));
                prop_assert!((found - expected).abs() <= rounding(&body, start, expected),
                    "smallest {} against {} on {:?}", found, expected, leg);
                let there = record.smallest.indentation;
                prop_assert!((steps.force(there) - expected).abs() <= rounding(&body, start, expected));
                if let Some(force) = wanted {
                    let last = steps.last_at_most(force, start).unwrap();
                    prop_assert!((d - last).abs() <= 16.0 * f64::EPSILON * (d.abs() + body.deepest()),
                        "{:?} ended at {}, first reached at {}", leg, d, last);
                }
            }
            if let (Some(force), true) = (wanted, end.springs > 0) {
                prop_assert!((end.force - force).abs() <= rounding_at_rounded(&body, d, force),
                    "{:?} ended at {}", leg, end.force);
            }
            (start, present, separated) = (d, end.force, end.springs == 0);
        }
    }

    #[test]
    fn the_number_of_samples_changes_no_figure(body in body(), moves in moves()) {
        let mut solvers = [2, 3, 17, 512, 1025, 5000].map(|samples| body.on(samples));
        let mut present = 0.0;
        for step in moves {
            let leg = step.leg(&body, present);
            let mut outcomes = solvers.iter_mut().map(|solver| solver.advance(leg));
            let Ok(one) = outcomes.next().unwrap() else {
                prop_assert!(outcomes.all(|other| other.is_err()));
                continue;
            };
            for other in outcomes {
                let other = other.unwrap();
                let (here, there) = (one.curve.last().unwrap(), other.curve.last().unwrap());
                prop_assert_eq!(bits(here), bits(there), "end of {:?}", leg);
                let exact = match one.direction {
                    Direction::Loading => (one.largest, other.largest),
                    Direction::Unloading => (one.smallest, other.smallest),
                };
                prop_assert!(within_ulps(exact.0.force, exact.1.force, 2), "{:?}", exact);
                // Where the force is the same to rounding, both ends of the interval are right.
                let stretch = body.deepest() + exact.0.indentation.abs();
                prop_assert!((exact.0.indentation - exact.1.indentation).abs() <= 4.0 * f64::EPSILON * stretch,
                    "{:?} on {:?}", exact, leg);
                prop_assert_eq!((one.attached, one.detached), (other.attached, other.detached));
                let scale = body.force_scale() * (body.deepest() + body.largest_stretch());
                prop_assert!((one.released_energy - other.released_energy).abs() <= 1e-14 * scale);
            }
            present = one.curve.last().unwrap().force;
        }
    }
}

fn within_ulps(a: f64, b: f64, most: u32) -> bool {
    let mut up = a.min(b);
    for _ in 0..most {
        up = up.next_up();
    }
    up >= a.max(b)
}
