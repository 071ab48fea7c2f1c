//! Impossible legs are errors with their reason, and leave the body in place; empty legs are done at once.

use super::*;
use asperity::analysis::Figures;
use asperity::contact::ContactError;

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
            prop_assert_eq!(&one, &other, "{:?} after a refused leg", target);
            prop_assert_eq!(asked.leg().patches(one.end()), spared.leg().patches(one.end()));
            separated = end(&one).springs == 0;
        }
    }

    #[test]
    fn a_separated_body_carries_no_force(
        body in bodies(200), heights in prop::collection::vec(0.0..2.0_f64, 1..6),
    ) {
        let (mut flown, mut fresh) = (body.on(17), body.on(17));
        let mut below = 0.0;
        for height in heights.iter().map(|height| height + 1e-9) {
            let record = flown.advance(Move::ToIndentation(-height)).unwrap();
            let direction = if -height > below { Direction::Loading } else { Direction::Unloading };
            prop_assert_eq!((record.direction, record.start(), record.end()), (direction, below, -height));
            prop_assert_eq!((record.attached, record.detached, record.released_energy), (0, 0, 0.0));
            prop_assert!(record.curve.iter().all(|point| point.springs == 0 && point.force == 0.0));
            prop_assert!(flown.leg().patches(-height).is_empty() && flown.leg().patches(1.0).is_empty());
            below = -height;
        }
        // The body is already separated.
        let record = flown.advance(Move::ToSeparation).unwrap();
        prop_assert_eq!((record.curve.len(), record.start()), (1, below));
        prop_assert_eq!((record.detached, record.released_energy), (0, 0.0));
        // From up there first touch is the same; the way there is one more point.
        let (touch, expected) = (flown.advance(Move::ToTouch).unwrap(), fresh.advance(Move::ToTouch).unwrap());
        prop_assert_eq!(&curve_bits(&touch)[1..], &curve_bits(&expected)[..]);
        prop_assert_eq!((touch.start(), touch.attached), (below, expected.attached));
        let [one, other] = [&mut flown, &mut fresh].map(|solver| solver.advance(Move::ToSeparation).unwrap());
        prop_assert_eq!(one, other);
    }

    #[test]
    fn motions_after_separation_do_not_change_figures(
        body in bodies(200), to in 0.0..1.0_f64, heights in prop::collection::vec(0.0..2.0_f64, 1..5),
    ) {
        let mut targets = vec![Move::ToIndentation(to), Move::ToSeparation];
        let figures = Figures::of(&body.history(&targets, 17));
        prop_assert!(figures.adhesion_force.is_some() && figures.dissipated_energy.is_some());
        // High enough not to be moved towards the body from its point of detachment.
        let low = body.largest_stretch() + 1.0;
        targets.extend(heights.iter().map(|height| Move::ToIndentation(-low - height)));
        targets.push(Move::ToSeparation);
        prop_assert_eq!(Figures::of(&body.history(&targets, 17)), figures);
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
