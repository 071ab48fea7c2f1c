//! The results of a study as Parquet, read back by the library's own reader: the rows of the CSV, bit for bit.

use super::program::asperity_in;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::{self, File};
use std::path::Path;

const PLAN: &str = r#"(
    version: 1,
    scene: (
        version: 1,
        material: (effective_modulus: 2.0e6),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
        adhesion: (kappa: 1.0),
        numerics: (points: 256),
    ),
    axes: [
        Linear(path: "kappa", from: 0.5, to: 40.0, count: 3),
        List(path: "numerics.points", values: [128, 256]),
    ],
    preloads: [0.01, 0.3],
    lines: 3,
    seed: 18446744073709551614,
    record: [adhesion_force, adhesion_coefficient, regime, stiffness_exponent, skewness],
)"#;

fn merge(folder: &Path, arguments: &[&str]) -> String {
    asperity_in(folder, &[&["sweep", "merge", "study"], arguments].concat()).succeeded()
}

/// Compares the file with the table, and returns the numbers of rows and of null values.
fn compare(study: &Path) -> (usize, usize) {
    let reader = SerializedFileReader::new(File::open(study.join("results.parquet")).unwrap()).unwrap();
    let table = fs::read_to_string(study.join("results.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let (mut rows, mut nulls) = (0, 0);
    for row in reader.get_row_iter(None).unwrap() {
        let row = row.unwrap();
        let texts: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!(row.len(), names.len());
        for (((name, field), column), text) in row.get_column_iter().zip(&names).zip(&texts) {
            assert_eq!(name, column);
            let whole = ["cell", "seed", "numerics.points"].contains(column);
            match field {
                Field::ULong(value) => assert_eq!((whole, *value), (true, text.parse().unwrap())),
                Field::Double(value) => {
                    let expected: f64 = text.parse().unwrap();
                    assert_eq!((whole, value.to_bits()), (false, expected.to_bits()), "{column}");
                }
                Field::Str(value) => assert_eq!((*column, value.as_str()), ("regime", *text)),
                Field::Null => {
                    assert_eq!(*text, "", "{column}");
                    nulls += 1;
                }
                other => panic!("{column}: {other:?}"),
            }
        }
        rows += 1;
    }
    assert_eq!(lines.next(), None);
    let metadata = reader.metadata().file_metadata();
    let plan = metadata.key_value_metadata().unwrap().iter().find(|entry| entry.key == "asperity.plan");
    assert_eq!(plan.unwrap().value, Some(fs::read_to_string(study.join("plan.ron")).unwrap()));
    (rows, nulls)
}

#[test]
fn rows_are_those_of_the_csv_and_no_older_file_stays() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("plan.ron"), PLAN).unwrap();
    asperity_in(at, &["sweep", "plan.ron", "-o", "study", "--shard", "1/3"]).succeeded();
    let study = at.join("study");
    assert!(merge(at, &["--partial", "--parquet"]).contains("results.parquet has the rows of results.csv"));
    let (part, _) = compare(&study);
    assert!(part > 0 && part < 36, "{part}");

    // The whole study without Parquet: the file of the part must not remain beside the new tables.
    asperity_in(at, &["sweep", "plan.ron", "-o", "study"]).succeeded();
    assert!(!study.join("results.parquet").exists());

    merge(at, &["--parquet"]);
    assert_eq!(compare(&study), (36, 0));
    let left = fs::read_dir(&study).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(left.into_iter().all(|name| !name.ends_with(".tmp")));
}

#[test]
fn what_there_is_not_is_null() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // Neither preloads nor unloading: no adhesion force, no coefficient, no regime.
    let plan = PLAN.replace("preloads: [0.01, 0.3],", "");
    let plan = plan.replace("numerics: (", "loading: [ToForce(1.0e-5)],\n        numerics: (");
    fs::write(at.join("plan.ron"), plan).unwrap();
    asperity_in(at, &["sweep", "plan.ron", "-o", "study"]).succeeded();
    merge(at, &["--parquet"]);
    assert_eq!(compare(&at.join("study")), (18, 4 * 18));
}
