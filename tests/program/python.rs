//! The lines of Python in the documentation run, and read the tables of the program.
//!
//! `PYTHON` names another interpreter than `python3`; with `NUMPY=required` NumPy and pandas must
//! be installed.

use super::documentation::block;
use super::generated::read;
use super::program::{asperity_in, table};
use std::path::Path;
use std::process::{Command, Output};

/// Runs code in a folder, with the program first in the search path; `None` without Python.
fn python(folder: &Path, code: &str) -> Option<Output> {
    let interpreter = std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let program = Path::new(env!("CARGO_BIN_EXE_asperity"))
        .parent()
        .unwrap()
        .to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths([program].into_iter().chain(std::env::split_paths(&path))).unwrap();
    Command::new(interpreter)
        .args(["-c", code])
        .current_dir(folder)
        .env("PATH", path)
        .output()
        .ok()
}

/// Output of code that must succeed.
fn passes(folder: &Path, code: &str) -> String {
    let output = python(folder, code).unwrap();
    assert!(
        output.status.success(),
        "{code}\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

/// True if there is Python, and with it the packages to import.
fn can_import(folder: &Path, packages: &str) -> bool {
    let can = python(folder, packages).is_some_and(|output| output.status.success());
    assert!(
        can || std::env::var_os("NUMPY").is_none(),
        "Python cannot run: {packages}"
    );
    if !can {
        eprintln!("SKIPPED: Python cannot run: {packages}");
    }
    can
}

/// The contact radius by the closed solution gives its overlap back, and the force is that of the
/// unloading in the table.
#[test]
fn the_force_without_iteration_is_that_of_the_theory() {
    let folder = tempfile::tempdir().unwrap();
    if can_import(folder.path(), "import math") {
        let code = block("docs/studies.md", "python")
            + r#"
for exponent in range(-400, 401):
    smallest = (pi * 0.05 * 1e-4**2 / (8 * 1e6)) ** (1 / 3)
    a = smallest * (1 + 10 ** (exponent / 100))
    d = a**2 / 1e-4 - sqrt(2 * pi * 0.05 * a / 1e6)
    found, force = jkr(d, 1e-4, 1e6, 0.05)
    expected = 4e6 * a**3 / 3e-4 - sqrt(8 * pi * 1e6 * 0.05 * a**3)
    assert abs(found / a - 1) < 1e-10, (exponent, found, a)
    assert abs(force - expected) < 1e-9 * (abs(expected) + 1.5 * pi * 0.05 * 1e-4), (exponent, force, expected)
assert jkr(-1.02e-6, 1e-4, 1e6, 0.05) is None
print(jkr(2.2120067601286665e-6, 1e-4, 2e6 / 0.75, 0.05)[1])
"#;
        let force: f64 = passes(folder.path(), &code).trim().parse().unwrap();
        assert!((force / 1e-4 - 1.0).abs() < 1e-6, "{force}");
    }
}

#[test]
fn lines_of_python_read_tables() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |scene: &[&str], name: &str| {
        for ending in ["csv", "npy"] {
            let file = format!("{name}.{ending}");
            asperity_in(
                folder,
                &[
                    &["run"],
                    scene,
                    &["--set", "numerics.points=1024", "-o", &file],
                ]
                .concat(),
            )
            .succeeded();
        }
        std::fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap()
    };
    let forces: Vec<f64> = table(&write(&["jkr-sphere"], "loop"))
        .map(|point| point[2])
        .collect();
    let expected = format!("expected = {forces:?}\n");
    let page = read("docs/results.md");
    let blocks: Vec<&str> = page
        .split("```python\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    let [frame] = blocks[..] else {
        panic!("not one block of Python")
    };
    if !can_import(folder, "import numpy, pandas") {
        return;
    }
    let (code, other) = frame.split_once("  # or ").unwrap();
    passes(
        folder,
        &format!(
            "{code}\nother = {other}{expected}\
             assert list(frame['force']) == expected and list(other['force']) == expected\n\
             assert list(frame.columns) == list(other.columns) and (frame.to_numpy() == other.to_numpy()).all()"
        ),
    );
    // Words, and missing values.
    write(
        &[
            "rough-sphere",
            "--set",
            "roughness.modes=(1, 64)",
            "--set",
            "loading=[ToTouch]",
            "--profiles",
            "3",
        ],
        "lines",
    );
    passes(
        folder,
        "import numpy, pandas\n\
         one = pandas.read_csv('lines.csv', comment='#', keep_default_na=True).fillna('-')\n\
         other = pandas.DataFrame(numpy.load('lines.npy')).replace('', numpy.nan).astype(object).fillna('-')\n\
         assert len(one) == 3 and list(one.columns) == list(other.columns)\n\
         assert (one['pull_off_force'] == '-').all() and (one['regime'] == '-').all()\n\
         assert (one.to_numpy() == other.to_numpy()).all(), (one, other)",
    );
}
