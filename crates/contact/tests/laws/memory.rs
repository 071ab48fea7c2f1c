//! Effects of the past: closed minor loops and ordered contact sets.

use super::*;

/// Turning points that are still remembered at the end of a history from separation: a move as far
/// as an earlier turning point erases the loop that began there.
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
                [.., _, b, c, d] if (b - c).abs() <= (d - c).abs() => {
                    drop(turns.drain(end - 3..end - 1))
                }
                _ => break,
            }
        }
    }
    turns.split_off(1)
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn only_the_deepest_turning_points_are_remembered(body in bodies(200), turns in indentations(16)) {
        let short = remembered(&turns);
        let [whole, reduced] = [&turns, &short].map(|turns| body.history(&to_indentations(turns), 2));
        let [one, other] = [&whole, &reduced].map(|history| end(history.stages.last().unwrap()));
        if body.edges == Edges::SubCell && body.closing_work < body.work {
            // An edge that keeps its place may do so up to the indentation at which it slid before:
            // the level there is the same but for its rounding.
            let slack = 1e-15 * body.force_scale();
            prop_assert!((one.force - other.force).abs() <= slack, "{:?} {:?}", one, other);
            prop_assert_eq!((one.springs, one.patches), (other.springs, other.patches));
        } else {
            prop_assert_eq!(bits(&one), bits(&other), "{:?} against {:?}", turns, short);
        }
        prop_assert_eq!(whole.contacts.len() as u64, one.patches);
        prop_assert_eq!(indices(&whole.contacts).len() as u64, one.springs);
        prop_assert_eq!(whole.contacts, reduced.contacts);
    }

    #[test]
    fn deeper_loads_leave_more_in_contact_and_more_adhesion(
        body in bodies(200),
        (shallow, deep) in (0.0..1.2_f64, 0.0..1.2_f64),
        probes in prop::collection::vec(0.0..1.0_f64, 6),
    ) {
        let (shallow, deep) = (shallow.min(deep), shallow.max(deep));
        let [less, more] = [shallow, deep].map(|to| {
            let mut solver = body.on(2);
            solver.advance(Move::ToIndentation(to)).unwrap();
            let smallest = solver.advance(Move::ToSeparation).unwrap().smallest.force;
            (smallest, solver.stage())
        });
        let whole = body.edges == Edges::Grid;
        let slack = if whole { 4.0 * f64::EPSILON * less.0.abs() } else { 1e-14 * body.force_scale() };
        prop_assert!(more.0 <= less.0 + slack, "{} {}", more.0, less.0);
        let low = -body.largest_stretch();
        for probe in probes {
            let d = low + probe * (shallow - low);
            let held = indices(&more.1.patches(d));
            prop_assert!(indices(&less.1.patches(d)).iter().all(|index| held.binary_search(index).is_ok()));
        }
    }
}
