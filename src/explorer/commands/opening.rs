//! Functions that show what the user opens: scenes, studies and measured curves.

use super::edit;
use crate::explorer::app::App;
use crate::explorer::config::Config;
use crate::explorer::editor::Edited;
use crate::explorer::map_state::OpenStudy;
use crate::explorer::measured::Measured;
use crate::explorer::opening::{Opened, Opening};
use crate::explorer::pane::Pane;
use crate::explorer::prompt::Purpose;
use crate::explorer::theme::Appearance;
use asperity_data::path_name;
use asperity_report::LoopQuantities;
use asperity_scene::Document;
use asperity_study::maps::StudyMap;
use std::path::Path;
use std::sync::Arc;

/// Creates the state of an explorer in a window of this size. `opening` contains the scene, study
/// or curve that the arguments of the program name.
pub fn begin(opening: Opening, size: (u16, u16), appearance: Appearance, config: Config) -> App {
    let Opening {
        document,
        study_map,
        ghost,
        measured,
        profiles,
    } = opening;
    let mut app = App::new(document, size, appearance, config);
    app.ghosts.extend(ghost);
    if let Some(profiles) = profiles {
        app.edit.begin_with_profiles(profiles);
    }
    if let Some(study_map) = study_map {
        show_study(&mut app, study_map);
    }
    if let Some(measured) = measured {
        app.edit.begin_with(measured.clone());
        let document = app.edit.document.clone();
        show_measured(&mut app, measured, document, None);
    }
    app
}

/// Shows what was found at the path that the user has opened: a scene, a study, or a measured
/// curve. A measured curve is compared with the present scene.
pub fn open(app: &mut App, opened: Opened) {
    match opened {
        Opened::Scene(opening) => {
            edit::open(app, opening.document);
            if let Some(study_map) = opening.study_map {
                // The curve was measured on another contact than the scenes of the study.
                close_measured(app);
                show_study(app, study_map);
            }
        }
        Opened::Curve(measured) => open_measured(app, *measured),
        Opened::Question(question) => {
            let reason = question.reason.clone();
            app.ask_again(Purpose::Curve(*question), "", &reason);
        }
        Opened::Surface(path) => set_roughness(app, &path),
    }
}

fn close_measured(app: &mut App) {
    if let Some(Measured { name, .. }) = &app.edit.measured {
        let closed = format!("{name} is closed; u shows it again");
        let edited = Edited {
            measured: None,
            ..app.edit.edited()
        };
        edit::adopt_all(app, edited);
        app.set_done(closed);
    }
}

fn show_study(app: &mut App, study_map: Arc<StudyMap>) {
    app.map.study = Some(OpenStudy::new(study_map, 0));
    app.map.of_study = true;
    app.show(Pane::Map);
}

/// Makes a measured surface the roughness of the present scene, in one edit.
fn set_roughness(app: &mut App, path: &Path) {
    let document = &app.edit.document;
    // Paths in a scene are relative to the folder of its file.
    let from_scene = document.resolve(&path.to_string_lossy());
    let path = if from_scene.exists() {
        path.to_owned()
    } else {
        path.canonicalize().unwrap_or_else(|_| path.to_owned())
    };
    match document.set("roughness", &path.to_string_lossy()) {
        Ok(document) => {
            edit::adopt(app, document);
            let name = path_name(&path);
            app.set_done(format!("{name} is the roughness of the scene; u undoes"));
        }
        Err(errors) => app.set_error(errors.to_string()),
    }
}

/// Shows a measured curve that the user has opened. If its file states the stiffness of the
/// instrument, this stiffness replaces the stiffness of the scene.
fn open_measured(app: &mut App, measured: Measured) {
    match measured.curve.with_instrument_of_file(&app.edit.document) {
        Ok((document, instrument)) => show_measured(app, measured, document, instrument),
        Err(errors) => app.set_error(errors.to_string()),
    }
}

/// Shows a measured curve together with the scene `document`, and gives the scene the loading of
/// the curve, in one edit. `instrument` is a sentence on the stiffness of the instrument.
fn show_measured(
    app: &mut App,
    measured: Measured,
    document: Document,
    instrument: Option<String>,
) {
    let is_new = app.edit.measured.as_ref() != Some(&measured);
    let undone = if is_new {
        "u closes it"
    } else {
        "u returns to its own"
    };
    let name = measured.name.clone();
    let loaded = measured.curve.load(&document, measured.offset);
    let (document, wrong) = match loaded {
        Ok(document) => (document, None),
        Err(errors) => (app.edit.document.clone(), Some(errors)),
    };
    let edited = Edited {
        document,
        measured: Some(measured),
        ..app.edit.edited()
    };
    edit::adopt_all(app, edited);
    match wrong {
        None => {
            let instrument = instrument.map_or_else(String::new, |text| format!(". {text}"));
            app.set_done(format!(
                "{name}: the scene has the loading of the measured curve; {undone}{instrument}"
            ));
        }
        Some(errors) => app.set_error(errors.to_string()),
    }
    app.view.curve.quantities = LoopQuantities::ForceDisplacement;
    app.show_force_curve();
    app.edit.select_measured();
}
