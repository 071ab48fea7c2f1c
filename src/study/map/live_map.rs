//! The cells of a map.

use super::Template;
use super::grid::{HURSTS, KAPPAS, Level, hursts, kappas};
use super::model::{Layer, MapCell, MapModel, usual};
use crate::analysis::CellRegime;
use crate::study::Quantity;
use crate::study::figure::Estimate;
use std::sync::Arc;

/// What the lines of a cell give in the mean; forces in N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// F_a(0), by the touch protocol.
    pub zero_load_adhesion: f64,
    /// F_a of the scene's own loading; zero where it pulls nothing.
    pub adhesion: f64,
    /// Preload F_n.
    pub preload: f64,
    /// Ideal adhesion force F_a,max, eq. (14).
    pub ideal_adhesion: f64,
    /// Regime of its lines; `None` where nothing is pulled.
    pub regime: Option<CellRegime>,
}

impl Cell {
    /// F_a(0)/F_a,max.
    #[must_use]
    pub fn zero_load_share(&self) -> f64 {
        self.zero_load_adhesion / self.ideal_adhesion
    }

    /// F_a/F_n; `None` without a preload.
    #[must_use]
    pub fn coefficient(&self) -> Option<f64> {
        Some(self.adhesion / self.preload).filter(|share| self.preload > 0.0 && share.is_finite())
    }
}

/// A map, as far as it has been computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    basis: Arc<Template>,
    /// Row by row; a cell that could not be computed has the reason.
    cells: Vec<Option<Result<Cell, String>>>,
}

impl LiveMap {
    /// A map of which nothing is known.
    #[must_use]
    pub fn new(basis: Arc<Template>) -> Self {
        let rows = if basis.has_hurst() { HURSTS } else { 1 };
        LiveMap { basis, cells: vec![None; rows * KAPPAS] }
    }

    /// What it belongs to.
    #[must_use]
    pub fn basis(&self) -> &Arc<Template> {
        &self.basis
    }

    /// Its rows: one where there is no H.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.cells.len() / KAPPAS
    }

    /// The rows that a level has of it.
    #[must_use]
    pub fn rows_of(&self, level: Level) -> &'static [usize] {
        if self.basis.has_hurst() { level.rows() } else { &[0] }
    }

    /// A cell, once it has been computed, or why it could not be.
    #[must_use]
    pub fn cell(&self, column: usize, row: usize) -> Option<&Result<Cell, String>> {
        self.cells.get(row * KAPPAS + column).filter(|_| column < KAPPAS)?.as_ref()
    }

    /// Sets a cell.
    pub fn set(&mut self, column: usize, row: usize, cell: Result<Cell, String>) {
        if let Some(place) = self.cells.get_mut(row * KAPPAS + column).filter(|_| column < KAPPAS) {
            *place = Some(cell);
        }
    }

    /// Whether all cells of a level are there.
    #[must_use]
    pub fn has(&self, level: Level) -> bool {
        self.rows_of(level).iter().all(|&row| level.columns().all(|column| self.cell(column, row).is_some()))
    }

    /// The finest level that is there whole.
    #[must_use]
    pub fn level(&self) -> Option<Level> {
        Level::ALL.into_iter().take_while(|level| self.has(*level)).last()
    }

    /// Whether nothing of it is missing.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.has(self.basis.finest())
    }

    /// The computed cell that stands for one: itself or, while it has not been computed, one of a coarser
    /// level.
    fn stand_in(&self, column: usize, row: usize) -> Option<usize> {
        let near = |all: &mut dyn Iterator<Item = usize>, wanted: usize| {
            all.min_by_key(|one| one.abs_diff(wanted)).unwrap_or(wanted)
        };
        Level::ALL.into_iter().rev().find_map(|level| {
            let column = near(&mut level.columns(), column);
            let row = near(&mut self.rows_of(level).iter().copied(), row);
            self.cell(column, row).map(|_| row * KAPPAS + column)
        })
    }

    /// The map as it is shown.
    #[must_use]
    pub fn plane(&self) -> MapModel {
        let lines = self.basis.lines();
        let spot = |cell: &Result<Cell, String>| match cell {
            Ok(cell) => Ok(MapCell::new(cell.regime, lines)),
            Err(why) => Err(why.clone()),
        };
        let layer = |quantity: Quantity, value: fn(&Cell) -> Option<f64>| {
            let (scale, steps) = usual(quantity)?;
            // Of so few lines no confidence is told.
            let estimate = |cell: &Option<Result<Cell, String>>| {
                let mean = value(cell.as_ref()?.as_ref().ok()?)?;
                Some(Estimate { mean, low: mean, high: mean })
            };
            Some(Layer { quantity, scale, steps, estimates: self.cells.iter().map(estimate).collect() })
        };
        let layers = [
            layer(Quantity::ZeroLoadAdhesionShare, |cell| Some(cell.zero_load_share())),
            layer(Quantity::AdhesionCoefficient, Cell::coefficient),
        ];
        MapModel::new(
            (kappas(), self.basis.has_hurst().then(hursts)),
            layers.into_iter().flatten().collect(),
            self.cells.iter().map(|cell| cell.as_ref().map(spot)).collect(),
            (0..self.cells.len()).map(|index| self.stand_in(index % KAPPAS, index / KAPPAS)).collect(),
        )
    }
}
