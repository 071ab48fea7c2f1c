//! The catalogue of `asperity check`, case by case, and the engine against arithmetic of 192 binary digits.

mod body;
mod events;
mod extended;
mod laws;
mod sub_cell;
mod wide;

use super::subcell::brute_force as level_by_level;
use asperity::check::{checks, judge};

#[test]
fn the_catalogue_holds() {
    let mut failed = Vec::new();
    let checks = checks(|case| !case.large);
    assert!(checks.len() >= 30, "{} checks", checks.len());
    for check in checks {
        let verdict = judge(check);
        let error = verdict.error.as_ref().map_or_else(ToString::to_string, |error| format!("{error:.1e}"));
        let line = format!("{} {:?}: {error} against {:e}", check.case.name, check.edges, check.bound);
        println!("{line}, {:.1} s", verdict.seconds);
        if !verdict.passes() {
            failed.push(line);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
