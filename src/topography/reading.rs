//! From the numbers of a file to heights in m: units, distances between points, missing points.

use super::error::{Place, TopographyError, refused};
use super::{Grid, Topography, Unit, missing};

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
    /// Treatment of missing points.
    pub missing: Missing,
    /// Number of the channel of a file with several.
    pub channel: Option<u32>,
}

/// Treatment of missing points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Missing {
    /// A missing point is an error.
    #[default]
    Refuse,
    /// A missing height is interpolated from its neighbours along its row and its column.
    Interpolate,
}

/// Format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Columns of text: x z, or x y z, or z.
    Columns,
    /// Matrix of text.
    Matrix,
    /// SDF of ISO 25178-71.
    Sdf,
    /// Gwyddion Simple Field.
    Gsf,
    /// Array of NumPy.
    Npy,
    /// X3P of ISO 25178-72.
    X3p,
    /// Gwyddion's own format.
    Gwy,
    /// Digital Surf SUR.
    Sur,
    /// NetCDF in its classic format.
    NetCdf,
}

impl Format {
    /// Name for readers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Format::Columns => "text columns",
            Format::Matrix => "text matrix",
            Format::Sdf => "SDF",
            Format::Gsf => "GSF",
            Format::Npy => "NumPy array",
            Format::X3p => "X3P",
            Format::Gwy => "GWY",
            Format::Sur => "SUR",
            Format::NetCdf => "NetCDF",
        }
    }
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

    /// The grid in m.
    ///
    /// # Errors
    /// An unknown unit or distance, positions out of range.
    fn in_metres(
        self,
        format: Format,
        stated: Option<Unit>,
        options: &ReadOptions,
    ) -> Result<Grid, TopographyError> {
        let unit = |name: &str| unit(name, stated, options.unit, options.convention);
        let even = |distance: Option<f64>| match (distance, options.spacing) {
            (Some(distance), _) => check_spacing(unit("distances")?.to_metres(distance)),
            (None, Some(spacing)) => check_spacing(spacing),
            (None, None) => Err(refused(
                Place::File,
                format!("{} without a distance between points", format.name()),
                "a distance beside the file: --spacing 0.5um, in a scene roughness.spacing",
            )),
        };
        match self {
            RawGrid::Positions(mut positions) => {
                let unit = unit("positions")?;
                positions.iter_mut().for_each(|x| *x = unit.to_metres(*x));
                check_positions(&positions)?;
                Ok(Grid::Positions(positions))
            }
            RawGrid::Profile(spacing) => Ok(Grid::Profile { spacing: even(spacing)? }),
            RawGrid::Map { columns, spacing } => {
                let [along, between] = spacing.map_or([None; 2], |spacing| spacing.map(Some));
                Ok(Grid::Map { columns, spacing: [even(along)?, even(between)?] })
            }
        }
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
    /// Heights and positions in m.
    ///
    /// # Errors
    /// An unknown unit or distance, missing or too many points, values out of range.
    pub fn resolve(self, options: &ReadOptions) -> Result<Topography, TopographyError> {
        let Reading { format, mut heights, grid, lateral_unit, height_unit, first_missing } = self;
        let points = heights.len();
        if !(2..=MOST_POINTS).contains(&points) {
            return Err(refused(Place::File, format!("{points} points"), format!("from 2 to {MOST_POINTS}")));
        }
        let height_option = options.height_unit.or(options.unit);
        let height_unit = unit("heights", height_unit, height_option, options.convention)?;
        let missing = heights_in_metres(&mut heights, height_unit, first_missing, options.missing)?;
        let grid = grid.in_metres(format, lateral_unit, options)?;
        let mut interpolated = Vec::new();
        if missing > 0 {
            let columns = if let Grid::Map { columns, .. } = grid { columns } else { points };
            interpolated = missing::interpolate(&mut heights, columns)?;
        }
        Topography::new(format, heights, grid, interpolated)
    }
}

/// Converts heights to m. Returns the number of missing ones.
///
/// # Errors
/// Missing points if refused, heights out of range.
fn heights_in_metres(
    heights: &mut [f64],
    unit: Unit,
    first_missing: Option<Place>,
    treatment: Missing,
) -> Result<usize, TopographyError> {
    let missing = missing::count(heights);
    if missing > 0 && treatment == Missing::Refuse {
        let first = heights.iter().position(|height| !height.is_finite()).unwrap_or(0);
        let share = 100.0 * missing as f64 / heights.len() as f64;
        return Err(refused(
            first_missing.unwrap_or(Place::Point(first + 1)),
            format!("{missing} of {} points are missing ({share:.2} %), the first here", heights.len()),
            "--interpolate, in a scene roughness.interpolate, which fills them from their neighbours",
        ));
    }
    heights.iter_mut().for_each(|height| *height = unit.to_metres(*height));
    match heights.iter().position(|height| height.abs() > LARGEST && height.is_finite()) {
        Some(index) => Err(refused(
            Place::Point(index + 1),
            format!("a height of {:e} m", heights[index]),
            format!("from -{LARGEST:e} to {LARGEST:e} m"),
        )),
        None => Ok(missing),
    }
}

/// Checks ascending positions, m: they lie within the range if both ends do.
fn check_positions(positions: &[f64]) -> Result<(), TopographyError> {
    if let Some(index) = [0, positions.len() - 1].into_iter().find(|index| positions[*index].abs() > LARGEST)
    {
        let fault = format!("a position of {:e} m", positions[index]);
        return Err(refused(Place::Point(index + 1), fault, format!("from -{LARGEST:e} to {LARGEST:e} m")));
    }
    // Units divide, and neighbours closer than the last digit coincide.
    match positions.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(index) => {
            Err(refused(Place::Point(index + 2), "the position of the point before", "ascending positions"))
        }
        None => Ok(()),
    }
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
