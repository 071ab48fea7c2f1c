//! The probability of the parameters γ and E*, given several measured curves. Polynomials, learned
//! from computed curves, predict the parameters of a curve from its summaries: numbers computed
//! from the curve, such as its pull-off force. The mean prediction over the measured curves is
//! compared with the predictions over random profiles.

use super::summary::{
    Description, LOOP_AREA, Measurement, PULL_OFF, SUMMARIES, Summaries, WAY_TO_HALF,
};
use super::table::{End, Place, Scatter, Table};
use crate::curve::MeasuredCurve;
use asperity_data::{Cholesky, mean, standard_deviation};

/// Index of ln γ among the parameters and the axes of a grid.
pub(crate) const WORK: usize = 0;
/// Index of ln E* among the parameters and the axes of a grid.
pub(crate) const MODULUS: usize = 1;
/// Largest deviation of a summary from its mean, in standard deviations. Larger deviations are
/// reduced to this value.
const LARGEST: f64 = 4.0;
/// Penalty on the squares of the coefficients (ridge regression), divided by the mean diagonal
/// element of the matrix of the normal equations.
const RIDGE: f64 = 1e-5;
/// Number of cells of a grid along each axis.
const CELLS: usize = 96;
/// Largest allowed probability of one value of an axis: a coarser grid is replaced by a finer one.
/// A normal distribution has this probability at its mean if the step of the axis is a fifth of the
/// standard deviation.
const MOST_AT_VALUE: f64 = 0.08;
/// Probability of one value of an axis below which the value counts as outside the distribution.
const NEGLIGIBLE: f64 = 1e-7;
/// Number of values that a finer grid keeps on each side, beyond the values with more than
/// negligible probability. The margin is needed because on a coarse grid the largest probability of
/// a narrow ridge may be some values away from the true maximum.
const MARGIN: usize = 8;
/// Largest number of grids that are tried, each finer or wider than the previous one.
const MOST_GRIDS: usize = 60;
/// Smallest step of a grid. With a smaller step the values of an axis would differ only by rounding
/// errors.
const LEAST_STEP: f64 = 1e-12;
/// Largest probability of values within [`EDGE`] of an end of the table. If the probability is
/// larger, the table is too short.
const MOST_AT_END: f64 = 2e-3;
/// Width of the edge of the table, as a difference of natural logarithms.
const EDGE: f64 = 0.1;
/// Smallest probability density, divided by the largest density, of a value that is not excluded at
/// the level of 5 %: exp(−1.96²/2).
const NOT_EXCLUDED: f64 = 0.146_5;
/// Quantiles of the lower end of the 95 % interval, of the estimate (the median), and of the upper
/// end.
const QUANTILES: [f64; 3] = [0.025, 0.5, 0.975];
/// Squared Mahalanobis distance from the mean of the random profiles that one curve of a thousand
/// exceeds by chance, if E* is given: a quantile of χ² with one degree of freedom.
const FOREIGN_OF_WORK: f64 = 10.8;
/// Squared Mahalanobis distance that one curve of a thousand exceeds by chance, if E* is free: a
/// quantile of χ² with two degrees of freedom.
const FOREIGN_OF_BOTH: f64 = 13.8;
/// Smallest pull-off force that is reported, in standard deviations of the noise.
const LEAST_PULL_OFF: f64 = 5.0;
/// Smallest number of curves whose scatter is compared with the scatter of the random profiles.
const FEWEST_FOR_SCATTER: usize = 4;

/// Computed curve of a random profile with known parameters.
struct Example {
    /// Number of the random profile.
    line: u64,
    description: Description,
    /// ln γ and ln E*.
    parameters: [f64; 2],
}

/// Mean and standard deviation of a summary.
struct Standard {
    mean: f64,
    deviation: f64,
}

/// Two polynomials of second degree in the summaries. Each is learned from one half of the random
/// profiles, and predicts the parameters of the other half.
struct Polynomials {
    /// Mean and standard deviation of each summary.
    standards: Vec<Standard>,
    /// Coefficients for both parameters: first those learned from the profiles with even numbers,
    /// then those learned from the profiles with odd numbers.
    halves: [Vec<[f64; 2]>; 2],
    /// Mean of the parameters of the computed curves.
    centre: [f64; 2],
}

impl Polynomials {
    fn learned(examples: &[Example]) -> Self {
        let mut polynomials = Polynomials {
            standards: standards(examples),
            halves: [Vec::new(), Vec::new()],
            centre: [WORK, MODULUS].map(|parameter| {
                let values = examples.iter().map(|example| example.parameters[parameter]);
                mean(&values.collect::<Vec<f64>>())
            }),
        };
        polynomials.halves = [0, 1].map(|half| polynomials.coefficients(examples, half));
        polynomials
    }

