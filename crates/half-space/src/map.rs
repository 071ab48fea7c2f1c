//! Isotropic random surfaces with a given spectrum.

use super::error::HalfSpaceError;
use asperity_data::resized;
use asperity_fourier::{Complex64, plan_inverse};
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Makes the heights of a random isotropic surface on a square of `cells` × `cells` points, row by
/// row.
///
/// The surface is a sum of waves with k_x periods along one side and k_y periods along the other.
/// `variance`(k) with k = √(k_x² + k_y²) is the contribution of one wave to the mean square height.
/// The heights are in m if `variance` returns m². With the same `seed` and more cells, the surface
/// has the same waves and additional shorter waves.
///
/// # Errors
/// Returns an error if the heights do not fit into memory.
pub fn random_map(
    cells: usize,
    variance: impl Fn(f64) -> f64,
    seed: u64,
) -> Result<Vec<f64>, HalfSpaceError> {
    let mut waves = resized(Vec::new(), cells * cells, Complex64::default())?;
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let half = cells as i64 / 2;
    // Waves with half as many periods as cells along a side have no phase, so they are left out.
    for shell in 1..half {
        for (x, y) in half_shell(shell) {
            let phase = TAU * (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
            // A pair of opposite waves is one cosine, and the mean square of a cosine is half of
            // its squared amplitude.
            let amplitude = 2.0 * variance((x as f64).hypot(y as f64)).sqrt();
            let column = x.rem_euclid(cells as i64) as usize;
            let row = y.rem_euclid(cells as i64) as usize;
            waves[row * cells + column] = Complex64::from_polar(amplitude, phase);
        }
    }
    let plan = plan_inverse(cells);
    let mut scratch = resized(
        Vec::new(),
        plan.get_inplace_scratch_len(),
        Complex64::default(),
    )?;
    plan.process_with_scratch(&mut waves, &mut scratch);
    let mut column = resized(Vec::new(), cells, Complex64::default())?;
    let mut heights = resized(Vec::new(), cells * cells, 0.0)?;
    for x in 0..cells {
        for (y, value) in column.iter_mut().enumerate() {
            *value = waves[y * cells + x];
        }
        plan.process_with_scratch(&mut column, &mut scratch);
        for (y, value) in column.iter().enumerate() {
            heights[y * cells + x] = value.re;
        }
    }
    Ok(heights)
}

/// Lists the wave numbers (k_x, k_y) of one half of a shell, the boundary of a square of wave
/// numbers. The other half of the shell consists of the opposite waves.
fn half_shell(shell: i64) -> impl Iterator<Item = (i64, i64)> {
    let side = (1 - shell..=shell).map(move |y| (shell, y));
    let top = (1 - shell..=shell).map(move |x| (-x, shell));
    side.chain(top)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_has_its_spectrum_and_is_refined_by_more_cells() {
        let variance = |k: f64| {
            if (1.0..=6.0).contains(&k) {
                k.powf(-3.6)
            } else {
                0.0
            }
        };
        let coarse = random_map(32, variance, 7).unwrap();
        let fine = random_map(64, variance, 7).unwrap();
        let expected: f64 = (-16..=16_i32)
            .flat_map(|x| (-16..=16_i32).map(move |y| (x, y)))
            .filter(|wave| *wave != (0, 0))
            .map(|(x, y)| variance(f64::from(x).hypot(f64::from(y))))
            .sum();
        let squares: f64 = coarse.iter().map(|height| height * height).sum();
        let mean_square = squares / coarse.len() as f64;
        assert!(
            (mean_square / expected - 1.0).abs() < 1e-12,
            "{mean_square} {expected}"
        );
        for (index, height) in coarse.iter().enumerate() {
            let index_of_fine = index / 32 * 2 * 64 + index % 32 * 2;
            assert!((height - fine[index_of_fine]).abs() < 1e-12);
        }
        assert_ne!(random_map(32, variance, 8).unwrap(), coarse);
        // On average over many maps the surface is isotropic: the gradients along x and y are
        // equal.
        let mut along_x = 0.0;
        let mut along_y = 0.0;
        for seed in 0..40 {
            let map = random_map(32, variance, seed).unwrap();
            for index in 0..31 * 32 {
                if index % 32 < 31 {
                    along_x += (map[index + 1] - map[index]).powi(2);
                }
                along_y += (map[index + 32] - map[index]).powi(2);
            }
        }
        assert!(
            (along_x / along_y - 1.0).abs() < 0.05,
            "{along_x} {along_y}"
        );
    }
}
