//! Names of kept loops: their differences from the present scene.

use crate::explorer::app::App;
use crate::scene::Change;

/// Names the differences between each ghost and the present scene anew.
pub fn name_ghosts(app: &mut App) {
    let document = &app.edit.document;
    for ghost in &mut app.ghosts {
        let changes = ghost.document.changes_to(document);
        let join = |part: &dyn Fn(&Change) -> String| {
            let parts: Vec<String> = changes.iter().map(part).collect();
            if parts.is_empty() { "the same scene".to_owned() } else { parts.join(", ") }
        };
        ghost.differs = join(&|change| format!("{} {}", change.name, change.from));
        ghost.changes = join(&Change::to_string);
    }
}
