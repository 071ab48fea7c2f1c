//! The command line as for its users: the program itself, its output and its exit code.

use super::common::deadline::within;
use super::program::{Finished, asperity, failed, json, program, rows};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::Stdio;

/// Keys of `run --format json`, in their order.
const KEYS: &[&str] = &[
    "scene",
    "line",
    "kappa",
    "elastic_energy",
    "elastic_energy_ratio",
    "regime",
    "ideal_adhesion_force",
    "preload",
    "preload_indentation",
    "adhesion_force",
    "adhesion_coefficient",
    "pull_off_indentation",
    "dissipated_energy",
    "tabor_number",
    "curve",
    "contacts",
    "work",
    "timings",
];
const LINE_KEYS: &[&str] = &["points", "length", "spacing", "rms_height", "rms_gradient", "modes", "seed"];
const CURVE_KEYS: &[&str] = &["leg", "indentation", "force", "contact_length", "fragments", "stored_energy"];

/// Standard output of a command that succeeds without messages but for that of few springs.
fn done(arguments: &[&str]) -> String {
    let Finished { code, stdout, stderr } = asperity(arguments);
    let is_quiet =
        stderr.lines().all(|line| line.starts_with("warning: ") && line.contains("the shortest wave has"));
    assert!(code == Some(0) && is_quiet, "{arguments:?}: {code:?}, {stderr}");
    stdout
}

/// Standard output of a command that reads this text.
fn with_input(arguments: &[&str], text: &str) -> String {
    let mut command = program();
    let mut child = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    String::from_utf8(child.wait_with_output().unwrap().stdout).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn presets() -> Vec<String> {
    let listed = json(&["presets", "list", "--format", "json"]);
    let names = listed.as_array().unwrap().iter();
    names.map(|preset| preset["name"].as_str().unwrap().to_string()).collect()
}

/// Keys of an object whose entries have lines of their own, indented by `indent`.
fn keys_in_order(text: &str, indent: usize) -> Vec<&str> {
    let opening = format!("{}\"", " ".repeat(indent));
    text.lines().filter_map(|line| line.strip_prefix(&opening)?.split_once('"')).map(|(key, _)| key).collect()
}

#[test]
fn every_scene_gives_the_documented_json() {
    let mut scenes: Vec<Vec<String>> = presets().into_iter().map(|name| vec![name]).collect();
    for overrides in [
        &["loading=[ToForce(1e-5)]", "observe=[Fragments, HeightHistogram]"][..],
        &["adhesion=None", "roughness=None", "numerics.points=1", "form=None"],
        &["numerics.solver=Stepwise(step: 1e-9)", "numerics.points=1024"],
        &["loading=[ToIndentation(-1e-9)]"],
        &["loading=[ToTouch, ToZeroForce, ToSeparation, ToForce(1e-6)]", "numerics.samples=2"],
    ] {
        let sets = overrides.iter().flat_map(|set| ["--set".to_string(), (*set).to_string()]);
        scenes.push(std::iter::once("pressure-sensitive".to_string()).chain(sets).collect());
    }
    for scene in scenes {
        let mut arguments = vec!["run", "--format", "json"];
        arguments.extend(scene.iter().map(String::as_str));
        let text = done(&arguments);
        let found = keys_in_order(&text, 2);
        let contract: Vec<&str> = found.iter().copied().filter(|key| KEYS.contains(key)).collect();
        assert_eq!(contract, KEYS, "{scene:?}");
        let object: Value = serde_json::from_str(&text).unwrap();
        for key in LINE_KEYS {
            assert!(object["line"].get(key).is_some(), "{scene:?}: line.{key}");
        }
        for stage in ["line", "tree", "loop", "curve"] {
            assert!(number(&object["timings"][stage]) >= 0.0);
        }
        let curve = object["curve"].as_array().unwrap();
        assert!(!curve.is_empty());
        let spacing = number(&object["line"]["spacing"]);
        for point in curve {
            assert!(CURVE_KEYS.iter().all(|key| point[key].is_number()), "{scene:?}: {point}");
            let cells = number(&point["contact_length"]) / spacing;
            assert!(cells >= 0.0, "{scene:?}: {point}");
            if number(&point["fragments"]) == 0.0 {
                assert_eq!(cells, 0.0, "{scene:?}: {point}");
            }
        }
        // The contact at the end is that of the last point of the curve.
        let end = curve.last().unwrap();
        let contacts = object["contacts"].as_array().unwrap();
        assert_eq!(contacts.len() as f64, number(&end["fragments"]), "{scene:?}");
        // Each edge lies within a cell of the last held spring.
        let springs: f64 = contacts.iter().map(|run| number(&run[1]) - number(&run[0]) + 1.0).sum();
        let beyond = number(&end["contact_length"]) / spacing - springs;
        assert!(beyond.abs() <= contacts.len() as f64 * (1.0 + 1e-9), "{scene:?}: {beyond} cells");
    }
}

#[test]
fn figures_follow_from_the_curve() {
    let object = json(&["run", "pressure-sensitive", "--format", "json"]);
    let forces: Vec<f64> =
        object["curve"].as_array().unwrap().iter().map(|point| number(&point["force"])).collect();
    let smallest = forces.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(number(&object["adhesion_force"]), -smallest);
    let largest = forces.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(number(&object["preload"]), largest);
    let coefficient = number(&object["adhesion_coefficient"]);
    assert!((coefficient * largest + smallest).abs() < 1e-12 * largest);
    assert_eq!(object["scene"]["numerics"]["samples"], 512, "defaults are filled in");
    // The number of samples does not affect the figures.
    let coarse = json(&["run", "pressure-sensitive", "--format", "json", "--set", "numerics.samples=7"]);
    for key in ["adhesion_force", "preload", "pull_off_indentation", "dissipated_energy"] {
        let (one, other) = (number(&object[key]), number(&coarse[key]));
        assert!((one - other).abs() <= 1e-9 * one.abs(), "{key}: {one} {other}");
    }
}

/// The numbers of a point of the curve, read from its line of the JSON to the last digit.
fn point(line: &str) -> Option<Vec<f64>> {
    let entries = line.strip_prefix("    {\"leg\"")?.trim_end_matches(['}', ',']);
    Some(entries.split(", ").map(|entry| entry.rsplit(": ").next().unwrap().parse().unwrap()).collect())
}

#[test]
fn csv_is_the_curve_of_the_json() {
    for scene in ["rough-sphere", "non-adhesive"] {
        let object = done(&["run", scene, "--format", "json"]);
        let curve: Vec<Vec<f64>> = object.lines().filter_map(point).collect();
        let text = done(&["run", scene, "--format", "csv"]);
        let mut lines = rows(&text);
        assert_eq!(lines.next().unwrap(), CURVE_KEYS.join(","));
        let points = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect());
        assert_eq!(points.collect::<Vec<Vec<f64>>>(), curve);
        assert!(curve.len() > 1000);
    }
}

