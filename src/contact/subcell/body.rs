//! A body whose contact has its edges between grid points, moved leg by leg.

use super::edges::SubCellEdges;
use super::level_sets::LevelSets;
use super::search::{Found, Search};
use super::sums::{Piece, Sums, each_node, sums_and_stretches, sums_at};
use crate::contact::exact::SEARCH_INTERVALS;
use crate::contact::ledger::Grid;
use crate::contact::springs::{AdhesiveSprings, Contact};
use crate::contact::targets::{Standing, Target};
use crate::contact::{
    ContactError, CurvePoint, Direction, Foundation, HessRule, LegContact, LegRecord, Solver, Work,
};
use crate::scene::Leg;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A body on its foundation, moved leg by leg.
pub struct SubCell<'a> {
    springs: AdhesiveSprings<'a, SubCellEdges>,
    edges: SubCellEdges,
    foundation: Foundation,
    samples: usize,
    indentation: f64,
    standing: Sums,
    /// Whether the present leg touches at all, so that its thresholds hold.
    touching: bool,
    legs: usize,
    work: Work,
    /// Time spent on whole legs, and in it on the thresholds.
    leg_time: Duration,
    pass_time: Duration,
}

/// The even grid of a leg, and what is in contact at each of its points.
struct Sampled {
    grid: Grid,
    sums: Vec<Sums>,
}

impl Sampled {
    fn found(&self, index: usize) -> Found {
        Found { indentation: self.grid.points()[index], sums: self.sums[index] }
    }

    fn intervals(&self) -> usize {
        self.sums.len() - 1
    }

    fn width(&self, interval: usize) -> f64 {
        self.grid.points()[interval + 1] - self.grid.points()[interval]
    }

    /// The index of the point with the best compression.
    fn best(&self, is_better: impl Fn(f64, f64) -> bool) -> Found {
        let mut best = 0;
        for index in 1..self.sums.len() {
            if is_better(self.sums[index].compression(), self.sums[best].compression()) {
                best = index;
            }
        }
        self.found(best)
    }
}

