//! Axes: scale, range, label and unit.

use super::label::{Label, prefixed};
use super::scale::Span;
use super::ticks::{Tick, are_plain, ticks};
use asperity_data::AxisScale;
use std::ops::Range;

/// Largest numbers on a linear axis with which all numbers at the ticks have few digits.
const SHORT: Range<f64> = 1e-3..1e6;

/// Axis of a chart: a quantity with name, symbol and unit, and the scale and range of the numbers
/// that the axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxis {
    pub scale: AxisScale,
    /// Range of coordinates that the axis shows. A coordinate is the number itself on a linear
    /// axis, and the decadic logarithm of the number on a logarithmic axis.
    pub span: Span,
    /// Name of the quantity in words; may be empty.
    pub name: String,
    /// Symbol of the quantity, such as `F_n`; may be empty.
    pub symbol: String,
    /// SI unit of the quantity without a prefix; `1` or empty for plain numbers.
    pub unit: String,
    /// Names along the axis in place of numbers, at the coordinates 0, 1, 2 and so on. Empty for an
    /// axis with numbers.
    pub names: Vec<Label>,
    /// True if the quantity is a count, so that the axis has ticks only at whole numbers.
    pub counts: bool,
}

impl ChartAxis {
    pub fn new(scale: AxisScale, span: Span, name: &str, symbol: &str, unit: &str) -> ChartAxis {
        ChartAxis {
            scale,
            span,
            name: name.to_owned(),
            symbol: symbol.to_owned(),
            unit: unit.to_owned(),
            names: Vec::new(),
            counts: false,
        }
    }

    /// Creates a linear axis with these names at the coordinates 0, 1, 2 and so on, in place of
    /// numbers.
    pub fn of_names(names: Vec<Label>) -> ChartAxis {
        let span = Span {
            low: -0.5,
            high: names.len() as f64 - 0.5,
        };
        ChartAxis {
            names,
            ..ChartAxis::new(AxisScale::Linear, span, "", "", "")
        }
    }

    /// Returns the position of a number along the axis, from 0 at the lower end to 1 at the upper
    /// end. For 0 or a negative number on a logarithmic axis the position is not finite.
    pub fn share(&self, number: f64) -> f64 {
        (self.scale.coordinate(number) - self.span.low) / self.span.width()
    }

    /// Returns the divisor of the numbers at the ticks, and the unit of the divided numbers, such
    /// as 1e-6 and `µN`.
    pub fn prefix(&self) -> (f64, String) {
        let lowest = self.scale.number(self.span.low).abs();
        let highest = self.scale.number(self.span.high).abs();
        let largest = lowest.max(highest);
        if self.scale == AxisScale::Logarithmic {
            // The prefix of a smaller number may give plain numbers in place of powers of ten.
            for thousands in 0..6 {
                let (divisor, unit) = prefixed(&self.unit, largest / 1000_f64.powi(thousands));
                if are_plain(self.span, divisor) {
                    return (divisor, unit);
                }
            }
            let (_, unit) = prefixed(&self.unit, 1.0);
            return (1.0, unit);
        }
        let (divisor, unit) = prefixed(&self.unit, largest);
        if SHORT.contains(&(largest / divisor)) || !largest.is_normal() {
            return (divisor, unit);
        }
        let power = 3 * (largest.log10() / 3.0).floor() as i32;
        let unit = format!("{} {unit}", Label::power_of_ten(power));
        (10_f64.powi(power), unit.trim_end().to_owned())
    }

    /// Returns the axis with its numbers divided by a unit with this symbol.
    pub(super) fn over(&self, unit: f64, symbol: &str) -> ChartAxis {
        let divided = |coordinate: f64| self.scale.coordinate(self.scale.number(coordinate) / unit);
        ChartAxis {
            span: Span {
                low: divided(self.span.low),
                high: divided(self.span.high),
            },
            symbol: format!("{}/{symbol}", self.symbol),
            unit: "1".to_owned(),
            ..self.clone()
        }
    }

