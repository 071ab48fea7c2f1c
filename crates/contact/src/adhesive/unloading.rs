//! Unloading: finds the indentation at which each node of the contact tree opens, and lists the
//! runs between these events. A run is a patch over a range of indentations in which the edges of
//! the patch do not jump.

use super::levels::{Span, smaller};
use super::run::{Ground, HeldPatch, Run, RunList};
use super::tree::Branch;
use crate::detachment::{DetachmentRule, Levels};
use crate::error::ContactError;
use asperity_data::push;

/// A part of the contact at the beginning of the unloading whose runs must still be listed.
#[derive(Clone, Copy, Debug)]
struct Part {
    branch: Branch,
    first: u32,
    last: u32,
    /// Indentation in m at which the larger patch that contains this part splits.
    opens: f64,
    /// True if the part is a whole patch that is in contact at the beginning of the unloading.
    is_whole: bool,
}

/// The smallest patch of a branch of the contact tree, around the node or the local minimum at
/// which the branch begins.
struct Bottom {
    /// Gap in m of the node at which the branch begins; −∞ if the branch begins at a local minimum.
    node_gap: f64,
    /// Smallest gap in m of all springs in the subtree of the branch.
    lowest: f64,
    /// Spring at the node or at the local minimum. In the smallest patch of the branch, this spring
    /// detaches first.
    spring: usize,
}

/// A walk down one branch of the contact tree, on which the patch shrinks from its largest to its
/// smallest size.
struct Descent {
    branch: Branch,
    first: usize,
    last: usize,
    bottom: Bottom,
    /// Indentation in m at which the patch of the previous step of the walk loses a spring or
    /// splits. Below this indentation the present springs form the patch.
    opens: f64,
    /// True for a patch that is in contact at the beginning of the unloading, until its run has
    /// been added to the list of runs.
    is_whole: bool,
    /// Height in m of pinned edges above the largest gap of a patch that is in contact at the
    /// beginning of the unloading; `None` if the edges are free.
    pin: Option<f64>,
    /// Length of the patch of the previous step as a function of its level; `None` if the run of
    /// that patch cannot continue with the present springs.
    above: Option<Levels>,
}

impl Descent {
    fn springs(&self) -> usize {
        self.last + 1 - self.first
    }

    /// Returns true if the patch has reached its smallest size on the branch.
    #[inline]
    fn is_at_bottom(&self, gaps: &[f64]) -> bool {
        if self.bottom.node_gap == f64::NEG_INFINITY {
            return self.first == self.last;
        }
        gaps[self.first] < self.bottom.node_gap && gaps[self.last] <= self.bottom.node_gap
    }

    /// Removes the outermost spring with the larger gap from the patch.
    #[inline]
    fn shrink(&mut self, gaps: &[f64]) {
        if gaps[self.first] >= gaps[self.last] {
            self.first += 1;
        } else {
            self.last -= 1;
        }
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    /// Lists the runs of an unloading that begins at the indentation `from` in m. A run is a patch
    /// over a range of indentations in which the edges of the patch do not jump. `held` are the
    /// patches in contact at `from`, from left to right.
    ///
    /// A patch v splits when the most stretched spring of v detaches. This has two conditions: the
    /// larger patch that contains v has already split, and the rule no longer allows the stretch of
    /// the spring. The indentation of the split is therefore t_v = min(t of the larger patch,
    /// smallest φ of v). φ is the indentation at which a patch with its edges at a given gap is in
    /// equilibrium; see the module `run`.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn open(&self, held: &[HeldPatch], from: f64) -> Result<RunList, ContactError> {
        let mut listed = RunList {
            runs: Vec::new(),
            end: f64::INFINITY,
            evaluations: 0,
        };
        let mut parts = Vec::new();
        for patch in held.iter().rev() {
            let whole = Part {
                branch: patch.branch,
                first: patch.first,
                last: patch.last,
                opens: from,
                is_whole: true,
            };
            push(&mut parts, whole)?;
            while let Some(part) = parts.pop() {
                let remaining = self.descend(part, patch.pin, &mut listed)?;
                for part in remaining.into_iter().flatten() {
                    push(&mut parts, part)?;
                }
            }
        }
        Ok(listed)
    }

    /// Returns false if a spring with the gap `gap` (m) certainly detaches at indentations below
    /// `opens` (m), whatever patch contains the spring. The patch must lie within a range of
    /// `springs` springs, so that it is at most as long as this range plus two edge cells. `gap`
    /// must be the smallest or the largest gap of the patch.
    #[inline]
    fn may_hold(&self, gap: f64, opens: f64, springs: usize) -> bool {
        let need = gap - opens;
        need <= 0.0 || self.rule.may_bear(need, (springs + 1) as f64)
    }

