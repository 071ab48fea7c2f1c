//! Result of a fit: each parameter with its errors, how well the model describes the curve, and the
//! scene with the fitted values.

use crate::fit::agreement::{Agreement, Grade, MISFIT};
use crate::fit::parameter::Parameter;
use crate::fit::reason::Reason;
use asperity_data::{Note, Warning, format_rounded, format_within};
use asperity_scene::Document;
use serde::ser::{Serialize, SerializeMap, Serializer};

/// Fitted parameter with its errors. All values are in the SI unit of the parameter.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FittedParameter {
    /// Parameter of the scene or of the curve that was fitted.
    #[serde(skip)]
    pub parameter: Parameter,
    /// Value, in the SI unit of the parameter, with which the scene describes the curve best.
    pub value: f64,
    /// Lower and upper end of the 95 % interval of the value, in the SI unit of the parameter. If
    /// [`FitResult::has_other_profile`] is true, the value is not known, and the interval is the
    /// whole [`Self::range`]. The parameters `Offset` and `Zero` are exceptions.
    #[serde(flatten, serialize_with = "low_and_high")]
    pub interval: (f64, f64),
    /// Standard error of the value due to the noise of the force, in the SI unit of the parameter.
    /// If the model does not describe the curve, the standard error is at least the scatter of the
    /// value between parts of the curve (jackknife).
    pub noise_error: f64,
    /// Value with which the fit begins, in the SI unit of the parameter. It is an estimate from the
    /// curve. For the force F₀ it is 0, and for the radius it is the value in the scene. If this
    /// value is outside [`Self::range`], the fit begins at the nearer end of the range.
    pub start: f64,
    /// Lower and upper end of the range in which the value was searched, in the SI unit of the
    /// parameter.
    pub range: (f64, f64),
    /// End of the range at which the best value lies. The value is then only a bound, and
    /// [`Self::interval`] is the whole range. `None` for a value inside the range.
    pub at_end: Option<RangeEnd>,
}

/// End of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RangeEnd {
    /// Lower end of the range: the true value is at most the value at this end.
    Low,
    /// Upper end of the range: the true value is at least the value at this end.
    High,
}

fn low_and_high<S: Serializer>((low, high): &(f64, f64), serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(2))?;
    map.serialize_entry("low", low)?;
    map.serialize_entry("high", high)?;
    map.end()
}

impl FittedParameter {
    /// Marks the value as a bound. `end` is the end of the range at which the value lies. The
    /// interval becomes the whole range.
    pub(crate) fn set_at_end(&mut self, end: RangeEnd) {
        self.at_end = Some(end);
        self.interval = self.range;
        self.noise_error = self.range.1 - self.range.0;
    }

    /// Returns the value as a bound, such as `≥ 3 GPa`, if it lies at an end of its range; `None`
    /// for a value inside its range.
    pub fn bound(&self) -> Option<String> {
        let sign = match self.at_end? {
            RangeEnd::Low => "≤",
            RangeEnd::High => "≥",
        };
        let value = format_rounded(self.value, 2, self.parameter.row().unit);
        Some(format!("{sign} {value}"))
    }

    /// Returns `value` as text with the unit of the parameter, such as `50.02 mJ/m²`. The narrower
    /// the [`Self::interval`], the more digits the text has.
    pub fn text(&self, value: f64) -> String {
        let unit = self.parameter.row().unit;
        // If the interval is the whole range, its width gives no number of digits.
        if self.interval == self.range {
            return format_within(value, 0.0, unit);
        }
        let (low, high) = self.interval;
        format_within(value, 0.5 * (high - low), unit)
    }
}

/// Effective modulus E∞ = E* (1 − s) in Pa of a half-space that has relaxed for a long time.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RelaxedModulus {
    /// Value in Pa for the parameters with which the scene describes the curve best.
    pub value: f64,
    /// Lower and upper end of the 95 % interval in Pa.
    #[serde(flatten, serialize_with = "low_and_high")]
    pub interval: (f64, f64),
}

