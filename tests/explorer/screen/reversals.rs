//! First-order reversal curves beside the force curve.

use super::common::driver::Driver;
use super::common::scenes::{changed, rough};
use asperity::analysis::ReversalMap;
use asperity::explorer::action::Action;
use asperity::explorer::app::Pane;
use asperity::explorer::update::studies;
use asperity::scene::Document;
use asperity::simulation::Simulation;

/// The explorer with the Everett function computed, and shown.
pub fn reversed(document: Document) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space O");
    for study in studies(&mut driver.app).into_iter().filter(|study| study.is::<ReversalMap>()) {
        study.perform(&mut Simulation::default(), &|| false, &mut |finding| {
            driver.act(Action::Found(finding));
        });
    }
    driver
}

#[test]
fn one_key_shows_everett_function_density_and_profile() {
    let mut driver = reversed(rough());
    assert!(driver.app.panes().contains(&Pane::Everett), "{}", driver.text());
    // Half of the fall from the preload to the pull-off, but for the step of the map.
    let map: &ReversalMap = driver.app.studies.value().unwrap();
    let last = map.reversals.len() - 1;
    let largest = (0..map.points.len()).filter_map(|point| map.everett(last, point)).fold(0.0, f64::max);
    let figures = driver.outcome().figures;
    let fall = 0.5 * (figures.preload.unwrap() + figures.adhesion_force.unwrap());
    assert!(largest <= fall * (1.0 + 1e-9) && largest > 0.9 * fall, "{largest:e} {fall:e}");
    assert!(driver.text().contains("64 turning points"), "{}", driver.text());
    driver.press("O");
    assert!(
        driver.app.panes().contains(&Pane::Density) && driver.text().contains("ρ ("),
        "{}",
        driver.text()
    );
    driver.press("O");
    assert!(driver.app.panes().contains(&Pane::Profile));
}

#[test]
fn a_scene_that_never_presses_states_the_reason() {
    let driver = reversed(changed(&rough(), &[("loading", "[ToTouch, ToSeparation]")]));
    assert!(driver.text().contains("that presses the bodies together"), "{}", driver.text());
}
