//! The selection of a figure from a merged study: quantities, axes, and values of the fixed axes.

use super::axis::Axis;
use super::error::StudyError;
use super::grid::{Grid, GridLayer, across_and_up, scale_of};
use super::plan::Plan;
use super::quantity::Quantity;
use super::results::Results;
use asperity_data::{AxisScale, format_quantity, parse_quantity};

/// Largest number of values of a second axis that is shown as curves. With more values the figure
/// is a map.
const MOST_CURVES: usize = 5;
const MOST_NAMED: usize = 12;

/// Choice of the quantities, axes and values of a study that a figure shows. Each field is an
/// option of `asperity sweep plot`.
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Quantity of each panel; default: F_a(d=0)/F_a,max and F_a/F_n
    ///
    /// If the study did not record F_a/F_n, the default is F_a(d=0)/F_a,max and
    /// F_a(F=0)/F_a,max. Of each pair, only recorded quantities are drawn. If none is recorded,
    /// the first recorded quantity is drawn.
    #[cfg_attr(
        feature = "clap",
        arg(long = "quantity", value_name = "NAME", verbatim_doc_comment)
    )]
    pub quantities: Vec<String>,
    /// Horizontal axis of the charts: one of the axes of the study
    #[cfg_attr(feature = "clap", arg(long = "x", value_name = "AXIS"))]
    pub across: Option<String>,
    /// Vertical axis of the maps: one of the axes of the study
    #[cfg_attr(feature = "clap", arg(long = "y", value_name = "AXIS"))]
    pub up: Option<String>,
    /// Fix an axis at one of its values; repeat for further axes
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXIS=VALUE", value_parser = axis_and_value))]
    pub at: Vec<(String, String)>,
    /// Scale of the quantities
    ///
    /// By default the range of the values decides; small values have a second, logarithmic chart.
    #[cfg_attr(feature = "clap", arg(long, value_enum))]
    pub scale: Option<AxisScale>,
}

#[cfg(feature = "clap")]
fn axis_and_value(text: &str) -> Result<(String, String), String> {
    let parts = text
        .split_once('=')
        .map(|(axis, value)| (axis.trim(), value.trim()));
    let parts = parts.filter(|(axis, value)| !axis.is_empty() && !value.is_empty());
    let owned = parts.map(|(axis, value)| (axis.to_owned(), value.to_owned()));
    owned.ok_or_else(|| "allowed: AXIS=VALUE, such as roughness.hurst=0.3".into())
}

/// Part of a study that a [`Selection`] has chosen for a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Selected {
    /// Results of the chosen part of the study, over one or two axes of the study.
    pub grid: Grid,
    /// Quantities that the figure shows, one in each panel.
    pub quantities: Vec<Quantity>,
    /// True if the figure shows the rows of a grid with two axes as curves over the horizontal
    /// axis.
    pub curves: bool,
    /// Sentence that states the preload of the figure, if the study has several preloads and the
    /// figure shows the first one because the user chose none; otherwise `None`.
    pub note: Option<String>,
}

/// Indices of the axes that the user named as horizontal and vertical, and for each axis of the
/// study the index of its fixed value.
type Chosen = ([Option<usize>; 2], Vec<Option<usize>>);

impl Selection {
    /// Returns the part of a study that the fields of this selection choose.
    ///
    /// # Errors
    /// Returns an error if the study lacks a chosen quantity, axis or value. It is also an error
    /// if, apart from the axis of preloads, more than two axes have several values and are not
    /// fixed by [`Selection::at`].
    pub fn of(&self, study: &Results) -> Result<Selected, StudyError> {
        let plan = study.plan();
        let quantities = self.quantities(plan)?;
        let (named, mut at) = self.axes(&plan.axes)?;
        let note = first_preload(&plan.axes, named, &mut at);
        let (across, second) = self.free(&plan.axes, named, &at)?;
        let curves =
            self.up.is_none() && second.is_some_and(|second| is_few(&plan.axes, second, across));
        let places = at.iter().map(|place| place.unwrap_or(0)).collect();
        let mut grid = study.grid((across, second), places, study.layers());
        let is_map = second.is_some() && !curves;
        let layer = |quantity, scale: Option<AxisScale>| match is_map {
            true => study.layer(quantity, scale),
            false => section_layer(&grid, quantity, scale),
        };
        // The same quantity by two protocols has one scale.
        let is_share = |quantity: &Quantity| Quantity::ADHESION_SHARES.contains(quantity);
        let is_logarithmic =
            |quantity: &Quantity| layer(*quantity, None).scale == AxisScale::Logarithmic;
        let both = quantities.iter().all(is_share) && quantities.iter().any(is_logarithmic);
        let scale = self.scale.or(both.then_some(AxisScale::Logarithmic));
        grid.layers = grid
            .layers
            .iter()
            .map(|one| layer(one.quantity, scale))
            .collect();
        Ok(Selected {
            grid,
            quantities,
            curves,
            note,
        })
    }

