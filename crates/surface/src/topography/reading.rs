//! The contents of a file with a surface before its numbers are converted to m.

use super::stated_units::StatedUnits;
use crate::error::Place;
use asperity_data::Note;

/// Contents of a file in the units of the file: heights, positions, and other statements of the
/// file about the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub format: &'static str,
    /// Heights row by row, in the unit that the file uses. The height of a missing point is NaN or
    /// infinite.
    pub heights: Vec<f64>,
    /// Number of points in a row. All points of a profile are one row.
    pub columns: usize,
    /// Ascending positions of the points of a profile; `None` if the points are evenly spaced.
    pub positions: Option<Vec<f64>>,
    /// Distances between evenly spaced points along the rows, and between the rows; `None` if the
    /// file states none.
    pub spacing: Option<[f64; 2]>,
    pub units: StatedUnits,
    /// Place in the file of the first missing point, such as a line. `None` if the reader knows
    /// only the number of this point.
    pub first_missing: Option<Place>,
    /// True if the file states that the surface is periodic at its borders.
    pub periodic: bool,
    /// Messages for the user about something unusual in the file.
    pub warnings: Vec<Note>,
}

impl Reading {
    /// Creates evenly spaced heights in rows of `columns` points. A single row or column is a
    /// profile.
    pub fn even(
        format: &'static str,
        heights: Vec<f64>,
        columns: usize,
        spacing: Option<[f64; 2]>,
        units: StatedUnits,
    ) -> Reading {
        let rows = heights.len() / columns.max(1);
        let mut reading = Reading {
            format,
            heights,
            columns,
            positions: None,
            spacing,
            units,
            first_missing: None,
            periodic: false,
            warnings: Vec::new(),
        };
        if rows == 1 {
            reading.spacing = spacing.map(|[along, _]| [along; 2]);
            reading.units.between = units.along;
        } else if columns == 1 {
            reading.columns = rows;
            reading.spacing = spacing.map(|[_, between]| [between; 2]);
            reading.units.along = units.between;
        }
        reading
    }

    /// Creates a profile from positions and heights. If the positions descend, the order of the
    /// points is reversed.
    pub fn profile(
        format: &'static str,
        mut positions: Vec<f64>,
        mut heights: Vec<f64>,
        units: StatedUnits,
    ) -> Reading {
        if positions.len() > 1 && positions[0] > positions[1] {
            positions.reverse();
            heights.reverse();
        }
        let points = heights.len();
        Reading {
            positions: Some(positions),
            ..Reading::even(format, heights, points, None, units)
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
}
