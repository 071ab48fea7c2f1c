//! Axes: scale, range, label and unit.

use super::label::{Label, prefixed};
use super::scale::Span;
use super::ticks::{Tick, are_plain, ticks};
use asperity_data::AxisScale;

/// Smallest and largest value of the largest number on a linear axis for which the numbers at the
/// ticks have few digits.
const SHORT: (f64, f64) = (1e-3, 1e6);

/// Axis of a chart: a quantity with name, symbol and unit, and the scale and range of the numbers
/// that the axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxis {
    /// Scale of the axis, linear or logarithmic.
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
    /// Creates an axis of a quantity with this name, symbol and SI unit.
    pub fn new(scale: AxisScale, span: Span, name: &str, symbol: &str, unit: &str) -> ChartAxis {
        let [name, symbol, unit] = [name, symbol, unit].map(str::to_owned);
        ChartAxis {
            scale,
            span,
            name,
            symbol,
            unit,
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
        let ends = self.span.bounds().map(|end| self.scale.number(end).abs());
        let largest = ends[0].max(ends[1]);
        if self.scale == AxisScale::Logarithmic {
            let largest = (0..6).map(|thousands| largest / 1000_f64.powi(thousands));
            let prefixes = largest.map(|largest| prefixed(&self.unit, largest));
            let is_plain = |(divisor, _): &(f64, String)| are_plain(self.span, *divisor);
            return prefixes
                .into_iter()
                .find(is_plain)
                .unwrap_or_else(|| (1.0, prefixed(&self.unit, 1.0).1));
        }
        let (divisor, unit) = prefixed(&self.unit, largest);
        let is_short = (SHORT.0..SHORT.1).contains(&(largest / divisor));
        if is_short || !largest.is_normal() {
            return (divisor, unit);
        }
        let power = 3 * (largest.log10() / 3.0).floor() as i32;
        (
            10_f64.powi(power),
            format!("{} {unit}", Label::power_of_ten(power))
                .trim_end()
                .to_owned(),
        )
    }

    /// Returns the axis with its numbers divided by a unit with this symbol.
    pub(super) fn over(&self, unit: f64, symbol: &str) -> ChartAxis {
        let end = |at: f64| self.scale.coordinate(self.scale.number(at) / unit);
        let span = Span {
            low: end(self.span.low),
            high: end(self.span.high),
        };
        ChartAxis {
            span,
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

    /// Returns the symbol of the quantity, or the name if the quantity has no symbol.
    pub fn symbol_or_name(&self) -> Label {
        Label::symbol_or_name(&self.symbol, &self.name)
    }

    fn with_unit(&self, label: Label) -> Label {
        match self.prefix().1 {
            unit if unit.is_empty() => label,
            unit => label.then(&format!(" ({unit})")),
        }
    }

    /// Returns the ticks of the axis: about `most` ticks with a number, and minor ticks without a
    /// number between them. An axis with names has a tick at each name.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        if !self.names.is_empty() {
            let tick = |(at, name): (usize, &Label)| Tick {
                at: at as f64,
                label: Some(name.clone()),
            };
            return self.names.iter().enumerate().map(tick).collect();
        }
        let least = if self.counts { 1.0 } else { 0.0 };
        let of = |most| ticks(self.scale, self.span, self.prefix().0, most, least);
        let two = |ticks: &Vec<Tick>| {
            ticks
                .iter()
                .filter(|tick| tick.label.is_some())
                .nth(1)
                .is_some()
        };
        (most..=most + 2)
            .map(of)
            .find(two)
            .unwrap_or_else(|| of(most))
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
    pub(super) fn place(self, (x, y): (f64, f64)) -> Option<Share> {
        self.y
            .share(y)
            .is_finite()
            .then(|| self.place_at_end((x, y)))
            .flatten()
    }

    /// Returns the position of a point. A y without a coordinate is placed at the end of the axis.
    pub(super) fn place_at_end(self, (x, y): (f64, f64)) -> Option<Share> {
        let (x, y) = (self.x.share(x), self.y.share(y));
        x.is_finite().then(|| {
            (
                x.clamp(0.0, 1.0),
                if y.is_nan() { 0.0 } else { y.clamp(0.0, 1.0) },
            )
        })
    }

    /// Returns the positions of points, divided into runs where a point has no coordinates.
    pub(super) fn runs(self, points: impl Iterator<Item = (f64, f64)>) -> Vec<Vec<Share>> {
        let places: Vec<Option<Share>> = points.map(|point| self.place(point)).collect();
        let runs = places
            .split(Option::is_none)
            .map(|run| run.iter().flatten().copied().collect());
        runs.filter(|run: &Vec<Share>| !run.is_empty()).collect()
    }

    /// Returns the positions along an envelope through both ends of each column, beginning with the
    /// end nearer to the previous point. A column outside the chart begins a new run.
    pub(super) fn envelope(
        self,
        (from, to): (f64, f64),
        columns: &[Option<(f64, f64)>],
    ) -> Vec<Vec<Share>> {
        let mut last: Option<f64> = None;
        let points = columns.iter().enumerate().flat_map(|(column, ends)| {
            let inside =
                ends.filter(|(low, high)| self.y.share(*high) >= 0.0 && self.y.share(*low) <= 1.0);
            let (low, high) = inside.unwrap_or((f64::NAN, f64::NAN));
            let falls = last.is_some_and(|last| (last - high).abs() < (last - low).abs());
            let ends = if falls { [high, low] } else { [low, high] };
            last = Some(ends[1]).filter(|end| end.is_finite());
            let middle = from + (to - from) * (column as f64 + 0.5) / columns.len() as f64;
            ends.map(|end| (middle, end))
        });
        self.runs(points)
    }

    /// Returns the ends of a vertical (`upright`) or horizontal line across the chart; `None` if
    /// the line lies outside.
    pub(super) fn guide(self, at: f64, upright: bool) -> Option<[Share; 2]> {
        let share = if upright {
            self.x.share(at)
        } else {
            self.y.share(at)
        };
        let ends = if upright {
            [(share, 0.0), (share, 1.0)]
        } else {
            [(0.0, share), (1.0, share)]
        };
        (0.0..=1.0).contains(&share).then_some(ends)
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
