//! Results of the program: JSON, tables and texts agree with each other, with the plan, and with a
//! run of their own.

use super::program::{json, number, rows, table, text};
use serde_json::Value;

/// Keys of `run --format json` and of two of its parts.
const KEYS: &str = "program command scene profile modulus work kappa elastic_energy elastic_energy_ratio regime regime_after_zero_force \
    ideal_pull_off_force first_touch_pull_off_force zero_force_pull_off_force preload preload_indentation pull_off_force \
    adhesion_coefficient pull_off_indentation dissipated_energy tabor_number curve patches_at_end counts timings";
const PROFILE_KEYS: &str = "points length spacing rms_height rms_gradient modes seed";
const CURVE_KEYS: &str = "stage,indentation,force,contact_length,patches,stored_energy";

fn array(value: &Value) -> &Vec<Value> {
    value
        .as_array()
        .unwrap_or_else(|| panic!("{value} is not a list"))
}

fn presets() -> Vec<String> {
    let listed = json(&["presets", "list", "--format", "json"]);
    array(&listed["scenes"])
        .iter()
        .map(|preset| preset["name"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn every_scene_gives_the_documented_json() {
    let sensitive = |sets: &[&str]| {
        let sets = sets
            .iter()
            .flat_map(|set| ["--set".to_owned(), (*set).to_owned()]);
        std::iter::once("pressure-sensitive".to_owned())
            .chain(sets)
            .collect()
    };
    let presets = presets().into_iter().map(|name| vec![name]);
    for scene in presets.chain([
        sensitive(&[
            "loading=[ToForce(1e-5)]",
            "observe=[Patches, HeightHistogram]",
        ]),
        sensitive(&[
            "adhesion=None",
            "roughness=None",
            "numerics.points=1",
            "form=None",
        ]),
        sensitive(&[
            "numerics.solver=Stepwise(step: 1e-9)",
            "numerics.points=1024",
        ]),
        sensitive(&["loading=[ToIndentation(-1e-9)]"]),
        sensitive(&[
            "loading=[ToTouch, ToZeroForce, ToSeparation, ToForce(1e-6)]",
            "numerics.samples=2",
        ]),
    ]) {
        let scene: Vec<&str> = scene.iter().map(String::as_str).collect();
        let run = |command: &str, format: &str| {
            text(&[&[command], &scene[..], &["--format", format]].concat())
        };
        let (written, plan) = (run("run", "json"), run("plan", "json"));
        let object: Value = serde_json::from_str(&written).unwrap();
        let missing = KEYS.split(' ').find(|key| object.get(key).is_none());
        assert_eq!(missing, None, "{scene:?}");
        assert!(
            object["command"]
                .as_str()
                .unwrap()
                .starts_with("asperity run "),
            "{scene:?}"
        );
        assert!(
            PROFILE_KEYS
                .split(' ')
                .all(|key| object["profile"].get(key).is_some()),
            "{}",
            object["profile"]
        );
        let spacing = number(&object["profile"]["spacing"]);
        for point in array(&object["curve"]) {
            assert!(
                CURVE_KEYS.split(',').all(|key| point[key].is_number()),
                "{scene:?}: {point}"
            );
            let (length, patches) = (number(&point["contact_length"]), number(&point["patches"]));
            assert!(
                length >= 0.0 && (patches > 0.0 || length == 0.0),
                "{scene:?}: {point}"
            );
        }
        // The contact at the end is that of the last point, and each edge lies within a cell of the
        // last spring.
        let (end, contacts) = (
            array(&object["curve"]).last().unwrap(),
            array(&object["patches_at_end"]),
        );
        assert_eq!(contacts.len() as f64, number(&end["patches"]), "{scene:?}");
        let springs: f64 = contacts
            .iter()
            .map(|run| number(&run[1]) - number(&run[0]) + 1.0)
            .sum();
        let beyond = number(&end["contact_length"]) / spacing - springs;
        assert!(
            beyond.abs() <= contacts.len() as f64 * (1.0 + 1e-9),
            "{scene:?}: {beyond} cells"
        );
        if let [preset] = scene[..] {
            assert_plan(&serde_json::from_str(&plan).unwrap(), &object, preset);
        }
        if scene == ["million-springs"] {
            continue;
        }
        let summary = run("run", "text");
        assert!(
            summary.lines().all(|line| line.chars().count() <= 80),
            "{summary}"
        );
        assert!(
            !summary.contains("NaN") && !summary.contains('\u{1b}'),
            "{summary}"
        );
    }
}

/// The plan counts the work that the run has done.
fn assert_plan(plan: &Value, run: &Value, scene: &str) {
    let stage = |name: &str| {
        array(&plan["parts"])
            .iter()
            .find(|stage| stage["part"] == name)
            .unwrap()
    };
    let runs = |name: &str| stage(name)["runs"].as_bool().unwrap();
    let work = |key: &str| run["counts"][key].as_u64();
    assert_eq!(plan["springs"].as_u64(), work("springs"), "{scene}");
    for (name, passes) in [
        ("without-preload", "passes_without_preload"),
        ("synthesis", "transforms"),
    ] {
        assert_eq!(
            stage(name)["passes"].as_u64().unwrap_or(0),
            work(passes).unwrap(),
            "{scene}: {name}"
        );
    }
    for (name, done) in [
        ("loading-pass", work("loading_passes") > Some(0)),
        ("unloading-pass", work("unloading_passes") > Some(0)),
        // A smooth body has no local maximum of the gap, and so no node.
        ("tree", work("loading_passes") > Some(0)),
        ("equilibrium", work("equilibrium_sweeps") > Some(0)),
        (
            "relaxation",
            work("steps") > Some(0) && work("equilibrium_sweeps") == Some(0),
        ),
        ("height-histogram", !run["histogram"].is_null()),
        ("patches", !run["patches_at_stage_ends"].is_null()),
    ] {
        assert_eq!(runs(name), done, "{scene}: {name}");
    }
    assert!(
        array(&plan["parts"])
            .iter()
            .all(|stage| stage["because"] != ""),
        "{plan}"
    );
}

#[test]
fn figures_follow_from_the_curve_and_the_table_is_the_curve() {
    let run = |more: &[&str]| {
        text(&[&["run", "rough-sphere", "--set", "roughness.seed=3"], more].concat())
    };
    let written = run(&["--format", "json"]);
    let object: Value = serde_json::from_str(&written).unwrap();
    let forces = || {
        array(&object["curve"])
            .iter()
            .map(|point| number(&point["force"]))
    };
    let (smallest, largest) = (forces().fold(0.0, f64::min), forces().fold(0.0, f64::max));
    assert_eq!(
        (
            number(&object["pull_off_force"]),
            number(&object["preload"])
        ),
        (-smallest, largest)
    );
    assert!((number(&object["adhesion_coefficient"]) * largest + smallest).abs() < 1e-12 * largest);
    let coarse: Value =
        serde_json::from_str(&run(&["--format", "json", "--set", "numerics.samples=7"])).unwrap();
    for key in [
        "pull_off_force",
        "preload",
        "pull_off_indentation",
        "dissipated_energy",
    ] {
        let (one, other) = (number(&object[key]), number(&coarse[key]));
        assert!(
            (one - other).abs() <= 1e-9 * one.abs(),
            "{key}: {one} {other}"
        );
    }
    // From the text itself, to the last digit: a general reader of JSON rounds.
    let points = written
        .split("{\"stage\":")
        .skip(1)
        .map(|point| -> Vec<f64> {
            let entries = point.split('}').next().unwrap().split(',');
            entries
                .map(|entry| entry.rsplit(':').next().unwrap().parse().unwrap())
                .collect()
        });
    let csv = run(&["--format", "csv"]);
    assert_eq!(rows(&csv).next(), Some(CURVE_KEYS));
    assert!(points.eq(table(&csv)) && table(&csv).count() > 1000);
}

#[test]
fn a_profile_that_is_written_and_measured_gives_the_same_loop() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let stylus = (0..=150).map(|x| {
        format!(
            "{:e} {:e}\n",
            f64::from(x) * 1e-6,
            3.0 + 1e-8 * f64::from(x % 7)
        )
    });
    std::fs::write(path("stylus.txt"), stylus.collect::<String>()).unwrap();
    let write = |name: &str, form: &str, roughness: &str, numerics: &str| {
        let text = format!(
            "(version: 1, material: (modulus: 2.0e6), length: 1.0e-4, form: {form}, roughness: {roughness}, \
             adhesion: (work: 0.02), observe: [Patches], numerics: (samples: 50, {numerics}), \
             loading: [ToForce(3.0e-4), ToZeroForce, ToForce(6.0e-4), ToSeparation])"
        );
        std::fs::write(path(name), text).unwrap();
        path(name)
    };
    let rough = "SelfAffine(hurst: 0.7, rms_height: 3.0e-7, modes: (1, 100), seed: 4)";
    let measured = "Measured(file: \"stylus.txt\", as_line: true)";
    for (form, roughness, numerics) in [
        ("None", rough, "points: 201, edges: SubCell"),
        ("None", measured, "points: 317, edges: Grid"),
        (
            "Paraboloid(radius: 5.0e-4)",
            rough,
            "points: 200, edges: Grid",
        ),
        (
            "Paraboloid(radius: 5.0e-4)",
            measured,
            "points: 1024, edges: SubCell",
        ),
        ("Cone(angle: 0.05)", "None", "points: 200, edges: SubCell"),
        (
            "Power(coefficient: 1.0e7, exponent: 3.0)",
            rough,
            "points: 1024, edges: SubCell",
        ),
    ] {
        let made = write("made.ron", form, roughness, numerics);
        text(&["profile", &made, "--force", "-o", &path("line.csv")]);
        let measured = write(
            "measured.ron",
            "None",
            "Measured(file: \"line.csv\", as_line: true)",
            numerics,
        );
        let curves = [&made, &measured].map(|scene| text(&["run", scene, "--format", "csv"]));
        assert!(
            rows(&curves[0]).eq(rows(&curves[1])) && rows(&curves[0]).count() > 100,
            "{form}, {roughness}, {numerics}"
        );
        let [made, measured] =
            [&made, &measured].map(|scene| json(&["run", scene, "--format", "json"]));
        assert!(number(&made["dissipated_energy"]) > 0.0);
        for key in [
            "first_touch_pull_off_force",
            "preload_indentation",
            "pull_off_force",
            "dissipated_energy",
            "patches",
        ] {
            assert_eq!(
                made[key], measured[key],
                "{key}: {form}, {roughness}, {numerics}"
            );
        }
    }
}

/// Few springs, for a profile that is only inspected.
const FEW: [&str; 5] = [
    "pressure-sensitive",
    "--set",
    "numerics.points=1024",
    "--set",
    "roughness.modes=(4, 64)",
];

#[test]
fn preloads_and_profiles_are_those_of_runs_of_their_own() {
    let alone =
        |set: &str| json(&[&["run"], &FEW[..], &["--set", set, "--format", "json"]].concat());
    let many = |more: &[&str]| text(&[&["run"], &FEW[..], more].concat());
    let preloads = many(&["--preloads", "0..20uN:5", "--format", "csv"]);
    let of_preload = table(&preloads).nth(3).unwrap();
    let one = alone(&format!(
        "loading=[ToForce({:e}), ToSeparation]",
        of_preload[1]
    ));
    for (key, column) in [
        ("preload_indentation", 2),
        ("pull_off_force", 3),
        ("dissipated_energy", 5),
    ] {
        assert_eq!(number(&one[key]), of_preload[column], "{key}");
    }
    let object: Value = serde_json::from_str(&many(&[
        "--profiles",
        "6",
        "--set",
        "roughness.seed=5",
        "--format",
        "json",
    ]))
    .unwrap();
    let ensemble = &object["ensemble"];
    let lines = array(&ensemble["per_profile"]);
    let seven = alone("roughness.seed=7");
    for key in [
        "pull_off_force",
        "preload_indentation",
        "dissipated_energy",
        "regime",
    ] {
        assert_eq!(lines[2][key], seven[key], "{key}");
    }
    let forces = lines.iter().map(|line| number(&line["pull_off_force"]));
    let mean = forces.clone().sum::<f64>() / 6.0;
    let deviation = (forces.map(|force| (force - mean).powi(2)).sum::<f64>() / 5.0).sqrt();
    let statistics = &ensemble["pull_off_force"];
    for (found, expected) in [
        (&statistics["mean"], mean),
        (&statistics["standard_deviation"], deviation),
    ] {
        assert!(
            (number(found) / expected - 1.0).abs() < 1e-8,
            "{found} for {expected}"
        );
    }
    let of_preloads = many(&[
        "--preloads",
        "0..20uN:5",
        "--profiles",
        "3",
        "--format",
        "json",
    ]);
    let of_preloads: Value = serde_json::from_str(&of_preloads).unwrap();
    assert_eq!(
        (
            array(&of_preloads["per_profile"]).len(),
            &of_preloads["mean"][4]["pull_off_force"]["count"]
        ),
        (3, &3.into())
    );
}

#[test]
fn reversals_end_at_their_turning_points() {
    let run =
        |more: &[&str]| text(&[&["reversals"], &FEW[..], &["--preloads", ":12"], more].concat());
    let object: Value = serde_json::from_str(&run(&["--format", "json"])).unwrap();
    let (reversals, forces, indentations) = (
        array(&object["reversals"]),
        array(&object["forces"]),
        array(&object["indentations"]),
    );
    assert_eq!((reversals.len(), forces.len()), (12, 12));
    for (reversal, forces) in reversals.iter().zip(forces) {
        let forces = array(forces);
        assert_eq!(forces.last(), Some(&reversal["turning_force"]));
        assert_eq!(
            indentations[forces.len() - 1],
            reversal["turning_indentation"]
        );
    }
}

/// The list of jumps is the same as JSON and as a table, at least as long for smaller jumps, and
/// its energies are a part of those of the loading.
#[test]
fn jumps_are_part_of_the_loading() {
    let scene = "pressure-sensitive";
    let events = |option: &str| json(&["run", scene, option, "--format", "json"]);
    let (all, large) = (events("--events=all"), events("--events"));
    let whole = json(&["run", scene, "--profiles", "1", "--format", "json"]);
    for key in [
        "pull_off_force",
        "dissipated_energy",
        "curve",
        "pull_off_force_error",
    ] {
        assert_eq!(
            (&large[key], &all[key]),
            (&whole[key], &whole[key]),
            "{key}"
        );
    }
    let [all, large] = [&all["events"], &large["events"]].map(array);
    let energies = |events: &[Value]| -> Vec<f64> {
        let energies = events.iter().map(|event| &event["energy"]);
        energies.filter_map(Value::as_f64).collect()
    };
    let found = energies(all);
    let largest = found
        .iter()
        .fold(0.0, |largest: f64, energy| largest.max(energy.abs()));
    let expected: Vec<f64> = found
        .iter()
        .copied()
        .filter(|energy| energy.abs() >= 0.01 * largest)
        .collect();
    assert_eq!(energies(large), expected);
    // Springs gain energy on loading and release it on unloading, three quarters or more in jumps.
    assert!(all.iter().all(|event| {
        let energy = event["energy"].as_f64().unwrap_or_default();
        if event["stage"] == 0 {
            energy >= 0.0
        } else {
            energy <= 0.0
        }
    }));
    let dissipated = number(&whole["dissipated_energy"]);
    let sum: f64 = found.iter().sum();
    assert!(
        (-sum / dissipated - 1.0).abs() < 0.25,
        "{sum} of {dissipated} J"
    );
    let marks: Vec<&str> = all
        .iter()
        .filter_map(|event| event["mark"].as_str())
        .collect();
    let marks: Vec<&str> = marks.into_iter().filter(|mark| !mark.is_empty()).collect();
    assert_eq!(marks, ["jump-in", "preload", "pull-off", "jump-out"]);

    let csv = text(&["run", scene, "--events", "--format", "csv"]);
    let mut names: Vec<&str> = rows(&csv).next().unwrap().split(',').collect();
    names.sort_unstable();
    let keys: Vec<&String> = large[0].as_object().unwrap().keys().collect();
    assert_eq!(names, keys);
    let indentations = |event: &Value| number(&event["indentation"]);
    let expected: Vec<f64> = large.iter().map(indentations).collect();
    let found: Vec<f64> = table(&csv).map(|row| row[1]).collect();
    // Reading JSON rounds the last digit.
    let is_near = |(one, other): (&f64, &f64)| (one - other).abs() <= 1e-15 * one.abs();
    assert!(found.len() == expected.len() && found.iter().zip(&expected).all(is_near));
}
