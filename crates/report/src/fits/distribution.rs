//! Distribution of the first free parameter over the curves: its values, median, quartiles and
//! histogram.

use asperity_data::{counted, format_quantity, format_range, quartiles};
use asperity_experiment::Parameter;
use asperity_plot::Span;
use serde::Serialize;

/// Values of the first free parameter on the curves that the model describes, and on the other
/// curves.
pub(super) struct FirstParameter {
    pub described: Vec<f64>,
    pub others: Vec<f64>,
}

impl FirstParameter {
    /// Returns the values on all curves, beginning with the curves that the model describes.
    pub fn all(&self) -> Vec<f64> {
        [self.described.as_slice(), &self.others].concat()
    }
}

/// Median and quartiles of a parameter over curves, and the number of these curves.
pub(super) struct Distribution {
    quartiles: [f64; 3],
    count: usize,
}

impl Distribution {
    /// Returns the distribution of some values; `None` if there are no values.
    pub fn new(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        Some(Distribution {
            quartiles: quartiles(&values)?,
            count: values.len(),
        })
    }

    /// Returns a sentence on the distribution of a parameter. `curves` says in words which curves
    /// these are, such as `that the model describes`.
    pub fn sentence(&self, parameter: Parameter, curves: &str) -> String {
        let row = parameter.row();
        let [lower, median, upper] = self.quartiles;
        let first_letter = row.term[..1].to_uppercase();
        let other_letters = &row.term[1..];
        let symbol = row.symbol;
        let median = format_quantity(median, row.unit);
        let quartiles = format_range((lower, upper), 4, row.unit);
        let count = counted(self.count as u64, "curve");
        format!(
            "{first_letter}{other_letters} {symbol}: median {median}, quartiles {quartiles}, over {count} {curves}."
        )
    }
}

#[derive(Serialize)]
pub(super) struct DistributionJson {
    median: f64,
    quartiles: [f64; 2],
    curves: usize,
}

impl DistributionJson {
    pub fn new(values: Vec<f64>) -> Option<Self> {
        let distribution = Distribution::new(values)?;
        let [lower, median, upper] = distribution.quartiles;
        Some(DistributionJson {
            median,
            quartiles: [lower, upper],
            curves: distribution.count,
        })
    }
}

/// Smallest and largest number of bars of a histogram. The number is the square root of the number
/// of values within these limits.
const BARS: (usize, usize) = (5, 40);

/// Range of a bar of a histogram along the horizontal axis, and range along the vertical axis.
type Bar = ((f64, f64), (f64, f64));

/// Histogram of the first parameter over the curves.
pub(super) struct Histogram {
    pub described: Vec<Bar>,
    /// Bars of the curves that the model does not describe. They are drawn on top of the bars of
    /// the described curves.
    pub others: Vec<Bar>,
    /// Largest number of curves in a bar, at least 1.
    pub most: f64,
}

impl Histogram {
    pub fn new(values: &FirstParameter) -> Self {
        let all = values.all();
        // If all values are equal, `Span::around` returns a range with these values in its middle.
        let Span { low, high } = Span::around(all.iter().copied(), 0.0);
        let (fewest, most) = BARS;
        let bars = ((all.len() as f64).sqrt().ceil() as usize).clamp(fewest, most);
        let width = (high - low) / bars as f64;

        let mut histogram = Histogram {
            described: Vec::new(),
            others: Vec::new(),
            most: 1.0,
        };
        let described_counts = counts(&values.described, bars, low, width);
        let other_counts = counts(&values.others, bars, low, width);
        for bar in 0..bars {
            let described = described_counts[bar];
            let others = other_counts[bar];
            let edges = (low + width * bar as f64, low + width * (bar + 1) as f64);
            if described > 0.0 {
                histogram.described.push((edges, (0.0, described)));
            }
            if others > 0.0 {
                histogram
                    .others
                    .push((edges, (described, described + others)));
            }
            histogram.most = histogram.most.max(described + others);
        }
        histogram
    }
}

/// Returns the number of values in each of `bars` bars of equal width. The first bar begins at
/// `low`. A value at the upper end belongs to the last bar.
fn counts(values: &[f64], bars: usize, low: f64, width: f64) -> Vec<f64> {
    let mut counts = vec![0.0; bars];
    for value in values {
        let bar = ((value - low) / width).min(bars as f64 - 1.0) as usize;
        counts[bar] += 1.0;
    }
    counts
}
