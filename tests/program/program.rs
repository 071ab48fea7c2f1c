//! The program as for its users: output and exit code of a command.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};

/// A finished command.
pub struct Finished {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Finished {
    /// Standard output of a command that succeeds.
    pub fn succeeded(self) -> String {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self.stdout
    }
}

/// The program without input, and without scenes of the user who runs the tests.
pub fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.stdin(Stdio::null()).env(
        "XDG_CONFIG_HOME",
        concat!(env!("CARGO_TARGET_TMPDIR"), "/nothing"),
    );
    command
}

/// Runs a command to its end.
pub fn finished(command: &mut Command) -> Finished {
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Finished {
        code: output.status.code(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// Runs the program with these arguments.
pub fn asperity(arguments: &[&str]) -> Finished {
    finished(program().args(arguments))
}

/// Runs the program in a folder.
pub fn asperity_in(folder: &Path, arguments: &[&str]) -> Finished {
    finished(program().current_dir(folder).args(arguments))
}

/// Standard error of a command that fails with this code and prints no results.
pub fn failed(code: i32, arguments: &[&str]) -> String {
    let Finished {
        code: found,
        stdout,
        stderr,
    } = asperity(arguments);
    assert_eq!(
        (found, stdout.as_str()),
        (Some(code), ""),
        "{arguments:?}: {stderr}"
    );
    assert!(
        !stderr.is_empty() && !stderr.contains("panicked"),
        "{stderr}"
    );
    stderr
}

/// Standard output of a command that succeeds.
pub fn text(arguments: &[&str]) -> String {
    asperity(arguments).succeeded()
}

/// The JSON object printed by a command.
pub fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&text(arguments)).unwrap()
}

/// A number in JSON.
pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is not a number"))
}

/// Lines of a table without its provenance.
pub fn rows(table: &str) -> impl Iterator<Item = &str> {
    table.lines().filter(|line| !line.starts_with('#'))
}

/// Numbers of each row of a table; not a number in place of words.
pub fn table(csv: &str) -> impl Iterator<Item = Vec<f64>> {
    rows(csv).skip(1).map(|row| {
        row.split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect()
    })
}
