//! Axes: scale, range, label and unit.

use super::label::{Label, prefixed};
use super::ticks::{Tick, ticks};

/// Mapping of numbers to coordinates along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisScale {
    /// The number itself.
    Linear,
    /// The decimal logarithm; all values are above zero.
    Logarithmic,
}

impl AxisScale {
    /// Coordinate of a number; not finite where the number has no logarithm.
    #[must_use]
    pub fn coordinate(self, number: f64) -> f64 {
        if self == AxisScale::Logarithmic { number.log10() } else { number }
    }

    /// Number at a coordinate.
    #[must_use]
    pub fn number(self, coordinate: f64) -> f64 {
        if self == AxisScale::Logarithmic { 10_f64.powf(coordinate) } else { coordinate }
    }
}

/// A range of coordinates, wider than a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Relative width below which a range is one number.
const NO_SPREAD: f64 = 1e-9;

impl Span {
    /// Range of finite coordinates with the share `room` of its width added at each end; a range around a
    /// single coordinate, and 0 to 1 without any.
    #[must_use]
    pub fn around(coordinates: impl Iterator<Item = f64>, room: f64) -> Span {
        let finite = coordinates.filter(|coordinate| coordinate.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        if low > high {
            return Span { low: 0.0, high: 1.0 };
        }
        let width = high - low;
        let largest = low.abs().max(high.abs());
        let margin = match () {
            () if width > NO_SPREAD * largest => room * width,
            () if largest > 0.0 => 0.1 * largest,
            () => 1.0,
        };
        Span { low: low - margin, high: high + margin }
    }

    /// Range of values of a quantity, as coordinates of a scale. A linear range begins at zero where no value is
    /// below zero and the lowest is at most 0.3 of the highest; a logarithmic one has at most `decades`.
    #[must_use]
    pub fn of_values(scale: AxisScale, values: impl Iterator<Item = f64>, decades: f64) -> Span {
        let span = Span::around(values.map(|value| scale.coordinate(value)), 0.0);
        match scale {
            AxisScale::Linear if span.low >= 0.0 && span.low <= 0.3 * span.high => Span { low: 0.0, ..span },
            AxisScale::Linear => span,
            AxisScale::Logarithmic => Span { low: span.low.max(span.high - decades), ..span },
        }
    }

    /// Whole decades around coordinates of a logarithmic scale, at least one.
    #[must_use]
    pub fn decades(coordinates: impl Iterator<Item = f64>) -> Span {
        let span = Span::around(coordinates, 0.0);
        let low = span.low.floor();
        Span { low, high: span.high.ceil().max(low + 1.0) }
    }

    /// The range with the share `room` of its width added at each end.
    #[must_use]
    pub fn widened(self, room: f64) -> Span {
        let margin = room * self.width();
        Span { low: self.low - margin, high: self.high + margin }
    }

    /// Width.
    #[must_use]
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Lower and upper end.
    #[must_use]
    pub fn bounds(self) -> [f64; 2] {
        [self.low, self.high]
    }
}

/// An axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Scale.
    pub scale: AxisScale,
    /// Range, coordinates.
    pub span: Span,
    /// Name and symbol without unit; may be empty.
    pub label: Label,
    /// SI unit; `1` or empty for numbers.
    pub unit: String,
}

impl Axis {
    /// An axis with a name, a symbol such as `F_n`, and a unit, each of which may be empty.
    #[must_use]
    pub fn new(scale: AxisScale, span: Span, name: &str, symbol: &str, unit: &str) -> Axis {
        let space = if name.is_empty() || symbol.is_empty() { "" } else { " " };
        let label = Label::plain(name).then(space).join(&Label::symbol(symbol));
        Axis { scale, span, label, unit: unit.to_owned() }
    }

    /// Position of a number from 0 at the lower to 1 at the upper end; not finite where the scale has no
    /// coordinate for the number.
    #[must_use]
    pub fn share(&self, number: f64) -> f64 {
        (self.scale.coordinate(number) - self.span.low) / self.span.width()
    }

    /// Divisor of the numbers on the axis and unit with the SI prefix that goes with the divisor.
    #[must_use]
    pub fn prefix(&self) -> (f64, String) {
        let ends = self.span.bounds().map(|end| self.scale.number(end).abs());
        prefixed(&self.unit, ends[0].max(ends[1]))
    }

    /// Label with the prefixed unit in brackets.
    #[must_use]
    pub fn label_with_unit(&self) -> Label {
        match self.prefix().1 {
            unit if unit.is_empty() => self.label.clone(),
            unit => self.label.clone().then(&format!(" ({unit})")),
        }
    }

    /// Ticks, about `most` of which are labelled, at coordinates.
    #[must_use]
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        ticks(self.scale, self.span, self.prefix().0, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_suit_their_values() {
        let linear = |values: &[f64]| Span::of_values(AxisScale::Linear, values.iter().copied(), 6.0);
        assert_eq!(linear(&[0.1, f64::NAN, 2.0]), Span { low: 0.0, high: 2.0 });
        assert_eq!(linear(&[1.0, 2.0]), Span { low: 1.0, high: 2.0 });
        let decades = |values: &[f64]| Span::of_values(AxisScale::Logarithmic, values.iter().copied(), 6.0);
        assert_eq!(decades(&[0.0, -1.0, 1e-2, 1.0]), Span { low: -2.0, high: 0.0 });
        assert_eq!(decades(&[1e-20, 1.0]).low, -6.0);
        let rounded = linear(&[2.0, 2.0 + 1e-9]);
        assert!((rounded.low - 1.8).abs() < 1e-6 && (rounded.high - 2.2).abs() < 1e-6, "{rounded:?}");
        for none in [&[][..], &[0.0], &[3.0, 3.0], &[-1.0], &[f64::INFINITY]] {
            for span in [linear(none), decades(none), Span::around(none.iter().copied(), 0.1)] {
                assert!(span.width() > 0.0 && span.width().is_finite(), "{none:?} {span:?}");
            }
        }
        assert_eq!(Span::decades([0.3, 1.2].into_iter()), Span { low: 0.0, high: 2.0 });
        assert_eq!(Span::around([1.0, 3.0].into_iter(), 0.5), Span { low: 0.0, high: 4.0 });
    }

    #[test]
    fn numbers_have_a_position_and_a_unit() {
        let span = Span { low: -2.0, high: 0.0 };
        let axis = Axis::new(AxisScale::Logarithmic, span, "preload", "F_n", "N");
        assert_eq!(axis.share(0.1), 0.5);
        assert!(!axis.share(0.0).is_finite() && !axis.share(-1.0).is_finite());
        assert_eq!(axis.label_with_unit().to_string(), "preload F_n (N)");
        let axis = Axis::new(AxisScale::Linear, Span { low: -3e-6, high: 1e-6 }, "", "F", "N");
        assert_eq!(axis.label_with_unit().to_string(), "F (µN)");
        let labels: Vec<_> = axis.ticks(5).into_iter().filter_map(|tick| tick.label).collect();
        assert_eq!(labels.iter().map(Label::to_string).collect::<Vec<_>>(), ["−3", "−2", "−1", "0", "1"]);
    }
}
