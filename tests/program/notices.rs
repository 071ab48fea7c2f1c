//! Each claim in the notice of a built-in scene, and the discretisation error of its pull-off
//! force.

use asperity::scene::Regime;
use asperity::scene::discretisation::Target;
use asperity::scene::estimate;
use asperity::scene::instrument::DisplacementCurve;
use asperity::scene::{Document, Roughness, open, presets};
use asperity::scene::{Outcome, Simulation};
use asperity::surface::Form;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::Path;

/// A built-in scene, whose notice contains these parts, so that no test outlives its claim.
fn scene(name: &str, claims: &[&str]) -> Document {
    let document = open(name).unwrap_or_else(|error| panic!("{name}: {error}"));
    let notice = &document.scene().notice;
    assert!(
        claims.iter().all(|claim| notice.contains(claim)),
        "{name}: {notice:?} does not say {claims:?}"
    );
    document
}

fn run(document: &Document) -> Outcome {
    Simulation::default()
        .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap()
}

/// The scene with other values of these fields.
fn with(document: &Document, fields: &[(&str, &str)]) -> Document {
    fields
        .iter()
        .fold(document.clone(), |document, (path, value)| {
            document.set(path, value).unwrap()
        })
}

fn force(outcome: &Outcome) -> f64 {
    outcome.figures.pull_off_force.unwrap()
}

/// Pull-off force of a scene under another force of its first loading stage, N.
fn pressed(document: &Document, load: f64) -> f64 {
    force(&run(&with(
        document,
        &[("loading", &format!("[ToForce({load:e}), ToSeparation]"))],
    )))
}

/// A number with two significant digits, as in notices.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap()
}

/// Dissipated energy in whole picojoules.
fn picojoules(outcome: &Outcome) -> f64 {
    (outcome.figures.dissipated_energy.unwrap() * 1e12).round()
}

#[test]
fn three_regimes_depend_on_the_preload_as_stated() {
    let ideal = scene(
        "ideal-adhesion",
        &["the pull-off force is the same for every preload"],
    );
    let outcome = run(&ideal);
    assert_eq!(outcome.regime, Some(Regime::PressureInsensitive));
    assert_eq!(outcome.first_touch_pull_off_force, Some(force(&outcome)));
    assert!(
        [1e-7, 2e-6, 1e-4, 1e-2]
            .iter()
            .all(|load| pressed(&ideal, *load) == force(&outcome))
    );

    let growth = "to 5, 10 and 20 µN: the pull-off force grows from 2.6 to 17 and 66 µN";
    let sensitive = scene(
        "pressure-sensitive",
        &[growth, "At first touch almost nothing"],
    );
    assert_eq!(
        [5e-6, 1e-5, 2e-5].map(|load| two_digits(pressed(&sensitive, load))),
        [2.6e-6, 1.7e-5, 6.6e-5]
    );
    let outcome = run(&sensitive);
    assert_eq!(outcome.regime, Some(Regime::PressureSensitive));
    assert!(outcome.first_touch_pull_off_force.unwrap() < 1e-3 * force(&outcome));

    let none = "less than 0.1 % of the preload, and a higher preload does not change it";
    let none = scene("non-adhesive", &[none]);
    let outcome = run(&none);
    assert_eq!(outcome.regime, Some(Regime::NonAdhesive));
    assert!(force(&outcome) < 1e-3 * outcome.figures.preload.unwrap());
    assert!(
        [1e-4, 1e-3, 1e-2]
            .iter()
            .all(|load| pressed(&none, *load) == force(&outcome))
    );
}

#[test]
fn two_profiles_differ_in_their_hurst_exponent_alone() {
    let jagged = scene("profile-hurst-025", &["the rms gradient is 1.2"]);
    let smooth = scene(
        "profile-hurst-075",
        &["the rms gradient is 0.086, and the pull-off force is 1.4 times as high"],
    );
    let described = |document: &Document| {
        with(document, &[("title", "\"\""), ("notice", "\"\"")])
            .scene()
            .clone()
    };
    assert_eq!(
        described(&with(&jagged, &[("roughness.hurst", "0.75")])),
        described(&smooth)
    );
    let [jagged, smooth] = [run(&jagged), run(&smooth)];
    let gradient =
        |outcome: &Outcome| two_digits(outcome.governing.amplitude.unwrap().rms_gradient);
    assert_eq!([gradient(&jagged), gradient(&smooth)], [1.2, 0.086]);
    assert_eq!(two_digits(force(&smooth) / force(&jagged)), 1.4);
}

