//! Studies of the present scene: error of its outcome, springs for a tolerance, data of the shown
//! pane, and the curve of a typed value.

use super::{edit, measured, target};
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::editor::scene_of;
use crate::explorer::panes;
use crate::explorer::prompt::Purpose;
use crate::explorer::snapshot::Preview;
use crate::explorer::studies::{Study, ensemble_key};
use asperity_data::parallel::threads;
use asperity_scene::discretisation::{Choice, ChoiceError, choose, parse_tolerance};
use asperity_scene::{CheckedScene, Document, Estimate, estimate};
use asperity_study::Ensemble;
use asperity_study::half_space::SquareLoops;
use std::path::Path;
use std::sync::Arc;

/// Largest number of springs for which a demo estimates the error: above, viewers would have to
/// wait.
const MOST_ESTIMATED: u64 = 1 << 17;

/// Empty: the paths of an explored scene are absolute or relative to the working folder.
const FOLDER: &str = "";

#[derive(Clone, Debug)]
pub struct Choosing {
    pub tolerance: f64,
    pub tried: Option<u64>,
    pub found: Option<Result<Choice, ChoiceError>>,
}

/// The studies that the present state needs and that have not ended, in the order in which they are
/// performed.
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
                move |_, stop, _: &mut dyn FnMut(Estimate)| {
                    let known = estimate(&of.scene, Path::new(FOLDER), &of.outcome, stop);
                    known.ok_or_else(|| "the error cannot be estimated".to_owned())
                },
            ));
            wanted.extend(measured::study(app));
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

/// Computes the outcome of the scene with the value being typed.
fn preview(document: &Document) -> Study {
    let (text, scene) = (document.text().to_owned(), scene_of(document));
    Study::new(document.text(), false, move |simulation, stop, _| {
        let outcome = simulation.run(&scene, stop, &mut |_, _, _| Ok(()));
        Ok(Preview {
            text,
            outcome: outcome.map_err(|error| error.to_string())?,
        })
    })
}

/// Computes the random profiles of the scene, for the headline; `None` for a fixed profile.
fn ensemble(app: &App, is_long: bool) -> Option<Study> {
    let (scene, key) = (Arc::clone(&app.edit.scene), ensemble_key(&app.edit.scene));
    let profiles = Ensemble::profiles_of(&scene);
    (profiles > 1).then(|| {
        Study::new(key, is_long, move |simulation, stop, report| {
            let solver = (std::mem::take(simulation), threads());
            let found = Ensemble::of(&scene, &[], profiles, solver, stop, &mut |_, part| {
                report(part())
            });
            found.map_err(|error| error.to_string())
        })
    })
}

/// Computes loops of random squares in three dimensions.
fn squares(app: &App) -> Study {
    let (scene, key) = (Arc::clone(&app.edit.scene), ensemble_key(&app.edit.scene));
    Study::new(key, true, move |simulation, stop, report| {
        let own = std::mem::take(simulation);
        let found = SquareLoops::of(&scene, own, threads(), stop, &mut |part| {
            report(part.clone())
        });
        found.map_err(|error| error.to_string())
    })
}

/// Searches the smallest number of springs of a scene for a tolerance.
fn choice(generation: u64, scene: Arc<CheckedScene>, tolerance: f64) -> Study {
    Study::new(generation, false, move |_, stop, report| {
        let found = choose(&scene, Path::new(FOLDER), tolerance, stop, &mut |points| {
            report(Choosing {
                tolerance,
                tried: Some(points),
                found: None,
            });
        });
        Ok(Choosing {
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

/// Begins the search of the number of springs that meets a typed tolerance.
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

/// Applies the result of the search to the scene.
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
    // The errors of the choice are known from finer solutions than those of an estimate.
    app.studies
        .set(app.edit.generation, choice.estimate(), true);
    let unchanged = if is_unchanged { "as it is: " } else { "" };
    app.set_done(format!("{unchanged}{}", choice.sentence()));
}
