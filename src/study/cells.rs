//! The order and the parts of the computation of a plan.
//!
//! A *run* is one loading: all cells that differ in the preload alone. A *unit* is the work of one thread from end
//! to end: runs on one random profile with the same roughness, so that the profile and its tree are made once.
//! Within a unit the numbers that shape the profile vary slowest.

use super::plan::Plan;
use super::target::Shapes;
use std::ops::Range;

/// Number of units up to which profiles are divided into several, so that many processes can share a plan of few
/// profiles.
const ENOUGH_UNITS: u64 = 256;
/// Fewest runs of a divided profile: with fewer, making the profile would cost more than the runs.
const LEAST_RUNS: u64 = 16;

/// Numbering of the runs and units of a plan.
pub(super) struct Cells<'p> {
    plan: &'p Plan,
    /// Axes that shape the roughness, in the order of the plan.
    outer: Vec<usize>,
    /// The other axes without that of preloads, those that shape the profile first.
    inner: Vec<usize>,
    /// Cells of one run.
    preloads: u64,
    /// Runs of one unit, and units of one profile.
    chunk: u64,
    chunks: u64,
}

/// Runs on one profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    line: u64,
    group: u64,
    steps: Range<u64>,
}

/// One loading on one profile.
pub(super) struct Run {
    /// Cells of the run, one for each preload.
    pub cells: Range<u64>,
    /// Index of the profile, from 0.
    pub line: u64,
}

impl<'p> Cells<'p> {
    pub fn of(plan: &'p Plan) -> Cells<'p> {
        let axes = plan.scene_axes();
        let with = |shapes| (0..axes.len()).filter(move |&axis| axes[axis].target.shapes() == shapes);
        let outer: Vec<usize> = with(Shapes::Roughness).collect();
        let inner: Vec<usize> = with(Shapes::Profile).chain(with(Shapes::Passes)).collect();
        let count = |places: &[usize]| places.iter().map(|&axis| axes[axis].count()).product::<u64>();
        let (groups, steps) = (count(&outer), count(&inner));
        let wanted = ENOUGH_UNITS.div_ceil(groups * plan.lines).min(steps / LEAST_RUNS).max(1);
        let chunk = steps.div_ceil(wanted);
        let preloads = plan.preloads().map_or(1, |axis| axis.count());
        Cells { plan, outer, inner, preloads, chunk, chunks: steps.div_ceil(chunk) }
    }

    fn count(&self, axes: &[usize]) -> u64 {
        axes.iter().map(|&axis| self.plan.axes[axis].count()).product()
    }

    /// Number of units.
    pub fn units(&self) -> u64 {
        self.count(&self.outer) * self.plan.lines * self.chunks
    }

    /// The unit of an index; units of one spectrum are consecutive.
    pub fn unit(&self, index: u64) -> Unit {
        let (rest, chunk) = (index / self.chunks, index % self.chunks);
        let start = chunk * self.chunk;
        let steps = start..(start + self.chunk).min(self.count(&self.inner));
        Unit { group: rest / self.plan.lines, line: rest % self.plan.lines, steps }
    }

    /// The runs of a unit in the most efficient order.
    pub fn runs_of(&self, unit: &Unit) -> impl Iterator<Item = Run> + use<'_> {
        let Unit { group, line, .. } = *unit;
        unit.steps.clone().map(move |step| {
            let mut places = vec![0; self.plan.axes.len()];
            for (axes, number) in [(&self.outer, group), (&self.inner, step)] {
                let mut rest = number;
                for &axis in axes.iter().rev() {
                    let count = self.plan.axes[axis].count();
                    places[axis] = (rest % count) as usize;
                    rest /= count;
                }
            }
            let first = self.plan.cell_at(&places);
            Run { cells: first..first + self.preloads, line }
        })
    }

    /// Number of records of a unit.
    pub fn records_of(&self, unit: &Unit) -> u64 {
        (unit.steps.end - unit.steps.start) * self.preloads
    }
}
