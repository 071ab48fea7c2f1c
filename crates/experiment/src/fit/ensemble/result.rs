//! Result of a comparison of measured curves with random profiles.

use super::deviation::{RoughnessShifts, SummaryDeviation};
use super::estimate::IntervalEstimate;
use super::predictions::CurveOfEnsemble;
use asperity_data::CountedWarning;

/// Result of [`fit_ensemble`](crate::fit_ensemble): the work of adhesion and the effective modulus
/// of one rough body, from curves measured at several places on it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ in J/m². Its interval begins at 0 if [`Self::work_at_most`] has a value.
    pub work: IntervalEstimate,
    /// Upper bound of γ in J/m² if curves without adhesion would have the same summaries; otherwise
    /// `None`.
    pub work_at_most: Option<f64>,
    /// Effective modulus E* in Pa. A given modulus has an interval of zero width.
    pub modulus: IntervalEstimate,
    /// True if the scene gives the effective modulus.
    pub modulus_is_given: bool,
    /// Work of adhesion on closing divided by the work of adhesion on opening, as the scene states
    /// it.
    pub closing_over_opening: f64,
    /// Correlation of the errors of ln γ and ln E*, from −1 to 1; 0 for a given E*.
    pub correlation: f64,
    /// Shares of the sources of error in the uncertainty of the work of adhesion.
    pub shares: Shares,
    /// Expected precision of the work of adhesion with 16, 64 and 256 measured curves. Numbers of
    /// curves that do not exceed the present one are left out.
    pub prospects: Vec<Prospect>,
    /// Effect of a wrong roughness of the scene on γ and E*; `None` if the scene has a measured
    /// roughness, or if γ has an upper bound only.
    pub roughness: Option<RoughnessShifts>,
    /// Sentence on the stiffness of the instrument, if the scene and the files of the curves state
    /// different values; otherwise `None`.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Premises of the model that the scene with the found values does not meet, each with the
    /// number of the [`Self::EXAMINED`] random profiles that do not meet it.
    #[serde(skip)]
    pub warnings: Vec<CountedWarning>,
    /// Number of random profiles with which the curves were compared.
    pub profiles: u64,
    /// Number of force curves computed on these profiles.
    pub computed: usize,
    /// Mean preload (largest force) in N of the measured curves.
    pub preload: f64,
    /// Standard deviation of the preloads divided by their mean; `None` if the preloads differ only
    /// by noise.
    pub preload_scatter: Option<f64>,
    /// Results of each measured curve when it is used without the others.
    pub curves: Vec<CurveOfEnsemble>,
    /// Standard deviation of ln γ between measured curves, divided by the standard deviation of ln
    /// γ between random profiles; usually 0.8 to 1.2. If E* is free, the ratio is the root mean
    /// square Mahalanobis distance of (ln γ, ln E*), divided by √2. `None` for fewer than 4 curves.
    pub scatter_ratio: Option<f64>,
    /// True if random profiles describe the measured curves: none of [`Self::deviations`] is
    /// significant.
    pub described: bool,
    /// Difference between the measured curves and the random profiles for each summary, a number
    /// computed from a curve such as its pull-off force.
    pub deviations: Vec<SummaryDeviation>,
    /// True if the interval of γ or E* reaches an end of the range of values for which curves were
    /// computed. The true interval is then wider.
    pub at_end_of_table: bool,
}

impl EnsembleFit {
    /// Number of random profiles on which the scene with the found values is computed for
    /// [`Self::warnings`].
    pub const EXAMINED: u64 = 5;
}

/// Sources of the uncertainty of the work of adhesion. The share of a source is its part of the
/// square of the half-width of the interval of ln γ. The shares add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shares {
    /// Share that comes from the limited number of measured curves.
    pub places: f64,
    /// Share that comes from the limited number of random profiles, and from the distances between
    /// the points of a curve. Nothing is known about the force between two points.
    pub profiles: f64,
    /// Share that comes from the stated errors of the roughness.
    pub roughness: f64,
}

/// Precision of the work of adhesion that a larger number of measured curves would give.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Prospect {
    /// Assumed number of measured curves: 16, 64 or 256.
    pub curves: u64,
    /// Half the width of the 95 % interval of ln γ with this number of curves.
    pub half_width: f64,
}
