//! The rule of Hess read with the length between edges that lie anywhere in their cells.

use super::level_sets::{LevelSets, Levels, levels_between};
use crate::contact::grid::CompensatedSum;
use crate::contact::tally::GapScale;
use crate::contact::{EdgeRule, HessRule, SpringTree};
use std::sync::Arc;

/// Edges between grid points: a fragment at level t is in equilibrium with the indentation
/// φ(t) = t − Δl_max(ℓ(t)).
///
/// It grows while φ(t) ≤ d and recedes while φ(t) ≥ d. Between the gap of its largest spring and that of
/// its parent ℓ is linear in t, so φ is convex: it falls to its lowest value and then rises, and only
/// where it rises does a fragment rest.
#[derive(Clone, Debug)]
pub struct SubCellRule {
    sets: Arc<LevelSets>,
    /// Largest stretch of a fragment of one cell, m: Δl_max = `stretch` √ℓ.
    stretch: f64,
}

impl SubCellRule {
    /// Edges under the rule of Hess; `None`: without adhesion.
    pub fn new(sets: Arc<LevelSets>, hess: Option<HessRule>) -> Self {
        SubCellRule { sets, stretch: hess.map_or(0.0, |hess| hess.largest_stretch(1)) }
    }

    /// The level sets.
    pub fn sets(&self) -> &LevelSets {
        &self.sets
    }

    /// φ at a level of a node, m.
    #[inline]
    fn rest(&self, gap: f64, levels: Levels, level: f64) -> f64 {
        level - self.stretch * (levels.length + levels.growth * (level - gap)).sqrt()
    }

    /// φ at the highest level of a node, where its parent's spring is next, m.
    #[inline]
    fn grows_on_at(&self, gap: f64, levels: Levels) -> f64 {
        self.rest(gap, levels, levels.top)
    }

    /// The smallest φ of the levels of a node, m.
    #[inline]
    fn holds(&self, gap: f64, levels: Levels) -> f64 {
        // There √ℓ is half of the stretch that a unit of growth gives.
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

    /// How the fragment of a node slides.
    #[inline]
    pub fn slider(&self, node: usize) -> Slider {
        let tree = self.sets.tree();
        let compression = self.sets.edge_compression(node);
        Slider::new(
            tree.gap(node),
            f64::from(tree.size(node)),
            self.sets.levels(node),
            compression,
            self.stretch,
        )
    }
}

/// The fragment of a node as its edges slide with the indentation.
///
/// With y = √ℓ its level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic in y.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    gap: f64,
    levels: Levels,
    /// What of its edge cells is in contact at its lowest level, in cells.
    edges: f64,
    /// What its edges carry there at the indentation of its gap.
    compression: f64,
    stretch: f64,
    /// ½ stretch × growth.
    half: f64,
    /// half² + length.
    square: f64,
}

/// What the two cells at the edges of a fragment, or at one of them, add to its whole cells at one
/// indentation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edges {
    /// How much of them is in contact, in cells.
    pub length: f64,
    /// The compression ∫ (d − c) dx over that, in cells times metres.
    pub compression: f64,
}

/// What the edges of many fragments add.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeSum {
    length: CompensatedSum,
    compression: CompensatedSum,
}

impl EdgeSum {
    #[inline]
    pub fn add(&mut self, edges: Edges) {
        self.length.add(edges.length);
        self.compression.add(edges.compression);
    }

    pub fn total(&self) -> Edges {
        Edges { length: self.length.total(), compression: self.compression.total() }
    }
}

impl Slider {
    /// The slider of the fragment of these springs (first and last) among `gaps` along the line; `stretch` is
    /// the largest stretch of a fragment of one cell, m.
    #[must_use]
    pub(super) fn of_springs(gaps: &[f64], (first, last): (usize, usize), stretch: f64) -> Self {
        let gap = gaps[first..=last].iter().copied().fold(0.0, f64::max);
        let (levels, compression) = levels_between(gaps, (first, last), gap);
        Slider::new(gap, (last + 1 - first) as f64, levels, compression, stretch)
    }

    #[inline]
    fn new(gap: f64, springs: f64, levels: Levels, compression: f64, stretch: f64) -> Self {
        let half = 0.5 * stretch * levels.growth;
        let square = half * half + levels.length;
        let cells = springs - 1.0;
        Slider { gap, levels, edges: levels.length - cells, compression, stretch, half, square }
    }

    /// Gap of its node, m: its lowest level.
    #[inline]
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Gap of the parent, m: its highest level.
    #[inline]
    pub fn top(&self) -> f64 {
        self.levels.top
    }

    /// By how much it grows with its level, cells per metre.
    #[inline]
    pub fn growth(&self) -> f64 {
        self.levels.growth
    }

