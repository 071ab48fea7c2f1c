//! Approach and retraction of a curve, over the distance from its turning point.

use crate::baseline::Baseline;
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};

/// Share of the points of a branch, and fewest points, through which a line gives the force at the turning point.
const NEAR_TURN: f64 = 0.02;
const FEWEST_NEAR_TURN: usize = 5;
/// Force at the end of the retraction, in standard deviations of the noise of its mean, above which contact is not lost.
const LOST: f64 = 5.0;
/// Share of the largest force up to which a force without contact may be off zero, by drift.
const NEAR_ZERO: f64 = 0.03;
/// Number of points at the end of the retraction that have lost the contact.
const FEWEST_FREE: usize = 5;

/// A displacement relative to the turning point, m, at most about 0, and the force there, N.
pub(crate) type Point = (f64, f64);

/// Approach and first retraction of a curve, each in the order of time.
pub(crate) struct Branches {
    pub approach: Vec<Point>,
    pub retraction: Vec<Point>,
    /// Standard deviation of the noise of the force, N.
    pub noise: f64,
    /// Number of the first points of the approach, which are before contact.
    pub free: usize,
}

impl Branches {
    /// Takes approach and retraction out of a measured curve,.
    ///
    /// # Errors
    /// The curve lacks one of them, or ends before the loss of contact.
    pub fn of(curve: &MeasuredCurve) -> Result<Self, ExperimentError> {
        let turn = curve.turns[0];
        let branch = |number: usize| -> Vec<Point> {
            let of = curve.points().zip(&curve.segment).filter(|(_, segment)| **segment == number);
            of.map(|((displacement, force), _)| (displacement - turn, force)).collect()
        };
        let (approach, retraction) = (branch(0), branch(1));
        if approach.len().min(retraction.len()) < 4 * FEWEST_NEAR_TURN || curve.free == 0 {
            let allowed = "an approach, which begins before contact, and its retraction";
            return refused("no approach and retraction of at least 20 points each", allowed);
        }
        let branches = Branches { approach, retraction, noise: curve.noise, free: curve.free };
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
        let largest = self.retraction.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
        mean.abs() > (LOST * self.noise / (FEWEST_FREE as f64).sqrt()).max(NEAR_ZERO * largest)
    }

    /// Largest force, N, by straight lines through the points of both branches beside the turning point.
    pub fn preload(&self) -> f64 {
        let of = |near: Vec<f64>| {
            let line = Baseline::through(&near);
            line.mean - 0.5 * (near.len() - 1) as f64 * line.slope
        };
        let count = |branch: &[Point]| ((NEAR_TURN * branch.len() as f64) as usize).max(FEWEST_NEAR_TURN);
        let before = self.approach.iter().rev().take(count(&self.approach)).map(|point| point.1).collect();
        let after = self.retraction.iter().take(count(&self.retraction)).map(|point| point.1).collect();
        0.5 * (of(before) + of(after))
    }

    /// Standard deviation of the preload due to the noise, N.
    pub fn preload_error(&self) -> f64 {
        // The end of a line through n points has a variance of 4/n.
        let count =
            (NEAR_TURN * self.approach.len().min(self.retraction.len()) as f64).max(FEWEST_NEAR_TURN as f64);
        self.noise * (2.0 / count).sqrt()
    }
}
