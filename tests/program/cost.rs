//! The cost of accuracy, and tolerances. Asserted are structure, errors and orders, never times.

use super::program::{asperity, json};
use serde_json::Value;
use std::f64::consts::PI;

/// Springs and resolved errors of a figure in the rows of a knob.
fn errors(table: &Value, knob: &str, figure: &str) -> Vec<(f64, f64)> {
    let rows = table["rows"].as_array().unwrap().iter().filter(|row| row["knob"] == knob);
    let resolved = rows.filter(|row| row["errors"][figure]["resolved"] == true);
    resolved
        .map(|row| (row["setting"].as_f64().unwrap(), row["errors"][figure]["error"].as_f64().unwrap()))
        .collect()
}

/// Slope of ln(error) over −ln(springs) by least squares, up to 1024 springs; `None` with too few rows.
fn order(errors: &[(f64, f64)]) -> Option<f64> {
    let points: Vec<_> = errors
        .iter()
        .filter(|row| row.0 <= 1024.0)
        .map(|(springs, error)| (-springs.ln(), error.ln()))
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let slope = covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
    (points.len() >= 6).then_some(slope)
}

/// The cost of a scene, with more time where a busy machine has too few rows in less.
fn cost(scene: &str, is_enough: impl Fn(&Value) -> bool) -> Value {
    let table = |budget| {
        let run = asperity(&["cost", scene, "--format", "json", "--budget", budget]);
        (run.code == Some(0)).then(|| serde_json::from_str(&run.stdout).unwrap())
    };
    ["3s", "10s", "60s"].into_iter().filter_map(table).find(is_enough).expect("enough rows within a minute")
}

#[test]
fn a_sphere_is_reached_with_the_orders_of_its_edges() {
    let orders = |table: &Value| -> Option<Vec<[f64; 2]>> {
        let of = |knob, figure| order(&errors(table, knob, figure));
        let figures = ["adhesion_force", "curve", "dissipated_energy"].into_iter();
        figures.map(|figure| Some([of("sub-cell-springs", figure)?, of("grid-springs", figure)?])).collect()
    };
    let table =
        cost("jkr-sphere", |table| orders(table).is_some() && errors(table, "step", "curve").len() >= 4);
    assert_eq!(table["reference"]["closed_form"], true);
    let exact = 1.5 * PI * 0.05 * 1e-4;
    assert!((table["reference"]["adhesion_force"].as_f64().unwrap() / exact - 1.0).abs() < 1e-12);
    for [sub_cell, grid] in orders(&table).unwrap() {
        assert!(
            (1.6..2.5).contains(&sub_cell) && (0.85..1.25).contains(&grid),
            "orders {sub_cell} and {grid}"
        );
    }
    let steps = errors(&table, "step", "curve");
    assert!(steps[steps.len() - 1].1 < steps[0].1 / 10.0, "{steps:?}");
}

#[test]
fn rough_scenes_are_counted_from_their_finest_solution() {
    let table = cost("rough-sphere", |table| table["rows"].as_array().unwrap().len() > 4);
    let (reference, rows) = (&table["reference"], table["rows"].as_array().unwrap());
    let own = reference["errors"]["adhesion_force"].as_f64().unwrap();
    assert!(reference["closed_form"] == false && own > 0.0 && own < 0.01, "{own}");
    // The finest solution has no difference from itself: its stated error is that of the reference.
    let finest = rows.iter().rfind(|row| row["knob"] == "sub-cell-springs").unwrap();
    assert_eq!(finest["setting"].as_f64(), reference["springs"].as_f64());
    assert_eq!(finest["errors"]["adhesion_force"]["resolved"], false);
    assert_eq!(finest["errors"]["adhesion_force"]["error"], reference["errors"]["adhesion_force"]);
    // The fewest springs are twice the last mode.
    assert_eq!((&rows[0]["setting"], table["answer"].as_array().unwrap().len()), (&1024.0.into(), 2));
}

/// Adhesion force, N, of a scene with these overrides.
fn adhesion_force(scene: &str, sets: &[&str]) -> f64 {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", scene, "--format", "json"].into_iter().chain(sets).collect();
    json(&arguments)["adhesion_force"].as_f64().unwrap()
}

const FINEST: [&str; 2] = ["numerics.points=262144", "numerics.edges=SubCell"];

/// An error that changes its sign is small at some load with few springs, and large under other loads.
#[test]
fn tolerances_are_kept_under_half_and_twice_the_load() {
    // As docs/accuracy.md states them.
    for (tolerance, points, edges) in
        [("1e-2", 4096, "Grid"), ("1e-3", 8192, "SubCell"), ("1e-4", 32_768, "SubCell")]
    {
        let run = json(&["run", "pressure-sensitive", "--tolerance", tolerance, "--format", "json"]);
        assert_eq!((&run["choice"]["points"], &run["choice"]["edges"]), (&points.into(), &edges.into()));
        assert_eq!(
            (&run["line"]["points"], &run["scene"]["numerics"]["points"]),
            (&points.into(), &points.into())
        );
        let chosen = [format!("numerics.points={points}"), format!("numerics.edges={edges}")];
        for load in ["5e-6", "1e-5", "2e-5"] {
            let loading = format!("loading=[ToForce({load}), ToSeparation]");
            let force = |numerics: [&str; 2]| {
                adhesion_force("pressure-sensitive", &[&loading, numerics[0], numerics[1]])
            };
            let error = (force([&chosen[0], &chosen[1]]) / force(FINEST) - 1.0).abs();
            assert!(error <= tolerance.parse().unwrap(), "{tolerance}, {load}: {error}");
        }
    }
}

/// F_a jumps from 17 to 66 µN between 13.0 and 13.05 µN.
#[test]
fn a_preload_near_a_step_is_named_and_others_have_a_small_error() {
    for (load, is_near) in [("12e-6", false), ("13e-6", false), ("13.04e-6", true), ("14e-6", false)] {
        let loading = format!("loading=[ToForce({load}), ToSeparation]");
        let run = json(&["run", "pressure-sensitive", "--format", "json", "--set", &loading]);
        let number = |key: &str| run[key].as_f64().unwrap();
        let (force, error) = (number("adhesion_force"), number("adhesion_force_error"));
        let fine = adhesion_force("pressure-sensitive", &[&loading, FINEST[0]]);
        assert_eq!(run["adhesion_force_near_step"], is_near, "{load}");
        let is_small = if is_near { error > 4e-5 } else { error <= 1e-2 * force };
        assert!((force - fine).abs() <= error && is_small, "{load}: {force} {error} for {fine}");
    }
}
