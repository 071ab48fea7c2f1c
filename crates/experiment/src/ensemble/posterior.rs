//! The probability of the parameters from the mean prediction over the measured curves.

use super::computed::Place;
use super::scatter::{Moments, Scatter, distance};
use super::table::{End, Table};

/// Steps of the fine grid in ln(γ/E*) and ln E*, and in ln(γ/E*) alone.
const STEPS: [f64; 2] = [0.01, 0.0125];
const STEP_ALONE: f64 = 0.002;
/// Share of the probability within `EDGE` of an end of the table, above which the table is too short.
const MOST_AT_END: f64 = 2e-3;
const EDGE: f64 = 0.1;
/// Quantiles of the result and of its 95 % interval.
const QUANTILES: [f64; 3] = [0.025, 0.5, 0.975];

/// Estimate of the work of adhesion in J/m² or of the effective modulus in Pa, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct IntervalEstimate {
    /// Estimated value: the median of the probability distribution of the parameter.
    pub value: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
}

impl IntervalEstimate {
    /// Returns half the width of the interval on the scale of the natural logarithm, ½ ln(high/low).
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high / self.low).ln()
    }

    pub(crate) fn known(value: f64) -> Self {
        IntervalEstimate { value, low: value, high: value }
    }

    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        IntervalEstimate { value: of(self.value), low: of(self.low), high: of(self.high) }
    }

    /// Adds further errors in quadrature, given as the half-width of a 95 % interval of the natural logarithm.
    pub(crate) fn widened(self, half_width: f64) -> Self {
        let factor = |end: f64| (end / self.value).ln().hypot(half_width).exp();
        IntervalEstimate {
            value: self.value,
            low: self.value / factor(self.low),
            high: self.value * factor(self.high),
        }
    }
}

/// Moments of the table at the places of a fine grid.
pub(crate) struct Grid {
    places: Vec<(Place, Moments, [f64; 3], f64)>,
    ends: [f64; 4],
    /// Number of random profiles of the table.
    lines: f64,
}

/// Probability of each place of a grid.
pub(crate) struct Posterior<'g> {
    grid: &'g Grid,
    weights: Vec<f64>,
}

impl Grid {
    /// Makes a grid over the table, or along a known ln E*.
    pub fn new(table: &Table, scatter: &Scatter, known: Option<f64>) -> Self {
        let ends = |axis: &[f64]| [axis[0], axis[axis.len() - 1]];
        let ([low, high], [soft, hard]) = (ends(&table.ranges), ends(&table.moduli));
        let along = |low: f64, high: f64, step: f64| {
            let count = ((high - low) / step).ceil().max(1.0) as usize;
            (0..=count).map(move |index| low + (high - low) * index as f64 / count as f64)
        };
        let at = |range: f64, modulus: f64| {
            let place = Place { range, modulus };
            let moments = scatter.at(place);
            let (inverse, determinant) = moments.inverse();
            (place, moments, inverse, determinant)
        };
        let places = match known {
            Some(modulus) => along(low, high, STEP_ALONE).map(|range| at(range, modulus)).collect(),
            None => along(low, high, STEPS[0])
                .flat_map(|range| along(soft, hard, STEPS[1]).map(move |modulus| at(range, modulus)))
                .collect(),
        };
        Grid { places, ends: [low, high, soft, hard], lines: table.lines.len() as f64 }
    }

    /// Returns the probability of the parameters if the mean prediction over `curves` curves is `at`. The prior is flat
    /// over ln γ and ln E*. The error of the mean comes from the number of curves and from the number of random profiles. A
    /// power in place of an exponential allows for the uncertain covariance of few profiles (Student's t-distribution).
    pub fn posterior(&self, at: [f64; 2], curves: f64) -> Posterior<'_> {
        let variance = 1.0 / curves + 1.0 / self.lines;
        let logarithm = |(_, moments, inverse, determinant): &(Place, Moments, [f64; 3], f64)| {
            let square = distance(moments.mean, *inverse, at) / variance;
            -0.5 * determinant - 0.5 * self.lines * (square / (self.lines - 1.0)).ln_1p()
        };
        let mut weights: Vec<f64> = self.places.iter().map(logarithm).collect();
        let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        weights.iter_mut().for_each(|weight| *weight = (*weight - largest).exp());
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Posterior { grid: self, weights }
    }
}

