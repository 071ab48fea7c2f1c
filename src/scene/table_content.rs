//! Content of a table of results: the part of a computation that the table holds.

use super::preloads::Preloads;

/// Content of a table of results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableContent {
    /// Points of the force curve.
    ForceCurve,
    /// Points of the approximate JKR curve.
    ApproximateJkr,
    /// Positions and heights of the profile.
    Profile,
    /// Figures of random profiles, a row for each.
    RandomProfiles(u32),
    /// Adhesion forces for preloads, on the profile of the scene or on so many random profiles.
    Preloads(Preloads, Option<u32>),
}

/// Words behind a number of random profiles, and before that number behind preloads.
const RANDOM_PROFILES: &str = " random profiles";
const ON: &str = " on ";

impl TableContent {
    /// Name in the file.
    pub(super) fn name(self) -> String {
        match self {
            TableContent::ForceCurve => "force curve".to_owned(),
            TableContent::ApproximateJkr => "approximate JKR curve".to_owned(),
            TableContent::Profile => "profile".to_owned(),
            TableContent::RandomProfiles(count) => format!("{count}{RANDOM_PROFILES}"),
            TableContent::Preloads(preloads, None) => preloads.name(),
            TableContent::Preloads(preloads, Some(profiles)) => {
                format!("{}{ON}{profiles}{RANDOM_PROFILES}", preloads.name())
            }
        }
    }

    /// Content of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let plain = [TableContent::ForceCurve, TableContent::ApproximateJkr, TableContent::Profile];
        if let Some(content) = plain.into_iter().find(|content| content.name() == name) {
            return Some(content);
        }
        let Some(counted) = name.strip_suffix(RANDOM_PROFILES) else {
            return Preloads::from_name(name).map(|preloads| TableContent::Preloads(preloads, None));
        };
        match counted.split_once(ON) {
            Some((preloads, profiles)) => {
                Some(TableContent::Preloads(Preloads::from_name(preloads)?, Some(profiles.parse().ok()?)))
            }
            None => counted.parse().ok().map(TableContent::RandomProfiles),
        }
    }
}
