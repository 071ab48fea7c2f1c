//! Scenes through the library: what a simulation keeps changes no bit, counted work, and finer
//! grids of one profile.

use asperity_contact::{Move, Work};
use asperity_scene::workload::Timings;
use asperity_scene::{CheckedScene, Document, Outcome, Simulation};

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
    document
        .set_all(&overrides.iter().map(owned).collect::<Vec<_>>())
        .unwrap()
}

fn scene(overrides: Overrides) -> CheckedScene {
    with(&Document::parse(SCENE, "scene").unwrap(), overrides)
        .scene()
        .clone()
}

fn outcome(simulation: &mut Simulation, scene: &CheckedScene) -> Outcome {
    let outcome = simulation.compute(scene).unwrap();
    let mut outcome = outcome;
    outcome.timings = Timings::default();
    outcome
}

fn work(overrides: Overrides) -> Work {
    outcome(&mut Simulation::default(), &scene(overrides))
        .history
        .work
}

const KAPPA: (&str, &str) = ("adhesion.kappa", "20.0");
const OBSERVED: (&str, &str) = ("observe", "[Patches, HeightHistogram]");
const STEPS: (&str, &str) = ("numerics.solver", "Stepwise(step: 2.0e-9)");
const BARE: (&str, &str) = ("adhesion", "None");

#[test]
fn kept_stages_do_not_change_results() {
    let mut kept = Simulation::default();
    let edits: [Overrides; 16] = [
        &[],
        &[KAPPA],
        &[
            KAPPA,
            (
                "loading",
                "[ToForce(1.0e-5), ToZeroForce, ToForce(3.0e-5), ToSeparation]",
            ),
        ],
        &[("material.youngs_modulus", "1.0e6")],
        &[("roughness.seed", "2")],
        &[("roughness.seed", "3"), KAPPA],
        &[("roughness.modes", "(1, 500)")],
        &[
            ("roughness.modes", "(1, 500)"),
            ("roughness.seed", "2"),
            KAPPA,
        ],
        &[
            ("roughness.hurst", "0.9"),
            ("roughness.rms_height", "1.0e-7"),
        ],
        &[BARE],
        &[("form", "Punch(radius: 2.0e-5)")],
        &[
            ("form", "Paraboloid(radius: 1.0e-3)"),
            ("adhesion", "(work: 0.01)"),
            ("numerics.edges", "SubCell"),
        ],
        &[
            ("roughness", "None"),
            ("form", "Paraboloid(radius: 1.0e-4)"),
            ("adhesion", "(work: 0.05)"),
        ],
        &[("numerics.points", "40000")],
        &[(
            "loading",
            "[ToIndentation(-1.0e-8), ToIndentation(-1.0e-7)]",
        )],
        &[],
    ];
    for edit in edits {
        let scene = scene(&[edit, &[OBSERVED]].concat());
        let found = outcome(&mut kept, &scene);
        let mut expected = outcome(&mut Simulation::default(), &scene);
        // Kept results are not computed again.
        let Work {
            random_phases,
            transforms,
            heights_binned,
            ..
        } = found.history.work;
        assert!(
            [0, expected.history.work.random_phases].contains(&random_phases),
            "{edit:?}"
        );
        let work = &mut expected.history.work;
        (work.random_phases, work.transforms, work.heights_binned) =
            (random_phases, transforms, heights_binned);
        assert_eq!(found, expected, "{edit:?}");

        let without_preload = [
            found.first_touch_pull_off_force,
            found.zero_force_pull_off_force,
        ];
        for (force, turn) in without_preload
            .into_iter()
            .zip([Move::ToTouch, Move::ToZeroForce])
        {
            let turned = scene
                .with(|scene| scene.loading = vec![turn, Move::ToSeparation])
                .unwrap();
            let turned = outcome(&mut Simulation::default(), &turned)
                .figures
                .pull_off_force;
            assert_eq!(
                force,
                turned.filter(|_| scene.adhesion.is_some()),
                "{edit:?}, {turn:?}"
            );
        }
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
        (
            &[OBSERVED, ("roughness.rms_height", "1.0e-7")],
            (0, 0, 1024),
        ),
        (&[OBSERVED, ("roughness.seed", "2")], (64, 1, 1024)),
    ];
    for (overrides, expected) in steps {
        let work = outcome(&mut simulation, &scene(overrides)).history.work;
        assert_eq!(
            (work.random_phases, work.transforms, work.heights_binned),
            expected,
            "{overrides:?}"
        );
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
                assert_eq!(found.history.stages, expected.history.stages);
                assert_eq!(
                    found.first_touch_pull_off_force,
                    expected.first_touch_pull_off_force
                );
                assert_eq!(found.histogram, expected.histogram);
                return;
            }
        }
    }
}

#[test]
fn work_counts_match_the_snapshot() {
    let smooth: Overrides = &[
        ("roughness", "None"),
        ("form", "Paraboloid(radius: 1.0e-4)"),
        ("adhesion", "(work: 0.05)"),
    ];
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
    // The counts that are not zero.
    let counted = |(name, overrides): (&str, Overrides)| {
        let counts = serde_json::to_value(work(overrides)).unwrap();
        let counts = counts
            .as_object()
            .unwrap()
            .iter()
            .filter(|(_, count)| **count != 0);
        format!(
            "{name}: {}",
            counts
                .map(|(name, count)| format!("{name} {count}"))
                .collect::<Vec<_>>()
                .join(", ")
        )
    };
    insta::assert_snapshot!(scenes.map(counted).join("\n"));
}
