//! The cells of a plan, with the order and the parts of their computation.
//!
//! A *run* is one loading: all cells that differ in the preload alone. A *unit* is the work of one thread from end
//! to end: runs on one random profile with the same roughness, so that the profile and its tree are made once.
//! Within a unit the numbers that shape the profile vary slowest.

use super::axis::Axis;
use super::numbering::{number_at, places_of};
use super::plan::{Plan, targets};
use super::target::{Shapes, Target};
use crate::scene::Scene;
use std::ops::Range;

/// Number of units up to which profiles are divided into several, so that many processes can share a plan of few
/// profiles.
const ENOUGH_UNITS: u64 = 256;
/// Fewest runs of a divided profile: with fewer, making the profile would cost more than the runs.
const LEAST_RUNS: u64 = 16;

/// Numbering of the runs, units and cells of a plan.
pub(super) struct Cells {
    /// Values of each axis, in the order of the plan.
    values: Vec<Vec<f64>>,
    targets: Vec<Target>,
    /// Axes that shape the roughness, in the order of the plan.
    outer: Vec<usize>,
    /// The other axes, those that shape the profile first.
    inner: Vec<usize>,
    preloads: u64,
    lines: u64,
    /// Runs of one unit, and units of one profile.
    chunk: u64,
    chunks: u64,
}

/// Runs on one profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    /// Index of the profile, from 0.
    pub line: u64,
    group: u64,
    steps: Range<u64>,
}

impl Cells {
    pub fn of(plan: &Plan) -> Cells {
        let targets = targets(plan);
        let with = |shapes: Shapes| {
            (0..targets.len()).filter(|&axis| targets[axis].shapes() == shapes).collect::<Vec<_>>()
        };
        let outer = with(Shapes::Roughness);
        let inner = [with(Shapes::Line), with(Shapes::Passes)].concat();
        let values: Vec<Vec<f64>> = plan.axes.iter().map(Axis::values).collect();
        let count = |axes: &[usize]| axes.iter().map(|&axis| values[axis].len() as u64).product::<u64>();
        let (groups, steps) = (count(&outer), count(&inner));
        let wanted = ENOUGH_UNITS.div_ceil(groups * plan.lines).min(steps / LEAST_RUNS).max(1);
        let chunk = steps.div_ceil(wanted);
        let preloads = plan.preloads.as_ref().map_or(1, Axis::count);
        let chunks = steps.div_ceil(chunk);
        Cells { values, targets, outer, inner, preloads, lines: plan.lines, chunk, chunks }
    }

    fn counts(&self, axes: &[usize]) -> impl DoubleEndedIterator<Item = u64> {
        axes.iter().map(|&axis| self.values[axis].len() as u64)
    }

    fn count(&self, axes: &[usize]) -> u64 {
        self.counts(axes).product()
    }

    /// Number of runs, the same for each profile.
    pub fn runs(&self) -> u64 {
        self.values.iter().map(|values| values.len() as u64).product()
    }

    /// Number of cells of one run.
    pub fn preloads(&self) -> u64 {
        self.preloads
    }

    /// Number of units.
    pub fn units(&self) -> u64 {
        self.count(&self.outer) * self.lines * self.chunks
    }

    /// The unit of an index; units of one spectrum are consecutive.
    pub fn unit(&self, index: u64) -> Unit {
        let (rest, chunk) = (index / self.chunks, index % self.chunks);
        let steps = self.count(&self.inner);
        let start = chunk * self.chunk;
        Unit {
            group: rest / self.lines,
            line: rest % self.lines,
            steps: start.min(steps)..(start + self.chunk).min(steps),
        }
    }

    /// All runs of one profile with the same roughness, by the number of the roughness.
    pub fn whole_unit(&self, group: u64, line: u64) -> Unit {
        Unit { group, line, steps: 0..self.count(&self.inner) }
    }

    /// The runs of a unit, in the most efficient order.
    pub fn runs_of(&self, unit: &Unit) -> impl Iterator<Item = u64> + use<'_> {
        let group = unit.group;
        unit.steps.clone().filter_map(move |step| {
            let mut places = vec![0; self.values.len()];
            for (axes, number) in [(&self.outer, group), (&self.inner, step)] {
                for (&axis, place) in axes.iter().zip(places_of(number, self.counts(axes))) {
                    places[axis] = place;
                }
            }
            number_at(&places, self.values.iter().map(|values| values.len() as u64))
        })
    }

    /// Number of runs of a unit.
    pub fn length_of(&self, unit: &Unit) -> u64 {
        unit.steps.end - unit.steps.start
    }

    /// The cells of a run, one for each preload.
    pub fn cells_of(&self, run: u64) -> Range<u64> {
        run * self.preloads..(run + 1) * self.preloads
    }

    /// Turns `scene` into that of a run: the base with the values of the run and its loading.
    ///
    /// # Errors
    /// The index of an axis whose number the scene does not have, and the reason.
    pub fn shape(&self, run: u64, base: &Scene, scene: &mut Scene) -> Result<(), (usize, String)> {
        restore(base, scene);
        let places = places_of(run, self.values.iter().map(|values| values.len() as u64));
        let values = places.iter().zip(&self.values).map(|(place, values)| values[*place as usize]);
        Target::set_all(self.targets.iter().copied().zip(values), scene)
    }
}

/// Restores the fields that an axis may have changed.
fn restore(base: &Scene, scene: &mut Scene) {
    scene.material = base.material;
    scene.length = base.length;
    scene.form = base.form;
    scene.adhesion = base.adhesion;
    scene.numerics = base.numerics;
    scene.loading.clone_from(&base.loading);
    scene.roughness.clone_from(&base.roughness);
}
