//! Summaries, preloads and noise of the measured curves.

use super::branches::Branches;
use super::computed::Protocol;
use super::deviation::Mean;
use super::learn::Described;
use super::summary::{Summaries, summaries};
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use asperity_data::{mean, median, standard_deviation};

/// Scatter of the preloads divided by the scatter due to noise, above which the preloads differ.
const DIFFERENT: f64 = 2.0;
/// Factor within which the noise of all curves must agree to be replaced by the median.
const ONE_NOISE: f64 = 1.5;

/// Measured curves as their summaries.
pub(crate) struct Measured {
    pub protocols: Vec<Protocol>,
    /// Largest force of each curve, N.
    pub preloads: Vec<f64>,
    /// Standard deviation of the preloads divided by their mean; `None` if they differ by noise
    /// only.
    pub preload_scatter: Option<f64>,
    pub summaries: Vec<Summaries>,
}

impl Measured {
    pub fn of(curves: &[(String, MeasuredCurve)]) -> Result<Self, ExperimentError> {
        let mut branches = Vec::with_capacity(curves.len());
        for (name, curve) in curves {
            let of = Branches::of(curve).map_err(|error| match error {
                ExperimentError::Refused { found, allowed } => ExperimentError::Refused {
                    found: format!("{name}: {found}"),
                    allowed,
                },
                error => error,
            })?;
            if of.preload() <= of.noise {
                return refused(
                    format!("{name}: the force at the turning point is not above the noise"),
                    "a preload",
                );
            }
            branches.push(of);
        }
        let noise =
            median(&mut branches.iter().map(|of| of.noise).collect::<Vec<_>>()).unwrap_or_default();
        let is_alike = |of: &Branches| (of.noise / noise).ln().abs() < ONE_NOISE.ln();
        if branches.iter().all(is_alike) {
            branches.iter_mut().for_each(|of| of.noise = noise);
        }
        let preloads: Vec<f64> = branches.iter().map(Branches::preload).collect();
        let average = mean(&preloads);
        let by_noise = mean(
            &branches
                .iter()
                .map(Branches::preload_error)
                .collect::<Vec<_>>(),
        );
        let scatter = standard_deviation(&preloads, average);
        let differ = curves.len() > 1 && scatter > DIFFERENT * by_noise;
        let preload_of = |index: usize| if differ { preloads[index] } else { average };
        let of = |(index, branches): (usize, &Branches)| summaries(branches, preload_of(index));
        let summaries = branches.iter().enumerate().map(of).collect();
        let of = |(index, branches): (usize, &Branches)| Protocol::of(branches, preload_of(index));
        let protocols = branches.iter().enumerate().map(of).collect();
        Ok(Measured {
            protocols,
            preload_scatter: differ.then(|| scatter / average),
            preloads,
            summaries,
        })
    }

    pub fn mean(&self) -> Mean {
        let of = |index: usize| {
            mean(
                &self
                    .summaries
                    .iter()
                    .map(|of| of[index])
                    .collect::<Vec<_>>(),
            )
        };
        Mean {
            summaries: std::array::from_fn(of),
            curves: self.summaries.len(),
        }
    }

    /// Returns the summaries of a curve, with its preload if the preloads differ.
    pub fn described(&self, summaries: Summaries, curve: usize) -> Described {
        let preload = self
            .preload_scatter
            .map(|_| self.protocols[curve % self.protocols.len()].preload.ln());
        Described { summaries, preload }
    }
}
