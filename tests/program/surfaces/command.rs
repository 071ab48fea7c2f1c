//! `asperity surface`, and scenes of measured surfaces.

use crate::program::{Finished, asperity_in, rows};
use asperity::scene::format_quantity;
use std::path::Path;

fn done(folder: &Path, arguments: &[&str]) -> String {
    let Finished { code, stdout, stderr } = asperity_in(folder, arguments);
    assert_eq!((code, stderr.as_str()), (Some(0), ""), "{arguments:?}");
    stdout
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let Finished { code, stdout, stderr } = asperity_in(folder, arguments);
    assert_eq!((code, stdout.as_str()), (Some(1), ""), "{arguments:?}");
    stderr
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&done(folder, arguments)).unwrap()
}

/// Heights of a rough profile in nm at 0, 1, 2 … µm.
fn heights(points: u32) -> Vec<f64> {
    let wave = |i: u32, k: u32| (f64::from(k) * (0.1 * f64::from(i) + f64::from(k * k))).sin();
    (0..points).map(|i| (1..40).map(|k| 100.0 * wave(i, k) / f64::from(k * k)).sum()).collect()
}

/// A folder with the profile `line.txt`, without units `plain.txt`, and a map `map.txt`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let heights = heights(512);
    let points: String = heights.iter().enumerate().map(|(i, z)| format!("{i}\t{z:?}\n")).collect();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("line.txt", format!("x [µm]\tz [nm]\n{points}"));
    write("plain.txt", points.clone());
    let row = |start: usize| heights[start..start + 40].iter().map(|z| format!("{z:?} ")).collect::<String>();
    let rows: String = (0..40).map(|i| format!("{}\n", row(11 * i % 400))).collect();
    write("map.txt", format!("# Width: 40 µm\n# Height: 40 µm\n# Value units: nm\n{rows}"));
    folder
}

#[test]
fn a_profile_is_stated_in_every_form() {
    let folder = folder();
    let folder = folder.path();
    let summary = done(folder, &["surface", "line.txt", "--modulus", "1MPa", "--tip-radius", "5um"]);
    for words in [
        "profile of 512 points, 512 µm",
        "rms height Rq",
        "Equivalent line",
        "elastic energy e_el",
        "Warnings",
    ] {
        assert!(summary.contains(words), "{words}: {summary}");
    }
    let report = json(folder, &["surface", "line.txt", "--format", "json", "--modulus", "1MPa"]);
    let heights = heights(512);
    let (count, level) = (heights.len() as f64, heights.iter().sum::<f64>() / 512.0);
    // Tilt by least squares about the middle.
    let x = |i: usize| i as f64 - 255.5;
    let squares: f64 = (0..512).map(|i| x(i) * x(i)).sum();
    let tilt = heights.iter().enumerate().map(|(i, z)| x(i) * (z - level)).sum::<f64>() / squares;
    let rest: f64 = heights.iter().enumerate().map(|(i, z)| (z - level - tilt * x(i)).powi(2)).sum();
    let expected = 1e-9 * (rest / count).sqrt();
    let found = report["rms_height"].as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    let line = &report["equivalent_line"];
    let energy = line["elastic_energy"]["value"].as_f64().unwrap();
    assert!((energy / (1e6 * line["energy_per_modulus"]["value"].as_f64().unwrap()) - 1.0).abs() < 1e-12);
    assert_eq!(line["kappa"], serde_json::Value::Null);
    let adhesive = ["surface", "line.txt", "--format", "json", "--modulus", "1MPa", "--work", "50mJ/m^2"];
    let contact = &json(folder, &adhesive)["equivalent_line"];
    let value = |name: &str| contact[name]["value"].as_f64().unwrap();
    let error = |name: &str| contact[name]["error"].as_f64().unwrap() / value(name);
    let kappa = (value("rms_height") * value("rms_gradient") * 1e6 / 0.05).sqrt();
    assert!((value("kappa") / kappa - 1.0).abs() < 1e-12, "{contact}");
    assert!(error("kappa") <= 0.5 * (error("rms_height") + error("rms_gradient")), "{contact}");
    assert!(
        (value("elastic_energy_ratio") * 0.05 / value("elastic_energy") - 1.0).abs() < 1e-12,
        "{contact}"
    );
    assert!((error("elastic_energy_ratio") / error("elastic_energy") - 1.0).abs() < 1e-12, "{contact}");
    let summary = done(folder, &["surface", "line.txt", "--modulus", "1MPa", "--work", "50mJ/m^2"]);
    assert!(summary.contains("κ ") && summary.contains("e_el/γ "), "{summary}");
    assert_eq!(report["files"][0]["points"], serde_json::json!([512]));
    let table = done(folder, &["surface", "line.txt", "--format", "csv"]);
    assert!(table.contains("\nspectrum,wave_number,power,waves\n1D PSD along x,"), "{table}");
    // The bins hold the whole height except for waves 1 to 255 of the window.
    let rows = table.lines().filter_map(|row| row.strip_prefix("1D PSD along x,"));
    let numbers = rows.map(|row| row.split(',').map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>());
    let square: f64 = numbers.map(|row| row[1] * row[2]).sum::<f64>() / 512e-6 * 2.0;
    assert!((square.sqrt() / expected - 1.0).abs() < 0.3, "{} {expected}", square.sqrt());
    done(folder, &["surface", "line.txt", "-o", "spectrum.csv"]);
    assert_eq!(std::fs::read_to_string(folder.join("spectrum.csv")).unwrap(), table);
    assert!(
        refused(folder, &["surface", "line.txt", "-o", "spectrum.csv"]).contains("--force overwrites it")
    );
}

