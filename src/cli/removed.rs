//! Commands and options that the program no longer has.

/// Names of commands and options, and what serves instead.
const REMOVED: &[(&str, &str)] = &[
    ("compare", "asperity A --compare B opens A with the curve of B, asperity run A B prints both"),
    ("config", "docs/keys.md lists the settings of the configuration file"),
    ("--cast", "asciinema rec -c \"asperity demo\" records the terminal"),
    ("--parquet", "results.csv has the same rows, and pandas or polars write them as Parquet"),
    ("--smoothing", "the density is gone, and --map writes forces and Everett function"),
    ("--loops", "asperity run computes minor loops as stages of the loading"),
    ("--memory", "fewer threads take less memory: --jobs; --check states the memory of a plan"),
];

/// Returns what serves in place of the first removed command or option among these words.
pub(super) fn instead<'a>(words: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let name = |word: &'a str| word.split('=').next().unwrap_or(word);
    let row = |word| REMOVED.iter().find(|(removed, _)| *removed == name(word));
    words.into_iter().find_map(row).map(|(name, instead)| format!("'{name}' has been removed: {instead}"))
}
