//! The exact solver: any loading history, leg by leg, in linear time and without a step error.
//!
//! A leg proceeds in the same way for whole springs and for edges between them; the contact model supplies forces and
//! thresholds.

use super::adhesive::{Adhesive, AdhesiveMemory, ContactTree, EdgeModel, GridEdges, SubCellEdges};
use super::contact_model::{ContactModel, SEARCH_INTERVALS};
use super::contact_state::{ContactState, Extreme, Sampled};
use super::grid::Grid;
use super::leg_plan::{Target, plan};
use super::{
    ContactError, CurvePoint, Direction, Foundation, HessRule, LegRecord, LegView, Nonadhesive, Work,
};
use crate::scene::{Edges, Leg};
use std::mem::take;
use std::time::{Duration, Instant};

/// A body on its foundation, moved leg by leg.
pub struct Exact<'a> {
    contact: Box<dyn ContactModel + 'a>,
    foundation: Foundation,
    samples: usize,
    state: ContactState,
    /// Contact states of the loading from separation, kept after the first search for a force there: always the same.
    first: Option<Sampled>,
    /// True if the body touches on the present leg, so that the thresholds are those of this leg.
    touching: bool,
    legs: usize,
    work: Work,
    /// Time spent on whole legs, and in it on the thresholds.
    leg_time: Duration,
    pass_time: Duration,
}

/// Rule by which springs attach and detach.
#[derive(Clone, Copy, Debug)]
pub enum ContactRule<'a> {
    /// Each spring at its own gap, with these edges of the contact patches.
    Nonadhesive(Edges),
    /// The rule of Hess over the tree of the gaps, with the edges of that tree.
    Hess(HessRule, &'a ContactTree),
}

/// Returns a separated body without adhesion at d = 0 just before first touch, over springs of these gaps (m, the
/// smallest 0).
#[must_use]
pub fn nonadhesive(gaps: &[f64], edges: Edges, foundation: Foundation, samples: usize) -> Exact<'_> {
    Exact::over(Box::new(Nonadhesive::new(gaps, edges)), foundation, samples)
}

/// A separated body under adhesion at d = 0 just before first touch, over springs of these gaps (m, the smallest 0) and
/// the tree of these gaps; `samples` (at least 2) curve points are taken on each leg.
///
/// # Panics
/// For a tree of other edges.
#[must_use]
pub fn adhesive<'a, E: EdgeModel>(
    gaps: &'a [f64],
    tree: &'a ContactTree,
    edges: E,
    foundation: Foundation,
    samples: usize,
) -> Exact<'a> {
    adhesive_in(AdhesiveMemory::default(), gaps, tree, edges, foundation, samples)
}

fn adhesive_in<'a, E: EdgeModel>(
    memory: AdhesiveMemory,
    gaps: &'a [f64],
    tree: &'a ContactTree,
    edges: E,
    foundation: Foundation,
    samples: usize,
) -> Exact<'a> {
    let mut body = Exact::over(Box::new(Adhesive::new(gaps, tree, edges, memory)), foundation, samples);
    body.work.tree_nodes = tree.len() as u64;
    body
}

impl<'a> Exact<'a> {
    /// A separated body at d = 0 just before first touch over springs of these gaps (m, the smallest 0); `samples` (at
    /// least 2) curve points are taken on each leg.
    ///
    /// Under adhesion the body takes this memory until [`Exact::give_back`]: fresh memory costs about as much as a
    /// pass.
    #[must_use]
    pub fn new(
        memory: &mut AdhesiveMemory,
        gaps: &'a [f64],
        rule: ContactRule<'a>,
        foundation: Foundation,
        samples: usize,
    ) -> Self {
        let (hess, tree) = match rule {
            ContactRule::Nonadhesive(edges) => return nonadhesive(gaps, edges, foundation, samples),
            ContactRule::Hess(hess, tree) => (hess, tree),
        };
        let memory = take(memory);
        match tree.edges() {
            Edges::Grid => adhesive_in(memory, gaps, tree, GridEdges::new(hess), foundation, samples),
            Edges::SubCell => adhesive_in(memory, gaps, tree, SubCellEdges::new(hess), foundation, samples),
        }
    }

    /// A body over these springs, separated, at d = 0 just before first touch.
    fn over(contact: Box<dyn ContactModel + 'a>, foundation: Foundation, samples: usize) -> Self {
        let work = Work { springs: contact.count(), ..Work::default() };
        Exact {
            contact,
            foundation,
            samples: samples.max(2),
            state: ContactState::free(0.0),
            first: None,
            touching: false,
            legs: 0,
            work,
            leg_time: Duration::ZERO,
            pass_time: Duration::ZERO,
        }
    }

