//! Forces and energies of a stage: on a grid of indentations, at the extremes of the force, and at
//! the indentation at which the force reaches a value. A stage is the contact at all indentations
//! of a motion in one direction.
//!
//! An event is an indentation at which springs attach or detach in a jump. While the indentation d
//! grows, the force does not rise in such a jump, and between two events the force is convex. The
//! contact at two indentations therefore gives bounds of the force between them. Springs that
//! attach in between are either stretched, or just touch and are then compressed by at most the
//! difference of the two indentations. A search examines only those intervals whose bounds allow
//! the sought force.

use super::{Patches, Stage};
use crate::adhesive::levels::Edges;
use crate::contact_state::{ContactState, Extreme, Grid, intervals, lower_bound, upper_bound};
use crate::detachment::ContactRule;
use crate::error::ContactError;
use crate::history::{CurvePoint, Direction, ForcePoint, Goal, StageRecord, Work};
use crate::interval::{Interval, Intervals, Jumped};
use crate::thresholds::Thresholds;
use asperity_data::CompensatedSum;

/// Number of intervals of the grid on which extremes are searched. Each patch is evaluated at each
/// point of the grid.
pub(crate) const SEARCH_INTERVALS: usize = 256;
/// Width of a jump of the instrument, as a share of the way of the motion, below which it is due to
/// rounding.
const ROUNDING: f64 = 1e-12;
/// Number of intervals whose events are listed at the same time.
const AT_ONCE: usize = 16;
/// Distance, in grid points, between the points that a search evaluates before it evaluates points
/// between them.
const STRIDE: usize = 16;

/// Jump of the body at one displacement of a compliant instrument: where the force of the contact
/// changes faster than the instrument can follow, the body moves on to the next indentation at
/// which the two forces are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct InstrumentJump {
    /// Displacement in m of the drive of the instrument.
    pub displacement: f64,
    /// Indentation in m before the jump.
    pub from: f64,
    /// Indentation in m after the jump.
    pub to: f64,
    /// Energy in J that the instrument and the body lose, a positive number. Springs that attach or
    /// detach in between have energies of their own.
    pub energy: f64,
}

/// States whether the body is separated at the beginning and at the end of a motion.
#[derive(Clone, Copy)]
pub(crate) struct SeparatedEnds {
    pub at_begin: bool,
    pub at_end: bool,
}

