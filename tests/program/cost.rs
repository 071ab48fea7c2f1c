//! Tolerances, and the error of a preload near a step.

use super::program::json;

/// Pull-off force, N, of a scene with these overrides.
fn pull_off_force(scene: &str, sets: &[&str]) -> f64 {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", scene, "--format", "json"]
        .into_iter()
        .chain(sets)
        .collect();
    json(&arguments)["pull_off_force"].as_f64().unwrap()
}

const FINEST: [&str; 2] = ["numerics.points=262144", "numerics.edges=SubCell"];

/// An error that changes its sign is small at some load with few springs, and large under other
/// loads.
#[test]
fn tolerances_are_kept_under_half_and_twice_the_load() {
    let loads = ["5e-6", "1e-5", "2e-5"];
    let force = |load: &str, numerics: [&str; 2]| {
        let loading = format!("loading=[ToForce({load}), ToSeparation]");
        pull_off_force("pressure-sensitive", &[&loading, numerics[0], numerics[1]])
    };
    let finest = loads.map(|load| force(load, FINEST));
    // As docs/accuracy.md states them.
    for (tolerance, points, edges) in [
        ("1e-2", 4096, "Grid"),
        ("1e-3", 8192, "SubCell"),
        ("1e-4", 32_768, "SubCell"),
    ] {
        let run = json(&[
            "run",
            "pressure-sensitive",
            "--tolerance",
            tolerance,
            "--format",
            "json",
        ]);
        assert_eq!(
            (&run["choice"]["points"], &run["choice"]["edges"]),
            (&points.into(), &edges.into())
        );
        assert_eq!(
            (
                &run["profile"]["points"],
                &run["scene"]["numerics"]["points"]
            ),
            (&points.into(), &points.into())
        );
        let chosen = [
            format!("numerics.points={points}"),
            format!("numerics.edges={edges}"),
        ];
        for (load, finest) in loads.into_iter().zip(finest) {
            let error = (force(load, [&chosen[0], &chosen[1]]) / finest - 1.0).abs();
            assert!(
                error <= tolerance.parse().unwrap(),
                "{tolerance}, {load}: {error}"
            );
        }
    }
}

/// F_a jumps from 17 to 66 µN between 13.0 and 13.05 µN.
#[test]
fn a_preload_near_a_step_is_named_and_others_have_a_small_error() {
    for (load, is_near) in [
        ("12e-6", false),
        ("13e-6", false),
        ("13.04e-6", true),
        ("14e-6", false),
    ] {
        let loading = format!("loading=[ToForce({load}), ToSeparation]");
        let run = json(&[
            "run",
            "pressure-sensitive",
            "--format",
            "json",
            "--set",
            &loading,
        ]);
        let number = |key: &str| run[key].as_f64().unwrap();
        let (force, error) = (number("pull_off_force"), number("pull_off_force_error"));
        let fine = pull_off_force("pressure-sensitive", &[&loading, FINEST[0]]);
        assert_eq!(run["pull_off_force_near_step"], is_near, "{load}");
        let is_small = if is_near {
            error > 4e-5
        } else {
            error <= 1e-2 * force
        };
        assert!(
            (force - fine).abs() <= error && is_small,
            "{load}: {force} {error} for {fine}"
        );
    }
}
