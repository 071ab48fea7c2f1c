//! Known accuracy of the scene, and the studies still to be done.

use super::study::Finding;
use crate::accuracy::{CostTable, Estimate};
use std::sync::Arc;

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

/// The table of costs, as far as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Costs {
    /// The rows so far.
    pub table: Option<Arc<CostTable>>,
    /// Setting that is tried at present.
    pub trying: Option<String>,
    /// True if it is finished; or why there is no table.
    pub ended: Option<Result<(), String>>,
}

impl Appraisal {
    /// Takes in a finding. What a tolerance led to is for others to act on.
    pub fn take_in(&mut self, finding: Finding) {
        match finding {
            Finding::Estimated(estimate) => {
                self.estimated = estimate.map_or(Estimated::Unknown, Estimated::Known);
            }
            Finding::Trying(knob, setting) => {
                let setting = if setting.is_empty() { String::new() } else { format!(": {setting}") };
                self.costs.trying = Some(format!("{}{setting}", knob.name()));
            }
            Finding::Costs(table) => self.costs.table = Some(table),
            Finding::Measured(table) => {
                self.costs = Costs { table: Some(table), trying: None, ended: Some(Ok(())) };
            }
            Finding::NotMeasured(why) => {
                self.costs = Costs { table: None, trying: None, ended: Some(Err(why)) };
            }
            Finding::Choosing(points) => {
                if let Some((_, trying)) = &mut self.choosing {
                    *trying = Some(points);
                }
            }
            Finding::Chosen(..) => self.choosing = None,
            // Not about accuracy.
            Finding::Extended(_) | Finding::NotExtended(..) => {}
        }
    }
}
