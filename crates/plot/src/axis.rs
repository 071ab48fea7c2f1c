//! Axes of charts: scale, range, label and unit.

use super::label::{Label, prefixed};
use super::scale::Span;
use super::ticks::{Tick, are_plain, ticks};
use asperity_data::AxisScale;
use std::ops::Range;

/// If the largest number on a linear axis lies in this range, the ticks show plain numbers.
/// Otherwise the numbers would have many digits, so that a power of ten is added to the unit.
const SHORT: Range<f64> = 1e-3..1e6;

/// Axis of a chart: a quantity with name, symbol and unit, and the scale and range of the numbers
/// that the axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxis {
    pub scale: AxisScale,
    /// Range of coordinates that the axis shows. On a linear axis, the coordinate of a number is
    /// the number itself. On a logarithmic axis, it is the decadic logarithm of the number.
    pub span: Span,
    /// Name of the quantity in words; may be empty.
    pub name: String,
    /// Symbol of the quantity, such as `F_n`; may be empty.
    pub symbol: String,
    /// SI unit of the quantity without a prefix; `1` or empty for plain numbers.
    pub unit: String,
    /// Names that the axis shows instead of numbers. They belong to the coordinates 0, 1, 2 and so
    /// on. The list is empty for an axis with numbers.
    pub names: Vec<Label>,
    /// True if the quantity is a count. The axis then has ticks only at whole numbers.
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

    /// Creates a linear axis that shows names instead of numbers. The names belong to the
    /// coordinates 0, 1, 2 and so on.
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
    /// end. On a logarithmic axis, the position of 0 or of a negative number is not finite.
    pub fn share(&self, number: f64) -> f64 {
        (self.scale.coordinate(number) - self.span.low) / self.span.width()
    }

    /// Returns the prefix of the axis: the divisor of the numbers that the axis shows, and the unit
    /// of the divided numbers. For example, forces of some µN give 1e-6 and `µN`.
    pub fn prefix(&self) -> (f64, String) {
        let lowest = self.scale.number(self.span.low).abs();
        let highest = self.scale.number(self.span.high).abs();
        let largest = lowest.max(highest);
        if self.scale == AxisScale::Logarithmic {
            // With a smaller prefix, the ticks may have plain numbers instead of powers of ten.
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

    /// Returns the axis of the quotient of this quantity and another quantity, such as F/F_a,max.
    /// `unit` is the value and `symbol` the symbol of the other quantity.
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

    /// Returns the label of the axis: the name, the symbol and, in brackets, the unit. The unit has
    /// the SI prefix that suits the range of the axis; see [`Self::prefix`].
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

    /// Returns the label of the axis. If the full label would be wider than `most` times the font
    /// size, the label consists of the symbol and the unit, or of the name and the unit if there is
    /// no symbol.
    pub(super) fn label_within(&self, most: f64) -> Label {
        let label = self.label_with_unit();
        if label.width() <= most {
            label
        } else {
            self.symbol_with_unit()
        }
    }

    /// Returns a short label of the axis: the symbol and, in brackets, the unit. An axis without a
    /// symbol has its name instead.
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

    /// Returns the ticks of the axis. About `most` ticks have a number. The minor ticks between
    /// them have no number. An axis with names has one tick at each name.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        if !self.names.is_empty() {
            let named = self.names.iter().enumerate().map(|(index, name)| Tick {
                at: index as f64,
                label: Some(name.clone()),
            });
            return named.collect();
        }
        // A single number does not show the scale. Therefore up to two more ticks are requested,
        // until at least two ticks have a number.
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

/// Horizontal and vertical position in a chart. Each number is a share of the axis, from 0 at the
/// left or lower end to 1 at the right or upper end.
pub(super) type Share = (f64, f64);

#[derive(Clone, Copy)]
pub(super) struct Axes<'a> {
    pub x: &'a ChartAxis,
    pub y: &'a ChartAxis,
}

impl Axes<'_> {
    /// Returns the position of a point (x, y) in the chart. A point outside the chart gets the
    /// nearest position on the border. Returns `None` if x or y has no coordinate. For example, 0
    /// has no coordinate on a logarithmic axis.
    pub(super) fn place(self, point: (f64, f64)) -> Option<Share> {
        let (_, y) = point;
        if !self.y.share(y).is_finite() {
            return None;
        }
        self.place_at_end(point)
    }

    /// Returns the position of a point (x, y) in the chart. If y has no coordinate, the position is
    /// at the end of the vertical axis. Returns `None` if x has no coordinate. For example, 0 has
    /// no coordinate on a logarithmic axis.
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

    /// Returns the positions of points, divided into groups of successive points. A point without a
    /// position, such as 0 on a logarithmic axis, ends a group.
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

    /// Returns the positions along a line that passes through the lowest and the highest point of
    /// each column. In each column, the line first goes to the point that is nearer to the end of
    /// the line in the previous column. A column outside the chart begins a new list of positions.
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

    /// Returns the two ends of a straight line across the chart: a vertical line at x = `number` if
    /// `is_vertical` is true, otherwise a horizontal line at y = `number`. Returns `None` if the
    /// line lies outside the chart.
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