    /// Returns the coefficients that are learned from one half of the profiles (ridge regression).
    fn coefficients(&self, examples: &[Example], half: u64) -> Vec<[f64; 2]> {
        let count = self.terms(&examples[0].description).len();
        let mut products = vec![0.0; count * count];
        let mut right_of_work = vec![0.0; count];
        let mut right_of_modulus = vec![0.0; count];
        for example in examples {
            if example.line % 2 != half {
                continue;
            }
            let terms = self.terms(&example.description);
            let work = example.parameters[WORK] - self.centre[WORK];
            let modulus = example.parameters[MODULUS] - self.centre[MODULUS];
            for (row, term) in terms.iter().enumerate() {
                // The matrix is symmetric, so only its lower triangle is computed.
                let sums = &mut products[row * count..][..=row];
                for (sum, other) in sums.iter_mut().zip(&terms) {
                    *sum += term * other;
                }
                right_of_work[row] += term * work;
                right_of_modulus[row] += term * modulus;
            }
        }
        let trace: f64 = (0..count).map(|index| products[index * (count + 1)]).sum();
        for index in 0..count {
            products[index * (count + 1)] += RIDGE * trace / count as f64;
        }
        let Some(factor) = Cholesky::new(products, count) else {
            return vec![[0.0; 2]; count];
        };
        let work = factor.solve(right_of_work);
        let modulus = factor.solve(right_of_modulus);
        work.into_iter()
            .zip(modulus)
            .map(<[f64; 2]>::from)
            .collect()
    }

    /// Returns the terms of a polynomial of second degree: 1, the standardised summaries, and all
    /// products of two of them.
    fn terms(&self, description: &Description) -> Vec<f64> {
        let mut factors = Vec::with_capacity(self.standards.len() + 1);
        factors.push(1.0);
        for (value, standard) in description.values().zip(&self.standards) {
            let deviation = (value - standard.mean) / standard.deviation;
            factors.push(deviation.clamp(-LARGEST, LARGEST));
        }
        let mut terms = Vec::with_capacity(factors.len() * (factors.len() + 1) / 2);
        for (index, factor) in factors.iter().enumerate() {
            for other in &factors[..=index] {
                terms.push(factor * other);
            }
        }
        terms
    }

    /// Predicts ln γ and ln E* by the polynomial that was learned from one half of the profiles.
    fn by_half(&self, terms: &[f64], half: usize) -> [f64; 2] {
        [WORK, MODULUS].map(|parameter| {
            let products = terms
                .iter()
                .zip(&self.halves[half])
                .map(|(term, coefficients)| term * coefficients[parameter]);
            self.centre[parameter] + products.sum::<f64>()
        })
    }

    /// Predicts ln γ and ln E* of a computed curve by the polynomial of the half that does not
    /// contain its random profile, so that the prediction has no bias from learning.
    fn of_line(&self, line: u64, description: &Description) -> [f64; 2] {
        self.by_half(&self.terms(description), 1 - (line % 2) as usize)
    }

    /// Predicts ln γ and ln E* of a curve that belongs to no profile of the table, as the mean of
    /// both polynomials.
    fn of_curve(&self, description: &Description) -> [f64; 2] {
        let terms = self.terms(description);
        let even = self.by_half(&terms, 0);
        let odd = self.by_half(&terms, 1);
        [WORK, MODULUS].map(|parameter| 0.5 * (even[parameter] + odd[parameter]))
    }
}

/// Returns the mean and the standard deviation of each summary, and of the preload if the examples
/// have one.
fn standards(examples: &[Example]) -> Vec<Standard> {
    let mut standards = Vec::with_capacity(SUMMARIES + 1);
    for index in 0..SUMMARIES + 1 {
        let values = examples
            .iter()
            .map(|example| example.description.values().nth(index));
        let Some(values) = values.collect::<Option<Vec<f64>>>() else {
            break;
        };
        let average = mean(&values);
        standards.push(Standard {
            mean: average,
            deviation: standard_deviation(&values, average).max(f64::MIN_POSITIVE),
        });
    }
    standards
}

