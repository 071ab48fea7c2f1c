//! Effects of the past: closed minor loops, ordered contact sets, and no free energy.

use super::brute_force::Steps;
use super::*;
use asperity::scene::Document;
use asperity::simulation::Simulation;

/// Turning points that are still remembered at the end of a history from separation: a move as far as an earlier
/// turning point erases the loop that began there.
fn remembered(indentations: &[f64]) -> Vec<f64> {
    let mut turns = vec![f64::NEG_INFINITY];
    for &to in indentations {
        turns.push(to);
        loop {
            let end = turns.len();
            match turns[..] {
                [.., a, b] if a == b => turns.truncate(end - 1),
                // b is no turn but a point on the way.
                [.., a, b, c] if (a < b) == (b < c) => drop(turns.remove(end - 2)),
                // The loop from b to c and back lies on the way from a to d.
                [.., _, b, c, d] if (b - c).abs() <= (d - c).abs() => drop(turns.drain(end - 3..end - 1)),
                _ => break,
            }
        }
    }
    turns.split_off(1)
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn only_the_deepest_turning_points_are_remembered(body in body_of_two_works(), turns in indentations(16)) {
        let short = remembered(&turns);
        prop_assert!(short.len() <= turns.len());
        let (whole, reduced) =
            (body.history(&to_indentations(&turns), 2), body.history(&to_indentations(&short), 2));
        prop_assert_eq!(bits(&end(&whole)), bits(&end(&reduced)), "{:?} against {:?}", turns, short);
        prop_assert_eq!(whole.contacts, reduced.contacts);
    }

    #[test]
    fn minor_loops_close(body in body_of_two_works(), turns in indentations(6), inner in -0.8..1.2_f64) {
        // A history, away from its last turning point, and back to it.
        let before = body.history(&to_indentations(&turns), 2);
        let last = turns[turns.len() - 1];
        let came_from = remembered(&turns).iter().rev().nth(1).copied().unwrap_or(f64::NEG_INFINITY);
        // Back along the same way, but not beyond its beginning.
        let inner = if last > came_from { inner.clamp(came_from, last) } else { inner.clamp(last, came_from) };
        let there_and_back = [&turns[..], &[inner, last]].concat();
        let after = body.history(&to_indentations(&there_and_back), 2);
        prop_assert_eq!(bits(&end(&before)), bits(&end(&after)), "{:?}", there_and_back);
        prop_assert_eq!(before.contacts, after.contacts);
    }

    #[test]
    fn deeper_loads_leave_more_in_contact_and_more_adhesion(
        body in body_of_two_works(),
        (shallow, deep) in (0.0..1.2_f64, 0.0..1.2_f64),
        probes in prop::collection::vec(0.0..1.0_f64, 6),
    ) {
        let (shallow, deep) = (shallow.min(deep), shallow.max(deep));
        let (mut less, mut more) = (body.on(2), body.on(2));
        let [mut of_less, mut of_more] = [0.0; 2];
        for (solver, to, smallest) in [(&mut less, shallow, &mut of_less), (&mut more, deep, &mut of_more)] {
            solver.advance(Move::ToIndentation(to)).unwrap();
            *smallest = solver.advance(Move::ToSeparation).unwrap().smallest.force;
        }
        prop_assert!(of_more <= of_less + 4.0 * f64::EPSILON * of_less.abs(), "{} {}", of_more, of_less);
        let low = -body.largest_stretch();
        for probe in probes {
            let d = low + probe * (shallow - low);
            let held = indices(&more.leg().patches(d));
            prop_assert!(indices(&less.leg().patches(d)).iter().all(|index| held.binary_search(index).is_ok()));
        }
    }

    #[test]
    fn what_is_lost_is_what_the_force_has_done(body in body(), turns in indentations(10)) {
        let mut solver = body.on(2);
        let (mut position, mut stored, mut lost) = (0.0_f64, 0.0, 0.0);
        for leg in to_indentations(&turns).into_iter().chain([Move::ToSeparation]) {
            let record = solver.advance(leg).unwrap();
            let thresholds = solver.leg().thresholds();
            let end = record.curve.last().unwrap();
            let steps = Steps::new(&thresholds, &body);
            let touches = end.springs > 0;
            let stored_now = if touches { steps.stored_energy(end.indentation) } else { 0.0 };
            // ∫F dd = stored + dissipated energy, to the rounding of the larger energies.
            let done = if position < end.indentation {
                steps.work(position, end.indentation)
            } else {
                -steps.work(end.indentation, position)
            };
            let expected = done - (stored_now - stored);
            let reach = body.deepest() + body.largest_stretch() + end.indentation.abs() + position.abs();
            let springs = body.gaps.len() as f64 * body.foundation.spring_stiffness();
            prop_assert!(
                (record.released_energy - expected).abs() <= 1e-14 * springs * reach * reach,
                "{} against {} on {:?}", record.released_energy, expected, leg
            );
            // The energy stored at each point, each within the rounding of the stretches and of their sum.
            let found = end.stored_energy;
            prop_assert!((found - stored_now).abs() <= 1e-14 * springs * reach * reach, "{found} {stored_now}");
            (position, stored) = (end.indentation, stored_now);
            lost += record.released_energy;
        }
        // From separation to separation.
        prop_assert!(lost >= -1e-14 * body.force_scale(), "gained {}", -lost);
    }

    #[test]
    fn a_leg_divided_at_an_event_loses_no_more(
        body in body_of_two_works(), deep in 0.2..1.2_f64, springs in prop::array::uniform4(any::<prop::sample::Index>()),
    ) {
        let mut solver = body.on(2);
        let whole = [Move::ToIndentation(deep), Move::ToSeparation].map(|leg| {
            let record = solver.advance(leg).unwrap();
            let mut thresholds = solver.leg().thresholds();
            thresholds.retain(|threshold| threshold.is_finite());
            (record.released_energy, thresholds)
        });
        let [(loading, attached), (unloading, detached)] = whole;
        let scale = body.force_scale() * (body.deepest() + body.largest_stretch() + deep);
        for spring in springs {
            let mut parts = body.on(2);
            let mut lost = |legs: [Move; 2]| -> f64 {
                legs.into_iter().map(|leg| parts.advance(leg).unwrap().released_energy).sum()
            };
            let event = spring.get(&attached).min(deep);
            let found = lost([Move::ToIndentation(event), Move::ToIndentation(deep)]);
            prop_assert!((found - loading).abs() <= 1e-14 * scale, "{found} against {loading} at {event}");
            if !detached.is_empty() {
                let event = spring.get(&detached).min(deep);
                let found = lost([Move::ToIndentation(event), Move::ToSeparation]);
                prop_assert!((found - unloading).abs() <= 1e-14 * scale, "{found} against {unloading} at {event}");
            }
        }
    }

    #[test]
    fn no_closed_loop_gains_energy(body in body_of_two_works(), outer in 0.0..1.2_f64, inner in -0.8..1.2_f64) {
        let inner = inner.min(outer);
        let history = body.history(&to_indentations(&[outer, inner, outer]), 2);
        let lost: f64 = history.legs[1..].iter().map(|leg| leg.released_energy).sum();
        prop_assert!(lost >= -1e-14 * body.force_scale(), "gained {}", -lost);
    }
}

