//! A map over κ and H as it is shown: the one that is computed while one looks on, and those of a finished
//! study, fill the same [`MapModel`].

use crate::analysis::Regime;
use crate::scene::format_quantity;
use crate::study::cell_summary::CellSummary;
use crate::study::figure::{AxisScale, Estimate, FigureAxis};
use crate::study::figure_axis::scale_of;
use crate::study::quantity::Quantity;

/// A map as it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct MapModel {
    across: FigureAxis,
    up: Option<FigureAxis>,
    layers: Vec<Layer>,
    /// Row by row, the lowest H first.
    cells: Vec<Option<Result<MapCell, String>>>,
    /// The cell that stands for each: itself, or one of a coarser map.
    stand_ins: Vec<Option<usize>>,
    /// True where the regime of any cell is known; true where profiles of any cell are divided between regimes.
    has_regimes: bool,
    is_split: bool,
    labels: [Vec<(usize, String)>; 2],
}

/// A quantity in all cells of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Which one.
    pub quantity: Quantity,
    /// Scale of the quantity.
    pub scale: AxisScale,
    /// Least values of the three densest glyphs, the densest first.
    pub steps: [f64; 3],
    /// Mean in each cell, row by row, with its confidence where that is known.
    pub estimates: Vec<Option<Estimate>>,
}

/// A quantity of a map with its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MapScale {
    /// The quantity.
    pub quantity: Quantity,
    /// Scale of the quantity.
    pub scale: AxisScale,
    /// Least values of the three densest glyphs, the densest first.
    pub steps: [f64; 3],
}

impl MapScale {
    /// The scale of a quantity, from its estimates on all maps unless it is the same on every map.
    pub fn new(quantity: Quantity, estimates: impl FnOnce() -> Vec<Option<Estimate>>) -> Self {
        let (scale, steps) = match quantity.steps() {
            Some(steps) => (AxisScale::Logarithmic, steps),
            None => quarters(&estimates()),
        };
        MapScale { quantity, scale, steps }
    }
}

/// Scale and steps of a quantity by its values: a quarter of their range for each glyph.
fn quarters(estimates: &[Option<Estimate>]) -> (AxisScale, [f64; 3]) {
    let scale = scale_of(estimates);
    let places = || estimates.iter().flatten().map(|estimate| scale.coordinate(estimate.mean));
    let (low, high) =
        places().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let step = |share: f64| {
        let value = scale.number(low + share * (high - low));
        format!("{value:.1e}").parse().unwrap_or(value)
    };
    if low > high { (AxisScale::Linear, [0.0; 3]) } else { (scale, [0.75, 0.5, 0.25].map(step)) }
}

/// Regime of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapCell {
    /// Regime; `None` where unknown.
    pub regime: Option<Regime>,
    /// Another regime, where too many of its lines are in that one to call the first the cell's.
    pub split: Option<Regime>,
    /// Lines that are in its regime each by itself.
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
}

/// A cell that is shown, and where it stands on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<'p> {
    /// Column of the cell.
    pub column: usize,
    /// Row of the cell.
    pub row: usize,
    /// Regime, or the reason why the cell was not computed.
    pub cell: &'p Result<MapCell, String>,
}

/// Quantity of the glyphs of a map. Colours show the regime, where it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Charted {
    /// The regime.
    #[default]
    Regime,
    /// A quantity.
    Quantity(Quantity),
}

/// Fewest and most values that are written along a side, as far as there are so many.
const LABELS: (usize, usize) = (3, 6);
/// Distances between them, and values to begin with, that are tried.
const MOST_TRIED: usize = 64;
/// Weight of another label, in characters of their mean length.
const LABEL: f64 = 0.45;

