//! A grid of cells over one or two axes. Maps, curves and tables of a study show such a grid.

use super::axis::Axis;
use super::quantity::Quantity;
use super::statistics::{RegimeCounts, Statistics};
use asperity_data::AxisScale;
use asperity_scene::{Regime, RoughnessParameter};

/// A mean counts as small if it is less than the largest mean divided by this number.
const LOGARITHMIC_RATIO: f64 = 50.0;

/// Results of a study in one cell of a [`Grid`]. A cell belongs to one value on the horizontal axis
/// and one value on the vertical axis.
#[derive(Clone, Debug, PartialEq)]
pub struct GridCell {
    /// Statistics over the random profiles for each quantity of the grid, in the order of
    /// [`Grid::layers`]; `None` if the quantity has no value on any profile.
    pub statistics: Vec<Option<Statistics>>,
    /// Number of profiles in each regime of adhesion, as two counts. In the first count, the regime
    /// follows from F_a(d=0), the pull-off force of a loading that turns at first touch
    /// ([`Quantity::Regime`]). In the second count, it follows from F_a(F=0), the pull-off force of
    /// a loading that turns at zero force ([`Quantity::RegimeAfterZeroForce`]).
    pub regimes: [RegimeCounts; 2],
}

impl GridCell {
    /// Returns the number of profiles in each regime of adhesion. If `quantity` is
    /// [`Quantity::RegimeAfterZeroForce`], the regime follows from F_a(F=0), the pull-off force of
    /// a loading that turns at zero force. For any other quantity it follows from F_a(d=0), the
    /// pull-off force of a loading that turns at first touch.
    pub fn regimes_of(&self, quantity: Quantity) -> RegimeCounts {
        self.regimes[usize::from(quantity == Quantity::RegimeAfterZeroForce)]
    }
}

/// Quantity that a [`Grid`] shows, and the scale on which figures show its means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridLayer {
    /// Quantity whose means over the profiles the grid shows.
    pub quantity: Quantity,
    /// Scale of the means of the quantity in a figure, linear or logarithmic.
    pub scale: AxisScale,
    /// Smallest and largest mean of the quantity over the [cells](GridCell). If the scale is
    /// logarithmic, only means above zero are included. `None` if there is no such mean.
    pub range: Option<(f64, f64)>,
}

impl GridLayer {
    /// Makes a layer of a quantity with the range of `means`, its means over the profiles, one for
    /// each cell.
    pub fn new<'a>(
        quantity: Quantity,
        scale: AxisScale,
        means: impl IntoIterator<Item = &'a f64>,
    ) -> GridLayer {
        let mut range: Option<(f64, f64)> = None;
        for &mean in means {
            if scale.coordinate(mean).is_finite() {
                let (least, most) = range.unwrap_or((mean, mean));
                range = Some((least.min(mean), most.max(mean)));
            }
        }
        GridLayer {
            quantity,
            scale,
            range,
        }
    }
}

/// Returns the scale that suits `means`, the means of a quantity over the profiles, one for each
/// cell. It is logarithmic if all means are above zero and at least a third of them are below a
/// fiftieth of the largest mean. Otherwise it is linear.
pub(super) fn scale_of(means: &[f64]) -> AxisScale {
    let largest = means.iter().copied().fold(0.0, f64::max);
    let small = means
        .iter()
        .filter(|mean| **mean < largest / LOGARITHMIC_RATIO)
        .count();
    let wide = means.iter().all(|mean| *mean > 0.0) && 3 * small >= means.len().max(1);
    if wide {
        AxisScale::Logarithmic
    } else {
        AxisScale::Linear
    }
}