/// Estimate of the work of adhesion in J/m² or of the effective modulus in Pa, with its 95 %
/// interval.
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
    /// Returns half the width of the interval on the scale of the natural logarithm, ½
    /// ln(high/low).
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high / self.low).ln()
    }

    pub(crate) fn known(value: f64) -> Self {
        IntervalEstimate {
            value,
            low: value,
            high: value,
        }
    }

    /// Returns the estimate of a parameter of which only the upper bound `most` is known. Its
    /// interval begins at 0.
    pub(crate) fn at_most(self, most: f64) -> Self {
        IntervalEstimate {
            value: self.value.min(most),
            low: 0.0,
            high: most,
        }
    }

    /// Adds an independent error to the interval. `half_width` is half the width of the 95 %
    /// interval of this error, on the scale of the natural logarithm.
    pub(crate) fn widened(self, half_width: f64) -> Self {
        let factor_below = (self.low / self.value).ln().hypot(half_width).exp();
        let factor_above = (self.high / self.value).ln().hypot(half_width).exp();
        IntervalEstimate {
            value: self.value,
            low: self.value / factor_below,
            high: self.value * factor_above,
        }
    }
}

/// Data from which the probability of the parameters is computed.
struct Likelihood {
    scatter: Scatter,
    limits: Limits,
    /// Number of random profiles of the table.
    lines: f64,
}

/// Ranges of the parameters in a table.
#[derive(Clone, Copy)]
struct Limits {
    /// Smallest and largest ln(γ/E*).
    ranges: Extent,
    /// Smallest and largest ln E*. Both are equal if E* is given.
    moduli: Extent,
}

impl Limits {
    /// Returns the ranges of ln γ and ln E* that contain all values in the table.
    fn extents(self) -> [Extent; 2] {
        let works = Extent {
            low: self.ranges.low + self.moduli.low,
            high: self.ranges.high + self.moduli.high,
        };
        [works, self.moduli]
    }

    /// Returns true if a place, a pair of parameters, is near this end of the table.
    fn is_near(self, place: Place, end: End) -> bool {
        let is_modulus_free = self.moduli.high > self.moduli.low;
        match end {
            End::LowRange => place.range < self.ranges.low + EDGE,
            End::HighRange => place.range > self.ranges.high - EDGE,
            End::LowModulus => is_modulus_free && place.modulus < self.moduli.low + EDGE,
            End::HighModulus => is_modulus_free && place.modulus > self.moduli.high - EDGE,
        }
    }
}

/// Mean prediction over measured curves.
struct Observed {
    prediction: [f64; 2],
    /// Variance of the difference between this mean and the mean of the table, in units of the
    /// variance of one profile.
    variance: f64,
}

/// Interval of values of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    low: f64,
    high: f64,
}

/// Probability of the parameters on a grid over ln γ and ln E*.
pub(crate) struct Posterior {
    /// Evenly spaced values of ln γ and of ln E*.
    axes: [Vec<f64>; 2],
    /// Probability of each pair of values. All pairs with the first value of ln γ come first, in
    /// the order of ln E*.
    weights: Vec<f64>,
    limits: Limits,
}

impl Likelihood {
    /// Prepares the comparison with a table. If ln E* is known, only pairs with this value are
    /// compared.
    fn new(table: &Table, scatter: &Scatter, known: Option<f64>) -> Self {
        let moduli = match known {
            Some(modulus) => Extent {
                low: modulus,
                high: modulus,
            },
            None => Extent::of(&table.moduli),
        };
        Likelihood {
            scatter: scatter.clone(),
            limits: Limits {
                ranges: Extent::of(&table.ranges),
                moduli,
            },
            lines: table.lines.len() as f64,
        }
    }

    /// Returns the probability of the parameters if the mean prediction over `curves` curves is
    /// `prediction`. The prior is flat over ln γ and ln E*. The error of the mean comes from the
    /// number of curves and from the number of random profiles.
    ///
    /// The first grid covers the whole table. The next grids are narrowed to the values with more
    /// than negligible probability, or widened where the probability does not end within the grid,
    /// until no value of a parameter has more than a small part of the probability.
    fn posterior(&self, prediction: [f64; 2], curves: f64) -> Posterior {
        let observed = Observed {
            prediction,
            variance: 1.0 / curves + 1.0 / self.lines,
        };
        let whole = self.limits.extents();
        let mut extents = whole;
        let mut posterior = self.on_grid(&observed, extents);
        for _ in 1..MOST_GRIDS {
            let next = [WORK, MODULUS].map(|axis| posterior.next_extent(axis, whole[axis]));
            if next == extents {
                break;
            }
            extents = next;
            posterior = self.on_grid(&observed, extents);
        }
        posterior
    }

    /// Computes the probability on a grid over these values of ln γ and ln E*.
    fn on_grid(&self, observed: &Observed, extents: [Extent; 2]) -> Posterior {
        let [works, moduli] = extents.map(Extent::values);
        let mut weights = Vec::with_capacity(works.len() * moduli.len());
        for work in &works {
            for modulus in &moduli {
                let place = Place {
                    range: work - modulus,
                    modulus: *modulus,
                };
                weights.push(self.logarithm(observed, place));
            }
        }
        let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        for weight in &mut weights {
            *weight = (*weight - largest).exp();
            sum += *weight;
        }
        for weight in &mut weights {
            *weight /= sum;
        }
        Posterior {
            axes: [works, moduli],
            weights,
            limits: self.limits,
        }
    }