#[test]
fn a_summary_says_what_came_out_and_why() {
    let text = done(&["run", "pressure-sensitive"]);
    for expected in [
        "Pressure-sensitive adhesion",
        "16 384",
        "100 µm",
        "κ = √(h⟨∇z⟩E*/γ)",
        "pressure-sensitive from first touch: adhesion is small",
        "F_a(0)/F_a",
        "below 0.5",
        "preload F_n",
        "adhesion force F_a",
        "pull-off indentation",
        "ideal F_a,max",
        "dissipated energy",
        "none: separated",
        "tree nodes",
        "time",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    for preset in presets() {
        let text = done(&["run", &preset]);
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(!text.contains('\u{1b}') && !text.contains("NaN"), "{text}");
    }
}

#[test]
fn the_same_command_prints_the_same_bytes() {
    let without_timings = || {
        let text = done(&["run", "fragment-closeup", "--format", "json"]);
        let (before, timings) = text.split_once("  \"timings\": {").unwrap();
        assert_eq!(timings.matches('}').count(), 2, "timings are last");
        before.to_string()
    };
    assert_eq!(without_timings(), without_timings());
    for arguments in [
        &["run", "rough-sphere", "--format", "csv"][..],
        &["line", "profile-hurst-025"],
        &["plan", "million-springs", "--format", "json"],
    ] {
        assert_eq!(done(arguments), done(arguments));
    }
}

#[test]
fn overrides_reach_the_run() {
    let sphere = |work: &str| {
        let work = format!("adhesion.work={work}");
        let sets = ["--set", &work, "--set", "numerics.points=65536"];
        let object = json(&[&["run", "jkr-sphere", "--format", "json"], &sets[..]].concat());
        assert_eq!(object["line"]["points"], 65536);
        number(&object["adhesion_force"])
    };
    // Pull-off is proportional to the work of adhesion.
    let ratio = sphere("0.1") / sphere("0.05");
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
    assert_eq!(sphere("50mJ/m2").to_bits(), sphere("0.05").to_bits());
}

#[test]
fn errors_of_overrides_state_field_value_and_range() {
    let run = |set: &str| failed(1, &["run", "pressure-sensitive", "--set", set]);
    let message = run("roughness.hurst=1.4");
    for expected in ["roughness.hurst", "1.4", "above 0 and below 1"] {
        assert!(message.contains(expected), "{expected}: {message}");
    }
    assert!(run("numerics.pionts=64").contains("numerics.points"));
    assert!(run("numerics.points=many").contains("many"));
    let wrong = "length = 10 kg: allowed: from 1e-9 to 10 m (kg is no length: m, mm, µm, nm)";
    assert!(run("length=10 kg").contains(wrong));
    // Several errors, each on a line of its own; the same on every command.
    for command in ["run", "plan", "line"] {
        let message =
            failed(1, &[command, "jkr-sphere", "--set", "length=-1.0", "--set", "numerics.samples=1"]);
        let lines: Vec<_> = message.lines().collect();
        assert_eq!(lines.len(), 2, "{message}");
        assert!(lines[0].contains("length") && lines[1].contains("numerics.samples"), "{message}");
    }
    // Also without a command, if there is no terminal to explore in.
    assert!(failed(1, &["--set", "roughness.hurst=1.4"]).contains("above 0 and below 1"));
}

#[test]
fn a_scene_that_cannot_be_computed_is_an_error() {
    let message = failed(1, &["run", "jkr-sphere", "--set", "loading=[ToTouch, ToForce(-1.0)]"]);
    assert!(message.starts_with("jkr-sphere: loading.1"), "{message}");
    assert!(message.contains("allowed"), "{message}");
    for command in ["run", "plan", "line"] {
        let message = failed(1, &[command, "no-such-scene"]);
        assert!(message.contains("no-such-scene") && message.contains("jkr-sphere"), "{message}");
        assert!(failed(1, &[command, "no/such/scene.ron"]).contains("no/such/scene.ron"));
    }
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_string()
}

const SMALL: &str = "(
    version: 1,
    material: (effective_modulus: 1.0e6),
    length: 1.0e-4,
    numerics: (points: 64),
)
";

#[test]
fn errors_in_files_have_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let unknown = write(folder.path(), "unknown.ron", &SMALL.replace("length:", "lenght:"));
    for command in [&["run"][..], &["plan"], &["line"], &["presets", "check"]] {
        let message = failed(1, &[command, &[unknown.as_str()]].concat());
        assert!(message.starts_with(&format!("{unknown}:4:5: lenght")), "{message}");
        assert!(message.contains("did you mean length?"), "{message}");
    }
}

#[test]
fn checking_prints_every_error_of_every_file() {
    let folder = tempfile::tempdir().unwrap();
    let good = write(folder.path(), "good.ron", SMALL);
    let wrong = write(
        folder.path(),
        "wrong.ron",
        &SMALL.replace("length: 1.0e-4", "length: -1.0").replace("points: 64", "points: 0, samples: 1"),
    );
    let broken = write(folder.path(), "broken.ron", "(version: 1");
    let missing = folder.path().join("missing.ron").to_str().unwrap().to_string();
    let profile = write(
        folder.path(),
        "profile.ron",
        &SMALL.replace("numerics", "roughness: Measured(file: \"none.csv\"),\n    numerics"),
    );

    assert_eq!(done(&["presets", "check", &good]), format!("{good}: ok\n"));
    let folder_name = folder.path().to_str().unwrap();
    let finished = asperity(&[
        "presets",
        "check",
        &wrong,
        &good,
        &broken,
        &missing,
        &profile,
        folder_name,
        "jkr-sphere",
    ]);
    assert_eq!((finished.code, finished.stdout), (Some(1), format!("{good}: ok\n")));
    let lines: Vec<_> = finished.stderr.lines().collect();
    let expected = [
        format!("{wrong}:4:13: length = -1.0: allowed"),
        format!("{wrong}:5:24: numerics.points = 0: allowed"),
        format!("{wrong}:5:36: numerics.samples = 1: allowed"),
        format!("{broken}:1:1: "),
        format!("{missing}: there is no such file"),
        format!("{profile}:5:31: roughness.file"),
        format!("{folder_name}: "),
        "jkr-sphere: there is no such file".to_string(),
    ];
    assert_eq!(lines.len(), expected.len(), "{lines:#?}");
    for (line, expected) in lines.iter().zip(&expected) {
        assert!(line.starts_with(expected), "{line} is not {expected}");
    }
}

