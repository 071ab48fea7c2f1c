//! The springs under a rigid line, their elastic foundation by the method of dimensionality reduction, the rule of Hess,
//! and the contact of all three: what stays the same while the body moves.

use super::ContactError;
use super::adhesive::levels::Edges;
use super::adhesive::loading::Closing;
use super::adhesive::tree::ContactTree;
use super::history::{CurvePoint, Direction, Patch};
use super::totals::GapScale;
use std::sync::{Arc, OnceLock};

/// Springs under a rigid line: their gaps, and the contact trees, which depend on the gaps and the edge model alone.
///
/// A tree is built when a contact first needs it.
#[derive(Debug, Default)]
pub struct Springs {
    pub(super) gaps: Arc<Vec<f64>>,
    deepest: f64,
    /// One tree for each edge model, by its number.
    trees: [OnceLock<Arc<ContactTree>>; 2],
}

/// Springs on their foundation under a rule of adhesion.
#[derive(Clone, Debug)]
pub struct Contact {
    pub(super) springs: Arc<Springs>,
    pub(super) foundation: Foundation,
    pub(super) edges: Edges,
    pub(super) hess: Option<HessRule>,
    /// Stiffness k of the instrument that moves the body, N/m; infinite for a rigid one.
    pub(super) loading_stiffness: f64,
    closing: Arc<OnceLock<Closing>>,
}

impl Springs {
    /// Creates springs with these gaps, m: 1 to 2^28 finite numbers, the smallest of which is 0.
    pub fn new(gaps: impl Into<Arc<Vec<f64>>>) -> Self {
        let gaps = gaps.into();
        let deepest = crate::adhesive::tree::largest(&gaps);
        Springs { gaps, deepest, trees: Default::default() }
    }

    /// Gaps along the line, m.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Largest gap, m.
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// Fixed-point scale of exact sums over the gaps.
    pub fn scale(&self) -> GapScale {
        GapScale::for_gaps_up_to(self.deepest)
    }

    /// Returns the contact tree of the gaps for an edge model.
    pub fn tree(&self, edges: Edges) -> Result<&Arc<ContactTree>, ContactError> {
        self.tree_in(ContactTree::default(), edges)
    }

    /// Returns the tree as [`Springs::tree`] does; where it is not built yet, `memory` is a former tree whose memory it
    /// reuses.
    pub fn tree_in(&self, memory: ContactTree, edges: Edges) -> Result<&Arc<ContactTree>, ContactError> {
        let tree = &self.trees[edges as usize];
        if let Some(tree) = tree.get() {
            return Ok(tree);
        }
        let built = Arc::new(memory.rebuild(&self.gaps, self.deepest, edges)?);
        Ok(tree.get_or_init(|| built))
    }

    /// Returns a tree that nothing else uses, for the reuse of its memory; an empty one if there is none.
    pub fn into_tree(self) -> ContactTree {
        let trees = self.trees.into_iter().filter_map(OnceLock::into_inner);
        trees.filter_map(Arc::into_inner).next().unwrap_or_default()
    }
}

impl Contact {
    /// Creates a contact of springs with these gaps (m, the smallest 0); without a rule of Hess it has no adhesion.
    pub fn new(
        gaps: impl Into<Arc<Vec<f64>>>,
        edges: Edges,
        foundation: Foundation,
        hess: Option<HessRule>,
    ) -> Self {
        Self::of(Arc::new(Springs::new(gaps)), edges, foundation, hess)
    }

    /// Force at which the last spring touches the rigid body, N.
    pub fn full_contact_force(&self) -> f64 {
        let deepest = self.springs.deepest();
        self.foundation.spring_stiffness() * self.gaps().iter().map(|gap| deepest - gap).sum::<f64>()
    }

    /// Creates a contact of springs that other contacts may share.
    pub fn of(springs: Arc<Springs>, edges: Edges, foundation: Foundation, hess: Option<HessRule>) -> Self {
        let loading_stiffness = f64::INFINITY;
        Contact { springs, foundation, edges, hess, loading_stiffness, closing: Arc::default() }
    }

    /// Sets the stiffness of the instrument, N/m, above zero; infinite for a rigid instrument.
    pub fn with_loading_stiffness(self, loading_stiffness: f64) -> Self {
        Contact { loading_stiffness, ..self }
    }

    /// Displacement of the instrument at an indentation (m) and a force (N), D = d + F/k, m.
    pub fn displacement(&self, indentation: f64, force: f64) -> f64 {
        indentation + force / self.loading_stiffness
    }

    /// Creates a contact of the same springs and edges with another foundation and rule.
    pub fn with_rule(&self, foundation: Foundation, hess: Option<HessRule>) -> Self {
        Self::of(Arc::clone(&self.springs), self.edges, foundation, hess)
    }

    /// Springs of the contact, shared with other contacts.
    pub fn springs(&self) -> &Arc<Springs> {
        &self.springs
    }

    /// Gaps along the line, m.
    pub fn gaps(&self) -> &[f64] {
        self.springs.gaps()
    }

    /// Elastic foundation.
    pub fn foundation(&self) -> Foundation {
        self.foundation
    }

    /// Returns true if the contact has a rule of Hess.
    pub fn has_adhesion(&self) -> bool {
        self.hess.is_some()
    }

