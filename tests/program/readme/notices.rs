//! Each claim in the notice of a built-in scene, and the discretisation error of its adhesion force.

use asperity::accuracy::{Target, estimate};
use asperity::analysis::Regime;
use asperity::scene::{Document, open, presets};
use asperity::simulation::{Outcome, Simulation};
use std::path::Path;

fn scene(name: &str) -> Document {
    open(name).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn run(document: &Document) -> Outcome {
    Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap()
}

/// A built-in scene with another force of its first loading stage, N.
fn pressed(name: &str, force: f64) -> Outcome {
    run(&scene(name).set("loading", &format!("[ToForce({force:e}), ToSeparation]")).unwrap())
}

fn adhesion_force(outcome: &Outcome) -> f64 {
    outcome.figures.adhesion_force.unwrap()
}

/// Asserts that a notice contains this part, so that no test outlives its claim.
fn assert_says(name: &str, part: &str) {
    let document = scene(name);
    let notice = &document.scene().notice;
    assert!(notice.contains(part), "{name}: {notice:?} does not say {part:?}");
}

/// A number with two significant digits, as in notices.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap()
}

#[test]
fn ideal_adhesion_does_not_depend_on_the_preload() {
    assert_says("ideal-adhesion", "the pull-off force is the same for every preload");
    let outcome = run(&scene("ideal-adhesion"));
    assert_eq!(outcome.regime, Some(Regime::PressureInsensitive));
    assert_eq!(outcome.zero_load_adhesion_force, outcome.figures.adhesion_force);
    for force in [1e-7, 2e-6, 1e-4, 1e-2] {
        assert_eq!(adhesion_force(&pressed("ideal-adhesion", force)), adhesion_force(&outcome), "{force}");
    }
}

#[test]
fn pressure_sensitive_adhesion_grows_with_the_preload() {
    let name = "pressure-sensitive";
    assert_says(name, "to 5, 10 and 20 µN: the pull-off force grows from 2.6 to 17 and 66 µN");
    for (preload, force) in [(5e-6, 2.6e-6), (1e-5, 1.7e-5), (2e-5, 6.6e-5)] {
        assert_eq!(two_digits(adhesion_force(&pressed(name, preload))), force, "{preload}");
    }
    assert_says(name, "At first touch almost nothing sticks");
    let outcome = run(&scene(name));
    assert_eq!(outcome.regime, Some(Regime::PressureSensitive));
    assert!(outcome.zero_load_adhesion_force.unwrap() < 1e-3 * adhesion_force(&outcome));
}

#[test]
fn roughness_prevents_adhesion() {
    let name = "non-adhesive";
    assert_says(name, "less than 0.1 % of the preload, and a higher preload does not change it");
    let outcome = run(&scene(name));
    assert_eq!(outcome.regime, Some(Regime::NonAdhesive));
    assert!(adhesion_force(&outcome) < 1e-3 * outcome.figures.preload.unwrap());
    for force in [1e-4, 1e-3, 1e-2] {
        assert_eq!(adhesion_force(&pressed(name, force)), adhesion_force(&outcome), "{force}");
    }
}

#[test]
fn the_two_profiles_differ_in_their_hurst_exponent_alone() {
    let [jagged, smooth] = ["profile-hurst-025", "profile-hurst-075"];
    let changed = scene(jagged).set("roughness.hurst", "0.75").unwrap();
    let described = |document: &Document| {
        let mut scene = document.scene().clone();
        (scene.title, scene.notice) = Default::default();
        scene
    };
    assert_eq!(described(&changed), described(&scene(smooth)));
    assert_says(jagged, "the rms gradient is 1.2");
    assert_says(smooth, "the rms gradient is 0.086, and the pull-off force is 1.4 times as high");
    let [jagged, smooth] = [jagged, smooth].map(|name| run(&scene(name)));
    let gradient = |outcome: &Outcome| two_digits(outcome.governing.amplitude.unwrap().rms_gradient);
    assert_eq!([gradient(&jagged), gradient(&smooth)], [1.2, 0.086]);
    assert_eq!(two_digits(adhesion_force(&smooth) / adhesion_force(&jagged)), 1.4);
}

#[test]
fn patches_have_lengths_of_their_own() {
    assert_says("fragment-closeup", "each contact patch has a length of its own");
    let outcome = run(&scene("fragment-closeup"));
    let lengths: std::collections::BTreeSet<usize> =
        outcome.history.contacts.iter().map(|patch| patch.springs().len()).collect();
    assert!(lengths.len() >= 5, "{lengths:?}");
}

#[test]
fn the_sphere_keeps_its_pull_off_force() {
    let name = "jkr-sphere";
    assert_says(
        name,
        "the pull-off force (3/2)πγR depends neither on the preload nor on the elastic modulus",
    );
    let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
    let softer = run(&scene(name).set("material.youngs_modulus", "1.0e6").unwrap());
    for outcome in [run(&scene(name)), pressed(name, 1e-6), pressed(name, 2e-4), softer] {
        assert!((adhesion_force(&outcome) / exact - 1.0).abs() < 1e-4);
    }
}

#[test]
fn the_punch_detaches_as_a_whole() {
    let name = "kendall-punch";
    assert_says(name, "A flat punch detaches as a whole, at the force √(8πa³E*γ), after any preload");
    let outcome = run(&scene(name));
    let modulus = outcome.governing.effective_modulus;
    let exact = (8.0 * std::f64::consts::PI * 2e-5_f64.powi(3) * modulus * 0.05).sqrt();
    for outcome in [&outcome, &pressed(name, 1e-6), &pressed(name, 1e-3)] {
        assert!((adhesion_force(outcome) / exact - 1.0).abs() < 1e-3);
        let unloading = &outcome.history.legs.last().unwrap().curve;
        let fragments: Vec<u64> = unloading.iter().map(|point| point.fragments).collect();
        let springs: std::collections::BTreeSet<u64> = unloading.iter().map(|point| point.springs).collect();
        assert!(fragments.iter().all(|&count| count <= 1));
        assert_eq!(springs.len(), 2, "all springs or none: {springs:?}");
    }
}

