//! Effects that only some scenes have, and the lines of source that compute each effect.
//!
//! Callgrind counts instructions by line, also for inlined functions. The check therefore does not
//! depend on the functions into which the compiler divides the program. If no instruction of an
//! effect is found in a scene that has the effect, the check fails, because the lines are then
//! probably wrong.

use super::callgrind::Profile;
use super::cases::Case;
use asperity_contact::Work;
use std::path::Path;

/// Source lines whose instructions belong to an effect.
pub enum Lines {
    /// All lines of some functions of this project. Each element has the file and the declaration
    /// of a function.
    Of(&'static [(&'static str, &'static str)]),
    /// All lines of some packages. The elements are the beginnings of the folder names of the
    /// packages.
    Packages(&'static [&'static str]),
}

/// An effect that only some scenes have.
pub struct Effect {
    /// Name of the effect in messages.
    pub name: &'static str,
    /// Source lines that compute the effect.
    pub lines: Lines,
    /// Returns true for a scene that has the effect.
    pub called_for: fn(&Case) -> bool,
    /// Returns how often the effect was computed, according to the work counts of the program.
    pub counted: fn(&Work) -> u64,
}

/// All effects whose code must not run in scenes without the effect.
pub const EFFECTS: &[Effect] = &[
    Effect {
        name: "Hess",
        lines: Lines::Of(&[
            (
                "crates/contact/src/detachment/hess.rs",
                "fn largest_stretch(",
            ),
            ("crates/contact/src/adhesive/run.rs", "pub fn attachment("),
            ("crates/contact/src/adhesive/run.rs", "pub fn holds_to("),
        ]),
        called_for: Case::is_adhesive,
        counted: |work| work.hess_evaluations,
    },
    Effect {
        name: "unloading",
        lines: Lines::Of(&[
            ("crates/contact/src/stage/mod.rs", "pub fn turn("),
            ("crates/contact/src/adhesive/unloading.rs", "pub fn open("),
        ]),
        called_for: Case::goes_back,
        counted: |work| work.detached,
    },
    Effect {
        name: "relaxation",
        lines: Lines::Of(&[
            ("crates/contact/src/relaxation/drive.rs", "pub fn moved("),
            ("crates/contact/src/relaxation/turn.rs", "pub fn memories("),
            ("crates/contact/src/relaxation/recorder.rs", "fn add("),
        ]),
        // No scene here relaxes, so nothing of it may run.
        called_for: |_| false,
        counted: |work| work.steps,
    },
    Effect {
        name: "histogram",
        lines: Lines::Of(&[(
            "crates/surface/src/line/rigid_line.rs",
            "pub fn new(heights: impl Iterator",
        )]),
        called_for: Case::is_observed,
        counted: |work| work.heights_binned,
    },
    Effect {
        name: "FFT",
        lines: Lines::Packages(&["rustfft-", "realfft-"]),
        called_for: Case::is_rough,
        counted: |work| work.transforms,
    },
    Effect {
        name: "random numbers",
        lines: Lines::Packages(&["chacha20-", "rand-0.10"]),
        called_for: Case::is_rough,
        counted: |work| work.random_phases,
    },
];

impl Effect {
    /// Returns the number of instructions that the program executed in the source lines of this
    /// effect, from the counts of instructions by file and line in `profile`. An effect is a part
    /// of the computation that only some scenes need, such as the Fourier transforms of a rough
    /// profile.
    pub fn executed(&self, profile: &Profile) -> u64 {
        match self.lines {
            Lines::Packages(packages) => profile
                .files()
                .filter(|(file, _)| {
                    file.split('/')
                        .any(|folder| packages.iter().any(|package| folder.starts_with(package)))
                })
                .map(|(_, lines)| lines.values().sum::<u64>())
                .sum(),
            Lines::Of(functions) => functions
                .iter()
                .map(|(file, declared)| {
                    let range = lines_of(file, declared);
                    profile
                        .files()
                        .filter(|(path, _)| Path::new(path).ends_with(file))
                        .flat_map(|(_, lines)| lines.range(range.clone()))
                        .map(|(_, &instructions)| instructions)
                        .sum::<u64>()
                })
                .sum(),
        }
    }
}

/// Returns the lines of a function, from its declaration to the brace that closes the function.
fn lines_of(file: &str, declared: &str) -> std::ops::RangeInclusive<u64> {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let text = std::fs::read_to_string(project.join(file)).expect("a source");
    let lines: Vec<&str> = text.lines().collect();
    let first = lines.iter().position(|line| line.contains(declared));
    let first = first.unwrap_or_else(|| panic!("{file} has no {declared}"));
    let indent = &lines[first][..lines[first].len() - lines[first].trim_start().len()];
    let length = lines[first..]
        .iter()
        .position(|line| *line == format!("{indent}}}"))
        .expect("a closing brace");
    first as u64 + 1..=(first + length) as u64 + 1
}
