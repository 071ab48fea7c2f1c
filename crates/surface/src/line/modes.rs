//! Random phases and Fourier coefficients of the modes of a self-affine profile. The phase of a
//! mode depends only on the seed and the mode, and not on the grid, the number of modes or the
//! platform. The coefficients are computed 64 at a time in loops without branches, so that the
//! compiler can use instructions that compute several numbers at once.

use super::spectrum::SelfAffine;
use asperity_fourier::Complex64;
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};

/// Number of modes in a block, which is computed at once. Block b always has the modes 64 b + 1 to
/// 64 b + 64, whichever mode is needed first. The result therefore does not depend on how the modes
/// are divided among threads.
const BLOCK: usize = 64;

/// Number of terms of the power series of (1 + x)^p − 1. For |x| ≤ 1/64 and |p| ≤ 3/2 the first
/// omitted term is below 1e-18. For |x| ≤ 1/1024 six terms are enough.
const TERMS: usize = 10;

/// Coefficients of the minimax approximation of (sin y − y)/y³ by a polynomial in y² for |y| ≤ π/4
/// (1 + 2⁻⁹), lowest power first. The error of the sine is at most 4e-18 in addition to rounding.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_418,
    -0.000_198_412_698_298_123_78,
    2.755_731_369_357_179_7e-6,
    -2.505_075_838_419_456_7e-8,
    1.589_681_178_661_149_6e-10,
];

/// Coefficients of the approximation of (cos y − 1 + y²/2)/y⁴ by a polynomial in y². Range and
/// order are those of [`SINE`].
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_413_1,
    2.480_158_728_948_701e-5,
    -2.755_731_435_378_765_5e-7,
    2.087_572_347_883_230_7e-9,
    -1.135_965_883_378_375_8e-11,
];

/// Random modes of a self-affine profile on a grid. Their Fourier coefficients have the profile as
/// inverse Fourier transform.
#[derive(Clone, Copy, Debug)]
pub(super) struct Modes {
    spectrum: SelfAffine,
    seed: u64,
    /// Half the amplitude that mode 1 would have without a roll-off. Half of it is needed because a
    /// cosine wave is the sum of two complex exponentials with half its amplitude.
    half_amplitude: f64,
    /// Phase of mode 1 at the first point of the grid minus its phase at the beginning of the
    /// profile, in turns (1 is 2π).
    advance: f64,
    /// Coefficients of the power series of (1 + x)^p − 1 in x, where p is the exponent of the
    /// amplitudes.
    series: [f64; TERMS],
}

impl Modes {
    /// Creates the modes of a random profile with the rms height 1, for a spectrum and a seed. Mode
    /// k is the wave with k periods on the profile. The grid has `points` points. Its first point
    /// is at the distance of `start` grid spacings from the beginning of the profile.
    pub fn new(spectrum: SelfAffine, seed: u64, points: usize, start: f64) -> Self {
        let exponent = spectrum.amplitude_exponent();
        let mut binomial = 1.0;
        let series = std::array::from_fn(|index| {
            binomial *= (exponent - index as f64) / (index + 1) as f64;
            binomial
        });
        Modes {
            spectrum,
            seed,
            half_amplitude: 0.5 / spectrum.relative_rms(),
            advance: start / points as f64,
            series,
        }
    }

    /// Computes the Fourier coefficients ½ A_k e^(iφ) of the modes k = `first`, `first` + 1, …, and
    /// stores them in `coefficients`. A_k is the amplitude of the mode, and φ is its phase at the
    /// first point of the grid.
    pub fn draw(&self, first: u64, mut coefficients: &mut [Complex64]) {
        let mut generator = phase_words(self.seed, first);
        let mut words = [0; BLOCK];
        let mut block = [Complex64::ZERO; BLOCK];
        let mut index = first - 1;
        while !coefficients.is_empty() {
            let lane = (index % BLOCK as u64) as usize;
            let lanes = lane..BLOCK.min(lane + coefficients.len());
            let (now, later) = coefficients.split_at_mut(lanes.len());
            words[lanes.clone()].fill_with(|| generator.next_u64());
            self.fill(index - lane as u64, &words, &mut block);
            now.copy_from_slice(&block[lanes.clone()]);
            index += lanes.len() as u64;
            coefficients = later;
        }
    }

