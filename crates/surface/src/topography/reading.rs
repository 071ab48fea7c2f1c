//! Conversion of the numbers of a file to heights in m: units, distances between points, missing
//! points.

use super::surface::{Cropped, Cut, LARGEST, Layout, Topography};
use super::{Unit, levels, missing};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;
use std::ops::Range;

/// Largest number of points of a surface: 2 GiB of heights.
pub(super) const MOST_POINTS: usize = 1 << 28;

/// Options for reading a surface: units and distances that a file may omit, the part of the file to
/// read, and corrections of the heights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of positions and heights if the file states none.
    pub unit: Option<Unit>,
    /// Unit of the heights if the file states none for them; `None` means the unit in `unit`.
    pub height_unit: Option<Unit>,
    /// Unit of positions and heights that is assumed if the file states none and `unit` is `None`.
    pub convention: Option<Unit>,
    /// Distance between neighbouring points in m if the file states none.
    pub spacing: Option<f64>,
    /// True if missing heights are interpolated from their neighbours. Otherwise a missing height
    /// is an error.
    pub interpolate: bool,
    /// Number, from 0, of the channel to read from a file with several channels.
    pub channel: Option<u32>,
    /// Row or column of a map that is read as a profile. With `None` the whole map is read.
    pub cut: Option<Cut>,
    /// True if a profile with uneven distances between points is interpolated at evenly spaced
    /// points.
    pub resample: bool,
    /// True if the median height of each row of a map is subtracted from the row, which removes
    /// offsets between rows.
    pub align_rows: bool,
    /// True if outliers, such as spikes of the instrument, are replaced by heights interpolated
    /// from their neighbours.
    pub robust: bool,
    /// Name of the surface or of the measurement to read from an archive with several measurements.
    pub surface_name: Option<String>,
}

/// Numbers of a file before conversion, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub format: &'static str,
    /// Heights row by row; a missing point is not finite.
    pub heights: Vec<f64>,
    /// Number of points of a row, or of all points for a profile.
    pub columns: usize,
    /// Positions of a profile, ascending; `None` for evenly spaced points.
    pub positions: Option<Vec<f64>>,
    /// Distances of evenly spaced points along and between rows, if the file states them.
    pub spacing: Option<[f64; 2]>,
    /// Units of the positions along and between rows and of the heights, where the file states
    /// them.
    pub units: [Option<Unit>; 3],
    /// Place of the first missing point, if the reader can name it better than by its number.
    pub first_missing: Option<Place>,
    /// Messages about oddities of the file.
    pub warnings: Vec<String>,
}

impl Reading {
    /// Creates evenly spaced heights in rows of `columns` points. A single row or column is a
    /// profile.
    pub fn even(
        format: &'static str,
        heights: Vec<f64>,
        mut columns: usize,
        mut spacing: Option<[f64; 2]>,
        [mut along, mut between, of_heights]: [Option<Unit>; 3],
    ) -> Reading {
        let rows = heights.len() / columns.max(1);
        if rows == 1 {
            (spacing, between) = (spacing.map(|[along, _]| [along; 2]), along);
        } else if columns == 1 {
            (columns, spacing, along) = (rows, spacing.map(|[_, between]| [between; 2]), between);
        }
        let units = [along, between, of_heights];
        let (positions, first_missing, warnings) = (None, None, Vec::new());
        Reading {
            format,
            heights,
            columns,
            positions,
            spacing,
            units,
            first_missing,
            warnings,
        }
    }

    /// Creates a profile at positions in the order of the file. A profile scanned backwards is
    /// reversed.
    pub fn profile(
        format: &'static str,
        mut positions: Vec<f64>,
        mut heights: Vec<f64>,
        [lateral, of_heights]: [Option<Unit>; 2],
    ) -> Reading {
        if positions.len() > 1 && positions[0] > positions[1] {
            positions.reverse();
            heights.reverse();
        }
        let (columns, units) = (heights.len(), [lateral, lateral, of_heights]);
        Reading {
            positions: Some(positions),
            ..Reading::even(format, heights, columns, None, units)
        }
    }

    /// Multiplies the heights by `scale`. Heights for which `is_missing` is true become missing.
    pub fn scaled(mut self, is_missing: impl Fn(f64) -> bool, scale: f64) -> Reading {
        for height in &mut self.heights {
            *height = if is_missing(*height) {
                f64::NAN
            } else {
                *height * scale
            };
        }
        self
    }