#[test]
fn built_in_scenes_are_listed_shown_and_sound() {
    let names = presets();
    assert!(names.contains(&"pressure-sensitive".to_string()));
    let list = done(&["presets", "list"]);
    assert_eq!(list.lines().count(), names.len());
    for name in names {
        assert!(list.lines().any(|line| line.starts_with(&name)), "{name}");
        let text = done(&["presets", "show", &name]);
        let stdout = with_input(&["presets", "check", "-"], &text);
        assert_eq!(stdout, "standard input: ok\n", "{name}");
    }
    let message = failed(1, &["presets", "show", "no-such-scene"]);
    assert!(message.contains("no-such-scene") && message.contains("kendall-punch"), "{message}");
}

/// On other systems no variable names the configuration folder.
#[cfg(unix)]
#[test]
fn own_scenes_are_listed_and_opened() {
    let config = tempfile::tempdir().unwrap();
    let folder = config.path().join("asperity/presets");
    let asperity = |arguments: &[&str]| {
        let output = program().args(arguments).env("XDG_CONFIG_HOME", config.path()).output().unwrap();
        (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    };
    let (code, message) = asperity(&["line", "my-tape"]);
    assert_eq!(code, Some(1));
    assert!(message.starts_with("my-tape: ") && message.contains(folder.to_str().unwrap()), "{message}");
    fs::create_dir_all(&folder).unwrap();
    let scene = SMALL.replace("version: 1,", "version: 1, title: \"My tape\",");
    let path = write(&folder, "my-tape.ron", &scene);
    write(&folder, "wrong.ron", "(version: 1");
    let (code, list) = asperity(&["presets", "list"]);
    let mut lines = list.lines().skip(presets().len());
    assert_eq!(code, Some(0));
    let line = lines.next().unwrap();
    assert!(line.starts_with("my-tape ") && line.ends_with(" My tape"), "{list}");
    assert!(lines.next().unwrap().contains("line 1, column 1: this bracket is not closed"), "{list}");
    assert_eq!(lines.next(), None);
    let (_, list) = asperity(&["presets", "list", "--format", "json"]);
    let list: Value = serde_json::from_str(&list).unwrap();
    let tape = list.as_array().unwrap().iter().find(|scene| scene["name"] == "my-tape").unwrap();
    assert_eq!((&tape["title"], &tape["path"]), (&Value::from("My tape"), &Value::from(path)));
    let (code, line) = asperity(&["line", "my-tape"]);
    let rows = line.lines().filter(|row| !row.starts_with('#')).count();
    assert_eq!((code, rows), (Some(0), 65));
    assert_eq!(asperity(&["presets", "show", "my-tape"]), (Some(0), scene));
}

#[test]
fn a_plan_is_what_the_run_then_does() {
    for preset in presets() {
        let plan = json(&["plan", &preset, "--format", "json"]);
        let object = json(&["run", &preset, "--format", "json"]);
        let passes = |stage: &str| {
            let stages = plan["stages"].as_array().unwrap();
            let found = stages.iter().find(|planned| planned["stage"] == stage).unwrap();
            assert!(!found["because"].as_str().unwrap().is_empty());
            (found["runs"].as_bool().unwrap(), found["passes"].as_u64())
        };
        let work = |key: &str| object["work"][key].as_u64();
        assert_eq!(plan["springs"].as_u64(), work("springs"), "{preset}");
        assert_eq!(passes("loading-pass").0, work("loading_passes") > Some(0), "{preset}");
        assert_eq!(passes("unloading-pass").0, work("unloading_passes") > Some(0), "{preset}");
        assert_eq!(passes("zero-load-adhesion").1, work("zero_load_passes"), "{preset}");
        assert_eq!(passes("synthesis").1, work("transforms"), "{preset}");
        // A smooth body has no local maximum of the gap, and so no node.
        assert_eq!(passes("tree").0, work("loading_passes") > Some(0), "{preset}");
        assert_eq!(passes("relaxation").0, work("steps") > Some(0), "{preset}");
        assert_eq!(passes("height-histogram").0, !object["histogram"].is_null(), "{preset}");
        assert_eq!(passes("fragments").0, !object["fragments"].is_null(), "{preset}");
    }
    let text = done(&["plan", "pressure-sensitive", "--set", "adhesion=None"]);
    let line = |stage: &str| text.lines().find(|line| line.starts_with(stage)).unwrap();
    assert!(
        line("contact tree").contains("skipped") && line("contact tree").contains("no adhesion"),
        "{text}"
    );
    assert!(line("random profile").contains("1  "), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn springs_under_a_punch_are_counted_beforehand() {
    for points in ["7", "10", "1000", "1001"] {
        let set = format!("numerics.points={points}");
        let plan = json(&["plan", "kendall-punch", "--set", &set, "--format", "json"]);
        let line = done(&["line", "kendall-punch", "--set", &set]);
        assert_eq!(plan["springs"].as_u64(), Some(rows(&line).count() as u64 - 1), "{points}");
    }
}

/// Positions and heights of the line of a scene.
fn line(scene: &str, points: usize) -> Vec<(f64, f64)> {
    let set = format!("numerics.points={points}");
    let text = done(&["line", scene, "--set", &set]);
    let mut points = rows(&text);
    assert_eq!(points.next(), Some("x,z"));
    points
        .map(|row| {
            let (x, z) = row.split_once(',').unwrap();
            (x.parse().unwrap(), z.parse().unwrap())
        })
        .collect()
}

#[test]
fn a_line_refines_to_the_same_line() {
    let coarse = line("profile-hurst-025", 9000);
    let fine = line("profile-hurst-025", 27_000);
    assert_eq!((coarse.len(), fine.len()), (9000, 27_000));
    let spacing = 1.0e-4 / 9000.0;
    for (index, &(x, z)) in coarse.iter().enumerate() {
        assert!((x - (index as f64 + 0.5) * spacing).abs() < 1e-12 * 1.0e-4);
        // With three times the springs, the middle one of each three is at the place of one spring.
        let (fine_x, fine_z) = fine[3 * index + 1];
        assert!((x - fine_x).abs() < 1e-12 * 1.0e-4);
        assert!((z - fine_z).abs() < 1e-10 * 2.0e-7, "{index}: {z} {fine_z}");
    }
}

#[test]
fn a_line_that_is_written_and_measured_gives_the_same_loop() {
    let folder = tempfile::tempdir().unwrap();
    let points = (0..=150)
        .map(|index| format!("{:e} {:e}\n", f64::from(index) * 1e-6, 3.0 + 1e-8 * f64::from(index % 7)));
    write(folder.path(), "stylus.txt", &points.collect::<String>());
    let file = folder.path().join("line.csv");
    let file = file.to_str().unwrap();
    let scene = |form: &str, roughness: &str, points: usize, edges: &str| {
        format!(
            "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4, form: {form}, roughness: {roughness}, \
             adhesion: (work: 0.02), observe: [Fragments], \
             loading: [ToForce(3.0e-4), ToZeroForce, ToForce(6.0e-4), ToSeparation], \
             numerics: (points: {points}, samples: 50, edges: {edges}))"
        )
    };
    let fine = "SelfAffine(hurst: 0.7, rms_height: 3.0e-7, modes: (1, 100), seed: 4)";
    let forms = [
        "None",
        "Paraboloid(radius: 5.0e-4)",
        "Cone(angle: 0.05)",
        "Power(coefficient: 1.0e7, exponent: 3.0)",
    ];
    for (form, roughness) in forms
        .into_iter()
        .flat_map(|form| [(form, "None"), (form, fine), (form, "Measured(file: \"stylus.txt\")")])
    {
        for (points, edges) in
            [(200, "SubCell"), (201, "SubCell"), (200, "Grid"), (317, "Grid"), (1024, "SubCell")]
        {
            let made = write(folder.path(), "made.ron", &scene(form, roughness, points, edges));
            assert_eq!(done(&["line", &made, "--force", "-o", file]), "");
            let measured = scene("None", "Measured(file: \"line.csv\")", points, edges);
            let measured = write(folder.path(), "measured.ron", &measured);
            let curves = [&made, &measured].map(|scene| done(&["run", scene, "--format", "csv"]));
            assert!(curves[0].lines().count() > 100);
            assert!(rows(&curves[0]).eq(rows(&curves[1])), "{form}, {roughness}, {points} points, {edges}");
            let [made, measured] = [&made, &measured].map(|scene| json(&["run", scene, "--format", "json"]));
            for key in [
                "zero_load_adhesion_force",
                "preload",
                "preload_indentation",
                "adhesion_force",
                "pull_off_indentation",
                "dissipated_energy",
                "contacts",
                "fragments",
            ] {
                assert_eq!(made[key], measured[key], "{key}: {form}, {roughness}, {points} points, {edges}");
            }
            assert!(number(&made["dissipated_energy"]) > 0.0);
        }
    }
}

#[test]
fn a_line_holds_only_what_is_under_the_body() {
    let punch = line("kendall-punch", 1000);
    assert_eq!(punch.len(), 400);
    assert!(punch.iter().all(|&(x, z)| (x - 0.5e-4).abs() <= 2.0e-5 && z == 0.0));
}

#[test]
fn measured_lines_are_found_beside_their_scene() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "line.csv", "x,z\n0,0\n0.5e-4,1e-7\n1e-4,0\n");
    let scene = write(
        folder.path(),
        "measured.ron",
        &SMALL.replace("numerics", "roughness: Measured(file: \"line.csv\"),\n    numerics"),
    );
    assert_eq!(done(&["presets", "check", &scene]), format!("{scene}: ok\n"));
    assert_eq!(rows(&done(&["line", &scene])).count(), 65);
    assert!(number(&json(&["run", &scene, "--format", "json"])["line"]["rms_height"]) > 0.0);
}

#[test]
fn a_table_has_its_command_and_opens_as_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let stylus: String =
        (0..=150).map(|x| format!("{:e} {:e}\n", f64::from(x) * 1e-6, 1e-8 * f64::from(x % 7))).collect();
    write(folder.path(), "stylus.txt", &stylus);
    let measured = "roughness=Measured(file: \"stylus.txt\", as_line: true)";
    let scene = write(folder.path(), "scene.ron", SMALL);
    let few = ["--set", "numerics.points=1024"];
    for (name, arguments) in [
        ("curve", &["run", &scene, "--set", "adhesion.work=0.07", "--set", "title=\"Unit: nm, x [um]\""][..]),
        ("measured", &["run", &scene, "--set", measured]),
        ("line", &["line", "pressure-sensitive", few[0], few[1]]),
        ("lines", &["run", "pressure-sensitive", few[0], few[1], "--lines", "3"]),
        ("preloads", &["run", "jkr-sphere", few[0], few[1], "--preloads", "0..1uN:5"]),
        ("map", &["reversals", "pressure-sensitive", few[0], few[1], "--count", "8", "--map"]),
    ] {
        for ending in ["csv", "npy"] {
            let [first, again, curve] =
                ["", "-again", "-curve"].map(|part| path(&format!("{name}{part}.{ending}")));
            done(&[arguments, &["-o", &first]].concat());
            done(&[arguments, &["-o", &again]].concat());
            assert!(fs::read(&first).unwrap() == fs::read(&again).unwrap(), "{name}.{ending}");
            // As a scene, and not as the table, of which the command is known.
            done(&["run", &first, "-o", &curve]);
            let text = String::from_utf8_lossy(&fs::read(&first).unwrap()).into_owned();
            let command = format!("command: asperity {} ", arguments[0]);
            assert!(
                text.contains(&command)
                    && text.contains(&format!("asperity {}\n", env!("CARGO_PKG_VERSION")))
            );
        }
    }
    let [curve, again] = ["curve.csv", "curve-curve.csv"].map(|name| fs::read_to_string(path(name)).unwrap());
    assert!(rows(&curve).eq(rows(&again)) && curve.contains("work: 0.07"), "{again}");
    let line = fs::read_to_string(path("line.csv")).unwrap();
    assert!(line.contains("\n# seed: "), "{line}");
    // Units are those of the reader and not words of the scene.
    let report = json(&["surface", &path("line.csv"), "--unit", "m", "--format", "json"]);
    let array = json(&["surface", &path("line.npy"), "--unit", "m", "--format", "json"]);
    assert!(number(&report["rms_height"]) > 0.0 && report["rms_height"] == array["rms_height"]);
    let none = write(folder.path(), "none.csv", "# asperity 0.1.0\nx,z\n");
    assert!(failed(1, &["run", &none]).contains("a table without a scene; allowed: "));
}