    pub(super) fn contact(&self) -> &dyn ContactModel {
        &*self.contact
    }

    pub(super) fn work_mut(&mut self) -> (&mut (dyn ContactModel + 'a), &mut Work) {
        (&mut *self.contact, &mut self.work)
    }

    /// Leaves its memory to the next body.
    pub fn give_back(self, memory: &mut AdhesiveMemory) {
        self.contact.give_back(memory);
    }

    /// Smallest force of the unloading from first touch, N, and the work counts of the search.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn pull_off_at_touch(&mut self) -> Result<(f64, Work), ContactError> {
        let stiffness = self.foundation.spring_stiffness();
        let (compression, work) = self.contact.pull_off_at_touch()?;
        Ok((stiffness * compression, work))
    }

    fn is_separated(&self) -> bool {
        self.state.springs == 0
    }

    /// Separates the body and begins a loading; returns the smallest indentation of full contact, m.
    pub(super) fn begin_loading(&mut self) -> Result<f64, ContactError> {
        self.state = ContactState::free(0.0);
        self.touching = true;
        self.contact.load(None, &mut self.work)
    }

    /// Grid of a leg's curve: every `stride`-th point is a sample, those between sharpen the search.
    pub(super) fn grid(&self, low: f64, high: f64) -> (Grid, usize) {
        let intervals = self.samples - 1;
        let stride = SEARCH_INTERVALS.div_ceil(intervals);
        (Grid::new(low, high, intervals * stride), stride)
    }

    pub(super) fn curve_point(&self, state: ContactState) -> CurvePoint {
        state.point(self.foundation)
    }

    /// The samples of a leg in ascending order of indentation.
    fn samples(&self, sampled: &Sampled, stride: usize) -> Vec<CurvePoint> {
        let last = sampled.states.len() - 1;
        let states = sampled.states.iter().enumerate();
        let chosen = states.filter(|(index, _)| index % stride == 0 || *index == last);
        chosen.map(|(_, &state)| self.curve_point(state)).collect()
    }

    /// Energy of springs that attach or detach with this sum of squared stretches (m²), J.
    pub(super) fn energy(&self, squared_stretch: f64) -> f64 {
        0.5 * self.foundation.spring_stiffness() * squared_stretch
    }

    fn load(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let before = self.state;
        let separated = self.is_separated();
        let clock = Instant::now();
        let complete = self.contact.load((!separated).then_some(before.indentation), &mut self.work)?;
        self.pass_time += clock.elapsed();
        // Nothing touches below d = 0.
        let low = if separated { before.indentation.max(0.0) } else { before.indentation };
        let high = match target {
            Target::Indentation(indentation) => indentation,
            Target::Force(force) => self.load_to_force(leg, force, low, complete.max(low))?,
            Target::Separation => low,
        };
        let (grid, stride) = match target {
            // No search follows.
            Target::Force(_) => (Grid::new(low, high, self.samples - 1), 1),
            _ => self.grid(low, high),
        };
        self.work.springs_tallied += self.work.springs;
        let (sampled, attaching) = self.contact.sample_changes(grid, separated)?;
        let mut curve = self.samples(&sampled, stride);
        if separated {
            curve.insert(0, self.curve_point(ContactState::free(low)));
            if before.indentation < low {
                curve.insert(0, self.curve_point(before));
            }
        }
        let end = sampled.last();
        let largest = match target {
            // The force is below its target until then.
            Target::Force(_) => end,
            _ => self.contact.extreme(Extreme::Largest, &sampled, &mut self.work.events_sorted),
        };
        let at_end = self.curve_point(end);
        let smallest = curve.iter().copied().min_by(|a, b| a.force.total_cmp(&b.force)).unwrap_or(at_end);
        let extremes = [smallest, self.curve_point(largest)];
        Ok(self.end((leg, Direction::Loading), curve, extremes, end, attaching))
    }

