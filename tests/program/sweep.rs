//! Parameter studies: results equal to those of single runs, for any division of the work and any
//! interruption.

use super::common::effort::cases;
use asperity::contact::Move;
use asperity::data::Control;
use asperity::scene::Regime;
use asperity::scene::{Adhesion, Material, Roughness, RoughnessParameter, Scene};
use asperity::scene::{Outcome, Simulation};
use asperity::study::folders::{Merged, Status};
use asperity::study::maps::StudyMap;
use asperity::study::{
    Changes, Folder, Plan, Quantity, Results, Shard, Spread, Statistics, merge, run_study,
};
use proptest::prelude::*;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

#[cfg(unix)]
mod foreign;
#[cfg(unix)]
mod many;
#[cfg(unix)]
mod measured;
#[cfg(unix)]
mod processes;
mod wrong_plans;

const SMALL: &str = r#"(
    version: 1,
    title: "Small",
    scene: (
        version: 1,
        material: (modulus: 2.0e6),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
        adhesion: (kappa: 1.0),
        numerics: (points: 256, edges: Grid),
    ),
    axes: [
        Linear(path: "adhesion.kappa", from: 0.5, to: 5.0, count: 4),
        List(path: "roughness.hurst", values: [0.8, 0.3]),
        List(path: "material.modulus", values: [1.0e6, 2.0e6]),
    ],
    preloads: [0.01, 0.3],
    profiles: 3,
    seed: 18446744073709551614,
    record: [
        first_touch_pull_off_force, zero_force_pull_off_force, preload_force, pull_off_force, adhesion_coefficient,
        dissipated_energy, regime, regime_after_zero_force, stiffness_exponent, skewness, patches, contact_fraction,
    ],
)"#;

