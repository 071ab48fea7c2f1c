//! Reordering of maps, for files that have the heights column by column or begin with the lowest
//! row.

use asperity_data::{OutOfMemory, gathered};

/// Returns the values of a matrix row by row. `values` has them column by column, with
/// `column_length` values in each column.
pub(super) fn transposed(values: &[f64], column_length: usize) -> Result<Vec<f64>, OutOfMemory> {
    let rows =
        (0..column_length).flat_map(|row| values.iter().skip(row).step_by(column_length).copied());
    gathered(values.len(), rows)
}

/// Reverses the order of the rows of a map, for a file that begins with the lowest row.
pub(super) fn reverse_rows(heights: &mut [f64], columns: usize) {
    let rows = heights.len() / columns.max(1);
    for row in 0..rows / 2 {
        let (upper, lower) = heights.split_at_mut((rows - 1 - row) * columns);
        upper[row * columns..(row + 1) * columns].swap_with_slice(&mut lower[..columns]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_reversed_and_columns_stay() {
        for (columns, expected) in [
            (1, [6.0, 5.0, 4.0, 3.0, 2.0, 1.0]),
            (2, [5.0, 6.0, 3.0, 4.0, 1.0, 2.0]),
            (3, [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]),
            (6, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        ] {
            let mut heights = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
            reverse_rows(&mut heights, columns);
            assert_eq!(heights, expected, "{columns}");
        }
    }
}
