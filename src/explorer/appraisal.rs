//! Known accuracy of the scene.

use super::panes::Costs;
use crate::accuracy::Estimate;

/// State of the pane of accuracy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appraisal {
    /// Estimated error of the outcome.
    pub estimated: Estimated,
    /// Cost of accuracy.
    pub costs: Costs,
    /// The tolerance for which springs are searched, and the number tried.
    pub choosing: Option<(f64, Option<u64>)>,
    /// Answer to the last tolerance, until the next edit.
    pub answer: Option<String>,
}

/// Estimated error of the outcome.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Estimated {
    /// Not known yet.
    #[default]
    Waiting,
    /// Known.
    Known(Estimate),
    /// Cannot be estimated.
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
