//! The rule of Hess read with the length between edges that lie anywhere in their cells.

use super::level_sets::{Component, LevelSets, Levels};
use crate::contact::{ContactTree, EdgeRule, HessRule};
use std::sync::Arc;

/// Edges between grid points: a fragment at level t is in equilibrium with the indentation
/// φ(t) = t − Δl_max(ℓ(t)).
///
/// It grows while φ(t) ≤ d and recedes while φ(t) ≥ d. Between the gap of its largest spring and that of
/// its parent ℓ is linear in t, so φ is convex: it falls to its lowest value and then rises, and only
/// where it rises does a fragment rest.
#[derive(Clone, Debug)]
pub struct SubCellEdges {
    sets: Arc<LevelSets>,
    /// Largest stretch of a fragment of one cell, m: Δl_max = `stretch` √ℓ.
    stretch: f64,
}

impl SubCellEdges {
    /// Edges under the rule of Hess; `None`: without adhesion.
    pub fn new(sets: Arc<LevelSets>, hess: Option<HessRule>) -> Self {
        SubCellEdges { sets, stretch: hess.map_or(0.0, |hess| hess.largest_stretch(1)) }
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

    /// The level at which φ is smallest, of those of a node, m.
    #[inline]
    fn lowest(&self, gap: f64, levels: Levels) -> f64 {
        // There √ℓ is half of the stretch that a unit of growth gives.
        let root = 0.5 * self.stretch * levels.growth;
        let excess = root * root - levels.length;
        if excess > 0.0 && levels.growth > 0.0 { (gap + excess / levels.growth).min(levels.top) } else { gap }
    }

    /// The level at which the fragment of a node rests under an indentation, m: where φ rises through it.
    #[inline]
    pub fn level(&self, node: usize, indentation: f64) -> f64 {
        let (gap, levels) = (self.sets.tree().gap(node), self.sets.levels(node));
        if levels.growth <= 0.0 {
            return gap;
        }
        // With y = √ℓ the level is d + stretch y, and ℓ = length + growth (level − gap) is quadratic in y.
        let root = self.root(gap, levels, indentation);
        (indentation + self.stretch * root).clamp(gap, levels.top)
    }

    /// √ℓ of the fragment of a node that rests under an indentation.
    #[inline]
    fn root(&self, gap: f64, levels: Levels, indentation: f64) -> f64 {
        let half = 0.5 * self.stretch * levels.growth;
        let square = half * half + (levels.length + levels.growth * (indentation - gap));
        half + square.max(0.0).sqrt()
    }

    /// The fragment of a node under an indentation.
    pub fn fragment(&self, node: usize, indentation: f64) -> Component {
        self.sets.component(node, self.level(node, indentation), indentation)
    }

    /// By how much the compression of the fragment of a node grows with the indentation, in cells: its length
    /// times (2y − 3k)/(2y − k) with y = √ℓ and k = stretch × growth, since its edges move with it.
    ///
    /// It only grows with the indentation: between events the force is convex.
    pub fn stiffness(&self, node: usize, indentation: f64) -> f64 {
        let (gap, levels) = (self.sets.tree().gap(node), self.sets.levels(node));
        let level = self.level(node, indentation);
        let length = self.sets.component(node, level, indentation).length;
        if levels.growth <= 0.0 || level <= gap || level >= levels.top {
            return length;
        }
        let root = self.root(gap, levels, indentation);
        let fall = self.stretch * levels.growth;
        let rises = 2.0 * root - fall;
        // Where it is about to let go the edges run away at once.
        if rises > 0.0 { length * (2.0 * root - 3.0 * fall) / rises } else { f64::NEG_INFINITY }
    }

    /// ∫ (c − θ)² dx over the part of the line that the fragment of a node takes in between two levels, in
    /// cells times m²: at once at the indentation `at`.
    pub fn squared_stretch_at_once(&self, node: usize, from: f64, to: f64, at: f64) -> f64 {
        let growth = self.sets.levels(node).growth;
        let cube = |level: f64| (level - at).powi(3);
        (growth * (cube(to) - cube(from)) / 3.0).max(0.0)
    }

    /// The same while its edges slide from one level to another, each place at its own indentation.
    pub fn squared_stretch_sliding(&self, node: usize, from: f64, to: f64) -> f64 {
        let (gap, levels) = (self.sets.tree().gap(node), self.sets.levels(node));
        let length = |level: f64| levels.length + levels.growth * (level - gap);
        let square = length(to) * length(to) - length(from) * length(from);
        (0.5 * self.stretch * self.stretch * square).max(0.0)
    }
}

impl EdgeRule for SubCellEdges {
    #[inline]
    fn grows_at(&self, tree: &ContactTree, fragment: usize, _: usize) -> f64 {
        let levels = self.sets.levels(fragment);
        self.rest(tree.gap(fragment), levels, levels.top)
    }

    #[inline]
    fn holds_to(&self, tree: &ContactTree, node: usize) -> f64 {
        let (gap, levels) = (tree.gap(node), self.sets.levels(node));
        self.rest(gap, levels, self.lowest(gap, levels)).min(gap)
    }
}