/// Result of [`Fit::run`](crate::Fit::run). A residual is the measured force minus the computed
/// force at a point.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct FitResult {
    /// Free parameters of the fit with their errors.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<FittedParameter>,
    /// Root mean square, in N, of the residuals of the points that are in contact in the
    /// measurement or in the model. Points at jumps do not count, see [`Agreement`]. Points without
    /// contact do not count either, because their residuals are only noise.
    pub residual: f64,
    /// [`Self::residual`] divided by the [noise](crate::MeasuredCurve::noise) of the force.
    pub residual_over_noise: f64,
    /// Share of points with a large residual, from 0 to 1: the residual exceeds 5 times the noise
    /// in magnitude. Only the points that count in [`Self::residual`] are considered.
    pub beyond_five_sigma: f64,
    /// Robust root mean square of the residuals in contact, divided by the noise. Points near a
    /// jump of the force and outliers have a smaller weight. The model describes the curve within
    /// its noise if the value is at most 1.5.
    pub misfit: f64,
    /// Agreement of the model with the curve in contact, as shares of the largest force.
    pub agreement: Agreement,
    /// How well the model describes the curve.
    #[serde(rename = "description")]
    pub grade: Grade,
    /// Effective modulus after a long time; `None` if the half-space does not relax.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relaxed_modulus: Option<RelaxedModulus>,
    /// Largest work of adhesion in J/m² that is compatible with a curve without clear adhesion. It
    /// is the upper end of the 95 % interval. `None` if the curve excludes a scene without adhesion
    /// at the level of 5 %, or if the work of adhesion is not free.
    #[serde(skip)]
    pub work_at_most: Option<f64>,
    /// Tabor number of the scene with the fitted values. `None` if the curve shows no adhesion, or
    /// if the form has no radius of curvature, such as a cone.
    #[serde(rename = "tabor_number")]
    pub tabor: Option<f64>,
    /// Reason why the model does not describe the curve within its noise; `None` if the model
    /// describes the curve.
    pub reason: Option<Reason>,
    /// Premises of the model that the scene with the found values does not meet.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
    /// Each pair of free parameters with the correlation of their errors, from −1 to 1.
    pub correlations: Vec<(Parameter, Parameter, f64)>,
    /// Pairs of free parameters that the curve cannot separate. A pair of one parameter with itself
    /// means that the curve does not determine this parameter.
    pub not_distinguished: Vec<(Parameter, Parameter)>,
    /// Sentences about values that the fit did not search but took from the file or from the points
    /// of the curve, such as the stiffness of the instrument.
    #[serde(skip)]
    pub assumptions: Vec<Note>,
    /// Number of force curves that the fit computed.
    pub evaluations: usize,
    /// Computed force in N at each point of the measured curve. The force includes the fitted force
    /// before contact and its fitted linear changes with time (drift) and with displacement (tilt).
    /// It can be compared with [`MeasuredCurve::force`](crate::MeasuredCurve::force).
    #[serde(skip)]
    pub model: Vec<f64>,
    /// Scene with the fitted values and with the loading of the measurement.
    #[serde(rename = "scene", serialize_with = "scene_of")]
    pub document: Document,
}

fn by_name<S: Serializer>(
    parameters: &[FittedParameter],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let rows = parameters.iter().map(|fitted| (fitted.parameter, fitted));
    serializer.collect_map(rows)
}

fn scene_of<S: Serializer>(document: &Document, serializer: S) -> Result<S::Ok, S::Error> {
    document.scene().serialize(serializer)
}

impl FitResult {
    /// Largest [`Self::misfit`] at which the model is considered to describe the curve.
    pub const MOST_MISFIT: f64 = MISFIT;

    /// Returns true if the model describes the curve within its noise: [`Self::misfit`] is at most
    /// 1.5, and no drift or tilt remains. [`Self::grade`] gives a finer judgement.
    pub fn describes(&self) -> bool {
        self.grade == Grade::WithinNoise
    }

    /// Returns true if the model does not describe the curve and the profile of the scene is
    /// random. The profile of the specimen then differs from the profile of the scene, and the
    /// fitted values are meaningless.
    pub fn has_other_profile(&self) -> bool {
        !self.describes() && self.document.scene().seed().is_some()
    }
}
