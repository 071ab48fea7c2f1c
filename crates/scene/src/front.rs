//! Computation of a scene by one call.

use crate::error::Error;
use crate::scene::document::Document;
use crate::simulation::outcome::Outcome;
use crate::simulation::stages::Simulation;

/// Computes the scene of a document. Names of measured files in the scene are relative to the
/// folder of the scene file.
///
/// # Errors
/// Returns [`Error::Run`], [`Error::Contact`] or [`Error::Values`] if the scene cannot be computed.
///
/// ```
/// let sphere = asperity_scene::open("jkr-sphere")?.set("adhesion.work", "20 mJ/m²")?;
/// let outcome = asperity_scene::run(&sphere)?;
/// assert!(
///     outcome.figures.pull_off_force > Some(9.0e-6)
///         && outcome.figures.pull_off_force < Some(9.6e-6)
/// );
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn run(document: &Document) -> Result<Outcome, Error> {
    Ok(Simulation::new(document.resolve("")).compute(document.scene())?)
}
