//! Edges between springs against relaxation of the rule level by level, after any history.

pub mod relaxed;

use super::*;
use relaxed::Relaxed;

proptest! {
    #![proptest_config(cases(2500))]

    #[test]
    fn any_history_agrees_with_relaxation_level_by_level(body in bodies(61), turns in indentations(9)) {
        let body = Body { edges: Edges::SubCell, ..body };
        let mut solver = body.on(6);
        // One body with hardly more and one with hardly less adhesion: where their patches
        // differ, an event lies at the turning point to rounding and either is right.
        let slight = [1.0, 1.0 + 1e-11, 1.0 - 1e-11].map(|factor| body.with_more_adhesion(factor));
        let mut relaxed = slight.each_ref().map(Relaxed::new);
        // Effect of the rounding of the indentation alone on the force.
        let [largest, energy] = body.scales().map(|scale| 1e-13 * scale);
        let line = 1e-11 * body.gaps.len() as f64 * body.foundation.spacing;
        for turn in turns {
            let record = solver.advance(Move::ToIndentation(turn)).unwrap();
            let touches = record.curve.iter().any(|point| point.springs > 0);
            for (index, point) in record.curve.iter().enumerate() {
                // At a jump, the point before and the point after.
                let moved_on = record.curve.get(index + 1).is_some_and(|p| p.indentation == point.indentation);
                // Relaxation does not distinguish levels that are 0 except for the rounding of any
                // gap.
                if moved_on || !touches || point.indentation.abs() < 1e-16 {
                    continue;
                }
                relaxed.iter_mut().for_each(|one| one.move_to(point.indentation));
                let contacts = relaxed[0].contacts();
                if relaxed.iter().any(|one| one.contacts() != contacts) {
                    continue;
                }
                let near = |what: &str, found: f64, [one, more, less]: [f64; 3], slack: f64| {
                    let is_near = (found - one).abs() <= slack + 4.0 * (more - less).abs();
                    prop_assert!(is_near, "{} {} against {} at {}", what, found, one, point.indentation);
                    Ok(())
                };
                near("force", point.force, relaxed.each_ref().map(|one| one.force()), largest)?;
                near("length", point.contact_length, relaxed.each_ref().map(|one| one.contact_length()), line)?;
                near("energy", point.stored_energy, relaxed.each_ref().map(|one| one.stored_energy()), energy)?;
                let counts = (contacts.len() as u64, indices(&contacts).len() as u64);
                prop_assert_eq!((point.patches, point.springs), counts);
                prop_assert_eq!(solver.stage().patches(point.indentation), contacts);
            }
            relaxed.iter_mut().for_each(|one| one.move_to(turn));
            prop_assume!(relaxed.iter().all(|one| one.contacts() == relaxed[0].contacts()));
        }
    }
}