#[test]
fn roughness_makes_a_sphere_depend_on_its_preload() {
    let name = "rough-sphere";
    assert_says(name, "from 236 to 89 µN, and to 47 µN after a preload of only 10 µN");
    let micronewtons = |outcome: &Outcome| (adhesion_force(outcome) * 1e6).round();
    let smooth = |force: f64| {
        let loading = format!("[ToForce({force:e}), ToSeparation]");
        let smooth = scene(name).set("roughness", "None").unwrap().set("loading", &loading).unwrap();
        micronewtons(&run(&smooth))
    };
    assert_eq!([smooth(1e-4), smooth(1e-5), micronewtons(&run(&scene(name)))], [236.0, 236.0, 89.0]);
    assert_eq!(micronewtons(&pressed(name, 1e-5)), 47.0);
}

/// Dissipated energy in whole picojoules.
fn picojoules(outcome: &Outcome) -> f64 {
    (outcome.figures.dissipated_energy.unwrap() * 1e12).round()
}

#[test]
fn two_works_dissipate_more_at_the_same_pull_off_force() {
    let name = "two-works";
    assert_says(name, "Opening takes ten times the work that closing gives back");
    assert_says(name, "the pull-off force stays (3/2)πγR, and the loop dissipates 16 pJ instead of 12 pJ");
    let adhesion = scene(name).scene().adhesion.unwrap();
    assert!((adhesion.work.unwrap() / adhesion.closing_work.unwrap() - 10.0).abs() < 1e-12);
    let [two, one] = [run(&scene(name)), run(&scene(name).set("adhesion.closing_work", "None").unwrap())];
    let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
    for outcome in [&two, &one] {
        assert!((adhesion_force(outcome) / exact - 1.0).abs() < 1e-4);
    }
    assert_eq!([picojoules(&two), picojoules(&one)], [16.0, 12.0]);
}

#[test]
fn waves_strengthen_a_sphere() {
    let name = "wavy-sphere";
    assert_says(
        name,
        "with waves of 80 nm the pull-off force is 1.17 times that of the smooth sphere, and the loop dissipates 11 pJ more",
    );
    let wavy = scene(name);
    let smooth = run(&wavy.set("form", "Paraboloid(radius: 1.0e-3)").unwrap());
    let outcome = run(&wavy);
    assert_eq!((100.0 * adhesion_force(&outcome) / adhesion_force(&smooth)).round(), 117.0);
    assert_eq!(picojoules(&outcome) - picojoules(&smooth), 11.0);
    let Some(asperity::scene::Form::WavySphere { amplitude, .. }) = wavy.scene().form else {
        panic!("no waves");
    };
    assert_eq!(amplitude, 8e-8);
}

#[test]
fn adhesion_at_zero_force_ends_at_an_elastic_energy() {
    let [below, above] = ["elastic-energy-below", "elastic-energy-above"];
    assert_says(below, "would take twice the work of adhesion, e_el/γ = 2");
    assert_says(below, "keeps 58 % of the ideal adhesion force; at e_el/γ = 2.5 it keeps 0.17 %");
    assert_says(above, "at e_el/γ = 2.5 instead of 2");
    assert_says(above, "keeps 0.17 % of the ideal adhesion force instead of 58 %");
    let changed = scene(below).set("adhesion.elastic_energy_ratio", "2.5").unwrap();
    assert_eq!(changed.scene().roughness, scene(above).scene().roughness);
    assert_eq!(changed.scene().adhesion, scene(above).scene().adhesion);
    for (name, ratio, share) in [(below, 2.0, 58.0), (above, 2.5, 0.17)] {
        let outcome = run(&scene(name));
        let energies =
            outcome.governing.elastic_energy().unwrap() / outcome.governing.work_of_adhesion.unwrap();
        assert!((energies / ratio - 1.0).abs() < 1e-12, "{name}: {energies}");
        let kept = 100.0 * adhesion_force(&outcome) / outcome.ideal_adhesion_force.unwrap();
        assert_eq!(two_digits(kept), share, "{name}: {kept}");
    }
}

#[test]
fn a_million_springs_have_a_shortest_wave_of_four() {
    assert_says("million-springs", "2²⁰ springs and a shortest wave of four springs");
    let document = scene("million-springs");
    let Some(asperity::scene::Roughness::SelfAffine { modes, .. }) = document.scene().roughness else {
        panic!("no self-affine roughness");
    };
    assert_eq!(document.scene().numerics.points, 1 << 20);
    assert_eq!(document.scene().numerics.points / modes.1, 4);
}

#[test]
fn adhesion_forces_are_within_one_per_cent() {
    for preset in presets() {
        let document = scene(preset.name);
        let outcome = run(&document);
        let estimate = estimate(document.scene(), Path::new(""), &outcome, &|| false);
        let estimate = estimate.unwrap_or_else(|| panic!("{}: no estimate", preset.name));
        let pulls = outcome.figures.adhesion_force.is_some();
        assert_eq!(estimate.target == Target::AdhesionForce, pulls, "{}", preset.name);
        assert!(estimate.error <= 0.01, "{}: {}", preset.name, estimate.error);
    }
}
