//! The probability of the parameters. Polynomials, learned from computed curves, predict the
//! parameters of a curve from its summaries, and the mean prediction over the measured curves is
//! compared with the predictions over random profiles.

use super::summary::{Described, LOOP_AREA, Measured, PULL_OFF, SUMMARIES, Summaries, WAY_TO_HALF};
use super::table::{End, Place, Scatter, Table, distance};
use crate::curve::MeasuredCurve;
use asperity_data::{Cholesky, mean, standard_deviation};

/// Largest deviation of a summary from its mean, in standard deviations. Larger deviations are cut
/// off.
const LARGEST: f64 = 4.0;
/// Penalty of the size of the coefficients, divided by the mean weight of the curves.
const RIDGE: f64 = 1e-5;
/// Number of cells of a grid along each axis.
const CELLS: usize = 96;
/// Largest probability at one value of an axis. A normal distribution has it if the step is a fifth
/// of its standard deviation.
const MOST_AT_VALUE: f64 = 0.08;
/// Probability at one value of an axis below which this value is beyond the distribution.
const NEGLIGIBLE: f64 = 1e-7;
/// Number of values that a finer grid keeps beyond the values with a probability. On a coarse grid
/// the largest probability of a narrow ridge may be some values away from its summit.
const MARGIN: usize = 8;
/// Largest number of grids, each of which is finer or wider than the one before.
const MOST_GRIDS: usize = 60;
/// Smallest step of a grid, which rounding allows.
const LEAST_STEP: f64 = 1e-12;
/// Share of the probability within `EDGE` of an end of the table, above which the table is too
/// short.
const MOST_AT_END: f64 = 2e-3;
const EDGE: f64 = 0.1;
/// Density divided by the largest density above which a value is not excluded: exp(−1.96²/2).
const NOT_EXCLUDED: f64 = 0.146_5;
/// Quantiles of the result and of its 95 % interval.
const QUANTILES: [f64; 3] = [0.025, 0.5, 0.975];
/// Squared distance of a curve from the others that one curve of a thousand exceeds: quantiles of
/// χ² for one and for two values.
const FOREIGN: [f64; 2] = [10.8, 13.8];
/// Smallest pull-off force that is reported, in standard deviations of the noise.
const LEAST_PULL_OFF: f64 = 5.0;
const FEWEST_FOR_SCATTER: usize = 4;

/// Two polynomials of second degree in the summaries. Each is learned from one half of the random
/// profiles, and predicts the parameters of the other half.
pub(crate) struct Learned {
    /// Mean and standard deviation of each summary.
    standard: Vec<(f64, f64)>,
    halves: [Vec<[f64; 2]>; 2],
    centre: [f64; 2],
}

impl Learned {
    /// Learns from computed curves, each with the number of its random profile, ln γ and ln E*.
    pub fn from(curves: &[(u64, Described, [f64; 2])]) -> Self {
        let standard = (0..SUMMARIES + 1)
            .map_while(|index| {
                let of: Option<Vec<f64>> = curves
                    .iter()
                    .map(|curve| curve.1.values().nth(index))
                    .collect();
                let of = of?;
                let mean = mean(&of);
                Some((mean, standard_deviation(&of, mean).max(f64::MIN_POSITIVE)))
            })
            .collect();
        let of_parameter = |index: usize| {
            mean(
                &curves
                    .iter()
                    .map(|curve| curve.2[index])
                    .collect::<Vec<f64>>(),
            )
        };
        let centre = [of_parameter(0), of_parameter(1)];
        let mut learned = Learned {
            standard,
            halves: [Vec::new(), Vec::new()],
            centre,
        };
        learned.halves = [0, 1].map(|half| learned.coefficients(curves, half));
        learned
    }

