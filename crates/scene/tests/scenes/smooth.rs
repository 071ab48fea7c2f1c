//! F_smooth against runs of the same bodies without roughness.

use asperity_scene::{Document, Outcome, Simulation};

const ROUGHNESS: &str = "SelfAffine(hurst: 0.7, rms_height: 2.0e-8, modes: (2, 64), seed: 3)";

fn run(
    simulation: &mut Simulation,
    form: &str,
    roughness: &str,
    adhesion: &str,
    loading: &str,
) -> Outcome {
    let text = format!(
        "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4, form: {form}, roughness: {roughness}, \
         adhesion: {adhesion}, loading: {loading}, numerics: (points: 2048, samples: 9))"
    );
    let document = Document::parse(&text, "test").unwrap_or_else(|errors| panic!("{errors}"));
    simulation.compute(document.scene()).unwrap()
}

/// Bodies with a closed form and without one: waves, tables, contacts that reach the end of the
/// profile, two works.
#[test]
fn the_smooth_force_is_that_of_a_run_without_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |depth: &dyn Fn(f64) -> f64| {
        let line = |row: u32| {
            let r = 5e-5 * (f64::from(row) / 200.0).powi(2);
            format!("{r:e}, {:e}\n", depth(r))
        };
        (0..=200).map(line).collect::<String>()
    };
    std::fs::write(folder.path().join("sphere.csv"), rows(&|r| r * r / 2e-4)).unwrap();
    std::fs::write(folder.path().join("blunt.csv"), rows(&|r| 1e8 * r.powi(3))).unwrap();
    let mut simulation = Simulation::new(folder.path().to_owned());
    let mut without = Simulation::new(folder.path().to_owned());
    let pressed = "[ToForce(1.0e-3), ToSeparation]";
    let gently = "[ToForce(2.0e-6), ToSeparation]";
    for (form, adhesion, loading, error) in [
        ("None", "(work: 0.05)", pressed, 1e-12),
        (
            "Some(Paraboloid(radius: 1.0e-4))",
            "(work: 0.05)",
            pressed,
            1e-5,
        ),
        (
            "Some(Paraboloid(radius: 1.0e-4))",
            "(work: 0.05)",
            "[ToZeroForce, ToSeparation]",
            1e-5,
        ),
        ("Some(Cone(angle: 0.2))", "(work: 0.05)", pressed, 1e-5),
        ("Some(Punch(radius: 2.5e-5))", "(work: 0.05)", pressed, 1e-9),
        // The contact at pull-off would be longer than the profile.
        (
            "Some(Paraboloid(radius: 1.0e-2))",
            "(work: 0.05)",
            pressed,
            0.0,
        ),
        (
            "Some(Cone(angle: 0.003443384566175278))",
            "(work: 0.000289)",
            pressed,
            0.0,
        ),
        (
            "Some(Power(coefficient: 1.0e6, exponent: 3.0))",
            "(work: 0.05)",
            pressed,
            0.0,
        ),
        // With waves the force depends on the preload.
        (
            "Some(WavySphere(radius: 1.75e-4, amplitude: 2.85e-8, wavelength: 1.0e-5))",
            "(work: 6.98e-5)",
            pressed,
            0.0,
        ),
        (
            "Some(WavySphere(radius: 1.75e-4, amplitude: 2.85e-7, wavelength: 1.0e-5))",
            "(work: 1.0e-3)",
            gently,
            0.0,
        ),
        (
            "Some(Table(file: \"sphere.csv\"))",
            "(work: 0.05)",
            pressed,
            0.0,
        ),
        (
            "Some(Table(file: \"blunt.csv\"))",
            "(work: 0.05)",
            gently,
            0.0,
        ),
        // A preload that does not press the closing contact beyond that of the pull-off.
        (
            "Some(Paraboloid(radius: 1.0e-4))",
            "(work: 0.05, closing_work: 0.0)",
            gently,
            0.0,
        ),
        (
            "Some(Paraboloid(radius: 1.0e-4))",
            "(work: 0.05, closing_work: 0.01)",
            pressed,
            1e-5,
        ),
    ] {
        let rough = run(
            &mut simulation,
            form,
            &format!("Some({ROUGHNESS})"),
            adhesion,
            loading,
        );
        let smooth = run(&mut without, form, "None", adhesion, loading);
        let expected = smooth.figures.pull_off_force.unwrap();
        for found in [&rough, &smooth].map(|outcome| outcome.smooth_pull_off_force.unwrap()) {
            let share = found / expected;
            assert!(
                (share - 1.0).abs() <= error,
                "{form} {adhesion} {loading}: {found} {expected}"
            );
        }
        // From run to run.
        let again = run(
            &mut simulation,
            form,
            &format!("Some({ROUGHNESS})"),
            adhesion,
            loading,
        );
        assert_eq!(again.smooth_pull_off_force, rough.smooth_pull_off_force);
    }
    // A smooth body that is not pulled off has the force all the same, and no adhesion none.
    let form = "Some(WavySphere(radius: 1.75e-4, amplitude: 2.85e-8, wavelength: 1.0e-5))";
    let held = run(
        &mut without,
        form,
        "None",
        "(work: 0.01)",
        "[ToForce(1.0e-3), ToForce(1.0e-4)]",
    );
    let pulled = run(&mut without, form, "None", "(work: 0.01)", pressed);
    assert_eq!(
        (held.figures.pull_off_force, held.smooth_pull_off_force),
        (None, pulled.figures.pull_off_force)
    );
    assert_eq!(
        run(&mut without, form, "None", "(work: 0.0)", pressed).smooth_pull_off_force,
        None
    );
}
