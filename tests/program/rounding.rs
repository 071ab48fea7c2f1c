//! The catalogue of hard cases under other directions of rounding: digits of each error independent of the rounding of
//! each operation.
//!
//! `docs/rounding.md` states the method and holds the table of digits; the same number of digits less one is required
//! here. After a change of the catalogue `UPDATE_ROUNDING=1 cargo test --test program rounding` writes the table anew.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Directions of rounding of every operation; the first is the usual one.
const DIRECTIONS: [&str; 4] = ["to nearest", "upward", "downward", "towards zero"];

/// Digits of an unchanged number.
const ALL_DIGITS: f64 = 16.0;

/// Fewest checks that must change: without any the rounding was not perturbed.
const MOVED: usize = 20;

/// Marks of the beginning and the end of the table.
const START: &str = "<!-- digits -->\n";
const END: &str = "<!-- end of digits -->";

/// Name and edges of a check, in the order of the catalogue.
type Errors = Vec<((String, String), Option<f64>)>;

/// The library that sets the direction, built by the C compiler; `None` without a compiler.
fn library(folder: &Path) -> Option<PathBuf> {
    let made = folder.join("direction.so");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/rounding/direction.c");
    let compiled =
        Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&made).arg(source).arg("-lm").output();
    match compiled {
        Ok(output) if output.status.success() => Some(made),
        Ok(output) => panic!("cc: {}", String::from_utf8_lossy(&output.stderr)),
        Err(_) => None,
    }
}

/// The errors of all checks except the large ones under one direction of rounding.
fn errors(library: &Path, direction: &str) -> Errors {
    let run = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["check", "--quick", "--format", "json"])
        .env("LD_PRELOAD", library)
        .env("ROUNDING", direction)
        .output()
        .unwrap();
    // Bounds are those of rounding to nearest: beyond them the exit code is 1, but the table is still printed.
    let report: Value = serde_json::from_slice(&run.stdout)
        .unwrap_or_else(|error| panic!("{direction}: {error}\n{}", String::from_utf8_lossy(&run.stderr)));
    let text = |value: &Value| value.as_str().unwrap_or_default().to_string();
    let checks = report["checks"].as_array().unwrap();
    checks
        .iter()
        .map(|check| ((text(&check["case"]), text(&check["edges"])), check["error"].as_f64()))
        .collect()
}

/// Digits of a check that do not depend on the rounding.
struct Kept {
    /// The error under rounding to nearest.
    error: Option<f64>,
    /// Decimal digits of the error, counted from one, that are the same in all directions with a number.
    digits: f64,
    /// Directions without a number.
    without: Vec<&'static str>,
}

/// Compares the errors of one check, in the order of [`DIRECTIONS`].
fn kept(errors: &[Option<f64>]) -> Kept {
    let nearest = errors[0];
    let change =
        errors.iter().flatten().map(|error| (error - nearest.unwrap_or(*error)).abs()).fold(0.0, f64::max);
    let digits = if change == 0.0 { ALL_DIGITS } else { (-change.log10()).clamp(0.0, ALL_DIGITS) };
    let none = |(direction, error): (&&'static str, &Option<f64>)| error.is_none().then_some(*direction);
    Kept { error: nearest, digits, without: DIRECTIONS.iter().zip(errors).filter_map(none).collect() }
}

fn row((case, edges): &(String, String), kept: &Kept) -> String {
    let error = kept.error.map_or("–".to_string(), |error| format!("{:.1e}", error + 0.0));
    let digits = (kept.digits * 10.0).floor() / 10.0;
    let demanded = (kept.digits.floor() - 1.0).max(0.0);
    format!("| `{case}` | {edges} | {error} | {digits:.1} | {demanded} | {} |\n", kept.without.join(", "))
}

/// Digits required of each check, and the directions allowed without a number.
fn demanded(table: &str) -> BTreeMap<(String, String), (f64, String)> {
    let rows = table.lines().skip(2).map(|row| {
        let columns: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [case, edges, _, _, digits, without] = columns[..] else { panic!("{row}") };
        (
            (case.trim_matches('`').to_string(), edges.to_string()),
            (digits.parse().unwrap(), without.to_string()),
        )
    });
    rows.collect()
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn errors_keep_their_digits_however_operations_are_rounded() {
    let folder = tempfile::tempdir().unwrap();
    let library = if cfg!(target_os = "linux") { library(folder.path()) } else { None };
    let Some(library) = library else {
        eprintln!("SKIPPED: without Linux and a C compiler rounding is not perturbed");
        return;
    };
    let library = library.as_path();
    let of_directions: Vec<Errors> = std::thread::scope(|scope| {
        let runs: Vec<_> =
            DIRECTIONS.iter().map(|direction| scope.spawn(move || errors(library, direction))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let checks: Vec<_> = of_directions[0].iter().map(|(name, _)| name.clone()).collect();
    let kept: Vec<Kept> = (0..checks.len())
        .map(|index| {
            assert!(of_directions.iter().all(|errors| errors[index].0 == checks[index]));
            kept(&of_directions.iter().map(|errors| errors[index].1).collect::<Vec<_>>())
        })
        .collect();
    let moved = kept.iter().filter(|kept| kept.digits < ALL_DIGITS).count();
    assert!(moved >= MOVED, "{moved} checks change: rounding was not perturbed");

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rounding.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(START).unwrap();
    let (table, after) = rest.split_once(END).unwrap();
    if std::env::var_os("UPDATE_ROUNDING").is_some() {
        let head = "| case | edges | error | digits | at least | no number |\n| --- | --- | --- | --- | --- | --- |\n";
        let rows: String = checks.iter().zip(&kept).map(|(name, kept)| row(name, kept)).collect();
        std::fs::write(path, format!("{before}{START}{head}{rows}{END}{after}")).unwrap();
        return;
    }
    let demanded = demanded(table);
    assert_eq!(demanded.len(), checks.len(), "docs/rounding.md has another catalogue: see UPDATE_ROUNDING");
    let mut lost = Vec::new();
    for (name, kept) in checks.iter().zip(&kept) {
        let (least, without) = demanded
            .get(name)
            .unwrap_or_else(|| panic!("{name:?} is not in docs/rounding.md: see UPDATE_ROUNDING"));
        if kept.digits < *least {
            lost.push(format!("{name:?} keeps {:.1} digits, at least {least} are demanded", kept.digits));
        }
        for direction in &kept.without {
            if !without.contains(direction) {
                lost.push(format!("{name:?} gives no number when rounded {direction}"));
            }
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

#[test]
fn digits_are_those_of_the_largest_change() {
    let [nearest, far] = [Some(1e-15), Some(1e-6 + 1e-15)];
    let same = kept(&[nearest; 4]);
    assert!(same.digits == ALL_DIGITS && same.without.is_empty());
    let changed = kept(&[nearest, far, nearest, None]);
    assert!((changed.digits - 6.0).abs() < 1e-6 && changed.without == ["towards zero"]);
    let table = format!("| case |\n| --- |\n{}", row(&("one".into(), "Grid".into()), &changed));
    let demanded = demanded(&table);
    assert_eq!(demanded[&("one".to_string(), "Grid".to_string())].1, "towards zero");
    assert!(demanded.values().all(|(digits, _)| (4.0..=5.0).contains(digits)));
}
