//! Whole springs, as the paper counts them: a fragment of n springs is n Δx long.

use super::edge_model::EdgeModel;
use super::levels::Levels;
use super::span::Span;
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// The paper's rule for edges.
#[derive(Clone, Copy, Debug)]
pub struct GridEdges {
    hess: HessRule,
}

impl GridEdges {
    /// Whole springs under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        GridEdges { hess }
    }
}

impl EdgeModel for GridEdges {
    const EDGES: Edges = Edges::Grid;
    const SLIDES: bool = false;

    #[inline]
    fn rule(&self) -> HessRule {
        self.hess
    }

    #[inline]
    fn on(&self, direction: Direction) -> Self {
        GridEdges::new(self.hess.on(direction))
    }

    #[inline]
    fn levels(&self, _: &[f64], span: &Span) -> Levels {
        let length = f64::from(span.springs() as u32);
        Levels { gap: span.gap, length, growth: 0.0, top: f64::INFINITY }
    }

    #[inline]
    fn least_length(&self, first: usize, last: usize) -> f64 {
        (last + 1 - first) as f64
    }

    #[inline]
    fn holds_to(&self, levels: &Levels) -> f64 {
        // At this indentation the spring is stretched by just Δl_max and detaches, so the smallest that still holds it
        // is the next number above; but a spring whose gap is closed stays under any rule.
        (levels.gap - self.stretch() * levels.length.sqrt()).next_up().min(levels.gap)
    }

    fn squared_stretch_sliding(&self, _: &[f64], between: [(Span, f64); 2], unloading: bool) -> f64 {
        let [fewer, more] = between.map(|(span, _)| span.springs() as f64);
        // Springs attach one by one to patches of `fewer` springs and more, and detach from those of `more` and fewer.
        let sign = if unloading { 1.0 } else { -1.0 };
        0.5 * self.stretch() * self.stretch() * (more - fewer) * (more + fewer + sign)
    }
}
