//! Content of a table of results: its part of a computation.

use super::preloads::{PRELOADS, Preloads, force_range, parse_force_range};

/// Content of a table of results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableContent {
    /// Points of the force curve.
    ForceCurve,
    /// Positions and heights of the profile.
    Profile,
    /// Figures of random profiles, one row each.
    RandomProfiles(u32),
    /// Adhesion forces for preloads, on the profile of the scene or on this number of random profiles.
    Preloads(Preloads, Option<u32>),
    /// Reversals of one loading.
    Reversals(ReversalContent),
}

/// Reversals in a table: one row for each turning point, or for each point of their map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReversalContent {
    /// Number of turning points.
    pub count: u16,
    /// Forces at the first and the last turning point, N; `None`: from first touch to the preload of the scene.
    pub forces: Option<(f64, f64)>,
    /// Steps on either side over which the density of a map is fitted; `None`: one row for each turning point.
    pub map_smoothing: Option<u8>,
}

/// Words after a number of reversals: before the smoothing of their map, and after it.
const REVERSALS: &str = " reversals";
const MAP: &str = ", map of densities over ";
const STEPS: &str = " steps";

impl ReversalContent {
    fn name(self) -> String {
        let forces = self.forces.map_or_else(String::new, force_range);
        let map = self.map_smoothing.map_or_else(String::new, |steps| format!("{MAP}{steps}{STEPS}"));
        format!("{}{REVERSALS}{forces}{map}", self.count)
    }

    fn from_name(name: &str) -> Option<Self> {
        let (name, map_smoothing) = match name.split_once(MAP) {
            Some((name, map)) => (name, Some(map.strip_suffix(STEPS)?.parse().ok()?)),
            None => (name, None),
        };
        let (count, forces) = name.split_once(REVERSALS)?;
        let forces = if forces.is_empty() { None } else { Some(parse_force_range(forces)?) };
        if forces.is_some_and(|(from, to)| Preloads::new(from, to, *PRELOADS.start()).is_none()) {
            return None;
        }
        Some(ReversalContent { count: count.parse().ok()?, forces, map_smoothing })
    }
}

/// Words after a number of random profiles, and before that number in a table of preloads.
const RANDOM_PROFILES: &str = " random profiles";
const ON: &str = " on ";

impl TableContent {
    /// Name in the file.
    pub(super) fn name(self) -> String {
        match self {
            TableContent::ForceCurve => "force curve".to_owned(),
            TableContent::Profile => "profile".to_owned(),
            TableContent::RandomProfiles(count) => format!("{count}{RANDOM_PROFILES}"),
            TableContent::Preloads(preloads, None) => preloads.name(),
            TableContent::Reversals(reversals) => reversals.name(),
            TableContent::Preloads(preloads, Some(profiles)) => {
                format!("{}{ON}{profiles}{RANDOM_PROFILES}", preloads.name())
            }
        }
    }

    /// Content of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let plain = [TableContent::ForceCurve, TableContent::Profile];
        if let Some(content) = plain.into_iter().find(|content| content.name() == name) {
            return Some(content);
        }
        let Some(counted) = name.strip_suffix(RANDOM_PROFILES) else {
            let preloads = Preloads::from_name(name).map(|preloads| TableContent::Preloads(preloads, None));
            return preloads.or_else(|| ReversalContent::from_name(name).map(TableContent::Reversals));
        };
        match counted.split_once(ON) {
            Some((preloads, profiles)) => {
                Some(TableContent::Preloads(Preloads::from_name(preloads)?, Some(profiles.parse().ok()?)))
            }
            None => counted.parse().ok().map(TableContent::RandomProfiles),
        }
    }
}
