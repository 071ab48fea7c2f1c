//! The regime in words, with the deciding shares and their thresholds.

use super::sheet::Sheet;
use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE};
use crate::scene::format_quantity;
use crate::simulation::Outcome;

/// The regime and its meaning.
pub(super) fn sentence(outcome: &Outcome) -> String {
    let adhesive = outcome.governing.adhesive_work().is_some();
    let meaning = match outcome.regime {
        None if adhesive => return "not known: no stage unloads".to_owned(),
        None => return "none: no adhesion, and no stage unloads".to_owned(),
        Some(Regime::NonAdhesive) if !adhesive => "the scene has no adhesion",
        Some(Regime::PressureInsensitive) => "adhesion hardly needs a preload",
        Some(Regime::PressureSensitive) => "adhesion is small without a preload",
        Some(Regime::NonAdhesive) => "almost no adhesion, after a turn at first touch or after the preload",
    };
    let name = outcome.regime.map_or("", Regime::by_protocol);
    format!("{name}: {meaning}")
}

/// The regime and, one row each, the deciding shares.
pub(super) fn rows(sheet: &mut Sheet, outcome: &Outcome) {
    sheet.row("regime", sentence(outcome));
    if outcome.regime.is_none() {
        return;
    }
    let (zero_load, adhesion) = (outcome.zero_load_adhesion_force, outcome.figures.adhesion_force);
    let (smooth, preload) = (outcome.smooth_adhesion_force, outcome.figures.preload);
    let says = ["first touch makes most of it", "the preload makes most of it"];
    share(sheet, "  F_a(0)/F_a", zero_load, adhesion, INSENSITIVE_SHARE, says);
    let says = ["there at first touch", "vanished at first touch"];
    share(sheet, "  F_a(0)/F_smooth", zero_load, smooth, VANISHING_SHARE, says);
    if preload.is_some_and(|preload| preload <= 0.0) && zero_load != adhesion {
        let says = ["there without a preload", "vanished without a preload"];
        share(sheet, "  F_a/F_smooth", adhesion, smooth, VANISHING_SHARE, says);
    }
    let says = ["not negligible", "negligible"];
    share(sheet, "  F_a/F_n", adhesion, preload, NEGLIGIBLE_COEFFICIENT, says);
}

/// One share, its side of the threshold, and the conclusion: from the threshold on, below.
fn share(
    sheet: &mut Sheet,
    label: &str,
    part: Option<f64>,
    whole: Option<f64>,
    threshold: f64,
    [from_on, below]: [&str; 2],
) {
    // A share of zero has no meaning.
    let (Some(part), Some(whole)) = (part, whole.filter(|&whole| whole > 0.0)) else { return };
    // Products, as in the comparison of the regime itself.
    let (side, says) = if part >= threshold * whole { ("at least", from_on) } else { ("below", below) };
    let share = format_quantity(part / whole, "1");
    sheet.row(label, format!("{share}, {side} {threshold}: {says}"));
}
