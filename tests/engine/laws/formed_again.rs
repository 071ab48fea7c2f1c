//! A body that forms its contact several times, compared with new bodies that form it once.

use super::*;

proptest! {
    #![proptest_config(cases(800))]

    #[test]
    fn a_second_contact_equals_that_of_a_new_body(
        body in bodies(120), drawn in targets(14), samples in 2_usize..40,
    ) {
        let mut first = body.on(samples);
        let mut new = body.on(samples);
        let (mut free, mut at) = (true, 0.0);
        for drawn in drawn {
            let target = body.target(drawn, &first);
            if free {
                new = body.on(samples);
                new.advance(Move::ToIndentation(f64::min(at, -1e-300))).unwrap();
            }
            let (one, other) = match (first.advance(target), new.advance(target)) {
                (Ok(one), Ok(other)) => (one, other),
                (one, other) => {
                    prop_assert_eq!(one.is_err(), other.is_err());
                    continue;
                }
            };
            // The indentation of the start in separation does not matter.
            let touching = |record: &LegRecord| {
                record.curve.iter().filter(|point| !free || point.springs > 0).copied().collect::<Vec<_>>()
            };
            prop_assert_eq!(touching(&one), touching(&other));
            prop_assert_eq!(one.attached, other.attached);
            if !free || one.attached > 0 {
                prop_assert_eq!((one.largest, one.detached), (other.largest, other.detached));
                prop_assert_eq!(one.released_energy, other.released_energy);
            }
            if !free {
                prop_assert_eq!(one.smallest, other.smallest);
            }
            for point in &one.curve {
                prop_assert_eq!(first.leg().patches(point.indentation), new.leg().patches(point.indentation));
            }
            (free, at) = (end(&one).springs == 0, one.end());
        }
    }
}
