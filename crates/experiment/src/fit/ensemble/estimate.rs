//! Estimate of the work of adhesion or of the effective modulus, with its 95 % interval.

/// Estimate of the work of adhesion in J/m² or of the effective modulus in Pa, with its 95 %
/// interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct IntervalEstimate {
    /// Estimated value, in J/m² for a work of adhesion and in Pa for a modulus: the median of the
    /// probability distribution of the parameter.
    pub value: f64,
    /// Lower end of the 95 % interval, in the unit of the value.
    pub low: f64,
    /// Upper end of the 95 % interval, in the unit of the value.
    pub high: f64,
}

impl IntervalEstimate {
    /// Returns half the width of the interval on the scale of the natural logarithm, ½
    /// ln(high/low).
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high / self.low).ln()
    }

    /// Returns the estimate of a parameter whose value is given: an interval of zero width.
    pub(crate) fn known(value: f64) -> Self {
        IntervalEstimate {
            value,
            low: value,
            high: value,
        }
    }

    /// Returns the estimate of a parameter of which only the upper bound `most` is known. Its
    /// interval begins at 0.
    pub(crate) fn at_most(self, most: f64) -> Self {
        IntervalEstimate {
            value: self.value.min(most),
            low: 0.0,
            high: most,
        }
    }

    /// Adds an independent error to the interval. `half_width` is half the width of the 95 %
    /// interval of this error, on the scale of the natural logarithm.
    pub(crate) fn widened(self, half_width: f64) -> Self {
        let factor_below = (self.low / self.value).ln().hypot(half_width).exp();
        let factor_above = (self.high / self.value).ln().hypot(half_width).exp();
        IntervalEstimate {
            value: self.value,
            low: self.value / factor_below,
            high: self.value * factor_above,
        }
    }
}
