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
use crate::detachment::ContactRule;
use crate::error::ContactError;
use crate::history::{CurvePoint, Direction, Goal, Work};
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

/// Ends of a motion at which the body is separated.
#[derive(Clone, Copy)]
pub(crate) struct SeparatedEnds {
    pub at_begin: bool,
    pub at_end: bool,
}

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
        let foundation = self.contact.foundation;
        Ok(sampled
            .iter()
            .map(|state| state.point(foundation))
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
        let separation = self.end.min(from);
        let end = match goal {
            Goal::Indentation(indentation) => indentation,
            Goal::Separation(_) => separation,
            Goal::Force(force) => self.reach_force(force, from, work)?,
            Goal::Displacement(displacement) => {
                let force = self.contact.loading_stiffness * displacement;
                match self.with_instrument().reach_force(force, from, work) {
                    Err(ContactError::DetachesBefore { .. }) => {
                        return Ok((separation, Goal::Separation(Some(displacement))));
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
        let sampled = leg.beside_instrument(sampled);
        self.state(leg.extreme(Extreme::Smallest, &sampled, work).indentation)
    }

    /// Adds the instrument of this leg to the states of the contact.
    fn beside_instrument(&self, sampled: &[ContactState]) -> Vec<ContactState> {
        let states = sampled.iter();
        states.map(|state| state.beside(self.instrument)).collect()
    }

    /// Returns the energy in J that a compliant instrument and the moving body lose in the jumps of
    /// a sampled motion: ∫ (k (D − d) − F) dd over the jumps. `extreme` is the extreme compression
    /// of contact and instrument so far, `None` at the beginning of a motion.
    pub(crate) fn jump_energy(
        &self,
        sampled: &[ContactState],
        separated: SeparatedEnds,
        extreme: &mut Option<f64>,
    ) -> f64 {
        let leg = self.with_instrument();
        if leg.instrument == 0.0 || !self.contact.has_adhesion() {
            return 0.0;
        }
        let sampled = leg.beside_instrument(sampled);
        let low = sampled[0];
        let high = sampled[sampled.len() - 1];
        let begin = match self.direction {
            Direction::Loading if separated.at_begin => leg.instrument * low.indentation,
            Direction::Loading => low.compression,
            Direction::Unloading => high.compression,
        };
        let mut reached = extreme.unwrap_or(begin);
        let mut area = CompensatedSum::default();
        let pairs = intervals(&sampled, |_, _| true);
        match self.direction {
            Direction::Loading => {
                for pairs in pairs.chunks(AT_ONCE) {
                    for interval in &leg.events(pairs, &mut Work::default()) {
                        area.add(interval.jumped_on_loading(&mut reached));
                    }
                }
            }
            Direction::Unloading => {
                for pairs in pairs.rchunks(AT_ONCE) {
                    for interval in leg.events(pairs, &mut Work::default()).iter().rev() {
                        area.add(interval.jumped_on_unloading(&mut reached));
                    }
                }
            }
        }
        // The last loss of contact ends where nothing deflects the instrument.
        if separated.at_end {
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
        if self.direction == Direction::Loading {
            return self.reach_on_loading(wanted, from, work);
        }
        let sampled = self.sample(Grid::new(self.end.min(from), from, SEARCH_INTERVALS))?;
        if let Some(indentation) = self.last_at_most(&sampled, wanted, work) {
            return Ok(indentation);
        }
        let smallest = self.extreme(Extreme::Smallest, &sampled, work);
        Err(ContactError::DetachesBefore {
            smallest: stiffness * smallest.compression,
        })
    }

    /// Finds the first indentation in m, from `from` on, at which the compression of a loading is
    /// `wanted` in m.
    fn reach_on_loading(
        &self,
        wanted: f64,
        from: f64,
        work: &mut Work,
    ) -> Result<f64, ContactError> {
        let complete = self.end.max(from);
        let grid = Grid::new(from, complete, SEARCH_INTERVALS);
        if let Some(indentation) = self.first_at_least(&grid, wanted, work)? {
            return Ok(indentation);
        }
        // Beyond full contact the force rises with all springs; a second step removes the rounding
        // of the first.
        let mut indentation = complete;
        for _ in 0..2 {
            let full = self.state(indentation)?;
            let next = indentation + (wanted - full.compression) / full.length;
            if full.totals.springs < self.contact.gaps().len() as i64 || !next.is_finite() {
                return Err(ContactError::OutOfReach);
            }
            indentation = next.max(complete);
        }
        Ok(indentation)
    }

    /// Computes the contact of this leg, beside the instrument in searches, at the points of a
    /// grid.
    pub(crate) fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let mut sampled = match &self.patches {
            Patches::Springs(thresholds) => Thresholds::new(&self.contact, thresholds).sample(grid),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, along => along.sample(grid)),
        }?;
        if self.instrument > 0.0 {
            for state in &mut sampled {
                *state = state.beside(self.instrument);
            }
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
    fn events(&self, ends: &[[ContactState; 2]], work: &mut Work) -> Vec<Interval<ContactRule>> {
        if ends.is_empty() {
            return Vec::new();
        }
        let slides = self.contact.edges == Edges::SubCell;
        let scale = self.contact.profile.springs.scale();
        let mut intervals = Intervals::new(ends, slides, scale, self.instrument);
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
        let mut best = extreme.among(leg);
        // Without adhesion the force never falls.
        if self.contact.has_adhesion() {
            let chosen = intervals(leg, |low, high| extreme.may_lie(low, high, &best));
            for interval in &self.events(&chosen, work) {
                interval.extreme(extreme, &mut best);
            }
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
        let best = Extreme::Smallest.among(&coarse);
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
        // Nothing is sought after the first point with that compression.
        let may_lie = |first: Option<f64>, low: &ContactState, high: &ContactState| {
            high.indentation <= first.unwrap_or(f64::INFINITY) && upper_bound(low, high) >= wanted
        };
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let first_of_coarse = first_point_at_least(&coarse, wanted);
        let leg = self.refined(grid, coarse, |low, high| {
            may_lie(first_of_coarse, low, high)
        })?;
        let first = first_point_at_least(&leg, wanted);
        let chosen = intervals(&leg, |low, high| may_lie(first, low, high));
        for interval in &self.events(&chosen, work) {
            if let Some(indentation) = interval.first_at_least(wanted) {
                return Ok(Some(indentation));
            }
        }
        Ok(first)
    }

    /// Evaluates a finer grid where needed. It adds to the sampled points `coarse` the points of
    /// `grid` between two neighbours for which `may_lie` is true.
    fn refined(
        &self,
        grid: &Grid,
        mut coarse: Vec<ContactState>,
        may_lie: impl Fn(&ContactState, &ContactState) -> bool,
    ) -> Result<Vec<ContactState>, ContactError> {
        let mut fine = Vec::new();
        for [low, high] in intervals(&coarse, may_lie) {
            let after_low = grid.first_at_least(low.indentation) + 1;
            let end = grid.first_at_least(high.indentation);
            if after_low < end {
                fine.extend_from_slice(&grid.points[after_low..end]);
            }
        }
        if !fine.is_empty() {
            coarse.extend(self.sample(Grid::at(fine))?);
            coarse.sort_by(|state, other| state.indentation.total_cmp(&other.indentation));
        }
        Ok(coarse)
    }

    /// Finds the largest indentation in m, between the ends of a sampled leg, at which the
    /// compression is at most `wanted` in m.
    fn last_at_most(&self, leg: &[ContactState], wanted: f64, work: &mut Work) -> Option<f64> {
        let last = leg.iter().rfind(|state| state.compression <= wanted);
        let last = last.map(|state| state.indentation);
        let chosen = intervals(leg, |low, high| {
            low.indentation >= last.unwrap_or(f64::NEG_INFINITY) && lower_bound(low, high) <= wanted
        });
        for interval in self.events(&chosen, work).iter().rev() {
            if let Some(indentation) = interval.last_at_most(wanted) {
                return Some(indentation);
            }
        }
        last
    }
}

/// Returns the smallest indentation in m among the points of a sampled leg at which the compression
/// is at least `wanted` in m.
fn first_point_at_least(leg: &[ContactState], wanted: f64) -> Option<f64> {
    let first = leg.iter().find(|state| state.compression >= wanted)?;
    Some(first.indentation)
}
