//! Warnings and formats that each command states, wherever its results go.

use super::program::{asperity, asperity_in, text};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Text without its line breaks.
fn unbroken(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Texts of the list `warnings` of a JSON object.
fn warnings_of(json: &str) -> Vec<String> {
    let json: Value = serde_json::from_str(json).unwrap();
    let list = json["warnings"].as_array().unwrap();
    list.iter()
        .map(|text| unbroken(text.as_str().unwrap()))
        .collect()
}

/// Tables, arrays and pictures of a surface hold no warnings, so they go to standard error.
#[test]
fn warnings_of_a_surface_are_stated_with_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let mut profile = "x [um],z [um]\n".to_owned();
    for index in 0..256 {
        let x = 0.4 * f64::from(index);
        let height = 0.3 * (0.05 * x).sin() + 0.01 * (3.1 * x).cos();
        writeln!(profile, "{x},{height}").unwrap();
    }
    std::fs::write(folder.path().join("other.csv"), profile).unwrap();
    let surface = |more: &[&str]| {
        let arguments = [&["surface", "other.csv"], more].concat();
        asperity_in(folder.path(), &arguments)
    };
    let warnings = warnings_of(&surface(&["--format", "json"]).succeeded());
    assert!(!warnings.is_empty());
    let shown = surface(&[]);
    assert_eq!(shown.stderr, "");
    let shown = unbroken(&shown.succeeded());
    for warning in &warnings {
        assert!(shown.contains(warning), "{shown}");
    }
    for output in ["sp.csv", "sp.npy", "sp.svg", "sp.png", "sp.pdf"] {
        let written = surface(&["-o", output]);
        let stated: Vec<String> = written.stderr.lines().map(unbroken).collect();
        let expected: Vec<String> = warnings
            .iter()
            .map(|warning| format!("warning: other.csv: {warning}"))
            .collect();
        assert_eq!(stated, expected, "{output}");
        written.succeeded();
        if output.ends_with("csv") || output.ends_with("svg") {
            let file = std::fs::read_to_string(folder.path().join(output)).unwrap();
            let held: Vec<String> = file
                .lines()
                .filter_map(|line| line.trim_start_matches("# ").strip_prefix("warning: "))
                .map(unbroken)
                .collect();
            assert_eq!(held.len(), warnings.len(), "{output}");
        }
    }
}

/// A table or a figure that is passed on still states which premises it does not meet, and a table
/// is opened as its scene all the same.
#[test]
fn tables_and_figures_hold_their_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let short = [
        "run",
        "jkr-sphere",
        "--set",
        "length=20um",
        "--set",
        "material=(modulus: 1.0e6)",
        "--set",
        "loading=100 µN, separation",
    ];
    let run = |more: &[&str]| asperity_in(folder.path(), &[&short[..], more].concat());
    let warnings = warnings_of(&run(&["--format", "json"]).succeeded());
    assert!(
        warnings[0].contains("reaches an end of the profile"),
        "{warnings:?}"
    );
    for output in ["short.csv", "short.svg"] {
        run(&["-o", output]).succeeded();
        let file = std::fs::read_to_string(folder.path().join(output)).unwrap();
        let held: Vec<&str> = file
            .lines()
            .filter_map(|line| line.trim_start_matches("# ").strip_prefix("warning: "))
            .collect();
        assert_eq!(held, warnings, "{output}");
    }
    let again = asperity_in(folder.path(), &["run", "short.csv", "--format", "json"]);
    assert_eq!(warnings_of(&again.succeeded()), warnings);
}

/// Writes the force curve of a sphere to a file, with a force in N that rises by `drift` over the
/// points.
fn write_curve(folder: &Path, drift: f64) {
    let run = "run jkr-sphere --set loading_stiffness=20 --set numerics.points=256 --set \
               numerics.samples=200 --format csv";
    let table = text(&run.split_whitespace().collect::<Vec<_>>());
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|found| *found == name).unwrap();
    let [place, force] = [column("displacement"), column("force")];
    let mut points: Vec<[f64; 2]> = lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            [place, force].map(|column| cells[column].parse().unwrap())
        })
        .collect();
    // Before and after contact, the body is far from the surface.
    let far = |end: [f64; 2], index: u32| [end[0] - 1e-8 * f64::from(index), 0.0];
    let (first, last) = (points[0], points[points.len() - 1]);
    let before: Vec<[f64; 2]> = (1..150).rev().map(|index| far(first, index)).collect();
    let least = first[0].min(last[0]);
    points.extend((1..150).map(|index| far([least, 0.0], index)));
    let mut curve = "displacement [m],force [N]\n".to_owned();
    let all = before.len() + points.len();
    for (index, [place, force]) in before.into_iter().chain(points).enumerate() {
        let share = index as f64 / all as f64;
        let noise = 2e-7 * (1.7 * (index * index) as f64).sin();
        writeln!(curve, "{place:e},{:e}", force + drift * share + noise).unwrap();
    }
    std::fs::write(folder.join("curve.csv"), curve).unwrap();
}

/// What the text of a fit says against the curve and against the fit is in the list of warnings of
/// its JSON, in the same words.
#[test]
fn the_warnings_of_a_fit_hold_what_its_text_says() {
    let folder = tempfile::tempdir().unwrap();
    let fit = |format: &str| {
        let command = format!(
            "fit curve.csv jkr-sphere --set loading_stiffness=20 --set numerics.points=256 \
             --free work,offset --format {format}"
        );
        let arguments: Vec<&str> = command.split_whitespace().collect();
        asperity_in(folder.path(), &arguments).succeeded()
    };
    write_curve(folder.path(), 2e-5);
    let warnings = warnings_of(&fit("json"));
    let shown = unbroken(&fit("text"));
    assert!(
        warnings
            .iter()
            .any(|warning| warning.starts_with("The model")),
        "{warnings:?}\n{shown}"
    );
    assert!(
        warnings.iter().any(|warning| warning.contains("Drift")),
        "{warnings:?}\n{shown}"
    );
    for warning in &warnings {
        assert!(shown.contains(warning), "{warning}\n{shown}");
    }
}

/// The help of a command lists the formats that its results have: those that the command names when
/// it refuses another one.
#[test]
fn the_help_lists_only_formats_that_exist() {
    let formats = ["text", "json", "csv", "npy", "svg", "png", "pdf"];
    let commands: [(&[&str], &[&str]); 6] = [
        (
            &["find"],
            &["preload", "jkr-sphere", "--where", "F_a = 2 uN"],
        ),
        (&["sensitivity"], &["jkr-sphere"]),
        (&["profile"], &["jkr-sphere"]),
        (&["check"], &[]),
        (&["sweep", "boundary"], &["none"]),
        (&["sweep", "plot"], &["none"]),
    ];
    for (command, arguments) in commands {
        let help = unbroken(&text(&[command, &["--help"]].concat()));
        let (_, help) = help.split_once("--format <FORMAT> ").unwrap();
        let (listed, _) = help.split_once("; default: by the extension").unwrap();
        let others: Vec<&str> = formats
            .into_iter()
            .filter(|format| !listed.contains(format))
            .collect();
        assert!(!others.is_empty(), "{command:?}: {listed}");
        let expected = format!("this result has no such format; use {listed}");
        for format in others {
            let run = asperity(&[command, arguments, &["--format", format]].concat());
            let refusal = unbroken(&run.stderr);
            assert!(refusal.contains(&expected), "{command:?}: {refusal}");
        }
    }
}
