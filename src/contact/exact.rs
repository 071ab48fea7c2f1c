//! The exact solver: any loading history, leg by leg, in linear time and without a step error.
//!
//! A leg proceeds in the same way for whole springs and for edges between them; the contact model gives forces and
//! thresholds.

use super::adhesive::{Adhesive, AdhesiveMemory, ContactTree, EdgeModel};
use super::contact_model::{ContactModel, ContactState, Sampled};
use super::grid::Grid;
use super::leg_plan::{Target, plan};
use super::{ContactError, CurvePoint, Direction, Foundation, LegContact, LegRecord, Nonadhesive, Work};
use crate::scene::{Edges, Leg};
use std::time::{Duration, Instant};

/// A body on its foundation, moved leg by leg.
pub struct Exact<C: ContactModel> {
    contact: C,
    foundation: Foundation,
    samples: usize,
    state: ContactState,
    /// Contact states of the loading from separation, once a force has been sought there: the same each time.
    first: Option<Sampled>,
    /// True if the body touches on the present leg, so that the thresholds are those of this leg.
    touching: bool,
    legs: usize,
    work: Work,
    /// Time spent on whole legs, and in it on the thresholds.
    leg_time: Duration,
    pass_time: Duration,
}

/// A body without adhesion; build one with [`nonadhesive`].
pub type WithoutAdhesion<'a> = Exact<Nonadhesive<'a>>;

/// A separated body without adhesion at d = 0 just before first touch, over springs of these gaps (m, the smallest 0).
#[must_use]
pub fn nonadhesive(
    gaps: &[f64],
    edges: Edges,
    foundation: Foundation,
    samples: usize,
) -> WithoutAdhesion<'_> {
    Exact::new(Nonadhesive::new(gaps, edges), foundation, samples)
}

/// A separated body under adhesion at d = 0 just before first touch, over springs of these gaps (m, the smallest 0) and
/// the tree of these gaps; `samples` (at least 2) curve points are taken on each leg.
#[must_use]
pub fn adhesive<'a, E: EdgeModel>(
    gaps: &'a [f64],
    tree: &'a ContactTree,
    edges: E,
    foundation: Foundation,
    samples: usize,
) -> Exact<Adhesive<'a, E>> {
    adhesive_in(AdhesiveMemory::default(), gaps, tree, edges, foundation, samples)
}

/// The same in the memory that [`Exact::into_memory`] gave back: fresh memory costs about as much as a pass.
#[must_use]
pub fn adhesive_in<'a, E: EdgeModel>(
    memory: AdhesiveMemory,
    gaps: &'a [f64],
    tree: &'a ContactTree,
    edges: E,
    foundation: Foundation,
    samples: usize,
) -> Exact<Adhesive<'a, E>> {
    let mut body = Exact::new(Adhesive::new(gaps, tree, edges, memory), foundation, samples);
    body.work.tree_nodes = tree.len() as u64;
    body
}

