//! Conversion of the contents of a file to a surface in m. The conversion determines units and
//! distances between points, treats missing points, and selects the part of the map that is read.

use super::cut::Cut;
use super::options::ReadOptions;
use super::positions::LARGEST;
use super::reading::Reading;
use super::stated_units::Units;
use super::surface::{Cropped, Layout, Topography};
use super::{levels, missing, outliers};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Note, Remedy};
use std::ops::Range;

/// Largest number of points of a surface. The heights of this number of points take 2 GiB of
/// memory.
pub(super) const MOST_POINTS: usize = 1 << 28;

impl Reading {
    /// Converts heights and positions to m, and returns the surface. If the options choose a row or
    /// a column, only this row or column is returned, as a profile.
    ///
    /// # Errors
    /// Returns an error if a unit, a distance or a height is missing and the options do not state
    /// it, if a value is out of its range, or if an option does not suit the surface.
    pub fn resolve_part(self, options: &ReadOptions) -> Result<Topography, SurfaceError> {
        let mut surface = self.resolve(options)?;
        if let Some(cut) = options.cut {
            surface = surface.cut(cut)?;
        }
        if options.resample {
            surface.resampled()
        } else {
            Ok(surface)
        }
    }

    /// Converts heights and positions to m, corrects the heights as the options request, and
    /// returns the whole surface.
    ///
    /// # Errors
    /// Returns an error if a unit, a distance or a height is missing and the options do not state
    /// it, if a value is out of its range, or if an option does not suit the surface.
    pub fn resolve(mut self, options: &ReadOptions) -> Result<Topography, SurfaceError> {
        check_points(self.heights.len())?;
        let units = Units::new(self.units, self.positions.is_some(), options);
        let height_unit = units.heights()?;
        for height in &mut self.heights {
            *height = height_unit.to_metres(*height);
        }
        check_range("height", &self.heights, f64::is_finite)?;

        let cropped = self.crop();
        let is_missing = self.has_missing(&cropped, options)?;
        let warning = levels::warning(&self.heights, self.columns);
        self.warnings.extend(warning.map(Note::new));
        let layout = self.layout(&units, options)?;

        let mut heights = self.heights;
        let columns = self.columns;
        if options.align_rows {
            if heights.len() / columns < 2 {
                let found = "a profile, which has no rows to align";
                return Err(refused(Place::File, found, "a map"));
            }
            outliers::level_rows(&mut heights, columns)?;
        }
        let outliers = if options.robust {
            outliers::remove_outliers(&mut heights, columns)?
        } else {
            0
        };
        let interpolated = if is_missing || outliers > 0 {
            missing::interpolate(&mut heights, columns)?
        } else {
            Vec::new()
        };
        let surface = Topography {
            format: self.format,
            heights,
            columns,
            layout,
            cropped,
            interpolated,
            resampled: Vec::new(),
            aligned: options.align_rows,
            name: String::new(),
            detrend: None,
            periodic: self.periodic,
            warnings: self.warnings,
        };
        surface.check_slopes()?;
        Ok(surface)
    }

    /// Removes rows and columns without a measured point at the borders of a map, or missing points
    /// at the ends of a profile. Returns how many were removed.
    fn crop(&mut self) -> Cropped {
        let columns = self.columns;
        let rows = self.heights.len() / columns;
        let [across, down] = missing::measured_part(&self.heights, columns);
        let is_whole = across.len() * down.len() == self.heights.len();
        // A map must not become a profile, so at least two rows and two columns must remain.
        let is_too_narrow = |part: &Range<usize>, count: usize| part.len() < count.min(2);
        if is_whole || is_too_narrow(&across, columns) || is_too_narrow(&down, rows) {
            return Cropped::default();
        }
        let mut index = 0;
        self.heights.retain(|_| {
            let column = index % columns;
            let row = index / columns;
            index += 1;
            across.contains(&column) && down.contains(&row)
        });
        if let Some(positions) = &mut self.positions {
            positions.truncate(across.end);
            positions.drain(..across.start);
        }
        self.columns = across.len();
        // The first missing point may have been removed, so its place is no longer valid.
        self.first_missing = None;
        Cropped {
            before: [across.start, down.start],
            after: [columns - across.end, rows - down.end],
        }
    }

