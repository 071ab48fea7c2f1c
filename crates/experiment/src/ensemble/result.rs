//! The result of a comparison of curves with random profiles.

use super::posterior::IntervalEstimate;

/// Options of [`fit_ensemble`](crate::fit_ensemble), which compares measured curves with random profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles with which the curves are compared, at least 16.
    pub lines: u64,
    /// True if the effective modulus is to be found; false if the scene gives it.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the roughness divided by this height; `None` if it is not stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Result of [`fit_ensemble`](crate::fit_ensemble): the work of adhesion and the effective modulus of one rough body, from
/// curves measured at several places of it.
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
    /// Correlation of the errors of ln γ and ln E*, from −1 to 1; 0 for a given E*.
    pub correlation: f64,
    /// How much the number of curves, the number of profiles and the errors of the roughness contribute to the
    /// uncertainty of the work of adhesion.
    pub shares: Shares,
    /// How narrow the interval of the work of adhesion would be with 16, 64 and 256 measured curves. Numbers that do
    /// not exceed the present number of curves are left out.
    pub prospects: Vec<Prospect>,
    /// Changes of γ and E* that errors of the rms height and of the Hurst exponent of the scene cause; `None` for a
    /// measured roughness.
    pub roughness: Option<RoughnessShifts>,
    /// Sentence about the stiffness of the instrument that the files of the curves state; `None` if the scene is used
    /// unchanged.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Number of random profiles with which the curves were compared.
    pub lines: u64,
    /// Number of force curves computed on these profiles.
    pub computed: usize,
    /// Mean preload (largest force) of the measured curves, N.
    pub preload: f64,
    /// Standard deviation of the preloads divided by their mean; `None` if they differ by noise only. If there is a value,
    /// each random profile is loaded to the preload of one of the curves, otherwise to the mean preload.
    pub preload_scatter: Option<f64>,
    /// Results of each measured curve when it is used without the others.
    pub curves: Vec<CurveOfEnsemble>,
    /// Standard deviation of ln γ between measured curves, divided by the standard deviation of ln γ between random
    /// profiles. Each curve and each profile gives one γ. If E* is free, the scatter of ln E* is included. The ratio
    /// should be about 0.8 to 1.2. It is `None` for fewer than 4 curves.
    pub scatter_ratio: Option<f64>,
    /// True if random profiles describe the measured curves. This means that [`SummaryDeviation::deviates`] is false in
    /// all [`Self::deviations`].
    pub described: bool,
    /// Differences between the measured curves and the random profiles, one for each number that is computed from a
    /// curve, such as the pull-off force.
    pub deviations: Vec<SummaryDeviation>,
    /// True if the interval of γ or E* reaches an end of the range of values for which curves were computed. The true
    /// interval is then wider.
    pub at_end_of_table: bool,
}

/// Sources of the uncertainty of the work of adhesion, as shares of the squared half-width of its interval. The three
/// shares have the sum 1.
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
    /// Number of measured curves.
    pub curves: u64,
    /// Half the width of the 95 % interval of ln γ with this number of curves.
    pub half_width: f64,
}

/// Derivatives of the results ln γ and ln E* with respect to the roughness of the scene: how far an error of the roughness
/// shifts the results.
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

/// Results of one measured curve when it is used without the others.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CurveOfEnsemble {
    /// Name of the curve, as it was given to [`fit_ensemble`](crate::fit_ensemble).
    pub name: String,
    /// Largest force of the curve, N.
    pub preload: f64,
    /// Largest tensile force of the curve, N; `None` if it is at most 5 times the noise.
    pub pull_off_force: Option<f64>,
    /// Area between approach and retraction in a chart of the force over the displacement of the instrument, J.
    pub loop_area: f64,
    /// Stiffness at the beginning of the retraction, N/m: half the preload, divided by the change of the displacement
    /// while the force falls from the preload to half the preload.
    pub stiffness: f64,
    /// Work of adhesion found from this single curve, J/m².
    pub work: IntervalEstimate,
    /// True if the interval from this single curve reaches an end of the range of values for which curves were computed.
    pub at_end_of_table: bool,
    /// True if this curve deviates from the mean of the random profiles by more than 999 of 1000 random profiles do.
    /// The place of the specimen at which it was measured may then differ from the other places.
    pub foreign: bool,
}

/// Difference between the measured curves and the random profiles in one summary. A summary is a number computed from a
/// curve, such as its pull-off force.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SummaryDeviation {
    /// Name of the summary, such as `pull-off force`.
    pub summary: &'static str,
    /// Mean of the natural logarithm of the summary over the measured curves, minus the mean over the random profiles
    /// with the fitted γ and E*.
    pub logarithm: f64,
    /// [`Self::logarithm`] divided by its standard error.
    pub deviation: f64,
    /// True if the magnitude of [`Self::deviation`] exceeds a limit. Random profiles replace the measured curves to
    /// find this limit: in 99 % of such trials no summary exceeds it.
    pub deviates: bool,
}
