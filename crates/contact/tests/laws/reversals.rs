//! Reversals of one loading against separate loadings and unloadings, bit for bit.

use super::*;
use asperity_contact::Reversal;

/// Targets of turning points in contact: forces as shares of those of a body.
fn turns() -> impl Strategy<Value = Vec<Move>> {
    let turn = prop_oneof![
        4 => (0.0..1.3_f64).prop_map(Move::ToIndentation),
        1 => (0_u8..6).prop_map(|level| Move::ToIndentation(0.25 * f64::from(level))),
        4 => (0.0..1.0_f64).prop_map(Move::ToForce),
        1 => Just(Move::ToTouch),
        1 => Just(Move::ToZeroForce),
    ];
    prop::collection::vec(turn, 1..16)
}

/// All reversals in the order of their targets.
fn all(
    body: &mut contact::motion::Body,
    turns: &[Move],
    points: &[f64],
) -> Result<Vec<Reversal>, ContactError> {
    let mut found = vec![None; turns.len()];
    body.reversals(turns, points, &mut |index, reversal| {
        assert!(found[index].replace(reversal).is_none());
        Ok(())
    })?;
    Ok(found.into_iter().map(Option::unwrap).collect())
}

/// Compares all reversals with separate histories, each on a new body; forces are those at
/// `points`, m.
fn compare(
    new: impl Fn() -> contact::motion::Body,
    turns: &[Move],
    points: &[f64],
) -> Result<(), TestCaseError> {
    let reversals = all(&mut new(), turns, points).unwrap();
    for (turn, reversal) in turns.iter().zip(&reversals) {
        let history = load_body(&mut new(), &[*turn, Move::ToSeparation], |_, _| Ok(())).unwrap();
        let [loading, unloading] = &history.stages[..] else {
            panic!("{history:?}")
        };
        prop_assert_eq!(bits(&reversal.turn), bits(&end(loading)), "{:?}", turn);
        prop_assert_eq!(
            bits(&reversal.smallest),
            bits(&unloading.smallest),
            "{:?}",
            turn
        );
        prop_assert_eq!(
            reversal.separation.to_bits(),
            unloading.end().to_bits(),
            "{:?}",
            turn
        );
        let dissipated = loading.released_energy + unloading.released_energy;
        prop_assert_eq!(
            reversal.dissipated_energy.to_bits(),
            (dissipated + 0.0).to_bits(),
            "{:?}",
            turn
        );
        let below = points
            .iter()
            .filter(|point| **point <= reversal.turn.indentation);
        let separate = below.map(|&point| {
            let to_point = load_body(&mut new(), &[*turn, Move::ToIndentation(point)], |_, _| {
                Ok(())
            })
            .unwrap();
            end(&to_point.stages[1]).force.to_bits()
        });
        let found: Vec<_> = reversal
            .forces
            .iter()
            .map(|force| force.to_bits())
            .collect();
        prop_assert_eq!(found, separate.collect::<Vec<_>>(), "{:?}", turn);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn reversals_are_those_of_separate_runs(
        body in bodies(200),
        samples in prop_oneof![Just(2_usize), 2_usize..600],
        turns in turns(),
        points in prop::collection::vec(-1.0..1.3_f64, 0..7),
    ) {
        let turns: Vec<Move> = turns.into_iter().map(|turn| body.target((turn, false), &body.on(2))).collect();
        let mut points = points;
        points.sort_by(f64::total_cmp);
        compare(|| body.on(samples), &turns, &points)?;
        compare(|| body.bare(samples), &turns, &points)?;
    }
}

#[test]
fn turning_points_out_of_contact_are_refused() {
    let body = Body::new(
        vec![0.0, 0.5, 0.25],
        Edges::SubCell,
        Foundation::new(0.01, 1.0),
        0.0,
    );
    for (turns, index, reason) in [
        (
            vec![Move::ToTouch, Move::ToIndentation(-0.1)],
            1,
            ContactError::NoContact,
        ),
        (
            vec![Move::ToForce(f64::INFINITY)],
            0,
            ContactError::NotFinite(f64::INFINITY),
        ),
        (vec![Move::ToSeparation], 0, ContactError::NoContact),
    ] {
        let expected = ContactError::Stage {
            index,
            target: turns[index],
            reason: Box::new(reason),
        };
        assert_eq!(all(&mut body.bare(2), &turns, &[]), Err(expected));
    }
}

#[test]
fn all_reversals_share_one_loading_pass() {
    for work in [0.002, 0.02] {
        let gaps = self_affine(0.7, 1, 1 << 13);
        let mut body = Body::new(gaps, Edges::SubCell, Foundation::new(1e-3, 1.0), work).on(2);
        let turns: Vec<Move> = (1..=64)
            .map(|turn| Move::ToForce(0.05 * f64::from(turn)))
            .collect();
        body.reversals(&turns, &[], &mut |_, _| Ok(())).unwrap();
        assert_eq!(
            (body.work().loading_passes, body.work().unloading_passes),
            (1, 64)
        );
    }
}
