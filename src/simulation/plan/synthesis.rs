//! A random self-affine line: phases and a Fourier transform.

use super::Stage;
use super::call::{Called, HEIGHT, Row};

pub const ROW: Row = Row {
    stage: Stage::Synthesis,
    name: "random profile",
    called: |call| match (call.is_synthesised(), call.is_measured()) {
        (true, true) => Called::For("roughness: Measured, its equivalent line"),
        (true, false) => Called::For("roughness: SelfAffine"),
        (_, true) => Called::Not("roughness: Measured, as the line"),
        _ => Called::Not("no roughness: smooth"),
    },
    cost: |call| {
        let mut cost = call.passes_over(call.points, Some(1), HEIGHT + transform(call.points));
        cost.bytes = cost.bytes.saturating_add(convolution(call.points));
        cost
    },
};

/// Largest prime factor of a number of springs that the Fourier transform takes in its stride.
const LARGEST_FACTOR: u64 = 31;

/// Bytes for each spring of the transform's coefficients, scratch space and twiddle factors, as measured. Odd
/// numbers of springs transform at twice the length.
fn transform(points: u64) -> u64 {
    if points.is_multiple_of(2) { 20 } else { 56 }
}

/// Bytes of the convolution by way of which a large prime factor is transformed, as measured.
fn convolution(points: u64) -> u64 {
    let factor = largest_prime_factor(points);
    if factor > LARGEST_FACTOR { 152 * factor } else { 0 }
}

fn largest_prime_factor(mut number: u64) -> u64 {
    let (mut factor, mut largest) = (2, 1);
    while factor * factor <= number {
        if number.is_multiple_of(factor) {
            number /= factor;
            largest = factor;
        } else {
            factor += 1;
        }
    }
    largest.max(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_prime_factor_is_found() {
        for (number, factor) in [
            (1, 1),
            (2, 2),
            (3, 3),
            (1 << 28, 2),
            (1_048_583, 1_048_583),
            (2 * 524_287, 524_287),
            (121, 11),
            (90, 5),
        ] {
            assert_eq!(largest_prime_factor(number), factor, "{number}");
        }
    }
}
