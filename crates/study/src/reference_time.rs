//! Computing time of a comparison with square surfaces in three dimensions. It is estimated from
//! surfaces with few grid cells before the comparison begins.

use super::error::StudyError;
use super::spatial::{Body, SquareLoading, Watch};
use asperity_data::format_rounded;
use std::time::Instant;

/// Smallest number of grid cells along the side of a square surface. It also limits the coarser
/// grid that shows the error of the grid.
pub const LEAST_CELLS: usize = 32;
/// Smallest computing time in s of a square surface with few cells from which the time of surfaces
/// with more cells is estimated.
const LEAST_TIMED: f64 = 0.2;
/// Factor by which the computing time of a square surface grows if the number of cells along its
/// side doubles: first without adhesion, then with adhesion.
const GROWTH: [f64; 2] = [6.5, 8.5];
/// Longest allowed computing time of a comparison in s, one day.
pub const LONGEST: f64 = 86_400.0;

/// Computing time of a square surface, estimated from the same surface with fewer grid cells. The
/// number of cells along the side is doubled until the computation takes long enough for an
/// estimate.
#[derive(Clone, Copy, Debug)]
pub struct SquareTime {
    /// Computing time in s of a square surface, including the computation on a grid with half as
    /// many cells along the side.
    pub seconds: f64,
    /// Number of loads (forces or indentations) at which a square surface is computed.
    pub loads: u64,
    pub is_adhesive: bool,
}

impl SquareTime {
    /// Estimates the computing time of a square surface with `cells` grid cells along its side.
    ///
    /// # Errors
    /// Returns an error if the surface cannot be computed, or if `stop` returned true.
    pub fn estimate(
        body: &Body,
        cells: usize,
        seed: u64,
        loading: &SquareLoading,
        stop: &dyn Fn() -> bool,
    ) -> Result<SquareTime, StudyError> {
        let is_adhesive = body.works.is_some();
        let growth = GROWTH[usize::from(is_adhesive)];
        let mut smaller = LEAST_CELLS;
        loop {
            let begun = Instant::now();
            let loads = body
                .load(
                    smaller,
                    seed,
                    loading,
                    Watch {
                        stop,
                        loaded: &|| (),
                    },
                )?
                .count;
            let seconds = begun.elapsed().as_secs_f64();
            if 2 * smaller >= cells || seconds > LEAST_TIMED {
                let of_finest = seconds * growth.powi((cells / smaller).ilog2() as i32);
                return Ok(SquareTime {
                    seconds: of_finest * (1.0 + growth.recip()),
                    loads,
                    is_adhesive,
                });
            }
            smaller *= 2;
        }
    }

    /// Returns the computing time in s of `surfaces` square surfaces on `threads` threads.
    pub fn of_squares(&self, surfaces: u64, threads: usize) -> f64 {
        self.seconds * surfaces.div_ceil(threads as u64) as f64
    }

    /// Returns the share of one load (a force or an indentation) of one square surface in the whole
    /// computation of `surfaces` square surfaces.
    pub fn share_of_load(&self, surfaces: u64) -> f64 {
        1.0 / (self.loads.max(1) as f64 * surfaces as f64)
    }
}

/// Returns an error if the comparison takes longer than a day. The comparison has `surfaces` square
/// surfaces with `cells` grid cells along the side, and is computed on `threads` threads. `time` is
/// the estimated computing time of one of them.
pub fn check_time(
    cells: usize,
    surfaces: u64,
    threads: usize,
    time: &SquareTime,
) -> Result<(), StudyError> {
    let seconds = time.of_squares(surfaces, threads);
    if seconds <= LONGEST {
        return Ok(());
    }
    let most = threads as f64 * LONGEST / time.seconds;
    let halvings = (seconds / LONGEST)
        .log(GROWTH[usize::from(time.is_adhesive)])
        .ceil();
    let grid = (cells >> (halvings as u32).min(usize::BITS - 1)).max(LEAST_CELLS);
    let squares = if most >= 1.0 {
        format!(", or at most {} squares", most as u64)
    } else {
        String::new()
    };
    let days = format_rounded(seconds / LONGEST, 2, "1");
    let squares_found = if surfaces == 1 {
        "square takes"
    } else {
        "squares take"
    };
    let found = format!("{surfaces} {squares_found} about {days} days, longer than one day");
    let allowed = format!("a grid of at most {grid} cells along the side{squares}");
    Err(StudyError::refused(
        Some(&format!("{cells} cells")),
        found,
        allowed,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_longer_than_a_day_is_refused() {
        let time = |days: f64| SquareTime {
            seconds: days * LONGEST,
            loads: 100,
            is_adhesive: false,
        };
        let refused = |surfaces, days| {
            check_time(1024, surfaces, 1, &time(days))
                .unwrap_err()
                .to_string()
        };
        assert!(check_time(1024, 24, 1, &time(1.0 / 24.0)).is_ok());
        assert!(check_time(1024, 24, 2, &time(2.0 / 24.0)).is_ok());
        assert_eq!(
            refused(24, 0.124),
            "1024 cells: 24 squares take about 3 days, longer than one day; allowed: a grid of at most 512 cells \
             along the side, or at most 8 squares"
        );
        assert!(
            refused(24, 50.0 / 24.0)
                .ends_with("allowed: a grid of at most 128 cells along the side")
        );
        let never = SquareTime {
            seconds: 1e300,
            loads: 1,
            is_adhesive: true,
        };
        let never = check_time(8192, 1, 1, &never).unwrap_err().to_string();
        assert!(never.contains("at most 32 cells"), "{never}");
        assert!((time(1.0).share_of_load(4) - 0.0025).abs() < 1e-15);
    }
}
