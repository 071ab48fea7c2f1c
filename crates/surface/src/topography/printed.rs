//! Even grids whose positions are printed with few digits.

use super::positions::first_uneven;
use crate::error::SurfaceError;
use asperity_data::gathered;

/// Smallest number of positions that are moved onto an even grid. Fewer positions may be uneven on
/// purpose.
const LEAST_PRINTED: usize = 32;

/// Largest relative difference between the spacing of the points and the last printed digit with
/// which the positions are left unchanged. A missing point would then look like a rounded distance.
const LIKE_DIGIT: f64 = 0.1;

/// Largest number of steps in which the search for an even grid narrows the range of possible
/// spacings.
const MOST_CUTS: usize = 64;

/// Largest magnitude of the exponent of a printed number that is taken into account for its digits.
const LARGEST_EXPONENT: i32 = 400;

/// Digits with which the numbers of a column are printed: the largest number of decimals, and the
/// largest number of significant digits.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Digits {
    decimals: i32,
    significant: i32,
}

impl Digits {
    pub const EXACT: Digits = Digits {
        decimals: 400,
        significant: 15,
    };

    /// Creates a value for numbers with at most this many decimals and this many significant
    /// digits.
    #[cfg(test)]
    pub fn at_most(decimals: i32, significant: i32) -> Digits {
        Digits {
            decimals,
            significant,
        }
    }

    /// Updates the numbers of digits by one more printed number `cell`, which may have more digits
    /// than the earlier numbers.
    pub fn take(&mut self, cell: &str) {
        let mut decimals = 0;
        let mut significant = 0;
        let mut is_after_mark = false;
        for (index, byte) in cell.bytes().enumerate() {
            match byte {
                b'0'..=b'9' => {
                    decimals += i32::from(is_after_mark);
                    significant += i32::from(byte != b'0' || significant > 0);
                }
                // The last point or comma in a number is the decimal mark. Any earlier ones
                // separate thousands.
                b'.' | b',' => {
                    is_after_mark = true;
                    decimals = 0;
                }
                b'e' | b'E' => {
                    if let Ok(exponent) = cell[index + 1..].parse::<i32>() {
                        decimals -= exponent.clamp(-LARGEST_EXPONENT, LARGEST_EXPONENT);
                    }
                    break;
                }
                _ => {}
            }
        }
        self.decimals = self.decimals.max(decimals);
        self.significant = self.significant.max(significant);
    }

    /// Returns the largest error of the number `value` that results from its rounding to these
    /// digits. The error is half a unit of the last digit, plus some rounding errors of
    /// floating-point numbers.
    pub fn half(self, value: f64) -> f64 {
        let digits_before_mark = if value == 0.0 {
            i32::MIN / 2
        } else {
            value.abs().log10().floor() as i32 + 1
        };
        let digit = (digits_before_mark - self.significant).max(-self.decimals);
        0.500_001 * 10.0_f64.powi(digit)
    }
}

/// A point of a grid: its number along the axis, counted from 0, and its printed position.
#[derive(Clone, Copy)]
pub(super) struct GridPoint {
    pub number: f64,
    pub position: f64,
}

/// First position and spacing of an even grid.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub first: f64,
    pub distance: f64,
}

/// A bound (lower or upper) for the first position of a grid with a given spacing.
struct Bound {
    first: f64,
    /// Number of the point that gives the bound.
    number: f64,
    /// Smallest or largest exact position that this point can have, from its printed digits.
    position: f64,
}

impl Bound {
    /// Creates a bound that no point has given yet.
    fn unknown(first: f64) -> Self {
        Bound {
            first,
            number: 0.0,
            position: 0.0,
        }
    }
}

/// Smallest and largest first position with which a grid of a given spacing agrees with all points.
struct Bounds {
    lower: Bound,
    upper: Bound,
}

impl Bounds {
    /// Computes the bounds that the printed digits of all points set for the first position of a
    /// grid with the spacing `distance`.
    fn new(points: &[GridPoint], digits: Digits, distance: f64) -> Self {
        let mut bounds = Bounds {
            lower: Bound::unknown(f64::NEG_INFINITY),
            upper: Bound::unknown(f64::INFINITY),
        };
        for point in points {
            let half = digits.half(point.position);
            let before = point.number * distance;
            let low = point.position - half;
            let high = point.position + half;
            if low - before > bounds.lower.first {
                bounds.lower = Bound {
                    first: low - before,
                    number: point.number,
                    position: low,
                };
            }
            if high - before < bounds.upper.first {
                bounds.upper = Bound {
                    first: high - before,
                    number: point.number,
                    position: high,
                };
            }
        }
        bounds
    }
}

