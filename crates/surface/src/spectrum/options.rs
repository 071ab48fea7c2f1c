//! Options of the analysis of measured surfaces.

use super::nodes::End;
use crate::topography::surface::Detrend;

/// Options of the analysis of measured surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnalysisOptions {
    /// Polynomial removed before the analysis. `Option::None` means the polynomial that the file of
    /// the surface states. If the file states no polynomial, it means [`Detrend::Tilt`], or
    /// [`Detrend::Mean`] for a periodic surface.
    pub detrend: Option<Detrend>,
    /// True for a surface that continues periodically at its borders. The analysis then uses no
    /// window function.
    pub periodic: bool,
    /// Assumption on waves shorter than the shortest wave that the points resolve: whether the
    /// surface has such waves.
    pub end: End,
    /// Radius in m of the tip that measured the surface.
    pub tip_radius: Option<f64>,
}
