//! A body that keeps the loading which forms its contact, beside one that computes it each time.

use asperity::contact::Solver;
use asperity::scene::Leg;
use proptest::prelude::*;

/// Loadings that come down several times; forces are shares, indentations metres.
pub fn loadings() -> impl Strategy<Value = Vec<Leg>> {
    let leg = prop_oneof![
        3 => (-0.5..1.3_f64).prop_map(Leg::ToIndentation),
        3 => (-0.2..1.0_f64).prop_map(Leg::ToForce),
        1 => Just(Leg::ToTouch),
        1 => Just(Leg::ToZeroForce),
        4 => Just(Leg::ToSeparation),
    ];
    prop::collection::vec(leg, 2..14)
}

/// Moves both along the legs, shares of this force instead of forces, and holds each record, what is in contact
/// and what has been done against the other's.
pub fn do_the_same(
    plain: &mut impl Solver,
    keeping: &mut impl Solver,
    legs: &[Leg],
    force: f64,
) -> Result<(), TestCaseError> {
    let (mut formed, mut free) = (0, true);
    for leg in legs {
        let leg = if let Leg::ToForce(share) = *leg { Leg::ToForce(share * force) } else { *leg };
        let passes = plain.work().loading_passes;
        let [one, other] = [plain.advance(leg), keeping.advance(leg)];
        match (one, other) {
            (Ok(one), Ok(other)) => {
                prop_assert_eq!(&one, &other);
                for point in &one.curve {
                    prop_assert_eq!(plain.fragments(point.indentation), keeping.fragments(point.indentation));
                }
                formed += u64::from(free && plain.work().loading_passes > passes);
                free = one.curve.last().is_none_or(|end| end.springs == 0);
            }
            (one, other) => prop_assert_eq!(one.is_err(), other.is_err()),
        }
    }
    let [one, other] = [plain.work(), keeping.work()];
    prop_assert!(other.hess_evaluations <= one.hess_evaluations);
    prop_assert!(other.loading_passes + formed.max(1) - 1 <= one.loading_passes, "{one:?} {other:?}");
    Ok(())
}
