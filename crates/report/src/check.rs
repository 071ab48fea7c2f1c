//! Results of the catalogue of checks as text and JSON.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use asperity_data::object;
use asperity_study::checks::{Case, Check, Verdict};

impl Report for [Verdict] {
    /// Returns a table with a row for each [`Check`], then what each [`Case`] shows by which
    /// evidence, then why checks failed.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        let head = ["case", "edges", "error", "bound", "", "time"].map(String::from);
        let mut rows = vec![head];
        rows.extend(self.iter().map(|verdict| {
            let Check { case, edges, bound } = verdict.check;
            [
                case.name.to_owned(),
                edges.name().to_owned(),
                verdict
                    .error
                    .as_ref()
                    .map_or_else(|_| "–".to_owned(), |&error| figure(error)),
                figure(bound),
                if verdict.passes() { "pass" } else { "FAIL" }.to_owned(),
                format!("{:.2} s", verdict.seconds),
            ]
        }));
        sheet.table(&rows);
        sheet.heading("Claims");
        let mut sentences = Vec::new();
        for case in Case::all() {
            if self
                .iter()
                .any(|verdict| verdict.check.case.name == case.name)
            {
                let evidence = format!(
                    "{} Evidence: {}; error of {}.",
                    case.holds, case.evidence, case.error_of
                );
                sentences.push([case.name.to_owned(), evidence]);
            }
        }
        sheet.table(&sentences);
        let failed: Vec<&Verdict> = self.iter().filter(|verdict| !verdict.passes()).collect();
        if !failed.is_empty() {
            sheet.heading("Failures");
            let why = |verdict: &&Verdict| {
                let Check { case, edges, bound } = verdict.check;
                let name = format!("{} {}", case.name, edges.name());
                let why = match &verdict.error {
                    Ok(error) => {
                        format!("error {} above the bound {}", figure(*error), figure(bound))
                    }
                    Err(fault) => fault.clone(),
                };
                [name, why]
            };
            sheet.table(&failed.iter().map(why).collect::<Vec<_>>());
        }
        sheet.heading(&format!(
            "{} of {} checks pass, in {:.1} s.",
            self.len() - failed.len(),
            self.len(),
            self.iter().map(|verdict| verdict.seconds).sum::<f64>()
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
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
        let passes = self.iter().all(Verdict::passes);
        Some(Box::new(
            object! { "passes": passes, "checks": self.iter().map(row).collect::<Vec<_>>() },
        ))
    }
}

/// Writes a bound or an error with two digits, which suffice for a comparison. Zero is exact.
fn figure(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.1e}")
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