impl<C: ContactModel> Exact<C> {
    /// A body over these springs, separated, at d = 0 just before first touch.
    pub(super) fn new(contact: C, foundation: Foundation, samples: usize) -> Self {
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

    pub(super) fn contact(&self) -> &C {
        &self.contact
    }

    pub(super) fn work_mut(&mut self) -> (&mut C, &mut Work) {
        (&mut self.contact, &mut self.work)
    }

    fn is_separated(&self) -> bool {
        self.state.springs == 0
    }

    /// Places the body apart and begins a loading from there; returns the indentation from which on all is in contact, m.
    pub(super) fn begin_loading(&mut self) -> Result<f64, ContactError> {
        self.state = ContactState::free(0.0);
        self.touching = true;
        self.contact.load(None, &mut self.work)
    }

    /// Grid of a leg's curve: every `stride`-th point is a sample, those between sharpen the search.
    pub(super) fn grid(&self, low: f64, high: f64) -> (Grid, usize) {
        let intervals = self.samples - 1;
        let stride = C::SEARCH_INTERVALS.div_ceil(intervals);
        (Grid::new(low, high, intervals * stride), stride)
    }

    /// Contact states along the grid of a search.
    fn sample(&mut self, low: f64, high: f64) -> Result<Sampled, ContactError> {
        self.work.springs_tallied += self.work.springs;
        self.contact.sample(Grid::new(low, high, C::SEARCH_INTERVALS))
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

    /// A leg of a separated body that does not touch.
    fn fly(&mut self, leg: Leg, to: f64) -> LegRecord {
        let from = self.state.indentation;
        self.state = ContactState::free(to);
        LegRecord::free(leg, from, to)
    }

    fn stay(&self, leg: Leg) -> LegRecord {
        LegRecord::still(leg, self.curve_point(self.state))
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
            // Nothing is sought any more.
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
            _ => self.contact.largest(&sampled, &mut self.work.events_sorted),
        };
        let at_end = self.curve_point(end);
        let smallest = curve.iter().copied().min_by(|a, b| a.force.total_cmp(&b.force)).unwrap_or(at_end);
        let attached = (end.springs - before.springs).unsigned_abs();
        self.work.attached += attached;
        self.state = end;
        Ok(LegRecord {
            leg,
            direction: Direction::Loading,
            curve,
            largest: self.curve_point(largest),
            smallest,
            attached,
            detached: 0,
            // Not −0 where nothing attached with a stretch.
            dissipated_energy: 0.0 - self.energy(attaching),
        })
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
        // From d = 0 to where all is in contact.
        let known = if forms { self.first.take() } else { None };
        let sampled = match known {
            Some(sampled) => sampled,
            None => self.sample(low, complete)?,
        };
        let sorted = &mut self.work.events_sorted;
        // Beyond, everything is in contact and the force rises with all springs.
        let beyond = || {
            let end = sampled.last();
            let straight = self.contact.straight(*sampled.totals.last()?, wanted);
            let sliding = || end.indentation + (wanted - end.compression) / end.length;
            let found = straight.unwrap_or_else(sliding);
            found.is_finite().then(|| found.max(complete))
        };
        let found = self.contact.first_at_least(&sampled, wanted, sorted).or_else(beyond);
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
        let smallest = self.contact.smallest(&sampled, &mut self.work.events_sorted);
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
        let detached = (before.springs - end.springs).unsigned_abs();
        self.work.detached += detached;
        self.state = end;
        Ok(LegRecord {
            leg,
            direction: Direction::Unloading,
            curve,
            largest,
            smallest,
            attached: 0,
            detached,
            dissipated_energy: self.energy(detaching),
        })
    }

    fn unload_to_force(&mut self, leg: Leg, force: f64, low: f64, high: f64) -> Result<f64, ContactError> {
        let wanted = force / self.foundation.spring_stiffness();
        let sampled = self.sample(low, high)?;
        let sorted = &mut self.work.events_sorted;
        if let Some(found) = self.contact.last_at_most(&sampled, wanted, sorted) {
            return Ok(found);
        }
        // The thresholds of this leg are still true at the present indentation.
        let smallest = self.contact.smallest(&sampled, sorted).compression;
        let smallest = self.foundation.spring_stiffness() * smallest;
        Err(ContactError::DetachesBefore { index: self.legs, leg, smallest })
    }
}

impl<C: ContactModel> super::Solver for Exact<C> {
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError> {
        let clock = Instant::now();
        let plan = plan(leg, self.curve_point(self.state), self.legs)?;
        let separated = self.is_separated();
        let (touching, record) = match plan {
            None => (!separated, self.stay(leg)),
            Some((_, Target::Indentation(to))) if separated && to < 0.0 => (false, self.fly(leg, to)),
            Some((Direction::Loading, target)) => (true, self.load(leg, target)?),
            Some((Direction::Unloading, target)) => (true, self.unload(leg, target)?),
        };
        self.touching = touching;
        self.legs += 1;
        self.leg_time += clock.elapsed();
        Ok(record)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        if self.touching { self.contact.fragments(indentation) } else { Vec::new() }
    }

    fn rises(&self, indentation: f64) -> Vec<f64> {
        if self.touching { self.contact.rises(indentation) } else { Vec::new() }
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.contact.thresholds_along_line(out);
        if !self.touching {
            out.fill(f64::INFINITY);
        }
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        if self.touching {
            self.contact.copy_leg(copy)
        } else {
            copy.keep_nothing();
            Ok(())
        }
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        (self.leg_time - self.pass_time).as_secs_f64()
    }
}

impl<'a, E: EdgeModel> Exact<Adhesive<'a, E>> {
    /// The memory it worked in, for the next body.
    #[must_use]
    pub fn into_memory(self) -> AdhesiveMemory {
        self.contact.into_memory()
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
}
