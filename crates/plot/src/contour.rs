//! Lines on which a field on a grid has a given value, by marching squares.

/// Point in coordinates of the grid.
type Point = (f64, f64);

/// Returns straight pieces of the line on which a field has the value `level`. The field is
/// interpolated linearly along the edges of the grid, and pieces meet at their ends. A square with
/// a missing corner has no piece. In a square that the line crosses twice, the mean of the corners
/// decides how the crossings are connected.
pub(super) fn contour(
    across: &[f64],
    up: &[f64],
    field: &[Option<f64>],
    level: f64,
) -> Vec<[Point; 2]> {
    let mut pieces = Vec::new();
    for row in 1..up.len() {
        for column in 1..across.len() {
            let corner = |dx: usize, dy: usize| {
                let (column, row) = (column - 1 + dx, row - 1 + dy);
                let value = *field.get(row * across.len() + column)?;
                Some((across[column], up[row], value? - level))
            };
            // Around the square, so that neighbours share an edge.
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(dx, dy)| corner(dx, dy));
            let [Some(a), Some(b), Some(c), Some(d)] = corners else {
                continue;
            };
            let square = [a, b, c, d];
            let cuts: Vec<(usize, Point)> = (0..4)
                .filter_map(|edge| Some((edge, cut(square[edge], square[(edge + 1) % 4])?)))
                .collect();
            match cuts.as_slice() {
                [(_, from), (_, to)] => pieces.push([*from, *to]),
                [(_, south), (_, east), (_, north), (_, west)] => {
                    let middle = square.iter().map(|corner| corner.2).sum::<f64>();
                    // The corners on the side of the mean are connected.
                    if (middle < 0.0) == (square[0].2 < 0.0) {
                        pieces.extend([[*south, *east], [*north, *west]]);
                    } else {
                        pieces.extend([[*west, *south], [*east, *north]]);
                    }
                }
                _ => {}
            }
        }
    }
    pieces
}

fn cut(from: (f64, f64, f64), to: (f64, f64, f64)) -> Option<Point> {
    ((from.2 < 0.0) != (to.2 < 0.0)).then(|| {
        // Always from the lower corner, so that two squares compute the same point to the last bit.
        let (low, high) = if from.2 < to.2 {
            (from, to)
        } else {
            (to, from)
        };
        let share = low.2 / (low.2 - high.2);
        (
            low.0 + (high.0 - low.0) * share,
            low.1 + (high.1 - low.1) * share,
        )
    })
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
        // From border to border.
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
        // A corner of squares crossed by the line.
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
            // High corners are connected where the middle is high: each line cuts off a low one.
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