    /// Returns the logarithm of the probability density at a place, up to a constant. It is
    /// Student's t-distribution, and not a normal distribution, because the covariance from few
    /// profiles is uncertain.
    fn logarithm(&self, observed: &Observed, place: Place) -> f64 {
        let Extent { low, high } = self.limits.ranges;
        let rounding = 1e-9;
        if place.range < low - rounding || place.range > high + rounding {
            return f64::NEG_INFINITY;
        }
        let moments = self.scatter.at(place);
        let inverse = moments.inverse();
        let distance = inverse.squared_distance(moments.mean, observed.prediction);
        let square = distance / observed.variance;
        -0.5 * inverse.log_determinant - 0.5 * self.lines * (square / (self.lines - 1.0)).ln_1p()
    }
}

impl Extent {
    fn of(axis: &[f64]) -> Self {
        Extent {
            low: axis[0],
            high: axis[axis.len() - 1],
        }
    }

    fn width(self) -> f64 {
        self.high - self.low
    }

    /// Returns evenly spaced values; a single value if the width is 0.
    fn values(self) -> Vec<f64> {
        if self.width() == 0.0 {
            return vec![self.low];
        }
        (0..=CELLS)
            .map(|index| self.low + self.width() * index as f64 / CELLS as f64)
            .collect()
    }
}

impl Posterior {
    /// Returns the values of ln γ and ln E* of each weight, in the order of the weights.
    fn nodes(&self) -> impl Iterator<Item = Place> {
        let [works, moduli] = &self.axes;
        works.iter().flat_map(move |work| {
            moduli.iter().map(move |modulus| Place {
                range: work - modulus,
                modulus: *modulus,
            })
        })
    }

    /// Returns the probability of each value of an axis.
    fn along(&self, axis: usize) -> Vec<f64> {
        let moduli = self.axes[MODULUS].len();
        let mut sums = vec![0.0; self.axes[axis].len()];
        for (index, weight) in self.weights.iter().enumerate() {
            let value = if axis == WORK {
                index / moduli
            } else {
                index % moduli
            };
            sums[value] += weight;
        }
        sums
    }

    /// Returns the range of an axis for the next grid, within `whole`. The range is unchanged if
    /// this grid is fine and wide enough.
    fn next_extent(&self, axis: usize, whole: Extent) -> Extent {
        let values = &self.axes[axis];
        let last = values.len() - 1;
        let present = Extent::of(values);
        if last == 0 {
            return present;
        }
        let probabilities = self.along(axis);
        let is_present = |probability: &f64| *probability > NEGLIGIBLE;
        let first_present = probabilities.iter().position(is_present).unwrap_or(0);
        let last_present = probabilities.iter().rposition(is_present).unwrap_or(last);
        let grows_below = first_present == 0 && present.low > whole.low;
        let grows_above = last_present == last && present.high < whole.high;
        if grows_below || grows_above {
            let mut wider = present;
            if grows_below {
                wider.low -= present.width();
            }
            if grows_above {
                wider.high += present.width();
            }
            return Extent {
                low: wider.low.max(whole.low),
                high: wider.high.min(whole.high),
            };
        }
        let most = probabilities.iter().copied().fold(0.0, f64::max);
        if most <= MOST_AT_VALUE || present.width() < LEAST_STEP * CELLS as f64 {
            return present;
        }
        Extent {
            low: values[first_present.saturating_sub(MARGIN)],
            high: values[(last_present + MARGIN).min(last)],
        }
    }

    /// Returns the most probable pair of parameters.
    pub fn best(&self) -> Place {
        let weights = self.weights.iter().enumerate();
        let best = weights.max_by(|(_, weight), (_, next)| weight.total_cmp(next));
        let index = best.map_or(0, |(index, _)| index);
        let moduli = self.axes[MODULUS].len();
        let work = self.axes[WORK][index / moduli];
        let modulus = self.axes[MODULUS][index % moduli];
        Place {
            range: work - modulus,
            modulus,
        }
    }

    /// Returns the estimate of a parameter: of γ in J/m² for [`WORK`], or of E* in Pa for
    /// [`MODULUS`].
    pub fn estimate(&self, parameter: usize) -> IntervalEstimate {
        let probabilities = self.along(parameter);
        let [low, value, high] =
            QUANTILES.map(|share| quantile(&self.axes[parameter], &probabilities, share).exp());
        IntervalEstimate { value, low, high }
    }