#[test]
fn files_are_not_overwritten_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.csv");
    let file = path.to_str().unwrap();
    for (command, header) in [("run", "leg,"), ("line", "x,z")] {
        let arguments = [command, "jkr-sphere", "-o", file];
        assert_eq!(done(&arguments), "");
        let written = fs::read_to_string(&path).unwrap();
        assert!(rows(&written).next().unwrap().starts_with(header), "the ending .csv selects the table");
        let message = failed(1, &arguments);
        assert!(message.contains(file) && message.contains("--force"), "{message}");
        assert_eq!(fs::read_to_string(&path).unwrap(), written);
        fs::write(&path, "old").unwrap();
        assert_eq!(done(&[&arguments[..], &["--force"]].concat()), "");
        assert_eq!(fs::read_to_string(&path).unwrap(), written);
        fs::remove_file(&path).unwrap();
    }
    // A failed run leaves neither a file nor anything beside it.
    failed(1, &["run", "jkr-sphere", "--set", "loading=[ToTouch, ToForce(-1.0)]", "-o", file]);
    let nowhere = folder.path().join("none/out.csv");
    assert!(failed(1, &["run", "jkr-sphere", "-o", nowhere.to_str().unwrap()]).contains("no folder"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let csv = done(&["run", "jkr-sphere", "--format", "csv"]);
    assert_eq!(done(&["run", "jkr-sphere", "--format", "csv", "-o", "-"]), csv);
}

#[cfg(unix)]
#[test]
fn a_process_that_is_killed_while_it_writes_leaves_nothing_behind() {
    within(120, || {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.csv");
        let arguments = ["run", "jkr-sphere", "--set", "numerics.samples=200000", "--force", "-o"];
        let clock = std::time::Instant::now();
        assert!(program().args(arguments).arg(&out).status().unwrap().success());
        let (whole, time) = (fs::read(&out).unwrap(), clock.elapsed());
        for (round, share) in (0..16).map(|round| (round, 0.1 + 0.06 * f64::from(round))) {
            if round % 2 == 0 {
                fs::remove_file(&out).unwrap();
            }
            let mut run = program().args(arguments).arg(&out).spawn().unwrap();
            std::thread::sleep(time.mul_f64(share));
            run.kill().unwrap();
            run.wait().unwrap();
            if out.exists() {
                assert!(fs::read(&out).unwrap() == whole, "a file is whole or not there");
            } else {
                fs::write(&out, &whole).unwrap();
            }
        }
        assert!(program().args(arguments).arg(&out).status().unwrap().success());
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
        assert_eq!(names.collect::<Vec<_>>(), ["out.csv"]);
    });
}

#[cfg(unix)]
#[test]
fn a_scene_comes_from_a_stream_only_where_it_is_named_on_the_command_line() {
    within(60, || {
        let text = done(&["presets", "show", "jkr-sphere"]);
        let force = |json: &Value| number(&json["adhesion_force"]);
        let wanted = force(&json(&["run", "jkr-sphere", "--format", "json"]));
        for name in ["-", "/dev/stdin"] {
            let stdout = with_input(&["run", name, "--format", "json"], &text);
            assert_eq!(force(&serde_json::from_str(&stdout).unwrap()), wanted, "{name}");
        }
        // An endless file is read no further than the longest scene.
        assert!(failed(1, &["run", "/dev/zero"]).contains("too long"));
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("endless.ron");
        let measured = SMALL.replace("numerics", "roughness: Measured(file: \"/dev/zero\"),\n    numerics");
        fs::write(&scene, measured).unwrap();
        let scene = scene.to_str().unwrap();
        for command in [&["run"][..], &["line"], &["cost"], &["presets", "check"]] {
            let message = failed(1, &[command, &[scene]].concat());
            assert!(message.contains("not a regular file"), "{command:?}: {message}");
        }
        // The frames of a demo show the error.
        assert!(done(&["demo", "--frames", "--size", "120x40", scene]).contains("not a regular file"));
    });
}

#[test]
fn a_file_that_cannot_be_written_is_an_error_before_anything_is_computed() {
    // The run itself would fail as well, but later.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().to_str().unwrap();
    let message = failed(1, &["run", "jkr-sphere", "--set", "loading=[ToTouch, ToForce(-1.0)]", "-o", file]);
    assert!(message.contains("not the name of a file") && !message.contains("loading"), "{message}");
}

#[test]
fn wrong_usage_is_exit_code_two() {
    for arguments in [
        &["run"][..],
        &["run", "jkr-sphere", "--no-such-option"],
        &["run", "jkr-sphere", "--format", "xml"],
        &["run", "jkr-sphere", "--set", "adhesion.work"],
        &["run", "jkr-sphere", "--set", "=1"],
        &["line", "jkr-sphere", "--force"],
        &["presets"],
        &["presets", "check"],
        &["reversals"],
        &["completions", "no-such-shell"],
        &["--set"],
        &["rough-sphere", "jkr-sphere"],
    ] {
        failed(2, arguments);
    }
    let message = failed(2, &["rnu", "jkr-sphere", "--format", "json"]);
    assert!(
        message.contains("'rnu' is not a command") && message.contains("run, compare, reversals, demo, plan"),
        "{message}"
    );
    assert!(failed(2, &["--set", "length=1", "run", "jkr-sphere"]).contains("comes first"));
}

#[test]
fn a_word_that_is_no_scene_may_be_meant_as_a_command() {
    let message = failed(1, &["rnu"]);
    for expected in ["rnu", "pressure-sensitive", "presets", "asperity --help"] {
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

#[test]
fn the_explorer_asks_for_a_terminal() {
    let message = failed(1, &["rough-sphere"]);
    assert!(
        message.contains("needs a terminal") && message.contains("asperity run rough-sphere"),
        "{message}"
    );
}

#[test]
fn help_is_for_reading() {
    for command in [
        &[][..],
        &["run"],
        &["compare"],
        &["reversals"],
        &["cost"],
        &["surface"],
        &["config"],
        &["demo"],
        &["line"],
        &["plan"],
        &["check"],
        &["presets", "check"],
        &["completions"],
        &["sweep"],
        &["sweep", "merge"],
        &["sweep", "status"],
        &["sweep", "boundary"],
        &["sweep", "plot"],
        &["sweep", "submit"],
        &["sweep", "plans"],
    ] {
        for flag in ["-h", "--help"] {
            let text = done(&[command, &[flag]].concat());
            assert!(text.contains("Usage: asperity") && text.contains("Examples:"), "{text}");
            assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        }
    }
    assert_eq!(done(&["--version"]), format!("asperity {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_demo_into_a_pipe_is_text() {
    within(60, || {
        let text = done(&["demo", "jkr-sphere", "--size", "100x30"]);
        assert!(!text.contains(['\u{1b}', '\r']), "no control characters of a terminal");
        let heads: Vec<&str> = text.lines().filter(|line| line.starts_with("== ")).collect();
        assert_eq!(heads.len(), 13, "{heads:?}");
        assert_eq!((heads[0], heads[12]), ("== 0.00 s ==", "== 12.00 s =="));
        assert_eq!(text.lines().count(), 13 * 31);
        assert!(text.lines().all(|line| line.chars().count() <= 100));
        assert!(text.contains("Force F(d)") && text.contains('⠒'));
        assert_eq!(
            text,
            done(&["demo", "jkr-sphere", "--size", "100x30", "--frames"]),
            "the same every time"
        );
        let ascii = done(&["demo", "jkr-sphere", "--size", "100x30", "--ascii", "--fps", "0.5"]);
        assert!(ascii.bytes().all(|byte| byte == b'\n' || (b' '..=b'~').contains(&byte)));
        assert!(ascii.contains("Force F(d)"));
        let changed = done(&["demo", "jkr-sphere", "--set", "adhesion.work=0.06", "--at", "1"]);
        assert!(changed.contains("60 mJ/m²"), "overrides hold here too");
    });
}

#[test]
fn one_moment_of_a_demo_is_printed_or_drawn() {
    within(60, || {
        let text = done(&["demo", "jkr-sphere", "--at", "3"]);
        assert_eq!(text.lines().count(), 40);
        assert!(text.contains("F_a") && !text.contains("== "));
        assert_ne!(text, done(&["demo", "jkr-sphere", "--at", "9"]));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("screen.svg");
        let path = file.to_str().unwrap();
        assert_eq!(done(&["demo", "jkr-sphere", "--at", "3", "--picture", path]), "");
        let first = fs::read_to_string(&file).unwrap();
        assert!(first.contains("<svg") && first.trim_end().ends_with("</svg>"));
        assert!(first.contains("Force F(d)") && first.contains("Asperity: jkr-sphere"));
        let message = failed(1, &["demo", "jkr-sphere", "--at", "3", "--picture", path]);
        assert!(message.contains("--force overwrites it"), "{message}");
        done(&["demo", "jkr-sphere", "--at", "9", "--picture", path, "--force"]);
        assert_ne!(fs::read_to_string(&file).unwrap(), first);
        let other = folder.path().join("screen.png");
        let stated = failed(1, &["demo", "jkr-sphere", "--at", "3", "--picture", other.to_str().unwrap()]);
        assert!(stated.contains("use .svg") && !other.exists(), "{stated}");
    });
}

#[test]
fn a_demo_is_recorded_the_same_every_time() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        let recorded = |name: &str| {
            let file = folder.path().join(name);
            let path = file.to_str().unwrap();
            assert_eq!(done(&["demo", "jkr-sphere", "--size", "80x24", "--fps", "4", "--cast", path]), "");
            let message = failed(1, &["demo", "jkr-sphere", "--cast", path]);
            assert!(message.contains("--force overwrites it"), "{message}");
            fs::read_to_string(file).unwrap()
        };
        let text = recorded("a.cast");
        assert_eq!(text, recorded("b.cast"));
        let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let header = &lines[0];
        assert_eq!(
            (&header["version"], &header["width"], &header["height"]),
            (&2.into(), &80.into(), &24.into())
        );
        let times: Vec<f64> = lines[1..].iter().map(|line| number(&line[0])).collect();
        assert!(times.len() > 40 && times.is_sorted_by(|a, b| a < b), "{times:?}");
        assert!(lines[1..].iter().all(|line| line[1] == "o"));
        // Played back, the recording shows the last frame.
        let mut terminal = vt100::Parser::new(24.try_into().unwrap(), 80.try_into().unwrap(), 0);
        lines[1..].iter().for_each(|line| terminal.process(line[2].as_str().unwrap().as_bytes()));
        let last = done(&["demo", "jkr-sphere", "--size", "80x24", "--at", "100"]);
        let shown: Vec<String> = terminal.screen().rows(0, 80).map(|row| row.trim_end().to_owned()).collect();
        assert_eq!(shown, last.lines().collect::<Vec<_>>());
    });
}

#[test]
fn wrong_words_for_a_demo_are_refused() {
    within(60, || {
        for arguments in [
            &["--size", "0x10"][..],
            &["--size", "120"],
            &["--size", "120x"],
            &["--size", "1001x40"],
            &["--size", "-1x40"],
            &["--fps", "0"],
            &["--fps", "61"],
            &["--fps", "NaN"],
            &["--fps", "many"],
            &["--at", "-1"],
            &["--at", "inf"],
            &["--picture", "a.svg"],
            &["--ascii", "--marker", "octant"],
            &["--cast", "a.cast", "--at", "3"],
            &["--theme", "blue"],
        ] {
            failed(2, &[&["demo", "jkr-sphere"], arguments].concat());
        }
        assert!(failed(2, &["demo", "--size", "big"]).contains("such as 120x40"));
        failed(1, &["demo", "no-such-scene"]);
        failed(1, &["demo", "jkr-sphere", "--set", "length=-1"]);
        failed(1, &["demo", "jkr-sphere", "--cast", "/no/such/folder/a.cast"]);
    });
}

#[test]
fn every_shell_has_completions() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = done(&["completions", shell]);
        assert!(script.contains("asperity") && script.contains("presets"), "{shell}");
    }
}

