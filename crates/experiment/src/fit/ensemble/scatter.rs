//! Mean and covariance of two values over the random profiles of a table, at its nodes and between
//! them.

use super::table::{Place, Table};

/// Signed binomial coefficients of a difference of sixth order. A smooth function has a small
/// difference of this order.
const DIFFERENCE: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
/// Sum of the squares of the coefficients [`DIFFERENCE`]. If the errors of the values are
/// independent, the variance of the difference is this number times the variance of a value.
const SQUARES: f64 = 924.0;
/// Ratio above which the differences of the means count as errors that all profiles have in common:
/// the mean square of these differences, divided by the mean square that they would have if the
/// differences of the profiles were independent.
const LEAST_COMMON: f64 = 4.0;
/// Number of differences on each side of a node over which the mean square for this node is
/// averaged.
const NEAR: usize = 3;

/// Mean and covariance of two values over the random profiles at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub mean: [f64; 2],
    /// Covariance matrix of the two values: variance of the first value, covariance, and variance
    /// of the second value.
    pub covariance: [f64; 3],
}

/// Inverse of a covariance matrix of two values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InverseCovariance {
    /// Elements of the inverse matrix, in the order of [`Moments::covariance`].
    elements: [f64; 3],
    /// Logarithm of the determinant of the covariance matrix.
    pub log_determinant: f64,
}

impl Moments {
    pub fn of(values: &[[f64; 2]]) -> Self {
        let count = values.len() as f64;
        let mean = [0, 1].map(|index| values.iter().map(|value| value[index]).sum::<f64>() / count);
        let product = |first: usize, second: usize| {
            let products = values
                .iter()
                .map(|value| (value[first] - mean[first]) * (value[second] - mean[second]));
            products.sum::<f64>() / (count - 1.0).max(1.0)
        };
        Moments {
            mean,
            covariance: [product(0, 0), product(0, 1), product(1, 1)],
        }
    }

    /// Returns the same mean with another covariance matrix: the present one times `factor`, plus
    /// `errors`.
    pub fn with_errors(&self, factor: f64, errors: [f64; 3]) -> Self {
        let mut covariance = errors;
        for (sum, own) in covariance.iter_mut().zip(self.covariance) {
            *sum += factor * own;
        }
        Moments {
            mean: self.mean,
            covariance,
        }
    }

    /// Returns the inverse of the covariance matrix. The inverse ignores the second value if this
    /// value does not vary, as ln E* for a given E*.
    pub fn inverse(&self) -> InverseCovariance {
        let [first, both, second] = self.covariance;
        if second == 0.0 {
            let first = first.max(f64::MIN_POSITIVE);
            return InverseCovariance {
                elements: [1.0 / first, 0.0, 0.0],
                log_determinant: first.ln(),
            };
        }
        let determinant = (first * second - both * both).max(f64::MIN_POSITIVE);
        InverseCovariance {
            elements: [
                second / determinant,
                -both / determinant,
                first / determinant,
            ],
            log_determinant: determinant.ln(),
        }
    }
}

impl InverseCovariance {
    /// Returns the squared Mahalanobis distance (x − mean)ᵀ Σ⁻¹ (x − mean), where x are the
    /// `values` and Σ is the covariance matrix.
    pub fn squared_distance(&self, mean: [f64; 2], values: [f64; 2]) -> f64 {
        let [first, both, second] = self.elements;
        let x = values[0] - mean[0];
        let y = values[1] - mean[1];
        first * x * x + 2.0 * both * x * y + second * y * y
    }

    /// Returns the product Σ⁻¹ x, where x are the `values` and Σ is the covariance matrix.
    pub fn times(&self, values: [f64; 2]) -> [f64; 2] {
        let [first, both, second] = self.elements;
        let [x, y] = values;
        [first * x + both * y, both * x + second * y]
    }
}

/// Mean and covariance of two values over the random profiles, at each node of a table.
#[derive(Clone)]
pub(crate) struct Scatter {
    ranges: Vec<f64>,
    moduli: Vec<f64>,
    nodes: Vec<Moments>,
    /// Covariance, at each value of ln(γ/E*), of those errors of the means that all profiles have
    /// in common.
    unevenness: Vec<[f64; 3]>,
}

/// Weights for the interpolation along an axis. `first` is the index of the first node with a
/// weight.
struct Weights<const COUNT: usize> {
    first: usize,
    weights: [f64; COUNT],
}

