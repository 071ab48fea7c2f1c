//! Interpolation of missing points from neighbours.

use super::error::{Place, TopographyError, refused};

/// Smallest share of measured points for interpolation.
const LEAST_MEASURED: f64 = 0.5;

pub(super) fn count(heights: &[f64]) -> usize {
    heights.iter().filter(|height| !height.is_finite()).count()
}

/// Interpolates the missing heights of a map with `columns` columns, or of a profile, which is one row. Returns the indices
/// of the interpolated heights.
///
/// A missing height is the mean of two linear interpolations, one along its row and one along its column, each from
/// the nearest measured point before to the nearest one behind. Before the first or behind the last measured point
/// of a row or column the height is constant; a row or column without any measured point does not contribute.
///
/// # Errors
/// Fewer than half of the points are measured, or a point has no measured one in its row or column.
pub(super) fn interpolate(heights: &mut [f64], columns: usize) -> Result<Vec<usize>, TopographyError> {
    let missing = count(heights);
    let share = 1.0 - missing as f64 / heights.len() as f64;
    if share < LEAST_MEASURED {
        let fault = format!("{:.1} % of the points are measured", 100.0 * share);
        return Err(refused(Place::File, fault, format!("at least {:.0} %", 100.0 * LEAST_MEASURED)));
    }
    let rows = heights.len() / columns;
    let mut filled: Vec<(usize, f64)> = Vec::new();
    filled.try_reserve_exact(missing).map_err(|_| TopographyError::OutOfMemory(missing))?;
    for row in 0..rows {
        for_each_gap(heights, row * columns, 1, columns, |index, height| filled.push((index, height)));
    }
    // Heights along rows are in order; those along columns are added to them, or appended.
    let along_rows = filled.len();
    for column in (0..columns).filter(|_| rows > 1) {
        for_each_gap(heights, column, columns, rows, |index, height| {
            match filled[..along_rows].binary_search_by_key(&index, |(index, _)| *index) {
                Ok(place) => filled[place].1 = 0.5 * (filled[place].1 + height),
                Err(_) => filled.push((index, height)),
            }
        });
    }
    filled.iter().for_each(|(index, height)| heights[*index] = *height);
    match heights.iter().position(|height| !height.is_finite()) {
        Some(index) => Err(refused(
            Place::Point(index + 1),
            "missing like all points of its row and its column",
            "a measured point in the row or the column",
        )),
        None => Ok(filled.into_iter().map(|(index, _)| index).collect()),
    }
}

/// Calls `fill` with the index and the interpolated height of each missing one of `count` heights, `step` indices apart.
fn for_each_gap(heights: &[f64], first: usize, step: usize, count: usize, mut fill: impl FnMut(usize, f64)) {
    let at = |place: usize| heights[first + place * step];
    let mut before = None;
    let mut place = 0;
    while place < count {
        let end = (place..count).find(|place| at(*place).is_finite());
        for gap in place..end.unwrap_or(count) {
            let height = match (before, end) {
                (Some(from), Some(to)) => {
                    at(from) + (gap - from) as f64 / (to - from) as f64 * (at(to) - at(from))
                }
                (Some(near), None) | (None, Some(near)) => at(near),
                (None, None) => continue,
            };
            fill(first + gap * step, height);
        }
        before = end;
        place = end.map_or(count, |end| end + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: f64 = f64::NAN;

    #[test]
    fn gaps_of_a_profile_are_straight_and_its_ends_level() {
        let mut heights = [NONE, 1.0, NONE, NONE, 4.0, 6.0, 7.0, NONE];
        assert!(interpolate(&mut heights, 8).is_ok());
        assert_eq!(heights, [1.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 7.0]);
    }

    #[test]
    fn a_point_of_a_map_is_the_mean_of_row_and_column() {
        let mut heights = [0.0, 1.0, 2.0, 3.0, NONE, 7.0, 6.0, 9.0, 8.0];
        assert!(interpolate(&mut heights, 3).is_ok());
        assert_eq!(heights[4], 0.5 * (5.0 + 5.0));
        // A row without any measured point is interpolated from its columns.
        let mut heights = [0.0, 1.0, NONE, NONE, 4.0, 5.0];
        assert!(interpolate(&mut heights, 2).is_ok());
        assert_eq!(heights, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn too_few_points_are_refused() {
        let mut few = [NONE, NONE, 1.0];
        assert!(interpolate(&mut few, 3).unwrap_err().to_string().contains("allowed: at least 50 %"));
        let mut cross = [NONE, NONE, NONE, 1.0, NONE, 2.0, 3.0, 4.0, NONE, 6.0, 7.0, 8.0];
        cross[1] = NONE;
        assert!(interpolate(&mut cross, 3).is_ok());
        let mut corner = [NONE, NONE, NONE, 1.0, NONE, 3.0];
        // The middle column and the upper row are empty.
        assert!(interpolate(&mut corner, 3).unwrap_err().to_string().contains("33.3 % of the points"));
    }
}