#[test]
fn a_reader_may_leave_at_any_time() {
    for arguments in [
        &["line", "million-springs"][..],
        &["run", "million-springs", "--format", "json", "--set", "numerics.samples=20000"],
        &["run", "jkr-sphere"],
        &["demo", "--fps", "2"],
        &["--help"],
    ] {
        let mut child =
            program().args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        let mut stderr = String::new();
        child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        assert_eq!((child.wait().unwrap().code(), stderr.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    for arguments in [&["run", "jkr-sphere"][..], &["line", "jkr-sphere"], &["completions", "zsh"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = program().args(arguments).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.starts_with("standard output: cannot be written"), "{message}");
    }
}

#[test]
fn hard_cases_are_a_table_or_json() {
    let table = done(&["check", "no-adhesion", "near-ties"]);
    // A row may continue below its last column.
    let rows = table.lines().take_while(|line| !line.is_empty());
    let rows: Vec<_> = rows.filter(|line| !line.starts_with(' ')).collect();
    assert!(rows[0].starts_with("case") && rows.len() == 5, "{table}");
    assert!(rows[1..].iter().all(|row| row.contains(" pass ")), "{table}");
    assert!(table.contains("4 of 4 checks pass"), "{table}");
    assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    let report = json(&["check", "no-adhesion", "--format", "json"]);
    assert_eq!(report["passes"], true);
    let checks = report["checks"].as_array().unwrap();
    let edges: Vec<_> = checks.iter().map(|check| check["edges"].as_str().unwrap()).collect();
    assert_eq!(edges, ["Grid", "SubCell"]);
    assert!(checks.iter().all(|check| number(&check["error"]) <= number(&check["bound"])));
}

#[test]
fn words_that_are_in_no_case_are_refused() {
    let message = failed(1, &["check", "near-ties", "no-such-case"]);
    assert!(
        message.starts_with("no-such-case: ") && message.contains("allowed") && message.contains("near-ties"),
        "{message}"
    );
    let message = failed(1, &["check", "--quick", "2^24"]);
    assert!(message.contains("--quick"), "{message}");
}

#[test]
fn scenes_are_drawn_and_pictures_hold_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let quick = ["--set", "numerics.points=512", "--set", "numerics.samples=16"];
    let run = |scenes: &[&str], more: &[&str]| [&["run"], scenes, &quick, more].concat().join("\0");
    let words = |command: &str| command.split('\0').map(str::to_owned).collect::<Vec<_>>();
    let with = |command: &str, then: &dyn Fn(&[&str])| {
        let words = words(command);
        then(&words.iter().map(String::as_str).collect::<Vec<_>>());
    };
    let loop_file = path("loop.svg");
    for (command, file, expected) in [
        (
            run(&["jkr-sphere"], &["-o", &loop_file]),
            Some(&loop_file),
            vec!["pull-off", "indentation", ">loading<"],
        ),
        (run(&["jkr-sphere"], &["--profile", "-o", "-"]), None, vec!["rigid profile", "elastic surface"]),
        (run(&["jkr-sphere"], &["--fragments"]), None, vec!["(a) loading", "(b) unloading", ">contact<"]),
        (
            run(&["jkr-sphere", "kendall-punch"], &["--format", "svg"]),
            None,
            vec!["Sphere of Johnson", "Flat punch of Kendall"],
        ),
    ] {
        with(&command, &|arguments| {
            let printed = done(arguments);
            let svg = file.map_or(printed, |file| fs::read_to_string(file).unwrap());
            assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{arguments:?}");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{arguments:?}");
            for expected in &expected {
                assert!(svg.contains(expected), "{arguments:?}: no {expected}");
            }
        });
    }
    // The same picture as pixels: two for each px.
    let (svg, png) = (fs::read_to_string(&loop_file).unwrap(), path("loop.png"));
    with(&run(&["jkr-sphere"], &["-o", &png]), &|arguments| drop(done(arguments)));
    let bytes = fs::read(&png).unwrap();
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.ends_with(b"IEND\xaeB`\x82"));
    let side = |at: usize| f64::from(u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()));
    for (name, at) in [(" width=\"", 16), (" height=\"", 20)] {
        let px: f64 = svg.split(name).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        assert_eq!(side(at), (2.0 * px).ceil(), "{name}");
    }
    let before = fs::read_dir(folder.path()).unwrap().count();
    let (picture, other) = (path("a.svg"), path("a.json"));
    for (command, expected) in [
        (
            run(&["jkr-sphere"], &["--format", "json", "-o", &picture]),
            "the extension contradicts --format json; use .json",
        ),
        (run(&["jkr-sphere"], &["-o", &path("a.gif")]), "use .txt, .json, .csv, .npy, .svg or .png"),
        (
            run(&["jkr-sphere"], &["--profile", "-o", &other]),
            "unsupported file extension .json; use .svg or .png",
        ),
        (
            run(&["jkr-sphere", "kendall-punch"], &["-o", &other]),
            "unsupported file extension .json; use .svg or .png",
        ),
        (
            run(&["jkr-sphere"], &["--lines", "2", "-o", &picture]),
            "unsupported file extension .svg; use .txt, .json, .csv or .npy",
        ),
        (["line", "jkr-sphere", "-o", &picture].join("\0"), "use .csv or .npy"),
        (["check", "--quick", "-o", &picture].join("\0"), "use .txt or .json"),
        (
            ["cost", "jkr-sphere", "-o", &path("a.gif")].join("\0"),
            "use .txt, .json, .csv, .npy, .svg or .png",
        ),
        (["cost", "jkr-sphere", "--picture", &other].join("\0"), "use .svg or .png"),
        (["compare", "jkr-sphere", "cone", "-o", &path("a.pdf")].join("\0"), "use .txt, .svg or .png"),
        (
            ["reversals", "jkr-sphere", "-o", &path("a.gif")].join("\0"),
            "use .txt, .json, .csv, .npy, .svg or .png",
        ),
        (
            ["surface", "missing.csv", "-o", &path("a.gif")].join("\0"),
            "use .txt, .json, .csv, .npy, .svg or .png",
        ),
    ] {
        with(&command, &|arguments| {
            let message = failed(1, arguments);
            assert!(message.contains(expected), "{arguments:?}: {message}");
        });
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before, "nothing is written");
}

