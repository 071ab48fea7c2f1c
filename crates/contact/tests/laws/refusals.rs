//! Impossible stages are errors with their reason, and leave the body in place; empty stages are
//! done at once.

use super::*;

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn a_refused_target_does_not_change_the_body(
        body in bodies(200),
        turns in indentations(8),
        refused in prop::collection::vec(prop_oneof![Just(f64::MAX), Just(-1e300), Just(-1e30)], 8),
        bare: bool,
    ) {
        let [mut asked, mut spared] = [(), ()].map(|()| if bare { body.bare(9) } else { body.on(9) });
        let mut separated = true;
        for (target, &force) in to_indentations(&turns).into_iter().chain([Move::ToSeparation]).zip(&refused) {
            let error = asked.advance(Move::ToForce(force)).unwrap_err();
            let is_expected = match error {
                ContactError::OutOfReach => force > 0.0,
                ContactError::NothingToPull => force < 0.0 && separated,
                ContactError::DetachesBefore { smallest } => force < 0.0 && !separated && smallest > force,
                _ => false,
            };
            prop_assert!(is_expected, "{:?} for {} N", error, force);
            let (one, other) = (asked.advance(target).unwrap(), spared.advance(target).unwrap());
            prop_assert_eq!(&one, &other, "{:?} after a refused stage", target);
            prop_assert_eq!(asked.stage().patches(one.end()), spared.stage().patches(one.end()));
            separated = end(&one).springs == 0;
        }
    }

    #[test]
    fn a_target_already_reached_does_nothing(body in bodies(200), to in 0.0..1.0_f64) {
        let mut solver = body.on(17);
        let there = end(&solver.advance(Move::ToIndentation(to)).unwrap());
        let before = solver.work();
        for target in [Move::ToIndentation(to), Move::ToForce(there.force)] {
            let record = solver.advance(target).unwrap();
            prop_assert_eq!(curve_bits(&record), [bits(&there)], "{:?}", target);
            prop_assert_eq!((record.attached, record.detached, record.released_energy), (0, 0, 0.0));
        }
        prop_assert_eq!(solver.work(), before);
    }
}
