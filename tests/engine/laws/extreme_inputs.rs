//! Numbers at the ends of their ranges: no NaN, no infinity, and springs counted right.

use super::*;
use asperity::contact::ContactError;

fn power_of_ten(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10_f64.powf(power))
}

/// A number of either sign, or zero.
fn signed(low: f64, high: f64) -> impl Strategy<Value = f64> {
    let either =
        (power_of_ten(low, high), prop_oneof![Just(1.0), Just(-1.0)]).prop_map(|(size, sign)| sign * size);
    prop_oneof![8 => either, 1 => Just(0.0)]
}

/// Gaps from subnormal numbers to 1e15 m, all sizes at once or each line of one size.
fn extreme_gaps() -> impl Strategy<Value = Vec<f64>> {
    let tiny = prop_oneof![power_of_ten(-323.0, -300.0), power_of_ten(-300.0, -15.0)];
    let size = prop_oneof![8 => power_of_ten(-15.0, 15.0), 1 => tiny];
    let mixed = prop::collection::vec(size, 0..40);
    let alike = (power_of_ten(-15.0, 15.0), prop::collection::vec(0.0..1.0_f64, 0..40))
        .prop_map(|(size, gaps)| gaps.iter().map(|gap| size * gap).collect::<Vec<f64>>());
    (prop_oneof![mixed, alike], any::<prop::sample::Index>()).prop_map(|(mut gaps, place)| {
        gaps.insert(place.index(gaps.len() + 1), 0.0);
        gaps
    })
}

fn extreme_target() -> impl Strategy<Value = Move> {
    prop_oneof![
        4 => signed(-20.0, 15.0).prop_map(Move::ToIndentation),
        4 => signed(-40.0, 30.0).prop_map(Move::ToForce),
        1 => Just(Move::ToTouch),
        1 => Just(Move::ToZeroForce),
        1 => Just(Move::ToSeparation),
    ]
}

/// Checks a leg that began with this number of springs in contact.
fn check_leg(record: &LegRecord, before: u64, springs: u64) -> Result<(), TestCaseError> {
    prop_assert!(record.released_energy.is_finite(), "{:?}", record.released_energy);
    for point in record.curve.iter().chain([&record.largest, &record.smallest]) {
        let CurvePoint { indentation, force, contact_length, stored_energy, .. } = *point;
        let numbers = [indentation, force, contact_length, stored_energy];
        prop_assert!(numbers.iter().all(|number| number.is_finite()) && contact_length >= 0.0, "{:?}", point);
        prop_assert!(point.springs <= springs && point.fragments <= point.springs, "{:?}", point);
        prop_assert_eq!(point.springs == 0, point.fragments == 0);
    }
    for pair in record.curve.windows(2) {
        let [before, after] = [pair[0].indentation, pair[1].indentation];
        let ordered = if record.direction == Direction::Loading { before <= after } else { before >= after };
        prop_assert!(ordered, "{} before {}", before, after);
    }
    prop_assert_eq!(before + record.attached - record.detached, end(record).springs);
    if record.direction == Direction::Unloading && record.curve.len() > 2 {
        let least = record.curve.iter().map(|point| point.force).fold(f64::INFINITY, f64::min);
        prop_assert!(record.smallest.force <= least, "{:?} {}", record.smallest, least);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn every_number_is_finite(
        gaps in extreme_gaps(),
        edges in prop_oneof![Just(Edges::Grid), Just(Edges::SubCell)],
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        spacing in power_of_ten(-18.0, 1.0),
        effective_modulus in power_of_ten(0.0, 13.0),
        targets in prop::collection::vec(extreme_target(), 1..8),
        samples in 2_usize..300,
    ) {
        let foundation = Foundation::endless(spacing, effective_modulus);
        let body = Body::new(gaps, edges, foundation, range * effective_modulus);
        for mut solver in [body.on(samples), body.bare(samples)] {
            let mut springs = 0;
            for &target in &targets {
                match solver.advance(target) {
                    Ok(record) => {
                        check_leg(&record, springs, body.gaps.len() as u64)?;
                        let end = end(&record);
                        springs = end.springs;
                        if springs > 0 {
                            let patches = solver.leg().patches(end.indentation);
                            prop_assert_eq!(patches.len() as u64, end.fragments);
                            prop_assert_eq!(indices(&patches).len() as u64, springs);
                        }
                    }
                    Err(ContactError::DetachesBefore { smallest, .. }) => prop_assert!(smallest.is_finite()),
                    Err(ContactError::NothingToPull | ContactError::OutOfReach) => {}
                    Err(error) => return Err(TestCaseError::fail(error.to_string())),
                }
                prop_assert!(!solver.leg().thresholds().iter().any(|threshold| threshold.is_nan()));
            }
        }
    }

    #[test]
    fn every_number_of_the_stepwise_solver_is_finite(
        gaps in extreme_gaps(),
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        step in power_of_ten(-15.0, 15.0),
        to in -50_i32..50,
    ) {
        let body = Body::new(gaps, Edges::Grid, Foundation::endless(0.01, 1.0), range);
        let contact = body.contact();
        let mut solver = Stepwise::new(&contact, step, 9, &|| false).unwrap();
        let mut springs = 0;
        for to in [0.0, f64::from(to) * step, 0.5 * f64::from(to) * step] {
            let record = solver.advance(Move::ToIndentation(to)).unwrap();
            check_leg(&record, springs, body.gaps.len() as u64)?;
            springs = end(&record).springs;
        }
    }
}
