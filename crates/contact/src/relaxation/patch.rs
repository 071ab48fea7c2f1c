//! A patch that loses springs where its tension is largest.

use super::core::{Core, Peaks};
use super::field::{Field, Spring, Sums};
use super::line::Line;
use super::peaks::{Bound, Peak, bound_of};
use crate::detachment::{DetachmentRule, Levels};
use crate::history::Patch;

/// Relative difference below which two tensions count as equal.
const ROUNDING: f64 = 1e-12;

/// An edge of a patch. The edge lies between the outermost spring of the patch and the first spring
/// outside the patch.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Outermost spring of the patch on this side.
    pub spring: usize,
    /// Share of the cell beyond this spring that is in contact.
    pub share: f64,
    /// Gap and memory at the outer end of this cell.
    pub outer: Spring,
}

impl Edge {
    /// Returns the edge after the patch has lost its outermost spring. `next` is the next spring
    /// inwards.
    fn without_spring(&self, line: &Line, next: usize) -> Edge {
        Edge {
            spring: next,
            share: 1.0,
            outer: line.spring(self.spring),
        }
    }
}

/// A patch after the turn of the body: the positions of its edges, and integrals over its length.
#[derive(Clone, Copy, Debug)]
pub struct StretchedPatch {
    pub left: Edge,
    pub right: Edge,
    pub sums: Sums,
    /// Upper bound of the tension at all positions of the patch.
    bound: Bound,
    core: Core,
}

/// A patch that loses springs at its two edges, while the edges move inwards.
struct Receding<'a> {
    line: &'a Line,
    field: &'a Field,
    common: f64,
    left: Edge,
    right: Edge,
    peaks: Peaks<'a>,
    /// Smallest difference so far between the largest tension and the tension that the patch bears,
    /// in m.
    least_excess: f64,
    /// True if the largest tension exceeds the tension that the patch bears by more than before, so
    /// that the edges jump.
    jumps: bool,
}

/// Motion of the edges of a patch, up to the place at which the patch holds under its tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Settling {
    /// Nothing detaches.
    Holds,
    /// The edges move no further than the motion of the drive requires.
    Slides,
    /// The edges move further than the motion of the drive requires, or the patch splits or
    /// disappears.
    Jumps,
}

/// State of a patch after springs have detached at its edges.
enum Remainder {
    /// The patch bears its tension.
    Holds,
    /// The patch has lost all its springs.
    Nothing,
    /// The patch has lost a spring inside the patch, so that the patch splits. The value is the
    /// index of this spring.
    Parts(usize),
}

impl StretchedPatch {
    pub fn new(line: &Line, left: Edge, right: Edge) -> Self {
        Self::with_core(line, left, right, None)
    }

    /// Creates a patch. `known` is a core that may be used again, such as that of a larger patch.
    fn with_core(line: &Line, left: Edge, right: Edge, known: Option<Core>) -> Self {
        let core = Core::renewed(known, line, left.spring, right.spring);
        let mut bound = core.bound_with_flanks(line, left.spring, right.spring);
        let mut sums = line.sums_between(left.spring, right.spring);
        for edge in [left, right] {
            let inner = line.spring(edge.spring);
            let place = inner.between(edge.outer, edge.share);
            bound.include(bound_of(place, line.remaining));
            sums = sums.plus(Sums::of_piece(inner, place, edge.share));
        }
        StretchedPatch {
            left,
            right,
            sums,
            bound,
            core,
        }
    }

    pub fn range(&self) -> Patch {
        Patch {
            first: self.left.spring,
            last: self.right.spring,
        }
    }

    pub fn springs(&self) -> usize {
        self.right.spring + 1 - self.left.spring
    }

    /// Returns the largest tension of the patch in m. The tension of a spring is minus its force
    /// divided by the instantaneous stiffness of a spring.
    pub fn tension(&self, line: &Line, field: &Field) -> f64 {
        let mut receding = Receding::new(line, field, self.left, self.right, self.core);
        let [left, right] = receding.tensions();
        left.max(right).max(receding.peak().tension)
    }

