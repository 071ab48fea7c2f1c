//! A body that forms its contact several times, compared with new bodies that form it once.

use asperity::contact::Solver;
use asperity::scene::Move;
use proptest::prelude::*;

/// Loadings with several separations; forces are shares, indentations metres.
pub fn loadings() -> impl Strategy<Value = Vec<Move>> {
    let leg = prop_oneof![
        3 => (-0.5..1.3_f64).prop_map(Move::ToIndentation),
        3 => (-0.2..1.0_f64).prop_map(Move::ToForce),
        1 => Just(Move::ToTouch),
        1 => Just(Move::ToZeroForce),
        4 => Just(Move::ToSeparation),
    ];
    prop::collection::vec(leg, 2..14)
}

/// Moves a body along the legs, shares of this force instead of forces, and beside it a new one from each separation
/// on, and compares their records and contacts.
pub fn as_if_new<S: Solver>(new: impl Fn() -> S, legs: &[Move], force: f64) -> Result<(), TestCaseError> {
    let (mut body, mut beside) = (new(), new());
    let (mut free, mut at) = (true, 0.0);
    for leg in legs {
        let leg = if let Move::ToForce(share) = *leg { Move::ToForce(share * force) } else { *leg };
        if free {
            beside = new();
            beside.advance(Move::ToIndentation(f64::min(at, -1e-300))).unwrap();
        }
        match (body.advance(leg), beside.advance(leg)) {
            (Ok(one), Ok(other)) => {
                // The indentation of the start in separation does not matter.
                let touching = |record: &asperity::contact::LegRecord| {
                    record
                        .curve
                        .iter()
                        .filter(|point| !free || point.springs > 0)
                        .copied()
                        .collect::<Vec<_>>()
                };
                prop_assert_eq!(touching(&one), touching(&other));
                let figures = |record: &asperity::contact::LegRecord| {
                    (record.largest, record.attached, record.detached, record.released_energy)
                };
                prop_assert_eq!(one.attached, other.attached);
                if !free || one.attached > 0 {
                    prop_assert_eq!(figures(&one), figures(&other));
                }
                if !free {
                    prop_assert_eq!(one.smallest, other.smallest);
                }
                for point in &one.curve {
                    prop_assert_eq!(
                        body.leg().patches(point.indentation),
                        beside.leg().patches(point.indentation)
                    );
                }
                let end = one.curve.last().copied().unwrap_or_default();
                (free, at) = (end.springs == 0, end.indentation);
            }
            (one, other) => prop_assert_eq!(one.is_err(), other.is_err()),
        }
    }
    Ok(())
}