/// The values of an axis that are written beside it, at equal distances: those that are short, and rather more
/// than fewer.
fn labels(axis: &FigureAxis) -> Vec<(usize, String)> {
    let count = axis.values.len();
    let text = |value: &f64| format_quantity(format!("{value:.2e}").parse().unwrap_or(*value), "1");
    let strides = ((count / (LABELS.1 + 1)).max(1)..=count.max(1)).step_by((count / MOST_TRIED).max(1));
    let all = strides.flat_map(|stride| {
        (0..stride).step_by((stride / MOST_TRIED).max(1)).map(move |first| (stride, first))
    });
    let written = |(stride, first): (usize, usize)| -> Vec<(usize, String)> {
        let values = axis.values.iter().enumerate().skip(first).step_by(stride);
        values.map(|(index, value)| (index, text(value))).collect()
    };
    let cost = |labels: &Vec<(usize, String)>| {
        let (number, length) =
            (labels.len() as f64, labels.iter().map(|(_, text)| text.chars().count()).sum::<usize>());
        length as f64 / number.max(1.0) - LABEL * number
    };
    let allowed = LABELS.0.min(count)..=LABELS.1;
    let all = all.map(written).filter(|labels| allowed.contains(&labels.len()));
    all.min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or_default()
}

impl Layer {
    /// The step that a value reaches, 0 the densest; 3 where it reaches none.
    #[must_use]
    pub fn step(&self, value: f64) -> usize {
        self.steps.iter().position(|least| value >= *least).unwrap_or(self.steps.len())
    }
}

impl MapModel {
    /// A map from the summaries of its cells, row by row, or the reasons why they could not be computed, and the cell
    /// that stands for each. `scales` are the quantities beside the regime, each with its place among the recorded.
    pub(super) fn new(
        (across, up): (FigureAxis, Option<FigureAxis>),
        scales: &[(usize, MapScale)],
        summaries: &[Option<Result<&CellSummary, &String>>],
        stand_ins: Vec<Option<usize>>,
    ) -> MapModel {
        let cells: Vec<_> = summaries
            .iter()
            .map(|cell| cell.map(|cell| cell.map(MapCell::new).map_err(String::clone)))
            .collect();
        let layer = |&(column, MapScale { quantity, scale, steps }): &(usize, MapScale)| {
            let estimate = |cell: &Option<Result<&CellSummary, &String>>| (*cell)?.ok()?.estimate(column);
            Layer { quantity, scale, steps, estimates: summaries.iter().map(estimate).collect() }
        };
        let known = || cells.iter().flatten().flatten();
        MapModel {
            has_regimes: known().any(|cell| cell.regime.is_some()),
            is_split: known().any(|cell| cell.split.is_some()),
            labels: [labels(&across), up.as_ref().map(labels).unwrap_or_default()],
            layers: scales.iter().map(layer).collect(),
            across,
            up,
            cells,
            stand_ins,
        }
    }

    /// κ of its columns.
    #[must_use]
    pub fn across(&self) -> &FigureAxis {
        &self.across
    }

    /// H of its rows; `None` where there is no H.
    #[must_use]
    pub fn up(&self) -> Option<&FigureAxis> {
        self.up.as_ref()
    }

    /// The values that are written below it, with their columns, and beside it, with their rows.
    #[must_use]
    pub fn labels(&self) -> &[Vec<(usize, String)>; 2] {
        &self.labels
    }

    /// Numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.across.values.len(), self.up.as_ref().map_or(1, |up| up.values.len()))
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

    /// Choices for the glyphs, the regime first where it is known.
    #[must_use]
    pub fn charted(&self) -> Vec<Charted> {
        let regime = self.has_regimes.then_some(Charted::Regime);
        regime.into_iter().chain(self.layers.iter().map(|layer| Charted::Quantity(layer.quantity))).collect()
    }

    /// Returns true where profiles of a cell are divided between regimes.
    #[must_use]
    pub fn is_split(&self) -> bool {
        self.is_split
    }

