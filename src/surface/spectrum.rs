//! The self-affine spectrum of the equivalent line, eqs. (4)–(9), and its mean squares.

use crate::parallel::in_parallel;

/// With fewer modes than these another thread takes longer to begin than it saves.
pub(super) const MANY_MODES: u64 = 1 << 14;

/// A self-affine spectrum over the modes k = `first` … `last`, wave vectors q_k = 2πk/L:
/// A_k ∝ k^(−H−1/2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H, 0 < H < 1.
    pub hurst: f64,
    /// First mode, at least 1.
    pub first: u64,
    /// Last mode, at least `first`.
    pub last: u64,
}

impl SelfAffine {
    /// Amplitude of mode k in units of that of mode 1.
    #[inline]
    #[must_use]
    pub fn relative_amplitude(&self, mode: u64) -> f64 {
        (mode as f64).powf(-self.hurst - 0.5)
    }

    /// Root mean square of the sum of cosines with these relative amplitudes: √(Σ A_k²/2).
    #[must_use]
    pub fn relative_rms(&self) -> f64 {
        relative_rms(self.moment(0))
    }

    /// Rms gradient over rms height, 1/m, of a line of length L in m:
    /// ⟨∇z⟩/h = √(Σ A_k² q_k² / Σ A_k²), the sums over the modes of the line itself.
    ///
    /// Finite sums of positive terms: nothing special happens at H → 1, where the integrals of
    /// eqs. (12) and (13) change their form.
    #[must_use]
    pub fn gradient_per_height(&self, length: f64) -> f64 {
        gradient_per_height(self.moment(0), self.moment(2), length)
    }

    /// [`Self::relative_rms`] and [`Self::gradient_per_height`] on a length of 1 m, with each sum made once,
    /// on two threads where there are many modes.
    pub(super) fn mean_squares(&self) -> MeanSquares {
        let many = self.last - self.first >= MANY_MODES;
        let (zeroth, second) = in_parallel(many, || self.moment(0), || self.moment(2));
        MeanSquares {
            relative_rms: relative_rms(zeroth),
            gradient_per_height: gradient_per_height(zeroth, second, 1.0),
        }
    }

    /// The same ratio by the integrals of eqs. (5)–(7) and (12), in which modes are dense:
    /// ⟨∇z⟩²/h² = ∫ q^(1−2H) dq / ∫ q^(−1−2H) dq between q_min and q_max.
    ///
    /// It differs from [`Self::gradient_per_height`], which belongs to the modes as they are, because
    /// the first modes carry most of the height. Zero when there is only one mode.
    #[must_use]
    pub fn continuum_gradient_per_height(&self, length: f64) -> f64 {
        let (low, high) = (self.first as f64, self.last as f64);
        let height = integral_of_power(-1.0 - 2.0 * self.hurst, low, high);
        if height == 0.0 {
            return 0.0;
        }
        let gradient = integral_of_power(1.0 - 2.0 * self.hurst, low, high);
        std::f64::consts::TAU / length * (gradient / height).sqrt()
    }

    /// Σ k^(power − 1 − 2H) over the modes, relative error a few units in the last place.
    fn moment(&self, power: i32) -> f64 {
        let exponent = f64::from(power) - 1.0 - 2.0 * self.hurst;
        // From the smallest term on, with the lost parts kept.
        let (mut sum, mut lost) = (0.0, 0.0);
        let mut add = |mode: u64| {
            let term = (mode as f64).powf(exponent);
            let next: f64 = sum + term;
            let added = next - sum;
            lost += (sum - (next - added)) + (term - added);
            sum = next;
        };
        if exponent < 0.0 {
            (self.first..=self.last).rev().for_each(&mut add);
        } else {
            (self.first..=self.last).for_each(&mut add);
        }
        sum + lost
    }
}

