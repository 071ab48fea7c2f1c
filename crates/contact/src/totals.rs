//! Totals of the springs in contact: the numbers of springs and patches, and the sums of gaps. The
//! sums are integers, so no digits cancel.

/// Scale that converts the gaps of one profile to integers. The unit of the integers is called the
/// quantum. It is 2⁻⁶² of the smallest power of two above the largest gap.
///
/// A sum of integers does not depend on the order of the springs, and a spring that attaches and
/// detaches again changes no bit. If a loading and an unloading lead to the same contact, their
/// forces are therefore equal bit for bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapScale {
    quanta_per_metre: f64,
    quantum: f64,
}

impl Default for GapScale {
    fn default() -> Self {
        GapScale::for_gaps_up_to(0.0)
    }
}

/// Number of bits of a gap in quanta. A gap below 2^62 quanta fits into an `i64`, and a sum of 2^28
/// such gaps into an `i128`.
const GAP_BITS: i32 = 62;

/// Largest exponent of the scale, which is the power of two by which a gap in m is multiplied to
/// count its quanta. Up to this exponent, the scale and its inverse, the quantum, are both normal
/// floating-point numbers.
const LARGEST_SCALE_EXPONENT: i32 = 1000;

/// Number of bits of the mantissa of an `f64`.
const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// Value of the exponent bits of an `f64` for the number 1.
const EXPONENT_BIAS: i32 = f64::MAX_EXP - 1;

/// Returns 2 to the power `exponent`. The result must be a normal floating-point number.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((EXPONENT_BIAS + exponent) as u64) << MANTISSA_BITS)
}

impl GapScale {
    /// Creates the scale for gaps from zero to `largest` in m. `largest` must be finite.
    pub fn for_gaps_up_to(largest: f64) -> Self {
        // The smallest power of two above the largest gap, which may be zero.
        let bits = largest.max(f64::MIN_POSITIVE).to_bits();
        let above = (bits >> MANTISSA_BITS) as i32 - EXPONENT_BIAS + 1;
        let exponent = (GAP_BITS - above).min(LARGEST_SCALE_EXPONENT);
        GapScale {
            quanta_per_metre: power_of_two(exponent),
            quantum: power_of_two(-exponent),
        }
    }

    /// Returns a gap in m as a whole number of quanta, rounded down. The quantum is the unit of
    /// this scale.
    #[inline]
    pub fn quanta(&self, gap: f64) -> i64 {
        (gap * self.quanta_per_metre) as i64
    }

    /// Returns the size in m of a quantum, the unit of this scale. In a sum, each gap is rounded by
    /// less than a quantum.
    #[cfg(test)]
    pub fn quantum(&self) -> f64 {
        self.quantum
    }
}

/// Number of low bits by which squared quanta are shortened in a sum of squares, so that 2^28
/// squares fit into an `i128`.
const SQUARE_BITS: u32 = 28;

/// Returns the sum of the gaps and the sum of their squares over at most four springs, or over at
/// most four cells, which lie between five springs. The first sum is in quanta, the units of
/// `scale`. The second sum is in units of 2^28 squared quanta.
///
/// The sum of four gaps, each below 2^62 quanta, fits into 64 bits, and the sum of their squares
/// into 128 bits. The profile is straight between springs. The mean square along a cell is
/// therefore (mean gap)² + (difference)²/12.
#[inline]
pub fn sums_of_few(gaps: &[f64], of_cells: bool, scale: GapScale) -> [i128; 2] {
    let mut sum = 0_u64;
    let mut squares = 0_u128;
    let mut squared_differences = 0_u128;
    let mut add = |gap: f64| {
        let quanta = scale.quanta(gap).cast_unsigned();
        sum += quanta;
        squares += u128::from(quanta) * u128::from(quanta);
    };
    if of_cells {
        for cell in gaps.windows(2) {
            add(0.5 * cell[0] + 0.5 * cell[1]);
            let difference = u128::from(scale.quanta((cell[0] - cell[1]).abs()).cast_unsigned());
            squared_differences += difference * difference;
        }
    } else {
        for &gap in gaps {
            add(gap);
        }
    }
    let squares = (squares + twelfth(squared_differences)) >> SQUARE_BITS;
    [i128::from(sum), squares.cast_signed()]
}

