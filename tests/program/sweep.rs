//! Parameter studies: results equal to those of single runs, for any division of the work and any interruption.

use super::common::effort::cases;
use asperity::analysis::Regime;
use asperity::scene::{Adhesion, Material, Move, Roughness, RoughnessParameter, Scene};
use asperity::simulation::{Outcome, Simulation};
use asperity::study::{
    Changes, Finished, Folder, Options, Plan, Quantity, RESULTS, SUMMARY, Shard, Status, StudyError, merge,
    run,
};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
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
        material: (effective_modulus: 2.0e6),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
        adhesion: (kappa: 1.0),
        numerics: (points: 256, edges: Grid),
    ),
    axes: [
        Linear(path: "kappa", from: 0.5, to: 5.0, count: 4),
        List(path: "roughness.hurst", values: [0.8, 0.3]),
        List(path: "material.effective_modulus", values: [1.0e6, 2.0e6]),
    ],
    preloads: [0.01, 0.3],
    lines: 3,
    seed: 18446744073709551614,
    record: [
        zero_load_adhesion_force, zero_force_adhesion_force, preload_force, adhesion_force, adhesion_coefficient,
        dissipated_energy, regime, stiffness_exponent, skewness, fragments, contact_fraction,
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
    let ended = run(folder, Options { jobs, shard }, &|| false, &mut |_| ()).unwrap();
    assert!(ended.complete);
}

#[test]
fn progress_and_status_state_the_same_rate() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    let mut last = None;
    let options = Options { jobs: 1, shard: Shard::WHOLE };
    run(&folder, options, &|| false, &mut |progress| last = progress.rate()).unwrap();
    let reported = last.unwrap();
    let there = Status::of(&folder).unwrap().shards[0].attempts[0].rate.unwrap();
    // Times of files have the resolution of the system's ticks.
    let seconds = plan.records_in_all() as f64 / reported;
    assert!((reported / there - 1.0).abs() <= 0.02 + 0.02 / seconds, "{reported} and {there} per second");
}

fn tables(folder: &Folder) -> [String; 2] {
    [RESULTS, SUMMARY].map(|name| fs::read_to_string(folder.path().join(name)).unwrap())
}

fn shard_files(folder: &Folder) -> Vec<PathBuf> {
    folder.files().unwrap().into_iter().map(|file| file.path).collect()
}

/// The tables of an undisturbed run on one thread.
fn undisturbed(plan: &Plan) -> [String; 2] {
    let (_place, folder) = study(plan);
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder, false).unwrap();
    tables(&folder)
}

/// One loop by itself.
fn alone(scene: &Scene, loading: [Move; 2]) -> Outcome {
    let mut scene = scene.clone();
    scene.loading = loading.to_vec();
    scene.numerics.samples = 2;
    Simulation::new(PathBuf::new()).run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap()
}

