//! A measured surface: heights in m, with the positions of the points.

use super::missing;
use super::positions::{LARGEST, UNEVEN, first_uneven, interpolated, mean_distance};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Note, Remedy, gathered};
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// Positions of the points of a surface in m.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Layout {
    /// Ascending positions of the points of a profile.
    Positions(Vec<f64>),
    /// Distance in m between neighbouring points of a row, and distance in m between neighbouring
    /// rows. For a profile both values are the distance between its points.
    Even([f64; 2]),
}

/// Numbers of columns and rows that were removed at the borders of a map because they have no
/// measured point. For a profile, each point is a column, and missing points at both ends were
/// removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cropped {
    pub(super) before: [usize; 2],
    pub(super) after: [usize; 2],
}

impl Cropped {
    /// Returns the number of removed columns and the number of removed rows. Each number is the sum
    /// over two opposite borders.
    pub fn counts(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.before[axis] + self.after[axis])
    }

    /// Returns the index of a point in the file. `index` is the index of the point after removal of
    /// columns and rows at the borders, when each row has `columns` points.
    pub(super) fn place_in_file(&self, index: usize, columns: usize) -> usize {
        let [columns_before, rows_before] = self.before;
        let [columns_left_out, _] = self.counts();
        let row = index / columns + rows_before;
        let column = index % columns + columns_before;
        row * (columns + columns_left_out) + column
    }
}

/// A measured surface, which is a profile or a map: heights and the positions of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Topography {
    /// Name of the format of the file, such as `SDF`.
    pub format: &'static str,
    /// Heights in m, row by row.
    pub heights: Vec<f64>,
    /// Number of points in each row. All points of a profile are one row.
    pub columns: usize,
    pub(super) layout: Layout,
    /// Numbers of columns and rows that were removed at the borders, because these columns and rows
    /// have no measured point.
    pub cropped: Cropped,
    /// Indices of the points with interpolated heights.
    pub(crate) interpolated: Vec<usize>,
    /// Positions in m that the points had before the surface was resampled at even distances; empty
    /// for a surface that was not resampled.
    pub(super) resampled: Vec<f64>,
    /// True if the median height of each row was subtracted from the row.
    pub(crate) aligned: bool,
    /// Name of the measurement, if its file is an archive with several measurements; otherwise
    /// empty.
    pub name: String,
    /// Polynomial that has to be removed before the analysis; `None` unless the archive with the
    /// surface states one.
    pub(crate) detrend: Option<Detrend>,
    /// True if the surface continues periodically at its borders, as the file or the archive with
    /// the file states.
    pub(crate) periodic: bool,
    /// Messages for the user, each about something unusual in the file.
    pub warnings: Vec<Note>,
}

impl Topography {
    /// Returns an error if a slope between neighbouring points of the surface exceeds [`LARGEST`].
    pub(super) fn check_slopes(&self) -> Result<(), SurfaceError> {
        for index in 1..self.heights.len() {
            // The first point in a row has no neighbour before it in the row.
            if index % self.columns == 0 {
                continue;
            }
            let distance = match &self.layout {
                Layout::Positions(positions) => positions[index] - positions[index - 1],
                Layout::Even([along, between]) => along.min(*between),
            };
            let slope = (self.heights[index] - self.heights[index - 1]).abs() / distance;
            if slope.is_nan() || slope > LARGEST {
                let place = Place::Point(self.cropped.place_in_file(index, self.columns) + 1);
                let found = format!("a slope of {slope:e} from the point before");
                return Err(refused(place, found, format!("at most {LARGEST:e}")));
            }
        }
        Ok(())
    }

    /// Returns the number of points whose heights are interpolated: missing points and replaced
    /// outliers.
    pub fn interpolated(&self) -> usize {
        self.interpolated.len()
    }

    /// Returns the index of the first missing point of a profile in the file, counted from 0;
    /// `None` if no point is missing.
    pub(crate) fn first_missing(&self) -> Option<usize> {
        let [points_before, _] = self.cropped.before;
        let [points_after, _] = self.cropped.after;
        if points_before > 0 {
            return Some(0);
        }
        match self.interpolated.first() {
            Some(index) => Some(*index),
            None if points_after > 0 => Some(self.columns),
            None => None,
        }
    }

    pub(crate) fn is_resampled(&self) -> bool {
        !self.resampled.is_empty()
    }

    /// Copies the heights in m. If `quarters` is 0, the copy has the same heights. With 1, 2 or 3,
    /// the copy is changed by about as much as interpolation may have changed the heights.
    ///
    /// For this change, as many measured points as were missing are interpolated too. These points
    /// have a distance from the missing points of `quarters` quarters of the length and of the
    /// width. A resampled profile also gets an estimate of the short waves that resampling has
    /// removed.
    pub(crate) fn copied_heights(&self, quarters: usize) -> Result<Vec<f64>, SurfaceError> {
        let mut heights = gathered(self.heights.len(), self.heights.iter().copied())?;
        if quarters == 0 {
            return Ok(heights);
        }
        if let Layout::Even([spacing, _]) = &self.layout
            && self.is_resampled()
        {
            self.add_lost_waves(&mut heights, *spacing)?;
        }
        if !self.interpolated.is_empty() {
            let columns = self.columns;
            let rows = self.rows();
            let moved = |place: usize, count: usize| (place + quarters * count / 4) % count;
            for index in &self.interpolated {
                let row = moved(index / columns, rows);
                let column = moved(index % columns, columns);
                heights[row * columns + column] = f64::NAN;
            }
            missing::interpolate(&mut heights, columns)?;
        }
        Ok(heights)
    }

