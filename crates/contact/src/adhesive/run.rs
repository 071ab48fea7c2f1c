//! Runs: patches over ranges of indentation in which their edges move without a jump. The two edge
//! models give the length of a patch, its next attachment and its next detachment.
//!
//! A patch grows from span to span. On each span its level lies between the largest gap of the span
//! and the gap of the wall, the spring that attaches next. The level gives the length ℓ, the only
//! input of the rule of detachment, and the rule gives the largest stretch Δl_max(ℓ).
//!
//! * Whole springs, as Popov and Filippov (2012) count them: a patch of n springs has the length n
//!   Δx at all levels of its span.
//! * Edges that slide between springs: the profile is straight between neighbouring springs, and a
//!   patch ends where the profile crosses the level of the patch. A patch at the level t is in
//!   equilibrium at the indentation φ(t) = t − Δl_max(ℓ(t)). It grows while φ(t) ≤ d and recedes
//!   while φ(t) ≥ d. On one span ℓ is linear in t, so φ is convex: it falls to its lowest value and
//!   then rises. A patch rests only where φ rises.

use super::levels::{EdgeCell, Slider, Span, larger};
use super::tree::{Branch, ContactTree};
use crate::detachment::{DetachmentRule, Levels, ROUNDING};
use crate::history::Patch;
use crate::totals::ContactTotals;

/// One patch over a range of indentations in which it grows from span to span, until it jumps,
/// merges or splits.
///
/// The runs of a motion are in the order of a walk through the contact tree from its root, right
/// parts first. On each branch the larger patch comes first. So a run comes before the runs inside
/// it, and of two separate runs the right one comes first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Lower bound of the indentations of the run in m, inclusive; −∞ for a patch in contact when a
    /// loading begins.
    pub from: f64,
    /// Upper bound of the indentations of the run in m, exclusive; +∞ for a patch in contact when
    /// an unloading begins.
    pub to: f64,
    /// Height in m of pinned edges above the largest gap; NaN for edges that are free to move.
    pub pin: f64,
    /// First and last spring of the smallest span of the run.
    pub bottom: [u32; 2],
    /// First and last spring of the largest span of the run.
    pub top: [u32; 2],
    pub branch: Branch,
}

/// A patch in contact at the end of one motion, with which the next motion begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldPatch {
    pub branch: Branch,
    pub first: u32,
    pub last: u32,
    /// Height in m of the pinned edges above the largest gap of the patch; `None` if the edges are
    /// free.
    pub pin: Option<f64>,
}

/// The runs of a motion.
#[derive(Debug)]
pub struct RunList {
    pub runs: Vec<Run>,
    /// On loading the smallest indentation of full contact, on unloading the smallest indentation
    /// with contact, both in m.
    pub end: f64,
    /// Number of evaluations of the rule of Hess.
    pub evaluations: u64,
}