    /// Computes the coefficients of the block of modes after the mode `before`. `words` has one
    /// random word for the phase of each mode.
    fn fill(&self, before: u64, words: &[u64; BLOCK], block: &mut [Complex64; BLOCK]) {
        let amplitudes = self.half_amplitudes(before);
        let before = before as f64;
        for (((coefficient, word), amplitude), count) in
            block.iter_mut().zip(words).zip(amplitudes).zip(COUNTS)
        {
            let turns = fraction(*word) + self.advance * (before + count);
            let SineAndCosine { sine, cosine } = sine_and_cosine(turns);
            *coefficient = Complex64::new(amplitude * cosine, amplitude * sine);
        }
    }

    /// Returns half the amplitude of each mode in the block after the mode `before`.
    fn half_amplitudes(&self, before: u64) -> [f64; BLOCK] {
        if (before as f64) < self.spectrum.roll_off_mode {
            return self.half_amplitudes_one_by_one(before);
        }
        match before {
            0..512 => self.half_amplitudes_one_by_one(before),
            512..2048 => self.half_amplitudes_in_series::<16, TERMS>(before),
            2048..32_768 => self.half_amplitudes_in_series::<64, TERMS>(before),
            _ => self.half_amplitudes_in_series::<64, 6>(before),
        }
    }

    fn half_amplitudes_one_by_one(&self, before: u64) -> [f64; BLOCK] {
        std::array::from_fn(|lane| self.half_amplitude(before + 1 + lane as u64))
    }

    /// Returns half the amplitude of each mode in the block after the mode `before`. Groups of
    /// `SPAN` modes are expanded about their middle, with the first `COUNT` terms of the series.
    #[inline(always)]
    fn half_amplitudes_in_series<const SPAN: usize, const COUNT: usize>(
        &self,
        before: u64,
    ) -> [f64; BLOCK] {
        let mut amplitudes = [0.0; BLOCK];
        let mut middle = before + SPAN as u64 / 2;
        for span in amplitudes.as_chunks_mut::<SPAN>().0 {
            let at_middle = self.half_amplitude(middle);
            let inverse = (middle as f64).recip();
            for (amplitude, count) in span.iter_mut().zip(COUNTS) {
                let x = (count - (SPAN / 2) as f64) * inverse;
                *amplitude = at_middle + at_middle * (x * polynomial(&self.series[..COUNT], x));
            }
            middle += SPAN as u64;
        }
        amplitudes
    }

    fn half_amplitude(&self, mode: u64) -> f64 {
        self.half_amplitude * self.spectrum.relative_amplitude(mode)
    }
}

struct SineAndCosine {
    sine: f64,
    cosine: f64,
}

