//! Approach and retraction of a curve over the distance from the turning point.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use asperity_data::{mean, standard_deviation};
use std::f64::consts::FRAC_1_SQRT_2;

/// Smallest number of points of a branch, and of its part without contact.
const FEWEST: usize = 20;
const FEWEST_FREE: usize = 5;
/// Mean force at the end of the retraction, in standard deviations of its noise, above which the
/// body is still in contact.
const LOST: f64 = 5.0;
/// Smallest noise divided by the largest force. Computed curves are not more accurate.
const LEAST_NOISE: f64 = 1e-4;
/// Share of the largest force by which a force without contact may differ from zero because of
/// drift.
const NEAR_ZERO: f64 = 0.03;

/// Displacement relative to the turning point in m, at most about 0, and the force in N.
pub(crate) type Point = (f64, f64);

/// Approach and first retraction of a curve, each in the order of time.
pub(crate) struct Branches {
    pub approach: Vec<Point>,
    pub retraction: Vec<Point>,
    /// Standard deviation of the noise of the force, N.
    pub noise: f64,
    /// Number of points at the beginning of the approach that give the zero and the noise of the
    /// force.
    pub free: usize,
}

impl Branches {
    /// Takes approach and retraction out of a measured curve.
    ///
    /// # Errors
    /// The curve lacks an approach or a retraction, or ends before the contact is lost.
    pub fn of(curve: &MeasuredCurve) -> Result<Self, ExperimentError> {
        let turn = curve.turns[0];
        let branch = |number: usize| -> Vec<Point> {
            let of = curve
                .points()
                .zip(&curve.segment)
                .filter(|(_, segment)| **segment == number);
            of.map(|((displacement, force), _)| (displacement - turn, force))
                .collect()
        };
        let (mut approach, mut retraction) = (branch(0), branch(1));
        if approach.len().min(retraction.len()) < FEWEST || curve.free < 2 * FEWEST_FREE {
            let allowed = "an approach, which begins before contact, and its retraction";
            return refused(
                "no approach and retraction of at least 20 points each",
                allowed,
            );
        }
        // The first contacts of a rough body are weak, and may lie in the part that seems to be
        // free.
        let free = curve.free / 2;
        let before: Vec<f64> = approach[..free.min(approach.len())]
            .iter()
            .map(|point| point.1)
            .collect();
        let zero = mean(&before);
        let points = approach.iter().chain(&retraction);
        let largest = points
            .map(|point| (point.1 - zero).abs())
            .fold(0.0, f64::max);
        let noise = standard_deviation(&before, zero).max(LEAST_NOISE * largest);
        let zero = if curve.is_estimated[0] { zero } else { 0.0 };
        [&mut approach, &mut retraction]
            .into_iter()
            .flatten()
            .for_each(|point| point.1 -= zero);
        let branches = Branches {
            approach,
            retraction,
            noise,
            free,
        };
        if branches.ends_in_contact() {
            return refused(
                "the retraction ends before contact is lost",
                "a retraction until the force is zero",
            );
        }
        Ok(branches)
    }

    fn ends_in_contact(&self) -> bool {
        let end = &self.retraction[self.retraction.len() - FEWEST_FREE..];
        let mean = end.iter().map(|point| point.1).sum::<f64>() / FEWEST_FREE as f64;
        let largest = self
            .retraction
            .iter()
            .map(|point| point.1.abs())
            .fold(0.0, f64::max);
        mean.abs() > (LOST * self.noise / (FEWEST_FREE as f64).sqrt()).max(NEAR_ZERO * largest)
    }

    /// Returns the force at the turning point in N, as the mean over the ends of both branches.
    pub fn preload(&self) -> f64 {
        0.5 * (self.approach[self.approach.len() - 1].1 + self.retraction[0].1)
    }

    /// Returns the standard deviation of the preload due to the noise, in N.
    pub fn preload_error(&self) -> f64 {
        self.noise * FRAC_1_SQRT_2
    }
}
