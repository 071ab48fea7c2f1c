//! Ranges of coordinates that axes show.

use asperity_data::AxisScale;

/// Range of coordinates along an axis. The coordinate of a number is the number itself on a linear
/// axis, and its decadic logarithm on a logarithmic axis. The upper end is above the lower end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub low: f64,
    pub high: f64,
}

/// A range counts as a single coordinate if its width is below this number times its largest
/// coordinate.
const NO_SPREAD: f64 = 1e-9;

impl Span {
    /// Returns the range from the smallest to the largest finite coordinate. The range is widened
    /// at each end by `room` times its width. Without any finite coordinate, the range is 0 to 1.
    ///
    /// ```
    /// let span = asperity_plot::Span::around([1.0, 3.0].into_iter(), 0.1);
    /// assert!(span.low < 1.0 && span.high > 3.0);
    /// ```
    pub fn around(coordinates: impl Iterator<Item = f64>, room: f64) -> Span {
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        for coordinate in coordinates.filter(|coordinate| coordinate.is_finite()) {
            low = low.min(coordinate);
            high = high.max(coordinate);
        }
        if low > high {
            return Span {
                low: 0.0,
                high: 1.0,
            };
        }
        let width = high - low;
        let largest = low.abs().max(high.abs());
        let margin = if width > NO_SPREAD * largest {
            room * width
        } else if largest > 0.0 {
            0.1 * largest
        } else {
            1.0
        };
        Span {
            low: low - margin,
            high: high + margin,
        }
    }

    /// Returns the range of coordinates of an axis that shows these values. The range goes from the
    /// smallest to the largest value, with two exceptions:
    ///
    /// * On a linear scale, the range begins at zero if the smallest value is at least 0 and at
    ///   most 0.3 times the largest value.
    /// * On a logarithmic scale, the range has at most `decades` decades, up to the largest value.
    pub fn of_values(scale: AxisScale, values: impl Iterator<Item = f64>, decades: f64) -> Span {
        let span = Span::around(values.map(|value| scale.coordinate(value)), 0.0);
        match scale {
            AxisScale::Linear if span.low >= 0.0 && span.low <= 0.3 * span.high => {
                Span { low: 0.0, ..span }
            }
            AxisScale::Linear => span,
            AxisScale::Logarithmic => Span {
                low: span.low.max(span.high - decades),
                ..span
            },
        }
    }

    /// Returns the smallest range of whole decades, at least one, that contains these coordinates.
    /// The coordinates are decadic logarithms, as on a logarithmic scale.
    pub fn decades(coordinates: impl Iterator<Item = f64>) -> Span {
        let span = Span::around(coordinates, 0.0);
        let low = span.low.floor();
        Span {
            low,
            high: span.high.ceil().max(low + 1.0),
        }
    }

    /// Returns this range, widened at each end by `room` times the width of the range.
    pub fn widened(self, room: f64) -> Span {
        let margin = room * self.width();
        Span {
            low: self.low - margin,
            high: self.high + margin,
        }
    }

    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Returns the lower and the upper end of the range.
    pub fn bounds(self) -> [f64; 2] {
        [self.low, self.high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_suit_their_values() {
        let linear =
            |values: &[f64]| Span::of_values(AxisScale::Linear, values.iter().copied(), 6.0);
        assert_eq!(
            linear(&[0.1, f64::NAN, 2.0]),
            Span {
                low: 0.0,
                high: 2.0
            }
        );
        assert_eq!(
            linear(&[1.0, 2.0]),
            Span {
                low: 1.0,
                high: 2.0
            }
        );
        let decades =
            |values: &[f64]| Span::of_values(AxisScale::Logarithmic, values.iter().copied(), 6.0);
        assert_eq!(
            decades(&[0.0, -1.0, 1e-2, 1.0]),
            Span {
                low: -2.0,
                high: 0.0
            }
        );
        assert_eq!(decades(&[1e-20, 1.0]).low, -6.0);
        let rounded = linear(&[2.0, 2.0 + 1e-9]);
        assert!(
            (rounded.low - 1.8).abs() < 1e-6 && (rounded.high - 2.2).abs() < 1e-6,
            "{rounded:?}"
        );
        for none in [&[][..], &[0.0], &[3.0, 3.0], &[-1.0], &[f64::INFINITY]] {
            for span in [
                linear(none),
                decades(none),
                Span::around(none.iter().copied(), 0.1),
            ] {
                assert!(
                    span.width() > 0.0 && span.width().is_finite(),
                    "{none:?} {span:?}"
                );
            }
        }
        assert_eq!(
            Span::decades([0.3, 1.2].into_iter()),
            Span {
                low: 0.0,
                high: 2.0
            }
        );
        assert_eq!(
            Span::around([1.0, 3.0].into_iter(), 0.5),
            Span {
                low: 0.0,
                high: 4.0
            }
        );
    }
}