impl Stage {
    /// Returns the point of the force curve of this motion at an indentation in m.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn point(&self, indentation: f64) -> Result<CurvePoint, ContactError> {
        Ok(self.state(indentation)?.point(&self.contact))
    }

    /// Returns the points of the force curve of this motion at ascending indentations in m.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn curve(&self, indentations: &[f64]) -> Result<Vec<CurvePoint>, ContactError> {
        let states = self.states(indentations)?;
        Ok(states
            .iter()
            .map(|state| state.point(&self.contact))
            .collect())
    }

    /// Returns the point of the force curve of this motion at an indentation in m, without the
    /// stored energy.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn force(&self, indentation: f64) -> Result<ForcePoint, ContactError> {
        Ok(self.state(indentation)?.force_point(&self.contact))
    }

    /// Returns the points of the force curve of this motion at ascending indentations in m, without
    /// the stored energy, whose computation takes about as long as that of the force.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    ///
    /// ```
    /// use asperity_contact::motion::Stage;
    /// use asperity_contact::{Contact, ForcePoint, Modulus, Profile};
    ///
    /// let profile = Profile::from_heights(vec![0.0, -9.0e-8, -1.0e-8], 1.0e-6)?;
    /// let contact = Contact::builder(&profile, Modulus::effective(1.0e6)?).build()?;
    /// let loading = Stage::approach(&contact)?;
    /// let forces = loading.forces(&[1.0e-8, 2.0e-8])?;
    /// let curve = loading.curve(&[1.0e-8, 2.0e-8])?;
    /// assert_eq!(forces[1], ForcePoint::from(&curve[1]));
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn forces(&self, indentations: &[f64]) -> Result<Vec<ForcePoint>, ContactError> {
        let states = self.states(indentations)?;
        Ok(states
            .iter()
            .map(|state| state.force_point(&self.contact))
            .collect())
    }

    /// Computes the contact at ascending indentations in m, of which there may be none.
    fn states(&self, indentations: &[f64]) -> Result<Vec<ContactState>, ContactError> {
        if indentations.is_empty() {
            return Ok(Vec::new());
        }
        self.sample(Grid::at(indentations.to_vec()))
    }

    /// Returns the energy in J that springs release on this motion at indentations above `low` and
    /// up to `high` (m). It is the elastic energy released on detaching, minus the elastic energy
    /// gained on attaching.
    pub fn released_energy(&self, low: f64, high: f64) -> f64 {
        self.energy(self.squared_stretch(low, high))
    }

    /// Converts a sum of squared stretches in m² to the energy in J that springs release on this
    /// stage. The sum is over springs that attach or detach, each with its stretch at this moment.
    pub(crate) fn energy(&self, squared_stretch: f64) -> f64 {
        let energy = 0.5 * self.contact.foundation.spring_stiffness() * squared_stretch;
        // 0.0 − energy instead of −energy, so that an energy of zero is not −0.
        if self.direction == Direction::Loading {
            0.0 - energy
        } else {
            energy
        }
    }

    pub(crate) fn state(&self, indentation: f64) -> Result<ContactState, ContactError> {
        Ok(self.sample(Grid::at(vec![indentation]))?[0])
    }

    /// Returns the stage together with the instrument, which counts as springs parallel to the
    /// contact. Their common force is k D with D = d + F/k. If the instrument is rigid, its
    /// displacement is the indentation, and no springs are added.
    fn with_instrument(&self) -> Self {
        let springs = self.contact.loading_stiffness / self.contact.foundation.spring_stiffness();
        Stage {
            instrument: if springs.is_infinite() { 0.0 } else { springs },
            ..self.clone()
        }
    }

    /// Finds the indentation in m at which a motion ends, and the goal that the motion reaches
    /// there. The motion begins at the indentation `from` in m. The returned goal is `goal`, or
    /// separation if the contact is lost before `goal` is reached.
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

    /// Returns the contact at which the displacement of the drive of the instrument is smallest on
    /// a sampled unloading.
    pub(crate) fn least_displaced(
        &self,
        sampled: &[ContactState],
        work: &mut Work,
    ) -> Result<ContactState, ContactError> {
        let stage = self.with_instrument();
        let sampled = stage.beside_instrument(sampled);
        self.state(stage.extreme(Extreme::Smallest, &sampled, work).indentation)
    }

    /// Adds the springs that represent the instrument to the states of the contact.
    fn beside_instrument(&self, sampled: &[ContactState]) -> Vec<ContactState> {
        let states = sampled.iter();
        states.map(|state| state.beside(self.instrument)).collect()
    }

    /// Returns the energy in J that a compliant instrument and the moving body lose in the jumps of
    /// a sampled motion. The energy is ∫ (k (D − d) − F) dd over the jumps, where D is the
    /// displacement of the instrument and k the stiffness of the instrument. `extreme` is the
    /// extreme compression in m of contact and instrument together, so far on this motion. It is
    /// `None` at the beginning of a motion.
    pub(crate) fn jump_energy(
        &self,
        sampled: &[ContactState],
        separated: SeparatedEnds,
        extreme: &mut Option<f64>,
    ) -> f64 {
        let mut area = CompensatedSum::default();
        self.each_jump(sampled, separated, extreme, &mut |jumped| {
            area.add(jumped.area)
        });
        self.contact.foundation.spring_stiffness() * area.total()
    }

    /// Finds the jumps of a compliant instrument on a recorded motion, in the order of the motion.
    /// `extreme` is as in [`Self::jump_energy`].
    pub(crate) fn instrument_jumps(
        &self,
        record: &StageRecord,
        extreme: &mut Option<f64>,
    ) -> Result<Vec<InstrumentJump>, ContactError> {
        let is_free = |point: Option<&CurvePoint>| point.is_none_or(|point| point.springs == 0);
        let separated = SeparatedEnds {
            at_begin: is_free(record.curve.first()),
            at_end: is_free(record.curve.last()),
        };
        let [low, high] = record.passed();
        let curve = record.curve.iter().map(|point| point.indentation);
        let mut indentations: Vec<f64> = curve
            .filter(|indentation| (low..=high).contains(indentation))
            .collect();
        indentations.sort_by(f64::total_cmp);
        indentations.dedup();
        let way = match (indentations.first(), indentations.last()) {
            (Some(first), Some(last)) => last - first,
            _ => return Ok(Vec::new()),
        };
        let sampled = self.sample(Grid::at(indentations))?;
        let mut parts: Vec<Jumped> = Vec::new();
        let unloads = self.direction == Direction::Unloading;
        self.each_jump(&sampled, separated, extreme, &mut |jumped| {
            match parts.last_mut() {
                // A jump passes several intervals.
                Some(last) if unloads && last.low == jumped.high && last.level == jumped.level => {
                    last.low = jumped.low;
                    last.area += jumped.area;
                }
                Some(last) if !unloads && last.high == jumped.low && last.level == jumped.level => {
                    last.high = jumped.high;
                    last.area += jumped.area;
                }
                _ => parts.push(jumped),
            }
        });
        let stiffness = self.contact.foundation.spring_stiffness();
        let instrument = self.contact.loading_stiffness / stiffness;
        let mut jumps = Vec::new();
        for part in parts {
            let [from, to] = if unloads {
                [part.high, part.low]
            } else {
                [part.low, part.high]
            };
            let is_rounding = part.high - part.low <= ROUNDING * way;
            if part.area > 0.0 && !is_rounding {
                jumps.push(InstrumentJump {
                    displacement: part.level / instrument,
                    from,
                    to,
                    energy: stiffness * part.area,
                });
            }
        }
        Ok(jumps)
    }

    /// Calls `found` with each part of a sampled motion that a compliant instrument passes in a
    /// jump, in the order of the motion.
    fn each_jump(
        &self,
        sampled: &[ContactState],
        separated: SeparatedEnds,
        extreme: &mut Option<f64>,
        found: &mut dyn FnMut(Jumped),
    ) {
        let stage = self.with_instrument();
        if stage.instrument == 0.0 || !self.contact.has_adhesion() {
            return;
        }
        let sampled = stage.beside_instrument(sampled);
        let low = sampled[0];
        let high = sampled[sampled.len() - 1];
        let begin = match self.direction {
            Direction::Loading if separated.at_begin => stage.instrument * low.indentation,
            Direction::Loading => low.compression,
            Direction::Unloading => high.compression,
        };
        let mut reached = extreme.unwrap_or(begin);
        let pairs = intervals(&sampled, |_, _| true);
        match self.direction {
            Direction::Loading => {
                for pairs in pairs.chunks(AT_ONCE) {
                    for interval in &stage.events(pairs, &mut Work::default()) {
                        interval.jumped_on_loading(&mut reached, found);
                    }
                }
            }
            Direction::Unloading => {
                for pairs in pairs.rchunks(AT_ONCE) {
                    for interval in stage.events(pairs, &mut Work::default()).iter().rev() {
                        interval.jumped_on_unloading(&mut reached, found);
                    }
                }
            }
        }
        // After the contact is lost, the instrument relaxes until no force deflects it. The energy
        // of this last jump also counts.
        if separated.at_end {
            let displacement = reached / stage.instrument;
            let free = (low.indentation - displacement).max(0.0);
            found(Jumped {
                low: low.indentation - free,
                high: low.indentation,
                level: reached,
                area: 0.5 * stage.instrument * free * free,
            });
        }
        *extreme = Some(reached);
    }

    /// Finds the indentation in m at which the force is `force` in N. On loading it is the smallest
    /// such indentation from `from` upwards, and on unloading the largest one up to `from`.
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

    /// Finds the smallest indentation in m, at least `from`, at which the compression of a loading
    /// is `wanted` in m.
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
        // In full contact the force is linear in the indentation, so one step reaches the wanted
        // force. A second step removes the rounding of the first.
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

    /// Computes the contact of this stage at the points of a grid of indentations. If a search uses
    /// the stage, the result includes the springs that represent the instrument.
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

    /// Computes ∫ (c − θ)² dx in cells times m² over all parts of the profile that attach or detach
    /// at an indentation θ above `low` and up to `high` (m). c is the gap.
    pub(crate) fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        match &self.patches {
            // Without adhesion no spring is stretched.
            Patches::Springs(_) => 0.0,
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, along => along.squared_stretch(low, high))
            }
        }
    }

    /// Returns one interval for each pair of `ends`, with the events inside the interval. The pairs
    /// must be in ascending order of the indentation.
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

    /// Finds the contact with the extreme force between the first and the last point of a sampled
    /// stage.
    pub(crate) fn extreme(
        &self,
        extreme: Extreme,
        stage: &[ContactState],
        work: &mut Work,
    ) -> ContactState {
        let mut best = extreme.among(stage);
        // Without adhesion the force never falls, so an extreme lies at one of the sampled points.
        if self.contact.has_adhesion() {
            let chosen = intervals(stage, |low, high| extreme.may_lie(low, high, &best));
            for interval in &self.events(&chosen, work) {
                interval.extreme(extreme, &mut best);
            }
        }
        best
    }

    /// Finds the contact with the smallest force of an unloading between the ends of a grid. The
    /// search first evaluates a coarser grid. The search evaluates the other points of `grid` only
    /// where the bounds of the force allow a smaller force.
    pub(crate) fn smallest(
        &self,
        grid: &Grid,
        work: &mut Work,
    ) -> Result<ContactState, ContactError> {
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let best = Extreme::Smallest.among(&coarse);
        let stage = self.refined(grid, coarse, |low, high| {
            Extreme::Smallest.may_lie(low, high, &best)
        })?;
        Ok(self.extreme(Extreme::Smallest, &stage, work))
    }

    /// Finds the smallest indentation in m, between the ends of a grid, at which the compression is
    /// at least `wanted` in m. Returns `None` if there is none.
    fn first_at_least(
        &self,
        grid: &Grid,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        // Intervals above the first point that has the wanted compression need no search.
        let may_lie = |first: Option<f64>, low: &ContactState, high: &ContactState| {
            high.indentation <= first.unwrap_or(f64::INFINITY) && upper_bound(low, high) >= wanted
        };
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let first_of_coarse = first_point_at_least(&coarse, wanted);
        let stage = self.refined(grid, coarse, |low, high| {
            may_lie(first_of_coarse, low, high)
        })?;
        let first = first_point_at_least(&stage, wanted);
        let chosen = intervals(&stage, |low, high| may_lie(first, low, high));
        for interval in &self.events(&chosen, work) {
            if let Some(indentation) = interval.first_at_least(wanted) {
                return Ok(Some(indentation));
            }
        }
        Ok(first)
    }

    /// Adds the points of `grid` that lie between two neighbouring points of `coarse`, if `may_lie`
    /// is true for these neighbours.
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

    /// Finds the largest indentation in m, between the ends of a sampled stage, at which the
    /// compression is at most `wanted` in m. Returns `None` if there is none.
    fn last_at_most(&self, stage: &[ContactState], wanted: f64, work: &mut Work) -> Option<f64> {
        let last = stage.iter().rfind(|state| state.compression <= wanted);
        let last = last.map(|state| state.indentation);
        let chosen = intervals(stage, |low, high| {
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

/// Returns the smallest indentation in m among the points of a sampled stage at which the
/// compression is at least `wanted` in m. Returns `None` if no point has this compression.
fn first_point_at_least(stage: &[ContactState], wanted: f64) -> Option<f64> {
    let first = stage.iter().find(|state| state.compression >= wanted)?;
    Some(first.indentation)
}
