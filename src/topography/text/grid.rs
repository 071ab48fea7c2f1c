//! Full grids from lists of points x y z.

use super::super::UNEVEN;
use super::super::error::{Place, TopographyError, refused};

/// Returns the number of columns and the distances along and between rows of points listed row by row, along x or y.
/// Each point lies on an even grid within 0.1 % of the distance between points.
pub(super) fn from_points([x, y]: &[Vec<f64>; 2]) -> Result<(usize, [f64; 2]), TopographyError> {
    let points = x.len();
    if points < 2 {
        return Err(refused(Place::File, format!("{points} points"), "at least 2"));
    }
    // The position that changes from the first point to the second is along the rows.
    let (along, between) = match (x[1] != x[0], y[1] != y[0]) {
        (true, false) => (x, y),
        (false, true) => (y, x),
        (same, _) => {
            let fault = if same { "x and y both differ from" } else { "x and y both equal" };
            let fault = format!("{fault} those of the point before");
            return Err(refused(Place::Point(2), fault, "points of a full grid, row by row"));
        }
    };
    let columns = between.iter().position(|position| *position != between[0]).unwrap_or(points);
    if !points.is_multiple_of(columns) {
        let fault = format!("{points} points in rows of {columns}");
        return Err(refused(Place::Point(points), fault, "full rows"));
    }
    let rows = points / columns;
    if columns < 2 {
        return Err(refused(Place::Point(2), "a row of 1 point", "rows of at least 2 points"));
    }
    let step = (along[columns - 1] - along[0]) / (columns - 1) as f64;
    let row_step = if rows > 1 { (between[points - 1] - between[0]) / (rows - 1) as f64 } else { step };
    for (index, (u, v)) in along.iter().zip(between).enumerate() {
        let off_row = (u - along[0] - (index % columns) as f64 * step).abs() / step.abs();
        let off_column = (v - between[0] - (index / columns) as f64 * row_step).abs() / row_step.abs();
        if off_row.is_nan() || off_column.is_nan() || off_row.max(off_column) > UNEVEN {
            return Err(refused(
                Place::Point(index + 1),
                format!("({:e}, {:e}) is off the even grid", x[index], y[index]),
                format!("points of a full grid, row by row, within {UNEVEN} of their distance"),
            ));
        }
    }
    Ok((columns, [step.abs(), row_step.abs()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(points: &[(f64, f64)]) -> Result<(usize, [f64; 2]), String> {
        let (x, y) = points.iter().copied().unzip();
        from_points(&[x, y]).map_err(|error| error.to_string())
    }

    #[test]
    fn rows_may_run_along_either_axis_and_in_either_direction() {
        let along_x = [(3.0, 0.0), (2.0, 0.0), (1.0, 0.0), (3.0, 5.0), (2.0, 5.0), (1.0, 5.0)];
        let expected = (3, [1.0, 5.0]);
        assert_eq!(grid(&along_x), Ok(expected));
        assert_eq!(grid(&along_x.map(|(x, y)| (y, x))), Ok(expected));
        assert_eq!(grid(&[(0.0, 1.0), (0.0, 3.0), (0.0, 5.0)]), Ok((3, [2.0; 2])));
    }

    #[test]
    fn points_off_the_grid_are_named() {
        for (points, place) in [
            (&[(0.0, 0.0), (1.0, 1.0)][..], "point 2: x and y both differ"),
            (&[(0.0, 0.0), (0.0, 0.0)], "point 2: x and y both equal"),
            (&[(0.0, 0.0), (1.0, 0.0), (2.5, 0.0), (3.0, 0.0)], "point 3: (2.5e0, 0e0) is off"),
            (&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], "point 3: 3 points in rows of 2"),
            (&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.1, 1.0)], "point 4: (1.1e0, 1e0) is off"),
        ] {
            let error = grid(points).unwrap_err();
            assert!(error.starts_with(place), "{points:?}: {error}");
        }
    }
}
