//! A surface without its polynomial, as the analysis sees it.

use super::options::AnalysisOptions;
use crate::error::{Place, SurfaceError, refused};
use crate::topography::surface::{Detrend, Topography};
use asperity_data::resized;

/// Smallest allowed number of points along a row and of rows of a map.
const LEAST_POINTS: usize = 32;

/// Share of the largest height below which heights are rounding errors.
const ROUNDING: f64 = 1e-12;

/// Height in m below which squares of heights could vanish.
const LEAST_HEIGHT: f64 = 1e-100;

/// Heights of a surface after removal of a polynomial.
pub(super) struct LevelledSurface {
    /// Heights in m, row by row.
    pub heights: Vec<f64>,
    pub columns: usize,
    pub rows: usize,
    /// True for each point that is measured, false for interpolated ones; empty if all points are
    /// measured.
    pub measured: Vec<bool>,
    /// Distances of the points along and between the rows in m.
    pub distances: [f64; 2],
    /// True if the analysis uses a window function, because the surface is not periodic.
    pub windowed: bool,
    /// True if the rows were levelled one by one.
    pub aligned: bool,
    /// True if the curvature was removed.
    pub without_curvature: bool,
}

impl LevelledSurface {
    /// Removes the polynomial from surface number `index`. With `quarters` above zero the heights
    /// differ by an estimate of the error of interpolation, see [`Topography::copied_heights`].
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
            without_curvature: polynomial == Detrend::Curvature,
        })
    }

    /// Returns the height in m of a point; `None` if it is interpolated.
    pub fn measured_height(&self, index: usize) -> Option<f64> {
        let is_measured = self.measured.get(index).copied().unwrap_or(true);
        is_measured.then(|| self.heights[index])
    }

    /// Checks that the heights exceed the rounding errors of the original heights.
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

/// Returns the polynomial to remove: the one of the options, else the one that the file states,
/// else the default.
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
