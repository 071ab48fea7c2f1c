//! Parameters γ and E* that are predicted from the summaries of computed and of measured curves,
//! and the results of each measured curve.

use super::estimate::IntervalEstimate;
use super::likelihood::Likelihood;
use super::polynomials::{Example, Polynomials};
use super::posterior::Posterior;
use super::scatter::Scatter;
use super::summary::{LOOP_AREA, Measurement, PULL_OFF, Summaries, WAY_TO_HALF};
use super::table::{MODULUS, Place, Table, WORK};
use crate::curve::MeasuredCurve;
use asperity_data::mean;

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
    /// True if the interval of [`Self::work`] reaches an end of the range of values for which
    /// curves were computed. The true interval is then wider.
    pub at_end_of_table: bool,
    /// True if this curve hardly belongs to the same specimen as the others. The distance of its ln
    /// γ and ln E* from the mean of the random profiles (Mahalanobis distance) is then larger than
    /// for 999 of 1000 random profiles.
    pub foreign: bool,
}

/// Predictions of the parameters of computed and of measured curves, by polynomials that are
/// learned from a table.
pub(crate) struct Predictions {
    polynomials: Polynomials,
    /// True if the table has a single E*, because E* is given.
    has_one_modulus: bool,
    /// Predicted ln γ and ln E*, for each random profile and each node. A node is a pair of values
    /// for which curves were computed.
    pub of_profiles: Vec<Vec<[f64; 2]>>,
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
        let mut of_profiles = Vec::with_capacity(table.profiles.len());
        for profile in examples.chunks(table.places().len()) {
            let predict = |example: &Example| {
                let prediction = polynomials.of_profile(example.half, &example.description);
                without_modulus_if(has_one_modulus, prediction)
            };
            of_profiles.push(profile.iter().map(predict).collect::<Vec<_>>());
        }
        let mut of_curves = Vec::with_capacity(measured.summaries.len());
        for (index, summaries) in measured.summaries.iter().enumerate() {
            let prediction = polynomials.of_curve(&measured.describe(*summaries, index));
            of_curves.push(without_modulus_if(has_one_modulus, prediction));
        }
        let scatter = Scatter::of(table, |profile, node| of_profiles[profile][node]);
        Predictions {
            likelihood: Likelihood::new(table, &scatter, known),
            polynomials,
            has_one_modulus,
            of_profiles,
            scatter,
            of_curves,
        }
    }

    /// Predicts ln γ and ln E* of a further computed curve of a random profile of the table.
    pub fn of_profile(
        &self,
        profile: usize,
        curve: &Summaries,
        measured: &Measurement,
    ) -> [f64; 2] {
        let description = measured.describe(*curve, profile);
        let half = measured.half(profile);
        let prediction = self.polynomials.of_profile(half, &description);
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

    /// Returns for each measured curve the results that this curve alone would give.
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
        let variance = 1.0 + 1.0 / self.of_profiles.len() as f64;
        let errors = self.scatter.error_of_steps(best);
        let moments = self.scatter.at(best).with_errors(variance, errors);
        let relative = moments
            .inverse()
            .squared_distance(moments.mean, self.of_curves[index]);
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
    let mut examples = Vec::with_capacity(table.profiles.len() * places.len());
    for (profile, curves) in table.profiles.iter().enumerate() {
        for (curve, place) in curves.iter().zip(&places) {
            examples.push(Example {
                half: measured.half(profile),
                description: measured.describe(*curve, profile),
                parameters: place.parameters(),
            });
        }
    }
    examples
}

/// Returns a prediction of ln γ and ln E*. If the table has a single E*, the predicted ln E* means
/// nothing and is replaced by 0.
fn without_modulus_if(has_one_modulus: bool, prediction: [f64; 2]) -> [f64; 2] {
    if has_one_modulus {
        [prediction[WORK], 0.0]
    } else {
        prediction
    }
}