    /// Converts heights and positions to m.
    pub fn resolve(mut self, options: &ReadOptions) -> Result<Topography, SurfaceError> {
        let points = self.heights.len();
        if !(2..=MOST_POINTS).contains(&points) {
            return Err(refused(
                Place::File,
                format!("{points} points"),
                format!("from 2 to {MOST_POINTS}"),
            ));
        }
        let [lateral_unit, unit_between, height_unit] = self.units;
        // An option for what the file does not state contradicts nothing that it states.
        let [of_positions, of_heights] = match (lateral_unit, height_unit, options.height_unit) {
            (None, Some(_), None) => [options.unit, None],
            (Some(_), None, None) => [None, options.unit],
            // Distances of a grid are lengths, such as 500 nm, whatever the unit of the heights is.
            (Some(_), Some(_), None) if self.positions.is_none() && options.unit == height_unit => {
                [None, options.unit]
            }
            (_, _, of_heights) => [options.unit, of_heights.or(options.unit)],
        };
        let height_unit = unit(
            "heights",
            height_unit,
            of_heights,
            options.convention,
            lateral_unit,
        )?;
        self.heights
            .iter_mut()
            .for_each(|height| *height = height_unit.to_metres(*height));
        check_range("height", &self.heights, f64::is_finite)?;
        let cropped = self.crop();
        let missing = self.has_missing(&cropped, options)?;
        self.warnings
            .extend(levels::warning(&self.heights, self.columns));
        let Reading {
            format,
            mut heights,
            columns,
            positions,
            spacing,
            warnings,
            ..
        } = self;
        let unit = |name: &str, stated: Option<Unit>| {
            let option = if stated.is_none() {
                options.unit
            } else {
                of_positions
            };
            unit(name, stated, option, options.convention, None)
        };
        let even = |axis: usize| match (spacing, options.spacing) {
            (Some(spacing), _) => {
                let unit = unit("distances", [lateral_unit, unit_between][axis])?;
                check_spacing(unit.to_metres(spacing[axis]))
            }
            (None, Some(spacing)) => check_spacing(spacing),
            (None, None) => {
                let fault = format!("{format} without a distance between points");
                let allowed =
                    "a distance beside the file: --spacing 0.5um, in a scene roughness.spacing";
                Err(refused(Place::File, fault, allowed))
            }
        };
        let layout = match positions {
            Some(mut positions) => {
                let unit = unit("positions", lateral_unit)?;
                positions.iter_mut().for_each(|x| *x = unit.to_metres(*x));
                check_positions(&positions)?;
                Layout::Positions(positions)
            }
            None => Layout::Even([even(0)?, even(1)?]),
        };
        let rows = heights.len() / columns;
        if options.align_rows {
            if rows < 2 {
                return Err(refused(
                    Place::File,
                    "a profile, which has no rows to align",
                    "a map",
                ));
            }
            missing::level_rows(&mut heights, columns)?;
        }
        let outliers = if options.robust {
            missing::remove_outliers(&mut heights, columns)?
        } else {
            0
        };
        let has_gaps = missing || outliers > 0;
        let interpolated = if has_gaps {
            missing::interpolate(&mut heights, columns)?
        } else {
            Vec::new()
        };
        let surface = Topography {
            format,
            heights,
            columns,
            layout,
            cropped,
            interpolated,
            resampled: Vec::new(),
            aligned: options.align_rows,
            name: String::new(),
            detrend: None,
            periodic: false,
            warnings,
        };
        surface.checked()
    }

    /// Converts heights and positions to m, and returns the surface or the row or column of it that
    /// the options choose.
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

    /// Leaves out empty rows and columns at the borders of a map, or missing points at the ends of
    /// a profile.
    fn crop(&mut self) -> Cropped {
        let (columns, rows) = (self.columns, self.heights.len() / self.columns);
        let [across, down] = missing::measured_part(&self.heights, columns);
        // A map stays a map.
        let is_map = |part: &Range<usize>, count: usize| part.len() >= count.min(2);
        if across.len() * down.len() == self.heights.len()
            || !is_map(&across, columns)
            || !is_map(&down, rows)
        {
            return Cropped::default();
        }
        let (mut index, mut place) = (0, 0);
        self.heights.retain(|_| {
            let is_inside =
                across.contains(&(index % columns)) && down.contains(&(index / columns));
            index += 1;
            is_inside
        });
        if let Some(positions) = &mut self.positions {
            positions.retain(|_| {
                place += 1;
                across.contains(&(place - 1))
            });
        }
        self.columns = across.len();
        // A line of the file may be the line of a point that is left out.
        self.first_missing = None;
        Cropped {
            before: [across.start, down.start],
            after: [columns - across.end, rows - down.end],
        }
    }

