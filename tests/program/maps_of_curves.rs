//! Fits of a text with several curves: a row and a table for each, and a figure with a map.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs `asperity fit` in a folder, with a scene for the curves of the example.
fn fit(folder: &Path, curves: &str, more: &str) -> Output {
    let scene = "jkr-sphere --set form.radius=7.5u --set length=24u --set loading_stiffness=3.01 \
                 --set numerics.points=256 --free work,offset";
    let arguments = format!("fit {curves} {scene} {more}");
    Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Four curves of one text lie on a grid of two columns and two rows. The third one is cut short.
/// Each of the others has the result that it has in a file of its own.
#[test]
fn a_text_with_a_map_gives_rows_tables_and_a_figure() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/rubber.csv");
    let text = fs::read_to_string(example).unwrap();
    let names = text
        .lines()
        .position(|line| line.starts_with("displacement"))
        .unwrap();
    let rows: Vec<&str> = text.lines().skip(names + 1).collect();
    let mut map = text.lines().nth(names).unwrap().to_owned() + "\n";
    for (index, (x, y)) in [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().enumerate() {
        writeln!(map, "# xPosition: {x}e-6\n# yPosition: {y}e-6").unwrap();
        let count = if index == 2 { 20 } else { rows.len() };
        map += &(rows[..count].join("\n") + "\n\n");
    }
    fs::write(folder.join("map.txt"), &map).unwrap();
    fs::write(folder.join("one.csv"), &text).unwrap();

    let output = fit(folder, "map.txt", "-o map.csv --curves models --jobs 1");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    assert!(
        message.contains("1 of 4 curves were not read or not fitted"),
        "{message}"
    );
    let single = fit(folder, "one.csv one.csv", "");
    let message = String::from_utf8_lossy(&single.stderr);
    assert!(message.contains("one.csv: named twice"), "{message}");

    let table = fs::read_to_string(folder.join("map.csv")).unwrap();
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let column = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let number = |row: &[&str], name: &str| row[column(name)].parse::<f64>().unwrap();
    assert_eq!(rows.len(), 4);
    assert_eq!(
        rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
        ["map.txt#1", "map.txt#2", "map.txt#3", "map.txt#4"]
    );
    assert!(rows[2][column("work")].is_empty());
    let last = &rows[3];
    assert_eq!(
        [number(last, "position_x"), number(last, "position_y")],
        [1e-6, 1e-6]
    );
    let json = fit(folder, "one.csv", "--format json");
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let work = json["parameters"]["work"]["value"].as_f64().unwrap();
    assert!((number(last, "work") / work - 1.0).abs() < 1e-12);
    // A single curve of the map, by its name in the rows.
    let second = fit(folder, "map.txt#2", "--format json");
    let second: serde_json::Value = serde_json::from_slice(&second.stdout).unwrap();
    let found = second["parameters"]["work"]["value"].as_f64().unwrap();
    assert!((found / work - 1.0).abs() < 1e-12);
    for (name, words) in [
        (
            "map.txt#5",
            "no curve 5; allowed: one of them, map.txt#1 to map.txt#4",
        ),
        ("map.txt#0", "no curve 0"),
        (
            "one.csv#2",
            "no curve 2; allowed: 1, the only curve of the file",
        ),
        ("none.csv#1", "none.csv"),
    ] {
        let refused = fit(folder, name, "");
        let message = String::from_utf8_lossy(&refused.stderr);
        assert!(
            !refused.status.success() && message.contains(words),
            "{message}"
        );
    }
    let mut tables: Vec<String> = fs::read_dir(folder.join("models"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    tables.sort();
    assert_eq!(tables, ["map-1.csv", "map-2.csv", "map-4.csv"]);

    let output = fit(folder, "map.txt", "-o map.svg");
    assert!(output.status.success());
    let svg = fs::read_to_string(folder.join("map.svg")).unwrap();
    assert!(svg.contains("position") && svg.contains("no value"));

    // A file with one curve stays one curve.
    let refused = fit(folder, "one.csv", "--curves models");
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(message.starts_with("--curves: one curve"), "{message}");
}
