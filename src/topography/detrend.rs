//! The part of a surface that is no roughness.

use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// Part of a surface removed before analysis.
#[cfg_attr(feature = "tui", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr)]
pub enum Detrend {
    /// None; in scenes `Nothing`, since `None` omits a field.
    #[serde(rename = "Nothing")]
    #[strum(serialize = "Nothing")]
    None,
    /// Mean height.
    Mean,
    /// Mean height and tilt.
    #[default]
    Tilt,
    /// Mean height, tilt and the curvatures of a paraboloid.
    Curvature,
}