    #[inline]
    fn bottom_of(&self, branch: Branch) -> Bottom {
        match branch.origin() {
            Ok(index) => {
                let node = &self.tree.nodes[index];
                Bottom {
                    node_gap: node.gap,
                    lowest: node.lowest,
                    spring: self.tree.maximum(node),
                }
            }
            Err(rank) => {
                let spring = self.tree.minimum(rank);
                Bottom {
                    node_gap: f64::NEG_INFINITY,
                    lowest: self.gaps[spring],
                    spring,
                }
            }
        }
    }

    /// Adds the runs of one branch to `listed`, from the largest patch of the branch down to the
    /// smallest one. Returns the two parts that remain after the spring of the node of the branch
    /// has detached. `pin` is the height in m of pinned edges above the largest gap of a patch that
    /// is in contact at the beginning.
    fn descend(
        &self,
        part: Part,
        pin: Option<f64>,
        listed: &mut RunList,
    ) -> Result<[Option<Part>; 2], ContactError> {
        let gaps = self.gaps;
        let mut descent = Descent {
            branch: part.branch,
            first: part.first as usize,
            last: part.last as usize,
            bottom: self.bottom_of(part.branch),
            opens: part.opens,
            is_whole: part.is_whole,
            pin,
            above: None,
        };
        let lowest = descent.bottom.lowest;
        if !part.is_whole && !self.may_hold(lowest, part.opens, descent.springs()) {
            return Ok([None; 2]);
        }
        loop {
            let is_at_bottom = descent.is_at_bottom(gaps);
            let left_gap = gaps[descent.first];
            let right_gap = gaps[descent.last];
            let gap = if is_at_bottom {
                gaps[descent.bottom.spring]
            } else if left_gap >= right_gap {
                left_gap
            } else {
                right_gap
            };
            if descent.is_whole || self.may_hold(gap, descent.opens, descent.springs()) {
                self.list_span(&mut descent, gap, listed)?;
            } else {
                descent.above = None;
            }
            if is_at_bottom {
                return Ok(self.parts_below(&descent));
            }
            descent.shrink(gaps);
        }
    }

    /// Adds the patch with the present springs of a walk to `listed`, for the indentations at which
    /// the patch exists. `gap` is the largest gap of the patch in m.
    #[inline]
    fn list_span(
        &self,
        descent: &mut Descent,
        gap: f64,
        listed: &mut RunList,
    ) -> Result<(), ContactError> {
        listed.evaluations += 1;
        let span = Span {
            gap,
            first: descent.first,
            last: descent.last,
        };
        let levels = self.levels(&span);
        let holds = self.holds_to(&levels);
        let is_patch = descent.is_whole || holds < descent.opens;
        if !is_patch {
            descent.above = None;
            return Ok(());
        }
        let mut leaves = smaller(descent.opens, holds);
        let mut to = descent.opens;
        if descent.is_whole {
            to = f64::INFINITY;
            if let Some(rise) = descent.pin {
                let (released, slides) = levels.release(self.rule, rise);
                let released = smaller(descent.opens, released);
                leaves = if slides {
                    smaller(leaves, released)
                } else {
                    released
                };
                let mut pinned = Run::new(descent.branch, &span, released, to);
                pinned.pin = rise;
                push(&mut listed.runs, pinned)?;
                to = released;
            }
        }
        // `leaves` is the indentation at which the free edges jump, and `to` the indentation at
        // which they begin to move. If both are equal, the edges never move freely, so there is no
        // run with free edges.
        if leaves != to {
            match (listed.runs.last_mut(), descent.above) {
                (Some(run), Some(upper)) if self.slides_on(&levels, &upper) => {
                    run.from = leaves;
                    run.bottom = span.ends();
                }
                _ => push(
                    &mut listed.runs,
                    Run::new(descent.branch, &span, leaves, to),
                )?,
            }
        }
        // A run continues with one spring less only if the level of the edges falls to the largest
        // gap of the present patch.
        let goes_on = leaves == holds && leaves < to;
        descent.above = goes_on.then_some(levels);
        descent.opens = leaves;
        descent.is_whole = false;
        listed.end = smaller(listed.end, leaves);
        Ok(())
    }

    /// Returns the two parts into which the smallest patch of a branch splits when the spring of
    /// its node detaches.
    fn parts_below(&self, descent: &Descent) -> [Option<Part>; 2] {
        let Ok(node) = descent.branch.origin() else {
            return [None; 2];
        };
        let [left, right] = self.tree.parts(node);
        let spring = descent.bottom.spring as u32;
        let left_part = Part {
            branch: left,
            first: descent.first as u32,
            last: spring - 1,
            opens: descent.opens,
            is_whole: false,
        };
        let right_part = Part {
            branch: right,
            first: spring + 1,
            last: descent.last as u32,
            opens: descent.opens,
            is_whole: false,
        };
        [Some(left_part), Some(right_part)]
    }
}
