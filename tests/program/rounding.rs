//! The catalogue of hard cases with every operation rounded to nearest, upward, downward and
//! towards zero.
//!
//! Each case has an error; the digits of the largest change of that error between the directions
//! are those that do not depend on the rounding. A formula that is well conditioned and well
//! evaluated keeps 14 to 16 of them; fewer show a cancellation, or a decision that depends on a
//! last bit. All operations of a run are rounded the same wrong way, so that errors that otherwise
//! average out add up. The unchanged program runs with a small library preloaded that sets the
//! direction of the processor; constants of the compiler and errors that cancel under all
//! directions escape the method.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Directions of rounding of every operation; the first is the usual one.
const DIRECTIONS: [&str; 4] = ["to nearest", "upward", "downward", "towards zero"];

/// Fewest checks that must change: without any the rounding was not perturbed.
const MOVED: usize = 12;

/// Digits that a case must keep.
fn least_digits(case: &str) -> f64 {
    match case {
        // The reference is a sum of 20 000 trapezia and more, whose roundings add up where all go
        // the same way.
        "no-energy-for-nothing" => 11.0,
        // The error is counted in roundings of the indentation.
        "far-loads" => 0.0,
        _ => 13.0,
    }
}

/// The library that sets the direction, built by the C compiler; `None` without a compiler.
fn library(folder: &Path) -> Option<PathBuf> {
    let made = folder.join("direction.so");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/rounding/direction.c");
    let compiled = Command::new("cc")
        .args(["-shared", "-fPIC", "-o"])
        .arg(&made)
        .arg(source)
        .arg("-lm")
        .output();
    let output = compiled.ok().filter(|_| cfg!(target_os = "linux"))?;
    assert!(
        output.status.success(),
        "cc: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(made)
}

/// Names and errors of all checks under one direction of rounding.
fn errors(library: &Path, direction: &str) -> Vec<(String, Option<f64>)> {
    let run = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["check", "--format", "json"])
        .env("LD_PRELOAD", library)
        .env("ROUNDING", direction)
        .output()
        .unwrap();
    // Bounds are those of rounding to nearest: beyond them the exit code is 1, but the table is
    // still printed.
    let report: Value = serde_json::from_slice(&run.stdout).unwrap_or_else(|error| {
        panic!(
            "{direction}: {error}\n{}",
            String::from_utf8_lossy(&run.stderr)
        )
    });
    let checks = report["checks"].as_array().unwrap().iter();
    checks
        .map(|check| {
            (
                check["case"].as_str().unwrap().to_owned(),
                check["error"].as_f64(),
            )
        })
        .collect()
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn errors_keep_their_digits_however_operations_are_rounded() {
    let folder = tempfile::tempdir().unwrap();
    let Some(library) = library(folder.path()) else {
        eprintln!("SKIPPED: without Linux and a C compiler rounding is not perturbed");
        return;
    };
    let library = library.as_path();
    let runs: Vec<_> = std::thread::scope(|scope| {
        let runs = DIRECTIONS.map(|direction| scope.spawn(move || errors(library, direction)));
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let mut moved = 0;
    for (index, (case, nearest)) in runs[0].iter().enumerate() {
        let nearest = nearest.unwrap_or_else(|| panic!("{case} has no error"));
        let change = runs.iter().zip(DIRECTIONS).map(|(run, direction)| {
            assert_eq!(run[index].0, *case);
            let error = run[index]
                .1
                .unwrap_or_else(|| panic!("{case} has no error when rounded {direction}"));
            (error - nearest).abs()
        });
        let digits = -change.fold(1e-16, f64::max).log10();
        moved += usize::from(digits < 16.0);
        assert!(
            digits >= least_digits(case),
            "{case} keeps {digits:.1} digits"
        );
    }
    assert!(
        moved >= MOVED,
        "{moved} checks change: rounding was not perturbed"
    );
}
