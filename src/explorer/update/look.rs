//! Changes of the view: panes, close-up, parts of the line, quantities, colours.

use super::Effect;
use crate::explorer::model::{CloseUpTarget, Model, Pane};
use crate::explorer::request::{Focus, LineView};
use crate::explorer::theme::Choice;

/// Fewest springs that fill a pane.
const FEWEST_SPRINGS: usize = 8;

/// Shows the fragment of a question, starting from the shown one.
pub fn go_to_fragment(model: &mut Model, question: fn(Option<usize>) -> Focus) {
    let fragment = model.snapshot.as_ref().and_then(|snapshot| snapshot.close_up.fragment);
    model.look.focus = question(fragment.map(|facts| facts.patch.middle()));
}

/// Shows the whole profile, and the close-up in its initial size.
pub fn reset_zoom(model: &mut Model) {
    model.profile = LineView::WHOLE;
    model.look.springs = CloseUpTarget::springs_shown(&model.document);
}

/// Keeps the profile centred on the close-up, or not.
pub fn toggle_follow(model: &mut Model) {
    model.profile.follow = !model.profile.follow;
    // There is nothing to follow in the whole line.
    if model.profile.follow && model.profile.share >= 1.0 {
        model.profile.share = 0.25;
    }
}

/// Selects the next pane.
pub fn next_pane(model: &mut Model) {
    let panes = model.panes();
    let place = panes.iter().position(|pane| *pane == model.pane).unwrap_or(0);
    model.pane = panes[(place + 1) % panes.len()];
}

/// Changes the colours.
pub fn next_theme(model: &mut Model) {
    model.appearance.theme = model.appearance.theme.next();
    model.set_done(format!("colours: {}", model.appearance.theme.name()));
}

/// Changes the markers of the plots.
pub fn next_marker(model: &mut Model) {
    model.appearance.marker = model.appearance.marker.next();
    model.set_done(format!("markers: {}", model.appearance.marker.name()));
}

/// Keeps colours and markers in the configuration file.
pub fn remember_appearance(model: &mut Model) -> Vec<Effect> {
    let Some(path) = model.config_path.clone() else {
        model.set_error("there is no configuration file: asperity was started with --no-config");
        return Vec::new();
    };
    vec![Effect::Remember { path, appearance: model.appearance }]
}

fn springs(model: &Model) -> usize {
    model.computed.as_ref().map_or(1, |computed| computed.outcome.line.points).max(1)
}

/// Zooms the profile, where it is the chosen pane, or the close-up; positive steps are closer.
pub fn zoom(model: &mut Model, steps: i32) {
    let most = springs(model);
    if model.pane == Pane::Profile {
        let least = (FEWEST_SPRINGS as f64 / most as f64).min(1.0);
        let share = model.profile.share * if steps > 0 { 0.5 } else { 2.0 };
        model.profile.share = share.clamp(least, 1.0);
        if model.profile.share >= 1.0 {
            model.profile = LineView::WHOLE;
        }
    } else {
        let springs = model.look.springs;
        let springs = if steps > 0 { springs / 2 } else { springs * 2 };
        model.look.springs = springs.clamp(FEWEST_SPRINGS, most.max(FEWEST_SPRINGS));
    }
}

/// Zooms in or out such that the point under the pointer, at a share of the pane, stays there.
pub fn zoom_at(model: &mut Model, steps: i32, pointer: Option<f64>) {
    let (profile, springs_before) = (model.profile, model.look.springs as f64);
    zoom(model, steps);
    let Some(pointer) = pointer else { return };
    let away = pointer - 0.5;
    if model.pane == Pane::Profile {
        let LineView { share, .. } = model.profile;
        let centre = profile.centre + away * (profile.share - share);
        let centre = centre.clamp(share / 2.0, 1.0 - share / 2.0);
        model.profile = LineView { centre, share, follow: false };
    } else if let Some(snapshot) = &model.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first as f64 + section.springs as f64 / 2.0;
        let to = middle + away * (springs_before - model.look.springs as f64);
        model.look.focus = Focus::Spring(to.clamp(0.0, (springs(model) - 1) as f64) as usize);
    }
}

/// Moves along the line by quarters of the visible part.
pub fn pan(model: &mut Model, quarters: i32) {
    let quarters = f64::from(quarters) / 4.0;
    if model.pane == Pane::Profile {
        let half = model.profile.share / 2.0;
        let centre = model.profile.centre + quarters * model.profile.share;
        model.profile.centre = centre.clamp(half, 1.0 - half);
        model.profile.follow = false;
    } else if let Some(snapshot) = &model.snapshot {
        let section = &snapshot.close_up.section;
        let middle = section.first + section.springs / 2;
        let to = middle as f64 + quarters * section.springs as f64;
        model.look.focus = Focus::Spring(to.clamp(0.0, (springs(model) - 1) as f64) as usize);
    }
}
