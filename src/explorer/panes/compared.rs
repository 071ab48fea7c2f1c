//! The figure of several curves for comparison, each named by the values that differ.

use super::force_loops::units;
use crate::explorer::app::App;
use crate::explorer::ghost::Ghost;
use asperity_plot::Figure;
use asperity_report::force_figure;
use asperity_scene::{Document, Outcome};

/// Returns the figure with the curves of the present scene and of the ghosts (scenes that the user
/// keeps for comparison). The present scene comes first, so that its curve is the solid one. Curves
/// of variants of one scene are named by the numbers that differ among them, other curves by their
/// titles.
pub fn compared(app: &App) -> Option<Figure> {
    let present = &app.edit.document;
    let variants: Vec<&Ghost> = app
        .ghosts
        .iter()
        .filter(|ghost| is_variant(&ghost.document, present))
        .collect();
    let differing = DifferingValues::new(present, &variants);
    let mut names = vec![
        differing
            .of_present()
            .unwrap_or_else(|| present.title().to_owned()),
    ];
    let mut outcomes: Vec<&Outcome> = vec![&app.current()?.outcome];
    for ghost in &app.ghosts {
        names.push(if is_variant(&ghost.document, present) {
            differing.of_ghost(ghost)
        } else {
            ghost.document.title().to_owned()
        });
        outcomes.push(&ghost.outcome);
    }
    let curves: Vec<(&str, &Outcome)> = names.iter().map(String::as_str).zip(outcomes).collect();
    Some(force_figure(&curves, units(app)))
}

/// Returns true if two documents are variants of one scene, so that numbers and not titles
/// distinguish them.
fn is_variant(one: &Document, other: &Document) -> bool {
    one.name() == other.name() || one.title() == other.title()
}

/// Values that differ among the present scene and its variants. Each has the name of its field and
/// its text in the present scene.
struct DifferingValues<'a> {
    present: &'a Document,
    values: Vec<(String, String)>,
}

impl DifferingValues<'_> {
    fn new<'a>(present: &'a Document, ghosts: &[&Ghost]) -> DifferingValues<'a> {
        let mut values: Vec<(String, String)> = Vec::new();
        for ghost in ghosts {
            for change in ghost.document.changes_to(present) {
                let is_listed = values.iter().any(|(name, _)| *name == change.name);
                if !is_listed {
                    values.push((change.name, change.to));
                }
            }
        }
        DifferingValues { present, values }
    }

    /// Returns the values of the present scene; `None` if none differs.
    fn of_present(&self) -> Option<String> {
        if self.values.is_empty() {
            return None;
        }
        let words = self
            .values
            .iter()
            .map(|(name, value)| format!("{name} {value}"));
        Some(words.collect::<Vec<_>>().join(", "))
    }

    /// Returns the same values of a ghost.
    fn of_ghost(&self, ghost: &Ghost) -> String {
        let changes = ghost.document.changes_to(self.present);
        let mut words = Vec::new();
        for (name, value) in &self.values {
            let change = changes.iter().find(|change| change.name == *name);
            let value = change.map_or(value, |change| &change.from);
            words.push(format!("{name} {value}"));
        }
        if words.is_empty() {
            ghost.document.title().to_owned()
        } else {
            words.join(", ")
        }
    }
}