#[test]
fn patches_have_lengths_of_their_own() {
    let outcome = run(&scene(
        "patch-closeup",
        &["each contact patch has a length of its own"],
    ));
    let lengths: BTreeSet<usize> = outcome
        .history
        .contacts
        .iter()
        .map(|patch| patch.springs().len())
        .collect();
    assert!(lengths.len() >= 5, "{lengths:?}");
}

#[test]
fn smooth_bodies_keep_their_pull_off_force() {
    let jkr = 1.5 * PI * 0.05 * 1e-4;
    let claim =
        "the pull-off force (3/2)πγR depends neither on the preload nor on the elastic modulus";
    let sphere = scene("jkr-sphere", &[claim]);
    let softer = force(&run(&with(
        &sphere,
        &[("material.youngs_modulus", "1.0e6")],
    )));
    for found in [
        force(&run(&sphere)),
        pressed(&sphere, 1e-6),
        pressed(&sphere, 2e-4),
        softer,
    ] {
        assert!((found / jkr - 1.0).abs() < 1e-4, "{found}");
    }

    let claim = "A flat punch detaches as a whole, at the force √(8πa³E*γ), after any preload";
    let punch = scene("kendall-punch", &[claim]);
    let outcome = run(&punch);
    let exact = (8.0 * PI * 2e-5_f64.powi(3) * outcome.governing.modulus * 0.05).sqrt();
    for found in [
        force(&outcome),
        pressed(&punch, 1e-6),
        pressed(&punch, 1e-3),
    ] {
        assert!((found / exact - 1.0).abs() < 1e-3, "{found}");
    }
    let unloading = &outcome.history.stages.last().unwrap().curve;
    let springs: BTreeSet<u64> = unloading.iter().map(|point| point.springs).collect();
    assert!(
        springs.len() == 2 && unloading.iter().all(|point| point.patches <= 1),
        "all springs or none: {springs:?}"
    );

    let opening = "Opening takes ten times the work that closing gives back";
    let loop_of =
        "the pull-off force stays (3/2)πγR, and the loop dissipates 16 pJ instead of 12 pJ";
    let two = scene("two-works", &[opening, loop_of]);
    let adhesion = two.scene().adhesion.unwrap();
    assert!((adhesion.work().unwrap() / adhesion.closing_work().unwrap() - 10.0).abs() < 1e-12);
    let outcomes = [
        run(&two),
        run(&with(&two, &[("adhesion.closing_work", "None")])),
    ];
    assert!(
        outcomes
            .iter()
            .all(|outcome| (force(outcome) / jkr - 1.0).abs() < 1e-4)
    );
    assert_eq!(
        [picojoules(&outcomes[0]), picojoules(&outcomes[1])],
        [16.0, 12.0]
    );
}

#[test]
fn probes_with_a_flank_or_a_second_contact_differ_from_a_sphere() {
    let claim =
        "the pull-off force is 532 pN, 2.8 times that of a sphere with the radius of the apex";
    let tip = scene(
        "rounded-cone",
        &["The flank of this tip adheres as well", claim],
    );
    let sphere = with(&tip, &[("form", "Paraboloid(radius: 2.0e-7)")]);
    let forces = [force(&run(&tip)), force(&run(&sphere))];
    assert_eq!((1e12 * forces[0]).round(), 532.0);
    assert_eq!((10.0 * forces[0] / forces[1]).round(), 28.0);

    let claim = "the force jumps four times, where a single sphere jumps twice";
    let probe = scene("two-spheres", &[claim]);
    let sphere = with(&probe, &[("form", "Paraboloid(radius: 5.4e-6)")]);
    assert_eq!([jumps(&probe), jumps(&sphere)], [4, 2]);
}

/// Returns how often the force of a scene with an instrument jumps by more than 5 % of the pull-off
/// force while the drive does not move.
fn jumps(scene: &Document) -> usize {
    let outcome = run(scene);
    let stiffness = scene.scene().loading_stiffness.unwrap();
    let pull_off = force(&outcome);
    let mut count = 0;
    for stage in &outcome.history.stages {
        let curve = DisplacementCurve::new(stage.direction, &stage.curve, stiffness);
        for ends in curve.jumps() {
            let change = (ends[1].force - ends[0].force).abs();
            count += usize::from(change > 0.05 * pull_off);
        }
    }
    count
}

