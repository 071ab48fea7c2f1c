//! Tests of the fit of one work of adhesion to many curves.

use super::precision::NORMAL;
use super::*;
use crate::common::specimens::{curve, document, scene};
use crate::fit::ensemble::computed::seed_of;
use asperity_contact::Move;
use asperity_data::CountedWarning;
use asperity_data::Warning;
use asperity_scene::{Adhesion, Scene};

const OPTIONS: EnsembleOptions = EnsembleOptions {
    profiles: 16,
    is_modulus_free: false,
    height_error: None,
    hurst_error: None,
};

fn found(
    curves: &[(String, MeasuredCurve)],
    scene: &Scene,
    options: EnsembleOptions,
) -> Result<EnsembleFit, ExperimentError> {
    fit_ensemble(
        curves,
        &document(scene),
        &options,
        &Simulation::default(),
        Control::default().on_threads(1),
    )
}

/// Returns curves of rough spheres on 1024 springs. The curve with the number `foreign` has a
/// fifth of the work of adhesion of the others.
fn curves(count: u64, foreign: Option<u64>) -> (Scene, Vec<(String, MeasuredCurve)>) {
    let mut scene = scene("rough-sphere");
    scene.numerics.points = 2048;
    let mut simulation = Simulation::default();
    let one = |seed: u64| {
        let share = if foreign == Some(seed) { 0.2 } else { 1.0 };
        let adhesion = Some(Adhesion::by_work(0.05 * share));
        let scene = Scene {
            adhesion,
            ..scene.clone()
        };
        (
            format!("place {seed}"),
            curve(&mut simulation, &scene, 40 + seed, 0.01),
        )
    };
    let curves = (0..count).map(one).collect();
    (scene, curves)
}

/// The result depends neither on the values in the scene nor on the number of threads. A place
/// with another work of adhesion is named.
#[test]
fn the_work_of_adhesion_is_found_and_a_foreign_place_named() {
    let (scene, all) = curves(12, Some(5));
    let fit = found(
        &all,
        &scene,
        EnsembleOptions {
            profiles: 64,
            ..OPTIONS
        },
    )
    .unwrap();
    let foreign: Vec<&str> = fit
        .curves
        .iter()
        .filter(|curve| curve.foreign)
        .map(|curve| curve.name.as_str())
        .collect();
    assert_eq!(foreign, ["place 5"]);
    let others: Vec<_> = all
        .iter()
        .filter(|(name, _)| name != "place 5")
        .cloned()
        .collect();
    let fit = found(&others, &scene, OPTIONS).unwrap();
    let IntervalEstimate { low, high, .. } = fit.work;
    assert!(
        low < 0.05 && 0.05 < high && high / low < 2.5,
        "{:?}",
        fit.work
    );
    assert!(
        fit.described && !fit.at_end_of_table && fit.preload_scatter.is_none(),
        "{fit:?}"
    );
    assert!(
        (fit.shares.places + fit.shares.profiles - 1.0).abs() < 1e-12
            && fit.shares.roughness == 0.0
    );
    // A larger rms height needs a larger work of adhesion.
    let shifts = fit.roughness.unwrap();
    assert!((0.3..3.0).contains(&shifts.work_by_height), "{shifts:?}");
    let other = Scene {
        adhesion: Some(Adhesion::by_work(0.3)),
        ..scene.clone()
    };
    let three = Control::default().on_threads(3);
    let simulation = Simulation::default();
    let same = fit_ensemble(&others, &document(&other), &OPTIONS, &simulation, three).unwrap();
    assert_eq!(same, fit);
    let stated = EnsembleOptions {
        height_error: Some(0.1),
        hurst_error: Some(0.0),
        ..OPTIONS
    };
    let wider = found(&others, &scene, stated).unwrap();
    let added = NORMAL * 0.1 * shifts.work_by_height;
    assert!((wider.work.half_width() - fit.work.half_width().hypot(added)).abs() < 0.02 * added);
}

/// Curves without adhesion give an upper bound of γ, and no other number that depends on γ.
#[test]
fn curves_without_adhesion_have_an_upper_bound_of_it() {
    let (scene, _) = curves(0, None);
    let bare = Scene {
        adhesion: Some(Adhesion::by_work(1e-8)),
        ..scene.clone()
    };
    let mut simulation = Simulation::default();
    let all: Vec<_> = (0..4)
        .map(|seed| {
            (
                seed.to_string(),
                curve(&mut simulation, &bare, 70 + seed, 0.01),
            )
        })
        .collect();
    let fit = found(
        &all,
        &scene,
        EnsembleOptions {
            profiles: 64,
            ..OPTIONS
        },
    )
    .unwrap();
    let most = fit.work_at_most.unwrap();
    assert!((1e-5..0.03).contains(&most), "{most:e}");
    assert_eq!(
        (fit.work.low, fit.work.high, fit.roughness),
        (0.0, most, None)
    );
    assert!(fit.work.value <= most && fit.prospects.is_empty() && fit.at_end_of_table);
    assert!(
        (fit.shares.places + fit.shares.profiles - 1.0).abs() < 1e-12,
        "{:?}",
        fit.shares
    );
}

