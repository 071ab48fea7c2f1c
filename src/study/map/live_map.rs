//! The live map over H and κ or e_el/γ with the cells computed so far.

use super::grid::{COLUMNS, HURSTS, Level, hursts, parameter_values};
use super::model::{Layer, MapModel};
use super::template::{RECORD, Template};
use crate::study::cell_summary::CellSummary;
use crate::study::quantity::Quantity;
use std::sync::Arc;

/// A map with the cells computed so far.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    template: Arc<Template>,
    /// Cells row by row; a cell that could not be computed holds the reason.
    cells: Vec<Option<Result<CellSummary, String>>>,
}

impl LiveMap {
    /// A map without cells.
    #[must_use]
    pub fn new(template: Arc<Template>) -> Self {
        let rows = if template.has_hurst() { HURSTS } else { 1 };
        LiveMap { template, cells: vec![None; rows * COLUMNS] }
    }

    /// Template of the map.
    #[must_use]
    pub fn template(&self) -> &Arc<Template> {
        &self.template
    }

    /// Number of rows: one for a scene without H.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.cells.len() / COLUMNS
    }

    /// The rows of a level on this map.
    #[must_use]
    pub fn rows_of(&self, level: Level) -> &'static [usize] {
        if self.template.has_hurst() { level.rows() } else { &[0] }
    }

    /// A computed cell, or the reason why it could not be computed.
    #[must_use]
    pub fn cell(&self, column: usize, row: usize) -> Option<&Result<CellSummary, String>> {
        self.cells.get(row * COLUMNS + column).filter(|_| column < COLUMNS)?.as_ref()
    }

    /// The number of a cell in the plan of its template.
    pub(super) fn index(&self, column: usize, row: usize) -> u64 {
        (row * COLUMNS + column) as u64
    }

    /// Sets a cell.
    pub fn set(&mut self, column: usize, row: usize, cell: Result<CellSummary, String>) {
        if let Some(place) = self.cells.get_mut(row * COLUMNS + column).filter(|_| column < COLUMNS) {
            *place = Some(cell);
        }
    }

    /// Returns true if all cells of a level are known.
    #[must_use]
    pub fn has(&self, level: Level) -> bool {
        self.rows_of(level).iter().all(|&row| level.columns().all(|column| self.cell(column, row).is_some()))
    }

    /// The finest complete level.
    #[must_use]
    pub fn level(&self) -> Option<Level> {
        Level::ALL.into_iter().take_while(|level| self.has(*level)).last()
    }

    /// Returns true for a complete map.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.has(self.template.finest())
    }

    /// The computed cell shown for this cell: itself or, until it is computed, one of a coarser level.
    fn stand_in(&self, column: usize, row: usize) -> Option<usize> {
        let near = |all: &mut dyn Iterator<Item = usize>, wanted: usize| {
            all.min_by_key(|one| one.abs_diff(wanted)).unwrap_or(wanted)
        };
        Level::ALL.into_iter().rev().find_map(|level| {
            let column = near(&mut level.columns(), column);
            let row = near(&mut self.rows_of(level).iter().copied(), row);
            self.cell(column, row).map(|_| row * COLUMNS + column)
        })
    }

    /// The map for display.
    #[must_use]
    pub fn model(&self) -> MapModel {
        let cells: Vec<_> = self.cells.iter().map(|cell| cell.as_ref().map(Result::as_ref)).collect();
        let estimates = |column| cells.iter().map(|cell| (*cell)?.ok()?.estimate(column)).collect();
        let record = RECORD.into_iter().enumerate();
        let drawn = record.filter(|(_, quantity)| *quantity != Quantity::Regime);
        let map_model = MapModel::new(
            (parameter_values(self.template.parameter()), self.template.has_hurst().then(hursts)),
            drawn.map(|(column, quantity)| Layer::new(quantity, estimates(column))).collect(),
            &cells,
            (0..cells.len()).map(|index| self.stand_in(index % COLUMNS, index / COLUMNS)).collect(),
        );
        // As in the paper: H across, κ up; e_el/γ likewise.
        map_model.transposed()
    }
}