    /// Adds to the heights of a resampled profile an estimate of the short waves that resampling
    /// has removed. The estimate is the effect of a second resampling, to the former positions and
    /// back.
    fn add_lost_waves(&self, heights: &mut [f64], spacing: f64) -> Result<(), SurfaceError> {
        let points = self.columns;
        let former = &self.resampled;
        let places = (0..points).map(|index| former[0] + index as f64 * spacing);
        let places = gathered(points, places)?;
        let at_former = interpolated(&places, heights, 0.0, former.iter().copied());
        let at_former = gathered(points, at_former)?;
        let smoother = interpolated(former, &at_former, 0.0, places.iter().copied());

        // The second resampling removes less than the first resampling, because the waves that were
        // removed first are already missing. The estimate is therefore enlarged, and the more so
        // the more the distances between points vary.
        let squares = former
            .windows(2)
            .map(|x| ((x[1] - x[0]) / spacing - 1.0).powi(2))
            .sum::<f64>();
        let lost = 1.0 + (squares / (points - 1) as f64).sqrt();
        for (height, smoother) in heights.iter_mut().zip(smoother) {
            *height += lost * (*height - smoother);
        }
        Ok(())
    }

    /// Returns the number of rows of a map; 1 for a profile.
    pub fn rows(&self) -> usize {
        self.heights.len() / self.columns
    }

    /// Returns the positions in m and the heights in m of the points of a profile. Equally spaced
    /// points begin at x = 0.
    ///
    /// # Errors
    /// Returns an error if the surface is a map.
    ///
    /// ```
    /// use asperity_surface::Topography;
    ///
    /// let (positions, heights) =
    ///     Topography::from_profile(&[3e-9, 1e-9, 2e-9], 1e-6)?.into_profile()?;
    /// assert_eq!(
    ///     (positions, heights),
    ///     (vec![0.0, 1e-6, 2e-6], vec![3e-9, 1e-9, 2e-9])
    /// );
    /// assert!(
    ///     Topography::from_map(&[0.0, 1.0, 2.0, 3.0], 2, [1.0; 2])?
    ///         .into_profile()
    ///         .is_err()
    /// );
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn into_profile(self) -> Result<(Vec<f64>, Vec<f64>), SurfaceError> {
        let columns = self.columns;
        let rows = self.rows();
        if rows > 1 {
            let found = format!("a map of {rows} rows of {columns} points");
            let allowed = "a profile; in a scene with as_line: false the equivalent line of a map";
            return Err(refused(Place::File, found, allowed));
        }
        let positions = match self.layout {
            Layout::Positions(positions) => positions,
            Layout::Even([spacing, _]) => {
                gathered(columns, (0..columns).map(|index| index as f64 * spacing))?
            }
        };
        Ok((positions, self.heights))
    }

    /// Returns the distance between neighbouring points along the rows and the distance between
    /// rows, in m. For a profile both values are the distance between its points.
    ///
    /// # Errors
    /// Returns an error if a point of a profile is off an even grid by more than 0.1 % of the mean
    /// distance.
    ///
    /// ```
    /// use asperity_surface::{ReadOptions, parse};
    ///
    /// let uneven = b"x [um] z [nm]\n0 1\n1 2\n5 3\n";
    /// assert!(parse(uneven, &ReadOptions::default())?.spacing().is_err());
    /// let even = parse(uneven, &ReadOptions { resample: true, ..ReadOptions::default() })?;
    /// assert_eq!(even.spacing()?, [2.5e-6; 2]);
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn spacing(&self) -> Result<[f64; 2], SurfaceError> {
        let positions = match &self.layout {
            Layout::Even(spacing) => return Ok(*spacing),
            Layout::Positions(positions) => positions,
        };
        let first = positions[0];
        let mean = mean_distance(positions);
        let Some(index) = first_uneven(positions, first, mean) else {
            return Ok([mean; 2]);
        };
        let x = positions[index];
        let off = (x - first) / mean - index as f64;
        let found = format!(
            "x = {x:e} m is off the even grid by {off:.1e} of the mean distance {mean:e} m"
        );
        let allowed = format!("at most {UNEVEN}, or linear interpolation");
        Err(refused(Place::Point(index + 1), found, allowed).with(Remedy::Resample))
    }

