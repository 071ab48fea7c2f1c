//! Opening of scenes, studies and measured curves.

use super::edit;
use crate::explorer::app::App;
use crate::explorer::config::Config;
use crate::explorer::map::OpenStudy;
use crate::explorer::measured::Measured;
use crate::explorer::opening::Opening;
use crate::explorer::pane::Pane;
use crate::explorer::theme::Appearance;
use asperity_report::LoopQuantities;
use asperity_study::StudyMap;
use std::sync::Arc;

/// Creates the state of an explorer in a window of this size, opened with the arguments of the program.
pub fn begin(opening: Opening, size: (u16, u16), appearance: Appearance, config: Config) -> App {
    let Opening { document, study_map, ghost, measured } = opening;
    let mut app = App::new(document, size, appearance, config);
    app.ghosts.extend(ghost);
    study_map.into_iter().for_each(|study_map| show_study(&mut app, study_map));
    measured.into_iter().for_each(|measured| show_measured(&mut app, measured));
    app
}

/// Explores a scene or a study that was opened by its path.
pub fn open(app: &mut App, opening: Opening) {
    let Opening { document, study_map, .. } = opening;
    edit::open(app, document);
    study_map.into_iter().for_each(|study_map| show_study(app, study_map));
}

fn show_study(app: &mut App, study_map: Arc<StudyMap>) {
    app.map.study = Some(OpenStudy::new(study_map, 0));
    app.map.of_study = true;
    app.show(Pane::Map);
}

/// Shows a measured curve. The scene gets the loading of the curve, as an edit that can be undone.
fn show_measured(app: &mut App, measured: Measured) {
    match measured.curve.load(&app.edit.document, measured.offset) {
        Ok(loaded) => {
            app.edit.adopt(loaded);
            app.set_done("the scene has the loading of the measured curve; u returns to its own");
        }
        Err(errors) => app.set_error(errors.to_string()),
    }
    app.view.curve.quantities = LoopQuantities::ForceDisplacement;
    app.measured = Some(measured);
}