    fn coefficients(&self, curves: &[(u64, Described, [f64; 2])], half: u64) -> Vec<[f64; 2]> {
        let columns = self.terms(&curves[0].1).len();
        let (mut products, mut right) = (
            vec![0.0; columns * columns],
            [0, 1].map(|_| vec![0.0; columns]),
        );
        for (_, described, parameters) in curves.iter().filter(|curve| curve.0 % 2 == half) {
            let terms = self.terms(described);
            for (row, one) in terms.iter().enumerate() {
                let sums = products[row * columns..][..=row].iter_mut();
                sums.zip(&terms)
                    .for_each(|(sum, other)| *sum += one * other);
                for (parameter, sums) in right.iter_mut().enumerate() {
                    sums[row] += one * (parameters[parameter] - self.centre[parameter]);
                }
            }
        }
        let on_diagonal = |index: usize| index * (columns + 1);
        let trace: f64 = (0..columns).map(|index| products[on_diagonal(index)]).sum();
        (0..columns)
            .for_each(|index| products[on_diagonal(index)] += RIDGE * trace / columns as f64);
        let Some(factor) = Cholesky::new(products, columns) else {
            return vec![[0.0; 2]; columns];
        };
        let [work, modulus] = right.map(|right| factor.solve(right));
        work.into_iter()
            .zip(modulus)
            .map(<[f64; 2]>::from)
            .collect()
    }

    /// Returns 1, the standardised summaries and all their products.
    fn terms(&self, described: &Described) -> Vec<f64> {
        let standardised = described.values().zip(&self.standard);
        let all: Vec<f64> = std::iter::once(1.0)
            .chain(standardised.map(|(value, (mean, deviation))| {
                ((value - mean) / deviation).clamp(-LARGEST, LARGEST)
            }))
            .collect();
        (0..all.len())
            .flat_map(|one| (0..=one).map(move |other| (one, other)))
            .map(|(one, other)| all[one] * all[other])
            .collect()
    }

    fn by_half(&self, terms: &[f64], half: usize) -> [f64; 2] {
        let sum = |parameter: usize| {
            terms
                .iter()
                .zip(&self.halves[half])
                .map(|(term, of)| term * of[parameter])
                .sum::<f64>()
        };
        [self.centre[0] + sum(0), self.centre[1] + sum(1)]
    }

    /// Predicts ln γ and ln E* of a curve of a random profile, by the polynomial learned from the
    /// other half.
    pub fn of_line(&self, line: u64, described: &Described) -> [f64; 2] {
        self.by_half(&self.terms(described), 1 - (line % 2) as usize)
    }

    /// Predicts ln γ and ln E* of another curve, as the mean of both polynomials.
    pub fn of_curve(&self, described: &Described) -> [f64; 2] {
        let terms = self.terms(described);
        let [one, other] = [0, 1].map(|half| self.by_half(&terms, half));
        [0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])]
    }
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

    /// Returns the estimate of a parameter that has an upper bound only.
    pub(crate) fn at_most(self, most: f64) -> Self {
        IntervalEstimate {
            value: self.value.min(most),
            low: 0.0,
            high: most,
        }
    }

    /// Adds further errors in quadrature, given as the half-width of a 95 % interval of the natural
    /// logarithm.
    pub(crate) fn widened(self, half_width: f64) -> Self {
        let factor = |end: f64| (end / self.value).ln().hypot(half_width).exp();
        IntervalEstimate {
            value: self.value,
            low: self.value / factor(self.low),
            high: self.value * factor(self.high),
        }
    }
}

/// Data from which the probability of the parameters is computed.
pub(crate) struct Likelihood {
    scatter: Scatter,
    /// First and last ln(γ/E*) of the table, and first and last ln E*. A known ln E* is both.
    ranges: [f64; 2],
    moduli: [f64; 2],
    /// Number of random profiles of the table.
    lines: f64,
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
    /// Probability of each pair of values, all values of ln E* of one ln γ together.
    weights: Vec<f64>,
    ranges: [f64; 2],
    moduli: [f64; 2],
}

impl Likelihood {
    /// Prepares the comparison with a table, or with the part of it that has a known ln E*.
    pub fn new(table: &Table, scatter: &Scatter, known: Option<f64>) -> Self {
        let ends = |axis: &[f64]| [axis[0], axis[axis.len() - 1]];
        Likelihood {
            scatter: scatter.clone(),
            ranges: ends(&table.ranges),
            moduli: known.map_or_else(|| ends(&table.moduli), |modulus| [modulus; 2]),
            lines: table.lines.len() as f64,
        }
    }