    /// Returns the force of those springs of this patch that are in none of the patches `held`,
    /// divided by the stiffness of one spring, in m.
    pub fn lost_force(&self, held: &[StretchedPatch], field: &Field) -> f64 {
        let mut lost = self.sums;
        for patch in held {
            lost = lost.minus(patch.sums);
        }
        field.common() * lost.length - field.remaining * lost.gap
            + (1.0 - field.remaining) * field.decay * lost.memory
    }

    /// Lets springs of the patch detach until each remaining part bears its tension. The remaining
    /// parts are added to the patches `held`. Returns how the edges moved.
    pub fn settle<R: DetachmentRule>(
        &self,
        line: &Line,
        field: &Field,
        rule: R,
        held: &mut Vec<StretchedPatch>,
    ) -> Settling {
        let most = self.bound.at(field.decay) - field.common();
        if most <= rule.largest_stretch(self.sums.length) {
            held.push(*self);
            return Settling::Holds;
        }
        let mut receding = Receding::new(line, field, self.left, self.right, self.core);
        let [left, right] = receding.tensions();
        let most = left.max(right).max(receding.peak().tension);
        if most <= rule.largest_stretch(self.sums.length) {
            held.push(*self);
            return Settling::Holds;
        }
        receding.least_excess = most - rule.largest_stretch(self.sums.length);
        let mut settling = Settling::Slides;
        let mut waiting = Vec::new();
        loop {
            let remainder = receding.recede(rule);
            if receding.jumps {
                settling = Settling::Jumps;
            }
            match remainder {
                Remainder::Holds => {
                    held.push(receding.patch());
                }
                Remainder::Nothing => settling = Settling::Jumps,
                Remainder::Parts(lost) => {
                    settling = Settling::Jumps;
                    let [left, right] = receding.split(lost);
                    waiting.push(right);
                    receding = left;
                    continue;
                }
            }
            match waiting.pop() {
                Some(next) => receding = next,
                None => return settling,
            }
        }
    }
}

impl<'a> Receding<'a> {
    fn new(line: &'a Line, field: &'a Field, left: Edge, right: Edge, core: Core) -> Self {
        Receding {
            line,
            field,
            common: field.common(),
            left,
            right,
            peaks: Peaks::new(line, field, core, left.spring, right.spring),
            least_excess: f64::INFINITY,
            jumps: false,
        }
    }

    fn patch(&self) -> StretchedPatch {
        let core = Some(self.peaks.core());
        StretchedPatch::with_core(self.line, self.left, self.right, core)
    }

    fn length(&self) -> f64 {
        (self.right.spring - self.left.spring) as f64 + (self.left.share + self.right.share)
    }

    #[inline]
    fn tension_of(&self, place: Spring) -> f64 {
        self.field.own_tension(place) - self.common
    }

    /// Returns the tensions of both edges in m.
    fn tensions(&self) -> [f64; 2] {
        [self.tension_at(&self.left), self.tension_at(&self.right)]
    }

    #[inline]
    fn tension_at(&self, edge: &Edge) -> f64 {
        let inner = self.line.spring(edge.spring);
        self.tension_of(inner.between(edge.outer, edge.share))
    }

    /// Returns the growth of the tension over the cell in which the edge lies, in m for each cell.
    fn slope(&self, edge: &Edge) -> f64 {
        let inner = self.line.spring(edge.spring);
        self.field.own_tension(edge.outer) - self.field.own_tension(inner)
    }

    /// Returns the spring of the patch with the largest tension.
    fn peak(&mut self) -> Peak {
        let own = self.peaks.largest(self.left.spring, self.right.spring);
        Peak {
            tension: own.tension - self.common,
            ..own
        }
    }

