//! Changes of the view: panes, close-up, parts of the line, quantities, colours.

use super::Effect;
use crate::draw::AxisScale;
use crate::explorer::action::{Command, Jump};
use crate::explorer::model::{CloseUpTarget, Model, Notice, Pane};
use crate::explorer::request::{Focus, LineView};

/// Fewest springs that fill a pane.
const FEWEST_SPRINGS: usize = 8;

/// Obeys a command that changes only what is seen.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::Fragment(jump) => {
            let fragment = model.snapshot.as_ref().and_then(|snapshot| snapshot.close_up.fragment);
            let middle = fragment.map(|fragment| fragment.middle());
            model.look.focus = match jump {
                Jump::Next => Focus::After(middle),
                Jump::Previous => Focus::Before(middle),
                Jump::Largest => Focus::Largest,
                Jump::MostLoaded => Focus::MostLoaded,
                Jump::Summit => Focus::Summit,
            };
        }
        Command::Zoom(steps) => zoom(model, steps),
        Command::Pan(quarters) => pan(model, quarters),
        Command::ResetZoom => {
            model.profile = LineView::WHOLE;
            model.look.springs = CloseUpTarget::springs_shown(&model.document);
        }
        Command::ToggleFollow => {
            model.profile.follow = !model.profile.follow;
            // There is nothing to follow in the whole line.
            if model.profile.follow && model.profile.share >= 1.0 {
                model.profile.share = 0.25;
            }
        }
        Command::NextCurve => model.curve.quantities = model.curve.quantities.next(),
        Command::ToggleNormalised => model.curve.normalised = !model.curve.normalised,
        Command::ToggleLogarithmic => {
            model.curve.scale = match model.curve.scale {
                AxisScale::Linear => AxisScale::Logarithmic,
                AxisScale::Logarithmic => AxisScale::Linear,
            };
        }
        Command::ToggleLoss => model.curve.loss = !model.curve.loss,
        Command::ToggleApproximate => {
            model.approximate.shown = !model.approximate.shown;
            return vec![Effect::Study, Effect::Show];
        }
        Command::ZoomPane => model.zoomed = !model.zoomed,
        Command::NextPane => {
            let panes = model.panes();
            let place = panes.iter().position(|pane| *pane == model.pane).unwrap_or(0);
            model.pane = panes[(place + 1) % panes.len()];
        }
        Command::ToggleWork => model.shows_work = !model.shows_work,
        Command::NextTheme => {
            model.appearance.theme = model.appearance.theme.next();
            notify(model, format!("colours: {}", model.appearance.theme.name()));
        }
        Command::NextMarker => {
            model.appearance.marker = model.appearance.marker.next();
            notify(model, format!("markers: {}", model.appearance.marker.name()));
        }
        Command::RememberAppearance => {
            let Some(path) = model.config_path.clone() else {
                let why = "there is no configuration file: asperity was started with --no-config";
                model.notice = Some(Notice::Error(why.to_owned()));
                return Vec::new();
            };
            return vec![Effect::Remember { path, appearance: model.appearance }];
        }
        _ => {}
    }
    vec![Effect::Show]
}

fn notify(model: &mut Model, text: String) {
    model.notice = Some(Notice::Done(text));
}

fn springs(model: &Model) -> usize {
    model.computed.as_ref().map_or(1, |computed| computed.outcome.line.points).max(1)
}

/// Looks closer in the profile, where it is the chosen pane, or in the close-up.
fn zoom(model: &mut Model, steps: i32) {
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

/// Looks closer, or from further away, such that the point under the pointer, at a share of the pane, stays there.
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

/// Moves along the line by quarters of what is seen.
fn pan(model: &mut Model, quarters: i32) {
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