    /// Returns the largest γ in J/m² that is not excluded at the level of 5 %. The probability
    /// density of this γ is exp(−1.96²/2) times the largest density.
    pub fn most_work(&self) -> f64 {
        let densities = self.along(WORK);
        let largest = densities.iter().copied().fold(0.0, f64::max);
        let last = densities
            .iter()
            .rposition(|density| *density >= NOT_EXCLUDED * largest);
        self.axes[WORK][last.unwrap_or(densities.len() - 1)].exp()
    }

    /// Returns the mean of a function of ln γ and ln E* over the probability distribution.
    fn mean(&self, value_of: impl Fn(f64, f64) -> f64) -> f64 {
        let [works, moduli] = &self.axes;
        let mut sum = 0.0;
        for (index, weight) in self.weights.iter().enumerate() {
            sum += weight * value_of(works[index / moduli.len()], moduli[index % moduli.len()]);
        }
        sum
    }

    /// Returns the correlation of ln γ and ln E*; 0 for a known E*.
    pub fn correlation(&self) -> f64 {
        if self.axes[MODULUS].len() == 1 {
            return 0.0;
        }
        let mean_work = self.mean(|work, _| work);
        let mean_modulus = self.mean(|_, modulus| modulus);
        let variance_of_work = self.mean(|work, _| (work - mean_work).powi(2));
        let variance_of_modulus = self.mean(|_, modulus| (modulus - mean_modulus).powi(2));
        let covariance = self.mean(|work, modulus| (work - mean_work) * (modulus - mean_modulus));
        let scale = (variance_of_work * variance_of_modulus).sqrt();
        if scale > 0.0 {
            (covariance / scale).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// Returns the ends of the table near which there is so much probability that the parameters
    /// may lie beyond.
    pub fn beyond(&self) -> Vec<End> {
        let mut ends = vec![
            End::LowRange,
            End::HighRange,
            End::LowModulus,
            End::HighModulus,
        ];
        ends.retain(|end| self.probability_near(*end) > MOST_AT_END);
        ends
    }

    /// Returns the probability of all pairs of parameters near an end of the table.
    fn probability_near(&self, end: End) -> f64 {
        let mut sum = 0.0;
        for (place, weight) in self.nodes().zip(&self.weights) {
            if self.limits.is_near(place, end) {
                sum += weight;
            }
        }
        sum
    }
}

/// Returns the value below which a parameter lies with the probability `share`. The density is
/// linear between the values of the axis, at which it is in proportion to `probabilities`.
fn quantile(values: &[f64], probabilities: &[f64], share: f64) -> f64 {
    let cells: Vec<f64> = probabilities
        .windows(2)
        .map(|ends| 0.5 * (ends[0] + ends[1]))
        .collect();
    let mut remainder = share * cells.iter().sum::<f64>();
    for (index, cell) in cells.iter().enumerate() {
        if remainder <= *cell {
            let from = probabilities[index];
            let to = probabilities[index + 1];
            // `root` is part of the positive solution x of from·x + (to − from)·x²/2 = remainder,
            // written so that it loses no digits if `from` and `to` are nearly equal.
            let root = (from * from + 2.0 * (to - from) * remainder)
                .max(0.0)
                .sqrt();
            let part = if from + root > 0.0 {
                2.0 * remainder / (from + root)
            } else {
                0.0
            };
            return values[index] + part.clamp(0.0, 1.0) * (values[index + 1] - values[index]);
        }
        remainder -= cell;
    }
    values[values.len() - 1]
}

/// Results of one measured curve when it is used without the others.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve, as it was given to [`fit_ensemble`](crate::fit_ensemble).
    pub name: String,
    /// Preload of the curve in N, which is its largest force.
    pub preload: f64,
    /// Largest tensile force of the retraction in N, as a positive number; `None` if it is at most
    /// 5 times the noise of the force.
    pub pull_off_force: Option<f64>,
    /// Energy in J that is dissipated in the loop: area between approach and retraction over the
    /// displacement of the instrument.
    pub loop_area: f64,
    /// Stiffness in N/m at the beginning of the retraction: half the preload, divided by the change
    /// of the displacement while the force falls from the preload to half the preload.
    pub stiffness: f64,
    /// Work of adhesion in J/m² that is found from this single curve.
    pub work: IntervalEstimate,
    /// True if the interval of [`Self::work`] ends where the values end for which curves were
    /// computed. The true interval is then wider.
    pub at_end_of_table: bool,
    /// True if the values of γ and E* found from this curve are further from the mean of the random
    /// profiles than the values found from 999 of 1000 random profiles (Mahalanobis distance).
    pub foreign: bool,
}

/// Predictions of the parameters of computed and of measured curves, by polynomials that are
/// learned from a table.
pub(crate) struct Predictions {
    polynomials: Polynomials,
    has_one_modulus: bool,
    /// Predicted ln γ and ln E* of each random profile at each node.
    pub of_lines: Vec<Vec<[f64; 2]>>,
    /// Scatter of the predictions over the random profiles.
    pub scatter: Scatter,
    likelihood: Likelihood,
    /// Predicted ln γ and ln E* of each measured curve.
    of_curves: Vec<[f64; 2]>,
}

impl Predictions {
    /// Learns the polynomials from a table, and predicts the parameters of all computed and
    /// measured curves. `known` is ln E* if E* is given.
    pub fn new(table: &Table, measured: &Measurement, known: Option<f64>) -> Self {
        let examples = examples(table, measured);
        let polynomials = Polynomials::learned(&examples);
        let has_one_modulus = table.moduli.len() == 1;
        let mut of_lines = Vec::with_capacity(table.lines.len());
        for line in examples.chunks(table.places().len()) {
            let predict = |example: &Example| {
                let prediction = polynomials.of_line(example.line, &example.description);
                without_modulus_if(has_one_modulus, prediction)
            };
            of_lines.push(line.iter().map(predict).collect::<Vec<_>>());
        }
        let mut of_curves = Vec::with_capacity(measured.summaries.len());
        for (index, summaries) in measured.summaries.iter().enumerate() {
            let prediction = polynomials.of_curve(&measured.describe(*summaries, index));
            of_curves.push(without_modulus_if(has_one_modulus, prediction));
        }
        let scatter = Scatter::of(table, |line, node| of_lines[line][node]);
        Predictions {
            likelihood: Likelihood::new(table, &scatter, known),
            polynomials,
            has_one_modulus,
            of_lines,
            scatter,
            of_curves,
        }
    }