fn plan(text: &str) -> Plan {
    Plan::parse(text, "test", &Changes::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn study(plan: &Plan) -> (TempDir, Folder) {
    let place = tempfile::tempdir().unwrap();
    let folder = Folder::create(&place.path().join("study"), plan).unwrap();
    (place, folder)
}

fn compute(folder: &Folder, jobs: usize, shard: Shard) {
    let ended = run_study(folder, shard, Control::default().on_threads(jobs)).unwrap();
    assert!(ended.progress.is_complete());
}

/// A study with the tables of all its cells.
fn computed(plan: &Plan) -> (TempDir, Folder) {
    let (place, folder) = study(plan);
    compute(&folder, 2, Shard::WHOLE);
    merge(&folder).unwrap();
    (place, folder)
}

fn tables(folder: &Folder) -> [String; 2] {
    [Merged::RESULTS, Merged::SUMMARY]
        .map(|name| fs::read_to_string(folder.path().join(name)).unwrap())
}

fn shard_files(folder: &Folder) -> Vec<PathBuf> {
    folder
        .files()
        .unwrap()
        .into_iter()
        .map(|file| file.path)
        .collect()
}

/// The tables of an undisturbed run on one thread.
fn undisturbed(plan: &Plan) -> [String; 2] {
    let (_place, folder) = study(plan);
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder).unwrap();
    tables(&folder)
}

/// One loop by itself.
fn alone(scene: &Scene, loading: [Move; 2]) -> Outcome {
    let mut scene = scene.clone();
    scene.loading = loading.to_vec();
    scene.numerics.samples = 2;
    let scene = scene.checked().unwrap();
    Simulation::new(PathBuf::new())
        .run(&scene, &|| false, &mut |_, _, _| Ok(()))
        .unwrap()
}

#[test]
fn cells_are_what_single_runs_give() {
    for edges in ["Grid", "SubCell"] {
        let plan = plan(&SMALL.replace("edges: Grid", &format!("edges: {edges}")));
        let (_place, folder) = computed(&plan);
        let results = Results::open(folder.path()).unwrap();
        for cell in 0..plan.cells() {
            for (line, recorded) in results.records_of(cell) {
                let values = plan.values(cell);
                let mut scene = plan.scene.clone();
                scene.adhesion = Some(Adhesion::by_parameter(RoughnessParameter::Kappa, values[0]));
                scene.material = Material::effective(values[2]);
                let Some(Roughness::SelfAffine {
                    hurst,
                    rms_height,
                    seed,
                    ..
                }) = &mut scene.roughness
                else {
                    panic!("rough")
                };
                (*hurst, *seed) = (values[1], plan.seed_of(line));
                let unit = values[2] * rms_height.unwrap() * scene.length;
                let pressed = alone(
                    &scene,
                    [Move::ToForce(values[3] * unit), Move::ToSeparation],
                );
                let touched = alone(&scene, [Move::ToTouch, Move::ToSeparation]);
                let balanced = alone(&scene, [Move::ToZeroForce, Move::ToSeparation]);
                let figures = pressed.figures;
                let number = |regime: Option<Regime>| Some(f64::from(regime? as u8));
                for (quantity, expected) in [
                    (
                        Quantity::FirstTouchPullOffForce,
                        touched.figures.pull_off_force,
                    ),
                    (
                        Quantity::ZeroForcePullOffForce,
                        balanced.figures.pull_off_force,
                    ),
                    (Quantity::PreloadForce, figures.preload),
                    (Quantity::PullOffForce, figures.pull_off_force),
                    (Quantity::AdhesionCoefficient, figures.adhesion_coefficient),
                    (Quantity::DissipatedEnergy, figures.dissipated_energy),
                    (Quantity::Regime, number(pressed.regime)),
                    (
                        Quantity::RegimeAfterZeroForce,
                        number(pressed.regime_after_zero_force),
                    ),
                ] {
                    let found = Some(recorded[plan.column(quantity).unwrap()])
                        .filter(|value| !value.is_nan());
                    let bits = |value: Option<f64>| value.map(f64::to_bits);
                    assert_eq!(bits(found), bits(expected), "{quantity:?} in cell {cell}");
                }
            }
        }
    }
}

#[test]
fn no_bit_depends_on_who_computes() {
    let plan = plan(SMALL);
    let expected = undisturbed(&plan);
    for jobs in [2, 7] {
        let (_place, folder) = study(&plan);
        compute(&folder, jobs, Shard::WHOLE);
        merge(&folder).unwrap();
        assert_eq!(tables(&folder), expected, "{jobs} jobs");
    }
    let (_place, folder) = study(&plan);
    for number in [3, 1, 2] {
        compute(&folder, 2, Shard { number, count: 3 });
    }
    assert_eq!(shard_files(&folder).len(), 3);
    // A shard with all its records present makes no file.
    compute(
        &folder,
        2,
        Shard {
            number: 1,
            count: 3,
        },
    );
    assert_eq!(shard_files(&folder).len(), 3);
    let merged = merge(&folder).unwrap();
    assert_eq!(
        (merged.records, merged.duplicates, merged.files),
        (96, 0, 3)
    );
    assert_eq!(tables(&folder), expected, "three shards");
}

/// Cells that cannot be computed have their reason in every table, and no numbers; the others are
/// as without them.
#[test]
fn cells_that_cannot_be_computed_have_a_reason() {
    let text = r#"(version: 1, axes: [
        List(path: "loading.1.0", values: [0.0, -1.0e3]),
        List(path: "roughness.modes.1", values: [32, 64]),
    ], scene: (version: 1, material: (modulus: 2.0e6), length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1), adhesion: (kappa: 1.0),
        loading: [ToForce(1.0e-5), ToForce(0.0), ToSeparation], numerics: (points: 256),
    ), profiles: 2, record: [pull_off_force, regime])"#;
    let mut plan = plan(text);
    // As in the folder of a plan that was not checked: more modes than springs.
    plan.axes[1].values[1] = 512.0;
    let (_place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    let merged = merge(&folder).unwrap();
    assert_eq!((merged.records, merged.total, merged.failed), (8, 8, 6));
    assert_eq!(Status::of(&folder).unwrap().failed, 6);
    let [rows, summary] = tables(&folder);
    let rows: Vec<&str> = rows.lines().collect();
    assert!(
        rows[0].ends_with("seed,pull_off_force,regime,reason"),
        "{}",
        rows[0]
    );
    assert!(
        rows[1..3]
            .iter()
            .all(|row| row.ends_with("pressure-insensitive,")),
        "{rows:?}"
    );
    for (row, said) in [
        (3, "last mode at most points/2"),
        (5, "detaches before"),
        (7, "last mode at most"),
    ] {
        assert!(
            rows[row].contains(",1,,,\"") || rows[row].contains(",1,,,"),
            "{}",
            rows[row]
        );
        assert!(rows[row].contains(said), "{}", rows[row]);
    }
    assert_eq!(summary.lines().count(), 5);
    let results = Results::open(folder.path()).unwrap();
    let known = |cell| {
        results
            .statistics(cell, Quantity::PullOffForce)
            .map(|all| all.count)
    };
    assert_eq!([0, 1, 2, 3].map(known), [Some(2), None, None, None]);
    assert_eq!(results.failed().count(), 6);
    let map = StudyMap::open(folder.path()).unwrap().grid(0);
    assert_eq!(
        map.cells
            .iter()
            .filter(|cell| matches!(cell, Some(Err(_))))
            .count(),
        3
    );
}

