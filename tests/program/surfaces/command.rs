//! `asperity surface`, and scenes of measured surfaces: what they state follows from the files, and
//! from each other.

use crate::program::{Finished, asperity_in, number, rows, table};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// A folder with measured files.
struct Place(tempfile::TempDir);

impl Place {
    /// With the profile `line.txt`, `plain.txt` without units, `column.txt` without distances and
    /// units, `holes.txt` with missing points, `uneven.txt` with points at uneven distances, a map
    /// `map.txt`, its seventh row and third column, and a container of two surfaces.
    fn new() -> Self {
        let place = Place(tempfile::tempdir().unwrap());
        let all = heights(512);
        let units = "x [um] z [nm]\n";
        let points = |x: &dyn Fn(usize) -> f64| -> String {
            all.iter()
                .enumerate()
                .map(|(i, z)| format!("{}\t{z:?}\n", x(i)))
                .collect()
        };
        let plain = points(&|i| i as f64);
        place.write("line.txt", &format!("{units}{plain}"));
        place.write("plain.txt", &plain);
        place.write(
            "column.txt",
            &all[100..400]
                .iter()
                .map(|z| format!("{z:?}\n"))
                .collect::<String>(),
        );
        let hole = |(i, z): (usize, &f64)| {
            format!(
                "{i}\t{}\n",
                if i % 97 == 50 {
                    "bad".into()
                } else {
                    format!("{z:?}")
                }
            )
        };
        place.write(
            "holes.txt",
            &all.iter().enumerate().map(hole).collect::<String>(),
        );
        place.write(
            "uneven.txt",
            &points(&|i| i as f64 + if i % 5 == 2 { 0.3 } else { 0.0 }),
        );
        let at = |row: usize, column: usize| all[11 * row % 400 + column];
        let row = |row: usize| {
            (0..40)
                .map(|column| format!("{:?} ", at(row, column)))
                .collect::<String>()
                + "\n"
        };
        let map: String = (0..40).map(row).collect();
        let map = format!("# Width: 40 µm\n# Height: 40 µm\n# Value units: nm\n{map}");
        place.write("map.txt", &map);
        let cut = |of: &dyn Fn(usize) -> f64| {
            (0..40)
                .map(|i| format!("{i} {:?}\n", of(i)))
                .collect::<String>()
        };
        let index = "surfaces:\n- {name: ball, topographies: [{datafile: {original: none.txt}}]}\n\
                     - {name: plate, topographies: [{name: a, datafile: {original: plain.txt}, unit: um}, \
                     {name: b, datafile: {original: map.txt}, is_periodic: true}]}\n";
        let mut container =
            zip::ZipWriter::new(std::fs::File::create(place.path().join("container.zip")).unwrap());
        for (name, text) in [
            ("meta.yml", index),
            ("plain.txt", &plain),
            ("map.txt", &map),
        ] {
            container
                .start_file(name, zip::write::SimpleFileOptions::default())
                .unwrap();
            container.write_all(text.as_bytes()).unwrap();
        }
        container.finish().unwrap();
        place.write("row.txt", &format!("{units}{}", cut(&|i| at(6, i))));
        place.write("column-3.txt", &format!("{units}{}", cut(&|i| at(i, 2))));
        place
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.path().join(name), text).unwrap();
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Output of a command that succeeds without messages other than warnings.
    fn run(&self, arguments: &[&str]) -> String {
        let Finished {
            code,
            stdout,
            stderr,
        } = asperity_in(self.path(), arguments);
        let messages: Vec<&str> = stderr
            .lines()
            .filter(|line| !line.starts_with("warning: "))
            .collect();
        assert!(
            code == Some(0) && messages.is_empty(),
            "{arguments:?}: {stderr}"
        );
        stdout
    }

    fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.run(&[arguments, &["--format", "json"]].concat())).unwrap()
    }

    /// Result of a scene with this version and roughness; the scene remains as `scene.ron`.
    fn scene(&self, roughness: &str) -> Value {
        let text = format!(
            "(version: 1, material: (modulus: 1.0e6), length: 3.0e-5, adhesion: (work: 0.05), \
             roughness: Measured({roughness}), numerics: (points: 2048))"
        );
        self.write("scene.ron", &text);
        self.json(&["run", "scene.ron"])
    }

    fn rms_height(&self, roughness: &str) -> f64 {
        number(&self.scene(roughness)["profile"]["rms_height"])
    }
}

fn assert_equal(found: f64, expected: f64, error: f64) {
    assert!(
        (found / expected - 1.0).abs() < error,
        "{found} for {expected}"
    );
}

/// Heights of a rough profile in nm at 0, 1, 2 … µm.
fn heights(points: u32) -> Vec<f64> {
    let wave = |i: u32, k: u32| (f64::from(k) * (0.1 * f64::from(i) + f64::from(k * k))).sin();
    (0..points)
        .map(|i| (1..40).map(|k| 100.0 * wave(i, k) / f64::from(k * k)).sum())
        .collect()
}

