//! Mean and covariance over the random profiles of a table, at its nodes and between them.

use super::computed::Place;
use super::table::Table;

/// Mean and covariance of two values over the random profiles at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub mean: [f64; 2],
    /// Variance of the first value, covariance, variance of the second value.
    pub covariance: [f64; 3],
}

impl Moments {
    pub fn of(values: &[[f64; 2]]) -> Self {
        let count = values.len() as f64;
        let mean = [0, 1].map(|index| values.iter().map(|value| value[index]).sum::<f64>() / count);
        let product = |one: usize, other: usize| {
            let of = values
                .iter()
                .map(|value| (value[one] - mean[one]) * (value[other] - mean[other]));
            of.sum::<f64>() / (count - 1.0).max(1.0)
        };
        Moments {
            mean,
            covariance: [product(0, 0), product(0, 1), product(1, 1)],
        }
    }

    /// Returns the inverse of the covariance, in the order of the field `covariance`, and the
    /// logarithm of its determinant. A second value that does not vary is ignored.
    pub fn inverse(&self) -> ([f64; 3], f64) {
        let [one, both, other] = self.covariance;
        if other == 0.0 {
            let one = one.max(f64::MIN_POSITIVE);
            return ([1.0 / one, 0.0, 0.0], one.ln());
        }
        let determinant = (one * other - both * both).max(f64::MIN_POSITIVE);
        (
            [other / determinant, -both / determinant, one / determinant],
            determinant.ln(),
        )
    }
}

/// Returns (x − mean)ᵀ Σ⁻¹ (x − mean).
pub(crate) fn distance(mean: [f64; 2], inverse: [f64; 3], at: [f64; 2]) -> f64 {
    let [one, other] = [at[0] - mean[0], at[1] - mean[1]];
    inverse[0] * one * one + 2.0 * inverse[1] * one * other + inverse[2] * other * other
}

/// Mean and covariance over the random profiles at all nodes.
#[derive(Clone)]
pub(crate) struct Scatter {
    ranges: Vec<f64>,
    moduli: Vec<f64>,
    nodes: Vec<Moments>,
}

/// First of the nodes that surround a place, and their weights.
struct Weights<const COUNT: usize> {
    first: usize,
    of: [f64; COUNT],
}

/// Returns the weights of the polynomial through the `COUNT` nearest nodes of an axis, or through
/// all nodes of a shorter axis.
fn weights<const COUNT: usize>(axis: &[f64], at: f64) -> Weights<COUNT> {
    let count = COUNT.min(axis.len());
    let next = axis.partition_point(|node| *node < at);
    let first = next
        .saturating_sub(count.div_ceil(2))
        .min(axis.len() - count);
    let mut of = [0.0; COUNT];
    for (index, weight) in of.iter_mut().enumerate().take(count) {
        let node = axis[first + index];
        let others = (first..first + count).filter(|other| *other != first + index);
        *weight = others
            .map(|other| (at - axis[other]) / (node - axis[other]))
            .product();
    }
    Weights { first, of }
}

impl Scatter {
    /// Computes the moments of two values, which `value` returns for the number of a random profile
    /// and of a node.
    pub fn of(table: &Table, value: impl Fn(usize, usize) -> [f64; 2]) -> Self {
        let node = |node: usize| {
            Moments::of(
                &(0..table.lines.len())
                    .map(|line| value(line, node))
                    .collect::<Vec<_>>(),
            )
        };
        let nodes = (0..table.ranges.len() * table.moduli.len())
            .map(node)
            .collect();
        Scatter {
            ranges: table.ranges.clone(),
            moduli: table.moduli.clone(),
            nodes,
        }
    }

    /// Returns the moments at a place: the mean by cubic interpolation, the covariance by linear
    /// interpolation.
    pub fn at(&self, place: Place) -> Moments {
        let of = |one: usize, other: usize| &self.nodes[one * self.moduli.len() + other];
        let mut moments = Moments {
            mean: [0.0; 2],
            covariance: [0.0; 3],
        };
        let (range, modulus) = (
            weights::<4>(&self.ranges, place.range),
            weights::<4>(&self.moduli, place.modulus),
        );
        for (one, first) in range
            .of
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight != 0.0)
        {
            for (other, second) in modulus
                .of
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0)
            {
                let node = of(range.first + one, modulus.first + other);
                (0..2).for_each(|index| moments.mean[index] += first * second * node.mean[index]);
            }
        }
        let inside = |axis: &[f64], at: f64| at.clamp(axis[0], axis[axis.len() - 1]);
        let range = weights::<2>(&self.ranges, inside(&self.ranges, place.range));
        let modulus = weights::<2>(&self.moduli, inside(&self.moduli, place.modulus));
        for (one, first) in range
            .of
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight != 0.0)
        {
            for (other, second) in modulus
                .of
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0)
            {
                let node = of(range.first + one, modulus.first + other);
                (0..3).for_each(|index| {
                    moments.covariance[index] += first * second * node.covariance[index]
                });
            }
        }
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ensemble::summary::SUMMARIES;

    /// A table whose first summary is a cubic of the place, with a scatter of 1 over two lines.
    fn cubic(place: Place, line: usize) -> f64 {
        place.range.powi(3) - 2.0 * place.range * place.modulus.powi(2)
            + [-0.5, 0.5][line] * place.range
    }

    #[test]
    fn means_are_exact_for_cubics_and_covariances_lie_between_nodes() {
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (
            (0..7).map(|at| 0.5 * f64::from(at)).collect(),
            (0..4).map(|at| 1.0 + 0.3 * f64::from(at)).collect(),
        );
        let mut table = Table {
            ranges,
            moduli,
            lines: Vec::new(),
        };
        let places: Vec<Place> = table.places().collect();
        table.lines = (0..2)
            .map(|line| {
                places
                    .iter()
                    .map(|place| [cubic(*place, line); SUMMARIES])
                    .collect()
            })
            .collect();
        let scatter = Scatter::of(&table, |line, node| [table.lines[line][node][0], 0.0]);
        for (range, modulus) in [(0.1, 1.05), (1.3, 1.6), (2.9, 1.9), (1.5, 1.3)] {
            let place = Place { range, modulus };
            let found = scatter.at(place);
            let expected = range.powi(3) - 2.0 * range * modulus * modulus;
            assert!(
                (found.mean[0] - expected).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            let node = (2.0 * range).floor() / 2.0;
            let square = |at: f64| 0.5 * at * at;
            let between = square(node) + (range - node) / 0.5 * (square(node + 0.5) - square(node));
            assert!(
                (found.covariance[0] - between).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            assert_eq!((found.mean[1], found.covariance[2]), (0.0, 0.0));
        }
    }

    #[test]
    fn the_distance_is_that_of_the_covariance() {
        let values = [[1.0, 2.0], [3.0, 1.0], [2.0, 6.0], [6.0, 3.0]];
        let moments = Moments::of(&values);
        assert_eq!(moments.mean, [3.0, 3.0]);
        let (inverse, determinant) = moments.inverse();
        // The squared distances of n values sum up to their dimension times n − 1.
        let sum: f64 = values
            .iter()
            .map(|value| distance(moments.mean, inverse, *value))
            .sum();
        assert!((sum - 6.0).abs() < 1e-12);
        let [one, both, other] = moments.covariance;
        assert!((determinant.exp() - (one * other - both * both)).abs() < 1e-12);
    }
}
