//! Files as instruments and analysis programs write them, with the right result of each. All of
//! them were computed by formulas. `surfaces` has a map of 40 × 33 points at 0.5 µm with an rms
//! height of 87.13 nm, and a profile of 256 points at 0.5 µm with 36.07 nm, in many formats.
//! `forces` has curves of a sphere of 7.5 µm on an instrument of 3 N/m with γ = 60 mJ/m² and
//! E* = 2 MPa, if nothing else is stated.

use super::generated::root;
use super::program::{Finished, asperity, number};
use serde_json::Value;
use std::path::PathBuf;

/// Rms heights in m of the map and of the profile.
const HEIGHT_OF_MAP: f64 = 87.13e-9;
const HEIGHT_OF_PROFILE: f64 = 36.07e-9;
/// Options of the scene of most curves.
const SPHERE: [&str; 11] = [
    "jkr-sphere",
    "--set",
    "form.radius=7.5u",
    "--set",
    "length=24u",
    "--set",
    "loading_stiffness=3",
    "--set",
    "numerics.points=1024",
    "--free",
    "work,modulus,offset",
];

fn path(name: &str) -> PathBuf {
    root().join("tests/program/cases").join(name)
}

/// Runs a command of the program on files of this folder, whose names contain a slash.
fn run(command: &str, arguments: &[&str]) -> Finished {
    let mut all = vec![command.to_owned()];
    for argument in arguments {
        let file = path(argument);
        let is_file = argument.contains('/') && file.is_file();
        all.push(if is_file {
            file.to_string_lossy().into_owned()
        } else {
            (*argument).to_owned()
        });
    }
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    asperity(&all)
}

/// Returns the JSON object that a command prints.
fn json(command: &str, arguments: &[&str]) -> Value {
    let arguments = [arguments, &["--format", "json"]].concat();
    let text = run(command, &arguments).succeeded();
    serde_json::from_str(&text).unwrap()
}

/// Asserts that a command refuses its input with a message that contains all these words.
fn assert_refused(command: &str, arguments: &[&str], words: &[&str]) {
    let Finished { code, stderr, .. } = run(command, arguments);
    assert_ne!(code, Some(0), "{arguments:?}");
    for word in words {
        assert!(stderr.contains(word), "{arguments:?}: {stderr}");
    }
}

/// Returns all texts of a list in JSON as one text.
fn texts(list: &Value) -> String {
    let texts = list.as_array().unwrap().iter();
    let texts: Vec<&str> = texts.map(|text| text.as_str().unwrap()).collect();
    texts.join(" ")
}

fn is_close(found: f64, expected: f64, tolerance: f64) -> bool {
    (found / expected - 1.0).abs() < tolerance
}

/// Points, lengths in m and rms height in m of a surface.
struct Surface<'a> {
    points: &'a [u64],
    lengths: &'a [f64],
    height: f64,
}

const MAP: Surface<'_> = Surface {
    points: &[40, 33],
    lengths: &[20e-6, 16.5e-6],
    height: HEIGHT_OF_MAP,
};
const PROFILE: Surface<'_> = Surface {
    points: &[256],
    lengths: &[128e-6],
    height: HEIGHT_OF_PROFILE,
};

impl Surface<'_> {
    /// Asserts that a file is read as this surface. The rms height may differ by a share of itself.
    fn assert_read(&self, arguments: &[&str], tolerance: f64) -> Value {
        let found = json("surface", arguments);
        let file = &found["files"][0];
        assert_eq!(file["points"], serde_json::json!(self.points), "{file}");
        for (length, expected) in file["lengths"].as_array().unwrap().iter().zip(self.lengths) {
            assert!(is_close(number(length), *expected, 0.005), "{file}");
        }
        let height = number(&found["rms_height"]);
        assert!(
            is_close(height, self.height, tolerance),
            "{arguments:?}: {height:e}"
        );
        found
    }
}

