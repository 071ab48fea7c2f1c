//! Extremes and crossings of the force: against all segments of the stage, against the points of a
//! fine curve, independent of the number of samples, and where the contact jumps.

use super::all_segments::Segments;
use super::*;

fn wanted(target: Move) -> Option<f64> {
    match target {
        Move::ToForce(force) => Some(force),
        Move::ToZeroForce => Some(0.0),
        _ => None,
    }
}

/// Rounding of a force on this body at indentation d, N.
fn rounding(body: &Body, d: f64, force: f64) -> f64 {
    4.0 * f64::EPSILON * force.abs() + 1e-18 * body.stiffness() * (d.abs() + body.deepest())
}

/// Rounding of a force at a rounded indentation, N.
fn rounding_at_rounded(body: &Body, d: f64, force: f64) -> f64 {
    rounding(body, d, force) + 8.0 * f64::EPSILON * body.stiffness() * (d.abs() + body.deepest())
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn extremes_and_crossings_are_those_of_all_segments(
        body in whole_springs(200),
        drawn in targets(8),
        samples in 2_usize..600,
    ) {
        let mut solver = body.on(samples);
        let (mut start, mut separated) = (0.0_f64, true);
        for drawn in drawn {
            let target = body.target(drawn, &solver);
            let outcome = solver.advance(target);
            // A refused unloading is that from the present contact.
            let stage = solver.stage();
            let turns = outcome.is_err() && stage.direction() == Direction::Loading && !separated;
            let stage = if turns { stage.turn(start).unwrap() } else { stage };
            let segments = Segments::new(&stage.thresholds(), &body);
            let record = match outcome {
                Ok(record) => record,
                Err(ContactError::DetachesBefore { smallest }) => {
                    let force = wanted(target).unwrap();
                    let expected = segments.smallest(f64::NEG_INFINITY, start);
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
            let end = end(&record);
            let d = end.indentation;
            if record.curve.len() > 1 && (end.springs > 0 || !separated) {
                let allowed = 16.0 * f64::EPSILON * (d.abs() + body.deepest());
                let first = if record.direction == Direction::Loading {
                    let low = if separated { start.max(0.0) } else { start };
                    let (found, expected) = (record.largest.force, segments.largest(low, d));
                    prop_assert!((found - expected).abs() <= rounding_at_rounded(&body, d, expected),
                        "largest {} against {} on {:?}", found, expected, target);
                    wanted(target).map(|force| segments.first_at_least(force, low).unwrap())
                } else {
                    let (found, expected) = (record.smallest.force, segments.smallest(d, start));
                    let allowed = rounding(&body, start, expected);
                    prop_assert!((found - expected).abs() <= allowed, "smallest {} against {}", found, expected);
                    let there = segments.force(record.smallest.indentation);
                    prop_assert!((there - expected).abs() <= allowed, "{} against {}", there, expected);
                    wanted(target).map(|force| segments.last_at_most(force, start).unwrap())
                };
                let ends_there = first.is_none_or(|first| (d - first).abs() <= allowed);
                prop_assert!(ends_there, "{:?} ended at {}, first reached at {:?}", target, d, first);
            }
            if let (Some(force), true) = (wanted(target), end.springs > 0) {
                prop_assert!((end.force - force).abs() <= rounding_at_rounded(&body, d, force),
                    "{:?} ended at {}", target, end.force);
            }
            (start, separated) = (d, end.springs == 0);
        }
    }

}

proptest! {
    #![proptest_config(cases(700))]

    /// Nor does any point of a fine curve pass the extremes, or the wanted force before the end.
    #[test]
    fn the_number_of_samples_changes_no_figure(body in bodies(120), drawn in targets(8)) {
        let mut solvers = [5000, 2, 3, 17, 512, 1025].map(|samples| body.on(samples));
        let whole = body.edges == Edges::Grid;
        let [slack, energy_slack] = body.scales().map(|scale| 1e-14 * scale);
        for drawn in drawn {
            let target = body.target(drawn, &solvers[0]);
            let mut outcomes = solvers.iter_mut().map(|solver| solver.advance(target));
            let Ok(fine) = outcomes.next().unwrap() else {
                prop_assert!(outcomes.all(|other| other.is_err()));
                continue;
            };
            let loads = fine.direction == Direction::Loading;
            let extreme = |record: &StageRecord| if loads { record.largest } else { record.smallest };
            let (last, sign) = (end(&fine), if loads { 1.0 } else { -1.0 });
            for point in fine.curve.iter().filter(|point| point.springs > 0) {
                let beyond = sign * (point.force - extreme(&fine).force);
                prop_assert!(beyond <= slack, "{:?} {:?}", point, extreme(&fine));
                let here = (point.indentation - last.indentation).abs() <= 1e-14 * (1.3 + body.deepest());
                let passed = wanted(target).is_some_and(|force| sign * (point.force - force) > slack);
                prop_assert!(here || !passed, "{:?} before {:?}", point, target);
            }
            for other in outcomes {
                let other = other.unwrap();
                prop_assert_eq!(bits(&last), bits(&end(&other)), "end of {:?}", target);
                let [one, another] = [&fine, &other].map(extreme);
                if whole {
                    prop_assert!(within_ulps(one.force, another.force, 2), "{:?} {:?}", one, another);
                    // Where the force is the same to rounding, both ends of the interval are right.
                    let reach = body.deepest() + one.indentation.abs();
                    let apart = (one.indentation - another.indentation).abs();
                    prop_assert!(apart <= 4.0 * f64::EPSILON * reach, "{:?} {:?}", one, another);
                }
                prop_assert!((one.force - another.force).abs() <= slack, "{:?} {:?}", one, another);
                prop_assert_eq!((fine.attached, fine.detached), (other.attached, other.detached));
                prop_assert!((fine.released_energy - other.released_energy).abs() <= energy_slack);
            }
        }
    }
}

fn within_ulps(a: f64, b: f64, most: u32) -> bool {
    let up = (0..most).fold(a.min(b), |up, _| up.next_up());
    up >= a.max(b)
}

proptest! {
    #![proptest_config(cases(300))]

    /// One spring carries just the wanted force where a second one attaches, stretched by s, and
    /// reduces the force accordingly: both carry it half of s deeper than the second one touches by
    /// itself, less half of the first one's depth.
    #[test]
    fn a_force_lost_in_a_jump_is_reached_further_on(
        wall in 0.25..1.0_f64, share in 0.05..0.9_f64, first: bool,
    ) {
        // E* Δx = 1 N/m: force and compression are the same number.
        let foundation = Foundation::new(0.25, 4.0);
        let work = (share * wall).powi(2) * 4.0 / (0.25 * PI);
        let gaps = if first { vec![0.0, wall] } else { vec![wall, 0.0] };
        let attaches = wall - foundation.largest_stretch(work, 1);
        let expected = 0.5 * (attaches + wall);
        let mut solver = Body::new(gaps, Edges::Grid, foundation, work).on(5);
        let record = solver.advance(Move::ToForce(attaches)).unwrap();
        prop_assert!((record.end() - expected).abs() < 4.0 * f64::EPSILON, "{} {}", record.end(), expected);
    }

    #[test]
    fn the_smallest_force_is_reached_and_none_below(body in bodies(200), deep in 0.2..1.2_f64) {
        let turned = || {
            let mut solver = body.on(9);
            solver.advance(Move::ToIndentation(deep)).unwrap();
            solver
        };
        let smallest = turned().advance(Move::ToSeparation).unwrap().smallest;
        let rounding = 1e-14 * body.scales()[0];
        prop_assume!(smallest.springs > 0 && smallest.force < -rounding);
        let reached = turned().advance(Move::ToForce(smallest.force + rounding)).unwrap();
        prop_assert!(reached.end() >= smallest.indentation - 1e-14);
        prop_assert!((end(&reached).force - smallest.force).abs() <= 2.0 * rounding);
        prop_assert!(turned().advance(Move::ToForce(smallest.force - rounding)).is_err());
    }
}