    /// Returns true if points are missing. Returns an error if they are part of what is read and
    /// are not to be interpolated.
    fn has_missing(&self, cropped: &Cropped, options: &ReadOptions) -> Result<bool, SurfaceError> {
        let is_missing = |index: &usize| !self.heights[*index].is_finite();
        let is_read = |index: &usize| {
            let [column, row] = [index % self.columns, index / self.columns];
            match options.cut {
                None => true,
                Some(Cut::Row(number)) => (row + cropped.before[1] + 1) as u64 == number,
                Some(Cut::Column(number)) => (column + cropped.before[0] + 1) as u64 == number,
            }
        };
        let points = 0..self.heights.len();
        let (Some(first), false) = (
            points.clone().filter(is_missing).find(is_read),
            options.interpolate,
        ) else {
            return Ok(points.into_iter().any(|index| is_missing(&index)));
        };
        let (missing, points) = (missing::count(&self.heights), self.heights.len());
        let share = 100.0 * missing as f64 / points as f64;
        let in_file = cropped.place_in_file(first, self.columns);
        Err(refused(
            self.first_missing
                .clone()
                .unwrap_or(Place::Point(in_file + 1)),
            format!("{missing} of {points} points are missing ({share:.2} %), the first here"),
            "--interpolate, in a scene roughness.interpolate, which fills them from their neighbours",
        ))
    }
}

impl Topography {
    /// Creates a profile from heights in m of points at equal distances of `spacing` in m.
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

    /// Creates a map from heights in m, row by row in rows of `columns` points. `spacing` has the
    /// distance in m between neighbouring points of a row, and the distance in m between
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

    /// Creates a map as [`Topography::from_map`] does, with the corrections of [`ReadOptions`] that
    /// a file has: a row or a column alone, levelled rows, replaced outliers and interpolated
    /// points. A height of NaN is a missing point.
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
        let metres = [Some(Unit::METRE); 3];
        Reading::even("array", heights, columns, Some(spacing), metres).resolve_part(options)
    }
}

/// Returns an error for heights that are not whole rows of `columns` points.
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

/// Returns an error if a length (m) for which `counts` is true exceeds [`LARGEST`].
fn check_range(name: &str, lengths: &[f64], counts: fn(f64) -> bool) -> Result<(), SurfaceError> {
    let is_beyond = |length: &f64| counts(*length) && (length.is_nan() || length.abs() > LARGEST);
    let Some(index) = lengths.iter().position(is_beyond) else {
        return Ok(());
    };
    let fault = format!("a {name} of {:e} m", lengths[index]);
    Err(refused(
        Place::Point(index + 1),
        fault,
        format!("from -{LARGEST:e} to {LARGEST:e} m"),
    ))
}

fn check_positions(positions: &[f64]) -> Result<(), SurfaceError> {
    check_range("position", positions, |_| true)?;
    // Units divide, and neighbours closer than the last digit coincide.
    let mut pairs = positions.windows(2).enumerate();
    let Some((index, pair)) = pairs.find(|(_, pair)| pair[0] >= pair[1]) else {
        return Ok(());
    };
    let fault = format!("x = {:e} m after {:e} m", pair[1], pair[0]);
    Err(refused(
        Place::Point(index + 2),
        fault,
        "positions that ascend, or descend",
    ))
}

/// Returns the unit of a quantity: as the file states, else as the user states, else by convention.
/// `beside` is a unit that the file states for the positions alone.
fn unit(
    name: &str,
    stated: Option<Unit>,
    option: Option<Unit>,
    convention: Option<Unit>,
    beside: Option<Unit>,
) -> Result<Unit, SurfaceError> {
    let (fault, allowed) = match (stated, option) {
        (Some(stated), Some(option)) if stated != option => (
            format!("the file states {stated} as the unit of {name}, the options state {option}"),
            "the unit of the file, or none".to_owned(),
        ),
        _ => match (stated.or(option).or(convention), beside) {
            (Some(unit), _) => return Ok(unit),
            (None, beside) => {
                let (unit, options, fields) = match beside {
                    Some(unit) => (
                        unit.name(),
                        " or --height-unit nm",
                        "roughness.unit or roughness.height_unit",
                    ),
                    None => ("um", "", "roughness.unit"),
                };
                let allowed = format!(
                    "a unit in the file or beside it: --unit {unit}{options}, in a scene {fields}"
                );
                (format!("no unit of {name} is stated"), allowed)
            }
        },
    };
    Err(refused(Place::File, fault, allowed))
}

fn check_spacing(spacing: f64) -> Result<f64, SurfaceError> {
    if (1.0 / LARGEST / LARGEST..=LARGEST).contains(&spacing) {
        return Ok(spacing);
    }
    let fault = format!("a distance of {spacing:e} m between points");
    Err(refused(
        Place::File,
        fault,
        format!("from 1e-18 to {LARGEST:e} m"),
    ))
}
