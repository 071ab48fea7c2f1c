//! Even grids of indentations, and sums that keep their rounding errors.

/// An evenly spaced grid of indentations, both ends exact.
#[derive(Clone, Debug)]
pub struct Grid {
    points: Vec<f64>,
    intervals_per_metre: f64,
}

impl Grid {
    /// `intervals` equal intervals from `low` to `high`; a single point where they coincide.
    pub fn new(low: f64, high: f64, intervals: usize) -> Self {
        let width = (high - low) / intervals as f64;
        // Also too narrow a range to tell its points apart is one point at each end.
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

    pub fn points(&self) -> &[f64] {
        &self.points
    }

    pub fn high(&self) -> f64 {
        self.points[self.points.len() - 1]
    }

    /// Index of the first point that is at least `indentation`, which must not exceed the last.
    #[inline]
    pub fn first_at_least(&self, indentation: f64) -> usize {
        // The guess is off by one at the most where the grid is even; the loops make it exact.
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

/// Sum of non-negative terms that keeps its rounding errors (Neumaier): relative error below
/// 2u + O(n u²).
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

    pub fn add_sum(&mut self, other: CompensatedSum) {
        self.add(other.value);
        self.error += other.error;
    }

    pub fn total(self) -> f64 {
        self.value + self.error
    }
}
