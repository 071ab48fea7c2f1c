//! Options of the analysis of measured surfaces.

use super::nodes::End;
use crate::topography::surface::Detrend;

/// Options of the analysis of measured surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnalysisOptions {
    /// Polynomial that is removed before the analysis. With `None`, the polynomial is removed that
    /// the file of the surface states. If the file states none, the tilt is removed
    /// ([`Detrend::Tilt`]), or only the mean for a periodic surface ([`Detrend::Mean`]).
    pub detrend: Option<Detrend>,
    /// True for a surface that continues periodically at its borders. The analysis then uses no
    /// window function.
    pub periodic: bool,
    /// Whether the surface is assumed to have waves shorter than the shortest wave that the points
    /// resolve.
    pub end: End,
    /// Radius in m of the tip that measured the surface.
    pub tip_radius: Option<f64>,
}
