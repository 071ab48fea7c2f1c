//! Measured heights in m with their positions.

use super::missing;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{between, gathered};
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// Largest allowed position and height in m, and largest slope between neighbours. Beyond them,
/// lengths and mean squares could overflow.
pub(super) const LARGEST: f64 = 1.0e9;

/// Share of the spacing by which points of an even grid may be displaced because of rounding.
pub(crate) const UNEVEN: f64 = 1.0e-3;

/// Returns the index of the first position that lies off the even grid with this first position (m)
/// and distance (m).
pub(crate) fn first_uneven(positions: &[f64], first: f64, distance: f64) -> Option<usize> {
    let is_even = |(index, x): (usize, &f64)| {
        (x - first - index as f64 * distance).abs() <= UNEVEN * distance.abs()
    };
    positions
        .iter()
        .enumerate()
        .position(|point| !is_even(point))
}

/// A row or a column of a map that is read as a profile. Rows and columns count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The row with this number.
    Row(u64),
    /// The column with this number.
    Column(u64),
}

/// Positions of the points of a surface in m.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Layout {
    /// Positions of the points of a profile, ascending.
    Positions(Vec<f64>),
    /// Distances along and between rows; both are equal for a profile.
    Even([f64; 2]),
}

/// Numbers of columns and rows at the borders of a map that have no measured point and are left
/// out. For a profile the numbers of columns are numbers of points at its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cropped {
    pub(super) before: [usize; 2],
    pub(super) after: [usize; 2],
}

impl Cropped {
    /// Returns the number of columns and the number of rows left out, each counted at two opposite
    /// borders together.
    pub fn counts(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.before[axis] + self.after[axis])
    }

    /// Returns the index in the file of a remaining point. `index` counts the remaining points in
    /// rows of `columns` points.
    pub(super) fn place_in_file(&self, index: usize, columns: usize) -> usize {
        let (row, column) = (
            index / columns + self.before[1],
            index % columns + self.before[0],
        );
        row * (columns + self.counts()[0]) + column
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
    /// Numbers of rows and columns without a measured point that are left out at the borders.
    pub cropped: Cropped,
    /// Indices of the points with interpolated heights.
    pub(crate) interpolated: Vec<usize>,
    /// Positions before resampling in m; empty for a surface that was not resampled.
    pub(super) resampled: Vec<f64>,
    /// True if the rows were levelled one by one.
    pub(crate) aligned: bool,
    /// Name of the measurement in an archive of several measurements; empty for a surface that has
    /// a file of its own.
    pub name: String,
    /// Polynomial to remove, and whether the surface is periodic at its borders, as a container
    /// states.
    pub(crate) detrend: Option<Detrend>,
    pub(crate) periodic: bool,
    /// Messages for the user, each about something unusual in the file.
    pub warnings: Vec<String>,
}

impl Topography {
    /// Returns the surface, or an error if it has a slope above 1e9.
    pub(super) fn checked(self) -> Result<Self, SurfaceError> {
        let slope = |index: usize| {
            let distance = match &self.layout {
                Layout::Positions(positions) => positions[index] - positions[index - 1],
                Layout::Even([along, between]) => along.min(*between),
            };
            (self.heights[index] - self.heights[index - 1]).abs() / distance
        };
        let is_steep = |index: &usize| slope(*index).is_nan() || slope(*index) > LARGEST;
        let mut places = (1..self.heights.len()).filter(|index| index % self.columns > 0);
        let Some(index) = places.find(is_steep) else {
            return Ok(self);
        };
        let found = format!("a slope of {:e} from the point before", slope(index));
        let place = Place::Point(self.cropped.place_in_file(index, self.columns) + 1);
        Err(refused(place, found, format!("at most {LARGEST:e}")))
    }

    /// Returns the number of points whose heights are interpolated, missing points and replaced
    /// outliers together.
    pub fn interpolated(&self) -> usize {
        self.interpolated.len()
    }