#[test]
fn the_profile_of_a_scene_is_read_back_with_its_moments() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    done(folder, &["line", "pressure-sensitive", "-o", "line.csv"]);
    let arguments = ["surface", "line.csv", "--unit", "m", "--periodic", "--detrend", "mean"];
    let report = json(folder, &[&arguments[..], &["--format", "json"]].concat());
    // Line over cut: 1, √2 and π/2, of which the points of the profile state the first two.
    for (name, measured, ratio) in
        [("rms_height", "rms_height", 1.0), ("rms_gradient", "rms_slope", std::f64::consts::SQRT_2)]
    {
        let [value, error] =
            ["value", "error"].map(|key| report["equivalent_line"][name][key].as_f64().unwrap());
        let ratio = value / report[measured].as_f64().unwrap() / ratio;
        assert!((ratio - 1.0).abs() < 0.01, "{name}: {ratio}");
        assert!(error < 0.15 * value, "{name}: {error}");
    }
    assert_eq!(report["ends_inside_scan"], true);
    // Each error has its column, and no sentence states another one.
    let text = done(folder, &arguments);
    let (_, table) = text.split_once("missing short waves\n").unwrap();
    let height: Vec<&str> =
        table.lines().next().unwrap().split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    assert_eq!((height.len(), height[0], height[4]), (5, "rms height h", "none"), "{text}");
    assert!(
        text.contains("195.1 nm (the spectrum ends inside the scan)") && !text.contains("accuracy"),
        "{text}"
    );
}

#[test]
fn spectra_are_drawn_and_their_table_has_its_command() {
    let folder = folder();
    let folder = folder.path();
    let options = ["surface", "plain.txt", "--unit", "um", "--periodic", "--continue-to", "0.7um"];
    done(folder, &[&options[..], &["-o", "a.csv"]].concat());
    let table = std::fs::read_to_string(folder.join("a.csv")).unwrap();
    assert!(table.contains(&format!("\n# command: asperity {}\n", options.join(" "))), "{table}");
    assert!(refused(folder, &["run", "a.csv"]).contains("a.csv: a table without a scene; allowed: "));
    let picture = done(folder, &[&options[..], &["--format", "svg"]].concat());
    for name in ["measured, 1D PSD along x", "line", "last resolved wave", "wave number", "10"] {
        assert!(picture.contains(name), "{name}: {picture}");
    }
    done(folder, &["surface", "map.txt", "--tip-radius", "1mm", "-o", "map.svg"]);
    let picture = std::fs::read_to_string(folder.join("map.svg")).unwrap();
    assert!(
        picture.contains("measured, q/π × 2D PSD") && picture.contains("reliability cut-off"),
        "{picture}"
    );
}

#[test]
fn titles_of_figures_have_names_of_files_without_their_folders() {
    let folder = folder();
    let folder = folder.path();
    let files = ["line.txt", "map.txt"].map(|name| folder.join(name).display().to_string());
    let picture = done(folder, &["surface", &files[0], &files[1], "--format", "svg"]);
    assert!(picture.contains("<title>line.txt, map.txt</title>"), "{picture}");
    std::fs::create_dir(folder.join("scenes")).unwrap();
    let untitled = "(version: 1, material: (effective_modulus: 1.0e6), length: 1.0e-4, form: Paraboloid(radius: 1.0e-4))";
    std::fs::write(folder.join("scenes/sphere.ron"), untitled).unwrap();
    let picture = done(folder, &["run", "scenes/sphere.ron", "--format", "svg"]);
    assert!(picture.contains("<title>sphere.ron</title>") && !picture.contains("scenes"), "{picture}");
}