/// Returns a twelfth of a number, at most 13 too small. An exact division of 128 bits would take
/// longer than all other sums.
#[inline]
fn twelfth(number: u128) -> u128 {
    let high = (number >> 64) as u64;
    let low = number as u64;
    (u128::from(high / 12) << 64)
        + u128::from(high % 12) * u128::from(u64::MAX / 12)
        + u128::from(low / 12)
}

/// Sums over the springs in contact at one indentation: their number, the number of patches, and
/// the sums of their gaps and of their squared gaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactTotals {
    /// Number of springs in contact.
    pub springs: i64,
    /// Number of patches.
    pub patches: i64,
    /// Sum of the gaps of the springs in contact. If the sums are over the cells between these
    /// springs, it is the sum of the mean gaps of the cells. The unit is the quantum of a
    /// [`GapScale`].
    pub quanta: i128,
    /// Sum of the squared gaps of the springs in contact, or of the cells between these springs.
    /// The unit is 2^28 squared quanta.
    pub squares: i128,
}

impl ContactTotals {
    /// Computes the sums over one patch. If `slides` is true, the sums are over the cells between
    /// the springs of the patch; otherwise they are over the springs.
    pub(super) fn of_patch(gaps: &[f64], slides: bool, scale: GapScale) -> Self {
        let mut totals = ContactTotals {
            springs: gaps.len() as i64,
            patches: 1,
            ..Self::default()
        };
        // Springs are summed one by one. Cells are summed as pairs of springs, because each cell
        // lies between two springs.
        let springs_of_part = if slides { 2 } else { 1 };
        for part in gaps.windows(springs_of_part) {
            let [quanta, squares] = sums_of_few(part, slides, scale);
            totals.quanta += quanta;
            totals.squares += squares;
        }
        totals
    }

    /// Returns the number of whole cells in contact if `slides` is true, otherwise the number of
    /// springs in contact. A patch has one whole cell less than springs.
    #[inline]
    pub(super) fn whole(&self, slides: bool) -> i64 {
        if slides {
            self.springs - self.patches
        } else {
            self.springs
        }
    }

    /// Computes the compression in m: the force divided by the stiffness of one spring. d =
    /// `indentation` is in m. For `count` springs with the gaps c_i, the compression is Σ (d −
    /// c_i). For `count` cells with the gap c, it is ∫ (d − c) dx, where x is in cells.
    ///
    /// For n springs and a largest gap below 2^e m, the error is at most 2u |result| plus n
    /// 2^(e−62), where u = 2⁻⁵³ is the unit roundoff. The gaps are summed exactly, n d is an exact
    /// product of two numbers, and only the difference of the product and the sum is rounded. If
    /// the largest gap is below about 2^−938 m, the quantum is 2^−1000 m and not smaller.
    #[inline]
    pub fn compression(&self, count: i64, indentation: f64, scale: &GapScale) -> f64 {
        let springs = count as f64;
        let product = springs * indentation;
        let product_error = springs.mul_add(indentation, -product);
        let high_quanta = self.quanta as f64;
        let low_quanta = (self.quanta - high_quanta as i128) as f64;
        let high = high_quanta * scale.quantum;
        let low = low_quanta * scale.quantum;
        // `error` is the rounding error of product − high by Knuth's two-sum, which does not
        // require that the first number is the larger one.
        let difference = product - high;
        let subtracted = difference - product;
        let kept = difference - subtracted;
        let error = (product - kept) - (high + subtracted);
        difference + (error + (product_error - low))
    }

