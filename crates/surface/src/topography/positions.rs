//! Positions of points: whether they lie on an even grid, and interpolation between them.

use asperity_data::between;

/// Largest allowed absolute value of a position in m, of a height in m, and of a slope between
/// neighbouring points. Larger values could make lengths and mean squares overflow.
pub(super) const LARGEST: f64 = 1.0e9;

/// Largest displacement of a point from an even grid that still counts as rounding, as a share of
/// the spacing of the grid.
pub(crate) const UNEVEN: f64 = 1.0e-3;

/// Returns the index of the first position that does not lie on an even grid; `None` if all
/// positions lie on the grid. The grid begins at the position `first` in m and has the spacing
/// `distance` in m.
pub(crate) fn first_uneven(positions: &[f64], first: f64, distance: f64) -> Option<usize> {
    let most = UNEVEN * distance.abs();
    let is_even = |index: usize, position: f64| {
        let off = position - first - index as f64 * distance;
        off.abs() <= most
    };
    (0..positions.len()).find(|index| !is_even(*index, positions[*index]))
}

/// Returns the mean distance in m between neighbours among at least two positions in m.
pub(super) fn mean_distance(positions: &[f64]) -> f64 {
    (positions[positions.len() - 1] - positions[0]) / (positions.len() - 1) as f64
}

/// Returns the heights in m at the positions `places` in m (ascending), minus `level` in m. The
/// heights are interpolated linearly between at least two points. Exactly at a point, the result is
/// exactly the height of the point. Before the first point and after the last point, the height
/// remains constant.
pub(crate) fn interpolated(
    positions: &[f64],
    heights: &[f64],
    level: f64,
    places: impl Iterator<Item = f64>,
) -> impl Iterator<Item = f64> {
    let mut piece = 0;
    places.map(move |x| {
        while piece + 2 < positions.len() && positions[piece + 1] < x {
            piece += 1;
        }
        let before = positions[piece];
        let after = positions[piece + 1];
        let height_before = heights[piece] - level;
        let height_after = heights[piece + 1] - level;
        if x <= before {
            height_before
        } else if x >= after {
            height_after
        } else {
            let share = (x - before) / (after - before);
            between(height_before, height_after, share)
        }
    })
}
