//! Selection of a figure from a merged study: quantities, axes across and up, values of the other axes.

use super::axis::Axis;
use super::figure::{
    AxisScale, Boundary, Estimate, Figure, FigureAxis, Panel, across_and_up, fixed, range_of, scale_of,
};
use super::finished::Finished;
use super::plan::Plan;
use super::quantity::Quantity;
use crate::scene::parse_quantity;
use thiserror::Error;

/// Most values of a second axis that makes curves of a section rather than rows of a map.
const MOST_CURVES: usize = 5;
/// F_a(0)/F_a,max by the two protocols.
const SHARES: [Quantity; 2] = Quantity::ADHESION_SHARES;
/// Most values named in a message.
const MOST_NAMED: usize = 12;

/// Selection by the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Names of quantities; if empty, F_a(0) and the adhesion coefficient if they were recorded, or F_a(0) by both
    /// protocols, else the first recorded one.
    pub quantities: Vec<String>,
    /// Path of the axis across.
    pub across: Option<String>,
    /// Path of the axis up.
    pub up: Option<String>,
    /// Fixed axes, with their values.
    pub at: Vec<(String, String)>,
    /// Scale of the quantities; by default, a map or several curves are logarithmic if a linear scale
    /// would show little but its lowest end.
    pub scale: Option<AxisScale>,
}

/// Reason why the figure cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FigureError {
    /// The study has no such quantity.
    #[error("--quantity {name}: this study has no such quantity; allowed: {allowed}")]
    NoQuantity {
        /// The given name.
        name: String,
        /// Quantities of the study.
        allowed: String,
    },
    /// The study has no such axis.
    #[error("{option} {path}: this study has no such axis; allowed: {allowed}")]
    NoAxis {
        /// Name of the option.
        option: &'static str,
        /// Path that was given.
        path: String,
        /// Axes of the study.
        allowed: String,
    },
    /// The axis has no such value.
    #[error("--at {path}={value}: the study has no such value; allowed: {allowed}")]
    NoValue {
        /// The axis.
        path: String,
        /// The value.
        value: String,
        /// Values of the axis.
        allowed: String,
    },
    /// An axis is selected twice.
    #[error("{path}: named by {one} and by {other}; allowed: one of them")]
    Twice {
        /// The axis.
        path: String,
        /// An option.
        one: &'static str,
        /// Another.
        other: &'static str,
    },
    /// More free axes than a figure has.
    #[error("{} axes are free: {}; a figure has two. Fix {}, such as {example}", free.len(), free.join(", "), if free.len() == 3 { "one of them" } else { "the others" })]
    TooManyAxes {
        /// The axes, each with its values.
        free: Vec<String>,
        /// Example of an option that fixes an axis.
        example: String,
    },
    /// All axes are fixed or have one value.
    #[error(
        "no axis is free: the study has one cell{fixed}; a section needs an axis with two values at least"
    )]
    NoAxes {
        /// Cause, in the wording of the message.
        fixed: &'static str,
    },
}

/// An axis of the study and its use.
struct Chosen<'a> {
    axis: &'a Axis,
    /// The place at which the axis is fixed.
    at: Option<u64>,
}

