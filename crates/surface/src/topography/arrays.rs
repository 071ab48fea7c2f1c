//! Surfaces from heights in memory.

use super::options::ReadOptions;
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::surface::Topography;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;

impl Topography {
    /// Creates a profile from the heights in m of points at equal distances. `spacing` is this
    /// distance in m.
    ///
    /// # Errors
    /// Returns an error if there are fewer than two points, if a height is not finite, or if the
    /// distance is not above 0.
    ///
    /// ```
    /// let profile = asperity_surface::Topography::from_profile(&[1e-8, 3e-8, 2e-8], 1e-7)?;
    /// assert_eq!((profile.columns, profile.rows()), (3, 1));
    /// let error = asperity_surface::Topography::from_profile(&[0.0, f64::NAN], 1e-7).unwrap_err();
    /// assert_eq!(error.to_string(), "point 2: a height of NaN m; allowed: finite heights");
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn from_profile(heights: &[f64], spacing: f64) -> Result<Self, SurfaceError> {
        Topography::from_map(heights, heights.len(), [spacing; 2])
    }

    /// Creates a map from heights in m, row by row. Each row has `columns` points. `spacing` has
    /// the distance in m between neighbouring points of a row, and the distance in m between
    /// neighbouring rows. A map of a single row or a single column is a profile.
    ///
    /// # Errors
    /// Returns the errors of [`Topography::from_profile`], and an error for a number of heights
    /// that is no multiple of `columns`.
    ///
    /// ```
    /// let map = asperity_surface::Topography::from_map(
    ///     &[0.0, 1e-9, 2e-9, 3e-9, 4e-9, 5e-9],
    ///     3,
    ///     [1e-6, 2e-6],
    /// )?;
    /// assert_eq!((map.rows(), map.spacing()?), (2, [1e-6, 2e-6]));
    /// assert!(asperity_surface::Topography::from_map(&[0.0; 5], 3, [1e-6; 2]).is_err());
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn from_map(
        heights: &[f64],
        columns: usize,
        spacing: [f64; 2],
    ) -> Result<Self, SurfaceError> {
        check_rows(heights, columns)?;
        if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
            let fault = format!("a height of {} m", heights[index]);
            return Err(refused(Place::Point(index + 1), fault, "finite heights"));
        }
        Topography::from_map_with(heights, columns, spacing, &ReadOptions::default())
    }

    /// Creates a map from heights in m and corrects it by [`ReadOptions`], as a map from a file is
    /// corrected. The corrections are the choice of one row or column, levelling of the rows,
    /// replacement of outliers and interpolation of missing points. A height of NaN is a missing
    /// point. The other arguments are those of [`Topography::from_map`].
    ///
    /// # Errors
    /// Returns the errors of [`Topography::from_map`], and an error for missing points that the
    /// options do not interpolate.
    ///
    /// ```
    /// use asperity_surface::{ReadOptions, Topography};
    ///
    /// let heights = [0.0, f64::NAN, 2e-9, 3e-9];
    /// let filled = ReadOptions {
    ///     interpolate: true,
    ///     ..ReadOptions::default()
    /// };
    /// assert_eq!(
    ///     Topography::from_map_with(&heights, 4, [1e-6; 2], &filled)?.heights[1],
    ///     1e-9
    /// );
    /// assert!(
    ///     Topography::from_map_with(&heights, 4, [1e-6; 2], &ReadOptions::default()).is_err()
    /// );
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn from_map_with(
        heights: &[f64],
        columns: usize,
        spacing: [f64; 2],
        options: &ReadOptions,
    ) -> Result<Self, SurfaceError> {
        check_rows(heights, columns)?;
        if let Some(index) = heights.iter().position(|height| height.is_infinite()) {
            let fault = format!("a height of {} m", heights[index]);
            return Err(refused(
                Place::Point(index + 1),
                fault,
                "finite heights, or NaN for a missing point",
            ));
        }
        let heights = gathered(heights.len(), heights.iter().copied())?;
        let spacing = Some(spacing);
        Reading::even("array", heights, columns, spacing, StatedUnits::METRES).resolve_part(options)
    }
}

/// Returns an error if the heights do not form whole rows of `columns` points.
fn check_rows(heights: &[f64], columns: usize) -> Result<(), SurfaceError> {
    if columns > 0 && heights.len().is_multiple_of(columns) {
        return Ok(());
    }
    let fault = format!("{} heights in rows of {columns}", heights.len());
    Err(refused(
        Place::File,
        fault,
        "whole rows of at least one height",
    ))
}
