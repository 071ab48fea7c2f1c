//! From the numbers of a file to heights in m: units, distances between points, missing points.

use super::surface::{Cut, Grid, LARGEST, Topography};
use super::{Place, TopographyError, refused};
use super::{Unit, missing};

/// Most points of a surface: 2 GiB of heights.
const MOST_POINTS: usize = 1 << 28;

/// Values of the user that a file may omit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of positions and heights if the file states none.
    pub unit: Option<Unit>,
    /// Unit of heights if the file states none; `None`: as `unit`.
    pub height_unit: Option<Unit>,
    /// Unit by convention, if neither the file nor the user states one.
    pub convention: Option<Unit>,
    /// Distance between points, m, if the file states none.
    pub spacing: Option<f64>,
    /// True if missing heights are interpolated from their neighbours along row and column; else they are an error.
    pub interpolate: bool,
    /// Number of the channel of a file with several.
    pub channel: Option<u32>,
    /// Row or column of a map read as a profile.
    pub cut: Option<Cut>,
    /// True if uneven profiles are resampled at their mean distance.
    pub resample: bool,
    /// True if the median of each row of a map is subtracted, since its rows are offset against each other.
    pub align_rows: bool,
    /// True if outliers are replaced by heights from their neighbours.
    pub robust: bool,
    /// Name of the surface of a container with several, or of a measurement.
    pub surface_name: Option<String>,
}

/// Numbers of a file before conversion, in its units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub format: &'static str,
    /// Heights row by row; not finite for a missing point.
    pub heights: Vec<f64>,
    /// Points of a row; all points of a profile.
    pub columns: usize,
    /// Positions of a profile, ascending; `None` for evenly spaced points.
    pub positions: Option<Vec<f64>>,
    /// Distances of evenly spaced points along and between rows, if the file states them.
    pub spacing: Option<[f64; 2]>,
    /// Units of positions and of heights, if the file states them.
    pub units: [Option<Unit>; 2],
    /// Place of the first missing point, if the reader knows a better one than its number.
    pub first_missing: Option<Place>,
}

impl Reading {
    /// Evenly spaced heights in rows of `columns` points: one row, or one column, is a profile.
    pub fn even(
        format: &'static str,
        heights: Vec<f64>,
        columns: usize,
        spacing: Option<[f64; 2]>,
        units: [Option<Unit>; 2],
    ) -> Reading {
        let rows = heights.len() / columns.max(1);
        let (columns, spacing) = match spacing {
            Some([along, _]) if rows == 1 => (columns, Some([along; 2])),
            Some([_, between]) if columns == 1 => (rows, Some([between; 2])),
            spacing => (if columns == 1 { rows } else { columns }, spacing),
        };
        Reading { format, heights, columns, positions: None, spacing, units, first_missing: None }
    }

    /// Profile at positions in the order of the file: one scanned backwards is reversed.
    pub fn profile(
        format: &'static str,
        mut positions: Vec<f64>,
        mut heights: Vec<f64>,
        units: [Option<Unit>; 2],
    ) -> Reading {
        if positions.len() > 1 && positions[0] > positions[1] {
            positions.reverse();
            heights.reverse();
        }
        let columns = heights.len();
        Reading { positions: Some(positions), ..Reading::even(format, heights, columns, None, units) }
    }

    /// Multiplies the heights by a scale; those of the value `missing` mark missing points.
    pub fn scaled(mut self, missing: Option<f64>, scale: f64) -> Reading {
        for height in &mut self.heights {
            *height = if Some(*height) == missing { f64::NAN } else { *height * scale };
        }
        self
    }