    /// Moves the edges inwards until the patch bears its largest tension, or until it loses a
    /// spring inside.
    fn recede<R: DetachmentRule>(&mut self, rule: R) -> Remainder {
        loop {
            let length = self.length();
            // Whatever is more in tension than the patch now bears will be lost in any case,
            // because a shorter patch bears less.
            self.shed(rule.largest_stretch(length));
            let length = self.length();
            let tensions = self.tensions();
            let peak = self.peak();
            let top = tensions[0].max(tensions[1]);
            let excess = top.max(peak.tension) - rule.largest_stretch(length);
            if excess <= 0.0 {
                return Remainder::Holds;
            }
            let slack = ROUNDING * (top.abs() + self.common.abs());
            self.jumps |= excess > self.least_excess + slack;
            self.least_excess = self.least_excess.min(excess);
            if peak.tension >= top - slack {
                if self.left.spring == self.right.spring {
                    return Remainder::Nothing;
                }
                if peak.spring == self.left.spring {
                    self.left = self.left.without_spring(self.line, self.left.spring + 1);
                } else if peak.spring == self.right.spring {
                    self.right = self.right.without_spring(self.line, self.right.spring - 1);
                } else {
                    return Remainder::Parts(peak.spring);
                }
                continue;
            }
            if self.slide(rule, tensions, peak.tension, slack) {
                return Remainder::Holds;
            }
        }
    }

    /// Moves both edges inwards to the tension `most` in m, but keeps one spring.
    fn shed(&mut self, most: f64) {
        while self.left.spring < self.right.spring
            && self.tension_of(self.line.spring(self.left.spring)) > most
        {
            self.left = self.left.without_spring(self.line, self.left.spring + 1);
        }
        while self.left.spring < self.right.spring
            && self.tension_of(self.line.spring(self.right.spring)) > most
        {
            self.right = self.right.without_spring(self.line, self.right.spring - 1);
        }
        let inner = self.tension_of(self.line.spring(self.left.spring));
        if self.tension_at(&self.left) > most && inner <= most {
            self.left.share = self.share_at(&self.left, most);
        }
        let inner = self.tension_of(self.line.spring(self.right.spring));
        if self.tension_at(&self.right) > most && inner <= most {
            self.right.share = self.share_at(&self.right, most);
        }
    }

    /// Slides the edge with the larger tension inwards, or both edges if their tensions are equal.
    /// An edge slides down to the tension of the other edge, or to `peak` in m, the largest tension
    /// of a spring. Returns true if the patch bears its tension before that. `slack` is the
    /// difference of tensions in m that rounding can cause.
    fn slide<R: DetachmentRule>(
        &mut self,
        rule: R,
        tensions: [f64; 2],
        peak: f64,
        slack: f64,
    ) -> bool {
        let top = tensions[0].max(tensions[1]);
        let mut floor = peak;
        let mut growth = 0.0;
        let mut slides = [false; 2];
        for (side, edge) in [self.left, self.right].iter().enumerate() {
            if tensions[side] >= top - slack {
                slides[side] = true;
                growth += self.slope(edge).recip();
            } else {
                floor = floor.max(tensions[side]);
            }
        }
        let length = self.length() - growth * (top - floor);
        // The levels of the rule are here the tensions, and the indentation is zero.
        let levels = Levels {
            gap: floor,
            length,
            growth,
            top,
        };
        let level = floor + rule.free_rise(&levels, -floor);
        let bears = rule.largest_stretch(levels.length_at(level - floor).max(0.0));
        let holds = level >= floor && level <= top && level <= bears + slack;
        let reached = if holds { level } else { floor };
        if slides[0] {
            self.left.share = self.share_at(&self.left, reached);
        }
        if slides[1] {
            self.right.share = self.share_at(&self.right, reached);
        }
        holds
    }

    /// Returns the share of its cell at which an edge has the tension `tension` in m.
    fn share_at(&self, edge: &Edge, tension: f64) -> f64 {
        let inner = self.tension_of(self.line.spring(edge.spring));
        if tension <= inner {
            return 0.0;
        }
        ((tension - inner) / self.slope(edge)).clamp(0.0, edge.share)
    }

    /// Returns the two parts of the patch without the spring `lost`.
    fn split(&self, lost: usize) -> [Self; 2] {
        let outer = self.line.spring(lost);
        let end = |spring| Edge {
            spring,
            share: 1.0,
            outer,
        };
        let part = |left: Edge, right: Edge| {
            let core = Core::renewed(None, self.line, left.spring, right.spring);
            Receding::new(self.line, self.field, left, right, core)
        };
        [
            part(self.left, end(lost - 1)),
            part(end(lost + 1), self.right),
        ]
    }
}