#[test]
fn turning_points_are_wiped_out_as_they_should_be() {
    assert_eq!(remembered(&[1.0, 2.0, 3.0]), [3.0]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0]), [3.0, 1.0, 2.0]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0, 1.5]), [3.0, 1.0, 2.0, 1.5]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0, 1.0]), [3.0, 1.0]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0, 0.5]), [3.0, 0.5]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0, 1.5, 3.0]), [3.0]);
    assert_eq!(remembered(&[3.0, 1.0, 2.0, 1.5, 2.5]), [3.0, 1.0, 2.5]);
}

#[test]
fn refining_the_grid_refines_the_same_line() {
    let text = include_str!("../../../presets/pressure-sensitive.ron");
    let scene = |points: u64| {
        let document = Document::parse(text, "scene").unwrap();
        document.set("numerics.points", &points.to_string()).unwrap().scene().clone()
    };
    let mut simulation = Simulation::default();
    let mut heights = |points: u64| -> Vec<f64> {
        let (line, _, _) = simulation.make_line(&scene(points)).unwrap();
        line.heights().collect()
    };
    let coarse = heights(2_000);
    let deepest = coarse.iter().fold(0.0_f64, |most, height| most.max(height.abs()));
    for factor in [3, 5, 9] {
        // Each spring of the coarse grid is at the place of one of the finer grid, in the middle of a cell.
        let fine = heights(2_000 * factor as u64);
        for (index, height) in coarse.iter().enumerate() {
            let same = fine[factor * index + factor / 2];
            assert!((same - height).abs() <= 1e-13 * deepest, "{factor}: {height} and {same} at {index}");
        }
    }
    // So the figures converge to one value.
    let mut adhesion_force = |points: u64| {
        let outcome = simulation.run(&scene(points), &|| false, &mut |_, _, _| Ok(())).unwrap();
        outcome.figures.adhesion_force.unwrap()
    };
    let finest = adhesion_force(2_000 * 729);
    let errors = [1, 9, 81].map(|factor| (adhesion_force(2_000 * factor) / finest - 1.0).abs());
    println!("{errors:?}");
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2] && errors[2] < 5e-3, "{errors:?}");
}