    /// Resamples the profile at its mean spacing by linear interpolation. An equally spaced profile
    /// and a map remain unchanged.
    pub(super) fn resampled(mut self) -> Result<Self, SurfaceError> {
        if self.spacing().is_ok() {
            return Ok(self);
        }
        let Layout::Positions(positions) = self.layout else {
            return Ok(self);
        };
        let first = positions[0];
        let spacing = mean_distance(&positions);
        let points = positions.len();
        let places = (0..points).map(|index| first + index as f64 * spacing);
        let heights = interpolated(&positions, &self.heights, 0.0, places);
        self.heights = gathered(points, heights)?;
        self.layout = Layout::Even([spacing; 2]);
        self.resampled = positions;
        Ok(self)
    }
}

/// Polynomial that is subtracted from the heights of a surface before the analysis.
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr)]
pub enum Detrend {
    /// Nothing is removed. In scene files this variant is written `Nothing`.
    #[serde(rename = "Nothing")]
    #[strum(serialize = "Nothing")]
    None,
    /// The mean height is removed.
    Mean,
    /// The mean height and the tilt are removed.
    #[default]
    Tilt,
    /// The mean height, the tilt and the curvatures of a paraboloid are removed.
    Curvature,
}

#[cfg(test)]
mod tests {
    use super::super::cut::Cut;
    use super::super::options::ReadOptions;
    use super::super::reading::Reading;
    use super::super::stated_units::StatedUnits;
    use super::*;
    use asperity_data::Remedied;

    const METRES: StatedUnits = StatedUnits::METRES;

    fn profile(positions: &[f64], heights: &[f64]) -> Topography {
        let reading = Reading::profile("", positions.to_vec(), heights.to_vec(), METRES);
        reading.resolve(&ReadOptions::default()).unwrap()
    }

    fn map() -> Topography {
        let heights = vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        Reading::even("", heights, 3, Some([1.0, 2.0]), METRES)
            .resolve(&ReadOptions::default())
            .unwrap()
    }

    #[test]
    fn uneven_points_are_named_and_resampled() {
        let uneven = profile(&[0.0, 1.0, 2.5, 3.0], &[0.0, 2.0, 5.0, 6.0]);
        let error = uneven.spacing().unwrap_err();
        assert!(
            error.to_string().starts_with("point 3: x = 2.5e0 m is off"),
            "{error}"
        );
        assert_eq!(error.remedies(), [Remedy::Resample]);
        let even = uneven.resampled().unwrap();
        assert_eq!(
            (even.spacing(), &even.heights[..]),
            (Ok([1.0; 2]), &[0.0, 2.0, 4.0, 6.0][..])
        );
        // On a straight line, resampling removes nothing, so nothing is added. A corner becomes
        // sharper.
        assert_eq!(even.copied_heights(1), Ok(vec![0.0, 2.0, 4.0, 6.0]));
        let corner = profile(&[0.0, 1.0, 2.5, 3.0], &[0.0, 0.0, 6.0, 6.0])
            .resampled()
            .unwrap();
        assert_eq!(
            (corner.copied_heights(0), corner.heights[2]),
            (Ok(corner.heights.clone()), 4.0)
        );
        assert!(corner.copied_heights(1).unwrap()[2] > 4.0);
        let digits = profile(&[0.0, 0.3333, 0.6667, 1.0], &[0.0; 4]);
        assert!((digits.spacing().unwrap()[0] - 1.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn rows_and_columns_of_a_map_are_profiles() {
        let row = map().cut(Cut::Row(2)).unwrap();
        assert_eq!(
            (&row.heights[..], row.spacing()),
            (&[3.0, 4.0, 5.0][..], Ok([1.0; 2]))
        );
        let column = map().cut(Cut::Column(3)).unwrap();
        assert_eq!(
            (&column.heights[..], column.spacing()),
            (&[2.0, 5.0][..], Ok([2.0; 2]))
        );
        for (cut, expected) in [
            (Cut::Row(0), "row 0; allowed: rows 1 to 2"),
            (Cut::Row(3), "row 3; allowed: rows 1 to 2"),
            (
                Cut::Column(u64::MAX),
                "column 18446744073709551615; allowed: columns 1 to 3",
            ),
        ] {
            assert_eq!(map().cut(cut).unwrap_err().to_string(), expected);
        }
        let profile = profile(&[0.0, 1.0], &[0.0, 1.0])
            .cut(Cut::Row(1))
            .unwrap_err()
            .to_string();
        assert_eq!(
            profile,
            "a profile, which has no rows and columns; allowed: a map"
        );
    }

    #[test]
    fn steep_slopes_and_maps_as_profiles_are_refused() {
        let steep = Reading::even("", vec![0.0, 1e5, 0.0, 0.0], 2, Some([1e-5; 2]), METRES);
        assert!(
            steep
                .resolve(&ReadOptions::default())
                .unwrap_err()
                .to_string()
                .starts_with("point 2: a slope of 1e10")
        );
        let error = map().into_profile().unwrap_err().to_string();
        assert_eq!(
            error,
            "a map of 2 rows of 3 points; allowed: a profile; in a scene with as_line: false the equivalent line of a map"
        );
    }
}
