//! Commands and options that the program no longer has, and what serves instead.

/// A removed command, or option with its dashes, and what serves instead of it.
const REMOVED: &[(&str, &str)] = &[
    ("--parquet", "results.csv has the same rows, and pandas or polars write them as Parquet"),
    ("--smoothing", "the density is gone, and --map writes forces and Everett function"),
    ("--loops", "asperity run computes minor loops as stages of the loading"),
    ("--memory", "fewer threads take less memory: --jobs; --check states the memory of a plan"),
];

/// The refusal of a removed command or option; `None` for any other word.
pub(super) fn refusal(word: &str) -> Option<String> {
    let name = word.split('=').next().unwrap_or(word);
    let (name, instead) = REMOVED.iter().find(|(removed, _)| *removed == name)?;
    Some(format!("'{name}' has been removed: {instead}"))
}
