//! Jumps of patches: the indentations at which runs end and other runs begin.
//!
//! A run is a patch over a range of indentations in which its edges do not jump. Where a patch
//! jumps, its run begins at some indentation d, and the runs of the smaller patches inside it end
//! at the same d. On loading the smaller patches become the larger one at d; on unloading the
//! larger patch becomes the smaller ones just below d. Both directions are therefore found in the
//! same way.

use super::levels::Span;
use super::run::{Run, SpanAtLevel};
use super::{Runs, SquaredStretch};
use crate::detachment::DetachmentRule;
use crate::history::Patch;

/// One end of a run. A run is a patch over a range of indentations in which the edges of the patch
/// do not jump. The run begins at the smallest of these indentations, where its patch is smallest,
/// and ends at the largest of them, where its patch is largest.
#[derive(Clone, Copy, Debug)]
pub struct Boundary {
    pub indentation: f64,
    /// Index of the run in the list of runs.
    run: u32,
    /// Number of springs of the patch. The number is positive at the beginning of a run, and
    /// negative at its end.
    pub springs: i32,
}

/// Patches that jump at one indentation.
#[derive(Clone, Copy, Debug)]
pub struct PatchJump {
    pub indentation: f64,
    /// Number of springs that are in contact at the indentation but not just below it.
    pub springs: i64,
    /// ∫ (c − d)² dx in cells times m² over the part of the profile that is in contact at the
    /// indentation d but not just below it. c is the gap.
    pub squared_stretch: f64,
    /// Number of patches just below the indentation.
    pub patches_below: u64,
    /// Number of patches at the indentation.
    pub patches_at: u64,
    /// Number of patches that jump at this indentation.
    pub jumping: u64,
    /// The patch of which the most springs jump, as it is at the indentation.
    pub larger: Patch,
    /// Springs from the first to the last one of the smaller patches that lie inside `larger` just
    /// below the indentation; `None` if there is no patch.
    pub smaller: Option<Patch>,
    /// Number of the smaller patches.
    pub parts: u64,
    /// Number of patches to the left of `larger` at the indentation.
    pub to_the_left: u64,
}

/// Counts which runs exist at an indentation, so that the number of patches to the left of a run is
/// found in few steps. It is a binary indexed tree over the list of runs. In this list the right
/// one of two separate runs comes first.
struct PresentRuns {
    counts: Vec<i32>,
    total: u64,
}

impl PresentRuns {
    /// Creates the counts at the indentation `low` in m.
    fn new(runs: &[Run], low: f64) -> Self {
        let mut present = PresentRuns {
            counts: vec![0; runs.len() + 1],
            total: 0,
        };
        for (index, run) in runs.iter().rev().enumerate() {
            if run.is_at(low) {
                present.counts[index + 1] += 1;
                present.total += 1;
            }
        }
        for index in 1..present.counts.len() {
            let above = index + lowest_bit(index);
            if above < present.counts.len() {
                present.counts[above] += present.counts[index];
            }
        }
        present
    }

    /// Adds the run of a boundary if it begins there, and removes it if it ends there.
    fn pass(&mut self, boundary: &Boundary) {
        let change = boundary.springs.signum();
        self.total = self.total.wrapping_add_signed(i64::from(change));
        let mut place = self.counts.len() - 1 - boundary.run as usize;
        while place < self.counts.len() {
            self.counts[place] += change;
            place += lowest_bit(place);
        }
    }

    /// Returns the number of runs to the left of a run. Runs inside this run must not be present.
    fn to_the_left_of(&self, run: u32) -> u64 {
        let mut place = self.counts.len() - 2 - run as usize;
        let mut count = 0;
        while place > 0 {
            count += i64::from(self.counts[place]);
            place -= lowest_bit(place);
        }
        count.unsigned_abs()
    }
}

fn lowest_bit(number: usize) -> usize {
    number & number.wrapping_neg()
}