const CONTACT: [&str; 4] = ["--modulus", "1MPa", "--work", "50mJ/m^2"];

#[test]
fn moments_and_contact_parameters_are_those_of_the_heights() {
    let place = Place::new();
    let report = place.json(&[&["surface", "line.txt"], &CONTACT[..]].concat());
    let heights = heights(512);
    let level = heights.iter().sum::<f64>() / 512.0;
    // Tilt by least squares about the middle.
    let x = |i: usize| i as f64 - 255.5;
    let squares: f64 = (0..512).map(|i| x(i) * x(i)).sum();
    let tilt = heights
        .iter()
        .enumerate()
        .map(|(i, z)| x(i) * (z - level))
        .sum::<f64>()
        / squares;
    let rest: f64 = heights
        .iter()
        .enumerate()
        .map(|(i, z)| (z - level - tilt * x(i)).powi(2))
        .sum();
    assert_equal(
        number(&report["rms_height"]),
        1e-9 * (rest / 512.0).sqrt(),
        1e-10,
    );
    let value = |name: &str| number(&report["equivalent_line"][name]["value"]);
    let error = |name: &str| number(&report["equivalent_line"][name]["error"]) / value(name);
    assert_equal(
        value("elastic_energy"),
        1e6 * value("energy_per_modulus"),
        1e-12,
    );
    assert_equal(
        value("kappa"),
        (value("rms_height") * value("rms_gradient") * 1e6 / 0.05).sqrt(),
        1e-12,
    );
    assert_equal(
        value("elastic_energy_ratio"),
        value("elastic_energy") / 0.05,
        1e-12,
    );
    assert_equal(
        error("elastic_energy_ratio"),
        error("elastic_energy"),
        1e-12,
    );
    assert!(error("kappa") <= 0.5 * (error("rms_height") + error("rms_gradient")));
    let both = place.json(&["surface", "line.txt", "map.txt"]);
    assert_eq!(
        (&both["points"], &both["files"][1]["points"]),
        (&json!(512 + 1600), &json!([40, 40]))
    );
}

/// Numbers after the last of these keys, each searched after the previous one, to the last digit: a
/// general JSON reader rounds some of them.
fn numbers<'a>(text: &'a str, keys: &[&str]) -> impl Iterator<Item = f64> + 'a {
    let quoted = |key: &str| format!("\"{key}\":");
    let (last, before) = keys.split_last().unwrap();
    let rest = before
        .iter()
        .fold(text, |rest, key| rest.split_once(&quoted(key)).unwrap().1);
    let cells: Vec<&str> = rest.split(&quoted(last)).skip(1).collect();
    cells
        .into_iter()
        .filter_map(|cell| cell[..cell.find([',', '}']).unwrap()].trim().parse().ok())
}

#[test]
fn a_scene_holds_all_that_decides_the_equivalent_line() {
    let place = Place::new();
    std::fs::create_dir(place.path().join("scenes")).unwrap();
    for (number, options) in [
        "plain.txt --unit um --height-unit nm",
        "plain.txt line.txt --unit um --height-unit nm --detrend curvature",
        "column.txt --unit nm --spacing 0.7um --periodic",
        "plain.txt holes.txt column.txt --unit nm --spacing 1nm --interpolate",
        "uneven.txt --unit um --height-unit nm --resample --continue-to 0.5um",
        "map.txt --row 7",
        "map.txt map.txt --column 3 --opposite map.txt",
        "map.txt --align-rows --robust",
        "container.zip --channel plate",
    ]
    .into_iter()
    .enumerate()
    {
        let scene = format!("scenes/{number}.ron");
        let asked: Vec<&str> = std::iter::once("surface")
            .chain(options.split(' '))
            .collect();
        let report = place.run(
            &[
                &asked[..],
                &CONTACT,
                &["--profiles", "2", "--format", "json", "--scene", &scene],
            ]
            .concat(),
        );
        // The moments of the analysis, and those of the line on springs: bit for bit.
        let document = asperity::scene::open(place.path().join(&scene).to_str().unwrap()).unwrap();
        let faces = document.scene().measured_paths(&document.resolve(""));
        let faces = asperity::surface::lines::read_faces(&faces).unwrap();
        let measured = document.scene().measured_options();
        let moments = asperity::surface::EquivalentLine::new(&faces, &measured)
            .unwrap()
            .moments();
        for (name, found) in [
            ("rms_height", moments.rms_height),
            ("rms_gradient", moments.rms_gradient),
            ("energy_per_modulus", moments.energy_per_modulus),
        ] {
            for (kind, value) in [("value", found.value), ("error", found.error)] {
                let stated = numbers(&report, &["equivalent_line", name, kind]).next();
                assert_eq!(stated, Some(value), "{options}, {name}, {kind}");
            }
        }
        let lines = place.run(&["run", &scene, "--profiles", "2", "--format", "csv"]);
        let stated: Vec<f64> =
            numbers(&report, &["adhesion", "per_profile", "pull_off_force"]).collect();
        assert_eq!(
            table(&lines).map(|row| row[1]).collect::<Vec<_>>(),
            stated,
            "{options}"
        );
        assert_eq!(
            numbers(&report, &["adhesion", "length"]).next(),
            Some(document.scene().length)
        );
    }
}