#[test]
fn a_table_is_not_computed_again_from_a_changed_file() {
    let folder = folder();
    let folder = folder.path();
    let scene = ["surface", "line.txt", "--modulus", "1MPa", "--work", "50mJ/m^2", "--scene", "rough.ron"];
    done(folder, &scene);
    done(folder, &["run", "rough.ron", "-o", "curve.csv"]);
    done(folder, &["run", "rough.ron", "--lines", "2", "-o", "lines.npy"]);
    done(folder, &["line", "rough.ron", "-o", "profile.csv"]);
    done(folder, &["surface", "line.txt", "map.txt", "-o", "spectra.csv"]);
    let table = std::fs::read_to_string(folder.join("spectra.csv")).unwrap();
    assert_eq!(table.lines().filter(|line| line.starts_with("# sha256: ")).count(), 2, "{table}");
    let tables = ["curve.csv", "lines.npy", "profile.csv"];
    done(folder, &["run", "lines.npy", "-o", "again.csv"]);
    let [one, other] =
        ["curve.csv", "again.csv"].map(|name| std::fs::read_to_string(folder.join(name)).unwrap());
    assert!(rows(&one).eq(rows(&other)));
    let mut text = std::fs::read_to_string(folder.join("line.txt")).unwrap();
    text.push_str("600\t1\n");
    std::fs::write(folder.join("line.txt"), text).unwrap();
    for table in tables {
        let message = refused(folder, &["run", table]);
        let expected = "line.txt: the measured file has changed: its SHA-256 is ";
        assert!(message.starts_with(expected) && message.contains(&format!("…, {table} has ")), "{message}");
    }
    // Another file in its place makes another scene.
    done(
        folder,
        &["run", "curve.csv", "--set", "roughness=Measured(file: \"map.txt\")", "--set", "length=4e-5"],
    );
    std::fs::remove_file(folder.join("line.txt")).unwrap();
    assert!(refused(folder, &["run", "curve.csv"]).starts_with("line.txt: cannot be read: "));
}

#[test]
fn several_files_are_one_roughness() {
    let folder = folder();
    let both = json(folder.path(), &["surface", "line.txt", "map.txt", "--format", "json"]);
    assert_eq!(both["points"], 512 + 1600);
    assert_eq!(both["files"][1]["points"], serde_json::json!([40, 40]));
    assert_eq!(both["rms_gradient"], serde_json::Value::Null);
    let map = json(folder.path(), &["surface", "map.txt", "--format", "json"]);
    assert!(map["rms_gradient"].as_f64().unwrap() > map["rms_slope"].as_f64().unwrap());
}

/// Folder with incomplete files: `plain.txt` without units, `column.txt` without distances and units, `holes.txt` with
/// missing points, `uneven.txt` with points at uneven distances, and a map `map.txt`.
fn open_folder() -> tempfile::TempDir {
    let folder = folder();
    let heights = heights(512);
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("column.txt", heights[100..400].iter().map(|z| format!("{z:?}\n")).collect());
    let hole = |i: usize, z: &f64| if i % 97 == 50 { "bad".to_owned() } else { format!("{z:?}") };
    write("holes.txt", heights.iter().enumerate().map(|(i, z)| format!("{i}\t{}\n", hole(i, z))).collect());
    let place = |i: usize| i as f64 + if i % 5 == 2 { 0.3 } else { 0.0 };
    write("uneven.txt", heights.iter().enumerate().map(|(i, z)| format!("{}\t{z:?}\n", place(i))).collect());
    folder
}

/// Numbers after the last of these keys, each searched after the previous one, to the last digit: a general JSON reader
/// rounds some of them.
fn numbers<'a>(text: &'a str, keys: &[&str]) -> impl Iterator<Item = f64> + 'a {
    let quoted = |key: &str| format!("\"{key}\":");
    let (last, before) = keys.split_last().unwrap();
    let rest = before.iter().fold(text, |rest, key| rest.split_once(&quoted(key)).unwrap().1);
    let cells: Vec<&str> = rest.split(&quoted(last)).skip(1).collect();
    cells.into_iter().filter_map(|cell| cell[..cell.find([',', '}']).unwrap()].trim().parse().ok())
}