#[test]
fn cells_are_what_single_runs_give() {
    for edges in ["Grid", "SubCell"] {
        let plan = plan(&SMALL.replace("edges: Grid", &format!("edges: {edges}")));
        let (_place, folder) = study(&plan);
        compute(&folder, 2, Shard::WHOLE);
        merge(&folder, false).unwrap();
        let mut rows = Vec::new();
        Finished::rows(folder.path(), |row| rows.push(row)).unwrap();
        assert_eq!(rows.len(), 4 * 2 * 2 * 2 * 3);
        assert!(rows.windows(2).all(|pair| pair[0].cell <= pair[1].cell));
        for row in rows {
            let values = plan.values(row.cell);
            let mut scene = plan.scene.clone();
            scene.adhesion = Some(Adhesion::by_parameter(RoughnessParameter::Kappa, values[0]));
            scene.material = Material::effective(values[2]);
            let Some(Roughness::SelfAffine { hurst, rms_height, seed, .. }) = &mut scene.roughness else {
                panic!("rough")
            };
            (*hurst, *seed) = (values[1], row.seed);
            let unit = values[2] * rms_height.unwrap() * scene.length;
            let pressed = alone(&scene, [Move::ToForce(values[3] * unit), Move::ToSeparation]);
            let touched = alone(&scene, [Move::ToTouch, Move::ToSeparation]);
            let balanced = alone(&scene, [Move::ToZeroForce, Move::ToSeparation]);
            let figures = pressed.figures;
            let of =
                |quantity: Quantity| row.values[plan.record.iter().position(|one| *one == quantity).unwrap()];
            for (quantity, expected) in [
                (Quantity::ZeroLoadAdhesionForce, touched.figures.adhesion_force),
                (Quantity::ZeroForceAdhesionForce, balanced.figures.adhesion_force),
                (Quantity::PreloadForce, figures.preload),
                (Quantity::AdhesionForce, figures.adhesion_force),
                (Quantity::AdhesionCoefficient, figures.adhesion_coefficient),
                (Quantity::DissipatedEnergy, figures.dissipated_energy),
            ] {
                let bits = |value: Option<f64>| value.map(f64::to_bits);
                assert_eq!(bits(of(quantity)), bits(expected), "{quantity:?} in cell {}", row.cell);
            }
            assert_eq!(row.regime, pressed.regime);
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
        merge(&folder, false).unwrap();
        assert_eq!(tables(&folder), expected, "{jobs} jobs");
    }
    let (_place, folder) = study(&plan);
    for number in [3, 1, 2] {
        compute(&folder, 2, Shard { number, count: 3 });
    }
    assert_eq!(shard_files(&folder).len(), 3);
    // A shard with all its records present makes no file.
    compute(&folder, 2, Shard { number: 1, count: 3 });
    assert_eq!(shard_files(&folder).len(), 3);
    let merged = merge(&folder, false).unwrap();
    assert_eq!((merged.records, merged.duplicates, merged.files), (96, 0, 3));
    assert_eq!(tables(&folder), expected, "three shards");
}

#[test]
fn the_same_shard_twice_is_one() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    // Both begin before the first write of the other.
    let barrier = std::sync::Barrier::new(2);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                barrier.wait();
                compute(&folder, 1, Shard::WHOLE);
            });
        }
    });
    // In any order of writes, the same file twice is certainly a duplicate.
    let first = shard_files(&folder).remove(0);
    fs::copy(&first, first.with_file_name("again.shard")).unwrap();
    let merged = merge(&folder, false).unwrap();
    assert!(merged.duplicates > 0);
    assert_eq!(tables(&folder), undisturbed(&plan));
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
    let other = format!("{start},{:?}", last.parse::<f64>().unwrap() * (1.0 + f64::EPSILON));
    let other = format!("{header}\n{:08x},{other}\n", crc32fast::hash(other.as_bytes()));
    fs::write(file.with_file_name("zz.shard"), other).unwrap();
    let Err(StudyError::Disagree { key, one, other, .. }) = merge(&folder, false) else {
        panic!("they differ by one bit")
    };
    assert_eq!((key.cell, key.seed, one.as_path()), (0, u64::MAX - 1, file.as_path()));
    assert!(other.ends_with("zz.shard"));
    assert!(!folder.path().join(RESULTS).exists());
}

#[test]
fn what_is_missing_is_named() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(&folder, 1, Shard { number: 1, count: 2 });
    let error = merge(&folder, false).unwrap_err().to_string();
    assert!(error.starts_with("48 of 96 records are missing, in 32 cells: cell 0 (kappa = 0.5, "), "{error}");
    assert!(error.contains("preload = 0.01)") && error.ends_with("--partial"), "{error}");
    assert!(!folder.path().join(RESULTS).exists());
    assert!(matches!(Finished::open(folder.path()), Err(StudyError::Folder { .. })));
    let merged = merge(&folder, true).unwrap();
    assert_eq!((merged.records, merged.missing_cells), (48, 32));
    let [results, summary] = tables(&folder);
    assert_eq!(results.lines().count(), 49);
    let whole = undisturbed(&plan);
    assert!(results.lines().all(|row| whole[0].lines().any(|one| one == row)));
    assert!(summary.lines().count() <= 33);
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder, false).unwrap();
    assert_eq!(tables(&folder), whole);
}

