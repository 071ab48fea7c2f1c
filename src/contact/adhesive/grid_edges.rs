//! Whole springs, as the paper counts them: a fragment of n springs is n Δx long.

use super::dissipation::squares;
use super::edge_model::{AtOnce, EdgeModel};
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

    fn squared_stretch(&self, gaps: &[f64], stretch: &AtOnce) -> f64 {
        3.0 * squares(&gaps[stretch.springs()], |gap| (gap - stretch.at) * (gap - stretch.at))
    }

    fn squared_stretch_sliding(&self, _: &[f64], _: [(Span, f64); 2]) -> f64 {
        0.0
    }
}
