//! Sums of gaps and forces against exact arithmetic: the documented bound also holds where nearly all of a force
//! cancels, and the order of the springs has no effect.

use super::totals::{ContactTotals, GapScale};
use proptest::prelude::*;

/// a + b and its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let added = sum - a;
    (sum, (a - (sum - added)) + (b - added))
}

/// An exact sum of numbers: its parts rise in size and have no digit in common (Shewchuk 1997).
#[derive(Clone, Default)]
struct Sum(Vec<f64>);

impl Sum {
    fn add(&mut self, mut value: f64) {
        for part in &mut self.0 {
            (value, *part) = two_sum(value, *part);
        }
        self.0.push(value);
        self.0.retain(|part| *part != 0.0);
    }

    fn add_product(&mut self, one: f64, other: f64) {
        let product = one * other;
        self.add(one.mul_add(other, -product));
        self.add(product);
    }

    /// Adds a sum times a power of two or its negative.
    fn add_sum(&mut self, other: &Sum, factor: f64) {
        other.0.iter().for_each(|part| self.add(factor * part));
    }

    /// The largest part, which has the sign of the sum and its size to rounding.
    fn rounded(&self) -> f64 {
        self.0.last().copied().unwrap_or(0.0)
    }
}

fn sum_of(gaps: &[f64]) -> Sum {
    let mut sum = Sum::default();
    gaps.iter().for_each(|&gap| sum.add(gap));
    sum
}

/// Checks that the compressions of these gaps are within the bound of [`ContactTotals::compression`], 2u |result| + a
/// quantum for each gap, at these indentations and where the gaps nearly balance.
fn check(gaps: &[f64], indentations: &[f64]) -> Result<(), String> {
    let scale = GapScale::for_gaps_up_to(gaps.iter().copied().fold(0.0, f64::max));
    let mut totals = ContactTotals::default();
    for &gap in gaps {
        let quanta = i128::from(scale.quanta(gap));
        totals += ContactTotals { springs: 1, quanta, ..ContactTotals::default() };
    }
    let (springs, sum) = (gaps.len() as f64, sum_of(gaps));
    let mean = sum.rounded() / springs;
    let balances =
        [-3, -1, 0, 1, 2].map(|places| f64::from_bits(mean.to_bits().saturating_add_signed(places)));
    for &d in indentations.iter().chain(&balances) {
        let found = totals.compression(totals.springs, d, &scale);
        let mut exact = Sum::default();
        exact.add_product(springs, d);
        exact.add_sum(&sum, -1.0);
        let mut error = exact.clone();
        error.add(-found);
        let mut room = Sum::default();
        room.add_product(springs, scale.quantum());
        room.add_sum(&exact, f64::EPSILON.copysign(exact.rounded()));
        room.add_sum(&error, 1.0_f64.copysign(-error.rounded()));
        if room.rounded() < 0.0 {
            let [exact, error] = [exact, error].map(|value| value.rounded());
            return Err(format!("at {d:e}: {found:e} against {exact:e}, error {error:e}"));
        }
    }
    Ok(())
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
    #![proptest_config(ProptestConfig { cases: 75, failure_persistence: None, ..ProptestConfig::default() })]

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
            // Without rounding: a quantum is a power of two, and the digits of the quanta are the first ones of the gap.
            let left = gap - quanta as f64 * scale.quantum();
            prop_assert!((0.0..scale.quantum()).contains(&left), "{} of {}", gap, largest);
        }
    }
}
