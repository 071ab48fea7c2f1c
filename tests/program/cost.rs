//! The cost of accuracy, tolerances and many lines, through the program itself. Asserted are structure, errors and
//! orders, never times.

mod estimates;

use super::program::{Finished, asperity, failed, json};
use serde_json::Value;
use std::fs;

fn done(arguments: &[&str]) -> String {
    asperity(arguments).succeeded()
}

/// Springs and resolved errors of a figure in the rows of a knob.
fn errors(table: &Value, knob: &str, figure: &str) -> Vec<(f64, f64)> {
    let rows = table["rows"].as_array().unwrap().iter().filter(|row| row["knob"] == knob);
    let resolved = rows.filter(|row| row["errors"][figure]["resolved"] == true);
    resolved
        .map(|row| (row["setting"].as_f64().unwrap(), row["errors"][figure]["error"].as_f64().unwrap()))
        .collect()
}

/// Slope of ln(error) over −ln(springs) by least squares, up to this number of springs.
fn order(errors: &[(f64, f64)], most: f64) -> f64 {
    let points: Vec<_> = errors
        .iter()
        .filter(|(springs, _)| *springs <= most)
        .map(|(springs, error)| (-springs.ln(), error.ln()))
        .collect();
    assert!(points.len() >= 6, "{errors:?}");
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn a_sphere_is_reached_with_the_orders_of_its_edges() {
    // A busy machine gets no further in the shorter time.
    let has_enough = |table: &Value| {
        let rows = |knob, figure| errors(table, knob, figure).iter().filter(|row| row.0 <= 1024.0).count();
        let springs = ["sub-cell-springs", "grid-springs"];
        springs.iter().all(|knob| rows(knob, "adhesion_force") >= 6 && rows(knob, "dissipated_energy") >= 6)
            && errors(table, "step", "curve").len() >= 4
    };
    let tables = ["8s", "60s"]
        .map(|budget| move || json(&["cost", "jkr-sphere", "--format", "json", "--budget", budget]));
    let table = tables.iter().map(|table| table()).find(has_enough).expect("enough rows within a minute");
    let reference = &table["reference"];
    assert_eq!(reference["closed_form"], true);
    let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
    assert!((reference["adhesion_force"].as_f64().unwrap() / exact - 1.0).abs() < 1e-12);
    for figure in ["adhesion_force", "curve", "dissipated_energy"] {
        let sub_cell = order(&errors(&table, "sub-cell-springs", figure), 1024.0);
        let grid = order(&errors(&table, "grid-springs", figure), 1024.0);
        assert!((1.6..2.5).contains(&sub_cell), "order {sub_cell} of the {figure} with edges SubCell");
        assert!((0.85..1.25).contains(&grid), "order {grid} of the {figure} with edges Grid");
    }
    // The last error of the step is far below the first.
    let steps = errors(&table, "step", "curve");
    assert!(steps[steps.len() - 1].1 < steps[0].1 / 10.0, "{steps:?}");
    for row in table["rows"].as_array().unwrap() {
        let (least, median) = (&row["seconds"]["minimum"], &row["seconds"]["median"]);
        assert!(least.as_f64().unwrap() <= median.as_f64().unwrap(), "{row}");
    }
}

#[test]
fn rough_scenes_are_counted_from_their_finest_solution() {
    let table = json(&["cost", "rough-sphere", "--format", "json", "--budget", "3s"]);
    let reference = &table["reference"];
    assert_eq!(reference["closed_form"], false);
    let own = reference["errors"]["adhesion_force"].as_f64().unwrap();
    assert!(own > 0.0 && own < 0.01, "{own}");
    // The finest solution has no difference from itself: its stated error is that of the reference.
    let rows = table["rows"].as_array().unwrap();
    let finest = rows.iter().rfind(|row| row["knob"] == "sub-cell-springs").unwrap();
    assert_eq!(finest["setting"].as_f64(), reference["springs"].as_f64());
    assert_eq!(finest["errors"]["adhesion_force"]["resolved"], false);
    assert_eq!(finest["errors"]["adhesion_force"]["error"], reference["errors"]["adhesion_force"]);
    // The fewest springs are twice the last mode.
    assert_eq!(rows[0]["setting"], 1024.0);
    assert_eq!(table["answer"].as_array().unwrap().len(), 2);
}

#[test]
fn the_text_begins_with_the_answer_and_ends_with_what_was_too_much() {
    let Finished { code, stdout: text, stderr: progress } =
        asperity(&["cost", "jkr-sphere", "--budget", "1s"]);
    assert_eq!(code, Some(0));
    assert!(text.starts_with("1 % of the adhesion force: "), "{text}");
    let (_, end) = text.rsplit_once("Left out, as").unwrap();
    assert!(end.lines().skip(1).all(|line| line.starts_with("- ")), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // One line for each knob.
    let mut reported: Vec<_> = progress.lines().collect();
    let lines = reported.len();
    reported.dedup();
    assert!(lines == reported.len() && (2..=3).contains(&lines), "{progress}");
    // Without adhesion the table is about the curve.
    let text = done(&["cost", "jkr-sphere", "--budget", "1s", "--set", "adhesion=None"]);
    assert!(text.starts_with("1 % of the force curve: "), "{text}");
}

#[test]
fn costs_go_to_files_that_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (csv, svg) = (path("cost.csv"), path("cost.svg"));
    let command = ["cost", "kendall-punch", "--budget", "1s", "-o", &csv, "--picture", &svg];
    assert_eq!(done(&command), "");
    let table = fs::read_to_string(&csv).unwrap();
    let rows = &table[table.find("knob").unwrap()..];
    assert!(table.starts_with("# asperity ") && table.contains("\n# command: asperity cost kendall-punch "));
    let columns = |row: &str| row.split(',').count();
    assert!(rows.starts_with("knob,setting,springs,minimum_seconds,"));
    assert!(rows.lines().count() > 4 && rows.lines().all(|row| columns(row) == 18), "{rows}");
    let picture = fs::read_to_string(&svg).unwrap();
    assert!(picture.starts_with("<svg ") && picture.contains("Grid") && !picture.contains("NaN"));
    assert!(failed(1, &command).contains("--force overwrites it"));
    fs::remove_file(&csv).unwrap();
    assert!(failed(1, &command).contains("cost.svg"));
    assert!(!fs::exists(&csv).unwrap());
    done(&[&command[..], &["--force"]].concat());
    assert!(fs::exists(&csv).unwrap());
}

#[test]
fn wrong_costs_are_refused() {
    failed(2, &["cost"]);
    failed(2, &["cost", "jkr-sphere", "--format", "xml"]);
    failed(2, &["cost", "jkr-sphere", "--budget", "soon"]);
    failed(1, &["cost", "no-such-scene"]);
    failed(1, &["cost", "jkr-sphere", "--set", "length=-1"]);
    assert!(failed(1, &["cost", "million-springs", "--budget", "1ms"]).contains("budget of 0.001 s"));
}

#[test]
fn help_is_for_reading() {
    for command in ["cost", "run"] {
        for flag in ["-h", "--help"] {
            let text = done(&[command, flag]);
            assert!(text.contains("Usage: asperity") && text.contains("Examples:"), "{text}");
            assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        }
    }
}

#[test]
fn tolerances_are_kept() {
    let Finished { code, stdout, stderr } =
        asperity(&["run", "jkr-sphere", "--tolerance", "0.1%", "--format", "json"]);
    let run: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(code, Some(0));
    let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
    assert!((run["adhesion_force"].as_f64().unwrap() / exact - 1.0).abs() <= 1e-3);
    assert_eq!(run["choice"]["edges"], "SubCell");
    assert_eq!(run["choice"]["points"], run["line"]["points"]);
    assert_eq!(run["scene"]["numerics"]["points"], run["line"]["points"]);
    let springs = run["line"]["points"].as_u64().unwrap();
    assert!(
        springs <= 1024 && stderr.starts_with(&format!("{springs} springs with edges SubCell")),
        "{stderr}"
    );
    assert!(done(&["run", "jkr-sphere", "--tolerance", "0.1%"]).contains("springs with edges SubCell"));

    let adhesion = |arguments: &[&str]| json(arguments)["adhesion_force"].as_f64().unwrap();
    let fine = ["--set", "numerics.points=262144", "--set", "numerics.edges=SubCell"];
    let fine = adhesion(&[&["run", "rough-sphere", "--format", "json"], &fine[..]].concat());
    let chosen = adhesion(&["run", "rough-sphere", "--format", "json", "--tolerance", "1e-2"]);
    assert!((chosen / fine - 1.0).abs() <= 1e-2, "{chosen} for {fine}");

    let bare = ["--set", "adhesion=None", "--tolerance", "1e-3", "--format", "json"];
    assert_eq!(json(&[&["run", "jkr-sphere"], &bare[..]].concat())["choice"]["target"], "curve");
}

/// An error that changes its sign is small at some load with few springs, and large under other loads.
#[test]
fn chosen_springs_keep_their_tolerance_under_half_and_twice_the_load() {
    let run = ["run", "pressure-sensitive", "--format", "json"];
    let choice = json(&[&run[..], &["--tolerance", "0.1%"]].concat())["choice"].clone();
    let springs = format!("numerics.points={}", choice["points"]);
    let edges = format!("numerics.edges={}", choice["edges"].as_str().unwrap());
    for load in ["5e-6", "1e-5", "2e-5"] {
        let loading = format!("loading=[ToForce({load}), ToSeparation]");
        let force = |springs: &str, edges: &str| {
            let sets = ["--set", &loading, "--set", springs, "--set", edges];
            json(&[&run[..], &sets[..]].concat())["adhesion_force"].as_f64().unwrap()
        };
        let fine = force("numerics.points=262144", "numerics.edges=SubCell");
        let chosen = force(&springs, &edges);
        assert!((chosen / fine - 1.0).abs() <= 1e-3, "{springs} {edges} {load}: {chosen} for {fine}");
    }
}

/// F_a jumps from 17 to 66 µN between 13.0 and 13.05 µN.
#[test]
fn a_preload_near_a_step_is_named_and_others_have_a_small_error() {
    let run = |load: &str, more: &[&str]| {
        let loading = format!("loading=[ToForce({load}), ToSeparation]");
        done(&[&["run", "pressure-sensitive", "--set", &loading], more].concat())
    };
    let object = |load, more: &[&str]| -> Value {
        serde_json::from_str(&run(load, &[&["--format", "json"], more].concat())).unwrap()
    };
    let number = |object: &Value, key: &str| object[key].as_f64().unwrap();
    for load in ["12e-6", "13e-6", "14e-6"] {
        let fine = ["--set", "numerics.points=262144"];
        let (own, fine) = (object(load, &[]), number(&object(load, &fine), "adhesion_force"));
        let (force, error) = (number(&own, "adhesion_force"), number(&own, "adhesion_force_error"));
        assert!((force - fine).abs() <= error && error <= 1e-2 * force, "{load}: {force} {error} for {fine}");
        assert_eq!(own["adhesion_force_near_step"], false);
    }
    let near = object("13.04e-6", &[]);
    assert_eq!(near["adhesion_force_near_step"], true);
    assert!(number(&near, "adhesion_force_error") > 4e-5);
    let text = run("13.04e-6", &[]);
    assert!(text.contains("17.17 µN, near a step of F_a(F_n)\n"), "{text}");
}

#[test]
fn an_error_that_cannot_be_estimated_refuses_no_scene() {
    let run = ["run", "elastic-energy-above", "--set", "numerics.points=4096"];
    let pull_off = json(&[&run[..], &["--format", "json"]].concat())["adhesion_force"].as_f64().unwrap();
    // Fewer springs detach before this force.
    let loading = format!("loading=[ToZeroForce, ToForce({:e})]", -0.999 * pull_off);
    let run = [&run[..], &["--set", &loading]].concat();
    let last = done(&[&run[..], &["--format", "csv"]].concat());
    let last: Vec<f64> =
        last.lines().next_back().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!((last[2] / (-0.999 * pull_off) - 1.0).abs() < 1e-12, "{last:?}");
    let object = json(&[&run[..], &["--format", "json"]].concat());
    assert!((object["adhesion_force"].as_f64().unwrap() + last[2]).abs() < 1e-12 * pull_off);
    assert!(object["adhesion_force_error"].is_null() && object["adhesion_force_near_step"].is_null());
    assert!(done(&run).contains("nN, error unknown"));
    // Beyond the pull-off force no number of springs helps.
    let beyond = format!("loading=[ToZeroForce, ToForce({:e})]", -1.5 * pull_off);
    let refused = failed(1, &["run", "elastic-energy-above", "--set", &beyond, "--tolerance", "1e-3"]);
    assert!(refused.contains("the contact detaches above that force"), "{refused}");
}

#[test]
fn tolerances_out_of_reach_are_refused_with_what_is_in_reach() {
    let message = failed(1, &["run", "pressure-sensitive", "--tolerance", "1e-13"]);
    assert!(
        message.contains("is not reached with at most 2 097 152 springs; what is reached is "),
        "{message}"
    );
    let stepwise = ["run", "jkr-sphere", "--set", "numerics.solver=Stepwise(step: 1e-8)"];
    assert!(failed(1, &[&stepwise[..], &["--tolerance", "0.01"]].concat()).contains("Exact"));
    for wrong in ["0", "1", "nan", "much"] {
        failed(2, &["run", "jkr-sphere", "--tolerance", wrong]);
    }
}

#[test]
fn lines_are_those_of_their_seeds() {
    let scene = ["run", "pressure-sensitive", "--set", "numerics.points=2048", "--set", "roughness.seed=5"];
    let lines = |more: &[&str]| done(&[&scene[..], &["--lines", "6"], more].concat());
    let text = lines(&["--format", "json", "--jobs", "1"]);
    assert_eq!(lines(&["--format", "json", "--jobs", "3"]), text);
    assert_eq!(lines(&["--format", "json"]), text);
    let object: Value = serde_json::from_str(&text).unwrap();
    let of_lines = object["lines"].as_array().unwrap();
    let forces: Vec<f64> = of_lines.iter().map(|line| line["adhesion_force"].as_f64().unwrap()).collect();
    assert_eq!(of_lines[5]["seed"], 10);
    let alone = json(&[&scene[..], &["--set", "roughness.seed=7", "--format", "json"]].concat());
    assert_eq!(of_lines[2]["adhesion_force"], alone["adhesion_force"]);
    assert_eq!(of_lines[2]["preload_indentation"], alone["preload_indentation"]);
    assert_eq!(of_lines[2]["dissipated_energy"], alone["dissipated_energy"]);
    assert_eq!(of_lines[2]["regime"], alone["regime"]);

    let mean = forces.iter().sum::<f64>() / 6.0;
    let deviation = (forces.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / 5.0).sqrt();
    // Student's t for five degrees of freedom.
    let half = 2.570_581_836 * deviation / 6.0_f64.sqrt();
    let statistics = &object["adhesion_force"];
    for (found, expected) in [
        (&statistics["mean"], mean),
        (&statistics["standard_deviation"], deviation),
        (&statistics["confidence_interval"][0], mean - half),
        (&statistics["confidence_interval"][1], mean + half),
    ] {
        assert!((found.as_f64().unwrap() / expected - 1.0).abs() < 1e-8, "{found} for {expected}");
    }

    let csv = lines(&["--format", "csv"]);
    let rows: Vec<Vec<&str>> =
        csv.lines().filter(|row| !row.starts_with('#')).map(|row| row.split(',').collect()).collect();
    assert!(rows.len() == 7 && rows.iter().all(|row| row.len() == 9), "{csv}");
    assert_eq!(rows[1][1].parse::<f64>().unwrap(), forces[0]);
    let summary = lines(&[]);
    assert!(summary.contains("6 random lines of 2 048 springs, seeds 5 to 10"), "{summary}");
    assert!(summary.contains("adhesion force F_a") && summary.contains("rms skewness"), "{summary}");
    assert!(summary.lines().all(|line| line.chars().count() <= 100), "{summary}");
}

#[test]
fn lines_that_mean_nothing_are_refused() {
    assert!(failed(1, &["run", "jkr-sphere", "--lines", "4"]).contains("but one line"));
    failed(2, &["run", "pressure-sensitive", "--lines", "1"]);
    failed(2, &["run", "pressure-sensitive", "--lines", "many"]);
    failed(2, &["run", "pressure-sensitive", "--jobs", "2"]);
    failed(2, &["run", "pressure-sensitive", "--lines", "4", "--jobs", "0"]);
}

/// More springs, with as many more waves, do not bring the heights of a line nearer to a bell curve.
#[test]
fn heights_do_not_average_themselves() {
    let skewness = |points: u32| {
        let points_set = format!("numerics.points={points}");
        let modes = format!("roughness.modes=(1, {})", points / 2);
        let object = json(&[
            "run",
            "profile-hurst-075",
            "--lines",
            "64",
            "--format",
            "json",
            "--set",
            &points_set,
            "--set",
            &modes,
        ]);
        object["rms_skewness"].as_f64().unwrap()
    };
    let (few, many) = (skewness(256), skewness(16_384));
    // Independent heights would reduce the deviation by sqrt(64) = 8.
    assert!(many > 0.2 && many / few > 0.7 && many / few < 1.4, "{few} and {many}");
}
