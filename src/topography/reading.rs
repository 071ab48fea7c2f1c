//! From the numbers of a file to heights in m: units, distances between points, missing points.

use super::error::{Place, TopographyError, refused};
use super::{Grid, Topography, Unit, missing};
use strum::IntoStaticStr;

/// Largest position and height, m, and largest slope between neighbours: beyond these, lengths and mean squares
/// could overflow.
pub(super) const LARGEST: f64 = 1.0e9;

/// Most points of a surface: 2 GiB of heights.
const MOST_POINTS: usize = 1 << 28;

/// Values of the user that a file may omit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
}

/// Format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr)]
pub enum Format {
    /// Columns x z, or x y z, or z.
    #[strum(serialize = "text columns")]
    Columns,
    /// Rows of heights.
    #[strum(serialize = "text matrix")]
    Matrix,
    /// ISO 25178-71.
    #[strum(serialize = "SDF")]
    Sdf,
    /// Gwyddion Simple Field.
    #[strum(serialize = "GSF")]
    Gsf,
    /// `.npy`.
    #[strum(serialize = "NumPy array")]
    Npy,
    /// ISO 25178-72.
    #[strum(serialize = "X3P")]
    X3p,
    /// Gwyddion's own format.
    #[strum(serialize = "GWY")]
    Gwy,
    /// Digital Surf.
    #[strum(serialize = "SUR")]
    Sur,
    /// The classic format.
    #[strum(serialize = "NetCDF")]
    NetCdf,
}

/// Positions of the heights of a file, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RawGrid {
    /// Position of each height, ascending.
    Positions(Vec<f64>),
    /// Equally spaced profile, with the distance if the file states one.
    Profile(Option<f64>),
    /// Equally spaced rows of so many columns, with the distances along and between rows if the file states them.
    Map { columns: usize, spacing: Option<[f64; 2]> },
}

impl RawGrid {
    /// Grid of so many columns and rows: one row, or one column, is a profile.
    pub fn of(columns: usize, rows: usize, spacing: Option<[f64; 2]>) -> RawGrid {
        match (columns, rows) {
            (_, 1) => RawGrid::Profile(spacing.map(|[along, _]| along)),
            (1, _) => RawGrid::Profile(spacing.map(|[_, between]| between)),
            _ => RawGrid::Map { columns, spacing },
        }
    }

    /// Positions of a profile in the order of the file. A profile scanned backwards is the same profile: both columns are
    /// reversed.
    pub fn scanned(mut positions: Vec<f64>, heights: &mut [f64]) -> RawGrid {
        if positions.len() > 1 && positions[0] > positions[1] {
            positions.reverse();
            heights.reverse();
        }
        RawGrid::Positions(positions)
    }
}

/// Numbers of a file before conversion.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub format: Format,
    /// Heights row by row; not finite for a missing point.
    pub heights: Vec<f64>,
    pub grid: RawGrid,
    /// Unit of positions and distances; `None` if the file states none.
    pub lateral_unit: Option<Unit>,
    pub height_unit: Option<Unit>,
    /// Place of the first missing point, if the reader knows a better one than its number.
    pub first_missing: Option<Place>,
}

impl Reading {
    /// Numbers of a file with its units of positions and of heights.
    pub fn new(format: Format, heights: Vec<f64>, grid: RawGrid, units: [Option<Unit>; 2]) -> Reading {
        let [lateral_unit, height_unit] = units;
        Reading { format, heights, grid, lateral_unit, height_unit, first_missing: None }
    }

    /// Converts heights and positions to m.
    ///
    /// # Errors
    /// An unknown unit or distance, missing or too many points, values out of range.
    pub fn resolve(mut self, options: &ReadOptions) -> Result<Topography, TopographyError> {
        let points = self.heights.len();
        if !(2..=MOST_POINTS).contains(&points) {
            return Err(refused(Place::File, format!("{points} points"), format!("from 2 to {MOST_POINTS}")));
        }
        let height_option = options.height_unit.or(options.unit);
        let height_unit = unit("heights", self.height_unit, height_option, options.convention)?;
        let missing = self.heights_in_metres(height_unit, options.interpolate)?;
        let Reading { format, mut heights, grid, lateral_unit, .. } = self;
        let unit = |name: &str| unit(name, lateral_unit, options.unit, options.convention);
        let even = |distance: Option<f64>| match (distance, options.spacing) {
            (Some(distance), _) => check_spacing(unit("distances")?.to_metres(distance)),
            (None, Some(spacing)) => check_spacing(spacing),
            (None, None) => {
                let fault = format!("{} without a distance between points", <&str>::from(format));
                let allowed = "a distance beside the file: --spacing 0.5um, in a scene roughness.spacing";
                Err(refused(Place::File, fault, allowed))
            }
        };
        let grid = match grid {
            RawGrid::Positions(mut positions) => {
                let unit = unit("positions")?;
                positions.iter_mut().for_each(|x| *x = unit.to_metres(*x));
                check_positions(&positions)?;
                Grid::Positions(positions)
            }
            RawGrid::Profile(spacing) => Grid::Profile { spacing: even(spacing)? },
            RawGrid::Map { columns, spacing } => {
                let [along, between] = spacing.map_or([None; 2], |spacing| spacing.map(Some));
                Grid::Map { columns, spacing: [even(along)?, even(between)?] }
            }
        };
        let columns = if let Grid::Map { columns, .. } = grid { columns } else { points };
        let interpolated = if missing { missing::interpolate(&mut heights, columns)? } else { Vec::new() };
        Topography::new(format, heights, grid, interpolated)
    }

    /// Converts heights to m. Returns true if some are missing.
    ///
    /// # Errors
    /// Missing points if these are not interpolated, heights out of range.
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

/// Checks ascending positions, m.
fn check_positions(positions: &[f64]) -> Result<(), TopographyError> {
    check_range("position", positions, |_| true)?;
    // Units divide, and neighbours closer than the last digit coincide.
    let Some(index) = positions.windows(2).position(|pair| pair[0] >= pair[1]) else { return Ok(()) };
    Err(refused(Place::Point(index + 2), "the position of the point before", "ascending positions"))
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
