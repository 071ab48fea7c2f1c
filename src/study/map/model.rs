//! A map for display, over two quantities of a scene or along one: the live map and those of a finished study fill
//! the same [`MapModel`].

use super::axis::MapAxis;
use crate::analysis::Regime;
use crate::study::cell_summary::CellSummary;
use crate::study::figure::{AxisScale, Boundary, Estimate, Figure, Panel, range_of, scale_of};
use crate::study::quantity::Quantity;

/// A map for display.
#[derive(Clone, Debug, PartialEq)]
pub struct MapModel {
    across: MapAxis,
    up: Option<MapAxis>,
    layers: Vec<Layer>,
    /// Cells row by row, the row of the lowest value first.
    cells: Vec<Option<Result<MapCell, String>>>,
    /// The cell shown for each: itself, or one of a coarser map.
    stand_ins: Vec<Option<usize>>,
    /// True where the regime of any cell is known; true where profiles of any cell are divided between regimes.
    has_regimes: bool,
    is_split: bool,
}

/// A quantity in all cells of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Quantity.
    pub quantity: Quantity,
    /// Scale of the quantity.
    pub scale: AxisScale,
    /// Least and largest mean over all maps that share the scale.
    pub range: Option<(f64, f64)>,
    /// Mean in each cell, row by row, with its confidence where known.
    pub estimates: Vec<Option<Estimate>>,
}

impl Layer {
    /// A quantity in all cells of all maps that share the scale.
    pub(super) fn new(quantity: Quantity, estimates: Vec<Option<Estimate>>) -> Self {
        let scale = scale_of(&estimates);
        Layer { quantity, scale, range: range_of(&estimates, scale), estimates }
    }

    /// The quantity in other cells, on the same scale.
    pub(super) fn with(&self, estimates: Vec<Option<Estimate>>) -> Self {
        Layer { estimates, ..*self }
    }
}

/// Regime of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapCell {
    /// Regime; `None` where unknown.
    pub regime: Option<Regime>,
    /// Second regime, where too many profiles are in it for the first to be the cell's alone.
    pub split: Option<Regime>,
    /// Number of profiles whose own regime is that of the cell.
    pub agreeing: u64,
    /// Number of profiles.
    pub lines: u64,
}

impl MapCell {
    /// The cell of a summary.
    #[must_use]
    pub fn new(summary: &CellSummary) -> Self {
        let (regime, lines) = (summary.regime(), summary.lines);
        let share = regime.map_or(0.0, |cell| cell.share);
        MapCell {
            regime: regime.map(|cell| cell.regime),
            split: regime.and_then(|cell| cell.split),
            agreeing: (share * lines as f64).round() as u64,
            lines,
        }
    }

    /// Place of the regime from 0, non-adhesive, to 1, pressure-insensitive; halfway between two regimes if
    /// profiles are divided between them.
    fn rank(&self) -> Option<Estimate> {
        let rank = |regime: Regime| 1.0 - regime as u8 as f64 / 2.0;
        let regime = rank(self.regime?);
        let mean = self.split.map_or(regime, |other| (regime + rank(other)) / 2.0);
        Some(Estimate { mean, low: mean, high: mean })
    }
}

/// A place in values of the axes of a map: across and, if the map has two axes, up.
pub type Place = (f64, Option<f64>);

/// A shown cell and its place on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownCell<'p> {
    /// Column of the cell.
    pub column: usize,
    /// Row of the cell.
    pub row: usize,
    /// Regime, or the reason why the cell was not computed.
    pub cell: &'p Result<MapCell, String>,
}

/// Quantity of the glyphs of a map. Colours show the regime, if known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Charted {
    /// The regime.
    #[default]
    Regime,
    /// A quantity.
    Quantity(Quantity),
}

impl MapModel {
    /// A map from the summaries of its cells, row by row, or the reasons for their absence, and the cell shown for
    /// each. The layers are the quantities beside the regime.
    pub(super) fn new(
        (across, up): (MapAxis, Option<MapAxis>),
        layers: Vec<Layer>,
        summaries: &[Option<Result<&CellSummary, &String>>],
        stand_ins: Vec<Option<usize>>,
    ) -> MapModel {
        let cells: Vec<_> = summaries
            .iter()
            .map(|cell| cell.map(|cell| cell.map(MapCell::new).map_err(String::clone)))
            .collect();
        let known = || cells.iter().flatten().flatten();
        MapModel {
            has_regimes: known().any(|cell| cell.regime.is_some()),
            is_split: known().any(|cell| cell.split.is_some()),
            layers,
            across,
            up,
            cells,
            stand_ins,
        }
    }

    /// The map with columns and rows exchanged; a map along one axis is unchanged.
    #[must_use]
    pub fn transposed(&self) -> MapModel {
        let Some(up) = self.up.clone() else { return self.clone() };
        let (columns, rows) = self.size();
        let place = |index: usize| index % columns * rows + index / columns;
        // The cells of the new order, by their numbers in the old one.
        let order = || (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
        let layer = |layer: &Layer| layer.with(order().map(|index| layer.estimates[index]).collect());
        MapModel {
            layers: self.layers.iter().map(layer).collect(),
            cells: order().map(|index| self.cells[index].clone()).collect(),
            stand_ins: order().map(|index| self.stand_ins[index].map(place)).collect(),
            across: up,
            up: Some(self.across.clone()),
            has_regimes: self.has_regimes,
            is_split: self.is_split,
        }
    }

    /// Axis of the columns.
    #[must_use]
    pub fn across(&self) -> &MapAxis {
        &self.across
    }

    /// Axis of the rows; `None` for a map along one axis.
    #[must_use]
    pub fn up(&self) -> Option<&MapAxis> {
        self.up.as_ref()
    }

    /// Numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.across.figure.values.len(), self.up.as_ref().map_or(1, |up| up.figure.values.len()))
    }