#[test]
fn formats_of_the_map_give_the_same_surface() {
    for arguments in [
        &["surfaces/c-order.npy", "--unit", "m", "--spacing", "0.5um"][..],
        &["surfaces/fortran.npy", "--unit", "m", "--spacing", "0.5um"],
        &["surfaces/y-in-nm.nc"],
        &["surfaces/nested.x3p"],
        &["surfaces/empty-offset.x3p"],
        &["surfaces/iso2-text.sdf"],
        &["surfaces/no-units.gwy", "--unit", "m"],
        &["surfaces/positions-in-matrix.csv", "--unit", "um"],
    ] {
        MAP.assert_read(arguments, 3e-4);
    }
    let rows = ["c-order", "fortran"].map(|name| {
        let file = format!("surfaces/{name}.npy");
        let options = ["--unit", "m", "--spacing", "0.5um", "--row", "3"];
        let found = json("surface", &[&[file.as_str()][..], &options].concat());
        number(&found["rms_height"])
    });
    assert_eq!(rows[0], rows[1]);
    assert_refused("surface", &["surfaces/no-units.gwy"], &["unit", "--unit"]);
}

#[test]
fn formats_of_the_profile_give_the_same_surface() {
    for arguments in [
        &["surfaces/unit-data.txt"][..],
        &["surfaces/dektak.csv"],
        &["surfaces/two-units-in-header.csv", "--unit", "um"],
    ] {
        PROFILE.assert_read(arguments, 3e-4);
    }
    let file = "surfaces/two-units-in-header.csv";
    assert_refused("surface", &[file], &["unit", "--unit"]);
}

/// The heights of the map in µm, as rows of the file in which positions are the first row and
/// column.
fn heights_of_map() -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path("surfaces/positions-in-matrix.csv")).unwrap();
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').skip(1).map(str::to_owned).collect())
        .collect()
}

/// The map as columns, with quotes, with gaps and with rounded positions, written by formula.
#[test]
fn other_texts_of_the_map_give_the_same_surface() {
    let folder = tempfile::tempdir().unwrap();
    let heights = heights_of_map();
    let mut by_columns = String::new();
    let mut gaps = String::new();
    let mut rounded = String::new();
    for (x, column) in (0..40).map(|x| (x, heights.iter().map(move |row| &row[x]))) {
        for (y, height) in column.enumerate() {
            let [across, along] = [x, y].map(|place| 0.5 * place as f64);
            by_columns += &format!("{across} {along} {height}\n");
        }
    }
    for (y, row) in heights.iter().enumerate() {
        for (x, height) in row.iter().enumerate() {
            if (40 * y + x) % 330 != 207 {
                gaps += &format!("{} {} {height}\n", 0.5 * x as f64, 0.5 * y as f64);
            }
            if x < 36 && y < 32 {
                let [across, along] = [x, y].map(|place| place as f64 / 3.0);
                rounded += &format!("{across:.2} {along:.2} {height}\n");
            }
        }
    }
    let mut quoted = "\"XY calibration\",\"500\",\"nm/pixel\"\n\"Unit\",\"um\"\n".to_owned();
    for row in &heights {
        quoted += &format!("\"{}\"\n", row.join("\",\""));
    }
    let written = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        file.to_string_lossy().into_owned()
    };
    let by_columns = written("by-columns.xyz", &by_columns);
    MAP.assert_read(&[&by_columns, "--unit", "um"], 3e-4);
    MAP.assert_read(&[&written("quoted.csv", &quoted)], 3e-4);
    let gaps = written("gaps.xyz", &gaps);
    assert_refused(
        "surface",
        &[&gaps, "--unit", "um"],
        &["4 of 1320", "--interpolate"],
    );
    MAP.assert_read(&[&gaps, "--unit", "um", "--interpolate"], 0.01);
    let rounded = written("rounded-grid.xyz", &rounded);
    let thirds = Surface {
        points: &[36, 32],
        lengths: &[12e-6, 32e-6 / 3.0],
        height: 85.2e-9,
    };
    thirds.assert_read(&[&rounded, "--unit", "um"], 0.01);
}

