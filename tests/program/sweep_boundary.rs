//! `asperity sweep boundary`, in κ and in the elastic energy.

use super::program::{asperity_in, failed, json};

/// A study of few springs whose adhesion without a load falls below a tenth between κ = 0.5 and 6.
const PLAN: &str = r#"(
    version: 1,
    base: "pressure-sensitive",
    set: {"numerics.points": "256", "roughness.modes": "(1, 32)"},
    axes: [
        List(path: "roughness.hurst", values: [0.4, 0.8]),
        Linear(path: "adhesion.kappa", from: 0.5, to: 6.0, count: 12),
    ],
    profiles: 8,
    record: [first_touch_adhesion_share, zero_force_adhesion_share],
)"#;

/// Σ k^(j−1−2H) over the modes 1 to 32.
fn moment(hurst: f64, j: i32) -> f64 {
    (1..=32)
        .map(|k| f64::from(k).powf(f64::from(j) - 1.0 - 2.0 * hurst))
        .sum()
}

#[test]
fn a_boundary_in_kappa_is_one_in_elastic_energy() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plan.ron"), PLAN).unwrap();
    asperity_in(place.path(), &["sweep", "plan.ron", "-o", "study"]).succeeded();
    let study = place.path().join("study").to_str().unwrap().to_owned();
    // H and the boundary at each place and protocol.
    let boundaries = |over: &str| -> Vec<[f64; 2]> {
        let of = [
            "sweep", "boundary", &study, "--format", "json", "--where", "0.1", "--x", over,
        ];
        let number = |one: &serde_json::Value, name: &str| one[name].as_f64().unwrap();
        let all = json(&of)["boundaries"].as_array().unwrap().clone();
        all.iter()
            .map(|one| [number(one, "H"), number(one, over)])
            .collect()
    };
    let [kappas, ratios] = ["kappa", "elastic_energy_ratio"].map(boundaries);
    assert_eq!(kappas.len(), 4);
    for ([hurst, kappa], [_, ratio]) in kappas.into_iter().zip(ratios) {
        assert!((0.5..6.0).contains(&kappa), "{kappa}");
        let sum = |j| moment(hurst, j);
        let expected = 0.25 * kappa * kappa * sum(1) / (sum(0) * sum(2)).sqrt();
        assert!((ratio / expected - 1.0).abs() < 1e-12, "{ratio} {expected}");
    }
    let wrong = failed(2, &["sweep", "boundary", &study, "--x", "work"]);
    assert!(
        wrong.contains("possible values: kappa, elastic_energy_ratio"),
        "{wrong}"
    );
}
