//! Figure of a study as numbers and names, without any drawing: a map over two axes or a section along one.

use super::axis::Axis;
use super::plan::Plan;
use super::quantity::Quantity;
use super::target::symbol_and_unit;
use crate::analysis::{Regime, VANISHING_SHARE};
pub use crate::draw::AxisScale;
use crate::scene::{Move, RoughnessParameter, field, format_quantity};

/// Smallest ratio of the values on a logarithmic scale.
const LOGARITHMIC_RATIO: f64 = 50.0;

/// An axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureAxis {
    /// Technical name: `Hurst exponent`.
    pub name: String,
    /// Symbol, with `_` before an index: `F_n`. May be empty.
    pub symbol: String,
    /// SI unit; `1` or empty for numbers without one.
    pub unit: String,
    /// Scale of the values.
    pub scale: AxisScale,
    /// Values in SI units, ascending.
    pub values: Vec<f64>,
}

impl FigureAxis {
    /// An axis of a plan with its values in ascending order.
    pub(super) fn new(plan: &Plan, axis: &Axis) -> FigureAxis {
        let path = axis.path();
        let values: Vec<f64> = axis.ascending().into_iter().map(|place| axis.value(place)).collect();
        let ends = values.first().copied().zip(values.last().copied());
        let wide = ends.is_some_and(|(low, high)| low > 0.0 && high >= LOGARITHMIC_RATIO * low);
        let list = matches!(axis, Axis::List { .. });
        let logarithmic = axis.is_logarithmic() || list && wide;
        let (symbol, unit) = symbol_and_unit(path);
        let leg =
            path.strip_prefix("loading.").and_then(|rest| rest.strip_suffix(".0")?.parse::<usize>().ok());
        let (name, unit) = match (path, leg.and_then(|leg| plan.scene.loading.get(leg).zip(Some(leg + 1)))) {
            (_, Some((Move::ToIndentation(_), leg))) => (format!("indentation of leg {leg}"), "m"),
            (_, Some((_, leg))) => (format!("force of leg {leg}"), "N"),
            ("kappa" | "adhesion.kappa", _) => ("governing parameter".into(), unit),
            ("elastic_energy_ratio", _) => ("elastic energy ratio".into(), unit),
            ("springs_per_wave", _) => ("springs per wave".into(), unit),
            ("roughness.modes.0", _) => ("first mode".into(), unit),
            ("roughness.modes.1", _) => ("last mode".into(), unit),
            _ => (field(path, None).map_or(path, |field| field.name).to_owned(), unit),
        };
        FigureAxis {
            name,
            symbol: symbol.into(),
            unit: unit.into(),
            scale: if logarithmic { AxisScale::Logarithmic } else { AxisScale::Linear },
            values,
        }
    }

    /// Coordinates of the values.
    #[must_use]
    pub fn coordinates(&self) -> Vec<f64> {
        self.values.iter().map(|value| self.scale.coordinate(*value)).collect()
    }

    /// Place of a number among the values, the first at 0: linear between two values, extrapolated by the last
    /// distance beyond the ends.
    #[must_use]
    pub fn place(&self, number: f64) -> f64 {
        self.scale.place(&self.values, number)
    }
}

/// A shown quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureQuantity {
    /// Technical name.
    pub name: String,
    /// Symbol, as in [`FigureAxis::symbol`].
    pub symbol: String,
    /// SI unit, as in [`FigureAxis::unit`].
    pub unit: String,
    /// Returns true for a quantity that may be negative.
    pub signed: bool,
}

impl From<Quantity> for FigureQuantity {
    fn from(quantity: Quantity) -> Self {
        FigureQuantity {
            name: in_words(quantity.name()),
            symbol: quantity.symbol().into(),
            unit: quantity.unit().into(),
            signed: quantity.is_signed(),
        }
    }
}

/// Name of a column in words.
fn in_words(column: &str) -> String {
    let hyphenated = [("zero load", "zero-load"), ("zero force", "zero-force"), ("pull off", "pull-off")];
    hyphenated.iter().fold(column.replace('_', " "), |name, (words, word)| name.replace(words, word))
}

/// A mean over random profiles with its confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Lower end of the 95 % confidence interval of the mean.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// One quantity in all cells; `None` in cells that are missing or do not have it. In a map row by row, the row of
/// the first value of the axis up first; in a section curve by curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Quantity of the panel.
    pub quantity: FigureQuantity,
    /// Values in all cells.
    pub estimates: Vec<Option<Estimate>>,
    /// Scale of the values.
    pub scale: AxisScale,
    /// Common range of several figures; `None` for the range of the values.
    pub range: Option<(f64, f64)>,
    /// True for F_a(0)/F_a,max by either protocol, which has a boundary of its own.
    pub vanishes: bool,
}

/// Boundary of vanishing zero-load adhesion: the values fall through the level.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// F_a(0) in all cells, in the order of [`Panel::estimates`].
    pub values: Vec<Option<f64>>,
    /// Level below which adhesion has vanished.
    pub level: f64,
    /// Label of the line: `F_a(0) = 0.05 F_a,max`.
    pub label: String,
}

impl Boundary {
    /// The boundary by F_a(0)/F_a,max in all cells.
    #[must_use]
    pub fn new(shares: &[Option<Estimate>]) -> Self {
        Boundary {
            values: shares.iter().map(|estimate| Some((*estimate)?.mean)).collect(),
            level: VANISHING_SHARE,
            label: format!("F_a(0) = {VANISHING_SHARE} F_a,max"),
        }
    }
}

