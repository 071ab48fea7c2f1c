//! The springs under a rigid line and the contact that they form: all that stays the same while the body moves.

use super::adhesive::{Closing, ContactTree};
use super::{ContactError, Edges, Foundation, GapScale, HessRule};
use std::sync::{Arc, OnceLock};

/// Springs under a rigid line: their gaps, and the trees that depend on the gaps and the edge model alone.
///
/// A tree is built when a contact first needs it.
#[derive(Debug, Default)]
pub struct Springs {
    gaps: Arc<Vec<f64>>,
    deepest: f64,
    /// For whole springs and for edges between springs.
    trees: [OnceLock<Arc<ContactTree>>; 2],
}

/// Springs on their foundation under a rule of adhesion.
#[derive(Clone, Debug)]
pub struct Contact {
    pub(super) springs: Arc<Springs>,
    pub(super) foundation: Foundation,
    pub(super) edges: Edges,
    pub(super) hess: Option<HessRule>,
    /// Stiffness k of the instrument that moves the body, N/m; infinite: rigid.
    pub(super) loading_stiffness: f64,
    closing: Arc<OnceLock<Closing>>,
}

impl Springs {
    /// Creates springs of these gaps (m, finite, the smallest 0, at least one, at most 2^28).
    pub fn new(gaps: impl Into<Arc<Vec<f64>>>) -> Self {
        let gaps = gaps.into();
        let deepest = super::adhesive::largest(&gaps);
        Springs { gaps, deepest, trees: Default::default() }
    }

    /// Gaps along the line, m.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Gaps to be shared with a leg, m.
    pub(super) fn shared_gaps(&self) -> &Arc<Vec<f64>> {
        &self.gaps
    }

    /// Largest gap, m.
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// Scale of exact sums over the gaps.
    pub fn scale(&self) -> GapScale {
        GapScale::for_gaps_up_to(self.deepest)
    }

    /// Returns the tree of the gaps with the sums of an edge model.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn tree(&self, edges: Edges) -> Result<&Arc<ContactTree>, ContactError> {
        self.tree_in(ContactTree::default(), edges)
    }

    /// Returns the tree of [`Springs::tree`], built in the memory of one that is no longer needed.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn tree_in(&self, memory: ContactTree, edges: Edges) -> Result<&Arc<ContactTree>, ContactError> {
        let tree = &self.trees[edges as usize];
        if let Some(tree) = tree.get() {
            return Ok(tree);
        }
        let built = Arc::new(memory.rebuild(&self.gaps, self.deepest, edges)?);
        Ok(tree.get_or_init(|| built))
    }

    /// Returns the memory of a tree that nothing else uses.
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

    /// Sets the stiffness of the instrument, N/m, above zero; infinite: rigid.
    #[must_use]
    pub fn with_loading_stiffness(self, loading_stiffness: f64) -> Self {
        Contact { loading_stiffness, ..self }
    }

    /// Stiffness of the instrument in units of the stiffness of one spring; zero for a rigid one, whose displacement is
    /// the indentation.
    pub(super) fn instrument_springs(&self) -> f64 {
        if self.loading_stiffness.is_infinite() {
            return 0.0;
        }
        self.loading_stiffness / self.foundation.spring_stiffness()
    }

    /// Creates a contact of the same springs and edges with another foundation and rule.
    pub(crate) fn with_rule(&self, foundation: Foundation, hess: Option<HessRule>) -> Self {
        Self::of(Arc::clone(&self.springs), self.edges, foundation, hess)
    }

    /// Springs along the line.
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

    /// Returns true with a rule of Hess.
    pub fn has_adhesion(&self) -> bool {
        self.hess.is_some()
    }

    /// Rule of Hess, without adhesion the one of no stretch.
    pub(super) fn rule(&self) -> HessRule {
        self.hess.unwrap_or(HessRule::NO_ADHESION)
    }

    /// Returns the closing thresholds of a loading from separation, computed by `close` at first.
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
