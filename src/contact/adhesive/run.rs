//! Spans, neighbouring springs that one fragment holds, and runs: the fragments of a leg, each over the range of
//! indentations in which its edges move without a jump.

use super::levels::Slider;
use super::tree::{Branch, ContactTree};
use crate::contact::ContactTotals;

/// Margin of bounds for rounding.
const ROUNDING: f64 = 1e-12;

/// One fragment over the range of indentations up to its next jump, merging or parting: on the way from its bottom to
/// its top each span passes into the next.
///
/// The runs of a leg are in the order of a walk through the tree from its root, right parts first, and on each branch
/// the larger ones first: a run comes before those inside it, and of two others the right one comes first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Lower bound (inclusive) of its indentations, m; −∞ for a fragment in contact when a loading leg begins.
    pub from: f64,
    /// Upper bound (exclusive), m; +∞ for a fragment in contact when an unloading leg begins.
    pub to: f64,
    /// Height of the level of pinned edges above the largest gap, m; NaN for edges that are free to move.
    pin: f64,
    /// First and last spring of its smallest span.
    pub bottom: [u32; 2],
    /// First and last spring of its largest span.
    pub top: [u32; 2],
    pub branch: Branch,
}

/// A fragment in contact between two legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    pub branch: Branch,
    pub first: u32,
    pub last: u32,
    /// Height of the level of pinned edges above its largest gap, m.
    pub pin: Option<f64>,
}

#[derive(Debug)]
pub struct Listed {
    pub runs: Vec<Run>,
    /// Smallest indentation of full contact of a loading, or of contact of an unloading, m.
    pub end: f64,
    pub evaluations: u64,
}

/// Gaps and contact tree under the rule of one direction: the input of all passes of a leg.
///
/// Edges that `SLIDES` between springs curve the force between two events. Whole springs have one length at all levels of a
/// span, and no edge cells.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a, const SLIDES: bool> {
    pub gaps: &'a [f64],
    pub tree: &'a ContactTree,
    /// Largest stretch of a fragment of unit length, m.
    pub stretch: f64,
    pub unloading: bool,
}

impl Run {
    pub fn new(branch: Branch, span: &Span, from: f64, to: f64) -> Self {
        Run { from, to, pin: f64::NAN, bottom: span.ends(), top: span.ends(), branch }
    }

    /// A run over one span with its edges pinned at a rise above its largest gap, m.
    pub fn pinned(branch: Branch, span: &Span, rise: f64, from: f64, to: f64) -> Self {
        Run { pin: rise, ..Run::new(branch, span, from, to) }
    }

    /// Rise of pinned edges, m.
    #[inline]
    pub fn pin(&self) -> Option<f64> {
        Some(self.pin).filter(|pin| !pin.is_nan())
    }

    /// Extends the run upwards, to the next larger span.
    pub fn raise(&mut self, span: &Span, to: f64) {
        (self.to, self.top) = (to, span.ends());
    }

    /// Extends the run downwards, to the next smaller span.
    pub fn lower(&mut self, span: &Span, from: f64) {
        (self.from, self.bottom) = (from, span.ends());
    }

    #[inline]
    pub fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}

