//! The self-affine spectrum of largest likelihood: C2D is constant below a roll-off wave number and
//! proportional to q^(−2−2H) above it.

use super::grid_model::GridModel;
use super::isotropic::{IsotropicSpectrum, cut};
use super::likelihood::{Model, misfit};
use super::moments::ValueWithError;
use super::scoring::{Linearised, Minimum, Objective, descend};
use std::f64::consts::LN_10;

/// Smallest gain of the log-likelihood with which a roll-off is added to the fit. By chance, an
/// unnecessary parameter reaches this gain once in a hundred times.
const LEAST_GAIN: f64 = 3.3;

/// Number of roll-off wave numbers per decade from which the search starts.
const STARTS_PER_DECADE: f64 = 4.0;

/// Number of steps of the search from each of these wave numbers.
const FEW_STEPS: usize = 6;

/// Largest number of further steps from the best result of these searches.
const MOST_STEPS: usize = 60;

/// Smallest and largest Hurst exponent that the search allows.
const HURST: [f64; 2] = [-0.5, 1.5];

/// Hurst exponent from which the search starts.
const INITIAL_HURST: f64 = 0.7;

/// Largest share of the range of ln q that may lie below the roll-off. The remaining third is
/// needed to determine the Hurst exponent.
const LARGEST_ROLL_OFF: f64 = 0.67;

/// Number of parameters of a fit with a roll-off: level, exponent and roll-off.
const WITH_ROLL_OFF: usize = 3;

/// Number of parameters of a fit without a roll-off: level and exponent.
const WITHOUT_ROLL_OFF: usize = 2;

/// Self-affine spectrum fitted to the powers of measured waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineFit {
    /// Hurst exponent H.
    pub hurst: ValueWithError,
    /// Roll-off wave number in rad/m; `None` if the fitted spectrum has no roll-off.
    pub roll_off: Option<ValueWithError>,
    /// Two-dimensional spectral density C2D in m⁴ at the roll-off wave number. If there is no
    /// roll-off, it is C2D at the first wave number of the fit.
    pub level: ValueWithError,
}

impl SelfAffineFit {
    /// Returns the power spectral density in m³ of a cut at a wave number in rad/m. A cut is a
    /// profile measured across the surface. `range` has the first and the last wave number of the
    /// surface in rad/m.
    pub fn cut(&self, wave_number: f64, range: [f64; 2]) -> f64 {
        let [first, last] = range;
        let corner = match self.roll_off {
            Some(roll_off) => roll_off.value,
            None => first,
        };
        let level = self.level.value;
        let exponent = -2.0 - 2.0 * self.hurst.value;
        let c2d = |q: f64| level * (q / corner).max(1.0).powf(exponent);
        cut(c2d, wave_number, last)
    }
}

/// Self-affine spectrum of largest likelihood, without standard errors.
#[derive(Clone, Copy)]
pub(super) struct PowerLaw {
    parameters: Parameters,
    /// Number of parameters that were fitted.
    free: usize,
    /// Negative logarithm of the likelihood of the observations for this spectrum.
    pub misfit: f64,
    /// Hurst exponent of a spectrum with a roll-off.
    hurst_with_roll_off: f64,
}

/// Finds the self-affine spectrum of largest likelihood for the observations of a model. Returns
/// `None` if the search does not converge.
pub(super) fn find_power_law(model: &Model<'_>) -> Option<PowerLaw> {
    let model = GridModel::new(model);
    let search = Search::new(&model);
    let without = search.without_roll_off()?;
    let with = search.with_roll_off();
    let hurst_with_roll_off = match with {
        Some(with) => with.parameters.hurst,
        None => without.parameters.hurst,
    };
    let (best, free) = match with {
        Some(with) if without.value - with.value > LEAST_GAIN => (with, WITH_ROLL_OFF),
        _ => (without, WITHOUT_ROLL_OFF),
    };
    Some(PowerLaw {
        parameters: best.parameters,
        free,
        misfit: best.value,
        hurst_with_roll_off,
    })
}

impl PowerLaw {
    pub fn hurst(&self) -> f64 {
        self.parameters.hurst
    }

