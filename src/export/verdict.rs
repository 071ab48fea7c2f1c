//! The regime in words, with the shares it was read from and their thresholds.

use super::sheet::Sheet;
use crate::analysis::{INSENSITIVE_SHARE, NEGLIGIBLE_COEFFICIENT, Regime, VANISHING_SHARE};
use crate::scene::format_quantity;
use crate::simulation::Outcome;

/// The regime and, one row for each, the shares that decided it.
pub(super) fn rows(sheet: &mut Sheet, outcome: &Outcome) {
    let adhesive = outcome.governing.adhesive_work().is_some();
    let meaning = match outcome.regime {
        None if adhesive => return sheet.row("regime", "not known: no leg back pulls"),
        None => return sheet.row("regime", "none: neither adhesion nor a leg back that pulls"),
        Some(Regime::NonAdhesive) if !adhesive => "the scene has no adhesion",
        Some(Regime::PressureInsensitive) => {
            "adhesion is there at first touch and hardly depends on the preload"
        }
        Some(Regime::PressureSensitive) => "adhesion appears, or grows considerably, only under a preload",
        Some(Regime::NonAdhesive) => "almost no adhesion",
    };
    let name = outcome.regime.map_or("", Regime::name);
    sheet.row("regime", format!("{name}: {meaning}"));

    let zero_load = outcome.zero_load_adhesion_force;
    let adhesion = outcome.figures.adhesion_force;
    let shares = [
        (
            "  F_a(0)/F_a",
            zero_load,
            adhesion,
            INSENSITIVE_SHARE,
            "it sticks unpressed",
            "pressing makes most of it",
        ),
        (
            "  F_a(0)/F_smooth",
            zero_load,
            outcome.smooth_adhesion_force,
            VANISHING_SHARE,
            "there at first touch",
            "vanished at first touch",
        ),
        (
            "  F_a/F_n",
            adhesion,
            outcome.figures.preload,
            NEGLIGIBLE_COEFFICIENT,
            "not negligible",
            "negligible",
        ),
    ];
    for (label, part, whole, threshold, above, below) in shares {
        // Products, as the regime itself compares them; a share of nothing decides nothing.
        let (Some(part), Some(whole)) = (part, whole.filter(|&whole| whole > 0.0)) else { continue };
        let (side, says) = if part >= threshold * whole { ("at least", above) } else { ("below", below) };
        let share = format_quantity(part / whole, "1");
        sheet.row(label, format!("{share}, {side} {threshold}: {says}"));
    }
}