    /// Returns true if points are missing. Returns an error if a missing point is in the part that
    /// is read and the options do not request interpolation.
    fn has_missing(&self, cropped: &Cropped, options: &ReadOptions) -> Result<bool, SurfaceError> {
        let points = self.heights.len();
        let missing = missing::count(&self.heights);
        if missing == 0 || options.interpolate {
            return Ok(missing > 0);
        }
        let mut missing_points = (0..points).filter(|index| !self.heights[*index].is_finite());
        let first = missing_points.find(|index| self.is_read(*index, cropped, options.cut));
        let Some(first) = first else {
            return Ok(true);
        };
        let number = cropped.place_in_file(first, self.columns) + 1;
        let place = self.first_missing.clone();
        Err(SurfaceError::MissingPoints {
            place: place.unwrap_or(Place::Point(number)),
            missing,
            points,
        })
    }

    /// Returns true if a point is read: if it is in the row or the column that the options choose,
    /// or if the options choose none.
    fn is_read(&self, index: usize, cropped: &Cropped, cut: Option<Cut>) -> bool {
        let [columns_before, rows_before] = cropped.before;
        let column = index % self.columns + columns_before + 1;
        let row = index / self.columns + rows_before + 1;
        match cut {
            None => true,
            Some(Cut::Row(number)) => row as u64 == number,
            Some(Cut::Column(number)) => column as u64 == number,
        }
    }

    /// Returns the positions of the points in m, or their distances if they are evenly spaced.
    fn layout(&mut self, units: &Units<'_>, options: &ReadOptions) -> Result<Layout, SurfaceError> {
        let Some(mut positions) = self.positions.take() else {
            let along = self.distance(0, units, options)?;
            let between = self.distance(1, units, options)?;
            return Ok(Layout::Even([along, between]));
        };
        let unit = units.positions()?;
        for position in &mut positions {
            *position = unit.to_metres(*position);
        }
        check_positions(&positions)?;
        Ok(Layout::Positions(positions))
    }

    /// Returns the distance in m between evenly spaced points along the rows (`axis` 0), or between
    /// the rows (`axis` 1). The distance in the file is used or, if the file states none, that in
    /// the options.
    fn distance(
        &self,
        axis: usize,
        units: &Units<'_>,
        options: &ReadOptions,
    ) -> Result<f64, SurfaceError> {
        if let Some(spacing) = self.spacing {
            let unit = units.distances(axis)?;
            return check_spacing(unit.to_metres(spacing[axis]));
        }
        if let Some(spacing) = options.spacing {
            return check_spacing(spacing);
        }
        let found = format!("{} without a distance between points", self.format);
        Err(refused(Place::File, found, "a distance beside the file").with(Remedy::Spacing))
    }
}

fn check_points(points: usize) -> Result<(), SurfaceError> {
    if (2..=MOST_POINTS).contains(&points) {
        return Ok(());
    }
    let found = format!("{points} points");
    let allowed = format!("from 2 to {MOST_POINTS}");
    Err(refused(Place::File, found, allowed))
}

/// Returns an error if the magnitude of a length in m exceeds [`LARGEST`]. Lengths for which
/// `counts` is false are not checked.
fn check_range(name: &str, lengths: &[f64], counts: fn(f64) -> bool) -> Result<(), SurfaceError> {
    let is_beyond = |length: &f64| counts(*length) && (length.is_nan() || length.abs() > LARGEST);
    let Some(index) = lengths.iter().position(is_beyond) else {
        return Ok(());
    };
    let found = format!("a {name} of {:e} m", lengths[index]);
    let allowed = format!("from -{LARGEST:e} to {LARGEST:e} m");
    Err(refused(Place::Point(index + 1), found, allowed))
}

fn check_positions(positions: &[f64]) -> Result<(), SurfaceError> {
    check_range("position", positions, |_| true)?;
    for (index, pair) in positions.windows(2).enumerate() {
        // The conversion of units is a division. It may round two neighbouring positions to the
        // same value if they differ only in the last bit.
        if pair[0] >= pair[1] {
            let found = format!("x = {:e} m after {:e} m", pair[1], pair[0]);
            let allowed = "positions that ascend, or descend";
            return Err(refused(Place::Point(index + 2), found, allowed));
        }
    }
    Ok(())
}

fn check_spacing(spacing: f64) -> Result<f64, SurfaceError> {
    if (1.0 / LARGEST / LARGEST..=LARGEST).contains(&spacing) {
        return Ok(spacing);
    }
    let found = format!("a distance of {spacing:e} m between points");
    let allowed = format!("from 1e-18 to {LARGEST:e} m");
    Err(refused(Place::File, found, allowed))
}
