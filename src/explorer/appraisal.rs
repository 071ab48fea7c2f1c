//! Known accuracy of the scene.

use super::panes::Costs;
use crate::accuracy::Estimate;

/// State of the pane of accuracy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appraisal {
    /// The error of what has been computed.
    pub estimated: Estimated,
    /// Cost of accuracy.
    pub costs: Costs,
    /// The tolerance for which springs are searched, and how many are tried.
    pub choosing: Option<(f64, Option<u64>)>,
    /// Answer to the last tolerance, until the next edit.
    pub answer: Option<String>,
}

/// The error of what has been computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Estimated {
    /// Not known yet.
    #[default]
    Waiting,
    /// This one.
    Known(Estimate),
    /// Nothing is known.
    Unknown,
}

impl Appraisal {
    /// Estimated error of the result, where known.
    #[must_use]
    pub fn estimate(&self) -> Option<&Estimate> {
        match &self.estimated {
            Estimated::Known(estimate) => Some(estimate),
            Estimated::Waiting | Estimated::Unknown => None,
        }
    }
}
