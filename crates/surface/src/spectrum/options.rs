//! Options of the analysis of measured surfaces.

use super::nodes::End;
use crate::topography::surface::Detrend;

/// Options of the analysis of measured surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnalysisOptions {
    /// Polynomial that is removed from the heights before the analysis. With `None`, the file of
    /// the surface determines the polynomial. If the file states none, the tilt is removed
    /// ([`Detrend::Tilt`]); for a periodic surface, only the mean is removed ([`Detrend::Mean`]).
    pub detrend: Option<Detrend>,
    /// True if the surface continues periodically at its borders. The analysis of such a surface
    /// uses no window function.
    pub periodic: bool,
    /// Whether the surface is assumed to have waves shorter than the shortest wave that the points
    /// resolve.
    pub end: End,
    /// Radius in m of the tip that measured the surface; `None` if it is unknown.
    pub tip_radius: Option<f64>,
}
