//! Bodies on springs, and the solver for either kind of edges over them: the only interface between the checks and
//! the engine.

use super::Fault;
use crate::contact::{self, Contact, CurvePoint, Foundation, HessRule, History, LegRecord, Solver, run};
use crate::scene::{Edges, Move};
use crate::surface::{Line, SelfAffine, UnitRoughness, phases};
use std::f64::consts::{PI, TAU};

/// Springs under adhesion.
#[derive(Clone, Debug)]
pub struct Body {
    /// Gaps of the springs, m, the smallest 0.
    pub gaps: Vec<f64>,
    /// The springs.
    pub foundation: Foundation,
    /// Work of adhesion γ, J/m².
    pub work: f64,
}

/// E* of bodies whose modulus does not matter, Pa.
pub const MODULUS: f64 = 2.0e6;

/// Length of these bodies, m.
pub const LENGTH: f64 = 1.0e-4;

/// Rms height of these bodies, m.
pub const RMS_HEIGHT: f64 = 1.0e-7;

impl Body {
    /// A body from gaps or heights of either sign: the highest point becomes gap 0.
    #[must_use]
    pub fn below(mut heights: Vec<f64>, length: f64, effective_modulus: f64, work: f64) -> Body {
        let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        heights.iter_mut().for_each(|height| *height = summit - *height);
        let foundation = Foundation::endless(length / heights.len() as f64, effective_modulus);
        Body { gaps: heights, foundation, work }
    }

    /// A self-affine body of [`LENGTH`], [`RMS_HEIGHT`] and [`MODULUS`].
    ///
    /// # Errors
    /// Errors of the synthesis.
    pub fn rough(spectrum: SelfAffine, seed: u64, points: usize, work: f64) -> Result<Body, Fault> {
        let rough = UnitRoughness::synthesize(spectrum, seed, points)?;
        let line = Line::new(LENGTH, points, None, Some(&rough.heights), RMS_HEIGHT)?;
        let foundation = Foundation::endless(line.spacing, MODULUS);
        Ok(Body { gaps: line.gaps.to_vec(), foundation, work })
    }

    /// A body of one of several kinds: self-affine, noise, a few levels, a random walk. The adhesion ranges from
    /// almost none to far more than that of full contact; a seed determines the body everywhere.
    ///
    /// # Errors
    /// Errors of the synthesis.
    pub fn random(seed: u64) -> Result<Body, Fault> {
        let mut numbers = phases(seed, 1).map(|phase| phase / TAU);
        let mut next = || numbers.next().unwrap_or(0.0);
        let points = 20 + (300.0 * next()) as usize;
        // γ for which the largest stretch of the whole profile is 1e−3 to 3 rms heights.
        let reach = RMS_HEIGHT * 10.0_f64.powf(-3.0 + 3.5 * next());
        let work = reach * reach * MODULUS / (PI * LENGTH);
        let heights = match seed % 4 {
            0 => {
                let spectrum = SelfAffine { hurst: 0.1 + 0.8 * next(), first: 1, last: points as u64 / 2 };
                return Body::rough(spectrum, seed, points, work);
            }
            1 => (0..points).map(|_| RMS_HEIGHT * next()).collect(),
            2 => (0..points).map(|_| 0.25 * RMS_HEIGHT * (5.0 * next()).floor()).collect(),
            _ => {
                let mut height = 0.0;
                let step = RMS_HEIGHT / (points as f64).sqrt();
                (0..points)
                    .map(|_| {
                        height += step * (next() - 0.5);
                        height
                    })
                    .collect()
            }
        };
        Ok(Body::below(heights, LENGTH, MODULUS, work))
    }

    /// Largest gap, m.
    #[must_use]
    pub fn deepest(&self) -> f64 {
        self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// Largest stretch, m, of a fragment `cells` cells long, eq. (10).
    #[must_use]
    pub fn stretch(&self, cells: f64) -> f64 {
        (PI * cells * self.foundation.spacing * self.work / self.foundation.effective_modulus).sqrt()
    }

    /// Largest stretch of a fragment as long as the whole profile, m.
    #[must_use]
    pub fn largest_stretch(&self) -> f64 {
        self.stretch(self.gaps.len() as f64)
    }

    /// A force of the order of the acting ones, N.
    #[must_use]
    pub fn force_scale(&self) -> f64 {
        let stiffness = self.gaps.len() as f64 * self.foundation.spring_stiffness();
        stiffness * (self.deepest() + self.largest_stretch())
    }

    /// Result of `act` with a solver over this separated body and `samples` points on a loading stage.
    ///
    /// # Errors
    /// Errors of `act`, and insufficient memory.
    pub fn with<T>(
        &self,
        edges: Edges,
        samples: usize,
        act: impl FnOnce(&mut dyn Solver) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        let hess = (self.work > 0.0).then(|| HessRule::new(self.foundation, self.work));
        let contact = Contact::new(self.gaps.clone(), edges, self.foundation, hess);
        act(&mut contact::Body::new(&contact, samples))
    }

    /// A whole loading.
    ///
    /// # Errors
    /// Errors of a loading stage that cannot be computed.
    pub fn history(&self, edges: Edges, legs: &[Move], samples: usize) -> Result<History, Fault> {
        self.with(edges, samples, |solver| Ok(run(solver, legs, |_, _| Ok(()))?))
    }

    /// Turning points, as shares of the depth, that cover all states of a body: a first contact, minor loops, below
    /// first touch, full contact and back.
    #[must_use]
    pub fn tour(&self) -> Vec<Move> {
        let depth = self.deepest() + self.largest_stretch();
        let shares = [0.31, 0.123, 0.57, -0.017, 0.71, 0.69, 1.03, 0.43, 0.47, -0.07];
        let turns = shares.iter().map(|share| Move::ToIndentation(share * depth));
        turns.chain([Move::ToSeparation]).collect()
    }
}

/// End of a loading stage; separated at d = 0 if the stage has no point.
#[must_use]
pub fn end(record: &LegRecord) -> CurvePoint {
    record.curve.last().copied().unwrap_or_default()
}
