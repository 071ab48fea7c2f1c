//! The map over κ and H: shown or not, and the mark on it, which is the scene.

use super::{Effect, edit};
use crate::explorer::action::Command;
use crate::explorer::model::{Model, Notice, Pane};
use crate::phase::{Basis, HURSTS, KAPPAS, hurst, kappa, next_beyond};

/// Obeys a command that has to do with the map.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::ToggleChart => toggle(model),
        Command::ToggleSections => {
            model.chart.sections = !model.chart.sections;
            Vec::new()
        }
        Command::NextCharted => {
            model.chart.quantity = model.chart.quantity.next();
            Vec::new()
        }
        Command::MoveKappa(steps) => step(model, steps, 0),
        Command::MoveHurst(steps) => step(model, 0, steps),
        _ => Vec::new(),
    }
}

fn toggle(model: &mut Model) -> Vec<Effect> {
    // Whoever comes from another pane wants the arrows to move the mark.
    if model.chart.shown && model.pane != Pane::Chart {
        model.pane = Pane::Chart;
        return vec![Effect::Show];
    }
    let shown = !model.chart.shown;
    model.chart.shown = shown;
    model.chart.edited = false;
    if shown {
        model.appraisal.hide();
        model.pane = Pane::Chart;
    } else if model.pane == Pane::Chart {
        model.pane = Pane::Force;
    }
    vec![Effect::Study, Effect::Show]
}

/// Moves the mark by columns and rows of the map.
fn step(model: &mut Model, columns: i32, rows: i32) -> Vec<Effect> {
    let Some((at_kappa, at_hurst)) = model.place() else {
        let why = match Basis::of(model.document.scene()) {
            Err(why) => why.to_string(),
            Ok(_) => "not before the scene is computed: its κ follows from its profile".to_owned(),
        };
        model.notice = Some(Notice::Error(why));
        return Vec::new();
    };
    let to_kappa = if columns == 0 { Some(at_kappa) } else { next_beyond(at_kappa, columns, KAPPAS, kappa) };
    let to_hurst = match at_hurst {
        Some(at) if rows != 0 => next_beyond(at, rows, HURSTS, hurst),
        None if rows != 0 => {
            model.notice = Some(Notice::Error("a measured profile has no H to change".to_owned()));
            return Vec::new();
        }
        at => Some(at.unwrap_or_default()),
    };
    match (to_kappa, to_hurst) {
        (Some(kappa), Some(hurst)) => move_to(model, kappa, hurst),
        _ => {
            model.notice = Some(Notice::Done("here the map ends".to_owned()));
            Vec::new()
        }
    }
}

/// Sets κ and H of the scene. All moves in a row are one edit.
pub fn move_to(model: &mut Model, kappa: f64, hurst: f64) -> Vec<Effect> {
    let goes_on = model.chart.moving;
    let effects = match Basis::moved(&model.document, kappa, hurst) {
        Ok(document) if goes_on => edit::replace(model, document),
        moved => edit::take_over(model, moved),
    };
    model.chart.moving = model.refused.is_none();
    effects
}
