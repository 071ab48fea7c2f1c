//! Time of a comparison with squares in three dimensions, estimated from small squares before it begins.

use super::error::StudyError;
use super::spatial::Body;
use asperity_data::format_rounded;
use std::time::Instant;

/// Smallest number of cells along the side of a square, and of the coarser square that is compared with it.
pub const LEAST_CELLS: usize = 32;
/// Smallest time in s of a square from which the time of larger squares follows.
const LEAST_TIMED: f64 = 0.2;
/// Factor of the time of a square with twice the cells along its side, without and with adhesion.
const GROWTH: [f64; 2] = [6.5, 8.5];
/// Longest time of a comparison in s, which is a day.
pub const LONGEST: f64 = 86_400.0;

/// Estimates the time of a square in s from smaller squares, each with twice the cells of the one before.
pub fn seconds_of_square(
    body: &Body,
    (cells, seed): (usize, u64),
    loads: (&[f64], f64),
    stop: &dyn Fn() -> bool,
) -> Result<f64, StudyError> {
    let growth = GROWTH[usize::from(body.works.is_some())];
    let mut smaller = LEAST_CELLS;
    loop {
        let begun = Instant::now();
        body.load((smaller, seed), loads, stop)?;
        let seconds = begun.elapsed().as_secs_f64();
        if 2 * smaller >= cells || seconds > LEAST_TIMED {
            return Ok(seconds * growth.powi((cells / smaller).ilog2() as i32) * (1.0 + growth.recip()));
        }
        smaller *= 2;
    }
}

/// Refuses a comparison of `maps` squares of `cells` cells along the side if it takes longer than a day, in which there is time
/// for `most` squares.
pub fn check_time(
    (cells, maps): (usize, u64),
    seconds: f64,
    most: f64,
    is_adhesive: bool,
) -> Result<(), StudyError> {
    if seconds <= LONGEST {
        return Ok(());
    }
    let halvings = (seconds / LONGEST).log(GROWTH[usize::from(is_adhesive)]).ceil();
    let grid = (cells >> (halvings as u32).min(usize::BITS - 1)).max(LEAST_CELLS);
    let squares = if most >= 1.0 { format!(", or at most {} squares", most as u64) } else { String::new() };
    let days = format_rounded(seconds / LONGEST, 2, "1");
    let squares_found = if maps == 1 { "square takes" } else { "squares take" };
    let found = format!("{maps} {squares_found} about {days} days, longer than one day");
    let allowed = format!("a grid of at most {grid} cells along the side{squares}");
    Err(StudyError::refused(Some(&format!("{cells} cells")), found, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_longer_than_a_day_is_refused() {
        let refused = |seconds, most| check_time((1024, 24), seconds, most, false).unwrap_err().to_string();
        assert!(check_time((1024, 24), LONGEST, 24.0, false).is_ok());
        assert_eq!(
            refused(3.0 * LONGEST, 8.5),
            "1024 cells: 24 squares take about 3 days, longer than one day; allowed: a grid of at most 512 cells \
             along the side, or at most 8 squares"
        );
        assert!(
            refused(50.0 * LONGEST, 0.4).ends_with("allowed: a grid of at most 128 cells along the side")
        );
        let never = check_time((8192, 1), 1e300, 0.0, true).unwrap_err().to_string();
        assert!(never.contains("at most 32 cells"), "{never}");
    }
}
