//! The result of a comparison of curves with random profiles.

use super::posterior::IntervalEstimate;

/// Options of a comparison of measured curves with random profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles with which the curves are compared.
    pub lines: u64,
    /// True if the effective modulus is to be found; false if the scene gives it.
    pub is_modulus_free: bool,
    /// Relative standard error of the rms height of the roughness; `None` if it is not stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Work of adhesion, and effective modulus, of a rough body from curves measured at many of its places.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ, J/m².
    pub work: IntervalEstimate,
    /// Effective modulus E*, Pa. A given modulus has an interval of zero width.
    pub modulus: IntervalEstimate,
    /// True if the scene gives the effective modulus.
    pub modulus_is_given: bool,
    /// Work of adhesion on closing divided by the work of adhesion on opening, as the scene states it.
    pub closing_over_opening: f64,
    /// Correlation of ln γ and ln E*; 0 for a given E*.
    pub correlation: f64,
    /// Sources of the uncertainty of the work of adhesion.
    pub shares: Shares,
    /// Precision of the work of adhesion that more curves would give.
    pub prospects: Vec<Prospect>,
    /// Derivatives of the results with respect to the roughness of the scene; `None` for a measured roughness.
    pub roughness: Option<RoughnessShifts>,
    /// Changes that the files of the curves make to the scene, in words; `None` if there are none.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Number of random profiles.
    pub lines: u64,
    /// Number of computed curves.
    pub computed: usize,
    /// Mean of the largest forces of the curves, N.
    pub preload: f64,
    /// Standard deviation of the largest forces divided by their mean; `None` if they differ by noise only. With a value,
    /// each random profile is loaded by the preload of one of the curves.
    pub preload_scatter: Option<f64>,
    /// Results that each single curve gives.
    pub curves: Vec<CurveOfEnsemble>,
    /// Scatter of the single curves divided by the scatter of the random profiles, expected between about 0.8 and 1.2. It
    /// is `None` for fewer than 4 curves.
    pub scatter_ratio: Option<f64>,
    /// True if random profiles describe the mean of each summary, a number such as the pull-off force or the loop area.
    pub described: bool,
    /// Difference between the curves and the random profiles in the mean of each summary.
    pub deviations: Vec<SummaryDeviation>,
    /// True if the interval reaches an end of the table of computed curves. The true interval is then wider.
    pub at_end_of_table: bool,
}

/// Sources of the uncertainty of the work of adhesion, as shares of the squared half-width of its interval. Their sum is 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shares {
    /// Share due to the limited number of curves.
    pub places: f64,
    /// Share due to the limited number of random profiles.
    pub profiles: f64,
    /// Share due to the stated errors of the roughness.
    pub roughness: f64,
}

/// Precision that a larger number of curves would give.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Prospect {
    /// Number of curves.
    pub curves: u64,
    /// Half-width of the 95 % interval of ln γ.
    pub half_width: f64,
}

/// Derivatives of ln γ and ln E* with respect to the roughness of the scene.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RoughnessShifts {
    /// Derivative of ln γ with respect to the logarithm of the rms height.
    pub work_by_height: f64,
    /// Derivative of ln γ with respect to the Hurst exponent.
    pub work_by_hurst: f64,
    /// Derivative of ln E* with respect to the logarithm of the rms height.
    pub modulus_by_height: f64,
    /// Derivative of ln E* with respect to the Hurst exponent.
    pub modulus_by_hurst: f64,
}

/// Results that one of the compared curves gives by itself.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve.
    pub name: String,
    /// Largest force of the curve, N.
    pub preload: f64,
    /// Largest tension of the curve, N; `None` if it is at most 5 times the noise.
    pub pull_off_force: Option<f64>,
    /// Area between approach and retraction, J.
    pub loop_area: f64,
    /// Mean stiffness of the retraction from the preload down to half the preload, N/m.
    pub stiffness: f64,
    /// Work of adhesion found from this single curve, J/m².
    pub work: IntervalEstimate,
    /// True if the interval from this single curve reaches an end of the table of computed curves.
    pub at_end_of_table: bool,
    /// True if at most one of a thousand curves of random profiles lies as far from the mean as this curve.
    pub foreign: bool,
}

/// Mean of a summary, a number such as the pull-off force, over the measured curves, compared with random profiles.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SummaryDeviation {
    /// Name of the summary, such as `pull-off force`.
    pub summary: &'static str,
    /// Natural logarithm of the ratio of the mean over the curves to the mean over the random profiles.
    pub logarithm: f64,
    /// This logarithm divided by its standard error.
    pub deviation: f64,
    /// True if the deviation is larger than the largest deviation in 99 % of ensembles of random profiles.
    pub deviates: bool,
}