impl Posterior<'_> {
    /// Returns the most probable place.
    pub fn best(&self) -> Place {
        let most = self.weights.iter().zip(&self.grid.places).max_by(|one, other| one.0.total_cmp(other.0));
        most.map_or(Place { range: 0.0, modulus: 0.0 }, |(_, (place, ..))| *place)
    }

    /// Returns γ in J/m² for the parameter 0, and E* in Pa for the parameter 1.
    pub fn estimate(&self, parameter: usize) -> IntervalEstimate {
        let places = self.weights.iter().zip(&self.grid.places);
        let mut values: Vec<(f64, f64)> =
            places.map(|(weight, (place, ..))| (place.parameters()[parameter], *weight)).collect();
        values.sort_by(|one, other| one.0.total_cmp(&other.0));
        let [low, value, high] = QUANTILES.map(|share| {
            let mut sum = 0.0;
            let (mut before, mut reached) = (values[0].0, 0.0);
            for (value, weight) in &values {
                // The weight of a place lies to both sides of it.
                let next = sum + 0.5 * weight;
                if next >= share {
                    let part = if next > reached { (share - reached) / (next - reached) } else { 1.0 };
                    return before + part.clamp(0.0, 1.0) * (value - before);
                }
                (before, reached, sum) = (*value, next, sum + weight);
            }
            before
        });
        IntervalEstimate { value, low, high }.map(f64::exp)
    }

    /// Returns the correlation of ln γ and ln E*; 0 for a known E*.
    pub fn correlation(&self) -> f64 {
        let all = || self.weights.iter().zip(self.grid.places.iter().map(|(place, ..)| place.parameters()));
        let mean = [0, 1].map(|index| all().map(|(weight, of)| weight * of[index]).sum::<f64>());
        let product = |one: usize, other: usize| {
            all().map(|(weight, of)| weight * (of[one] - mean[one]) * (of[other] - mean[other])).sum::<f64>()
        };
        let both = product(0, 0) * product(1, 1);
        if both > 1e-20 { product(0, 1) / both.sqrt() } else { 0.0 }
    }

    /// Returns the ends of the table beyond which the parameters may lie.
    pub fn beyond(&self) -> Vec<End> {
        let [low, high, soft, hard] = self.grid.ends;
        let is_near = |place: &Place, end: End| match end {
            End::LowRange => place.range < low + EDGE,
            End::HighRange => place.range > high - EDGE,
            End::LowModulus => hard > soft && place.modulus < soft + EDGE,
            End::HighModulus => hard > soft && place.modulus > hard - EDGE,
        };
        let share = |end: End| {
            let all = self.weights.iter().zip(&self.grid.places);
            all.filter(|(_, (place, ..))| is_near(place, end)).map(|(weight, _)| weight).sum::<f64>()
        };
        let ends = [End::LowRange, End::HighRange, End::LowModulus, End::HighModulus];
        ends.into_iter().filter(|end| share(*end) > MOST_AT_END).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::summary::SUMMARIES;

    /// Learned values that are the parameters themselves, with a scatter of `deviation` over the lines.
    fn grid(deviation: f64, known: Option<f64>, lines: usize) -> Grid {
        let axis = |count: u8, step: f64| (0..count).map(|at| step * f64::from(at) - 1.5).collect();
        let moduli = known.map_or_else(|| axis(7, 0.5), |modulus| vec![modulus]);
        let mut table = Table { ranges: axis(16, 0.2), moduli, lines: Vec::new() };
        let places: Vec<Place> = table.places().collect();
        table.lines = vec![vec![[0.0; SUMMARIES]; places.len()]; lines];
        // Two values of each line, uncorrelated and of this standard deviation.
        let size = deviation * ((lines - 1) as f64 / lines as f64).sqrt();
        let sign = |on: bool| if on { size } else { -size };
        let scatter = Scatter::of(&table, |line, node| {
            let [work, modulus] = places[node].parameters();
            if known.is_some() {
                [work + sign(line % 2 == 0), 0.0]
            } else {
                [work + sign(line % 2 == 0), modulus + sign(line / 2 % 2 == 0)]
            }
        });
        Grid::new(&table, &scatter, known)
    }

    #[test]
    fn intervals_have_the_errors_of_curves_and_profiles() {
        let error = 0.2 * (1.0_f64 / 8.0 + 1.0 / 400.0).sqrt();
        for known in [None, Some(0.0)] {
            let grid = grid(0.2, known, 400);
            let posterior = grid.posterior([0.1, 0.0], 8.0);
            let work = posterior.estimate(0);
            assert!((work.value.ln() - 0.1).abs() < 1e-3, "{work:?}");
            assert!((work.half_width() / (1.96 * error) - 1.0).abs() < 0.02, "{work:?} {error}");
            assert_eq!(posterior.beyond(), []);
            assert!(posterior.correlation().abs() < 0.01);
            let best = posterior.best();
            assert!((best.range - 0.1).abs() < 0.03 && best.modulus.abs() < 0.02, "{best:?}");
        }
    }

    #[test]
    fn ends_of_the_table_are_named_and_errors_add_in_quadrature() {
        let grid = grid(0.2, None, 64);
        assert_eq!(grid.posterior([1.4, -0.1], 8.0).beyond(), [End::HighRange]);
        assert_eq!(grid.posterior([0.0, -1.4], 8.0).beyond(), [End::HighRange, End::LowModulus]);
        let widened =
            IntervalEstimate { value: 1.0, low: (-0.3_f64).exp(), high: 0.4_f64.exp() }.widened(0.3);
        assert!(
            (widened.low.ln() + 0.3_f64.hypot(0.3)).abs() < 1e-12 && (widened.high.ln() - 0.5).abs() < 1e-12
        );
    }
}