impl Panel {
    /// A quantity in all cells.
    pub(super) fn new(quantity: Quantity, estimates: Vec<Option<Estimate>>, scale: AxisScale) -> Self {
        let vanishes = Quantity::ADHESION_SHARES.contains(&quantity);
        Panel { quantity: quantity.into(), estimates, scale, range: None, vanishes }
    }
}

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// One line above the figure; may be empty.
    pub title: String,
    /// Fixed axes, as `H = 0.3`.
    pub fixed: Vec<String>,
    /// The axis across.
    pub across: FigureAxis,
    /// The axis up; a section has none.
    pub up: Option<FigureAxis>,
    /// The axis of several curves of a section, one for each value.
    pub series: Option<FigureAxis>,
    /// Panels, side by side.
    pub panels: Vec<Panel>,
    /// Boundary of vanishing zero-load adhesion; `None` where not recorded.
    pub boundary: Option<Boundary>,
    /// The regime of most profiles of each cell, where known; empty otherwise.
    pub regimes: Vec<Option<Regime>>,
}

impl Figure {
    /// The boundary on a panel: that of the panel's own F_a(0) where the panel shows it.
    #[must_use]
    pub fn boundary_of(&self, panel: &Panel) -> Option<Boundary> {
        let boundary = self.boundary.clone()?;
        let own = || panel.estimates.iter().map(|estimate| estimate.map(|estimate| estimate.mean));
        Some(if panel.vanishes { Boundary { values: own().collect(), ..boundary } } else { boundary })
    }

    /// Points on the axis across, in its coordinates, where a section crosses the boundary.
    #[must_use]
    pub fn crossings(&self, panel: &Panel) -> Vec<f64> {
        if self.up.is_some() {
            return Vec::new();
        }
        let Some(boundary) = self.boundary_of(panel) else { return Vec::new() };
        let places = self.across.coordinates();
        // At zero load all curves are equal; curves that differ have no single crossing.
        let mut curves = boundary.values.chunks(places.len().max(1));
        let first = curves.next();
        if curves.any(|curve| Some(curve) != first) {
            return Vec::new();
        }
        let ends = places.windows(2).zip(first.unwrap_or_default().windows(2));
        ends.filter_map(|(x, value)| {
            let (first, second) = (value[0]? - boundary.level, value[1]? - boundary.level);
            let crosses = (first < 0.0) != (second < 0.0);
            crosses.then(|| x[0] + (x[1] - x[0]) * first / (first - second))
        })
        .collect()
    }
}

/// An axis at one of its values, for readers: `H = 0.3`.
pub(super) fn fixed(plan: &Plan, axis: &Axis, place: u64) -> String {
    let FigureAxis { name, symbol, unit, .. } = FigureAxis::new(plan, axis);
    let value = format_quantity(axis.value(place), &unit);
    if symbol.is_empty() { format!("{name} {value}") } else { format!("{symbol} = {value}") }
}

/// Axes across and up, as places among the axes of a study: H goes across and κ or e_el/γ up; of other free axes the
/// first goes across. `None` without a free axis.
pub(super) fn across_and_up(axes: &[&Axis], free: &[usize]) -> Option<(usize, Option<usize>)> {
    let find = |wanted: &dyn Fn(&str) -> bool| free.iter().copied().find(|axis| wanted(axes[*axis].path()));
    let other = |one: Option<usize>| free.iter().copied().find(|axis| Some(*axis) != one);
    let up = find(&|path| RoughnessParameter::named(path).is_some());
    let across = find(&|path| path == "roughness.hurst").or(other(up)).or(up)?;
    Some((across, up.filter(|up| *up != across).or(other(Some(across)))))
}

/// Least and largest mean that a scale shows.
pub(super) fn range_of(estimates: &[Option<Estimate>], scale: AxisScale) -> Option<(f64, f64)> {
    let means = estimates.iter().flatten().map(|estimate| estimate.mean);
    let shown = means.filter(|mean| scale.coordinate(*mean).is_finite());
    shown.map(|mean| (mean, mean)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Logarithmic scale where all means are above zero and half of them below a fiftieth of the largest.
pub(super) fn scale_of(estimates: &[Option<Estimate>]) -> AxisScale {
    let means: Vec<f64> = estimates.iter().flatten().map(|estimate| estimate.mean).collect();
    let largest = means.iter().copied().fold(0.0, f64::max);
    let small = means.iter().filter(|mean| **mean < largest / LOGARITHMIC_RATIO).count();
    let wide = means.iter().all(|mean| *mean > 0.0) && 2 * small >= means.len().max(1);
    if wide { AxisScale::Logarithmic } else { AxisScale::Linear }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_place_among_the_values() {
        let axis = |scale, values: &[f64]| FigureAxis {
            name: String::new(),
            symbol: String::new(),
            unit: String::new(),
            scale,
            values: values.to_vec(),
        };
        let linear = axis(AxisScale::Linear, &[1.0, 2.0, 6.0]);
        for (number, place) in
            [(1.0, 0.0), (1.5, 0.5), (2.0, 1.0), (4.0, 1.5), (6.0, 2.0), (10.0, 3.0), (0.0, -1.0)]
        {
            assert_eq!(linear.place(number), place, "{number}");
        }
        let decades = axis(AxisScale::Logarithmic, &[0.1, 1.0, 10.0]);
        assert!((decades.place(10_f64.sqrt()) - 1.5).abs() < 1e-12);
        assert_eq!((decades.place(100.0), decades.place(0.0)), (3.0, f64::NEG_INFINITY));
        assert_eq!(axis(AxisScale::Linear, &[3.0]).place(7.0), 0.0);
        assert_eq!(axis(AxisScale::Linear, &[]).place(7.0), 0.0);
    }
}
