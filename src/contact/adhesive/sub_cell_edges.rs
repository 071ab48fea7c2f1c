//! Sub-cell edges: the line is straight between neighbouring springs, and a fragment ends at the crossing of the line
//! with the level of the fragment. The error falls with the square of the distance between springs.

use super::dissipation::squares_of_cells;
use super::edge_model::{Boundary, EdgeCells, EdgeModel};
use super::span::Span;
use crate::contact::contact_model::ContactState;
use crate::contact::totals::{ContactTotals, GapScale};
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// Sub-cell edges under a rule of Hess.
///
/// A fragment at level t is in equilibrium with the indentation φ(t) = t − Δl_max(ℓ(t)): it grows while φ(t) ≤ d and
/// recedes while φ(t) ≥ d. Between the gap of its largest spring and that of its wall ℓ is linear in t, so φ is
/// convex: it falls to its lowest value and then rises, and only where it rises does a fragment rest.
#[derive(Clone, Copy, Debug)]
pub struct SubCellEdges {
    hess: HessRule,
    /// Largest stretch of a fragment of one cell, m.
    stretch: f64,
}

/// Length of a span at level t: `length + growth (t − gap)` cells, from its largest gap up to `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// At its largest gap, in cells.
    pub length: f64,
    /// Growth with the level, cells per metre.
    pub growth: f64,
    /// Gap of the wall, m; infinite where the span fills the line.
    pub top: f64,
}

/// The cell in which an edge moves: from the last spring that is held to the first that is not.
#[derive(Clone, Copy)]
struct EdgeCell {
    /// Gap of the first spring that is not held, m; infinite beyond the end of the foundation, half a cell away.
    outside: f64,
    /// Share of the cell at or below the level, which is not below the gap inside.
    share: f64,
    /// Growth of the share with the level, 1/m; zero where it does not grow, or all at once.
    growth: f64,
    /// Twice the compression of the cell at that level and indentation, m.
    carries: f64,
}

impl EdgeCell {
    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let (height, above) = (outside - inside, level - inside);
        if height == f64::INFINITY {
            // Half a cell as level as the spring it belongs to.
            return EdgeCell { outside, share: 0.5, growth: 0.0, carries: above };
        }
        let growth = height.recip();
        let growth = if growth < f64::INFINITY { growth } else { 0.0 };
        let share = if growth > 0.0 { above * growth } else { above / height };
        // 0/0 where the cell is level: then it lies there whole.
        let share = if above < height { share } else { 1.0 };
        EdgeCell { outside, share, growth, carries: above * share }
    }
}

/// Levels of a span and the compression of its edge cells at the level and the indentation of its largest gap: ∫ (c − c(x)) dx
/// over them, in cells times metres.
#[inline]
fn levels_between(gaps: &[f64], span: &Span) -> (Levels, f64) {
    let (first, last) = (span.first, span.last);
    let before = if first > 0 { gaps[first - 1] } else { f64::INFINITY };
    let after = gaps.get(last + 1).copied().unwrap_or(f64::INFINITY);
    let [left, right] =
        [EdgeCell::new(gaps[first], before, span.gap), EdgeCell::new(gaps[last], after, span.gap)];
    let levels = Levels {
        length: (last - first) as f64 + (left.share + right.share),
        growth: left.growth + right.growth,
        top: left.outside.min(right.outside),
    };
    (levels, 0.5 * (left.carries + right.carries))
}

impl SubCellEdges {
    /// Edges under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        SubCellEdges { hess, stretch: hess.largest_stretch(1) }
    }

    /// Edges of fragments, one of one cell of which can be stretched by so much, m.
    pub(in crate::contact) fn with_stretch(stretch: f64) -> Self {
        Self::new(HessRule::with_stretch(stretch))
    }
}