#[test]
fn every_figure_is_written_as_svg_and_as_png_by_its_extension() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let heights: String = (0..256).map(|x| format!("{x},{}\n", (0.3 * f64::from(x)).sin())).collect();
    fs::write(path("profile.csv"), heights).unwrap();
    let profile = path("profile.csv");
    let quick = ["--set", "numerics.points=256", "--set", "numerics.samples=16"];
    let commands: [(&[&str], &[&str], &str); 5] = [
        (&["run", "jkr-sphere"], &quick, "indentation"),
        (&["compare", "jkr-sphere", "kendall-punch"], &quick, ">A: Sphere"),
        (&["reversals", "jkr-sphere", "--count", "8", "--loops", "0"], &quick, "Everett function"),
        (&["cost", "kendall-punch", "--budget", "1s"], &[], "time of a run"),
        (&["surface", &profile, "--unit", "um"], &[], "wave number"),
    ];
    for (command, more, expected) in commands {
        for ending in ["svg", "png"] {
            let file = path(&format!("{}.{ending}", command[0]));
            // The progress of measurements is on standard error.
            let finished = asperity(&[command, more, &["-o", &file]].concat());
            assert_eq!((finished.code, finished.stdout.as_str()), (Some(0), ""), "{command:?}");
            let bytes = fs::read(&file).unwrap();
            if ending == "png" {
                assert!(bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82"), "{command:?}");
            } else {
                let svg = String::from_utf8(bytes).unwrap();
                assert!(svg.starts_with("<svg ") && svg.contains(expected), "{command:?}: {svg}");
            }
        }
    }
    let beside = [path("cost.json"), path("beside.png")];
    let command = ["cost", "kendall-punch", "--budget", "1s", "-o", &beside[0], "--picture", &beside[1]];
    assert_eq!(asperity(&command).code, Some(0));
    assert!(fs::read(&beside[1]).unwrap().starts_with(b"\x89PNG") && fs::exists(&beside[0]).unwrap());
}

