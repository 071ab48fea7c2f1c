//! The catalogue of hard cases of `asperity check`, case by case, and its references against arithmetic of 192 binary
//! digits.

mod events;
mod extended;
mod laws;
mod sub_cell;
mod wide;

use super::subcell::brute_force as level_by_level;
use asperity::check::{Family, checks, judge};

/// Runs the cases of a family.
fn hold(family: Family) {
    let mut failed = Vec::new();
    let checks = checks(|case| case.family == family && !case.large);
    assert!(checks.len() >= 6, "{family:?} has but {} checks", checks.len());
    for check in checks {
        let verdict = judge(check);
        let line = format!(
            "{} {:?}: {} against {:e}, {:.1} s",
            check.case.name,
            check.edges,
            verdict.error.as_ref().map_or_else(ToString::to_string, |error| format!("{error:.1e}")),
            check.bound,
            verdict.seconds,
        );
        println!("{line}");
        if !verdict.passes() {
            failed.push(line);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn adhesion_from_none_to_all() {
    hold(Family::Adhesion);
}

#[test]
fn scales_to_the_ends_of_numbers() {
    hold(Family::Scales);
}

#[test]
fn lines_of_all_shapes() {
    hold(Family::Lines);
}

#[test]
fn bodies_of_known_loops() {
    hold(Family::ClosedForms);
}

#[test]
fn laws_of_all_bodies() {
    hold(Family::Laws);
}