    /// Predicts ln γ and ln E* of a further computed curve of a random profile of the table.
    pub fn of_line(&self, line: usize, curve: &Summaries, measured: &Measurement) -> [f64; 2] {
        let description = measured.describe(*curve, line);
        let prediction = self.polynomials.of_line(line as u64, &description);
        without_modulus_if(self.has_one_modulus, prediction)
    }

    /// Returns the mean prediction over the measured curves.
    fn mean_of_curves(&self) -> [f64; 2] {
        [WORK, MODULUS].map(|parameter| {
            let values = self.of_curves.iter().map(|values| values[parameter]);
            mean(&values.collect::<Vec<f64>>())
        })
    }

    /// Returns the probability of the parameters given all measured curves.
    pub fn posterior(&self) -> Posterior {
        let curves = self.of_curves.len() as f64;
        self.likelihood.posterior(self.mean_of_curves(), curves)
    }

    /// Returns the ratio of two standard deviations of the predictions: over the measured curves,
    /// and over the random profiles at the most probable place. `None` for fewer than
    /// [`FEWEST_FOR_SCATTER`] curves.
    pub fn scatter_ratio(&self, best: Place) -> Option<f64> {
        let count = self.of_curves.len();
        if count < FEWEST_FOR_SCATTER {
            return None;
        }
        let inverse = self.scatter.at(best).inverse();
        let centre = self.mean_of_curves();
        let distances = self
            .of_curves
            .iter()
            .map(|values| inverse.squared_distance(centre, *values));
        let sum: f64 = distances.sum();
        let values = if self.has_one_modulus { 1.0 } else { 2.0 };
        Some((sum / (count as f64 - 1.0) / values).sqrt())
    }

    /// Returns the results of each curve as if it were the only measured curve.
    pub fn rows(
        &self,
        curves: &[(String, MeasuredCurve)],
        measured: &Measurement,
        best: Place,
    ) -> Vec<CurveOfEnsemble> {
        let mut rows = Vec::with_capacity(curves.len());
        for (index, (name, _)) in curves.iter().enumerate() {
            let summaries = &measured.summaries[index];
            let protocol = &measured.protocols[index];
            let pull_off = summaries[PULL_OFF].exp();
            let posterior = self.likelihood.posterior(self.of_curves[index], 1.0);
            rows.push(CurveOfEnsemble {
                name: name.clone(),
                preload: measured.preloads[index],
                pull_off_force: (pull_off > LEAST_PULL_OFF * protocol.noise).then_some(pull_off),
                loop_area: summaries[LOOP_AREA].exp(),
                stiffness: 0.5 * protocol.preload / summaries[WAY_TO_HALF].exp(),
                work: posterior.estimate(WORK),
                at_end_of_table: !posterior.beyond().is_empty(),
                foreign: self.is_foreign(index, best),
            });
        }
        rows
    }

