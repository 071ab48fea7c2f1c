//! Content of a table of results: the part of a computation that the table holds.

/// Content of a table of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableContent {
    /// Points of the force curve.
    ForceCurve,
    /// Positions and heights of the profile.
    Profile,
    /// Figures of random profiles, a row for each.
    RandomProfiles(u32),
}

impl TableContent {
    /// Name in the file.
    pub(super) fn name(self) -> String {
        match self {
            TableContent::ForceCurve => "force curve".to_owned(),
            TableContent::Profile => "profile".to_owned(),
            TableContent::RandomProfiles(count) => format!("{count} random profiles"),
        }
    }

    /// Content of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        match name.split_once(' ') {
            _ if name == TableContent::ForceCurve.name() => Some(TableContent::ForceCurve),
            _ if name == TableContent::Profile.name() => Some(TableContent::Profile),
            Some((count, "random profiles")) => Some(TableContent::RandomProfiles(count.parse().ok()?)),
            _ => None,
        }
    }
}