/// Gaps, contact tree and rule of detachment for one direction of motion, the input of all passes
/// over the tree.
///
/// With `SLIDES`, edges move between springs, and the force is curved between two events. Without
/// `SLIDES` a patch of whole springs has one length at all levels of a span, and no edge cells.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a, const SLIDES: bool, R> {
    pub gaps: &'a [f64],
    pub tree: &'a ContactTree,
    /// Rule of the direction of motion.
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

    /// Returns the height in m of pinned edges above the largest gap; `None` for free edges.
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
        // Above the lowest span of a branch the largest gap is that of the outermost spring that
        // attached last.
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

    /// Returns the smallest indentation in m at which a span attaches its wall, the next spring,
    /// whose gap is `wall` in m.
    #[inline]
    pub fn attaches_at(&self, span: &Span, wall: f64) -> f64 {
        self.attachment(&self.levels(span), wall)
    }

    /// Returns the level in m of the edges of a span at an indentation in m. `pin` is the height in
    /// m of pinned edges above the largest gap.
    #[inline]
    pub fn level(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        span.gap + self.rise(span, pin, indentation)
    }

    /// Returns the height in m of the edges above the largest gap, at an indentation in m. `pin` is
    /// the height of pinned edges.
    #[inline]
    pub fn rise(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        pin.unwrap_or_else(|| self.levels(span).rise(self.rule, indentation))
    }

    /// Returns the totals of the whole springs of a span, or with `SLIDES` of its whole cells. The
    /// span counts as one patch.
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

    /// Returns the upper end, in m, of the indentations over which a run fills a span. Beyond it
    /// the run fills the span `above`.
    #[inline]
    fn upper_end(&self, span: &Span, above: &Span) -> f64 {
        // An unloading reaches this span where the span above no longer holds its spring.
        if self.unloading {
            self.holds_to(&self.levels(above))
        } else {
            self.attaches_at(span, above.gap)
        }
    }

    /// Returns the upper end, in m, of the indentations over which a run fills one of its spans.
    #[inline]
    pub fn filled_up_to(&self, run: &Run, span: &Span) -> f64 {
        if span.ends() == run.top {
            return run.to;
        }
        self.upper_end(span, &span.grown(self.gaps))
    }

    /// Returns the level in m below which every spring beside a span certainly belongs to its
    /// patch, at an indentation in m. It holds for loading and unloading, and saves evaluations of
    /// the rule of Hess.
    #[inline]
    pub fn sure_level(&self, span: &Span, indentation: f64) -> f64 {
        let stretch = self
            .rule
            .sure_stretch(self.least_length(span.first, span.last));
        (indentation + stretch) - ROUNDING * (indentation.abs() + stretch)
    }

    /// Calls `see` with each span of a run, from the smallest on, and the range of indentations in
    /// m over which the run fills it. It stops when `see` returns true. Ranges below `low` (m) are
    /// left out, and a range around `low` begins there.
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

    /// Returns the span of a run at an indentation in m; `from` is a span that the run fills at a
    /// smaller indentation.
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

    /// Returns the span of a run at an indentation in m.
    #[inline]
    pub fn span_at(&self, run: &Run, indentation: f64) -> Span {
        self.filled(run, self.bottom(run), indentation)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    /// Returns the length of a patch on this span as a function of its level.
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

    /// Returns a lower bound in cells of the length of a span at its highest level.
    #[inline]
    pub fn least_length(&self, first: usize, last: usize) -> f64 {
        // One of two edge cells is full at the highest level.
        (last + usize::from(!SLIDES) - first).max(1) as f64
    }

    /// Returns the smallest indentation in m at which a span with these levels attaches its wall,
    /// whose gap is `wall` in m.
    #[inline]
    pub fn attachment(&self, levels: &Levels, wall: f64) -> f64 {
        let length = if SLIDES {
            levels.length_at(wall - levels.gap)
        } else {
            levels.length
        };
        wall - self.rule.largest_stretch(length)
    }

    /// Returns the smallest indentation in m at which a span with these levels still holds its most
    /// stretched spring. It is at most the largest gap of the span.
    #[inline]
    pub fn holds_to(&self, levels: &Levels) -> f64 {
        let gap = levels.gap;
        let rule = self.rule;
        if !SLIDES {
            // At this indentation the spring is stretched by just Δl_max and detaches, so the
            // smallest that still holds it is the next number above; but a spring whose gap is
            // closed stays under any rule.
            let detaches = gap - rule.largest_stretch(levels.length);
            return detaches.next_up().min(gap);
        }
        // φ is smallest at the turning length.
        let excess = rule.turning_length(levels.growth) - levels.length;
        // The choices are of values: the processor would often mispredict branches.
        let lowest = excess / levels.growth;
        let most = levels.top - gap;
        let limited = if lowest < most { lowest } else { most };
        let rise = if excess > 0.0 { limited } else { 0.0 };
        let holds = (gap + rise) - rule.largest_stretch(levels.length_at(rise));
        if holds < gap { holds } else { gap }
    }

    /// Returns true if the edges pass without a jump from a span to the span extended by its wall.
    #[inline]
    pub fn slides_on(&self, lower: &Levels, upper: &Levels) -> bool {
        if !SLIDES {
            return true;
        }
        // φ rises from the lowest level of the upper span on, and that span adds no level cell.
        let reached = lower.length_at(lower.top - lower.gap);
        self.rule.turning_length(upper.growth) < upper.length && upper.length - reached < 0.25
    }

    /// Computes ∫ (c − θ)² dx in cells times m² over the part of the profile that the edges pass
    /// from one state of a run to a larger one. Here θ is the indentation at which an edge passes
    /// the point, so c − θ is the largest stretch there.
    pub fn passed_squares(&self, lower: &SpanAtLevel, upper: &SpanAtLevel) -> f64 {
        if !SLIDES {
            let fewer = lower.span.springs() as f64;
            let more = upper.span.springs() as f64;
            // Springs attach one by one to patches of `fewer` springs and more, and detach from
            // those of `more` and fewer.
            return if self.unloading {
                self.rule.squares_of_patches(fewer + 1.0, more)
            } else {
                self.rule.squares_of_patches(fewer, more - 1.0)
            };
        }
        // Whole cells and shares are subtracted separately: as lengths they would lose digits.
        let fewer_cells = lower.whole_cells();
        let more_cells = upper.whole_cells();
        let smaller_share = lower.share_of_edges(self.gaps);
        let larger_share = upper.share_of_edges(self.gaps);
        let difference = (more_cells - fewer_cells) + (larger_share - smaller_share);
        let sum = (fewer_cells + more_cells) + (smaller_share + larger_share);
        self.rule.squares_between(difference, sum)
    }
}

/// Springs that a patch holds, and the gap in m at which its edges lie.
#[derive(Clone, Copy, Debug)]
pub struct SpanAtLevel {
    pub span: Span,
    pub level: f64,
}

impl SpanAtLevel {
    /// Returns the number of cells between the springs of the span.
    fn whole_cells(&self) -> f64 {
        (self.span.last - self.span.first) as f64
    }

    /// Returns the length in contact of both edge cells, in cells.
    fn share_of_edges(&self, gaps: &[f64]) -> f64 {
        let [left, right] = EdgeCell::of_span(gaps, &self.span, self.level);
        left.share + right.share
    }
}
