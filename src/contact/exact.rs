//! The exact solver: any loading history, leg by leg, in linear time and without a step error.

use super::ledger::{Grid, Ledger, SquaredStretch};
use super::search::{self, Extreme};
use super::springs::{AdhesiveSprings, BareSprings, Contact};
use super::tally::Tally;
use super::targets::{Standing, Target};
use super::{
    ContactError, ContactTree, CurvePoint, Direction, EdgeRule, Foundation, LegContact, LegRecord, Work,
};
use crate::scene::Leg;
use std::time::{Duration, Instant};

/// Intervals in which extremes are searched when the curve has fewer samples.
pub(super) const SEARCH_INTERVALS: usize = 1024;

/// A body on its foundation, moved leg by leg.
pub struct Exact<C> {
    contact: C,
    foundation: Foundation,
    samples: usize,
    state: State,
    /// Whether the present leg touches at all, so that its thresholds hold.
    touching: bool,
    legs: usize,
    work: Work,
    /// Time spent on whole legs, and in it on the thresholds.
    leg_time: Duration,
    pass_time: Duration,
}

/// Where the body stands and what touches.
#[derive(Clone, Copy, Debug)]
struct State {
    indentation: f64,
    tally: Tally,
}

impl State {
    fn is_separated(&self) -> bool {
        self.tally.springs == 0
    }
}

/// A body under adhesion; build one with [`adhesive`].
pub type Adhesive<'a, R> = Exact<AdhesiveSprings<'a, R>>;
/// A body without adhesion; build one with [`bare`].
pub type Bare<'a> = Exact<BareSprings<'a>>;

/// A body under adhesion, separated, at d = 0 just before first touch.
///
/// `samples` (at least 2) curve points are taken on each leg.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub fn adhesive<R: EdgeRule>(
    tree: &ContactTree,
    rule: R,
    foundation: Foundation,
    samples: usize,
) -> Result<Adhesive<'_, R>, ContactError> {
    adhesive_in(Vec::new(), tree, rule, foundation, samples)
}

/// The same in the memory that [`Exact::into_memory`] gave back: fresh memory costs about as much as a pass.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub fn adhesive_in<R: EdgeRule>(
    memory: Vec<f64>,
    tree: &ContactTree,
    rule: R,
    foundation: Foundation,
    samples: usize,
) -> Result<Adhesive<'_, R>, ContactError> {
    let mut exact = Exact::new(AdhesiveSprings::new(tree, rule, memory)?, foundation, samples);
    exact.work.springs = tree.len() as u64;
    exact.work.tree_nodes = tree.len() as u64;
    Ok(exact)
}

/// A body without adhesion on springs of these gaps (m, the smallest 0), separated.
#[must_use]
pub fn bare(gaps: &[f64], foundation: Foundation, samples: usize) -> Bare<'_> {
    let mut exact = Exact::new(BareSprings::new(gaps), foundation, samples);
    exact.work.springs = gaps.len() as u64;
    exact
}

impl<R: EdgeRule> Adhesive<'_, R> {
    /// The memory it worked in, for the next body.
    #[must_use]
    pub fn into_memory(self) -> Vec<f64> {
        self.contact.into_memory()
    }

    /// Roots of the fragments in contact at first touch, on the leg that forms the contact.
    pub(crate) fn roots_at_touch(&self) -> Option<Vec<usize>> {
        self.contact.roots_at_touch().filter(|_| self.touching)
    }
}

impl<C: Contact> Exact<C> {
    fn new(contact: C, foundation: Foundation, samples: usize) -> Self {
        Exact {
            contact,
            foundation,
            samples: samples.max(2),
            state: State { indentation: 0.0, tally: Tally::default() },
            touching: false,
            legs: 0,
            work: Work::default(),
            leg_time: Duration::ZERO,
            pass_time: Duration::ZERO,
        }
    }

    fn compression(&self) -> f64 {
        self.state.tally.compression(self.state.indentation, self.contact.scale())
    }