    /// Indentation of a loading leg, complete at another, at which a force is first reached, m.
    pub(super) fn load_to_force(
        &mut self,
        leg: Leg,
        force: f64,
        low: f64,
        complete: f64,
    ) -> Result<f64, ContactError> {
        let wanted = force / self.foundation.spring_stiffness();
        let forms = self.is_separated();
        // From d = 0 to full contact.
        let known = if forms { self.first.take() } else { None };
        let grid = Grid::new(low, complete, SEARCH_INTERVALS);
        let sampled = match known {
            Some(sampled) => sampled,
            None => {
                self.work.springs_tallied += self.work.springs;
                self.contact.sample_coarsely(&grid)?
            }
        };
        let sorted = &mut self.work.events_sorted;
        // Beyond full contact the force rises with all springs.
        let beyond = || {
            let end = sampled.last();
            let straight = self.contact.straight(*sampled.totals.last()?, wanted);
            let sliding = || end.indentation + (wanted - end.compression) / end.length;
            let found = straight.unwrap_or_else(sliding);
            found.is_finite().then(|| found.max(complete))
        };
        let found = self.contact.first_at_least(&grid, &sampled, wanted, sorted)?.or_else(beyond);
        if forms {
            self.first = Some(sampled);
        }
        found.ok_or(ContactError::OutOfReach { index: self.legs, leg })
    }

    fn unload(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let before = self.state;
        let high = before.indentation;
        let clock = Instant::now();
        let separates = self.contact.unload(high, &mut self.work)?;
        self.pass_time += clock.elapsed();
        let low = match target {
            Target::Indentation(indentation) => indentation,
            Target::Separation => separates.min(high),
            Target::Force(force) => self.unload_to_force(leg, force, separates.min(high), high)?,
        };
        let (grid, stride) = self.grid(low, high);
        let separates = matches!(target, Target::Separation);
        self.work.springs_tallied += self.work.springs;
        let (sampled, detaching) = self.contact.sample_changes(grid, separates)?;
        let smallest = self.contact.extreme(Extreme::Smallest, &sampled, &mut self.work.events_sorted);
        let smallest = self.curve_point(smallest);
        let mut curve = self.samples(&sampled, stride);
        let place = curve.partition_point(|point| point.indentation < smallest.indentation);
        if curve.get(place) != Some(&smallest) {
            curve.insert(place, smallest);
        }
        curve.reverse();
        let end = if separates {
            curve.push(self.curve_point(ContactState::free(low)));
            ContactState::free(low)
        } else {
            sampled.first()
        };
        let largest = curve.first().copied().unwrap_or(smallest);
        Ok(self.end((leg, Direction::Unloading), curve, [smallest, largest], end, detaching))
    }

    /// Ends a leg along this curve in a contact, with this sum of squared stretches (m²).
    fn end(
        &mut self,
        leg: (Leg, Direction),
        curve: Vec<CurvePoint>,
        extremes: [CurvePoint; 2],
        end: ContactState,
        squared_stretch: f64,
    ) -> LegRecord {
        let changed = (end.springs - self.state.springs).unsigned_abs();
        let record = LegRecord::moved(leg, curve, extremes, changed, self.energy(squared_stretch));
        self.work.count(&record);
        self.state = end;
        record
    }

    fn unload_to_force(&mut self, leg: Leg, force: f64, low: f64, high: f64) -> Result<f64, ContactError> {
        let wanted = force / self.foundation.spring_stiffness();
        self.work.springs_tallied += self.work.springs;
        let sampled = self.contact.sample(Grid::new(low, high, SEARCH_INTERVALS))?;
        let sorted = &mut self.work.events_sorted;
        if let Some(found) = self.contact.last_at_most(&sampled, wanted, sorted) {
            return Ok(found);
        }
        // The thresholds of this leg still hold at the present indentation.
        let smallest = self.contact.extreme(Extreme::Smallest, &sampled, sorted).compression;
        let smallest = self.foundation.spring_stiffness() * smallest;
        Err(ContactError::DetachesBefore { index: self.legs, leg, smallest })
    }
}

impl super::Solver for Exact<'_> {
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError> {
        let clock = Instant::now();
        let here = self.curve_point(self.state);
        let separated = self.is_separated();
        let (touching, record) = match plan(leg, here, self.legs)? {
            None => (!separated, LegRecord::still(leg, here)),
            Some((_, Target::Indentation(to))) if separated && to < 0.0 => {
                self.state = ContactState::free(to);
                (false, LegRecord::free(leg, here.indentation, to))
            }
            Some((Direction::Loading, target)) => (true, self.load(leg, target)?),
            Some((Direction::Unloading, target)) => (true, self.unload(leg, target)?),
        };
        self.touching = touching;
        self.legs += 1;
        self.leg_time += clock.elapsed();
        Ok(record)
    }

    fn leg(&self) -> LegView<'_> {
        let leg = self.contact.leg();
        if self.touching { leg } else { leg.apart() }
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        (self.leg_time - self.pass_time).as_secs_f64()
    }
}