impl<'a> SubCell<'a> {
    /// A body over the line of `sets`, separated, at d = 0 just before first touch.
    /// `hess` is the rule of Hess, `None` without adhesion; `samples` (at least 2) points are taken on each
    /// leg.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        sets: &'a Arc<LevelSets>,
        hess: Option<HessRule>,
        foundation: Foundation,
        samples: usize,
        memory: Vec<f64>,
    ) -> Result<Self, ContactError> {
        let edges = SubCellEdges::new(Arc::clone(sets), hess);
        let springs = AdhesiveSprings::new(sets.tree(), edges.clone(), memory)?;
        let count = sets.tree().len() as u64;
        Ok(SubCell {
            springs,
            edges,
            foundation,
            samples: samples.max(2),
            indentation: 0.0,
            standing: Sums::default(),
            touching: false,
            legs: 0,
            work: Work { springs: count, tree_nodes: count, ..Work::default() },
            leg_time: Duration::ZERO,
            pass_time: Duration::ZERO,
        })
    }

    /// The memory it worked in, for the next body.
    #[must_use]
    pub fn into_memory(self) -> Vec<f64> {
        self.springs.into_memory()
    }

    fn is_separated(&self) -> bool {
        self.standing.springs == 0
    }

    fn search(&self) -> Search<'_> {
        Search { edges: &self.edges }
    }

    fn curve_point(&self, Found { indentation, sums }: Found) -> CurvePoint {
        CurvePoint {
            indentation,
            force: self.foundation.spring_stiffness() * sums.compression(),
            contact_length: sums.length() * self.foundation.spacing,
            springs: sums.springs.unsigned_abs(),
            fragments: sums.fragments.unsigned_abs(),
        }
    }

    fn sample(&mut self, low: f64, high: f64, intervals: usize) -> Sampled {
        self.work.springs_tallied += self.work.springs;
        let grid = Grid::new(low, high, intervals);
        let sums = sums_at(&self.edges, self.springs.thresholds(), &grid);
        Sampled { grid, sums }
    }

    /// The same on the grid of a leg's curve, and the energy in J of what joins or leaves above `from`.
    fn sample_leg(&mut self, low: f64, high: f64, intervals: usize, from: f64) -> (Sampled, f64) {
        self.work.springs_tallied += self.work.springs;
        let grid = Grid::new(low, high, intervals);
        let (sums, squared) = sums_and_stretches(&self.edges, self.springs.thresholds(), &grid, from);
        (Sampled { grid, sums }, 0.5 * self.foundation.spring_stiffness() * squared)
    }

    /// Intervals of a leg's grid, and how many of them lie between two samples of its curve.
    fn intervals(&self) -> (usize, usize) {
        let intervals = self.samples - 1;
        let stride = SEARCH_INTERVALS.div_ceil(intervals);
        (intervals * stride, stride)
    }

    /// The fragments of each of the chosen intervals.
    fn pieces(&mut self, sampled: &Sampled, chosen: &[bool]) -> Vec<Vec<Piece>> {
        let points = sampled.grid.points();
        let mut pieces = vec![Vec::new(); chosen.len()];
        let mut count = 0;
        let first = chosen.iter().position(|&chosen| chosen);
        let last = chosen.iter().rposition(|&chosen| chosen);
        if let (Some(first), Some(last)) = (first, last) {
            let (low, high) = (points[first], points[last + 1]);
            each_node(&self.edges, self.springs.thresholds(), |node, from, to| {
                if from >= to || from > high || to <= low {
                    return;
                }
                // Intervals that reach from below `to` to `from` and above.
                let above = |value: f64| sampled.grid.first_at_least(value.min(high));
                for interval in above(from).saturating_sub(1).max(first)..above(to).min(last + 1) {
                    if chosen[interval] {
                        pieces[interval].push(Piece { node: node as u32, from, to });
                        count += 1;
                    }
                }
            });
        }
        self.work.events_sorted += count;
        pieces
    }

    fn smallest(&mut self, sampled: &Sampled) -> Found {
        let mut best = sampled.best(|a, b| a < b);
        let bound = |interval: usize| {
            let upper = &sampled.sums[interval + 1];
            upper.compression() - sampled.width(interval) * upper.length()
        };
        let limit = best.sums.compression();
        let chosen: Vec<bool> = (0..sampled.intervals()).map(|interval| bound(interval) < limit).collect();
        let pieces = self.pieces(sampled, &chosen);
        let points = sampled.grid.points();
        for interval in (0..chosen.len()).filter(|&interval| chosen[interval]) {
            let (low, high) = (points[interval], points[interval + 1]);
            let upper = sampled.sums[interval + 1];
            self.search().smallest(&pieces[interval], low, high, upper, &mut best);
        }
        best
    }

    fn largest(&mut self, sampled: &Sampled) -> Found {
        let mut best = sampled.best(|a, b| a > b);
        let bound = |interval: usize| {
            let (lower, upper) = (&sampled.sums[interval], &sampled.sums[interval + 1]);
            lower.compression() + sampled.width(interval) * upper.length()
        };
        let limit = best.sums.compression();
        let chosen: Vec<bool> = (0..sampled.intervals()).map(|interval| bound(interval) > limit).collect();
        let pieces = self.pieces(sampled, &chosen);
        let points = sampled.grid.points();
        for interval in (0..chosen.len()).filter(|&interval| chosen[interval]) {
            let (low, high) = (points[interval], points[interval + 1]);
            let (lower, upper) = (sampled.sums[interval], sampled.sums[interval + 1]);
            self.search().largest(&pieces[interval], low, high, lower, upper, &mut best);
        }
        best
    }

    fn load_to_compression(
        &mut self,
        leg: Leg,
        wanted: f64,
        low: f64,
        complete: f64,
    ) -> Result<f64, ContactError> {
        let sampled = self.sample(low, complete, SEARCH_INTERVALS);
        if sampled.sums[0].compression() >= wanted {
            return Ok(low);
        }
        let chosen: Vec<bool> = (0..sampled.intervals())
            .map(|interval| {
                let (lower, upper) = (&sampled.sums[interval], &sampled.sums[interval + 1]);
                lower.compression() + sampled.width(interval) * upper.length() >= wanted
            })
            .collect();
        let pieces = self.pieces(&sampled, &chosen);
        let points = sampled.grid.points();
        for interval in (0..chosen.len()).filter(|&interval| chosen[interval]) {
            let (low, high) = (points[interval], points[interval + 1]);
            if let Some(found) = self.search().first_at_least(&pieces[interval], low, high, wanted) {
                return Ok(found);
            }
        }
        // Everything is in contact and the force rises with the whole line.
        let end = sampled.found(sampled.intervals());
        let further = (wanted - end.sums.compression()) / end.sums.length();
        Some(end.indentation + further)
            .filter(|indentation| indentation.is_finite())
            .map(|indentation| indentation.max(complete))
            .ok_or(ContactError::OutOfReach { index: self.legs, leg })
    }

    fn unload_to_compression(
        &mut self,
        leg: Leg,
        wanted: f64,
        low: f64,
        high: f64,
    ) -> Result<f64, ContactError> {
        let sampled = self.sample(low, high, SEARCH_INTERVALS);
        let chosen: Vec<bool> = (0..sampled.intervals())
            .map(|interval| {
                let upper = &sampled.sums[interval + 1];
                upper.compression() - sampled.width(interval) * upper.length() <= wanted
            })
            .collect();
        let pieces = self.pieces(&sampled, &chosen);
        let points = sampled.grid.points();
        for interval in (0..chosen.len()).rev().filter(|&interval| chosen[interval]) {
            let (low, high) = (points[interval], points[interval + 1]);
            if sampled.sums[interval + 1].compression() <= wanted {
                return Ok(high);
            }
            if let Some(found) = self.search().last_at_most(&pieces[interval], low, high, wanted) {
                return Ok(found);
            }
        }
        if sampled.sums[0].compression() <= wanted {
            return Ok(low);
        }
        // The thresholds of this leg still say what is in contact where the body stands.
        let smallest = self.smallest(&sampled);
        let smallest = self.foundation.spring_stiffness() * smallest.sums.compression();
        Err(ContactError::LetsGoBefore { index: self.legs, leg, smallest })
    }

    fn load(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let (before, stood) = (self.standing, self.indentation);
        let separated = self.is_separated();
        let clock = Instant::now();
        let complete = self.springs.load((!separated).then_some(stood), &mut self.work);
        self.pass_time += clock.elapsed();
        // Nothing touches below d = 0.
        let low = if separated { stood.max(0.0) } else { stood };
        let high = match target {
            Target::Indentation(indentation) => indentation,
            Target::Compression(wanted) => self.load_to_compression(leg, wanted, low, complete.max(low))?,
            Target::Separation => low,
        };
        let (intervals, stride) = self.intervals();
        // What touches at once when the contact forms joins at the first point itself.
        let from = if separated { f64::NEG_INFINITY } else { stood };
        let (sampled, energy) = self.sample_leg(low, high, intervals, from);
        let mut curve = self.samples(&sampled, stride);
        if separated {
            let free = |indentation| CurvePoint { indentation, ..CurvePoint::default() };
            curve.insert(0, free(low));
            if stood < low {
                curve.insert(0, free(stood));
            }
        }
        let end = sampled.found(sampled.intervals());
        let at_end = self.curve_point(end);
        let largest = match target {
            // The force has been below its target all the way.
            Target::Compression(_) => at_end,
            _ => {
                let largest = self.largest(&sampled);
                self.curve_point(largest)
            }
        };
        let smallest = curve.iter().copied().min_by(|a, b| a.force.total_cmp(&b.force)).unwrap_or(at_end);
        let joins = (end.sums.springs - before.springs).unsigned_abs();
        self.work.joins += joins;
        (self.indentation, self.standing) = (high, end.sums);
        Ok(LegRecord {
            leg,
            direction: Direction::Loading,
            curve,
            largest,
            smallest,
            joins,
            leaves: 0,
            // Not −0 where nothing joined with a stretch.
            dissipated_energy: 0.0 - energy,
        })
    }

    fn unload(&mut self, leg: Leg, target: Target) -> Result<LegRecord, ContactError> {
        let (before, high) = (self.standing, self.indentation);
        let clock = Instant::now();
        let separates = self.springs.unload(high, &mut self.work);
        self.pass_time += clock.elapsed();
        let low = match target {
            Target::Indentation(indentation) => indentation,
            Target::Separation => separates.min(high),
            Target::Compression(wanted) => {
                self.unload_to_compression(leg, wanted, separates.min(high), high)?
            }
        };
        let (intervals, stride) = self.intervals();
        let separates = matches!(target, Target::Separation);
        // What is held to the last point leaves just below it.
        let from = if separates { f64::NEG_INFINITY } else { low };
        let (sampled, energy) = self.sample_leg(low, high, intervals, from);
        let smallest = self.smallest(&sampled);
        let smallest = self.curve_point(smallest);
        let mut curve = self.samples(&sampled, stride);
        let place = curve.partition_point(|point| point.indentation < smallest.indentation);
        if curve.get(place) != Some(&smallest) {
            curve.insert(place, smallest);
        }
        curve.reverse();
        let end = if separates {
            curve.push(CurvePoint { indentation: low, ..CurvePoint::default() });
            Sums::default()
        } else {
            sampled.sums[0]
        };
        let largest = curve.first().copied().unwrap_or(smallest);
        let leaves = (before.springs - end.springs).unsigned_abs();
        self.work.leaves += leaves;
        (self.indentation, self.standing) = (low, end);
        Ok(LegRecord {
            leg,
            direction: Direction::Unloading,
            curve,
            largest,
            smallest,
            joins: 0,
            leaves,
            dissipated_energy: energy,
        })
    }

    /// The samples of a leg in ascending order of indentation.
    fn samples(&self, sampled: &Sampled, stride: usize) -> Vec<CurvePoint> {
        let last = sampled.intervals();
        let wanted = (0..=last).filter(|index| index % stride == 0 || *index == last);
        wanted.map(|index| self.curve_point(sampled.found(index))).collect()
    }
}