#[test]
fn a_periodic_surface_keeps_its_tilt_unless_asked() {
    let folder = folder();
    let report =
        |options: &[&str]| done(folder.path(), &[&["surface", "line.txt", "--periodic"], options].concat());
    assert_eq!(report(&[]), report(&["--detrend", "mean"]));
    assert_ne!(report(&[]), report(&["--detrend", "tilt"]));
}

#[test]
fn a_length_without_a_unit_is_in_that_of_the_files() {
    let folder = open_folder();
    let report = |spacing: &str, wavelength: &str, radius: &str| {
        let lengths = ["--spacing", spacing, "--continue-to", wavelength, "--tip-radius", radius];
        let asked = [&["surface", "column.txt", "--unit", "um", "--format", "json"], &lengths[..]].concat();
        done(folder.path(), &asked)
    };
    let report_in_um = report("0.5", "0.25", "8");
    assert_eq!(report_in_um, report("0.5um", "250nm", "8µm"));
    assert_eq!(report_in_um, report("5.0e-1", ".25", "8e-6m"));
    assert_ne!(report_in_um, report("0.5", "0.25", "8nm"));
}

#[test]
fn a_scene_holds_all_that_decides_the_equivalent_line() {
    let folder = open_folder();
    let folder = folder.path();
    std::fs::create_dir(folder.join("scenes")).unwrap();
    let units = ["--unit", "um", "--height-unit", "nm"];
    let cases: [(&[&str], &[&str]); 7] = [
        (&["plain.txt"], &units),
        (&["plain.txt", "line.txt"], &["--unit", "um", "--height-unit", "nm", "--detrend", "curvature"]),
        (&["column.txt"], &["--unit", "nm", "--spacing", "0.7um", "--periodic"]),
        (&["plain.txt", "holes.txt", "column.txt"], &["--unit", "nm", "--spacing", "1nm", "--interpolate"]),
        (&["uneven.txt"], &["--unit", "um", "--height-unit", "nm", "--resample", "--continue-to", "0.5um"]),
        (&["map.txt"], &["--row", "7"]),
        (&["map.txt", "map.txt"], &["--column", "3", "--opposite", "map.txt"]),
    ];
    for (number, (files, options)) in cases.into_iter().enumerate() {
        let scene = format!("scenes/{number}.ron");
        let contact = ["--modulus", "1MPa", "--work", "50mJ/m^2", "--lines", "3", "--format", "json"];
        let asked = [&["surface"], files, options].concat();
        let report = done(folder, &[&asked[..], &contact, &["--scene", &scene]].concat());
        // The moments of the analysis, and those of the line on springs: bit for bit.
        let document = asperity::scene::open(folder.join(&scene).to_str().unwrap()).unwrap();
        let options = asperity::simulation::measured_options(document.scene());
        let faces = document.scene().measured_paths(&document.resolve(""));
        let faces = asperity::surface::read_faces(&faces).unwrap();
        let moments = asperity::surface::EquivalentLine::new(&faces, &options).unwrap().moments();
        for (name, found) in [
            ("rms_height", moments.rms_height),
            ("rms_gradient", moments.rms_gradient),
            ("energy_per_modulus", moments.energy_per_modulus),
        ] {
            for (kind, value) in [("value", found.value), ("error", found.error)] {
                let stated = numbers(&report, &["equivalent_line", name, kind]).next();
                assert_eq!(stated, Some(value), "{files:?}, {name}, {kind}");
            }
        }
        let lines = done(folder, &["run", &scene, "--lines", "3", "--format", "csv"]);
        let forces = rows(&lines).skip(1).map(|row| row.split(',').nth(1).unwrap().parse::<f64>().unwrap());
        let stated: Vec<f64> = numbers(&report, &["adhesion", "lines", "adhesion_force"]).collect();
        assert_eq!(forces.collect::<Vec<_>>(), stated, "{files:?}");
        assert_eq!(numbers(&report, &["adhesion", "length"]).next(), Some(document.scene().length));
    }
}

