//! Approximate JKR curve of the scene, drawn under the loop.

use super::snapshot::SolvedScene;
use crate::analysis::ApproximateJkr;
use std::sync::Arc;

/// State of the approximate JKR curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Approximate {
    /// True while shown beside the loop.
    pub shown: bool,
    /// The curve of the present scene, or the reason for none, once computed.
    pub found: Option<Result<Arc<ApproximateJkr>, String>>,
}

impl Approximate {
    /// Drops the curve of the former scene.
    pub fn renew(&mut self) {
        self.found = None;
    }

    /// The scene, if its curve is still to be computed.
    #[must_use]
    pub fn wanted(&self, computed: &Arc<SolvedScene>) -> Option<Arc<SolvedScene>> {
        (self.shown && self.found.is_none()).then(|| Arc::clone(computed))
    }

    /// The curve, while shown.
    #[must_use]
    pub fn curve(&self) -> Option<&ApproximateJkr> {
        let found = self.found.as_ref().filter(|_| self.shown)?;
        found.as_ref().ok().map(Arc::as_ref)
    }
}
