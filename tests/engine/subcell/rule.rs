//! The same contact as relaxed by brute force, after any history.

use super::brute_force::Relaxed;
use super::*;

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn any_history_agrees_with_brute_force_relaxation(
        body in any_body(61),
        turns in prop::collection::vec(-0.9..1.3_f64, 1..9),
    ) {
        let mut solver = body.on(6);
        // One body with hardly more and one with hardly less adhesion: where their fragments differ, an event lies at
        // the turning point to rounding and either is right.
        let work = |factor: f64| {
            Relaxed::new(&body.gaps, body.foundation, body.closing_work * factor, body.work * factor)
        };
        let mut relaxed: [Relaxed; 3] = [work(1.0), work(1.0 + 1e-11), work(1.0 - 1e-11)];
        // Effect of the rounding of the indentation alone on the force.
        let springs = body.gaps.len() as f64 * body.foundation.spring_stiffness();
        let largest = 0.01 * springs * (1.3 + body.largest_stretch());
        for turn in turns {
            let record = solver.advance(Move::ToIndentation(turn)).unwrap();
            let before = record.curve.iter().filter(|point| point.springs > 0).count();
            for (index, point) in record.curve.iter().enumerate() {
                // At a jump, the point before and the point after.
                let moved_on = record.curve.get(index + 1).is_some_and(|p| p.indentation == point.indentation);
                // Brute force does not distinguish levels that are 0 except for the rounding of any gap.
                if moved_on || before == 0 || point.indentation.abs() < 1e-16 {
                    continue;
                }
                relaxed.iter_mut().for_each(|one| one.move_to(point.indentation));
                let [one, more, less] = &relaxed;
                if one.contacts() != more.contacts() || one.contacts() != less.contacts() {
                    continue;
                }
                let near = |a: f64, b: f64, slack: f64, size: f64| (a - b).abs() <= 1e-11 * size + 4.0 * slack;
                let force = (more.force() - less.force()).abs();
                prop_assert!(
                    near(point.force, one.force(), force, largest),
                    "force {} against {} at {}", point.force, one.force(), point.indentation
                );
                let length = (more.contact_length() - less.contact_length()).abs();
                let line = body.gaps.len() as f64 * body.foundation.spacing;
                prop_assert!(
                    near(point.contact_length, one.contact_length(), length, line),
                    "length {} against {} at {}", point.contact_length, one.contact_length(), point.indentation
                );
                let contacts = one.contacts();
                prop_assert_eq!(point.fragments, contacts.len() as u64);
                prop_assert_eq!(point.springs, contacts.iter().map(|(a, b)| (b + 1 - a) as u64).sum::<u64>());
                prop_assert_eq!(solver.leg().patches(point.indentation), contacts);
            }
            relaxed.iter_mut().for_each(|one| one.move_to(turn));
            prop_assume!(relaxed.iter().all(|one| one.contacts() == relaxed[0].contacts()));
        }
    }
}
