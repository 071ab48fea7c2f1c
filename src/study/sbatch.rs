//! Options of sbatch for the submission of a study.
//!
//! sbatch takes abbreviations, bundles of letters, and the first word that is no option for the script. So words of
//! the user are neither passed on unchanged nor searched for errors: only options that are known to preserve array
//! and merge are accepted, read in full and written anew.

use crate::text::is_control;
use std::ffi::OsString;
use std::fmt;
use thiserror::Error;

/// A known option of sbatch, written in full: `--partition=short`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SbatchOption(String);

impl fmt::Display for SbatchOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Error in options for sbatch.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SbatchOptionError {
    /// The word is no such option.
    #[error(
        "{word}: this is not for sbatch here; allowed: {}, with values as in --time=2:00:00. For the array there \
         are --shards and --at-once",
        names().join(", ")
    )]
    Unknown {
        /// The word.
        word: String,
    },
    /// The option needs a value.
    #[error("{option}: the value is missing; allowed: {option}=VALUE")]
    NoValue {
        /// The option.
        option: &'static str,
    },
    /// The option has no value.
    #[error("{option}={value}: this option has no value; allowed: {option}")]
    Valued {
        /// The option.
        option: &'static str,
        /// The given value.
        value: String,
    },
    /// The value cannot be passed on.
    #[error("{option}: allowed: UTF-8 text without control characters")]
    NotText {
        /// The option.
        option: String,
    },
}

/// Kind of value of an option.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Value {
    Needed,
    Optional,
    None,
}

/// Names, letters and values, as in sbatch 22.05.
const OPTIONS: &[(&str, Option<&str>, Value)] = &[
    ("--account", Some("-A"), Value::Needed),
    ("--begin", Some("-b"), Value::Needed),
    ("--chdir", Some("-D"), Value::Needed),
    ("--comment", None, Value::Needed),
    ("--constraint", Some("-C"), Value::Needed),
    ("--core-spec", Some("-S"), Value::Needed),
    ("--cpu-freq", None, Value::Needed),
    ("--cpus-per-task", Some("-c"), Value::Needed),
    ("--deadline", None, Value::Needed),
    ("--error", Some("-e"), Value::Needed),
    ("--exclude", Some("-x"), Value::Needed),
    ("--exclusive", None, Value::Optional),
    ("--export", None, Value::Needed),
    ("--gres", None, Value::Needed),
    ("--hint", None, Value::Needed),
    ("--job-name", Some("-J"), Value::Needed),
    ("--licenses", Some("-L"), Value::Needed),
    ("--mail-type", None, Value::Needed),
    ("--mail-user", None, Value::Needed),
    ("--mem", None, Value::Needed),
    ("--mem-per-cpu", None, Value::Needed),
    ("--nice", None, Value::Optional),
    ("--nodelist", Some("-w"), Value::Needed),
    ("--output", Some("-o"), Value::Needed),
    ("--oversubscribe", Some("-s"), Value::None),
    ("--partition", Some("-p"), Value::Needed),
    ("--priority", None, Value::Needed),
    ("--qos", Some("-q"), Value::Needed),
    ("--reservation", None, Value::Needed),
    ("--switches", None, Value::Needed),
    ("--threads-per-core", None, Value::Needed),
    ("--time", Some("-t"), Value::Needed),
    ("--time-min", None, Value::Needed),
    ("--tmp", None, Value::Needed),
    ("--wckey", None, Value::Needed),
];

fn names() -> Vec<&'static str> {
    OPTIONS.iter().map(|(name, ..)| *name).collect()
}

/// Reads words as options: `--name=value`, `--name value`, `-n value`, and those without a value.
///
/// # Errors
/// The first invalid word, and the allowed options.
pub fn sbatch_options(words: &[OsString]) -> Result<Vec<SbatchOption>, SbatchOptionError> {
    let mut words = words.iter();
    let mut options = Vec::new();
    while let Some(word) = words.next() {
        let word = text(word, word)?;
        let (given, value) = match word.split_once('=') {
            Some((given, value)) if given.starts_with("--") => (given, Some(value)),
            _ => (word, None),
        };
        let known = OPTIONS.iter().find(|(name, letter, _)| *name == given || *letter == Some(given));
        let &(name, _, kind) = known.ok_or_else(|| SbatchOptionError::Unknown { word: word.to_owned() })?;
        let value = match (kind, value) {
            (Value::Needed, None) => {
                let missing = || SbatchOptionError::NoValue { option: name };
                let next = words.next().ok_or_else(missing)?;
                let next = text(next, word.as_ref())?;
                // A value with a leading hyphen requires =, so that no option is taken for a value.
                if next.starts_with('-') {
                    return Err(missing());
                }
                Some(next)
            }
            (Value::None, Some(value)) => {
                return Err(SbatchOptionError::Valued { option: name, value: value.to_owned() });
            }
            (_, value) => value,
        };
        if value.is_some_and(str::is_empty) {
            return Err(SbatchOptionError::NoValue { option: name });
        }
        options.push(SbatchOption(value.map_or_else(|| name.to_owned(), |value| format!("{name}={value}"))));
    }
    Ok(options)
}

fn text<'w>(word: &'w OsString, of: &std::ffi::OsStr) -> Result<&'w str, SbatchOptionError> {
    let text = word.to_str().filter(|text| !text.contains(is_control));
    text.ok_or_else(|| SbatchOptionError::NotText { option: of.to_string_lossy().into_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &str) -> Result<Vec<String>, String> {
        let words: Vec<OsString> = words.split_whitespace().map(OsString::from).collect();
        let options = sbatch_options(&words).map_err(|error| error.to_string())?;
        Ok(options.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn options_are_written_in_full() {
        assert_eq!(
            read("-p short --time=2:00:00 --mem 2G --exclusive --nice=5 -s -J a=b").unwrap(),
            [
                "--partition=short",
                "--time=2:00:00",
                "--mem=2G",
                "--exclusive",
                "--nice=5",
                "--oversubscribe",
                "--job-name=a=b"
            ]
        );
        assert_eq!(read("").unwrap(), Vec::<String>::new());
    }

    #[test]
    fn nothing_else_reaches_sbatch() {
        for words in [
            "x.sh",
            "--quiet",
            "-Q",
            "--arr=1-50",
            "--array=1-9",
            "-a 1-9",
            "-HW",
            "-W",
            "--wait",
            "--wrap=true",
            "--part=x",
            "-px",
            "-p=x",
            "--",
            "-",
            "--parsable",
            "--dependency=afterok:1",
            "--test-only",
            "-M east",
            "--time=1 x.sh",
            "--exclusive x.sh",
            "-s x.sh",
            "--PARTITION=x",
            "--Partition x",
        ] {
            let said = read(words).unwrap_err();
            assert!(said.contains(": this is not for sbatch here; allowed: --account, "), "{words}: {said}");
        }
        for words in ["-p", "--time", "--time=", "--partition --quiet", "-p -Q"] {
            let said = read(words).unwrap_err();
            assert!(said.contains("the value is missing; allowed: --"), "{words}: {said}");
        }
        assert!(read("--oversubscribe=yes").unwrap_err().contains("has no value"));
        let bell = sbatch_options(&["--comment=\u{7}".into()]).unwrap_err();
        assert!(matches!(bell, SbatchOptionError::NotText { .. }), "{bell}");
    }
}