/// Computes the sine and the cosine of 2π `turns`, where `turns` is between 0 and 2.
#[inline(always)]
fn sine_and_cosine(turns: f64) -> SineAndCosine {
    // Adding 3·2⁴¹ moves the number of quarter turns into the lowest bits of the floating-point
    // number, with 10 bits for the fraction of a quarter. The nearest quarter is therefore found
    // with an uncertainty of 2⁻¹⁰, in whatever way the sum is rounded.
    const ALIGN: f64 = 6_597_069_766_656.0;
    let aligned = (4.0 * turns + (ALIGN + 0.5)).to_bits();
    let nearest = f64::from_bits(aligned & !0x3ff) - ALIGN;
    let quarters = aligned >> 10;
    let y = std::f64::consts::TAU * (turns - 0.25 * nearest);
    let z = y * y;
    let sine = (y + y * (z * polynomial(&SINE, z))).to_bits();
    let cosine = (1.0 - (0.5 * z - z * z * polynomial(&COSINE, z))).to_bits();
    // After an odd number of quarter turns, sine and cosine are exchanged. Their signs depend on
    // the quadrant.
    let swap = 0_u64.wrapping_sub(quarters & 1);
    let sine_sign = (quarters & 2) << 62;
    let cosine_sign = (quarters.wrapping_add(1) & 2) << 62;
    let chosen = |unswapped: u64, swapped: u64| (unswapped & !swap) | (swapped & swap);
    SineAndCosine {
        sine: f64::from_bits(chosen(sine, cosine) ^ sine_sign),
        cosine: f64::from_bits(chosen(cosine, sine) ^ cosine_sign),
    }
}

/// Computes Σ c_i x^i for an even number of coefficients. Even and odd powers are summed
/// separately, so that the processor can compute both sums at the same time.
#[inline(always)]
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    let square = x * x;
    let mut pairs = coefficients.as_chunks::<2>().0.iter().rev();
    let [mut even, mut odd] = pairs.next().copied().unwrap_or_default();
    for &[next_even, next_odd] in pairs {
        even = next_even + square * even;
        odd = next_odd + square * odd;
    }
    even + x * odd
}

/// The numbers 1 to 64 as floating-point constants, because the compiler does not vectorise
/// conversions of integers.
const COUNTS: [f64; BLOCK] = {
    let mut counts = [0.0; BLOCK];
    let mut lane = 0;
    while lane < BLOCK {
        counts[lane] = (lane + 1) as f64;
        lane += 1;
    }
    counts
};

/// Part of the key of the random generator. It makes the phases independent of other random numbers
/// with the same seed. If the way in which phases are drawn changes, this text has to change too.
const PURPOSE: &[u8; 24] = b"asperity-line-phases-v1\0";

/// Returns the random phases φ_k in rad, between 0 and 2π, of the modes k = `first`, `first` + 1,
/// …. Mode k is the wave with k periods on the profile.
///
/// The phase of a mode depends only on the seed and on k. The phase is the same, bit for bit, on
/// every platform.
pub fn phases(seed: u64, first: u64) -> impl Iterator<Item = f64> {
    let mut generator = phase_words(seed, first);
    std::iter::repeat_with(move || std::f64::consts::TAU * fraction(generator.next_u64()))
}

/// Returns a random generator for a seed. The next 64-bit words of the generator determine the
/// phases of the modes `first`, `first` + 1, …, one word for each mode.
pub(super) fn phase_words(seed: u64, first: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..].copy_from_slice(PURPOSE);
    let mut generator = ChaCha8Rng::from_seed(key);
    // The position is counted in words of 32 bits, of which each phase takes two.
    generator.set_word_pos(2 * u128::from(first.saturating_sub(1)));
    generator
}