#[test]
fn results_that_differ_are_stated() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(&folder, 1, Shard::WHOLE);
    let file = &shard_files(&folder)[0];
    let text = fs::read_to_string(file).unwrap();
    let mut lines = text.lines();
    let (header, record) = (lines.next().unwrap(), lines.next().unwrap());
    let payload = record.split_once(',').unwrap().1;
    let (start, last) = payload.rsplit_once(',').unwrap();
    let other = format!(
        "{start},{:?}",
        last.parse::<f64>().unwrap() * (1.0 + f64::EPSILON)
    );
    let other = format!(
        "{header}\n{:08x},{other}\n",
        crc32fast::hash(other.as_bytes())
    );
    fs::write(file.with_file_name("zz.shard"), other).unwrap();
    let error = merge(&folder).unwrap_err().to_string();
    let file = file.display();
    assert!(
        error.starts_with("cell 0, seed 18446744073709551614 (adhesion.kappa = 0.5, "),
        "{error}"
    );
    assert!(
        error.contains(&format!("two records differ, in {file} and "))
            && error.contains("zz.shard;"),
        "{error}"
    );
    assert!(!folder.path().join(Merged::RESULTS).exists());
}

#[test]
fn what_is_missing_is_counted() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(
        &folder,
        1,
        Shard {
            number: 1,
            count: 2,
        },
    );
    let merged = merge(&folder).unwrap();
    assert_eq!((merged.records, merged.missing_cells), (48, 32));
    let [results, summary] = tables(&folder);
    assert_eq!(results.lines().count(), 49);
    let whole = undisturbed(&plan);
    assert!(
        results
            .lines()
            .all(|row| whole[0].lines().any(|one| one == row))
    );
    assert!(summary.lines().count() <= 33);
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder).unwrap();
    assert_eq!(tables(&folder), whole);
}

