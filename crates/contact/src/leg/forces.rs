//! Forces and energies of a leg: along a grid of indentations, at their extremes, and where a force
//! is reached.
//!
//! At an event springs attach or detach in a jump. There the force falls or remains the same as d
//! grows; between two events it is convex. The contact at two indentations bounds the force between
//! them. Springs that attach there are stretched, or they just touch and are then compressed by at
//! most the width of the interval. Only intervals whose bounds allow the sought force are searched.

use super::{Leg, Patches};
use crate::adhesive::levels::Edges;
use crate::contact_state::{ContactState, Extreme, Grid, intervals, lower_bound, upper_bound};
use crate::error::ContactError;
use crate::history::Goal;
use crate::history::{CurvePoint, Direction, Work};
use crate::interval::{Interval, Intervals};
use crate::thresholds::Thresholds;
use asperity_data::CompensatedSum;

/// Number of intervals of the grid on which extremes are searched. Each patch is evaluated at each
/// grid point.
pub(crate) const SEARCH_INTERVALS: usize = 256;
/// Number of intervals whose events are listed together.
const AT_ONCE: usize = 16;
/// Distance, in grid points, between the points that are evaluated first.
const STRIDE: usize = 16;

impl Leg {
    /// Returns the point of the force curve of this motion at an indentation in m.
    pub fn point(&self, indentation: f64) -> Result<CurvePoint, ContactError> {
        Ok(self.state(indentation)?.point(self.contact.foundation))
    }

    /// Returns the points of the force curve of this motion at ascending indentations in m.
    pub fn curve(&self, indentations: &[f64]) -> Result<Vec<CurvePoint>, ContactError> {
        if indentations.is_empty() {
            return Ok(Vec::new());
        }
        let sampled = self.sample(Grid::at(indentations.to_vec()))?;
        Ok(sampled
            .iter()
            .map(|state| state.point(self.contact.foundation))
            .collect())
    }

    /// Returns the energy in J that springs release on the part of this leg with indentations above
    /// `low` and up to `high` in m.
    /// [`LegRecord::released_energy`](crate::history::LegRecord::released_energy) defines this
    /// energy.
    pub fn released_energy(&self, low: f64, high: f64) -> f64 {
        self.energy(self.squared_stretch(low, high))
    }

    /// Returns the energy in J that this leg releases, for a sum of the squared stretches of
    /// springs in m².
    pub(crate) fn energy(&self, squared_stretch: f64) -> f64 {
        let energy = 0.5 * self.contact.foundation.spring_stiffness() * squared_stretch;
        // Not −0 where nothing attaches with a stretch.
        if self.direction == Direction::Loading {
            0.0 - energy
        } else {
            energy
        }
    }

    pub(crate) fn state(&self, indentation: f64) -> Result<ContactState, ContactError> {
        Ok(self.sample(Grid::at(vec![indentation]))?[0])
    }

    /// Returns the leg with the instrument as springs parallel to the contact. The force of both is
    /// k D where D = d + F/k. A rigid instrument, whose displacement is the indentation, adds none.
    fn with_instrument(&self) -> Self {
        let springs = self.contact.loading_stiffness / self.contact.foundation.spring_stiffness();
        Leg {
            instrument: if springs.is_infinite() { 0.0 } else { springs },
            ..self.clone()
        }
    }

    /// Finds the indentation in m at which a motion from the indentation `from` (m) reaches its
    /// goal. The returned goal is the separation if the contact is lost on the way.
    pub(crate) fn reach(
        &self,
        goal: Goal,
        from: f64,
        work: &mut Work,
    ) -> Result<(f64, Goal), ContactError> {
        let lost = self.end.min(from);
        let end = match goal {
            Goal::Indentation(at) => at,
            Goal::Separation(_) => lost,
            Goal::Force(force) => self.reach_force(force, from, work)?,
            Goal::Displacement(at) => {
                let force = self.contact.loading_stiffness * at;
                match self.with_instrument().reach_force(force, from, work) {
                    Err(ContactError::DetachesBefore { .. }) => {
                        return Ok((lost, Goal::Separation(Some(at))));
                    }
                    end => end?,
                }
            }
        };
        Ok((end, goal))
    }

    /// Returns the contact of a sampled unloading at which the displacement of the instrument is
    /// smallest.
    pub(crate) fn least_displaced(
        &self,
        sampled: &[ContactState],
        work: &mut Work,
    ) -> Result<ContactState, ContactError> {
        let leg = self.with_instrument();
        let sampled: Vec<_> = sampled
            .iter()
            .map(|state| state.beside(leg.instrument))
            .collect();
        self.state(leg.extreme(Extreme::Smallest, &sampled, work).indentation)
    }

