//! Scenes through the library: what a simulation keeps changes no bit, counted work, and finer grids of one profile.

use asperity::analysis::Figures;
use asperity::contact::{Move, Work};
use asperity::scene::{Document, Scene, open};
use asperity::simulation::{Outcome, Simulation, Timings};
use asperity::surface::Line;

/// A rough rubber face; each scene of these tests differs from it by its overrides.
const SCENE: &str = r#"(
    version: 1,
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
    adhesion: (kappa: 5.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 1024, solver: Exact, edges: Grid, samples: 64),
)"#;

type Overrides<'a> = &'a [(&'a str, &'a str)];

fn with(document: &Document, overrides: Overrides) -> Document {
    let owned = |&(path, value): &(&str, &str)| (path.to_string(), value.to_string());
    document.set_all(&overrides.iter().map(owned).collect::<Vec<_>>()).unwrap()
}

fn scene(overrides: Overrides) -> Scene {
    with(&Document::parse(SCENE, "scene").unwrap(), overrides).scene().clone()
}

fn outcome(simulation: &mut Simulation, scene: &Scene) -> Outcome {
    let outcome = simulation.run(scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
    Outcome { timings: Timings::default(), ..outcome }
}

fn work(overrides: Overrides) -> Work {
    outcome(&mut Simulation::default(), &scene(overrides)).history.work
}

fn line_of<'a>(simulation: &'a mut Simulation, scene: &Scene) -> &'a Line {
    simulation.make_line(scene).unwrap().0
}

const KAPPA: (&str, &str) = ("adhesion.kappa", "20.0");
const OBSERVED: (&str, &str) = ("observe", "[Fragments, HeightHistogram]");
const STEPS: (&str, &str) = ("numerics.solver", "Stepwise(step: 2.0e-9)");
const BARE: (&str, &str) = ("adhesion", "None");

