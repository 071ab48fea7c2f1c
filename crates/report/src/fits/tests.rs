//! Tests of the reports on fits to many curves.

use super::*;
use asperity_data::Warning;
use asperity_scene::open;

fn row(file: &str, work: f64, described: bool) -> CurveRow {
    CurveRow {
        file: file.to_owned(),
        parameters: vec![
            [work, 0.9 * work, 1.1 * work].map(Some),
            [None, Some(2e6), None],
        ],
        facts: [
            1e-6, 0.05, 0.5, 0.01, 0.75, 1e-9, 2.0, 0.04, 0.0, 1e-6, 2e-6,
        ]
        .map(Some),
        points: Some(400),
        described: Some(described),
        description: if described { "within the noise" } else { "no" }.to_owned(),
        reason: if described {
            String::new()
        } else {
            "The force, \"drifts\".".to_owned()
        },
        warnings: if described {
            Vec::new()
        } else {
            let springs = (1e6 * work) as u64 % 20;
            [
                Warning::ContactAtEnds { length: work },
                Warning::FewSpringsInContact { springs },
            ]
            .iter()
            .map(RowWarning::of)
            .collect()
        },
        error: String::new(),
    }
}

/// Returns a report written in each of six formats; `None` for a format that this report does
/// not have.
fn written(report: &FitsReport<'_>) -> [Option<Vec<u8>>; 6] {
    use crate::report::Format::{Csv, Json, Pdf, Png, Svg, Text};
    [Text, Json, Csv, Svg, Png, Pdf].map(|format| {
        let mut bytes = Vec::new();
        crate::report::write(&mut bytes, report, format, "")
            .ok()
            .map(|()| bytes)
    })
}

/// Every mixture of curves that are described, not described or not fitted can be written in
/// all formats. If no curve is fitted, there are no pictures, and the error message names the
/// files.
#[test]
fn tables_have_all_forms_for_every_mixture_of_curves() {
    let document = open("jkr-sphere").unwrap();
    for number in 0..27 {
        let counts = [number % 3, number / 3 % 3, number / 9];
        let described = (0..counts[0])
            .map(|index| row(&format!("d{index}"), 0.05 + 0.01 * f64::from(index), true));
        let others = (0..counts[1]).map(|index| row(&format!("n{index}"), 0.2, false));
        let failed = (0..counts[2]).map(|index| CurveRow {
            file: format!("f{index}"),
            error: format!("reason {index}"),
            ..CurveRow::default()
        });
        let rows: Vec<CurveRow> = described.chain(others).chain(failed).collect();
        let free = [Parameter::Work, Parameter::Modulus];
        let report = FitsReport {
            wording: |remedy| format!("{remedy:?}"),
            scene: document.scene(),
            free: &free,
            rows: &rows,
            together: &[],
        };
        let [text, json, csv, pictures @ ..] = written(&report);
        let fitted = counts[0] + counts[1];
        assert!(
            pictures
                .iter()
                .all(|picture| picture.is_some() == (fitted > 0)),
            "{counts:?}"
        );
        let text = String::from_utf8(text.unwrap()).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&json.unwrap()).unwrap();
        assert_eq!(
            csv.unwrap().split(|byte| *byte == b'\n').count(),
            rows.len() + 2
        );
        assert_eq!(json["curves"].as_array().unwrap().len(), rows.len());
        for (name, count) in [("described", counts[0]), ("all", fitted)] {
            let found = json[name]["curves"].as_i64().unwrap_or_default();
            assert_eq!(
                (found, json[name].is_null()),
                (count.into(), count == 0),
                "{counts:?}"
            );
        }
        let [median, only] = [
            json["all"]["median"].as_f64(),
            json["described"]["median"].as_f64(),
        ];
        assert_eq!(median.is_some(), fitted > 0);
        let expected = (counts[0] > 0).then_some(0.05 + 0.005 * f64::from(counts[0] - 1));
        assert_eq!(only.is_some(), expected.is_some());
        assert!(
            (only.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-12,
            "{only:?} {expected:?}"
        );
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert!(
            rows.iter()
                .all(|row| text.contains(&row.file) && text.contains(&row.error)),
            "{text}"
        );
        assert_eq!(text.contains("drifts"), counts[1] > 0, "{text}");
        assert_eq!(report.failures().count(), counts[2] as usize);
        let failure = report.failure().unwrap_or_default();
        assert_eq!(failure.is_empty(), fitted > 0, "{counts:?} {failure}");
        let is_named = |row: &CurveRow| failure.contains(&format!("{}: {}", row.file, row.error));
        assert!(fitted > 0 || rows.iter().all(is_named), "{failure}");
    }
}

