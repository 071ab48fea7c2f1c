//! Scales of axes.

/// Mapping of numbers to coordinates along an axis.
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Equal distances for equal differences.
    #[default]
    Linear,
    /// The decimal logarithm; all values are above zero.
    Logarithmic,
}

impl AxisScale {
    /// Coordinate of a number; not finite for a number without a logarithm.
    pub fn coordinate(self, number: f64) -> f64 {
        if self == AxisScale::Logarithmic { number.log10() } else { number }
    }

    /// Place of a number among ascending values, the first at 0: linear between two values, extrapolated by the
    /// last distance beyond the ends.
    pub fn place(self, values: &[f64], number: f64) -> f64 {
        let places: Vec<f64> = values.iter().map(|value| self.coordinate(*value)).collect();
        let at = self.coordinate(number);
        let after = places.partition_point(|place| *place <= at).clamp(1, places.len().max(2) - 1);
        match places.get(after - 1..=after) {
            Some(&[low, high]) if high > low => (after - 1) as f64 + (at - low) / (high - low),
            _ => 0.0,
        }
    }

    /// Number at a coordinate.
    pub fn number(self, coordinate: f64) -> f64 {
        if self == AxisScale::Logarithmic { 10_f64.powf(coordinate) } else { coordinate }
    }
}