/// Positions with fewer digits give the same moments within 2 %, without resampling.
#[test]
fn rounded_positions_do_not_change_a_profile() {
    let text = std::fs::read_to_string(path("surfaces/exact.txt")).unwrap();
    let mut rounded = String::new();
    for (index, row) in text.lines().enumerate() {
        let (position, height) = row.split_once('\t').or(row.split_once(' ')).unwrap();
        match position.parse::<f64>() {
            Ok(position) => rounded += &format!("{position:.1}\t{}\n", height.trim()),
            Err(_) => assert!(index == 0, "{row}"),
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("rounded.txt");
    std::fs::write(&file, format!("x [um]\tz [nm]\n{rounded}")).unwrap();
    let exact = json("surface", &["surfaces/exact.txt"]);
    let rounded = json("surface", &[&file.to_string_lossy()]);
    for field in ["rms_height", "rms_slope"] {
        let [rounded, exact] = [&rounded, &exact].map(|found| number(&found[field]));
        assert!(is_close(rounded, exact, 0.02), "{field}");
    }
    assert_eq!(rounded["points"], 1024);
}

#[test]
fn files_with_other_contents_are_read_or_refused_by_name() {
    let height = Surface {
        points: &[32, 32],
        lengths: &[16e-6, 16e-6],
        height: 81.8e-9,
    };
    height.assert_read(&["surfaces/two-channels.txt"], 0.01);
    let cropped = Surface {
        points: &[38, 32],
        lengths: &[19e-6, 16e-6],
        height: 88.13e-9,
    };
    let found = cropped.assert_read(&["surfaces/empty-border.x3p"], 3e-4);
    assert_eq!(found["files"][0]["cropped"], serde_json::json!([2, 1]));
    let of_institute = Surface {
        points: &[256],
        lengths: &[128e-6],
        height: 81.32e-9,
    };
    of_institute.assert_read(&["surfaces/nist.sdf"], 3e-4);
    let square = Surface {
        points: &[34, 34],
        lengths: &[1.7e-6, 1.7e-6],
        height: 11.74e-9,
    };
    square.assert_read(&["surfaces/wsxm-xyz.txt.gz"], 1e-3);
    let options = ["--unit", "um", "--interpolate"];
    let gaps = [&["surfaces/no-data.xyz.gz"][..], &options].concat();
    square.assert_read(&gaps, 0.02);
    let file = "surfaces/two-heights.csv";
    let words = ["\"raw\"", "\"levelled\"", "--channel"];
    assert_refused("surface", &[file], &words);
    let levelled = Surface {
        points: &[100],
        lengths: &[40e-6],
        height: 24.57e-9,
    };
    levelled.assert_read(&[file, "--channel", "levelled", "--unit", "um"], 1e-3);
    let found = json("surface", &["surfaces/microns.x3p"]);
    let warnings = texts(&found["warnings"]);
    assert!(warnings.contains("unit is probably wrong"), "{warnings}");
}

/// Errors are as large as the differences between parts, scans and continuations.
#[test]
fn errors_of_surfaces_contain_their_differences() {
    let options = |spacing: &'static str| ["--unit", "pm", "--spacing", spacing];
    let uneven = [&["surfaces/uneven-roughness.npy"][..], &options("50nm")].concat();
    let scans = [
        &["surfaces/scan-a.npy", "surfaces/scan-b.npy"][..],
        &options("50nm"),
    ]
    .concat();
    for (arguments, least, words) in [
        (uneven, 0.2, "Parts of the surface differ"),
        (scans, 0.5, "3.32-fold apart"),
    ] {
        let found = json("surface", &arguments);
        let gradient = &found["equivalent_line"]["rms_gradient"];
        let error = number(&gradient["error"]) / number(&gradient["value"]);
        let warnings = texts(&found["warnings"]);
        assert!(
            error >= least || warnings.contains(words),
            "{error} {warnings}"
        );
    }
    let sampled = [&["surfaces/hurst-half.npy"][..], &options("0.1um")].concat();
    let found = json("surface", &sampled);
    if let Some(hurst) = found["hurst_exponent"].as_object() {
        let error = number(&hurst["error"]);
        assert!((number(&hurst["value"]) - 0.5).abs() <= error, "{hurst:?}");
    }
}

/// The error of a pull-off force does not exceed the force of the smooth surface.
#[test]
fn the_error_of_a_pull_off_force_is_not_above_the_smooth_surface() {
    let found = json(
        "surface",
        &[
            "surfaces/fit-error.npy",
            "--unit",
            "pm",
            "--spacing",
            "30nm",
            "--modulus",
            "1GPa",
            "--work",
            "50mJ/m2",
        ],
    );
    let force = &found["adhesion"]["pull_off_force"];
    for field in ["median_interval", "confidence_interval"] {
        let [low, high] = [0, 1].map(|end| number(&force[field][end]));
        assert!(0.0 < low && low < high && high < 33.3e-6, "{force}");
    }
}

/// Returns the fit of a curve with the scene of most curves and further options.
fn fit(file: &str, options: &[&str]) -> Value {
    json("fit", &[&[file][..], &SPHERE, options].concat())
}

fn interval(fit: &Value, parameter: &str) -> [f64; 2] {
    let found = &fit["parameters"][parameter];
    [number(&found["low"]), number(&found["high"])]
}

/// Asserts that an interval contains a value.
fn assert_holds(fit: &Value, parameter: &str, truth: f64) {
    let [low, high] = interval(fit, parameter);
    assert!((low..=high).contains(&truth), "{}", fit["parameters"]);
    assert!(
        fit["parameters"][parameter]["at_end"].is_null(),
        "{}",
        fit["parameters"]
    );
}

/// Asserts that γ and E* are those of most curves, to these shares, and that the model describes
/// the curve.
fn assert_fitted(fit: &Value, of_work: f64, of_modulus: f64) {
    for (parameter, truth, tolerance) in [("work", 0.06, of_work), ("modulus", 2e6, of_modulus)] {
        let value = number(&fit["parameters"][parameter]["value"]);
        assert!(
            is_close(value, truth, tolerance),
            "{}: {parameter} {value}",
            fit["command"]
        );
    }
    assert_eq!(fit["described"], true, "{}", fit["command"]);
}

#[test]
fn curves_of_a_sphere_give_its_work_and_modulus() {
    // The last stated digits of 60.0 mJ/m² and 2.00 MPa, and of 60 mJ/m² and 2.0 MPa.
    assert_fitted(&fit("forces/plain.csv", &[]), 8e-4, 2.5e-3);
    for (file, options) in [
        ("forces/retraction-only.csv", &[][..]),
        ("forces/pyjibe.tab", &[]),
        ("forces/jpk-text.txt", &[]),
        ("forces/side-by-side.csv", &[]),
        ("forces/cycles.csv", &[]),
        ("forces/tilt-in-height.csv", &["--tilt", "remove"]),
        ("forces/z-and-d.csv", &["--units", "um,3nN"]),
    ] {
        assert_fitted(&fit(file, options), 8e-3, 2.5e-2);
    }
    let noisy = fit("forces/noisy-snap-in.csv", &[]);
    assert_holds(&noisy, "work", 0.06);
    assert_holds(&noisy, "modulus", 2e6);
}

#[test]
fn what_was_taken_or_left_is_stated() {
    let tilted = fit("forces/tilt-in-height.csv", &[]);
    let reading = texts(&tilted["reading"]);
    assert!(reading.contains("A tilt remains"), "{reading}");
    let units = fit("forces/wrong-unit-in-header.csv", &["--units", "um,3nN"]);
    assert_fitted(&units, 8e-3, 2.5e-2);
    let reading = texts(&units["reading"]);
    assert!(reading.contains("the file states nm"), "{reading}");
    let average = fit("forces/softmech-header.csv", &["--segments", "1"]);
    let reading = texts(&average["reading"]);
    assert!(reading.contains("F_avg (N)"), "{reading}");
}

/// In a loading by steps no point after first contact counts as before it. The contact begins at
/// the first force far below zero.
#[test]
fn a_loading_by_steps_begins_at_its_first_step() {
    let found = fit("forces/stairs.csv", &[]);
    assert_fitted(&found, 8e-3, 2.5e-2);
    let noise = number(&found["noise"]);
    assert!((4e-9..6e-9).contains(&noise), "{noise:e}");
    let text = std::fs::read_to_string(path("forces/stairs.csv")).unwrap();
    let forces = text.lines().skip(1).map(|row| row.split(',').nth(1));
    let is_contact = |force: Option<&str>| force.unwrap().parse::<f64>().unwrap() < -0.1;
    let first = forces.map(is_contact).position(|touches| touches).unwrap();
    let reading = texts(&found["reading"]);
    let (before, _) = reading.split_once(" before contact").unwrap();
    let before: usize = before.rsplit(' ').next().unwrap().parse().unwrap();
    assert!(before <= first && before > first / 2, "{before} {first}");
}

/// The retraction ends in contact: γ follows from the fit, and no pull-off force is stated.
#[test]
fn a_curve_that_does_not_detach_has_no_pull_off_force() {
    let found = fit("forces/not-detached.csv", &[]);
    let work = number(&found["parameters"]["work"]["value"]);
    assert!((work - 0.0597).abs() < 5e-4, "{work}");
    assert_holds(&found, "work", 0.06);
    assert!(found["pull_off_force"].is_null());
}

/// Without adhesion γ has an upper bound, and the interval begins at 0.
#[test]
fn a_curve_without_adhesion_gives_a_bound() {
    let options = [
        "--set",
        "form.radius=5u",
        "--set",
        "length=16u",
        "--set",
        "loading_stiffness=0.05",
    ];
    let found = fit("forces/nonadhesive.csv", &options);
    assert_eq!(interval(&found, "work")[0], 0.0);
    assert_holds(&found, "modulus", 1e4);
}

/// Quarters of a curve that the model does not describe have no intervals, or intervals that
/// overlap.
#[test]
#[ignore = "four fits that take four seconds"]
fn parts_of_a_curve_that_is_not_described_do_not_contradict_each_other() {
    let fits =
        ["a", "b", "c", "d"].map(|part| fit(&format!("forces/not-described-{part}.csv"), &[]));
    for parameter in ["work", "modulus"] {
        let intervals = fits.each_ref().map(|fit| interval(fit, parameter));
        let low = intervals
            .iter()
            .fold(0.0, |most: f64, ends| most.max(ends[0]));
        let high = intervals
            .iter()
            .fold(f64::MAX, |least, ends| least.min(ends[1]));
        assert!(low <= high, "{parameter} {intervals:?}");
    }
    assert!(fits.iter().all(|fit| fit["described"] == false));
}

/// The modulus of a soft gel in a liquid, whose drag rises before contact.
#[test]
fn a_drag_does_not_hide_the_modulus() {
    let options = [
        "--set",
        "form.radius=5u",
        "--set",
        "length=30u",
        "--set",
        "loading_stiffness=0.0155",
    ];
    let found = fit("forces/drag-excludes-modulus.csv", &options);
    assert_holds(&found, "modulus", 1e4);
    assert_holds(&found, "work", 1e-5);
}

/// A cone that is fitted by a sphere is not described, however long its retraction is. A force that
/// rises faster than its instrument allows gives no modulus.
#[test]
fn what_the_model_cannot_describe_is_said() {
    let cone = [
        "--segments",
        "2",
        "--set",
        "form.radius=5u",
        "--set",
        "length=30u",
        "--set",
        "loading_stiffness=0.05",
    ];
    let found = fit("forces/free-part-dilutes.csv", &cone);
    assert_eq!(found["described"], false);
    let steep = [
        "--set",
        "form.radius=20n",
        "--set",
        "length=300n",
        "--set",
        "loading_stiffness=0.16",
    ];
    let found = fit("forces/slope-above-k.csv", &steep);
    let reason = found["reason"].as_str().unwrap();
    for cause in ["stiffness", "sensitivity", "height"] {
        assert!(reason.contains(cause), "{reason}");
    }
    assert_eq!(found["parameters"]["modulus"]["at_end"], "high");
}

/// The curve of a rough sphere with γ = 50 mJ/m², compared with another profile of the same
/// roughness: the interval holds γ.
#[test]
fn a_curve_of_another_profile_gives_a_wide_interval() {
    let found = json(
        "fit",
        &[
            "forces/rough-seed-2.csv",
            "rough-sphere",
            "--set",
            "roughness.seed=5",
            "--set",
            "loading_stiffness=200",
            "--set",
            "numerics.points=2048",
            "--free",
            "work,offset",
        ],
    );
    let [low, high] = interval(&found, "work");
    assert!((low..=high).contains(&0.05), "{low} {high}");
}