/// Returns the scale of the colours of a map of a quantity with these means. A share, such as
/// F_a/F_a,max, has a linear scale, on which cells that hardly adhere look alike. For another
/// quantity, in contrast to [`scale_of`], a mean of zero counts as a small mean, since a cell with
/// it has the colour of the smallest means. A map of a few profiles and a map of many profiles then
/// usually have the same scale.
pub(super) fn scale_of_colours(quantity: Quantity, means: &[f64]) -> AxisScale {
    if quantity.bounds() == (0.0, 1.0) {
        return AxisScale::Linear;
    }
    let least = means.iter().copied().filter(|mean| *mean > 0.0);
    let least = least.fold(f64::INFINITY, f64::min);
    let means = means
        .iter()
        .map(|mean| if *mean == 0.0 { least } else { *mean });
    scale_of(&means.collect::<Vec<_>>())
}

/// Position on a [`Grid`]. The first number is a value on the horizontal axis. The second is a
/// value on the vertical axis, or `None` for a grid with one axis.
pub type GridPlace = (f64, Option<f64>);

/// Results of a study over one or two of its axes. The grid has a [cell](GridCell) for each
/// combination of values on these axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Horizontal axis, with an ascending value for each column.
    pub across: Axis,
    /// Vertical axis, with an ascending value for each row; `None` for a grid along one axis.
    pub up: Option<Axis>,
    /// Values on all other axes of the study, which are the same in the whole grid, as text such as
    /// `H = 0.3`.
    pub fixed: Vec<String>,
    /// Quantities that the grid shows, except regimes. For regimes, [`GridCell::regimes`] has the
    /// number of profiles in each regime.
    pub layers: Vec<GridLayer>,
    /// Cells of the grid row by row, beginning with the lowest row. An element is `None` until its
    /// [cell](GridCell) is computed. It is an error, with the reason as text, if the cell cannot be
    /// computed.
    pub cells: Vec<Option<Result<GridCell, String>>>,
    /// For each cell, the index of the cell whose results are shown in its place. This is its own
    /// index or, until the cell is computed, the index of a cell of a coarser grid.
    pub(super) stand_ins: Vec<usize>,
}

impl Grid {
    /// Creates a grid from its axes, fixed values, layers and cells. The fields of [`Grid`] with
    /// the same names describe these arguments.
    pub fn new(
        across: Axis,
        up: Option<Axis>,
        fixed: Vec<String>,
        layers: Vec<GridLayer>,
        cells: Vec<Option<Result<GridCell, String>>>,
    ) -> Grid {
        let stand_ins = (0..cells.len()).collect();
        Grid {
            across,
            up,
            fixed,
            layers,
            cells,
            stand_ins,
        }
    }

    /// Returns the size of the grid: first the number of columns, then the number of rows.
    pub fn size(&self) -> (usize, usize) {
        let columns = self.across.values.len();
        let rows = self.up.as_ref().map_or(1, |up| up.values.len());
        (columns, rows)
    }

    /// Returns the layer of [`Grid::layers`] that shows a quantity; `None` if the grid does not
    /// show the quantity.
    pub fn layer(&self, quantity: Quantity) -> Option<&GridLayer> {
        self.layers.iter().find(|layer| layer.quantity == quantity)
    }

    /// Returns the quantities that the grid shows, in the order of the layers. If the regimes of
    /// adhesion are known, they are added. The first quantity is then the regime that follows from
    /// the pull-off force after first touch, F_a(d=0), and the last quantity is the regime that
    /// follows from the pull-off force after zero force, F_a(F=0).
    pub fn quantities(&self) -> Vec<Quantity> {
        let [after_touch, after_zero_force] = Quantity::REGIMES;
        let mut quantities = Vec::with_capacity(self.layers.len() + 2);
        if !self.regimes(after_touch, false).is_empty() {
            quantities.push(after_touch);
        }
        quantities.extend(self.layers.iter().map(|layer| layer.quantity));
        if !self.regimes(after_zero_force, false).is_empty() {
            quantities.push(after_zero_force);
        }
        quantities
    }

    /// Returns true if the regime of adhesion is not clear in at least one [cell](GridCell): less
    /// than three quarters of its profiles have the same regime. `regime` is one of
    /// [`Quantity::REGIMES`].
    pub fn is_split(&self, regime: Quantity) -> bool {
        self.each(false)
            .flatten()
            .any(|cell| cell.regimes_of(regime).split().is_some())
    }

