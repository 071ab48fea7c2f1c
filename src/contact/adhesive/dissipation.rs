//! Energy of the parts of the line that attach or detach under a stretch, as a stream along the line.
//!
//! When a fragment forms or parts at an indentation θ, everything between its edges but the fragments inside attaches
//! (detaches) at once. In the order of the runs the fragments inside another one follow it from right to left, so one
//! pass with a stack meets each place of the line once for each event there.

use super::edge_model::{AtOnce, Boundary, Edge, EdgeModel};
use super::run::{Ground, Run};
use super::span::Span;
use crate::contact::grid::CompensatedSum;

/// Terms summed side by side, and terms before a sum is compensated.
const LANES: usize = 8;
const LONG: usize = 256;

/// A fragment whose parts may still follow.
struct Open {
    /// Number of its run.
    run: usize,
    at: f64,
    left: Edge,
    right: Edge,
    /// Left edge of the part met last.
    met: Option<Edge>,
    /// True for a fragment that forms on the range.
    counts: bool,
}

/// Part of a leg.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Indentations above this, m.
    pub low: f64,
    /// Up to and including this, m.
    pub high: f64,
    /// True if the leg unloads.
    pub unloading: bool,
}

impl<E: EdgeModel> Ground<'_, E> {
    /// ∫ (c − θ)² dx over the parts of the line that attach or detach on a range of a leg, in cells times m².
    pub fn squared_stretch(&self, runs: &[Run], range: Range) -> f64 {
        let (mut thirds, mut sliding) = (CompensatedSum::default(), CompensatedSum::default());
        let slide = |ends| sliding.add(self.edges.squared_stretch_sliding(self.gaps, ends));
        self.each_change(runs, range, slide, |stretch| {
            thirds.add(self.edges.squared_stretch(self.gaps, &stretch));
        });
        sliding.add(thirds.total() / 3.0);
        if !E::SLIDES {
            self.each_spring_of_chains(runs, range.unloading, |spring, at| {
                if at > range.low && at <= range.high {
                    let stretch = self.gaps[spring] - at;
                    sliding.add(stretch * stretch);
                }
            });
        }
        sliding.total()
    }

    /// Calls `see` with each spring that attaches (or detaches) while a run passes from span to span, and its
    /// indentation, m.
    pub fn each_spring_of_chains(&self, runs: &[Run], unloading: bool, mut see: impl FnMut(usize, f64)) {
        for run in runs {
            let mut below: Option<Span> = None;
            self.each_span(run, unloading, f64::NEG_INFINITY, |span, from, _| {
                if let Some(below) = below.replace(*span) {
                    see(if span.last > below.last { span.last } else { span.first }, from);
                }
                false
            });
        }
    }

    /// The smallest and the largest span of a run on a range, with their levels, m.
    pub fn ends_of(&self, run: &Run, range: Range) -> [(Span, f64); 2] {
        let Range { low, high, unloading } = range;
        let top = if run.to > high { self.span_at(run, unloading, high) } else { self.top(run) };
        let bottom = if run.from < low { self.span_at(run, unloading, low) } else { self.bottom(run) };
        self.levels_of(run, bottom, top, range)
    }

    /// Levels of these spans of a run at the ends of a range, m.
    pub fn levels_of(&self, run: &Run, bottom: Span, top: Span, range: Range) -> [(Span, f64); 2] {
        let lower = self.level(&bottom, run.pin(), run.from.max(range.low));
        let upper = self.level_up_to(&top, run.pin(), run.to.min(range.high), range.unloading);
        [(bottom, lower), (top, upper)]
    }

    /// Calls `slide` with the spans and levels between which each run slides on a range, and `jump` with each stretch
    /// of the line that attaches or detaches there at once.
    pub fn each_change(
        &self,
        runs: &[Run],
        range: Range,
        mut slide: impl FnMut([(Span, f64); 2]),
        mut jump: impl FnMut(AtOnce),
    ) {
        let Range { low, high, .. } = range;
        let mut nesting = Nesting::default();
        let mut jump = |_, at_once| jump(at_once);
        for (index, run) in runs.iter().enumerate().filter(|(_, run)| run.from <= high && run.to > low) {
            let [(bottom, lower), (top, upper)] = self.ends_of(run, range);
            slide([(bottom, lower), (top, upper)]);
            nesting.meet(top.ends(), || upper, &mut jump);
            // A range contains its upper end only.
            let counts = run.from > low || low == f64::NEG_INFINITY;
            nesting.enter((index, run.from), bottom.ends(), lower, counts);
        }
        nesting.close(&mut jump);
    }

    /// Calls `jump` with each stretch of the line that detaches at once with a `wanted` run of these parts, and the
    /// number of this run; `wanted` is called once for each run, in their order; the unloading began at `high`, m.
    pub fn each_jump(
        &self,
        runs: &[Run],
        high: f64,
        mut wanted: impl FnMut(usize) -> bool,
        mut jump: impl FnMut(usize, AtOnce),
    ) {
        let mut nesting = Nesting::default();
        for (index, run) in runs.iter().enumerate() {
            let upper = || self.level_up_to(&self.top(run), None, run.to.min(high), true);
            nesting.meet(run.top_ends(), upper, &mut jump);
            let counts = wanted(index);
            let level = if counts { self.level(&self.bottom(run), None, run.from) } else { f64::NAN };
            nesting.enter((index, run.from), run.bottom, level, counts);
        }
        nesting.close(&mut jump);
    }

    /// The smallest indentation at which each spring is in contact on a leg, m, along the line: −∞ always, +∞ never.
    pub fn thresholds(&self, runs: &[Run], unloading: bool, out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.gaps.len(), f64::INFINITY);
        let range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, unloading };
        self.each_change(runs, range, |_| {}, |stretch| out[stretch.springs()].fill(stretch.at));
        self.each_spring_of_chains(runs, unloading, |spring, at| out[spring] = at);
    }

    /// Level of the edges of a span at the upper end of its run or below, m.
    pub fn level_up_to(&self, span: &Span, pin: Option<f64>, indentation: f64, unloading: bool) -> f64 {
        if let Some(rise) = pin {
            return span.gap + rise;
        }
        match span.wall(self.gaps).map(|wall| self.gaps[wall]) {
            // At the attachment of the wall the level is that of the wall, also after rounding.
            Some(wall) if !unloading && indentation >= self.attaches_at(span, wall) => wall,
            Some(_) => self.level(span, None, indentation),
            None => span.gap,
        }
    }
}

