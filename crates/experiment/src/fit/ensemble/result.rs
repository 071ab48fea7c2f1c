//! The result of a comparison of curves with random profiles.

use super::posterior::IntervalEstimate;
use crate::fit::reason::Reason;

/// Options of [`fit_ensemble`](crate::fit_ensemble), which compares measured curves with random
/// profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles whose computed curves are compared with the measured curves, at
    /// least 16.
    pub lines: u64,
    /// True if the effective modulus is to be found too; false if its value in the scene is used.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the scene divided by this height; `None` if it is not
    /// stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent of the scene; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Result of [`fit_ensemble`](crate::fit_ensemble): the work of adhesion and the effective modulus
/// of one rough body, from curves measured at several places of it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ, J/m². Its interval begins at 0 if [`Self::work_at_most`] has a value.
    pub work: IntervalEstimate,
    /// Upper bound of γ in J/m² if curves without adhesion would have the same summaries; otherwise
    /// `None`.
    pub work_at_most: Option<f64>,
    /// Effective modulus E*, Pa. A given modulus has an interval of zero width.
    pub modulus: IntervalEstimate,
    /// True if the scene gives the effective modulus.
    pub modulus_is_given: bool,
    /// Work of adhesion on closing divided by the work of adhesion on opening, as the scene states
    /// it.
    pub closing_over_opening: f64,
    /// Correlation of the errors of ln γ and ln E*, from −1 to 1; 0 for a given E*.
    pub correlation: f64,
    /// Sources of the uncertainty of the work of adhesion.
    pub shares: Shares,
    /// Precision that the work of adhesion would have with 16, 64 and 256 measured curves. Only
    /// those of these numbers are listed that exceed the present number of curves.
    pub prospects: Vec<Prospect>,
    /// Effect of a wrong roughness of the scene on γ and E*; `None` if the scene has a measured
    /// roughness, or if γ has an upper bound only.
    pub roughness: Option<RoughnessShifts>,
    /// Sentence on the stiffness of the instrument if the scene and the files of the curves do not
    /// agree on it; otherwise `None`.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Why the profiles of the scene are not suitable with the fitted values: the contact fills
    /// most of the examined profiles, or few springs are in contact. `None` if they are suitable.
    pub unsuitable_profile: Option<Reason>,
    /// Number of random profiles with which the curves were compared.
    pub lines: u64,
    /// Number of force curves computed on these profiles.
    pub computed: usize,
    /// Mean preload (largest force) of the measured curves, N.
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
    /// True if the interval of γ or E* ends where the values end for which curves were computed.
    /// The true interval is then wider.
    pub at_end_of_table: bool,
}

/// Sources of the uncertainty of the work of adhesion, as shares of the squared half-width of the
/// interval of ln γ. Their sum is 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shares {
    /// Share of the uncertainty that comes from the limited number of measured curves.
    pub places: f64,
    /// Share of the uncertainty that comes from the limited number of random profiles.
    pub profiles: f64,
    /// Share of the uncertainty that comes from the stated errors of the roughness.
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

/// Derivatives of ln γ and ln E* with respect to ln h and to H, the rms height and Hurst exponent
/// of the scene. They show how far a wrong roughness shifts the result.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RoughnessShifts {
    /// Derivative of ln γ with respect to ln h.
    pub work_by_height: f64,
    /// Derivative of ln γ with respect to H.
    pub work_by_hurst: f64,
    /// Derivative of ln E* with respect to ln h.
    pub modulus_by_height: f64,
    /// Derivative of ln E* with respect to H.
    pub modulus_by_hurst: f64,
}

/// Results of one measured curve when it is used without the others.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve, as it was given to [`fit_ensemble`](crate::fit_ensemble).
    pub name: String,
    /// Preload of the curve, which is its largest force, N.
    pub preload: f64,
    /// Largest tensile force of the retraction as a positive number, N; `None` if it is at most 5
    /// times the noise of the force.
    pub pull_off_force: Option<f64>,
    /// Energy dissipated in the loop, J: area between approach and retraction over the displacement
    /// of the instrument.
    pub loop_area: f64,
    /// Stiffness at the beginning of the retraction, N/m: half the preload, divided by the change
    /// of the displacement while the force falls from the preload to half the preload.
    pub stiffness: f64,
    /// Work of adhesion found from this single curve, J/m².
    pub work: IntervalEstimate,
    /// True if the interval of [`Self::work`] ends where the values end for which curves were
    /// computed. The true interval is then wider.
    pub at_end_of_table: bool,
    /// True if the values of γ and E* found from this curve are further from the mean of the random
    /// profiles than the values found from 999 of 1000 random profiles (Mahalanobis distance).
    pub foreign: bool,
}

/// Difference between the measured curves and the random profiles in one summary. A summary is a
/// number computed from a curve, such as its pull-off force.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SummaryDeviation {
    /// Name of the summary, such as `pull-off force`.
    pub summary: &'static str,
    /// Mean of the natural logarithm of the summary over the measured curves, minus the mean over
    /// the random profiles with the fitted γ and E*.
    pub logarithm: f64,
    /// [`Self::logarithm`] divided by its standard error.
    pub deviation: f64,
    /// True if the difference is significant. If random profiles describe the curves, the
    /// probability that at least one of all summaries has a significant difference is 1 %.
    pub deviates: bool,
}
