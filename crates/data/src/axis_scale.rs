//! Scales of axes.

/// Scale of an axis: the mapping of numbers to coordinates along it.
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Linear: equal distances for equal differences.
    #[default]
    Linear,
    /// Logarithmic, by the decimal logarithm; all values are above zero.
    Logarithmic,
}

impl AxisScale {
    /// Coordinate of a number; not finite for a number without a logarithm.
    ///
    /// ```
    /// use asperity_data::AxisScale;
    ///
    /// assert_eq!(AxisScale::Logarithmic.number(AxisScale::Logarithmic.coordinate(1.0)), 1.0);
    /// assert_eq!(AxisScale::Linear.coordinate(5.0), 5.0);
    /// ```
    pub fn coordinate(self, number: f64) -> f64 {
        if self == AxisScale::Logarithmic { number.log10() } else { number }
    }

    /// Fractional index of a number among ascending values, 0 at the first value: interpolated between two values, and
    /// extrapolated beyond the ends by the nearest distance.
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
