//! Kept, copied and shared results equal those computed alone.

use super::*;
use asperity::analysis::Figures;
use asperity::contact::{Stepwise, Work};
use asperity::scene::{Document, Scene};
use asperity::simulation::{Outcome, Simulation, Timings};

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn a_leg_shows_its_contact_after_the_body_has_gone_on(
        body in body(),
        turns in indentations(5),
        kind in 0..3,
        probes in prop::collection::vec(-1.0..1.5_f64, 8),
    ) {
        let contact = body.contact();
        let stop = || false;
        let mut solver: Box<dyn Solver> = match kind {
            0 => Box::new(body.on(3)),
            1 => Box::new(nonadhesive(&body.gaps, Edges::Grid, body.foundation, 3)),
            _ => Box::new(Stepwise::new(&contact, 0.05, 3, &stop).unwrap()),
        };
        let fly = [Move::ToSeparation, Move::ToIndentation(-0.5)];
        let seen = |leg: &asperity::contact::Leg| probes.iter().map(|&probe| leg.patches(probe)).collect::<Vec<_>>();
        let mut kept = Vec::new();
        for target in to_indentations(&turns).into_iter().chain(fly) {
            solver.advance(target).unwrap();
            kept.push((solver.leg(), seen(&solver.leg())));
        }
        for (leg, expected) in &kept {
            prop_assert_eq!(&seen(leg), expected);
        }
    }
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn a_contact_that_is_formed_again_is_what_it_was(
        body in body(), legs in formed::loadings(), samples in 2_usize..40,
    ) {
        formed::as_if_new(|| body.on(samples), &legs, body.force_scale())?;
    }
}

const SCENE: &str = r#"(
    version: 1,
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 400), seed: 1),
    adhesion: (kappa: 2.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 40000, solver: Exact, edges: Grid, samples: 64),
    observe: [Fragments, HeightHistogram],
)"#;

fn scene(overrides: &[(&str, &str)]) -> Scene {
    let overrides: Vec<_> =
        overrides.iter().map(|&(path, value)| (path.to_string(), value.to_string())).collect();
    Document::parse(SCENE, "scene").unwrap().set_all(&overrides).unwrap().scene().clone()
}

fn outcome(simulation: &mut Simulation, scene: &Scene) -> Outcome {
    let outcome = simulation.run(scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
    Outcome { timings: Timings::default(), ..outcome }
}

#[test]
fn what_a_simulation_keeps_changes_no_bit() {
    let mut kept = Simulation::default();
    let twenty = ("adhesion.kappa", "20.0");
    let edits: [&[(&str, &str)]; 16] = [
        &[],
        &[twenty],
        &[twenty, ("loading", "[ToForce(1.0e-5), ToZeroForce, ToForce(3.0e-5), ToSeparation]")],
        &[("material.youngs_modulus", "1.0e6")],
        &[("roughness.seed", "2")],
        &[("roughness.seed", "3"), twenty],
        &[("roughness.modes", "(1, 20000)")],
        &[("roughness.modes", "(1, 20000)"), ("roughness.seed", "2"), twenty],
        &[("roughness.hurst", "0.9"), ("roughness.rms_height", "1.0e-7")],
        &[("adhesion", "None")],
        &[("form", "Punch(radius: 2.0e-5)")],
        &[("form", "Paraboloid(radius: 1.0e-3)"), ("adhesion", "(work: 0.01)")],
        &[("roughness", "None"), ("form", "Paraboloid(radius: 1.0e-4)"), ("adhesion", "(work: 0.05)")],
        &[("numerics.points", "1000")],
        &[("loading", "[ToIndentation(-1.0e-8), ToIndentation(-1.0e-7)]")],
        &[],
    ];
    for edit in edits {
        let scene = scene(edit);
        let found = outcome(&mut kept, &scene);
        let mut expected = outcome(&mut Simulation::default(), &scene);
        // Kept results are not computed again.
        let Work { random_phases, transforms, heights_binned, .. } = found.history.work;
        assert!([0, expected.history.work.random_phases].contains(&random_phases), "{edit:?}");
        expected.history.work = Work { random_phases, transforms, heights_binned, ..expected.history.work };
        assert_eq!(found, expected, "{edit:?}");

        let mut touch = scene.clone();
        touch.loading = vec![Move::ToTouch, Move::ToSeparation];
        let touch = outcome(&mut Simulation::default(), &touch);
        assert_eq!(found.zero_load_adhesion_force, touch.zero_load_adhesion_force, "{edit:?}");
        assert_eq!(touch.zero_load_adhesion_force.is_some(), scene.adhesion.is_some());
    }
}

#[test]
fn what_was_made_for_one_scene_is_made_once() {
    let mut simulation = Simulation::default();
    let work = |simulation: &mut Simulation, overrides: &[(&str, &str)]| {
        let work = outcome(simulation, &scene(overrides)).history.work;
        (work.random_phases, work.transforms, work.heights_binned)
    };
    let unobserved = [("observe", "[]")];
    assert_eq!(work(&mut simulation, &unobserved), (400, 1, 0));
    assert_eq!(work(&mut simulation, &[]), (0, 0, 40_000));
    assert_eq!(work(&mut simulation, &[("adhesion.kappa", "3.0")]), (0, 0, 0));
    assert_eq!(work(&mut simulation, &unobserved), (0, 0, 0));
    assert_eq!(work(&mut simulation, &[]), (0, 0, 0));
    assert_eq!(work(&mut simulation, &[("roughness.rms_height", "1.0e-7")]), (0, 0, 40_000));
    assert_eq!(work(&mut simulation, &[("roughness.seed", "2")]), (400, 1, 40_000));
}

#[test]
fn a_leg_kept_by_a_caller_stays_as_it_is() {
    let mut simulation = Simulation::default();
    let mut kept = Vec::new();
    let mut keep = |_, _: &LegRecord, leg: &asperity::contact::Leg| {
        kept.push((leg.clone(), leg.thresholds()));
        Ok(())
    };
    for edit in [
        ("adhesion.kappa", "3.0"),
        ("roughness.seed", "2"),
        ("adhesion", "None"),
        ("numerics.edges", "SubCell"),
    ] {
        simulation.run(&scene(&[edit]), &|| false, &mut keep).unwrap();
    }
    assert_eq!(kept.len(), 8);
    kept.iter().for_each(|(leg, thresholds)| assert_eq!(&leg.thresholds(), thresholds));
}

#[test]
fn a_run_asked_to_stop_stops_beside_other_threads_and_leaves_all_fit_for_the_next() {
    let scene = scene(&[]);
    let expected = outcome(&mut Simulation::default(), &scene);
    let mut simulation = Simulation::default();
    for allowed in 0.. {
        let asked = std::cell::Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) >= allowed;
        match simulation.run(&scene, &stop, &mut |_, _, _| Ok(())) {
            Err(error) => assert!(error.is_interruption()),
            Ok(found) => {
                assert!(allowed > 2);
                assert_eq!(found.history.legs, expected.history.legs);
                assert_eq!(found.zero_load_adhesion_force, expected.zero_load_adhesion_force);
                assert_eq!(found.histogram, expected.histogram);
                return;
            }
        }
    }
}

#[test]
fn figures_of_first_touch_are_those_of_its_protocol() {
    let touch = scene(&[("loading", "[ToTouch, ToSeparation]")]);
    assert!(Figures::is_touch_protocol(&touch));
    let outcome = outcome(&mut Simulation::default(), &touch);
    assert_eq!(outcome.zero_load_adhesion_force, outcome.figures.adhesion_force);
    assert_eq!(outcome.history.work.zero_load_passes, 0);
}
