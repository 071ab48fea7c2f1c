//! The force of whole springs: Σ (d − c) over those in contact, as the paper counts it.

use super::law::{Contact, Standing};
use super::ledger::{Grid, Ledger};
use super::search::{self, Extreme};
use super::springs::Thresholds;
use super::tally::Tally;
use super::{ContactError, LegContact, Work};

/// Springs of which each carries its own compression and nothing lies between them.
pub struct WholeSprings<T>(pub T);

impl<T: Thresholds> WholeSprings<T> {
    fn standing(&self, indentation: f64, tally: Tally, compression: f64) -> Standing {
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.springs as f64,
            compression,
        }
    }

    fn extreme(&self, Extreme { compression, indentation, tally }: Extreme) -> Standing {
        self.standing(indentation, tally, compression)
    }
}

impl<T: Thresholds> Contact for WholeSprings<T> {
    type Leg = Ledger;

    const SEARCH_INTERVALS: usize = 1024;

    fn count(&self) -> u64 {
        self.0.count()
    }

    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64 {
        self.0.load(from, work)
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> f64 {
        self.0.unload(from, work)
    }

    fn sample(&self, grid: Grid) -> Ledger {
        Ledger::new(&self.0, grid)
    }

    fn sample_joins(&self, grid: Grid, _: bool) -> (Ledger, f64) {
        let (ledger, joined) = Ledger::with_stretches(&self.0, grid);
        (ledger, joined.inside + joined.below)
    }

    fn sample_leaves(&self, grid: Grid, separates: bool) -> (Ledger, f64) {
        let (ledger, left) = Ledger::with_stretches(&self.0, grid);
        (ledger, if separates { left.inside + left.below } else { left.inside })
    }

    fn grid<'l>(&self, leg: &'l Ledger) -> &'l Grid {
        &leg.grid
    }

    fn at(&self, leg: &Ledger, index: usize) -> Standing {
        let compression = leg.compression(index, self.0.scale());
        self.standing(leg.grid.points()[index], leg.tallies[index], compression)
    }

    fn smallest(&self, leg: &Ledger, sorted: &mut u64) -> Standing {
        self.extreme(search::smallest(leg, &self.0, sorted))
    }

    fn largest(&self, leg: &Ledger, sorted: &mut u64) -> Standing {
        self.extreme(search::largest(leg, &self.0, sorted))
    }

    fn first_at_least(&self, leg: &Ledger, wanted: f64, sorted: &mut u64) -> Option<f64> {
        search::first_at_least(leg, &self.0, wanted, sorted)
    }

    fn last_at_most(&self, leg: &Ledger, wanted: f64, sorted: &mut u64) -> Option<f64> {
        search::last_at_most(leg, &self.0, wanted, sorted)
    }

    fn beyond(&self, leg: &Ledger, wanted: f64) -> Option<f64> {
        leg.tallies[leg.intervals()].indentation(wanted, self.0.scale())
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.0.thresholds_along_line(out);
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        self.0.copy_leg(copy)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        self.0.fragments(indentation)
    }
}
