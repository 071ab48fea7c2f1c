//! A row or a column of a map, read as a profile.

use super::surface::{Cropped, Layout, Topography};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;

/// A row or a column of a map that is read as a profile. Rows and columns of the file are counted
/// from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The row with this number.
    Row(u64),
    /// The column with this number.
    Column(u64),
}

/// The points of a row or of a column, given by their indices among the points of the map.
struct CutLine {
    /// Index, among the points of the map, of the first point of the line.
    first: usize,
    /// Difference between the indices of neighbouring points.
    step: usize,
    points: usize,
    /// Axis along which the line lies: 0 for a row, 1 for a column.
    axis: usize,
}

impl CutLine {
    /// Finds the points of a row or a column. Returns an error if the map has no such row or
    /// column.
    fn new(map: &Topography, cut: Cut) -> Result<Self, SurfaceError> {
        let columns = map.columns;
        let rows = map.rows();
        // The number of a row or a column is that in the file, so it also counts rows or columns
        // that were cropped.
        let [columns_before, rows_before] = map.cropped.before;
        Ok(match cut {
            Cut::Row(number) => CutLine {
                first: columns * remaining_index("row", number, rows_before, rows)?,
                step: 1,
                points: columns,
                axis: 0,
            },
            Cut::Column(number) => CutLine {
                first: remaining_index("column", number, columns_before, columns)?,
                step: columns,
                points: rows,
                axis: 1,
            },
        })
    }

    /// Returns the number, counted from 0, of a point along the line. `index` is its index in the
    /// map. Returns `None` if the point is not on the line.
    fn number_of(&self, index: usize) -> Option<usize> {
        let offset = index.checked_sub(self.first)?;
        let number = offset / self.step;
        let is_on_line = offset % self.step == 0 && number < self.points;
        is_on_line.then_some(number)
    }
}

/// Returns the index, counted from 0, of a row or column among the `count` that remain after
/// cropping. `number` is its number in the file, counted from 1. `before` is the number of rows or
/// columns that were cropped before the first remaining one.
fn remaining_index(
    name: &str,
    number: u64,
    before: usize,
    count: usize,
) -> Result<usize, SurfaceError> {
    let number_in_file = usize::try_from(number).ok();
    let index = number_in_file.and_then(|number| number.checked_sub(1 + before));
    match index {
        Some(index) if index < count => Ok(index),
        _ => {
            let found = format!("{name} {number}");
            let allowed = format!("{name}s {} to {}", before + 1, before + count);
            Err(refused(Place::File, found, allowed))
        }
    }
}

impl Topography {
    /// Returns a row or a column of this map as a profile.
    pub(super) fn cut(self, cut: Cut) -> Result<Self, SurfaceError> {
        let spacing = match &self.layout {
            Layout::Even(spacing) if self.rows() > 1 => *spacing,
            _ => {
                let found = "a profile, which has no rows and columns";
                return Err(refused(Place::File, found, "a map"));
            }
        };
        let line = CutLine::new(&self, cut)?;
        let heights = self.heights.iter().skip(line.first).step_by(line.step);
        let heights = gathered(line.points, heights.take(line.points).copied())?;
        let interpolated = self.interpolated.iter();
        let interpolated = interpolated.filter_map(|index| line.number_of(*index));
        let cropped = Cropped {
            before: [self.cropped.before[line.axis], 0],
            after: [self.cropped.after[line.axis], 0],
        };
        Ok(Topography {
            heights,
            columns: line.points,
            layout: Layout::Even([spacing[line.axis]; 2]),
            cropped,
            aligned: false,
            interpolated: interpolated.collect(),
            ..self
        })
    }
}