#[test]
fn a_scene_of_a_surface_runs_on_its_equivalent_line() {
    let place = Place::new();
    let asked = [
        &[
            "surface",
            "line.txt",
            "--preload",
            "10uN",
            "--profiles",
            "4",
            "--scene",
            "rough.ron",
        ],
        &CONTACT[..],
    ]
    .concat();
    let report = place.json(&asked);
    let run = |more: &[&str]| place.json(&[&["run", "rough.ron"], more].concat());
    let first = run(&[]);
    // The moments are those of the spectrum, with modes in place of integrals.
    for name in ["rms_height", "rms_gradient"] {
        assert_equal(
            number(&first["profile"][name]),
            number(&report["equivalent_line"][name]["value"]),
            0.03,
        );
    }
    // Other seeds are other lines with the same moments, and those that the report states.
    let seven = run(&["--set", "roughness.seed=7"]);
    assert_eq!(
        seven["profile"]["rms_height"],
        first["profile"]["rms_height"]
    );
    assert_ne!(seven["pull_off_force"], first["pull_off_force"]);
    let adhesion = &report["adhesion"];
    assert_eq!(
        (&adhesion["preload"], &adhesion["pull_off_force"]["count"]),
        (&json!(1e-5), &json!(4))
    );
    assert!(number(&adhesion["fit_deviation"]) > 0.0, "{adhesion}");
    let lines = place.run(&["run", "rough.ron", "--profiles", "4", "--format", "csv"]);
    for (row, line) in table(&lines).zip(adhesion["per_profile"].as_array().unwrap()) {
        assert_equal(row[1], number(&line["pull_off_force"]), 1e-9);
    }
    assert_equal(
        table(&lines).next().unwrap()[1],
        number(&first["pull_off_force"]),
        1e-12,
    );
    // Without a work of adhesion there is no pull-off force.
    assert_eq!(
        place.json(&["surface", "line.txt", "--modulus", "1MPa"])["adhesion"],
        Value::Null
    );
}

#[test]
fn scenes_choose_profile_detrending_window_and_opposite_face() {
    let place = Place::new();
    let height = |roughness: &str| place.rms_height(roughness);
    for as_line in ["", ", as_line: true, detrend: Mean"] {
        for (cut, file) in [("row: 7", "row.txt"), ("column: 3", "column-3.txt")] {
            let part = height(&format!("file: \"map.txt\", {cut}{as_line}"));
            assert_equal(part, height(&format!("file: \"{file}\"{as_line}")), 1e-9);
        }
    }
    // A tilt is roughness unless it is removed.
    let tilted = heights(512)
        .into_iter()
        .enumerate()
        .map(|(i, z)| format!("{i} {:?}\n", z + 9.0 * i as f64));
    place.write(
        "tilted.txt",
        &format!("x [um] z [nm]\n{}", tilted.collect::<String>()),
    );
    let plain = height("file: \"line.txt\", as_line: true, detrend: Tilt");
    assert_equal(
        height("file: \"tilted.txt\", as_line: true, detrend: Tilt"),
        plain,
        1e-9,
    );
    assert!(height("file: \"tilted.txt\", as_line: true") > 2.0 * plain);
    // A tilt of a periodic surface is a step at its borders: it stays, unless it is asked for.
    let [hann, none, mean, tilt] = [
        "",
        ", periodic: true",
        ", periodic: true, detrend: Mean",
        ", periodic: true, detrend: Tilt",
    ]
    .map(|options| height(&format!("file: \"line.txt\"{options}")));
    assert!(
        none == mean && none != tilt && (1e-3..1.0).contains(&(hann / none - 1.0).abs()),
        "{hann} {none} {tilt}"
    );
    // Spectra of two faces add.
    let squares =
        ["line.txt", "tilted.txt"].map(|file| height(&format!("file: \"{file}\"")).powi(2));
    let both = height("file: \"line.txt\", opposite: \"tilted.txt\"").powi(2);
    assert_equal(both, squares[0] + squares[1], 1e-9);
    // A table of a scene with two faces has both.
    place.run(&["run", "scene.ron", "-o", "both.csv"]);
    place.run(&["run", "both.csv", "-o", "again.csv"]);
    let [one, other] = ["both.csv", "again.csv"]
        .map(|name| std::fs::read_to_string(place.path().join(name)).unwrap());
    assert!(
        rows(&one).eq(rows(&other)) && one.contains("opposite: \"tilted.txt\""),
        "{one}"
    );
}
