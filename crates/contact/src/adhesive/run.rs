//! Runs. A run is a patch over a range of indentations in which the edges of the patch move without
//! a jump. The edge model decides the length of a patch, its next attachment and its next
//! detachment.
//!
//! A span is a range of springs that one patch contains. A patch grows from span to span. The level
//! of a patch is the gap at which its edges lie. On each span the level lies between the largest
//! gap of the span and the gap of the wall, the spring that attaches next. The length ℓ of the
//! patch follows from the level. The rule of detachment gives the largest stretch Δl_max(ℓ), which
//! depends on ℓ alone.
//!
//! * Whole springs, as Popov and Filippov (2012) count them: a patch of n springs has the length n
//!   Δx at all levels of its span.
//! * Edges that slide between springs: the profile is straight between neighbouring springs, and a
//!   patch ends where the profile crosses the level of the patch. A patch at the level t is in
//!   equilibrium at the indentation φ(t) = t − Δl_max(ℓ(t)). The patch grows while φ(t) ≤ d and
//!   recedes while φ(t) ≥ d, where d is the indentation. On one span ℓ is linear in t, so φ is
//!   convex: φ falls to its lowest value and then rises. A patch is stable only where φ rises.

use super::levels::{EdgeCell, Slider, Span, larger};
use super::tree::{Branch, ContactTree};
use crate::detachment::{DetachmentRule, Levels, ROUNDING};
use crate::history::Patch;
use crate::totals::ContactTotals;

/// A run: one patch over a range of indentations, in which the patch grows by one spring after the
/// other without a jump. The range ends where the patch jumps, merges or splits.
///
/// The runs of a motion are listed in the order of a walk through the contact tree from its root.
/// Of the two parts of a patch, the walk visits the right one first. On each branch of the tree the
/// larger patch comes first. A run therefore comes before the runs of the smaller patches inside
/// its patch, and before the runs of patches on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Lower bound of the indentations of the run in m, which belongs to the run. The bound is −∞
    /// if the patch is already in contact when a loading begins.
    pub from: f64,
    /// Upper bound of the indentations of the run in m, which does not belong to the run. The bound
    /// is +∞ if the patch is already in contact when an unloading begins.
    pub to: f64,
    /// Height in m of pinned edges above the largest gap of the patch. Pinned edges stay in place
    /// although the body moves. NaN if the edges are free to move.
    pub pin: f64,
    /// First and last spring of the patch at the lower end of the range, where the patch is
    /// smallest.
    pub bottom: [u32; 2],
    /// First and last spring of the patch at the upper end of the range, where the patch is
    /// largest.
    pub top: [u32; 2],
    pub branch: Branch,
}

/// A patch that is in contact where one motion ends and the next one begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldPatch {
    pub branch: Branch,
    pub first: u32,
    pub last: u32,
    /// Height in m of pinned edges above the largest gap of the patch. Pinned edges stay in place
    /// although the body moves. `None` if the edges are free to move.
    pub pin: Option<f64>,
}

/// The runs of a motion. A run is a patch over a range of indentations in which the edges of the
/// patch do not jump.
#[derive(Debug)]
pub struct RunList {
    pub runs: Vec<Run>,
    /// Indentation in m at which the list ends. For a loading it is the smallest indentation of
    /// full contact. For an unloading it is the smallest indentation at which any spring is in
    /// contact.
    pub end: f64,
    /// Number of times that the rule of Hess was evaluated for this motion.
    pub evaluations: u64,
}

/// Input of all passes over the contact tree: the gaps, the tree, and the rule of detachment for
/// the direction of the motion.
///
/// If `SLIDES` is true, the edges of patches move between springs, and the force is a curve between
/// two events. If `SLIDES` is false, patches consist of whole springs. The length of a patch then
/// depends only on the number of springs of the patch, and there are no edge cells.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a, const SLIDES: bool, R> {
    pub gaps: &'a [f64],
    pub tree: &'a ContactTree,
    /// Rule of detachment for the direction of motion.
    pub rule: R,
    pub unloading: bool,
}