/// The edge cells of a span as they slide with the indentation.
///
/// With y = √ℓ the level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic in y.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    gap: f64,
    levels: Levels,
    /// Whole cells between its springs.
    cells: f64,
    /// Part of its edge cells in contact at its lowest level, in cells.
    edges: f64,
    /// Compression of the edge cells there at the indentation of the gap of the span.
    compression: f64,
    stretch: f64,
    /// ½ stretch × growth.
    half: f64,
    /// half² + length.
    square: f64,
}

impl Slider {
    /// √ℓ at an indentation so far above the gap.
    #[inline]
    fn root(&self, above: f64) -> f64 {
        let square = self.square + self.levels.growth * above;
        // A square that is not a number comes of growth without bound, and then nothing but `half` counts.
        self.half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }

    /// Height of the level above the gap.
    #[inline]
    fn rise(&self, above: f64) -> f64 {
        let rise = above + self.stretch * self.root(above);
        let most = self.levels.top - self.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }
}

impl EdgeModel for SubCellEdges {
    type Length = Levels;
    type Slider = Slider;

    const EDGES: Edges = Edges::SubCell;
    const SLIDES: bool = true;

    #[inline]
    fn on(&self, direction: Direction) -> Self {
        Self::new(self.hess.on(direction))
    }

    #[inline]
    fn are_pinned(&self) -> bool {
        !self.hess.is_one()
    }

    fn stretch(&self) -> f64 {
        self.stretch
    }

    #[inline]
    fn length(&self, gaps: &[f64], span: &Span) -> Levels {
        levels_between(gaps, span).0
    }

    #[inline]
    fn least_length(&self, first: usize, last: usize) -> f64 {
        // One of the two edge cells is full at the highest level.
        (last - first).max(1) as f64
    }

    #[inline]
    fn attaches_at(&self, span: &Span, levels: Levels, wall: f64) -> f64 {
        wall - self.stretch * (levels.length + levels.growth * (wall - span.gap)).sqrt()
    }

    #[inline]
    fn holds_to(&self, span: &Span, levels: Levels) -> f64 {
        let gap = span.gap;
        // At the smallest φ √ℓ is half of the stretch that a unit of growth gives.
        let root = 0.5 * self.stretch * levels.growth;
        let excess = root * root - levels.length;
        // Without branches: they would often be mispredicted.
        let rise = excess / levels.growth;
        let most = levels.top - gap;
        let rise = if rise < most { rise } else { most };
        let rise = if excess > 0.0 { rise } else { 0.0 };
        let holds = (gap + rise) - self.stretch * (levels.length + levels.growth * rise).sqrt();
        if holds < gap { holds } else { gap }
    }

    #[inline]
    fn rise(&self, span: &Span, levels: Levels, indentation: f64) -> f64 {
        if levels.growth <= 0.0 {
            return 0.0;
        }
        let half = 0.5 * self.stretch * levels.growth;
        let above = indentation - span.gap;
        let square = half * half + levels.length + levels.growth * above;
        let rise = above + self.stretch * (half + if square > 0.0 { square.sqrt() } else { 0.0 });
        let most = levels.top - span.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }

    #[inline]
    fn release(&self, span: &Span, levels: Levels, rise: f64) -> (f64, bool) {
        let length = levels.length + levels.growth * rise;
        let root = 0.5 * self.stretch * levels.growth;
        // φ rises with the level where √ℓ is more than half of the stretch that a unit of growth gives.
        ((span.gap + rise) - self.stretch * length.sqrt(), root * root <= length)
    }

    #[inline]
    fn slides_on(&self, (lower, below): (&Span, Levels), (_, above): (&Span, Levels)) -> bool {
        // φ rises from the lowest level of the upper span on, and that span brings no cell that lies level.
        let root = 0.5 * self.stretch * above.growth;
        let reached = below.length + below.growth * (below.top - lower.gap);
        root * root < above.length && above.length - reached < 0.25
    }

    #[inline]
    fn slider(&self, gaps: &[f64], span: &Span) -> Slider {
        let (levels, compression) = levels_between(gaps, span);
        let half = 0.5 * self.stretch * levels.growth;
        let cells = span.springs() as f64 - 1.0;
        Slider {
            gap: span.gap,
            levels,
            cells,
            edges: levels.length - cells,
            compression,
            stretch: self.stretch,
            half,
            square: half * half + levels.length,
        }
    }