    fn quantities(&self, plan: &Plan) -> Result<Vec<Quantity>, StudyError> {
        let drawn = plan.record.iter().copied().filter(|one| !one.is_regime());
        let drawn: Vec<Quantity> = drawn.collect();
        let named = |name: &str| {
            drawn
                .iter()
                .copied()
                .find(|one| [one.name(), one.symbol()].contains(&name))
                .ok_or_else(|| {
                    let allowed = drawn
                        .iter()
                        .map(|one| one.name())
                        .collect::<Vec<_>>()
                        .join(", ");
                    let allowed = if drawn.is_empty() {
                        "none, only regimes were recorded"
                    } else {
                        &allowed
                    };
                    let place = format!("--quantity {name}");
                    StudyError::refused(Some(&place), "this study has no such quantity", allowed)
                })
        };
        if !self.quantities.is_empty() {
            return self.quantities.iter().map(|name| named(name)).collect();
        }
        let paper = [
            Quantity::FirstTouchAdhesionShare,
            Quantity::AdhesionCoefficient,
        ];
        // Without a preload there is no coefficient, and both protocols are side by side.
        let usual = if drawn.contains(&paper[1]) {
            paper
        } else {
            Quantity::ADHESION_SHARES
        };
        let usual: Vec<_> = usual
            .into_iter()
            .filter(|one| drawn.contains(one))
            .collect();
        let first = || named(drawn.first().map_or("regime", |one| one.name()));
        if usual.is_empty() {
            Ok(vec![first()?])
        } else {
            Ok(usual)
        }
    }

    /// Returns the named axes, which must exist and be named once. An axis with one value is fixed.
    fn axes(&self, axes: &[Axis]) -> Result<Chosen, StudyError> {
        let mut named: Vec<(usize, &str)> = Vec::new();
        let mut name = |path: &str, option| {
            let index = find(axes, path, option)?;
            if let Some((_, other)) = named.iter().find(|(known, _)| *known == index) {
                let found = format!("named by {other} and by {option}");
                return Err(StudyError::refused(Some(path), found, "one of them"));
            }
            named.push((index, option));
            Ok(index)
        };
        let across = self
            .across
            .as_ref()
            .map(|path| name(path, "--x"))
            .transpose()?;
        let up = self.up.as_ref().map(|path| name(path, "--y")).transpose()?;
        let mut fixed: Vec<_> = axes
            .iter()
            .map(|axis| (axis.values.len() == 1).then_some(0))
            .collect();
        for (path, value) in &self.at {
            let index = name(path, "--at")?;
            let axis = &axes[index];
            let wanted = parse_quantity(value, axis.unit).ok();
            // Messages have values of 4 digits: those may be typed, and mean the nearest value.
            let off = |there: &f64| wanted.map_or(f64::NAN, |wanted| (there - wanted).abs());
            let same = |there: &f64| off(there) <= 5e-4 * there.abs();
            let none = || {
                let place = format!("--at {path}={value}");
                StudyError::refused(Some(&place), "the study has no such value", values_of(axis))
            };
            let close = (0..axis.values.len()).filter(|place| same(&axis.values[*place]));
            let nearest =
                close.min_by(|a, b| off(&axis.values[*a]).total_cmp(&off(&axis.values[*b])));
            fixed[index] = Some(nearest.ok_or_else(none)?);
        }
        Ok(([across, up], fixed))
    }

