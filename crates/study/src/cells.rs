//! Order in which a plan is computed, and division of this computation among threads.
//!
//! A *cell* is one combination of values on the axes. A *streak* consists of all cells that differ
//! only in the preload, and is computed with a single loading. A *unit* consists of streaks on one
//! random profile with the same roughness. One thread computes the whole unit, so that the
//! roughness of the profile is made only once.

use super::axis::{Axis, Shapes};
use super::plan::Plan;
use std::ops::Range;

/// If the plan has fewer units than this number, the streaks of one profile are divided into
/// several units, so that all threads have work.
const ENOUGH_UNITS: u64 = 256;
/// Smallest number of streaks in a unit if the streaks of a profile are divided. In a smaller unit,
/// making the profile would take longer than computing the streaks.
const LEAST_STREAKS: u64 = 16;

/// Numbering of the streaks and units of a plan. A streak consists of all cells that differ only in
/// the preload, on one profile. A unit consists of streaks that one thread computes.
pub(super) struct Cells<'p> {
    plan: &'p Plan,
    /// Indices of the axes without a preload axis, sorted by [`Shapes`]: first the axes that change
    /// the roughness.
    order: Vec<usize>,
    /// Number of streaks on one profile with the same roughness.
    steps: u64,
    preloads: u64,
    /// Number of streaks in one unit. `chunks` is the number of units of one profile.
    chunk: u64,
    chunks: u64,
}

/// Streak: all cells of a plan that differ only in the preload, on one profile. A streak is
/// computed with a single loading.
pub(super) struct Streak {
    /// Cells of the streak, one for each preload. A cell is one combination of values on the axes.
    pub cells: Range<u64>,
    /// Index of the profile, counted from 0.
    pub line: u64,
}

impl<'p> Cells<'p> {
    pub fn of(plan: &'p Plan) -> Cells<'p> {
        let axes = plan.scene_axes();
        let mut order: Vec<usize> = (0..axes.len()).collect();
        order.sort_by_key(|&axis| axes[axis].target.shapes());
        let inner = axes
            .iter()
            .filter(|axis| axis.target.shapes() > Shapes::Roughness);
        let steps: u64 = inner.map(Axis::count).product();
        let preloads = plan.preloads().map_or(1, Axis::count);
        let profiles = plan.records_in_all() / preloads / steps;
        let wanted = ENOUGH_UNITS
            .div_ceil(profiles)
            .min(steps / LEAST_STREAKS)
            .max(1);
        let chunk = steps.div_ceil(wanted);
        Cells {
            plan,
            order,
            steps,
            preloads,
            chunk,
            chunks: steps.div_ceil(chunk),
        }
    }

    /// Returns the number of units into which the plan is divided. A unit is a part of the plan
    /// that one thread computes, on one random profile with the same roughness.
    pub fn units(&self) -> u64 {
        self.plan.records_in_all() / self.preloads / self.steps * self.chunks
    }

    /// Returns the streaks of unit number `unit`. A streak consists of all cells that differ only
    /// in the preload, on one random profile. A unit consists of streaks that one thread computes,
    /// on one random profile with unchanged roughness.
    ///
    /// The streaks are ordered so that as little of the profile as possible is computed again from
    /// one streak to the next. Units with the same spectrum have consecutive numbers.
    pub fn streaks(&self, unit: u64) -> impl Iterator<Item = Streak> + use<'_> {
        let start = unit % self.chunks * self.chunk;
        let group_and_line = unit / self.chunks;
        let group = group_and_line / self.plan.lines;
        let line = group_and_line % self.plan.lines;
        (start..(start + self.chunk).min(self.steps)).map(move |step| {
            let places = self
                .plan
                .places_on(self.order.iter().copied(), group * self.steps + step);
            let first = self.plan.cell_at(&places);
            Streak {
                cells: first..first + self.preloads,
                line,
            }
        })
    }
}
