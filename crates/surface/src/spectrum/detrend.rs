//! Removal of offset, tilt and curvature by least squares.

use crate::topography::surface::Detrend;
use asperity_data::Cholesky;

impl Detrend {
    /// Returns the exponents of x and y of the monomials that are removed from a profile or a map.
    fn monomials(self, is_map: bool) -> Vec<[i32; 2]> {
        let degrees = match self {
            Detrend::None => 0..0,
            Detrend::Mean => 0..1,
            Detrend::Tilt => 0..2,
            Detrend::Curvature => 0..3,
        };
        let of_degree = |degree: i32| (0..=degree).map(move |y| [degree - y, y]);
        degrees
            .flat_map(of_degree)
            .filter(|[_, y]| is_map || *y == 0)
            .collect()
    }

    /// Removes the least-squares polynomial from heights in rows of `columns` points.
    pub(crate) fn remove(self, heights: &mut [f64], columns: usize) {
        let rows = heights.len() / columns.max(1);
        let monomials = self.monomials(rows > 1);
        // From −1 to 1, and relative to the first height: powers and sums keep their digits.
        let place =
            |index: usize, count: usize| 2.0 * index as f64 / (count.max(2) - 1) as f64 - 1.0;
        let level = heights
            .first()
            .copied()
            .filter(|_| !monomials.is_empty())
            .unwrap_or_default();
        heights.iter_mut().for_each(|height| *height -= level);
        // Sums over the grid are products of sums along its axes.
        let powers = |count: usize| -> [f64; 5] {
            std::array::from_fn(|power| {
                (0..count)
                    .map(|index| place(index, count).powi(power as i32))
                    .sum()
            })
        };
        let (along, between) = (powers(columns), powers(rows));
        let size = monomials.len();
        let mut matrix = vec![0.0; size * size];
        for (row, a) in monomials.iter().enumerate() {
            for (column, b) in monomials.iter().enumerate() {
                let [x, y] = [0, 1].map(|axis| (a[axis] + b[axis]) as usize);
                matrix[row * size + column] = along[x] * between[y];
            }
        }
        let mut right = vec![0.0; size];
        for (row, heights) in heights.chunks_exact(columns.max(1)).enumerate() {
            let y = place(row, rows);
            let sums: [f64; 3] = std::array::from_fn(|power| {
                let terms = heights
                    .iter()
                    .enumerate()
                    .map(|(column, z)| z * place(column, columns).powi(power as i32));
                terms.sum()
            });
            for (value, [a, b]) in right.iter_mut().zip(&monomials) {
                *value += sums[*a as usize] * y.powi(*b);
            }
        }
        let Some(factor) = Cholesky::new(matrix, size) else {
            return;
        };
        let coefficients = factor.solve(right);
        for (row, heights) in heights.chunks_exact_mut(columns.max(1)).enumerate() {
            let y = place(row, rows);
            for (column, height) in heights.iter_mut().enumerate() {
                let x = place(column, columns);
                let terms = coefficients
                    .iter()
                    .zip(&monomials)
                    .map(|(c, [a, b])| c * x.powi(*a) * y.powi(*b));
                *height -= terms.sum::<f64>();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_removed_and_nothing_else() {
        let (columns, rows) = (20, 15);
        let surface = |polynomial: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            (0..columns * rows)
                .map(|i| polynomial((i % columns) as f64, (i / columns) as f64))
                .collect()
        };
        for (detrend, polynomial) in [
            (Detrend::Mean, &(|_, _| 1e6) as &dyn Fn(f64, f64) -> f64),
            (Detrend::Tilt, &|x, y| 3.0 + 2.0 * x - y),
            (Detrend::Curvature, &|x, y| {
                1.0 - x + 0.1 * x * x + 0.2 * x * y - 0.3 * y * y
            }),
        ] {
            let mut heights = surface(polynomial);
            detrend.remove(&mut heights, columns);
            let largest = heights
                .iter()
                .fold(0.0_f64, |largest, z| largest.max(z.abs()));
            assert!(largest < 1e-11, "{detrend:?}: {largest}");
            let mut profile: Vec<f64> = (0..columns).map(|i| polynomial(i as f64, 0.0)).collect();
            detrend.remove(&mut profile, columns);
            assert!(
                profile.iter().all(|z| z.abs() < 1e-11),
                "{detrend:?}: {profile:?}"
            );
        }
        let wave = surface(&|x, y| (0.7 * x + 0.3 * y).sin());
        for detrend in [Detrend::Mean, Detrend::Tilt, Detrend::Curvature] {
            let mut once = wave.clone();
            detrend.remove(&mut once, columns);
            let mut twice = once.clone();
            detrend.remove(&mut twice, columns);
            assert!(
                once.iter().zip(&twice).all(|(a, b)| (a - b).abs() < 1e-13),
                "{detrend:?}"
            );
            assert!(once.iter().map(|z| z * z).sum::<f64>() <= wave.iter().map(|z| z * z).sum());
        }
        let mut same = wave.clone();
        Detrend::None.remove(&mut same, columns);
        assert_eq!(same, wave);
    }
}
