//! Sums of gaps and forces against exact arithmetic: the documented bound also holds where nearly all of a force
//! cancels, and the order of the springs has no effect.

use super::body::cases;
use asperity::contact::{ContactTotals, GapScale};
use dashu_float::{FBig, round::mode::HalfEven};
use proptest::prelude::*;

/// A binary number without a limit to its digits: sums and products are exact.
type Unrounded = FBig<HalfEven, 2>;

fn unrounded(value: f64) -> Unrounded {
    without_limit(Unrounded::try_from(value).unwrap())
}

/// A number whose sums and products with other exact ones are exact too.
fn without_limit(value: Unrounded) -> Unrounded {
    value.with_precision(0).value()
}

/// Unit roundoff u = 2⁻⁵³.
const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;

fn scale_of(gaps: &[f64]) -> GapScale {
    GapScale::for_gaps_up_to(gaps.iter().copied().fold(0.0, f64::max))
}

fn totals(gaps: &[f64], scale: &GapScale) -> ContactTotals {
    let mut totals = ContactTotals::default();
    for &gap in gaps {
        let quanta = i128::from(scale.quanta(gap));
        totals += ContactTotals { springs: 1, quanta, ..ContactTotals::default() };
    }
    totals
}

/// Σ c, exactly.
fn sum(gaps: &[f64]) -> Unrounded {
    gaps.iter().fold(Unrounded::ZERO, |sum, &gap| sum + unrounded(gap))
}

/// Σ (d − c), exactly, of this number of springs with this sum of gaps.
fn compression(springs: usize, sum: &Unrounded, d: f64) -> Unrounded {
    let exact = unrounded(springs as f64) * unrounded(d) - sum;
    assert_eq!(exact.precision(), 0, "a limit to the digits");
    exact
}

fn magnitude(value: Unrounded) -> Unrounded {
    if value < Unrounded::ZERO { -value } else { value }
}

/// Bound of [`ContactTotals::compression`]: 2u |result| + n 2^(e − 62), a quantum for each gap.
fn bound(exact: &Unrounded, springs: usize, scale: &GapScale) -> Unrounded {
    unrounded(2.0 * UNIT_ROUNDOFF) * magnitude(exact.clone())
        + unrounded(springs as f64) * unrounded(scale.quantum())
}

/// Checks that the compressions of these gaps are within their bound, at these indentations and where the gaps nearly
/// balance.
fn check(gaps: &[f64], indentations: &[f64]) -> Result<(), String> {
    let scale = scale_of(gaps);
    let (totals, sum) = (totals(gaps, &scale), sum(gaps));
    let balances = [-3, -1, 0, 1, 2].map(|places| balance(gaps.len(), &sum, places));
    for &d in indentations.iter().chain(&balances) {
        let found = totals.compression(totals.springs, d, &scale);
        let exact = compression(gaps.len(), &sum, d);
        let error = magnitude(unrounded(found) - exact.clone());
        if error > bound(&exact, gaps.len(), &scale) {
            let [exact, error] = [exact, error].map(|value| value.to_f64().value());
            return Err(format!("at {d:e}: {found:e} against {exact:e}, error {error:e}"));
        }
    }
    Ok(())
}

/// An indentation at which these gaps nearly balance: their mean, rounded, and `places` numbers beside.
fn balance(springs: usize, sum: &Unrounded, places: i64) -> f64 {
    let mean = (sum.clone().with_precision(200).value() / Unrounded::from(springs)).to_f64().value();
    f64::from_bits(mean.to_bits().saturating_add_signed(places))
}

/// Gaps of one size, of all sizes, and on a large offset with differences in the last places.
fn gaps(most: usize) -> impl Strategy<Value = Vec<f64>> {
    let alike = (-150.0..150.0_f64, prop::collection::vec(0.0..1.0_f64, 1..most))
        .prop_map(|(power, gaps)| gaps.iter().map(|gap| gap * 10_f64.powf(power)).collect());
    let all_sizes = prop::collection::vec(-40.0..0.0_f64, 1..most)
        .prop_map(|powers| powers.iter().map(|power| 10_f64.powf(*power)).collect());
    let offset =
        (0.5..2.0_f64, prop::collection::vec(0_u64..1 << 20, 1..most)).prop_map(|(offset, places)| {
            places.iter().map(|place| f64::from_bits(offset.to_bits() + place)).collect::<Vec<f64>>()
        });
    prop_oneof![alike, all_sizes, offset]
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn compressions_keep_their_bound(gaps in gaps(600), share in -3.0..3.0_f64) {
        let largest = gaps.iter().copied().fold(0.0, f64::max);
        check(&gaps, &[share * largest, 0.0, 1e12 * largest, -largest]).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn quanta_are_rounded_down(largest in (-307.0..300.0_f64).prop_map(|p| 10_f64.powf(p)), share in 0.0..=1.0_f64) {
        let scale = GapScale::for_gaps_up_to(largest);
        for gap in [largest, share * largest, 0.0] {
            let quanta = scale.quanta(gap);
            prop_assert!((0..1_i64 << 62).contains(&quanta));
            // A whole number has the precision of its own digits, and would round the difference to them.
            let whole = Unrounded::from(quanta).with_precision(0).value();
            let left = unrounded(gap) - whole * unrounded(scale.quantum());
            prop_assert!(left >= Unrounded::ZERO && left < unrounded(scale.quantum()), "{} of {}", gap, largest);
        }
    }
}
