//! Studies (background computations) that the present scene needs. They compute the error of its
//! outcome, the number of springs for a tolerance, the data of the shown pane, and the curve for a
//! typed value.

use super::{edit, measured, target};
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::editor::scene_of;
use crate::explorer::panes::{self, spectrum};
use crate::explorer::prompt::Purpose;
use crate::explorer::snapshot::Preview;
use crate::explorer::studies::{Study, ensemble_key, profiles_key};
use asperity_data::Control;
use asperity_scene::discretisation::{Choice, ChoiceError, choose, parse_tolerance};
use asperity_scene::{CheckedScene, Document, Estimate, RunError, estimate};
use asperity_study::Ensemble;
use asperity_study::half_space::SquareLoops;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

/// Largest number of springs for which a demo estimates the error. With more springs, the viewers
/// would have to wait.
const MOST_ESTIMATED: u64 = 1 << 17;

/// Folder to which paths in the scene are relative. It is empty, because the paths in a checked
/// scene are already absolute or relative to the working folder.
const FOLDER: &str = "";

#[derive(Clone, Debug)]
pub struct Choosing {
    pub tolerance: f64,
    pub tried: Option<u64>,
    pub found: Option<Result<Choice, ChoiceError>>,
}

/// Returns the studies (background computations) that the present state needs and that have not
/// ended, in the order in which they are performed.
pub fn studies(app: &mut App) -> Vec<Study> {
    let mut wanted: Vec<Study> = app.tried.as_ref().map(preview).into_iter().collect();
    wanted.extend(target::study(app));
    if let Some(computed) = app.current().map(Arc::clone) {
        let generation = computed.generation;
        if let Some(Choosing { tolerance, .. }) = app.studies.value() {
            wanted.push(choice(generation, Arc::clone(&computed.scene), *tolerance));
        } else {
            let is_long = computed.scene.numerics.points > MOST_ESTIMATED;
            wanted.extend(ensemble(app, is_long));
            let of = Arc::clone(&computed);
            wanted.push(Study::new(
                generation,
                is_long,
                move |_, control: Control<'_, Estimate>| {
                    let folder = Path::new(FOLDER);
                    let known = estimate(&of.scene, folder, &of.outcome, control.stop());
                    known.ok_or("the error cannot be estimated")
                },
            ));
            wanted.extend(measured::study(app));
            wanted.extend(spectrum::measured_adhesion(app, &computed));
            wanted.extend(
                app.view
                    .large
                    .map_or_else(Vec::new, |pane| (panes::row(pane).studies)(app, &computed)),
            );
            wanted.extend(app.view.squares.then(|| squares(app)));
        }
    }
    app.studies.begin(wanted)
}

/// Returns the study that computes the outcome of the scene with the value that the user is typing.
fn preview(document: &Document) -> Study {
    let (text, scene) = (document.text().to_owned(), scene_of(document));
    Study::new(document.text(), false, move |simulation, control| {
        let outcome = simulation.run(&scene, control.stop(), &mut |_, _, _| Ok(()))?;
        Ok::<_, RunError>(Preview { text, outcome })
    })
}

/// Returns the study that computes the random profiles of the scene, whose results the explorer
/// shows in its status line; `None` if the scene has a fixed profile.
fn ensemble(app: &App, is_long: bool) -> Option<Study> {
    let scene = Arc::clone(&app.edit.scene);
    let profiles = app.edit.count_profiles();
    let key = ensemble_key(profiles, &scene);
    let is_random = Ensemble::profiles_of(&scene) > 1;
    is_random.then(|| {
        Study::new(key, is_long, move |simulation, control| {
            Ensemble::of(&scene, &[], profiles, simulation, control)
        })
    })
}

/// Returns the study that computes loops of random square surfaces on an elastic half-space.
fn squares(app: &App) -> Study {
    let (scene, key) = (Arc::clone(&app.edit.scene), profiles_key(&app.edit.scene));
    Study::new(key, true, move |simulation, control| {
        SquareLoops::of(&scene, simulation, control)
    })
}

/// Returns the study that searches for the smallest number of springs with which the error of the
/// scene is below a tolerance.
fn choice(generation: u64, scene: Arc<CheckedScene>, tolerance: f64) -> Study {
    Study::new(generation, false, move |_, mut control| {
        let stop = control.stop();
        let mut report = |points: u64| {
            control.report(Choosing {
                tolerance,
                tried: Some(points),
                found: None,
            });
        };
        let found = choose(&scene, Path::new(FOLDER), tolerance, stop, &mut report);
        Ok::<_, Infallible>(Choosing {
            tolerance,
            tried: None,
            found: Some(found),
        })
    })
}

pub fn type_tolerance(app: &mut App) {
    if app.is_current() {
        app.ask(Purpose::Tolerance, "");
    } else {
        app.set_error(edit::STILL_COMPUTED);
    }
}

/// Begins the search for the number of springs with which the error is below the typed tolerance.
pub fn accept_tolerance(app: &mut App, typed: &str) -> Result<(), String> {
    let tolerance = parse_tolerance(typed)?;
    if !app.is_current() {
        return Err(edit::STILL_COMPUTED.to_owned());
    }
    let choosing = Choosing {
        tolerance,
        tried: None,
        found: None,
    };
    app.studies.set(app.edit.generation, choosing, false);
    app.effects.push(Task::Study);
    Ok(())
}

/// Sets the number of springs of the scene to the number that the search for a tolerance has found.
pub fn found(app: &mut App) {
    if let Some(Choosing {
        found: Some(found), ..
    }) = app.studies.value::<Choosing>().cloned()
    {
        app.studies.forget::<Choosing>();
        app.effects.push(Task::Study);
        match found {
            Ok(choice) => apply(app, &choice),
            Err(error) => app.set_error(error.to_string()),
        }
    }
}

fn apply(app: &mut App, choice: &Choice) {
    let numerics = app.edit.document.scene().numerics;
    let is_unchanged = numerics.points == choice.points && numerics.edges == choice.edges;
    if !is_unchanged {
        let points = choice.points.to_string();
        let edges = choice.edges.name().to_owned();
        let values = [
            ("numerics.points".to_owned(), points),
            ("numerics.edges".to_owned(), edges),
        ];
        edit::apply(app, app.edit.document.set_all(&values));
        if app.is_refused() {
            return;
        }
    }
    // The search has computed finer solutions than the usual estimate of the error. Therefore the
    // errors found by the search are shown instead.
    app.studies
        .set(app.edit.generation, choice.estimate(), true);
    let unchanged = if is_unchanged { "as it is: " } else { "" };
    app.set_done(format!("{unchanged}{}", choice.sentence()));
}