impl HeldPatch {
    pub fn springs(&self) -> Patch {
        Patch {
            first: self.first as usize,
            last: self.last as usize,
        }
    }
}

impl Run {
    pub fn new(branch: Branch, span: &Span, from: f64, to: f64) -> Self {
        Run {
            from,
            to,
            pin: f64::NAN,
            bottom: span.ends(),
            top: span.ends(),
            branch,
        }
    }

    /// Returns the height in m of pinned edges above the largest gap of the patch; `None` if the
    /// edges are free to move. Pinned edges stay in place although the body moves.
    #[inline]
    pub fn pin(&self) -> Option<f64> {
        Some(self.pin).filter(|pin| !pin.is_nan())
    }

    #[inline]
    pub fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    #[inline]
    pub fn span(&self, branch: Branch, ends: [u32; 2]) -> Span {
        let first = ends[0] as usize;
        let last = ends[1] as usize;
        let gap_at_ends = larger(self.gaps[first], self.gaps[last]);
        // The largest gap of a patch is the gap of the node at which its branch begins. If the
        // patch has grown since then, it is the gap of the outermost spring that attached last.
        let gap = match branch.origin() {
            Ok(node) => larger(gap_at_ends, self.tree.nodes[node].gap),
            Err(_) => gap_at_ends,
        };
        Span { gap, first, last }
    }

    #[inline]
    pub fn bottom(&self, run: &Run) -> Span {
        self.span(run.branch, run.bottom)
    }

    #[inline]
    pub fn slider(&self, run: &Run, span: &Span) -> Slider<R> {
        Slider::new(self.gaps, span, self.rule, run.pin())
    }

    /// Returns the smallest indentation in m at which a patch with the springs of `span` attaches
    /// its next spring. `wall` is the gap of the next spring in m.
    #[inline]
    pub fn attaches_at(&self, span: &Span, wall: f64) -> f64 {
        self.attachment(&self.levels(span), wall)
    }

    /// Returns the level of a patch at an indentation in m: the gap in m at which the edges of the
    /// patch lie. The patch consists of the springs of `span`. `pin` is `None` if the edges are
    /// free to move. If the edges stay in place although the body moves, `pin` is the height in m
    /// of the edges above the largest gap of the patch.
    #[inline]
    pub fn level(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        span.gap + self.rise(span, pin, indentation)
    }

    /// Returns the height in m of the edges of a patch above the largest gap of the patch, at an
    /// indentation in m. The patch consists of the springs of `span`. `pin` is `None` if the edges
    /// are free to move. If the edges stay in place although the body moves, `pin` is this height.
    #[inline]
    pub fn rise(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        pin.unwrap_or_else(|| self.levels(span).rise(self.rule, indentation))
    }

    /// Returns sums over one patch that consists of the springs of `span`. The sums are over the
    /// whole cells of the patch if `SLIDES` is true, otherwise over the springs of the patch.
    #[inline]
    pub fn totals(&self, span: &Span) -> ContactTotals {
        let end = span.last + usize::from(!SLIDES);
        let [high, high_squares] = self.tree.sums_before(self.gaps, end);
        let [low, low_squares] = self.tree.sums_before(self.gaps, span.first);
        ContactTotals {
            springs: span.springs() as i64,
            patches: 1,
            quanta: high - low,
            squares: high_squares - low_squares,
        }
    }

    /// Returns the largest indentation in m at which the patch of a run has exactly the springs of
    /// `span`. At larger indentations the patch has the springs of `above`.
    #[inline]
    fn upper_end(&self, span: &Span, above: &Span) -> f64 {
        // On unloading, the patch with the springs of `above` loses a spring when it no longer
        // bears the stretch of its outermost spring. The patch then has the springs of `span`.
        if self.unloading {
            self.holds_to(&self.levels(above))
        } else {
            self.attaches_at(span, above.gap)
        }
    }