    /// The cell that is shown at a column and a row: itself or, while it has not been computed, one that stands
    /// for it.
    #[must_use]
    pub fn shown(&self, column: usize, row: usize) -> Option<Place<'_>> {
        let columns = self.across.values.len();
        let index = (*self.stand_ins.get(row * columns + column).filter(|_| column < columns)?)?;
        let cell = self.cells.get(index)?.as_ref()?;
        Some(Place { column: index % columns, row: index / columns, cell })
    }

    /// The column and the row of a place, between whole ones where it lies between cells.
    #[must_use]
    pub fn coordinates(&self, kappa: f64, hurst: Option<f64>) -> (f64, f64) {
        let row = self.up.as_ref().zip(hurst).map_or(0.0, |(up, hurst)| up.place(hurst));
        (self.across.place(kappa), row)
    }

    /// Returns true for a place on the map, half a cell beyond the outermost values included.
    #[must_use]
    pub fn contains(&self, kappa: f64, hurst: Option<f64>) -> bool {
        let (column, row) = self.coordinates(kappa, hurst);
        let within = |at: f64, count: usize| (-0.5..count as f64 - 0.5).contains(&at);
        let (columns, rows) = self.size();
        within(column, columns) && within(row, rows)
    }

    /// The cell that is shown for a place or, beyond the map, the one at its edge; `None` without an H where
    /// the map has one.
    #[must_use]
    pub fn nearest(&self, kappa: f64, hurst: Option<f64>) -> Option<Place<'_>> {
        if self.up.is_some() && hurst.is_none() {
            return None;
        }
        let (column, row) = self.coordinates(kappa, hurst);
        let nearest = |at: f64, count: usize| at.round().clamp(0.0, count.saturating_sub(1) as f64) as usize;
        let (columns, rows) = self.size();
        self.shown(nearest(column, columns), nearest(row, rows))
    }

    /// A layer in a cell.
    #[must_use]
    pub fn estimate(&self, layer: &Layer, column: usize, row: usize) -> Option<Estimate> {
        *layer.estimates.get(row * self.across.values.len() + column)?
    }

    /// A layer along a row, as far as it is known, by κ.
    pub fn along_kappa(&self, layer: &Layer, row: usize) -> Vec<(f64, Estimate)> {
        let values = self.across.values.iter().enumerate();
        values.filter_map(|(column, kappa)| Some((*kappa, self.estimate(layer, column, row)?))).collect()
    }

    /// A layer along a column, as far as it is known, by H.
    pub fn along_hurst(&self, layer: &Layer, column: usize) -> Vec<(f64, Estimate)> {
        let values = self.up.iter().flat_map(|up| &up.values).enumerate();
        values.filter_map(|(row, hurst)| Some((*hurst, self.estimate(layer, column, row)?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::map::{hursts, kappas};

    #[test]
    fn short_values_are_written_beside_a_map() {
        let written =
            |axis: &FigureAxis| labels(axis).into_iter().map(|(_, text)| text).collect::<Vec<_>>().join(" ");
        assert_eq!(written(&kappas()), "0.125 0.5 2 8 32");
        assert_eq!(written(&hursts()), "0.1 0.3 0.5 0.7 0.9");
        let list = |values: &[f64]| FigureAxis { values: values.to_vec(), ..hursts() };
        let fifths: Vec<f64> = (1..34).map(|index| f64::from(index) / 5.0).collect();
        assert_eq!(written(&list(&fifths)), "1 2 3 4 5 6");
        assert_eq!(written(&list(&[0.25, 4.0])), "0.25 4");
        assert_eq!((written(&list(&[3.0])), written(&list(&[]))), ("3".to_owned(), String::new()));
        let many: Vec<f64> = (0..1_000_000).map(f64::from).collect();
        assert!((LABELS.0..=LABELS.1).contains(&labels(&list(&many)).len()));
        let octaves: Vec<f64> = (-4..=8).map(|half| 2_f64.powf(f64::from(half) / 2.0)).collect();
        assert_eq!(written(&list(&octaves)), "0.25 1 4 16");
    }
}