#[test]
fn the_spectra_of_both_faces_add() {
    let folder = folder();
    let folder = folder.path();
    let report = |arguments: &[&str]| json(folder, &[&["surface", "--format", "json"], arguments].concat());
    let [one, other] = ["line.txt", "map.txt"].map(|file| report(&[file]));
    let both = report(&["line.txt", "--opposite", "map.txt"]);
    // Each face is stated by itself.
    for name in ["files", "points", "rms_height", "hurst_exponent", "spectrum", "profile_spectra", "warnings"]
    {
        assert_eq!((&both[name], &both["opposite"][name]), (&one[name], &other[name]), "{name}");
    }
    assert_eq!(one["opposite"], serde_json::Value::Null);
    // The gradient: long waves missing in one scan add little to it.
    let squares = |report: &serde_json::Value| {
        report["equivalent_line"]["rms_gradient"]["value"].as_f64().unwrap().powi(2)
    };
    let ratio = squares(&both) / (squares(&one) + squares(&other));
    assert!((ratio - 1.0).abs() < 1e-2 && ratio < 1.0, "{ratio}");
    let table = done(folder, &["surface", "line.txt", "--opposite", "map.txt", "--format", "csv"]);
    let power = |table: &str, kind: &str| -> Vec<[f64; 2]> {
        let cells = rows(table).filter_map(|row| row.strip_prefix(kind)?.strip_prefix(','));
        let number = |cell: Option<&str>| cell.unwrap().parse().unwrap();
        cells
            .map(|row| {
                let mut cells = row.split(',');
                [number(cells.next()), number(cells.next())]
            })
            .collect()
    };
    let alone = done(folder, &["surface", "map.txt", "--format", "csv"]);
    for kind in ["1D PSD along x", "q/π × 2D PSD"] {
        assert_eq!(power(&table, &format!("\"opposite, {kind}\"")), power(&alone, kind));
        assert!(!power(&alone, kind).is_empty());
    }
    // The line begins at the first wave contained in both scans.
    let line = power(&table, "equivalent line");
    assert!((line[0][0] * 40e-6 / std::f64::consts::TAU - 1.0).abs() < 1e-9, "{line:?}");
    let summary = done(folder, &["surface", "line.txt", "--opposite", "map.txt"]);
    for words in ["Opposite face", "missing short waves", "map of 40 × 40 points"] {
        assert!(summary.contains(words), "{words}: {summary}");
    }
    done(folder, &["surface", "line.txt", "--opposite", "map.txt", "-o", "both.svg"]);
    let picture = std::fs::read_to_string(folder.join("both.svg")).unwrap();
    assert!(picture.contains("measured, opposite, q/π × 2D PSD"), "{picture}");
}

#[test]
fn refusals_name_file_place_and_what_is_allowed() {
    let folder = folder();
    let folder = folder.path();
    std::fs::write(folder.join("bad.txt"), "x [um] z [um]\n0 1\n1 bad\n2 3\n").unwrap();
    std::fs::write(folder.join("uneven.txt"), "x [um] z [um]\n0 1\n1 2\n3 3\n").unwrap();
    for (arguments, expected) in [
        (
            &["surface", "plain.txt"][..],
            "plain.txt: no unit of heights is stated; allowed: a unit in the file",
        ),
        (&["surface", "line.txt", "--unit", "mm"], "line.txt: the file states nm as the unit of heights"),
        (&["surface", "none.txt"], "none.txt: cannot be read: "),
        (&["surface", "bad.txt"], "bad.txt: line 3: 1 of 3 points are missing (33.33 %)"),
        (&["surface", "bad.txt", "--interpolate"], "bad.txt: 3 points along an axis; allowed: at least 32"),
        (&["surface", "line.txt", "uneven.txt"], "uneven.txt: point 2: x = 1e-6 m is off the even grid"),
        (&["surface", "line.txt", "--continue-to", "1mm"], "line.txt: the spectrum continues up to q = "),
        (
            &["surface", "line.txt", "--continue-to", "1e-320m"],
            "--continue-to: 1e-320 m: allowed: from 1e-15 to 10 m",
        ),
        (&["surface", "line.txt", "--row", "1"], "line.txt: a profile, which has no rows and columns"),
        (
            &["surface", "line.txt", "-o", "./line.txt", "--force"],
            "line.txt: the output would replace this measured file; allowed: another name",
        ),
        (
            &["surface", "line.txt", "--modulus", "1MPa", "--scene", "line.txt", "--force-scene"],
            "line.txt: the output would replace this measured file; allowed: another name",
        ),
        (
            &["surface", "line.txt", "--tip-radius", "5"],
            "--tip-radius: a length without a unit; allowed: a unit, such as 0.5um, or --unit um",
        ),
        (&["surface", "line.txt", "--opposite", "none.txt"], "none.txt: cannot be read: "),
        (
            &[
                "surface",
                "plain.txt",
                "--unit",
                "um",
                "--opposite",
                "bad.txt",
                "--modulus",
                "1MPa",
                "--scene",
                "a.ron",
            ],
            "bad.txt: line 3: 1 of 3 points are missing",
        ),
    ] {
        let message = refused(folder, arguments);
        assert!(message.starts_with(expected) && message.lines().count() == 1, "{arguments:?}: {message}");
    }
    done(folder, &["surface", "plain.txt", "--unit", "um"]);
    assert!(!folder.join("a.ron").exists());
}

