//! Axes and scales of figures and maps, from the axes of a plan and the values of quantities.

use super::axis::Axis;
use super::figure::{AxisScale, Estimate, FigureAxis};
use super::plan::Plan;
use super::target::symbol_and_unit;
use crate::scene::{Leg, field, format_quantity};

/// Ratio of values from which on a scale is logarithmic.
const LOGARITHMIC_RATIO: f64 = 50.0;
/// An axis at one of its values, as people read it: `H = 0.3`.
pub(super) fn fixed(plan: &Plan, axis: &Axis, place: u64) -> String {
    let FigureAxis { name, symbol, unit, .. } = figure_axis(plan, axis);
    let value = format_quantity(axis.value(place), &unit);
    if symbol.is_empty() { format!("{name} {value}") } else { format!("{symbol} = {value}") }
}

/// An axis of a plan with its values in ascending order.
pub(super) fn figure_axis(plan: &Plan, axis: &Axis) -> FigureAxis {
    let path = axis.path();
    let values: Vec<f64> = axis.ascending().into_iter().map(|place| axis.value(place)).collect();
    let ends = values.first().copied().zip(values.last().copied());
    let wide = ends.is_some_and(|(low, high)| low > 0.0 && high >= LOGARITHMIC_RATIO * low);
    let list = matches!(axis, Axis::List { .. });
    let logarithmic = axis.is_logarithmic() || list && wide;
    let (symbol, unit) = symbol_and_unit(path);
    let leg = path.strip_prefix("loading.").and_then(|rest| rest.strip_suffix(".0")?.parse::<usize>().ok());
    let (name, unit) = match (path, leg.and_then(|leg| plan.scene.loading.get(leg).zip(Some(leg + 1)))) {
        (_, Some((Leg::ToIndentation(_), leg))) => (format!("indentation of leg {leg}"), "m"),
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

/// Logarithmic where all means are above zero and half of them below a fiftieth of the largest.
pub(super) fn scale_of(estimates: &[Option<Estimate>]) -> AxisScale {
    let means: Vec<f64> = estimates.iter().flatten().map(|estimate| estimate.mean).collect();
    let largest = means.iter().copied().fold(0.0, f64::max);
    let small = means.iter().filter(|mean| **mean < largest / LOGARITHMIC_RATIO).count();
    let wide = means.iter().all(|mean| *mean > 0.0) && 2 * small >= means.len().max(1);
    if wide { AxisScale::Logarithmic } else { AxisScale::Linear }
}