/// Returns an even grid that agrees with the positions of all points to within half a unit of the
/// last printed digit. Returns `None` if there is no such grid. The points must be in the order of
/// their numbers.
pub(super) fn printed_grid(points: &[GridPoint], digits: Digits) -> Option<Grid> {
    let [first, .., last] = points else {
        return None;
    };
    if points.len() < LEAST_PRINTED {
        return None;
    }
    let half_first = digits.half(first.position);
    let half_last = digits.half(last.position);
    let mean = (last.position - first.position) / last.number;
    let digit = 2.0 * half_first.max(half_last);
    if (mean.abs() / digit - 1.0).abs() < LIKE_DIGIT {
        return None;
    }

    let reach = (half_first + half_last) / last.number;
    let mut low = mean - reach;
    let mut high = mean + reach;
    for _ in 0..MOST_CUTS {
        let distance = f64::midpoint(low, high);
        let Bounds { lower, upper } = Bounds::new(points, digits, distance);
        if lower.first <= upper.first {
            return Some(Grid {
                first: f64::midpoint(lower.first, upper.first),
                distance,
            });
        }
        // The tried distance is too small or too large for the two points that give the bounds.
        // These two points give a new limit for it.
        let bound = (lower.position - upper.position) / (lower.number - upper.number);
        if lower.number > upper.number {
            low = low.max(bound);
        } else {
            high = high.min(bound);
        }
        if low > high {
            return None;
        }
    }
    None
}

/// Moves positions onto an even grid if each position changes by no more than its last printed
/// digit allows. Otherwise the positions remain unchanged.
pub(super) fn move_to_printed_grid(
    positions: &mut [f64],
    digits: Digits,
) -> Result<(), SurfaceError> {
    let [first, .., last] = *positions else {
        return Ok(());
    };
    let distance = (last - first) / (positions.len() - 1) as f64;
    if distance == 0.0 || first_uneven(positions, first, distance).is_none() {
        return Ok(());
    }
    let points = (0..positions.len()).map(|index| GridPoint {
        number: index as f64,
        position: positions[index],
    });
    let points = gathered(positions.len(), points)?;
    if let Some(grid) = printed_grid(&points, digits) {
        for (number, position) in positions.iter_mut().enumerate() {
            *position = grid.first + number as f64 * grid.distance;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(cells: &[&str]) -> Digits {
        let mut digits = Digits::default();
        cells.iter().for_each(|cell| digits.take(cell));
        digits
    }

    #[test]
    fn the_last_printed_digit_is_that_of_decimals_or_of_significant_digits() {
        for (cells, value, half) in [
            (&["0.00", "13.33"][..], 13.33, 0.005),
            (&["0.00", "13.33"], 0.33, 0.005),
            (&["0", "0.5", "10.5"], 10.0, 0.05),
            (&["0.333", "12.3"], 12.3, 0.05),
            (&["0.333", "12.3"], 0.333, 0.0005),
            (&["1.338e+01", "9.5e0"], 13.38, 0.005),
            (&["-0,33"], -0.33, 0.005),
            (&["10", "20"], 10.0, 0.5),
        ] {
            assert!(
                (digits(cells).half(value) / half - 1.0).abs() < 1e-5,
                "{cells:?}"
            );
        }
    }

    #[test]
    fn positions_rounded_in_print_are_even() {
        let printed = |position: &dyn Fn(u32) -> f64, decimals: usize| {
            let cells: Vec<String> = (0..200)
                .map(|i| format!("{:.decimals$}", position(i)))
                .collect();
            let digits = digits(&cells.iter().map(String::as_str).collect::<Vec<_>>());
            (
                cells
                    .iter()
                    .map(|cell| cell.parse().unwrap())
                    .collect::<Vec<f64>>(),
                digits,
            )
        };
        for (first, distance, decimals) in [
            (0.0, 0.156, 1),
            (-3.0, 1.0 / 3.0, 2),
            (100.0, -0.0333, 2),
            (0.0, 0.07, 1),
        ] {
            let (mut positions, digits) = printed(&|i| first + distance * f64::from(i), decimals);
            let before = positions.clone();
            move_to_printed_grid(&mut positions, digits).unwrap();
            let step = (positions[199] - positions[0]) / 199.0;
            assert!((step / distance - 1.0).abs() < 0.01, "{step}");
            assert_eq!(first_uneven(&positions, positions[0], step), None);
            let half = 0.5000001 * 10_f64.powi(-(decimals as i32));
            assert!(
                positions
                    .iter()
                    .zip(&before)
                    .all(|(one, other)| (one - other).abs() <= half)
            );
        }
        // Positions remain unchanged if there are few of them or if they are really uneven.
        let (before, digits) = printed(&|i| f64::from(i) + f64::from(i * i % 7) * 0.03, 2);
        let mut positions = before.clone();
        move_to_printed_grid(&mut positions, digits).unwrap();
        assert_eq!(positions, before);
        // If a point is missing, the positions remain unchanged.
        let (before, digits) = printed(&|i| f64::from(i + u32::from(i > 70)), 0);
        let mut positions = before.clone();
        move_to_printed_grid(&mut positions, digits).unwrap();
        assert_eq!(positions, before);
        let mut few = [0.0, 1.0, 3.0, 4.0, 6.0];
        move_to_printed_grid(&mut few, Digits::default()).unwrap();
        assert_eq!(few, [0.0, 1.0, 3.0, 4.0, 6.0]);
    }
}