impl<const SLIDES: bool, R: DetachmentRule> Runs<'_, SLIDES, R> {
    /// Returns the ends of all runs at indentations above `low` and up to `high` (m), in ascending
    /// order of the indentation. At one indentation, the run of a larger patch comes just before
    /// the runs of the smaller patches inside this patch. Of two separate patches, the right one
    /// comes first.
    pub fn boundaries(&self, low: f64, high: f64) -> Vec<Boundary> {
        let mut boundaries = Vec::new();
        for (index, run) in self.runs.iter().enumerate() {
            let begins = Boundary {
                // Adding 0.0 changes −0 to 0, which the sort would place after −0.
                indentation: run.from + 0.0,
                run: index as u32,
                springs: springs_between(run.bottom),
            };
            let ends = Boundary {
                indentation: run.to + 0.0,
                run: index as u32,
                springs: -springs_between(run.top),
            };
            for boundary in [begins, ends] {
                if low < boundary.indentation && boundary.indentation <= high {
                    boundaries.push(boundary);
                }
            }
        }
        boundaries.sort_unstable_by(|boundary, other| {
            let by_indentation = boundary.indentation.total_cmp(&other.indentation);
            by_indentation.then(boundary.run.cmp(&other.run))
        });
        boundaries
    }

    /// Returns the jumps of patches at indentations above `low` and up to `high` (m), in ascending
    /// order. A patch jumps if at least `least` of its springs attach or detach at one indentation.
    pub fn patch_jumps(&self, low: f64, high: f64, least: i32) -> Vec<PatchJump> {
        let mut jumps = Vec::new();
        let mut present = PresentRuns::new(self.runs, low);
        let boundaries = self.boundaries(low, high);
        for together in
            boundaries.chunk_by(|boundary, next| boundary.indentation == next.indentation)
        {
            let patches_below = present.total;
            for boundary in together {
                present.pass(boundary);
            }
            jumps.extend(self.jump_of(together, patches_below, &present, least));
        }
        jumps
    }

    /// Returns the jump at the common indentation of the boundaries `together`; `None` if no patch
    /// jumps. `present` counts the runs at this indentation.
    fn jump_of(
        &self,
        together: &[Boundary],
        patches_below: u64,
        present: &PresentRuns,
        least: i32,
    ) -> Option<PatchJump> {
        let indentation = together.first()?.indentation;
        let mut stretched = None;
        let mut most = 0;
        let mut jump = PatchJump {
            indentation,
            springs: 0,
            squared_stretch: 0.0,
            patches_below,
            patches_at: present.total,
            jumping: 0,
            larger: Patch { first: 0, last: 0 },
            smaller: None,
            parts: 0,
            to_the_left: 0,
        };
        // Each chunk is the run of a larger patch and the runs of the smaller patches inside it.
        for patches in together.chunk_by(|_, next| next.springs < 0) {
            let springs: i32 = patches.iter().map(|boundary| boundary.springs).sum();
            if springs < least {
                continue;
            }
            let sum = stretched
                .get_or_insert_with(|| SquaredStretch::new(&self.ground, indentation.abs()));
            self.add_stretches(patches, sum);
            jump.springs += i64::from(springs);
            jump.jumping += 1;
            if springs >= most
                && let [larger, smaller @ ..] = patches
            {
                most = springs;
                jump.larger = patch_of(self.run(larger).bottom);
                jump.smaller = self.extent(smaller);
                jump.parts = smaller.len() as u64;
                jump.to_the_left = present.to_the_left_of(larger.run);
            }
        }
        jump.squared_stretch = stretched?.total();
        Some(jump)
    }

    /// Returns the springs from the first to the last one of patches that are in the order of the
    /// list of runs, so that the rightmost patch is the first one; `None` if there is no patch.
    fn extent(&self, patches: &[Boundary]) -> Option<Patch> {
        let [_, last] = self.run(patches.first()?).top;
        let [first, _] = self.run(patches.last()?).top;
        Some(patch_of([first, last]))
    }

    fn run(&self, boundary: &Boundary) -> &Run {
        &self.runs[boundary.run as usize]
    }

    /// Adds the squared stretches of a larger patch to a sum, and subtracts those of the smaller
    /// patches inside it.
    fn add_stretches(&self, patches: &[Boundary], sum: &mut SquaredStretch) {
        let ground = &self.ground;
        for boundary in patches {
            let run = self.run(boundary);
            let indentation = boundary.indentation;
            if boundary.springs > 0 {
                let span = ground.bottom(run);
                let level = ground.level(&span, run.pin(), indentation);
                sum.add(ground, 1, &SpanAtLevel { span, level }, indentation);
            } else {
                let span: Span = ground.span(run.branch, run.top);
                let level = ground.level_up_to(&span, run.pin(), indentation);
                sum.add(ground, -1, &SpanAtLevel { span, level }, indentation);
            }
        }
    }
}

/// Returns the number of springs from the first to the last index of `ends`. A profile has at most
/// 2^28 springs.
fn springs_between(ends: [u32; 2]) -> i32 {
    let [first, last] = ends;
    (last - first + 1).cast_signed()
}

fn patch_of(ends: [u32; 2]) -> Patch {
    let [first, last] = ends;
    Patch {
        first: first as usize,
        last: last as usize,
    }
}
