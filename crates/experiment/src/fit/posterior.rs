//! The probability distribution of the parameters after a search: their errors, their correlations,
//! and the parameters that the curve does not determine.

use crate::curve::numerics::correlated_few;
use crate::fit::parameter::{Coordinate, Parameter, Values};
use crate::fit::result::{FittedParameter, RelaxedModulus};
use crate::fit::search::SearchResult;
use crate::fit::space::Space;
use crate::fit::statistics::{Spread, block_error, correlation, spread, widen};

/// Magnitude of the correlation of two parameters above which the curve does not separate them.
const CORRELATED: f64 = 0.95;
/// Half the width of the 95 % interval of the logarithm of a parameter above which the parameter is
/// undetermined.
const FLAT: f64 = 1.0;
/// Distance from the best value, in standard errors, above which another value that describes the
/// curve as well is a separate solution and widens the interval.
const ELSEWHERE: f64 = 5.0;
/// Factor by which the half-width of intervals is increased, because about 150 independent samples
/// determine a standard deviation only to 6 %.
const OF_SAMPLES: f64 = 1.06;
/// Half-width of the 95 % interval of a normal distribution, in standard deviations.
const NORMAL: f64 = 1.96;

/// Returns the modulus in Pa after a long time, for these values of the parameters.
fn relaxed_modulus(values: &Values) -> f64 {
    let share = values[Parameter::RelaxationShare as usize];
    values[Parameter::Modulus as usize] * (1.0 - share)
}

/// Probability distribution of the parameters after a search, from which their errors follow.
pub(crate) struct Posterior<'a> {
    space: &'a Space<'a>,
    result: &'a SearchResult,
    /// Samples whose deviations from the mean are increased, because residuals that correlate along
    /// the curve carry less information than independent residuals.
    widened: Vec<Vec<f64>>,
    /// The widened samples with another coordinate of the parameter `RelaxationShare`: the whole
    /// share of the modulus that relaxes, as in the results. In `widened` this coordinate is the
    /// part of the modulus that relaxes during the contact.
    shown: Vec<Vec<f64>>,
    /// Value of each parameter with which the model describes the curve best, in SI units.
    pub best: Values,
    /// True if the profile of the specimen differs from the random profile of the scene.
    has_other_profile: bool,
    /// True if a model without adhesion describes the curve too.
    is_without_adhesion: bool,
}

impl<'a> Posterior<'a> {
    pub fn new(space: &'a Space<'a>, result: &'a SearchResult, has_other_profile: bool) -> Self {
        let variance_factor = correlated_few(&result.residuals);
        let mut widened = result.samples.clone();
        widen(&mut widened, variance_factor.sqrt());
        let most_extra_cost = 0.5 * NORMAL * NORMAL * variance_factor;
        Posterior {
            space,
            result,
            shown: space.with_whole_shares(&widened),
            widened,
            best: space.values(&result.best.place),
            has_other_profile,
            is_without_adhesion: result.without_adhesion < most_extra_cost,
        }
    }

    /// Returns all free parameters with their errors.
    pub fn parameters(&self) -> Vec<FittedParameter> {
        let mut parameters = Vec::with_capacity(self.space.coordinates.len());
        for (index, coordinate) in self.space.coordinates.iter().enumerate() {
            let mut fitted = self.fitted(coordinate);
            if let Some(end) = self.space.end_at(index, &self.result.best.place) {
                fitted.set_at_end(end);
            }
            parameters.push(fitted);
        }
        parameters
    }

    /// Returns a parameter with its errors. The interval is that of the widened samples, and is at
    /// least as wide as a normal distribution with the standard error, which includes the scatter
    /// between blocks of the curve.
    fn fitted(&self, coordinate: &Coordinate) -> FittedParameter {
        let parameter = coordinate.parameter;
        let value = self.best[parameter as usize];
        let Spread {
            standard_deviation,
            interval: (low, high),
        } = spread(self.values_of(&self.widened, parameter)).unwrap_or(Spread::at(value));
        let samples = self.values_of(&self.result.samples, parameter);
        let blocks_error = block_error(&samples, &self.result.blocks);
        let noise_error = standard_deviation.max(blocks_error);

        let half_width = NORMAL * OF_SAMPLES * noise_error;
        let mut low = low.min(value - half_width);
        let mut high = high.max(value + half_width);
        for other in self.values_of(&self.result.alternatives, parameter) {
            if (other - value).abs() > ELSEWHERE * noise_error {
                low = low.min(other - half_width);
                high = high.max(other + half_width);
            }
        }
        if !parameter.is_signed() {
            low = low.max(0.0);
        }
        if parameter == Parameter::Work && self.is_without_adhesion {
            low = 0.0;
        }
        if parameter == Parameter::RelaxationShare {
            high = high.min(coordinate.range.1);
        }
        let is_meaningless = self.has_other_profile && !parameter.is_signed();
        FittedParameter {
            parameter,
            value,
            interval: if is_meaningless {
                coordinate.range
            } else {
                (low, high)
            },
            noise_error,
            start: coordinate.start,
            range: coordinate.range,
            at_end: None,
        }
    }