    /// Computes the sum of squared compressions Σ (d − c)² in m² of `count` springs or cells with
    /// the gaps c at the indentation d.
    ///
    /// The sums are integers. If one patch lies inside another one, their sums at the same
    /// indentation differ by the squares of the springs between the edges of both. Each square has
    /// an error below 2^28 squared quanta. This is a relative error of 1e-15 for a stretch of 1e-7
    /// of the largest gap.
    pub(super) fn squares_of(&self, count: i64, indentation: f64, scale: &GapScale) -> f64 {
        let scale = SquareScale::new(*scale, indentation.abs());
        let (squares, remainder) = scale.at(self, count, indentation);
        scale.in_metres(squares) + remainder
    }
}

impl std::ops::Neg for ContactTotals {
    type Output = ContactTotals;

    #[inline]
    fn neg(self) -> ContactTotals {
        ContactTotals {
            springs: -self.springs,
            patches: -self.patches,
            quanta: -self.quanta,
            squares: -self.squares,
        }
    }
}

impl std::ops::AddAssign for ContactTotals {
    #[inline]
    fn add_assign(&mut self, other: ContactTotals) {
        self.springs += other.springs;
        self.patches += other.patches;
        self.quanta += other.quanta;
        self.squares += other.squares;
    }
}

/// Unit in which sums of squared stretches are integers. It is usually 2^28 squared quanta, where a
/// quantum is the unit of the gaps. The unit is coarser if an indentation is much larger than all
/// gaps.
#[derive(Clone, Copy, Debug)]
pub struct SquareScale {
    quanta_per_metre: f64,
    quantum: f64,
    /// Number of bits by which the unit is coarser than the quantum of the gaps.
    coarser: u32,
}

impl SquareScale {
    /// Creates the unit for gaps that are converted to integers with `scale`, and for indentations
    /// from `−largest` to `largest` in m.
    pub fn new(scale: GapScale, largest: f64) -> Self {
        let mut squares = SquareScale {
            quanta_per_metre: scale.quanta_per_metre,
            quantum: scale.quantum,
            coarser: 0,
        };
        while largest * squares.quanta_per_metre >= (1_u64 << (GAP_BITS + 1)) as f64 {
            squares.quanta_per_metre *= 0.5;
            squares.quantum *= 2.0;
            squares.coarser += 1;
        }
        squares
    }

    /// Computes Σ (c − θ)² over `count` springs or cells with the gaps c, where θ is an indentation
    /// in m. The result has two parts, which are to be added: an integer in the unit `self`, and a
    /// remainder in m².
    pub fn at(&self, totals: &ContactTotals, count: i64, indentation: f64) -> (i128, f64) {
        let gaps = totals.quanta.checked_shr(self.coarser).unwrap_or(0);
        let squared_gaps = totals.squares.checked_shr(2 * self.coarser).unwrap_or(0);
        let exact = indentation * self.quanta_per_metre;
        let whole = i128::from(exact as i64);
        let part = exact - whole as f64;
        let number = i128::from(count);
        // The integer is Σ c² + θ (n θ − 2 Σ c) for the whole part of θ and n = `count`. The low
        // bits of the factor in brackets are multiplied separately, because the product of all bits
        // might exceed the range of integers.
        let factor = number * whole - 2 * gaps;
        let high_product = (factor >> SQUARE_BITS).wrapping_mul(whole);
        let low_bits = factor & ((1 << SQUARE_BITS) - 1);
        let low_product = (low_bits * whole) >> SQUARE_BITS;
        let sum = squared_gaps
            .wrapping_add(high_product)
            .wrapping_add(low_product);
        let remainder = part * (2.0 * (number * whole - gaps) as f64 + count as f64 * part);
        (sum, remainder * self.quantum * self.quantum)
    }