#[test]
fn kept_stages_do_not_change_results() {
    let mut kept = Simulation::default();
    let edits: [Overrides; 16] = [
        &[],
        &[KAPPA],
        &[KAPPA, ("loading", "[ToForce(1.0e-5), ToZeroForce, ToForce(3.0e-5), ToSeparation]")],
        &[("material.youngs_modulus", "1.0e6")],
        &[("roughness.seed", "2")],
        &[("roughness.seed", "3"), KAPPA],
        &[("roughness.modes", "(1, 500)")],
        &[("roughness.modes", "(1, 500)"), ("roughness.seed", "2"), KAPPA],
        &[("roughness.hurst", "0.9"), ("roughness.rms_height", "1.0e-7")],
        &[BARE],
        &[("form", "Punch(radius: 2.0e-5)")],
        &[
            ("form", "Paraboloid(radius: 1.0e-3)"),
            ("adhesion", "(work: 0.01)"),
            ("numerics.edges", "SubCell"),
        ],
        &[("roughness", "None"), ("form", "Paraboloid(radius: 1.0e-4)"), ("adhesion", "(work: 0.05)")],
        &[("numerics.points", "40000")],
        &[("loading", "[ToIndentation(-1.0e-8), ToIndentation(-1.0e-7)]")],
        &[],
    ];
    for edit in edits {
        let scene = scene(&[edit, &[OBSERVED]].concat());
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
fn stages_are_computed_once_for_equal_inputs() {
    let mut simulation = Simulation::default();
    let steps: [(Overrides, _); 6] = [
        (&[], (64, 1, 0)),
        (&[OBSERVED], (0, 0, 1024)),
        (&[OBSERVED, KAPPA], (0, 0, 0)),
        (&[], (0, 0, 0)),
        (&[OBSERVED, ("roughness.rms_height", "1.0e-7")], (0, 0, 1024)),
        (&[OBSERVED, ("roughness.seed", "2")], (64, 1, 1024)),
    ];
    for (overrides, expected) in steps {
        let work = outcome(&mut simulation, &scene(overrides)).history.work;
        assert_eq!((work.random_phases, work.transforms, work.heights_binned), expected, "{overrides:?}");
    }
}

#[test]
fn an_interrupted_run_does_not_affect_the_next() {
    // So long that a second thread takes part.
    let scene = scene(&[("numerics.points", "40000"), OBSERVED]);
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
fn work_counts_match_the_snapshot() {
    let smooth: Overrides =
        &[("roughness", "None"), ("form", "Paraboloid(radius: 1.0e-4)"), ("adhesion", "(work: 0.05)")];
    let loops = (
        "loading",
        "[ToForce(2.0e-5), ToZeroForce, ToForce(1.0e-5), ToIndentation(1.0e-7), ToTouch, ToForce(3.0e-5), ToSeparation]",
    );
    let scenes: [(&str, Overrides); 8] = [
        ("exact", &[]),
        ("exact, no adhesion", &[BARE]),
        ("exact, loading only", &[("loading", "[ToForce(2.0e-5)]")]),
        ("exact, smooth sphere", smooth),
        ("exact, minor loops", &[loops]),
        ("stepwise", &[STEPS]),
        ("stepwise, no adhesion", &[STEPS, BARE]),
        ("stepwise, minor loops", &[STEPS, loops]),
    ];
    insta::assert_debug_snapshot!(scenes.map(|(name, overrides)| (name, work(overrides))));
}

#[test]
fn refining_the_grid_refines_the_same_line() {
    let preset = open("pressure-sensitive").unwrap();
    let scene = |points: usize| with(&preset, &[("numerics.points", &points.to_string())]).scene().clone();
    let mut simulation = Simulation::default();
    let mut heights =
        |points: usize| -> Vec<f64> { line_of(&mut simulation, &scene(points)).heights().collect() };
    let coarse = heights(2_000);
    let deepest = coarse.iter().fold(0.0_f64, |most, height| most.max(height.abs()));
    for factor in [3, 5, 9] {
        // Each spring of the coarse grid is at the place of one of the finer grid, in the middle of a cell.
        let fine = heights(2_000 * factor);
        for (index, height) in coarse.iter().enumerate() {
            let same = fine[factor * index + factor / 2];
            assert!((same - height).abs() <= 1e-13 * deepest, "{factor}: {height} and {same} at {index}");
        }
    }
    // So the figures converge to one value.
    let mut adhesion_force =
        |points| outcome(&mut simulation, &scene(points)).figures.adhesion_force.unwrap();
    let finest = adhesion_force(2_000 * 729);
    let errors = [1, 9, 81].map(|factor| (adhesion_force(2_000 * factor) / finest - 1.0).abs());
    println!("{errors:?}");
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2] && errors[2] < 5e-3, "{errors:?}");
}

#[test]
fn a_measured_profile_of_waves_gives_the_loop_of_the_form() {
    let form = open("wavy-sphere").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = Simulation::new(folder.path().to_path_buf());
    let line = line_of(&mut simulation, form.scene());
    let row = |(index, height)| format!("{:e},{height:e}\n", line.position(index));
    std::fs::write(folder.path().join("waves.csv"), line.heights().enumerate().map(row).collect::<String>())
        .unwrap();
    let measured = [("form", "None"), ("roughness", "Measured(file: \"waves.csv\", as_line: true)")];
    let [a, b] = [&form, &with(&form, &measured)].map(|document| outcome(&mut simulation, document.scene()));
    let figures = |outcome: &Outcome| {
        let Figures { adhesion_force, pull_off_indentation, dissipated_energy, .. } = outcome.figures;
        [adhesion_force, pull_off_indentation, dissipated_energy].map(Option::unwrap)
    };
    for (a, b) in figures(&a).into_iter().zip(figures(&b)) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a:?} {b:?}");
    }
    let largest = a.figures.preload.unwrap();
    let [a, b] = [&a, &b].map(|outcome| &outcome.history.legs[1].curve);
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(b).all(|(a, b)| (a.force - b.force).abs() < 1e-9 * largest));
}