    /// Which way a leg goes and where it ends; `None` when it ends where the body stands.
    fn plan(&self, leg: Leg) -> Result<Option<(Direction, Target)>, ContactError> {
        let stiffness = self.foundation.spring_stiffness();
        let standing = Standing {
            indentation: self.state.indentation,
            force: stiffness * self.compression(),
            separated: self.state.is_separated(),
        };
        standing.plan(leg, stiffness, self.legs)
    }

    fn ledger(&mut self, grid: Grid) -> Ledger {
        self.work.springs_tallied += self.work.springs;
        Ledger::new(&self.contact, grid)
    }

    fn ledger_with_stretches(&mut self, grid: Grid) -> (Ledger, SquaredStretch) {
        self.work.springs_tallied += self.work.springs;
        Ledger::with_stretches(&self.contact, grid)
    }

    /// Grid of a leg's curve: every `stride`-th point is a sample, those between sharpen the search.
    fn grid(&self, low: f64, high: f64) -> (Grid, usize) {
        let intervals = self.samples - 1;
        let stride = SEARCH_INTERVALS.div_ceil(intervals);
        (Grid::new(low, high, intervals * stride), stride)
    }

    fn point(&self, extreme: Extreme) -> CurvePoint {
        self.curve_point(extreme.indentation, extreme.tally)
    }

    fn curve_point(&self, indentation: f64, tally: Tally) -> CurvePoint {
        let compression = tally.compression(indentation, self.contact.scale());
        CurvePoint {
            indentation,
            force: self.foundation.spring_stiffness() * compression,
            contact_length: tally.springs as f64 * self.foundation.spacing,
            springs: tally.springs.unsigned_abs(),
            fragments: tally.fragments.unsigned_abs(),
        }
    }

    /// The samples of a leg in ascending order of indentation.
    fn samples(&self, ledger: &Ledger, stride: usize) -> Vec<CurvePoint> {
        let points = ledger.grid.points();
        let last = points.len() - 1;
        (0..=last)
            .filter(|index| index % stride == 0 || *index == last)
            .map(|index| self.curve_point(points[index], ledger.tallies[index]))
            .collect()
    }

    /// Energy in J of springs that join or leave with these squared stretches.
    fn energy(&self, squared_stretch: f64) -> f64 {
        0.5 * self.foundation.spring_stiffness() * squared_stretch
    }

    /// A leg of a separated body that does not touch.
    fn fly(&mut self, leg: Leg, to: f64) -> LegRecord {
        let from = self.state.indentation;
        self.state.indentation = to;
        LegRecord::free(leg, from, to)
    }

    fn stay(&self, leg: Leg) -> LegRecord {
        LegRecord::still(leg, self.curve_point(self.state.indentation, self.state.tally))
    }

    fn load(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let before = self.state;
        let separated = before.is_separated();
        let clock = Instant::now();
        let complete = self.contact.load((!separated).then_some(before.indentation), &mut self.work);
        self.pass_time += clock.elapsed();
        // Nothing touches below d = 0.
        let low = if separated { before.indentation.max(0.0) } else { before.indentation };
        let high = match target {
            Target::Indentation(indentation) => indentation,
            Target::Compression(wanted) => self.load_to_compression(leg, wanted, low, complete.max(low))?,
            Target::Separation => low,
        };
        let (grid, stride) = self.grid(low, high);
        let (ledger, joined) = self.ledger_with_stretches(grid);
        let mut curve = self.samples(&ledger, stride);
        if separated {
            curve.insert(0, self.curve_point(low, Tally::default()));
            if before.indentation < low {
                curve.insert(0, self.curve_point(before.indentation, Tally::default()));
            }
        }
        let end = ledger.intervals();
        let tally = ledger.tallies[end];
        let at_end = self.curve_point(high, tally);
        let largest = match target {
            // The force has been below its target all the way.
            Target::Compression(_) => at_end,
            _ => {
                let extreme = search::largest(&ledger, &self.contact, &mut self.work.events_sorted);
                self.point(extreme)
            }
        };
        let smallest = curve.iter().copied().min_by(|a, b| a.force.total_cmp(&b.force)).unwrap_or(at_end);
        let joins = (tally.springs - before.tally.springs).unsigned_abs();
        self.work.joins += joins;
        self.state = State { indentation: high, tally };
        Ok(LegRecord {
            leg,
            direction: Direction::Loading,
            curve,
            largest,
            smallest,
            joins,
            leaves: 0,
            dissipated_energy: -self.energy(joined.inside + joined.below),
        })
    }