    /// Returns the [cell](GridCell) that a map shows at a column and a row, with the column and the
    /// row to which the returned cell belongs. A [`LiveMap`](crate::maps::LiveMap) that is not
    /// complete shows a computed cell nearby in place of a missing cell. The returned column and
    /// row may therefore differ from the given ones. `None` if the map shows no cell there.
    pub fn shown(
        &self,
        column: usize,
        row: usize,
    ) -> Option<(&Result<GridCell, String>, usize, usize)> {
        let columns = self.across.values.len();
        if column >= columns {
            return None;
        }
        let index = *self.stand_ins.get(row * columns + column)?;
        let cell = self.cells[index].as_ref()?;
        Some((cell, index % columns, index / columns))
    }

    /// Returns the cells in their order. If `whole` is true, a cell that is not computed yet is
    /// replaced by the cell that is shown in its place.
    fn each(&self, whole: bool) -> impl Iterator<Item = Option<&GridCell>> {
        (0..self.cells.len()).map(move |index| {
            let shown = if whole { self.stand_ins[index] } else { index };
            self.cells[shown].as_ref()?.as_ref().ok()
        })
    }

    /// Returns the statistics of a quantity in all [cells](GridCell), row by row. An element is
    /// `None` if the cell is not computed or the quantity has no value in it. If `whole` is true, a
    /// cell that is not computed yet gets the statistics of the computed cell that a map shows in
    /// its place.
    ///
    /// A regime is treated as a number: 0 (non-adhesive), ½ (pressure-sensitive) or 1
    /// (pressure-insensitive). The value of a cell is its most frequent regime. If fewer than three
    /// quarters of the profiles are in this regime, the value is halfway between the values of the
    /// two most frequent regimes.
    pub fn statistics(&self, quantity: Quantity, whole: bool) -> Vec<Option<Statistics>> {
        let layer = self
            .layers
            .iter()
            .position(|layer| layer.quantity == quantity);
        let cells = self.each(whole);
        if quantity.is_regime() {
            return cells
                .map(|cell| regime_as_number(cell?.regimes_of(quantity)))
                .collect();
        }
        cells.map(|cell| cell?.statistics[layer?]).collect()
    }

    /// Returns the most frequent regime of each [cell](GridCell), row by row. The list is empty if
    /// no regime is known in any cell. An element is `None` if the regime of the cell is not known.
    /// The regime follows from the pull-off force after zero force, F_a(F=0), if `quantity` is
    /// [`Quantity::RegimeAfterZeroForce`], and from the pull-off force after first touch, F_a(d=0),
    /// for any other quantity. If `whole` is true, a cell that is not computed yet gets the regime
    /// of the computed cell that a map shows in its place.
    pub fn regimes(&self, quantity: Quantity, whole: bool) -> Vec<Option<Regime>> {
        let mut regimes = Vec::new();
        for cell in self.each(whole) {
            let most = cell.and_then(|cell| cell.regimes_of(quantity).most());
            regimes.push(most.map(|(regime, _)| regime));
        }
        if regimes.iter().all(Option::is_none) {
            Vec::new()
        } else {
            regimes
        }
    }

    /// Returns true if a place, given by its values on the axes, lies on the grid. Along each axis
    /// the grid begins half a [cell](GridCell) before the first value and ends half a cell beyond
    /// the last value.
    pub fn contains(&self, at: GridPlace) -> bool {
        let (column, row) = self.coordinates(at);
        let (columns, rows) = self.size();
        is_on_axis(column, columns) && is_on_axis(row, rows)
    }

    /// Returns the column and the row of a place, with a fraction. They are whole numbers in the
    /// middle of a cell.
    fn coordinates(&self, place: GridPlace) -> (f64, f64) {
        let (across, up) = place;
        let column = index_of(across, &self.across);
        let mut row = 0.0;
        if let (Some(axis), Some(value)) = (&self.up, up) {
            row = index_of(value, axis);
        }
        (column, row)
    }

