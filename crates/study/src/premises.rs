//! Premises of the model that a scene does not meet, either in its own loading or in unloadings
//! from several turning points.

use super::error::StudyError;
use super::missing_profiles::Failures;
use super::quantity::Quantity;
use super::results::Results;
use asperity_data::{Control, CountedWarning, Warning};
use asperity_scene::theory::ReversalMap;
use asperity_scene::{CheckedScene, RunError, Simulation};

/// Returns the premises of the model that random profiles of a scene do not meet, each with the
/// number of profiles that do not meet it. The scene is computed on `profiles` random profiles. If
/// it cannot be computed on any of them, only those premises are checked that depend on the fields
/// of the scene alone. `control` receives the number of computed profiles.
///
/// # Errors
/// Returns an error if several profiles are requested and the profile of the scene is fixed, if the
/// memory does not suffice, or if `control` stops the computation.
///
/// ```
/// use asperity_data::Control;
/// use asperity_scene::Simulation;
/// use asperity_study::trust::warnings_on_profiles;
///
/// let narrow = asperity_scene::open("jkr-sphere")?.set("length", "20 µm")?;
/// let simulation = &mut Simulation::default();
/// let warnings = warnings_on_profiles(narrow.scene(), 1, simulation, Control::default())?;
/// assert_eq!(warnings[0].warning.name(), "contact_at_ends");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn warnings_on_profiles(
    scene: &CheckedScene,
    profiles: u64,
    simulation: &mut Simulation,
    mut control: Control<'_>,
) -> Result<Vec<CountedWarning>, StudyError> {
    let mut results = Results::begin(scene, &[Quantity::Warnings], profiles, None)?;
    let missing = results.missing(Failures::Keep);
    let threads = control.threads();
    let stop = control.stop();
    let mut computed = 0;
    missing.solve(simulation, threads, stop, &mut |solved| {
        results.take_in(solved);
        computed += 1;
        control.report(computed);
    })?;
    if results.failure_of(0).is_none() {
        return Ok(results.warnings(0));
    }
    let mut counted = Vec::new();
    for warning in scene.warnings() {
        counted.push(CountedWarning { warning, profiles });
    }
    Ok(counted)
}

/// Returns the premises of the model that a scene does not meet on its own profile, either in its
/// own loading or in the deepest unloading of `map`. `map` has the unloadings of the scene from
/// many turning points, and the deepest unloading begins at the largest indentation.
///
/// # Errors
/// Returns an error if the profile of the scene cannot be made.
pub fn warnings_of_reversals(
    map: &ReversalMap,
    scene: &CheckedScene,
    simulation: &mut Simulation,
) -> Result<Vec<Warning>, RunError> {
    let mut warnings = Vec::new();
    if let Some(deepest) = map.reversals.last() {
        warnings = deepest.warnings(&simulation.profile(scene)?);
    }
    warnings.extend(simulation.warnings(scene)?);
    Ok(warnings)
}
