//! Numbers of random profiles in each regime.

use crate::analysis::Regime;
use serde::Serialize;

/// Number of profiles in each regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RegimeCounts {
    /// Pressure-insensitive adhesion.
    pub pressure_insensitive: usize,
    /// Pressure-sensitive adhesion.
    pub pressure_sensitive: usize,
    /// No adhesion.
    pub non_adhesive: usize,
    /// Regime unknown: no tensile force.
    pub none: usize,
}

impl RegimeCounts {
    /// Counts the regimes of profiles.
    pub fn of(regimes: impl Iterator<Item = Option<Regime>>) -> Self {
        let mut counts = [0; 4];
        regimes.for_each(|regime| counts[regime.map_or(3, |regime| regime as usize)] += 1);
        let [pressure_insensitive, pressure_sensitive, non_adhesive, none] = counts;
        RegimeCounts { pressure_insensitive, pressure_sensitive, non_adhesive, none }
    }

    /// Regimes that occur, by name, with their numbers of profiles.
    pub fn present(self) -> impl Iterator<Item = (&'static str, usize)> {
        let counts = [self.pressure_insensitive, self.pressure_sensitive, self.non_adhesive, self.none];
        let names = Regime::ALL.map(Regime::name).into_iter().chain(["not known"]);
        names.zip(counts).filter(|(_, count)| *count > 0)
    }
}
