#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::num_complex::{Complex, Complex64};
pub use rustfft::{Fft, FftNum};

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use std::sync::Arc;

/// Precision of the numbers of a transform: `f32` or `f64`.
///
/// The algorithms of `rustfft` are generic. Because these methods belong to two concrete types and
/// are never inlined, the algorithms are compiled in this crate alone.
pub trait Precision: FftNum {
    /// Plans the transform of [`plan_real_forward`].
    fn real_forward(points: usize) -> Arc<dyn RealToComplex<Self>>;
    /// Plans the transform of [`plan_real_inverse`].
    fn real_inverse(points: usize) -> Arc<dyn ComplexToReal<Self>>;
    /// Plans the transform of [`plan_forward`].
    fn forward(points: usize) -> Arc<dyn Fft<Self>>;
    /// Plans the transform of [`plan_inverse`].
    fn inverse(points: usize) -> Arc<dyn Fft<Self>>;
}

macro_rules! precision {
    ($number:ty) => {
        impl Precision for $number {
            #[inline(never)]
            fn real_forward(points: usize) -> Arc<dyn RealToComplex<Self>> {
                RealFftPlanner::new().plan_fft_forward(points)
            }

            #[inline(never)]
            fn real_inverse(points: usize) -> Arc<dyn ComplexToReal<Self>> {
                RealFftPlanner::new().plan_fft_inverse(points)
            }

            #[inline(never)]
            fn forward(points: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_forward(points)
            }

            #[inline(never)]
            fn inverse(points: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_inverse(points)
            }
        }
    };
}

precision!(f32);
precision!(f64);

/// Plans the transform X_k = Σ x_n exp(−2πi kn/N) of N = `points` real numbers x_n. The result of
/// the transform is the modes X_k with k = 0 … ⌊N/2⌋.
pub fn plan_real_forward<T: Precision>(points: usize) -> Arc<dyn RealToComplex<T>> {
    T::real_forward(points)
}

/// Plans the transform x_n = Σ X_k exp(2πi kn/N), without the factor 1/N. The result of the
/// transform is N = `points` real numbers x_n. The input is only the modes X_k with k = 0 … ⌊N/2⌋,
/// because they determine all other modes of the sum.
pub fn plan_real_inverse<T: Precision>(points: usize) -> Arc<dyn ComplexToReal<T>> {
    T::real_inverse(points)
}

/// Plans the transform X_k = Σ x_n exp(−2πi kn/N) of N = `points` complex numbers x_n.
pub fn plan_forward<T: Precision>(points: usize) -> Arc<dyn Fft<T>> {
    T::forward(points)
}

/// Plans the transform x_n = Σ X_k exp(2πi kn/N) of N = `points` complex numbers X_k, without the
/// factor 1/N.
pub fn plan_inverse<T: Precision>(points: usize) -> Arc<dyn Fft<T>> {
    T::inverse(points)
}
