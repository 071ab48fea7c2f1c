//! Panes shown and hidden by a key.

use super::Effect;
use crate::explorer::model::{Model, Pane};

/// Shows and selects a pane, or hides it again. A pane with keys of its own is selected before it is hidden: a user in
/// another pane wants these keys.
pub fn toggle(model: &mut Model, pane: Pane) -> Vec<Effect> {
    let is_in_use = model.pane == pane || pane.row().keys.is_none();
    if model.is_shown(pane) && is_in_use {
        change(model, |model| model.hide(pane))
    } else {
        choose(model, pane)
    }
}

/// Shows and selects a pane.
pub fn choose(model: &mut Model, pane: Pane) -> Vec<Effect> {
    change(model, |model| model.show(pane))
}

/// Changes the shown panes and returns the effects: other data are computed.
pub fn change(model: &mut Model, change: impl FnOnce(&mut Model)) -> Vec<Effect> {
    let before = model.large;
    change(model);
    if before == model.large { vec![Effect::Ask] } else { vec![Effect::Study, Effect::Ask] }
}