    /// Returns true if the prediction of a measured curve is farther from the mean of the random
    /// profiles at the most probable place than chance explains.
    fn is_foreign(&self, index: usize, best: Place) -> bool {
        let moments = self.scatter.at(best);
        let inverse = moments.inverse();
        let distance = inverse.squared_distance(moments.mean, self.of_curves[index]);
        let relative = distance / (1.0 + 1.0 / self.of_lines.len() as f64);
        let most = if self.has_one_modulus {
            FOREIGN_OF_WORK
        } else {
            FOREIGN_OF_BOTH
        };
        relative > most
    }
}

/// Returns the computed curves of a table, profile by profile.
fn examples(table: &Table, measured: &Measurement) -> Vec<Example> {
    let places = table.places();
    let mut examples = Vec::with_capacity(table.lines.len() * places.len());
    for (line, curves) in table.lines.iter().enumerate() {
        for (curve, place) in curves.iter().zip(&places) {
            examples.push(Example {
                line: line as u64,
                description: measured.describe(*curve, line),
                parameters: place.parameters(),
            });
        }
    }
    examples
}

/// Returns the prediction. If the table has one modulus, its ln E* is replaced by 0, because it
/// means nothing.
fn without_modulus_if(has_one_modulus: bool, prediction: [f64; 2]) -> [f64; 2] {
    if has_one_modulus {
        [prediction[WORK], 0.0]
    } else {
        prediction
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Each polynomial learns a relation of second degree from the profiles of its half.
    #[test]
    fn a_polynomial_of_second_degree_is_learned() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut random = || {
            let summaries: Summaries = std::array::from_fn(|_| generator.random_range(-1.0..1.0));
            Description {
                summaries,
                preload: Some(generator.random_range(5.0..6.0)),
            }
        };
        let parameters = |of: &Description| {
            let [one, other, third] = [of.summaries[0], of.summaries[4], of.preload.unwrap()];
            [3.0 + one - 2.0 * other * third, 7.0 * one * one - other]
        };
        let curves: Vec<_> = (0..2000)
            .map(|index| {
                let of = random();
                // The parameters of one half of the profiles are off by 1, which the polynomial of
                // the other half does not learn.
                let [work, modulus] = parameters(&of);
                Example {
                    line: index % 16,
                    description: of,
                    parameters: [work + f64::from(u8::from(index % 2 == 0)), modulus],
                }
            })
            .collect();
        let learned = Polynomials::learned(&curves);
        let of = random();
        let [work, modulus] = parameters(&of);
        for (found, expected) in [
            (learned.of_line(0, &of), [work, modulus]),
            (learned.of_line(1, &of), [work + 1.0, modulus]),
            (learned.of_curve(&of), [work + 0.5, modulus]),
        ] {
            assert!(
                found
                    .iter()
                    .zip(expected)
                    .all(|(one, other)| (one - other).abs() < 0.01),
                "{found:?} {expected:?}"
            );
        }
    }

    /// Returns a likelihood in which the predictions are the parameters plus deviations. Over the
    /// profiles the deviations have the standard deviation `deviation` and the correlation
    /// `correlation` between ln γ and ln E*.
    fn likelihood(
        deviation: f64,
        correlation: f64,
        known: Option<f64>,
        lines: usize,
    ) -> Likelihood {
        let axis = |count: u8, step: f64| (0..count).map(|at| step * f64::from(at) - 1.5).collect();
        let moduli = known.map_or_else(|| axis(7, 0.5), |modulus| vec![modulus]);
        let mut table = Table {
            ranges: axis(16, 0.2),
            moduli,
            lines: Vec::new(),
        };
        let places: Vec<Place> = table.places();
        table.lines = vec![vec![[0.0; SUMMARIES]; places.len()]; lines];
        // Each profile has two uncorrelated deviations of this size.
        let size = deviation * ((lines - 1) as f64 / lines as f64).sqrt();
        let sign = |is_positive: bool| if is_positive { size } else { -size };
        let scatter = Scatter::of(&table, |line, node| {
            let [work, modulus] = places[node].parameters();
            let [one, other] = [sign(line % 2 == 0), sign(line / 2 % 2 == 0)];
            if known.is_some() {
                return [work + one, 0.0];
            }
            [
                work + one,
                modulus + correlation * one + (1.0 - correlation * correlation).sqrt() * other,
            ]
        });
        Likelihood::new(&table, &scatter, known)
    }

    /// Asserts that the estimate of a parameter and its interval are those of a normal
    /// distribution.
    fn assert_normal(found: IntervalEstimate, mean: f64, error: f64) {
        assert!(
            found.low < found.value && found.value < found.high,
            "{found:?}"
        );
        assert!(
            (found.value.ln() - mean).abs() < 0.01 * error,
            "{found:?}: {mean} {error}"
        );
        for (end, sign) in [(found.low, -1.0), (found.high, 1.0)] {
            let expected = mean + sign * 1.96 * error;
            assert!(
                (end.ln() - expected).abs() < 0.02 * error,
                "{found:?}: {mean} {error}"
            );
        }
    }

    /// The intervals are those of normal distributions. The scatter is from a ten-thousandth of a
    /// step of the table to a whole step, without correlation and with strong correlation.
    #[test]
    fn intervals_have_the_errors_of_curves_and_profiles() {
        for deviation in [1e-5, 1e-4, 1e-3, 5e-3, 0.02, 0.1, 0.2] {
            let error = deviation * (1.0_f64 / 8.0 + 1.0 / 1000.0).sqrt();
            for place in [0.1, 0.100_37, -0.731] {
                for correlation in [0.0, 0.9, 0.99, -0.95] {
                    let both = likelihood(deviation, correlation, None, 1000);
                    let posterior = both.posterior([place, 0.03], 8.0);
                    assert_normal(posterior.estimate(0), place, error);
                    assert_normal(posterior.estimate(1), 0.03, error);
                    assert_eq!(posterior.beyond(), []);
                    assert!(
                        (posterior.correlation() - correlation).abs() < 0.01,
                        "{deviation} {correlation}"
                    );
                    let best = posterior.best();
                    let [work, modulus] = best.parameters();
                    assert!(
                        (work - place).abs().max((modulus - 0.03).abs()) < 0.5 * error,
                        "{best:?}"
                    );
                }
                let one = likelihood(deviation, 0.0, Some(0.3), 1000);
                let posterior = one.posterior([place, 0.0], 8.0);
                assert_normal(posterior.estimate(0), place, error);
                assert_eq!(posterior.correlation(), 0.0);
            }
        }
    }

    #[test]
    fn quantiles_are_those_of_a_density_that_is_linear_between_values() {
        // The density x over 0 to 2 has the distribution x²/4, and the density 2 − x that of its
        // mirror image.
        for share in [0.0_f64, 0.01, 0.25, 0.3, 0.9, 1.0] {
            let rising = quantile(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0], share);
            assert!(
                (rising - 2.0 * share.sqrt()).abs() < 1e-12,
                "{share}: {rising}"
            );
            let falling = quantile(&[0.0, 1.0, 2.0], &[2.0, 1.0, 0.0], share);
            assert!(
                (falling - (2.0 - 2.0 * (1.0 - share).sqrt())).abs() < 1e-7,
                "{share}: {falling}"
            );
        }
        assert_eq!(quantile(&[5.0], &[1.0], 0.5), 5.0);
    }

