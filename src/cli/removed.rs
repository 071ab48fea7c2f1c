//! Commands and options that the program no longer has.

/// Names of removed commands and options, each with what to use instead.
const REMOVED: &[(&str, &str)] = &[
    ("compare", "asperity A --compare B opens A with the curve of B, asperity run A B prints both"),
    ("config", "docs/keys.md lists the settings of the configuration file"),
    ("--quick", "asperity check computes all its cases in seconds"),
    ("--cast", "asciinema rec -c \"asperity demo\" records the terminal"),
    ("--parquet", "results.csv has the same rows, and pandas or polars write them as Parquet"),
    ("--smoothing", "reversals have no density, and --map writes their forces and Everett function"),
    ("--loops", "asperity run computes minor loops as stages of the loading"),
    ("--memory", "--jobs keeps the memory of a study down, and --check states it"),
];

/// Returns what to use instead of the first of these words that is a removed command or option.
pub(super) fn instead<'a>(words: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let name = |word: &'a str| word.split('=').next().unwrap_or(word);
    let row = |word| REMOVED.iter().find(|(removed, _)| *removed == name(word));
    words.into_iter().find_map(row).map(|(name, instead)| format!("there is no {name} any more: {instead}"))
}
