//! Unloading: finds the indentation at which each node of the contact tree opens, and lists the
//! patches between these events.

use super::levels::{Levels, Span, smaller};
use super::run::{Ground, Held, Listed, Run};
use super::tree::Branch;
use crate::error::ContactError;
use asperity_data::push;

/// Factor that widens bounds by a margin for rounding.
const ABOVE: f64 = 1.0 + 1e-12;

/// Part of the contact at the beginning of the unloading whose runs are not listed yet.
#[derive(Clone, Copy, Debug)]
struct Part {
    branch: Branch,
    first: u32,
    last: u32,
    /// Indentation in m at which the larger patch around this part splits.
    opens: f64,
    /// True for a whole patch held at the beginning of the unloading.
    is_whole: bool,
}

impl<const SLIDES: bool> Ground<'_, SLIDES> {
    /// Lists the runs of an unloading from the indentation `from` (m) on. `held` are the patches in
    /// contact there, from left to right.
    ///
    /// A patch splits when its most stretched spring detaches. This happens as soon as the larger
    /// patch around it has split and the rule of Hess no longer holds the spring: t_v = min(t of
    /// the patch around v, smallest φ of v).
    pub fn open(&self, held: &[Held], from: f64) -> Result<Listed, ContactError> {
        let mut listed = Listed {
            runs: Vec::new(),
            end: f64::INFINITY,
            evaluations: 0,
        };
        let mut parts = Vec::new();
        for &Held {
            branch,
            first,
            last,
            pin,
        } in held.iter().rev()
        {
            parts.push(Part {
                branch,
                first,
                last,
                opens: from,
                is_whole: true,
            });
            while let Some(part) = parts.pop() {
                for part in self.descend(part, pin, &mut listed)?.into_iter().flatten() {
                    push(&mut parts, part)?;
                }
            }
        }
        Ok(listed)
    }

    /// Returns false if no patch within `springs` springs can hold the spring of this `gap` (m)
    /// below the indentation `opens` (m). `gap` is the smallest or the largest gap of the patch.
    /// The length of the patch is at most the length of these springs and two edge cells.
    #[inline]
    fn may_hold(&self, gap: f64, opens: f64, springs: usize) -> bool {
        let need = gap - opens;
        need <= 0.0 || need * need < self.stretch * self.stretch * ABOVE * (springs + 1) as f64
    }

    /// Returns the two parts of the smallest span of a branch after `spring` detaches at an
    /// indentation in m.
    fn parts_of(
        &self,
        branch: Branch,
        span: &Span,
        spring: usize,
        opens: f64,
    ) -> [Option<Part>; 2] {
        let Ok(node) = branch.origin() else {
            return [None; 2];
        };
        let [left, right] = self.tree.parts(node);
        let ([first, last], spring) = (span.ends(), spring as u32);
        let part = |branch, first, last| {
            Some(Part {
                branch,
                first,
                last,
                opens,
                is_whole: false,
            })
        };
        [part(left, first, spring - 1), part(right, spring + 1, last)]
    }

    /// Lists the runs of one branch from its largest span down to its smallest one, and returns the
    /// two parts that remain below its node. `pin` is the height in m of the pinned edges of a held
    /// patch above its largest gap.
    fn descend(
        &self,
        part: Part,
        pin: Option<f64>,
        listed: &mut Listed,
    ) -> Result<[Option<Part>; 2], ContactError> {
        let Ground { gaps, tree, .. } = *self;
        let Listed {
            runs,
            end,
            evaluations,
        } = listed;
        let (mut first, mut last) = (part.first as usize, part.last as usize);
        let (mut opens, mut is_whole) = (part.opens, part.is_whole);
        let (bottom, lowest, place) = match part.branch.origin() {
            Ok(index) => {
                let node = &tree.nodes[index];
                (node.gap, node.lowest, tree.maximum(node))
            }
            Err(rank) => {
                let place = tree.minimum(rank);
                (f64::NEG_INFINITY, gaps[place], place)
            }
        };
        if !is_whole && !self.may_hold(lowest, opens, last + 1 - first) {
            return Ok([None; 2]);
        }
        let is_leaf = bottom == f64::NEG_INFINITY;
        // Levels of the span above, while its run may go on.
        let mut above: Option<Levels> = None;
        loop {
            let (left, right) = (gaps[first], gaps[last]);
            let at_bottom = if is_leaf {
                first == last
            } else {
                left < bottom && right <= bottom
            };
            let gap = if at_bottom {
                gaps[place]
            } else if left >= right {
                left
            } else {
                right
            };
            let span = Span { gap, first, last };
            let mut goes_on = None;
            if is_whole || self.may_hold(gap, opens, last + 1 - first) {
                *evaluations += 1;
                let levels = self.levels(&span);
                let holds = self.holds_to(&levels);
                if is_whole || holds < opens {
                    let mut leaves = smaller(opens, holds);
                    let mut to = if is_whole { f64::INFINITY } else { opens };
                    if let Some(rise) = pin.filter(|_| is_whole) {
                        let (released, slides) = levels.release(self.stretch, rise);
                        let released = smaller(opens, released);
                        leaves = if slides {
                            smaller(leaves, released)
                        } else {
                            released
                        };
                        push(
                            runs,
                            Run {
                                pin: rise,
                                ..Run::new(part.branch, &span, released, to)
                            },
                        )?;
                        to = released;
                    }
                    match (runs.last_mut(), above) {
                        // Pinned edges run away at once.
                        _ if leaves == to => {}
                        (Some(run), Some(upper)) if self.slides_on(&levels, &upper) => {
                            (run.from, run.bottom) = (leaves, span.ends());
                        }
                        _ => push(runs, Run::new(part.branch, &span, leaves, to))?,
                    }
                    // A run continues only from a level equal to the gap of the span.
                    goes_on = (leaves == holds && leaves < to).then_some(levels);
                    *end = smaller(*end, leaves);
                    (opens, is_whole) = (leaves, false);
                }
            }
            above = goes_on;
            if at_bottom {
                return Ok(self.parts_of(part.branch, &span, place, opens));
            }
            if left >= right { first += 1 } else { last -= 1 }
        }
    }
}
