//! Errors of a plan are found before any computation.

use super::SMALL;
use asperity::study::{Changes, Plan};
use std::time::Instant;

fn wrong(text: &str) -> String {
    Plan::parse(text, "p.ron", &Changes::default())
        .expect_err(text)
        .to_string()
}

#[test]
fn each_mistake_has_its_message() {
    for (from, to, expected) in [
        (
            "axes:",
            "axis:",
            "p.ron:12:5: axis: no such field; did you mean axes?",
        ),
        (
            "Linear(",
            "Liner(",
            "p.ron:13:9: axes.0 = Liner: allowed: Linear, Logarithmic, List",
        ),
        (
            "from: 0.5",
            "form: 0.5",
            "form: no such field; did you mean from?",
        ),
        (
            "profiles: 3",
            "profiles: three",
            "p.ron:18:15: profiles = three: a whole number is expected here",
        ),
        (
            "profiles: 3",
            "profiles: 0",
            "p.ron: profiles = 0: allowed: from 1 to 1000000",
        ),
        ("regime,", "regimes,", "(did you mean regime?)"),
        (
            "regime,",
            "regime, regime,",
            "record: regime is given twice",
        ),
        (
            "version: 1,\n    title",
            "version: 2,\n    title",
            "version = 2: allowed: 1",
        ),
        (
            "preloads: [0.01, 0.3]",
            "preloads: [0.0, 0.3]",
            "preload 0.0: allowed: above 0",
        ),
        (
            "\n    ],\n    preloads: [0.01, 0.3],",
            "List(path: \"preload\", values: [0.1]), List(path: \"preload\", values: [0.2])],",
            "axis preload: given twice",
        ),
        (
            "preloads: [0.01, 0.3]",
            "preloads: [0.3, NaN]",
            "values must be finite",
        ),
        (
            "\"roughness.hurst\"",
            "\"roughness.hurts\"",
            "did you mean roughness.hurst?",
        ),
        (
            "\"roughness.hurst\"",
            "\"form.radius\"",
            "the scene has no form.radius",
        ),
        (
            "\"roughness.hurst\"",
            "\"adhesion.kappa\"",
            "axis adhesion.kappa: given twice",
        ),
        (
            "\"adhesion.kappa\"",
            "\"kappa\"",
            "axis kappa: no such number; did you mean adhesion.kappa?",
        ),
        (
            "\"roughness.hurst\"",
            "\"adhesion.work\"",
            "axis adhesion.work: adhesion.kappa sets it as well",
        ),
        (
            "\"roughness.hurst\"",
            "\"loading.7.0\"",
            "its 2 loading stages are counted from 0",
        ),
        (
            "\"roughness.hurst\"",
            "\"preload\"",
            "axis preload: given twice",
        ),
        (
            "(kappa: 1.0)",
            "(work: 0.05, closing_work: 0.02)",
            "and the scene has another one on closing",
        ),
        (
            "[0.8, 0.3]",
            "[0.8, 1.3]",
            "cell 4 (adhesion.kappa = 0.5, roughness.hurst = 1.3, ",
        ),
        (
            "[0.8, 0.3]",
            "[0.8, 1.3]",
            "roughness.hurst = 1.3: allowed: above 0 and below 1 (Hurst exponent)",
        ),
        (
            "scene: (",
            "base: \"jkr-sphere\", scene: (",
            "`base` and `scene` are given",
        ),
        (
            "points: 256",
            "points: 16",
            "roughness.modes = (1, 64): allowed: last mode at most points/2 = 8",
        ),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL);
        let message = wrong(&text);
        assert!(message.contains(expected), "{to}: {message}");
        assert!(
            message.lines().all(|line| line.starts_with("p.ron")),
            "{message}"
        );
    }
    let smooth =
        "(version: 1, base: \"jkr-sphere\", preloads: [0.1], profiles: 2, record: [regime])";
    let message = wrong(smooth);
    assert!(
        message.contains("this scene is smooth; allowed: an axis preload_in_N"),
        "{message}"
    );
    assert!(
        message.contains("profiles = 2: more than one profile, and the profile of this scene is fixed; allowed: random roughness (SelfAffine"),
        "{message}"
    );
    let message = wrong(&SMALL[..SMALL.len() / 2]);
    assert!(message.starts_with("p.ron:"), "{message}");
}

#[test]
fn too_many_cells_are_refused_at_once() {
    let clock = Instant::now();
    let text = SMALL.replace("count: 4", "count: 1000000");
    let message = wrong(&text.replace("values: [1.0e6, 2.0e6]", "values: [1.0e6, 2.0e6, 3.0e6]"));
    assert!(
        message.contains("1000000 × 2 × 3 × 2 cells; allowed: at most 10000000"),
        "{message}"
    );
    let message = wrong(&text.replace("profiles: 3", "profiles: 1000000"));
    assert!(
        message.contains("on 1000000 profiles; allowed: at most 100000000 together"),
        "{message}"
    );
    let message = wrong(&SMALL.replace("count: 4", "count: 18446744073709551615"));
    assert!(message.contains("allowed: from 2 to 1000000"), "{message}");
    assert!(clock.elapsed().as_secs() < 20, "nothing is gone through");
}

#[test]
fn scenes_stand_beside_their_plans() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let preset = asperity::scene::library::find_scene("rough-sphere")
        .unwrap()
        .text;
    std::fs::write(folder.join("mine.ron"), preset).unwrap();
    let text = "(version: 1, base: \"mine.ron\", set: {\"roughness.seed\": \"7\"}, profiles: 2, record: [regime])";
    std::fs::write(folder.join("plan.ron"), text).unwrap();
    let open = |name: &str| Plan::open(folder.join(name).to_str().unwrap(), &Changes::default());
    let plan = open("plan.ron").unwrap();
    assert_eq!((plan.seed, plan.cells()), (7, 1));
    let changes = Changes {
        set: vec![("roughness.hurst".into(), "1.5".into())],
        lines: None,
    };
    let message = Plan::open(folder.join("plan.ron").to_str().unwrap(), &changes)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("roughness.hurst = 1.5: allowed: above 0 and below 1"),
        "{message}"
    );
    std::fs::write(folder.join("lost.ron"), text.replace("mine", "other")).unwrap();
    assert!(
        open("lost.ron")
            .unwrap_err()
            .to_string()
            .contains("other.ron")
    );
    assert!(
        open("none.ron")
            .unwrap_err()
            .to_string()
            .contains("cannot be read")
    );
    let message = Plan::open("figure5a", &Changes::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("did you mean figure-5a?"), "{message}");
}