#[test]
fn summaries_are_the_statistics_of_the_rows() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    merge(&folder, false).unwrap();
    let finished = Finished::open(folder.path()).unwrap();
    assert_eq!(finished.plan(), &plan);
    let mut rows = Vec::new();
    Finished::rows(folder.path(), |row| rows.push(row)).unwrap();
    for cell in 0..plan.cells() {
        let lines: Vec<_> = rows.iter().filter(|row| row.cell == cell).collect();
        let summary = finished.cell(cell).unwrap();
        assert_eq!(summary.lines, 3);
        for (column, quantity) in plan.record.iter().enumerate().filter(|(_, one)| **one != Quantity::Regime)
        {
            let values: Vec<f64> = lines.iter().map(|row| row.values[column].unwrap()).collect();
            let expected = asperity::study::Statistics::of(&values).unwrap();
            let spread = finished.spread(cell, *quantity).unwrap();
            assert_eq!(spread.mean, expected.mean);
            assert_eq!(spread.standard_deviation, Some(expected.standard_deviation));
            assert_eq!(spread.confidence_interval, Some(expected.confidence_interval));
        }
        let shares = summary.regimes.unwrap();
        for (share, regime) in shares.into_iter().zip(Regime::ALL) {
            let count = lines.iter().filter(|row| row.regime == Some(regime)).count();
            assert_eq!(share, count as f64 / 3.0);
        }
    }
    // The preload varies fastest, then the last axis.
    assert_eq!(finished.at(&[3, 1, 0, 1]).unwrap().cell, ((3 * 2 + 1) * 2) * 2 + 1);
    assert_eq!(plan.values(29), [5.0, 0.3, 1.0e6, 0.3]);
    assert_eq!(finished.at(&[4, 0, 0, 0]), None);
}

#[test]
fn another_plan_is_refused() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    let other = self::plan(&SMALL.replace("to: 5.0", "to: 6.0"));
    let error = Folder::create(folder.path(), &other).unwrap_err().to_string();
    assert!(error.contains("holds a study of another plan"), "{error}");
    assert!(error.contains("there: Linear(path: \"kappa\", from: 0.5, to: 5.0, count: 4)"), "{error}");
    // A shard file of another plan does not belong to this one.
    let (_other_place, other) = study(&other);
    compute(&other, 1, Shard { number: 1, count: 8 });
    let stray = &shard_files(&other)[0];
    fs::copy(stray, folder.path().join("shards").join(stray.file_name().unwrap())).unwrap();
    assert!(merge(&folder, true).unwrap_err().to_string().contains("belongs to another plan"));
}

#[test]
fn plans_read_back_the_same() {
    for text in asperity::study::plans().iter().map(|plan| plan.text).chain([SMALL]) {
        let plan = plan(text);
        assert_eq!(self::plan(&plan.to_ron()), plan);
    }
}

fn cut(folder: &Folder, from: &Path, end: usize, into: &Path) -> Folder {
    let bytes = fs::read(from).unwrap();
    let cut = Folder::create(into, folder.plan()).unwrap();
    fs::write(into.join("shards").join("cut.shard"), &bytes[..end.min(bytes.len())]).unwrap();
    cut
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn every_prefix_of_a_file_is_a_subset_and_can_be_gone_on_from() {
    let text = SMALL.replace("lines: 3", "lines: 1").replace("count: 4", "count: 2");
    let plan = plan(&text);
    let (place, folder) = study(&plan);
    compute(&folder, 1, Shard::WHOLE);
    merge(&folder, false).unwrap();
    let whole = tables(&folder);
    let file = &shard_files(&folder)[0];
    let bytes = fs::read(file).unwrap();
    let header = bytes.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    for end in 0..=bytes.len() {
        let cut = cut(&folder, file, end, &place.path().join("cut"));
        let lines = bytes[..end].iter().filter(|&&byte| byte == b'\n').count() as u64;
        let status = Status::of(&cut).unwrap();
        assert_eq!(status.done, lines.saturating_sub(1), "{end} bytes");
        let torn = end > header && bytes[end - 1] != b'\n';
        assert_eq!(status.damaged, u64::from(torn), "{end} bytes");
        if end % 97 == 0 {
            compute(&cut, 1, Shard::WHOLE);
            merge(&cut, false).unwrap();
            assert_eq!(tables(&cut), whole, "{end} bytes");
            fs::remove_dir_all(cut.path()).unwrap();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(8)))]

    #[test]
    fn damage_anywhere_never_makes_a_wrong_number(place in any::<prop::sample::Index>(), bit in 0..8_u8) {
        let text = SMALL.replace("lines: 3", "lines: 1").replace("count: 4", "count: 2");
        let plan = plan(&text);
        let (_place, folder) = study(&plan);
        compute(&folder, 1, Shard::WHOLE);
        merge(&folder, false).unwrap();
        let whole = tables(&folder);
        let file = &shard_files(&folder)[0];
        let mut bytes = fs::read(file).unwrap();
        let place = place.index(bytes.len());
        bytes[place] ^= 1 << bit;
        fs::write(file, &bytes).unwrap();
        // Continued, the study is whole again.
        compute(&folder, 1, Shard::WHOLE);
        merge(&folder, false).unwrap();
        prop_assert_eq!(tables(&folder), whole);
    }
}