impl<const COUNT: usize> Weights<COUNT> {
    /// Returns the weights of the polynomial through the `COUNT` nearest nodes of an axis, or
    /// through all nodes of a shorter axis.
    fn new(axis: &[f64], place: f64) -> Self {
        let count = COUNT.min(axis.len());
        let next = axis.partition_point(|node| *node < place);
        let first = next
            .saturating_sub(count.div_ceil(2))
            .min(axis.len() - count);
        let mut weights = [0.0; COUNT];
        for (index, weight) in weights.iter_mut().enumerate().take(count) {
            let node = axis[first + index];
            let others = (first..first + count).filter(|other| *other != first + index);
            *weight = others
                .map(|other| (place - axis[other]) / (node - axis[other]))
                .product();
        }
        Weights { first, weights }
    }
}

impl Scatter {
    /// Computes the means and covariances of two values over the random profiles, at each node. A
    /// node is a pair of values for which curves were computed. `value` returns the two values from
    /// the index of a random profile and the index of a node.
    pub fn of(table: &Table, value: impl Fn(usize, usize) -> [f64; 2]) -> Self {
        let count = table.ranges.len() * table.moduli.len();
        let mut values: Vec<Vec<[f64; 2]>> = Vec::with_capacity(count);
        for node in 0..count {
            let profiles = 0..table.profiles.len();
            values.push(profiles.map(|profile| value(profile, node)).collect());
        }
        Scatter {
            ranges: table.ranges.clone(),
            moduli: table.moduli.clone(),
            nodes: values.iter().map(|values| Moments::of(values)).collect(),
            unevenness: unevenness(&values, table.ranges.len(), table.moduli.len()),
        }
    }

    /// Computes the mean and the variance of one summary over the random profiles, at each node.
    /// `index` is the index of the summary. The second value is 0.
    pub fn of_summary(table: &Table, index: usize) -> Self {
        Scatter::of(table, |profile, node| {
            [table.profiles[profile][node][index], 0.0]
        })
    }

    /// Returns the mean and the covariance at a place between the nodes, a pair of ln(γ/E*) and ln
    /// E*. The mean is interpolated by cubic polynomials, and the covariance linearly.
    pub fn at(&self, place: Place) -> Moments {
        let mut moments = Moments {
            mean: [0.0; 2],
            covariance: [0.0; 3],
        };
        self.interpolate::<4>(place, |weight, node| {
            for (sum, mean) in moments.mean.iter_mut().zip(node.mean) {
                *sum += weight * mean;
            }
        });
        let inside = Place {
            range: clamp_to(&self.ranges, place.range),
            modulus: clamp_to(&self.moduli, place.modulus),
        };
        self.interpolate::<2>(inside, |weight, node| {
            for (sum, covariance) in moments.covariance.iter_mut().zip(node.covariance) {
                *sum += weight * covariance;
            }
        });
        moments
    }

    /// Returns the covariance that the distances between the points of a curve cause, in the
    /// difference between the values of the curve and the interpolated means at a place. Nothing is
    /// known between two points of a curve. If all profiles have nearly the same curve, the
    /// summaries therefore change in steps with the parameters. Both the curve and the means have
    /// such steps. The differences between random profiles are not included.
    pub fn error_of_steps(&self, place: Place) -> [f64; 3] {
        let inside = clamp_to(&self.ranges, place.range);
        let Weights { first, weights } = Weights::<2>::new(&self.ranges, inside);
        let mut sums = [0.0; 3];
        for (index, weight) in weights.iter().enumerate() {
            if *weight == 0.0 {
                continue;
            }
            for (sum, variance) in sums.iter_mut().zip(self.unevenness[first + index]) {
                *sum += 2.0 * weight * variance;
            }
        }
        sums
    }

    /// Calls `add` with the weight and the moments of each node around a place. There are `COUNT`
    /// such nodes along each axis.
    fn interpolate<const COUNT: usize>(&self, place: Place, mut add: impl FnMut(f64, &Moments)) {
        let ranges = Weights::<COUNT>::new(&self.ranges, place.range);
        let moduli = Weights::<COUNT>::new(&self.moduli, place.modulus);
        for (range, of_range) in ranges.weights.iter().enumerate() {
            if *of_range == 0.0 {
                continue;
            }
            let row = (ranges.first + range) * self.moduli.len();
            for (modulus, of_modulus) in moduli.weights.iter().enumerate() {
                if *of_modulus != 0.0 {
                    let node = &self.nodes[row + moduli.first + modulus];
                    add(of_range * of_modulus, node);
                }
            }
        }
    }
}