    /// Returns the energy in J that a compliant instrument and the moving body lose in the jumps of
    /// a sampled motion: ∫ (k (D − d) − F) dd over the jumps. `extreme` is the extreme compression
    /// of contact and instrument so far, `None` at the beginning of a motion. `from_separation` and
    /// `to_separation` are true if the motion begins or ends separated.
    pub(crate) fn jump_energy(
        &self,
        sampled: &[ContactState],
        [from_separation, to_separation]: [bool; 2],
        extreme: &mut Option<f64>,
    ) -> f64 {
        let leg = self.with_instrument();
        if leg.instrument == 0.0 || self.contact.hess.is_none() {
            return 0.0;
        }
        let loads = self.direction == Direction::Loading;
        let beside = |state: &ContactState| state.beside(leg.instrument);
        let sampled: Vec<_> = sampled.iter().map(beside).collect();
        let [low, high] = [sampled[0], sampled[sampled.len() - 1]];
        let begin = match (loads, from_separation) {
            (true, true) => leg.instrument * low.indentation,
            (true, false) => low.compression,
            (false, _) => high.compression,
        };
        let mut reached = extreme.unwrap_or(begin);
        let mut area = CompensatedSum::default();
        let pairs = intervals(&sampled, |_, _| true);
        let mut pass = |pairs: &[[ContactState; 2]]| {
            let mut events = leg.events(pairs, &mut Work::default());
            if !loads {
                events.reverse();
            }
            events
                .iter()
                .for_each(|interval| area.add(interval.jumped(loads, &mut reached)));
        };
        match loads {
            true => pairs.chunks(AT_ONCE).for_each(&mut pass),
            false => pairs.rchunks(AT_ONCE).for_each(&mut pass),
        }
        // The last loss of contact ends where nothing deflects the instrument.
        if to_separation {
            let free = low.indentation - reached / leg.instrument;
            area.add(0.5 * leg.instrument * free.max(0.0) * free);
        }
        *extreme = Some(reached);
        self.contact.foundation.spring_stiffness() * area.total()
    }

    /// Finds the indentation in m at which the force is `force` in N: the first one of a loading
    /// from `from` on, or the last one of an unloading up to `from`.
    fn reach_force(&self, force: f64, from: f64, work: &mut Work) -> Result<f64, ContactError> {
        let stiffness = self.contact.foundation.spring_stiffness();
        let wanted = force / stiffness;
        if self.direction == Direction::Unloading {
            let sampled = self.sample(Grid::new(self.end.min(from), from, SEARCH_INTERVALS))?;
            return self.last_at_most(&sampled, wanted, work).ok_or_else(|| {
                let smallest = self.extreme(Extreme::Smallest, &sampled, work).compression;
                ContactError::DetachesBefore {
                    smallest: stiffness * smallest,
                }
            });
        }
        let complete = self.end.max(from);
        if let Some(found) =
            self.first_at_least(&Grid::new(from, complete, SEARCH_INTERVALS), wanted, work)?
        {
            return Ok(found);
        }
        // Beyond full contact the force rises with all springs; a second step removes the rounding
        // of the first.
        let mut found = complete;
        for _ in 0..2 {
            let full = self.state(found)?;
            let next = found + (wanted - full.compression) / full.length;
            if full.totals.springs < self.contact.gaps().len() as i64 || !next.is_finite() {
                return Err(ContactError::OutOfReach);
            }
            found = next.max(complete);
        }
        Ok(found)
    }