impl Selection {
    /// The figure of a study.
    ///
    /// # Errors
    /// Unknown quantity, axis or value, with those that the study has; more than two free axes.
    pub fn figure(&self, study: &Finished) -> Result<Figure, FigureError> {
        let plan = study.plan();
        let quantities = self.quantities(plan)?;
        let chosen = self.chosen(plan)?;
        let (across, second) = self.free(&chosen)?;
        let few = |index: usize| chosen[index].axis.count() as usize <= MOST_CURVES;
        // Curves lie along the longer axis, unless the axis across was given.
        let turned =
            |second: &usize| self.across.is_none() && self.up.is_none() && few(across) && !few(*second);
        let (across, second) = match second.filter(turned) {
            Some(second) => (second, Some(across)),
            None => (across, second),
        };
        let series = second.filter(|&second| self.up.is_none() && few(second) && !few(across));
        let places = chosen.iter().map(|one| one.at.unwrap_or(0)).collect();
        let cells = study.grid(across, second, places);
        let is_map = second.is_some() && series.is_none();
        let estimates = |quantity: Quantity| -> Vec<Option<Estimate>> {
            let column = study.column(quantity);
            cells.iter().map(|cell| cell.as_ref()?.estimate(column?)).collect()
        };
        let axis = |index: usize| FigureAxis::new(plan, chosen[index].axis);
        let fixed = chosen.iter().filter_map(|one| Some(fixed(plan, one.axis, one.at?)));
        let panel = |&quantity: &Quantity| {
            let estimates = estimates(quantity);
            if is_map {
                // All maps of a study have one scale, whatever the values of the other axes.
                let all = study.column(quantity).map(|column| study.estimates(column)).unwrap_or_default();
                let scale = self.scale.unwrap_or_else(|| scale_of(&all));
                return Panel { range: range_of(&all, scale), ..Panel::new(quantity, estimates, scale) };
            }
            // A single curve has an inset for its small values; of several the highest would hide the others.
            let mut curves = estimates.chunks(chosen[across].axis.count().max(1) as usize);
            let first = curves.next();
            let several = curves.any(|curve| Some(curve) != first);
            let by_itself = || if several { scale_of(&estimates) } else { AxisScale::Linear };
            let scale = self.scale.unwrap_or_else(by_itself);
            Panel::new(quantity, estimates, scale)
        };
        let mut panels: Vec<Panel> = quantities.iter().map(panel).collect();
        // The same quantity by two protocols has one scale.
        let shares = || quantities.iter().all(|quantity| SHARES.contains(quantity));
        if shares() && panels.iter().any(|panel: &Panel| panel.scale == AxisScale::Logarithmic) {
            panels.iter_mut().for_each(|panel| panel.scale = AxisScale::Logarithmic);
        }
        let boundary = SHARES.into_iter().find(|quantity| plan.record.contains(quantity));
        Ok(Figure {
            title: plan.title.clone(),
            fixed: fixed.collect(),
            across: axis(across),
            up: second.filter(|_| series.is_none()).map(axis),
            series: series.map(axis),
            panels,
            boundary: boundary.map(|quantity| Boundary::new(&estimates(quantity))),
            regimes: if series.is_some() || !plan.record.contains(&Quantity::Regime) {
                Vec::new()
            } else {
                cells.iter().map(|cell| Some((*cell)?.regime()?.regime)).collect()
            },
        })
    }

    fn quantities(&self, plan: &Plan) -> Result<Vec<Quantity>, FigureError> {
        let drawn = |quantity: &Quantity| *quantity != Quantity::Regime;
        let allowed = || {
            let names = plan.record.iter().filter(|one| drawn(one)).map(|one| one.name());
            names.collect::<Vec<_>>().join(", ")
        };
        if self.quantities.is_empty() {
            let paper = [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient];
            let recorded = |one: &Quantity| plan.record.contains(one);
            // Without a preload there is no coefficient, and both protocols are side by side.
            let usual = if recorded(&paper[1]) { paper } else { SHARES };
            let mut all: Vec<_> = usual.into_iter().filter(recorded).collect();
            if all.is_empty() {
                all.extend(plan.record.iter().copied().find(drawn));
            }
            let none = || FigureError::NoQuantity {
                name: "regime".into(),
                allowed: "none, only regimes were recorded".into(),
            };
            return if all.is_empty() { Err(none()) } else { Ok(all) };
        }
        let named = |name: &String| {
            let found = plan.record.iter().copied().filter(drawn).find(|one| one.name() == name);
            found.ok_or_else(|| FigureError::NoQuantity { name: name.clone(), allowed: allowed() })
        };
        self.quantities.iter().map(named).collect()
    }

