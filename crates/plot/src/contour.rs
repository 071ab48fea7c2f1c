//! Lines along which a field on a grid has a given value. They are computed by marching squares.

/// Point in coordinates of the grid.
type Point = (f64, f64);

/// Corner of a grid square.
#[derive(Clone, Copy)]
struct Corner {
    x: f64,
    y: f64,
    /// Value of the field minus the value that it has along the line.
    excess: f64,
}

impl Corner {
    fn is_low(self) -> bool {
        self.excess < 0.0
    }
}

/// Returns the line along which a field has the value `level`, as straight pieces that meet at
/// their ends. `field` has a value for each grid point, row by row. Along the edges of the grid,
/// the field is interpolated linearly. A grid square with a missing corner has no piece. If the
/// line crosses a square twice, the mean of the four corners decides how the crossings are
/// connected.
pub(super) fn contour(
    across: &[f64],
    up: &[f64],
    field: &[Option<f64>],
    level: f64,
) -> Vec<[Point; 2]> {
    let mut pieces = Vec::new();
    for row in 1..up.len() {
        for column in 1..across.len() {
            let corner = |column: usize, row: usize| {
                let value = *field.get(row * across.len() + column)?;
                Some(Corner {
                    x: across[column],
                    y: up[row],
                    excess: value? - level,
                })
            };
            // The corners are ordered around the square, so that two successive corners are the
            // ends of an edge.
            let corners = [
                corner(column - 1, row - 1),
                corner(column, row - 1),
                corner(column, row),
                corner(column - 1, row),
            ];
            if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                add_pieces(&mut pieces, [a, b, c, d]);
            }
        }
    }
    pieces
}

/// Adds the pieces of the line inside a grid square to `pieces`.
fn add_pieces(pieces: &mut Vec<[Point; 2]>, square: [Corner; 4]) {
    let [a, b, c, d] = square;
    let cuts: Vec<Point> = [cut(a, b), cut(b, c), cut(c, d), cut(d, a)]
        .into_iter()
        .flatten()
        .collect();
    match cuts[..] {
        [from, to] => pieces.push([from, to]),
        [south, east, north, west] => {
            let sum = square.iter().map(|corner| corner.excess).sum::<f64>();
            // The line crosses all four edges. The two corners on the same side of the level as the
            // mean of the corners are connected, and the line cuts off the other two corners.
            if (sum < 0.0) == a.is_low() {
                pieces.extend([[south, east], [north, west]]);
            } else {
                pieces.extend([[west, south], [east, north]]);
            }
        }
        _ => {}
    }
}

/// Returns the point at which the line crosses the edge between two corners; `None` if it does not
/// cross this edge.
fn cut(from: Corner, to: Corner) -> Option<Point> {
    if from.is_low() == to.is_low() {
        return None;
    }
    // The interpolation starts at the lower corner, so that the two squares that share the edge
    // compute the same point to the last bit.
    let (low, high) = if from.excess < to.excess {
        (from, to)
    } else {
        (to, from)
    };
    let share = low.excess / (low.excess - high.excess);
    let x = low.x + (high.x - low.x) * share;
    let y = low.y + (high.y - low.y) * share;
    Some((x, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loose(pieces: &[[Point; 2]]) -> Vec<Point> {
        let ends = pieces.concat();
        let alone = |end: &Point| ends.iter().filter(|other| *other == end).count() == 1;
        ends.iter().copied().filter(alone).collect()
    }

    #[test]
    fn a_plane_is_cut_along_a_straight_line() {
        let (across, up) = ([0.0, 1.0, 3.0, 4.0], [0.0, 2.0, 5.0]);
        let plane: Vec<_> = up
            .iter()
            .flat_map(|y| across.map(|x| Some(x + y - 2.5)))
            .collect();
        let pieces = contour(&across, &up, &plane, 0.0);
        for (x, y) in pieces.concat() {
            assert!((x + y - 2.5).abs() < 1e-12, "{x} {y}");
        }
        // The line runs from one border of the grid to another.
        let mut ends = loose(&pieces);
        ends.sort_by(|one, other| one.0.total_cmp(&other.0));
        assert_eq!(ends, [(0.0, 2.5), (2.5, 0.0)]);
    }

    #[test]
    fn a_hill_has_a_closed_line_and_a_gap_opens_it() {
        let places: Vec<f64> = (0..9).map(|index| f64::from(index) - 4.0).collect();
        let mut hill: Vec<_> = places
            .iter()
            .flat_map(|y| places.iter().map(move |x| Some(9.0 - x * x - y * y)))
            .collect();
        let pieces = contour(&places, &places, &hill, 2.0);
        assert!(pieces.len() > 8 && loose(&pieces).is_empty(), "{pieces:?}");
        assert!(
            pieces
                .concat()
                .iter()
                .all(|(x, y)| (x.hypot(*y) - 7.0_f64.sqrt()).abs() < 0.15)
        );
        // The line crosses squares that have the missing point as a corner, so that the line is
        // open there.
        hill[4 * 9 + 6] = None;
        assert_eq!(loose(&contour(&places, &places, &hill, 2.0)).len(), 2);
    }

    #[test]
    fn a_saddle_is_cut_as_its_middle_says() {
        let saddle = |other: f64| [Some(1.0), Some(-1.0), Some(-1.0), Some(other)];
        for (other, expected) in [(2.0, (0.5, 0.0)), (0.5, (0.5, 0.0))] {
            let lines = contour(&[0.0, 1.0], &[0.0, 1.0], &saddle(other), 0.0);
            assert_eq!(lines.len(), 2);
            let line = lines.iter().find(|line| line.contains(&expected)).unwrap();
            // If the middle of the square is high, the two high corners are connected. The pieces
            // of the line then cut off the low corners.
            let cuts_low = line.iter().any(|point| point.0 == 1.0);
            assert_eq!(cuts_low, other > 1.0, "{lines:?}");
        }
    }

    #[test]
    fn a_level_that_is_not_there_has_no_line() {
        assert_eq!(
            contour(&[0.0, 1.0], &[0.0, 1.0], &[Some(1.0); 4], 2.0),
            [[(0.0, 0.0); 2]; 0]
        );
        assert_eq!(
            contour(&[0.0], &[0.0, 1.0], &[Some(1.0); 2], 1.0),
            [[(0.0, 0.0); 2]; 0]
        );
    }
}
