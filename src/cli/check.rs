//! `asperity check`: checks this program against closed forms, laws and numerically hard cases on
//! this machine.

use super::error::CliError;
use super::output::{Origin, OutputArguments, TEXT_OR_JSON, only_formats};
use super::progress::{ProgressLine, Task, watched};
use asperity_data::Control;
use asperity_report::Format;
use asperity_study::checks::{Case, Check, Verdict};
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity check                            All cases
  asperity check sphere memory              Cases with one of these words in their names
  asperity check --format json -o check.json

Each case has one error and a bound that was stated beforehand. The exit code is 1 if a case fails.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(TEXT_OR_JSON)))]
pub struct CheckArguments {
    /// Only cases with one of these words in their names
    #[arg(value_name = "WORD")]
    pub words: Vec<String>,
    #[command(flatten)]
    pub output: OutputArguments,
}

impl CheckArguments {
    fn chosen(&self) -> Result<Vec<Check>, CliError> {
        for word in &self.words {
            if !Case::all().iter().any(|case| case.name.contains(&**word)) {
                let allowed: Vec<&str> = Case::all().into_iter().map(|case| case.name).collect();
                let none = format!(
                    "no case has this in its name; allowed: parts of {}",
                    allowed.join(", ")
                );
                return Err(CliError::named(word, none));
            }
        }
        Ok(Check::of(|case| {
            let mut words = self.words.iter();
            self.words.is_empty() || words.any(|word| case.name.contains(&**word))
        }))
    }
}

pub(super) fn check(arguments: &CheckArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let chosen = arguments.chosen()?;
    let format = arguments.output.format(TEXT_OR_JSON, Format::Text)?;
    let verdicts = judged(chosen)?;
    arguments
        .output
        .write(stdout, &verdicts[..], format, Origin::Files(&[]))?;
    conclude(&verdicts)
}

/// Performs all checks. After a signal, the present check is finished, and the others are not
/// begun.
fn judged(checks: Vec<Check>) -> Result<Vec<Verdict>, CliError> {
    let count = checks.len();
    let task = Task {
        name: None,
        threads: 1,
        begins: String::new(),
    };
    watched(
        task,
        |begun: &Begun, line: &mut ProgressLine| {
            line.show(&format!("{}/{count} {}", begun.number, begun.name), None)
        },
        |mut control: Control<'_, Begun>| {
            let mut verdicts = Vec::with_capacity(count);
            for (number, check) in (1..).zip(checks) {
                if control.is_stopped() {
                    break;
                }
                let name = check.case.name;
                control.report(Begun { number, name });
                verdicts.push(Check::judge(check));
            }
            Ok::<_, CliError>(verdicts)
        },
    )
}

/// A check that has just begun: its number, counted from 1, and the name of its case.
struct Begun {
    number: usize,
    name: &'static str,
}

fn conclude(verdicts: &[Verdict]) -> Result<(), CliError> {
    let failed = verdicts.iter().filter(|verdict| !verdict.passes()).count();
    match failed {
        0 => Ok(()),
        _ => Err(CliError::message(format!(
            "{failed} of {} checks fail",
            verdicts.len()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_choose_cases() {
        let chosen = |words: &[&str]| {
            let words = words.iter().map(ToString::to_string).collect();
            CheckArguments {
                words,
                output: OutputArguments::default(),
            }
            .chosen()
        };
        let mut names: Vec<&str> = chosen(&["cone", "memory"])
            .unwrap()
            .iter()
            .map(|check| check.case.name)
            .collect();
        names.dedup();
        assert_eq!(names, ["cone", "return-point-memory"]);
        let error = chosen(&["cone", "trapezium"]).unwrap_err().to_string();
        assert!(
            error.starts_with("trapezium: no case has this in its name"),
            "{error}"
        );
    }

    #[test]
    fn a_failing_case_is_an_error() {
        let verdicts = |errors: &[f64]| -> Vec<Verdict> {
            let checks = Check::of(|case| case.name == "flat-line");
            let verdict = |(check, &error)| Verdict {
                check,
                error: Ok(error),
                seconds: 0.0,
            };
            checks.into_iter().zip(errors).map(verdict).collect()
        };
        assert!(conclude(&verdicts(&[0.0, 1e-16])).is_ok());
        for error in [1.0, f64::NAN, f64::INFINITY] {
            let message = conclude(&verdicts(&[0.0, error])).unwrap_err().to_string();
            assert_eq!(message, "1 of 2 checks fail");
        }
    }
}