/// Few springs, for a profile that is only inspected.
const FEW_SPRINGS: [&str; 2] = ["--set", "numerics.points=1024"];

#[test]
fn adhesion_against_preload_is_printed_for_one_profile_and_for_many() {
    let run = |more: &[&str]| {
        done(&[&["run", "pressure-sensitive", "--preloads", "0..20uN:5"], &FEW_SPRINGS[..], more].concat())
    };
    let text = run(&[]);
    assert!(text.contains("Adhesion against preload, one profile of 1 024 springs"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let csv = run(&["--format", "csv"]);
    assert!(csv.contains("\n# command: asperity run pressure-sensitive --preloads 0..20uN:5 "), "{csv}");
    let rows: Vec<Vec<&str>> = rows(&csv).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..2], ["seed", "preload"]);
    assert_eq!(rows.len(), 6);
    // Each equals a run to that preload.
    let loading = format!("loading=[ToForce({}), ToSeparation]", rows[4][1]);
    let one = done(
        &[&["run", "pressure-sensitive", "--format", "json", "--set", &loading], &FEW_SPRINGS[..]].concat(),
    );
    let one: Value = serde_json::from_str(&one).unwrap();
    let number = |column: usize| rows[4][column].parse::<f64>().unwrap();
    assert_eq!(one["adhesion_force"].as_f64(), Some(number(3)));
    assert_eq!(one["dissipated_energy"].as_f64(), Some(number(5)));
    let many: Value = serde_json::from_str(&run(&["--lines", "3", "--format", "json"])).unwrap();
    assert_eq!(many["lines"].as_array().unwrap().len(), 3);
    assert_eq!(many["mean"][4]["adhesion_force"]["count"], 3);
    assert!(run(&["--lines", "3", "--format", "svg"]).starts_with("<svg"));
    for (preloads, place) in
        [("5uN", "--preloads"), ("2..1", "--preloads"), ("0..1kg", "kg"), ("0..1:1", "2 to 512")]
    {
        let error = failed(2, &["run", "pressure-sensitive", "--preloads", preloads]);
        assert!(error.contains(place) && error.contains("allowed"), "{error}");
    }
    let stepwise = "numerics.solver=Stepwise(step: 1e-9)";
    let error = failed(1, &["run", "jkr-sphere", "--preloads", "0..1mN", "--set", stepwise]);
    assert!(error.contains("numerics.solver = Stepwise: reversals need the exact solver"), "{error}");
}

