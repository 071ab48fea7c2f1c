//! Selection of the part of a merged study that a figure shows: quantities, axes, and values of the
//! fixed axes.

use super::axis::Axis;
use super::error::StudyError;
use super::grid::{Grid, GridLayer, across_and_up, scale_of};
use super::plan::Plan;
use super::quantity::Quantity;
use super::results::Results;
use asperity_data::{AxisScale, Note, Remedy, format_quantity, parse_quantity};

/// Largest number of values of a second axis with which the figure shows one curve for each value.
/// With more values the figure is a map.
const MOST_CURVES: usize = 5;
/// Largest number of values of an axis that an error message lists.
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
    let (axis, value) = text.split_once('=').unwrap_or_default();
    let axis = axis.trim();
    let value = value.trim();
    if axis.is_empty() || value.is_empty() {
        return Err("allowed: AXIS=VALUE, such as roughness.hurst=0.3".to_owned());
    }
    Ok((axis.to_owned(), value.to_owned()))
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
    /// Note on the preload that the figure shows. It is present if the study has several preloads
    /// and the user chose none, so that the figure shows the first one. Otherwise `None`.
    pub note: Option<Note>,
}

/// What each axis of a study is used for in a figure.
struct ChosenAxes {
    /// Index of the axis that the user named as horizontal.
    across: Option<usize>,
    /// Index of the axis that the user named as vertical.
    up: Option<usize>,
    /// For each axis the index of its fixed value; `None` for an axis that is not fixed.
    fixed: Vec<Option<usize>>,
}

impl ChosenAxes {
    fn is_named(&self, axis: usize) -> bool {
        self.across == Some(axis) || self.up == Some(axis)
    }
}

/// Axis that the user has named in the selection.
struct NamedAxis {
    index: usize,
    /// Use of the axis in the figure, such as horizontal axis, for error messages.
    role: &'static str,
}

impl Selection {
    /// Returns the part of a study that the fields of this selection choose.
    ///
    /// # Errors
    /// Returns an error if the study lacks a chosen quantity, axis or value. It is also an error if
    /// more than two axes with several values remain, apart from the axis of preloads.
    /// [`Selection::at`] fixes an axis at one value.
    pub fn of(&self, study: &Results) -> Result<Selected, StudyError> {
        let plan = study.plan();
        let quantities = self.quantities(plan)?;
        let mut chosen = self.axes(&plan.axes)?;
        let note = first_preload(&plan.axes, &mut chosen);
        let (across, second) = free_axes(&plan.axes, &chosen)?;
        let curves =
            self.up.is_none() && second.is_some_and(|second| is_few(&plan.axes, second, across));
        let places = chosen
            .fixed
            .iter()
            .map(|place| place.unwrap_or(0))
            .collect();
        let mut grid = study.grid((across, second), places, study.layers());
        let is_map = second.is_some() && !curves;
        let layer = |quantity: Quantity, scale: Option<AxisScale>| {
            if is_map {
                study.layer(quantity, scale)
            } else {
                section_layer(&grid, quantity, scale)
            }
        };
        let mut scale = self.scale;
        // The pull-off forces of loops that turn at first touch and at zero force share one scale,
        // so that their panels can be compared.
        let are_shares = quantities
            .iter()
            .all(|quantity| Quantity::ADHESION_SHARES.contains(quantity));
        let is_any_logarithmic = quantities
            .iter()
            .any(|quantity| layer(*quantity, None).scale == AxisScale::Logarithmic);
        if scale.is_none() && are_shares && is_any_logarithmic {
            scale = Some(AxisScale::Logarithmic);
        }
        let mut layers = Vec::with_capacity(grid.layers.len());
        for known in &grid.layers {
            layers.push(layer(known.quantity, scale));
        }
        grid.layers = layers;
        Ok(Selected {
            grid,
            quantities,
            curves,
            note,
        })
    }