#[test]
fn roughness_weakens_a_sphere_and_waves_strengthen_it() {
    let rough = scene(
        "rough-sphere",
        &["from 236 to 89 µN, and to 47 µN after a preload of only 10 µN"],
    );
    let smooth = with(&rough, &[("roughness", "None")]);
    let forces = [
        pressed(&smooth, 1e-4),
        pressed(&smooth, 1e-5),
        force(&run(&rough)),
        pressed(&rough, 1e-5),
    ];
    assert_eq!(
        forces.map(|force| (1e6 * force).round()),
        [236.0, 236.0, 89.0, 47.0]
    );

    let claim = "with waves of 80 nm the pull-off force is 1.17 times that of the smooth sphere, and the loop dissipates 11 pJ more";
    let waves = scene("wavy-sphere", &[claim]);
    let [wavy, smooth] = [
        run(&waves),
        run(&with(&waves, &[("form", "Paraboloid(radius: 1.0e-3)")])),
    ];
    assert_eq!((100.0 * force(&wavy) / force(&smooth)).round(), 117.0);
    assert_eq!(picojoules(&wavy) - picojoules(&smooth), 11.0);
    assert!(matches!(
        waves.scene().form,
        Some(Form::WavySphere {
            amplitude: 8e-8,
            ..
        })
    ));
}

#[test]
fn adhesion_at_zero_force_ends_at_an_elastic_energy() {
    let keeps = "keeps 58 % of F_a,max; at e_el/γ = 2.5 it keeps 0.17 %";
    let below = scene(
        "elastic-energy-below",
        &["would take twice the work of adhesion, e_el/γ = 2", keeps],
    );
    let keeps = "keeps 0.17 % of the ideal pull-off force instead of 58 %";
    let above = scene(
        "elastic-energy-above",
        &["at e_el/γ = 2.5 instead of 2", keeps],
    );
    let changed = with(&below, &[("adhesion.elastic_energy_ratio", "2.5")]);
    assert_eq!(changed.scene().roughness, above.scene().roughness);
    assert_eq!(changed.scene().adhesion, above.scene().adhesion);
    for (document, ratio, share) in [(below, 2.0, 58.0), (above, 2.5, 0.17)] {
        let outcome = run(&document);
        let energies = outcome.governing.elastic_energy().unwrap()
            / outcome.governing.work_of_adhesion.unwrap();
        assert!((energies / ratio - 1.0).abs() < 1e-12, "{energies}");
        assert_eq!(
            two_digits(100.0 * force(&outcome) / outcome.ideal_pull_off_force.unwrap()),
            share
        );
    }
}

#[test]
fn a_million_springs_have_a_shortest_wave_of_four() {
    let document = scene(
        "million-springs",
        &["2²⁰ springs and a shortest wave of four springs"],
    );
    let Some(Roughness::SelfAffine {
        modes: Some(modes), ..
    }) = document.scene().roughness
    else {
        panic!("no waves")
    };
    assert_eq!(
        (document.scene().numerics.points, modes.1),
        (1 << 20, 1 << 18)
    );
}

#[test]
fn pull_off_forces_are_within_one_per_cent() {
    for preset in presets() {
        let document = scene(preset.name, &[]);
        let outcome = run(&document);
        let estimate = estimate(document.scene(), Path::new(""), &outcome, &|| false);
        let estimate = estimate.unwrap_or_else(|| panic!("{}: no estimate", preset.name));
        let pulls = outcome.figures.pull_off_force.is_some();
        assert_eq!(
            estimate.target == Target::PullOffForce,
            pulls,
            "{}",
            preset.name
        );
        assert!(
            estimate.error <= 0.01,
            "{}: {}",
            preset.name,
            estimate.error
        );
    }
}

/// The probe of two spheres is no body of revolution, and its error of the model says why there is
/// none.
#[test]
fn two_spheres_have_a_model_error_of_their_own() {
    let text = super::program::text(&["run", "two-spheres"]);
    assert!(text.contains("none for spheres"), "{text}");
    assert!(!text.contains("bodies of revolution"), "{text}");
}
