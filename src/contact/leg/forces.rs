//! Forces and energies of a leg: along a grid of indentations, at their extremes, and where a force is reached.

use super::{Leg, Patches};
use crate::contact::adhesive::{EdgeCells, GridEdges, Run, Search, SubCellEdges};
use crate::contact::contact_state::{ContactState, Extreme, Sampled};
use crate::contact::grid::Grid;
use crate::contact::totals::ContactTotals;
use crate::contact::{
    Contact, ContactError, ContactTree, CurvePoint, Direction, Edges, Nonadhesive, TWO_THREADS, Work,
};
use crate::parallel::in_parallel;

/// Intervals in which extremes are searched: each patch is evaluated at each of their ends.
pub(in crate::contact) const SEARCH_INTERVALS: usize = 256;

impl Leg {
    /// Returns the point of the curve at an indentation, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn point(&self, indentation: f64) -> Result<CurvePoint, ContactError> {
        Ok(self.state(indentation)?.point(self.contact.foundation))
    }

    /// Returns the points of the curve at ascending indentations, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn curve(&self, indentations: &[f64]) -> Result<Vec<CurvePoint>, ContactError> {
        if indentations.is_empty() {
            return Ok(Vec::new());
        }
        let sampled = self.sample(Grid::at(indentations.to_vec()))?;
        Ok(sampled.states.iter().map(|state| state.point(self.contact.foundation)).collect())
    }

    /// Returns the first indentation of a loading from `from` on, or the last one of an unloading up to `from`, m, at which
    /// the force is `force`, N.
    ///
    /// # Errors
    /// [`ContactError::OutOfReach`], [`ContactError::DetachesBefore`], [`ContactError::OutOfMemory`].
    pub fn find_force(&self, force: f64, from: f64) -> Result<f64, ContactError> {
        self.reach_force(force, from, &mut Work::default())
    }

    /// Returns the points of the smallest and of the largest force between two indentations, m, exact to rounding.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn extremes(&self, low: f64, high: f64) -> Result<[CurvePoint; 2], ContactError> {
        let sampled = self.sample(self.search_grid(low, high))?;
        let of = |extreme| self.extreme(extreme, &sampled, &mut Work::default());
        Ok([Extreme::Smallest, Extreme::Largest].map(|extreme| of(extreme).point(self.contact.foundation)))
    }

    /// Returns the energy that springs release on the indentations from `low` to `high`, m, in J; see
    /// [`LegRecord::released_energy`](crate::contact::LegRecord::released_energy).
    #[must_use]
    pub fn released_energy(&self, low: f64, high: f64) -> f64 {
        let energy = 0.5 * self.contact.foundation.spring_stiffness() * self.squared_stretch(low, high);
        // Not −0 where nothing attaches with a stretch.
        if self.direction == Direction::Loading { 0.0 - energy } else { energy }
    }

    /// Contact state at an indentation, m.
    pub(in crate::contact) fn state(&self, indentation: f64) -> Result<ContactState, ContactError> {
        Ok(self.sample(Grid::at(vec![indentation]))?.first())
    }

    /// Grid of a search between two indentations, m: for springs with thresholds, between which the force is straight,
    /// each threshold and the number before it.
    fn search_grid(&self, low: f64, high: f64) -> Grid {
        let Patches::Thresholds(thresholds) = &self.patches else {
            return Grid::new(low, high, SEARCH_INTERVALS);
        };
        let inside = thresholds.iter().copied().filter(|at| low < *at && *at <= high);
        let mut points: Vec<f64> = inside.flat_map(|at| [at.next_down(), at]).chain([low, high]).collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        Grid::at(points)
    }

    /// Contact of whole springs at an indentation, m, patch by patch.
    fn totals(&self, indentation: f64) -> ContactTotals {
        let mut totals = ContactTotals::default();
        for ends in self.patches(indentation) {
            totals +=
                ContactTotals::of_patch(self.contact.gaps(), ends, Edges::Grid, self.contact.springs.scale());
        }
        totals
    }

    /// Finds the indentation of [`Leg::find_force`], m.
    pub(in crate::contact) fn reach_force(
        &self,
        force: f64,
        from: f64,
        work: &mut Work,
    ) -> Result<f64, ContactError> {
        let Contact { springs, foundation, edges, .. } = &self.contact;
        let stiffness = foundation.spring_stiffness();
        let wanted = force / stiffness;
        work.springs_tallied += work.springs;
        if self.direction == Direction::Unloading {
            let sampled = self.sample(self.search_grid(self.end.min(from), from))?;
            return self.last_at_most(&sampled, wanted, work)?.ok_or_else(|| {
                let smallest = self.extreme(Extreme::Smallest, &sampled, work).compression;
                ContactError::DetachesBefore { smallest: stiffness * smallest }
            });
        }
        let complete = self.end.max(from);
        if let Some(found) = self.first_at_least(self.search_grid(from, complete), wanted, work)? {
            return Ok(found);
        }
        if self.is_stepwise() {
            return Err(ContactError::OutOfReach);
        }
        // Beyond full contact the force rises with all springs.
        let full = self.sample(Grid::at(vec![complete]))?;
        let found = match edges {
            Edges::Grid => full.totals[0].indentation(wanted, &springs.scale()),
            Edges::SubCell => Some(complete + (wanted - full.first().compression) / full.first().length),
        };
        let found = found.filter(|found| found.is_finite()).map(|found| found.max(complete));
        found.ok_or(ContactError::OutOfReach)
    }

    /// Contact states along a grid.
    pub(in crate::contact) fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => search.sample(grid)),
            Patches::Gaps => self.nonadhesive().sample(grid),
            Patches::Apart | Patches::Thresholds(_) => {
                let scale = self.contact.springs.scale();
                let totals: Vec<_> = grid.points().iter().map(|&at| self.totals(at)).collect();
                let whole = |(&at, totals): (&f64, &ContactTotals)| {
                    ContactState::new(false, at, *totals, EdgeCells::default(), &scale)
                };
                let states = grid.points().iter().zip(&totals).map(whole).collect();
                Ok(Sampled { grid, totals, states })
            }
        }
    }

    /// Contact states along a grid, and ∫ (c − θ)² dx over the parts of the line that attach or detach at an indentation
    /// θ above `low` (m) and up to the end of the grid, in cells times m².
    pub(in crate::contact) fn sample_changes(
        &self,
        grid: Grid,
        low: f64,
    ) -> Result<(Sampled, f64), ContactError> {
        let (is_long, high) = (self.contact.gaps().len() >= TWO_THREADS, grid.high());
        let (sampled, squared) =
            in_parallel(is_long, || self.sample(grid), || self.squared_stretch(low, high));
        Ok((sampled?, squared))
    }

    /// ∫ (c − θ)² dx over the parts of the line that attach or detach at an indentation θ in a range, m, without its lower
    /// end, in cells times m².
    pub(in crate::contact) fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.squared_stretch(low, high))
            }
            // No spring is stretched.
            _ => 0.0,
        }
    }

    /// Extreme force on the range of a grid.
    pub(in crate::contact) fn extreme(
        &self,
        extreme: Extreme,
        sampled: &Sampled,
        work: &mut Work,
    ) -> ContactState {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.extreme(extreme, sampled, &mut work.events_sorted))
            }
            // Without adhesion the force never falls; springs with thresholds are sampled at all of them.
            _ => extreme.of(sampled),
        }
    }

    /// Smallest force of an unloading on the range of a grid.
    pub(in crate::contact) fn smallest(
        &self,
        grid: &Grid,
        work: &mut Work,
    ) -> Result<ContactState, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.smallest(grid, &mut work.events_sorted))
            }
            _ => self.state(grid.points()[0]),
        }
    }

    /// Smallest indentation of a grid at which the compression is at least `wanted`.
    pub(in crate::contact) fn first_at_least(
        &self,
        grid: Grid,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                search.first_at_least(&grid, wanted, &mut work.events_sorted)
            }),
            _ => self.nonadhesive().first_at_least(&self.sample(grid)?, wanted),
        }
    }

    /// Largest indentation of a grid at which the compression is at most `wanted`.
    pub(in crate::contact) fn last_at_most(
        &self,
        sampled: &Sampled,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                Ok(search.last_at_most(sampled, wanted, &mut work.events_sorted))
            }),
            _ => self.nonadhesive().last_at_most(sampled, wanted),
        }
    }

    fn nonadhesive(&self) -> Nonadhesive<'_> {
        Nonadhesive::new(&self.contact.springs, self.contact.edges)
    }
}