/// What the sums over all modes of a spectrum give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeanSquares {
    /// [`SelfAffine::relative_rms`].
    pub relative_rms: f64,
    /// [`SelfAffine::gradient_per_height`] on a length of 1 m.
    pub gradient_per_height: f64,
}

fn relative_rms(zeroth_moment: f64) -> f64 {
    (zeroth_moment / 2.0).sqrt()
}

fn gradient_per_height(zeroth_moment: f64, second_moment: f64, length: f64) -> f64 {
    std::f64::consts::TAU / length * (second_moment / zeroth_moment).sqrt()
}

/// ∫ q^power dq from `low` to `high`, accurate also where power → −1, eqs. (12) and (13).
///
/// With s = power + 1 it is low^s (e^(s ln(high/low)) − 1)/s; `expm1` keeps it accurate for small s and
/// the logarithm is its limit at s = 0.
fn integral_of_power(power: f64, low: f64, high: f64) -> f64 {
    let s = power + 1.0;
    let ratio = (high / low).ln();
    let growth = if s == 0.0 { ratio } else { (s * ratio).exp_m1() / s };
    low.powf(s) * growth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_stay_accurate_as_hurst_goes_to_one() {
        let spectrum = |hurst| SelfAffine { hurst, first: 1, last: 4096 };
        let limit = spectrum(1.0).continuum_gradient_per_height(1.0);
        // At H = 1: ∫dq/q = ln 4096 over ∫q⁻³dq = (1 − 4096⁻²)/2.
        let exact = std::f64::consts::TAU * (4096_f64.ln() * 2.0 / (1.0 - 4096_f64.powi(-2))).sqrt();
        assert!((limit - exact).abs() < 4.0 * f64::EPSILON * exact);
        for distance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
            let found = spectrum(1.0 - distance).continuum_gradient_per_height(1.0);
            // The ratio's logarithm changes by about ln 4096 for a unit change of H.
            assert!((found / limit - 1.0).abs() < 10.0 * distance + 1e-14, "{distance}: {found}");
        }
    }

    #[test]
    fn sums_agree_with_the_integrals_where_modes_are_dense() {
        for hurst in [0.1, 0.5, 0.9, 0.999_999] {
            let spectrum = SelfAffine { hurst, first: 10_000, last: 400_000 };
            let (sum, integral) =
                (spectrum.gradient_per_height(1.0), spectrum.continuum_gradient_per_height(1.0));
            assert!((sum / integral - 1.0).abs() < 2e-4, "H = {hurst}: {sum} against {integral}");
        }
    }

    #[test]
    fn a_longer_line_is_flatter() {
        let spectrum = SelfAffine { hurst: 0.7, first: 2, last: 99 };
        for gradient in [SelfAffine::gradient_per_height, SelfAffine::continuum_gradient_per_height] {
            assert_eq!(gradient(&spectrum, 0.25), 4.0 * gradient(&spectrum, 1.0));
        }
    }

    #[test]
    fn sums_keep_what_single_additions_lose() {
        // Each k⁻² is a whole multiple of 2⁻⁹⁰, and so is their sum.
        let unit = 2.0_f64.powi(90);
        for last in [1000, 100_000, 300_000] {
            let exact: u128 = (1..=last).map(|k| ((k as f64).powf(-2.0) * unit) as u128).sum();
            let found = SelfAffine { hurst: 0.5, first: 1, last }.moment(0);
            assert_eq!(found, exact as f64 / unit, "{last}");
        }
        assert_eq!(SelfAffine { hurst: 0.5, first: 3, last: 12 }.moment(2), 10.0);
    }

    #[test]
    fn one_mode_is_a_cosine() {
        let spectrum = SelfAffine { hurst: 0.3, first: 5, last: 5 };
        let expected = std::f64::consts::TAU * 5.0 / 2.0;
        assert!((spectrum.gradient_per_height(2.0) / expected - 1.0).abs() < 1e-15);
        assert_eq!(spectrum.continuum_gradient_per_height(2.0), 0.0);
    }
}
