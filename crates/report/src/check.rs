//! Results of the catalogue of checks as text and JSON.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use asperity_contact::Edges;
use asperity_study::checks::{Case, Verdict};
use serde::Serialize;

impl Report for [Verdict] {
    /// Returns a table with a row for each [`Check`](asperity_study::checks::Check). Below the
    /// table are the statement and the evidence of each [`Case`], and the reasons why checks have
    /// failed.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        add_verdicts(&mut sheet, self);
        sheet.heading("Claims");
        add_claims(&mut sheet, self);
        add_failures(&mut sheet, self);
        let passed = self.iter().filter(|verdict| verdict.passes()).count();
        let seconds: f64 = self.iter().map(|verdict| verdict.seconds).sum();
        sheet.heading(&format!(
            "{passed} of {} checks pass, in {seconds:.1} s.",
            self.len()
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(ChecksJson {
            passes: self.iter().all(Verdict::passes),
            checks: self.iter().map(CheckJson::new).collect(),
        }))
    }
}

/// Adds a table with the error of each check.
fn add_verdicts(sheet: &mut Sheet, verdicts: &[Verdict]) {
    let header = ["case", "edges", "error", "bound", "", "time"];
    let mut rows = vec![header.map(String::from)];
    for verdict in verdicts {
        let error = match &verdict.error {
            Ok(error) => figure(*error),
            Err(_) => "–".to_owned(),
        };
        let passes = if verdict.passes() { "pass" } else { "FAIL" };
        rows.push([
            verdict.check.case.name.to_owned(),
            verdict.check.edges.name().to_owned(),
            error,
            figure(verdict.check.bound),
            passes.to_owned(),
            format!("{:.2} s", verdict.seconds),
        ]);
    }
    sheet.table(&rows);
}

/// Adds a table of the statements that the checked cases confirm, each with its evidence.
fn add_claims(sheet: &mut Sheet, verdicts: &[Verdict]) {
    let mut rows = Vec::new();
    for case in Case::all() {
        let is_checked = verdicts
            .iter()
            .any(|verdict| verdict.check.case.name == case.name);
        if is_checked {
            let claim = format!(
                "{} Evidence: {}; error of {}.",
                case.holds, case.evidence, case.error_of
            );
            rows.push([case.name.to_owned(), claim]);
        }
    }
    sheet.table(&rows);
}

/// Adds the reasons why checks have failed. Adds nothing if all checks pass.
fn add_failures(sheet: &mut Sheet, verdicts: &[Verdict]) {
    let mut rows = Vec::new();
    for verdict in verdicts {
        if verdict.passes() {
            continue;
        }
        let check = verdict.check;
        let name = format!("{} {}", check.case.name, check.edges.name());
        let reason = match &verdict.error {
            Ok(error) => {
                let error = figure(*error);
                let bound = figure(check.bound);
                format!("error {error} above the bound {bound}")
            }
            Err(fault) => fault.clone(),
        };
        rows.push([name, reason]);
    }
    if !rows.is_empty() {
        sheet.heading("Failures");
        sheet.table(&rows);
    }
}

/// Returns a bound or an error as text with two digits, which suffice for a comparison. Zero is
/// written as `0`, because it is exact.
fn figure(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.1e}")
    }
}

#[derive(Serialize)]
struct ChecksJson<'a> {
    passes: bool,
    checks: Vec<CheckJson<'a>>,
}

#[derive(Serialize)]
struct CheckJson<'a> {
    case: &'static str,
    family: &'static str,
    edges: Edges,
    holds: &'static str,
    evidence: [String; 1],
    error_of: &'static str,
    /// Error that the check has found; `None` if the check found no error or one that is not
    /// finite.
    error: Option<f64>,
    bound: f64,
    passes: bool,
    /// Reason why the check could not determine the error; `None` if it could.
    fault: Option<&'a str>,
    seconds: f64,
}

impl<'a> CheckJson<'a> {
    fn new(verdict: &'a Verdict) -> Self {
        let case = verdict.check.case;
        let error = verdict.error.as_ref().ok().copied();
        CheckJson {
            case: case.name,
            family: case.family,
            edges: verdict.check.edges,
            holds: case.holds,
            evidence: [case.evidence.replace(' ', "-")],
            error_of: case.error_of,
            error: error.filter(|error| error.is_finite()),
            bound: verdict.check.bound,
            passes: verdict.passes(),
            fault: verdict.error.as_ref().err().map(String::as_str),
            seconds: verdict.seconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Format, write};
    use asperity_study::checks::Check;
    use serde_json::Value;

    #[test]
    fn what_fails_is_shown_with_its_reason() {
        let named = |name: &str| Check::of(|case| case.name == name);
        let [one, other] = named("flat-line")[..] else {
            panic!("not two kinds of edges")
        };
        let third = named("stepwise-solver")[0];
        let verdict = |check, error| Verdict {
            check,
            error,
            seconds: 0.25,
        };
        let verdicts = [
            verdict(one, Ok(0.0)),
            verdict(other, Ok(3.0)),
            verdict(third, Err("another contact".into())),
        ];
        let text = verdicts.text().unwrap();
        let row = |name: &str, edges: &str| {
            text.lines()
                .find(|line| line.starts_with(name) && line.contains(edges))
                .unwrap()
                .to_owned()
        };
        assert!(
            row("flat-line", "Grid").contains(" 0 ") && row("flat-line", "Grid").contains("pass")
        );
        assert!(
            row("flat-line", "SubCell").contains("3.0e0")
                && row("flat-line", "SubCell").contains("FAIL")
        );
        assert!(row("stepwise-solver", "FAIL").contains("–"), "{text}");
        assert!(
            text.contains("error 3.0e0 above the bound") && text.contains("another contact"),
            "{text}"
        );
        assert!(text.contains("1 of 3 checks pass, in 0.8 s."), "{text}");
        let mut json = Vec::new();
        write(&mut json, &verdicts[..], Format::Json, "").unwrap();
        let report: Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(report["passes"], false);
        assert_eq!(report["checks"][1]["error"], 3.0);
        assert_eq!(report["checks"][2]["fault"], "another contact");
        assert_eq!(report["checks"][2]["edges"], "Grid");
    }
}
