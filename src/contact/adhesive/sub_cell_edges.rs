//! Sub-cell edges: the line is straight between neighbouring springs, and a fragment ends at the crossing of the line
//! with the level of the fragment. The error falls with the square of the distance between springs.

use super::dissipation::squares_of_cells;
use super::edge_model::{AtOnce, Boundary, EdgeModel};
use super::levels::Levels;
use super::span::Span;
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// Sub-cell edges under a rule of Hess.
///
/// A fragment at level t is in equilibrium with the indentation φ(t) = t − Δl_max(ℓ(t)): it grows while φ(t) ≤ d and
/// recedes while φ(t) ≥ d. Between the gap of its largest spring and that of its wall ℓ is linear in t, so φ is convex:
/// φ falls to its lowest value and then rises, and a fragment rests only where φ rises.
#[derive(Clone, Copy, Debug)]
pub struct SubCellEdges {
    hess: HessRule,
}

impl SubCellEdges {
    /// Edges under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        SubCellEdges { hess }
    }
}

impl EdgeModel for SubCellEdges {
    const EDGES: Edges = Edges::SubCell;
    const SLIDES: bool = true;

    #[inline]
    fn rule(&self) -> HessRule {
        self.hess
    }

    #[inline]
    fn on(&self, direction: Direction) -> Self {
        Self::new(self.hess.on(direction))
    }

    #[inline]
    fn levels(&self, gaps: &[f64], span: &Span) -> Levels {
        Levels::between_springs(gaps, span).0
    }

    #[inline]
    fn least_length(&self, first: usize, last: usize) -> f64 {
        // One of the two edge cells is full at the highest level.
        (last - first).max(1) as f64
    }

    #[inline]
    fn holds_to(&self, levels: &Levels) -> f64 {
        let (gap, stretch) = (levels.gap, self.stretch());
        // At the smallest φ √ℓ is half of stretch × growth.
        let root = 0.5 * stretch * levels.growth;
        let excess = root * root - levels.length;
        // Without branches: they would often be mispredicted.
        let rise = excess / levels.growth;
        let most = levels.top - gap;
        let rise = if rise < most { rise } else { most };
        let rise = if excess > 0.0 { rise } else { 0.0 };
        let holds = (gap + rise) - stretch * levels.length_at(rise).sqrt();
        if holds < gap { holds } else { gap }
    }

    fn squared_stretch(&self, gaps: &[f64], &AtOnce { at, between }: &AtOnce) -> f64 {
        match between {
            (Boundary::Outer(outer), Boundary::Part(part)) if outer.spring == part.spring => outer
                .spring
                .checked_sub(1)
                .map_or(0.0, |cell| part_of_cell(gaps, cell, (part.level, outer.level), at)),
            (Boundary::Part(part), Boundary::Outer(outer)) if outer.spring == part.spring => {
                if outer.spring + 1 < gaps.len() {
                    part_of_cell(gaps, outer.spring, (part.level, outer.level), at)
                } else {
                    0.0
                }
            }
            (from, to) => {
                let (first, before) = match from {
                    Boundary::Outer(edge) => {
                        let cell = edge.spring.checked_sub(1);
                        (edge.spring, outer_cell(gaps, cell, (edge.spring, edge.level), at))
                    }
                    Boundary::Part(edge) => {
                        let next = edge.spring + 1;
                        (next, part_of_cell(gaps, edge.spring, (edge.level, gaps[next]), at))
                    }
                };
                let (last, after) = match to {
                    Boundary::Outer(edge) => {
                        let cell = Some(edge.spring).filter(|cell| cell + 1 < gaps.len());
                        (edge.spring, outer_cell(gaps, cell, (edge.spring, edge.level), at))
                    }
                    Boundary::Part(edge) => {
                        let next = edge.spring - 1;
                        (next, part_of_cell(gaps, next, (edge.level, gaps[next]), at))
                    }
                };
                before + squares_of_cells(&gaps[first..=last.max(first)], at) + after
            }
        }
    }

    fn squared_stretch_sliding(&self, gaps: &[f64], [lower, upper]: [(Span, f64); 2]) -> f64 {
        // Twice the stretch of an edge times the change of the length, as the stretch is s √ℓ.
        let ([cells0, share0], [cells1, share1]) = (length_at(gaps, &lower), length_at(gaps, &upper));
        // Whole cells and shares are subtracted separately: as lengths they would lose digits.
        let grown = (cells1 - cells0) + (share1 - share0);
        let both = (cells0 + cells1) + (share0 + share1);
        0.5 * self.stretch() * self.stretch() * grown * both
    }
}

/// Whole cells of a span at a level, and the shares of its edge cells.
fn length_at(gaps: &[f64], (span, level): &(Span, f64)) -> [f64; 2] {
    let share = |inside: usize, outside: Option<&f64>| {
        outside.map_or(0.5, |outside| {
            let (above, height) = (level - gaps[inside], outside - gaps[inside]);
            if above < height { above / height } else { 1.0 }
        })
    };
    let left = share(span.first, span.first.checked_sub(1).map(|before| &gaps[before]));
    [(span.last - span.first) as f64, left + share(span.last, gaps.get(span.last + 1))]
}

/// Three times ∫ (c − θ)² dx over the part of a cell in which the line lies between two levels.
fn part_of_cell(gaps: &[f64], cell: usize, (from, to): (f64, f64), at: f64) -> f64 {
    let growth = (gaps[cell + 1] - gaps[cell]).abs().recip();
    // A level cell belongs to the fragment that holds the spring at its right end.
    let growth = if growth < f64::INFINITY { growth } else { 0.0 };
    let (a, b) = (from - at, to - at);
    growth * (from - to).abs() * (a * a + a * b + b * b)
}

/// Three times ∫ (c − θ)² dx over the cell beyond the outermost spring of a fragment, up to its level; `None`: half a
/// cell as level as the spring, at the end of the foundation.
fn outer_cell(gaps: &[f64], cell: Option<usize>, (spring, level): (usize, f64), at: f64) -> f64 {
    let stretch = gaps[spring] - at;
    match cell {
        None => 1.5 * stretch * stretch,
        // A level cell attaches whole, with the spring.
        Some(cell) if gaps[cell] == gaps[cell + 1] => 3.0 * stretch * stretch,
        Some(cell) => part_of_cell(gaps, cell, (gaps[spring], level), at),
    }
}
