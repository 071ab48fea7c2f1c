//! Result of a fit: each parameter with its errors, how well the model describes the curve, and the scene that was found.

use crate::parameter::Parameter;
use crate::reason::Reason;
use crate::search::MISFIT;
use asperity_data::format_within;
use asperity_scene::Document;
use serde::ser::{Serialize, SerializeMap, Serializer};

/// Fitted parameter with its errors. All values are in the SI unit of the parameter.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FittedParameter {
    /// Fitted parameter of the scene or of the curve.
    #[serde(skip)]
    pub parameter: Parameter,
    /// Value of the parameter at which the residuals are smallest.
    pub value: f64,
    /// Lower and upper end of the 95 % interval. If [`FitResult::has_other_profile`] is true, the interval is the whole
    /// range of the search, except for a parameter that may be negative.
    #[serde(flatten, serialize_with = "low_and_high")]
    pub interval: (f64, f64),
    /// Standard error due to the noise, or from the scatter between parts of the curve if this error is larger.
    pub noise_error: f64,
    /// Value at which the search began.
    pub start: f64,
    /// Lower and upper end of the range in which the value was searched.
    pub range: (f64, f64),
}

fn low_and_high<S: Serializer>((low, high): &(f64, f64), serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(2))?;
    map.serialize_entry("low", low)?;
    map.serialize_entry("high", high)?;
    map.end()
}

impl FittedParameter {
    /// Writes a value of the parameter with its unit. The interval determines the digits, unless it is the whole range.
    pub fn text(&self, value: f64) -> String {
        let half = 0.5 * (self.interval.1 - self.interval.0);
        format_within(value, if self.interval == self.range { 0.0 } else { half }, self.parameter.row().unit)
    }
}

/// Result of a fit.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FitResult {
    /// Free parameters of the fit with their errors.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<FittedParameter>,
    /// Root mean square residual of all points, in N.
    pub residual: f64,
    /// Root mean square residual of all points divided by the noise.
    pub residual_over_noise: f64,
    /// Share of the points whose residual exceeds 5 times the noise.
    pub beyond_five_sigma: f64,
    /// Root mean square residual of the points in contact divided by the noise. Points inside a jump of the model count as
    /// described. A single point with a large residual counts as 5 times the root mean square.
    pub misfit: f64,
    /// Upper end of the interval of the work of adhesion, J/m²; `None` if a scene without adhesion describes the curve less
    /// well.
    #[serde(skip)]
    pub work_at_most: Option<f64>,
    /// Tabor number of the scene with the fitted values; `None` if the scene has none.
    pub tabor: Option<f64>,
    /// Reason why the model does not describe the curve; `None` if the model does.
    pub reason: Option<Reason>,
    /// Correlation of the errors of each pair of parameters.
    pub correlations: Vec<(Parameter, Parameter, f64)>,
    /// Pairs of parameters that the curve cannot separate. A pair of the same parameter twice means that the curve does not
    /// determine this parameter.
    pub not_distinguished: Vec<(Parameter, Parameter)>,
    /// Sentences about what the fit took from the file of the curve and did not search.
    #[serde(skip)]
    pub assumptions: Vec<String>,
    /// Number of curves that the fit computed.
    pub evaluations: usize,
    /// Force of the model at each point in N. It includes the zero, drift and tilt of the curve, which the fit refines.
    #[serde(skip)]
    pub model: Vec<f64>,
    /// Scene with the fitted values, loaded as the body was in the measurement.
    #[serde(rename = "scene", serialize_with = "scene_of")]
    pub document: Document,
}

fn by_name<S: Serializer>(parameters: &[FittedParameter], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(parameters.iter().map(|one| (one.parameter, one)))
}

fn scene_of<S: Serializer>(document: &Document, serializer: S) -> Result<S::Ok, S::Error> {
    document.scene().serialize(serializer)
}

impl FitResult {
    /// Returns true if the model describes the curve.
    pub fn describes(&self) -> bool {
        self.misfit <= MISFIT
    }

    /// Returns true if the model does not describe the curve and the profile of the scene is random. The specimen then has
    /// another profile, and the fitted values are meaningless.
    pub fn has_other_profile(&self) -> bool {
        !self.describes() && self.document.scene().seed().is_some()
    }
}
