//! A table of computed curves with the polynomials learned from it, and the measured curves.

use super::computed::Place;
use super::learn::{Described, Learned};
use super::measured::Measured;
use super::posterior::{Likelihood, Posterior};
use super::result::CurveOfEnsemble;
use super::scatter::{Scatter, distance};
use super::summary::{LOOP_AREA, PULL_OFF, Summaries, WAY_TO_HALF};
use super::table::Table;
use crate::curve::MeasuredCurve;
use asperity_data::mean;

/// Squared distance of a curve from the others that one curve of a thousand exceeds: quantiles of
/// χ² for one and for two values.
const FOREIGN: [f64; 2] = [10.8, 13.8];
/// Smallest pull-off force that is reported, in standard deviations of the noise.
const LEAST_PULL_OFF: f64 = 5.0;
const FEWEST_FOR_SCATTER: usize = 4;

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
