//! The lines of Python on the page of scene files read the tables of the program.
//!
//! `PYTHON` names another interpreter than `python3`; with `NUMPY=required` NumPy and pandas must be installed.

use super::program::program;
use std::path::Path;
use std::process::{Command, Output};

/// Blocks of Python on the page, in their order.
fn blocks() -> Vec<String> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/scene-file.md");
    let text = std::fs::read_to_string(page).unwrap();
    let blocks = text.split("```python\n").skip(1);
    blocks.map(|rest| rest.split_once("```").unwrap().0.to_owned()).collect()
}

fn python(folder: &Path, code: &str) -> std::io::Result<Output> {
    let interpreter = std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    Command::new(interpreter).args(["-c", code]).current_dir(folder).output()
}

/// Runs code that must succeed.
fn passes(folder: &Path, code: &str) {
    let output = python(folder, code).unwrap();
    assert!(output.status.success(), "{code}\n{}", String::from_utf8_lossy(&output.stderr));
}

fn asperity(folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let output = program().args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn lines_of_python_read_tables() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    if python(folder, "").is_err() {
        assert!(std::env::var_os("NUMPY").is_none(), "there is no Python");
        eprintln!("SKIPPED: there is no Python, no table is read by it");
        return;
    }
    let scene = ["jkr-sphere", "--set", "numerics.points=1024"];
    for file in ["loop.csv", "loop.npy"] {
        asperity(folder, &[&["run"], &scene[..], &["-o", file]].concat());
    }
    let table = std::fs::read_to_string(folder.join("loop.csv")).unwrap();
    let points = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let forces: Vec<f64> = points.map(|point| point.split(',').nth(2).unwrap().parse().unwrap()).collect();
    let expected = format!("expected = {forces:?}\n");
    let [frame, rows, origin] = &blocks()[..] else { panic!("not three blocks of Python") };
    passes(folder, &format!("{rows}{expected}assert [float(row['force']) for row in rows] == expected"));
    if !python(folder, "import numpy, pandas").unwrap().status.success() {
        assert!(std::env::var_os("NUMPY").is_none(), "there is no NumPy or no pandas");
        eprintln!("SKIPPED: there is no NumPy or no pandas, no array is read by them");
        return;
    }
    let (code, other) = frame.split_once("  # or ").unwrap();
    passes(
        folder,
        &format!(
            "{code}\nother = {other}{expected}\
             assert list(frame.columns) == ['leg', 'indentation', 'force', 'contact_length', 'fragments', 'stored_energy']\n\
             assert list(frame['force']) == expected and list(other['force']) == expected\n\
             assert (frame.to_numpy() == other.to_numpy()).all()"
        ),
    );
    passes(
        folder,
        &format!(
            "{origin}{expected}assert list(curve['force']) == expected\n\
             assert origin.startswith('asperity ') and 'command: asperity run ' in origin\n\
             scene = origin.split('scene:\\n')[1]\n\
             assert scene.startswith('(\\n    version: 1,') and 'points: 1024' in scene"
        ),
    );
    // Words, and missing values.
    let lines = ["run", "rough-sphere", "--set", "numerics.points=1024", "--set", "roughness.modes=(1, 64)"];
    for file in ["lines.csv", "lines.npy"] {
        asperity(folder, &[&lines[..], &["--set", "loading=[ToTouch]", "--lines", "3", "-o", file]].concat());
    }
    passes(
        folder,
        "import numpy, pandas\n\
         one = pandas.read_csv('lines.csv', comment='#', keep_default_na=True).fillna('-')\n\
         other = pandas.DataFrame(numpy.load('lines.npy')).replace('', numpy.nan).astype(object).fillna('-')\n\
         assert len(one) == 3 and list(one.columns) == list(other.columns)\n\
         assert (one['adhesion_force'] == '-').all() and (one['regime'] == '-').all()\n\
         assert (one.to_numpy() == other.to_numpy()).all(), (one, other)",
    );
}