    /// Returns the quantities that the user names. If the user names none, returns those of the
    /// usual quantities that are recorded or, if there are none, the first recorded quantity.
    fn quantities(&self, plan: &Plan) -> Result<Vec<Quantity>, StudyError> {
        let mut recorded = plan.record.clone();
        recorded.retain(|quantity| !quantity.is_regime());
        if !self.quantities.is_empty() {
            return self
                .quantities
                .iter()
                .map(|name| quantity_named(name, &recorded))
                .collect();
        }
        let paper = [
            Quantity::FirstTouchAdhesionShare,
            Quantity::AdhesionCoefficient,
        ];
        // If F_a/F_n is not recorded, the figure compares the two pull-off forces without a
        // preload.
        let usual = if recorded.contains(&Quantity::AdhesionCoefficient) {
            paper
        } else {
            Quantity::ADHESION_SHARES
        };
        let usual: Vec<Quantity> = usual
            .into_iter()
            .filter(|quantity| recorded.contains(quantity))
            .collect();
        if !usual.is_empty() {
            return Ok(usual);
        }
        let first = recorded.first().map_or("regime", |first| first.name());
        Ok(vec![quantity_named(first, &recorded)?])
    }

    /// Returns the use of each axis. An axis that the user names must exist and be named only once.
    /// An axis with a single value is fixed at this value.
    fn axes(&self, axes: &[Axis]) -> Result<ChosenAxes, StudyError> {
        let mut named: Vec<NamedAxis> = Vec::new();
        let mut across = None;
        let mut up = None;
        if let Some(path) = &self.across {
            across = Some(name_axis(&mut named, axes, path, "the horizontal axis")?);
        }
        if let Some(path) = &self.up {
            up = Some(name_axis(&mut named, axes, path, "the vertical axis")?);
        }
        let mut fixed: Vec<Option<usize>> = axes
            .iter()
            .map(|axis| (axis.values.len() == 1).then_some(0))
            .collect();
        for (path, value) in &self.at {
            let index = name_axis(&mut named, axes, path, "a fixed value")?;
            let axis = &axes[index];
            let Some(place) = place_of(value, axis) else {
                let place = format!("{path} = {value}");
                let found = "the study has no such value";
                return Err(StudyError::refused(Some(&place), found, values_of(axis)));
            };
            fixed[index] = Some(place);
        }
        Ok(ChosenAxes { across, up, fixed })
    }
}

/// Returns the recorded quantity with this name or symbol.
fn quantity_named(name: &str, recorded: &[Quantity]) -> Result<Quantity, StudyError> {
    for quantity in recorded {
        if name == quantity.name() || name == quantity.symbol() {
            return Ok(*quantity);
        }
    }
    let names: Vec<&str> = recorded.iter().map(|quantity| quantity.name()).collect();
    let mut allowed = names.join(", ");
    if names.is_empty() {
        allowed = "none, only regimes were recorded".to_owned();
    }
    let place = format!("quantity {name}");
    let found = "this study has no such quantity";
    Err(StudyError::refused(Some(&place), found, allowed))
}

/// Returns the index of the axis that the user names for this role in the figure. Returns an error
/// if the axis already has another role.
fn name_axis(
    named: &mut Vec<NamedAxis>,
    axes: &[Axis],
    path: &str,
    role: &'static str,
) -> Result<usize, StudyError> {
    let index = find(axes, path, role)?;
    if let Some(known) = named.iter().find(|known| known.index == index) {
        let found = format!("named as {} and as {role}", known.role);
        return Err(StudyError::refused(Some(path), found, "one of them"));
    }
    named.push(NamedAxis { index, role });
    Ok(index)
}

/// Returns the index of the axis value that a typed text means. Messages show values with 4 digits,
/// so a value typed with these digits means the nearest value of the axis.
fn place_of(text: &str, axis: &Axis) -> Option<usize> {
    let wanted = parse_quantity(text, axis.unit).ok()?;
    let mut nearest = None;
    let mut least = f64::INFINITY;
    for (place, value) in axis.values.iter().enumerate() {
        let distance = (value - wanted).abs();
        // If two values are equally near, the first one counts.
        if distance <= 5e-4 * value.abs() && distance < least {
            nearest = Some(place);
            least = distance;
        }
    }
    nearest
}

