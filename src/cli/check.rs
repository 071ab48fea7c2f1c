//! `asperity check`: closed forms, laws and hard cases, on this machine.

use super::error::CliError;
use super::output::{Origin, OutputArguments, TEXT_OR_JSON, without_look};
use super::progress::ProgressLine;
use crate::check::{Case, Check, Verdict, catalogue, checks, judge};
use crate::export::Format;
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity check                            All cases
  asperity check --quick                    All but the cases of seconds and much memory
  asperity check sphere memory              Cases with one of these words in their names
  asperity check --format json -o check.json

Each case has one error and a bound that was stated beforehand. The exit code is 1 if a case fails.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(without_look))]
pub struct CheckArguments {
    /// Only cases with one of these words in their names
    #[arg(value_name = "WORD")]
    pub words: Vec<String>,
    /// Leave out cases that take seconds and hundreds of megabytes
    #[arg(long)]
    pub quick: bool,
    #[command(flatten)]
    pub output: OutputArguments,
}

impl CheckArguments {
    fn chosen(&self) -> Result<Vec<Check>, CliError> {
        let has = |case: &Case, word: &String| case.name.contains(word.as_str());
        for word in &self.words {
            if !catalogue().iter().any(|case| has(case, word)) {
                let allowed: Vec<&str> = catalogue().into_iter().map(|case| case.name).collect();
                let none = format!("no case has this in its name; allowed: parts of {}", allowed.join(", "));
                return Err(CliError::named(word, none));
            }
        }
        let is_meant = |case: &Case| {
            let named = self.words.is_empty() || self.words.iter().any(|word| has(case, word));
            named && !(self.quick && case.large)
        };
        let chosen = checks(is_meant);
        if chosen.is_empty() {
            let none = "--quick leaves out all of these cases: they take seconds and hundreds of megabytes";
            return Err(CliError::message(none.to_owned()));
        }
        Ok(chosen)
    }
}

pub(super) fn check(arguments: &CheckArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let chosen = arguments.chosen()?;
    let format = arguments.output.format(TEXT_OR_JSON, Format::Text)?;
    let (mut progress, count) = (ProgressLine::default(), chosen.len());
    let run = |(index, check): (usize, Check)| {
        progress.show(&format!("{}/{count} {}", index + 1, check.case.name), None);
        judge(check)
    };
    let verdicts: Vec<Verdict> = chosen.into_iter().enumerate().map(run).collect();
    progress.clear();
    arguments.output.write(stdout, &verdicts[..], format, Origin::Files(&[]))?;
    conclude(&verdicts)
}

fn conclude(verdicts: &[Verdict]) -> Result<(), CliError> {
    let failed = verdicts.iter().filter(|verdict| !verdict.passes()).count();
    match failed {
        0 => Ok(()),
        _ => Err(CliError::message(format!("{failed} of {} checks fail", verdicts.len()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(words: &[&str], quick: bool) -> CheckArguments {
        CheckArguments {
            words: words.iter().map(ToString::to_string).collect(),
            quick,
            output: OutputArguments::default(),
        }
    }

    #[test]
    fn words_choose_cases() {
        let names = |words: &[&str], quick| -> Vec<&str> {
            let mut names: Vec<_> =
                arguments(words, quick).chosen().unwrap().iter().map(|check| check.case.name).collect();
            names.dedup();
            names
        };
        assert_eq!(names(&["cone", "memory"], false), ["cone", "return-point-memory"]);
        assert!(names(&[], false).contains(&"springs-2^24") && !names(&[], true).contains(&"springs-2^24"));
        let error = |words: &[&str], quick| arguments(words, quick).chosen().err().unwrap().to_string();
        assert!(error(&["cone", "trapezium"], false).starts_with("trapezium: no case has this in its name"));
        assert!(error(&["2^24"], true).starts_with("--quick leaves out all of these cases"));
    }

    #[test]
    fn a_failing_case_is_an_error() {
        let verdicts = |errors: &[f64]| -> Vec<Verdict> {
            let checks = checks(|case| case.name == "flat-line");
            let verdict = |(check, &error)| Verdict { check, error: Ok(error), seconds: 0.0 };
            checks.into_iter().zip(errors).map(verdict).collect()
        };
        assert!(conclude(&verdicts(&[0.0, 1e-16])).is_ok());
        for error in [1.0, f64::NAN, f64::INFINITY] {
            let message = conclude(&verdicts(&[0.0, error])).unwrap_err().to_string();
            assert_eq!(message, "1 of 2 checks fail");
        }
    }
}
