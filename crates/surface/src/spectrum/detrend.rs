//! Removal of offset, tilt and curvature from heights by least squares.

use crate::topography::surface::Detrend;
use asperity_data::Cholesky;

/// A monomial of the polynomial: the exponents of x and y.
#[derive(Clone, Copy)]
struct Monomial {
    x: i32,
    y: i32,
}

impl Detrend {
    /// Returns the monomials of the polynomial that is removed from a profile or a map.
    fn monomials(self, is_map: bool) -> Vec<Monomial> {
        let degrees = match self {
            Detrend::None => 0..0,
            Detrend::Mean => 0..1,
            Detrend::Tilt => 0..2,
            Detrend::Curvature => 0..3,
        };
        let mut monomials = Vec::new();
        for degree in degrees {
            let largest_y = if is_map { degree } else { 0 };
            for y in 0..=largest_y {
                monomials.push(Monomial { x: degree - y, y });
            }
        }
        monomials
    }

    /// Removes the least-squares polynomial from heights, which are in rows of `columns` points.
    pub(crate) fn remove(self, heights: &mut [f64], columns: usize) {
        let columns = columns.max(1);
        let rows = heights.len() / columns;
        let monomials = self.monomials(rows > 1);
        if monomials.is_empty() {
            return;
        }
        let Some(&level) = heights.first() else {
            return;
        };
        // The first height is subtracted: a large offset would increase the rounding errors of the
        // sums.
        for height in heights.iter_mut() {
            *height -= level;
        }
        let matrix = normal_matrix(&monomials, columns, rows);
        let right = right_side(&monomials, heights, columns);
        let Some(factor) = Cholesky::new(matrix, monomials.len()) else {
            return;
        };
        let coefficients = factor.solve(right);
        for (row, heights) in heights.chunks_exact_mut(columns).enumerate() {
            let y = place(row, rows);
            for (column, height) in heights.iter_mut().enumerate() {
                let x = place(column, columns);
                let polynomial: f64 = coefficients
                    .iter()
                    .zip(&monomials)
                    .map(|(coefficient, power)| coefficient * x.powi(power.x) * y.powi(power.y))
                    .sum();
                *height -= polynomial;
            }
        }
    }
}

/// Returns the coordinate of a point along an axis, from −1 to 1. With such coordinates all their
/// powers have a similar size, so that the rounding errors of the solution remain small.
fn place(index: usize, count: usize) -> f64 {
    2.0 * index as f64 / (count.max(2) - 1) as f64 - 1.0
}

/// Returns the sums of the powers 0 to 4 of the coordinates of all points along an axis.
fn sums_of_powers(count: usize) -> [f64; 5] {
    std::array::from_fn(|power| {
        (0..count)
            .map(|index| place(index, count).powi(power as i32))
            .sum()
    })
}

/// Returns the matrix of the normal equations. Its elements are sums over all points of the grid,
/// and each is the product of a sum along the rows and a sum along the columns.
fn normal_matrix(monomials: &[Monomial], columns: usize, rows: usize) -> Vec<f64> {
    let along = sums_of_powers(columns);
    let between = sums_of_powers(rows);
    let mut matrix = Vec::new();
    for a in monomials {
        for b in monomials {
            let x = (a.x + b.x) as usize;
            let y = (a.y + b.y) as usize;
            matrix.push(along[x] * between[y]);
        }
    }
    matrix
}

/// Returns the right-hand side of the normal equations.
fn right_side(monomials: &[Monomial], heights: &[f64], columns: usize) -> Vec<f64> {
    let rows = heights.len() / columns;
    let mut right = vec![0.0; monomials.len()];
    for (row, heights) in heights.chunks_exact(columns).enumerate() {
        let y = place(row, rows);
        // Sums, along the row, of the height times x⁰, x¹ and x².
        let sums: [f64; 3] = std::array::from_fn(|power| {
            let terms = heights.iter().enumerate();
            terms
                .map(|(column, z)| z * place(column, columns).powi(power as i32))
                .sum()
        });
        for (value, power) in right.iter_mut().zip(monomials) {
            *value += sums[power.x as usize] * y.powi(power.y);
        }
    }
    right
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