    #[inline]
    fn pin(&self, slider: Slider, rise: f64) -> Slider {
        let grown = slider.levels.growth * rise;
        let levels = Levels { growth: 0.0, ..slider.levels };
        let compression = slider.compression - 0.5 * grown * rise;
        Slider { levels, edges: slider.edges + grown, compression, ..slider }
    }

    #[inline]
    fn edge_cells(&self, slider: &Slider, indentation: f64) -> EdgeCells {
        let above = indentation - slider.gap;
        let rise = slider.rise(above);
        let grown = slider.levels.growth * rise;
        EdgeCells {
            length: slider.edges + grown,
            compression: (slider.edges * above + slider.compression) + grown * (above - 0.5 * rise),
        }
    }

    /// The length times (2y − 3k)/(2y − k) with y = √ℓ and k = stretch × growth, as the edges move with the
    /// indentation, less the whole cells. It only grows with the indentation: between events the force is convex.
    fn edge_stiffness(&self, slider: &Slider, indentation: f64) -> f64 {
        if slider.levels.growth <= 0.0 {
            return slider.edges;
        }
        let above = indentation - slider.gap;
        let length = slider.levels.length + slider.levels.growth * slider.rise(above);
        // Also at the ends of its levels its edges slide, to the one side at least.
        let (root, fall) = (slider.root(above), 2.0 * slider.half);
        let rises = 2.0 * root - fall;
        // Where it is about to detach the edges run away at once.
        if rises > 0.0 {
            length * (2.0 * root - 3.0 * fall) / rises - slider.cells
        } else {
            f64::NEG_INFINITY
        }
    }

    #[inline]
    fn state(
        &self,
        indentation: f64,
        totals: ContactTotals,
        edges: EdgeCells,
        scale: &GapScale,
    ) -> ContactState {
        ContactState {
            indentation,
            springs: totals.springs,
            fragments: totals.fragments,
            length: totals.cells() as f64 + edges.length,
            compression: totals.compression_of_cells(indentation, scale) + edges.compression,
        }
    }

    #[inline]
    fn stiffness(&self, totals: ContactTotals) -> f64 {
        totals.cells() as f64
    }

    fn indentation_of(&self, _: ContactTotals, _: f64, _: &GapScale) -> Option<f64> {
        None
    }

    fn squared_stretch(&self, gaps: &[f64], (from, to): (Boundary, Boundary), at: f64) -> f64 {
        match (from, to) {
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

    fn squared_stretch_sliding(&self, gaps: &[f64], lower: (&Span, f64), upper: (&Span, f64)) -> f64 {
        // Twice the stretch of an edge times the change of the length, as the stretch is s √ℓ.
        let ([cells0, share0], [cells1, share1]) = (length_at(gaps, lower), length_at(gaps, upper));
        // Whole cells and shares apart: as lengths they would lose digits.
        let grown = (cells1 - cells0) + (share1 - share0);
        let both = (cells0 + cells1) + (share0 + share1);
        0.5 * self.stretch * self.stretch * grown * both
    }
}

/// Whole cells of a span at a level, and the shares of those at its edges.
fn length_at(gaps: &[f64], (span, level): (&Span, f64)) -> [f64; 2] {
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

/// The same over the cell beyond the outermost spring of a fragment, up to its level; `None`: half a cell as level as
/// the spring, at the end of the foundation.
fn outer_cell(gaps: &[f64], cell: Option<usize>, (spring, level): (usize, f64), at: f64) -> f64 {
    let stretch = gaps[spring] - at;
    match cell {
        None => 1.5 * stretch * stretch,
        // Level: it attaches whole, with the spring.
        Some(cell) if gaps[cell] == gaps[cell + 1] => 3.0 * stretch * stretch,
        Some(cell) => part_of_cell(gaps, cell, (gaps[spring], level), at),
    }
}