    /// Returns a factor of at least 1, by which the standard errors are multiplied because the
    /// surface may not be self-affine. The factor follows from the comparison of two fits to the
    /// same observations: this spectrum, and `isotropic`, which may have any smooth shape.
    pub fn scale(&self, model: &Model<'_>, isotropic: &IsotropicSpectrum) -> f64 {
        // For a self-affine surface, twice the difference of the misfits equals in the mean the
        // number of additional parameters of the isotropic spectrum.
        let misfit_of_nodes = misfit(model.observations, model.means(&isotropic.values));
        let excess = 2.0 * (self.misfit - misfit_of_nodes);
        let further = isotropic.values.len() - self.free;
        (excess / further as f64).max(1.0).sqrt()
    }

    /// Returns the fit with its standard errors, each multiplied by `scale`. Returns `None` if the
    /// Hurst exponent is not between 0 and 1, or if the observations do not determine the errors.
    pub fn with_errors(&self, model: &Model<'_>, scale: f64) -> Option<SelfAffineFit> {
        let parameters = self.parameters;
        let model = GridModel::new(model);
        let likelihood = Search::new(&model).likelihood(self.free);
        let information = likelihood.linearise(&parameters).factor()?;
        let error = |index: usize| scale * information.standard_error(index);
        let is_possible = 0.0 < parameters.hurst && parameters.hurst < 1.0;
        if !is_possible {
            return None;
        }
        let roll_off = if self.free == WITH_ROLL_OFF {
            Some(exponential(parameters.roll_off, error(2)))
        } else {
            None
        };
        Some(SelfAffineFit {
            hurst: ValueWithError {
                value: parameters.hurst,
                // A roll-off may exist although the observations do not show it clearly. The change
                // of the exponent due to a roll-off is therefore part of the error.
                error: error(1).hypot(self.hurst_with_roll_off - parameters.hurst),
            },
            roll_off,
            level: exponential(parameters.level, error(0)),
        })
    }
}

/// Returns e to the power of a value, with the standard error that follows from `error`.
fn exponential(value: f64, error: f64) -> ValueWithError {
    ValueWithError {
        value: value.exp(),
        error: value.exp() * error,
    }
}

/// Parameters of the self-affine fit.
#[derive(Clone, Copy, Debug)]
struct Parameters {
    /// ln C2D at the roll-off, with C2D in m⁴.
    level: f64,
    /// Hurst exponent H.
    hurst: f64,
    /// ln q of the roll-off, with q in rad/m.
    roll_off: f64,
}

impl Parameters {
    /// Returns C2D in m⁴ at ln q.
    fn c2d(&self, ln_q: f64) -> f64 {
        (self.level - self.exponent() * (ln_q - self.roll_off).max(0.0)).exp()
    }

    /// Returns C2D in m⁴ at the wave numbers of the grid of a model.
    fn values(&self, model: &GridModel<'_>) -> Vec<f64> {
        model.ln_q.iter().map(|&ln_q| self.c2d(ln_q)).collect()
    }

    fn exponent(&self) -> f64 {
        2.0 + 2.0 * self.hurst
    }

    /// Returns the parameters from which a search with this initial roll-off starts.
    fn initial(model: &GridModel<'_>, roll_off: f64) -> Parameters {
        let mut parameters = Parameters {
            level: 0.0,
            hurst: INITIAL_HURST,
            roll_off,
        };
        let mut sum = 0.0;
        let mut waves = 0.0;
        let values = parameters.values(model);
        for (observed, mean) in model.observations.iter().zip(model.means(&values)) {
            if observed.power > 0.0 && mean > 0.0 {
                sum += observed.waves * (observed.power / mean).ln();
                waves += observed.waves;
            }
        }
        parameters.level = sum / waves.max(1.0);
        parameters
    }
}

/// Search for the parameters of the spectrum, with a limited range of roll-off wave numbers.
struct Search<'a> {
    model: &'a GridModel<'a>,
    /// Smallest and largest ln q of a roll-off.
    roll_off: [f64; 2],
}

impl<'a> Search<'a> {
    fn new(model: &'a GridModel<'_>) -> Self {
        let low = model.nodes.first;
        let high = low + model.nodes.step * (model.nodes.count - 1) as f64;
        Search {
            model,
            roll_off: [low, low + LARGEST_ROLL_OFF * (high - low)],
        }
    }

