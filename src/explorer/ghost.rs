//! Ghosts: computed scenes that the user keeps on the screen to compare them with the present
//! scene.

use asperity_scene::fields::Change;
use asperity_scene::{Document, Outcome};
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct Ghost {
    pub document: Document,
    pub outcome: Arc<Outcome>,
}

impl Ghost {
    /// Returns as text the changes that lead from this ghost, a scene kept for comparison, to the
    /// scene `present`. `words` converts a single change to text.
    pub fn changes(&self, present: &Document, words: impl Fn(&Change) -> String) -> String {
        let changes = self.document.changes_to(present);
        let parts: Vec<String> = changes.iter().map(words).collect();
        if parts.is_empty() {
            "the same scene".to_owned()
        } else {
            parts.join(", ")
        }
    }
}