    /// Returns the indentation in m up to which the patch of `run` has exactly the springs of
    /// `span`. A run is a patch over a range of indentations in which the edges of the patch do not
    /// jump.
    #[inline]
    pub fn filled_up_to(&self, run: &Run, span: &Span) -> f64 {
        if span.ends() == run.top {
            return run.to;
        }
        self.upper_end(span, &span.grown(self.gaps))
    }

    /// Returns a gap in m such that every spring beside the patch with a smaller gap certainly
    /// belongs to the patch at `indentation` in m. The patch has at least the springs of `span`.
    /// The returned gap is valid on loading and on unloading, and saves evaluations of the rule of
    /// Hess.
    #[inline]
    pub fn sure_level(&self, span: &Span, indentation: f64) -> f64 {
        let stretch = self
            .rule
            .sure_stretch(self.least_length(span.first, span.last));
        (indentation + stretch) - ROUNDING * (indentation.abs() + stretch)
    }

    /// Calls `see` for each size that the patch of `run` has, from the smallest to the largest. A
    /// run is a patch over a range of indentations. The arguments of `see` are the springs of the
    /// patch, and the lower and the upper end of the range of indentations in m at which the patch
    /// has exactly these springs. Indentations below `low` (m) are left out. The calls end when
    /// `see` returns true.
    #[inline]
    pub fn each_span(&self, run: &Run, low: f64, mut see: impl FnMut(&Span, f64, f64) -> bool) {
        let bottom = self.bottom(run);
        let mut span = self.filled(run, bottom, low);
        let mut from = if span == bottom { run.from } else { low };
        loop {
            let to = self.filled_up_to(run, &span);
            if see(&span, from, to) || span.ends() == run.top {
                return;
            }
            span = span.grown(self.gaps);
            from = to;
        }
    }

    /// Returns the springs of the patch of `run` at an indentation in m. A run is a patch over a
    /// range of indentations. The search begins with `from`, the springs of the patch at a smaller
    /// indentation.
    pub fn filled(&self, run: &Run, from: Span, indentation: f64) -> Span {
        let mut span = from;
        while span.ends() != run.top {
            let sure_level = self.sure_level(&span, indentation);
            let sure = span.up_to(self.gaps, sure_level, run.top);
            if sure != span {
                span = sure;
                continue;
            }
            let above = span.grown(self.gaps);
            if indentation < self.upper_end(&span, &above) {
                break;
            }
            span = above;
        }
        span
    }

