//! The cells of a map.

use super::Basis;
use super::grid::{HURSTS, KAPPAS, Level, hurst, kappa};
use crate::analysis::Regime;
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
    /// The regime of these forces.
    pub regime: Regime,
    /// Lines that are in this regime each by itself.
    pub agreeing: u64,
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
pub struct PhaseMap {
    basis: Arc<Basis>,
    /// Row by row; a cell that could not be computed has the reason.
    cells: Vec<Option<Result<Cell, String>>>,
}

impl PhaseMap {
    /// A map of which nothing is known.
    #[must_use]
    pub fn new(basis: Arc<Basis>) -> Self {
        let rows = if basis.has_hurst() { HURSTS } else { 1 };
        PhaseMap { basis, cells: vec![None; rows * KAPPAS] }
    }

    /// What it belongs to.
    #[must_use]
    pub fn basis(&self) -> &Arc<Basis> {
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

    /// The computed cell nearest to a place, and its column and row. Rows count as much as columns.
    #[must_use]
    pub fn nearest(
        &self,
        wanted_kappa: f64,
        wanted_hurst: f64,
    ) -> Option<(usize, usize, &Result<Cell, String>)> {
        let column = (4.0 * wanted_kappa.log2() + 12.0).clamp(0.0, (KAPPAS - 1) as f64);
        let row = (wanted_hurst * 20.0 - 1.0).clamp(0.0, (self.rows() - 1) as f64);
        let far = |at: &(usize, usize)| (at.0 as f64 - column).hypot(at.1 as f64 - row);
        let places = (0..self.rows()).flat_map(|row| (0..KAPPAS).map(move |column| (column, row)));
        let (column, row) = places
            .filter(|&(column, row)| self.cell(column, row).is_some())
            .min_by(|one, other| far(one).total_cmp(&far(other)))?;
        Some((column, row, self.cell(column, row)?))
    }

    /// The cells of a row that are there, by κ.
    pub fn along_kappa(&self, row: usize) -> impl Iterator<Item = (f64, &Cell)> {
        (0..KAPPAS).filter_map(move |column| Some((kappa(column), self.cell(column, row)?.as_ref().ok()?)))
    }

    /// The cells of a column that are there, by H.
    pub fn along_hurst(&self, column: usize) -> impl Iterator<Item = (f64, &Cell)> {
        (0..self.rows()).filter_map(move |row| Some((hurst(row), self.cell(column, row)?.as_ref().ok()?)))
    }
}
