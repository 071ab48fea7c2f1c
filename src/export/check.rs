//! The table of hard cases.

use super::sheet::{Sheet, markdown};
use crate::check::{Check, Verdict, catalogue};
use crate::io::{object, write_json_value};
use std::io::{self, Write};

/// The verdicts for a reader: one row for each check, then the claims of the cases, then the failures.
#[must_use]
pub fn check_text(verdicts: &[Verdict]) -> String {
    let mut sheet = Sheet::default();
    let head = ["case", "edges", "error", "bound", "", "time", "evidence: error of"].map(String::from);
    let mut rows = vec![head];
    rows.extend(verdicts.iter().map(|verdict| {
        let Check { case, edges, bound } = verdict.check;
        [
            case.name.to_owned(),
            edges.name().to_owned(),
            verdict.error.as_ref().map_or_else(|_| "–".to_owned(), |&error| figure(error)),
            figure(bound),
            if verdict.passes() { "pass" } else { "FAIL" }.to_owned(),
            format!("{:.2} s", verdict.seconds),
            format!("{}: {}", case.evidence, case.error_of),
        ]
    }));
    sheet.table(&rows);
    sheet.heading("What must hold");
    let mut sentences = Vec::new();
    for case in catalogue() {
        if verdicts.iter().any(|verdict| verdict.check.case.name == case.name) {
            sentences.push([case.name.to_owned(), case.holds.to_owned()]);
        }
    }
    sheet.table(&sentences);
    let failed: Vec<&Verdict> = verdicts.iter().filter(|verdict| !verdict.passes()).collect();
    if !failed.is_empty() {
        sheet.heading("What fails");
        let why = |verdict: &&Verdict| {
            let Check { case, edges, bound } = verdict.check;
            let name = format!("{} {}", case.name, edges.name());
            let why = match &verdict.error {
                Ok(error) => format!("error {} above the bound {}", figure(*error), figure(bound)),
                Err(fault) => fault.clone(),
            };
            [name, why]
        };
        sheet.table(&failed.iter().map(why).collect::<Vec<_>>());
    }
    sheet.heading(&format!(
        "{} of {} checks pass, in {:.1} s.",
        verdicts.len() - failed.len(),
        verdicts.len(),
        verdicts.iter().map(|verdict| verdict.seconds).sum::<f64>()
    ));
    sheet.into_text()
}

/// The cases as a Markdown table: claims and bounds.
#[must_use]
pub fn check_markdown(checks: &[Check]) -> String {
    let mut rows = vec![["case", "what must hold", "evidence", "error of", "bound"].map(String::from)];
    for case in catalogue() {
        let bounds: Vec<String> = checks
            .iter()
            .filter(|check| check.case.name == case.name)
            .map(|check| format!("{}: {}", check.edges.name(), figure(check.bound)))
            .collect();
        rows.push([
            format!("`{}`", case.name),
            case.holds.to_owned(),
            case.evidence.to_owned(),
            case.error_of.to_owned(),
            bounds.join(", "),
        ]);
    }
    markdown(&rows)
}

/// Writes the verdicts as one object.
///
/// # Errors
/// Errors of `out`.
pub fn write_check_json(out: &mut (impl Write + ?Sized), verdicts: &[Verdict]) -> io::Result<()> {
    let row = |verdict: &Verdict| {
        let Check { case, edges, bound } = verdict.check;
        object! {
            "case": case.name,
            "family": case.family,
            "edges": edges,
            "holds": case.holds,
            "evidence": [case.evidence.replace(' ', "-")],
            "error_of": case.error_of,
            "error": verdict.error.as_ref().ok().copied().filter(|error| error.is_finite()),
            "bound": bound,
            "passes": verdict.passes(),
            "fault": verdict.error.as_ref().err().cloned(),
            "seconds": verdict.seconds,
        }
    };
    let checks: Vec<_> = verdicts.iter().map(row).collect();
    let passes = verdicts.iter().all(Verdict::passes);
    write_json_value(out, &object! { "passes": passes, "checks": checks })
}

/// A bound or an error: two digits suffice for a comparison, zero is exact.
fn figure(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::checks;
    use serde_json::Value;

    #[test]
    fn what_fails_is_shown_with_its_reason() {
        let named = |name: &str| checks(|case| case.name == name);
        let [one, other] = named("flat-line")[..] else { panic!("not two kinds of edges") };
        let third = named("stepwise-solver")[0];
        let verdict = |check, error| Verdict { check, error, seconds: 0.25 };
        let verdicts =
            [verdict(one, Ok(0.0)), verdict(other, Ok(3.0)), verdict(third, Err("another contact".into()))];
        let text = check_text(&verdicts);
        let row = |name: &str, edges: &str| {
            text.lines().find(|line| line.starts_with(name) && line.contains(edges)).unwrap().to_owned()
        };
        assert!(row("flat-line", "Grid").contains(" 0 ") && row("flat-line", "Grid").contains("pass"));
        assert!(
            row("flat-line", "SubCell").contains("3.0e0") && row("flat-line", "SubCell").contains("FAIL")
        );
        assert!(row("stepwise-solver", "FAIL").contains("–"), "{text}");
        assert!(text.contains("error 3.0e0 above the bound") && text.contains("another contact"), "{text}");
        assert!(text.contains("1 of 3 checks pass, in 0.8 s."), "{text}");
        let mut json = Vec::new();
        write_check_json(&mut json, &verdicts).unwrap();
        let report: Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(report["passes"], false);
        assert_eq!(report["checks"][1]["error"], 3.0);
        assert_eq!(report["checks"][2]["fault"], "another contact");
        assert_eq!(report["checks"][2]["edges"], "Grid");
    }

    #[test]
    fn every_case_has_its_row() {
        let table = check_markdown(&checks(|_| true));
        assert_eq!(table.lines().count(), catalogue().len() + 2);
        assert!(table.contains("| `flat-line` |") && table.contains("| Grid: 2.0e-15, SubCell: 2.0e-15 |"));
    }
}
