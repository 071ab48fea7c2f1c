//! The result of a comparison of curves with random profiles.

use super::posterior::IntervalEstimate;

/// What is compared, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles with which the curves are compared.
    pub lines: u64,
    /// True if the effective modulus is unknown; else it is the one of the scene.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the roughness, as a share of it; `None` if it is not stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Work of adhesion, and effective modulus, of a rough body, from the curves of many places of it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ, J/m².
    pub work: IntervalEstimate,
    /// Effective modulus E*, Pa; a given one has no interval.
    pub modulus: IntervalEstimate,
    /// True if the effective modulus is the one of the scene.
    pub modulus_is_given: bool,
    /// Work of adhesion on closing over that on opening, as in the scene.
    pub closing_over_opening: f64,
    /// Correlation of ln γ and ln E*; 0 for a given E*.
    pub correlation: f64,
    /// What the interval of the work of adhesion comes from.
    pub shares: Shares,
    /// Relative half-width of the interval of the work of adhesion with other numbers of curves.
    pub prospects: Vec<Prospect>,
    /// Changes of the results if the roughness differs from the roughness of the scene; `None` for a measured
    /// roughness.
    pub roughness: Option<RoughnessShifts>,
    /// Changes of the scene by the files of the curves, in words.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Number of random profiles.
    pub lines: u64,
    /// Number of computed curves.
    pub computed: usize,
    /// Mean of the largest forces of the curves, N.
    pub preload: f64,
    /// Standard deviation of the largest forces over their mean, if the preloads of the curves differ by more than noise;
    /// each profile is then loaded by one of them.
    pub preload_scatter: Option<f64>,
    /// Each curve by itself.
    pub curves: Vec<CurveOfEnsemble>,
    /// Scatter of the curves over the scatter of the random profiles, expected between about 0.8 and 1.2; `None` for
    /// fewer than 4 curves.
    pub scatter_ratio: Option<f64>,
    /// True if random profiles of this spectrum describe the means of all summaries.
    pub described: bool,
    /// Difference between the mean of each summary and the mean of the random profiles.
    pub deviations: Vec<SummaryDeviation>,
    /// True if the interval reaches an end of the table of computed curves: its ends are then too close.
    pub at_end_of_table: bool,
}

/// Shares of the squared half-width of an interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shares {
    /// By the number of curves.
    pub places: f64,
    /// By the number of random profiles.
    pub profiles: f64,
    /// By the stated errors of the roughness.
    pub roughness: f64,
}

/// Precision that other numbers of curves would give.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Prospect {
    /// Number of curves.
    pub curves: u64,
    /// Half-width of the 95 % interval of ln γ.
    pub half_width: f64,
}

/// Derivatives of the results with respect to the roughness of the scene.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RoughnessShifts {
    /// Of ln γ with respect to the logarithm of the rms height.
    pub work_by_height: f64,
    /// Of ln γ with respect to the Hurst exponent.
    pub work_by_hurst: f64,
    /// Of ln E* with respect to the logarithm of the rms height.
    pub modulus_by_height: f64,
    /// Of ln E* with respect to the Hurst exponent.
    pub modulus_by_hurst: f64,
}

/// One curve of an ensemble.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve.
    pub name: String,
    /// Largest force, N.
    pub preload: f64,
    /// Largest tension, N; `None` if it does not exceed the noise.
    pub pull_off_force: Option<f64>,
    /// Area of the loop, J.
    pub loop_area: f64,
    /// Half of the preload over the way back to it, N/m.
    pub stiffness: f64,
    /// Work of adhesion by only this curve, J/m².
    pub work: IntervalEstimate,
    /// True if the interval of only this curve reaches an end of the table.
    pub at_end_of_table: bool,
    /// True if one in a thousand curves of random profiles lies so far from the others.
    pub foreign: bool,
}

/// Mean of a summary over the curves, compared with random profiles.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SummaryDeviation {
    /// Name of the summary.
    pub summary: &'static str,
    /// Natural logarithm of the mean over the curves, divided by the mean over random profiles.
    pub logarithm: f64,
    /// The same in units of its standard error.
    pub deviation: f64,
    /// True if it is beyond what 99 % of ensembles of random profiles have.
    pub deviates: bool,
}