    /// Returns the index in the file of the first missing point of a profile, from 0.
    pub(crate) fn first_missing(&self) -> Option<usize> {
        let Cropped {
            before: [before, _],
            after: [after, _],
        } = self.cropped;
        let inside = self
            .interpolated
            .first()
            .copied()
            .or((after > 0).then_some(self.columns));
        if before > 0 { Some(0) } else { inside }
    }

    pub(crate) fn is_resampled(&self) -> bool {
        !self.resampled.is_empty()
    }

    /// Copies the heights in m. With `quarters` above zero the copy differs by an estimate of the
    /// error of interpolation. Points at this number of quarters of length and width from the
    /// interpolated points are then interpolated too. A resampled profile gets back what resampling
    /// to its former positions and back would take.
    pub(crate) fn copied_heights(&self, quarters: usize) -> Result<Vec<f64>, SurfaceError> {
        let (columns, rows) = (self.columns, self.rows());
        let mut heights = gathered(self.heights.len(), self.heights.iter().copied())?;
        if let (Layout::Even([spacing, _]), 1.., true) =
            (&self.layout, quarters, self.is_resampled())
        {
            let (former, first) = (&self.resampled, self.resampled[0]);
            let places = gathered(
                columns,
                (0..columns).map(|index| first + index as f64 * spacing),
            )?;
            let there = gathered(
                columns,
                interpolated(&places, &heights, 0.0, former.iter().copied()),
            )?;
            let smoother = interpolated(former, &there, 0.0, places.iter().copied());
            // What was lost before is not lost again: the more, the more the distances between
            // points vary.
            let squares = former
                .windows(2)
                .map(|x| ((x[1] - x[0]) / spacing - 1.0).powi(2))
                .sum::<f64>();
            let lost = 1.0 + (squares / (columns - 1) as f64).sqrt();
            heights
                .iter_mut()
                .zip(smoother)
                .for_each(|(height, smoother)| *height += lost * (*height - smoother));
        }
        if quarters == 0 || self.interpolated.is_empty() {
            return Ok(heights);
        }
        for index in &self.interpolated {
            let moved = |place: usize, count: usize| (place + quarters * count / 4) % count;
            let (row, column) = (
                moved(index / columns, rows),
                moved(index % columns, columns),
            );
            heights[row * columns + column] = f64::NAN;
        }
        missing::interpolate(&mut heights, columns)?;
        Ok(heights)
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
        let (columns, rows) = (self.columns, self.rows());
        if rows > 1 {
            let fault = format!("a map of {rows} rows of {columns} points");
            let allowed = "a profile; in a scene with as_line: false the equivalent line of a map";
            return Err(refused(Place::File, fault, allowed));
        }
        let positions = match self.layout {
            Layout::Positions(positions) => positions,
            Layout::Even([spacing, _]) => {
                gathered(columns, (0..columns).map(|index| index as f64 * spacing))?
            }
        };
        Ok((positions, self.heights))
    }

    /// Returns the row or column `cut` of a map as a profile.
    pub(super) fn cut(self, cut: Cut) -> Result<Self, SurfaceError> {
        let (columns, rows) = (self.columns, self.rows());
        let (Layout::Even([along, between]), 2..) = (&self.layout, rows) else {
            return Err(refused(
                Place::File,
                "a profile, which has no rows and columns",
                "a map",
            ));
        };
        // Rows and columns are those of the file.
        let [first_column, first_row] = self.cropped.before;
        let (name, number, first, count) = match cut {
            Cut::Row(number) => ("row", number, first_row, rows),
            Cut::Column(number) => ("column", number, first_column, columns),
        };
        let index = usize::try_from(number)
            .ok()
            .and_then(|number| number.checked_sub(1 + first));
        let Some(index) = index.filter(|index| *index < count) else {
            let allowed = format!("{name}s {} to {}", first + 1, first + count);
            return Err(refused(Place::File, format!("{name} {number}"), allowed));
        };
        let (first, step, points, spacing) = match cut {
            Cut::Row(_) => (index * columns, 1, columns, *along),
            Cut::Column(_) => (index, columns, rows, *between),
        };
        let place = |index: &usize| {
            let offset = index
                .checked_sub(first)
                .filter(|offset| offset % step == 0)?;
            Some(offset / step).filter(|place| *place < points)
        };
        let axis = usize::from(matches!(cut, Cut::Column(_)));
        let ends = |of: [usize; 2]| [of[axis], 0];
        Ok(Topography {
            cropped: Cropped {
                before: ends(self.cropped.before),
                after: ends(self.cropped.after),
            },
            heights: gathered(
                points,
                self.heights
                    .iter()
                    .skip(first)
                    .step_by(step)
                    .take(points)
                    .copied(),
            )?,
            columns: points,
            layout: Layout::Even([spacing; 2]),
            aligned: false,
            interpolated: self.interpolated.iter().filter_map(place).collect(),
            ..self
        })
    }

