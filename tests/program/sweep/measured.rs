//! Studies of a measured file: its content is part of the plan.

use super::{compute, tables};
use asperity::data::Control;
use asperity::study::{Changes, Folder, Plan, Shard, StudyError, merge, run_study};
use std::fs;
use std::path::Path;

const PLAN: &str = r#"(
    version: 1,
    scene: (
        version: 1,
        material: (modulus: 2.0e6),
        length: 1.0e-4,
        roughness: Measured(file: "line.csv", as_line: true),
        adhesion: (work: 0.01),
        loading: [ToForce(1.0e-3), ToSeparation],
        numerics: (points: 64, edges: Grid),
    ),
    axes: [List(path: "numerics.points", values: [64, 128, 256]), List(path: "adhesion.work", values: [0.01, 0.1])],
    record: [pull_off_force, preload_indentation],
)"#;

fn profile(amplitude: f64) -> String {
    let row = |index: i32| {
        format!(
            "{:e} {:e}\n",
            f64::from(index) * 1e-6,
            amplitude * f64::from(index % 7)
        )
    };
    (0..=110).map(row).collect()
}

/// A folder with a profile and a plan for it.
fn place() -> (tempfile::TempDir, Plan) {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("line.csv"), profile(1e-7)).unwrap();
    fs::write(place.path().join("plan.ron"), PLAN).unwrap();
    let plan = place.path().join("plan.ron");
    let plan = Plan::open(plan.to_str().unwrap(), &Changes::default()).unwrap();
    (place, plan)
}

fn begin(place: &Path, plan: &Plan) -> Result<Folder, StudyError> {
    Folder::create(&place.join("study"), plan)
}

fn hash_of(path: &Path) -> String {
    let output = std::process::Command::new("sha256sum")
        .arg(path)
        .output()
        .unwrap();
    String::from_utf8(output.stdout).unwrap()[..64].to_owned()
}

#[test]
fn the_hash_of_the_content_is_in_the_plan() {
    let (place, plan) = place();
    let folder = begin(place.path(), &plan).unwrap();
    compute(&folder, 2, Shard::WHOLE);
    merge(&folder).unwrap();
    let text = fs::read_to_string(folder.path().join("plan.ron")).unwrap();
    let sidecar = fs::read_to_string(folder.path().join("results.json")).unwrap();
    let hash = hash_of(&place.path().join("line.csv"));
    for text in [text, sidecar] {
        assert!(text.contains(&hash), "{hash}: {text}");
    }
    // The same study is continued, and read back, also from its own copy of the plan.
    begin(place.path(), &plan).unwrap();
    let again = Plan::open(
        folder.path().join("plan.ron").to_str().unwrap(),
        &Changes::default(),
    )
    .unwrap();
    assert_eq!(&again, Folder::open(folder.path()).unwrap().plan());
    begin(place.path(), &again).unwrap();
}

#[test]
fn a_file_that_has_changed_is_refused() {
    let (place, plan) = place();
    let folder = begin(place.path(), &plan).unwrap();
    compute(
        &folder,
        1,
        Shard {
            number: 1,
            count: 2,
        },
    );
    let line = place.path().join("line.csv");
    let expected = hash_of(&line);
    fs::write(&line, profile(2e-7)).unwrap();
    let found = hash_of(&line);
    let check = |error: StudyError| {
        let message = error.to_string();
        for part in [
            line.to_str().unwrap(),
            &expected,
            &found,
            "has changed",
            "study/plan.ron",
        ] {
            assert!(message.contains(part), "{part}: {message}");
        }
    };
    check(begin(place.path(), &plan).unwrap_err());
    // Also if the folder was opened before.
    check(run_study(&folder, Shard::WHOLE, Control::default().on_threads(1)).unwrap_err());
    // With the file restored, the study continues.
    fs::write(&line, profile(1e-7)).unwrap();
    compute(&begin(place.path(), &plan).unwrap(), 1, Shard::WHOLE);
    merge(&folder).unwrap();
    // A plan that requires other content is refused before it creates a folder.
    let other = Plan {
        measured_sha256: Some(found),
        ..plan
    };
    let refused = Folder::create(&place.path().join("new"), &other).unwrap_err();
    assert!(refused.to_string().contains("has changed"), "{refused}");
    assert!(!place.path().join("new").exists());
}

#[test]
fn a_file_that_changes_while_a_study_runs_changes_nothing() {
    let (place, plan) = place();
    let folder = begin(place.path(), &plan).unwrap();
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder).unwrap();
    let whole = tables(&folder);
    let line = place.path().join("line.csv");
    let other = Folder::create(&place.path().join("other"), &plan).unwrap();
    // Lines of other numbers of points are sampled from the file again: after the first cell the
    // file has changed.
    let asked = std::sync::atomic::AtomicU32::new(0);
    let change = || {
        if asked.fetch_add(1, std::sync::atomic::Ordering::SeqCst) == 1 {
            fs::write(&line, profile(3e-7)).unwrap();
        }
        false
    };
    let control = Control::default().on_threads(1).stopped_by(&change);
    let ended = run_study(&other, Shard::WHOLE, control).unwrap();
    assert!(ended.progress.is_complete() && asked.into_inner() > 2);
    merge(&other).unwrap();
    assert_eq!(tables(&other), whole);
}

#[test]
fn a_hash_without_a_file_is_refused() {
    let smooth = super::SMALL.replace("profiles: 3", "profiles: 3, measured_sha256: \"abc\"");
    let message = Plan::parse(&smooth, "p.ron", &Changes::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("this scene has no such file"), "{message}");
}