#[test]
fn summaries_are_the_statistics_of_the_rows() {
    let plan = plan(SMALL);
    let (_place, folder) = computed(&plan);
    let results = Results::open(folder.path()).unwrap();
    assert_eq!(results.plan(), &plan);
    let [_, summary] = tables(&folder);
    let mut rows = summary
        .lines()
        .map(|row| row.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    for (cell, row) in (0..plan.cells()).zip(rows) {
        let column = |name: &str| row[header.iter().position(|one| *one == name).unwrap()];
        let number = |name: &str| column(name).parse::<f64>().unwrap();
        assert_eq!(
            (column("cell"), column("profiles")),
            (cell.to_string().as_str(), "3")
        );
        for (place, quantity) in plan.record.iter().enumerate() {
            let values: Vec<f64> = results
                .records_of(cell)
                .map(|(_, values)| values[place])
                .collect();
            let name = quantity.name();
            if quantity.is_regime() {
                let column = |regime: Regime| format!("{name}_{}", regime.name().replace('-', "_"));
                let shares = Regime::ALL.map(|regime| number(&column(regime)));
                let of = usize::from(*quantity != Quantity::Regime);
                assert_eq!(results.regimes(cell)[of].shares(), Some(shares));
                continue;
            }
            let expected = Statistics::of(values, quantity.bounds()).unwrap();
            let endings = [
                "mean", "sd", "low", "high", "min", "q1", "median", "q3", "max",
            ];
            let found = endings.map(|of| number(&format!("{name}_{of}")));
            let Spread {
                standard_deviation,
                confidence_interval: (low, high),
                ..
            } = expected.spread.unwrap();
            let ([lower, median, upper], (least, most)) = (expected.quartiles, expected.range);
            let all = [
                expected.mean,
                standard_deviation,
                low,
                high,
                least,
                lower,
                median,
                upper,
                most,
            ];
            assert_eq!(found, all, "{name}");
            assert_eq!(results.statistics(cell, *quantity), Some(expected));
            assert!(
                low >= quantity.bounds().0 && high <= quantity.bounds().1,
                "{name}: {low} to {high}"
            );
        }
    }
    // The preload varies fastest, then the last axis.
    assert_eq!(plan.values(29), [5.0, 0.3, 1.0e6, 0.3]);
}

#[test]
fn another_plan_is_refused() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    let other = self::plan(&SMALL.replace("to: 5.0", "to: 6.0"));
    let error = Folder::create(folder.path(), &other)
        .unwrap_err()
        .to_string();
    assert!(error.contains("holds a study of another plan"), "{error}");
    assert!(
        error.contains("there: Linear(path: \"adhesion.kappa\", from: 0.5, to: 5.0, count: 4)"),
        "{error}"
    );
    // A shard file of another plan does not belong to this one.
    let (_other_place, other) = study(&other);
    compute(
        &other,
        1,
        Shard {
            number: 1,
            count: 8,
        },
    );
    let stray = &shard_files(&other)[0];
    fs::copy(
        stray,
        folder
            .path()
            .join("shards")
            .join(stray.file_name().unwrap()),
    )
    .unwrap();
    assert!(
        merge(&folder)
            .unwrap_err()
            .to_string()
            .contains("belongs to another plan")
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(8)))]

    #[test]
    fn damage_anywhere_never_makes_a_wrong_number(place in any::<prop::sample::Index>(), bit in 0..8_u8) {
        let text = SMALL.replace("profiles: 3", "profiles: 1").replace("count: 4", "count: 2");
        let plan = plan(&text);
        let (_place, folder) = computed(&plan);
        let whole = tables(&folder);
        let file = &shard_files(&folder)[0];
        let mut bytes = fs::read(file).unwrap();
        let place = place.index(bytes.len());
        bytes[place] ^= 1 << bit;
        fs::write(file, &bytes).unwrap();
        // Continued, the study is whole again.
        compute(&folder, 1, Shard::WHOLE);
        merge(&folder).unwrap();
        prop_assert_eq!(tables(&folder), whole);
    }
}

#[test]
fn a_scene_may_be_varied_alone() {
    // Its own loading, without preloads and seeds.
    let text = r#"(
        version: 1,
        base: "jkr-sphere",
        set: {"numerics.points": "501"},
        axes: [Logarithmic(path: "adhesion.work", from: 0.01, to: 1.0, count: 3), List(path: "loading.0.0", values: [1.0e-5])],
        record: [pull_off_force, regime, zero_force_pull_off_force],
    )"#;
    let plan = plan(text);
    let (_place, folder) = computed(&plan);
    let results = Results::open(folder.path()).unwrap();
    let forces: Vec<_> = (0..3)
        .map(|cell| {
            results
                .statistics(cell, Quantity::PullOffForce)
                .unwrap()
                .mean
        })
        .collect();
    assert!(
        forces.windows(2).all(|pair| pair[0] < pair[1]),
        "{forces:?}"
    );
    let [results, _] = tables(&folder);
    assert!(
        results.starts_with("cell,adhesion.work,loading.0.0,preload,seed,pull_off_force,"),
        "{results}"
    );
    assert!(results.contains("\n0,0.01,1e-5,,0,"), "{results}");
}