    pub(crate) fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let mut sampled = match &self.patches {
            Patches::Springs(thresholds) => Thresholds::new(&self.contact, thresholds).sample(grid),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, along => along.sample(grid)),
        }?;
        if self.instrument > 0.0 {
            sampled
                .iter_mut()
                .for_each(|state| *state = state.beside(self.instrument));
        }
        Ok(sampled)
    }

    /// Computes ∫ (c − θ)² dx in cells times m² over the parts of the profile that attach or detach
    /// at an indentation θ above `low` and up to `high` (m).
    pub(crate) fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        match &self.patches {
            // No spring is stretched.
            Patches::Springs(_) => 0.0,
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along.squared_stretch(low, high))
            }
        }
    }

    /// Returns the intervals between these ascending ends, with the events inside each.
    fn events(&self, ends: &[[ContactState; 2]], work: &mut Work) -> Vec<Interval> {
        if ends.is_empty() {
            return Vec::new();
        }
        let slides = self.contact.edges == Edges::SubCell;
        let mut intervals = Intervals::new(
            ends,
            slides,
            self.contact.profile.springs.scale(),
            self.instrument,
        );
        match &self.patches {
            Patches::Springs(thresholds) => {
                Thresholds::new(&self.contact, thresholds).search(&mut intervals)
            }
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along.search(&mut intervals))
            }
        }
        intervals.finish(&mut work.events_sorted)
    }

    /// Finds the contact of the extreme force between the first and the last point of a sampled
    /// leg.
    pub(crate) fn extreme(
        &self,
        extreme: Extreme,
        leg: &[ContactState],
        work: &mut Work,
    ) -> ContactState {
        let mut best = extreme.of(leg);
        // Without adhesion the force never falls.
        if self.contact.hess.is_some() {
            let chosen = intervals(leg, |low, high| extreme.may_lie(low, high, &best));
            self.events(&chosen, work)
                .iter()
                .for_each(|interval| interval.extreme(extreme, &mut best));
        }
        best
    }

    /// Finds the contact of the smallest force of an unloading between the ends of a grid. Points
    /// of the grid are evaluated only between neighbours of a coarser grid whose bounds allow a
    /// smaller force.
    pub(crate) fn smallest(
        &self,
        grid: &Grid,
        work: &mut Work,
    ) -> Result<ContactState, ContactError> {
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let best = Extreme::Smallest.of(&coarse);
        let leg = self.refined(grid, coarse, |low, high| {
            Extreme::Smallest.may_lie(low, high, &best)
        })?;
        Ok(self.extreme(Extreme::Smallest, &leg, work))
    }

    /// Finds the smallest indentation in m, between the ends of a grid, at which the compression is
    /// at least `wanted` in m.
    fn first_at_least(
        &self,
        grid: &Grid,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let reached = |leg: &[ContactState]| {
            leg.iter()
                .find(|state| state.compression >= wanted)
                .map(|state| state.indentation)
        };
        // Behind the first point that has it nothing is sought.
        let may_lie = |end: Option<f64>| {
            let last = end.unwrap_or(f64::INFINITY);
            move |low: &ContactState, high: &ContactState| {
                high.indentation <= last && upper_bound(low, high) >= wanted
            }
        };
        let coarse_end = reached(&coarse);
        let leg = self.refined(grid, coarse, may_lie(coarse_end))?;
        let end = reached(&leg);
        let chosen = intervals(&leg, may_lie(end));
        Ok(self
            .events(&chosen, work)
            .iter()
            .find_map(|interval| interval.first_at_least(wanted))
            .or(end))
    }

    /// Evaluates a finer grid where needed. It adds to the sampled points `coarse` the points of
    /// `grid` between two neighbours for which `may_lie` is true.
    fn refined(
        &self,
        grid: &Grid,
        mut coarse: Vec<ContactState>,
        may_lie: impl Fn(&ContactState, &ContactState) -> bool,
    ) -> Result<Vec<ContactState>, ContactError> {
        let between = |[low, high]: [ContactState; 2]| {
            let place = |state: ContactState| grid.first_at_least(state.indentation);
            place(low) + 1..place(high)
        };
        let chosen = intervals(&coarse, may_lie).into_iter().flat_map(between);
        let fine: Vec<f64> = chosen.map(|index| grid.points[index]).collect();
        if !fine.is_empty() {
            coarse.extend(self.sample(Grid::at(fine))?);
            coarse.sort_by(|one, other| one.indentation.total_cmp(&other.indentation));
        }
        Ok(coarse)
    }

    /// Finds the largest indentation in m, between the ends of a sampled leg, at which the
    /// compression is at most `wanted` in m.
    fn last_at_most(&self, leg: &[ContactState], wanted: f64, work: &mut Work) -> Option<f64> {
        let reached = leg.iter().rfind(|state| state.compression <= wanted);
        let start = reached.map(|state| state.indentation);
        let first = start.unwrap_or(f64::NEG_INFINITY);
        let chosen = intervals(leg, |low, high| {
            low.indentation >= first && lower_bound(low, high) <= wanted
        });
        self.events(&chosen, work)
            .iter()
            .rev()
            .find_map(|interval| interval.last_at_most(wanted))
            .or(start)
    }
}
