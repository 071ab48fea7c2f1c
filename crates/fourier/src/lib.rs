#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::num_complex::{Complex, Complex64};
pub use rustfft::{Fft, FftNum};

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use std::sync::Arc;

/// Plans the transform X_k = Σ x_n exp(−2πi kn/N) of N = `points` real numbers x_n. The result of
/// the transform is the modes X_k with k = 0 … ⌊N/2⌋.
pub fn plan_real_forward<T: FftNum>(points: usize) -> Arc<dyn RealToComplex<T>> {
    RealFftPlanner::new().plan_fft_forward(points)
}

/// Plans the transform x_n = Σ X_k exp(2πi kn/N), without the factor 1/N. The result of the
/// transform is N = `points` real numbers x_n. The input is only the modes X_k with k = 0 … ⌊N/2⌋,
/// because they determine all other modes of the sum.
pub fn plan_real_inverse<T: FftNum>(points: usize) -> Arc<dyn ComplexToReal<T>> {
    RealFftPlanner::new().plan_fft_inverse(points)
}

/// Plans the transform X_k = Σ x_n exp(−2πi kn/N) of N = `points` complex numbers x_n.
pub fn plan_forward<T: FftNum>(points: usize) -> Arc<dyn Fft<T>> {
    FftPlanner::new().plan_fft_forward(points)
}

/// Plans the transform x_n = Σ X_k exp(2πi kn/N) of N = `points` complex numbers X_k, without the
/// factor 1/N.
pub fn plan_inverse<T: FftNum>(points: usize) -> Arc<dyn Fft<T>> {
    FftPlanner::new().plan_fft_inverse(points)
}
