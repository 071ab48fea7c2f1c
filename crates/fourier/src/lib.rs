#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::num_complex::{Complex, Complex64};
pub use rustfft::{Fft, FftNum};

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use std::sync::Arc;

/// Plans X_k = Σ x_n exp(−2πi kn/N) of N real `points`: its modes are k = 0 … ⌊N/2⌋.
pub fn plan_real_forward<T: FftNum>(points: usize) -> Arc<dyn RealToComplex<T>> {
    RealFftPlanner::new().plan_fft_forward(points)
}

/// Plans x_n = Σ X_k exp(2πi kn/N) over all modes of N real `points`, of which k = 0 … ⌊N/2⌋ are given.
pub fn plan_real_inverse<T: FftNum>(points: usize) -> Arc<dyn ComplexToReal<T>> {
    RealFftPlanner::new().plan_fft_inverse(points)
}

/// Plans X_k = Σ x_n exp(−2πi kn/N) of N complex `points`.
pub fn plan_forward<T: FftNum>(points: usize) -> Arc<dyn Fft<T>> {
    FftPlanner::new().plan_fft_forward(points)
}

/// Plans x_n = Σ X_k exp(2πi kn/N) of N complex `points`, without the factor 1/N.
pub fn plan_inverse<T: FftNum>(points: usize) -> Arc<dyn Fft<T>> {
    FftPlanner::new().plan_fft_inverse(points)
}