#[test]
fn a_scene_of_a_surface_runs_on_its_equivalent_line() {
    let folder = folder();
    let folder = folder.path();
    let arguments = ["surface", "plain.txt", "--unit", "um", "--modulus", "1MPa", "--work", "50mJ/m^2"];
    let report = [&arguments[..], &["--scene", "rough.ron", "--format", "json"]].concat();
    let report = json(folder, &report);
    let scene = std::fs::read_to_string(folder.join("rough.ron")).unwrap();
    assert!(
        scene.contains("version: 2") && scene.contains("Measured(file: \"plain.txt\", unit: \"µm\")"),
        "{scene}"
    );
    let again = refused(folder, &[&arguments[..], &["--scene", "rough.ron"]].concat());
    assert!(again.contains("there is a file of that name already"), "{again}");
    let run = json(folder, &["run", "rough.ron", "--format", "json"]);
    // The moments are those of the spectrum, with modes in place of integrals.
    for (name, of_scene) in [("rms_height", "rms_height"), ("rms_gradient", "rms_gradient")] {
        let estimate = report["equivalent_line"][name]["value"].as_f64().unwrap();
        let found = run["line"][of_scene].as_f64().unwrap();
        assert!((found / estimate - 1.0).abs() < 0.03, "{name}: {found} {estimate}");
    }
    assert_eq!(run["line"]["seed"], 1);
    // Other seeds are other lines with the same moments.
    let lines = done(folder, &["run", "rough.ron", "--lines", "3", "--format", "csv"]);
    let forces: Vec<&str> = rows(&lines).skip(1).map(|row| row.split(',').nth(1).unwrap()).collect();
    assert!(forces.len() == 3 && forces[0] != forces[1] && forces[1] != forces[2], "{lines}");
    let first = run["adhesion_force"].as_f64().unwrap();
    assert!((forces[0].parse::<f64>().unwrap() / first - 1.0).abs() < 1e-12);
    let seven = json(folder, &["run", "rough.ron", "--set", "roughness.seed=7", "--format", "json"]);
    assert_eq!(seven["line"]["rms_height"], run["line"]["rms_height"]);
    assert_ne!(seven["adhesion_force"], run["adhesion_force"]);
}