    /// Returns the distance between neighbouring points along the rows and the distance between
    /// rows, in m. Both are equal for a profile.
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
        match &self.layout {
            Layout::Even(spacing) => Ok(*spacing),
            Layout::Positions(positions) => {
                let (first, mean) = (positions[0], mean_distance(positions));
                let Some(index) = first_uneven(positions, first, mean) else {
                    return Ok([mean; 2]);
                };
                let (x, off) = (
                    positions[index],
                    (positions[index] - first) / mean - index as f64,
                );
                let fault = format!(
                    "x = {x:e} m is off the even grid by {off:.1e} of the mean distance {mean:e} m"
                );
                let allowed = format!(
                    "at most {UNEVEN}, or --resample, in a scene roughness.resample, which interpolates linearly"
                );
                Err(refused(Place::Point(index + 1), fault, allowed))
            }
        }
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
        let (first, spacing, points) = (positions[0], mean_distance(&positions), positions.len());
        let places = (0..points).map(|index| first + index as f64 * spacing);
        self.heights = gathered(points, interpolated(&positions, &self.heights, 0.0, places))?;
        (self.layout, self.resampled) = (Layout::Even([spacing; 2]), positions);
        Ok(self)
    }
}

/// Returns the heights above `level` (m) at ascending places (m), by linear interpolation between
/// at least two points. At a point it is its own height, bit for bit. Beyond the first and the last
/// point it is the height of that point.
pub(crate) fn interpolated(
    positions: &[f64],
    heights: &[f64],
    level: f64,
    places: impl Iterator<Item = f64>,
) -> impl Iterator<Item = f64> {
    let mut piece = 0;
    places.map(move |x| {
        while piece + 2 < positions.len() && positions[piece + 1] < x {
            piece += 1;
        }
        let (x0, x1) = (positions[piece], positions[piece + 1]);
        let (z0, z1) = (heights[piece] - level, heights[piece + 1] - level);
        if x <= x0 {
            z0
        } else if x >= x1 {
            z1
        } else {
            between(z0, z1, (x - x0) / (x1 - x0))
        }
    })
}

fn mean_distance(positions: &[f64]) -> f64 {
    (positions[positions.len() - 1] - positions[0]) / (positions.len() - 1) as f64
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
    use super::super::Unit;
    use super::super::reading::{ReadOptions, Reading};
    use super::*;

    const METRES: [Option<Unit>; 3] = [Some(Unit::METRE); 3];

    fn profile(positions: &[f64], heights: &[f64]) -> Topography {
        let reading = Reading::profile(
            "",
            positions.to_vec(),
            heights.to_vec(),
            [Some(Unit::METRE); 2],
        );
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
        let error = uneven.spacing().unwrap_err().to_string();
        assert!(
            error.starts_with("point 3: x = 2.5e0 m is off") && error.contains("--resample"),
            "{error}"
        );
        let even = uneven.resampled().unwrap();
        assert_eq!(
            (even.spacing(), &even.heights[..]),
            (Ok([1.0; 2]), &[0.0, 2.0, 4.0, 6.0][..])
        );
        // A straight line stays, a corner is sharper.
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