    /// Returns the label of the axis: name and symbol, then the unit in brackets, which has the
    /// prefix of [`Self::prefix`].
    ///
    /// ```
    /// use asperity_data::AxisScale;
    /// use asperity_plot::{ChartAxis, Span};
    ///
    /// let axis = ChartAxis::new(
    ///     AxisScale::Linear,
    ///     Span {
    ///         low: 0.0,
    ///         high: 2e-6,
    ///     },
    ///     "force",
    ///     "F",
    ///     "N",
    /// );
    /// assert_eq!(axis.label_with_unit().to_string(), "force F (µN)");
    /// ```
    pub fn label_with_unit(&self) -> Label {
        self.with_unit(Label::quantity(&self.name, &self.symbol))
    }

    /// Returns the label of the axis. The name is omitted if the axis has a symbol and the label
    /// would be wider than `most`, in units of the font size.
    pub(super) fn label_within(&self, most: f64) -> Label {
        let label = self.label_with_unit();
        if label.width() <= most {
            label
        } else {
            self.symbol_with_unit()
        }
    }

    /// Returns a short label of the axis: the symbol, or the name if there is no symbol, then the
    /// unit in brackets.
    pub fn symbol_with_unit(&self) -> Label {
        self.with_unit(self.symbol_or_name())
    }

    pub fn symbol_or_name(&self) -> Label {
        Label::symbol_or_name(&self.symbol, &self.name)
    }

    fn with_unit(&self, label: Label) -> Label {
        let (_, unit) = self.prefix();
        if unit.is_empty() {
            label
        } else {
            label.then(&format!(" ({unit})"))
        }
    }

    /// Returns the ticks of the axis: about `most` ticks with a number, and minor ticks without a
    /// number between them. An axis with names has a tick at each name.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        if !self.names.is_empty() {
            let named = self.names.iter().enumerate().map(|(index, name)| Tick {
                at: index as f64,
                label: Some(name.clone()),
            });
            return named.collect();
        }
        // One or two more ticks, if with fewer ticks a single one would have a number.
        for count in most..=most + 2 {
            let ticks = self.ticks_with_numbers(count);
            let labelled = ticks.iter().filter(|tick| tick.label.is_some());
            if labelled.count() >= 2 {
                return ticks;
            }
        }
        self.ticks_with_numbers(most)
    }

    fn ticks_with_numbers(&self, most: usize) -> Vec<Tick> {
        let (divisor, _) = self.prefix();
        let least = if self.counts { 1.0 } else { 0.0 };
        ticks(self.scale, self.span, divisor, most, least)
    }
}

/// Position in a chart as a horizontal and a vertical share, each from 0 to 1.
pub(super) type Share = (f64, f64);

#[derive(Clone, Copy)]
pub(super) struct Axes<'a> {
    pub x: &'a ChartAxis,
    pub y: &'a ChartAxis,
}