    /// Returns the indices of the horizontal axis and, if there is one, of the second axis. Unless
    /// the user names them, H is horizontal and κ or e_el/γ vertical, or curves extend along the
    /// longer of two axes.
    fn free(
        &self,
        axes: &[Axis],
        named: [Option<usize>; 2],
        fixed: &[Option<usize>],
    ) -> Result<(usize, Option<usize>), StudyError> {
        let none_left = || {
            let found = "no axis is left to go across";
            StudyError::refused(None, found, "an axis with two values at least")
        };
        let is_named = |index: &usize| named.contains(&Some(*index));
        let rest: Vec<usize> = (0..axes.len())
            .filter(|index| fixed[*index].is_none() && !is_named(index))
            .collect();
        match (named, &rest[..]) {
            ([Some(across), up], []) => Ok((across, up)),
            ([Some(across), None], [second]) => Ok((across, Some(*second))),
            ([None, Some(up)], [across]) => Ok((*across, Some(up))),
            ([None, None], [_] | [_, _]) => {
                let (across, up) = across_and_up(axes, &rest).ok_or_else(none_left)?;
                let longer = up.filter(|up| is_few(axes, across, *up));
                Ok(longer.map_or((across, up), |longer| (longer, Some(across))))
            }
            (_, []) => Err(none_left()),
            _ => {
                let all: Vec<String> = rest
                    .iter()
                    .map(|index| format!("{} ({})", axes[*index].path, values_of(&axes[*index])))
                    .collect();
                let example = &axes[rest[0]];
                let found = format!("too many axes are free for a figure: {}", all.join(", "));
                let value = format_quantity(example.values[0], example.unit).replace(' ', "");
                let allowed = format!(
                    "two, named by --x and --y, and the others fixed, such as --at {}={value}",
                    example.path
                );
                Err(StudyError::refused(None, found, allowed))
            }
        }
    }
}

/// Fixes an axis of preloads at its first value if too many axes are free, and says so.
fn first_preload(
    axes: &[Axis],
    named: [Option<usize>; 2],
    fixed: &mut [Option<usize>],
) -> Option<String> {
    let last = axes.len().checked_sub(1)?;
    let axis = axes.get(last).filter(|axis| axis.is_of_preloads())?;
    let free = fixed.iter().filter(|place| place.is_none()).count();
    if free <= 2 || fixed[last].is_some() || named.contains(&Some(last)) {
        return None;
    }
    fixed[last] = Some(0);
    let (count, path) = (axis.values.len(), &axis.path);
    Some(format!(
        "{} is the first of {count} preloads; --at {path}=VALUE selects another one",
        axis.at(0)
    ))
}

/// Returns true if axis `one` has few values and axis `other` many. The few values are then curves
/// over the other axis.
fn is_few(axes: &[Axis], one: usize, other: usize) -> bool {
    let few = |index: usize| axes[index].values.len() <= MOST_CURVES;
    few(one) && !few(other)
}

/// Returns a quantity shown as curves. A single curve has a linear scale, with a second,
/// logarithmic chart for small values. Several curves need one scale on which the highest does not
/// hide the others.
fn section_layer(grid: &Grid, quantity: Quantity, scale: Option<AxisScale>) -> GridLayer {
    let statistics = grid.statistics(quantity, false);
    let mut curves = statistics.chunks(grid.size().0.max(1));
    let first = curves.next();
    let several = curves.any(|curve| Some(curve) != first);
    let means: Vec<f64> = statistics.iter().flatten().map(|one| one.mean).collect();
    let usual = || {
        if several {
            scale_of(&means)
        } else {
            AxisScale::Linear
        }
    };
    GridLayer {
        quantity,
        scale: scale.unwrap_or_else(usual),
        range: None,
    }
}

fn find(axes: &[Axis], path: &str, option: &'static str) -> Result<usize, StudyError> {
    axes.iter()
        .position(|axis| axis.path == path)
        .ok_or_else(|| {
            let all: Vec<_> = axes.iter().map(|axis| axis.path.as_str()).collect();
            let allowed = if all.is_empty() {
                "none, it has one cell".into()
            } else {
                all.join(", ")
            };
            let place = format!("{option} {path}");
            StudyError::refused(Some(&place), "this study has no such axis", allowed)
        })
}

fn values_of(axis: &Axis) -> String {
    let value = |value: &f64| format_quantity(*value, axis.unit);
    let shown = |values: &[f64]| values.iter().map(value).collect::<Vec<_>>().join(", ");
    match &axis.values[..] {
        [first @ .., last] if first.len() >= MOST_NAMED => {
            format!("{}, … {}", shown(&first[..MOST_NAMED - 1]), value(last))
        }
        values => shown(values),
    }
}
