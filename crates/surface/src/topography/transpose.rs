//! Maps whose heights are column by column.

use asperity_data::{OutOfMemory, gathered};

/// Returns the values row by row of a matrix that is given column by column, in columns of this
/// many values.
pub(super) fn transposed(values: &[f64], column_length: usize) -> Result<Vec<f64>, OutOfMemory> {
    let rows =
        (0..column_length).flat_map(|row| values.iter().skip(row).step_by(column_length).copied());
    gathered(values.len(), rows)
}