    fn load_to_compression(
        &mut self,
        leg: Leg,
        wanted: f64,
        low: f64,
        complete: f64,
    ) -> Result<f64, ContactError> {
        let ledger = self.ledger(Grid::new(low, complete, SEARCH_INTERVALS));
        if let Some(found) =
            search::first_at_least(&ledger, &self.contact, wanted, &mut self.work.events_sorted)
        {
            return Ok(found);
        }
        // Everything is in contact and the force rises with all springs.
        ledger.tallies[ledger.intervals()]
            .indentation(wanted, self.contact.scale())
            .filter(|indentation| indentation.is_finite())
            .map(|indentation| indentation.max(complete))
            .ok_or(ContactError::OutOfReach { index: self.legs, leg })
    }

    fn unload(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let before = self.state;
        let high = before.indentation;
        let clock = Instant::now();
        let separates = self.contact.unload(high, &mut self.work);
        self.pass_time += clock.elapsed();
        let low = match target {
            Target::Indentation(indentation) => indentation,
            Target::Separation => separates.min(high),
            Target::Compression(wanted) => {
                self.unload_to_compression(leg, wanted, separates.min(high), high)?
            }
        };
        let (grid, stride) = self.grid(low, high);
        let (ledger, left) = self.ledger_with_stretches(grid);
        let extreme = search::smallest(&ledger, &self.contact, &mut self.work.events_sorted);
        let smallest = self.point(extreme);
        let mut curve = self.samples(&ledger, stride);
        let place = curve.partition_point(|point| point.indentation < smallest.indentation);
        if curve.get(place) != Some(&smallest) {
            curve.insert(place, smallest);
        }
        curve.reverse();
        let (tally, left_with) = match target {
            Target::Separation => {
                curve.push(self.curve_point(low, Tally::default()));
                (Tally::default(), left.inside + left.below)
            }
            _ => (ledger.tallies[0], left.inside),
        };
        let largest = curve.first().copied().unwrap_or(smallest);
        let leaves = (before.tally.springs - tally.springs).unsigned_abs();
        self.work.leaves += leaves;
        self.state = State { indentation: low, tally };
        Ok(LegRecord {
            leg,
            direction: Direction::Unloading,
            curve,
            largest,
            smallest,
            joins: 0,
            leaves,
            dissipated_energy: self.energy(left_with),
        })
    }

    fn unload_to_compression(
        &mut self,
        leg: Leg,
        wanted: f64,
        low: f64,
        high: f64,
    ) -> Result<f64, ContactError> {
        let ledger = self.ledger(Grid::new(low, high, SEARCH_INTERVALS));
        let sorted = &mut self.work.events_sorted;
        if let Some(found) = search::last_at_most(&ledger, &self.contact, wanted, sorted) {
            return Ok(found);
        }
        let smallest = search::smallest(&ledger, &self.contact, sorted);
        // The thresholds of this leg still say what is in contact where the body stands.
        let smallest = self.foundation.spring_stiffness() * smallest.compression;
        Err(ContactError::LetsGoBefore { index: self.legs, leg, smallest })
    }
}

impl<C: Contact> super::Solver for Exact<C> {
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError> {
        let clock = Instant::now();
        let plan = self.plan(leg)?;
        let separated = self.state.is_separated();
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
