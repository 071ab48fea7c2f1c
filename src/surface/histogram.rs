//! Histogram of heights.

/// Counts of heights in equal bins from the lowest to the highest.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Lower end of the first bin, m.
    pub low: f64,
    /// Upper end of the last bin, m.
    pub high: f64,
    /// Number of heights in each bin.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Counts `heights` (m, finite) into `bins` bins between `low` and `high`, ends included; heights outside are
    /// omitted. For a range of zero width all are in the first bin.
    #[must_use]
    pub fn new(heights: impl Iterator<Item = f64>, low: f64, high: f64, bins: usize) -> Self {
        let mut counts = vec![0; bins.max(1)];
        let last = counts.len() - 1;
        let scale = counts.len() as f64 / (high - low);
        for height in heights.filter(|height| (low..=high).contains(height)) {
            // The conversion to an integer maps NaN, 0/0 here, to zero.
            counts[(((height - low) * scale) as usize).min(last)] += 1;
        }
        Histogram { low, high, counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_every_height_once() {
        let heights = [0.0, 0.1, 0.49, 0.5, 0.99, 1.0];
        let histogram = Histogram::new(heights.into_iter(), 0.0, 1.0, 2);
        assert_eq!(histogram.counts, [3, 3]);
        assert_eq!(Histogram::new([2.0; 5].into_iter(), 2.0, 2.0, 3).counts, [5, 0, 0]);
        assert_eq!(Histogram::new([f64::NAN, -1.0].into_iter(), 0.0, 1.0, 3).counts, [0; 3]);
    }
}