/// Returns the covariance at each range of those errors of the means that all profiles have in
/// common. `values` has the values of all profiles at each node. The errors follow from differences
/// of sixth order along the ranges, which the smooth part of the means hardly has. An axis of fewer
/// nodes than [`DIFFERENCE`] gives no errors.
fn unevenness(values: &[Vec<[f64; 2]>], ranges: usize, moduli: usize) -> Vec<[f64; 3]> {
    let count = (ranges + 1).saturating_sub(DIFFERENCE.len());
    let mut errors = vec![[0.0; 3]; ranges];
    if count == 0 {
        return errors;
    }
    let mut of_windows = vec![Steps::default(); count];
    for (first, steps) in of_windows.iter_mut().enumerate() {
        for modulus in 0..moduli {
            let nodes = (first..).map(|range| &values[range * moduli + modulus]);
            let nodes: Vec<&Vec<[f64; 2]>> = nodes.take(DIFFERENCE.len()).collect();
            steps.add(&Steps::of(&nodes));
        }
    }
    for (node, error) in errors.iter_mut().enumerate() {
        let centre = node.saturating_sub(DIFFERENCE.len() / 2).min(count - 1);
        let near = &of_windows[centre.saturating_sub(NEAR)..(centre + NEAR + 1).min(count)];
        let mut sum = Steps::default();
        for steps in near {
            sum.add(steps);
        }
        *error = sum.common(SQUARES * (near.len() * moduli) as f64);
    }
    errors
}

/// Squares and product of the differences of two values along the ranges, in the order of
/// [`Moments::covariance`].
#[derive(Clone, Default)]
struct Steps {
    /// Squares and product for the mean over the profiles.
    of_mean: [f64; 3],
    /// Squares and product that are expected for the mean if the differences of the profiles are
    /// independent of each other.
    by_profiles: [f64; 3],
}

impl Steps {
    /// Computes the squares and the product for one difference. `nodes` has the values of all
    /// profiles at each node of this difference.
    fn of(nodes: &[&Vec<[f64; 2]>]) -> Self {
        let mut differences = vec![[0.0; 2]; nodes[0].len()];
        for (coefficient, values) in DIFFERENCE.iter().zip(nodes) {
            for (difference, value) in differences.iter_mut().zip(values.iter()) {
                difference[0] += coefficient * value[0];
                difference[1] += coefficient * value[1];
            }
        }
        let Moments { mean, covariance } = Moments::of(&differences);
        let profiles = differences.len() as f64;
        Steps {
            of_mean: [mean[0] * mean[0], mean[0] * mean[1], mean[1] * mean[1]],
            by_profiles: covariance.map(|element| element / profiles),
        }
    }

    fn add(&mut self, other: &Steps) {
        for index in 0..3 {
            self.of_mean[index] += other.of_mean[index];
            self.by_profiles[index] += other.by_profiles[index];
        }
    }

    /// Returns the covariance of the errors that all profiles have in common. The sums of squares
    /// and products are `scale` times this covariance. If the differences of a value can be
    /// explained by independent profiles, its error is 0, because the covariance over the profiles
    /// contains such differences already.
    fn common(&self, scale: f64) -> [f64; 3] {
        let mut errors = [0.0; 3];
        for (index, error) in errors.iter_mut().enumerate() {
            *error = (self.of_mean[index] - self.by_profiles[index]) / scale;
        }
        for index in [0, 2] {
            if self.of_mean[index] <= LEAST_COMMON * self.by_profiles[index] {
                errors[index] = 0.0;
            }
        }
        let most = (errors[0] * errors[2]).sqrt();
        errors[1] = errors[1].clamp(-most, most);
        errors
    }
}