    /// If the table cuts off the probability, or the probability fills the whole table, the
    /// interval lies within the table.
    #[test]
    fn intervals_end_with_the_table() {
        for (deviation, work, modulus) in [
            (30.0, 0.0, 0.0),
            (0.2, 4.0, 0.0),
            (0.01, -2.9, -1.6),
            (3.0, 0.0, -3.0),
        ] {
            let posterior = likelihood(deviation, 0.5, None, 64).posterior([work, modulus], 2.0);
            assert!(!posterior.beyond().is_empty());
            for (parameter, [least, most]) in [[-3.0_f64, 3.0], [-1.5, 1.5]].into_iter().enumerate()
            {
                let IntervalEstimate { value, low, high } = posterior.estimate(parameter);
                assert!(
                    least <= low.ln() && low < value && value < high && high.ln() <= most,
                    "{low} {value} {high}"
                );
            }
        }
    }

    #[test]
    fn ends_of_the_table_are_named_and_errors_add_in_quadrature() {
        let likelihood = likelihood(0.2, 0.0, None, 64);
        assert_eq!(
            likelihood.posterior([1.4, -0.1], 8.0).beyond(),
            [End::HighRange]
        );
        assert_eq!(
            likelihood.posterior([0.0, -1.4], 8.0).beyond(),
            [End::HighRange, End::LowModulus]
        );
        let widened = IntervalEstimate {
            value: 1.0,
            low: (-0.3_f64).exp(),
            high: 0.4_f64.exp(),
        }
        .widened(0.3);
        assert!(
            (widened.low.ln() + 0.3_f64.hypot(0.3)).abs() < 1e-12
                && (widened.high.ln() - 0.5).abs() < 1e-12
        );
    }
}
