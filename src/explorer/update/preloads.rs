//! Adhesion against preload: shown or not.

use super::Effect;
use crate::explorer::model::{Model, Pane};

/// Shows the pane, selects it, or shows profile and close-up again.
pub fn toggle(model: &mut Model) -> Vec<Effect> {
    if model.preloads.shown {
        model.preloads.shown = false;
        model.pane = if model.pane == Pane::Preloads { Pane::Force } else { model.pane };
    } else {
        model.hide_in_place_of_the_line();
        model.preloads.shown = true;
        model.preloads.edited = false;
        model.pane = Pane::Preloads;
    }
    vec![Effect::Study, Effect::Show]
}
