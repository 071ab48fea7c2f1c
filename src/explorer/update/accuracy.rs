//! Studies of the present scene: the error of its outcome, springs for a tolerance, data of the shown pane, and the curve
//! of a typed value.

use super::{Effect, edit};
use crate::accuracy::{Choice, ChoiceError, Estimate, Target, choose, estimate, parse_tolerance};
use crate::explorer::app::{App, Message};
use crate::explorer::editor::scene_of;
use crate::explorer::prompt::Purpose;
use crate::explorer::snapshot::Preview;
use crate::explorer::studies::{Finding, Study};
use crate::scene::{Document, Scene, format_quantity};
use crate::text::grouped;
use std::path::Path;
use std::sync::Arc;

/// Most springs for an estimate in a demo: above, viewers would have to wait.
const MOST_ESTIMATED: u64 = 1 << 17;

/// Files of an explored scene are named by whole paths.
const FOLDER: &str = "";

/// Search of springs for a tolerance.
#[derive(Clone, Debug)]
pub struct Choosing {
    /// The relative error.
    pub tolerance: f64,
    /// Number of springs tried last.
    pub tried: Option<u64>,
    /// Choice, or the reason for none.
    pub found: Option<Result<Choice, ChoiceError>>,
}

/// Answer to the last tolerance, until the next edit.
#[derive(Debug)]
pub struct Answer(pub String);

/// The studies that the present state needs and that have not ended, in the order of their performance.
pub fn studies(app: &mut App) -> Vec<Study> {
    let mut wanted: Vec<Study> = app.tried.as_ref().map(preview).into_iter().collect();
    if let Some(computed) = app.current().map(Arc::clone) {
        let generation = computed.generation;
        if let Some(Choosing { tolerance, .. }) = app.studies.value() {
            wanted.push(choice(generation, Arc::clone(&computed.scene), *tolerance));
        } else {
            let is_long = computed.scene.numerics.points > MOST_ESTIMATED;
            let of = Arc::clone(&computed);
            wanted.push(Study::new(generation, is_long, move |_, stop, _: &mut dyn FnMut(Estimate)| {
                let known = estimate(&of.scene, Path::new(FOLDER), &of.outcome, stop);
                known.ok_or_else(|| "the error cannot be estimated".to_owned())
            }));
            wanted.extend(app.view.large.map_or_else(Vec::new, |pane| (pane.row().studies)(app, &computed)));
        }
    }
    app.studies.begin(wanted)
}

/// Computes the outcome of a scene that is tried.
fn preview(document: &Document) -> Study {
    let (text, scene) = (document.text().to_owned(), scene_of(document));
    Study::new(document.text(), false, move |simulation, stop, _| {
        let outcome = simulation.run(&scene, stop, &mut |_, _, _| Ok(()));
        Ok(Preview { text, outcome: outcome.map_err(|error| error.to_string())? })
    })
}

/// Searches the fewest springs of a scene for a tolerance.
fn choice(generation: u64, scene: Arc<Scene>, tolerance: f64) -> Study {
    Study::new(generation, false, move |_, stop, report| {
        let found = choose(&scene, Path::new(FOLDER), tolerance, stop, &mut |points| {
            report(Choosing { tolerance, tried: Some(points), found: None });
        });
        Ok(Choosing { tolerance, tried: None, found: Some(found) })
    })
}

const NOT_COMPUTED: &str = "not before the scene is computed";

/// Asks for a tolerance.
pub fn type_tolerance(app: &mut App) {
    if app.is_current() {
        app.ask(Purpose::Tolerance, "");
    } else {
        app.set_error(NOT_COMPUTED);
    }
}

/// Searches springs for a typed tolerance.
pub fn accept_tolerance(app: &mut App, typed: &str) -> Result<(), String> {
    let tolerance = parse_tolerance(typed)?;
    if !app.is_current() {
        return Err(NOT_COMPUTED.to_owned());
    }
    app.studies.set(app.edit.generation, Choosing { tolerance, tried: None, found: None }, false);
    app.studies.forget::<Answer>();
    app.effects.push(Effect::Study);
    Ok(())
}

/// Stores a finding; the outcome of a search has further effects.
pub fn found(app: &mut App, finding: Finding) {
    app.studies.take_in(finding);
    if let Some(Choosing { tolerance, found: Some(found), .. }) = app.studies.value::<Choosing>().cloned() {
        app.studies.forget::<Choosing>();
        app.effects.push(Effect::Study);
        match found {
            Ok(choice) => take_over(app, &choice),
            Err(error) => refuse(app, tolerance, &error),
        }
    }
}

/// Makes a choice an edit.
fn take_over(app: &mut App, choice: &Choice) {
    let sentence = choice.sentence();
    let numerics = app.edit.document.scene().numerics;
    let short = format!(
        "{} springs, edges {}: {} within {}",
        grouped(choice.points),
        choice.edges.name(),
        if choice.target == Target::Curve { "curve" } else { "F_a" },
        per_cent(choice.tolerance),
    );
    let is_so = (numerics.points, numerics.edges) == (choice.points, choice.edges);
    if !is_so {
        let points = choice.points.to_string();
        let fields = [("numerics.points", points.as_str()), ("numerics.edges", choice.edges.name())];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        edit::take_over(app, app.edit.document.set_all(&fields));
        if let Some(Message::Refused(why)) = &app.message {
            app.studies.set(app.edit.generation, Answer(why.clone()), true);
            return;
        }
    }
    // From finer solutions than those of an estimate.
    app.studies.set(app.edit.generation, choice.estimate(), true);
    let already = if is_so { "as it is: " } else { "" };
    app.set_done(format!("{already}{short}"));
    app.studies.set(app.edit.generation, Answer(sentence), true);
}

/// States the accuracy within reach instead.
fn refuse(app: &mut App, tolerance: f64, error: &ChoiceError) {
    let sentence = error.to_string();
    let short = match error {
        ChoiceError::Unreached { best: Some(best), .. } => format!(
            "{tolerance:e} is out of reach: {:.1e} with {} springs, edges {}",
            best.error,
            grouped(best.points),
            best.edges.name()
        ),
        ChoiceError::Unreached { best: None, .. } => {
            format!("{tolerance:e} cannot be checked: too few springs")
        }
        ChoiceError::Stepwise => "a tolerance needs numerics.solver: Exact".to_owned(),
        ChoiceError::Run(_) | ChoiceError::Stopped => sentence.clone(),
    };
    app.set_error(short);
    app.studies.set(app.edit.generation, Answer(sentence), true);
}

fn per_cent(share: f64) -> String {
    format!("{} %", format_quantity(100.0 * share, "1"))
}