    /// Returns the probability of the parameters if the mean prediction over `curves` curves is
    /// `prediction`. The prior is flat over ln γ and ln E*. The error of the mean comes from the
    /// number of curves and from the number of random profiles.
    ///
    /// The grid begins with the whole table. It is cut to the values that have a probability, and
    /// widened where the probability does not end, until no value of a parameter has much of the
    /// probability.
    pub fn posterior(&self, prediction: [f64; 2], curves: f64) -> Posterior {
        let observed = Observed {
            prediction,
            variance: 1.0 / curves + 1.0 / self.lines,
        };
        let [low, high] = self.ranges;
        let [soft, hard] = self.moduli;
        let whole = [
            Extent {
                low: low + soft,
                high: high + hard,
            },
            Extent {
                low: soft,
                high: hard,
            },
        ];
        let mut extents = whole;
        let mut posterior = self.on_grid(&observed, extents);
        for _ in 1..MOST_GRIDS {
            let next = [0, 1].map(|axis| posterior.extent(axis, whole[axis]));
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
        let axes = extents.map(Extent::values);
        let mut weights = Vec::with_capacity(axes[0].len() * axes[1].len());
        for work in &axes[0] {
            for modulus in &axes[1] {
                weights.push(self.logarithm(
                    observed,
                    Place {
                        range: work - modulus,
                        modulus: *modulus,
                    },
                ));
            }
        }
        let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        for weight in &mut weights {
            *weight = (*weight - largest).exp();
            sum += *weight;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Posterior {
            axes,
            weights,
            ranges: self.ranges,
            moduli: self.moduli,
        }
    }

    /// Returns the logarithm of the probability density, up to a constant. A power in place of an
    /// exponential allows for the uncertain covariance of few profiles (Student's t-distribution).
    fn logarithm(&self, observed: &Observed, place: Place) -> f64 {
        let [low, high] = self.ranges;
        let rounding = 1e-9;
        if place.range < low - rounding || place.range > high + rounding {
            return f64::NEG_INFINITY;
        }
        let moments = self.scatter.at(place);
        let (inverse, determinant) = moments.inverse();
        let square = distance(moments.mean, inverse, observed.prediction) / observed.variance;
        -0.5 * determinant - 0.5 * self.lines * (square / (self.lines - 1.0)).ln_1p()
    }
}

impl Extent {
    fn width(self) -> f64 {
        self.high - self.low
    }

    /// Evenly spaced values; one value if the width is 0.
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
    /// Returns the probability of each value of ln γ for axis 0, and of ln E* for axis 1.
    fn along(&self, axis: usize) -> Vec<f64> {
        let moduli = self.axes[1].len();
        let mut sums = vec![0.0; self.axes[axis].len()];
        for (index, weight) in self.weights.iter().enumerate() {
            let value = if axis == 0 {
                index / moduli
            } else {
                index % moduli
            };
            sums[value] += weight;
        }
        sums
    }

    /// Returns the values of an axis that the next grid should have, within `whole`: the same
    /// values if this grid is fine and wide enough.
    fn extent(&self, axis: usize, whole: Extent) -> Extent {
        let values = &self.axes[axis];
        let last = values.len() - 1;
        let present = Extent {
            low: values[0],
            high: values[last],
        };
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
            let low = if grows_below {
                present.low - present.width()
            } else {
                present.low
            };
            let high = if grows_above {
                present.high + present.width()
            } else {
                present.high
            };
            return Extent {
                low: low.max(whole.low),
                high: high.min(whole.high),
            };
        }
        let most = probabilities.iter().copied().fold(0.0, f64::max);
        if most <= MOST_AT_VALUE || present.width() < LEAST_STEP * CELLS as f64 {
            return present;
        }
        let first = first_present.saturating_sub(MARGIN);
        Extent {
            low: values[first],
            high: values[(last_present + MARGIN).min(last)],
        }
    }

    /// Returns the most probable place.
    pub fn best(&self) -> Place {
        let weights = self.weights.iter().enumerate();
        let most = weights
            .max_by(|one, other| one.1.total_cmp(other.1))
            .map_or(0, |(index, _)| index);
        let moduli = self.axes[1].len();
        let [work, modulus] = [self.axes[0][most / moduli], self.axes[1][most % moduli]];
        Place {
            range: work - modulus,
            modulus,
        }
    }

    /// Returns γ in J/m² for the parameter 0, and E* in Pa for the parameter 1.
    pub fn estimate(&self, parameter: usize) -> IntervalEstimate {
        let probabilities = self.along(parameter);
        let [low, value, high] =
            QUANTILES.map(|share| quantile(&self.axes[parameter], &probabilities, share).exp());
        IntervalEstimate { value, low, high }
    }

    /// Returns the largest γ in J/m² that is not excluded at the level of 5 %: its probability
    /// density is at least exp(−1.96²/2) times the largest one.
    pub fn most_work(&self) -> f64 {
        let densities = self.along(0);
        let largest = densities.iter().copied().fold(0.0, f64::max);
        let last = densities
            .iter()
            .rposition(|density| *density >= NOT_EXCLUDED * largest);
        self.axes[0][last.unwrap_or(densities.len() - 1)].exp()
    }

    /// Returns the mean of a function of ln γ and ln E*.
    fn mean(&self, of: impl Fn(f64, f64) -> f64) -> f64 {
        let moduli = self.axes[1].len();
        let mut sum = 0.0;
        for (index, weight) in self.weights.iter().enumerate() {
            sum += weight * of(self.axes[0][index / moduli], self.axes[1][index % moduli]);
        }
        sum
    }

    /// Returns the correlation of ln γ and ln E*; 0 for a known E*.
    pub fn correlation(&self) -> f64 {
        if self.axes[1].len() == 1 {
            return 0.0;
        }
        let [work, modulus] = [self.mean(|work, _| work), self.mean(|_, modulus| modulus)];
        let variances = [
            self.mean(|other, _| (other - work).powi(2)),
            self.mean(|_, other| (other - modulus).powi(2)),
        ];
        let covariance = self.mean(|one, other| (one - work) * (other - modulus));
        let scale = (variances[0] * variances[1]).sqrt();
        if scale > 0.0 {
            (covariance / scale).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// Returns the ends of the table beyond which the parameters may lie.
    pub fn beyond(&self) -> Vec<End> {
        let ([low, high], [soft, hard]) = (self.ranges, self.moduli);
        let is_near = |work: f64, modulus: f64, end: End| match end {
            End::LowRange => work - modulus < low + EDGE,
            End::HighRange => work - modulus > high - EDGE,
            End::LowModulus => hard > soft && modulus < soft + EDGE,
            End::HighModulus => hard > soft && modulus > hard - EDGE,
        };
        let mut ends = vec![
            End::LowRange,
            End::HighRange,
            End::LowModulus,
            End::HighModulus,
        ];
        ends.retain(|end| {
            self.mean(|work, modulus| {
                if is_near(work, modulus, *end) {
                    1.0
                } else {
                    0.0
                }
            }) > MOST_AT_END
        });
        ends
    }
}

/// Returns the value below which a parameter lies with the probability `share`. The density is
/// linear between the values of the axis, at which it is in proportion to `probabilities`.
fn quantile(values: &[f64], probabilities: &[f64], share: f64) -> f64 {
    let cells = || {
        probabilities
            .windows(2)
            .map(|ends| 0.5 * (ends[0] + ends[1]))
    };
    let mut rest = share * cells().sum::<f64>();
    for (index, cell) in cells().enumerate() {
        if rest <= cell {
            let [from, to] = [probabilities[index], probabilities[index + 1]];
            // The positive root of from·x + (to − from)·x²/2 = rest.
            let root = (from * from + 2.0 * (to - from) * rest).max(0.0).sqrt();
            let part = if from + root > 0.0 {
                2.0 * rest / (from + root)
            } else {
                0.0
            };
            return values[index] + part.clamp(0.0, 1.0) * (values[index + 1] - values[index]);
        }
        rest -= cell;
    }
    values[values.len() - 1]
}

/// Results of one measured curve when it is used without the others.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve, as it was given to [`fit_ensemble`](crate::fit_ensemble).
    pub name: String,
    /// Preload of the curve, which is its largest force, N.
    pub preload: f64,
    /// Largest tensile force of the retraction as a positive number, N; `None` if it is at most 5
    /// times the noise of the force.
    pub pull_off_force: Option<f64>,
    /// Energy dissipated in the loop, J: area between approach and retraction over the displacement
    /// of the instrument.
    pub loop_area: f64,
    /// Stiffness at the beginning of the retraction, N/m: half the preload, divided by the change
    /// of the displacement while the force falls from the preload to half the preload.
    pub stiffness: f64,
    /// Work of adhesion found from this single curve, J/m².
    pub work: IntervalEstimate,
    /// True if the interval of [`Self::work`] ends where the values end for which curves were
    /// computed. The true interval is then wider.
    pub at_end_of_table: bool,
    /// True if the values of γ and E* found from this curve are further from the mean of the random
    /// profiles than the values found from 999 of 1000 random profiles (Mahalanobis distance).
    pub foreign: bool,
}

/// Table of computed curves with the polynomials learned from it.
pub(crate) struct Compared {
    polynomials: Learned,
    has_one_modulus: bool,
    /// Predicted ln γ and ln E* of each random profile at each node.
    pub learned: Vec<Vec<[f64; 2]>>,
    pub scatter: Scatter,
    likelihood: Likelihood,
    /// Predicted ln γ and ln E* of each measured curve.
    of_curves: Vec<[f64; 2]>,
}

impl Compared {
    pub fn new(table: &Table, measured: &Measured, known: Option<f64>) -> Self {
        let places: Vec<Place> = table.places().collect();
        let curves: Vec<_> = table
            .lines
            .iter()
            .enumerate()
            .flat_map(|(line, curves)| {
                let of = curves.iter().zip(&places);
                of.map(move |(curve, place)| {
                    (
                        line as u64,
                        measured.described(*curve, line),
                        place.parameters(),
                    )
                })
            })
            .collect();
        let polynomials = Learned::from(&curves);
        let has_one_modulus = table.moduli.len() == 1;
        let of_line = |(line, described, _): &(u64, Described, [f64; 2])| {
            alone(polynomials.of_line(*line, described), has_one_modulus)
        };
        let learned: Vec<Vec<[f64; 2]>> = curves
            .chunks(places.len())
            .map(|line| line.iter().map(of_line).collect())
            .collect();
        let scatter = Scatter::of(table, |line, node| learned[line][node]);
        let likelihood = Likelihood::new(table, &scatter, known);
        let of_curve = |(index, curve): (usize, &Summaries)| {
            alone(
                polynomials.of_curve(&measured.described(*curve, index)),
                has_one_modulus,
            )
        };
        let of_curves = measured
            .summaries
            .iter()
            .enumerate()
            .map(of_curve)
            .collect();
        Compared {
            polynomials,
            has_one_modulus,
            learned,
            scatter,
            likelihood,
            of_curves,
        }
    }

    /// Predicts ln γ and ln E* of another computed curve of a random profile.
    pub fn of_line(&self, line: usize, curve: &Summaries, measured: &Measured) -> [f64; 2] {
        let described = measured.described(*curve, line);
        alone(
            self.polynomials.of_line(line as u64, &described),
            self.has_one_modulus,
        )
    }

    /// Returns the probability of the parameters given all measured curves.
    pub fn posterior(&self, measured: &Measured) -> Posterior {
        let of = |index: usize| {
            mean(
                &self
                    .of_curves
                    .iter()
                    .map(|of| of[index])
                    .collect::<Vec<_>>(),
            )
        };
        self.likelihood
            .posterior([of(0), of(1)], measured.summaries.len() as f64)
    }

    /// Returns the standard deviation of the measured curves divided by the standard deviation of
    /// the random profiles.
    pub fn scatter_ratio(&self, measured: &Measured, best: Place) -> Option<f64> {
        let count = self.of_curves.len();
        let inverse = self.scatter.at(best).inverse().0;
        let centre = [0, 1].map(|index| {
            mean(
                &self
                    .of_curves
                    .iter()
                    .map(|of| of[index])
                    .collect::<Vec<_>>(),
            )
        });
        let sum: f64 = self
            .of_curves
            .iter()
            .map(|of| distance(centre, inverse, *of))
            .sum();
        let values = if self.has_one_modulus { 1.0 } else { 2.0 };
        (measured.summaries.len() >= FEWEST_FOR_SCATTER)
            .then(|| (sum / (count as f64 - 1.0) / values).sqrt())
    }

    /// Returns the results of each curve used without the others.
    pub fn rows(
        &self,
        curves: &[(String, MeasuredCurve)],
        measured: &Measured,
        best: Place,
    ) -> Vec<CurveOfEnsemble> {
        let moments = self.scatter.at(best);
        let inverse = moments.inverse().0;
        let row = |(index, (name, _)): (usize, &(String, MeasuredCurve))| {
            let (of, at) = (measured.summaries[index], self.of_curves[index]);
            let posterior = self.likelihood.posterior(at, 1.0);
            let away =
                distance(moments.mean, inverse, at) / (1.0 + 1.0 / self.learned.len() as f64);
            CurveOfEnsemble {
                name: name.clone(),
                preload: measured.preloads[index],
                pull_off_force: Some(of[PULL_OFF].exp())
                    .filter(|force| *force > LEAST_PULL_OFF * measured.protocols[index].noise),
                loop_area: of[LOOP_AREA].exp(),
                stiffness: 0.5 * measured.protocols[index].preload / of[WAY_TO_HALF].exp(),
                work: posterior.estimate(0),
                at_end_of_table: !posterior.beyond().is_empty(),
                foreign: away > FOREIGN[usize::from(!self.has_one_modulus)],
            }
        };
        curves.iter().enumerate().map(row).collect()
    }
}

/// Returns the predicted values, with 0 for the second one if the table has one modulus.
fn alone(values: [f64; 2], has_one_modulus: bool) -> [f64; 2] {
    if has_one_modulus {
        [values[0], 0.0]
    } else {
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// A relation of second degree is learned, by each half from its own lines.
    #[test]
    fn a_polynomial_of_second_degree_is_learned() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut random = || {
            let summaries: Summaries = std::array::from_fn(|_| generator.random_range(-1.0..1.0));
            Described {
                summaries,
                preload: Some(generator.random_range(5.0..6.0)),
            }
        };
        let parameters = |of: &Described| {
            let [one, other, third] = [of.summaries[0], of.summaries[4], of.preload.unwrap()];
            [3.0 + one - 2.0 * other * third, 7.0 * one * one - other]
        };
        let curves: Vec<_> = (0..2000)
            .map(|index| {
                let of = random();
                // The lines of one half are off by 1: the other half does not learn it.
                let [work, modulus] = parameters(&of);
                (
                    index % 16,
                    of,
                    [work + f64::from(u8::from(index % 2 == 0)), modulus],
                )
            })
            .collect();
        let learned = Learned::from(&curves);
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

    /// Learned values that are the parameters themselves, whose deviations over the profiles have
    /// this standard deviation and this correlation of ln γ and ln E*.
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
        let places: Vec<Place> = table.places().collect();
        table.lines = vec![vec![[0.0; SUMMARIES]; places.len()]; lines];
        // Two uncorrelated values of each profile, of this standard deviation.
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

    /// Asserts that an interval of a parameter is that of a normal distribution.
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

    /// For scatters from a ten-thousandth of a step of the table to a whole step, alone and with
    /// strong correlation, the intervals are those of normal distributions.
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

    /// A probability that the table cuts off, or that fills the whole table, has an interval within
    /// the table.
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
