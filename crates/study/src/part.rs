//! Parts of a study in memory, which other processes compute and send.

use super::error::StudyError;
use super::plan::Plan;
use super::recorder::Recorded;
use super::results::Results;
use asperity_data::Warning;
use serde::{Deserialize, Serialize};

/// Records of some profiles of a plan, and the premises of the model that these profiles do not
/// meet. Each entry begins with the number of the [cell](Plan) and the index of the profile.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StudyPart {
    pub(super) records: Vec<(u64, u64, Recorded)>,
    pub(super) warnings: Vec<(u64, u64, Vec<Warning>)>,
}

impl Results {
    /// Gathers the results of a plan from parts that were computed apart by
    /// [`compute_part`](crate::compute_part).
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice, or if a part belongs to another plan.
    pub fn of_parts(
        plan: &Plan,
        parts: impl IntoIterator<Item = StudyPart>,
    ) -> Result<Results, StudyError> {
        let mut results = Results::empty(plan.clone())?;
        for part in parts {
            for (cell, line, record) in part.records {
                let count = record.as_ref().map_or(plan.record.len(), Vec::len);
                if cell >= plan.cells() || line >= plan.lines || count != plan.record.len() {
                    let found = format!("a record of cell {cell} and profile {line}");
                    return Err(StudyError::refused(None, found, "parts of the same plan"));
                }
                results.set_record(cell * plan.lines + line, record);
            }
            for (cell, line, warnings) in part.warnings {
                results.set_warnings(line, vec![(cell, warnings)]);
            }
        }
        Ok(results)
    }
}