/// The fragments around a place of the line, in the order of the runs.
#[derive(Default)]
struct Nesting {
    open: Vec<Open>,
}

impl Nesting {
    /// Meets a run with these first and last springs at its largest span, and the level of its edges there.
    #[inline]
    fn meet(&mut self, top: [u32; 2], upper: impl FnOnce() -> f64, jump: &mut impl FnMut(usize, AtOnce)) {
        let [first, last] = top.map(|spring| spring as usize);
        while let Some(done) = self.open.pop_if(|open| open.left.spring > last) {
            done.close(jump);
        }
        if let Some(around) = self.open.last_mut() {
            let level = if around.counts { upper() } else { f64::NAN };
            around.meet(Edge { spring: first, level }, Edge { spring: last, level }, jump);
        }
    }

    /// Enters the run met last, of this number and indentation at which it parts (m), at its smallest span and the
    /// level of its edges there.
    #[inline]
    fn enter(&mut self, (run, at): (usize, f64), bottom: [u32; 2], level: f64, counts: bool) {
        let [left, right] = bottom.map(|spring| Edge { spring: spring as usize, level });
        self.open.push(Open { run, at, left, right, met: None, counts });
    }

    /// Leaves all runs.
    fn close(mut self, jump: &mut impl FnMut(usize, AtOnce)) {
        while let Some(done) = self.open.pop() {
            done.close(jump);
        }
    }
}

impl Open {
    /// Meets the next of its parts to the left.
    fn meet(&mut self, left: Edge, right: Edge, jump: &mut impl FnMut(usize, AtOnce)) {
        let to = self.met.replace(left).map_or(Boundary::Outer(self.right), Boundary::Part);
        if self.counts {
            jump(self.run, AtOnce { at: self.at, between: (Boundary::Part(right), to) });
        }
    }

    /// Has met all its parts.
    fn close(self, jump: &mut impl FnMut(usize, AtOnce)) {
        let to = self.met.map_or(Boundary::Outer(self.right), Boundary::Part);
        if self.counts {
            jump(self.run, AtOnce { at: self.at, between: (Boundary::Outer(self.left), to) });
        }
    }
}

/// Σ of a function of each gap.
pub fn squares(gaps: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let mut total = CompensatedSum::default();
    for block in gaps.chunks(LONG) {
        let (eights, rest) = block.as_chunks::<LANES>();
        let mut sums = [0.0; LANES];
        for eight in eights {
            for (sum, &gap) in sums.iter_mut().zip(eight) {
                *sum += of(gap);
            }
        }
        total.add(sum_of(sums) + rest.iter().map(|&gap| of(gap)).sum::<f64>());
    }
    total.total()
}

/// Three times ∫ (c − θ)² dx over the cells between neighbours of these gaps.
pub fn squares_of_cells(gaps: &[f64], at: f64) -> f64 {
    let of = |left: f64, right: f64| {
        let (a, b) = (left - at, right - at);
        (a + b) * a + b * b
    };
    let mut total = CompensatedSum::default();
    let mut rest = gaps;
    while let Some(block) = rest.first_chunk::<{ LONG + 1 }>() {
        let mut sums = [0.0; LANES];
        for start in (0..LONG).step_by(LANES) {
            for (lane, sum) in sums.iter_mut().enumerate() {
                *sum += of(block[start + lane], block[start + lane + 1]);
            }
        }
        total.add(sum_of(sums));
        rest = &rest[LONG..];
    }
    total.add(rest.windows(2).map(|cell| of(cell[0], cell[1])).sum());
    total.total()
}

fn sum_of([a, b, c, d, e, f, g, h]: [f64; LANES]) -> f64 {
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}
