//! Premises of the model that random profiles with the found parameters do not meet.

use super::computed::{Specimen, Workers, seed_of};
use super::result::EnsembleFit;
use super::table::Place;
use asperity_contact::Move;
use asperity_data::CountedWarning;
use asperity_scene::{Adhesion, CheckedScene, Material, Strength};

/// Returns the premises of the model that some random profiles do not meet, each with the number of
/// these profiles. A few profiles are computed with the parameters of `place`, up to a preload in
/// N. If no profile can be computed, the result has only the premises that can be checked with the
/// fields of the scene.
pub(super) fn warnings_at(
    workers: &Workers<'_>,
    place: Place,
    preload: f64,
) -> Vec<CountedWarning> {
    let mut simulation = workers.simulation.another();
    let mut warnings = Vec::new();
    let mut computed = 0;
    for number in 0..EnsembleFit::EXAMINED {
        let profile = profile_at(&workers.specimen, place, preload, number);
        let outcome = profile.and_then(|scene| simulation.compute(&scene).ok());
        let Some(outcome) = outcome else {
            continue;
        };
        computed += 1;
        for warning in &outcome.warnings {
            CountedWarning::count(&mut warnings, warning);
        }
    }
    if computed == 0 {
        for warning in workers.specimen.scene.warnings() {
            let profiles = EnsembleFit::EXAMINED;
            warnings.push(CountedWarning { warning, profiles });
        }
    }
    warnings
}

/// Returns the scene of a random profile with the parameters of a place, loaded to a preload in N;
/// `None` if the scene does not allow these values.
fn profile_at(
    specimen: &Specimen<'_>,
    place: Place,
    preload: f64,
    number: u64,
) -> Option<CheckedScene> {
    let [work, modulus] = place.parameters().map(f64::exp);
    let has_closing_work = specimen.closing != 1.0;
    let strength = Strength::Work {
        opening: work,
        closing: has_closing_work.then_some(specimen.closing * work),
    };
    let scene = specimen.scene.with(|scene| {
        scene.material = Material::effective(modulus);
        scene.adhesion = scene.adhesion.map(|adhesion| Adhesion {
            strength,
            ..adhesion
        });
        scene.loading = vec![Move::ToForce(preload), Move::ToSeparation];
        scene.set_seed(seed_of(specimen.scene, number));
    });
    scene.ok()
}