#[test]
fn stopping_leaves_whole_records() {
    use std::sync::atomic::{AtomicU32, Ordering};
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    let mut rounds = 0;
    loop {
        let asked = AtomicU32::new(0);
        let stop = || asked.fetch_add(1, Ordering::SeqCst) > 5;
        let ended = run(&folder, Options { jobs: 2, shard: Shard::WHOLE }, &stop, &mut |_| ()).unwrap();
        rounds += 1;
        assert_eq!(Status::of(&folder).unwrap().done, ended.progress.done);
        if ended.complete {
            break;
        }
    }
    assert!(rounds > 3, "{rounds}");
    merge(&folder, false).unwrap();
    assert_eq!(tables(&folder), undisturbed(&plan));
}

#[test]
fn a_scene_may_be_varied_alone() {
    // Its own loading, without preloads and seeds.
    let text = r#"(
        version: 1,
        base: "jkr-sphere",
        set: {"numerics.points": "501"},
        axes: [Logarithmic(path: "adhesion.work", from: 0.01, to: 1.0, count: 3), List(path: "loading.0.0", values: [1.0e-5])],
        record: [adhesion_force, regime, zero_force_adhesion_force],
    )"#;
    let plan = plan(text);
    let (_place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    merge(&folder, false).unwrap();
    let finished = Finished::open(folder.path()).unwrap();
    let forces: Vec<_> =
        (0..3).map(|cell| finished.spread(cell, Quantity::AdhesionForce).unwrap().mean).collect();
    assert!(forces.windows(2).all(|pair| pair[0] < pair[1]), "{forces:?}");
    let [results, _] = tables(&folder);
    assert!(results.starts_with("cell,adhesion.work,loading.0.0,preload,seed,adhesion_force,"), "{results}");
    assert!(results.contains("\n0,0.01,1e-5,,0,"), "{results}");
}

#[test]
fn a_study_is_a_folder_with_a_plan_and_shards() {
    let (place, folder) = study(&plan(SMALL));
    assert!(Folder::is_at(folder.path()) && !Folder::is_at(place.path()));
    let shards = folder.path().join("shards");
    fs::remove_dir(&shards).unwrap();
    assert!(folder.files().unwrap().is_empty());
    fs::write(&shards, "a file").unwrap();
    let error = folder.files().unwrap_err().to_string();
    assert!(error.contains("shards: cannot be read: "), "{error}");
}

#[test]
fn records_of_no_cell_or_line_of_the_plan_count_as_damaged() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(&folder, 1, Shard::WHOLE);
    let expected = undisturbed(&plan);
    let file = shard_files(&folder).remove(0);
    let text = fs::read_to_string(&file).unwrap();
    let payload = text.lines().nth(1).unwrap().split_once(',').unwrap().1;
    let [cell, seed, values] = payload.splitn(3, ',').collect::<Vec<_>>().try_into().unwrap();
    let beyond = plan.seed.wrapping_add(plan.lines);
    let foreign = [format!("{},{seed},{values}", plan.cells()), format!("{cell},{beyond},{values}")];
    let sealed = foreign.map(|payload| format!("{:08x},{payload}\n", crc32fast::hash(payload.as_bytes())));
    fs::write(&file, text + &sealed.concat()).unwrap();
    let status = Status::of(&folder).unwrap();
    assert_eq!((status.done, status.damaged), (plan.records_in_all(), 2));
    assert_eq!(merge(&folder, false).unwrap().damaged, 2);
    assert_eq!(tables(&folder), expected);
}