    /// √ℓ at an indentation that lies so far above the gap.
    #[inline]
    fn root(&self, above: f64) -> f64 {
        let square = self.square + self.levels.growth * above;
        // A square that is not a number comes of growth without bound, and then nothing but `half` counts.
        self.half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }

    /// How far the level lies above the gap.
    #[inline]
    fn rise(&self, above: f64) -> f64 {
        let rise = above + self.stretch * self.root(above);
        let most = self.levels.top - self.gap;
        let rise = if rise > 0.0 { rise } else { 0.0 };
        if rise < most { rise } else { most }
    }

    /// The level at which the fragment rests under an indentation, m, where φ rises through it.
    #[inline]
    pub fn level(&self, indentation: f64) -> f64 {
        if self.levels.growth > 0.0 { self.gap + self.rise(indentation - self.gap) } else { self.gap }
    }

    /// What its edges add under an indentation.
    #[inline]
    pub fn edges(&self, indentation: f64) -> Edges {
        let above = indentation - self.gap;
        let rise = self.rise(above);
        let grown = self.levels.growth * rise;
        Edges {
            length: self.edges + grown,
            compression: (self.edges * above + self.compression) + grown * (above - 0.5 * rise),
        }
    }

    /// Its length under an indentation, in cells.
    #[must_use]
    pub fn length(&self, indentation: f64) -> f64 {
        self.levels.length + self.levels.growth * self.rise(indentation - self.gap)
    }

    /// By how much the compression grows with the indentation, in cells: the length times (2y − 3k)/(2y − k)
    /// with y = √ℓ and k = stretch × growth, since its edges move with it.
    ///
    /// It only grows with the indentation: between events the force is convex.
    pub fn stiffness(&self, indentation: f64) -> f64 {
        let above = indentation - self.gap;
        let rise = self.rise(above);
        let length = self.levels.length + self.levels.growth * rise;
        if self.levels.growth <= 0.0 {
            return length;
        }
        // Also at the ends of its levels its edges slide, to the one side at least.
        let (root, fall) = (self.root(above), 2.0 * self.half);
        let rises = 2.0 * root - fall;
        // Where it is about to let go the edges run away at once.
        if rises > 0.0 { length * (2.0 * root - 3.0 * fall) / rises } else { f64::NEG_INFINITY }
    }

    /// ∫ (c − θ)² dx over the part of the line that is taken in or left between two levels, in cells times
    /// m²: at once at the indentation `at`.
    #[inline]
    pub fn squared_stretch_at_once(&self, from: f64, to: f64, at: f64) -> f64 {
        at_once(self.levels.growth, from, to, at)
    }

    /// The same while the edges slide from one level to another, each place at its own indentation.
    #[inline]
    pub fn squared_stretch_sliding(&self, from: f64, to: f64) -> f64 {
        let length = |level: f64| self.levels.length + self.levels.growth * (level - self.gap);
        let slides = self.levels.growth * (to - from);
        0.5 * self.stretch * self.stretch * slides * (length(from) + length(to))
    }

    /// What joins or leaves between the indentations `low` (not itself) and `high` around the springs of the
    /// node, which form a fragment of their own at `opens` and become part of a larger one at `closes`.
    #[inline]
    pub fn squared_stretch(&self, (opens, closes): (f64, f64), (low, high): (f64, f64)) -> f64 {
        let (gap, top) = (self.gap, self.levels.top);
        if opens > high || closes <= low || self.levels.growth <= 0.0 {
            return 0.0;
        }
        let (from, to) = (self.level(opens.max(low)), self.level(closes.min(high)));
        let mut sum = self.squared_stretch_sliding(from, to.max(from));
        if opens > low {
            sum += self.squared_stretch_at_once(gap, from, opens);
        }
        if closes <= high {
            sum += self.squared_stretch_at_once(to.max(from), top, closes);
        }
        sum
    }
}

/// growth ∫ (t − at)² dt from one level to another.
#[inline]
fn at_once(growth: f64, from: f64, to: f64, at: f64) -> f64 {
    const THIRD: f64 = 1.0 / 3.0;
    let (a, b) = (from - at, to - at);
    THIRD * growth * (to - from) * (a * a + a * b + b * b)
}

/// What joins and leaves are the cells between springs.
impl EdgeRule for SubCellRule {
    #[inline]
    fn grows_at(&self, tree: &SpringTree, fragment: usize, wall: usize) -> f64 {
        debug_assert_eq!(self.sets.levels(fragment).top, tree.gap(wall), "the wall is the parent");
        self.grows_on_at(tree.gap(fragment), self.sets.levels(fragment))
    }

    #[inline]
    fn holds_to(&self, tree: &SpringTree, node: usize) -> f64 {
        self.holds(tree.gap(node), self.sets.levels(node))
    }

    #[inline]
    fn quanta(&self, _: &SpringTree, _: &GapScale, node: usize) -> i64 {
        self.sets.cell_quanta(node)
    }
}