    /// The axes of the study, those with one value and those of `at` fixed.
    fn chosen<'a>(&self, plan: &'a Plan) -> Result<Vec<Chosen<'a>>, FigureError> {
        let only = |axis: &Axis| (axis.count() == 1).then_some(0);
        let mut chosen: Vec<_> =
            plan.all_axes().into_iter().map(|axis| Chosen { axis, at: only(axis) }).collect();
        let mut named: Vec<&str> = Vec::new();
        for (path, value) in &self.at {
            let index = find(&chosen, path, "--at")?;
            if named.contains(&path.as_str()) {
                return Err(FigureError::Twice { path: path.clone(), one: "--at", other: "--at" });
            }
            named.push(path);
            let axis = chosen[index].axis;
            let unit = FigureAxis::new(plan, axis).unit;
            let wanted = parse_quantity(value, &unit).ok();
            // Values are written with 12 digits, and 0.3 is typed for them.
            let same = |there: f64| wanted.is_some_and(|wanted| (there - wanted).abs() <= 1e-9 * there.abs());
            let place = (0..axis.count()).find(|&place| same(axis.value(place)));
            chosen[index].at = Some(place.ok_or_else(|| FigureError::NoValue {
                path: path.clone(),
                value: value.clone(),
                allowed: values_of(axis),
            })?);
        }
        Ok(chosen)
    }

    /// The axis across, and the second one if there is one.
    fn free(&self, chosen: &[Chosen<'_>]) -> Result<(usize, Option<usize>), FigureError> {
        let named = |path: &Option<String>, option: &'static str| {
            let Some(path) = path else { return Ok(None) };
            let index = find(chosen, path, option)?;
            if self.at.iter().any(|(fixed, _)| fixed == path) {
                return Err(FigureError::Twice { path: path.clone(), one: option, other: "--at" });
            }
            Ok(Some(index))
        };
        let (across, up) = (named(&self.across, "--x")?, named(&self.up, "--y")?);
        if let (Some(across), true) = (across, across == up) {
            let path = chosen[across].axis.path().to_owned();
            return Err(FigureError::Twice { path, one: "--x", other: "--y" });
        }
        let is_named = |index: &usize| Some(*index) == across || Some(*index) == up;
        let free: Vec<usize> =
            (0..chosen.len()).filter(|index| chosen[*index].at.is_none() || is_named(index)).collect();
        let rest: Vec<usize> = free.iter().copied().filter(|index| !is_named(index)).collect();
        let result = match (across, up, rest.as_slice()) {
            (Some(across), up, []) => (across, up),
            (Some(across), None, [second]) => (across, Some(*second)),
            (None, Some(up), [across]) => (*across, Some(up)),
            // Only one axis, and named to go up.
            (None, Some(only), []) => (only, None),
            (None, None, free @ ([] | [_] | [_, _])) => {
                let axes: Vec<&Axis> = chosen.iter().map(|one| one.axis).collect();
                let fixed = if self.at.is_empty() { "" } else { " left by --at" };
                across_and_up(&axes, free).ok_or(FigureError::NoAxes { fixed })?
            }
            _ => {
                let shortest = rest.iter().min_by_key(|index| chosen[**index].axis.count());
                let example = shortest.map_or_else(String::new, |&index| {
                    let axis = chosen[index].axis;
                    format!("--at {}={}", axis.path(), axis.value(0))
                });
                let said = |index: &usize| {
                    let axis = chosen[*index].axis;
                    format!("{} ({})", axis.path(), values_of(axis))
                };
                return Err(FigureError::TooManyAxes { free: free.iter().map(said).collect(), example });
            }
        };
        Ok(result)
    }
}

fn find(chosen: &[Chosen<'_>], path: &str, option: &'static str) -> Result<usize, FigureError> {
    chosen.iter().position(|one| one.axis.path() == path).ok_or_else(|| {
        let all: Vec<_> = chosen.iter().map(|one| one.axis.path()).collect();
        let allowed = if all.is_empty() { "none, it has one cell".into() } else { all.join(", ") };
        FigureError::NoAxis { option, path: path.into(), allowed }
    })
}

fn values_of(axis: &Axis) -> String {
    let values: Vec<_> = axis.values().into_iter().map(|value| value.to_string()).collect();
    if values.len() <= MOST_NAMED {
        return values.join(", ");
    }
    let (first, last) = (&values[..MOST_NAMED - 1], &values[values.len() - 1]);
    format!("{}, … {last}", first.join(", "))
}
