//! Commands, options and cases that the program no longer has.

/// A figure of a command that has had one.
pub(super) const FIGURE_OF_SENSITIVITY: &str = "figure of asperity sensitivity";

/// Names of removed commands and options, each with what to use instead.
const REMOVED: &[(&str, &str)] = &[
    ("compare", "asperity A --compare B opens A with the curve of B, asperity run A B prints both"),
    ("config", "docs/keys.md lists the settings of the configuration file"),
    ("--quick", "asperity check computes all its cases in seconds"),
    ("--cast", "asciinema rec -c \"asperity demo\" records the terminal"),
    ("--parquet", "results.csv has the same rows, and pandas or polars write them as Parquet"),
    ("--smoothing", "reversals have no density; their JSON has forces and Everett function"),
    ("--loops", "asperity run computes minor loops as stages of the loading"),
    ("--memory", "--jobs keeps the memory of a study down, and --check states it"),
    ("--picture", "-o FILE.svg writes the figure or the screen"),
    ("--frames", "asperity demo prints frames into a pipe: asperity demo | less"),
    ("--fps", "asperity demo has 12 frames a second on a terminal, one in a pipe"),
    ("--ascii", "--marker ascii"),
    ("--shards", "--jobs is the number of jobs of the array"),
    ("--dry-run", "--check prints the script"),
    ("--count", "a number after --preloads: --preloads :128, or 1uN..20uN:128"),
    ("--map", "--format json has the points of the map"),
    ("--partial", "asperity sweep merge writes the finished cells"),
    ("--no-config", "--config none reads no configuration file"),
    ("--no-mouse", "mouse: false in the configuration file leaves the mouse to the terminal"),
    ("--profile", "--draw profile"),
    ("--fragments", "--draw patches"),
    ("--panels", "--draw panels"),
    ("--surface-name", "--channel takes the name of a surface"),
    ("--lines", "--profiles is the number of random profiles"),
    ("--level", "--where names the share of F_a,max"),
    ("--over", "--x names the parameter"),
    (FIGURE_OF_SENSITIVITY, "its table has the same changes, and the explorer draws them as bars (Y)"),
];

/// Cases of `asperity check` that the tests of the crates judge.
const CASES: &[&str] =
    &["jkr-energy", "seventh-power", "mirror", "everything-sticks", "equal-teeth", "springs-2^24"];

/// Returns what serves in place of the first removed command or option among these words.
pub(super) fn instead<'a>(words: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let name = |word: &'a str| word.split('=').next().unwrap_or(word);
    let row = |word| REMOVED.iter().find(|(removed, _)| *removed == name(word));
    words.into_iter().find_map(row).map(|(name, instead)| format!("there is no {name} any more: {instead}"))
}

/// Returns what serves in place of a removed case of `asperity check`.
pub(super) fn instead_of_case(word: &str) -> Option<String> {
    let serves = "cargo test in the source of the program judges more of the same";
    CASES.contains(&word).then(|| format!("there is no case {word} any more: {serves}"))
}