    fn without_roll_off(&self) -> Option<Minimum<Parameters>> {
        let start = Parameters::initial(self.model, self.model.nodes.first);
        descend(&self.likelihood(WITHOUT_ROLL_OFF), start, MOST_STEPS)
    }

    /// Searches with a roll-off: first a few steps from each of several roll-off wave numbers, then
    /// more steps from the best result.
    fn with_roll_off(&self) -> Option<Minimum<Parameters>> {
        let [low, high] = self.roll_off;
        let starts = (STARTS_PER_DECADE * (high - low) / LN_10).ceil().max(1.0);
        let mut best: Option<Minimum<Parameters>> = None;
        for index in 1..=starts as usize {
            let roll_off = low + (high - low) * index as f64 / starts;
            let Some(found) = self.near(roll_off) else {
                continue;
            };
            if best.is_none_or(|best| found.value < best.value) {
                best = Some(found);
            }
        }
        let likelihood = self.likelihood(WITH_ROLL_OFF);
        descend(&likelihood, best?.parameters, MOST_STEPS)
    }

    /// Searches from one roll-off wave number: first only for the level and the exponent, then for
    /// all three parameters.
    fn near(&self, roll_off: f64) -> Option<Minimum<Parameters>> {
        let start = Parameters::initial(self.model, roll_off);
        let fixed = descend(&self.likelihood(WITHOUT_ROLL_OFF), start, FEW_STEPS)?;
        let likelihood = self.likelihood(WITH_ROLL_OFF);
        descend(&likelihood, fixed.parameters, FEW_STEPS)
    }

    /// Returns the negative log-likelihood as a function of the first `free` parameters.
    fn likelihood(&self, free: usize) -> SelfAffineLikelihood<'a> {
        SelfAffineLikelihood {
            model: self.model,
            free,
            roll_off: self.roll_off,
        }
    }
}

/// The negative log-likelihood as a function of the first `free` parameters.
struct SelfAffineLikelihood<'a> {
    model: &'a GridModel<'a>,
    free: usize,
    /// Smallest and largest ln q of a roll-off.
    roll_off: [f64; 2],
}

impl Objective for SelfAffineLikelihood<'_> {
    type Parameters = Parameters;

    fn value(&self, parameters: &Parameters) -> f64 {
        let values = parameters.values(self.model);
        misfit(self.model.observations, self.model.means(&values))
    }

    fn linearise(&self, parameters: &Parameters) -> Linearised {
        let free = self.free;
        let mut linearised = Linearised::zeros(free);
        let values = parameters.values(self.model);
        // The derivatives of C2D with respect to H and to ln q of the roll-off.
        let mut by_hurst = Vec::with_capacity(values.len());
        let mut by_roll_off = Vec::with_capacity(values.len());
        for (&ln_q, value) in self.model.ln_q.iter().zip(&values) {
            let above = (ln_q - parameters.roll_off).max(0.0);
            by_hurst.push(-2.0 * above * value);
            by_roll_off.push(if above > 0.0 {
                parameters.exponent() * value
            } else {
                0.0
            });
        }
        for (observed, sum) in self.model.observations.iter().zip(&self.model.sums) {
            let mean = sum.of(&values);
            let slope = [mean, sum.of(&by_hurst), sum.of(&by_roll_off)];
            let residual = observed.waves * (1.0 - observed.power / mean);
            for row in 0..free {
                linearised.gradient[row] += residual * slope[row] / mean;
                for column in 0..=row {
                    let product = observed.waves * slope[row] * slope[column];
                    linearised.information[row * free + column] += product / (mean * mean);
                }
            }
        }
        linearised
    }

    fn moved(&self, parameters: &Parameters, step: &[f64], share: f64) -> Parameters {
        // `step` has no element for the roll-off if the roll-off is not fitted.
        let limited = |index: usize, most: f64| match step.get(index) {
            Some(step) => (share * step).clamp(-most, most),
            None => 0.0,
        };
        let [low, high] = self.roll_off;
        Parameters {
            level: parameters.level - limited(0, 3.0),
            hurst: (parameters.hurst - limited(1, 0.3)).clamp(HURST[0], HURST[1]),
            roll_off: (parameters.roll_off - limited(2, 0.7)).clamp(low, high),
        }
    }
}