    /// Returns the [cell](GridCell) that a map shows nearest to a place, with the column and the
    /// row to which this cell belongs. If the place lies beyond the grid, this cell is at the edge
    /// of the grid. `None` if the map shows no cell there.
    pub fn nearest(&self, at: GridPlace) -> Option<(&Result<GridCell, String>, usize, usize)> {
        let (column, row) = self.coordinates(at);
        let (columns, rows) = self.size();
        self.shown(nearest_index(column, columns), nearest_index(row, rows))
    }
}

/// Returns the most frequent regime as a number from 0 to 1. If the profiles do not agree on a
/// regime, returns the mean of the numbers of the two most frequent regimes.
fn regime_as_number(regimes: RegimeCounts) -> Option<Statistics> {
    let most = regimes.most()?.0;
    let second = regimes.split().unwrap_or(most);
    let mean = (regime_rank(most) + regime_rank(second)) / 2.0;
    Statistics::of(vec![mean], (0.0, 1.0))
}

fn regime_rank(regime: Regime) -> f64 {
    1.0 - regime as u8 as f64 / 2.0
}

/// Returns the index of a value on an axis, with a fraction between two values of the axis.
fn index_of(value: f64, axis: &Axis) -> f64 {
    axis.scale().place(&axis.values, value)
}

/// Returns true if an index with a fraction is at most half a cell outside an axis with `count`
/// values.
fn is_on_axis(index: f64, count: usize) -> bool {
    (-0.5..count as f64 - 0.5).contains(&index)
}

/// Returns the index among `count` values that is nearest to an index with a fraction.
fn nearest_index(index: f64, count: usize) -> usize {
    index.round().clamp(0.0, count.saturating_sub(1) as f64) as usize
}

/// Returns the indices of the horizontal and the vertical axis of a grid. `free` are the indices of
/// the axes that are not fixed. A free axis of the Hurst exponent is horizontal, and a free axis of
/// a roughness parameter (κ or e_el/γ) is vertical. Otherwise the first free axis is horizontal.
/// Returns `None` if no axis is free.
pub(super) fn across_and_up(axes: &[Axis], free: &[usize]) -> Option<(usize, Option<usize>)> {
    let mut up = None;
    let mut across = None;
    for &axis in free {
        let path = axes[axis].path.as_str();
        if up.is_none() && RoughnessParameter::named(path).is_some() {
            up = Some(axis);
        }
        if across.is_none() && path == "roughness.hurst" {
            across = Some(axis);
        }
    }
    let across = across.or(first_beside(free, up)).or(up)?;
    let up = up.filter(|up| *up != across);
    Some((across, up.or(first_beside(free, Some(across)))))
}

/// Returns the first free axis that is not `axis`.
fn first_beside(free: &[usize], axis: Option<usize>) -> Option<usize> {
    free.iter().copied().find(|other| Some(*other) != axis)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_of_zero_changes_no_scale_of_colours() {
        let energy = |means: &[f64]| scale_of_colours(Quantity::DissipatedEnergy, means);
        let small = [1.0, 0.9, 1e-3, 1e-4, 1e-5];
        let zero = [1.0, 0.9, 1e-3, 0.0, 0.0];
        assert_eq!(energy(&small), AxisScale::Logarithmic);
        assert_eq!(energy(&zero), AxisScale::Logarithmic);
        // Curves cannot show zero on a logarithmic scale.
        assert_eq!(scale_of(&zero), AxisScale::Linear);
        for linear in [&[1.0, 0.5, 0.4][..], &[0.0, 0.0], &[-1.0, 0.0, 1.0], &[]] {
            assert_eq!(energy(linear), AxisScale::Linear, "{linear:?}");
        }
        let share = scale_of_colours(Quantity::AdhesionShare, &small);
        assert_eq!(share, AxisScale::Linear);
    }
}
