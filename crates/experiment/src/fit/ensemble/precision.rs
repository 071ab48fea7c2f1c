//! Precision of the work of adhesion: its sources, and how more curves would change it.

use super::estimate::IntervalEstimate;
use super::result::{Prospect, Shares};

/// Half-width of the 95 % interval of a normal distribution, in standard deviations.
pub(super) const NORMAL: f64 = 1.96;
/// Numbers of measured curves for which the expected precision is stated.
const PROSPECTS: [u64; 3] = [16, 64, 256];

/// Precision of the work of adhesion.
pub(super) struct Precision {
    /// Half the width of the 95 % interval of ln γ, without the errors of the roughness.
    pub half_width: f64,
    /// Half the width of the part of the 95 % interval of ln γ that results from the stated errors
    /// of the roughness.
    pub of_roughness: f64,
    /// Number of measured curves.
    pub curves: f64,
    /// Number of random profiles.
    pub profiles: f64,
    /// Variance of the error that comes from the finite distances between the points of a curve,
    /// divided by the variance over the random profiles.
    pub of_steps: f64,
}

impl Precision {
    /// Returns the variance of the mean prediction over `curves` curves, in units of the variance
    /// over the random profiles.
    fn variance(&self, curves: f64) -> f64 {
        1.0 / curves + 1.0 / self.profiles + self.of_steps
    }

    /// Returns how much each source contributes to the uncertainty of the work of adhesion. `work`
    /// is the estimate whose interval includes all errors.
    pub fn shares(&self, work: IntervalEstimate) -> Shares {
        let square = self.half_width.powi(2);
        let variance = self.variance(self.curves);
        let all = work.half_width().powi(2);
        Shares {
            places: square / self.curves / variance / all,
            profiles: square * (1.0 / self.profiles + self.of_steps) / variance / all,
            roughness: self.of_roughness.powi(2) / all,
        }
    }

    /// Returns the expected precision for larger numbers of curves.
    pub fn prospects(&self) -> Vec<Prospect> {
        let square = self.half_width.powi(2);
        let variance = self.variance(self.curves);
        let mut prospects = Vec::new();
        for curves in PROSPECTS {
            if curves as f64 > self.curves {
                let of_curves = square * self.variance(curves as f64) / variance;
                prospects.push(Prospect {
                    curves,
                    half_width: (of_curves + self.of_roughness.powi(2)).sqrt(),
                });
            }
        }
        prospects
    }
}
