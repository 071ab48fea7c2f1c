//! A surface from which a polynomial was removed. The analysis starts from such surfaces.

use super::options::AnalysisOptions;
use crate::error::{Place, SurfaceError, refused};
use crate::topography::surface::{Detrend, Topography};
use asperity_data::resized;

/// Smallest allowed number of points in a row, and of rows in a map.
const LEAST_POINTS: usize = 32;

/// Largest ratio of the heights after removal of the polynomial to the original heights with which
/// the remaining heights are only rounding errors.
const ROUNDING: f64 = 1e-12;

/// Smallest allowed height in m. The squares of smaller heights could be rounded to zero.
const LEAST_HEIGHT: f64 = 1e-100;

/// Heights of a surface after removal of a polynomial.
pub(super) struct LevelledSurface {
    /// Heights in m, row by row.
    pub heights: Vec<f64>,
    pub columns: usize,
    pub rows: usize,
    /// True for each point that was measured, and false for each interpolated point. Empty if all
    /// points were measured.
    pub measured: Vec<bool>,
    /// Distances in m between neighbouring points of a row, and between neighbouring rows.
    pub distances: [f64; 2],
    /// True if the surface is not periodic, so that the analysis uses a window function.
    pub windowed: bool,
    /// True if the median height of each row was subtracted from the row.
    pub aligned: bool,
    /// The polynomial that was removed.
    pub removed: Detrend,
}

impl LevelledSurface {
    /// Copies the heights of a surface and removes a polynomial from the copy. `index` is the
    /// number of the surface in error messages. `quarters` is 0 for the heights as they are. With
    /// 1, 2 or 3, the copied heights are changed in one of three ways, by about as much as
    /// interpolation may have changed them ([`Topography::copied_heights`]).
    pub fn new(
        index: usize,
        surface: &Topography,
        options: &AnalysisOptions,
        quarters: usize,
    ) -> Result<Self, SurfaceError> {
        let within = |error: SurfaceError| error.within(|place| Place::Surface(index, place));
        let distances = surface.spacing().map_err(within)?;
        let columns = surface.columns;
        let rows = surface.rows();
        check_points(columns, rows).map_err(within)?;

        let mut heights = surface.copied_heights(quarters).map_err(within)?;
        let periodic = options.periodic || surface.periodic;
        let polynomial = polynomial(surface, options, periodic);
        polynomial.remove(&mut heights, columns);
        Ok(LevelledSurface {
            heights,
            columns,
            rows,
            measured: measured_points(surface).map_err(within)?,
            distances,
            windowed: !periodic,
            aligned: surface.aligned,
            removed: polynomial,
        })
    }

    /// Returns the height of a point in m; `None` if the height was interpolated.
    pub fn measured_height(&self, index: usize) -> Option<f64> {
        let is_measured = self.measured.get(index).copied().unwrap_or(true);
        is_measured.then(|| self.heights[index])
    }

    /// Returns an error if the heights after removal of the polynomial are not larger than the
    /// rounding errors of the original heights.
    pub fn check_rough(&self, original: &Topography) -> Result<(), SurfaceError> {
        let left = largest_height(&self.heights);
        if left > ROUNDING * largest_height(&original.heights) && left > LEAST_HEIGHT {
            return Ok(());
        }
        Err(refused(
            Place::File,
            "no roughness is left after detrending",
            "heights that differ",
        ))
    }
}

fn measured_points(surface: &Topography) -> Result<Vec<bool>, SurfaceError> {
    if surface.interpolated.is_empty() {
        return Ok(Vec::new());
    }
    let mut measured = resized(Vec::new(), surface.heights.len(), true)?;
    for index in &surface.interpolated {
        measured[*index] = false;
    }
    Ok(measured)
}

fn check_points(columns: usize, rows: usize) -> Result<(), SurfaceError> {
    let points = if rows > 1 { columns.min(rows) } else { columns };
    if points >= LEAST_POINTS {
        return Ok(());
    }
    let found = format!("{points} points along an axis");
    let allowed = format!("at least {LEAST_POINTS}");
    Err(refused(Place::File, found, allowed))
}

/// Returns the polynomial that is removed. The polynomial in the options is used, or else the one
/// that the file states, or else the default.
fn polynomial(surface: &Topography, options: &AnalysisOptions, periodic: bool) -> Detrend {
    let default = if periodic {
        Detrend::Mean
    } else {
        Detrend::Tilt
    };
    options.detrend.or(surface.detrend).unwrap_or(default)
}

fn largest_height(heights: &[f64]) -> f64 {
    heights
        .iter()
        .fold(0.0, |largest, height| largest.max(height.abs()))
}