/// Each premise is stated only once, with the number of fitted curves for which it is not met,
/// and with the values of the first of these curves.
#[test]
fn premises_are_counted_over_the_fitted_curves() {
    let failed = CurveRow {
        error: "no".into(),
        ..CurveRow::default()
    };
    let all = [
        row("a", 0.05, true),
        row("b", 0.2, false),
        row("c", 0.1, false),
        failed,
    ];
    let document = open("jkr-sphere").unwrap();
    let texts = |rows: &[CurveRow]| {
        let report = FitsReport {
            wording: |remedy| format!("{remedy:?}"),
            scene: document.scene(),
            free: &[Parameter::Work],
            rows,
            together: &[],
        };
        let warnings = report.warnings();
        let text = report.text().unwrap().replace('\n', " ");
        let mut bytes = Vec::new();
        report.json().unwrap().write_json(&mut bytes, &[]).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        assert_eq!(text.contains("Warnings"), !warnings.is_empty());
        assert_eq!(json["warnings"], serde_json::json!(warnings));
        warnings
    };
    let of_all = texts(&all);
    let ends = Warning::ContactAtEnds { length: 0.2 };
    assert_eq!(of_all.len(), 2);
    assert_eq!(of_all[0], format!("On 2 of 3 curves: {ends}"));
    assert_eq!(texts(&all[1..2])[0], ends.to_string());
    assert_eq!(texts(&all[..1]), [""; 0]);
    assert_eq!(texts(&all[3..]), [""; 0]);
    assert_eq!(texts(&[]), [""; 0]);
}

#[test]
fn the_title_of_a_figure_counts_its_curves() {
    let document = open("jkr-sphere").unwrap();
    let rows = [row("a", 0.05, true), row("b", 0.06, true)];
    for (count, title) in [(1, "1 curve"), (2, "2 curves")] {
        let report = FitsReport {
            wording: |remedy| format!("{remedy:?}"),
            scene: document.scene(),
            free: &[Parameter::Work, Parameter::Modulus],
            rows: &rows[..count],
            together: &[],
        };
        assert_eq!(report.figure().unwrap().title, title);
    }
}

#[test]
fn a_message_names_a_few_of_many_files() {
    let rows: Vec<CurveRow> = (0..40)
        .map(|index| CurveRow {
            file: format!("{index}.csv"),
            error: "no".into(),
            ..CurveRow::default()
        })
        .collect();
    let document = open("jkr-sphere").unwrap();
    let report = FitsReport {
        wording: |remedy| format!("{remedy:?}"),
        scene: document.scene(),
        free: &[Parameter::Work],
        rows: &rows,
        together: &[],
    };
    let expected = "no curve was fitted: 0.csv: no; 1.csv: no; 2.csv: no; 3.csv: no; and 36 others";
    assert_eq!(report.failure().as_deref(), Some(expected));
}

/// A row can be read from its line in the CSV table. A damaged line is refused.
#[test]
fn rows_come_back_from_the_table() {
    let failed = CurveRow {
        file: "a, b.csv".into(),
        error: "no contact; allowed: one".into(),
        ..CurveRow::default()
    };
    let rows = [
        row("a.csv", 0.05, true),
        row("b \"x\".csv", 0.06, false),
        failed,
    ];
    let (document, free) = (
        open("jkr-sphere").unwrap(),
        [Parameter::Work, Parameter::Modulus],
    );
    let report = FitsReport {
        wording: |remedy| format!("{remedy:?}"),
        scene: document.scene(),
        free: &free,
        rows: &rows,
        together: &[],
    };
    let mut text = Vec::new();
    report.table().unwrap().write_csv(&mut text, "").unwrap();
    let text = String::from_utf8(text).unwrap();
    let read: Vec<_> = text
        .lines()
        .skip(1)
        .map(|line| CurveRow::from_line(line, 2))
        .collect();
    assert_eq!(read, rows.map(Some));
    let line = text.lines().nth(2).unwrap();
    assert!((0..line.len()).all(|end| CurveRow::from_line(&line[..end], 2).is_none()));
    assert_eq!(CurveRow::from_line(line, 1), None);
}
