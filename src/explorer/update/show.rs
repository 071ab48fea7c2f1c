//! Panes shown and hidden by a key.

use super::Effect;
use crate::explorer::app::{App, Pane};
use crate::explorer::keys::Context;

/// Shows and selects a pane, or hides it again. A pane with other keys than the crosshair's is selected before it is
/// hidden: a user in another pane wants these keys.
pub fn toggle(app: &mut App, pane: Pane) -> Vec<Effect> {
    let is_in_use = app.view.pane == pane || matches!(pane.row().keys, None | Some(Context::Crosshair));
    if app.is_shown(pane) && is_in_use { change(app, |app| app.hide(pane)) } else { choose(app, pane) }
}

/// Shows and selects a pane.
pub fn choose(app: &mut App, pane: Pane) -> Vec<Effect> {
    change(app, |app| app.show(pane))
}

/// Changes the shown panes and returns the effects: other data are computed.
pub fn change(app: &mut App, change: impl FnOnce(&mut App)) -> Vec<Effect> {
    let before = app.view.large;
    change(app);
    if before == app.view.large { vec![Effect::Ask] } else { vec![Effect::Study, Effect::Ask] }
}