impl<const SLIDES: bool> Ground<'_, SLIDES> {
    #[inline]
    pub fn span(&self, branch: Branch, [first, last]: [u32; 2]) -> Span {
        let (first, last) = (first as usize, last as usize);
        let ends = larger(self.gaps[first], self.gaps[last]);
        // Above the lowest span of a branch the largest gap is that of the outermost spring that attached last.
        let gap = branch.origin().map_or(ends, |node| larger(ends, self.tree.nodes[node].gap));
        Span { gap, first, last }
    }

    #[inline]
    pub fn bottom(&self, run: &Run) -> Span {
        self.span(run.branch, run.bottom)
    }

    #[inline]
    pub fn slider(&self, run: &Run, span: &Span) -> Slider {
        Slider::new(self.gaps, span, self.stretch, run.pin())
    }

    /// Smallest indentation at which a span attaches its wall of this gap, m.
    #[inline]
    pub fn attaches_at(&self, span: &Span, wall: f64) -> f64 {
        self.attachment(&self.levels(span), wall)
    }

    /// Level of the edges of a span at an indentation, m, pinned at a rise, m, if there is one.
    #[inline]
    pub fn level(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        span.gap + self.rise(span, pin, indentation)
    }

    /// Height of the level of the edges above the largest gap, m, pinned or not.
    #[inline]
    pub fn rise(&self, span: &Span, pin: Option<f64>, indentation: f64) -> f64 {
        pin.unwrap_or_else(|| self.levels(span).rise(self.stretch, indentation))
    }

    /// Whole springs or cells of a span, and the fragment they form.
    #[inline]
    pub fn totals(&self, span: &Span) -> ContactTotals {
        let end = span.last + usize::from(!SLIDES);
        let [high, high_squares] = self.tree.sums_before(self.gaps, end);
        let [low, low_squares] = self.tree.sums_before(self.gaps, span.first);
        let (quanta, squares) = (high - low, high_squares - low_squares);
        ContactTotals { springs: span.springs() as i64, fragments: 1, quanta, squares }
    }

    /// Upper end of the indentations over which a run fills a span, m: where the span `above` takes its place.
    #[inline]
    fn upper_end(&self, span: &Span, above: &Span) -> f64 {
        // Unloading, the span above parts where this one would go on.
        if self.unloading { self.holds_to(&self.levels(above)) } else { self.attaches_at(span, above.gap) }
    }

    /// Upper end of the indentations over which a run fills one of its spans, m.
    #[inline]
    pub fn filled_up_to(&self, run: &Run, span: &Span) -> f64 {
        if span.ends() == run.top {
            return run.to;
        }
        self.upper_end(span, &span.grown(self.gaps))
    }

    /// Lower bound of the gaps of springs outside a span that do not belong to its fragment at this indentation (m), on
    /// either leg: a spring with a smaller gap needs no evaluation of the rule.
    #[inline]
    pub fn sure_level(&self, span: &Span, indentation: f64) -> f64 {
        let root = (self.square() * self.least_length(span.first, span.last)).sqrt();
        (indentation + root) - ROUNDING * (indentation.abs() + root)
    }

    /// Squared stretch of a fragment of unit length, m², rounded down.
    #[inline]
    pub fn square(&self) -> f64 {
        self.stretch * self.stretch * (1.0 - ROUNDING)
    }

    /// Calls `see` with each span of a run from the smallest one on and the range of indentations (m) over which the
    /// run fills it, until `see` returns true. Ranges that end at `low` (m) or below are left out; the first of the others
    /// then begins at `low`.
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
            (span, from) = (span.grown(self.gaps), to);
        }
    }

    /// The span of a run at an indentation, from one that it fills at a smaller indentation on.
    pub fn filled(&self, run: &Run, from: Span, indentation: f64) -> Span {
        let (mut span, top) = (from, run.top);
        while span.ends() != top {
            let sure = span.up_to(self.gaps, self.sure_level(&span, indentation), top);
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

    /// The span of a run at an indentation, m.
    #[inline]
    pub fn span_at(&self, run: &Run, indentation: f64) -> Span {
        self.filled(run, self.bottom(run), indentation)
    }
}

/// Springs `first..=last` of one fragment and their largest gap, m.
///
/// Every fragment in equilibrium under any loading history is a span all of whose neighbours have larger gaps: a
/// subtree of the max-Cartesian tree of the gaps, where of equal gaps the leftmost is nearest the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub gap: f64,
    pub first: usize,
    pub last: usize,
}

impl Span {
    /// The largest span of its branch within these first and last springs whose walls lie above a level, m; itself if its
    /// walls do already.
    #[inline]
    pub fn up_to(&self, gaps: &[f64], level: f64, [lowest, highest]: [u32; 2]) -> Self {
        let Span { gap, mut first, mut last } = *self;
        while first > lowest as usize && gaps[first - 1] < level {
            first -= 1;
        }
        while last < highest as usize && gaps[last + 1] <= level {
            last += 1;
        }
        Span { gap: larger(gap, larger(gaps[first], gaps[last])), first, last }
    }

    /// The spring that attaches next, the lower one beside the span; `None` where it fills the line.
    #[inline]
    pub fn wall(&self, gaps: &[f64]) -> Option<usize> {
        match (self.first.checked_sub(1), gaps.get(self.last + 1)) {
            (Some(left), Some(&right)) => Some(if right <= gaps[left] { self.last + 1 } else { left }),
            (Some(left), None) => Some(left),
            (None, Some(_)) => Some(self.last + 1),
            (None, None) => None,
        }
    }

    /// The span extended by the spring beside it that attaches next.
    #[inline]
    pub fn with(&self, gaps: &[f64], wall: usize) -> Self {
        let gap = gaps[wall];
        if wall > self.last { Span { gap, last: wall, ..*self } } else { Span { gap, first: wall, ..*self } }
    }

    /// The next larger span, if there is one.
    #[inline]
    pub fn grown(&self, gaps: &[f64]) -> Self {
        self.wall(gaps).map_or(*self, |wall| self.with(gaps, wall))
    }

    #[inline]
    pub fn springs(&self) -> usize {
        self.last + 1 - self.first
    }

    #[inline]
    pub fn ends(&self) -> [u32; 2] {
        [self.first as u32, self.last as u32]
    }
}

/// The smaller of two numbers, neither of which is NaN: `f64::min` would check for NaN.
#[inline]
pub fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger of two numbers, neither of which is NaN.
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