    /// Converts a sum of squares from the unit `self` to m².
    pub fn in_metres(&self, squares: i128) -> f64 {
        squares as f64 * self.quantum * self.quantum * f64::from(1 << SQUARE_BITS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A sum of compressions is rounded only once, also if it is much smaller or larger than
        /// the sum of the gaps.
        #[test]
        fn a_compression_is_rounded_once(
            count in 1_i64..1000,
            indentation in 0_u64..1 << 53,
            quanta in 0_i128..1 << 62,
            halvings in 0_u32..20,
        ) {
            let scale = GapScale::for_gaps_up_to(1.0);
            let quanta = quanta >> halvings;
            let exact = i128::from(count) * (i128::from(indentation) << 9) - quanta;
            let totals = ContactTotals { quanta, ..ContactTotals::default() };
            let found = totals.compression(count, (indentation << 9) as f64 * scale.quantum(), &scale);
            let error = (found / scale.quantum()) as i128 - exact;
            prop_assert!(error.abs() <= (exact.abs() >> 53) + (exact.abs() >> 60) + 1, "{} of {}", error, exact);
        }
    }

    // The following tests compare sums of gaps and forces with exact arithmetic. The documented
    // bound also holds if nearly all of a force cancels.

    /// Returns the rounded sum a + b and its rounding error.
    fn two_sum(a: f64, b: f64) -> (f64, f64) {
        let sum = a + b;
        let added = sum - a;
        (sum, (a - (sum - added)) + (b - added))
    }

    /// An exact sum of numbers as several parts. The parts rise in size and have no digit in common
    /// (Shewchuk 1997).
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

        /// Adds another sum multiplied by `factor`, a power of two or the negative of a power of
        /// two.
        fn add_sum(&mut self, other: &Sum, factor: f64) {
            other.0.iter().for_each(|part| self.add(factor * part));
        }

        /// Returns the largest part. It has the sign of the sum, and the size of the sum to
        /// rounding.
        fn rounded(&self) -> f64 {
            self.0.last().copied().unwrap_or(0.0)
        }
    }

    fn sum_of(gaps: &[f64]) -> Sum {
        let mut sum = Sum::default();
        gaps.iter().for_each(|&gap| sum.add(gap));
        sum
    }

    /// Checks that the compressions of these gaps are within the bound of
    /// [`ContactTotals::compression`], 2u |result| plus a quantum for each gap. The check uses
    /// these indentations, and indentations at which the compression nearly vanishes.
    fn check(gaps: &[f64], indentations: &[f64]) -> Result<(), String> {
        let scale = GapScale::for_gaps_up_to(gaps.iter().copied().fold(0.0, f64::max));
        let mut totals = ContactTotals::default();
        for &gap in gaps {
            let quanta = i128::from(scale.quanta(gap));
            totals += ContactTotals {
                springs: 1,
                quanta,
                ..ContactTotals::default()
            };
        }
        let (springs, sum) = (gaps.len() as f64, sum_of(gaps));
        let mean = sum.rounded() / springs;
        let balances = [-3, -1, 0, 1, 2]
            .map(|places| f64::from_bits(mean.to_bits().saturating_add_signed(places)));
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
                return Err(format!(
                    "at {d:e}: {found:e} against {exact:e}, error {error:e}"
                ));
            }
        }
        Ok(())
    }

    /// Generates gaps of three kinds: of similar size, of very different sizes, and with a large
    /// common offset and differences only in the last digits.
    fn gaps(most: usize) -> impl Strategy<Value = Vec<f64>> {
        let alike = (
            -150.0..150.0_f64,
            prop::collection::vec(0.0..1.0_f64, 1..most),
        )
            .prop_map(|(power, gaps)| gaps.iter().map(|gap| gap * 10_f64.powf(power)).collect());
        let all_sizes = prop::collection::vec(-40.0..0.0_f64, 1..most)
            .prop_map(|powers| powers.iter().map(|power| 10_f64.powf(*power)).collect());
        let offset = (0.5..2.0_f64, prop::collection::vec(0_u64..1 << 20, 1..most)).prop_map(
            |(offset, places)| {
                places
                    .iter()
                    .map(|place| f64::from_bits(offset.to_bits() + place))
                    .collect::<Vec<f64>>()
            },
        );
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
                // This difference has no rounding: a quantum is a power of two, and the digits of
                // the quanta are the first digits of the gap.
                let left = gap - quanta as f64 * scale.quantum();
                prop_assert!((0.0..scale.quantum()).contains(&left), "{} of {}", gap, largest);
            }
        }
    }
}