impl Axes<'_> {
    /// Returns the position of a point, or the nearest position on the border for a point outside
    /// the chart; `None` if the point has no coordinates.
    pub(super) fn place(self, point: (f64, f64)) -> Option<Share> {
        let (_, y) = point;
        if !self.y.share(y).is_finite() {
            return None;
        }
        self.place_at_end(point)
    }

    /// Returns the position of a point. A y without a coordinate is placed at the end of the axis.
    pub(super) fn place_at_end(self, point: (f64, f64)) -> Option<Share> {
        let (x, y) = point;
        let across = self.x.share(x);
        let up = self.y.share(y);
        if !across.is_finite() {
            return None;
        }
        let up = if up.is_nan() { 0.0 } else { up.clamp(0.0, 1.0) };
        Some((across.clamp(0.0, 1.0), up))
    }

    /// Returns the positions of points, divided into runs where a point has no coordinates.
    pub(super) fn runs(self, points: impl Iterator<Item = (f64, f64)>) -> Vec<Vec<Share>> {
        let mut runs = Vec::new();
        let mut run = Vec::new();
        for point in points {
            if let Some(place) = self.place(point) {
                run.push(place);
            } else if !run.is_empty() {
                runs.push(std::mem::take(&mut run));
            }
        }
        if !run.is_empty() {
            runs.push(run);
        }
        runs
    }

    /// Returns the positions along an envelope through both ends of each column, beginning with the
    /// end nearer to the previous point. A column outside the chart begins a new run.
    pub(super) fn envelope(self, x: (f64, f64), columns: &[Option<(f64, f64)>]) -> Vec<Vec<Share>> {
        let (from, to) = x;
        let mut points = Vec::with_capacity(2 * columns.len());
        let mut last: Option<f64> = None;
        for (column, ends) in columns.iter().enumerate() {
            let inside =
                ends.filter(|(low, high)| self.y.share(*high) >= 0.0 && self.y.share(*low) <= 1.0);
            let (low, high) = inside.unwrap_or((f64::NAN, f64::NAN));
            let falls = last.is_some_and(|last| (last - high).abs() < (last - low).abs());
            let [first, second] = if falls { [high, low] } else { [low, high] };
            last = second.is_finite().then_some(second);
            let middle = from + (to - from) * (column as f64 + 0.5) / columns.len() as f64;
            points.push((middle, first));
            points.push((middle, second));
        }
        self.runs(points.into_iter())
    }

    /// Returns the ends of a vertical or horizontal line across the chart at this number; `None` if
    /// the line lies outside.
    pub(super) fn guide(self, number: f64, is_vertical: bool) -> Option<[Share; 2]> {
        let axis = if is_vertical { self.x } else { self.y };
        let share = axis.share(number);
        if !(0.0..=1.0).contains(&share) {
            return None;
        }
        if is_vertical {
            Some([(share, 0.0), (share, 1.0)])
        } else {
            Some([(0.0, share), (1.0, share)])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_position_and_a_unit() {
        let span = Span {
            low: -2.0,
            high: 0.0,
        };
        let axis = ChartAxis::new(AxisScale::Logarithmic, span, "preload", "F_n", "N");
        assert_eq!(axis.share(0.1), 0.5);
        assert!(!axis.share(0.0).is_finite() && !axis.share(-1.0).is_finite());
        assert_eq!(axis.label_with_unit().to_string(), "preload F_n (N)");
        assert_eq!(axis.symbol_with_unit().to_string(), "F_n (N)");
        let unnamed = ChartAxis::new(AxisScale::Linear, span, "relative error", "", "1");
        assert_eq!(unnamed.symbol_with_unit(), unnamed.label_with_unit());
        let axis = ChartAxis::new(
            AxisScale::Linear,
            Span {
                low: -3e-6,
                high: 1e-6,
            },
            "",
            "F",
            "N",
        );
        assert_eq!(axis.label_with_unit().to_string(), "F (µN)");
        let share = ChartAxis::new(
            AxisScale::Linear,
            Span {
                low: 0.0,
                high: 7e18,
            },
            "",
            "F_a/F_n",
            "1",
        );
        assert_eq!(share.label_with_unit().to_string(), "F_a/F_n (10¹⁸)");
        let labels: Vec<_> = axis
            .ticks(5)
            .into_iter()
            .filter_map(|tick| tick.label)
            .collect();
        assert_eq!(
            labels.iter().map(Label::to_string).collect::<Vec<_>>(),
            ["-3", "-2", "-1", "0", "1"]
        );
        let hurst = ChartAxis::new(
            AxisScale::Linear,
            Span {
                low: 0.075,
                high: 0.925,
            },
            "",
            "H",
            "1",
        );
        assert_eq!(
            hurst
                .ticks(3)
                .into_iter()
                .filter(|tick| tick.label.is_some())
                .count(),
            4
        );
    }

    #[test]
    fn an_axis_over_a_unit_keeps_the_places_of_its_numbers() {
        let ends = Span {
            low: -3.0,
            high: 1.0,
        };
        for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
            let axis = ChartAxis::new(scale, ends, "force", "F", "N");
            let over = axis.over(0.5, "F_a,max");
            assert_eq!(over.label_with_unit().to_string(), "force F/F_a,max");
            for number in [0.01, 0.7, 2.0] {
                assert!(
                    (over.share(number / 0.5) - axis.share(number)).abs() < 1e-12,
                    "{scale:?} {number}"
                );
            }
        }
    }
}
