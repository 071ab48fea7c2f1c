//! A random self-affine line: phases and a Fourier transform.

use super::Stage;
use super::call::{Called, HEIGHT, Row};

pub const ROW: Row = Row {
    stage: Stage::Synthesis,
    name: "random line (phases, Fourier transform)",
    called: |call| match (call.is_synthesised(), call.is_measured()) {
        (true, _) => Called::For("roughness: SelfAffine"),
        (_, true) => Called::Not("roughness: Measured"),
        _ => Called::Not("no roughness: smooth"),
    },
    cost: |call| call.passes_over(call.points, Some(1), HEIGHT + transform(call.points)),
};

/// Largest prime factor of a number of springs that the Fourier transform takes in its stride.
const LARGEST_FACTOR: u64 = 11;

/// Bytes for each spring of the transform's coefficients, scratch space and twiddle factors, as measured. Odd
/// numbers of springs transform at twice the length, those with a large prime factor by way of a much longer
/// convolution.
fn transform(points: u64) -> u64 {
    match (points.is_multiple_of(2), has_small_factors(points)) {
        (true, true) => 20,
        (false, true) => 56,
        (true, false) => 96,
        (false, false) => 176,
    }
}

fn has_small_factors(mut number: u64) -> bool {
    for factor in 2..=LARGEST_FACTOR {
        while number > 1 && number.is_multiple_of(factor) {
            number /= factor;
        }
    }
    number <= 1
}
