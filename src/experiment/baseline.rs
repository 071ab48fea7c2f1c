//! The part of a curve before contact: where it ends, its straight line and the noise around it.

/// Fewest points before contact.
pub(super) const FEWEST: usize = 10;
/// Share of the approach that is taken as free at first, and of its points in each mean that is compared with the line before.
const FIRST: usize = 50;
const MEAN: usize = 200;
/// Deviation of a mean in standard errors: of two in a row, or of one, that is a contact.
const TWO: f64 = 5.0;
const ONE: f64 = 20.0;

/// Straight line through evenly spaced values, by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    count: f64,
    pub mean: f64,
    pub slope: f64,
    /// Standard deviation of a value around the line.
    pub noise: f64,
}

impl Line {
    pub fn through(values: &[f64]) -> Line {
        let count = values.len() as f64;
        let place = |index: usize| index as f64 - 0.5 * (count - 1.0);
        let mean = values.iter().sum::<f64>() / count;
        let product: f64 = values.iter().enumerate().map(|(index, value)| place(index) * value).sum();
        let slope = product / (count * (count * count - 1.0) / 12.0);
        let rest = |(index, value): (usize, &f64)| (value - mean - slope * place(index)).powi(2);
        let noise = (values.iter().enumerate().map(rest).sum::<f64>() / (count - 2.0)).sqrt();
        Line { count, mean, slope, noise }
    }

    /// Standard error of the slope.
    pub fn slope_error(&self) -> f64 {
        self.noise / (self.count * (self.count * self.count - 1.0) / 12.0).sqrt()
    }
}

/// Number of the first values of an approach, up to the first change: means of a few values that differ from the line
/// before. `Some(0)` if the change comes at once, `None` without a change. The noise is `least` at least.
pub(super) fn free_count(values: &[f64], least: f64) -> Option<usize> {
    let block = values.len().div_ceil(MEAN).max(3);
    let first = (values.len() / FIRST).max(2 * FEWEST);
    let mut before = 0.0;
    for end in (first..).step_by(block).take_while(|end| end + block <= values.len()) {
        let line = Line::through(&values[..end]);
        let ahead = 0.5 * (end + block) as f64;
        let mean = values[end..end + block].iter().sum::<f64>() / block as f64;
        let noise = line.noise.max(least);
        let error = noise * (1.0 / block as f64 + 1.0 / end as f64).sqrt() + line.slope_error() * ahead;
        let deviation = (mean - line.mean - line.slope * ahead) / error;
        if deviation.abs() > TWO && (deviation * before > 0.0 || deviation.abs() > ONE) {
            // The mean before may hold the beginning of the contact.
            let free = end - if before == 0.0 { 0 } else { block };
            return Some(if end <= first + block { 0 } else { free });
        }
        before = if deviation.abs() > TWO { deviation } else { 0.0 };
    }
    None
}

/// Sum of products over the shorter length.
pub(super) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}
