//! Random phases that belong to modes: the same for every grid, number of modes and platform.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Tells this use of the generator from any other; a change of how phases are drawn changes it.
const PURPOSE: &[u8; 24] = b"asperity-line-phases-v1\0";

/// Phases φ_k of the modes k = `first`, `first` + 1, … of a seed, rad, uniform in [0, 2π).
///
/// The generator is ChaCha with 8 rounds. Its 32-byte key is the seed, little-endian, followed by the
/// 24 ASCII bytes `asperity-line-phases-v1` and a zero; φ_k is the k-th 64-bit word of its stream,
/// counted from k = 1, of which the upper 53 bits are the fraction of 2π. So mode k of a seed has one
/// phase, bit for bit, for every number of springs and of modes and on every platform.
pub fn phases(seed: u64, first: u64) -> impl Iterator<Item = f64> {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..].copy_from_slice(PURPOSE);
    let mut generator = ChaCha8Rng::from_seed(key);
    // Two 32-bit words for each phase.
    generator.set_word_pos(2 * u128::from(first.saturating_sub(1)));
    std::iter::repeat_with(move || {
        let fraction = (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        std::f64::consts::TAU * fraction
    })
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
    fn a_mode_keeps_its_phase() {
        let all: Vec<f64> = phases(7, 1).take(50).collect();
        for first in [2, 9, 17, 40] {
            let some: Vec<f64> = phases(7, first).take(5).collect();
            assert_eq!(some, all[first as usize - 1..][..5]);
        }
        assert_ne!(all[..5], phases(8, 1).take(5).collect::<Vec<_>>());
        assert!(all.iter().all(|phase| (0.0..std::f64::consts::TAU).contains(phase)));
    }
}