/// A warning names a profile that is shorter than the contact.
#[test]
fn a_contact_that_fills_its_profile_is_named() {
    let (scene, all) = curves(2, None);
    let ends = |warning: &&CountedWarning| warning.warning.name() == "contact_at_ends";
    let fit = found(&all, &scene, OPTIONS).unwrap();
    assert_eq!(fit.warnings.iter().find(ends), None);
    let mut short = scene.clone();
    short.length = 2e-5;
    let fit = found(&all, &short, OPTIONS).unwrap();
    let expected = CountedWarning {
        warning: Warning::ContactAtEnds { length: 2e-5 },
        profiles: EnsembleFit::EXAMINED,
    };
    assert_eq!(fit.warnings.iter().find(ends), Some(&expected));
}

/// The warnings are those of the profiles that are computed with the found values.
#[test]
fn the_premises_are_those_of_single_profiles() {
    let (mut scene, all) = curves(2, None);
    scene.numerics.points = 1024;
    let fit = found(&all, &scene, OPTIONS).unwrap();
    let mut names = Vec::new();
    let checked = scene.checked().unwrap();
    for seed in 0..EnsembleFit::EXAMINED {
        let single = checked.with(|scene| {
            scene.adhesion = Some(Adhesion::by_work(fit.work.value));
            scene.loading = vec![Move::ToForce(fit.preload), Move::ToSeparation];
            scene.set_seed(seed_of(&checked, seed));
        });
        let outcome = Simulation::default().compute(&single.unwrap()).unwrap();
        names.extend(outcome.warnings.iter().map(Warning::name));
    }
    assert!(!names.is_empty());
    for counted in &fit.warnings {
        let name = counted.warning.name();
        let profiles = names.iter().filter(|other| **other == name).count();
        assert_eq!(counted.profiles, profiles as u64, "{name}");
        names.retain(|other| *other != name);
    }
    assert_eq!(names, [""; 0]);
}

#[test]
fn curves_that_cannot_be_compared_are_refused() {
    let (scene, all) = curves(2, None);
    let smooth = Scene {
        roughness: None,
        ..scene.clone()
    };
    let turned = all[0].1.segment.partition_point(|segment| *segment == 0);
    let cut = |from: usize, to: usize| {
        let mut curve = all[0].1.clone();
        for values in [&mut curve.displacement, &mut curve.force] {
            *values = values[from..to].to_vec();
        }
        curve.segment = curve.segment[from..to].to_vec();
        vec![("cut".to_owned(), curve)]
    };
    let few = EnsembleOptions {
        profiles: 8,
        ..OPTIONS
    };
    let twice = vec![all[0].clone(), ("again".to_owned(), all[0].1.clone())];
    for (result, said) in [
        (
            found(&all, &smooth, OPTIONS),
            "the profile of the scene is not random",
        ),
        (found(&[], &scene, OPTIONS), "no curve"),
        (found(&all, &scene, few), "8 profiles"),
        (
            found(&twice, &scene, OPTIONS),
            "again: the same curve as place 0",
        ),
        (
            found(&cut(0, turned + 120), &scene, OPTIONS),
            "cut: the retraction ends before contact is lost",
        ),
        (
            found(&cut(turned, 2 * turned), &scene, OPTIONS),
            "cut: no approach and retraction",
        ),
    ] {
        let error = result.unwrap_err().to_string();
        assert!(
            error.contains(said) && error.contains("allowed: "),
            "{said}: {error}"
        );
    }
    let wrong = |error| EnsembleOptions {
        height_error: Some(error),
        ..OPTIONS
    };
    for error in [-0.1, 0.6, f64::NAN, f64::INFINITY] {
        let refused = found(&all, &scene, wrong(error)).unwrap_err().to_string();
        assert!(refused.contains("allowed: from 0 to 0.5"), "{refused}");
    }
    let none = fit_ensemble(
        &all,
        &document(&scene),
        &OPTIONS,
        &Simulation::default(),
        Control::default().on_threads(0),
    );
    assert_eq!(
        none.unwrap_err().to_string(),
        "0 threads; allowed: at least one"
    );
    let stopped = fit_ensemble(
        &all,
        &document(&scene),
        &OPTIONS,
        &Simulation::default(),
        Control::default().stopped_by(&|| true),
    );
    assert!(matches!(stopped, Err(ExperimentError::Run(_))));
}