/// Returns the phase of a mode divided by 2π, in [0, 1), from the upper 53 bits of its random word.
///
/// The upper 52 bits become the mantissa of a number from 1 to 2, and 1 is subtracted from this
/// number. The 53rd bit adds half of the last digit. Every processor can do this for several words
/// in one instruction, but few processors can convert several integers to floating-point numbers at
/// once.
#[inline(always)]
pub(super) fn fraction(word: u64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    const HALF_A_DIGIT: u64 = (f64::EPSILON / 2.0).to_bits();
    let upper = f64::from_bits(ONE | (word >> 12)) - 1.0;
    let last = 0_u64.wrapping_sub((word >> 11) & 1);
    upper + f64::from_bits(HALF_A_DIGIT & last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::modes::phases;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn sine_and_cosine_are_within_two_roundings() {
        let mut worst = 0.0_f64;
        for word in (0..200_000_u64).map(|index| index.wrapping_mul(0x9e37_79b9_7f4a_7c15)) {
            let turns = fraction(word) + (word & 1) as f64 * 0.75;
            let SineAndCosine { sine, cosine } = sine_and_cosine(turns);
            // The angle is reduced to an eighth of a turn before its multiplication by 2π, so that
            // the rounding of the product remains negligible.
            let quarters = (4.0 * turns).round();
            let (s, c) = (TAU * (turns - 0.25 * quarters)).sin_cos();
            let expected = [(s, c), (c, -s), (-s, -c), (-c, s)][quarters as usize % 4];
            worst = worst
                .max((sine - expected.0).abs())
                .max((cosine - expected.1).abs());
        }
        assert!(worst <= 2.3e-16, "{worst:e}");
        for quarter in 0..8 {
            let expected = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarter % 4];
            let SineAndCosine { sine, cosine } = sine_and_cosine(0.25 * quarter as f64);
            assert_eq!((sine, cosine), expected);
        }
    }

    #[test]
    fn amplitudes_are_their_powers_to_rounding() {
        for hurst in [1e-300, 0.3, 0.7, 1.0_f64.next_down()] {
            let spectrum = SelfAffine {
                hurst,
                first: 1,
                last: 1,
                roll_off_mode: 0.0,
            };
            let modes = Modes::new(spectrum, 1, 10, 0.5);
            for before in [
                0,
                448,
                512,
                1984,
                2048,
                32_704,
                32_768,
                1 << 20,
                (1 << 27) - 64,
            ] {
                for (mode, amplitude) in (before + 1..).zip(modes.half_amplitudes(before)) {
                    // If mode 1 alone has the amplitude 1, the rms height of the profile is √½.
                    let error =
                        amplitude / (0.5_f64.sqrt() * spectrum.relative_amplitude(mode)) - 1.0;
                    assert!(error.abs() <= 1e-15, "H = {hurst}, mode {mode}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn modes_are_the_same_wherever_drawing_begins_and_on_any_number_of_threads() {
        let spectrum = SelfAffine {
            hurst: 0.7,
            first: 1,
            last: 5000,
            roll_off_mode: 0.0,
        };
        let modes = Modes::new(spectrum, 3, 10_000, 0.5);
        let mut all = vec![Complex64::ZERO; 5000];
        modes.draw(1, &mut all);
        for (mode, (coefficient, phase)) in (1..).zip(all.iter().zip(phases(3, 1))) {
            let amplitude = spectrum.relative_amplitude(mode) / spectrum.relative_rms();
            let expected =
                Complex64::from_polar(0.5 * amplitude, phase + PI * mode as f64 / 10_000.0);
            assert!(
                (coefficient - expected).norm() <= 4e-15 * expected.norm(),
                "mode {mode}"
            );
        }
        for threads in [1, 2, 3, 8] {
            let mut shared = vec![Complex64::ZERO; all.len()];
            let share = all.len().div_ceil(threads);
            std::thread::scope(|scope| {
                for (index, share_of_one) in shared.chunks_mut(share).enumerate() {
                    scope.spawn(move || modes.draw((1 + index * share) as u64, share_of_one));
                }
            });
            assert_eq!(shared, all, "{threads} threads");
        }
        for (first, count) in [
            (1, 0),
            (1, 1),
            (2, 63),
            (64, 1),
            (64, 2),
            (65, 64),
            (100, 4000),
            (4999, 2),
        ] {
            let mut some = vec![Complex64::ZERO; count];
            modes.draw(first as u64, &mut some);
            assert_eq!(
                some,
                all[first - 1..][..count],
                "{count} modes from {first} on"
            );
        }
    }

    #[test]
    fn phases_are_these_for_ever() {
        let bits: Vec<u64> = phases(1, 1).take(4).map(f64::to_bits).collect();
        insta::assert_debug_snapshot!(bits);
    }
}
