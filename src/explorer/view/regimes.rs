//! Glyphs and styles of the regimes and of the steps of a quantity.

use crate::analysis::Regime;
use crate::explorer::theme::Meaning;

/// Style of a regime. Themes without colours leave the distinction to the glyph.
pub(super) fn meaning(regime: Regime) -> Meaning {
    match regime {
        Regime::PressureInsensitive => Meaning::Surface,
        Regime::PressureSensitive => Meaning::Hand,
        Regime::NonAdhesive => Meaning::Quiet,
    }
}

/// Glyph of a regime.
pub(super) fn glyph_of(regime: Regime) -> &'static str {
    match regime {
        Regime::PressureInsensitive => "█",
        Regime::PressureSensitive => "▒",
        Regime::NonAdhesive => "·",
    }
}

/// Glyphs of a quantity by its steps; below the last there is a dot.
pub(super) const STEPS: [&str; 4] = ["█", "▒", "░", "·"];

/// The glyph of a cell whose lines are divided between two regimes.
pub(super) fn glyph_between(one: Regime, other: Regime) -> &'static str {
    if [one, other].contains(&Regime::PressureInsensitive) { "▓" } else { "░" }
}