    /// Quantities beside the regime.
    #[must_use]
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The layer of a quantity.
    #[must_use]
    pub fn layer(&self, quantity: Quantity) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.quantity == quantity)
    }

    /// Choices for the glyphs, the regime first if known.
    #[must_use]
    pub fn charted(&self) -> Vec<Charted> {
        let regime = self.has_regimes.then_some(Charted::Regime);
        regime.into_iter().chain(self.layers.iter().map(|layer| Charted::Quantity(layer.quantity))).collect()
    }

    /// Returns true if profiles of a cell are divided between regimes.
    #[must_use]
    pub fn is_split(&self) -> bool {
        self.is_split
    }

    /// The cell shown at a column and a row: itself or, until it is computed, its substitute.
    #[must_use]
    pub fn shown(&self, column: usize, row: usize) -> Option<ShownCell<'_>> {
        let columns = self.across.figure.values.len();
        let index = (*self.stand_ins.get(row * columns + column).filter(|_| column < columns)?)?;
        let cell = self.cells.get(index)?.as_ref()?;
        Some(ShownCell { column: index % columns, row: index / columns, cell })
    }

    /// Returns true for a place on the map, including half a cell beyond the outermost values.
    #[must_use]
    pub fn contains(&self, at: Place) -> bool {
        let (column, row) = self.coordinates(at);
        let within = |at: f64, count: usize| (-0.5..count as f64 - 0.5).contains(&at);
        let (columns, rows) = self.size();
        within(column, columns) && within(row, rows)
    }

    /// The column and the row of a place, fractional between cells.
    fn coordinates(&self, (across, up): Place) -> (f64, f64) {
        let row = self.up.as_ref().zip(up).map_or(0.0, |(axis, value)| axis.figure.place(value));
        (self.across.figure.place(across), row)
    }

    /// The cell shown for a place or, beyond the map, the one at its edge.
    #[must_use]
    pub fn nearest(&self, at: Place) -> Option<ShownCell<'_>> {
        let (column, row) = self.nearest_cell(at);
        self.shown(column, row)
    }

    /// Column and row of the cell nearest to a place.
    #[must_use]
    pub fn nearest_cell(&self, at: Place) -> (usize, usize) {
        let (column, row) = self.coordinates(at);
        let nearest = |at: f64, count: usize| at.round().clamp(0.0, count.saturating_sub(1) as f64) as usize;
        let (columns, rows) = self.size();
        (nearest(column, columns), nearest(row, rows))
    }

    /// A layer in a cell.
    #[must_use]
    pub fn estimate(&self, layer: &Layer, column: usize, row: usize) -> Option<Estimate> {
        *layer.estimates.get(row * self.across.figure.values.len() + column)?
    }

    /// The known values of a layer along a row, by the values across.
    pub fn along_row(&self, layer: &Layer, row: usize) -> Vec<(f64, Estimate)> {
        let values = self.across.figure.values.iter().enumerate();
        values.filter_map(|(column, value)| Some((*value, self.estimate(layer, column, row)?))).collect()
    }

    /// The known values of a layer along a column, by the values up.
    pub fn along_column(&self, layer: &Layer, column: usize) -> Vec<(f64, Estimate)> {
        let values = self.up.iter().flat_map(|up| &up.figure.values).enumerate();
        values.filter_map(|(row, value)| Some((*value, self.estimate(layer, column, row)?))).collect()
    }

    /// A computed cell, or the reason for its absence; never a substitute.
    #[must_use]
    pub fn computed(&self, column: usize, row: usize) -> Option<&Result<MapCell, String>> {
        self.cells.get(row * self.across.figure.values.len() + column)?.as_ref()
    }

    /// The figure of the charted quantities: a map, or a section along the only axis. `whole` adds substitutes for
    /// cells that have not been computed yet.
    #[must_use]
    pub fn figure(&self, charted: &[Charted], whole: bool) -> Figure {
        let cells =
            || (0..self.cells.len()).map(|index| if whole { self.stand_ins[index] } else { Some(index) });
        let estimates = |layer: &Layer| -> Vec<_> { cells().map(|index| layer.estimates[index?]).collect() };
        let known = |index: usize| self.cells[index].as_ref()?.as_ref().ok();
        let panel = |charted: &Charted| match *charted {
            Charted::Quantity(quantity) => self.layer(quantity).map(|layer| Panel {
                range: layer.range,
                ..Panel::new(quantity, estimates(layer), layer.scale)
            }),
            Charted::Regime => {
                let ranks = cells().map(|index| known(index?)?.rank()).collect();
                let panel = Panel::new(Quantity::Regime, ranks, AxisScale::Linear);
                Some(Panel { range: Some((0.0, 1.0)), ..panel })
            }
        };
        let share = Quantity::ADHESION_SHARES.into_iter().find_map(|share| self.layer(share));
        let regime = |index: Option<usize>| known(index?)?.regime;
        Figure {
            title: String::new(),
            fixed: Vec::new(),
            across: self.across.figure.clone(),
            up: self.up.as_ref().map(|up| up.figure.clone()),
            series: None,
            panels: charted.iter().filter_map(panel).collect(),
            boundary: share.map(|layer| Boundary::new(&estimates(layer))),
            regimes: if self.has_regimes { cells().map(regime).collect() } else { Vec::new() },
        }
    }
}
