//! Figures of studies, drawn by the program.

use super::program::{Finished, asperity_in};
use std::fs;
use std::path::Path;

const PLAN: &str = r#"(
    version: 1,
    title: "Small",
    scene: (
        version: 1,
        material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
        adhesion: (kappa: 1.0),
        loading: [ToForce(1.0e-5), ToSeparation],
        numerics: (points: 256, edges: SubCell),
    ),
    axes: [
        Linear(path: "roughness.hurst", from: 0.1, to: 0.9, count: 9),
        Logarithmic(path: "adhesion.kappa", from: 0.25, to: 16, count: 7),
    ],
    preloads: [0.01, 0.1, 1.0],
    profiles: 4,
    record: [first_touch_adhesion_share, adhesion_coefficient, pull_off_force, regime],
)"#;

fn asperity(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let Finished {
        code,
        stdout,
        stderr,
    } = asperity_in(folder, arguments);
    if code == Some(0) {
        Ok(stdout)
    } else {
        Err(stderr)
    }
}

#[test]
fn a_study_is_drawn_as_a_map_and_as_curves() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("plan.ron"), PLAN).unwrap();
    let plot = |more: &[&str]| asperity(at, &[&["sweep", "plot", "study"], more].concat());

    asperity(at, &["sweep", "plan.ron", "-o", "study", "--shard", "1/2"]).unwrap();
    assert!(plot(&[]).unwrap_err().contains("has not been merged yet"));
    asperity(at, &["sweep", "plan.ron", "-o", "study"]).unwrap();

    // Of preloads the first is shown.
    assert_eq!(plot(&[]), plot(&["--at", "preload=0.01"]));
    let note = asperity_in(at, &["sweep", "plot", "study"]).stderr;
    assert!(
        note.contains("is the first of 3 preloads: --at preload=VALUE selects another"),
        "{note}"
    );
    let error = plot(&["--x", "preload"]).unwrap_err();
    assert!(
        error.starts_with("too many axes are free for a figure: roughness.hurst (0.1, "),
        "{error}"
    );
    assert!(
        error
            .trim_end()
            .ends_with("--at roughness.hurst=0.1 fixes one"),
        "{error}"
    );
    for (arguments, expected) in [
        (
            vec!["--quantity", "force"],
            "allowed: first_touch_adhesion_share, adhesion_coefficient",
        ),
        (
            vec!["--quantity", "regime"],
            "this study has no such quantity",
        ),
        (
            vec!["--x", "hurst"],
            "no such axis; allowed: roughness.hurst, adhesion.kappa, preload",
        ),
        (
            vec!["--at", "preload=0.2"],
            "preload = 0.2: the study has no such value; allowed: 0.01, 0.1, 1",
        ),
        (
            vec!["--at", "preload=0.1", "--at", "preload=1"],
            "preload: named as a fixed value and as a fixed value",
        ),
        (
            vec!["--at", "adhesion.kappa=1", "--x", "adhesion.kappa"],
            "kappa: named as the horizontal axis and as a fixed value",
        ),
        (vec!["--at", "preload"], "allowed: AXIS=VALUE"),
    ] {
        let error = plot(&arguments).unwrap_err();
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }

    let map = plot(&["--at", "preload=0.1", "-o", "-"]).unwrap();
    assert_eq!(map, plot(&["--at", "preload=0.1", "-o", "-"]).unwrap());
    assert!(map.starts_with("<svg ") && map.contains("Small"), "{map}");
    // Two panels with a scale of 64 colours each.
    assert!(
        map.matches("crispEdges").count() > 128 && map.contains("(b) "),
        "{map}"
    );
    plot(&["--at", "preload=0.1", "-o", "map.svg"]).unwrap();
    assert_eq!(fs::read_to_string(at.join("map.svg")).unwrap(), map);
    assert!(
        plot(&["--at", "preload=0.1", "-o", "map.svg"])
            .unwrap_err()
            .contains("--force overwrites it")
    );

    // Into a pipe: text without colours.
    let text = plot(&["--at", "preload=0.1"]).unwrap();
    assert!(
        text.contains("Hurst exponent H") && text.contains("F_a/F_n") && !text.contains('\x1b'),
        "{text}"
    );
    let turned = plot(&["--at", "preload=0.1", "--x", "adhesion.kappa"]).unwrap();
    assert!(turned.contains("↑ Hurst exponent H"), "{turned}");

    // One free axis, and three preloads as curves.
    let curves = plot(&["--at", "roughness.hurst=0.3"]).unwrap();
    assert!(curves.contains("⠒▲⠒ F_n/(E* h L) = 1\n"), "{curves}");
    let section = plot(&[
        "--at",
        "roughness.hurst=0.3",
        "--at",
        "preload=1",
        "--quantity",
        "pull_off_force",
    ]);
    let section = section.unwrap();
    assert!(
        section.contains("F_a (") && section.contains("95 % confidence"),
        "{section}"
    );

    // Half of the cells: the others are gaps.
    asperity(at, &["sweep", "plan.ron", "-o", "half", "--shard", "1/5"]).unwrap();
    asperity(at, &["sweep", "merge", "half"]).unwrap();
    let half = asperity(at, &["sweep", "plot", "half", "--at", "preload=0.1"]).unwrap();
    assert!(half.contains("Small"), "{half}");
}