fn clamp_to(axis: &[f64], place: f64) -> f64 {
    place.clamp(axis[0], axis[axis.len() - 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ensemble::summary::SUMMARIES;

    /// Returns the first summary of a profile, which is a cubic polynomial of the place. The
    /// summaries of the two profiles differ by the range.
    fn cubic(place: Place, profile: usize) -> f64 {
        place.range.powi(3) - 2.0 * place.range * place.modulus.powi(2)
            + [-0.5, 0.5][profile] * place.range
    }

    #[test]
    fn means_are_exact_for_cubics_and_covariances_lie_between_nodes() {
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (
            (0..7).map(|index| 0.5 * f64::from(index)).collect(),
            (0..4).map(|index| 1.0 + 0.3 * f64::from(index)).collect(),
        );
        let mut table = Table {
            ranges,
            moduli,
            profiles: Vec::new(),
        };
        let places: Vec<Place> = table.places();
        table.profiles = (0..2)
            .map(|profile| {
                places
                    .iter()
                    .map(|place| [cubic(*place, profile); SUMMARIES])
                    .collect()
            })
            .collect();
        let scatter = Scatter::of(&table, |profile, node| {
            [table.profiles[profile][node][0], 0.0]
        });
        for (range, modulus) in [(0.1, 1.05), (1.3, 1.6), (2.9, 1.9), (1.5, 1.3)] {
            let place = Place { range, modulus };
            let found = scatter.at(place);
            let expected = range.powi(3) - 2.0 * range * modulus * modulus;
            assert!(
                (found.mean[0] - expected).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            let node = (2.0 * range).floor() / 2.0;
            let square = |value: f64| 0.5 * value * value;
            let between = square(node) + (range - node) / 0.5 * (square(node + 0.5) - square(node));
            assert!(
                (found.covariance[0] - between).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            assert_eq!((found.mean[1], found.covariance[2]), (0.0, 0.0));
        }
    }

    /// A value that is rounded to the distances between the points of a curve changes in steps with
    /// the parameters. If all profiles have the same steps, the variance of the rounding error is
    /// found. If each profile has steps of its own, they belong to the scatter over the profiles.
    #[test]
    fn steps_that_all_profiles_have_are_errors_of_the_means() {
        let step = 0.013;
        let deviation = step / 12.0_f64.sqrt();
        let stepped = |value: f64| (value / step).round() * step;
        let profiles = 64_u16;
        let ranges: Vec<f64> = (0..16).map(|node| 0.2 * f64::from(node) - 1.5).collect();
        let moduli: Vec<f64> = (0..4).map(|node| 0.462 * f64::from(node)).collect();
        let nodes = ranges.len() * moduli.len();
        let table = Table {
            ranges,
            moduli,
            profiles: vec![vec![[0.0; SUMMARIES]; nodes]; usize::from(profiles)],
        };
        let places = table.places();
        let smooth = |place: Place| (0.7 * place.range).sin() + 0.3 * place.modulus;
        let error_of = |value: &dyn Fn(usize, Place) -> f64| {
            let scatter = Scatter::of(&table, |profile, node| [value(profile, places[node]), 0.0]);
            let mut sum = 0.0;
            for place in &places {
                let [first, both, second] = scatter.error_of_steps(*place);
                assert!(first >= 0.0 && both == 0.0 && second == 0.0);
                sum += first / nodes as f64;
            }
            sum.sqrt() / deviation
        };
        let common = error_of(&|_, place| stepped(smooth(place)));
        assert!((common / 2.0_f64.sqrt() - 1.0).abs() < 0.25, "{common}");
        let own = error_of(&|profile, place| {
            let offset = (profile as f64 * 0.754_877).fract();
            stepped(smooth(place) + 10.0 * step * offset)
        });
        assert!(own < 0.25, "{own}");
        let none = error_of(&|profile, place| smooth(place) + 1e-3 * profile as f64);
        assert!(none < 0.01, "{none}");
    }

    #[test]
    fn the_distance_is_that_of_the_covariance() {
        let values = [[1.0, 2.0], [3.0, 1.0], [2.0, 6.0], [6.0, 3.0]];
        let moments = Moments::of(&values);
        assert_eq!(moments.mean, [3.0, 3.0]);
        let inverse = moments.inverse();
        // The squared Mahalanobis distances of n points sum up to (n − 1) times their dimension.
        let sum: f64 = values
            .iter()
            .map(|value| inverse.squared_distance(moments.mean, *value))
            .sum();
        assert!((sum - 6.0).abs() < 1e-12);
        let [one, both, other] = moments.covariance;
        assert!((inverse.log_determinant.exp() - (one * other - both * both)).abs() < 1e-12);
    }
}
