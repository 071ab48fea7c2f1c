//! `asperity sweep boundary`: from a plan to a table, and what it says where there is no boundary to find.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn asperity(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.args(arguments).output().unwrap()
}

fn told(output: &[u8]) -> String {
    String::from_utf8(output.to_vec()).unwrap()
}

/// A study of few springs whose adhesion without a load falls below a tenth between κ = 0.5 and 6.
fn study(folder: &Path, axis: &str) -> String {
    let plan = folder.join("plan-of-mine.ron");
    let text = format!(
        "(version: 1, base: \"pressure-sensitive\",
          set: {{\"numerics.points\": \"256\", \"roughness.modes\": \"(1, 32)\"}},
          axes: [List(path: \"roughness.hurst\", values: [0.4, 0.8]), {axis}],
          lines: 8, record: [zero_load_adhesion_share, zero_force_adhesion_share])"
    );
    std::fs::write(&plan, text).unwrap();
    let study = folder.join("study").to_str().unwrap().to_string();
    let done = asperity(&["sweep", plan.to_str().unwrap(), "-o", &study]);
    assert!(done.status.success(), "{}", told(&done.stderr));
    study
}

#[test]
fn a_boundary_is_found_for_each_place_protocol_and_level() {
    let place = tempfile::tempdir().unwrap();
    let study = study(place.path(), "Linear(path: \"kappa\", from: 0.5, to: 6.0, count: 12)");
    let found =
        asperity(&["sweep", "boundary", &study, "--level", "0.5", "--level", "0.1", "--format", "json"]);
    assert!(found.status.success(), "{}", told(&found.stderr));
    let object: Value = serde_json::from_slice(&found.stdout).unwrap();
    assert_eq!(object["lines"], 8);
    let boundaries = object["boundaries"].as_array().unwrap();
    assert_eq!(boundaries.len(), 2 * 2 * 2);
    for boundary in boundaries {
        let kappa = boundary["kappa"].as_f64().unwrap();
        assert!((0.5..6.0).contains(&kappa), "{boundary}");
        let cycles = boundary["kappa_cycles"].as_f64().unwrap();
        assert!((kappa / cycles - std::f64::consts::TAU.sqrt()).abs() < 1e-12);
        if let Some([low, high]) = boundary["confidence_interval"].as_array().map(Vec::as_slice) {
            assert!(low.as_f64().unwrap() <= kappa && kappa <= high.as_f64().unwrap(), "{boundary}");
        }
    }
    // Asking for less left over takes a larger κ.
    for pair in boundaries.chunks(2) {
        assert!(pair[0]["kappa"].as_f64() < pair[1]["kappa"].as_f64(), "{pair:?}");
    }
    let text = asperity(&["sweep", "boundary", &study]);
    assert!(told(&text.stdout).contains("zero force"), "{}", told(&text.stdout));
    let csv = told(&asperity(&["sweep", "boundary", &study, "--format", "csv"]).stdout);
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns), "{csv}");
}

#[test]
fn a_study_without_kappa_has_none_and_says_so() {
    let place = tempfile::tempdir().unwrap();
    let study = study(place.path(), "List(path: \"roughness.rms_height\", values: [1.0e-7])");
    let refused = asperity(&["sweep", "boundary", &study]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(told(&refused.stderr).contains("no axis `kappa`"), "{}", told(&refused.stderr));
    let wrong = asperity(&["sweep", "boundary", &study, "--level", "1.5"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(told(&wrong.stderr).contains("above 0 and below 1"), "{}", told(&wrong.stderr));
}