/// Returns the indices of the horizontal axis and, if there is one, of the second axis. Unless the
/// user names the axes, H is horizontal and κ or e_el/γ is vertical. If one of two axes has few
/// values, the figure shows a curve for each of them over the other axis.
fn free_axes(axes: &[Axis], chosen: &ChosenAxes) -> Result<(usize, Option<usize>), StudyError> {
    let free: Vec<usize> = (0..axes.len())
        .filter(|index| chosen.fixed[*index].is_none() && !chosen.is_named(*index))
        .collect();
    match (chosen.across, chosen.up, &free[..]) {
        (Some(across), up, []) => Ok((across, up)),
        (Some(across), None, [second]) => Ok((across, Some(*second))),
        (None, Some(up), [across]) => Ok((*across, Some(up))),
        (None, None, [_] | [_, _]) => {
            let (across, up) = across_and_up(axes, &free).ok_or_else(none_left)?;
            match up {
                Some(longer) if is_few(axes, across, longer) => Ok((longer, Some(across))),
                up => Ok((across, up)),
            }
        }
        (_, _, []) => Err(none_left()),
        _ => Err(too_many_free(axes, &free)),
    }
}

fn none_left() -> StudyError {
    let found = "no axis is left to go across";
    StudyError::refused(None, found, "an axis with two values at least")
}

/// Returns the error for a study with more free axes than a figure can show.
fn too_many_free(axes: &[Axis], free: &[usize]) -> StudyError {
    let all: Vec<String> = free
        .iter()
        .map(|index| format!("{} ({})", axes[*index].path, values_of(&axes[*index])))
        .collect();
    let found = format!("too many axes are free for a figure: {}", all.join(", "));
    let example = &axes[free[0]];
    let path = &example.path;
    let value = format_quantity(example.values[0], example.unit).replace(' ', "");
    let error = StudyError::refused(None, found, "two, and the others fixed");
    error
        .with(Remedy::FigureAxes)
        .with(Remedy::FixAxis(format!("{path}={value}")))
}

/// If too many axes are free, fixes the axis of preloads at its first value and returns a note that
/// says so.
fn first_preload(axes: &[Axis], chosen: &mut ChosenAxes) -> Option<Note> {
    let last = axes.len().checked_sub(1)?;
    let axis = axes.get(last).filter(|axis| axis.is_of_preloads())?;
    let free = chosen.fixed.iter().filter(|place| place.is_none()).count();
    if free <= 2 || chosen.fixed[last].is_some() || chosen.is_named(last) {
        return None;
    }
    chosen.fixed[last] = Some(0);
    let count = axis.values.len();
    let path = &axis.path;
    let note = Note::new(format!("{} is the first of {count} preloads", axis.at(0)));
    Some(note.with(Remedy::OtherValue(path.clone())))
}

/// Returns true if the axis `few` has so few values that the figure shows a curve for each of them
/// over the axis `many`, which has more values.
fn is_few(axes: &[Axis], few: usize, many: usize) -> bool {
    axes[few].values.len() <= MOST_CURVES && axes[many].values.len() > MOST_CURVES
}

/// Returns the layer that shows a quantity as curves. A single curve is drawn on a linear scale,
/// with a second chart on a logarithmic scale for its small values. Several curves share the scale
/// that suits their means.
fn section_layer(grid: &Grid, quantity: Quantity, scale: Option<AxisScale>) -> GridLayer {
    let statistics = grid.statistics(quantity, false);
    let mut curves = statistics.chunks(grid.size().0.max(1));
    let first = curves.next();
    let several = curves.any(|curve| Some(curve) != first);
    let mut usual = AxisScale::Linear;
    if several {
        let known = statistics.iter().flatten();
        let means: Vec<f64> = known.map(|statistics| statistics.mean).collect();
        usual = scale_of(&means);
    }
    GridLayer {
        quantity,
        scale: scale.unwrap_or(usual),
        range: None,
    }
}

fn find(axes: &[Axis], path: &str, role: &'static str) -> Result<usize, StudyError> {
    if let Some(index) = axes.iter().position(|axis| axis.path == path) {
        return Ok(index);
    }
    let paths: Vec<&str> = axes.iter().map(|axis| axis.path.as_str()).collect();
    let mut allowed = paths.join(", ");
    if paths.is_empty() {
        allowed = "none, it has one cell".to_owned();
    }
    let place = format!("{role} {path}");
    let found = "this study has no such axis";
    Err(StudyError::refused(Some(&place), found, allowed))
}

fn values_of(axis: &Axis) -> String {
    let values: Vec<String> = axis
        .values
        .iter()
        .map(|value| format_quantity(*value, axis.unit))
        .collect();
    match &values[..] {
        [first @ .., last] if first.len() >= MOST_NAMED => {
            format!("{}, … {last}", first[..MOST_NAMED - 1].join(", "))
        }
        values => values.join(", "),
    }
}
