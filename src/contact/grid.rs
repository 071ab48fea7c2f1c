//! Grids of indentations, and sums that keep their rounding errors.

/// A grid of ascending indentations, evenly spaced with both ends exact but for a shorter last interval, or at given
/// points.
#[derive(Clone, Debug)]
pub struct Grid {
    points: Vec<f64>,
    intervals_per_metre: f64,
}

impl Grid {
    /// `intervals` equal intervals from `low` to `high`; a single point where they coincide.
    pub fn new(low: f64, high: f64, intervals: usize) -> Self {
        let width = (high - low) / intervals as f64;
        // A range too narrow for two different points is also one point at each end.
        let even = low + width > low && high - width < high && width.recip().is_finite();
        let mut points: Vec<f64> = if even {
            (0..intervals).map(|k| (low + width * k as f64).min(high)).collect()
        } else {
            vec![low]
        };
        if high > low {
            points.push(high);
        }
        Grid { points, intervals_per_metre: if even { width.recip() } else { 0.0 } }
    }

    /// Grid at these ascending indentations, at least one, m.
    pub fn at(points: Vec<f64>) -> Self {
        Grid { points, intervals_per_metre: 0.0 }
    }

    /// Every `stride`-th of its points, and the last.
    pub fn coarser(&self, stride: usize) -> Self {
        let last = self.points.len() - 1;
        let points = (0..last).step_by(stride).chain([last]).map(|index| self.points[index]).collect();
        Grid { points, intervals_per_metre: self.intervals_per_metre / stride as f64 }
    }

    /// Returns false for a grid of given points, or of its two ends alone.
    pub fn is_even(&self) -> bool {
        self.intervals_per_metre > 0.0
    }

    pub fn points(&self) -> &[f64] {
        &self.points
    }

    pub fn high(&self) -> f64 {
        self.points[self.points.len() - 1]
    }

    /// Index of the first point that is at least `indentation`, which must not exceed the last point.
    #[inline]
    pub fn first_at_least(&self, indentation: f64) -> usize {
        if !self.is_even() {
            return self.points.partition_point(|&point| point < indentation);
        }
        // Off by at most two where the grid is even; the loops make it exact.
        let guess = ((indentation - self.points[0]) * self.intervals_per_metre) as usize;
        let mut index = guess.min(self.points.len() - 1);
        while self.points[index] < indentation {
            index += 1;
        }
        while index > 0 && self.points[index - 1] >= indentation {
            index -= 1;
        }
        index
    }
}

/// Sum that keeps its rounding errors (Neumaier): error below 2u |Σ t| + O(n u²) Σ |t|.
#[derive(Clone, Copy, Debug, Default)]
pub struct CompensatedSum {
    value: f64,
    error: f64,
}

impl CompensatedSum {
    #[inline]
    pub fn add(&mut self, term: f64) {
        let sum = self.value + term;
        let added = sum - self.value;
        self.error += (self.value - (sum - added)) + (term - added);
        self.value = sum;
    }

    pub fn total(self) -> f64 {
        self.value + self.error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A grid has the requested number of equal intervals, both ends exact; the search finds the same point as a
        /// scan.
        #[test]
        fn points_are_even_and_found(
            low in -1.0..1.0_f64,
            width in prop_oneof![1e-9..1.0_f64, Just(0.0)],
            intervals in 1_usize..70,
            share in 0.0..=1.0_f64,
        ) {
            let high = low + width;
            let grid = Grid::new(low, high, intervals);
            let points = grid.points();
            prop_assert_eq!((points[0], grid.high()), (low, high));
            prop_assert_eq!(points.len(), if high > low { intervals + 1 } else { 1 });
            for (k, &point) in points.iter().enumerate() {
                let even = low + (high - low) * (k as f64 / intervals as f64);
                prop_assert!((point - even).abs() <= 4.0 * f64::EPSILON, "{} {}", point, even);
            }
            let wanted = points.iter().copied().chain([(low + share * width).min(high), low - 1.0]);
            for wanted in wanted {
                prop_assert_eq!(grid.first_at_least(wanted), points.partition_point(|&point| point < wanted));
            }
        }

        /// Small numbers added to a large one, which is then subtracted, are kept.
        #[test]
        fn a_sum_keeps_its_rounding_errors(power in 40..60_i32, small in 1e-3..1.0_f64, count in 1_u32..99) {
            let large = 2.0_f64.powi(power);
            let mut sum = CompensatedSum::default();
            (0..count).for_each(|_| [small, large, small].into_iter().for_each(|term| sum.add(term)));
            sum.add(-large * f64::from(count));
            prop_assert!((sum.total() / (2.0 * f64::from(count) * small) - 1.0).abs() < 1e-9, "{:?}", sum);
        }
    }

    #[test]
    fn a_range_too_narrow_for_its_points_is_its_two_ends() {
        let high = 1.0 + f64::EPSILON;
        assert_eq!(Grid::new(1.0, high, 8).points(), [1.0, high]);
        // Narrower than the reciprocal of the largest number.
        let high = f64::from_bits(1 << 14);
        let grid = Grid::new(0.0, high, 4);
        assert_eq!(grid.points(), [0.0, high]);
        assert_eq!([0.0, 0.5 * high, high].map(|wanted| grid.first_at_least(wanted)), [0, 1, 1]);
    }
}
