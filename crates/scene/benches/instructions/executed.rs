//! Effects of scenes, and the lines of source that only they execute.
//!
//! Callgrind attributes instructions to lines, also of inlined functions, so the check does not
//! depend on how the compiler cut the program into functions. Each effect is also searched in the
//! scenes that have it: a check that finds nothing there fails.

use super::callgrind::Profile;
use super::cases::Case;
use asperity_contact::Work;
use std::path::Path;

/// Place of the instructions of an effect.
pub enum Lines {
    /// All lines of functions: files of this project, and the declaration of each function.
    Of(&'static [(&'static str, &'static str)]),
    /// All lines of packages by the beginnings of their folder names.
    Packages(&'static [&'static str]),
}

/// An effect of some scenes only.
pub struct Effect {
    /// Name in words.
    pub name: &'static str,
    /// Its place.
    pub lines: Lines,
    /// True for a case with this effect.
    pub called_for: fn(&Case) -> bool,
    /// Number of its executions as counted by the program.
    pub counted: fn(&Work) -> u64,
}

/// All effects that must not run in scenes without them.
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
            ("crates/contact/src/leg/mod.rs", "pub fn turn("),
            ("crates/contact/src/adhesive/unloading.rs", "pub fn open("),
        ]),
        called_for: Case::goes_back,
        counted: |work| work.detached,
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
    /// Instructions executed for the effect.
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

/// The lines of a function, from its declaration to the brace that closes it.
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