    /// Rule of Hess; without adhesion the rule with no stretch.
    pub(super) fn rule(&self) -> HessRule {
        self.hess.unwrap_or(HessRule::NO_ADHESION)
    }

    /// Returns the closing thresholds of a loading from separation; `close` computes them at the first call.
    pub(super) fn closing(
        &self,
        close: impl FnOnce() -> Result<Closing, ContactError>,
    ) -> Result<&Closing, ContactError> {
        match self.closing.get() {
            Some(closing) => Ok(closing),
            None => close().map(|closing| self.closing.get_or_init(|| closing)),
        }
    }
}

/// A foundation of independent springs, equivalent to an elastic half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// Distance Δx between springs, m.
    pub spacing: f64,
    /// Effective modulus E*, Pa, eq. (2).
    pub effective_modulus: f64,
    /// Length L of the foundation, m; infinite if it extends beyond any contact.
    pub length: f64,
}

impl Foundation {
    /// Returns a foundation of this length (m) and number of springs for a half-space of this modulus (Pa).
    pub fn new(length: f64, springs: usize, effective_modulus: f64) -> Self {
        Foundation { spacing: length / springs as f64, effective_modulus, length }
    }

    /// Returns an endless foundation of springs at this distance (m) for a half-space of this modulus (Pa).
    pub const fn endless(spacing: f64, effective_modulus: f64) -> Self {
        Foundation { spacing, effective_modulus, length: f64::INFINITY }
    }

    /// Length in contact of this number of cells, m. It is never above the length of the foundation, and equals it where
    /// the cells cover the foundation, although N times Δx may differ by a rounding.
    #[inline]
    pub fn contact_length(&self, cells: f64) -> f64 {
        let length = cells * self.spacing;
        if length > self.length * (1.0 - 2.0 * f64::EPSILON) { self.length } else { length }
    }

    /// Half the distance between the outermost edges of the contact, m; zero in separation. `patches` and `point` describe
    /// one state. Separated regions between patches are whole cells; the outermost edges may lie inside a cell.
    pub fn contact_radius(&self, patches: &[Patch], point: CurvePoint) -> f64 {
        let outermost = patches.first().zip(patches.last()).map(|(one, other)| other.last - one.first + 1);
        let between = outermost.map_or(0, |springs| springs as u64 - point.springs);
        0.5 * (point.contact_length + between as f64 * self.spacing)
    }

    /// Stiffness Δk = E* Δx of one spring, N/m, eq. (1).
    pub fn spring_stiffness(&self) -> f64 {
        self.effective_modulus * self.spacing
    }
}

/// The rule of Hess, eqs. (3) and (10): largest stretch of the springs of a contact fragment before they detach.
///
/// If the work of adhesion on opening exceeds that on closing, springs attach to a contact patch by the closing rule and detach
/// from it by the opening rule; between both limits the edges of the patch do not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HessRule {
    /// Largest stretch of a single spring before it detaches, m.
    opening: f64,
    /// Largest stretch with which a single spring attaches, m; at most `opening`.
    closing: f64,
}

impl HessRule {
    /// The rule without adhesion: the largest stretch is zero.
    pub const NO_ADHESION: HessRule = HessRule { opening: 0.0, closing: 0.0 };

    /// The rule for a work of adhesion γ₁ on closing and γ₂ ≥ γ₁ on opening, both in J/m².
    ///
    /// A γ₂ smaller than γ₁ is replaced by γ₁: a spring would detach where it had just attached.
    pub fn from_works(foundation: Foundation, closing_work: f64, opening_work: f64) -> Self {
        let stretch = |work: f64| {
            // The quotient γ/E* first: scaling both by one power of two then changes no bit.
            let range = work / foundation.effective_modulus;
            (std::f64::consts::PI * foundation.spacing * range).sqrt()
        };
        let closing = stretch(closing_work);
        HessRule { opening: stretch(opening_work).max(closing), closing }
    }

    /// Largest stretch of a fragment of one spring, m: on unloading before it detaches, on loading as it attaches.
    pub fn stretch(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Loading => self.closing,
            Direction::Unloading => self.opening,
        }
    }

    /// Returns true if springs attach and detach by the same rule.
    pub fn is_one(&self) -> bool {
        self.opening == self.closing
    }

    /// Largest stretch Δl_max = √(π n Δx γ/E*) of a fragment of n = `springs` springs, m, eq. (10).
    ///
    /// Rounding keeps the order: the value never falls with the number of springs.
    pub fn largest_stretch(&self, direction: Direction, springs: usize) -> f64 {
        self.stretch(direction) * (springs as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// All cells are as long as the foundation, to the last bit; fewer have their own length, and more are no
        /// longer.
        #[test]
        fn no_contact_is_longer_than_the_foundation(springs in 2_usize..400, length in 1e-6..10.0_f64) {
            let foundation = Foundation::new(length, springs, 1.0);
            prop_assert_eq!(foundation.contact_length(springs as f64), length);
            prop_assert_eq!(foundation.contact_length(springs as f64 + 0.5), length);
            for cells in 0..springs {
                let own = cells as f64 * foundation.spacing;
                prop_assert_eq!(foundation.contact_length(cells as f64), own);
                prop_assert_eq!(Foundation::endless(foundation.spacing, 1.0).contact_length(cells as f64), own);
            }
        }
    }
}
