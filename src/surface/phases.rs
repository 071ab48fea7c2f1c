//! Random phases of modes: independent of the grid, the number of modes and the platform.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Separates this use of the generator from others; a change of the drawing of phases changes this text.
const PURPOSE: &[u8; 24] = b"asperity-line-phases-v1\0";

/// Phases φ_k of the modes k = `first`, `first` + 1, … of a seed, rad, uniform in [0, 2π).
///
/// The generator is ChaCha with 8 rounds. Its 32-byte key is the seed, little-endian, followed by the
/// 24 ASCII bytes `asperity-line-phases-v1` and a zero; φ_k is the k-th 64-bit word of its stream,
/// counted from k = 1, of which the upper 53 bits are the fraction of 2π. So mode k of a seed has one
/// phase, bit for bit, for every number of springs and of modes and on every platform.
pub fn phases(seed: u64, first: u64) -> impl Iterator<Item = f64> {
    let mut generator = phase_words(seed, first);
    std::iter::repeat_with(move || std::f64::consts::TAU * fraction(generator.next_u64()))
}

/// Generator whose next 64-bit words belong to the modes `first`, `first` + 1, … of a seed.
pub(super) fn phase_words(seed: u64, first: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..].copy_from_slice(PURPOSE);
    let mut generator = ChaCha8Rng::from_seed(key);
    // Two 32-bit words for each phase.
    generator.set_word_pos(2 * u128::from(first.saturating_sub(1)));
    generator
}

/// Phase of a mode over 2π, from 0 to below 1: the upper 53 bits of its word.
///
/// 52 bits become the digits of a number from 1 to 2, the last bit adds half a digit. Any processor computes this
/// for several words in one instruction; few have such an instruction for the conversion of integers.
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

    #[test]
    fn phases_are_these_for_ever() {
        let bits: Vec<u64> = phases(1, 1).take(4).map(f64::to_bits).collect();
        insta::assert_debug_snapshot!(bits);
    }

    #[test]
    fn fractions_are_the_upper_53_bits() {
        let words = [0, 1, (1 << 11) - 1, 1 << 11, 1 << 12, (1 << 63) - 1, 1 << 63, u64::MAX];
        let many = (1..10_000_u64).map(|index| index.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        for word in words.into_iter().chain(many) {
            assert_eq!(fraction(word), (word >> 11) as f64 / (1_u64 << 53) as f64, "{word:#x}");
        }
    }
}
