//! Numbers at the ends of their ranges: no NaN, no infinity, and energies that balance.

use super::*;
use asperity::contact::{ContactError, Direction, Stepwise};

fn power_of_ten(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10_f64.powf(power))
}

/// A number of either sign, or zero.
fn signed(low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => power_of_ten(low, high),
        4 => power_of_ten(low, high).prop_map(|value| -value),
        1 => Just(0.0),
    ]
}

/// Gaps from 1e−15 to 1e15 m, all sizes at once or each line of one size.
fn extreme_gaps() -> impl Strategy<Value = Vec<f64>> {
    let mixed = prop::collection::vec(power_of_ten(-15.0, 15.0), 0..40);
    let alike = (power_of_ten(-15.0, 15.0), prop::collection::vec(0.0..1.0_f64, 0..40))
        .prop_map(|(size, gaps)| gaps.iter().map(|gap| size * gap).collect::<Vec<f64>>());
    (prop_oneof![mixed, alike], any::<prop::sample::Index>()).prop_map(|(mut gaps, place)| {
        gaps.insert(place.index(gaps.len() + 1), 0.0);
        gaps
    })
}

fn extreme_leg() -> impl Strategy<Value = Move> {
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
        prop_assert!(point.indentation.is_finite() && point.force.is_finite(), "{:?}", point);
        prop_assert!(point.springs <= springs && point.fragments <= point.springs, "{:?}", point);
        prop_assert_eq!(point.springs == 0, point.fragments == 0);
    }
    for pair in record.curve.windows(2) {
        let [before, after] = [pair[0].indentation, pair[1].indentation];
        let ordered = if record.direction == Direction::Loading { before <= after } else { before >= after };
        prop_assert!(ordered, "{} before {}", before, after);
    }
    let after = record.curve.last().unwrap().springs;
    prop_assert_eq!(before + record.attached - record.detached, after);
    if record.direction == Direction::Unloading {
        let least = record.curve.iter().map(|point| point.force).fold(f64::INFINITY, f64::min);
        prop_assert!(
            record.smallest.force <= least || record.curve.len() < 3,
            "{:?} {}",
            record.smallest,
            least
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn every_number_is_finite(
        gaps in extreme_gaps(),
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        spacing in power_of_ten(-18.0, 1.0),
        effective_modulus in power_of_ten(0.0, 13.0),
        legs in prop::collection::vec(extreme_leg(), 1..8),
        samples in 2_usize..300,
    ) {
        let work = range * effective_modulus;
        let body = Body { gaps, foundation: Foundation::endless(spacing, effective_modulus), work, closing: 1.0 };
        let springs = body.gaps.len() as u64;
        let adhesive: Box<dyn Solver> = Box::new(body.on(samples));
        let bare: Box<dyn Solver> = Box::new(nonadhesive(&body.gaps, Edges::Grid, body.foundation, samples));
        for mut solver in [adhesive, bare] {
            let mut held = 0;
            for &leg in &legs {
                match solver.advance(leg) {
                    Ok(record) => {
                        check_leg(&record, held, springs)?;
                        let end = record.curve.last().unwrap();
                        held = end.springs;
                        if held > 0 {
                            let fragments = solver.leg().patches(end.indentation);
                            prop_assert_eq!(fragments.len() as u64, end.fragments);
                            prop_assert_eq!(indices(&fragments).len() as u64, held);
                        }
                    }
                    Err(ContactError::DetachesBefore { smallest, .. }) => prop_assert!(smallest.is_finite()),
                    Err(ContactError::NothingToPull | ContactError::OutOfReach) => {}
                    Err(error) => return Err(TestCaseError::fail(error.to_string())),
                }
                let thresholds = solver.leg().thresholds();
                prop_assert!(!thresholds.iter().any(|threshold| threshold.is_nan()));
            }
        }
    }

    #[test]
    fn stepwise_as_well(
        gaps in extreme_gaps(),
        range in prop_oneof![1 => Just(0.0), 8 => power_of_ten(-30.0, 30.0)],
        step in power_of_ten(-15.0, 15.0),
        to in -50_i32..50,
    ) {
        let foundation = Foundation::endless(0.01, 1.0);
        let hess = (range > 0.0).then(|| HessRule::new(foundation, range));
        let contact = Contact::new(gaps.clone(), Edges::Grid, foundation, hess);
        let mut solver = Stepwise::new(&contact, step, 9, &|| false).unwrap();
        let mut held = 0;
        for leg in [0.0, f64::from(to) * step, 0.5 * f64::from(to) * step].map(Move::ToIndentation) {
            let record = solver.advance(leg).unwrap();
            check_leg(&record, held, gaps.len() as u64)?;
            held = record.curve.last().unwrap().springs;
        }
    }
}