impl Solver for SubCell<'_> {
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError> {
        let clock = Instant::now();
        let here = self.curve_point(Found { indentation: self.indentation, sums: self.standing });
        let separated = self.is_separated();
        let standing = Standing { indentation: self.indentation, force: here.force, separated };
        let plan = standing.plan(leg, self.foundation.spring_stiffness(), self.legs)?;
        let (touching, record) = match plan {
            None => (!separated, LegRecord::still(leg, here)),
            Some((_, Target::Indentation(to))) if separated && to < 0.0 => {
                let from = std::mem::replace(&mut self.indentation, to);
                (false, LegRecord::free(leg, from, to))
            }
            Some((Direction::Loading, target)) => (true, self.load(leg, target)?),
            Some((Direction::Unloading, target)) => (true, self.unload(leg, target)?),
        };
        self.touching = touching;
        self.legs += 1;
        self.leg_time += clock.elapsed();
        Ok(record)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        if self.touching { self.springs.fragments(indentation) } else { Vec::new() }
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.springs.thresholds_along_line(out);
        if !self.touching {
            out.fill(f64::INFINITY);
        }
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        if self.touching {
            return self.springs.copy_leg(copy);
        }
        copy.keep_nothing();
        Ok(())
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        (self.leg_time - self.pass_time).as_secs_f64()
    }
}