#[test]
fn waves_too_steep_for_jkr_are_stated_with_its_force() {
    let run = |form: &str, more: &[&str]| {
        let form = format!("form=WavySphere(radius: 1.0, amplitude: {form})");
        let fields = ["material=(effective_modulus: 1.0e6)", "adhesion=(work: 1.0e3)", "length=1.0"];
        let fields = fields.iter().copied().chain(["loading=[ToTouch, ToSeparation]", form.as_str()]);
        let fields = fields.flat_map(|field| ["--set", field]).collect::<Vec<_>>();
        done(&[&["run", "wavy-sphere"][..], &fields, more].concat())
    };
    let steep = "2.0e-3, wavelength: 0.1";
    let text = run(steep, &[]).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("λ²/(AR) 5, below 12.391: by the rule of Hess inner springs detach first"),
        "{text}"
    );
    assert!(text.contains("1.56 F_smooth"), "{text}");
    let json: Value = serde_json::from_str(&run(steep, &["--format", "json"])).unwrap();
    assert!((json["steep_waves"]["ratio"].as_f64().unwrap() - 5.0).abs() < 1e-12, "{json}");
    assert!((json["steep_waves"]["jkr_factor"].as_f64().unwrap() - 1.56).abs() < 0.01, "{json}");
    assert!(!run("2.0e-3, wavelength: 0.2", &["--format", "json"]).contains("steep_waves"));
}

#[test]
fn the_regime_states_the_protocol_that_decides() {
    let sentence = |scene: &str| {
        let text = done(&[&["run", scene], &FEW_SPRINGS[..]].concat());
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let sensitive = sentence("pressure-sensitive");
    assert!(
        sensitive.contains("pressure-sensitive from first touch: adhesion is small without a preload"),
        "{sensitive}"
    );
    let insensitive = sentence("ideal-adhesion");
    assert!(
        insensitive.contains("pressure-insensitive from first touch: adhesion hardly needs a preload"),
        "{insensitive}"
    );
}

#[test]
fn reversals_are_printed_in_all_formats() {
    let run = |more: &[&str]| {
        done(&[&["reversals", "pressure-sensitive", "--count", "12"], &FEW_SPRINGS[..], more].concat())
    };
    let text = run(&[]);
    assert!(text.contains("12 reversals of one loading") && text.contains("minor loops with loss"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let json: Value = serde_json::from_str(&run(&["--format", "json", "--smoothing", "1"])).unwrap();
    let reversals = json["reversals"].as_array().unwrap();
    let forces = json["forces"].as_array().unwrap();
    assert_eq!((reversals.len(), forces.len()), (12, 12));
    let indentations = json["indentations"].as_array().unwrap();
    // Each curve ends at its turning point, with the force there.
    for (reversal, forces) in reversals.iter().zip(forces) {
        let forces = forces.as_array().unwrap();
        assert_eq!(forces.last(), Some(&reversal["turning_force"]));
        assert_eq!(indentations[forces.len() - 1], reversal["turning_indentation"]);
    }
    let csv = run(&["--format", "csv"]);
    assert_eq!(rows(&csv).count(), 13);
    let map = run(&["--map"]);
    assert_eq!(rows(&map).next(), Some("turning_indentation,indentation,force,everett,density"));
    let points: usize = forces.iter().map(|forces| forces.as_array().unwrap().len()).sum();
    assert_eq!(rows(&map).count(), 1 + points);
    let svg = run(&["--format", "svg"]);
    for words in ["FORC density", "Everett function", "adhesion force ", "this profile"] {
        assert!(svg.contains(words), "{words}");
    }
    for (code, arguments, words) in [
        (2, &["--count", "7"][..], "8..=512"),
        (2, &["--count", "513"], "8..=512"),
        (2, &["--preloads", "0..1uN:8"], "--count"),
        (2, &["--preloads", "1uN"], "allowed"),
        (2, &["--smoothing", "0"], "1..=16"),
        (1, &["--map", "--format", "json"], "use csv or npy"),
        (1, &["--set", "loading=[ToIndentation(-1e-9)]"], "allowed: a stage that presses"),
        (1, &["--set", "numerics.solver=Stepwise(step: 1e-9)"], "allowed: numerics.solver = Exact"),
    ] {
        let error =
            failed(code, &[&["reversals", "pressure-sensitive"], &FEW_SPRINGS[..], arguments].concat());
        assert!(error.contains(words), "{arguments:?}: {error}");
    }
}
