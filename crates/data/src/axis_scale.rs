//! Linear and logarithmic scales of axes.

/// Scale of an axis of a chart, linear or logarithmic. The scale maps each number to a coordinate
/// along the axis.
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Linear scale: the coordinate is the number.
    #[default]
    Linear,
    /// Logarithmic scale: the coordinate is the decimal logarithm of the number.
    Logarithmic,
}

impl AxisScale {
    /// Returns the coordinate of a number along the axis. On a logarithmic scale, zero and negative
    /// numbers have no finite coordinate.
    ///
    /// ```
    /// use asperity_data::AxisScale;
    ///
    /// assert_eq!(AxisScale::Logarithmic.number(AxisScale::Logarithmic.coordinate(1.0)), 1.0);
    /// assert_eq!(AxisScale::Linear.coordinate(5.0), 5.0);
    /// ```
    pub fn coordinate(self, number: f64) -> f64 {
        if self == AxisScale::Logarithmic {
            number.log10()
        } else {
            number
        }
    }

    /// Returns where `number` lies among the ascending `values`, as an index that need not be a
    /// whole number. For example, 1.5 means the middle, on this scale, between the values with the
    /// indices 1 and 2. Outside the range of the values, the index is extrapolated. If there are
    /// fewer than two values, the index is 0.
    pub fn place(self, values: &[f64], number: f64) -> f64 {
        let coordinates: Vec<f64> = values.iter().map(|value| self.coordinate(*value)).collect();
        let coordinate = self.coordinate(number);
        let last = coordinates.len().max(2) - 1;
        let after = coordinates
            .partition_point(|other| *other <= coordinate)
            .clamp(1, last);
        match coordinates.get(after - 1..=after) {
            Some(&[low, high]) if high > low => {
                (after - 1) as f64 + (coordinate - low) / (high - low)
            }
            _ => 0.0,
        }
    }

    /// Returns the number whose coordinate on this scale is `coordinate`.
    pub fn number(self, coordinate: f64) -> f64 {
        if self == AxisScale::Logarithmic {
            10_f64.powf(coordinate)
        } else {
            coordinate
        }
    }
}
