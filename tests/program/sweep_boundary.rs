//! `asperity sweep boundary`: from a plan to a table, and its messages without a boundary.

use super::program::{asperity, failed, json, rows};
use serde_json::Value;
use std::path::Path;

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
    asperity(&["sweep", plan.to_str().unwrap(), "-o", &study]).succeeded();
    study
}

#[test]
fn a_boundary_is_found_for_each_place_protocol_and_level() {
    let place = tempfile::tempdir().unwrap();
    let study = study(place.path(), "Linear(path: \"adhesion.kappa\", from: 0.5, to: 6.0, count: 12)");
    let object = json(&["sweep", "boundary", &study, "--level", "0.5", "--level", "0.1", "--format", "json"]);
    assert_eq!(object["lines"], 8);
    let boundaries = object["boundaries"].as_array().unwrap();
    assert_eq!(boundaries.len(), 2 * 2 * 2);
    for boundary in boundaries {
        let kappa = boundary["kappa"].as_f64().unwrap();
        assert!((0.5..6.0).contains(&kappa), "{boundary}");
        if let Some([low, high]) = boundary["confidence_interval"].as_array().map(Vec::as_slice) {
            assert!(low.as_f64().unwrap() <= kappa && kappa <= high.as_f64().unwrap(), "{boundary}");
        }
    }
    // A smaller threshold is reached at a larger κ.
    for pair in boundaries.chunks(2) {
        assert!(pair[0]["kappa"].as_f64() < pair[1]["kappa"].as_f64(), "{pair:?}");
    }
    let text = asperity(&["sweep", "boundary", &study]).succeeded();
    assert!(text.contains("zero force"), "{text}");
    let csv = asperity(&["sweep", "boundary", &study, "--format", "csv"]).succeeded();
    let columns = rows(&csv).next().unwrap().split(',').count();
    assert!(rows(&csv).all(|line| line.split(',').count() == columns), "{csv}");
}

/// Σ k^(j−1−2H) over the modes 1 to 32.
fn moment(hurst: f64, j: i32) -> f64 {
    (1..=32).map(|k| f64::from(k).powf(f64::from(j) - 1.0 - 2.0 * hurst)).sum()
}

#[test]
fn a_boundary_in_kappa_is_one_in_elastic_energy() {
    let place = tempfile::tempdir().unwrap();
    let study = study(place.path(), "Linear(path: \"adhesion.kappa\", from: 0.5, to: 6.0, count: 12)");
    let json =
        |arguments: &[&str]| json(&[&["sweep", "boundary", &study, "--format", "json"], arguments].concat());
    let of = |object: &Value, name: &str| -> Vec<(f64, f64)> {
        let number = |one: &Value, name: &str| one[name].as_f64().unwrap();
        let all = object["boundaries"].as_array().unwrap().iter();
        all.map(|one| (number(one, "H"), number(one, name))).collect()
    };
    let levels = ["--level", "0.1"];
    let kappas = of(&json(&levels), "kappa");
    let ratios =
        of(&json(&[&levels[..], &["--over", "elastic_energy_ratio"]].concat()), "elastic_energy_ratio");
    assert_eq!(kappas.len(), 4);
    for ((hurst, kappa), (_, ratio)) in kappas.iter().zip(&ratios) {
        let sum = |j| moment(*hurst, j);
        let expected = 0.25 * kappa * kappa * sum(1) / (sum(0) * sum(2)).sqrt();
        assert!((ratio / expected - 1.0).abs() < 1e-12, "{ratio} {expected}");
    }
    let wrong = failed(2, &["sweep", "boundary", &study, "--over", "work"]);
    assert!(wrong.contains("possible values: kappa, elastic_energy_ratio"), "{wrong}");
}

#[test]
fn a_study_without_kappa_has_none_and_says_so() {
    let place = tempfile::tempdir().unwrap();
    let study = study(place.path(), "List(path: \"roughness.rms_height\", values: [1.0e-7])");
    let refused = failed(1, &["sweep", "boundary", &study]);
    assert!(refused.contains("no axis adhesion.kappa or adhesion.elastic_energy_ratio"), "{refused}");
    let wrong = failed(2, &["sweep", "boundary", &study, "--level", "1.5"]);
    assert!(wrong.contains("above 0 and below 1"), "{wrong}");
}