#[test]
fn the_adhesion_force_has_the_spread_over_lines_beside_that_of_the_fit() {
    let folder = folder();
    let folder = folder.path();
    let arguments = ["surface", "line.txt", "--modulus", "1MPa", "--work", "50mJ/m^2", "--preload", "10uN"];
    let summary = done(folder, &arguments);
    for words in [
        "loading                 to 10 µN, then pull",
        "16 profiles: median ",
        "(quartiles ",
        "fit ± ",
        " of 16 profiles",
    ] {
        assert!(summary.contains(words), "{words}: {summary}");
    }
    let few = [&arguments[..], &["--lines", "4", "--scene", "rough.ron", "--format", "json"]].concat();
    let adhesion = json(folder, &few)["adhesion"].take();
    assert_eq!((&adhesion["preload"], &adhesion["adhesion_force"]["count"]), (&1e-5.into(), &4.into()));
    assert!(adhesion["fit_deviation"].as_f64().unwrap() > 0.0, "{adhesion}");
    // The same lines as those of the scene.
    let lines = done(folder, &["run", "rough.ron", "--lines", "4", "--format", "csv"]);
    for (row, line) in rows(&lines).skip(1).zip(adhesion["lines"].as_array().unwrap()) {
        let force: f64 = row.split(',').nth(1).unwrap().parse().unwrap();
        assert!((force / line["adhesion_force"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{row} {line}");
    }
    // Without a work of adhesion there is no adhesion force.
    let none = json(folder, &["surface", "line.txt", "--modulus", "1MPa", "--format", "json"]);
    assert_eq!(none["adhesion"], serde_json::Value::Null);
}

#[test]
fn older_scenes_keep_the_profile_as_the_line() {
    let folder = folder();
    let folder = folder.path();
    let scene = |version: u32, as_line: &str| {
        let text = format!(
            "(version: {version}, material: (effective_modulus: 1.0e6), length: 4.0e-4, adhesion: (work: 0.05), \
             roughness: Measured(file: \"line.txt\"{as_line}), numerics: (points: 2048))"
        );
        std::fs::write(folder.join("scene.ron"), text).unwrap();
        json(folder, &["run", "scene.ron", "--format", "json"])
    };
    let older = scene(1, "");
    let raw = scene(2, ", as_line: true");
    let equivalent = scene(2, "");
    assert_eq!(older["adhesion_force"], raw["adhesion_force"]);
    assert_eq!(scene(1, ", as_line: false")["adhesion_force"], equivalent["adhesion_force"]);
    assert_ne!(raw["adhesion_force"], equivalent["adhesion_force"]);
    assert_eq!((&older["line"]["seed"], &equivalent["line"]["seed"]), (&serde_json::Value::Null, &1.into()));
    let plain = "(version: 2, material: (effective_modulus: 1.0e6), length: 4.0e-4, \
                 roughness: Measured(file: \"plain.txt\"), numerics: (points: 2048))";
    std::fs::write(folder.join("plain.ron"), plain).unwrap();
    let message = refused(folder, &["run", "plain.ron"]);
    assert!(message.contains("roughness.file = \"plain.txt\": no unit of heights is stated"), "{message}");
    let message = refused(folder, &["run", "plain.ron", "--set", "roughness.unit=\"px\""]);
    assert!(message.contains("roughness.unit = \"px\": allowed: m, cm, mm"), "{message}");
}

#[test]
fn a_comparison_states_the_forces_of_both_uses_of_a_measured_profile() {
    let folder = folder();
    let folder = folder.path();
    let force = |as_line: bool| {
        let roughness = format!("file: \"line.txt\", as_line: {as_line}");
        run(folder, &roughness)["adhesion_force"].as_f64().unwrap()
    };
    let profile = force(true);
    // The last run leaves the scene of the equivalent line.
    let line = force(false);
    let text = done(folder, &["compare", "scene.ron", "--as-line", "--format", "text"]);
    assert_ne!(line, profile);
    let [line, profile, ratio] = [(line, "N"), (profile, "N"), (profile / line, "1")]
        .map(|(value, unit)| format_quantity(value, unit));
    let forces = format!("adhesion force F_a: {line} → {profile}, ratio {ratio}\n");
    assert!(text.contains(&forces), "{forces}: {text}");
    assert!(text.contains("different from A to B: profile as line false → true\n"), "{text}");
    // The second scene is the first with the profile as the line, overrides of both included.
    std::fs::copy(folder.join("scene.ron"), folder.join("line.ron")).unwrap();
    let other = std::fs::read_to_string(folder.join("scene.ron")).unwrap();
    std::fs::write(folder.join("profile.ron"), other.replace("as_line: false", "as_line: true")).unwrap();
    let change = ["--set", "adhesion.work=0.1"];
    let one = done(folder, &[&["compare", "line.ron", "--as-line"], &change[..]].concat());
    let two = done(folder, &[&["compare", "line.ron", "profile.ron"], &change[..]].concat());
    // Without the names of the scenes, above and in the legend.
    let is_curve = |line: &&str| !line.contains("A: ") && !line.contains("B: ");
    let curves = |text: &str| text.lines().skip(2).filter(is_curve).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(curves(&one), curves(&two));
    assert_eq!(asperity_in(folder, &["compare", "line.ron", "profile.ron", "--as-line"]).code, Some(2));
}

/// Result of a scene with this roughness, in JSON.
fn run(folder: &Path, roughness: &str) -> serde_json::Value {
    let text = format!(
        "(version: 2, material: (effective_modulus: 1.0e6), length: 3.0e-5, adhesion: (work: 0.05), \
         roughness: Measured({roughness}), numerics: (points: 2048))"
    );
    std::fs::write(folder.join("scene.ron"), text).unwrap();
    json(folder, &["run", "scene.ron", "--format", "json"])
}

#[test]
fn scenes_choose_profile_detrending_window_and_opposite_face() {
    let folder = folder();
    let folder = folder.path();
    // The map of the folder: row r begins at height 11 r mod 400.
    let all = heights(512);
    let seventh = 11 * 6;
    let row: String = (0..40).map(|i| format!("{i} {:?}\n", all[seventh + i])).collect();
    let column: String = (0..40).map(|r| format!("{r} {:?}\n", all[11 * r % 400 + 2])).collect();
    std::fs::write(folder.join("row.txt"), format!("x [um] z [nm]\n{row}")).unwrap();
    std::fs::write(folder.join("column.txt"), format!("x [um] z [nm]\n{column}")).unwrap();
    let height = |roughness: &str| run(folder, roughness)["line"]["rms_height"].as_f64().unwrap();
    for as_line in ["", ", as_line: true"] {
        let length = if as_line.is_empty() { "" } else { ", detrend: Mean" };
        for (cut, file) in [("row: 7", "row.txt"), ("column: 3", "column.txt")] {
            let of_map = |what: &str| format!("file: \"{what}\"{as_line}{length}");
            let (part, whole) = (height(&format!("{}, {cut}", of_map("map.txt"))), height(&of_map(file)));
            assert!((part / whole - 1.0).abs() < 1e-9, "{cut}{as_line}: {part} {whole}");
        }
    }
    // A tilt is roughness unless it is removed.
    let tilted: String =
        all.iter().enumerate().map(|(i, z)| format!("{i} {:?}\n", z + 9.0 * i as f64)).collect();
    std::fs::write(folder.join("tilted.txt"), format!("x [um] z [nm]\n{tilted}")).unwrap();
    let plain = height("file: \"line.txt\", as_line: true, detrend: Tilt");
    let level = height("file: \"tilted.txt\", as_line: true, detrend: Tilt");
    assert!((level / plain - 1.0).abs() < 1e-9, "{level} {plain}");
    assert!(height("file: \"tilted.txt\", as_line: true") > 2.0 * plain);
    let [tilt, mean] =
        ["Tilt", "Mean"].map(|detrend| height(&format!("file: \"tilted.txt\", detrend: {detrend}")));
    assert!((mean / tilt - 1.0).abs() > 1e-3, "{mean} {tilt}");
    let [hann, none] =
        ["false", "true"].map(|periodic| height(&format!("file: \"line.txt\", periodic: {periodic}")));
    // A tilt of a periodic surface is a step at its borders: it stays, unless it is asked for.
    let [mean, tilt] =
        ["Mean", "Tilt"].map(|part| height(&format!("file: \"line.txt\", periodic: true, detrend: {part}")));
    assert!(none == mean && none != tilt, "{none} {mean} {tilt}");
    assert!((hann / none - 1.0).abs() > 1e-3 && (hann / none - 1.0).abs() < 1.0, "{hann} {none}");
    // Spectra of two faces add.
    let squares = ["line.txt", "tilted.txt"].map(|file| height(&format!("file: \"{file}\"")).powi(2));
    let both = height("file: \"line.txt\", opposite: \"tilted.txt\"").powi(2);
    assert!((both / (squares[0] + squares[1]) - 1.0).abs() < 1e-9, "{both} {squares:?}");
    // A table of a scene with two faces has both.
    done(folder, &["run", "scene.ron", "-o", "both.csv"]);
    done(folder, &["run", "both.csv", "-o", "again.csv"]);
    let [one, other] =
        ["both.csv", "again.csv"].map(|name| std::fs::read_to_string(folder.join(name)).unwrap());
    assert!(rows(&one).eq(rows(&other)) && one.contains("opposite: \"tilted.txt\""), "{one}");
    for (set, expected) in [
        ("roughness=Measured(file: \"map.txt\", row: 1, column: 2)", "give one of them"),
        ("roughness=Measured(file: \"map.txt\", row: 41)", "row 41; allowed: rows 1 to 40"),
        ("roughness=Measured(file: \"map.txt\", row: 0)", "roughness.row = 0: allowed: "),
        (
            "roughness=Measured(file: \"line.txt\", column: 1)",
            "a profile, which has no rows and columns; allowed: a map",
        ),
        ("roughness=Measured(file: \"line.txt\", detrend: Slope)", "Slope"),
        (
            "roughness=Measured(file: \"line.txt\", opposite: \"none.txt\")",
            "roughness.file = \"none.txt\": cannot be read",
        ),
        (
            "roughness=Measured(file: \"line.txt\", opposite: \"line.txt\", as_line: true)",
            "spectra of two faces add, their profiles do not",
        ),
        (
            "roughness=Measured(file: \"line.txt\", further_files: [\"map.txt\"], as_line: true)",
            "several files have one spectrum, and no profile",
        ),
        ("roughness=Measured(file: \"line.txt\", further_files: [\"none.txt\"])", "none.txt"),
        (
            "roughness=Measured(file: \"line.txt\", height_unit: \"px\")",
            "roughness.height_unit = \"px\": allowed: m, cm",
        ),
        ("roughness=Measured(file: \"line.txt\", further_files: [\"\"])", "roughness.further_files"),
    ] {
        let message = refused(folder, &["run", "scene.ron", "--set", set]);
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{set}: {message}");
    }
}
