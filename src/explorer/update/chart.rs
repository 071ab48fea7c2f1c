//! The map over κ and H: shown or not, and the mark on it, which is the scene.

use super::{Effect, edit};
use crate::explorer::action::Command;
use crate::explorer::model::{Model, Notice, Pane};
use crate::explorer::opening::Opening;
use crate::scene::{Document, SceneErrors};
use crate::study::map::{Template, next_beyond};

/// Obeys a command that has to do with the map.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::ToggleChart => toggle(model),
        Command::ToggleSections => {
            model.chart.sections = !model.chart.sections;
            Vec::new()
        }
        Command::NextCharted => {
            model.chart.quantity = model.chart.next_charted();
            Vec::new()
        }
        Command::ToggleStudy => toggle_study(model),
        Command::NextSlice(steps) => step_slice(model, steps),
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

/// Explores what has been opened by its path.
pub fn open(model: &mut Model, opening: Opening) -> Vec<Effect> {
    let Opening { document, study_map, beside } = opening;
    model.opens_beside = beside;
    let effects = edit::open(model, document);
    if let Some(study_map) = study_map {
        model.show_study(study_map);
    }
    effects
}

/// Without a study there is nothing to be shown of it.
const NO_STUDY: &str = "no study is open; o and the path of its folder open one";

fn toggle_study(model: &mut Model) -> Vec<Effect> {
    if model.chart.study.is_none() {
        model.notice = Some(Notice::Error(NO_STUDY.to_owned()));
        return Vec::new();
    }
    model.chart.of_study = !model.chart.of_study;
    model.chart.edited = false;
    vec![Effect::Study]
}

/// Shows another map of the study. A scene that is of the map before goes with it.
fn step_slice(model: &mut Model, steps: i32) -> Vec<Effect> {
    let Some(study) = model.chart.shown_study() else {
        let why = if model.chart.study.is_some() {
            "this is the map that is computed here; W shows the study's"
        } else {
            NO_STUDY
        };
        model.notice = Some(Notice::Error(why.to_owned()));
        return Vec::new();
    };
    if study.study_map.slices() == 1 {
        model.notice = Some(Notice::Done("this study has one map".to_owned()));
        return Vec::new();
    }
    let next = study.stepped(steps);
    let goes_with = study.study_map.is_of(study.slice, model.document.scene());
    let followed = goes_with.then(|| next.study_map.follow(next.slice, &model.document));
    model.chart.study = Some(next);
    followed.map_or_else(Vec::new, |followed| edit::take_over(model, followed))
}

/// Moves the mark by columns and rows of the map.
fn step(model: &mut Model, columns: i32, rows: i32) -> Vec<Effect> {
    let Some((at_kappa, at_hurst)) = model.place() else {
        let why = match Template::of(model.document.scene()) {
            Err(why) => why.to_string(),
            Ok(_) => "not before the scene is computed: its κ follows from its profile".to_owned(),
        };
        model.notice = Some(Notice::Error(why));
        return Vec::new();
    };
    let (across, up) = model.chart.axes();
    let to_kappa = if columns == 0 { Some(at_kappa) } else { next_beyond(at_kappa, columns, &across.values) };
    let to_hurst = match at_hurst {
        Some(at) if rows != 0 => next_beyond(at, rows, &up.values),
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
    let effects = match moved(model, kappa, hurst) {
        Ok(document) if goes_on => edit::replace(model, document),
        moved => edit::take_over(model, moved),
    };
    model.chart.moving = model.refused.is_none();
    effects
}

/// The scene with another κ and H. A preload in units of E* h L may change with them.
fn moved(model: &Model, kappa: f64, hurst: f64) -> Result<Document, SceneErrors> {
    let moved = Template::moved(&model.document, kappa, hurst)?;
    match model.chart.shown_study() {
        Some(study)
            if study.study_map.is_of(study.slice, model.document.scene())
                && !study.study_map.is_of(study.slice, moved.scene()) =>
        {
            study.study_map.follow(study.slice, &moved)
        }
        _ => Ok(moved),
    }
}