    /// Returns the values of one parameter in all samples.
    fn values_of(&self, samples: &[Vec<f64>], parameter: Parameter) -> Vec<f64> {
        samples
            .iter()
            .map(|place| self.space.values(place)[parameter as usize])
            .collect()
    }

    /// Returns the modulus after a long time; `None` if the half-space does not relax.
    pub fn relaxed_modulus(&self) -> Option<RelaxedModulus> {
        if !self.space.relaxes() {
            return None;
        }
        let value = relaxed_modulus(&self.best);
        let samples = self.widened.iter();
        let values = samples.map(|place| relaxed_modulus(&self.space.values(place)));
        let Spread {
            standard_deviation,
            interval: (low, high),
        } = spread(values.collect()).unwrap_or(Spread::at(value));
        let half_width = NORMAL * OF_SAMPLES * standard_deviation;
        Some(RelaxedModulus {
            value,
            interval: (
                low.min(value - half_width).max(0.0),
                high.max(value + half_width),
            ),
        })
    }

    /// Returns each pair of free parameters with the correlation of their errors, from −1 to 1.
    pub fn correlations(&self) -> Vec<(Parameter, Parameter, f64)> {
        let coordinates = &self.space.coordinates;
        let mut correlations = Vec::new();
        for first in 0..coordinates.len() {
            for second in first + 1..coordinates.len() {
                let value = correlation(&self.shown, [first, second]);
                let first = coordinates[first].parameter;
                let second = coordinates[second].parameter;
                correlations.push((first, second, value));
            }
        }
        correlations
    }

    /// Returns the pairs of parameters that the curve does not separate. A parameter that the curve
    /// does not determine is listed as a pair with itself.
    pub fn not_distinguished(&self) -> Vec<(Parameter, Parameter)> {
        let mut pairs = Vec::new();
        for (first, second, correlation) in self.correlations() {
            if correlation.abs() > CORRELATED {
                pairs.push((first, second));
            }
        }
        for (index, coordinate) in self.space.coordinates.iter().enumerate() {
            let parameter = coordinate.parameter;
            let is_in_pair = pairs
                .iter()
                .any(|(first, second)| *first == parameter || *second == parameter);
            if !is_in_pair && !self.is_determined(index, coordinate) {
                pairs.push((parameter, parameter));
            }
        }
        pairs
    }

    /// Returns true if the curve determines a parameter: its samples do not spread too widely, and
    /// do not reach an end of the range.
    fn is_determined(&self, index: usize, coordinate: &Coordinate) -> bool {
        if coordinate.parameter == Parameter::Work && self.is_without_adhesion {
            return false;
        }
        let samples = self.shown.iter().map(|place| place[index]).collect();
        let best = self.result.best.place[index];
        let (from, to) = spread(samples).unwrap_or(Spread::at(best)).interval;
        let width = to - from;
        let (low, high) = coordinate.ends();
        let is_wide = !coordinate.parameter.is_signed() && 0.5 * width > FLAT;
        let is_at_end = (from - low).min(high - to) < 0.01 * width;
        !is_wide && !is_at_end
    }

    /// Returns the upper bound of the work of adhesion in J/m² if the curve shows no adhesion;
    /// otherwise `None`.
    pub fn work_at_most(&self, parameters: &[FittedParameter]) -> Option<f64> {
        if !self.is_without_adhesion {
            return None;
        }
        let work = parameters
            .iter()
            .find(|fitted| fitted.parameter == Parameter::Work)?;
        Some(work.interval.1)
    }
}