    /// Converts heights and positions to m.
    pub fn resolve(mut self, options: &ReadOptions) -> Result<Topography, TopographyError> {
        let points = self.heights.len();
        if !(2..=MOST_POINTS).contains(&points) {
            return Err(refused(Place::File, format!("{points} points"), format!("from 2 to {MOST_POINTS}")));
        }
        let [lateral_unit, height_unit] = self.units;
        let height_option = options.height_unit.or(options.unit);
        let height_unit = unit("heights", height_unit, height_option, options.convention)?;
        let missing = self.heights_in_metres(height_unit, options.interpolate)?;
        let Reading { format, mut heights, columns, positions, spacing, .. } = self;
        let unit = |name: &str| unit(name, lateral_unit, options.unit, options.convention);
        let even = |axis: usize| match (spacing, options.spacing) {
            (Some(spacing), _) => check_spacing(unit("distances")?.to_metres(spacing[axis])),
            (None, Some(spacing)) => check_spacing(spacing),
            (None, None) => {
                let fault = format!("{format} without a distance between points");
                let allowed = "a distance beside the file: --spacing 0.5um, in a scene roughness.spacing";
                Err(refused(Place::File, fault, allowed))
            }
        };
        let grid = match positions {
            Some(mut positions) => {
                let unit = unit("positions")?;
                positions.iter_mut().for_each(|x| *x = unit.to_metres(*x));
                check_positions(&positions)?;
                Grid::Positions(positions)
            }
            None => Grid::Even([even(0)?, even(1)?]),
        };
        let rows = heights.len() / columns;
        if options.align_rows {
            if rows < 2 {
                return Err(refused(Place::File, "a profile, which has no rows to align", "a map"));
            }
            missing::level_rows(&mut heights, columns)?;
        }
        let outliers = if options.robust { missing::remove_outliers(&mut heights, columns)? } else { 0 };
        let has_gaps = missing || outliers > 0;
        let interpolated = if has_gaps { missing::interpolate(&mut heights, columns)? } else { Vec::new() };
        let surface = Topography::new(format, heights, columns, grid, interpolated)?;
        Ok(Topography { aligned: options.align_rows, ..surface })
    }

    /// Converts heights to m. Returns true if some are missing.
    fn heights_in_metres(&mut self, unit: Unit, interpolate: bool) -> Result<bool, TopographyError> {
        let points = self.heights.len();
        let first = self.heights.iter().position(|height| !height.is_finite());
        if let (Some(first), false) = (first, interpolate) {
            let missing = missing::count(&self.heights);
            let share = 100.0 * missing as f64 / points as f64;
            return Err(refused(
                self.first_missing.take().unwrap_or(Place::Point(first + 1)),
                format!("{missing} of {points} points are missing ({share:.2} %), the first here"),
                "--interpolate, in a scene roughness.interpolate, which fills them from their neighbours",
            ));
        }
        self.heights.iter_mut().for_each(|height| *height = unit.to_metres(*height));
        check_range("height", &self.heights, f64::is_finite)?;
        Ok(first.is_some())
    }
}

/// Checks that no length, m, is beyond the largest one, of those that `counts`.
fn check_range(name: &str, lengths: &[f64], counts: fn(f64) -> bool) -> Result<(), TopographyError> {
    let is_beyond = |length: &f64| counts(*length) && (length.is_nan() || length.abs() > LARGEST);
    let Some(index) = lengths.iter().position(is_beyond) else { return Ok(()) };
    let fault = format!("a {name} of {:e} m", lengths[index]);
    Err(refused(Place::Point(index + 1), fault, format!("from -{LARGEST:e} to {LARGEST:e} m")))
}

fn check_positions(positions: &[f64]) -> Result<(), TopographyError> {
    check_range("position", positions, |_| true)?;
    // Units divide, and neighbours closer than the last digit coincide.
    let mut pairs = positions.windows(2).enumerate();
    let Some((index, pair)) = pairs.find(|(_, pair)| pair[0] >= pair[1]) else { return Ok(()) };
    let fault = format!("x = {:e} m after {:e} m", pair[1], pair[0]);
    Err(refused(Place::Point(index + 2), fault, "positions that ascend, or descend"))
}

/// Returns the unit of a quantity: stated by the file, else by the user, else by convention.
fn unit(
    name: &str,
    stated: Option<Unit>,
    option: Option<Unit>,
    convention: Option<Unit>,
) -> Result<Unit, TopographyError> {
    let (fault, allowed) = match (stated, option) {
        (Some(stated), Some(option)) if stated != option => (
            format!("the file states {stated} as the unit of {name}, the options state {option}"),
            "the unit of the file, or none",
        ),
        _ => match stated.or(option).or(convention) {
            Some(unit) => return Ok(unit),
            None => (
                format!("no unit of {name} is stated"),
                "a unit in the file or beside it: --unit um, in a scene roughness.unit",
            ),
        },
    };
    Err(refused(Place::File, fault, allowed))
}

fn check_spacing(spacing: f64) -> Result<f64, TopographyError> {
    if (1.0 / LARGEST / LARGEST..=LARGEST).contains(&spacing) {
        return Ok(spacing);
    }
    let fault = format!("a distance of {spacing:e} m between points");
    Err(refused(Place::File, fault, format!("from 1e-18 to {LARGEST:e} m")))
}