    /// Returns the springs of the patch of `run` at an indentation in m. A run is a patch over a
    /// range of indentations in which the edges of the patch do not jump.
    #[inline]
    pub fn span_at(&self, run: &Run, indentation: f64) -> Span {
        self.filled(run, self.bottom(run), indentation)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    /// Returns the length of a patch with the springs of `span` as a function of its level, the gap
    /// at which the edges of the patch lie.
    #[inline]
    pub fn levels(&self, span: &Span) -> Levels {
        if SLIDES {
            return Levels::between_springs(self.gaps, span).0;
        }
        let length = f64::from(span.springs() as u32);
        Levels {
            gap: span.gap,
            length,
            growth: 0.0,
            top: f64::INFINITY,
        }
    }

    /// Returns a lower bound, in cells, of the length that a patch with the springs `first..=last`
    /// has just before the patch attaches its next spring.
    #[inline]
    pub fn least_length(&self, first: usize, last: usize) -> f64 {
        // Before the next spring attaches, one of the two edge cells is fully in contact.
        (last + usize::from(!SLIDES) - first).max(1) as f64
    }

    /// Returns the smallest indentation in m at which a patch attaches its next spring. `wall` is
    /// the gap of this spring in m. `levels` is the length of the patch as a function of its level,
    /// the gap at which the edges of the patch lie.
    #[inline]
    pub fn attachment(&self, levels: &Levels, wall: f64) -> f64 {
        let length = if SLIDES {
            levels.length_at(wall - levels.gap)
        } else {
            levels.length
        };
        wall - self.rule.largest_stretch(length)
    }

    /// Returns the smallest indentation in m at which a patch still bears the stretch of its most
    /// stretched spring, or the largest gap of the patch if this gap is smaller. `levels` is the
    /// length of the patch as a function of its level, the gap at which the edges of the patch lie.
    #[inline]
    pub fn holds_to(&self, levels: &Levels) -> f64 {
        let gap = levels.gap;
        let rule = self.rule;
        if !SLIDES {
            // At the indentation `detaches` the stretch of the spring is exactly Δl_max and the
            // spring detaches. The smallest indentation at which the spring stays is therefore the
            // next floating-point number above. But a spring whose gap is closed stays in contact
            // under any rule.
            let detaches = gap - rule.largest_stretch(levels.length);
            return detaches.next_up().min(gap);
        }
        // The patch holds down to the smallest φ, the indentation of equilibrium. φ is smallest
        // where the length of the patch is the turning length.
        let excess = rule.turning_length(levels.growth) - levels.length;
        // The code chooses between computed values instead of branching, because the processor
        // would often mispredict the branches.
        let lowest = excess / levels.growth;
        let most = levels.top - gap;
        let limited = if lowest < most { lowest } else { most };
        let rise = if excess > 0.0 { limited } else { 0.0 };
        let holds = (gap + rise) - rule.largest_stretch(levels.length_at(rise));
        if holds < gap { holds } else { gap }
    }

    /// Returns true if the edges of a patch do not jump when the patch attaches its next spring.
    /// `lower` is the length of the patch before the attachment, and `upper` the length after the
    /// attachment. Both lengths are functions of the level, the gap at which the edges of the patch
    /// lie.
    #[inline]
    pub fn slides_on(&self, lower: &Levels, upper: &Levels) -> bool {
        if !SLIDES {
            return true;
        }
        // There is no jump if φ rises already at the lowest level of `upper`, and if `upper` begins
        // with the length that `lower` has reached. The length jumps if a cell with two equal gaps
        // is added.
        let reached = lower.length_at(lower.top - lower.gap);
        self.rule.turning_length(upper.growth) < upper.length && upper.length - reached < 0.25
    }

    /// Computes ∫ (c − θ)² dx in cells times m² over the part of the profile that the edges of a
    /// patch pass while it grows from the state `lower` to the state `upper`. θ is the indentation
    /// at which an edge passes a point with the gap c. The largest stretch at this point is
    /// therefore c − θ.
    pub fn passed_squares(&self, lower: &SpanAtLevel, upper: &SpanAtLevel) -> f64 {
        if !SLIDES {
            let fewer = lower.span.springs() as f64;
            let more = upper.span.springs() as f64;
            // On loading, springs attach one by one to patches of `fewer` up to `more − 1` springs.
            // On unloading they detach one by one from patches of `more` down to `fewer + 1`
            // springs.
            return if self.unloading {
                self.rule.squares_of_patches(fewer + 1.0, more)
            } else {
                self.rule.squares_of_patches(fewer, more - 1.0)
            };
        }
        // Whole cells and shares of cells are subtracted separately, because the difference of two
        // long lengths would be less accurate.
        let fewer_cells = lower.whole_cells();
        let more_cells = upper.whole_cells();
        let smaller_share = lower.share_of_edges(self.gaps);
        let larger_share = upper.share_of_edges(self.gaps);
        let difference = (more_cells - fewer_cells) + (larger_share - smaller_share);
        let sum = (fewer_cells + more_cells) + (smaller_share + larger_share);
        self.rule.squares_between(difference, sum)
    }
}

/// The springs of a patch, and the level of the patch: the gap in m at which the edges of the patch
/// lie.
#[derive(Clone, Copy, Debug)]
pub struct SpanAtLevel {
    pub span: Span,
    pub level: f64,
}

impl SpanAtLevel {
    /// Returns the number of cells between the springs of the patch.
    fn whole_cells(&self) -> f64 {
        (self.span.last - self.span.first) as f64
    }

    /// Returns the length in contact of both edge cells, in cells.
    fn share_of_edges(&self, gaps: &[f64]) -> f64 {
        let [left, right] = EdgeCell::of_span(gaps, &self.span, self.level);
        left.share + right.share
    }
}
