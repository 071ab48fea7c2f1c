//! Result of a fit: each parameter with its errors, how well the model describes the curve, and the scene that was found.

use crate::parameter::Parameter;
use crate::reason::Reason;
use crate::search::MISFIT;
use asperity_data::format_within;
use asperity_scene::Document;
use serde::ser::{Serialize, SerializeMap, Serializer};

/// A fitted parameter with its errors.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FittedParameter {
    /// Which parameter it is.
    #[serde(skip)]
    pub parameter: Parameter,
    /// Value of the smallest residuals; all values are in the SI unit of the parameter.
    pub value: f64,
    /// Ends of the 95 % interval; the whole range where the profile is random and the model does not describe the curve.
    #[serde(flatten, serialize_with = "low_and_high")]
    pub interval: (f64, f64),
    /// Standard error due to the noise.
    pub noise_error: f64,
    /// Value at which the search began.
    pub start: f64,
    /// Range in which the value was searched.
    pub range: (f64, f64),
}

fn low_and_high<S: Serializer>((low, high): &(f64, f64), serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(2))?;
    map.serialize_entry("low", low)?;
    map.serialize_entry("high", high)?;
    map.end()
}

impl FittedParameter {
    /// A value of the parameter in words, with the digits that its interval determines, unless it is the whole range.
    pub fn text(&self, value: f64) -> String {
        let half = 0.5 * (self.interval.1 - self.interval.0);
        format_within(value, if self.interval == self.range { 0.0 } else { half }, self.parameter.row().unit)
    }
}

/// Result of a fit.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FitResult {
    /// The free parameters with their errors.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<FittedParameter>,
    /// Root mean square residual of all points, N.
    pub residual: f64,
    /// Root mean square residual over the noise.
    pub residual_over_noise: f64,
    /// Share of the points whose residual exceeds 5 times the noise.
    pub beyond_five_sigma: f64,
    /// Root mean square residual of the points in contact over the noise; points inside a jump of the model count as
    /// described, and other single points count as 5 times that root mean square.
    pub misfit: f64,
    /// Upper end of the interval of the work of adhesion, J/m², if a scene without adhesion describes the curve
    /// equally well.
    #[serde(skip)]
    pub work_at_most: Option<f64>,
    /// Tabor number of the scene with the fitted values.
    pub tabor: Option<f64>,
    /// Why the model does not describe the curve; `None` if it does.
    pub reason: Option<Reason>,
    /// Correlation of each pair of parameters.
    pub correlations: Vec<(Parameter, Parameter, f64)>,
    /// Pairs of parameters that the curve cannot separate; a pair of the same parameter for one that the curve does not
    /// determine.
    pub not_distinguished: Vec<(Parameter, Parameter)>,
    /// What the fit took from the file of the curve and did not search, in sentences.
    #[serde(skip)]
    pub assumptions: Vec<String>,
    /// Number of curves computed by the fit.
    pub evaluations: usize,
    /// Force of the model at each point, N, including the zero and the drift of the curve, which the fit refines.
    #[serde(skip)]
    pub model: Vec<f64>,
    /// The scene with the fitted values, loaded as the measured curve was.
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

    /// Returns true if the model does not describe the curve and the profile of the scene is random: the specimen has another
    /// one, and the values found say nothing about it.
    pub fn has_other_profile(&self) -> bool {
        !self.describes() && self.document.scene().seed().is_some()
    }
}
